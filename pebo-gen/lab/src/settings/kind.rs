//! What the observer of known numbers is.

/// What the observer of known numbers is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ObserverKind {
    /// The outputs themselves as the regressand.
    Output,
    /// A static regression, sample by sample.
    Sampled,
    /// Rates through a filter.
    Filtered,
}
