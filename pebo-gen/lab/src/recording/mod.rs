//! Runs the observer over recorded data.
//!
//! ```text
//! Model, Plant, Derivation, Log -> Replay -> run -> Replayed, CSV, figure
//! ```
//!
//! In: an accepted derivation, the model's sections `observer` and `recording`, and a table of samples of any length.
//! Out: the estimates of x row by row, their errors where states were measured besides, the residuals of the outputs,
//! and the faults of rows. The loop is that of a simulation; here its samples are those of the log.
//!
//! Holds: memory does not grow with the recording; the same rows give the same estimates, to the last bit.

mod alignment;
mod clock;
mod failure;
mod fault;
mod fit;
mod log;
mod moment;
mod piece;
mod replayed;
mod residual;
mod run;
mod scene;
mod signals;
mod stream;

#[cfg(test)]
mod tests;

pub use failure::Failure;
pub use fault::FaultCount;
pub use fit::{FittedNumbers, fit};
pub use log::{Log, Malformed, Unreadable};
pub use replayed::{OutputResidual, Replayed};
pub use scene::Replay;
