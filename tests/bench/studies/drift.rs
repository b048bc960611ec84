//! Drift: a boost converter whose input voltage is 0.1 V off, the plain form beside the one without drift, in single
//! and double precision. Prints the extension and the error of the current at every power of ten steps.
//!
//! Run with `cargo run --release -p tests --example drift [STEPS]`; a billion steps take some minutes.

use pebo_runtime::nalgebra::{Matrix1, SMatrix, SVector, Vector1};
use pebo_runtime::{
    Drift, Fault, Filter, Flow, Hold, Integrator, LeastSquares, Model, Observer, Real, Rebase, Regression, Sides,
};

const L: f64 = 1e-3;
const C: f64 = 1e-4;
const R: f64 = 50.0;
const E: f64 = 12.0;
/// The offset of the input voltage beyond its sensor's value, in V.
const OFFSET: f64 = 0.1;
const DT: f64 = 1e-5;
/// The rate of forgetting, in 1/s: the offset costs OFFSET/L/BETA of the current.
const BETA: f64 = 1e3;

/// `x = i`, `y = v`, `u` the duty cycle and the measured input voltage: `i' = (u2 - (1 - u1) v)/L`, `v' = ((1 - u1) i -
/// v/R)/C`.
#[derive(Clone)]
struct Boost<S>(core::marker::PhantomData<S>);

impl<S: Real> Model<1, 1, 2, 1, 1, 1> for Boost<S> {
    type Scalar = S;
    type Extension = Integrator<S, 1>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 2>;
    type Terms = Vector1<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<S>) -> Vector1<S> {
        *y
    }
    fn flow(&self, y: &Vector1<S>, u: &pebo_runtime::nalgebra::Vector2<S>) -> Flow<S, 1> {
        Flow::plain(Vector1::new((u.y - (S::one() - u.x) * y.x) * Real::from_f64(1.0 / L)))
    }
    fn regression(
        &self,
        x: &Self::Extension,
        y: &Vector1<S>,
        u: &pebo_runtime::nalgebra::Vector2<S>,
    ) -> Sides<S, 1, 1> {
        let r: S = Real::from_f64(1.0 / R);
        Sides {
            known: Vector1::new(((S::one() - u.x) * x.chi().x - y.x * r) * Real::from_f64(1.0 / C)),
            factor: Matrix1::new((S::one() - u.x) * Real::from_f64(1.0 / C)),
        }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector1<S>) -> Sides<S, 1, 1> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector1<S>) -> Vector1<S> {
        *eta
    }
    fn recover(&self, z: &Vector1<S>, _: &Vector1<S>) -> Vector1<S> {
        *z
    }
}

impl<S: Real> Rebase<1, 1, 2, 1, 1> for Boost<S> {}

type BoostObserver<S> = Observer<Boost<S>, LeastSquares<S, 1>, 1, 1, 2, 1, 1, 1>;

fn observer<S: Real>() -> Result<BoostObserver<S>, Fault> {
    let real = |x: f64| -> S { Real::from_f64(x) };
    let squares = LeastSquares::diagonal(&Vector1::new(real(1e3)), real(BETA))?;
    let filter = Filter::new(real(1e4), Hold::First)?;
    Observer::new(Boost(core::marker::PhantomData), squares, filter, Vector1::zeros())
}

fn run<S: Real>(steps: u64) -> Result<(), Fault> {
    let real = |x: f64| -> S { Real::from_f64(x) };
    let (mut plain, mut free) = (observer::<S>()?, observer::<S>()?);
    let (mut plain_error, mut free_error) = (0.0, 0.0);
    // Plant: a small ripple of the duty cycle around 1/2, whose response is computed along.
    let (mut i, mut v) = (2.0 * 24.0 / R, 24.0);
    let mut next_print = 10_000;
    for k in 1..=steps {
        let d = if k % 2000 < 1000 { 0.5 } else { 0.52 };
        // Midpoint rule, with the true input voltage.
        let rate = |i: f64, v: f64| ((E + OFFSET - (1.0 - d) * v) / L, ((1.0 - d) * i - v / R) / C);
        let (di, dv) = rate(i, v);
        let (di, dv) = rate(i + di * DT / 2.0, v + dv * DT / 2.0);
        (i, v) = (i + di * DT, v + dv * DT);
        let y = Vector1::new(real(v));
        let u = pebo_runtime::nalgebra::Vector2::new(real(d), real(E));
        let error = |estimate: Vector1<S>| (Real::to_f64(estimate.x) - i).abs();
        plain_error = f64::max(plain_error, error(plain.step(y, u, real(DT))?));
        free_error = f64::max(free_error, error(free.step_without_drift(y, u, real(DT), Drift::Free)?));
        if k == next_print {
            println!(
                "{k:>12} {:>12.4e} {plain_error:>12.4e} {:>12.4e} {free_error:>12.4e}",
                Real::to_f64(plain.extension().chi().x),
                Real::to_f64(free.extension().chi().x),
            );
            next_print *= 10;
            (plain_error, free_error) = (0.0, 0.0);
        }
    }
    Ok(())
}

fn main() -> Result<(), Fault> {
    let steps = std::env::args().nth(1).map_or(100_000_000, |steps| steps.parse().expect("a number of steps"));
    println!("offset {OFFSET} V, beta {BETA}/s: the estimate lags by {} A in every form", OFFSET / L / BETA);
    for (name, run) in [("f32", run::<f32> as fn(u64) -> Result<(), Fault>), ("f64", run::<f64>)] {
        println!(
            "\n{name}: steps, plain chi and largest error since the line before, the same of the form without drift"
        );
        run(steps)?;
    }
    Ok(())
}
