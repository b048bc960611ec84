//! Random samples with random faults, many of them: no panic, no number that is not finite, no trace of a refused
//! sample.
//!
//! `STORM_STEPS` sets how many in all; ten million take a minute in a release build.

use core::fmt::Debug;

use pebo_runtime::nalgebra::{SVector, Vector1, Vector2};
use pebo_runtime::{
    Bounded, Drem, Drift, Estimator, Extension as _, Fault, Filter, FilteredRegression, FiniteTime, Gradient, Hold,
    Kreisselmeier, LeastSquares, Model, Monitor, NormalisedGradient, Observer, OutputForm, Real, Rebase,
    RegressionOperator, Response, SampledRegression, WindowedRegression, Within,
};

use crate::converter::{Case, CaseTwo, CaseTwoGeneralised};
use crate::noise::Noise;

/// The runs in each of the two scalars: an estimator, a regression and a form of the observer each.
const RUNS: u32 = 24;

/// The steps of each run.
fn steps() -> u32 {
    let all: u32 = std::env::var("STORM_STEPS").map_or(400_000, |steps| steps.parse().expect("a number of steps"));
    all.div_ceil(2 * RUNS)
}

/// An ordinary number as a rule; else zeros, infinities, NaN, huge and tiny numbers, or any bits at all.
fn number(noise: &mut Noise, size: f64) -> f64 {
    match noise.bits() % 32 {
        0 => f64::NAN,
        1 => f64::INFINITY,
        2 => f64::NEG_INFINITY,
        3 => 0.0,
        4 => f64::MAX * (noise.uniform() - 0.5),
        5 => 1e30 * noise.normal(),
        6 => f64::MIN_POSITIVE,
        7 => f64::from_bits(noise.bits()),
        _ => size * noise.normal(),
    }
}

/// A period as a rule; else zero, negative, or any number as above.
fn period(noise: &mut Noise) -> f64 {
    match noise.bits() % 16 {
        0 => 0.0,
        1 => -1e-5,
        2 => number(noise, 1.0),
        _ => 1e-5 * noise.uniform(),
    }
}

/// The generalised converter, plain and re-based at every third sample.
fn weather<S, E, R>(estimator: E, regression: R, seed: u64) -> u32
where
    S: Real,
    E: Estimator<S, 2, 2> + Copy + Debug + PartialEq,
    R: RegressionOperator<S, 2, 2> + Copy + Debug + PartialEq,
{
    of_model(&CaseTwo::<S>::new(), estimator, regression, None, seed)
        + of_model(&CaseTwoGeneralised::<S>::new(), estimator, regression, Some(3), seed + 100)
}

fn of_model<S, M, E, R, const NZ: usize>(model: &M, estimator: E, regression: R, every: Option<u32>, seed: u64) -> u32
where
    S: Real,
    M: Rebase<2, 2, 1, NZ, 2> + Model<2, 2, 1, NZ, 2, NZ, Scalar = S, X = Vector2<S>> + Clone,
    E: Estimator<S, 2, NZ> + Copy + Debug + PartialEq,
    R: RegressionOperator<S, 2, NZ> + Copy + Debug + PartialEq,
{
    let real = |x: f64| -> S { Real::from_f64(x) };
    let finite = |vector: &[S]| vector.iter().all(|&x| Real::is_finite(x));
    let mut noise = Noise::new(seed);
    let build = || {
        let observer = Observer::with_regression(model.clone(), estimator, regression, SVector::zeros()).unwrap();
        match every {
            Some(every) => observer.rebasing(every).unwrap(),
            None => observer,
        }
    };
    let mut observer = build();
    let mut refused = 0;
    for k in 0..steps() {
        let y = Vector2::new(real(number(&mut noise, 30.0)), real(number(&mut noise, 1.0)));
        let u = Vector1::new(real(number(&mut noise, 0.5)));
        let dt = real(period(&mut noise));
        let before = *observer.state();
        let estimate = match k % 3 {
            0 => observer.step(y, u, dt),
            1 => observer.step_straight(y, [u, Vector1::new(real(noise.uniform()))], dt),
            _ if every.is_some() => observer.step(y, u, dt),
            _ => observer.step_without_drift(y, u, dt, Drift::Free),
        };
        if let Ok(estimate) = estimate {
            assert!(finite(estimate.as_slice()), "{estimate}");
        } else {
            refused += 1;
            assert_eq!(*observer.state(), before);
        }
        assert!(finite(observer.eta().as_slice()) && finite(observer.extension().offset().as_slice()));
        assert!(observer.estimator().is_finite() && observer.regression().is_finite());
        // An outage now and then, or nothing would be left to go wrong after the first huge number.
        if noise.bits().is_multiple_of(256) {
            observer.restart(SVector::zeros(), &SVector::zeros()).unwrap();
            assert_eq!(observer.estimate_at(Vector2::zeros()), build().estimate_at(Vector2::zeros()));
        }
    }
    refused
}

