//! Equal forms of an expression, for people and for code.

mod as_sign;
mod hyperbolic;
mod near_zero;
pub(crate) mod number_powers;
pub mod opaque;
pub mod oriented;
pub mod scaled;
pub(crate) mod shared_sums;
pub mod tidy;
