//! Advice beside the claims: no verdict depends on it.
//!
//! In: a plant and its derivation. Out: an operating point, the integrators that a bias makes grow with a remedy, and
//! whether the observer may be re-based; each computed on first use.

mod drift;
mod equilibrium;
pub(super) mod remark;
mod remarks;
