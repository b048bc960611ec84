//! Single precision at its ends: steps of 100 ns for long, huge and tiny gains, outliers, equations more and fewer than
//! unknowns.

use pebo_runtime::nalgebra::{Matrix1, SMatrix, SVector, Vector1};
use pebo_runtime::{
    Drem, Estimator, FiniteTime, Gap, Gradient, Hold, Kreisselmeier, LeastSquares, NormalisedGradient,
    RegressionOperator, Response, Sides, WindowedRegression,
};

/// `Delta` is 1/2 from the first steps on: with the regressor 1, Q settles at 1/forgetting, and the gain times that is
/// 1.
fn drem(gain: f32) -> Drem<f32, Kreisselmeier<f32, 1>, 1> {
    Drem::new(Kreisselmeier::new(&Vector1::new(1e7), 1e7).unwrap(), &Vector1::new(gain)).unwrap()
}

/// One step of an equation with the regressor 1.
fn see(estimator: &mut impl Estimator<f32, 1, 1>, known: f32, dt: f32) {
    estimator.advance(&Matrix1::new(1.0), &Vector1::new(known), dt).unwrap();
}

#[test]
fn finite_time_is_exact_however_little_a_step_contracts() {
    // A step takes 1e-7 gain Delta^2 of the error: from far below the resolution of f32 to the whole.
    for gain in [0.01, 0.1, 1.0, 10.0, 1e3, 1e8] {
        let dt = 1e-7;
        let mut estimator = FiniteTime::once(drem(gain), 1e-4).unwrap();
        // Past the clip after 1e-4/(gain dt Delta^2) steps: 4000 at gain 1.
        for _ in 0..100_000 {
            if estimator.has_arrived() {
                break;
            }
            see(&mut estimator, 5.0, dt);
        }
        // A gain too low for that many steps has not arrived, and must not be beyond.
        let estimate = Estimator::<f32, 1, 1>::estimate(&estimator).x;
        if gain >= 1.0 {
            assert!(estimator.has_arrived(), "{gain}");
            // Of the numbers between, the smallest is a difference of 5e-4 from 0: some roundings of it.
            assert!((estimate - 5.0).abs() < 1e-4, "{gain}: {estimate}");
        }
        assert!(estimate < 5.001, "{gain}: {estimate}");
    }
}

#[test]
fn references_ripen_however_short_the_step() {
    // At an age of more than 2 s a step of 100 ns is less than half the resolution.
    let mut estimator = FiniteTime::tracking(drem(2.0), 0.1, 2.1).unwrap();
    let run = |estimator: &mut FiniteTime<_, _, 1>, known: f32, steps: u32, dt: f32| {
        for _ in 0..steps {
            see(estimator, known, dt);
        }
    };
    run(&mut estimator, 1.0, 41, 0.05);
    // A jump at 2.05 s, and a reference behind it at 2.1 s.
    run(&mut estimator, -3.0, 1_000_000, 1e-7);
    // That serves from 4.2 s on. DREM itself has a third of the jump before it then: e^(-gain Delta^2 2.1 s).
    run(&mut estimator, -3.0, 42, 0.05);
    let estimate = Estimator::<f32, 1, 1>::estimate(&estimator).x;
    // Of a million roundings in theta and in the weight, carried along.
    assert!((estimate + 3.0).abs() < 1e-4, "{estimate}");
}

#[test]
fn a_long_gap_is_as_long_as_it_was() {
    // 4 s in steps of 100 ns: each is a fifth of the resolution of the sum at its end.
    let mut gap = Gap::<f32, 1>::new();
    for _ in 0..40_000_000 {
        gap.add(&Vector1::new(3.0), 1e-7).unwrap();
    }
    let (u, dt) = gap.take();
    // Few roundings, where a plain sum ends at 2 s.
    assert!((dt - 4.0).abs() < 1e-5 && (u.x - 3.0).abs() < 1e-5, "{dt} {}", u.x);
}

