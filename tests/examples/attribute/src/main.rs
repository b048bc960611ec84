//! The momentum of a pendulum from its angle: the plant in plain Rust, the observer from the attribute.

use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Fault, Filter, Gradient, Hold};

#[pebo_macros::pebo_model(assume(M > 0, L > 0))]
mod pendulum {
    const M: f64 = 1.0;
    const L: f64 = 0.5;
    const G: f64 = 9.81;

    /// Momentum, not measured.
    #[derive(Clone, Copy)]
    pub(crate) struct X {
        pub(crate) p: f64,
    }
    /// Angle, measured.
    #[derive(Clone, Copy)]
    pub(crate) struct Y {
        pub(crate) q: f64,
    }
    /// Torque.
    #[derive(Clone, Copy)]
    pub(crate) struct U {
        pub(crate) tau: f64,
    }

    pub(crate) fn f_x(y: Y, u: U) -> X {
        X { p: u.tau - M * G * L * y.q.sin() }
    }
    pub(crate) fn f_y(x: X) -> Y {
        Y { q: x.p / (M * L.powi(2)) }
    }
    pub(crate) fn phi(x: X) -> [f64; 1] {
        [x.p]
    }
}

/// The error of the estimate after ten seconds of swinging.
fn error() -> Result<f64, Fault> {
    use pendulum::{U, X, Y};

    let mut observer = pendulum::Observer::new(
        pendulum::Pendulum::new(&pendulum::Parameters::default()),
        Gradient::diagonal(&SVector::from([10.0]))?,
        Filter::new(5.0, Hold::First)?,
        SVector::zeros(),
    )?;
    let (mut x, mut y, u) = (X { p: 0.3 }, Y { q: 1.0 }, U { tau: 0.0 });
    let dt = 1e-3;
    let mut estimate = 0.0;
    for _ in 0..10_000 {
        // The same functions are the simulated plant.
        x.p += dt * pendulum::f_x(y, u).p;
        y.q += dt * pendulum::f_y(x).q;
        estimate = observer.step(y, u, dt)?.p;
    }
    Ok(estimate - x.p)
}

fn main() -> Result<(), Fault> {
    println!("error after ten seconds: {:.1e} kg m^2/s", error()?);
    Ok(())
}

#[test]
fn the_estimate_converges() {
    assert!(error().is_ok_and(|error| error.abs() < 1e-2));
}
