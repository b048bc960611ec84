//! Exact algebra: expressions, their normal form, and decisions about them.
//!
//! Knows neither plants nor spans. An [`Arena`] owns expressions; [`Expr`] is a copyable handle.

pub mod budget;
pub mod domain;
pub mod forms;
pub mod graph;
pub mod linear;
pub mod number;
pub mod poly;
pub mod print;
pub mod solve;
pub mod tower;

pub use budget::Budget;
pub use domain::Domain;
pub use graph::arena::Arena;
pub use graph::expr::{Expr, Node, Product, Sum, Symbol};
pub use graph::facts::{Facts, Relation};
pub use graph::function::Function;
pub use number::integer::Integer;
pub use number::rational::Rational;
