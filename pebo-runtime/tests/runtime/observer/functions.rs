//! Unknowns that depend on one another: the estimate that goes out is among their values.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Flow, Functions, Fundamental, Gradient, Integrator, LeastSquares, Model, Observer, OutputForm, Rebase, Regression,
    SampledRegression, Sides, Within,
};

type Scalar = SVector<f64, 1>;
type Pair = SVector<f64, 2>;
type Triple = SVector<f64, 3>;

/// `y = a + s(t) a b` with the constants a and b, `eta = (a, b, a b)`: samples say nothing of b but by the product.
#[derive(Clone, Copy, Debug)]
struct Product {
    is_constrained: bool,
}

impl Model<2, 1, 1, 2, 1, 3> for Product {
    type Scalar = f64;
    type Extension = Integrator<f64, 2>;
    type X = Pair;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, _y: &Scalar, _u: &Scalar) -> Flow<f64, 2> {
        Flow::plain(Pair::zeros())
    }
    fn regression(&self, _: &Self::Extension, y: &Scalar, u: &Scalar) -> Sides<f64, 1, 3> {
        Sides { known: *y, factor: SMatrix::from([[1.0], [0.0], [u[0]]]) }
    }
    fn theta(&self, eta: &Triple) -> Pair {
        Pair::new(eta[0], eta[1])
    }
    fn functions(&self, theta: &Pair) -> Option<Functions<f64, 3, 2>> {
        let &[[a, b]] = &theta.data.0;
        let slopes = SMatrix::from([[1.0, 0.0, b], [0.0, 1.0, a]]);
        self.is_constrained.then(|| Functions { values: Triple::new(a, b, a * b), slopes })
    }
    fn recover(&self, z: &Pair, _y: &Scalar) -> Pair {
        *z
    }
}

const NOISE: f64 = 0.01;

/// The samples: an input between -1 and 1, and the output with an error that has no mean over a period.
fn samples() -> impl Iterator<Item = (Scalar, Scalar)> {
    (0..400).map(|k| {
        let (u, sign) = ((0.1 * f64::from(k)).sin(), if k % 2 == 0 { 1.0 } else { -1.0 });
        (Scalar::new(2.0 + u * 2.0 * 0.7 + sign * NOISE), Scalar::new(u))
    })
}

fn squares(
    is_constrained: bool,
) -> Observer<Product, LeastSquares<f64, 3>, 2, 1, 1, 2, 1, 3, SampledRegression<f64, 1, 3>> {
    let estimator = LeastSquares::diagonal(&Triple::new(4.0, 4.0, 16.0), 0.0).unwrap();
    let regression = SampledRegression::new(&Scalar::new(NOISE * 0.1_f64.sqrt())).unwrap();
    Observer::with_regression(Product { is_constrained }, estimator, regression, Pair::zeros()).unwrap()
}

#[test]
fn a_factor_is_known_by_its_product() {
    let [mut with, mut without] = [true, false].map(squares);
    for (y, u) in samples() {
        with.step(y, u, 0.1).unwrap();
        without.step(y, u, 0.1).unwrap();
    }
    let [found, blind] = [with.theta(), without.theta()];
    // The error of the mean of 400 samples is a twentieth of the noise.
    assert!((found - Pair::new(2.0, 0.7)).amax() < 5.0 * NOISE / 20.0, "{found}");
    assert!(blind[1].abs() < 1e-9, "{blind}");
    // Functions and theta agree.
    assert!((with.eta() - Triple::new(found[0], found[1], found[0] * found[1])).amax() < 1e-12);
    let [known, unknown] = [with.standard_error().unwrap(), without.standard_error().unwrap()];
    assert!(known.amax() < 0.01 && unknown[1] > 1.9, "{known} {unknown}");
}

