//! Exact linear algebra: one type of matrices, one elimination, one routine for minors.
//!
//! `matrix` holds entries of any type; `elimination` is the loop of every elimination, `minors` makes determinants
//! without a division. Above them stand the questions: `fractions` for null spaces and solutions, `determinant`,
//! `rank`, `comparison` for combinations. Strategies for numbers are `rational_matrix` and `lifting`, for residues
//! `residues`, for enclosures `pivots`.

mod cofactors;
pub mod combination;
pub mod comparison;
pub mod contrast;
pub mod determinant;
mod echelon;
pub(crate) mod elimination;
mod expressions;
mod fractions;
mod lifting;
pub mod matrix;
mod minors;
pub mod pivots;
pub mod rank;
pub(crate) mod rational_matrix;
pub mod residues;

pub use echelon::Echelon;
pub use fractions::{null_space_of_numbers, solve, solve_each};
pub use matrix::Matrix;
