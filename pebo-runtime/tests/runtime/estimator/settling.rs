//! The settling times of the estimators on the Cuk converter, case II, without noise, on the data of one closed loop.

use pebo_runtime::nalgebra::{Vector1, Vector2};
use pebo_runtime::{
    Drem, Estimator, Filter, FilteredRegression, FiniteTime, Hold, Kreisselmeier, LeastSquares, Observer,
    RegressionOperator, Response, WindowedRegression,
};

use crate::converter::{Case, CaseTwo, Loop};

const DT: f64 = 1e-5;

/// Samples until the error of both components stays below 1 % of its start, and the error after 10 ms.
fn settles<E, R>(estimator: E, regression: R) -> (u32, Vector2<f64>)
where
    E: Estimator<f64, 2, 2>,
    R: RegressionOperator<f64, 2, 2>,
{
    // The loop is closed by the paper's observer: whoever watches sees the same data.
    let mut closed = Loop::<f64, CaseTwo<f64>>::new(1.0, [1.0, 10.0], DT).unwrap();
    let mut observer = Observer::with_regression(CaseTwo::new(), estimator, regression, Vector2::zeros()).unwrap();
    observer.step(closed.outputs(), Vector1::zeros(), DT).unwrap();
    let initial = closed.error();
    let mut settled = 0;
    let mut error = initial;
    for k in 1..=1000_u32 {
        let duty = Vector1::new(closed.duty());
        closed.advance().unwrap();
        let truth = CaseTwo::<f64>::unmeasured(&closed.circuit);
        error = observer.step(closed.outputs(), duty, DT).unwrap() - truth;
        if error.component_div(&initial).abs().max() > 0.01 {
            settled = k + 1;
        }
    }
    (settled, error)
}

#[test]
fn a_few_samples_suffice() {
    let filtered = FilteredRegression::new(Filter::new(1e3, Hold::First).unwrap());
    let weak = Vector2::new(1e6, 1e10);
    let squares = LeastSquares::diagonal(&weak, 0.0).unwrap();
    let speed = Vector2::new(1e5, 1e5);
    let memory = Kreisselmeier::new(&Vector2::new(2e-3, 40.0), 0.0).unwrap();
    let window = WindowedRegression::<f64, 2, 2, 100>::new(Hold::First);
    let runs = [
        // Two equations in two unknowns: one interval has it all, and the trapezoidal rule knows it to (2e3/s *
        // dt)^2/12.
        ("least squares", settles(squares, filtered), 1),
        ("least squares, window", settles(squares, window), 1),
        // The scalar estimators take their time: ln(100)/1e5 s and what the determinant needs to rise.
        (
            "least squares + DREM",
            settles(Drem::new(Response::<_, _, 2, 2>::new(squares).unwrap(), &speed).unwrap(), filtered),
            10,
        ),
        // Until the integral of 1e5 Delta^2 is ln(1/0.9): the memory must fill first.
        ("finite time", settles(FiniteTime::once(Drem::new(memory, &speed).unwrap(), 0.1).unwrap(), filtered), 30),
    ];
    for (name, (settled, error), samples) in runs {
        assert!(settled <= samples, "{name} after {settled} samples");
        // The error of sampling of 0.5 A and 7.5 V: (2e3/s * 1e-5 s)^2/12 = 3e-5 of each, twice over.
        assert!(error.x.abs() < 3e-5 && error.y.abs() < 4e-4, "{name}: {error}");
    }
}
