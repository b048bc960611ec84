//! Estimators and windows chosen in a model file: each converges, and is the runtime's own in spite of the padding.

use pebo_runtime::nalgebra::{Matrix2, SMatrix, SVector, Vector2};
use pebo_runtime::{
    AdaptiveLeastSquares, Drem, Estimator, FiniteTime, Gradient, Hold, Kreisselmeier, LeastSquares, RegressionOperator,
    Response, Sides, WindowedRegression,
};

use super::{CUK_CASE_2, resolve, run};
use crate::Overrides;
use crate::observe::estimator::PaddedEstimator;
use crate::observe::operator::Window;
use crate::observe::setup::{self, Covariance, Extension};
use crate::observe::sizes::{LARGEST, MOST_MIXED, padded};
use pebo_design::source::Code;

/// Case II of the converter with this section `observer`.
fn converter(section: &str) -> String {
    let start = CUK_CASE_2.find("observer:\n").unwrap();
    let end = CUK_CASE_2.find("simulation:\n").unwrap();
    format!("{}observer: {{{section}}}\n{}", &CUK_CASE_2[..start], &CUK_CASE_2[end..])
}

/// The largest errors of `i1` and `v4` in the last quarter of 20 ms, over those at the start.
fn remains(section: &str) -> [f64; 2] {
    let trace = run(&converter(section), &Overrides { duration: Some(0.02), ..Overrides::default() });
    ["i1_error", "v4_error"].map(|name| {
        let errors = trace.column(name).unwrap();
        let late = &errors[errors.len() / 4 * 3..];
        late.iter().fold(0.0, |largest, error| f64::max(largest, error.abs())) / errors[0].abs()
    })
}

#[test]
fn each_converges() {
    let sections = [
        "gain: [5e-6, 0.1], filter: 1e3",
        "estimator: normalised-gradient, gain: [5e-6, 0.1], normalisation: 1e-9, filter: 1e3",
        "estimator: least-squares, covariance: [1e6, 1e10], filter: 1e3",
        "estimator: least-squares, covariance: [1e6, 1e10], forgetting: 100, window: 100",
        "estimator: drem, gain: 1e5, regressor_gain: [2e-3, 40], forgetting: 200, filter: 1e3",
        "estimator: finite-time-drem, gain: 1e5, regressor_gain: [2e-3, 40], clip: 0.1, filter: 1e3",
        "estimator: finite-time-drem, gain: 1e5, regressor_gain: [2e-3, 40], forgetting: 200, clip: 0.1, period: 5e-3, filter: 1e3",
        "estimator: gradient-drem, gain: 1e5, regressor_gain: [5e-6, 0.1], filter: 1e3",
        "estimator: least-squares-drem, gain: 1e5, covariance: [1e6, 1e10], filter: 1e3",
        "estimator: least-squares, covariance: [1e6, 1e10], bounds: {lower: -50, upper: 50}, filter: 1e3, hold: zero-order",
    ];
    for section in sections {
        let [i1, v4] = remains(section);
        // The 1 % of settling.
        assert!(i1 < 0.01 && v4 < 0.01, "{section}: {i1} {v4}");
    }
    // The unknown of the voltage is 7.5: more than half of that is beyond this bound, and remains as error.
    let [_, v4] = remains("estimator: least-squares, covariance: [1e6, 1e10], bounds: {upper: [50, 3]}, filter: 1e3");
    assert!(v4 > 0.5, "{v4}");
}

/// A regression of two unknowns with three equations, at some step.
fn data(k: u32) -> (SMatrix<f64, 3, 2>, SVector<f64, 3>) {
    let t = 0.1 * f64::from(k);
    let factor = SMatrix::<f64, 3, 2>::new(t.sin(), 1.0, t.cos(), -2.0, 0.5 * t.sin(), t.cos());
    (factor, factor * Vector2::new(1.0, -2.0) + SVector::<f64, 3>::repeat(1e-3 * t.sin()))
}

/// The estimate of the erased estimator, padded to any size, against that of the estimator itself.
fn same(settings: &setup::Estimator, plain: impl Estimator<f64, 3, 2>) {
    same_of::<4>(settings, plain.clone());
    same_of::<MOST_MIXED>(settings, plain.clone());
    same_of::<LARGEST>(settings, plain);
}

fn same_of<const N: usize>(settings: &setup::Estimator, mut plain: impl Estimator<f64, 3, 2>) {
    let mut erased = PaddedEstimator::<N>::new(settings, 2).unwrap();
    for k in 0..50 {
        let (factor, known) = data(k);
        erased.advance(&padded_square(&factor), &padded(known.as_slice(), 0.0), 0.1).unwrap();
        plain.advance(&factor, &known, 0.1).unwrap();
        let (found, expected) = (erased.estimate(), plain.estimate());
        // Sums with zeros besides may be taken in another order: some roundings of numbers up to 10.
        let close = (found.fixed_rows::<2>(0) - expected).norm() < 1e-13;
        assert!(close && found.iter().skip(2).all(|padding| *padding == 0.0), "{settings:?} {k}: {found} {expected}");
    }
    // A copy is one: the observer advances copies.
    let before = erased.estimate();
    let (factor, known) = data(7);
    let mut copy = erased.clone();
    copy.advance(&padded_square(&factor), &padded(known.as_slice(), 1.0), 0.1).unwrap();
    assert_eq!(erased.estimate(), before);
    erased.shift(&padded(&[1.0, 2.0], 0.0));
    assert!((erased.estimate() - before - padded::<N>(&[1.0, 2.0], 0.0)).norm() < 1e-13);
    erased.reset(&padded(&[3.0, 4.0], 0.0));
    assert!(erased.estimate() == padded::<N>(&[3.0, 4.0], 0.0) && erased.is_finite());
}

