//! The Cuk converter of the paper, Section 5.3, both measurement cases, in closed loop.
//!
//! Values, start and set points: the paper, with the misprints mended (second row of `Phi_0` in case II: `-(G/C4) y2`)
//! and `lambda_0 = 0.1`, which the paper does not give.

use pebo_runtime::nalgebra::{Matrix2, SMatrix, SVector, Vector2, Vector4};
use pebo_runtime::{
    Fault, Filter, Flow, Fundamental, Gradient, Hold, Integrator, Model, Observer, Real, Rebase, Regression, Sides,
};

const L1: f64 = 10e-3;
const C2: f64 = 22e-6;
const L3: f64 = 10e-3;
const C4: f64 = 22.9e-6;
const G: f64 = 0.0447;
const E: f64 = 12.0;
const LAMBDA_0: f64 = 0.1;

type Input<S> = SVector<S, 1>;

fn real<S: Real>(value: f64) -> S {
    Real::from_f64(value)
}

/// `di1/dt`, the same in both cases.
fn di1<S: Real>(v2: S, d: S) -> S {
    (real::<S>(E) - (S::one() - d) * v2) / real(L1)
}

/// Case I: x = (i1, i3), y = (v2, v4), phi = x.
#[derive(Clone, Debug)]
pub(crate) struct CaseOne<S>(core::marker::PhantomData<S>);

impl<S: Real> Model<2, 2, 1, 2, 2, 2> for CaseOne<S> {
    type Scalar = S;
    type Extension = Integrator<S, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector2<S>) -> Vector2<S> {
        *y
    }
    fn flow(&self, y: &Vector2<S>, u: &Input<S>) -> Flow<S, 2> {
        Flow::plain(Vector2::new(di1(y.x, u.x), -(u.x * y.x + y.y) / real(L3)))
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<S>, u: &Input<S>) -> Sides<S, 2, 2> {
        let chi = extension.chi();
        Sides {
            known: Vector2::new(
                ((S::one() - u.x) * chi.x + u.x * chi.y) / real(C2),
                (chi.y - real::<S>(G) * y.y) / real(C4),
            ),
            factor: Matrix2::new((S::one() - u.x) / real(C2), u.x / real(C2), S::zero(), real(1.0 / C4)),
        }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector2<S>) -> Sides<S, 2, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector2<S>) -> Vector2<S> {
        *eta
    }
    fn recover(&self, z: &Vector2<S>, _: &Vector2<S>) -> Vector2<S> {
        *z
    }
}

impl<S: Real> Rebase<2, 2, 1, 2, 2> for CaseOne<S> {}

/// Case II: x = (i1, v4), y = (v2, i3), phi = (i1, v4 - (G L3/C4) i3).
#[derive(Clone, Debug)]
pub(crate) struct CaseTwo<S>(core::marker::PhantomData<S>);

impl<S: Real> Model<2, 2, 1, 2, 2, 2> for CaseTwo<S> {
    type Scalar = S;
    type Extension = Integrator<S, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector2<S>) -> Vector2<S> {
        *y
    }
    fn flow(&self, y: &Vector2<S>, u: &Input<S>) -> Flow<S, 2> {
        Flow::plain(Vector2::new(di1(y.x, u.x), (y.y + real::<S>(G) * u.x * y.x) / real(C4)))
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<S>, u: &Input<S>) -> Sides<S, 2, 2> {
        let chi = extension.chi();
        Sides {
            known: Vector2::new(
                ((S::one() - u.x) * chi.x + u.x * y.y) / real(C2),
                -(u.x * y.x + chi.y) / real(L3) - real::<S>(G / C4) * y.y,
            ),
            factor: Matrix2::new((S::one() - u.x) / real(C2), S::zero(), S::zero(), real(-1.0 / L3)),
        }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector2<S>) -> Sides<S, 2, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector2<S>) -> Vector2<S> {
        *eta
    }
    fn recover(&self, z: &Vector2<S>, y: &Vector2<S>) -> Vector2<S> {
        Vector2::new(z.x, z.y + real::<S>(G * L3 / C4) * y.y)
    }
}

