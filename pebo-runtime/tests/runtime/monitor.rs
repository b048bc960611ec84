//! The excitation monitor against what it stands for: the spread of estimates under the noise of sensors.

use pebo_runtime::nalgebra::{Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3};
use pebo_runtime::{
    Estimator, Excitation, Fault, Filter, Flow, Hold, Integrator, LeastSquares, Model, Monitor, Observer, Real,
    Regression, Sides,
};
use proptest::prelude::*;

use crate::noise::Noise;
use crate::random::matrix;

#[test]
fn not_yet_then_converged_then_lost() {
    // Excitation of the second component only between 1 s and 2 s; data age within 0.5 s.
    let mut monitor = Monitor::of_white(&Vector2::new(0.1, 0.1), &Vector1::new(1e-3), 2.0).unwrap();
    let mut seen = Vec::new();
    for k in 0..500_u32 {
        let t = f64::from(k) * 0.01;
        let second = if (1.0..2.0).contains(&t) { (20.0 * t).sin() } else { 0.0 };
        monitor.advance(&SMatrix::<f64, 1, 2>::new(1.0, second), 0.01).unwrap();
        if seen.last() != Some(&monitor.excitation()) {
            seen.push(monitor.excitation());
        }
    }
    assert_eq!(seen, [Excitation::NotYet, Excitation::Converged, Excitation::Lost]);
    monitor.reset();
    assert_eq!((monitor.excitation(), monitor.standard_error()), (Excitation::NotYet, None));
}

/// Variances of the two components over many runs of least squares under white noise, and the monitor's prediction.
fn spread(beta: f64) -> (Vector2<f64>, Vector2<f64>) {
    let (dt, sigma, runs) = (0.01, 0.3, 4000);
    let mut noise = Noise::new(7);
    let mut predicted = None;
    let mut squares = Vector2::zeros();
    for _ in 0..runs {
        let mut estimator = LeastSquares::diagonal(&Vector2::new(1e6, 1e6), beta).unwrap();
        let mut monitor = Monitor::of_white(&Vector2::new(1.0, 1.0), &Vector1::new(sigma * sigma * dt), beta).unwrap();
        for k in 0..200_u32 {
            let phi = SMatrix::<f64, 1, 2>::new(1.0, (0.05 * f64::from(k)).cos());
            // The truth is 0: the estimate is its error.
            estimator.advance(&phi, &Vector1::new(sigma * noise.normal()), dt).unwrap();
            if predicted.is_none() {
                monitor.advance(&phi, dt).unwrap();
            }
        }
        squares += estimator.estimate().component_mul(estimator.estimate()) / f64::from(runs);
        predicted = predicted.or(monitor.standard_error());
    }
    let predicted = predicted.unwrap();
    (squares, predicted.component_mul(&predicted))
}

#[test]
fn standard_error_is_the_spread_of_least_squares() {
    for beta in [0.0, 3.0] {
        let (found, predicted) = spread(beta);
        let ratio = found.component_div(&predicted);
        // The variance of 4000 normal numbers is known to sqrt(2/4000) = 2.2 %: four of that.
        assert!((ratio - Vector2::new(1.0, 1.0)).abs().max() < 0.09, "{ratio} at {beta}");
    }
}

proptest! {
    #[test]
    fn level_is_the_smallest_eigenvalue(root in matrix::<3, 3>(-10.0..10.0), scale in 1e-6..1e6) {
        let mut monitor = Monitor::of_white(&Vector3::repeat(scale), &Vector3::repeat(1.0), 0.0).unwrap();
        monitor.advance(&root, 1.0).unwrap();
        let gramian: Matrix3<f64> = root.transpose() * root;
        let expected = gramian.symmetric_eigenvalues().min();
        // The covariance is the inverse, known to roundings times the condition number of the Gramian.
        let condition = gramian.norm() / expected;
        let ratio = monitor.level() / (scale * scale * expected);
        prop_assume!(condition < 1e8);
        prop_assert!((ratio - 1.0).abs() < 1e-14 * condition, "{} {}", ratio, condition);
    }
}

#[test]
fn singular_and_bad_data() {
    let mut monitor = Monitor::of_white(&Vector2::new(1.0, 1.0), &Vector1::new(1.0), 0.0).unwrap();
    monitor.advance(&SMatrix::<f64, 1, 2>::new(1.0, 1.0), 1.0).unwrap();
    assert_eq!((monitor.standard_error(), monitor.level().to_bits()), (None, 0.0_f64.to_bits()));
    let before = monitor;
    for (phi, dt, fault) in [(1.0, 0.0, Fault::Step), (f64::NAN, 1.0, Fault::State), (1e200, 1.0, Fault::State)] {
        assert_eq!(monitor.advance(&SMatrix::<f64, 1, 2>::new(phi, 1.0), dt), Err(fault));
        assert_eq!(monitor, before);
    }
    for (wanted, noise, beta) in [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, -1.0)] {
        assert_eq!(Monitor::of_white(&Vector1::new(wanted), &Vector1::new(noise), beta), Err(Fault::Gain));
    }
}

