//! Ways to predict an observer's errors from the known numbers.

use super::kind::ObserverKind;

/// The way to predict the standard errors of estimates from the known numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Prediction {
    /// The covariance of least squares is that of the unknown.
    Covariance,
    /// With a noise model besides: the noise of a sample is not only in its row of the regression.
    Noise(Noise),
    /// No prediction, with the reason.
    None(&'static str),
}

/// The noise that an observer meets.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    /// The standard deviation of the samples of each output.
    pub sensors: Vec<f64>,
    /// The drift of each unknown, as a variance per second.
    pub drift: Vec<f64>,
}

impl Prediction {
    /// The prediction for a kind of observer: `is_elsewhere` if noise is not only in its row, `can_rebase` if the
    /// extension follows the estimate.
    pub(super) fn of(kind: ObserverKind, is_elsewhere: bool, can_rebase: bool, noise: Noise) -> Self {
        match kind {
            ObserverKind::Filtered => Self::None(FILTERED),
            _ if !is_elsewhere => Self::Covariance,
            _ if can_rebase => Self::Noise(noise),
            _ => Self::None(ACCUMULATES),
        }
    }
}

/// The reason for a gradient.
pub(super) const UNWEIGHED: &str = "a gradient keeps no covariance";

/// The reason for a regression through a filter.
const FILTERED: &str = "the filter makes the noise of one sample that of all later ones too";

/// The reason for unknowns that are functions of theta.
const ACCUMULATES: &str = "the noise of the outputs adds up in the extension, and the unknowns, which are functions of theta, do not follow it";
