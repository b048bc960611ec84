//! An output that is an angle: a sensor that reads it within a turn changes no estimate.

use core::f64::consts::TAU;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Filter, Flow, Gradient, Hold, Integrator, LeastSquares, Model, Observer, OutputForm, Rebase, Regression,
    SampledRegression, Sides,
};

type Scalar = SVector<f64, 1>;

/// A gyroscope with an unknown bias beside a compass, `psi' = u - theta`.
#[derive(Clone, Copy, Debug)]
struct Compass {
    period: f64,
}

impl Model<1, 1, 1, 1, 1, 1> for Compass {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = Scalar;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Dynamic;

    fn periods(&self) -> Scalar {
        Scalar::new(self.period)
    }
    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, _y: &Scalar, _u: &Scalar) -> Flow<f64, 1> {
        Flow::plain(Scalar::zeros())
    }
    fn regression(&self, extension: &Self::Extension, _y: &Scalar, u: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: u - extension.chi(), factor: -SMatrix::identity() }
    }
    fn primitive(&self, _: &Self::Extension, y: &Scalar) -> Sides<f64, 1, 1> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Scalar) -> Scalar {
        *eta
    }
    fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
        *z
    }
}

impl Rebase<1, 1, 1, 1, 1> for Compass {}

/// The samples of five turns, as they are and as the sensor reads them.
fn samples() -> impl Iterator<Item = (f64, [f64; 2])> {
    (0..400).map(|k| {
        let angle = 2.5 + 0.08 * f64::from(k) + 0.3 * (0.05 * f64::from(k)).sin();
        (0.85, [angle, angle - TAU * (angle / TAU).round()])
    })
}

#[test]
fn turns_of_a_sensor_are_counted_by_filters() {
    let observer = |period| {
        let gradient = Gradient::diagonal(&Scalar::new(50.0)).unwrap();
        Observer::new(Compass { period }, gradient, Filter::new(5.0, Hold::First).unwrap(), Scalar::zeros()).unwrap()
    };
    let (mut whole, mut wrapped, mut ignored) = (observer(0.0), observer(TAU), observer(0.0));
    for (rate, [angle, read]) in samples() {
        let expected = whole.step(Scalar::new(angle), Scalar::new(rate), 0.1).unwrap();
        let found = wrapped.step(Scalar::new(read), Scalar::new(rate), 0.1).unwrap();
        assert!((found - expected).norm() < 1e-9, "{found} for {expected}");
        ignored.step(Scalar::new(read), Scalar::new(rate), 0.1).unwrap();
    }
    let [expected, without] = [whole, ignored].map(|observer| observer.estimate().unwrap()[0]);
    assert!((without - expected).abs() > 0.1, "{without} {expected}");
}

#[test]
fn turns_of_a_sensor_are_counted_in_the_output_form_with_innovations() {
    let observer = |period| {
        let estimator = LeastSquares::diagonal(&SVector::<f64, 2>::new(0.01, 1.0), 0.0).unwrap();
        let model = OutputForm::new(Compass { period });
        let regression = SampledRegression::<f64, 1, 2>::new(&Scalar::new(0.01)).unwrap();
        Observer::with_regression(model, estimator, regression, SVector::zeros()).unwrap()
    };
    let (mut whole, mut wrapped) = (observer(0.0), observer(TAU));
    for (rate, [angle, read]) in samples() {
        let (rate, angle, read) = (Scalar::new(rate), Scalar::new(angle), Scalar::new(read));
        let expected = whole.innovation(angle, rate, 0.1).unwrap();
        let found = wrapped.innovation(read, rate, 0.1).unwrap();
        assert!((found.value - expected.value).norm() < 1e-6 * (1.0 + expected.value.norm()));
        let expected = whole.step(angle, rate, 0.1).unwrap();
        let found = wrapped.step(read, rate, 0.1).unwrap();
        assert!((found - expected).norm() < 1e-9, "{found} for {expected}");
    }
}
