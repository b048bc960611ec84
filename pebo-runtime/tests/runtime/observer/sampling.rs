//! Windows, holds, skipped samples, limits, and the forms without drift: on a mass whose speed is not measured.

use pebo_runtime::nalgebra::{Matrix1, SMatrix, SVector, Vector1, Vector2};
use pebo_runtime::{
    Drem, Drift, Estimator, Fault, Filter, Flow, Gap, Gradient, Hold, Integrator, Kreisselmeier, LeastSquares, Limits,
    Model, Observer, Real, Rebase, Regression, RegressionOperator, Response, Sides, WindowedRegression,
};
use proptest::prelude::*;

use crate::random::decades;

/// `x' = u`, `y' = x`.
#[derive(Clone, Debug)]
struct Mass<S>(core::marker::PhantomData<S>);

impl<S: Real> Model<1, 1, 1, 1, 1, 1> for Mass<S> {
    type Scalar = S;
    type Extension = Integrator<S, 1>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<S>) -> Vector1<S> {
        *y
    }
    fn flow(&self, _: &Vector1<S>, u: &Vector1<S>) -> Flow<S, 1> {
        Flow::plain(*u)
    }
    fn regression(&self, extension: &Self::Extension, _: &Vector1<S>, _: &Vector1<S>) -> Sides<S, 1, 1> {
        Sides { known: *extension.chi(), factor: Matrix1::identity() }
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

impl<S: Real> Rebase<1, 1, 1, 1, 1> for Mass<S> {}

fn mass<S>() -> Mass<S> {
    Mass(core::marker::PhantomData)
}

fn filter<S: Real>() -> Filter<S> {
    Filter::new(Real::from_f64(5.0), Hold::First).unwrap()
}

fn squares<S: Real>(beta: f64) -> LeastSquares<S, 1> {
    LeastSquares::diagonal(&Vector1::new(Real::from_f64(1e6)), Real::from_f64(beta)).unwrap()
}

proptest! {
    #[test]
    fn window_is_the_integral_form(
        samples in prop::collection::vec((-10.0..10.0, -10.0..10.0, decades(-3, 0)), 1..40),
    ) {
        // Sides that run straight between the samples, in steps of different length.
        let mut window = WindowedRegression::<f64, 1, 1, 7>::new(Hold::First);
        let side = |&(known, factor, _): &(f64, f64, f64)| Sides { known: Vector1::new(known), factor: Vector1::new(factor) };
        for k in 1..samples.len() {
            let step = window.step([&side(&samples[k - 1]), &side(&samples[k])], samples[k].2);
            window.take(step);
            let inside = k.saturating_sub(7)..k;
            let length: f64 = inside.clone().map(|j| samples[j + 1].2).sum();
            let mean = |of: fn(&(f64, f64, f64)) -> f64| -> f64 {
                inside.clone().map(|j| f64::midpoint(of(&samples[j]), of(&samples[j + 1])) * samples[j + 1].2).sum::<f64>() / length
            };
            // Forty sums of numbers up to 10, over a length of at least 1e-3 of the longest.
            prop_assert!((window.duration() - length).abs() < 1e-14);
            prop_assert!((window.regressand().x - mean(|s| s.0)).abs() < 1e-10);
            prop_assert!((window.regressor().x - mean(|s| s.1)).abs() < 1e-10);
        }
    }
}

#[test]
fn window_gives_the_state_at_once_and_forgets_completely() {
    // A wrong start of chi is known after the first interval; after an unmeasured kick, when the window is past
    // it.
    let window = WindowedRegression::<f64, 1, 1, 10>::new(Hold::First);
    let gradient = Gradient::diagonal(&Vector1::new(1e9)).unwrap();
    let mut observer = Observer::with_regression(mass(), gradient, window, Vector1::new(3.0)).unwrap();
    let (mut x, mut y) = (-1.0, 0.5);
    let mut errors = Vec::new();
    for k in 0..60_u32 {
        let u = f64::from(k).sin();
        errors.push(observer.step(Vector1::new(y), Vector1::new(u), 0.1).unwrap().x - x);
        if k == 30 {
            x += 5.0;
        }
        // The input of the next call is that of the coming interval.
        let next = f64::from(k + 1).sin();
        y += x * 0.1 + next * 0.005;
        x += next * 0.1;
    }
    // A gain of 1e9 leaves 1e-8 of 4, and the straight line through a parabola nothing: chi and y agree on the
    // trapezoid.
    assert!(errors[1].abs() < 1e-7 && errors[30].abs() < 1e-12, "{errors:?}");
    assert!(errors[35].abs() > 1.0, "{errors:?}");
    assert!(errors[41].abs() < 1e-7 && errors[59].abs() < 1e-12, "{errors:?}");
}

#[test]
fn straight_inputs_need_the_first_order_hold() {
    // x' = t: with both ends of the interval the observer is exact, with the end alone it is late.
    let new = || Observer::new(mass(), squares(0.0), filter(), Vector1::zeros()).unwrap();
    let (mut straight, mut held) = (new(), new());
    for k in 0..100_u32 {
        let [before, now] = [k.saturating_sub(1), k].map(|k| Vector1::new(f64::from(k) * 0.1));
        straight.step_straight(now * 2.0, [before, now], 0.1).unwrap();
        held.step(now * 2.0, now, 0.1).unwrap();
    }
    let exact = 9.9 * 9.9 / 2.0;
    // A hundred roundings of numbers up to 50; half a step of an input of 9.9.
    assert!((straight.extension().chi().x - exact).abs() < 1e-12);
    assert!((held.extension().chi().x - exact - 0.05 * 9.9).abs() < 1e-12);
    // Either end is looked at, and a held input is a straight one.
    let (zero, bad) = (Vector1::zeros(), Vector1::new(f64::NAN));
    for u in [[zero, bad], [bad, zero]] {
        assert_eq!(straight.step_straight(zero, u, 0.1), Err(Fault::Input { index: 0 }));
    }
    let mut other = straight.clone();
    assert_eq!(straight.step(zero, zero, 0.1), other.step_straight(zero, [zero, zero], 0.1));
}

#[test]
fn gaps_lose_nothing() {
    // Three intervals with inputs 1, 2, 6, the outputs between them missing.
    let mut observer = Observer::new(mass(), squares(1.0), filter(), Vector1::zeros()).unwrap();
    observer.step(Vector1::new(0.0), Vector1::new(0.0), 0.1).unwrap();
    let mut gap = Gap::new();
    for (u, dt) in [(1.0, 0.1), (2.0, 0.2), (6.0, 0.1)] {
        gap.add(&Vector1::new(u), dt).unwrap();
    }
    let (u, dt) = gap.take();
    assert_eq!(gap, Gap::default());
    observer.step(Vector1::new(1.0), u, dt).unwrap();
    // The integral of the input: a few roundings of numbers up to 1.
    assert!((observer.extension().chi().x - 1.1).abs() < 1e-15 && (dt - 0.4).abs() < 1e-15);
    // Of a bad time nothing is taken; an input that is unknown takes time, and no part in the mean.
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let before = gap;
        assert_eq!(gap.add(&Vector1::new(1.0), bad), Err(Fault::Step));
        assert_eq!(gap, before);
    }
    for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
        gap.add(&Vector1::new(bad), 2.0).unwrap();
        let mut alone = gap;
        let (u, dt) = alone.take();
        assert_eq!(observer.step(Vector1::new(1.0), u, dt), Err(Fault::Input { index: 0 }));
        gap.add(&Vector1::new(3.0), 1.0).unwrap();
        assert_eq!(gap.take(), (Vector1::new(3.0), 3.0));
    }
}

