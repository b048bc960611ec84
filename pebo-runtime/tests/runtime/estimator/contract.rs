//! The contract of every estimator: no growth of the error, convergence, and the promises of each.

use pebo_runtime::nalgebra::{Matrix1x3, SMatrix, SVector, Vector1, Vector2, Vector3};
use pebo_runtime::{
    Bounded, Drem, Estimator, Fault, FiniteTime, Gradient, Kreisselmeier, LeastSquares, NormalisedGradient, Real,
    RegressorExtension, Response,
};
use proptest::prelude::*;

use crate::random::{decades, matrix, vector};

type Vector<const N: usize> = SVector<f64, N>;

fn gradient<const N: usize>(gain: f64) -> Gradient<f64, N> {
    Gradient::diagonal(&Vector::repeat(gain)).unwrap()
}

fn least_squares<const N: usize>(variance: f64, beta: f64) -> LeastSquares<f64, N> {
    LeastSquares::diagonal(&Vector::repeat(variance), beta).unwrap()
}

fn kreisselmeier<const N: usize>(gain: f64, rate: f64) -> Kreisselmeier<f64, N> {
    Kreisselmeier::new(&Vector::repeat(gain), rate).unwrap()
}

fn drem<X, const N: usize>(extension: X, gain: f64) -> Drem<f64, X, N> {
    Drem::new(extension, &Vector::repeat(gain)).unwrap()
}

fn response<E, const NR: usize, const N: usize>(estimator: E) -> Response<f64, E, NR, N>
where
    E: Estimator<f64, NR, N> + Copy,
{
    Response::new(estimator).unwrap()
}

/// The regressor of the interval excitation example: exciting for 3 s, zero after.
fn interval(t: f64) -> Matrix1x3<f64> {
    if t < 3.0 { Matrix1x3::new(1.0, (2.0 * t).sin(), t.cos()) } else { Matrix1x3::zeros() }
}

const TRUTH: [f64; 3] = [1.0, -2.0, 0.5];

/// The error at the end of a run of the interval example at 1 kHz.
fn after<E: Estimator<f64, 1, 3>>(mut estimator: E, duration: u32) -> f64 {
    let truth = Vector3::from(TRUTH);
    for k in 1..=duration * 1000 {
        let phi = interval(f64::from(k) * 1e-3);
        estimator.advance(&phi, &(phi * truth), 1e-3).unwrap();
    }
    (estimator.estimate() - truth).norm() / truth.norm()
}

#[test]
fn interval_excitation_suffices_where_promised() {
    // Gradients stop short of the truth with the excitation.
    assert!(after(gradient(1.0), 20) > 0.05);
    assert!(after(NormalisedGradient::new(gradient(1.0), 1.0).unwrap(), 20) > 0.05);
    // So does what forgets.
    let (at_the_end, later) =
        (after(drem(kreisselmeier(1.0, 2.0), 10.0), 4), after(drem(kreisselmeier(1.0, 2.0), 10.0), 20));
    assert!(later > 0.05 && (later - at_the_end).abs() < 0.01 * later, "{at_the_end} {later}");
    // These have memory: determinants above 0.005 from 3 s on and a gain of 1e5/s leave e^(-1e5 0.005^2 17) of the
    // error.
    assert!(after(drem(kreisselmeier(10.0, 0.0), 1e5), 20) < 1e-6);
    assert!(after(drem(response(gradient(3.0)), 1e5), 20) < 1e-6);
    assert!(after(drem(response(least_squares(100.0, 0.0)), 1e5), 20) < 1e-6);
    // Finite time: exact when the clip is passed, within the excitation. Rounding of 2000 steps over a clip of 0.1.
    for estimator in [FiniteTime::once, |drem, clip| FiniteTime::tracking(drem, clip, 1.0)] {
        let estimator = estimator(drem(response(least_squares(100.0, 0.0)), 30.0), 0.1).unwrap();
        assert!(after(estimator, 3) < 1e-12);
    }
    // Least squares: only the weight of the start is left, 1e-6 beside an information of 0.1 and more.
    assert!(after(least_squares(1e6, 0.0), 3) < 1e-4);
    // The inflow of the start's information does not move the estimate once excitation is over.
    let (at_the_end, later) = (after(least_squares(1e3, 1.0), 4), after(least_squares(1e3, 1.0), 20));
    assert!((at_the_end - later).abs() < 1e-12, "{at_the_end} {later}");
}

