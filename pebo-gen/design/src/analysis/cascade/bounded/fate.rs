//! What each criterion says of a block.

/// What is known of a part of the fundamental matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Fate {
    /// It dies out, no slower than some exponential.
    Fades,
    /// It stays bounded.
    Stays,
    /// It grows without bound.
    Grows,
    /// Nothing.
    Open,
}
