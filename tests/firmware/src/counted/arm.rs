//! The two-link arm. As for the motor, the signals are of the right size and no trajectory of the plant.

use pebo_runtime::Fault;
use pebo_runtime::nalgebra::SVector;

use super::{Plant, Settings, waves};
use crate::by_hand::arm::ByHand;
use crate::emitted::arm::{Arm as Model, Observer, Parameters, U, X, Y};

/// Seconds between two samples.
const DT: f32 = 1e-3;

/// The settings of both observers.
pub const SETTINGS: Settings = Settings { gains: [1.0, 2.0], alpha: 50.0 };

/// Angles, then the torques of the interval before.
pub type Sample = ([f32; 2], [f32; 2]);

/// The arm.
pub struct Arm;

impl Plant for Arm {
    const NAME: &'static str = "arm";
    type Sample = Sample;
    type Estimate = [f32; 2];
    type Emitted = Observer;
    type ByHand = ByHand;

    fn observers() -> Result<(Observer, ByHand), Fault> {
        let model = Model::new(&Parameters::default());
        let (gradient, filter) = SETTINGS.parts()?;
        Ok((Observer::new(model, gradient, filter, SVector::zeros())?, ByHand::new()))
    }

    fn samples() -> impl Iterator<Item = Sample> {
        waves().map(|(sine, cosine)| ([sine, 1.2 + 0.3 * cosine], [2.0 * cosine, sine]))
    }

    #[inline]
    fn emitted(observer: &mut Observer, &([y1, y2], [u1, u2]): &Sample) -> Option<[f32; 2]> {
        observer.step(Y { y1, y2 }, U { u1, u2 }, DT).map(|X { x1, x2 }| [x1, x2]).ok()
    }

    #[inline]
    fn by_hand(observer: &mut ByHand, (y, u): &Sample) -> Option<[f32; 2]> {
        observer.step(*y, *u, DT)
    }
}
