//! Derives the settings of the gradient of a monotone regression from standard deviations.
//!
//! ```text
//! theta' = Gamma Phi^T e / (1 + mu |Phi|^2)     Gamma = speed (1 + mu |Phi|^2) / diag(Phi^T Phi)
//! ```
//!
//! In: standard deviations and the slopes of the regression along the plant's course, in the mean. Out: the gain with which
//! the error dies out at the speed there, and a normalisation with which it does so at no less than half of it where slopes
//! are ten times smaller. The proof admits no memory of rows: samples are taken one by one.

use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::analysis::{AtEstimate, Derivation, RegressionKind};
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::plant::settings::{Estimator, Operator, Rebase, Settings};
use pebo_design::source::{Code, Diagnostic, Diagnostics};

use super::derive::{BANDWIDTH, frame, no_period, no_point, out_of_range};
use super::derived::DerivedSettings;
use super::digits::rounded;
use super::magnitude::Deviations;
use super::point::Point;
#[cfg(feature = "simulate")]
use super::prediction::{Prediction, UNWEIGHED};
use super::shown::Shown;
use super::spread::Slopes;
use super::start::beginning;
#[cfg(feature = "simulate")]
use super::words::KnownNumbers;

/// Time constants within the samples after which a constant may have drifted by its magnitude: the error has settled then.
const SETTLED: f64 = 5.0;

/// The slopes at which the speed is half of what it is with large ones, as a share of those along the course.
const FLAT: f64 = 0.1;

/// True if the regression of the model is monotone.
pub(super) fn is_monotone(derivation: &Derivation) -> bool {
    derivation.at_estimate() == Some(AtEstimate::Monotone)
}

/// The refusal of a setting of another estimator than the gradient, or of one with memory.
pub(super) fn refused(model: &Model, derivation: &Derivation) -> Option<Diagnostic> {
    if !is_monotone(derivation) {
        return None;
    }
    let written = &model.observer;
    let gains = ["estimator", "gain", "normalisation"].into_iter().find_map(|key| written.span_of(key));
    let gains = gains.or_else(|| written.estimator.as_ref().map(|estimator| estimator.span));
    if let (Some(span), None, None, None) = (gains, &written.window, &written.filter, written.known()) {
        let message = "the gradient of a monotone regression needs `window: 1`";
        return Some(
            Diagnostic::error(Code::SimulationIncomplete, span, message)
                .note("its proof is of samples one by one")
                .help("add `window: 1` under `observer`"),
        );
    }
    let is_one = |window: &pebo_design::model::Decimal| (window.to_f64() - 1.0).abs() < f64::EPSILON;
    let filter = written.filter.as_ref().map(|filter| ("filter", filter.span));
    let window = written.window.as_ref().filter(|window| !is_one(&window.value)).map(|window| ("window", window.span));
    let gate = written.gate.as_ref().map(|gate| ("gate", gate.span));
    let form = written.form.as_ref().map(|form| ("form", form.span));
    let of_others = ["covariance", "process_noise", "forgetting", "regressor_gain", "clip", "period"];
    let others = of_others.into_iter().find_map(|key| Some((key, written.span_of(key)?)));
    let (key, span) = filter.or(window).or(gate).or(form).or(others)?;
    let message = format!("`{key}` does not go with a monotone regression");
    Some(
        Diagnostic::error(Code::SettingConflict, span, message)
            .note(
                "the proof is that of a gradient on the samples one by one: `estimator: gradient` or \
                   `normalised-gradient` with `window: 1`",
            )
            .help(format!(
                "remove `{key}`, or write `regression: local` for an observer that converges from a neighbourhood"
            )),
    )
}

