//! The observer of the Cuk converter, case II.

use super::{Extension, Regression};
use crate::converter::{ALPHA, GAINS};

const INV_L1: f32 = 1.0 / 10e-3;
const INV_C2: f32 = 1.0 / 22e-6;
const INV_L3: f32 = 1.0 / 10e-3;
const INV_C4: f32 = 1.0 / 22.9e-6;
const G: f32 = 0.0447;
const E: f32 = 12.0;
const G_OVER_C4: f32 = G * INV_C4;
const L3_G_OVER_C4: f32 = G * 10e-3 * INV_C4;

/// The observer.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    y: [f32; 2],
    extension: Extension,
    regression: Regression<2>,
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        Self { sampled: false, y: [0.0; 2], extension: Extension::START, regression: Regression::START }
    }

    /// One sample: outputs at the end of an interval, the duty cycle during it, its length. None for a bad sample.
    pub fn step(&mut self, y: [f32; 2], d: f32, dt: f32) -> Option<[f32; 2]> {
        if !(y[0] * 0.0 + y[1] * 0.0 + d * 0.0 + dt * 0.0 == 0.0 && dt > 0.0) {
            return None;
        }
        let mut next = *self;
        if next.sampled {
            next.advance(y, d, dt);
        }
        next.sampled = true;
        next.y = y;
        if !next.is_finite() {
            return None;
        }
        let z = next.regression.coordinates(&next.extension);
        let estimate = [z[0], z[1] + y[1] * L3_G_OVER_C4];
        if estimate[0] * 0.0 + estimate[1] * 0.0 != 0.0 {
            return None;
        }
        *self = next;
        Some(estimate)
    }

    fn advance(&mut self, y: [f32; 2], d: f32, dt: f32) {
        let before = self.y;
        let h = |[v2, i3]: [f32; 2]| [(E - v2 * (1.0 - d)) * INV_L1, (i3 + v2 * d * G) * INV_C4];
        let (h_start, h_end) = (h(before), h(y));
        let [start, end] = self.extension.integrate(h_start, h_end, dt);

        let phi_0 = |chi: [f32; 2], [v2, i3]: [f32; 2]| {
            [(i3 * d + chi[0] * (1.0 - d)) * INV_C2, -((chi[1] + v2 * d) * INV_L3 + i3 * G_OVER_C4)]
        };
        let (known_start, known_end) = (phi_0(start, before), phi_0(end, y));
        let phi_1 = [[(1.0 - d) * INV_C2, 0.0], [0.0, -INV_L3]];

        let regression = &mut self.regression;
        regression.use_sample_time(ALPHA, dt);
        for row in 0..2 {
            let rate = (y[row] - before[row]) / dt;
            let (first, last) = (rate - known_start[row], rate - known_end[row]);
            // The factors are the same at both ends of the interval.
            regression.filter(row, [first, last], [phi_1[row]; 2]);
        }
        regression.correct(GAINS, dt);
    }

    fn is_finite(&self) -> bool {
        self.extension.blemish() + self.regression.blemish() == 0.0
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}
