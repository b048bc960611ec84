//! Settings of a call that a file cannot have.

use crate::Overrides;
use pebo_design::model::Estimator;

use super::{CUK, CUK_CASE_2, SPRING, resolve, run};

#[test]
fn the_error_at_the_start_is_that_share_of_the_files() {
    for text in [SPRING, CUK, CUK_CASE_2] {
        let errors = |share| {
            let called =
                Overrides { initial_error: share, duration: Some(1e-3), step: Some(1e-5), ..Overrides::default() };
            let trace = run(text, &called);
            let own = trace.summary().estimates.iter().filter(|rated| rated.estimate.baseline.is_none());
            own.map(|rated| rated.score.first).collect::<Vec<_>>()
        };
        let usual = errors(None);
        for share in [0.0, 0.5, 1.0, 2.0] {
            for (error, usual) in errors(Some(share)).into_iter().zip(&usual) {
                // The left inverses of these are affine in z: what remains is rounding of numbers of some tens.
                assert!((error - share * usual).abs() <= 1e-13, "{share}: {error} {usual}");
            }
        }
    }
}

#[test]
fn every_estimator_can_be_tried_on_every_section() {
    let sections = [
        "gain: [5e-6, 0.1], filter: 1e3",
        "estimator: least-squares, covariance: [1e6, 1e10], forgetting: 100, window: 100",
        "estimator: finite-time-drem, gain: 1e5, regressor_gain: [2e-3, 40], forgetting: 200, clip: 0.1, filter: 1e3",
        "estimator: least-squares-drem, gain: 1e5, covariance: [1e6, 1e10], filter: 1e3",
    ];
    let start = CUK_CASE_2.find("observer:\n").unwrap();
    let end = CUK_CASE_2.find("simulation:\n").unwrap();
    for section in sections {
        let text = format!("{}observer: {{{section}}}\n{}", &CUK_CASE_2[..start], &CUK_CASE_2[end..]);
        for estimator in Estimator::ALL {
            let called = Overrides { estimator: Some(estimator), duration: Some(1e-3), ..Overrides::default() };
            let scenario = resolve(&text, &called).unwrap();
            assert!(scenario.run().is_ok(), "{section} with {}", estimator.name());
        }
    }
    // Known numbers are those of least squares: another estimator has gains, and is another observer.
    for section in ["", "observer: {sensors: {v2: 0.1}, start: {i1: 5}, gate: 25}\n"] {
        let text = format!("{}{section}{}", &CUK_CASE_2[..start], &CUK_CASE_2[end..]);
        let usual = run(&text, &Overrides { duration: Some(1e-3), ..Overrides::default() }).csv();
        for estimator in Estimator::ALL {
            let called = Overrides { estimator: Some(estimator), duration: Some(1e-3), ..Overrides::default() };
            let same = run(&text, &called).csv() == usual;
            assert_eq!(same, estimator == Estimator::LeastSquares, "{section} with {}", estimator.name());
        }
    }
    // The gain of the gradient is the covariance of least squares, and the other way round.
    let gradient = "estimator: gradient, gain: [5e-6, 0.1], filter: 1e3";
    let least = "estimator: least-squares, covariance: [5e-6, 0.1], filter: 1e3";
    let text = |section: &str| format!("{}observer: {{{section}}}\n{}", &CUK_CASE_2[..start], &CUK_CASE_2[end..]);
    for (from, to, other) in [(gradient, Estimator::LeastSquares, least), (least, Estimator::Gradient, gradient)] {
        let called = Overrides { estimator: Some(to), duration: Some(1e-3), ..Overrides::default() };
        let usual = Overrides { duration: Some(1e-3), ..Overrides::default() };
        assert_eq!(run(&text(from), &called).csv(), run(&text(other), &usual).csv());
    }
}
