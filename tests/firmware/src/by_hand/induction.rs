//! An extended Kalman filter of the induction motor with the currents and the speed among its states: covariance in full,
//! its zeros and its symmetry used, one sensor after the other. No part of the runtime library is in it.

const R_S: f32 = 2.15;
const R_R: f32 = 2.33;
const L_S: f32 = 0.221;
const L_R: f32 = 0.221;
const L_M: f32 = 0.2135;
const N_P: f32 = 2.0;
const J: f32 = 0.015;
const B: f32 = 1.3e-3;

/// Of the rotor: the rate of its fluxes, and of what the currents bring.
const FADING: f32 = R_R / L_R;
const BROUGHT: f32 = FADING * L_M;
/// The leakage inductance, and the share of the rotor's rate in that of the currents.
const INV_L: f32 = 1.0 / (L_S - L_M * L_M / L_R);
const SHARE: f32 = L_M / L_R * INV_L;
const TORQUE: f32 = N_P * L_M / L_R / J;
const INV_J: f32 = 1.0 / J;

/// Currents, speed, fluxes and load torque.
type State = [f32; 6];

/// The variances of the sensors, of the state at the start, and what it gains a second.
pub const SENSORS: [f32; 3] = [0.0025, 0.0025, 0.01];
const START: State = [0.0025, 0.0025, 0.01, 0.25, 0.25, 25.0];
const DISTURBANCE: State = [0.000_686_8, 0.001_545, 0.000_539_2, 0.000_100_2, 0.000_100_4, 25.0];

/// The rate of the state.
pub fn rate([i1, i2, omega, psi1, psi2, load]: State, [v1, v2]: [f32; 2]) -> State {
    let turning = N_P * omega;
    let p1 = BROUGHT * i1 - FADING * psi1 - turning * psi2;
    let p2 = BROUGHT * i2 - FADING * psi2 + turning * psi1;
    [
        INV_L * (v1 - R_S * i1) - SHARE * p1,
        INV_L * (v2 - R_S * i2) - SHARE * p2,
        TORQUE * (psi1 * i2 - psi2 * i1) - INV_J * (load + B * omega),
        p1,
        p2,
        0.0,
    ]
}

/// The filter.
#[derive(Clone, Copy)]
pub struct ByHand {
    sampled: bool,
    x: State,
    /// The covariance; both halves are kept.
    p: [State; 6],
}

impl ByHand {
    /// Before the first sample.
    pub fn new() -> Self {
        let mut p = [[0.0; 6]; 6];
        for (i, row) in p.iter_mut().enumerate() {
            row[i] = START[i];
        }
        Self { sampled: false, x: [0.0; 6], p }
    }

    /// One sample: outputs at the end of an interval, the voltages during it, its length. None for a bad sample.
    pub fn step(&mut self, y: [f32; 3], u: [f32; 2], dt: f32) -> Option<[f32; 3]> {
        let blemish = y[0] * 0.0 + y[1] * 0.0 + y[2] * 0.0 + u[0] * 0.0 + u[1] * 0.0 + dt * 0.0;
        if !(blemish == 0.0 && dt > 0.0) {
            return None;
        }
        let mut next = *self;
        if next.sampled {
            next.predict(u, dt);
            for (sensor, value) in y.into_iter().enumerate() {
                next.correct(sensor, value);
            }
        } else {
            next.x[..3].copy_from_slice(&y);
            next.sampled = true;
        }
        let sum = next.x.iter().chain(next.p.as_flattened()).fold(0.0, |sum, &number| sum + number * 0.0);
        if sum != 0.0 {
            return None;
        }
        *self = next;
        let [_, _, _, psi1, psi2, load] = next.x;
        Some([psi1, psi2, load])
    }

    /// The midpoint rule for the state; `P` goes by `F = 1 + A dt + (A dt)^2/2`, row by row.
    fn predict(&mut self, u: [f32; 2], dt: f32) {
        let half = 0.5 * dt;
        let first = rate(self.x, u);
        let middle: State = core::array::from_fn(|i| self.x[i] + half * first[i]);
        let second = rate(middle, u);
        let [i1, i2, omega, psi1, psi2, _] = middle;
        for (x, rate) in self.x.iter_mut().zip(second) {
            *x += dt * rate;
        }
        // F P: to second order, as A (P + A P dt/2) dt.
        let once = flow([i1, i2, omega, psi1, psi2], &self.p);
        let mean = combined(&self.p, &once, half);
        let ahead = combined(&self.p, &flow([i1, i2, omega, psi1, psi2], &mean), dt);
        // (F P) F^T, whose transpose is F (F P)^T.
        let across = transposed(&ahead);
        let once = flow([i1, i2, omega, psi1, psi2], &across);
        let mean = combined(&across, &once, half);
        self.p = combined(&across, &flow([i1, i2, omega, psi1, psi2], &mean), dt);
        for i in 0..6 {
            self.p[i][i] += DISTURBANCE[i] * dt;
        }
    }

    /// Takes one sensor, whose state has its index.
    fn correct(&mut self, sensor: usize, value: f32) {
        let row = self.p[sensor];
        let weight = 1.0 / (row[sensor] + SENSORS[sensor]);
        let innovation = value - self.x[sensor];
        for i in 0..6 {
            let gain = row[i] * weight;
            self.x[i] += gain * innovation;
            for j in i..6 {
                self.p[i][j] -= gain * row[j];
                self.p[j][i] = self.p[i][j];
            }
        }
    }
}

impl Default for ByHand {
    fn default() -> Self {
        Self::new()
    }
}

/// `A` times a matrix, `A` the derivative of [`rate`].
fn flow([i1, i2, omega, psi1, psi2]: [f32; 5], p: &[State; 6]) -> [State; 6] {
    let turning = N_P * omega;
    let mut ahead = [[0.0; 6]; 6];
    for k in 0..6 {
        let [of_i1, of_i2, of_omega, of_psi1, of_psi2, of_load] =
            [p[0][k], p[1][k], p[2][k], p[3][k], p[4][k], p[5][k]];
        let p1 = BROUGHT * of_i1 - FADING * of_psi1 - turning * of_psi2 - N_P * psi2 * of_omega;
        let p2 = BROUGHT * of_i2 - FADING * of_psi2 + turning * of_psi1 + N_P * psi1 * of_omega;
        ahead[0][k] = -INV_L * R_S * of_i1 - SHARE * p1;
        ahead[1][k] = -INV_L * R_S * of_i2 - SHARE * p2;
        ahead[2][k] =
            TORQUE * (psi1 * of_i2 + i2 * of_psi1 - psi2 * of_i1 - i1 * of_psi2) - INV_J * (of_load + B * of_omega);
        ahead[3][k] = p1;
        ahead[4][k] = p2;
    }
    ahead
}

/// `a + factor b`.
fn combined(a: &[State; 6], b: &[State; 6], factor: f32) -> [State; 6] {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + factor * b[i][j]))
}

fn transposed(a: &[State; 6]) -> [State; 6] {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}
