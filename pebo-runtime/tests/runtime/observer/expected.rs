//! The output form that evaluates its model at expected outputs.

use pebo_runtime::nalgebra::{SMatrix, SVector, Vector1, Vector2};
use pebo_runtime::{
    Fault, Flow, Integrator, LeastSquares, Model, Observer, OutputForm, Rebase, Regression, SampledRegression, Sides,
};

use crate::noise::Noise;

/// A tank that drains, of unknown inflow: `y' = a - sqrt(y)`, `a' = 0`; the root has no slope that serves at every `y`.
#[derive(Clone, Copy, Debug)]
struct Tank;

impl Model<1, 1, 1, 1, 1, 1> for Tank {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = Vector1<f64>;
    type Y = Vector1<f64>;
    type U = Vector1<f64>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Flow<f64, 1> {
        Flow { lambda: SMatrix::zeros(), h: Vector1::zeros() }
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector1<f64>, _: &Vector1<f64>) -> Sides<f64, 1, 1> {
        Sides { known: Vector1::new(extension.chi().x - y.x.sqrt()), factor: Vector1::new(1.0) }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector1<f64>) -> Sides<f64, 1, 1> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector1<f64>) -> Vector1<f64> {
        *eta
    }
    fn recover(&self, z: &Vector1<f64>, _: &Vector1<f64>) -> Vector1<f64> {
        *z
    }
}

impl Rebase<1, 1, 1, 1, 1> for Tank {}

/// The standard deviation of its samples.
const SIGMA: f64 = 0.1;

/// The flow of a form whose sample is `y`, near an estimate of output and inflow.
fn flow(form: &impl Model<1, 1, 1, 2, 1, 2, Scalar = f64>, y: f64, z: &Vector2<f64>) -> Flow<f64, 2> {
    form.flow_near(&form.terms(&Vector1::new(y)), &Vector1::zeros(), z)
}

fn expecting() -> Result<OutputForm<Tank, f64, 1, 1>, Fault> {
    OutputForm::expecting(Tank, [0], &Vector1::new(SIGMA))
}

#[test]
fn rates_are_those_of_the_expected_output_near_the_sample() -> Result<(), Fault> {
    // To rounding: each is one root.
    let (form, plain) = (expecting()?, OutputForm::<_, _, 1, 1>::new(Tank));
    let known =
        |form: &OutputForm<Tank, f64, 1, 1>, y: f64, expected: f64| flow(form, y, &Vector2::new(expected, 7.0)).h.x;
    for (y, expected, used) in [
        (4.0, 4.2, 4.2),
        (4.0, 3.71, 3.71),
        // Beyond three standard deviations.
        (4.0, 4.31, 4.0),
        (4.0, -50.0, 4.0),
        // The root of what is expected has no value.
        (0.01, -0.01, 0.01),
    ] {
        assert!((known(&form, y, expected) + f64::sqrt(used)).abs() < 1e-15, "{y} {expected}");
        assert!((known(&plain, y, expected) + f64::sqrt(y)).abs() < 1e-15, "{y} {expected}");
    }
    // Where no estimate is meant there is the sample.
    let at_sample: Vector2<f64> = form.h(&Vector1::new(0.01), &Vector1::zeros());
    assert!((at_sample.x + 0.1).abs() < 1e-15);
    Ok(())
}

#[test]
fn the_output_goes_ahead_by_its_rate() -> Result<(), Fault> {
    let (form, plain) = (expecting()?, OutputForm::<_, _, 1, 1>::new(Tank));
    let z = Vector2::new(4.0, 7.0);
    let flow = flow(&form, 4.0, &z);
    let ahead = form.ahead(&flow, &z, 0.1) - Vector2::new(4.0 + 0.1 * (7.0 - 2.0), 7.0);
    assert!(ahead.abs().max() < 1e-15, "{ahead}");
    assert_eq!(plain.ahead(&flow, &z, 0.1), z);
    Ok(())
}

/// The mean error of the inflow.
fn bias(form: OutputForm<Tank, f64, 1, 1>) -> Result<f64, Fault> {
    // The inflow is followed over some seconds, so that the start is forgotten.
    let squares =
        LeastSquares::diagonal(&Vector2::new(SIGMA * SIGMA, 1.0), 0.0)?.with_process_noise(&Vector2::new(0.0, 1e-5))?;
    let sampled = SampledRegression::<f64, 1, 2>::new(&Vector1::new(SIGMA))?;
    let mut observer = Observer::with_regression(form, squares, sampled, SVector::zeros())?.rebasing(1)?;
    let mut noise = Noise::new(3);
    // At rest.
    let (inflow, level, samples) = (0.6, 0.36, 200_000_u32);
    let mut sum = 0.0;
    for k in 0..samples {
        // A sensor that reads no level below 0.
        let y = f64::max(level + SIGMA * noise.normal(), 0.0);
        let estimate = observer.step(Vector1::new(y), Vector1::zeros(), 1e-2)?;
        sum += if k < samples / 2 { 0.0 } else { estimate.x - inflow };
    }
    Ok(sum / f64::from(samples / 2))
}

#[test]
fn the_square_of_the_noise_is_in_no_rate() -> Result<(), Fault> {
    let (own, plain) = (bias(expecting()?)?, bias(OutputForm::new(Tank))?);
    println!("{own:e} {plain:e}");
    // The mean of a root of noisy samples is less than that root by `sigma^2/(8 level^1.5)`, 5.8e-3 here, and by more as
    // the noise is large beside the level. What is left is the error of the mean of 1e5 samples, 3e-4 of the level.
    assert!(plain < -5e-3 && own.abs() < 1e-3, "{own:e} {plain:e}");
    Ok(())
}

#[test]
fn bad_rows_and_deviations_are_refused() {
    let of = |row, deviation| OutputForm::expecting(Tank, [row], &Vector1::new(deviation)).map(|_| ());
    assert_eq!(of(1, 0.1), Err(Fault::Limits));
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(of(0, bad), Err(Fault::Gain));
    }
    assert_eq!(of(0, 0.0), Ok(()));
}

/// Every interval begins with the sample before: one whose rates have no value leads nowhere.
#[test]
fn a_first_sample_without_rates_is_refused() -> Result<(), Fault> {
    let squares = LeastSquares::diagonal(&Vector2::new(SIGMA * SIGMA, 1.0), 0.0)?;
    let sampled = SampledRegression::new(&Vector1::new(SIGMA))?;
    for form in [expecting()?, OutputForm::new(Tank)] {
        let mut observer = Observer::with_regression(form, squares, sampled, Vector2::zeros())?;
        assert_eq!(observer.step(Vector1::new(-1.0), Vector1::zeros(), 0.1), Err(Fault::State));
        for _ in 0..2 {
            observer.step(Vector1::new(1.0), Vector1::zeros(), 0.1)?;
        }
    }
    Ok(())
}
