//! Exact numbers, and rigorous enclosures of real ones.

pub mod integer;
pub mod interval;
pub(crate) mod notation;
pub mod rational;
