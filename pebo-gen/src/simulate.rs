//! The closed loop of plant, controller and observer, and the observer over recorded data, run.
//!
//! What users of the library call of the crate `pebo-lab`.

pub use pebo_lab::{
    Certainty, Ensemble, Estimate, EstimateScore, Excitation, Failure, Faults, KnownNumbers, Numbers, Overrides,
    Quantiles, SETTLED, Scenario, Score, Spread, Summary, Trace, Value, recording as replay,
};

/// The figure of a run, as SVG.
pub mod figure {
    pub use pebo_lab::draw;
}
