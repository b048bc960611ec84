//! Re-basing in full: the fundamental matrix starts again, and the memory of estimator and regression goes along.

use pebo_runtime::nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3};
use pebo_runtime::{
    Bounded, Drem, Drift, Estimator, Extension, Fault, Filter, FilteredRegression, FiniteTime, Flow, Fundamental,
    Gradient, Hold, Information, Kreisselmeier, LeastSquares, Model, Observer, Real, Rebase, Regression,
    RegressionOperator, RegressorExtension, Response, Sides, Sum, Turn, WindowedRegression,
};
use proptest::prelude::*;

use crate::random::{decades, matrix, vector};

/// `z' = Lambda z + (u, 0)` with `y' = (1, 1) z`: a pair that turns and dies out or grows, measured through one rate.
#[derive(Clone, Debug)]
pub(crate) struct Pair<S> {
    lambda: Matrix2<S>,
}

impl<S: Real> Pair<S> {
    pub(crate) fn new(entries: [f64; 4]) -> Self {
        let [a, b, c, d] = entries.map(Real::from_f64);
        Self { lambda: Matrix2::new(a, b, c, d) }
    }
}

impl<S: Real> Model<2, 1, 1, 2, 1, 2> for Pair<S> {
    type Scalar = S;
    type Extension = Fundamental<S, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<S>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<S>) -> Vector1<S> {
        *y
    }
    fn flow(&self, _: &Vector1<S>, u: &Vector1<S>) -> Flow<S, 2> {
        Flow { lambda: self.lambda, h: Vector2::new(u.x, S::zero()) }
    }
    fn regression(&self, extension: &Self::Extension, _: &Vector1<S>, _: &Vector1<S>) -> Sides<S, 1, 2> {
        let row = SMatrix::<S, 1, 2>::repeat(S::one());
        Sides { known: row * extension.xi(), factor: row * extension.psi() }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector1<S>) -> Sides<S, 1, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Vector2<S>) -> Vector2<S> {
        *eta
    }
    fn recover(&self, z: &Vector2<S>, _: &Vector1<S>) -> Vector2<S> {
        *z
    }
}

impl<S: Real> Rebase<2, 1, 1, 2, 1> for Pair<S> {}

type PairObserver<S, E, R> = Observer<Pair<S>, E, 2, 1, 1, 2, 1, 2, R>;

/// The pair itself, advanced as precisely as the extension does it.
struct Truth {
    extension: Fundamental<f64, 2>,
    y: f64,
}

const LAMBDA: [f64; 4] = [-0.4, 3.0, -3.0, 0.2];

fn input(k: u32) -> f64 {
    (0.013 * f64::from(k)).sin() + 0.3
}

impl Truth {
    fn new() -> Self {
        Self { extension: Extension::new(Vector2::new(1.0, -2.0)), y: 0.5 }
    }

    fn advance(&mut self, lambda: [f64; 4], u: f64, dt: f64) {
        let before = self.extension.xi().sum();
        let flow = Pair::<f64>::new(lambda).flow(&Vector1::zeros(), &Vector1::new(u));
        Extension::advance(&mut self.extension, &flow, &flow, dt).unwrap();
        // The trapezoidal rule, which is also what the regression makes of it.
        self.y += (before + self.extension.xi().sum()) * (dt / 2.0);
    }
}

/// The largest distance of the estimates of two observers of one run, the one re-based, and the error of the first.
fn apart<S, E, R>(estimator: E, regression: R, every: u32, steps: u32, dt: f64, lambda: [f64; 4]) -> [f64; 2]
where
    S: Real,
    E: Estimator<S, 1, 2> + Copy,
    R: RegressionOperator<S, 1, 2> + Copy,
{
    let real = |x: f64| -> S { Real::from_f64(x) };
    let observer = || -> PairObserver<S, E, R> {
        Observer::with_regression(Pair::new(lambda), estimator, regression, Vector2::zeros()).unwrap()
    };
    let (mut plain, mut rebased) = (observer(), observer().rebasing(every).unwrap());
    let mut truth = Truth::new();
    let (mut largest, mut error) = (0.0_f64, 0.0);
    for k in 0..steps {
        // The input during the interval that ends here.
        let u = Vector1::new(real(input(k)));
        if k > 0 {
            truth.advance(lambda, Real::to_f64(u.x), dt);
        }
        let y = Vector1::new(real(truth.y));
        let (one, other) = (plain.step(y, u, real(dt)).unwrap(), rebased.step(y, u, real(dt)).unwrap());
        largest = largest.max((one - other).map(Real::to_f64).norm());
        error = (one.map(Real::to_f64) - truth.extension.xi()).norm();
    }
    [largest, error]
}

