//! Samples that are taken while the state has no value.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Fault, Flow, Integrator, LeastSquares, Model, Observer, Regression, SampledRegression, Sides};

type Scalar = SVector<f64, 1>;

/// `y = z` with the constant `z = x^2`: the state has no value while the estimate of z is negative.
#[derive(Clone, Copy, Debug)]
struct Root;

impl Model<1, 1, 1, 1, 1, 1> for Root {
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
    fn flow(&self, _y: &Scalar, _u: &Scalar) -> Flow<f64, 1> {
        Flow::plain(Scalar::zeros())
    }
    fn regression(&self, extension: &Self::Extension, y: &Scalar, _u: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: y - extension.chi(), factor: SMatrix::from([[1.0]]) }
    }
    fn theta(&self, eta: &Scalar) -> Scalar {
        *eta
    }
    fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
        z.map(f64::sqrt)
    }
}

#[test]
fn a_sample_without_a_state_teaches_the_unknown() {
    let squares = LeastSquares::diagonal(&Scalar::new(100.0), 0.0).unwrap();
    let regression = SampledRegression::<f64, 1, 1>::new(&Scalar::new(0.1)).unwrap();
    let mut observer = Observer::with_regression(Root, squares, regression, Scalar::new(1.0)).unwrap();
    let samples = [-3.0, 4.0, 4.0, 4.0, 4.0].map(Scalar::new);
    let none = Scalar::zeros();
    // A first sample at which there is no state leaves the start.
    assert_eq!(observer.step(samples[0], none, 0.1).unwrap(), Scalar::new(1.0));
    let before = *observer.state();
    // The second sample is as far off; the mean of all but the first is 17/6.
    assert_eq!(observer.step(samples[0], none, 0.1), Err(Fault::Estimate));
    assert_eq!(*observer.state(), before);
    observer.learn(samples[0], none, 0.1).unwrap();
    assert!(observer.theta()[0] < -3.0 && observer.estimate().unwrap()[0].is_nan());
    // Other faults are as of a step, and the next step is one again.
    assert_eq!(observer.learn(Scalar::new(f64::NAN), none, 0.1), Err(Fault::Output { index: 0 }));
    assert_eq!(observer.learn(samples[0], none, -0.1), Err(Fault::Step));
    assert_eq!(observer.step(samples[0], none, 0.1), Err(Fault::Estimate));
    for sample in &samples[1..] {
        observer.learn(*sample, none, 0.1).unwrap();
    }
    // What was never learned brings no state back: each sample would be refused by itself.
    let estimate = observer.step(Scalar::new(4.0), none, 0.1).unwrap();
    assert!((estimate[0].powi(2) - 17.0 / 6.0).abs() < 0.01, "{estimate}");
}
