//! The laboratory: settings of an observer, its closed loop with plant and controller, its runs over recordings.
//!
//! ```text
//! Model, Plant, Derivation -> Scenario -> run -> Trace -> CSV, figure
//! ```
//!
//! In: an accepted derivation, and the model's sections `observer` and `simulation`. Out: the course of the loop, or
//! diagnostics of incomplete sections, or the reason why the run stopped early. The observer is the runtime library's
//! own, on a model that is interpreted. The plant, which may differ from its model (`truth`), and the baselines that have
//! equations are one ODE between two samples; baselines by name (`baseline`) are fed the samples that the observer is.
//! Between plant and observers are sensors (`sensor`), whose samples may be noisy, offset, rounded, late, at other
//! instants or not there. No file is touched here and nothing printed.
//!
//! Holds: the same scenario gives the same trace, to the last bit.

#[cfg(feature = "simulate")]
mod closed_loop;
#[cfg(feature = "simulate")]
mod experiment;
#[cfg(feature = "simulate")]
mod figure;
#[cfg(feature = "simulate")]
mod observe;
#[cfg(feature = "simulate")]
mod overrides;
#[cfg(feature = "simulate")]
pub mod recording;
#[cfg(feature = "simulate")]
mod score;
pub mod settings;
#[cfg(feature = "simulate")]
mod summary;
#[cfg(feature = "simulate")]
mod timing;

#[cfg(all(test, feature = "simulate"))]
mod tests;

#[cfg(feature = "simulate")]
pub use crate::settings::{KnownNumbers, Numbers, Value};
#[cfg(feature = "simulate")]
pub use closed_loop::ensemble::{Ensemble, Quantiles, Spread};
#[cfg(feature = "simulate")]
pub use closed_loop::failure::Failure;
#[cfg(feature = "simulate")]
pub use closed_loop::scenario::Scenario;
#[cfg(feature = "simulate")]
pub use closed_loop::sheet::draw;
#[cfg(feature = "simulate")]
pub use closed_loop::trace::Trace;
#[cfg(feature = "simulate")]
pub use observe::certainty::Certainty;
#[cfg(feature = "simulate")]
pub use observe::excitation::Excitation;
#[cfg(feature = "simulate")]
pub use overrides::Overrides;
#[cfg(feature = "simulate")]
pub use score::domain::OutsideDomain;
#[cfg(feature = "simulate")]
pub use score::faults::Faults;
#[cfg(feature = "simulate")]
pub use score::{SETTLED, Score};
#[cfg(feature = "simulate")]
pub use summary::{Estimate, EstimateScore, Summary};
