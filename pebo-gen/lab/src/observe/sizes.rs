//! What the simulator has room for. An observer has the size of its model; here it is padded to one of a few sizes, so
//! that they are compiled once.

use pebo_runtime::nalgebra::SVector;

/// The most states, outputs, inputs or unknowns.
pub(crate) const LARGEST: usize = 16;

/// Small plants have no more of anything than one of these.
pub(crate) const SMALL: [usize; 2] = [2, 4];

/// The most unknowns of DREM, to which fewer are padded.
pub(crate) const MOST_MIXED: usize = 6;

/// The longest window in samples: an observer copies it at every step.
pub(crate) const LONGEST: usize = 1024;

/// The values, and zeros up to the size.
pub(crate) fn pad<const N: usize>(values: &[f64]) -> SVector<f64, N> {
    padded(values, 0.0)
}

/// The values, and behind them as many of another as there is room for.
pub(crate) fn padded<const N: usize>(values: &[f64], other: f64) -> SVector<f64, N> {
    let mut vector = SVector::<f64, N>::repeat(other);
    vector.as_mut_slice()[..values.len()].copy_from_slice(values);
    vector
}

/// The vector in another size: with zeros behind it, or without what is behind.
pub(crate) fn resized<const N: usize, const M: usize>(vector: &SVector<f64, N>) -> SVector<f64, M> {
    pad(&vector.as_slice()[..N.min(M)])
}
