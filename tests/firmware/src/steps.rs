//! The steps that are counted, each a function of its own so that counters and size figures find it.

use pebo_runtime::Fault;

use crate::by_hand::ByHand;
use crate::converter::{Circuit, DT, counted};
use crate::emitted::cuk_case2::{Observer, U, X, Y};

/// Samples in a round of counting.
pub const ROUND: usize = 64;

/// Samples of the converter: outputs and duty cycle.
pub type Samples = [([f32; 2], f32); ROUND];

/// The first samples of the converter.
pub fn samples() -> Samples {
    let mut circuit = Circuit::new();
    core::array::from_fn(|_| {
        let sample = (circuit.outputs().into(), circuit.duty());
        circuit.advance();
        sample
    })
}

/// One step of the emitted observer.
#[inline(never)]
pub fn emitted_step(observer: &mut Observer, &[v2, i3]: &[f32; 2], d: f32) -> Result<X, Fault> {
    observer.step(Y { v2, i3 }, U { d }, DT)
}

/// One step of the observer written by hand.
#[inline(never)]
pub fn hand_step(observer: &mut ByHand, y: &[f32; 2], d: f32) -> Option<[f32; 2]> {
    observer.step(*y, d, DT)
}

/// Rounds before the one that counts: the first step of all sets the clock, the second computes the filter's weights.
pub const WARM_UP: usize = 1;

/// A round of the emitted observer's steps.
#[inline(never)]
pub fn emitted_round(observer: &mut Observer, samples: &Samples) -> bool {
    samples.iter().all(|(y, d)| emitted_step(observer, y, *d).is_ok())
}

/// A round of steps by hand.
#[inline(never)]
pub fn hand_round(observer: &mut ByHand, samples: &Samples) -> bool {
    samples.iter().all(|(y, d)| hand_step(observer, y, *d).is_some())
}

/// Whether both give the same estimates to the last bit.
///
/// # Errors
/// A fault where none should be.
pub fn agree() -> Result<bool, Fault> {
    let (mut emitted, mut hand) = (counted()?, ByHand::new());
    let mut circuit = Circuit::new();
    let mut same = true;
    let mut duty = 0.5;
    for _ in 0..2000_u32 {
        let y: [f32; 2] = circuit.outputs().into();
        let X { i1, v4 } = emitted_step(&mut emitted, &y, duty)?;
        same &= hand_step(&mut hand, &y, duty)
            .is_some_and(|by_hand| by_hand.map(f32::to_bits) == [i1, v4].map(f32::to_bits));
        duty = circuit.duty();
        circuit.advance();
    }
    Ok(same)
}
