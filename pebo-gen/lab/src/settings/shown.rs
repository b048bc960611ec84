//! What samples show besides the model: where the plant starts, how much its sensors scatter, how often they come.
//!
//! In: the first samples of a recording. Out: numbers that stand in for those of a simulation.

use std::collections::BTreeMap;

use pebo_cas::Symbol;
use pebo_design::model::Model;

/// What samples show besides the model; nothing, where there are none yet.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// Their period in seconds, where it is known.
    period: Option<f64>,
    /// True if they were recorded.
    pub(super) is_recorded: bool,
    /// The first values of signals.
    pub(super) first: BTreeMap<Symbol, f64>,
    /// Some samples in which no signal is missing, in the order of `signals`.
    pub(super) course: Vec<Vec<f64>>,
    pub(super) signals: Vec<Symbol>,
    /// The standard deviations of sensors.
    pub(super) deviations: BTreeMap<Symbol, f64>,
}

impl Shown {
    /// Nothing but the period.
    #[cfg(feature = "simulate")]
    pub(crate) fn of_period(period: Option<f64>) -> Self {
        Self { period, ..Self::default() }
    }

    /// The period of the first samples, in seconds.
    #[cfg(feature = "simulate")]
    pub(crate) fn period(&self) -> Option<f64> {
        self.period
    }

    /// The period of the samples: that of a recording counts more than that of a simulation, and this more than one that
    /// is merely given.
    pub(super) fn period_beside(&self, model: &Model) -> Option<f64> {
        let step = model.simulation.as_ref().and_then(|simulation| simulation.step.as_ref());
        let simulated = step.map(|step| step.value.to_f64()).filter(|step| *step > 0.0);
        if self.is_recorded { self.period.or(simulated) } else { simulated.or(self.period) }
    }

    /// What the first samples of a recording show, signal by signal, and their instants, where the period is not known; a
    /// value that is not finite is missing. What scatters is told of the signals in `sensors`.
    #[cfg(feature = "simulate")]
    pub(crate) fn by_samples(
        (times, period): (&[f64], Option<f64>),
        samples: &[(Symbol, Vec<f64>)],
        sensors: &[Symbol],
    ) -> Self {
        let intervals = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|interval| *interval > 0.0);
        let first = samples
            .iter()
            .filter_map(|(signal, values)| Some((*signal, values.iter().copied().find(|value| value.is_finite())?)));
        let rows = samples.iter().map(|(_, values)| values.len()).min().unwrap_or_default();
        let whole = (0..rows).step_by(EVERY).map(|k| samples.iter().map(|(_, values)| values[k]).collect());
        let measured = samples.iter().filter(|(signal, _)| sensors.contains(signal));
        Self {
            period: period.or_else(|| median(intervals.collect())),
            is_recorded: true,
            first: first.collect(),
            course: whole.filter(|row: &Vec<f64>| row.iter().all(|value| value.is_finite())).collect(),
            signals: samples.iter().map(|(signal, _)| *signal).collect(),
            deviations: measured.filter_map(|(signal, values)| Some((*signal, scatter(values)?))).collect(),
        }
    }
}

/// Of so many rows one shows how large the rates of the plant are.
#[cfg(feature = "simulate")]
const EVERY: usize = 8;

/// The orders of the differences that are looked at.
#[cfg(feature = "simulate")]
const ORDERS: std::ops::RangeInclusive<usize> = 2..=4;

/// The median of the absolute value of a normal number of standard deviation 1.
#[cfg(feature = "simulate")]
const MEDIAN: f64 = 0.674_489_750_196_081_7;

/// Fewer differences say little of their median.
#[cfg(feature = "simulate")]
const FEWEST: usize = 20;