fn filter<S: Real>() -> FilteredRegression<S, 1, 2> {
    filter_of(5.0)
}

fn filter_of<S: Real>(alpha: f64) -> FilteredRegression<S, 1, 2> {
    FilteredRegression::new(Filter::new(Real::from_f64(alpha), Hold::First).unwrap())
}

fn pair<S: Real>(a: f64, b: f64) -> Vector2<S> {
    Vector2::new(Real::from_f64(a), Real::from_f64(b))
}

#[test]
fn estimates_are_those_without_rebasing() {
    let window = WindowedRegression::<f64, 1, 2, 16>::new(Hold::First);
    let squares = LeastSquares::diagonal(&pair(1e3, 1e3), Real::from_f64(0.0)).unwrap();
    let gradient = Gradient::diagonal(&pair(3.0, 5.0)).unwrap().carrying_its_gain();
    for every in [1, 7] {
        let runs = [
            apart::<f64, _, _>(squares, filter(), every, 2000, 5e-3, LAMBDA),
            apart::<f64, _, _>(squares, window, every, 2000, 5e-3, LAMBDA),
            apart::<f64, _, _>(gradient, filter(), every, 2000, 5e-3, LAMBDA),
            apart::<f64, _, _>(gradient, window, every, 2000, 5e-3, LAMBDA),
        ];
        for [largest, _] in runs {
            // Ten seconds, |Psi| < e^2 and its inverse: rounding of numbers up to 10 in 2000 steps, with gains of 1e3
            // while the second direction is not excited yet.
            assert!(largest < 1e-9, "{largest:e}");
        }
    }
}

#[test]
fn a_carried_gain_is_its_first_one_after_a_reset() {
    let matrix = Sum::new(Matrix2::new(2.0, 1.0, 0.0, 0.5));
    let new = Gradient::<f64, 2>::diagonal(&pair(3.0, 5.0)).unwrap().carrying_its_gain();
    let mut turned = new;
    Estimator::<f64, 1, 2>::turn(&mut turned, &Turn::new(&matrix).unwrap());
    assert_ne!(turned, new);
    Estimator::<f64, 1, 2>::reset(&mut turned, &Vector2::zeros());
    assert_eq!(turned, new);
}

/// [`apart`] of least squares without forgetting, and of the gradient that carries its gain.
fn both_apart<S: Real>(every: u32, steps: u32, dt: f64, lambda: [f64; 4]) -> [[f64; 2]; 2] {
    let squares = LeastSquares::<S, 2>::diagonal(&pair(1e3, 1e3), Real::from_f64(0.0)).unwrap();
    let gradient = Gradient::<S, 2>::diagonal(&pair(3.0, 5.0)).unwrap().carrying_its_gain();
    [apart(squares, filter(), every, steps, dt, lambda), apart(gradient, filter(), every, steps, dt, lambda)]
}

/// Ten million steps take a minute in a release build: `REBASING_STEPS`.
#[test]
fn rounding_does_not_add_up() {
    let steps: u32 = std::env::var("REBASING_STEPS").map_or(20_000, |steps| steps.parse().expect("a number of steps"));
    // A pair that turns and neither dies out nor grows, so that there is something to compare after any time.
    let still = [-0.0, 3.0, -3.0, 0.0];
    let dt = 1e-3;
    for every in [1, 100] {
        let double = both_apart::<f64>(every, steps, dt, still);
        let single = both_apart::<f32>(every, steps, dt, still);
        println!("every {every}, {steps} steps: f64 {double:?}, f32 {single:?}");
        // Least squares settles and the gradient forgets: what is left is the rounding of numbers up to 5 and what
        // gains make of it at the start.
        assert!(double.iter().all(|[largest, _]| *largest < 1e-13), "{double:?}");
        assert!(single.iter().all(|[largest, _]| *largest < 1e-4), "{single:?}");
    }
}

