//! Outputs that hold the input and drive the cascade.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Fault, Flow, Fundamental, LeastSquares, Model, Observer, Rebase, Regression, SampledRegression, Sides,
};

type Scalar = SVector<f64, 1>;
type Pair = SVector<f64, 2>;

/// `x' = -y` with `y = x + r u`, and the constant r.
#[derive(Clone, Copy, Debug)]
struct Relaxation;

impl Model<2, 1, 1, 2, 1, 2> for Relaxation {
    type Scalar = f64;
    type Extension = Fundamental<f64, 2>;
    type X = Pair;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, y: &Scalar, _u: &Scalar) -> Flow<f64, 2> {
        Flow::plain(Pair::new(-y.x, 0.0))
    }
    fn regression(&self, extension: &Self::Extension, y: &Scalar, u: &Scalar) -> Sides<f64, 1, 2> {
        let row = SMatrix::<f64, 1, 2>::new(1.0, u.x);
        Sides { known: y - row * extension.xi(), factor: row * extension.psi() }
    }
    fn theta(&self, eta: &Pair) -> Pair {
        *eta
    }
    fn recover(&self, z: &Pair, _y: &Scalar) -> Pair {
        *z
    }
}

impl Rebase<2, 1, 1, 2, 1> for Relaxation {}

type Relaxed = Observer<Relaxation, LeastSquares<f64, 2>, 2, 1, 1, 2, 1, 2, SampledRegression<f64, 1, 2>>;

const TRUE: [f64; 2] = [2.0, 0.5];
const SENSOR: f64 = 1e-2;
const STEP: f64 = 0.01;

fn observer(start: [f64; 2]) -> Relaxed {
    let estimator = LeastSquares::diagonal(&Pair::new(1.0, 1.0), 0.0).unwrap();
    let regression = SampledRegression::new(&Scalar::new(SENSOR)).unwrap();
    let observer = Observer::with_regression(Relaxation, estimator, regression, Pair::from(start)).unwrap();
    observer.rebasing(1).unwrap()
}

/// The plant: its state, and its output with the input of an interval at the end of it.
struct Plant {
    x: f64,
    u: f64,
}

impl Plant {
    fn new() -> Self {
        Self { x: TRUE[0], u: 0.0 }
    }

    /// The next sample, with the input before it.
    fn sample(&mut self, k: u32) -> (Scalar, Scalar) {
        if k > 0 {
            // It jumps at each sample, between two values and twice.
            self.u = [1.0, -1.0, -1.0, 3.0][k as usize % 4];
            let rest = self.x + TRUE[1] * self.u;
            self.x = rest * (-STEP).exp() - TRUE[1] * self.u;
        }
        (Scalar::new(self.x + TRUE[1] * self.u), Scalar::new(self.u))
    }
}

/// The largest error of the state in the second half of a run.
fn error(mut observer: Relaxed) -> f64 {
    let mut plant = Plant::new();
    let mut worst: f64 = 0.0;
    for k in 0..400 {
        let (y, u) = plant.sample(k);
        let estimate = observer.step(y, u, STEP).unwrap();
        if k >= 200 {
            worst = worst.max((estimate.x - plant.x).abs());
        }
    }
    worst
}

#[test]
fn an_interval_begins_after_the_jump_of_the_input() {
    let plain = error(observer([0.0, 0.0]));
    for start in [[0.0, 0.0], [-1.0, 2.0]] {
        let carried = error(observer(start).with_feedthrough([Some(0)]).unwrap());
        // What is left is the trapezium's, a twelfth of the cube of the step, beside half a step times the jump.
        assert!(carried < 0.1 * plain, "{start:?}: {carried} of {plain}");
    }
}

#[test]
fn a_row_without_such_an_output_leaves_all_as_it_is() {
    let without = error(observer([0.0, 0.0]).with_feedthrough([None]).unwrap());
    assert_eq!(without.to_bits(), error(observer([0.0, 0.0])).to_bits());
}

#[test]
fn an_estimate_that_does_not_explain_the_sample_carries_nothing() {
    // Estimates that are certain and wrong: the sample drives the cascade as it is.
    let certain = |observer: Relaxed| {
        let estimator = LeastSquares::diagonal(&Pair::new(1e-12, 1e-12), 0.0).unwrap();
        let regression = SampledRegression::new(&Scalar::new(SENSOR)).unwrap();
        let chi_0 = Pair::new(5.0, 100.0);
        let certain = Observer::with_regression(*observer.model(), estimator, regression, chi_0).unwrap();
        certain.rebasing(1).unwrap()
    };
    let [plain, carried] =
        [certain(observer([0.0; 2])), certain(observer([0.0; 2])).with_feedthrough([Some(0)]).unwrap()].map(
            |mut observer| {
                let mut plant = Plant::new();
                (0..10).map(|k| plant.sample(k)).map(|(y, u)| observer.step(y, u, STEP).unwrap().x.to_bits()).collect()
            },
        ) as [Vec<u64>; 2];
    assert_eq!(plain, carried);
}

#[test]
fn a_saved_state_has_the_input_of_its_sample() {
    let mut first = observer([0.0, 0.0]).with_feedthrough([Some(0)]).unwrap();
    let mut plant = Plant::new();
    for k in 0..50 {
        let (y, u) = plant.sample(k);
        first.step(y, u, STEP).unwrap();
    }
    let mut second = observer([0.0, 0.0]).with_feedthrough([Some(0)]).unwrap();
    second.restore(*first.state()).unwrap();
    for k in 50..100 {
        let (y, u) = plant.sample(k);
        let innovations = [&first, &second].map(|observer| observer.innovation(y, u, STEP).unwrap().value.x.to_bits());
        assert_eq!(innovations[0], innovations[1]);
        let [estimate, restored] = [&mut first, &mut second].map(|observer| observer.step(y, u, STEP).unwrap());
        assert_eq!(estimate.map(f64::to_bits), restored.map(f64::to_bits));
    }
    assert_eq!(first.step(Scalar::new(f64::NAN), Scalar::zeros(), STEP), Err(Fault::Output { index: 0 }));
}

#[test]
fn an_output_that_is_none_is_refused() {
    assert_eq!(observer([0.0, 0.0]).with_feedthrough([Some(1)]).map(|_| ()), Err(Fault::Limits));
}
