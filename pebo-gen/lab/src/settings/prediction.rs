//! How far the errors of an observer follow from the numbers that are known.

use super::kind::ObserverKind;

/// How the standard errors of estimates follow from the numbers that are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Prediction {
    /// The covariance of least squares is that of the unknown.
    Covariance,
    /// Not that alone: the noise of a sample is elsewhere than in its row of the regression too.
    Noise(Noise),
    /// Not at all, and why.
    None(&'static str),
}

/// Noise that an observer has to do with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    /// The standard deviation of the samples of each output.
    pub sensors: Vec<f64>,
    /// What each unknown drifts by besides, as a variance per second.
    pub drift: Vec<f64>,
}

impl Prediction {
    /// That of an observer, with whether noise is heard elsewhere than in its row, whether the extension follows the
    /// estimate, and the noise.
    pub(super) fn of(kind: ObserverKind, is_elsewhere: bool, can_rebase: bool, noise: Noise) -> Self {
        match kind {
            ObserverKind::Filtered => Self::None(FILTERED),
            _ if !is_elsewhere => Self::Covariance,
            _ if can_rebase => Self::Noise(noise),
            _ => Self::None(ACCUMULATES),
        }
    }
}

/// Why nothing is predicted of what went through a filter.
const FILTERED: &str = "the filter makes the noise of one sample that of all later ones too";

/// Why nothing is predicted of unknowns that are functions of theta.
const ACCUMULATES: &str = "the noise of the outputs adds up in the extension, and the unknowns, which are functions of theta, do not follow it";
