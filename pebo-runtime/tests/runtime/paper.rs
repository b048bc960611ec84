//! The Cuk runs of the paper, Section 5.3, against an independent reference.
//!
//! The reference integrates plant, controller and observer as one continuous stiff system (LSODA, rtol 1e-8), without
//! sampling. Here the loop is sampled: the control is held and the gradient steps implicitly, both of first
//! order. What remains at a step dt is a lag of the order of dt: at most dt times the slope of the error curve.

use pebo_runtime::nalgebra::Vector2;

use crate::converter::{Case, CaseOne, CaseTwo, CaseTwoGeneralised, Loop};

/// A row of the reference: time in s, then both errors, estimate minus truth.
type Point = (f64, [f64; 2]);

/// Case I, alpha 0.5, Gamma diag(0.001, 0.001): errors of i1 and i3 in A.
const CASE_ONE: [Point; 4] = [
    (0.0, [-0.5, 1.0]),
    (0.01, [-0.524_543_533, 0.805_864_955]),
    (0.05, [-0.159_374_94, 0.026_149_012_8]),
    (0.1, [-1.106_117_04e-5, 1.823_540_94e-6]),
];
/// Case II, alpha 1, Gamma diag(0.01, 0.1): errors of i1 in A and v4 in V.
const CASE_TWO_LOW: [Point; 4] = [
    (0.0, [-0.5, -7.519_650_66]),
    (0.01, [-0.250_453_74, -7.517_163_23]),
    (0.05, [-5.352_580_6e-10, -7.223_789_65]),
    (0.1, [8.255_174_32e-12, -5.518_246_52]),
];
/// Case II, alpha 1, Gamma diag(1, 10).
const CASE_TWO_HIGH: [Point; 5] = [
    (0.0, [-0.5, -7.519_650_66]),
    (0.002, [-0.276_859_626, -7.517_648_69]),
    (0.01, [-2.488_236_28e-10, -7.274_937_24]),
    (0.03, [7.931_633_13e-10, -3.118_927_46]),
    (0.05, [-4.064_770_74e-10, -0.135_812_467]),
];

/// The largest distance from the reference, relative to the initial error, of each component.
fn distance<M: Case<f64>>(points: &[Point], alpha: f64, gains: [f64; 2], dt: f64) -> Vector2<f64> {
    let mut closed = Loop::<f64, M>::new(alpha, gains, dt).unwrap();
    let initial = Vector2::from(points[0].1);
    let (mut now, mut worst) = (0.0, Vector2::zeros());
    for &(t, errors) in points {
        closed.run(t - now).unwrap();
        now = t;
        worst = worst.sup(&(closed.error() - Vector2::from(errors)).component_div(&initial).abs());
    }
    worst
}

/// The time after which each error stays below 1 % of its initial value, looked at every millisecond.
fn settling<M: Case<f64>>(alpha: f64, gains: [f64; 2]) -> [f64; 2] {
    let mut closed = Loop::<f64, M>::new(alpha, gains, 1e-5).unwrap();
    let initial = closed.error();
    let mut settled = [0.0; 2];
    for millisecond in 1..350 {
        closed.run(1e-3).unwrap();
        for (settled, (error, initial)) in settled.iter_mut().zip(closed.error().iter().zip(initial.iter())) {
            if error.abs() >= 0.01 * initial.abs() {
                *settled = f64::from(millisecond + 1) * 1e-3;
            }
        }
    }
    settled
}

fn assert_settling(settled: [f64; 2], expected: [f64; 2]) {
    for (settled, expected) in settled.iter().zip(expected) {
        // The grid of both is 1 ms: 1 % may be crossed on the other side of a grid point.
        assert!((settled - expected).abs() < 1.1e-3, "{settled} {expected}");
    }
}

#[test]
fn case_one() {
    // Steepest slopes: i1 loses 40 % in 10 ms around 0.05 s (40/s), i3 65 % in 10 ms (65/s): dt times that.
    let worst = distance::<CaseOne<f64>>(&CASE_ONE, 0.5, [0.001, 0.001], 1e-5);
    assert!(worst.x < 4e-4 && worst.y < 6.5e-4, "{worst}");
    assert_settling(settling::<CaseOne<f64>>(0.5, [0.001, 0.001]), [0.077, 0.060]);
}

#[test]
fn case_two_low_gain() {
    // i1 loses 50 % in 5 ms (100/s); v4 needs a tenth of a second for 27 % (5/s).
    let worst = distance::<CaseTwo<f64>>(&CASE_TWO_LOW, 1.0, [0.01, 0.1], 1e-5);
    assert!(worst.x < 1e-3 && worst.y < 5e-5, "{worst}");
    assert_settling(settling::<CaseTwo<f64>>(1.0, [0.01, 0.1]), [0.019, 0.256]);
}

#[test]
fn case_two_high_gain() {
    // i1 loses 90 % in 2 ms (450/s); v4 55 % in 20 ms (30/s).
    let worst = distance::<CaseTwo<f64>>(&CASE_TWO_HIGH, 1.0, [1.0, 10.0], 1e-5);
    assert!(worst.x < 4.5e-3 && worst.y < 3e-4, "{worst}");
    assert_settling(settling::<CaseTwo<f64>>(1.0, [1.0, 10.0]), [0.004, 0.053]);
}

#[test]
fn sampling_error_is_of_first_order() {
    let at = |dt| distance::<CaseTwo<f64>>(&CASE_TWO_HIGH, 1.0, [1.0, 10.0], dt).x;
    let ratio = at(1e-5) / at(5e-6);
    // Halving the step halves the distance, but for the second-order part: (450/s * 1e-5 s) of it, a few times over.
    assert!((ratio - 2.0).abs() < 0.05, "{ratio}");
}

#[test]
fn generalised_observer_agrees_with_the_cascade_one() {
    // The first state has the same equations in both; the second is found in either way: in the cascade by estimation,
    // in the generalised one by the circuit's own decay G/C4 = 1952/s, long over after 20 ms.
    let mut cascade = Loop::<f64, CaseTwo<f64>>::new(1.0, [0.01, 0.1], 1e-5).unwrap();
    let mut generalised = Loop::<f64, CaseTwoGeneralised<f64>>::new(1.0, [0.01, 0.1], 1e-5).unwrap();
    let initial = generalised.error();
    cascade.run(0.01).unwrap();
    generalised.run(0.01).unwrap();
    // Equal but for rounding, which the loop feeds back, in the first 10 ms.
    assert!((cascade.error().x - generalised.error().x).abs() < 1e-9);
    generalised.run(0.02).unwrap();
    // The error of sampling, second order: (2132 rad/s * dt)^2/12 = 4e-5 of a ripple that is itself below the state.
    let error = generalised.error().component_div(&initial);
    assert!(error.abs().max() < 4e-5, "{error}");
}

#[test]
fn single_precision_follows_the_reference() {
    // A step of 1e-6 s is the hard one: alpha dt = 5e-7 is 8 times the resolution of f32, and sums that lose what does
    // not fit end percents away. What remains: 20 roundings of numbers relative to the initial error.
    let mut closed = Loop::<f32, CaseOne<f32>>::new(0.5, [0.001, 0.001], 1e-6).unwrap();
    closed.run(0.05).unwrap();
    let error = closed.error() - Vector2::new(-0.159_374_94, 0.026_149_012_8);
    assert!(error.abs().max() < 2e-4, "{error}");
    closed.run(0.05).unwrap();
    assert!(closed.error().abs().max() < 2e-4, "{}", closed.error());
}
