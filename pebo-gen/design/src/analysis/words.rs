//! The words of verdicts and kinds: one for each case, the same in JSON, text and the header of emitted code.
//!
//! In: a case. Out: its word, for programs and people. A sentence around a word is its author's own. The other tables
//! of words are beside their enumerations, as readers of input need them too: [`Class::name`](super::Class::name),
//! [`Relation::sign`](pebo_cas::Relation::sign) and [`Code::name`](crate::source::Code::name).

use crate::plant::{Plant, TransformOrigin};

use super::advice::remark::Equilibrium;
use super::design::{
    AtEstimate, Excitation, Fundamental, Origin, Outcome, Regression, RegressionKind, UnusedReason, Verdict,
};

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
    /// The origin of a left inverse, in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Derived => "derived",
        }
    }
}

impl UnusedReason {
    /// The reason in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Nonlinear => "its equation was not found to be linear in the unknowns",
            Self::Hidden => "an unmeasured signal is in its equation",
            Self::NotMonotone => "its equation was not found to be monotone in one unknown",
            Self::Unproved => "with its equation the claims were not proved",
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
    /// Boundedness as a verdict, in a word; an undecided one is no open claim.
    pub fn word(self) -> &'static str {
        match self {
            Self::Bounded { .. } => Verdict::Proved.word(),
            Self::Grows => Verdict::Refuted.word(),
            Self::Undecided => "not shown",
        }
    }
}

impl Equilibrium {
    /// The existence of an equilibrium, as a verdict.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::At(_) => Verdict::Proved,
            Self::Nowhere(_) => Verdict::Refuted,
            Self::Undecided(_) => Verdict::Undecided,
        }
    }
}

impl Regression {
    /// The meaning of one at the estimate.
    pub fn meaning(&self) -> Option<&'static str> {
        Some(match self.at_estimate? {
            AtEstimate::Local => {
                "it holds to first order at the estimate, to which the extension is moved at each sample: that converges \
                 from a neighbourhood of the state, whose size no proof gives"
            }
            AtEstimate::Monotone => {
                "each equation is monotone in one unknown, with the slope at the estimate, to which the extension is moved \
                 at each sample: the gradient moves no estimate within the assumptions away from the state, however far"
            }
        })
    }

    /// The parameterisation in a word: over-parameterised too where functions of the author's own unknowns are among
    /// theta, monotone or local where theta enters linearly to first order alone.
    pub fn parameterisation(&self, plant: &Plant) -> &'static str {
        let is_lifted = matches!(plant.origin, TransformOrigin::Lifted { .. });
        match (self.at_estimate, self.is_linear(plant) && !is_lifted) {
            (Some(AtEstimate::Local), _) => "local",
            (Some(AtEstimate::Monotone), _) => "monotone",
            (None, true) => "linear",
            (None, false) => "over-parameterised",
        }
    }
}
