//! Exact algebra: expressions, their normal form, and the questions asked of them.
//!
//! Knows neither plants nor spans. An [`Arena`] owns expressions; [`Expr`] is a copyable handle.

pub(crate) mod analytic;
mod arena;
mod arranged;
mod as_sign;
pub mod asks;
pub(crate) mod bounds;
pub mod budget;
mod build;
mod cofactors;
pub(crate) mod combination;
pub(crate) mod contrast;
mod derivative;
pub(crate) mod determinant;
pub mod domain;
pub(crate) mod elimination;
pub(crate) mod enclosure;
mod expr;
mod extremes;
pub mod facts;
pub mod field;
pub(crate) mod frozen;
pub mod function;
mod hyperbolic;
mod implied;
pub mod integer;
pub mod interval;
pub(crate) mod jump;
pub(crate) mod letter;
mod lifting;
pub(crate) mod linear;
pub(crate) mod manifold;
pub(crate) mod mathml;
mod minors;
mod near_zero;
mod notation;
pub(crate) mod oriented;
pub(crate) mod pivots;
pub mod poly;
mod print;
pub(crate) mod rank;
pub mod rational;
mod rational_matrix;
pub(crate) mod reducible;
pub(crate) mod residues;
pub(crate) mod scaled;
mod shared;
pub(crate) mod solve;
pub(crate) mod tidy;
pub(crate) mod twice;
pub mod zero;

pub use arena::Arena;
pub use expr::{Expr, Node, Product, Sum, Symbol};
pub use function::Function;
