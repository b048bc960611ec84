//! The observer of the motor with currents and speed measured.

use pebo_runtime::Real;

use super::{Extension, Regression};
use crate::counted::motor::TUNING;

const R: f32 = 8.875;
const L: f32 = 40.03e-3;
const N_P: f32 = 5.0;
const F: f32 = 0.001;
const TAU: f32 = 0.02;
const INV_L: f32 = 1.0 / L;
const INV_J: f32 = 1.0 / 60e-6;
const INV_N_P: f32 = 1.0 / N_P;
const N_P_OVER_L: f32 = N_P * INV_L;
const N_P_OVER_J: f32 = N_P * INV_J;

/// The observer.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    y: [f32; 3],
    extension: Extension,
    regression: Regression<3>,
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        Self { sampled: false, y: [0.0; 3], extension: Extension::START, regression: Regression::START }
    }

    /// One sample: outputs at the end of an interval, the voltages during it, its length. None for a bad sample.
    pub fn step(&mut self, y: [f32; 3], u: [f32; 2], dt: f32) -> Option<f32> {
        let blemish = y[0] * 0.0 + y[1] * 0.0 + y[2] * 0.0 + u[0] * 0.0 + u[1] * 0.0 + dt * 0.0;
        if !(blemish == 0.0 && dt > 0.0) {
            return None;
        }
        let mut next = *self;
        if next.sampled {
            next.advance(y, u, dt);
        }
        next.sampled = true;
        next.y = y;
        if next.extension.blemish() + next.regression.blemish() != 0.0 {
            return None;
        }
        let z = next.regression.coordinates(&next.extension);
        let estimate = Real::atan2(z[1] - y[1] * L, z[0] - y[0] * L) * INV_N_P;
        if estimate * 0.0 != 0.0 {
            return None;
        }
        *self = next;
        Some(estimate)
    }

    fn advance(&mut self, y: [f32; 3], [v1, v2]: [f32; 2], dt: f32) {
        let before = self.y;
        let h = |[i1, i2, _]: [f32; 3]| [v1 - i1 * R, v2 - i2 * R];
        let (h_start, h_end) = (h(before), h(y));
        let [start, end] = self.extension.integrate(h_start, h_end, dt);

        let phi_0 = |[chi1, chi2]: [f32; 2], h: [f32; 2], [i1, i2, omega]: [f32; 3]| {
            let electrical = omega * N_P;
            [
                (h[0] + electrical * (chi2 - i2 * L)) * INV_L,
                (h[1] + electrical * (i1 * L - chi1)) * INV_L,
                ((i2 * chi1 - i1 * chi2) * N_P - (omega * F + TAU)) * INV_J,
            ]
        };
        let phi_1 = |[i1, i2, omega]: [f32; 3]| {
            let coupling = omega * N_P_OVER_L;
            [[0.0, coupling], [-coupling, 0.0], [i2 * N_P_OVER_J, -(i1 * N_P_OVER_J)]]
        };
        let (known_start, known_end) = (phi_0(start, h_start, before), phi_0(end, h_end, y));
        let (factor_start, factor_end) = (phi_1(before), phi_1(y));
        let regression = &mut self.regression;
        regression.use_sample_time(TUNING.alpha, dt);
        for row in 0..3 {
            let rate = (y[row] - before[row]) / dt;
            let known = [rate - known_start[row], rate - known_end[row]];
            regression.filter(row, known, [factor_start[row], factor_end[row]]);
        }
        regression.correct(TUNING.gains, dt);
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}
