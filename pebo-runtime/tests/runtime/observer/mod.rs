//! The whole observer: kinds of regression, sampling, re-basing, bounds, and random faults.

mod angle;
mod drift;
mod errors_in_variables;
mod expected;
mod feedthrough;
mod functions;
mod kinds;
mod late;
mod learning;
mod local;
pub(crate) mod rebasing;
mod sampling;
mod storm;
mod within;