#[test]
fn an_empty_window_says_nothing() {
    let window = WindowedRegression::<f32, 1, 1, 8>::new(Hold::First);
    let (known, factor) = (RegressionOperator::regressand(&window).x, RegressionOperator::regressor(&window).x);
    assert_eq!((known, factor, window.duration()), (0.0, 0.0, 0.0));
}

#[test]
fn a_window_forgets_outliers_to_the_last_bit() {
    let side = |known: f32, factor: f32| Sides { known: Vector1::new(known), factor: Matrix1::new(factor) };
    let advance = |window: &mut WindowedRegression<f32, 1, 1, 8>, known: f32, factor: f32, dt: f32| {
        let step = window.step([&side(known, factor), &side(known, factor)], dt);
        window.take(step);
    };
    // Numbers beyond the 48 bits of a sum beside ordinary ones: values, and times.
    for outliers in [[(1e30, 1e20, 1e-3), (1e12, 1e10, 1e-3)], [(1.0, 1.0, 1e30), (1.0, 1.0, 1e10)]] {
        let mut window = WindowedRegression::<f32, 1, 1, 8>::new(Hold::First);
        for (known, factor, dt) in outliers {
            advance(&mut window, known, factor, dt);
        }
        for _ in 0..16 {
            advance(&mut window, 3.0, 2.0, 1e-3);
        }
        // Means of equal numbers, some roundings apart.
        let (known, factor) = (RegressionOperator::regressand(&window).x, RegressionOperator::regressor(&window).x);
        assert!((known - 3.0).abs() < 1e-6 && (factor - 2.0).abs() < 1e-6, "{known} {factor}");
        assert!((window.duration() - 8e-3).abs() < 1e-8);
    }
}

/// Feeds consistent data of one unknown, 2, from the estimate 0, as an observer does: no gain, step or regressor may
/// bring the estimate beyond, and none may be refused but for what overflows.
fn never_beyond(mut estimator: impl Estimator<f32, 1, 1>, gain: f32, what: &str) {
    for step in 0..50 {
        for dt in [1e-7_f32, 1e-2, 1e5] {
            for factor in [0.0_f32, 1e-12, 1.0, -1e12] {
                let data = (Matrix1::new(factor), Vector1::new(factor * 2.0));
                let mut next = estimator.clone();
                if next.advance(&data.0, &data.1, dt).is_ok() && next.is_finite() {
                    estimator = next;
                } else {
                    // Gain times Gramian is beyond f32.
                    let product = f64::from(gain) * f64::from(factor * factor) * f64::from(dt);
                    assert!(product > 1e36, "{what}, {step}: refused {factor} {dt}");
                }
                let estimate = estimator.estimate().x;
                // A rounding for each step.
                assert!((-1e-4..2.0001).contains(&estimate), "{what}, {step}: {estimate}");
            }
        }
    }
}

#[test]
fn no_gain_is_too_large_or_too_small() {
    for gain in [1e-36_f32, 1e-10, 1.0, 1e10, 1e36] {
        let gains = Vector1::new(gain);
        let gradient = Gradient::diagonal(&gains).unwrap();
        never_beyond(gradient, gain, &format!("gradient {gain}"));
        for mu in [0.0, 1e-30, 1e30] {
            never_beyond(NormalisedGradient::new(gradient, mu).unwrap(), gain, &format!("normalised {gain} {mu}"));
        }
        for rate in [0.0, 1e-10, 1e10] {
            let squares = LeastSquares::diagonal(&gains, rate).unwrap();
            never_beyond(squares, gain, &format!("least squares {gain} {rate}"));
            let response = Response::<f32, _, 1, 1>::new(squares).unwrap();
            for speed in [1e-36, 1.0, 1e36] {
                let speed = Vector1::new(speed);
                let memory = Kreisselmeier::new(&gains, rate).unwrap();
                let drem = Drem::new(memory, &speed).unwrap();
                let what = format!("{gain} {rate} {}", speed.x);
                never_beyond(drem, gain, &format!("drem {what}"));
                never_beyond(Drem::new(response, &speed).unwrap(), gain, &format!("least squares and drem {what}"));
                never_beyond(FiniteTime::once(drem, 0.1).unwrap(), gain, &format!("finite time {what}"));
            }
        }
    }
}

