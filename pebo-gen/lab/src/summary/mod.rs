//! The summary of a run, for people and for programs.
//!
//! In: the scores of the estimates, the excitation, and the lost samples. Out: all of it as a structure and as a table
//! in text. Independent of the source of samples.

pub(crate) mod advice;

use serde::Serialize;

use super::score::Score;
use crate::observe::certainty::Certainty;
use crate::observe::driver::ObserverDriver;
use crate::observe::excitation::Excitation;
use crate::score::domain::OutsideDomain;
use crate::score::faults::Faults;
use crate::settings::{KnownNumbers, Numbers, Value};

/// The summary of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The time of its end, in seconds.
    pub end: f64,
    /// The samples after the first.
    pub samples: u64,
    /// The estimates of the model's observer, then those of each baseline.
    pub estimates: Vec<EstimateScore>,
    /// The excitation of the model's observer by its data.
    pub excitation: Excitation,
    /// The samples that the model's observer refused.
    pub faults: Faults,
    /// The samples that never arrived.
    pub dropped: u64,
    /// The samples that were taken without some of their outputs.
    pub parted: u64,
    /// The samples that were taken while the left inverse had no value, so that there was no estimate.
    pub stateless: u64,
    /// The number of restarts of the model's observer after gaps that were too long.
    pub restarts: u64,
    /// The assumptions of the plant that did not hold throughout.
    pub outside: Vec<OutsideDomain>,
    /// The normalised square of the innovation, on average over samples and rows: 1 where model and numbers are right;
    /// none where the observer does not know its sensors.
    pub surprise: Option<f64>,
    /// The same without what stands out: at most five standard deviations of each count.
    pub typical: Option<f64>,
    /// How many times as large innovations are as the observer's numbers say, where these are contradicted: then no
    /// standard error is expected.
    pub contradiction: Option<f64>,
    /// The certainty of estimates beside `wanted`; none where nothing is wanted.
    pub certainty: Option<Certainty>,
    /// The known numbers behind the settings of the model's observer; none where the author chose them.
    pub known: Option<KnownNumbers>,
}

/// The estimate of a state with its score.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EstimateScore {
    /// The estimate: its observer and its state.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Its score.
    #[serde(flatten)]
    pub score: Score,
    /// The standard error that the observer predicts, from the time on at which errors are scored; none where it does
    /// not know.
    pub expected: Option<f64>,
    /// The step up to whose multiples the outputs determine the state, where it is not declared an angle; none where
    /// they determine it.
    pub step: Option<f64>,
    /// True if the state itself was beyond its bounds in `within`, where that is known.
    pub outside: bool,
}

/// The estimate: its observer and its state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Estimate {
    /// The baseline; none for the model's own observer.
    pub baseline: Option<String>,
    /// The state.
    pub state: String,
    /// Its unit, if the model has one for it.
    pub unit: Option<String>,
}

impl Estimate {
    /// The state's name behind its baseline's.
    pub fn name(&self) -> String {
        match &self.baseline {
            Some(baseline) => format!("{baseline}.{}", self.state),
            None => self.state.clone(),
        }
    }

    /// The name with the unit.
    pub(super) fn heading(&self) -> String {
        let unit = self.unit.as_ref().map_or_else(String::new, |unit| format!(" in {unit}"));
        self.name() + &unit
    }
}

/// Beyond these, the normalised square of the innovation contradicts the numbers of an observer: what a factor of two in
/// a standard deviation comes to, with some room.
pub(crate) const CREDIBLE: std::ops::RangeInclusive<f64> = 0.2..=5.0;

/// The mean square of so many innovations is below or above these by chance in one of ten thousand runs at most.
const ENOUGH: [u64; 2] = [20, 10];

/// How many times as large innovations are as expected, if that contradicts the observer's numbers: what is typical of
/// their normalised squares, and the number of these. Samples that scatter less do so only where they are real ones, or
/// have noise: those of an ideal sensor are no measurement of it.
pub(crate) fn contradiction(driver: &ObserverDriver, is_noisy: bool) -> Option<f64> {
    let contradicts = |square: &f64| {
        let is_above = *square > 1.0;
        !CREDIBLE.contains(square) && (is_noisy || is_above) && driver.judged() >= ENOUGH[usize::from(is_above)]
    };
    driver.typical().filter(contradicts)?;
    Some(driver.surprise()?.sqrt())
}

/// The same of recorded innovations of which most are as expected, and some so large that their mean is not: a step of the
/// plant, or samples that are off by far. In a simulation they come from the scenario.
pub(crate) fn standing_out(driver: &ObserverDriver) -> Option<f64> {
    let mean = driver.surprise().filter(|square| square > CREDIBLE.end() && driver.stands_out())?;
    Some(mean.sqrt())
}

impl Summary {
    /// The states whose estimates by the model's own observer did not settle.
    pub fn unsettled(&self) -> Vec<&EstimateScore> {
        let own = self.estimates.iter().filter(|scored| scored.estimate.baseline.is_none());
        own.filter(|scored| scored.score.settled.is_none()).collect()
    }

    /// A table of the estimates, and a line each for excitation, faults and lost samples.
    pub fn text(&self) -> String {
        let mut text: String = self.foremost().map(|line| line + "\n").unwrap_or_default();
        text.push_str(&if self.estimates.is_empty() { String::new() } else { table(&self.rows()) });
        for line in self.lines() {
            text.extend([line.as_str(), "\n"]);
        }
        text
    }

