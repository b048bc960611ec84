//! What is good to know beside the claims: no verdict rests on it.
//!
//! In: a plant and what was derived of it. Out: an operating point, which integrators a bias makes grow and what helps,
//! whether the observer may be re-based; each computed when it is first asked for.

pub(super) mod drift;
pub(super) mod equilibrium;
pub(super) mod remarks;