fn padded_square<const N: usize>(factor: &SMatrix<f64, 3, 2>) -> SMatrix<f64, N, N> {
    let mut wide = SMatrix::<f64, N, N>::zeros();
    wide.view_mut((0, 0), (3, 2)).copy_from(factor);
    wide
}

#[test]
fn padding_changes_no_estimate() {
    let gain = vec![2.0, 3.0];
    let gains = Vector2::new(2.0, 3.0);
    let covariance = || Covariance { start: vec![4.0, 5.0], forgetting: 0.5, process_noise: None };
    let gradient = Gradient::diagonal(&gains).unwrap();
    let squares = LeastSquares::diagonal(&Vector2::new(4.0, 5.0), 0.5).unwrap();
    let memory = Kreisselmeier::new(&Vector2::new(4.0, 5.0), 0.5).unwrap();
    let drem = Drem::new(memory, &gains).unwrap();
    let mixed = |extension| setup::Estimator::Drem { gain: gain.clone(), extension };
    let kreisselmeier = |finite_time| Extension::Kreisselmeier { gain: vec![4.0, 5.0], forgetting: 0.5, finite_time };
    let finite = |period| Some(setup::FiniteTime { clip: 0.2, period });
    same(&setup::Estimator::Gradient(gain.clone()), gradient);
    same(&setup::Estimator::LeastSquares(covariance()), squares);
    let adaptive = AdaptiveLeastSquares::new(squares, &Vector2::new(0.3, 7.0)).unwrap();
    same(&setup::Estimator::AdaptiveLeastSquares(covariance(), vec![0.3, 7.0]), adaptive);
    same(&mixed(kreisselmeier(None)), drem);
    same(&mixed(kreisselmeier(finite(None))), FiniteTime::once(drem, 0.2).unwrap());
    same(&mixed(kreisselmeier(finite(Some(1.0)))), FiniteTime::tracking(drem, 0.2, 1.0).unwrap());
    let response = Response::<f64, _, 3, 2>::new(gradient).unwrap();
    same(&mixed(Extension::Gradient(gain.clone())), Drem::new(response, &gains).unwrap());
    let response = Response::<f64, _, 3, 2>::new(squares).unwrap();
    same(&mixed(Extension::LeastSquares(covariance())), Drem::new(response, &gains).unwrap());
}

#[test]
fn a_window_of_any_length_is_that_of_the_runtime() {
    for hold in [Hold::Zero, Hold::First] {
        let mut constant = WindowedRegression::<f64, 2, 2, 7>::new(hold);
        let mut any = Window::<2>::new(7, hold);
        for k in 0..40_u32 {
            let side = |k: u32| {
                let t = f64::from(k);
                Sides {
                    known: Vector2::new(t.sin(), t.cos()),
                    factor: Matrix2::new(t.cos(), 0.1, 0.3, (2.0 * t).sin()),
                }
            };
            let dt = 0.1 + 0.01 * f64::from(k % 3);
            let sides = [&side(k), &side(k + 1)];
            constant.take(constant.step(sides, dt));
            any.take(any.step(sides, dt));
            assert_eq!((constant.regressand(), constant.regressor()), (any.regressand(), any.regressor()));
            if k == 20 {
                constant.shift(&Vector2::new(1.0, -3.0));
                any.shift(&Vector2::new(1.0, -3.0));
                // The ring begins elsewhere than the queue: the sum is taken in another order, of numbers up to 10.
                assert!((constant.regressand() - any.regressand()).norm() < 1e-14);
                constant.reset();
                any.reset();
            }
            assert!(any.is_finite());
        }
    }
}

#[test]
fn drem_of_many_unknowns_is_refused() {
    let list = |entry: &dyn Fn(u32) -> String| (1..=9).map(entry).collect::<Vec<_>>().join(", ");
    let masses = format!(
        "model: masses\nx: [{}]\ny: [{}]\nf_x: {{{}}}\nf_y: {{{}}}\nphi: [{}]\n\
         observer: {{estimator: drem, gain: 5, regressor_gain: 5, filter: 5}}\n\
         simulation: {{duration: 3, step: 0.01, initial: {{{}, {}}}}}\n",
        list(&|i| format!("a{i}")),
        list(&|i| format!("q{i}")),
        list(&|i| format!("a{i}: -q{i}")),
        list(&|i| format!("q{i}: a{i}")),
        list(&|i| format!("a{i}")),
        list(&|i| format!("a{i}: {i}")),
        list(&|i| format!("q{i}: 0")),
    );
    let found = resolve(&masses, &Overrides::default()).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code, Code::SimulationUnsupported);
    assert!(found[0].help.is_some());
}
