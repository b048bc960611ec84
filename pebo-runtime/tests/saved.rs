//! A saved state restored elsewhere: the observers go on together, bit for bit. Run with `--features serde`.

use pebo_runtime::nalgebra::{Matrix1, SMatrix, SVector, Vector1};
use pebo_runtime::{
    AdaptiveLeastSquares, Bounded, Drem, Estimator, Fault, Filter, FilteredRegression, FiniteTime, Flow, Gradient,
    Hold, Integrator, Kreisselmeier, LeastSquares, Model, NormalisedGradient, Observer, Regression, RegressionOperator,
    Response, SampledRegression, Sides, State, WindowedRegression,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A mass whose position is measured and whose speed is not.
#[derive(Clone, Debug)]
struct Mass;

impl Model<1, 1, 1, 1, 1, 1> for Mass {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, _: &Vector1<f64>, u: &Vector1<f64>) -> Flow<f64, 1> {
        Flow::plain(*u)
    }
    fn regression(&self, extension: &Self::Extension, _: &Vector1<f64>, _: &Vector1<f64>) -> Sides<f64, 1, 1> {
        Sides { known: *extension.chi(), factor: Matrix1::identity() }
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

type MassObserver<E, R> = Observer<Mass, E, 1, 1, 1, 1, 1, 1, R>;

/// One sample of a trajectory without round numbers.
fn feed<E: Estimator<f64, 1, 1>, R: RegressionOperator<f64, 1, 1>>(
    observer: &mut MassObserver<E, R>,
    k: u32,
) -> Result<Vector1<f64>, Fault> {
    let t = f64::from(k) * 0.01;
    observer.step(Vector1::new((1.3 * t).sin() + t / 3.0), Vector1::new(t.sin()), 0.01)
}

/// The value read back.
type Saved<E, R> = State<f64, Integrator<f64, 1>, R, E, 1, 1>;

fn continues<E, R>(estimator: &E, regression: &R)
where
    E: Estimator<f64, 1, 1> + Serialize + DeserializeOwned + core::fmt::Debug + PartialEq,
    R: RegressionOperator<f64, 1, 1> + Serialize + DeserializeOwned + core::fmt::Debug + PartialEq,
{
    let new = || Observer::with_regression(Mass, estimator.clone(), regression.clone(), Vector1::new(0.7)).unwrap();
    let mut first = new();
    for k in 0..100 {
        feed(&mut first, k).unwrap();
    }
    let bytes = postcard::to_allocvec(first.state()).unwrap();
    let mut second = new();
    second.restore(postcard::from_bytes(&bytes).unwrap()).unwrap();
    assert_eq!(first.state(), second.state());
    for k in 100..200 {
        assert_eq!(feed(&mut first, k).unwrap().x.to_bits(), feed(&mut second, k).unwrap().x.to_bits());
    }
    assert_eq!(postcard::to_allocvec(first.state()).unwrap(), postcard::to_allocvec(second.state()).unwrap());

    // Cut short, no state at all; with a NaN in it, refused.
    for length in 0..bytes.len() {
        assert!(postcard::from_bytes::<Saved<E, R>>(&bytes[..length]).is_err());
    }
    let mut broken = bytes.clone();
    // The last sample's output: an option's tag, then the eight bytes of y.
    broken[1..9].copy_from_slice(&f64::NAN.to_le_bytes());
    let before = second.state().clone();
    assert_eq!(second.restore(postcard::from_bytes(&broken).unwrap()), Err(Fault::State));
    assert_eq!(*second.state(), before);
}

#[test]
fn every_estimator_and_regression_continues() {
    let one = Vector1::new(1.0);
    let filtered = FilteredRegression::new(Filter::new(3.0, Hold::First).unwrap());
    let gradient = Gradient::diagonal(&Vector1::new(50.0)).unwrap();
    let squares = LeastSquares::diagonal(&Vector1::new(50.0), 0.5).unwrap();
    let kreisselmeier = Kreisselmeier::new(&one, 0.5).unwrap();
    let drem = Drem::new(kreisselmeier, &one).unwrap();
    continues(&gradient, &filtered);
    continues(&gradient, &WindowedRegression::<f64, 1, 1, 9>::new(Hold::First));
    continues(&NormalisedGradient::new(gradient, 2.0).unwrap(), &filtered);
    continues(&squares, &filtered);
    continues(&squares.with_process_noise(&one).unwrap(), &SampledRegression::new(&one).unwrap());
    continues(&AdaptiveLeastSquares::new(squares, &one).unwrap(), &SampledRegression::new(&one).unwrap());
    continues(&drem, &filtered);
    continues(&Drem::new(Response::<_, _, 1, 1>::new(squares).unwrap(), &one).unwrap(), &filtered);
    continues(&FiniteTime::tracking(drem, 0.1, 0.3).unwrap(), &filtered);
    continues(&Bounded::new(gradient, &Vector1::new(-9.0), &Vector1::new(9.0)).unwrap(), &filtered);
}

#[test]
fn a_fault_is_read_as_it_was_written() {
    for fault in [Fault::Step, Fault::Output { index: 3 }, Fault::Parameter { index: 0 }, Fault::Singular] {
        let bytes = postcard::to_allocvec(&fault).unwrap();
        assert_eq!(postcard::from_bytes(&bytes), Ok(fault));
    }
}
