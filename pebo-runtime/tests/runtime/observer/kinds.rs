//! The other kinds of regression: static and over-parameterised, implicit, padded.

use pebo_runtime::nalgebra::{Matrix1, Matrix1x3, SMatrix, SVector, Vector1, Vector2, Vector3};
use pebo_runtime::{Filter, Flow, Gradient, Hold, Integrator, Model, Observer, Rebase, Regression, Sides};

use crate::converter::{CaseOne, Loop};

/// The surface-mounted PMSM of the paper, Section 5.2: the flux circle `|chi + theta - L i|^2 = lambda_m^2` as a static
/// regression in `eta = (theta, lambda_m^2 - |theta|^2)`; the recovered state is the position.
struct Motor;

const R: f64 = 0.5;
const L: f64 = 0.4;
const LAMBDA_M: f64 = 0.8;
const POLES: f64 = 3.0;

impl Model<1, 2, 2, 2, 1, 3> for Motor {
    type Scalar = f64;
    type Extension = Integrator<f64, 2>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 2>;
    type Terms = Vector2<f64>;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Vector2<f64>) -> Vector2<f64> {
        *y
    }
    fn flow(&self, i: &Vector2<f64>, u: &Vector2<f64>) -> Flow<f64, 2> {
        Flow::plain(u - i * R)
    }
    fn regression(&self, extension: &Self::Extension, i: &Vector2<f64>, _: &Vector2<f64>) -> Sides<f64, 1, 3> {
        let s = (extension.chi() - i * L) * -2.0;
        Sides { known: Vector1::new((extension.chi() - i * L).norm_squared()), factor: Matrix1x3::new(s.x, s.y, 1.0) }
    }
    fn theta(&self, eta: &Vector3<f64>) -> Vector2<f64> {
        eta.xy()
    }
    fn recover(&self, z: &Vector2<f64>, i: &Vector2<f64>) -> Vector1<f64> {
        let magnet = z - i * L;
        Vector1::new(magnet.y.atan2(magnet.x) / POLES)
    }
}

#[test]
fn motor_finds_its_position() {
    let current = |t: f64| Vector2::new((2.0 * t).sin(), 0.5 * (3.0 * t).cos());
    let angle = |t: f64| 0.3 + 4.0 * t;
    let flux = |t: f64| current(t) * L + Vector2::new((POLES * angle(t)).cos(), (POLES * angle(t)).sin()) * LAMBDA_M;

    let gradient = Gradient::diagonal(&Vector3::new(5.0, 5.0, 5.0)).unwrap();
    let filter = Filter::new(20.0, Hold::First).unwrap();
    let chi_0 = Vector2::new(0.2, -0.1);
    let mut observer = Observer::new(Motor, gradient, filter, chi_0).unwrap();

    let dt = 1e-3;
    let (mut estimate, mut now) = (Vector1::zeros(), 0.0);
    for k in 0..40_000_u32 {
        now = f64::from(k) * dt;
        let before = (now - dt).max(0.0);
        // The voltage that moves the flux exactly under the trapezoidal rule: the regression then holds without error.
        let u = (flux(now) - flux(before)) / dt + (current(now) + current(before)) * (R / 2.0);
        estimate = observer.step(current(now), u, dt).unwrap();
    }
    let theta = flux(0.0) - chi_0;
    let eta = Vector3::new(theta.x, theta.y, LAMBDA_M * LAMBDA_M - theta.norm_squared());
    // The transient has decayed; what is left is the rounding of 40000 steps and, as the filter sees a straight line
    // where the product of signals is curved, nothing: both sides are interpolated, and eta makes them equal at the
    // samples.
    assert!((observer.eta() - eta).norm() < 1e-9, "{}", observer.eta() - eta);
    let turn = (estimate.x - angle(now)) * POLES / core::f64::consts::TAU;
    assert!((turn - turn.round()).abs() < 1e-9, "{turn}");
}

/// `x' = u1`, `x y' = u2 - y`: the unknown multiplies the derivative. With `x = chi + theta`,
/// `d/dt [chi y + y theta] = u2 - y + u1 y`.
struct Implicit;

impl Model<1, 1, 2, 1, 1, 1> for Implicit {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 2>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, _: &Vector1<f64>, u: &Vector2<f64>) -> Flow<f64, 1> {
        Flow::plain(Vector1::new(u.x))
    }
    fn regression(&self, _: &Self::Extension, y: &Vector1<f64>, u: &Vector2<f64>) -> Sides<f64, 1, 1> {
        Sides { known: Vector1::new(u.y - y.x + u.x * y.x), factor: Matrix1::zeros() }
    }
    fn primitive(&self, extension: &Self::Extension, y: &Vector1<f64>) -> Sides<f64, 1, 1> {
        Sides { known: extension.chi().component_mul(y), factor: *y }
    }
    fn theta(&self, eta: &Vector1<f64>) -> Vector1<f64> {
        *eta
    }
    fn recover(&self, z: &Vector1<f64>, _: &Vector1<f64>) -> Vector1<f64> {
        *z
    }
}

