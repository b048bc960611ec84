//! The observer of the motor with currents and speed measured. What it needs of a sample is kept for the interval that
//! begins there.

use pebo_runtime::Real;

use super::{Extension, Regression};
use crate::counted::motor::SETTINGS;

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
const L_N_P: f32 = L * N_P;
const F_OVER_J: f32 = F * INV_J;
const TAU_OVER_J: f32 = TAU * INV_J;

/// A sample of currents and speed, with what depends on it alone.
#[derive(Clone, Copy)]
struct Sample {
    y: [f32; 3],
    /// The voltages that the resistance and the turning coils take.
    taken: [f32; 2],
    /// The deceleration by friction and load.
    braked: f32,
}

impl Sample {
    const NONE: Self = Self { y: [0.0; 3], taken: [0.0; 2], braked: 0.0 };

    fn new(y: [f32; 3]) -> Self {
        let [i1, i2, omega] = y;
        let turning = omega * L_N_P;
        let taken = [i1 * R + turning * i2, turning * i1 - i2 * R];
        Self { y, taken, braked: omega * F_OVER_J + TAU_OVER_J }
    }

    fn h(&self, [v1, v2]: [f32; 2]) -> [f32; 2] {
        [v1 - self.y[0] * R, v2 - self.y[1] * R]
    }

    fn phi_1(&self) -> [[f32; 2]; 3] {
        let [i1, i2, omega] = self.y;
        let coupling = omega * N_P_OVER_L;
        [[0.0, coupling], [-coupling, 0.0], [i2 * N_P_OVER_J, -(i1 * N_P_OVER_J)]]
    }

    fn phi_0(&self, [chi1, chi2]: [f32; 2], [v1, v2]: [f32; 2]) -> [f32; 3] {
        let [[_, coupling], _, [t2, minus_t3]] = self.phi_1();
        [
            chi2 * coupling + INV_L * (v1 - self.taken[0]),
            INV_L * (v2 + self.taken[1]) - chi1 * coupling,
            chi1 * t2 + chi2 * minus_t3 - self.braked,
        ]
    }
}

/// The observer.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    sample: Sample,
    extension: Extension,
    regression: Regression<3>,
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        Self { sampled: false, sample: Sample::NONE, extension: Extension::START, regression: Regression::START }
    }

    /// One sample: outputs at the end of an interval, the voltages during it, its length. None for a bad sample.
    pub fn step(&mut self, y: [f32; 3], u: [f32; 2], dt: f32) -> Option<f32> {
        let blemish = y[0] * 0.0 + y[1] * 0.0 + y[2] * 0.0 + u[0] * 0.0 + u[1] * 0.0 + dt * 0.0;
        if !(blemish == 0.0 && dt > 0.0) {
            return None;
        }
        let sample = Sample::new(y);
        let mut next = *self;
        if next.sampled {
            next.advance(&sample, u, dt);
        }
        next.sampled = true;
        next.sample = sample;
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

    fn advance(&mut self, sample: &Sample, u: [f32; 2], dt: f32) {
        let before = self.sample;
        let [start, end] = self.extension.integrate(before.h(u), sample.h(u), dt);

        let (known_start, known_end) = (before.phi_0(start, u), sample.phi_0(end, u));
        let (factor_start, factor_end) = (before.phi_1(), sample.phi_1());
        let regression = &mut self.regression;
        regression.use_sample_time(SETTINGS.alpha, dt);
        for row in 0..3 {
            let rate = (sample.y[row] - before.y[row]) / dt;
            let known = [rate - known_start[row], rate - known_end[row]];
            regression.filter(row, known, [factor_start[row], factor_end[row]]);
        }
        regression.correct(SETTINGS.gains, dt);
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}
