//! The closed loop of plant, controller and observer, run.
//!
//! ```text
//! Model, Plant, Derivation -> Scenario -> run -> Trace -> CSV, figure
//! ```
//!
//! In: an accepted derivation, and the model's sections `observer` and `simulation`. Out: the course
//! of the loop, or a diagnostic where the sections do not say enough, or the fact that the run could
//! not go on. The observer is the runtime library's own, on a model that is interpreted; the plant
//! and the baselines are one ODE between two samples. No file is touched here and nothing printed.
//!
//! Holds: the same scenario gives the same trace, to the last bit.

mod control;
mod curve;
mod derived;
mod estimator;
mod failure;
pub mod figure;
mod flow;
mod label;
mod layout;
mod observer;
mod panel;
mod rival;
mod run;
mod scenario;
mod scope;
mod settings;
mod signal;
mod timing;
mod trace;
mod window;

#[cfg(test)]
mod tests;

pub use failure::Failure;
pub use scenario::{Overrides, Scenario};
pub use trace::Trace;
