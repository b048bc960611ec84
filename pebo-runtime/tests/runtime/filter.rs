//! The filter against the convolution that it stands for.

use crate::random::decades;
use pebo_runtime::nalgebra::Vector1;
use pebo_runtime::{Fault, Filter, Filtered, Hold, Real};
use proptest::prelude::*;

fn step<S: Real>(alpha: S, hold: Hold, output: S, inputs: [S; 2], dt: S) -> S {
    let mut filter = Filter::new(alpha, hold).unwrap();
    let mut filtered = Filtered::new(Vector1::new(output));
    filtered.advance(&filter.weights(dt), &Vector1::new(inputs[0]), &Vector1::new(inputs[1]));
    filtered.value().x
}

/// The integral of `a e^(-a (1 - s)) (x0 + (x1 - x0) s)` over 0..1 by Gauss-Legendre quadrature of 3 points on 256
/// panels.
fn convolution(a: f64, x0: f64, x1: f64) -> f64 {
    let node = 0.6_f64.sqrt();
    let mut sum = 0.0;
    for panel in 0..256 {
        for (point, weight) in [(-node, 5.0 / 9.0), (0.0, 8.0 / 9.0), (node, 5.0 / 9.0)] {
            let s = (f64::from(panel) + 0.5 + 0.5 * point) / 256.0;
            sum += weight / 512.0 * a * (-a * (1.0 - s)).exp() * (x0 + (x1 - x0) * s);
        }
    }
    sum
}

proptest! {
    #[test]
    fn step_is_the_convolution(
        alpha in decades(-6, 6), a in decades(-9, 1), output in -1.0..1.0, x0 in -1.0..1.0, x1 in -1.0..1.0,
    ) {
        // Quadrature error of one panel: (a/256)^6/2e6 < 2e-15 of the integrand at a = 10; rounding of its 768 terms
        // 1e-14.
        let tolerance = 2e-14;
        let decayed = output * (-a).exp();
        let first = step(alpha, Hold::First, output, [x0, x1], a / alpha);
        prop_assert!((first - decayed - convolution(a, x0, x1)).abs() < tolerance, "{first}");
        let zero = step(alpha, Hold::Zero, output, [x0, x1], a / alpha);
        prop_assert!((zero - decayed - convolution(a, x0, x0)).abs() < tolerance, "{zero}");
    }

    #[test]
    fn small_steps_keep_their_digits(alpha in decades(-6, 6), a in decades(-12, -6), x0 in 0.1..1.0, x1 in -1.0..1.0) {
        // From rest the output is a (x0 + x1)/2 - a^2 (2 x0 + x1)/6 + O(a^3): all of it is the small number.
        let expected = a * (x0 + x1) / 2.0 - a * a * (2.0 * x0 + x1) / 6.0;
        let got = step(alpha, Hold::First, 0.0, [x0, x1], a / alpha);
        // The cubic term, and a few roundings of terms of size a.
        prop_assert!((got - expected).abs() <= a * a * a + 8.0 * f64::EPSILON * a);
    }

    #[test]
    fn two_half_steps_are_one(
        alpha in decades(-9, 9), dt in decades(-9, 9), output in -1.0..1.0, x0 in -1.0..1.0, x1 in -1.0..1.0,
    ) {
        let middle = f64::midpoint(x0, x1);
        let whole = step(alpha, Hold::First, output, [x0, x1], dt);
        let half = step(alpha, Hold::First, output, [x0, middle], dt / 2.0);
        let halves = step(alpha, Hold::First, half, [middle, x1], dt / 2.0);
        // About ten roundings of numbers below 2 in each step.
        prop_assert!((whole - halves).abs() < 32.0 * f64::EPSILON, "{whole} {halves}");

        let whole = step(alpha, Hold::Zero, output, [x0, x1], dt);
        let half = step(alpha, Hold::Zero, output, [x0, middle], dt / 2.0);
        let halves = step(alpha, Hold::Zero, half, [x0, x1], dt / 2.0);
        prop_assert!((whole - halves).abs() < 32.0 * f64::EPSILON, "{whole} {halves}");
    }
}

#[test]
fn every_step_has_its_own_weights() {
    let mut filter = Filter::new(2.0, Hold::First).unwrap();
    for dt in [0.1, 0.1, 0.3, 0.1] {
        assert_eq!(filter.weights(dt), Filter::new(2.0, Hold::First).unwrap().weights(dt));
    }
}

#[test]
fn weights_agree_where_the_series_ends() {
    // Left of a = 1 the slope is a series, right of it the closed form: no jump beyond their own rounding.
    let [left, right] = [1.0_f64, 1.0 + f64::EPSILON].map(|a| step(1.0, Hold::First, 0.0, [0.0, 1.0], a));
    assert!((left - (-1.0_f64).exp()).abs() < 2.0 * f64::EPSILON);
    assert!((left - right).abs() < 4.0 * f64::EPSILON);
}

#[test]
#[expect(clippy::float_cmp, reason = "a filter without bandwidth limit returns its input to the last bit")]
fn infinite_bandwidth_passes_the_signal() {
    assert_eq!(step(f64::INFINITY, Hold::First, 0.5, [0.25, 0.75], 1e-3), 0.75);
    assert_eq!(step(f64::INFINITY, Hold::Zero, 0.5, [0.25, 0.75], 1e-3), 0.25);
    assert_eq!(step(1e300, Hold::First, 0.5, [0.25, 0.75], 1e300), 0.75);
}

#[test]
fn single_precision_settles() {
    // A million steps of alpha dt = 1e-6: a plain f32 sum ends more than 1e-4 away.
    let dt = 1e-6_f32;
    let mut filter = Filter::new(1.0_f32, Hold::First).unwrap();
    let mut filtered = Filtered::new(Vector1::new(0.0_f32));
    let one = Vector1::new(1.0_f32);
    for _ in 0..1_000_000 {
        let weights = filter.weights(dt);
        filtered.advance(&weights, &one, &one);
    }
    let expected = -(-1e6 * f64::from(dt)).exp_m1();
    // Each increment is off by at most 3 roundings of itself, and so is their sum.
    assert!((f64::from(filtered.value().x) - expected).abs() < 3.0 * f64::from(f32::EPSILON));
}

#[test]
fn bandwidth_must_be_positive() {
    for alpha in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        assert_eq!(Filter::new(alpha, Hold::First), Err(Fault::Filter));
    }
}