#[test]
fn a_growing_plant_is_followed_without_a_fault() {
    // e^(50 * 60) is beyond every number; what is estimated is what is left between plant and estimate.
    let lambda = [50.0, 0.0, 0.0, -1.0];
    let squares =
        LeastSquares::<f64, 2>::diagonal(&pair(1.0, 1.0), 0.0).unwrap().with_process_noise(&pair(1.0, 1.0)).unwrap();
    let mut observer: PairObserver<f64, _, _> =
        Observer::with_regression(Pair::new(lambda), squares, filter(), Vector2::zeros()).unwrap().rebasing(1).unwrap();
    let dt = 1e-3;
    let (mut z, mut y, mut late) = (Vector2::new(0.01, -2.0), 0.5, 0.0_f64);
    observer.step(Vector1::new(y), Vector1::zeros(), dt).unwrap();
    for k in 0..60_000_u32 {
        // A feedback of the true state holds the plant, as one of the estimate would.
        let u = -60.0 * z.x + (0.01 * f64::from(k)).sin();
        let before = z.sum();
        let flow = Pair::<f64>::new(lambda).flow(&Vector1::zeros(), &Vector1::new(u));
        let mut plant = Fundamental::new(z);
        plant.advance(&flow, &flow, dt).unwrap();
        z = *plant.xi();
        y += (before + z.sum()) * (dt / 2.0);
        let estimate = observer.step(Vector1::new(y), Vector1::new(u), dt).unwrap();
        if k > 40_000 {
            late = late.max((estimate - z).norm());
        }
    }
    // The start is forgotten at 1/s at least. What is left is what the filter makes of straight lines that are curved:
    // 5/s dt^2/12 of a rate of 10.
    println!("largest error after 40 s: {late:e}");
    assert!(late < 1e-5, "{late:e}");
    // Without, it ends in a fault long before.
    let mut plain: PairObserver<f64, _, _> =
        Observer::with_regression(Pair::new(lambda), squares, filter(), Vector2::zeros()).unwrap();
    let fault = (0..60_000).find_map(|_| plain.step(Vector1::zeros(), Vector1::zeros(), dt).err());
    assert_eq!(fault, Some(Fault::State));
}

/// The error of the estimate 5 s after an unmeasured input stepped by 1.
fn after_a_step(observer: PairObserver<f64, LeastSquares<f64, 2>, FilteredRegression<f64, 1, 2>>) -> f64 {
    let mut observer = observer;
    let lambda = [-4.0, 1.0, 0.0, -2.0];
    let mut truth = Truth::new();
    let mut error = 0.0;
    for k in 0..4000 {
        let unknown = if k > 3000 { 1.0 } else { 0.0 };
        let estimate = observer.step(Vector1::new(truth.y), Vector1::new(input(k)), 5e-3).unwrap();
        error = (estimate - truth.extension.xi()).norm();
        truth.advance(lambda, input(k + 1) + unknown, 5e-3);
    }
    error
}

#[test]
fn a_matrix_that_dies_out_is_no_open_loop() {
    let squares = LeastSquares::<f64, 2>::diagonal(&pair(1.0, 1.0), 0.0).unwrap();
    let build = |squares| -> PairObserver<f64, _, _> {
        // Faster than the plant: a filter takes the past as the model has it, disturbance or not.
        Observer::with_regression(Pair::new([-4.0, 1.0, 0.0, -2.0]), squares, filter_of(200.0), Vector2::zeros())
            .unwrap()
    };
    // An input of 1 that is not modelled moves z by 1/4. Psi has died out: nothing that is estimated reaches z.
    let open = after_a_step(build(squares));
    assert!(open > 0.2, "{open}");
    let wandering = squares.with_process_noise(&pair(1e4, 0.0)).unwrap();
    let closed = after_a_step(build(wandering).rebasing(1).unwrap());
    println!("after a step that is not modelled: {open} in the open loop, {closed} re-based");
    assert!(closed < open / 5.0, "{closed} {open}");
}