#[test]
fn an_estimator_without_information_is_left_alone() {
    let observer = |is_constrained| {
        let gradient = Gradient::diagonal(&Triple::repeat(2.0)).unwrap();
        let regression = SampledRegression::<f64, 1, 3>::new(&Scalar::new(1.0)).unwrap();
        Observer::with_regression(Product { is_constrained }, gradient, regression, Pair::zeros()).unwrap()
    };
    let (mut with, mut without) = (observer(true), observer(false));
    for (y, u) in samples() {
        assert_eq!(with.step(y, u, 0.1).unwrap(), without.step(y, u, 0.1).unwrap());
    }
}

/// `y = a + s(t) a^2`, with `eta = (a, a^2)`.
#[derive(Clone, Copy, Debug)]
struct Square {
    is_constrained: bool,
}

impl Model<1, 1, 1, 1, 1, 2> for Square {
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
    fn regression(&self, _: &Self::Extension, y: &Scalar, u: &Scalar) -> Sides<f64, 1, 2> {
        Sides { known: *y, factor: SMatrix::from([[1.0], [u[0]]]) }
    }
    fn theta(&self, eta: &Pair) -> Scalar {
        Scalar::new(eta[0])
    }
    fn functions(&self, theta: &Scalar) -> Option<Functions<f64, 2, 1>> {
        let a = theta[0];
        self.is_constrained.then(|| Functions { values: Pair::new(a, a * a), slopes: SMatrix::from([[1.0, 2.0 * a]]) })
    }
    fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
        *z
    }
}

/// From 0.5 the tangent of the square leads beyond 9, where its value is farther from 9 than it was.
#[test]
fn a_step_that_leads_away_is_shortened() {
    let estimator = LeastSquares::diagonal(&Pair::new(4.0, 16.0), 0.0).unwrap();
    let regression = SampledRegression::<f64, 1, 2>::new(&Scalar::new(NOISE * 0.1_f64.sqrt())).unwrap();
    let square = Square { is_constrained: true };
    let mut observer = Observer::with_regression(square, estimator, regression, Scalar::zeros()).unwrap();
    observer.restart(Scalar::zeros(), &Pair::new(0.5, 0.25)).unwrap();
    let (a, u) = (3.0, Scalar::new(1e3));
    for _ in 0..2 {
        observer.step(Scalar::new(a + u.x * a * a), u, 0.1).unwrap();
    }
    // The prior of a, of one standard deviation of 2, moves the estimate by a part of the sensor's error alone.
    assert!((observer.theta().x - a).abs() < 1e-4, "{}", observer.theta());
}

/// The true value is among those of the functions: data that contradict all of these are no reason to trust one.
#[test]
fn an_estimate_that_is_far_from_all_values_stays() {
    let observer = |is_constrained| {
        let estimator = LeastSquares::diagonal(&Pair::new(4.0, 16.0), 0.0).unwrap();
        let regression = SampledRegression::<f64, 1, 2>::new(&Scalar::new(NOISE * 0.1_f64.sqrt())).unwrap();
        Observer::with_regression(Square { is_constrained }, estimator, regression, Scalar::zeros()).unwrap()
    };
    let after = |is_constrained, square: f64| {
        let mut observer = observer(is_constrained);
        for (_, u) in samples() {
            observer.step(Scalar::new(1.0) + u * square, u, 0.1).unwrap();
        }
        observer.eta()
    };
    assert!((after(false, -3.0) - Pair::new(1.0, -3.0)).amax() < 1e-3);
    // The first samples leave so much open that a value of the functions is near; the others outweigh them by their
    // number, 400.
    assert!((after(true, -3.0) - Pair::new(1.0, -3.0)).amax() < 0.1, "{}", after(true, -3.0));
    let found = after(true, 1.0);
    assert!((found - Pair::new(1.0, 1.0)).amax() < 1e-3, "{found}");
}

/// `y' = x1 + u x1 x2 - y` with the constants x1 and x2: `z = (x1, x2, x1 x2)`. Samples say nothing of x2 but by the product.
#[derive(Clone, Copy, Debug)]
struct Lifted<const RELATED: bool>;