fn all_weathers<S: Real>() -> Result<u32, Fault> {
    let pair = |a: f64, b: f64| Vector2::<S>::new(Real::from_f64(a), Real::from_f64(b));
    let real = |x: f64| -> S { Real::from_f64(x) };
    let four = |a: f64| SVector::<S, 4>::repeat(Real::from_f64(a));
    let filtered = FilteredRegression::<S, 2, 2>::new(Filter::new(real(1e3), Hold::First)?);
    let window = WindowedRegression::<S, 2, 2, 8>::new(Hold::First);
    let gradient = Gradient::diagonal(&pair(1.0, 10.0))?;
    let squares = LeastSquares::diagonal(&pair(1e6, 1e10), real(100.0))?;
    let memory = Kreisselmeier::new(&pair(2e-3, 40.0), real(200.0))?;
    let drem = Drem::new(memory, &pair(1e5, 1e5))?;
    let response = Response::<S, _, 2, 2>::new(squares)?;
    Ok([
        weather::<S, _, _>(gradient, filtered, 1),
        weather::<S, _, _>(gradient, window, 2),
        weather::<S, _, _>(NormalisedGradient::new(gradient, real(1e-9))?, filtered, 3),
        weather::<S, _, _>(squares, filtered, 4),
        weather::<S, _, _>(LeastSquares::diagonal(&pair(1e6, 1e10), real(0.0))?, window, 5),
        weather::<S, _, _>(drem, filtered, 6),
        weather::<S, _, _>(Drem::new(response, &pair(1e5, 1e5))?, filtered, 7),
        weather::<S, _, _>(Drem::new(Response::<S, _, 2, 2>::new(gradient)?, &pair(1e5, 1e5))?, filtered, 8),
        weather::<S, _, _>(FiniteTime::once(drem, real(0.1))?, filtered, 9),
        weather::<S, _, _>(FiniteTime::tracking(drem, real(0.1), real(1e-3))?, filtered, 10),
        weather::<S, _, _>(Bounded::new(squares, &pair(-50.0, -50.0), &pair(50.0, 50.0))?, filtered, 11),
        of_model::<S, _, _, _, 4>(
            &OutputForm::<_, _, 2, 2>::new(CaseTwo::<S>::new()),
            LeastSquares::diagonal(&four(1e3), real(0.0))?.with_process_noise(&four(1.0))?,
            SampledRegression::new(&pair(0.1, 0.1))?,
            Some(1),
            12,
        ),
        of_model::<S, _, _, _, 2>(
            &Within::new(CaseTwoGeneralised::<S>::new(), &pair(-1.0, 0.0), &pair(1.0, f64::INFINITY))?,
            gradient.carrying_its_gain(),
            filtered,
            Some(1),
            13,
        ),
    ]
    .iter()
    .sum())
}

#[test]
fn nothing_gets_through() {
    let all = steps() * 2 * RUNS;
    let refused = all_weathers::<f64>().unwrap() + all_weathers::<f32>().unwrap();
    // About a third are faults by themselves; far from all are refused, far from all accepted.
    assert!(refused > all / 4 && refused < all / 10 * 9, "{refused} of {all}");
}

#[test]
fn monitor_stands_it_too() {
    let mut noise = Noise::new(12);
    let filter = Filter::new(1e3_f32, Hold::First).unwrap();
    let sensors = Vector2::new(0.1_f32, 0.3);
    let mut monitor = Monitor::of_rates(&Vector2::new(1e-3_f32, 1e-2), &sensors, filter, 10.0).unwrap();
    for _ in 0..steps() {
        let mut entry = || -> f32 { Real::from_f64(number(&mut noise, 1e4)) };
        let regressor = pebo_runtime::nalgebra::Matrix2::new(entry(), entry(), entry(), entry());
        let dt: f32 = Real::from_f64(period(&mut noise));
        let before = monitor;
        if monitor.advance(&regressor, dt).is_err() {
            assert_eq!(monitor, before);
        }
        assert!(monitor.level().is_finite());
        assert!(monitor.standard_error().is_none_or(|error| error.iter().all(|x| x.is_finite())));
        if noise.bits().is_multiple_of(256) {
            monitor.reset();
        }
    }
}