#[test]
fn limits_refuse_what_they_name() {
    let limits = Limits::none()
        .outputs(&Vector1::new(-10.0), &Vector1::new(10.0))
        .and_then(|limits| limits.inputs(&Vector1::new(0.0), &Vector1::new(1.0)))
        .and_then(|limits| limits.gap(0.5))
        .unwrap();
    let check = |y, u, dt| limits.check(&Vector1::new(y), &Vector1::new(u), dt);
    assert_eq!(check(10.0, 1.0, 0.5), Ok(()));
    for y in [10.001, -11.0, f64::INFINITY, f64::NAN] {
        assert_eq!(check(y, 0.0, 0.1), Err(Fault::OutputRange { index: 0 }));
    }
    for u in [-0.1, 1.1, f64::NAN] {
        assert_eq!(check(0.0, u, 0.1), Err(Fault::InputRange { index: 0 }));
    }
    assert_eq!(check(0.0, 0.0, 0.6), Err(Fault::Gap));
    let none = Limits::<f64, 2, 1>::none();
    assert_eq!(none.check(&Vector2::new(1e300, -1e300), &Vector1::new(0.0), 1e300), Ok(()));
    assert_eq!(none.outputs(&Vector2::new(0.0, 1.0), &Vector2::new(1.0, 0.0)), Err(Fault::Limits));
    assert_eq!(none.inputs(&Vector1::new(f64::NAN), &Vector1::new(0.0)), Err(Fault::Limits));
    assert_eq!(none.gap(0.0), Err(Fault::Limits));
}

/// The largest distance between the estimates of the plain form and of another, and the largest `chi` of the latter.
fn compare<S: Real, E: Estimator<S, 1, 1>>(estimator: E, drift: Drift<S>, steps: u32) -> (f64, f64) {
    let real = |x: f64| -> S { Real::from_f64(x) };
    let mut plain = Observer::new(mass(), estimator.clone(), filter(), Vector1::new(real(2.0))).unwrap();
    let mut other = Observer::new(mass(), estimator, filter(), Vector1::new(real(2.0))).unwrap();
    let (mut distance, mut largest) = (0.0_f64, 0.0_f64);
    for k in 0..steps {
        let t = f64::from(k) * 0.01;
        // A speed of 1 + sin, and an offset of the input that chi integrates.
        let (y, u) = (Vector1::new(real(t - t.cos())), Vector1::new(real(t.cos() + 0.5)));
        let estimate = plain.step(y, u, real(0.01)).unwrap();
        let moved = other.step_without_drift(y, u, real(0.01), drift).unwrap();
        distance = distance.max(Real::to_f64((estimate - moved).x).abs());
        largest = largest.max(Real::to_f64(other.extension().chi().x).abs());
    }
    (distance, largest)
}

