//! Numerical kernels: the scalar's functions, compensated sums, small linear systems.

pub(crate) mod decay;
mod double;
pub(crate) mod eigenvalue;
pub(crate) mod exponential;
pub(crate) mod linear;
mod real;
mod single;
pub(crate) mod sum;

pub use real::Real;
pub use sum::Sum;
