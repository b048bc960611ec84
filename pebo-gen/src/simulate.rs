//! Runs of the closed loop of plant, controller and observer, and of the observer over recorded data.
//!
//! The public face of the crate `pebo-lab`.

pub use pebo_lab::{
    Certainty, Ensemble, Estimate, Excitation, Failure, Faults, Known, Numbers, Overrides, Quantiles, Rated, SETTLED,
    Scenario, Score, Spread, Summary, Trace, Value, figure, recording as replay,
};
