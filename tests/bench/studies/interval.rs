//! Interval excitation: the regressor (1, sin 2t, cos t) for 3 s and zero after, theta = (1, -2, 0.5). Prints the time
//! to 1 % of each estimator.
//!
//! Run with `cargo run --release -p tests --example interval`.

use pebo_runtime::nalgebra::{Matrix1x3, Vector3};
use pebo_runtime::{
    Drem, Estimator, Fault, FiniteTime, Gradient, Kreisselmeier, LeastSquares, NormalisedGradient, Response,
};

/// The time after which the error stays below 1 % of its start, if it does so within 60 s.
fn settles(mut estimator: impl Estimator<f64, 1, 3>) -> Result<Option<f64>, Fault> {
    let (truth, dt) = (Vector3::new(1.0, -2.0, 0.5), 1e-3);
    let mut settled = 0.0;
    for k in 1..=60_000_u32 {
        let t = f64::from(k) * dt;
        let phi = if t < 3.0 { Matrix1x3::new(1.0, (2.0 * t).sin(), t.cos()) } else { Matrix1x3::zeros() };
        estimator.advance(&phi, &(phi * truth), dt)?;
        if (estimator.estimate() - truth).norm() > 0.01 * truth.norm() {
            settled = t + dt;
        }
    }
    Ok((settled < 60.0).then_some(settled))
}

fn main() -> Result<(), Fault> {
    let ones = Vector3::repeat(1.0);
    let gradient = |gain: f64| Gradient::diagonal(&(ones * gain));
    let squares = |variance: f64, beta| LeastSquares::diagonal(&(ones * variance), beta);
    let memory = |gain: f64, rate| Kreisselmeier::new(&(ones * gain), rate);
    let response = Response::<f64, _, 1, 3>::new;
    let show = |name: &str, time: Option<f64>| {
        println!("{name:64} {}", time.map_or("never".to_owned(), |time| format!("{time:.3} s")));
    };
    show("gradient, gain 10", settles(gradient(10.0)?)?);
    show("normalised gradient, gain 10, mu 1", settles(NormalisedGradient::new(gradient(10.0)?, 1.0)?)?);
    show("least squares, variance 1e2", settles(squares(1e2, 0.0)?)?);
    show("least squares, variance 1e6", settles(squares(1e6, 0.0)?)?);
    show("least squares, variance 1e6, beta 1", settles(squares(1e6, 1.0)?)?);
    for gain in [1e4, 1e6] {
        let gains = ones * gain;
        println!("with scalar gains of {gain:.0e}/s:");
        show("  Kreisselmeier DREM, gain 10, l 0", settles(Drem::new(memory(10.0, 0.0)?, &gains)?)?);
        show("  Kreisselmeier DREM, gain 10, l 1", settles(Drem::new(memory(10.0, 1.0)?, &gains)?)?);
        show("  gradient + DREM, gain 10", settles(Drem::new(response(gradient(10.0)?)?, &gains)?)?);
        let finite = Drem::new(memory(10.0, 0.0)?, &gains)?;
        show("  finite time once, Kreisselmeier gain 10, clip 0.1", settles(FiniteTime::once(finite, 0.1)?)?);
        show("  finite time tracking, the same, 0.5 s", settles(FiniteTime::tracking(finite, 0.1, 0.5)?)?);
        let drem = Drem::new(Response::<f64, _, 1, 3>::new(squares(1e2, 0.0)?)?, &gains)?;
        show("  least squares + DREM, variance 1e2", settles(drem)?);
    }
    Ok(())
}
