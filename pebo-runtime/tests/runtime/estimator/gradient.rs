//! The gradient estimator and the least-squares form of its step.

use crate::random::{decades, matrix, vector};
use pebo_runtime::nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};
use pebo_runtime::{Estimator, Fault, Gradient, Information, Real};
use proptest::prelude::*;

/// Signed entries over eleven decades, and zeros.
fn entry() -> impl Strategy<Value = f64> {
    prop_oneof![decades(-6, 5), decades(-6, 5).prop_map(|x| -x), Just(0.0)]
}

/// The size of an error in the norm of `Gamma^-1`.
fn size<const NE: usize>(error: &SVector<f64, NE>, gains: &SVector<f64, NE>) -> f64 {
    error.zip_map(gains, |error, gain| error / gain.sqrt()).norm()
}

/// One step on consistent data, in scalar `S`: the size of the error before and after, and what rounding may add.
fn sizes<S: Real, const NR: usize, const NE: usize>(
    gains: SVector<f64, NE>,
    regressor: SMatrix<f64, NR, NE>,
    start: SVector<f64, NE>,
    truth: SVector<f64, NE>,
    dt: f64,
) -> (f64, f64, f64) {
    let real = |x: f64| -> S { Real::from_f64(x) };
    let (phi, truth) = (regressor.map(real), truth.map(real));
    let mut gradient = Gradient::diagonal(&gains.map(real)).unwrap().starting_at(&start.map(real)).unwrap();
    let error = |gradient: &Gradient<S, NE>| (gradient.estimate() - truth).map(Real::to_f64);

    let before = size(&error(&gradient), &gains);
    gradient.advance(&phi, &(phi * truth), real(dt)).unwrap();
    let after = size(&error(&gradient), &gains);

    // The innovation is known up to n = eps |Phi| (|theta| + |theta_hat|), which moves the minimiser of
    // d^T Gamma^-1 d + dt |n - Phi d|^2 by at most sqrt(dt) |n| in this norm; the step itself and the sum with the old
    // estimate are off by a few eps of the numbers added, and of the step through the factor.
    let eps = Real::to_f64(S::EPSILON);
    let numbers = truth.map(Real::to_f64).abs() + start.abs();
    let noise = (regressor.abs() * numbers).norm() * dt.sqrt();
    (before, after, 64.0 * eps * (noise + size(&numbers, &gains)))
}

macro_rules! never_grows {
    ($name:ident, $rows:literal, $columns:literal) => {
        proptest! {
            #[test]
            fn $name(
                gains in vector::<$columns>(decades(-9, 12)),
                regressor in matrix::<$rows, $columns>(entry()),
                start in vector::<$columns>(-10.0..10.0),
                truth in vector::<$columns>(-10.0..10.0),
                dt in decades(-9, 3),
            ) {
                let (before, after, rounding) = sizes::<f64, $rows, $columns>(gains, regressor, start, truth, dt);
                prop_assert!(after <= before + rounding, "f64: {} {} {}", before, after, rounding);
                let (before, after, rounding) = sizes::<f32, $rows, $columns>(gains, regressor, start, truth, dt);
                prop_assert!(after <= before + rounding, "f32: {} {} {}", before, after, rounding);
            }
        }
    };
}

never_grows!(error_never_grows_square, 2, 2);
never_grows!(error_never_grows_wide, 1, 3);
never_grows!(error_never_grows_tall, 3, 2);

proptest! {
    #[test]
    fn step_is_implicit_euler(
        root in matrix::<3, 3>(-1.0..1.0),
        regressor in matrix::<2, 3>(-10.0..10.0),
        regressand in vector::<2>(-10.0..10.0),
        start in vector::<3>(-10.0..10.0),
        dt in decades(-4, 0),
    ) {
        // Well conditioned on purpose, so that the explicit inverse is a fair reference: |I + dt Gamma Phi^T Phi| <
        // 2e3.
        let gain = Matrix3::identity() + root * root.transpose();
        let mut gradient = Gradient::full(&gain).unwrap().starting_at(&start).unwrap();
        gradient.advance(&regressor, &regressand, dt).unwrap();
        let gathered = gain * regressor.transpose() * dt;
        let implicit = (Matrix3::identity() + gathered * regressor).try_inverse().unwrap()
            * (start + gathered * regressand);
        // eps times that condition number times numbers up to 1e3.
        prop_assert!((gradient.estimate() - implicit).norm() < 1e-9, "{} {implicit}", gradient.estimate());
    }

    #[test]
    fn diagonal_gain_is_a_full_one(
        gains in vector::<3>(decades(-6, 6)),
        regressor in matrix::<2, 3>(-10.0..10.0),
        regressand in vector::<2>(-10.0..10.0),
    ) {
        let mut diagonal = Gradient::diagonal(&gains).unwrap();
        let mut full = Gradient::full(&Matrix3::from_diagonal(&gains)).unwrap();
        diagonal.advance(&regressor, &regressand, 0.01).unwrap();
        full.advance(&regressor, &regressand, 0.01).unwrap();
        prop_assert_eq!(diagonal, full);
    }

    #[test]
    fn zero_columns_leave_their_component_alone(
        gains in vector::<4>(decades(-9, 12)),
        narrow in matrix::<2, 2>(entry()),
        regressand in vector::<2>(entry()),
        start in vector::<4>(-10.0..10.0),
        dt in decades(-9, 3),
    ) {
        // A model padded from 2 to 4 equations and unknowns steps as the one without padding.
        let mut padded = Gradient::diagonal(&gains).unwrap().starting_at(&start).unwrap();
        let mut regressor = SMatrix::<f64, 4, 4>::zeros();
        regressor.fixed_view_mut::<2, 2>(0, 0).copy_from(&narrow);
        padded.advance(&regressor, &SVector::<f64, 4>::new(regressand.x, regressand.y, 0.0, 0.0), dt).unwrap();

        let mut plain = Gradient::diagonal(&gains.xy()).unwrap().starting_at(&start.xy()).unwrap();
        plain.advance(&narrow, &regressand, dt).unwrap();
        prop_assert_eq!(padded.estimate().xy(), *plain.estimate());
        prop_assert_eq!(padded.estimate().fixed_rows::<2>(2), start.fixed_rows::<2>(2));
    }

    #[test]
    fn shifted_estimator_has_the_same_error(
        regressor in matrix::<2, 2>(-10.0..10.0), truth in vector::<2>(-10.0..10.0), shift in vector::<2>(-100.0..100.0),
    ) {
        let mut plain = Gradient::diagonal(&Vector2::new(0.1, 3.0)).unwrap();
        let mut shifted = plain;
        Estimator::<f64, 2, 2>::shift(&mut shifted, &shift);
        plain.advance(&regressor, &(regressor * truth), 0.1).unwrap();
        shifted.advance(&regressor, &(regressor * (truth + shift)), 0.1).unwrap();
        // Rounding of innovations up to 2200 times a gain of the step of at most sqrt(dt gamma)/2 = 0.3.
        prop_assert!((shifted.estimate() - shift - plain.estimate()).norm() < 1e-11);
    }

    #[test]
    fn information_is_least_squares(
        equations in matrix::<4, 3>(-3.0..3.0), values in vector::<4>(-3.0..3.0), weights in vector::<4>(decades(-2, 2)),
        prior in vector::<3>(decades(-1, 1)),
    ) {
        let mut information = Information::from_variances(&prior.map(|x| 1.0 / x)).unwrap();
        for i in 0..4 {
            information.absorb(&equations.row(i).transpose(), values[i], weights[i]);
        }
        let d = information.solve().unwrap();
        // At the minimum the gradient vanishes: W-weighted residuals up to 100 * 3 * (3 + 3 * |d|), rounded.
        let gradient = prior.component_mul(&d)
            - equations.transpose() * weights.component_mul(&(values - equations * d));
        prop_assert!(gradient.norm() < 1e-10, "{gradient}");
    }
}