/// The largest error after 3 s of steady excitation and, after a jump of the unknown, at 1 s and at 30 s.
fn jump<E: Estimator<f64, 1, 3>>(mut estimator: E) -> [f64; 3] {
    let mut truth = Vector3::from(TRUTH);
    let mut errors = [0.0; 3];
    for k in 1..=33_000_u32 {
        let phi = interval(f64::from(k % 3000) * 1e-3);
        estimator.advance(&phi, &(phi * truth), 1e-3).unwrap();
        let error = (estimator.estimate() - truth).norm();
        match k {
            3000 => (errors[0], truth) = (error, -truth),
            4000 => errors[1] = error,
            33_000 => errors[2] = error,
            _ => {}
        }
    }
    errors
}

#[test]
fn jumps_are_followed_as_documented() {
    // Without forgetting least squares averages before and after: after ten times as long, a tenth of the jump is left.
    let [before, _, late] = jump(least_squares(1e6, 0.0));
    assert!(before < 1e-4 && late > 0.2, "{before} {late}");
    // With it, e^(-1 s/0.1 s) is left of a jump of 4.6, times the condition of one period.
    let [before, soon, late] = jump(least_squares(1e6, 10.0));
    assert!(before < 1e-4 && soon < 0.3 && late < 1e-4, "{before} {soon} {late}");
    // The finite-time estimate on a memory that forgets: exact again, to what the memory keeps after 30 s.
    let extension = kreisselmeier(100.0, 3.0);
    let [before, _, late] = jump(FiniteTime::tracking(drem(extension, 1e6), 0.1, 0.5).unwrap());
    assert!(before < 1e-9 && late < 1e-9, "{before} {late}");
}

#[test]
fn finite_time_comes_before_asymptotic() {
    // The moment the clip is passed the estimate is exact, while DREM on the same data still has 1 - clip of its error.
    let truth = Vector2::new(3.0, -1.0);
    let start = Vector2::new(10.0, 10.0);
    let plain = Drem::new(kreisselmeier(1.0, 0.0), &Vector2::new(5.0, 5.0)).unwrap().starting_at(&start).unwrap();
    let mut finite = FiniteTime::once(plain, 0.2).unwrap();
    let mut plain = plain;
    let mut steps = 0_u32;
    while !finite.has_arrived() {
        steps += 1;
        let t = f64::from(steps) * 0.01;
        let phi = SMatrix::<f64, 1, 2>::new(1.0, t.sin());
        plain.advance(&phi, &(phi * truth), 0.01).unwrap();
        finite.advance(&phi, &(phi * truth), 0.01).unwrap();
        let ahead = finite.estimate() - start;
        let moved = plain.estimate() - start;
        // Never more than 1/clip ahead of DREM; a rounding for the quotient.
        assert!(ahead.norm() <= moved.norm() / 0.2 * (1.0 + 1e-12));
    }
    let error = |estimate: Vector2<f64>| (estimate - truth).norm();
    // Rounding of numbers up to 10, over the clip.
    assert!(error(finite.estimate()) < 1e-12);
    assert!(error(*plain.estimate()) > 0.7 * error(start));
}

#[test]
fn normalised_speed_does_not_depend_on_size() {
    // Large regressors: theta' = gamma/mu (eta - theta), whatever their size. One implicit step of 0.1 s at 2/s.
    for size in [1e3, 1e6, 1e9] {
        let mut estimator = NormalisedGradient::new(gradient::<1>(2.0), 1.0).unwrap();
        estimator.advance(&Vector1::new(size), &Vector1::new(size), 0.1).unwrap();
        // The 1 in 1 + mu |Phi|^2 is below 1e-6 of it.
        assert!((estimator.estimate().x - 0.2 / 1.2).abs() < 1e-6);
    }
}

