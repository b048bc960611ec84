//! The kinds of observers of known numbers.

/// The kind of an observer of known numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ObserverKind {
    /// The outputs themselves as the regressand.
    Output,
    /// A static regression, sample by sample.
    Sampled,
    /// Rates through a filter.
    Filtered,
}
