//! Least squares against the Cramer-Rao bound of the regression that it is given.

use pebo_runtime::nalgebra::{Matrix2, Vector1, Vector2};
use pebo_runtime::{Estimator, LeastSquares, Model};

use crate::converter::{CaseTwo, Loop};
use crate::noise::Noise;

const DT: f64 = 1e-5;
const SAMPLES: usize = 200;
const RUNS: u32 = 20_000;

/// The regressors of the first samples of the converter's closed loop, case II, as the plant goes.
fn regressors() -> Vec<Matrix2<f64>> {
    let mut closed = Loop::<f64, CaseTwo<f64>>::new(1.0, [1.0, 10.0], DT).unwrap();
    let mut all = Vec::new();
    for _ in 0..SAMPLES {
        closed.advance().unwrap();
        let duty = Vector1::new(closed.duty());
        all.push(closed.observer.model().phi_1(closed.observer.extension(), &closed.outputs(), &duty));
    }
    all
}

#[test]
fn least_squares_reaches_the_cramer_rao_bound() {
    let regressors = regressors();
    // White noise of different size in the two equations of case II: in V/s and in A/s.
    let sigma = Vector2::new(2e3, 50.0);
    let truth = Vector2::new(0.5, -19.0);
    // The bound: the inverse of the Fisher information, of which every sample adds Phi^T diag(sigma)^-2 Phi.
    let precision = Matrix2::from_diagonal(&sigma.map(|s| 1.0 / (s * s)));
    let information = regressors.iter().fold(Matrix2::zeros(), |sum, phi| sum + phi.transpose() * precision * phi);
    let bound = information.try_inverse().unwrap().diagonal();

    let mut noise = Noise::new(3);
    let mut squares = Vector2::zeros();
    let mut mean = Vector2::zeros();
    for _ in 0..RUNS {
        let mut estimator = LeastSquares::diagonal(&Vector2::new(1e9, 1e9), 0.0).unwrap();
        for phi in &regressors {
            let known = phi * truth + Vector2::new(noise.normal(), noise.normal()).component_mul(&sigma);
            // The equations in units of their noise.
            let scale = Matrix2::from_diagonal(&sigma.map(|s| 1.0 / s));
            estimator.advance(&(scale * phi), &(scale * known), DT).unwrap();
        }
        let error = estimator.estimate() - truth;
        squares += error.component_mul(&error) / f64::from(RUNS);
        mean += error / f64::from(RUNS);
    }
    let ratio = squares.component_div(&bound);
    // The variance of 20000 normal numbers is known to sqrt(2/20000) = 1 %: four of that, well inside the 10 % asked
    // for.
    assert!((ratio - Vector2::new(1.0, 1.0)).abs().max() < 0.04, "{ratio}");
    // Unbiased: the mean of 20000 is known to 1/sqrt(20000) of the spread; four of that.
    let bias = mean.component_div(&bound.map(f64::sqrt)).abs().max();
    assert!(bias < 4.0 / f64::from(RUNS).sqrt(), "{bias}");
}