/// An estimator on `NR` equations of `NE` unknowns, whose regressors turn so that all unknowns are identifiable.
fn converges<const NR: usize, const NE: usize>(mut estimator: impl Estimator<f64, NR, NE>) {
    let truth = SVector::<f64, NE>::from_fn(|i, _| [1.0, -2.0, 0.5, 3.0][i % 4]);
    for k in 0..4000_u32 {
        let phase =
            |i: usize, j: usize| f64::from(k) * 0.1 * [1.0, 1.7, 2.3, 3.1][j % 4] + [0.0, 1.0, 2.0, 3.0, 4.0][i % 5];
        let factor = SMatrix::<f64, NR, NE>::from_fn(|i, j| phase(i, j).sin());
        estimator.advance(&factor, &(factor * truth), 0.1).unwrap();
    }
    // Excited for 400 s at gains of 10: what is left is the prior of least squares, 1e-8 of the start.
    let error = (estimator.estimate() - truth).norm();
    assert!(error < 1e-6, "{NR} {NE}: {error}");
}

fn all_converge<const NR: usize, const NE: usize>() {
    let tens = SVector::<f64, NE>::repeat(10.0);
    let gradient = Gradient::diagonal(&tens).unwrap();
    let squares = LeastSquares::diagonal(&(tens * 1e8), 0.1).unwrap();
    let drem = Drem::new(Kreisselmeier::new(&tens, 0.1).unwrap(), &(tens * 1e8)).unwrap();
    converges::<NR, NE>(gradient);
    converges::<NR, NE>(NormalisedGradient::new(gradient, 0.1).unwrap());
    converges::<NR, NE>(squares);
    converges::<NR, NE>(drem);
    converges::<NR, NE>(FiniteTime::once(drem, 0.1).unwrap());
    converges::<NR, NE>(Drem::new(Response::<f64, _, NR, NE>::new(gradient).unwrap(), &(tens * 1e8)).unwrap());
    converges::<NR, NE>(Drem::new(Response::<f64, _, NR, NE>::new(squares).unwrap(), &(tens * 1e8)).unwrap());
}

#[test]
fn equations_may_be_more_or_fewer_than_unknowns() {
    all_converge::<1, 1>();
    all_converge::<1, 3>();
    all_converge::<3, 1>();
    all_converge::<5, 2>();
    all_converge::<2, 4>();
    all_converge::<5, 4>();
}

#[test]
fn nothing_to_estimate_is_no_case() {
    // No equation, and no unknown: nothing happens, and nothing is indexed.
    let mut gradient = Gradient::<f32, 0>::diagonal(&SVector::zeros()).unwrap();
    gradient.advance(&SMatrix::<f32, 2, 0>::zeros(), &SVector::zeros(), 0.1).unwrap();
    let mut squares = LeastSquares::<f32, 2>::diagonal(&SVector::repeat(1.0), 0.1).unwrap();
    squares.advance(&SMatrix::<f32, 0, 2>::zeros(), &SVector::zeros(), 0.1).unwrap();
    let mut drem = Drem::new(Kreisselmeier::<f32, 0>::new(&SVector::zeros(), 0.0).unwrap(), &SVector::zeros()).unwrap();
    drem.advance(&SMatrix::<f32, 1, 0>::zeros(), &SVector::zeros(), 0.1).unwrap();
    assert_eq!(*squares.estimate(), SVector::<f32, 2>::zeros());
}
