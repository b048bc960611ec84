//! The excitation monitor against what it stands for: the spread of estimates under noise.

use pebo_runtime::nalgebra::{Matrix3, SMatrix, Vector1, Vector2, Vector3};
use pebo_runtime::{Estimator, Excitation, Fault, LeastSquares, Monitor};
use proptest::prelude::*;

use crate::noise::Noise;
use crate::random::matrix;

#[test]
fn not_yet_then_converged_then_lost() {
    // Excitation of the second component only between 1 s and 2 s; data age within 0.5 s.
    let mut monitor = Monitor::new(&Vector2::new(0.1, 0.1), 1e-3, 2.0).unwrap();
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
        let mut monitor = Monitor::new(&Vector2::new(1.0, 1.0), sigma * sigma * dt, beta).unwrap();
        for k in 0..200_u32 {
            let phi = SMatrix::<f64, 1, 2>::new(1.0, (0.05 * f64::from(k)).cos());
            // The truth is 0: the estimate is its error.
            estimator.advance(&phi, &Vector1::new(sigma * noise.normal()), dt).unwrap();
            monitor.advance(&phi, dt).unwrap();
        }
        squares += estimator.estimate().component_mul(estimator.estimate()) / f64::from(runs);
        predicted = monitor.standard_error();
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
        let mut monitor = Monitor::new(&Vector3::new(scale, scale, scale), 1.0, 0.0).unwrap();
        monitor.advance(&root, 1.0).unwrap();
        let gramian: Matrix3<f64> = root.transpose() * root;
        let expected = gramian.symmetric_eigenvalues().min();
        // Both algorithms are good to a few roundings of the largest entry, at most 300.
        prop_assert!((monitor.level() / (scale * scale) - expected).abs() < 1e-12, "{} {}", monitor.level(), expected);
    }
}

#[test]
fn singular_and_bad_data() {
    let mut monitor = Monitor::new(&Vector2::new(1.0, 1.0), 1.0, 0.0).unwrap();
    monitor.advance(&SMatrix::<f64, 1, 2>::new(1.0, 1.0), 1.0).unwrap();
    assert_eq!(monitor.standard_error(), None);
    // Rounding of an eigenvalue that is 0, beside one that is 2.
    assert!(monitor.level().abs() < 1e-15);
    let before = monitor;
    for (phi, dt, fault) in [(1.0, 0.0, Fault::Step), (f64::NAN, 1.0, Fault::State), (1e200, 1.0, Fault::State)] {
        assert_eq!(monitor.advance(&SMatrix::<f64, 1, 2>::new(phi, 1.0), dt), Err(fault));
        assert_eq!(monitor, before);
    }
    for (wanted, noise, beta) in [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, -1.0)] {
        assert_eq!(Monitor::new(&Vector1::new(wanted), noise, beta), Err(Fault::Gain));
    }
}
