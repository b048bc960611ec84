//! The observer over recorded data.
//!
//! ```text
//! Model, Plant, Derivation, Log -> Replay -> run -> Replayed, CSV, figure
//! ```
//!
//! In: an accepted derivation, the model's sections `observer` and `recording`, and a table of samples of any length. Out:
//! the estimates of x row by row, how far they are from states that were measured besides, what of the outputs the model
//! does not explain, and what was wrong with rows. What runs is what [`simulate`](super) runs, without the plant.
//!
//! Holds: memory does not grow with the recording; the same rows give the same estimates, to the last bit.

mod clock;
mod failure;
mod fault;
mod layout;
mod log;
mod panels;
mod replayed;
mod residual;
mod run;
mod scene;
mod signals;

#[cfg(test)]
mod tests;

pub use failure::Failure;
pub use fault::FaultCount;
pub use log::{Log, Malformed, Unreadable};
pub use replayed::{OutputResidual, Replayed};
pub use scene::Replay;
