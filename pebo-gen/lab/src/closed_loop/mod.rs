//! The closed loop of plant, sensors, control law, observer and baselines.

pub(crate) mod baseline;
mod control;
pub(crate) mod ensemble;
mod estimator;
pub(crate) mod failure;
mod growth;
mod noise;
pub(crate) mod ode;
mod panels;
mod run;
pub(crate) mod scenario;
pub(crate) mod scope;
mod sensor;
pub(crate) mod sheet;
pub(crate) mod signal;
pub(crate) mod simulated;
pub(crate) mod trace;
mod truth;