impl<const RELATED: bool> Model<2, 1, 1, 3, 1, 3> for Lifted<RELATED> {
    type Scalar = f64;
    type Extension = Fundamental<f64, 3>;
    type X = Pair;
    type Y = Scalar;
    type U = Scalar;
    type Terms = Scalar;
    const REGRESSION: Regression = Regression::Dynamic;
    const RELATED: bool = RELATED;

    fn terms(&self, y: &Scalar) -> Scalar {
        *y
    }
    fn flow(&self, _y: &Scalar, _u: &Scalar) -> Flow<f64, 3> {
        Flow::plain(Triple::zeros())
    }
    fn regression(&self, extension: &Self::Extension, y: &Scalar, u: &Scalar) -> Sides<f64, 1, 3> {
        let row = SMatrix::<f64, 1, 3>::new(1.0, 0.0, u[0]);
        Sides { known: row * extension.xi() - y, factor: row * extension.psi() }
    }
    fn primitive(&self, _: &Self::Extension, y: &Scalar) -> Sides<f64, 1, 3> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn theta(&self, eta: &Triple) -> Triple {
        *eta
    }
    fn transform(&self, x: &Pair, _y: &Scalar) -> Option<Functions<f64, 3, 2>> {
        let &[[x1, x2]] = &x.data.0;
        let slopes = SMatrix::from([[1.0, 0.0, x2], [0.0, 1.0, x1]]);
        Some(Functions { values: Triple::new(x1, x2, x1 * x2), slopes })
    }
    fn recover(&self, z: &Triple, _y: &Scalar) -> Pair {
        Pair::new(z[0], z[1])
    }
}

impl<const RELATED: bool> Rebase<2, 1, 1, 3, 1> for Lifted<RELATED> {}

const STATE: Pair = Pair::new(2.0, 0.7);

/// The samples of `Lifted`, whose output relaxes towards `x1 + u x1 x2`, with an error of the sensor that has no mean over
/// a period.
fn lifted_samples() -> impl Iterator<Item = (Scalar, Scalar)> {
    let mut output = 0.0;
    (0..400).map(move |k| {
        let (u, sign) = (1.0 + f64::from(k).sin(), if k % 2 == 0 { NOISE } else { -NOISE });
        if k > 0 {
            let end = STATE[0] + u * STATE[0] * STATE[1];
            output = end + (output - end) * (-0.05_f64).exp();
        }
        (Scalar::new(output + sign), Scalar::new(u))
    })
}

#[test]
fn a_state_is_known_by_a_component_that_holds_it() {
    type Lift<const RELATED: bool> = OutputForm<Lifted<RELATED>, f64, 1, 3>;
    fn run<
        M: Model<2, 1, 1, 4, 1, 4, Scalar = f64, Extension = Fundamental<f64, 4>, X = Pair, Y = Scalar, U = Scalar>,
    >(
        model: M,
    ) -> (Pair, Pair) {
        let squares = LeastSquares::diagonal(&SVector::<f64, 4>::new(1e-4, 4.0, 4.0, 16.0), 0.0).unwrap();
        let regression = SampledRegression::<f64, 1, 4>::new(&Scalar::new(NOISE * 0.05_f64.sqrt())).unwrap();
        let mut observer = Observer::with_regression(model, squares, regression, SVector::zeros()).unwrap();
        let mut error = Pair::zeros();
        for (y, u) in lifted_samples() {
            error = observer.step(y, u, 0.05).unwrap() - STATE;
        }
        (error, observer.standard_error().unwrap())
    }
    let (blind, unknown) = run(Lift::new(Lifted::<false>));
    assert!(blind[1].abs() > 0.6 && unknown[1] > 1.9, "{blind} {unknown}");
    // A step is exact where the input is held: what is left is the noise, a few standard errors.
    let (error, known) = run(Lift::new(Lifted::<true>));
    assert!(known.amax() < 0.02 && error.abs() < 4.0 * known, "{error} {known}");
    // Bounds on the states that hold change nothing.
    let within = Within::new(Lift::new(Lifted::<true>), &Pair::zeros(), &Pair::repeat(9.0)).unwrap();
    assert_eq!(run(within), (error, known));
}
