//! The motor with currents and speed measured. The cost of a step does not depend on the values of the sensors: the
//! signals are of the right size and no trajectory of the plant.

use pebo_runtime::Fault;
use pebo_runtime::nalgebra::SVector;

use super::{Plant, Settings, waves};
use crate::by_hand::motor::ByHand;
use crate::emitted::motor::{Motor as Model, Observer, Parameters, U, X, Y};

/// Seconds between two samples.
const DT: f32 = 1e-4;

/// The settings of both observers.
pub const SETTINGS: Settings = Settings { gains: [2e-5, 1e-5], alpha: 500.0 };

/// Currents and speed, then the voltages of the interval before.
pub type Sample = ([f32; 3], [f32; 2]);

/// The motor.
pub struct Motor;

impl Plant for Motor {
    const NAME: &'static str = "motor";
    type Sample = Sample;
    type Estimate = [f32; 1];
    type Emitted = Observer;
    type ByHand = ByHand;

    fn observers() -> Result<(Observer, ByHand), Fault> {
        let model = Model::new(&Parameters::default());
        let (gradient, filter) = SETTINGS.parts()?;
        Ok((Observer::new(model, gradient, filter, SVector::zeros())?, ByHand::new()))
    }

    fn samples() -> impl Iterator<Item = Sample> {
        waves().map(|(sine, cosine)| ([2.0 * cosine, 2.0 * sine, 10.0 + sine], [10.0 * cosine, 10.0 * sine]))
    }

    #[inline]
    fn emitted(observer: &mut Observer, &([i1, i2, omega], [v1, v2]): &Sample) -> Option<[f32; 1]> {
        observer.step(Y { i1, i2, omega }, U { v1, v2 }, DT).map(|X { q }| [q]).ok()
    }

    #[inline]
    fn by_hand(observer: &mut ByHand, (y, u): &Sample) -> Option<[f32; 1]> {
        observer.step(*y, *u, DT).map(|q| [q])
    }
}