impl Rebase<1, 1, 2, 1, 1> for Implicit {}

/// The error of the implicit model's estimate after 20 s, of observers with and without re-basing on the way.
fn implicit_errors(dt: f64) -> [f64; 2] {
    let gradient = Gradient::diagonal(&Vector1::new(20.0)).unwrap();
    let filter = Filter::new(2.0, Hold::First).unwrap();
    let new = || Observer::new(Implicit, gradient, filter, Vector1::new(0.5)).unwrap();
    let (mut plain, mut moved) = (new(), new());
    let (mut x, mut y, mut t) = (2.0, 1.0, 0.0);
    let mut u = Vector2::zeros();
    let mut errors = [f64::NAN; 2];
    for k in 0_u32..=20_000 {
        for (observer, error) in [&mut plain, &mut moved].into_iter().zip(&mut errors) {
            *error = observer.step(Vector1::new(y), u, dt).unwrap().x - x;
        }
        if k % 1000 == 500 {
            let chi = *moved.extension().chi();
            moved.rebase(&chi).unwrap();
        }
        u = Vector2::new(0.5 * f64::cos(0.7 * t), 3.0 * f64::sin(2.0 * t));
        // Exact over the held input: x is straight, and y - u2 decays as a power of x (or exponentially if x rests).
        let after = x + u.x * dt;
        let decay = if u.x == 0.0 { (-dt / x).exp() } else { (after / x).powf(-1.0 / u.x) };
        y = u.y + (y - u.y) * decay;
        x = after;
        t += dt;
    }
    errors
}

#[test]
fn unknown_may_multiply_the_derivative() {
    let [plain, moved] = implicit_errors(1e-3);
    // The estimate settles (gain times squared regressor is above 1/s) to what the trapezoidal rule leaves: dt^2/12
    // times second derivatives of y up to 30, over regressors of order 1.
    assert!(plain.abs() < 1e-5, "{plain}");
    // Rounding only: numbers of order 10, twenty moves.
    assert!((plain - moved).abs() < 1e-11, "{plain} {moved}");
}

/// Any model on 2 outputs, padded with zeros to 4 coordinates, equations and unknowns.
struct Padded<M>(M);

impl<M> Model<2, 2, 1, 4, 4, 4> for Padded<M>
where
    M: Model<2, 2, 1, 2, 2, 2, Scalar = f64, Extension = Integrator<f64, 2>, Terms = Vector2<f64>>,
{
    type Scalar = f64;
    type Extension = Integrator<f64, 4>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<f64>;
    const REGRESSION: Regression = M::REGRESSION;

    fn terms(&self, y: &Vector2<f64>) -> Vector2<f64> {
        *y
    }
    fn flow(&self, y: &Vector2<f64>, u: &Vector1<f64>) -> Flow<f64, 4> {
        Flow::plain(pad(&self.0.flow(y, u).h))
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<f64>, u: &Vector1<f64>) -> Sides<f64, 4, 4> {
        let mut padded = SMatrix::<f64, 4, 4>::zeros();
        let sides = self.0.regression(&narrow(extension), y, u);
        padded.fixed_view_mut::<2, 2>(0, 0).copy_from(&sides.factor);
        Sides { known: pad(&sides.known), factor: padded }
    }
    fn primitive(&self, extension: &Self::Extension, y: &Vector2<f64>) -> Sides<f64, 4, 4> {
        Sides { known: pad(&self.0.primitive(&narrow(extension), y).known), factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &SVector<f64, 4>) -> SVector<f64, 4> {
        *eta
    }
    fn recover(&self, z: &SVector<f64, 4>, y: &Vector2<f64>) -> Vector2<f64> {
        self.0.recover(&z.xy(), y)
    }
}

fn pad(vector: &Vector2<f64>) -> SVector<f64, 4> {
    SVector::<f64, 4>::new(vector.x, vector.y, 0.0, 0.0)
}

fn narrow(extension: &Integrator<f64, 4>) -> Integrator<f64, 2> {
    pebo_runtime::Extension::new(extension.chi().xy())
}

#[test]
fn padded_model_is_the_same_observer() {
    let mut closed = Loop::<f64, CaseOne<f64>>::new(0.5, [1e-3, 1e-3], 1e-5).unwrap();
    let model = Padded(closed.observer.model().clone());
    let gradient = Gradient::diagonal(&SVector::<f64, 4>::repeat(1e-3)).unwrap();
    let filter = Filter::new(0.5, Hold::First).unwrap();
    let mut padded = Observer::new(model, gradient, filter, SVector::zeros()).unwrap();
    padded.step(closed.outputs(), Vector1::zeros(), 1e-5).unwrap();
    for _ in 0..1000 {
        let duty = closed.duty();
        closed.advance().unwrap();
        let estimate = padded.step(closed.outputs(), Vector1::new(duty), 1e-5).unwrap();
        assert_eq!(Some(estimate), closed.observer.estimate());
    }
}
