//! Common code of the programs for the host.

use std::print;

use pebo_runtime::Fault;

use crate::counted::{Plant, WARM_UP, compare, emitted_round, hand_round, samples};
use crate::report::Report;

/// Writes results as the board does.
pub struct Words;

impl Report for Words {
    fn write(&mut self, text: &str) {
        print!("{text}");
    }
}

/// Compares both observers of a plant, or runs the rounds of the one that the call names.
///
/// # Errors
/// A fault where none should be.
pub fn count<P: Plant>() -> Result<(), Fault> {
    let which = std::env::args().nth(1);
    if which.is_none() {
        return compare::<P>(&mut Words);
    }
    let samples = std::hint::black_box(samples::<P>());
    let (mut emitted, mut hand) = P::observers()?;
    for _ in 0..=WARM_UP {
        let good = match which.as_deref() {
            Some("emitted") => emitted_round::<P>(&mut emitted, &samples),
            _ => hand_round::<P>(&mut hand, &samples),
        };
        assert!(good, "a step of the round was refused");
    }
    Ok(())
}
