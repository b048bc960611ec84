//! The Cuk converter of the paper, Section 5.3, in case II, under the full-state controller.

use pebo_runtime::nalgebra::{Vector2, Vector4};

pub(crate) const L1: f64 = 10e-3;
pub(crate) const C2: f64 = 22e-6;
pub(crate) const L3: f64 = 10e-3;
pub(crate) const C4: f64 = 22.9e-6;
pub(crate) const G: f64 = 0.0447;
pub(crate) const E: f64 = 12.0;
/// Not given in the paper.
const LAMBDA_0: f64 = 0.1;

/// The circuit: `i1`, `v2`, `i3`, `v4`.
pub(crate) struct Converter {
    state: Vector4<f64>,
}

impl Converter {
    /// The paper's start.
    pub(crate) fn new() -> Self {
        Self { state: Vector4::new(0.5, 10.0, -1.0, -12.0) }
    }

    /// The measured pair: `v2`, `i3`.
    pub(crate) fn outputs(&self) -> Vector2<f64> {
        Vector2::new(self.state.y, self.state.z)
    }

    /// The unmeasured pair: `i1`, `v4`.
    pub(crate) fn unmeasured(&self) -> Vector2<f64> {
        Vector2::new(self.state.x, self.state.w)
    }

    /// The transform: `i1`, `v4 - L3 G/C4 i3`.
    pub(crate) fn transform(&self) -> Vector2<f64> {
        Vector2::new(self.state.x, self.state.w - L3 * G / C4 * self.state.z)
    }

    /// The duty cycle that the controller sets at time `t`, knowing the state.
    pub(crate) fn duty(&self, t: f64) -> f64 {
        // Half a nanosecond of slack: sample times are sums of rounded steps.
        let set_point = match t + 0.5e-9 {
            t if t < 0.2 => 25.0,
            t if t < 0.4 => 30.0,
            t if t < 0.6 => 15.0,
            t if t < 0.8 => 5.0,
            _ => 20.0,
        };
        let lambda = LAMBDA_0 * (set_point / (set_point + E)).min(E / (set_point + E));
        let s = G * set_point * self.state.y + E * (self.state.z - self.state.x);
        set_point / (set_point + E) + lambda * s / (1.0 + s * s)
    }

    /// One step of the classical Runge-Kutta method with a held duty cycle.
    pub(crate) fn advance(&mut self, d: f64, dt: f64) {
        let rate = |s: &Vector4<f64>| {
            Vector4::new(
                (E - (1.0 - d) * s.y) / L1,
                ((1.0 - d) * s.x + d * s.z) / C2,
                -(d * s.y + s.w) / L3,
                (s.z - G * s.w) / C4,
            )
        };
        let s = self.state;
        let k1 = rate(&s);
        let k2 = rate(&(s + k1 * (dt / 2.0)));
        let k3 = rate(&(s + k2 * (dt / 2.0)));
        let k4 = rate(&(s + k3 * dt));
        self.state = s + (k1 + (k2 + k3) * 2.0 + k4) * (dt / 6.0);
    }
}