impl<S: Real> Rebase<2, 2, 1, 2, 2> for CaseTwo<S> {}

/// Case II with phi = x, which is no cascade but a generalised one: Lambda = diag(0, -G/C4).
#[derive(Clone, Debug)]
pub(crate) struct CaseTwoGeneralised<S>(core::marker::PhantomData<S>);

impl<S: Real> Model<2, 2, 1, 2, 2, 2> for CaseTwoGeneralised<S> {
    type Scalar = S;
    type Extension = Fundamental<S, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector2<S>) -> Vector2<S> {
        *y
    }
    fn flow(&self, y: &Vector2<S>, u: &Input<S>) -> Flow<S, 2> {
        Flow {
            lambda: Matrix2::new(S::zero(), S::zero(), S::zero(), real(-G / C4)),
            h: Vector2::new(di1(y.x, u.x), y.y / real(C4)),
        }
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<S>, u: &Input<S>) -> Sides<S, 2, 2> {
        let xi = extension.xi();
        let through = Matrix2::new((S::one() - u.x) / real(C2), S::zero(), S::zero(), real(-1.0 / L3));
        Sides {
            known: Vector2::new(((S::one() - u.x) * xi.x + u.x * y.y) / real(C2), -(u.x * y.x + xi.y) / real(L3)),
            factor: through * extension.psi(),
        }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector2<S>) -> Sides<S, 2, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector2<S>) -> Vector2<S> {
        *eta
    }
    fn recover(&self, z: &Vector2<S>, _: &Vector2<S>) -> Vector2<S> {
        *z
    }
}

impl<S: Real> Rebase<2, 2, 1, 2, 2> for CaseTwoGeneralised<S> {}

/// A measurement case: its view of the circuit state (i1, v2, i3, v4).
pub(crate) trait Case<S: Real>: Model<2, 2, 1, 2, 2, 2, Scalar = S, X = Vector2<S>> {
    fn new() -> Self;
    /// The measured pair.
    fn outputs(circuit: &Vector4<f64>) -> Vector2<f64>;
    /// The unmeasured pair.
    fn unmeasured(circuit: &Vector4<f64>) -> Vector2<f64>;
    /// (i1, i3) as the controller sees them.
    fn currents(y: &Vector2<f64>, estimate: &Vector2<f64>) -> Vector2<f64>;
}

impl<S: Real> Case<S> for CaseOne<S> {
    fn new() -> Self {
        Self(core::marker::PhantomData)
    }
    fn outputs(circuit: &Vector4<f64>) -> Vector2<f64> {
        Vector2::new(circuit.y, circuit.w)
    }
    fn unmeasured(circuit: &Vector4<f64>) -> Vector2<f64> {
        Vector2::new(circuit.x, circuit.z)
    }
    fn currents(_: &Vector2<f64>, estimate: &Vector2<f64>) -> Vector2<f64> {
        *estimate
    }
}

macro_rules! second_case {
    ($($model:ident),+) => {$(
        impl<S: Real> Case<S> for $model<S> {
            fn new() -> Self {
                Self(core::marker::PhantomData)
            }
            fn outputs(circuit: &Vector4<f64>) -> Vector2<f64> {
                Vector2::new(circuit.y, circuit.z)
            }
            fn unmeasured(circuit: &Vector4<f64>) -> Vector2<f64> {
                Vector2::new(circuit.x, circuit.w)
            }
            fn currents(y: &Vector2<f64>, estimate: &Vector2<f64>) -> Vector2<f64> {
                Vector2::new(estimate.x, y.y)
            }
        }
    )+};
}

second_case!(CaseTwo, CaseTwoGeneralised);

/// The circuit with a held duty cycle, and the controller of the paper.
mod circuit {
    use super::{C2, C4, E, G, L1, L3, LAMBDA_0, Vector2, Vector4};

    fn rate(s: &Vector4<f64>, d: f64) -> Vector4<f64> {
        Vector4::new(
            (E - (1.0 - d) * s.y) / L1,
            ((1.0 - d) * s.x + d * s.z) / C2,
            -(d * s.y + s.w) / L3,
            (s.z - G * s.w) / C4,
        )
    }

