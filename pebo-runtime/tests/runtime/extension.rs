//! The dynamic extensions against exact solutions of their flow.

use pebo_runtime::nalgebra::{Matrix1, Matrix2, Vector1, Vector2};
use pebo_runtime::{Extension, Fault, Flow, Fundamental, Integrator};
use proptest::prelude::*;

use crate::random::{decades, matrix, vector};

fn flow(lambda: Matrix2<f64>, h: Vector2<f64>) -> Flow<f64, 2> {
    Flow { lambda, h }
}

/// `z' = Lambda z + h` with a turning and decaying `Lambda`, at rest at `z = (1, -1)`.
fn spiral() -> Flow<f64, 2> {
    let lambda = Matrix2::new(-0.5, -3.0, 3.0, -0.5);
    flow(lambda, -(lambda * Vector2::new(1.0, -1.0)))
}

fn advance<X: Extension<f64, 2>>(extension: &mut X, flow: &Flow<f64, 2>, steps: u32, dt: f64) {
    for _ in 0..steps {
        extension.advance(flow, flow, dt).unwrap();
    }
}

proptest! {
    #[test]
    fn integrator_is_exact_for_a_straight_h(
        start in vector::<2>(-1.0..1.0), h in vector::<2>(-1.0..1.0), slope in vector::<2>(-1.0..1.0), dt in decades(-6, 2),
    ) {
        let zero = Matrix2::zeros();
        let mut extension = Integrator::new(start);
        extension.advance(&flow(zero, h), &flow(zero, h + slope * dt), dt).unwrap();
        let exact = start + h * dt + slope * (dt * dt / 2.0);
        // A few roundings of terms up to 1 + dt + dt^2.
        let tolerance = 8.0 * f64::EPSILON * (1.0 + dt + dt * dt);
        prop_assert!((extension.chi() - exact).norm() <= tolerance);
    }

    #[test]
    fn fundamental_without_lambda_is_the_integrator(
        start in vector::<2>(-1.0..1.0), h in vector::<2>(-1.0..1.0), end in vector::<2>(-1.0..1.0), dt in decades(-6, 2),
    ) {
        let (before, after) = (flow(Matrix2::zeros(), h), flow(Matrix2::zeros(), end));
        let (mut integrator, mut fundamental) = (Integrator::new(start), Fundamental::new(start));
        integrator.advance(&before, &after, dt).unwrap();
        fundamental.advance(&before, &after, dt).unwrap();
        // dt/4 * 2 in the one, dt/2 in the other: the same number.
        prop_assert_eq!(fundamental.xi(), integrator.chi());
        prop_assert_eq!(*fundamental.psi(), Matrix2::identity());
    }

    #[test]
    fn stable_flow_stays_bounded_at_any_step(turn in matrix::<2, 2>(-1.0..1.0), decay in decades(-3, 9), dt in decades(-9, 9)) {
        // Lambda + Lambda^T = -2 decay I: |Psi| may not grow.
        let skew = turn - turn.transpose();
        let stable = flow(skew - Matrix2::identity() * decay, Vector2::zeros());
        let mut extension = Fundamental::new(Vector2::new(3.0, -4.0));
        advance(&mut extension, &stable, 3, dt);
        // Three solutions of a 2 by 2 system that is within a factor 2 of a multiple of the identity.
        prop_assert!(extension.psi().norm() <= 2.0_f64.sqrt() * (1.0 + 1e-13));
        prop_assert!(extension.xi().norm() <= 5.0 * (1.0 + 1e-13));
    }

    #[test]
    fn every_solution_is_the_extension_at_some_theta(
        lambda in matrix::<2, 2>(-2.0..2.0), h in vector::<2>(-1.0..1.0), end in vector::<2>(-1.0..1.0),
        start in vector::<2>(-1.0..1.0), theta in vector::<2>(-1.0..1.0),
    ) {
        // Started at start + theta, or at start and evaluated at theta: the same z.
        let (before, after) = (flow(lambda, h), flow(lambda * 0.5, end));
        let (mut whole, mut parts) = (Fundamental::new(start + theta), Fundamental::new(start));
        let mut moved = parts;
        moved.rebase(&theta);
        for extension in [&mut whole, &mut parts, &mut moved] {
            for _ in 0..10 {
                extension.advance(&before, &after, 0.1).unwrap();
            }
        }
        let z = whole.coordinates(&Vector2::zeros());
        // |Psi| < e^4 = 55 after 1 s: a hundred roundings of numbers up to that.
        prop_assert!((parts.coordinates(&theta) - z).norm() < 1e-12);
        prop_assert!((moved.coordinates(&(theta + theta)) - z).norm() < 1e-12);
    }
}

#[test]
fn constant_flow_is_exact() {
    // A whole turn and more in one step, and what is left after a step of fifty time constants.
    for steps in [1, 3, 10, 100] {
        let mut extension = Fundamental::new(Vector2::zeros());
        advance(&mut extension, &spiral(), steps, 1.0 / f64::from(steps));
        let psi = rotation(3.0) * (-0.5_f64).exp();
        // |q|^10/3628800 a step, with |q| <= 1 after halving, of numbers up to 2.
        let size = (3.04 / f64::from(steps)).min(1.0);
        let tolerance = 2.0 * f64::from(steps) * size.powi(10) / 3_628_800.0 + 1e-14;
        assert!((extension.psi() - psi).norm() < tolerance, "{steps}");
        assert!((extension.xi() - exact(1.0)).norm() < tolerance, "{steps}");
    }
    let mut stiff = Fundamental::new(Vector1::new(1.0));
    let flow = Flow { lambda: Matrix1::new(-50.0), h: Vector1::new(100.0) };
    stiff.advance(&flow, &flow, 1.0).unwrap();
    // e^-50 keeps its sign and its first digits: 1e-5 of the rate, fifty of it.
    assert!((stiff.psi().x / (-50.0_f64).exp() - 1.0).abs() < 5e-4, "{}", stiff.psi().x);
    assert!((stiff.xi().x - 2.0).abs() < 1e-14);
}

