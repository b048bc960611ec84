//! Many runs of one scenario that differ in their random numbers alone.
//!
//! In: the number of runs; they have the seeds `seed`, `seed + 1`, .. Out: the spread of the estimates over the runs,
//! in time and as a table. Keeps a few hundred numbers of each run, not its trace.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use serde::Serialize;

use pebo_design::model::Scale;
use pebo_design::source::Diagnostic;

use super::failure::Failure;
use super::scenario::Scenario;
use crate::experiment::layout::TIME;
use crate::figure::Sheet;
use crate::figure::curve::DrawnCurve;
use crate::figure::label::Label;
use crate::figure::panel::{Panel, PanelCurve};
use crate::summary::{Estimate, Summary, short, table};
use crate::timing::real;

/// Spans of time, each with its largest error: more than a figure resolves.
const SPANS: u64 = 400;

/// The most errors that are kept of all runs combined.
const MOST_ERRORS: u64 = 20_000_000;

/// Spans of time that a figure needs at least.
const FEWEST_SPANS: u64 = 40;

/// The spread of estimates over many runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ensemble {
    /// The seed of the first run.
    pub seed: u64,
    /// The number of runs.
    pub runs: u64,
    /// The time of their end, in seconds.
    pub end: f64,
    /// The estimates of the model's observer, then those of each baseline.
    pub estimates: Vec<Spread>,
    /// The runs that stopped before their end; their errors count as infinite.
    pub stopped: u64,
    /// The reason of the first of these.
    pub reason: Option<String>,
    /// The number of runs in which an estimate of the model's observer did not settle, and the first of them.
    #[serde(skip)]
    pub(crate) unsettled: (u64, Option<Summary>),
    #[serde(skip)]
    pub(crate) courses: Vec<ErrorCourse>,
}

/// The spread of a state's estimate over the runs; a number that most runs or a tenth of them lack is absent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The time at which it settles, in seconds; see [`Score::settled`](crate::Score::settled).
    pub settled: Quantiles,
    /// The runs in which it does not settle.
    pub unsettled: u64,
    /// The root mean square of its error from then on.
    pub rms: Quantiles,
    /// The largest absolute value of its error from then on.
    pub worst: Quantiles,
    /// The root mean square that the observer predicts, from then on; absent where its numbers are not known.
    pub expected: Quantiles,
}

/// The median and the quantile of 90 % over the runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// The median.
    pub median: Option<f64>,
    /// The quantile of 90 %.
    pub ninety: Option<f64>,
}

/// The largest error in each span of time: instants, each with the quantiles of 10, 50 and 90 %.
pub(crate) type ErrorCourse = Vec<(f64, [f64; 3])>;

impl Scenario {
    /// Runs the loop `runs` times, with the seed of the scenario and those after it. `progress` gets the finished share
    /// now and then, and may end the runs.
    ///
    /// # Errors
    /// [`Failure::Stopped`] if the caller ended it, and the reason of the first run if all stop before their end.
    pub fn run_often(
        &mut self,
        runs: u64,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(Ensemble, Summary), Failure> {
        let seed = self.seed;
        let runs = runs.max(1);
        let mut pool = Pool::new(self, runs);
        for run in 0..runs {
            self.seed = seed.wrapping_add(run);
            let mut peaks = pool.empty();
            let followed = self.follow(
                &mut |plant, table| {
                    let errors = &table[self.experiment.layout.errors.clone()];
                    pool.spans.keep(&mut peaks, (plant.sample(), table[TIME]), errors);
                },
                &mut |done| progress((real(run) + done) / real(runs)),
            );
            match followed {
                Err(Failure::Stopped { at }) => {
                    self.seed = seed;
                    return Err(Failure::Stopped { at });
                }
                Err(failure) => pool.stop(failure),
                Ok(summary) => pool.take(summary, peaks),
            }
        }
        self.seed = seed;
        pool.finish(seed, runs, self)
    }

    /// The advice on many runs, if an estimate did not settle in at least one.
    pub fn advise_on(&self, ensemble: &Ensemble) -> Vec<Diagnostic> {
        let (count, first) = &ensemble.unsettled;
        let found = first.as_ref().map(|first| self.advise(first)).unwrap_or_default();
        let note = format!("so it is in {count} of {} runs, of which this is the first", ensemble.runs);
        found.into_iter().map(|diagnostic| diagnostic.note(note.clone())).collect()
    }
}

/// The spans of time of a run.
#[derive(Debug)]
struct Spans {
    count: usize,
    samples: u64,
    /// The last instant in each.
    ends: Vec<f64>,
}

impl Spans {
    /// Keeps the largest errors of a sample's span.
    fn keep(&mut self, peaks: &mut [Vec<f64>], (sample, t): (u64, f64), errors: &[f64]) {
        let count = u64::try_from(self.count).unwrap_or(SPANS);
        let span = usize::try_from(sample * count / (self.samples + 1)).unwrap_or_default();
        self.ends[span] = t;
        for (peaks, error) in peaks.iter_mut().zip(errors) {
            let error = if error.is_nan() { f64::INFINITY } else { error.abs() };
            peaks[span] = peaks[span].max(error);
        }
    }
}

/// The numbers that are kept of the runs.
#[derive(Debug)]
struct Pool {
    spans: Spans,
    estimates: usize,
    /// By estimate, span and run.
    peaks: Vec<Vec<Vec<f64>>>,
    summaries: Vec<Vec<[f64; 4]>>,
    first: Option<Summary>,
    unsettled: (u64, Option<Summary>),
    stopped: u64,
    failure: Option<Failure>,
}

impl Pool {
    fn new(scenario: &Scenario, runs: u64) -> Self {
        let estimates = scenario.experiment.scored.len();
        let room = MOST_ERRORS / runs / u64::try_from(estimates).unwrap_or(1).max(1);
        let samples = scenario.timing.samples;
        let count = room.clamp(FEWEST_SPANS, SPANS).min(samples + 1);
        let count = usize::try_from(count).unwrap_or(1);
        Self {
            spans: Spans { count, samples, ends: vec![0.0; count] },
            estimates,
            peaks: vec![vec![Vec::new(); count]; estimates],
            summaries: vec![Vec::new(); estimates],
            first: None,
            unsettled: (0, None),
            stopped: 0,
            failure: None,
        }
    }

