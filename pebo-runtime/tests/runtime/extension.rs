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
fn fundamental_is_of_second_order() {
    let exact = |t: f64| Vector2::new(1.0, -1.0) + rotation(3.0 * t) * Vector2::new(-1.0, 1.0) * (-0.5 * t).exp();
    let error = |steps: u32| {
        let mut extension = Fundamental::new(Vector2::zeros());
        advance(&mut extension, &spiral(), steps, 1.0 / f64::from(steps));
        let psi = rotation(3.0) * (-0.5_f64).exp();
        assert!((extension.psi() - psi).norm() < 30.0 / f64::from(steps).powi(2));
        (extension.xi() - exact(1.0)).norm()
    };
    // Halving the step quarters the error; the next term of its expansion is (3 dt)^2 = 0.1 % of it.
    let ratio = error(100) / error(200);
    assert!((ratio - 4.0).abs() < 0.01, "{ratio}");
}

fn rotation(angle: f64) -> Matrix2<f64> {
    Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos())
}

#[test]
fn step_onto_the_pole_is_a_fault() {
    // z' = 2 z with a step of 1 s: I - dt Lambda/2 = 0.
    let unstable = Flow { lambda: Matrix1::new(2.0), h: Vector1::new(1.0) };
    let mut extension = Fundamental::new(Vector1::new(1.0));
    assert_eq!(extension.advance(&unstable, &unstable, 1.0), Err(Fault::Singular));
    // The same behind a row exchange: diag(1, 1) - [[1, 1], [1, 1]] has zeros on its diagonal and is regular; with
    // [[1, 0], [1, 1]] it is singular.
    let regular = flow(Matrix2::new(1.0, 1.0, 1.0, 1.0) * 2.0, Vector2::zeros());
    let mut extension = Fundamental::new(Vector2::zeros());
    extension.advance(&regular, &regular, 1.0).unwrap();
    assert_eq!(*extension.psi(), Matrix2::new(-1.0, -2.0, -2.0, -1.0));
    let singular = flow(Matrix2::new(1.0, 0.0, 1.0, 1.0) * 2.0, Vector2::zeros());
    assert_eq!(extension.advance(&singular, &singular, 1.0), Err(Fault::Singular));
}