#[test]
fn huge_gain_reaches_the_truth_in_one_step() {
    // A regressor of the Cuk converter, case I, at gains for which an explicit step would need 1e-22 s.
    let regressor = Matrix2::new(1.4e4, 3.1e4, 0.0, 4.4e4);
    let truth = Vector2::new(0.5, -1.0);
    let mut gradient = Gradient::diagonal(&Vector2::new(1e12, 1e12)).unwrap();
    gradient.advance(&regressor, &(regressor * truth), 1e-5).unwrap();
    // 1/(dt gamma |Phi|^2) = 1e-16 remains, and the condition of Phi, about 4, times eps.
    assert!((gradient.estimate() - truth).norm() < 1e-14);
}

#[test]
fn repeated_rows_of_huge_weight_are_one_row() {
    // The Gram matrix of these rows is singular to working precision by 20 digits: a factorisation of it would fail.
    let regressor = Matrix2::new(1e10, 1e10, 1e10, 1e10);
    let mut gradient = Gradient::diagonal(&Vector2::new(1.0, 1.0)).unwrap();
    gradient.advance(&regressor, &Vector2::new(2e10, 2e10), 1.0).unwrap();
    // The closest point to 0 on theta1 + theta2 = 2.
    assert!((gradient.estimate() - Vector2::new(1.0, 1.0)).norm() < 1e-15);
}

#[test]
fn overflow_is_a_fault() {
    let mut gradient = Gradient::diagonal(&Vector2::new(1.0, 1.0)).unwrap();
    let regressor = Matrix2::new(1e200, 0.0, 0.0, 1.0);
    assert_eq!(gradient.advance(&regressor, &Vector2::new(1.0, 1.0), 1.0), Err(Fault::State));
}

#[test]
fn gains_must_be_positive() {
    for gain in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320] {
        assert_eq!(Gradient::diagonal(&Vector2::new(1.0, gain)), Err(Fault::Gain), "{gain}");
    }
    let refused = [
        Matrix2::new(1.0, 0.5, 0.4, 1.0),
        Matrix2::new(1.0, 2.0, 2.0, 1.0),
        Matrix2::new(1.0, 1.0, 1.0, 1.0),
        Matrix2::new(-1.0, 0.0, 0.0, 1.0),
        Matrix2::new(1.0, f64::NAN, f64::NAN, 1.0),
        Matrix2::new(f64::INFINITY, 0.0, 0.0, 1.0),
    ];
    for gain in refused {
        assert_eq!(Gradient::full(&gain), Err(Fault::Gain), "{gain}");
    }
    let start = Vector3::new(0.0, f64::NAN, 0.0);
    assert_eq!(Gradient::diagonal(&Vector3::new(1.0, 1.0, 1.0)).unwrap().starting_at(&start), Err(Fault::Start));
}

/// True if the estimator calls itself finite at an estimate.
fn is_finite_at<E: Estimator<f64, 1, 2>>(mut estimator: E, estimate: &Vector2<f64>) -> bool {
    estimator.reset(estimate);
    estimator.is_finite()
}

#[test]
fn an_estimate_that_is_no_number_is_found() {
    let gradient = Gradient::diagonal(&Vector2::new(1.0, 2.0)).unwrap();
    assert!(is_finite_at(gradient, &Vector2::new(1.0, -2.0)));
    for broken in [f64::NAN, f64::INFINITY] {
        assert!(!is_finite_at(gradient, &Vector2::new(0.0, broken)), "{broken}");
    }
}