    /// Zero errors for each estimate and span.
    fn empty(&self) -> Vec<Vec<f64>> {
        vec![vec![0.0; self.spans.count]; self.estimates]
    }

    fn take(&mut self, summary: Summary, peaks: Vec<Vec<f64>>) {
        for (all, run) in self.peaks.iter_mut().zip(peaks) {
            all.iter_mut().zip(run).for_each(|(all, peak)| all.push(peak));
        }
        for (all, scored) in self.summaries.iter_mut().zip(&summary.estimates) {
            let score = scored.score;
            let expected = scored.expected.unwrap_or(f64::INFINITY);
            all.push([score.settled.unwrap_or(f64::INFINITY), score.rms, score.worst, expected]);
        }
        if !summary.unsettled().is_empty() {
            self.unsettled.0 += 1;
            self.unsettled.1.get_or_insert_with(|| summary.clone());
        }
        self.first.get_or_insert(summary);
    }

    fn stop(&mut self, failure: Failure) {
        self.stopped += 1;
        self.failure.get_or_insert(failure);
        self.peaks.iter_mut().flatten().for_each(|all| all.push(f64::INFINITY));
        self.summaries.iter_mut().for_each(|all| all.push([f64::INFINITY; 4]));
    }

    fn finish(self, seed: u64, runs: u64, scenario: &Scenario) -> Result<(Ensemble, Summary), Failure> {
        let Some(first) = self.first else {
            return Err(self.failure.unwrap_or(Failure::Stopped { at: 0.0 }));
        };
        let course = |spans: Vec<Vec<f64>>| -> ErrorCourse {
            let sorted = spans.into_iter().map(|mut all| quantiles(&mut all, [0.1, 0.5, 0.9]));
            self.spans.ends.iter().copied().zip(sorted).collect()
        };
        let spread = |(estimate, all): (Estimate, &Vec<[f64; 4]>)| {
            let of = |place: usize| {
                let mut column: Vec<f64> = all.iter().map(|row| row[place]).collect();
                let [median, ninety] =
                    quantiles(&mut column, [0.5, 0.9]).map(|value| Some(value).filter(|v| v.is_finite()));
                Quantiles { median, ninety }
            };
            let unsettled = all.iter().fold(0, |count, row| count + u64::from(!row[0].is_finite()));
            Spread { estimate, settled: of(0), unsettled, rms: of(1), worst: of(2), expected: of(3) }
        };
        let estimates = scenario.experiment.scored.iter().map(|scored| scored.estimate.clone());
        let ensemble = Ensemble {
            seed,
            runs,
            end: first.end,
            estimates: estimates.zip(&self.summaries).map(spread).collect(),
            stopped: self.stopped,
            reason: self.failure.map(|failure| failure.to_string()),
            unsettled: self.unsettled,
            courses: self.peaks.into_iter().map(course).collect(),
        };
        Ok((ensemble, first))
    }
}

/// The least values that these shares of all do not exceed; `values` are sorted by it.
fn quantiles<const N: usize>(values: &mut [f64], shares: [f64; N]) -> [f64; N] {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    shares.map(|share| {
        let place = (1..=count).position(|rank| real(rank as u64) >= share * real(count as u64) - 1e-9);
        values.get(place.unwrap_or_default()).copied().unwrap_or(f64::NAN)
    })
}

impl Ensemble {
    /// A table of the estimates, and a line for runs that stopped.
    pub fn text(&self) -> String {
        let name = |what: &str| [format!("{what}, median"), "90 %".to_owned()];
        let [settled, rms, worst] = ["settled to 1 %", "rms then", "worst then"].map(name);
        let heading = ["error of".to_owned()].into_iter().chain([settled, rms, worst].into_iter().flatten());
        // An empty column is left out.
        let is_known = self.estimates.iter().any(|spread| spread.expected.median.is_some());
        let known = |text: String| if is_known { text } else { String::new() };
        let mut rows: Vec<[String; 9]> = Vec::new();
        let last = ["unsettled".to_owned(), known("expected".to_owned())];
        rows.extend(heading.chain(last).collect::<Vec<_>>().try_into());
        for Spread { estimate, settled, unsettled, rms, worst, expected } in &self.estimates {
            let time = |t: Option<f64>| t.map_or_else(|| "no".to_owned(), |t| format!("{} s", short(t)));
            let size = |error: Option<f64>| error.map_or_else(|| "-".to_owned(), short);
            rows.push([
                estimate.heading(),
                time(settled.median),
                time(settled.ninety),
                size(rms.median),
                size(rms.ninety),
                size(worst.median),
                size(worst.ninety),
                format!("{unsettled}/{}", self.runs),
                known(size(expected.median)),
            ]);
        }
        let mut text = table(&rows);
        let last = self.seed.wrapping_add(self.runs - 1);
        let mut written = writeln!(text, "runs: {} with the seeds {} to {last}", self.runs, self.seed);
        if let Some(reason) = &self.reason {
            written =
                written.and_then(|()| writeln!(text, "stopped: {} of {} runs: {reason}", self.stopped, self.runs));
        }
        debug_assert!(written.is_ok(), "a string takes everything");
        text
    }