#[test]
fn least_squares_is_the_batch_solution() {
    // After any number of steps: the minimiser of sum dt |v - Phi theta|^2 + |theta|^2/P_0, solved at once.
    let (dt, variance) = (0.1, 4.0);
    let mut recursive = least_squares::<2>(variance, 0.0);
    let mut gramian = SMatrix::<f64, 2, 2>::identity() / variance;
    let mut correlation = Vector2::zeros();
    for k in 0..50_u32 {
        let t = f64::from(k);
        let (phi, v) = (SMatrix::<f64, 1, 2>::new(t.sin(), 1.0), Vector1::new((3.0 * t).cos()));
        recursive.advance(&phi, &v, dt).unwrap();
        gramian += phi.transpose() * phi * dt;
        correlation += phi.transpose() * v * dt;
        let batch = gramian.try_inverse().unwrap() * correlation;
        // The condition number of the Gramian is at most 1 + 4 * 5; fifty steps of a few roundings each.
        assert!((recursive.estimate() - batch).norm() < 1e-13);
    }
}

#[test]
fn covariance_is_bounded_by_its_start() {
    // Forgetting for a hundred time constants without excitation in the second direction, then with none at all.
    let mut estimator = least_squares::<2>(2.0, 1.0);
    for k in 0..2000_u32 {
        let phi = SMatrix::<f64, 1, 2>::new(if k < 1000 { 30.0 } else { 0.0 }, 0.0);
        estimator.advance(&phi, &Vector1::new(0.0), 0.1).unwrap();
    }
    // R is back at R_0 = 1/2, up to the roundings of 1000 steps, which forgetting keeps from adding up.
    let weight = SVector::<f64, 2>::from_fn(|i, _| estimator.information().weight()[i]);
    assert!((weight - Vector2::new(0.5, 0.5)).norm() < 1e-13, "{weight}");
}

#[test]
fn determinant_goes_from_zero_to_one() {
    let mut estimator = drem(response(least_squares::<3>(1e3, 0.0)), 1.0);
    let mut last = 0.0;
    assert_eq!(estimator.determinant::<1>().to_bits(), 0.0_f64.to_bits());
    for k in 1..3000_u32 {
        let phi = interval(f64::from(k) * 1e-3);
        estimator.advance(&phi, &(phi * Vector3::from(TRUTH)), 1e-3).unwrap();
        let now = estimator.determinant::<1>();
        // Roundings of a determinant of numbers up to 1.
        assert!(now >= last - 1e-14 && now <= 1.0 + 1e-14, "{last} {now}");
        last = now;
    }
    assert!(last > 0.9, "{last}");
}

#[test]
fn bounds_hold_and_move() {
    let mut estimator =
        Bounded::new(gradient::<2>(1e6), &Vector2::new(-1.0, f64::NEG_INFINITY), &Vector2::new(1.0, 0.5)).unwrap();
    let truth = Vector2::new(2.0, -3.0);
    let phi = SMatrix::<f64, 2, 2>::identity();
    estimator.advance(&phi, &truth, 1.0).unwrap();
    let estimate = Estimator::<f64, 2, 2>::estimate(&estimator);
    // The first is cut, the second is not: 1e-6 of it is what the gain leaves.
    assert!((estimate - Vector2::new(1.0, -3.0)).norm() < 1e-5);
    Estimator::<f64, 2, 2>::shift(&mut estimator, &Vector2::new(10.0, 10.0));
    assert!((Estimator::<f64, 2, 2>::estimate(&estimator) - Vector2::new(11.0, 7.0)).norm() < 1e-5);
    Estimator::<f64, 2, 2>::reset(&mut estimator, &Vector2::new(5.0, 0.25));
    assert_eq!(Estimator::<f64, 2, 2>::estimate(&estimator), Vector2::new(1.0, 0.25));
    assert_eq!(Bounded::new(gradient::<1>(1.0), &Vector1::new(1.0), &Vector1::new(0.0)), Err(Fault::Start));
    assert_eq!(Bounded::new(gradient::<1>(1.0), &Vector1::new(f64::NAN), &Vector1::new(0.0)), Err(Fault::Start));
}