#[test]
fn weights_of_a_dying_component_remain_finite() {
    // Without process noise P dies out with Psi: in f32 its inverse would overflow after 44 time constants.
    let squares = LeastSquares::<f32, 2>::diagonal(&pair(1.0, 1.0), 0.0).unwrap();
    let mut observer: PairObserver<f32, _, _> =
        Observer::with_regression(Pair::new([-50.0, 0.0, 0.0, -70.0]), squares, filter(), Vector2::zeros())
            .unwrap()
            .rebasing(1)
            .unwrap();
    for k in 0..100_000 {
        observer.step(Vector1::new(0.0), Vector1::new(Real::from_f64(input(k))), 1e-3).unwrap();
    }
    assert!(observer.estimator().information().is_finite());
}

#[test]
fn drift_free_forms_take_lambda_along() {
    let squares = LeastSquares::diagonal(&pair(1e3, 1e3), 0.0).unwrap();
    let build = || -> PairObserver<f64, _, _> {
        Observer::with_regression(Pair::new(LAMBDA), squares, filter(), Vector2::zeros()).unwrap()
    };
    for drift in [Drift::Free, Drift::Leak(2.0), Drift::Above(0.5)] {
        let (mut plain, mut moved) = (build(), build());
        let mut truth = Truth::new();
        let mut largest = 0.0_f64;
        for k in 0..2000 {
            let (y, u) = (Vector1::new(truth.y), Vector1::new(input(k)));
            let one = plain.step(y, u, 5e-3).unwrap();
            let other = moved.step_without_drift(y, u, 5e-3, drift).unwrap();
            largest = largest.max((one - other).norm());
            truth.advance(LAMBDA, input(k + 1), 5e-3);
            let offset = moved.extension().xi().abs().max();
            match drift {
                Drift::Free => assert!(offset < 1e-15 && *moved.extension().psi() == Matrix2::identity()),
                Drift::Above(bound) => assert!(offset <= bound),
                Drift::Leak(_) => assert!(*moved.extension().psi() == Matrix2::identity()),
            }
        }
        // As in the test of re-basing.
        assert!(largest < 1e-9, "{drift:?} {largest:e}");
    }
}

#[test]
fn rebasing_is_never_at_every_zeroth_sample() {
    let squares = LeastSquares::<f64, 2>::diagonal(&pair(1.0, 1.0), 0.0).unwrap();
    let observer: PairObserver<f64, _, _> =
        Observer::with_regression(Pair::new(LAMBDA), squares, filter(), Vector2::zeros()).unwrap();
    assert_eq!(observer.rebasing(0).err(), Some(Fault::Gain));
}

/// A turn by a regular matrix, and the matrix.
fn turn() -> impl Strategy<Value = (Turn<f64, 3>, Matrix3<f64>)> {
    matrix::<3, 3>(-0.5..0.5).prop_filter_map("far from singular", |part| {
        let matrix = Matrix3::identity() + part;
        (matrix.determinant().abs() > 0.2).then(|| (Turn::new(&Sum::new(matrix)).unwrap(), matrix))
    })
}

/// Two runs, one with a turn of the unknown in the middle: the same estimate, in its coordinates.
fn turns<E: Estimator<f64, 2, 3>>(
    estimator: E,
    phis: &[SMatrix<f64, 2, 3>],
    truth: &Vector3<f64>,
    (turn, matrix): &(Turn<f64, 3>, Matrix3<f64>),
) -> Result<(), TestCaseError> {
    let (mut plain, mut turned) = (estimator.clone(), estimator);
    let inverse = matrix.try_inverse().unwrap();
    for (k, phi) in phis.iter().enumerate() {
        if k == 3 {
            turned.turn(turn);
        }
        plain.advance(phi, &(phi * truth), 0.1).unwrap();
        let seen = if k < 3 { *phi } else { phi * inverse };
        turned.advance(&seen, &(phi * truth), 0.1).unwrap();
        let told = if k < 3 { turned.estimate() } else { inverse * turned.estimate() };
        // Numbers up to 60 in problems with a condition number of 1e3 at most, and a turn of 1e2.
        let distance = (told - plain.estimate()).norm();
        prop_assert!(distance < 1e-9, "{} at {}", distance, k);
    }
    Ok(())
}

