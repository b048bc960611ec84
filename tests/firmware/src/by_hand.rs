//! The observer of the Cuk converter, case II, as a careful engineer writes it for this plant alone: no library, no
//! generics, the same arithmetic in the same order as the emitted observer, and the same promise to keep the last good
//! state.

use crate::converter::{ALPHA, GAINS};

const INV_L1: f32 = 1.0 / 10e-3;
const INV_C2: f32 = 1.0 / 22e-6;
const INV_L3: f32 = 1.0 / 10e-3;
const INV_C4: f32 = 1.0 / 22.9e-6;
const G: f32 = 0.0447;
const E: f32 = 12.0;
const G_OVER_C4: f32 = G * INV_C4;
const L3_G_OVER_C4: f32 = G_OVER_C4 * 10e-3;

/// A number and the rounding error of its summation.
#[derive(Clone, Copy)]
struct Accumulator {
    value: f32,
    carry: f32,
}

impl Accumulator {
    const ZERO: Self = Self { value: 0.0, carry: 0.0 };

    fn add(&mut self, increment: f32) {
        let sum = self.value + increment;
        let taken = sum - self.value;
        let lost = (self.value - (sum - taken)) + (increment - taken);
        let rest = self.carry + lost;
        self.value = sum + rest;
        self.carry = rest - (self.value - sum);
    }

    /// Zero, or NaN if either number is not finite.
    fn blemish(self) -> f32 {
        self.value * 0.0 + self.carry * 0.0
    }
}

/// The observer.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    y: [f32; 2],
    chi: [Accumulator; 2],
    regressand: [Accumulator; 2],
    /// By rows.
    regressor: [[Accumulator; 2]; 2],
    theta: [Accumulator; 2],
    weight_dt: f32,
    level: f32,
    slope: f32,
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        Self {
            sampled: false,
            y: [0.0; 2],
            chi: [Accumulator::ZERO; 2],
            regressand: [Accumulator::ZERO; 2],
            regressor: [[Accumulator::ZERO; 2]; 2],
            theta: [Accumulator::ZERO; 2],
            weight_dt: 0.0,
            level: 0.0,
            slope: 0.0,
        }
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
        let estimate =
            [next.chi[0].value + next.theta[0].value, next.chi[1].value + next.theta[1].value + y[1] * L3_G_OVER_C4];
        if estimate[0] * 0.0 + estimate[1] * 0.0 != 0.0 {
            return None;
        }
        *self = next;
        Some(estimate)
    }

    fn advance(&mut self, y: [f32; 2], d: f32, dt: f32) {
        let before = self.y;
        let start = [self.chi[0].value, self.chi[1].value];
        let h = |[v2, i3]: [f32; 2]| [(E - v2 * (1.0 - d)) * INV_L1, (i3 + v2 * d * G) * INV_C4];
        let (h_start, h_end) = (h(before), h(y));
        self.chi[0].add((h_start[0] + h_end[0]) * (0.5 * dt));
        self.chi[1].add((h_start[1] + h_end[1]) * (0.5 * dt));
        let end = [self.chi[0].value, self.chi[1].value];

        let phi_0 = |chi: [f32; 2], [v2, i3]: [f32; 2]| {
            [(chi[0] + d * (i3 - chi[0])) * INV_C2, -((chi[1] + v2 * d) * INV_L3 + i3 * G_OVER_C4)]
        };
        let (known_start, known_end) = (phi_0(start, before), phi_0(end, y));
        let phi_1 = [[(1.0 - d) * INV_C2, 0.0], [0.0, -INV_L3]];

        if self.weight_dt != dt {
            self.set_weights(dt);
        }
        for row in 0..2 {
            let rate = (y[row] - before[row]) / dt;
            let (first, last) = (rate - known_start[row], rate - known_end[row]);
            let behind = (first - self.regressand[row].value) * self.level;
            self.regressand[row].add(behind + (last - first) * self.slope);
            for (entry, factor) in self.regressor[row].iter_mut().zip(phi_1[row]) {
                // The factor is the same at both ends of the interval.
                entry.add((factor - entry.value) * self.level);
            }
        }
        self.correct(dt);
    }

    /// The implicit gradient step.
    fn correct(&mut self, dt: f32) {
        let phi = self.regressor.map(|row| row.map(|entry| entry.value));
        let innovation = [
            self.regressand[0].value - (phi[0][0] * self.theta[0].value + phi[0][1] * self.theta[1].value),
            self.regressand[1].value - (phi[1][0] * self.theta[0].value + phi[1][1] * self.theta[1].value),
        ];
        let mut weight = [1.0 / GAINS[0], 1.0 / GAINS[1]];
        let mut upper = 0.0;
        let mut target = [0.0; 2];
        for row in 0..2 {
            let [first, mut second] = phi[row];
            let mut value = innovation[row];
            let mut share = dt;
            if first != 0.0 {
                let after = weight[0] + share * first * first;
                let kept = weight[0] / after;
                let taken = share * first / after;
                weight[0] = after;
                share *= kept;
                let (entry, above) = (second, upper);
                second = entry - first * above;
                upper = kept * above + taken * entry;
                let (entry, above) = (value, target[0]);
                value = entry - first * above;
                target[0] = kept * above + taken * entry;
            }
            if second != 0.0 {
                let after = weight[1] + share * second * second;
                let kept = weight[1] / after;
                let taken = share * second / after;
                weight[1] = after;
                target[1] = kept * target[1] + taken * value;
            }
        }
        self.theta[1].add(target[1]);
        self.theta[0].add(target[0] - upper * target[1]);
    }

    /// The weights of the filter for another sample time.
    fn set_weights(&mut self, dt: f32) {
        let a = ALPHA * dt;
        self.level = -pebo_runtime::Real::exp_m1(-a);
        let mut series = 1.0;
        for k in (3..20_u8).rev() {
            series = 1.0 - a / f32::from(k) * series;
        }
        self.slope = 0.5 * a * series;
        self.weight_dt = dt;
    }

    fn is_finite(&self) -> bool {
        let [[a, b], [c, d]] = self.regressor;
        let all = self.chi.into_iter().chain(self.regressand).chain(self.theta).chain([a, b, c, d]);
        all.map(Accumulator::blemish).reduce(|sum, blemish| sum + blemish) == Some(0.0)
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}
