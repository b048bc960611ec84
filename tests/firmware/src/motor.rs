//! The position of a permanent magnet motor at constant speed.

use core::f32::consts::PI;

use pebo_runtime::nalgebra::Vector2;
use pebo_runtime::{Fault, Filter, Hold, LeastSquares, Real};

use crate::emitted::pmsm::{self, Observer, Parameters, Pmsm, U};
use crate::report::Report;

const DT: f32 = 1e-4;
/// Mechanical speed in rad/s.
const SPEED: f32 = 40.0;
/// Amplitude of the currents in A.
const CURRENT: f32 = 2.0;

/// Runs 4000 samples and reports the position.
///
/// # Errors
/// A fault where none should be.
pub fn run(report: &mut impl Report) -> Result<(), Fault> {
    report.name("motor");
    let parameters = Parameters::default();
    let Parameters { r, l, n_p, lambda_m } = parameters;
    // Position, currents in phase with the induced voltage, and the voltage that goes with both.
    let position = |t: f32| Real::atan2(Real::sin(SPEED * n_p * t), Real::cos(SPEED * n_p * t)) / n_p;
    let turned = |angle: f32| Vector2::new(-Real::sin(angle), Real::cos(angle));
    let voltage = |t: f32| {
        let angle = SPEED * n_p * t;
        let along = Vector2::new(Real::cos(angle), Real::sin(angle));
        let rate = SPEED * n_p;
        turned(angle) * (CURRENT * r + lambda_m * rate) - along * (CURRENT * l * rate)
    };
    let squares = LeastSquares::diagonal(&Vector2::repeat(100.0), 20.0)?;
    let filter = Filter::new(200.0, Hold::First)?;
    let mut observer: Observer<_> = Observer::new(Pmsm::new(&parameters), squares, filter, Vector2::new(0.1, 0.0))?;
    for k in 0..4000_u16 {
        let now = f32::from(k) * DT;
        // Held at its mean over the interval behind, which is that of its middle.
        let u = voltage(now - DT / 2.0);
        let i = turned(SPEED * n_p * now) * CURRENT;
        let pmsm::X { q } = observer.step(i, U { v1: u.x, v2: u.y, w: SPEED }, DT)?;
        if k % 800 == 799 {
            // The error modulo the period of the position.
            let turns = (q - position(now)) * n_p / (2.0 * PI);
            // Adding and taking away 1.5 * 2^23 rounds to an integer.
            let whole = (turns + 12_582_912.0) - 12_582_912.0;
            let error = (turns - whole) * 2.0 * PI / n_p;
            report.estimate(&Vector2::new(q, error), &Vector2::new(q, 0.0));
            // A voltage held at its mean misses (200/s * DT)^2/24 = 1.7e-5 of the flux, a fifth of that in position; as
            // much again for rounding.
            report.flag(Real::abs(error) < 1e-5);
        }
    }
    Ok(())
}
