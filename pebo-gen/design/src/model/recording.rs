//! The section `recording`: the meaning of the columns of recorded data.

use super::formula::Formula;
use super::section::{Names, Row, Value};
use super::spanned::Entry;
#[cfg(feature = "yaml")]
use super::yaml::{Key, Shape};
use crate::source::Span;

/// Formulas over the columns of a recording and the parameters. A signal that has none is the column of its own name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The time of a row, in seconds; excludes the next.
    pub t: Option<Entry<Formula>>,
    /// The period of rows that are equally far apart, in parameters.
    pub step: Option<Entry<Formula>>,
    /// Outputs, inputs, and states that were measured besides.
    pub signals: Vec<Entry<Formula>>,
}

impl Recording {
    /// The name of the instants.
    pub const T: &str = "t";

    /// The name of the period.
    pub const STEP: &str = "step";

    /// The keys besides signals.
    #[cfg(feature = "yaml")]
    pub(super) const KEYS: &'static [Key] = &[
        Key::new(Self::T, Shape::Formula, "t: time/1000", "When each row was recorded, in seconds"),
        Key::new(
            Self::STEP,
            Shape::Formula,
            "step: 1e-5",
            "The time from row to row in seconds, in parameters, where the rows have no time",
        ),
    ];

    /// The section with these entries, in any order.
    #[cfg(feature = "yaml")]
    pub(super) fn of(entries: Vec<Entry<Formula>>) -> Self {
        let mut recording = Self::default();
        for entry in entries {
            match entry.name.value.as_str() {
                Self::T => recording.t = Some(entry),
                Self::STEP => recording.step = Some(entry),
                _ => recording.signals.push(entry),
            }
        }
        recording
    }

    /// The formula of a signal.
    pub fn of_signal(&self, name: &str) -> Option<&Entry<Formula>> {
        self.signals.iter().find(|entry| entry.name.value == name)
    }

    /// All entries.
    pub fn entries(&self) -> impl Iterator<Item = &Entry<Formula>> {
        self.t.iter().chain(&self.step).chain(&self.signals)
    }

    /// Its first entry.
    pub fn span(&self) -> Option<Span> {
        self.entries().map(|entry| entry.name.span).min()
    }
}

impl Value for Recording {
    fn rows(&self) -> Vec<Row<'_>> {
        vec![Row::new("recording", &self.signals).of(Names::Signal)]
    }
}