/// The settings derived from known numbers.
pub(super) fn derive(
    model: &Model,
    plant: &Plant,
    derivation: &Derivation,
    shown: &Shown,
    problems: &mut Diagnostics,
) -> Option<DerivedSettings> {
    let regression = derivation.regression.result.as_ref()?.with_extension(plant, &plant.transform());
    let frame = frame(model, plant, derivation, problems)?;
    let asked = model.observer.known();
    let known = Point::of(model, plant, shown);
    let slopes: Vec<Expr> = regression.phi_1.concat();
    let transform = plant.transform();
    if let Some(lacking) = known.lacks(&[slopes.as_slice(), &transform].concat()) {
        asked.map(|asked| no_point(plant, asked, lacking)).into_iter().for_each(|problem| problems.push(problem));
        return None;
    }
    let Some(period) = shown.period_beside(model) else {
        asked.map(|asked| no_period(plant, "gain", asked)).into_iter().for_each(|problem| problems.push(problem));
        return None;
    };
    let deviations = Deviations::of(model, plant, &known, (shown, Some(period)), true)?;
    let mean = mean_squares(&known.along(shown), &slopes)?;
    let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    let drift = Slopes::new(plant, &transform, &states).variances(&known, &deviations.disturbance)?;
    let total: f64 = mean.iter().sum();
    let of_unknown = |place: usize| mean.iter().skip(place).step_by(transform.len()).sum::<f64>();
    let speed = {
        let sensors = deviations.sensors.iter().map(|deviation| deviation.powi(2)).sum::<f64>();
        let moved: f64 = drift.iter().enumerate().map(|(place, drift)| of_unknown(place) * drift).sum();
        let signal = moved / sensors;
        // The least sum of what the sensors add and what the drift leaves: of a value each sample errs by itself, of a rate
        // as much as it makes up for at the next one.
        let wanted = match regression.kind {
            RegressionKind::Static => (signal / period).sqrt(),
            RegressionKind::Dynamic | RegressionKind::Implicit => (signal / 4.0).cbrt(),
        };
        let assumed = SETTLED / (Deviations::SAMPLES * period);
        let wanted = if deviations.are_assumed || !wanted.is_finite() { assumed } else { wanted.max(assumed) };
        wanted.min(BANDWIDTH / period)
    };
    let mu = 1.0 / (FLAT * FLAT * total);
    let gain: Vec<f64> = (0..transform.len()).map(|place| speed * mu.mul_add(total, 1.0) / of_unknown(place)).collect();
    let exact = || Some((gain.iter().map(|gain| rounded(*gain)).collect::<Option<Vec<Rational>>>()?, rounded(mu)?));
    let is_usable = mu.is_finite() && gain.iter().all(|gain| gain.is_finite() && *gain > 0.0);
    let Some((gain, mu)) = Some(()).filter(|()| is_usable).and_then(|()| exact()) else {
        problems.push(out_of_range(asked.map_or(model.name.span, |(_, span)| span)));
        return None;
    };
    #[cfg(feature = "simulate")]
    let numbers = KnownNumbers::of_gradient(plant, (model, shown), &deviations, (&gain, &mu));
    let begun = || beginning(&known, plant, derivation);
    let chi_0 = frame.chi_0.or_else(begun).unwrap_or_else(|| vec![Rational::from(0); transform.len()]);
    Some(DerivedSettings {
        settings: Settings {
            operator: Operator::Window(Rational::ONE),
            output: false,
            expected: None,
            errors_in_variables: None,
            feedthrough: None,
            late: None,
            straight: frame.straight,
            estimator: Estimator::NormalisedGradient { gain, mu },
            lower: None,
            upper: None,
            within: frame.within,
            rebase: Some(Rebase::Samples(Rational::ONE)),
            chi_0,
            gate: None,
            limits: None,
        },
        #[cfg(feature = "simulate")]
        known: Some(numbers),
        #[cfg(feature = "simulate")]
        prediction: Prediction::None(UNWEIGHED),
    })
}

/// The mean squares of formulas at these points.
fn mean_squares(points: &[Point], formulas: &[Expr]) -> Option<Vec<f64>> {
    let rows: Vec<Vec<f64>> = points.iter().filter_map(|point| point.values(formulas)).collect();
    let count = rows.iter().map(|_| 1.0).sum::<f64>();
    let mean =
        |place: usize| rows.iter().map(|row| row[place].powi(2)).filter(|square| square.is_finite()).sum::<f64>();
    (!rows.is_empty()).then(|| (0..formulas.len()).map(|place| mean(place) / count).collect())
}
