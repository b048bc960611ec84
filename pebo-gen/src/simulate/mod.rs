//! The closed loop of plant, controller and observer, run.
//!
//! ```text
//! Model, Plant, Derivation -> Scenario -> run -> Trace -> CSV, figure
//! ```
//!
//! In: an accepted derivation, and the model's sections `observer` and `simulation`. Out: the course
//! of the loop, or a diagnostic where the sections do not say enough, or the fact that the run could
//! not go on. The observer is the runtime library's own, on a model that is interpreted. The plant, which may differ from
//! its model (`truth`), and the baselines that have equations are one ODE between two samples; baselines by name (`rival`)
//! are fed the samples that the observer is. Between plant and observers are sensors (`sensor`), whose samples may be
//! noisy, offset, rounded, late, at other instants or not there. No file is touched here and nothing printed.
//!
//! Holds: the same scenario gives the same trace, to the last bit.

mod advice;
mod asked;
mod certainty;
mod changed;
mod control;
mod curve;
mod derived;
mod ensemble;
mod equation;
mod estimator;
mod excitation;
mod expected;
mod explicit;
mod failure;
mod faults;
pub mod figure;
mod flow;
mod growth;
mod label;
mod layout;
mod noise;
mod observer;
mod overrides;
mod panel;
pub mod replay;
mod rival;
mod run;
mod scenario;
mod scope;
mod score;
mod sensor;
mod settings;
mod signal;
mod sizes;
mod stepping;
mod stiff;
mod summary;
mod switching;
mod timing;
mod trace;
mod truth;
mod uncertainty;
mod unit;
mod watched;
mod window;

#[cfg(test)]
mod tests;

pub use crate::tuning::{Known, Numbers, Value};
pub use certainty::Certainty;
pub use ensemble::{Ensemble, Quantiles, Spread};
pub use excitation::Excitation;
pub use failure::Failure;
pub use faults::Faults;
pub use overrides::Overrides;
pub use scenario::Scenario;
pub use score::{SETTLED, Score};
pub use summary::{Estimate, Rated, Summary};
pub use trace::Trace;