#[test]
fn a_converged_unknown_has_a_standard_error() {
    // A flux of 1 mWb beside a speed of 1000 rad/s in single precision: the two entries of the Gramian are 1e12 apart.
    let wanted = Vector2::new(1.0_f32, 1.0);
    let mut monitor = Monitor::of_white(&wanted, &Vector1::new(1e-3), 0.0).unwrap();
    for k in 0..255_u32 {
        let phase: f32 = Real::from_f64(f64::from(k) * 0.1);
        monitor.advance(&SMatrix::<f32, 1, 2>::new(1e6 * phase.sin(), phase.cos()), 0.01).unwrap();
    }
    assert_eq!(monitor.excitation(), Excitation::Converged);
    let error = monitor.standard_error().expect("it has converged");
    // 2.5 s of a mean square of 1/2, and white noise: sqrt(1e-3/1.28), and 1e6 times less.
    assert!((error.y / 0.028 - 1.0).abs() < 0.03 && (error.x / 0.028e-6 - 1.0).abs() < 0.03, "{error}");
}

/// `y' = x_1 + u x_2` with constant `x`: a regression that outputs enter by their rates alone.
struct Slope;

impl Model<2, 1, 1, 2, 1, 2> for Slope {
    type Scalar = f64;
    type Extension = Integrator<f64, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Flow<f64, 2> {
        Flow::plain(Vector2::zeros())
    }
    fn regression(&self, extension: &Self::Extension, _: &Vector1<f64>, u: &Vector1<f64>) -> Sides<f64, 1, 2> {
        let factor = SMatrix::<f64, 1, 2>::new(1.0, u.x);
        Sides { known: factor * extension.chi(), factor }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector1<f64>) -> Sides<f64, 1, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector2<f64>) -> Vector2<f64> {
        *eta
    }
    fn recover(&self, z: &Vector2<f64>, _: &Vector1<f64>) -> Vector2<f64> {
        *z
    }
}

/// Standard errors of the observer's estimate over many runs, over those that the monitor says.
fn monte_carlo(alpha: f64, beta: f64, steps: u32) -> Vector2<f64> {
    let (dt, sigma, runs) = (1e-3, 0.02, 500);
    let filter = Filter::new(alpha, Hold::First).unwrap();
    let mut noise = Noise::new(11);
    let mut squares = Vector2::zeros();
    let mut predicted = Vector2::zeros();
    for run in 0..runs {
        let estimator = LeastSquares::diagonal(&Vector2::repeat(1e6), beta).unwrap();
        let mut observer = Observer::new(Slope, estimator, filter, Vector2::zeros()).unwrap();
        let mut monitor = Monitor::of_rates(&Vector2::repeat(1.0), &Vector1::new(sigma), filter, beta).unwrap();
        for k in 0..=steps {
            // The truth is 0, so what is measured is noise.
            let u = Vector1::new((0.02 * f64::from(k)).sin());
            observer.step(Vector1::new(sigma * noise.normal()), u, dt).unwrap();
            if run == 0 && k > 0 {
                monitor.advance(observer.regression().regressor(), dt).unwrap();
            }
        }
        if run == 0 {
            predicted = monitor.standard_error().unwrap();
        }
        squares += observer.eta().component_mul(&observer.eta()) / f64::from(runs);
    }
    squares.map(f64::sqrt).component_div(&predicted)
}

#[test]
fn standard_error_of_an_observer_follows_from_sensors_and_filter() {
    for (alpha, beta, steps) in [(200.0, 0.0, 600), (20.0, 0.0, 600), (200.0, 10.0, 600), (f64::INFINITY, 0.0, 300)] {
        let ratio = monte_carlo(alpha, beta, steps);
        println!("Monte Carlo over monitor, filter {alpha}, forgetting {beta}: {:.3} {:.3}", ratio.x, ratio.y);
        // A standard deviation of 500 numbers is known to 1/sqrt(1000) = 3.2 %: four of that.
        assert!((ratio - Vector2::repeat(1.0)).abs().max() < 0.13, "{ratio} at {alpha} {beta}");
    }
}