    /// One step of the classical Runge-Kutta method.
    pub(super) fn advance(s: &Vector4<f64>, d: f64, dt: f64) -> Vector4<f64> {
        let k1 = rate(s, d);
        let k2 = rate(&(s + k1 * (dt / 2.0)), d);
        let k3 = rate(&(s + k2 * (dt / 2.0)), d);
        let k4 = rate(&(s + k3 * dt), d);
        s + (k1 + (k2 + k3) * 2.0 + k4) * (dt / 6.0)
    }

    pub(super) fn duty(set_point: f64, v2: f64, currents: &Vector2<f64>) -> f64 {
        let lambda = LAMBDA_0 * (set_point / (set_point + E)).min(E / (set_point + E));
        let s = G * set_point * v2 + E * (currents.y - currents.x);
        set_point / (set_point + E) + lambda * s / (1.0 + s * s)
    }

    pub(super) fn set_point(t: f64) -> f64 {
        // Half a nanosecond of slack: sample times are sums of rounded steps.
        let t = t + 0.5e-9;
        match t {
            t if t < 0.2 => 25.0,
            t if t < 0.4 => 30.0,
            t if t < 0.6 => 15.0,
            t if t < 0.8 => 5.0,
            _ => 20.0,
        }
    }
}

/// The observer type of every case.
pub(crate) type CukObserver<S, M> = Observer<M, Gradient<S, 2>, 2, 2, 1, 2, 2, 2>;

/// The closed loop of converter, observer and controller, sampled.
pub(crate) struct Loop<S: Real, M: Case<S>> {
    pub(crate) circuit: Vector4<f64>,
    pub(crate) observer: CukObserver<S, M>,
    steps: u32,
    dt: f64,
    d: f64,
}

impl<S: Real, M: Case<S>> Loop<S, M> {
    /// The loop at t = 0, after the first sample.
    pub(crate) fn new(alpha: f64, gains: [f64; 2], dt: f64) -> Result<Self, Fault> {
        let circuit = Vector4::new(0.5, 10.0, -1.0, -12.0);
        let gradient = Gradient::diagonal(&Vector2::new(real(gains[0]), real(gains[1])))?;
        let observer = Observer::new(M::new(), gradient, Filter::new(real(alpha), Hold::First)?, Vector2::zeros())?;
        let mut closed = Self { circuit, observer, steps: 0, dt, d: 0.0 };
        closed.sample()?;
        Ok(closed)
    }

    /// Samples the output, updates the estimate, sets the duty cycle for the interval to come.
    fn sample(&mut self) -> Result<(), Fault> {
        let y = M::outputs(&self.circuit);
        let estimate = self.observer.step(y.map(real), Input::new(real(self.d)), real(self.dt))?;
        let estimate = estimate.map(Real::to_f64);
        let t = f64::from(self.steps) * self.dt;
        self.d = circuit::duty(circuit::set_point(t), y.x, &M::currents(&y, &estimate));
        Ok(())
    }

    /// One sample interval.
    pub(crate) fn advance(&mut self) -> Result<(), Fault> {
        // The controller computes in the observer's precision: plant and observer get the same input.
        self.d = Real::to_f64(real::<S>(self.d));
        self.circuit = circuit::advance(&self.circuit, self.d, self.dt);
        self.steps += 1;
        self.sample()
    }

    /// Advances for `duration` seconds.
    pub(crate) fn run(&mut self, duration: f64) -> Result<(), Fault> {
        let until = f64::from(self.steps) * self.dt + duration - self.dt / 2.0;
        while f64::from(self.steps) * self.dt < until {
            self.advance()?;
        }
        Ok(())
    }

    /// The duty cycle of the interval to come.
    pub(crate) fn duty(&self) -> f64 {
        self.d
    }

    /// The measured pair.
    pub(crate) fn outputs(&self) -> Vector2<f64> {
        M::outputs(&self.circuit)
    }

    /// Estimate minus truth.
    pub(crate) fn error(&self) -> Vector2<f64> {
        let estimate = self.observer.estimate_at(M::outputs(&self.circuit).map(real));
        estimate.map(Real::to_f64) - M::unmeasured(&self.circuit)
    }
}
