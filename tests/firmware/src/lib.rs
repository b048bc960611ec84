//! Programs of board and host: emitted observers in `f32` on plants in `f32`, so that the two must agree to the last
//! bit.
#![no_std]

#[cfg(not(feature = "board"))]
extern crate std;

#[cfg(feature = "board")]
pub mod board;
pub mod by_hand;
pub mod converter;
pub mod counted;
#[cfg(not(feature = "board"))]
pub mod host;
pub mod motor;
pub mod report;

/// The emitted modules.
pub mod emitted {
    include!(concat!(env!("OUT_DIR"), "/emitted.rs"));
}
