//! The rate of a pendulum's momentum, by code that the build script wrote.

use pebo_runtime::Model as _;
use pebo_runtime::nalgebra::SVector;

// Declares `pub mod pendulum`.
include!(concat!(env!("OUT_DIR"), "/pebo.rs"));

fn rate(angle: f64, torque: f64) -> f64 {
    let model = pendulum::Pendulum::new(&pendulum::Parameters::default());
    model.h(&SVector::from([angle]), &SVector::from([torque]))[0]
}

fn main() {
    println!("at rest under 2 Nm: {} Nm", rate(0.0, 2.0));
}

#[test]
fn the_rate_is_that_of_the_model() {
    assert_eq!(rate(0.0, 2.0).to_bits(), 2.0_f64.to_bits());
}