/// The standard deviation of what samples have besides a smooth course; none where they do not tell.
///
/// Method: the median of divided differences of higher order, which outliers do not move and in which a smooth signal is
/// the smaller the higher the order is: of orders two to four the least. They are of the samples that are there, at their
/// places among the rows. A sensor that rounds to a step scatters by the twelfth root of it at least.
#[cfg(feature = "simulate")]
fn scatter(values: &[f64]) -> Option<f64> {
    let mut place = 0.0;
    let mut placed = |value: &f64| {
        place += 1.0;
        (place, *value)
    };
    let present: Vec<(f64, f64)> = values.iter().map(&mut placed).filter(|(_, value)| value.is_finite()).collect();
    let steps = present.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
    let step = steps.filter(|step| *step > 0.0).min_by(f64::total_cmp)?;
    let of_order = |order: usize| {
        let known: Vec<f64> = present.windows(order + 1).map(|samples| difference(samples).abs()).collect();
        Some(known).filter(|known| known.len() >= FEWEST).and_then(median).map(|median| median / MEDIAN)
    };
    let least = ORDERS.filter_map(of_order).min_by(f64::total_cmp)?;
    Some(least.max(step / 12.0_f64.sqrt()))
}

/// The divided difference of samples at these places, of standard deviation 1 where they are noise of that.
#[cfg(feature = "simulate")]
fn difference(samples: &[(f64, f64)]) -> f64 {
    let factor = |(own, _): &(f64, f64)| {
        let others = samples.iter().map(|(place, _)| own - place).filter(|apart| *apart != 0.0);
        1.0 / others.product::<f64>()
    };
    let factors: Vec<f64> = samples.iter().map(factor).collect();
    let size = factors.iter().map(|factor| factor * factor).sum::<f64>().sqrt();
    samples.iter().zip(&factors).map(|((_, value), factor)| value * factor / size).sum()
}

#[cfg(feature = "simulate")]
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(all(test, feature = "simulate"))]
mod tests {
    use super::scatter;

    /// Numbers of mean 0 and standard deviation 1, nearly normal: sums of twelve even ones.
    fn noise(count: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let mut even = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from(u32::try_from(state >> 33).unwrap()) / f64::from(1_u32 << 31)
        };
        (0..count).map(|_| (0..12).map(|_| even()).sum::<f64>() - 6.0).collect()
    }

    #[test]
    fn what_a_sensor_scatters_by_is_told_from_its_course() {
        let time = |k: usize| f64::from(u32::try_from(k).unwrap()) * 0.01;
        // A swing of 10 at half a hertz, sampled at 100: noise of 0.05 on it, known to some percent from 500 samples.
        let noisy: Vec<f64> =
            noise(500).iter().enumerate().map(|(k, e)| 10.0 * (3.0 * time(k)).sin() + 0.05 * e).collect();
        let found = scatter(&noisy).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.15, "{found}");
        // Two samples are missing, and one of fifty is off by far.
        let mut holes = noisy.clone();
        holes[100] = f64::NAN;
        holes[101] = f64::NAN;
        (0..500).step_by(50).for_each(|k| holes[k] += 30.0);
        let found = scatter(&holes).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.3, "{found}");
        // Every third sample is missing, or two of three: no three of them are neighbours. The median of 165 differences
        // that share samples is known to an eighth, and the least of three of them is lower.
        for (every, keeps) in [(3, false), (3, true)] {
            let is_kept = |k: usize| k.is_multiple_of(every) == keeps;
            let gaps: Vec<f64> =
                noisy.iter().enumerate().map(|(k, value)| if is_kept(k) { *value } else { f64::NAN }).collect();
            let found = scatter(&gaps).unwrap();
            assert!((found / 0.05 - 1.0).abs() < 0.3, "{found}");
        }
        // A sensor that comes with every tenth row, of a swing that is as much slower.
        let mut slow = vec![f64::NAN; 5000];
        (0..500).for_each(|k| slow[10 * k] = noisy[k]);
        let found = scatter(&slow).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.15, "{found}");
        // An ideal sensor that rounds to 0.1.
        let rounded: Vec<f64> = (0..500).map(|k| (10.0 * (3.0 * time(k)).sin() * 10.0).round() / 10.0).collect();
        let found = scatter(&rounded).unwrap();
        assert!((0.02..0.04).contains(&found), "{found}");
        // Neither a constant nor a few samples tell.
        assert_eq!((scatter(&[1.0; 100]), scatter(&noisy[..20])), (None, None));
    }
}