#[test]
fn settings_out_of_range_are_refused() {
    let one = Vector1::new(1.0);
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(LeastSquares::diagonal(&one, bad), Err(Fault::Gain));
        assert_eq!(LeastSquares::diagonal(&Vector1::new(bad), 0.0), Err(Fault::Gain));
        assert_eq!(Kreisselmeier::new(&one, bad), Err(Fault::Gain));
        assert_eq!(Kreisselmeier::new(&Vector1::new(bad), 0.0), Err(Fault::Gain));
        assert_eq!(Drem::new(kreisselmeier::<1>(1.0, 0.0), &Vector1::new(bad)), Err(Fault::Gain));
        assert_eq!(NormalisedGradient::new(gradient::<1>(1.0), bad), Err(Fault::Gain));
        assert_eq!(FiniteTime::tracking(drem::<_, 1>(kreisselmeier::<1>(1.0, 0.0), 1.0), 0.5, bad), Err(Fault::Gain));
    }
    for bad in [0.0, 1.0, -1.0, f64::NAN] {
        assert_eq!(FiniteTime::once(drem::<_, 1>(kreisselmeier::<1>(1.0, 0.0), 1.0), bad), Err(Fault::Gain));
    }
}

/// Signed entries over eleven decades, and zeros.
fn entry() -> impl Strategy<Value = f64> {
    prop_oneof![decades(-6, 5), decades(-6, 5).prop_map(|x| -x), Just(0.0)]
}

/// Samples of a regression: regressors and step lengths.
fn samples() -> impl Strategy<Value = Vec<(SMatrix<f64, 2, 3>, f64)>> {
    prop::collection::vec((matrix::<2, 3>(entry()), decades(-6, 2)), 1..30)
}

/// Runs an estimator whose components all have the gain or variance `gain`, in scalar `S`, on consistent data.
fn never_grows<S: Real, E: Estimator<S, 2, 3>>(
    mut estimator: E,
    samples: &[(SMatrix<f64, 2, 3>, f64)],
    truth: &Vector3<f64>,
    gain: f64,
) -> Result<(), TestCaseError> {
    let real = |x: f64| -> S { Real::from_f64(x) };
    let truth = truth.map(real);
    let error = |estimator: &E| (estimator.estimate() - truth).map(Real::to_f64).norm();
    let mut bound = error(&estimator);
    for (phi, dt) in samples {
        // As for one gradient step (see there): the innovation is known up to eps |Phi| (|theta| + |theta_hat|), which
        // moves the estimate by sqrt(gain dt) of that at most, and the sums round.
        let numbers = (truth.abs() + estimator.estimate().abs()).map(Real::to_f64);
        let noise = (phi.abs() * numbers).norm() * (gain * dt).sqrt();
        bound += 64.0 * Real::to_f64(S::EPSILON) * (noise + numbers.norm());
        let phi = phi.map(real);
        estimator.advance(&phi, &(phi * truth), real(*dt)).unwrap();
        prop_assert!(estimator.is_finite());
        prop_assert!(error(&estimator) <= bound, "{} {}", error(&estimator), bound);
    }
    Ok(())
}

macro_rules! errors_never_grow {
    ($name:ident, $scalar:ident) => {
        proptest! {
            /// Gains over twenty decades, regressors over eleven, steps over eight.
            #[test]
            fn $name(
                samples in samples(), truth in vector::<3>(-10.0..10.0), gain in decades(-10, 10), beta in decades(-6, 6),
            ) {
                let real = <$scalar as Real>::from_f64;
                let gains = SVector::<$scalar, 3>::repeat(real(gain));
                let gradient = Gradient::diagonal(&gains).unwrap();
                never_grows(gradient, &samples, &truth, gain)?;
                never_grows(NormalisedGradient::new(gradient, 1.0).unwrap(), &samples, &truth, gain)?;
                never_grows(LeastSquares::diagonal(&gains, 0.0).unwrap(), &samples, &truth, gain)?;
                never_grows(LeastSquares::diagonal(&gains, real(beta)).unwrap(), &samples, &truth, gain)?;
            }
        }
    };
}

errors_never_grow!(errors_never_grow_in_double, f64);
errors_never_grow!(errors_never_grow_in_single, f32);

