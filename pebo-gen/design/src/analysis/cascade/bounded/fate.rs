//! The verdict of each criterion on a block.

/// The behaviour of a block of the fundamental matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Fate {
    /// It dies out, no slower than some exponential.
    Fades,
    /// Bounded.
    Bounded,
    /// It grows without bound.
    Grows,
    /// Nothing.
    Open,
}
