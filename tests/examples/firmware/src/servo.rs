//! A motor without a sensor of its position: three currents and voltages in, the position out.

use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Extension as _, Fault};

/// The motor that is observed.
#[pebo_macros::pebo_model("models/servo.yaml", scalar = f32)]
mod model {}

use model::{Parameters, Servo, Tuned, U, X, Y};

/// Three windings to two coordinates, with the same amplitude.
fn clarke([a, b, c]: [f32; 3]) -> [f32; 2] {
    const INV_SQRT_3: f32 = 0.577_350_3;
    [(2.0 * a - b - c) / 3.0, (b - c) * INV_SQRT_3]
}

/// The state of the current loop from period to period.
pub struct Position {
    observer: Tuned,
    magnet: f32,
}

impl Position {
    /// Before the first sample.
    ///
    /// # Errors
    /// None with the parameters of the model.
    pub fn new() -> Result<Self, Fault> {
        let parameters = Parameters::default();
        Ok(Self { observer: Servo::observer(&parameters)?, magnet: parameters.lambda_m })
    }

    /// The position modulo a turn of the field, from the currents now, the voltages of the period that ends now, and
    /// its length.
    ///
    /// # Errors
    /// The fault of a sample that is not finite.
    pub fn period(&mut self, currents: [f32; 3], voltages: [f32; 3], dt: f32) -> Result<f32, Fault> {
        let ([i1, i2], [v1, v2]) = (clarke(currents), clarke(voltages));
        let X { q } = self.observer.step(Y { i1, i2 }, U { v1, v2 }, dt)?;
        // Beyond the fluxes of three magnets an offset has grown into the extension.
        let chi = self.observer.extension().chi();
        if chi.dot(chi) > 9.0 * self.magnet * self.magnet {
            self.start_again()?;
        }
        Ok(q)
    }

    /// Starts again at the estimated fluxes, from which the unknown is 0.
    fn start_again(&mut self) -> Result<(), Fault> {
        let fluxes = self.observer.extension().coordinates(&self.observer.theta());
        self.observer.restart(fluxes, &SVector::zeros())
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::TAU;

    use super::*;

    const R: f32 = 8.875;
    const L: f32 = 40.03e-3;
    const POLE_PAIRS: f32 = 5.0;
    const MAGNET: f32 = 0.2086;

    /// Samples in a turn of the field.
    const TURN: u16 = 314;

    /// The largest error of the angle of the field in the last quarter of some turns at constant speed, with an offset
    /// of the first current's sensor, and how often the extension has started again.
    fn error(turns: u16, offset: f32) -> (f32, u32) {
        let mut position = Position::new().expect("the parameters of the model");
        let (dt, increment) = (1e-4, TAU / f32::from(TURN));
        let (mut largest, mut restarts) = (0.0_f32, 0);
        for (turn, k) in (0..turns).flat_map(|turn| (0..TURN).map(move |k| (turn, k))) {
            let angle = increment * f32::from(k);
            let middle = angle - 0.5 * increment;
            // One ampere across the field, and the voltage that drives it, held at its mean over the period.
            let current = [-angle.sin(), angle.cos()];
            let across = R + MAGNET * increment / dt;
            let along = -L * increment / dt;
            let voltage = [along * middle.cos() - across * middle.sin(), along * middle.sin() + across * middle.cos()];
            let phases = |[a, b]: [f32; 2]| {
                let half = 0.5 * 3.0_f32.sqrt() * b;
                [a, -0.5 * a + half, -0.5 * a - half]
            };
            let [a, b, c] = phases(current);
            let before = position.observer.extension().chi().norm();
            let q = position.period([a + offset, b, c], phases(voltage), dt).expect("a good sample");
            restarts += u32::from(position.observer.extension().chi().norm() < before - MAGNET);
            let difference = (POLE_PAIRS * q - angle).rem_euclid(TAU);
            if turn > turns / 4 * 3 {
                largest = largest.max(difference.min(TAU - difference));
            }
        }
        (largest, restarts)
    }

    /// A voltage that is held at its mean misses a fraction of 0.02^2/24 = 2e-5; the filter's lag dies out.
    #[test]
    fn the_position_is_found() {
        let (error, restarts) = error(32, 0.0);
        assert!(error < 1e-3 && restarts == 0, "{error} rad, {restarts}");
    }

    /// 0.05 A in one phase are 0.033 A in the plane, 0.3 V, and with a forgetting of 40/s a lag of 7 mWb, 0.04 rad; as
    /// much again for what the offset does to the equation itself.
    #[test]
    fn an_offset_makes_it_start_again() {
        let (error, restarts) = error(640, 0.05);
        assert!(error < 0.1 && (10..=20).contains(&restarts), "{error} rad, {restarts}");
    }
}