/// An extension whose regression holds for the unknown, before and after a turn.
fn holds<X: RegressorExtension<f64, 2, 3>>(
    mut extension: X,
    phis: &[SMatrix<f64, 2, 3>],
    truth: &Vector3<f64>,
    (turn, matrix): &(Turn<f64, 3>, Matrix3<f64>),
) -> Result<(), TestCaseError> {
    let inverse = matrix.try_inverse().unwrap();
    for (k, phi) in phis.iter().enumerate() {
        if k == 3 {
            extension.turn(turn);
        }
        let (seen, eta) = if k < 3 { (*phi, *truth) } else { (phi * inverse, matrix * truth) };
        extension.advance(&seen, &(phi * truth), 0.1).unwrap();
        let residual = (extension.matrix() * eta - extension.vector()).norm();
        prop_assert!(residual < 1e-10, "{} at {}", residual, k);
    }
    Ok(())
}

proptest! {
    #[test]
    fn memory_turns_with_the_unknown(
        phis in prop::collection::vec(matrix::<2, 3>(-3.0..3.0), 4..8), truth in vector::<3>(-3.0..3.0),
        start in vector::<3>(-3.0..3.0), turned in turn(),
    ) {
        let gains = Vector3::repeat(1.0);
        let gradient = Gradient::diagonal(&gains).unwrap().starting_at(&start).unwrap().carrying_its_gain();
        let squares = LeastSquares::diagonal(&gains, 0.0).unwrap().starting_at(&start).unwrap();
        turns(gradient, &phis, &truth, &turned)?;
        turns(squares, &phis, &truth, &turned)?;
        let bounds = Vector3::repeat(2.0);
        turns(Bounded::new(squares, &-bounds, &bounds).unwrap(), &phis, &truth, &turned)?;
        holds(Kreisselmeier::new(&gains, 0.3).unwrap(), &phis, &truth, &turned)?;
        holds(Response::<f64, _, 2, 3>::new(gradient).unwrap(), &phis, &truth, &turned)?;
        holds(Response::<f64, _, 2, 3>::new(squares).unwrap(), &phis, &truth, &turned)?;
    }

    #[test]
    fn finite_time_is_exact_through_turns(
        truth in vector::<3>(-3.0..3.0), turned in turn(),
    ) {
        let (turn, matrix) = turned;
        let phis = (0..200_u32).map(|k| SMatrix::<f64, 2, 3>::from_fn(|i, j| {
            (0.1 * f64::from(k) * [1.0, 1.7, 2.3][j] + [0.0, 1.0][i]).sin()
        }));
        let inverse = matrix.try_inverse().unwrap();
        let drem = Drem::new(Kreisselmeier::new(&Vector3::repeat(10.0), 0.0).unwrap(), &Vector3::repeat(1e4)).unwrap();
        let mut estimator = FiniteTime::once(drem, 0.1).unwrap();
        let mut eta = truth;
        let mut back = Matrix3::identity();
        for (k, phi) in phis.enumerate() {
            if k == 5 {
                Estimator::<f64, 2, 3>::turn(&mut estimator, &turn);
                (eta, back) = (matrix * truth, inverse);
            }
            estimator.advance(&(phi * back), &(phi * truth), 0.1).unwrap();
            if estimator.has_arrived() {
                // Some roundings over the clip.
                prop_assert!((Estimator::<f64, 2, 3>::estimate(&estimator) - eta).norm() < 1e-9);
            }
        }
        prop_assert!(estimator.has_arrived());
    }

    #[test]
    fn a_step_of_unknown_size_adds_its_variance(
        root in matrix::<3, 3>(-1.0..1.0), place in 0..3_usize, variance in decades(-6, 6),
    ) {
        let covariance: Matrix3<f64> = root.transpose() * root + Matrix3::identity() * 0.1;
        let mut information = Information::from_covariance(&covariance).unwrap();
        information.diffuse(place, variance);
        let mut expected = covariance;
        expected[(place, place)] += variance;
        // Read back by the vector that fits best to one more equation: P row / (row P row + 1).
        for row in [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.3, -1.0, 2.0), Vector3::new(0.0, 0.0, 1.0)] {
            let mut with = information;
            with.absorb(&row, 1.0, 1.0);
            let gain = expected * row / (row.dot(&(expected * row)) + 1.0);
            // A condition number of 1e8 at most, of which this form feels the root.
            prop_assert!((with.solve().unwrap() - gain).norm() < 1e-10 * (1.0 + gain.norm()));
        }
    }
}