proptest! {
    #[test]
    fn memory_moves_with_a_shift(
        phis in prop::collection::vec(matrix::<2, 3>(-3.0..3.0), 4..8), truth in vector::<3>(-3.0..3.0),
        shift in vector::<3>(-3.0..3.0), start in vector::<3>(-3.0..3.0),
    ) {
        moves(gradient(1.0).starting_at(&start).unwrap(), &phis, &truth, &shift)?;
        moves(NormalisedGradient::new(gradient(1.0).starting_at(&start).unwrap(), 0.5).unwrap(), &phis, &truth, &shift)?;
        moves(least_squares(10.0, 1.0).starting_at(&start).unwrap(), &phis, &truth, &shift)?;
        moves(drem(kreisselmeier(1.0, 1.0), 10.0).starting_at(&start).unwrap(), &phis, &truth, &shift)?;
        moves(drem(response(gradient(1.0).starting_at(&start).unwrap()), 10.0), &phis, &truth, &shift)?;
        moves(drem(response(least_squares(10.0, 1.0).starting_at(&start).unwrap()), 10.0), &phis, &truth, &shift)?;
        moves(FiniteTime::once(drem(kreisselmeier(1.0, 1.0), 10.0), 0.1).unwrap(), &phis, &truth, &shift)?;
        moves(FiniteTime::tracking(drem(kreisselmeier(1.0, 1.0), 10.0), 0.1, 0.2).unwrap(), &phis, &truth, &shift)?;
    }

    #[test]
    fn response_is_the_estimators_own(
        phis in prop::collection::vec(matrix::<2, 3>(-3.0..3.0), 1..8), truth in vector::<3>(-3.0..3.0), start in vector::<3>(-3.0..3.0),
    ) {
        let mut extension = response(least_squares(10.0, 1.0).starting_at(&start).unwrap());
        for phi in &phis {
            extension.advance(phi, &(phi * truth), 0.1).unwrap();
            // Q eta = q: numbers up to 10, eight steps of a problem with a condition number of 1e3 at most.
            prop_assert!((extension.matrix() * truth - extension.vector()).norm() < 1e-11);
        }
    }

    #[test]
    fn drem_components_never_grow(
        samples in samples(), truth in vector::<3>(-10.0..10.0), gain in decades(-6, 6), speed in decades(-6, 6),
    ) {
        let mut estimator = drem(kreisselmeier::<3>(gain, 0.1), speed);
        let mut last: Vector3<f64> = truth.abs();
        // The diagonal of the Gramian.
        let mut seen = Vector3::zeros();
        for (phi, dt) in &samples {
            estimator.advance(phi, &(phi * truth), *dt).unwrap();
            let now = (estimator.estimate() - truth).abs();
            let share = -(-0.1 * dt).exp_m1();
            seen = seen * (1.0 - share) + (phi.transpose() * phi).diagonal() * (share / 0.1);
            // In units with equal data for each unknown, the determinant and the mixed innovation are sums of products
            // up to 1 and `size`, rounded; the step is at most 1/Delta of the latter, and never taken where Delta is
            // but rounding: half of sqrt(gamma dt) at most.
            let units = seen.map(|seen| (seen + 1.0 / gain).sqrt());
            let size = units.dot(&(truth.abs() + last));
            let noise = (units.map(|unit| size / unit) + last) * 1e-13 * (1.0 + (speed * dt).sqrt());
            prop_assert!((now - last - noise).max() <= 0.0, "{} {} {}", now, last, noise);
            last = now;
        }
    }
}

/// Two runs, one with a shift in the middle: the same error after it.
fn moves<E: Estimator<f64, 2, 3>>(
    estimator: E,
    phis: &[SMatrix<f64, 2, 3>],
    truth: &Vector3<f64>,
    shift: &Vector3<f64>,
) -> Result<(), TestCaseError> {
    let (mut plain, mut moved) = (estimator.clone(), estimator);
    for (k, phi) in phis.iter().enumerate() {
        let eta = if k < 3 { *truth } else { truth + shift };
        if k == 3 {
            moved.shift(shift);
        }
        plain.advance(phi, &(phi * truth), 0.1).unwrap();
        moved.advance(phi, &(phi * eta), 0.1).unwrap();
        let distance = (moved.estimate() - shift * f64::from(u8::from(k >= 3)) - plain.estimate()).norm();
        // Rounding of innovations up to 60 in problems with a condition number of 1e3 at most.
        prop_assert!(distance < 1e-10, "{} at {}", distance, k);
    }
    Ok(())
}
