//! A factor of the unknown that is a sample itself.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Fault, Flow, Integrator, LeastSquares, Model, Observer, Rebase, Regression, SampledRegression, Sides,
};

type Scalar = SVector<f64, 1>;
type Pair = SVector<f64, 2>;

/// `q = a p` with the outputs p and q, and the constant a.
#[derive(Clone, Copy, Debug)]
struct Proportion;

impl Model<1, 2, 1, 1, 1, 1> for Proportion {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = Scalar;
    type Y = Pair;
    type U = Scalar;
    type Terms = Pair;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Pair) -> Pair {
        *y
    }
    fn flow(&self, _y: &Pair, _u: &Scalar) -> Flow<f64, 1> {
        Flow::plain(Scalar::zeros())
    }
    fn regression(&self, extension: &Self::Extension, y: &Pair, _u: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: Scalar::new(y[1]) - y[0] * extension.chi(), factor: SMatrix::from([[y[0]]]) }
    }
    fn theta(&self, eta: &Scalar) -> Scalar {
        *eta
    }
    fn recover(&self, z: &Scalar, _y: &Pair) -> Scalar {
        *z
    }
}

impl Rebase<1, 2, 1, 1, 1> for Proportion {}

type Proportional = Observer<Proportion, LeastSquares<f64, 1>, 1, 2, 1, 1, 1, 1, SampledRegression<f64, 1, 1>>;

/// The true factor and output, and the deviation of the sensor of p.
const TRUE: [f64; 2] = [2.0, 1.0];
const NOISE: f64 = 0.5;

fn observer() -> Proportional {
    let estimator = LeastSquares::diagonal(&Scalar::new(100.0), 0.0).unwrap();
    // The deviation of the equation at the truth, in samples of one second.
    let regression = SampledRegression::new(&Scalar::new(TRUE[0] * NOISE)).unwrap();
    Observer::with_regression(Proportion, estimator, regression, Scalar::zeros()).unwrap()
}

/// The estimate after samples of p that are too large and too small by turns.
fn estimate(mut observer: Proportional) -> f64 {
    for k in 0..2000 {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        observer.step(Pair::new(TRUE[1] + sign * NOISE, TRUE[0] * TRUE[1]), Scalar::zeros(), 1.0).unwrap();
    }
    observer.estimate().unwrap().x
}

#[test]
fn noise_in_the_factor_does_not_pull_the_estimate_to_zero() {
    // By least squares alone: the square of the noise adds to that of the factor.
    let pulled = TRUE[0] / (1.0 + NOISE * NOISE);
    assert!((estimate(observer()) - pulled).abs() < 0.01);
    let correct = || observer().with_errors_in_variables(&Pair::new(NOISE, 0.0)).unwrap();
    for observer in [correct(), correct().rebasing(1).unwrap()] {
        // What is left of the pull is that of the first samples, while the factor is not known better than they tell.
        let found = estimate(observer);
        assert!((found - TRUE[0]).abs() < 0.1 * (TRUE[0] - pulled), "{found}");
    }
}

#[test]
fn an_observer_of_sensors_without_noise_is_not_changed() {
    let corrected = observer().with_errors_in_variables(&Pair::zeros()).unwrap();
    assert_eq!(estimate(corrected).to_bits(), estimate(observer()).to_bits());
}

#[test]
fn deviations_are_finite_and_not_negative() {
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = observer().with_errors_in_variables(&Pair::new(0.1, wrong)).map(|_| ());
        assert_eq!(refused, Err(Fault::Gain));
    }
}

/// `r^2 = z` with the output r, and `z' = u`.
#[derive(Clone, Copy, Debug)]
struct Range;

impl Model<1, 1, 1, 1, 1, 1> for Range {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = Scalar;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, _y: &Scalar, u: &Scalar) -> Flow<f64, 1> {
        Flow::plain(*u)
    }
    fn regression(&self, extension: &Self::Extension, y: &Scalar, _u: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: y.component_mul(y) - extension.chi(), factor: SMatrix::from([[1.0]]) }
    }
    fn theta(&self, eta: &Scalar) -> Scalar {
        *eta
    }
    fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
        *z
    }
}

impl Rebase<1, 1, 1, 1, 1> for Range {}

#[test]
fn an_equation_has_the_weight_of_its_sensor_at_the_sample() {
    const RANGE: f64 = 0.1;
    let estimator = LeastSquares::diagonal(&Scalar::new(1e4), 0.0).unwrap();
    // As at a range of 1.
    let regression = SampledRegression::new(&Scalar::new(2.0 * RANGE)).unwrap();
    let observer = Observer::with_regression(Range, estimator, regression, Scalar::zeros()).unwrap();
    let constant = observer.clone().rebasing(1).unwrap();
    let weighted = observer.with_errors_in_variables(&Scalar::new(RANGE)).unwrap().rebasing(1).unwrap();
    for (mut observer, tenfold) in [(weighted, 1.0), (constant, 10.0)] {
        for k in 0..1000_u32 {
            // From a range of 1 to one of 10, and there.
            let u = if k < 100 { 1.0 } else { 0.0 };
            let truth = (1.0 + f64::from(k.min(99))).sqrt();
            let noise = if k % 2 == 0 { RANGE } else { -RANGE };
            let (y, u) = (Scalar::new(truth + noise), Scalar::new(u));
            let innovation = observer.innovation(y, u, 1.0).unwrap().value.x;
            // The mean over all samples is known to a share of a sample's noise that falls with their number.
            assert!(k < 900 || (innovation.abs() - tenfold).abs() < 0.1 * tenfold, "{k}: {innovation}");
            observer.step(y, u, 1.0).unwrap();
        }
    }
}
