//! Numerical kernels: the scalar's functions, compensated sums, products of small matrices, small linear systems,
//! functions between points.

pub(crate) mod decay;
pub(crate) mod dense;
mod double;
pub(crate) mod eigenvalue;
pub(crate) mod exponential;
pub(crate) mod linear;
mod real;
mod single;
pub(crate) mod sum;
mod table;

pub use real::Real;
pub use sum::Sum;
pub use table::Table;
