//! What board and host both run: emitted observers in `f32` on plants in `f32`, so that the two must agree to the last
//! bit.
#![no_std]

pub mod by_hand;
pub mod converter;
pub mod motor;
pub mod report;
pub mod steps;

/// The emitted modules.
pub mod emitted {
    include!(concat!(env!("OUT_DIR"), "/emitted.rs"));
}
