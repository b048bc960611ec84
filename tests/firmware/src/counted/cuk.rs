//! The Cuk converter, case II, as it runs.

use pebo_runtime::Fault;

use super::Plant;
use crate::by_hand::cuk::ByHand;
use crate::converter::{Circuit, DT, counted};
use crate::emitted::cuk_case2::{Observer, U, X, Y};

/// Capacitor voltage and inductor current, then the duty cycle of the interval before.
pub type Sample = ([f32; 2], f32);

/// The converter.
pub struct Cuk;

impl Plant for Cuk {
    const NAME: &'static str = "cuk";
    type Sample = Sample;
    type Estimate = [f32; 2];
    type Emitted = Observer;
    type ByHand = ByHand;

    fn observers() -> Result<(Observer, ByHand), Fault> {
        Ok((counted()?, ByHand::new()))
    }

    fn samples() -> impl Iterator<Item = Sample> {
        let (mut circuit, mut duty) = (Circuit::new(), 0.5);
        core::iter::repeat_with(move || {
            let sample = (circuit.outputs().into(), duty);
            duty = circuit.duty();
            circuit.advance();
            sample
        })
    }

    #[inline]
    fn emitted(observer: &mut Observer, &([v2, i3], d): &Sample) -> Option<[f32; 2]> {
        observer.step(Y { v2, i3 }, U { d }, DT).map(|X { i1, v4 }| [i1, v4]).ok()
    }

    #[inline]
    fn by_hand(observer: &mut ByHand, (y, d): &Sample) -> Option<[f32; 2]> {
        observer.step(*y, *d, DT)
    }
}
