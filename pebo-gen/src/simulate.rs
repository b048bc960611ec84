//! Runs of the closed loop of plant, controller and observer, and of the observer over recorded data.
//!
//! The public face of the crate `pebo-lab`.

pub use pebo_lab::{
    Certainty, Ensemble, Estimate, EstimateScore, Excitation, Failure, Faults, KnownNumbers, Numbers, OutsideDomain,
    Overrides, Quantiles, SETTLED, Scenario, Score, Spread, Summary, Trace, Value, recording as replay,
};

/// The figure of a run, as SVG.
pub mod figure {
    pub use pebo_lab::draw;
}
