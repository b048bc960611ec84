//! The closed loop of plant, controller and observer, and the observer over recorded data, run.
//!
//! What users of the library call of the crate `pebo-lab`.

pub use pebo_lab::{
    Certainty, Ensemble, Estimate, Excitation, Failure, Faults, Known, Numbers, Overrides, Quantiles, Rated, SETTLED,
    Scenario, Score, Spread, Summary, Trace, Value, figure, recording as replay,
};