#[test]
fn forms_without_drift_give_the_same_estimates() {
    let gradient = Gradient::diagonal(&Vector1::new(20.0)).unwrap();
    let drem = Drem::new(Kreisselmeier::new(&Vector1::new(10.0), 2.0).unwrap(), &Vector1::new(50.0)).unwrap();
    let response = Drem::new(Response::<_, _, 1, 1>::new(squares(1.0)).unwrap(), &Vector1::new(50.0)).unwrap();
    for (drift, bound) in [(Drift::Free, 0.0), (Drift::Leak(1.0), 3.0), (Drift::Above(1.0), 1.02)] {
        // Roundings of numbers up to 12 in 2000 steps.
        let close =
            |(distance, chi): (f64, f64)| assert!(distance < 1e-11 && chi <= bound, "{distance} {chi} {drift:?}");
        close(compare(gradient, drift, 2000));
        close(compare(squares(1.0), drift, 2000));
        close(compare(drem, drift, 2000));
        close(compare(response, drift, 2000));
    }
    for bad in [Drift::Above(0.0), Drift::Above(f64::NAN), Drift::Leak(-1.0), Drift::Leak(f64::NAN)] {
        let mut observer = Observer::new(mass(), gradient, filter(), Vector1::zeros()).unwrap();
        let before = *observer.state();
        assert_eq!(observer.step_without_drift(Vector1::zeros(), Vector1::zeros(), 0.1, bad), Err(Fault::Gain));
        assert_eq!(*observer.state(), before);
    }
}

#[test]
fn window_moves_with_the_extension() {
    let window = WindowedRegression::<f64, 1, 1, 10>::new(Hold::First);
    let new = || Observer::with_regression(mass(), squares(1.0), window, Vector1::new(2.0)).unwrap();
    let (mut plain, mut moved) = (new(), new());
    for k in 0..100_u32 {
        let t = f64::from(k) * 0.1;
        let (y, u) = (Vector1::new(t.sin()), Vector1::new(-t.sin()));
        let estimate = plain.step(y, u, 0.1).unwrap();
        let free = moved.step_without_drift(y, u, 0.1, Drift::Free).unwrap();
        // Rounding of numbers up to 3 in a hundred steps.
        assert!((estimate - free).norm() < 1e-12);
    }
}

/// The error of `x` after a long time with an offset in the input.
fn lag<E: Estimator<f64, 1, 1>>(estimator: E, seconds: u32) -> f64 {
    let mut observer = Observer::new(mass(), estimator, filter(), Vector1::zeros()).unwrap();
    let mut error = f64::NAN;
    for k in 0..=seconds * 100 {
        // At rest, while the input says 0.1.
        error = observer.step(Vector1::new(0.0), Vector1::new(0.1), 0.01).unwrap().x;
        if k % 1000 == 0 {
            let chi = *observer.extension().chi();
            observer.rebase(&chi).unwrap();
        }
    }
    error
}

#[test]
fn offset_costs_what_the_documentation_says() {
    // theta is a ramp of slope -0.1. The filter itself is late by 1/alpha = 0.2 s, in regressand alone: 0.02 more.
    let gradient = Gradient::diagonal(&Vector1::new(20.0)).unwrap();
    // Sampling delays by dt: 1e-3.
    assert!((lag(gradient, 100) - 0.1 / 20.0 - 0.02).abs() < 2e-3);
    assert!((lag(squares(0.5), 100) - 0.1 / 0.5 - 0.02).abs() < 2e-3);
    // Half of what the ramp has run, and the filter's part.
    let [short, long] = [100, 200].map(|seconds| lag(squares(0.0), seconds));
    assert!((short - 5.0).abs() < 0.1 && (long - 10.0).abs() < 0.1, "{short} {long}");
}

#[test]
fn shifts_of_a_window_keep_its_identity() {
    let mut window = WindowedRegression::<f64, 1, 2, 3>::new(Hold::Zero);
    let eta = Vector2::new(1.0, -2.0);
    let shift = Vector2::new(0.5, 4.0);
    for k in 0..10_u32 {
        let factor = SMatrix::<f64, 1, 2>::new(f64::from(k), 1.0);
        let known = factor * if k > 5 { eta + shift } else { eta };
        if k == 6 {
            window.shift(&shift);
        }
        let sides = Sides { known, factor };
        let step = window.step([&sides, &sides], 0.5);
        window.take(step);
        let truth = if k > 5 { eta + shift } else { eta };
        // Dyadic numbers throughout, but for the mean over 1.5 s.
        assert!((window.regressor() * truth - window.regressand()).norm() < 1e-14);
    }
}
