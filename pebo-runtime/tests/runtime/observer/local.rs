//! Regressions to first order, whose slopes are those at the estimate.

use pebo_runtime::nalgebra::{SMatrix, SVector, Vector1, Vector2};
use pebo_runtime::{
    Filter, Flow, Hold, Integrator, LeastSquares, Model, Observer, OutputForm, Rebase, Regression, SampledRegression,
    Sides, Within,
};

type Scalar = SVector<f64, 1>;

/// `y' = u - exp(x)` with a constant x.
#[derive(Clone, Copy, Debug)]
struct Decline;

impl Model<1, 1, 1, 1, 1, 1> for Decline {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = Scalar;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Dynamic;
    const LOCAL: bool = true;

    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, _y: &Scalar, _u: &Scalar) -> Flow<f64, 1> {
        Flow::plain(Scalar::zeros())
    }
    fn regression(&self, extension: &Self::Extension, _y: &Scalar, u: &Scalar) -> Sides<f64, 1, 1> {
        let slope = -extension.chi().x.exp();
        Sides { known: Vector1::new(u.x + slope), factor: SMatrix::from([[slope]]) }
    }
    fn primitive(&self, _extension: &Self::Extension, y: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Scalar) -> Scalar {
        *eta
    }
    fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
        *z
    }
}

impl Rebase<1, 1, 1, 1, 1> for Decline {}

const TRUE: f64 = 1.5;
const STEP: f64 = 0.01;

/// The outputs with their inputs: they move along straight lines, so that nothing is lost between samples.
fn samples() -> impl Iterator<Item = (Scalar, Scalar)> {
    (0..500).map(|k| (Vector1::new((4.0 - TRUE.exp()) * STEP * f64::from(k)), Vector1::new(4.0)))
}

/// The estimates of an observer, sample by sample.
fn estimates(mut step: impl FnMut(Scalar, Scalar) -> f64) -> Vec<f64> {
    samples().map(|(y, u)| step(y, u)).collect()
}

fn filtered<M: Rebase<1, 1, 1, 1, 1, Scalar = f64, X = Scalar, Y = Scalar, U = Scalar>>(model: M) -> Vec<f64> {
    let estimator = LeastSquares::diagonal(&Vector1::new(1.0), 0.0).unwrap();
    let estimator = estimator.with_process_noise(&Vector1::new(0.1)).unwrap();
    let filter = Filter::new(10.0, Hold::First).unwrap();
    let observer = Observer::new(model, estimator, filter, Scalar::zeros()).unwrap();
    let mut observer = observer.rebasing(1).unwrap();
    estimates(|y, u| observer.step(y, u, STEP).unwrap().x)
}

/// The extension follows the estimate, so that the slope becomes that of the state.
#[test]
fn the_slope_is_that_of_the_state_in_the_end() {
    let found = filtered(Decline);
    // What the filter has of earlier slopes fades with the process noise, to 1.2e-4 here.
    assert!((found[499] - TRUE).abs() < 1e-3, "{}", found[499]);
    let form = OutputForm::new(Decline);
    let estimator = LeastSquares::diagonal(&Vector2::new(1e-4, 1.0), 0.0).unwrap();
    let estimator = estimator.with_process_noise(&Vector2::new(0.0, 0.1)).unwrap();
    let sampled = SampledRegression::new(&Vector1::new(1e-2)).unwrap();
    let observer = Observer::<_, _, 1, 1, 1, 2, 1, 2, _>::with_regression(form, estimator, sampled, Vector2::zeros());
    let mut observer = observer.unwrap().rebasing(1).unwrap();
    let found = estimates(|y, u| observer.step(y, u, STEP).unwrap().x);
    // It holds nothing of the past.
    assert!((found[499] - TRUE).abs() < 1e-9, "{}", found[499]);
}

/// Bounds of the state change no estimate between them, and the output form takes the slopes of the model within.
#[test]
fn bounds_keep_the_slopes() {
    let wide = Vector1::new(1e9);
    let bounded = Within::new(Decline, &-wide, &wide).unwrap();
    assert!(bounded.is_local() && Within::<Decline, f64, 1>::LOCAL);
    assert_eq!(filtered(bounded), filtered(Decline));
}
