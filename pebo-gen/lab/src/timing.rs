//! The instants of a run, and the samples that are written.

use pebo_cas::Rational;
use pebo_design::model::{Simulation, Spanned};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

use crate::overrides::Overrides;

/// A run with this number of samples takes minutes; one with more, hours.
pub(super) const MOST_SAMPLES: f64 = 2e8;

/// Rows of the table, unless asked otherwise.
const ROWS: f64 = 1000.0;

/// The instants of a run.
#[derive(Clone, Debug)]
pub(super) struct Timing {
    /// The sampling period in seconds.
    pub(super) step: f64,
    /// The number of intervals.
    pub(super) samples: u64,
    /// The period as a fraction, so that instants are rounded once.
    fraction: (f64, f64),
    /// Intervals between two rows, at least 1; not a whole number as a rule.
    stride: f64,
}

impl Timing {
    /// The instants that the section and the call ask for.
    pub(super) fn resolve(
        simulation: &Simulation,
        overrides: &Overrides,
        span: Span,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let duration = Setting::resolve("duration", simulation.duration.as_ref(), overrides.duration, span);
        let step = Setting::resolve("step", simulation.step.as_ref(), overrides.step, span);
        let every = overrides.every.map(|every| Setting::called("every", every)).transpose();
        let (duration, step, every) = (problems.keep(duration), problems.keep(step), problems.keep(every));
        let (duration, step, every) = (duration?, step?, every?);
        for (name, period) in [("step", Some(&step)), ("every", every.as_ref())] {
            let Some(period) = period else { continue };
            if (&duration.seconds - &period.seconds).is_negative() {
                let message = format!("{} is longer than the duration of {} s", period.named(name), duration.to_f64());
                problems.push(
                    Diagnostic::error(Code::NumberOutOfRange, period.span, message)
                        .help(format!("choose a shorter `{name}`, or a longer `duration`")),
                );
                return None;
            }
        }
        let intervals = duration.seconds.checked_div(&step.seconds)?.to_f64();
        if intervals > MOST_SAMPLES {
            let message = format!(
                "the simulation has {intervals:.3e} samples: {} is too short for a duration of {} s",
                step.named("step"),
                duration.to_f64()
            );
            problems.push(
                Diagnostic::error(Code::SimulationTooLong, step.span, message)
                    .help(format!("choose a longer step or a shorter duration: at most {MOST_SAMPLES:.0e} samples")),
            );
            return None;
        }
        // A last interval that is a rounding error of a division is none.
        let samples = (intervals - 1e-9).ceil().max(1.0);
        let stride = match every {
            Some(every) => every.seconds.checked_div(&step.seconds)?.to_f64(),
            None => intervals / ROWS,
        };
        let fraction = (step.seconds.numerator().to_f64(), step.seconds.denominator().to_f64());
        Some(Self { step: step.to_f64(), samples: whole(samples), fraction, stride: stride.max(1.0) })
    }

    /// The instant of a sample.
    pub(super) fn at(&self, sample: u64) -> f64 {
        real(sample) * self.fraction.0 / self.fraction.1
    }

    /// The sample of a row.
    pub(super) fn sample_of_row(&self, row: u64) -> u64 {
        whole((real(row) * self.stride).round())
    }

    /// The number of rows.
    pub(super) fn rows(&self) -> u64 {
        whole((real(self.samples) / self.stride + 1e-9).floor()) + 1
    }

    /// Two instants closer than this are the same.
    pub(super) fn slack(&self) -> f64 {
        1e-6 * self.step
    }
}

/// A time that the file or the call sets.
struct Setting {
    seconds: Rational,
    /// The span in the file; nowhere if the call sets it.
    span: Span,
}

impl Setting {
    /// The setting of the call, else that of the file.
    fn resolve(
        name: &str,
        written: Option<&Spanned<pebo_design::model::Decimal>>,
        called: Option<f64>,
        section: Span,
    ) -> Result<Self, Diagnostic> {
        match (called, written) {
            (Some(seconds), _) => Self::called(name, seconds),
            (None, Some(written)) => {
                let text = written.value.text();
                Self::positive(name, text, Rational::from_decimal(text).ok(), written.span)
            }
            (None, None) => {
                Err(Diagnostic::error(Code::SimulationIncomplete, section, format!("the simulation has no {name}"))
                    .help(format!("add `{name}:` in seconds under `simulation`")))
            }
        }
    }

    /// A setting of the call as the decimal that was meant.
    fn called(name: &str, seconds: f64) -> Result<Self, Diagnostic> {
        let exact = Rational::from_decimal(&format!("{seconds:e}")).ok();
        Self::positive(name, &seconds.to_string(), exact, Span::NOWHERE)
    }

    fn positive(name: &str, text: &str, seconds: Option<Rational>, span: Span) -> Result<Self, Diagnostic> {
        if let Some(seconds) = seconds.filter(|seconds| seconds.signum() > 0) {
            return Ok(Self { seconds, span });
        }
        let whose = if span == Span::NOWHERE { " of the call" } else { "" };
        let message = format!("`{name}`{whose} is {text}, but must be positive");
        Err(Diagnostic::error(Code::NumberOutOfRange, span, message)
            .help("give a number of seconds above zero, as 1e-5"))
    }

    /// The setting as messages call it.
    fn named(&self, name: &str) -> String {
        let whose = if self.span == Span::NOWHERE { " of the call" } else { "" };
        let seconds = self.to_f64();
        // Without exponent, numbers far from 1 are rows of zeros.
        let shown = if (1e-4..1e6).contains(&seconds) { seconds.to_string() } else { format!("{seconds:e}") };
        format!("`{name}`{whose}, {shown} s,")
    }

    fn to_f64(&self) -> f64 {
        self.seconds.to_f64()
    }
}

#[expect(clippy::cast_precision_loss, reason = "samples are fewer than 2^53")]
pub(super) fn real(count: u64) -> f64 {
    count as f64
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts are positive and far below 2^53")]
pub(super) fn whole(count: f64) -> u64 {
    count as u64
}