#[test]
fn starting_anew_is_an_advance_and_its_turn() {
    // From steps whose third power is below rounding to ones that are halved, in units that differ by 1000.
    for step in [1e-6, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0] {
        let lambda = Matrix2::new(-0.3, 2000.0, -0.002, 0.1) * step;
        let flow = flow(lambda, Vector2::new(0.5, -0.001));
        let start = Vector2::new(1.0, 0.003);
        let [mut plain, mut anew] = [Fundamental::new(start); 2];
        plain.advance(&flow, &flow, 1.0).unwrap();
        let turn = plain.take_turn().unwrap().unwrap();
        let mut followed = None;
        anew.advance_anew(&flow, &flow, 1.0, |turn| followed = Some(*turn)).unwrap();
        assert_eq!(anew, plain, "{step}");
        // A factor of the unknown has gone by the inverse, to some roundings of what it gains; the series of the map and of
        // its inverse err by |q|^10/3628800 each, |q| = 2 for a step of 1, in three entries of this size.
        let tolerance = 2e-15 * step + 6.0 * (2.0 * step).min(1.0).powi(10) / 3_628_800.0;
        let factor = Matrix2::new(1.0, 1000.0, 0.001, 1.0);
        let difference = turn.of_factor(&factor) - followed.unwrap().of_factor(&factor);
        let scaled = difference.component_div(&factor).norm();
        assert!(scaled <= tolerance, "{step}: {scaled:e} of {tolerance:e}");
    }
}

#[test]
fn long_steps_are_halved_where_their_powers_overflow() {
    let flow = Flow { lambda: Matrix1::new(-1e10_f32), h: Vector1::new(2e10) };
    let mut extension = Fundamental::new(Vector1::new(1.0));
    extension.advance(&flow, &flow, 1.0).unwrap();
    // Rest, to the rounding of the sum over the halved steps.
    assert!((extension.xi().x - 2.0).abs() < 1e-4, "{}", extension.xi().x);
    assert!(extension.psi().x.abs() < f32::MIN_POSITIVE);
}

/// The spiral from 0.
fn exact(t: f64) -> Vector2<f64> {
    Vector2::new(1.0, -1.0) + rotation(3.0 * t) * Vector2::new(-1.0, 1.0) * (-0.5 * t).exp()
}

#[test]
fn varying_flow_is_of_second_order() {
    // z' = -2 t z + 1 from 1, to t = 1: Psi = e^-1.
    let error = |steps: u32| {
        let dt = 1.0 / f64::from(steps);
        let at = |k: u32| Flow { lambda: Matrix1::new(-2.0 * dt * f64::from(k)), h: Vector1::new(1.0) };
        let mut extension = Fundamental::new(Vector1::new(1.0));
        (0..steps).for_each(|k| extension.advance(&at(k), &at(k + 1), dt).unwrap());
        // The rate is straight, so its mean is its integral.
        assert!((extension.psi().x - (-1.0_f64).exp()).abs() < 1e-10);
        // Dawson's function of 1, and the start.
        extension.xi().x - (0.538_079_506_912_768_4 + (-1.0_f64).exp())
    };
    // Halving the step quarters the error; the next term of its expansion is dt^2 of it.
    let ratio = error(100) / error(200);
    assert!((ratio - 4.0).abs() < 0.01, "{ratio}");
}

fn rotation(angle: f64) -> Matrix2<f64> {
    Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos())
}

#[test]
fn units_of_lambda_do_not_matter() {
    // A coordinate in units 1e9 times smaller than the other, in single precision.
    let unit = 1e9_f32;
    let flow = Flow { lambda: Matrix2::new(-1.0, unit, -1.0 / unit, -1.0), h: Vector2::zeros() };
    let mut extension = Fundamental::new(Vector2::new(unit, 0.0));
    (0..100).for_each(|_| extension.advance(&flow, &flow, 0.01).unwrap());
    let expected = Vector2::new(1.0_f32.cos(), -1.0_f32.sin()) * (-1.0_f32).exp();
    // A hundred steps with some roundings each.
    let found = Vector2::new(extension.xi().x / unit, extension.xi().y);
    assert!((found - expected).norm() < 1e-5, "{found}");
}

#[test]
fn step_beyond_all_bounds_is_a_fault() {
    let unstable = Flow { lambda: Matrix1::new(2.0), h: Vector1::new(1.0) };
    let mut extension = Fundamental::new(Vector1::new(1.0));
    assert_eq!(extension.advance(&unstable, &unstable, 1e30), Err(Fault::Singular));
    // A matrix that has died out has no inverse to re-base by.
    let stable = Flow { lambda: Matrix2::new(-1.0, 0.0, 0.0, -800.0), h: Vector2::zeros() };
    let mut extension = Fundamental::new(Vector2::new(1.0, 1.0));
    extension.advance(&stable, &stable, 1.0).unwrap();
    assert_eq!(extension.take_turn(), Err(Fault::Singular));
    let mut extension = Fundamental::new(Vector2::new(1.0, 1.0));
    assert_eq!(extension.advance_anew(&stable, &stable, 1.0, |_| ()), Err(Fault::Singular));
}
