//! The observer of the two-link arm. What it needs of a sample is kept for the interval that begins there.

use pebo_runtime::Real;

use super::{Extension, Regression};
use crate::counted::arm::SETTINGS;

const M1: f32 = 0.8;
const L1: f32 = 0.5;
const L2: f32 = 0.35;
const M1_G: f32 = M1 * 9.81;
const INV_L1: f32 = 1.0 / L1;
const INV_L1_L2: f32 = 1.0 / (L1 * L2);
const INV_M1_L1: f32 = 1.0 / (M1 * L1);
const INV_M1_L1_L2: f32 = 1.0 / (M1 * L1 * L2);

/// Terms of the angles alone.
#[derive(Clone, Copy)]
struct Posture {
    /// Cosine and sine of the first angle.
    first: [f32; 2],
    /// Cosine and sine of the sum of both angles.
    both: [f32; 2],
    inv_sine: f32,
    /// Factors of the torque of the first joint in the momenta, times the sine, and of that of the second.
    shoulder: [f32; 2],
    elbow: [f32; 2],
    /// By rows.
    regressor: [[f32; 2]; 2],
}

impl Posture {
    const NONE: Self = Self {
        first: [0.0; 2],
        both: [0.0; 2],
        inv_sine: 0.0,
        shoulder: [0.0; 2],
        elbow: [0.0; 2],
        regressor: [[0.0; 2]; 2],
    };

    fn new([y1, y2]: [f32; 2]) -> Self {
        let (sin_1, cos_1) = Real::sin_cos(y1);
        let (sin_2, cos_2) = Real::sin_cos(y2);
        let both = [cos_1 * cos_2 - sin_1 * sin_2, sin_1 * cos_2 + cos_1 * sin_2];
        // From the shoulder to the tip.
        let tip = [both[0] * L2 + cos_1 * L1, both[1] * L2 + sin_1 * L1];
        let inv_sine = 1.0 / sin_2;
        Self {
            first: [cos_1, sin_1],
            both,
            inv_sine,
            shoulder: [both[0] * INV_L1, both[1] * INV_L1],
            elbow: [tip[0] * INV_L1_L2, tip[1] * INV_L1_L2],
            regressor: [
                [INV_M1_L1 * both[0] * inv_sine, INV_M1_L1 * both[1] * inv_sine],
                [-(INV_M1_L1_L2 * tip[0] * inv_sine), -(INV_M1_L1_L2 * tip[1] * inv_sine)],
            ],
        }
    }

    /// Gravity takes from the upright momentum what it takes from a free point mass.
    fn h(&self, u: [f32; 2]) -> [f32; 2] {
        let given = |axis: usize| self.inv_sine * (u[0] * self.shoulder[axis] - u[1] * self.elbow[axis]);
        [given(0), given(1) - M1_G]
    }

    fn phi_0(&self, chi: [f32; 2]) -> [f32; 2] {
        self.regressor.map(|row| chi[0] * row[0] + chi[1] * row[1])
    }
}

/// The observer.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    y: [f32; 2],
    posture: Posture,
    extension: Extension,
    regression: Regression<2>,
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        Self {
            sampled: false,
            y: [0.0; 2],
            posture: Posture::NONE,
            extension: Extension::START,
            regression: Regression::START,
        }
    }

    /// One sample: angles at the end of an interval, the torques during it, its length. None for a bad sample.
    pub fn step(&mut self, y: [f32; 2], u: [f32; 2], dt: f32) -> Option<[f32; 2]> {
        if !(y[0] * 0.0 + y[1] * 0.0 + u[0] * 0.0 + u[1] * 0.0 + dt * 0.0 == 0.0 && dt > 0.0) {
            return None;
        }
        let posture = Posture::new(y);
        let mut next = *self;
        if next.sampled {
            next.advance((y, &posture), u, dt);
        }
        next.sampled = true;
        next.y = y;
        if next.extension.blemish() + next.regression.blemish() != 0.0 {
            return None;
        }
        let z = next.regression.coordinates(&next.extension);
        let along = |[cosine, sine]: [f32; 2]| z[1] * cosine - z[0] * sine;
        let second = L2 * along(posture.both);
        let estimate = [L1 * along(posture.first) + second, second];
        if estimate[0] * 0.0 + estimate[1] * 0.0 != 0.0 {
            return None;
        }
        next.posture = posture;
        *self = next;
        Some(estimate)
    }

    fn advance(&mut self, (y, posture): ([f32; 2], &Posture), u: [f32; 2], dt: f32) {
        let (before, earlier) = (self.y, self.posture);
        let (h_start, h_end) = (earlier.h(u), posture.h(u));
        let [start, end] = self.extension.integrate(h_start, h_end, dt);

        let (known_start, known_end) = (earlier.phi_0(start), posture.phi_0(end));
        let regression = &mut self.regression;
        regression.use_sample_time(SETTINGS.alpha, dt);
        for row in 0..2 {
            let rate = (y[row] - before[row]) / dt;
            let known = [rate - known_start[row], rate - known_end[row]];
            regression.filter(row, known, [earlier.regressor[row], posture.regressor[row]]);
        }
        regression.correct(SETTINGS.gains, dt);
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}
