//! The words of verdicts and kinds: one for each case, the same in JSON, text and the header of emitted code.
//!
//! In: a case. Out: its word, which programs compare and people read. A sentence around a word is its author's own.
//! The other tables of words stand beside their enumerations, as readers of input need them too:
//! [`Class::name`](super::Class::name), [`Relation::sign`](pebo_cas::Relation::sign) and
//! [`Code::name`](crate::source::Code::name).

use crate::plant::Plant;

use super::advice::equilibrium::Equilibrium;
use super::design::{Excitation, Fundamental, Origin, Outcome, Regression, RegressionKind, Verdict};

impl Verdict {
    /// The verdict in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::Refuted => "refuted",
            Self::Undecided => "undecided",
            Self::Skipped => "skipped",
        }
    }
}

impl Outcome {
    /// The verdict on the model in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Rejected => "rejected",
            Self::Undecided => "undecided",
        }
    }
}

#[cfg(feature = "yaml")]
impl serde::Serialize for Outcome {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

impl Origin {
    /// Where a left inverse is from, in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Derived => "derived",
        }
    }
}

impl RegressionKind {
    /// The kind in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Dynamic => "dynamic",
            Self::Static => "static",
            Self::Implicit => "implicit",
        }
    }
}

impl Excitation {
    /// The kind in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Instant => "instant",
            Self::Excitation => "excitation",
            Self::Never => "never",
        }
    }
}

impl Fundamental {
    /// Whether it stays bounded, as the verdict on that; what was not shown is no claim that is left undecided.
    pub fn word(self) -> &'static str {
        match self {
            Self::Bounded { .. } => Verdict::Proved.word(),
            Self::Grows => Verdict::Refuted.word(),
            Self::NotShown => "not shown",
        }
    }
}

impl Equilibrium {
    /// Whether there is one.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::At(_) => Verdict::Proved,
            Self::Nowhere(_) => Verdict::Refuted,
            Self::Undecided(_) => Verdict::Undecided,
        }
    }
}

impl Regression {
    /// The parameterisation in a word.
    pub fn parameterisation(&self, plant: &Plant) -> &'static str {
        if self.is_linear(plant) { "linear" } else { "over-parameterised" }
    }
}
