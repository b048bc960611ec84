//! The sizes of the simulator. An observer has the size of its model; here it is padded to one of a few sizes, so that
//! they are compiled once.

use pebo_runtime::nalgebra::SVector;

/// The most states, outputs, inputs or unknowns.
pub(crate) const LARGEST: usize = 16;

/// The sizes for small plants.
pub(crate) const SMALL: [usize; 2] = [2, 4];

/// The most unknowns of DREM, to which fewer are padded.
pub(crate) const MOST_MIXED: usize = 6;

/// The longest window in samples: an observer copies it at every step.
pub(crate) const LONGEST: usize = 1024;

/// The values, padded with zeros.
pub(crate) fn pad<const N: usize>(values: &[f64]) -> SVector<f64, N> {
    padded(values, 0.0)
}

/// The values, padded with another value.
pub(crate) fn padded<const N: usize>(values: &[f64], other: f64) -> SVector<f64, N> {
    let mut vector = SVector::<f64, N>::repeat(other);
    vector.as_mut_slice()[..values.len()].copy_from_slice(values);
    vector
}

/// The vector in another size: padded with zeros, or truncated.
pub(crate) fn resized<const N: usize, const M: usize>(vector: &SVector<f64, N>) -> SVector<f64, M> {
    pad(&vector.as_slice()[..N.min(M)])
}