    /// The table of the estimates with its headings; a column without entries is empty.
    pub fn rows(&self) -> Vec<[String; 7]> {
        let headings =
            ["error of", "at the start", "at the end", "settled to 1 %", "rms then", "worst then", "expected"];
        let mut rows = vec![headings.map(str::to_owned)];
        for EstimateScore { estimate, score, expected, .. } in &self.estimates {
            let settled = match score.settled {
                Some(t) => format!("{} s", short(t)),
                None => "no".to_owned(),
            };
            let errors = [score.first, score.last].map(short);
            let [first, last] = errors;
            let expected = expected.map_or_else(|| "-".to_owned(), short);
            rows.push([estimate.heading(), first, last, settled, short(score.rms), short(score.worst), expected]);
        }
        // A column without entries is left out.
        if self.estimates.iter().all(|scored| scored.expected.is_none()) {
            for row in &mut rows {
                row[6].clear();
            }
        }
        rows
    }

    /// What is to be known before the table is read.
    pub fn foremost(&self) -> Option<String> {
        let factor = short(self.contradiction?);
        if self.is_mostly_as_expected() {
            return Some(format!(
                "innovations: most as expected, but some stand out, so that on average they are {factor} times as large as the \
                 numbers of the observer say; no standard error is expected"
            ));
        }
        Some(format!(
            "innovations: {factor} times as large as the numbers of the observer say, which do not fit these samples; no \
             standard error is expected"
        ))
    }

    /// True if innovations are as the numbers say but for some that stand out.
    pub(crate) fn is_mostly_as_expected(&self) -> bool {
        self.typical.is_some_and(|typical| CREDIBLE.contains(&typical))
    }

    /// The lines below the table.
    pub fn lines(&self) -> Vec<String> {
        // The first is one of them too.
        let all = self.samples + 1;
        let mut lines = Vec::new();
        let mut line = |name: &str, what: &str| lines.push(format!("{name}: {what}"));
        for OutsideDomain { assumption, is_condition, since, samples } in &self.outside {
            let since = short(*since);
            line(
                if *is_condition { "outside the conditions" } else { "outside the domain" },
                &format!(
                    "`{assumption}` does not hold from t = {since} s on, in {samples} of {all} samples: nothing is proved there"
                ),
            );
        }
        match &self.excitation {
            Excitation::NotYet { weakest } => line("excitation", &format!("not yet, `{weakest}` is not determined")),
            Excitation::Converged { since } => line("excitation", &format!("enough from t = {} s on", short(*since))),
            Excitation::Lost { since, weakest } => {
                line("excitation", &format!("lost at t = {} s, `{weakest}` has been forgotten", short(*since)));
            }
        }
        match &self.certainty {
            None => {}
            Some(Certainty::NotYet { weakest, error: Some(error), wanted }) => line(
                "certainty",
                &format!(
                    "not yet, `{weakest}` is known to {} at the end, where {} is wanted",
                    short(*error),
                    short(*wanted)
                ),
            ),
            Some(Certainty::NotYet { error: None, .. }) => {
                line("certainty", "not known, as no standard error is predicted");
            }
            Some(Certainty::Converged { since }) => {
                line("certainty", &format!("as wanted from t = {} s on", short(*since)));
            }
            Some(Certainty::Lost { since, weakest }) => {
                line(
                    "certainty",
                    &format!("lost at t = {} s, `{weakest}` is no longer known as wanted", short(*since)),
                );
            }
        }
        if let Some(surprise) = self.surprise {
            line("innovation", &format!("normalised square {} on average, where 1 is expected", short(surprise)));
        }
        if let Some(reason) = self.known.as_ref().and_then(|known| known.unpredicted.as_ref()) {
            line("expected", &format!("no standard error is predicted: {reason}"));
        }
        if self.parted > 0 {
            line("in part", &format!("{} of {all} samples lack an output", self.parted));
        }
        if self.stateless > 0 {
            line("no state", &format!("at {} of {all} samples, where the left inverse is not finite", self.stateless));
        }
        if self.dropped > 0 {
            line("dropped", &format!("{} of {all} samples", self.dropped));
        }
        if self.restarts > 0 {
            let often = if self.restarts == 1 { "once".to_owned() } else { format!("{} times", self.restarts) };
            line("begun anew", &format!("{often}, after more than `gap` without a sample"));
        }
        for (reason, count) in self.faults.iter() {
            line("refused", &format!("{count} of {all} samples: {reason}"));
        }
        if let Some(known) = &self.known {
            line("observer", &known.observer);
            for Numbers { what, assumed, recorded, values } in &known.numbers {
                let value = |value: &Value| {
                    let unit = value.unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
                    format!("{} {}{unit}", value.name, short(value.value))
                };
                let values = values.iter().map(value).collect::<Vec<_>>().join(", ");
                let origin = match (assumed, recorded) {
                    (true, _) => " (assumed)",
                    (false, true) => " (as the first rows show)",
                    (false, false) => "",
                };
                line(&format!("  {what}"), &(values + origin));
            }
        }
        lines
    }
}

/// Three digits.
pub(super) fn short(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&magnitude) {
        // The decimals that leave three digits, for each power of ten.
        let decimals = [1000.0, 100.0, 10.0, 1.0, 0.1, 0.01, 0.0].iter().position(|power| magnitude >= *power);
        format!("{value:.0$}", decimals.unwrap_or_default().saturating_sub(1))
    } else {
        format!("{value:.2e}")
    }
}

/// Columns beside one another: the first to the left, the others to the right.
pub(super) fn table<const N: usize>(rows: &[[String; N]]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default();
    let widths: [usize; N] = std::array::from_fn(width);
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("   {cell:>width$}"),
        });
        let line: String = cells.collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
