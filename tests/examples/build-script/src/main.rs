//! The rate of a pendulum's momentum, by code that the build script wrote.

// Declares `pub mod pendulum`.
include!(concat!(env!("OUT_DIR"), "/pebo.rs"));

fn rate(angle: f64, torque: f64) -> f64 {
    let model = pendulum::Pendulum::new(&pendulum::Parameters::default());
    let [rate] = model.h(pendulum::Y { q: angle }, pendulum::U { tau: torque });
    rate
}

fn main() {
    println!("at rest under 2 Nm: {} Nm", rate(0.0, 2.0));
}

#[test]
fn the_rate_is_that_of_the_model() {
    assert_eq!(rate(0.0, 2.0).to_bits(), 2.0_f64.to_bits());
}