    /// The largest error in each span of time as CSV: `t`, and for each estimate the quantiles of 10, 50 and 90 %.
    pub fn csv(&self) -> String {
        let names = self.estimates.iter().map(|spread| spread.estimate.name());
        let columns = names.flat_map(|name| ["10", "50", "90"].map(|share| format!("{name}_error_{share}")));
        let mut lines = vec![std::iter::once("t".to_owned()).chain(columns).collect::<Vec<_>>().join(",")];
        for span in 0..self.courses.first().map_or(0, Vec::len) {
            let errors = self.courses.iter().flat_map(|course| course[span].1).map(|value| format!("{value:e}"));
            let t = self.courses[0][span].0.to_string();
            lines.push(std::iter::once(t).chain(errors).collect::<Vec<_>>().join(","));
        }
        lines.join("\n") + "\n"
    }

    /// The figure: for each state the largest error in each span of time, its median over the runs and the band of 10
    /// to 90 %, for the model's observer and for each baseline.
    pub fn figure(&self, scenario: &Scenario) -> String {
        let mut states: Vec<&str> = Vec::new();
        for spread in &self.estimates {
            if !states.contains(&spread.estimate.state.as_str()) {
                states.push(&spread.estimate.state);
            }
        }
        let (mut panels, mut curves): (Vec<Panel>, Vec<Vec<DrawnCurve>>) = Default::default();
        for state in states {
            let of_state =
                || self.estimates.iter().zip(&self.courses).filter(|(spread, _)| spread.estimate.state == state);
            let label = |baseline: &Option<String>| match baseline {
                None => Label::text("observer"),
                Some(baseline) => Label::text(baseline),
            };
            panels.push(Panel {
                title: format!("Error of {state}"),
                unit: of_state().find_map(|(spread, _)| spread.estimate.unit.clone()),
                scale: Scale::Log,
                curves: of_state()
                    .map(|(spread, _)| PanelCurve::settling(label(&spread.estimate.baseline), true))
                    .collect(),
            });
            let drawn = |course: &ErrorCourse| {
                let quantile = |place: usize| course.iter().map(|(t, q)| (*t, q[place])).collect();
                DrawnCurve { line: quantile(1), band: Some([quantile(0), quantile(2)]) }
            };
            curves.push(of_state().map(|(_, course)| drawn(course)).collect());
        }
        let title =
            Label::text(&scenario.experiment.title).remark(&format!("median and 10 to 90 % of {} runs", self.runs));
        let duration = scenario.timing.at(scenario.timing.samples);
        let time = ([0.0, duration], Label::name("t"));
        Sheet { title: (&scenario.experiment.title, title), time, panels: &panels, curves: &curves }.draw()
    }
}

#[cfg(test)]
mod tests {
    use super::quantiles;

    #[test]
    fn quantiles_are_values_that_were_there() {
        let mut ten: Vec<f64> = [3, 9, 1, 10, 7, 2, 8, 4, 6, 5].map(f64::from).to_vec();
        let bits = |values: [f64; 3]| values.map(f64::to_bits);
        assert_eq!(bits(quantiles(&mut ten, [0.1, 0.5, 0.9])), bits([1.0, 5.0, 9.0]));
        assert_eq!(bits(quantiles(&mut [7.0], [0.1, 0.5, 0.9])), bits([7.0; 3]));
        assert!(quantiles(&mut [1.0, f64::INFINITY], [0.9])[0].is_infinite());
    }
}
