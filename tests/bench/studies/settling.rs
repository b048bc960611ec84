//! Settling of every estimator on one run of the Cuk converter, case II: prints the table.
//!
//! Run with `cargo run --release -p tests --example settling`.
//!
//! Plant under the full-state controller of the paper for 0.6 s, so that all observers see the same data. Every sample
//! of both outputs is multiplied by 1 + noise times a normal number. Settling: the time after which the error of a
//! component of `z` stays below 1 % of its start. That of `x` differs by the noise of the sample that the left inverse
//! takes, which no estimator can help; it is in the error at 10 ms.

mod converter;
#[path = "../../../pebo-runtime/tests/runtime/noise.rs"]
mod noise;

use converter::{C2, C4, Converter, E, G, L1, L3};
use noise::Noise;
use pebo_runtime::nalgebra::{SVector, Vector2};
use pebo_runtime::{
    Drem, Estimator, Fault, Filter, FiniteTime, Gradient, Hold, Kreisselmeier, LeastSquares, NormalisedGradient,
    Response, WindowedRegression,
};
use tests::emitted::cuk_case2_f64::{CukCase2, Observer, Parameters, U};

const DURATION: f64 = 0.6;

/// An observer behind one face: a sample in, the estimate of the state out.
type Step = Box<dyn FnMut(&Vector2<f64>, f64, f64) -> Result<Vector2<f64>, Fault>>;

fn model() -> CukCase2 {
    CukCase2::new(&Parameters::default())
}

/// An observer with a filter of bandwidth `alpha`.
fn filtered<T: Estimator<f64, 2, 2> + 'static>(alpha: f64, estimator: T) -> Result<Step, Fault> {
    let filter = Filter::new(alpha, Hold::First)?;
    let mut observer: Observer<T> = Observer::new(model(), estimator, filter, SVector::zeros())?;
    Ok(Box::new(move |y, d, dt| observer.step(*y, U { d }, dt).map(Into::into)))
}

/// An observer with the integral form over `NW` samples.
fn windowed<T: Estimator<f64, 2, 2> + 'static, const NW: usize>(estimator: T) -> Result<Step, Fault> {
    let window = WindowedRegression::<f64, 2, 2, NW>::new(Hold::First);
    let mut observer = pebo_runtime::Observer::with_regression(model(), estimator, window, SVector::zeros())?;
    Ok(Box::new(move |y, d, dt| observer.step(*y, U { d }, dt).map(Into::into)))
}

/// The immersion and invariance observer of the paper with the sign of `gamma_2` that its own dynamics need;
/// trapezoidal rule.
fn immersion([gamma_1, gamma_2]: [f64; 2]) -> Step {
    let mut before: Option<(Vector2<f64>, Vector2<f64>)> = None;
    Box::new(move |y, d, dt| {
        let offset = |y: &Vector2<f64>| Vector2::new(C2 * gamma_1 * y.x, -L3 * gamma_2 * y.y);
        // zeta' = known(y) - decay zeta
        let known = |y: &Vector2<f64>| {
            let at = offset(y);
            Vector2::new(
                (E - (1.0 - d) * y.x) / L1 - gamma_1 * ((1.0 - d) * at.x + d * y.y),
                (y.y - G * at.y) / C4 - gamma_2 * (d * y.x + at.y),
            )
        };
        let decay = Vector2::new(gamma_1 * (1.0 - d), G / C4 + gamma_2);
        let zeta = match before {
            // Both estimates start at 0.
            None => -offset(y),
            Some((last, zeta)) => {
                let half = decay * (dt / 2.0);
                let numerator = zeta - zeta.component_mul(&half) + (known(&last) + known(y)) * (dt / 2.0);
                numerator.component_div(&half.add_scalar(1.0))
            }
        };
        before = Some((*y, zeta));
        Ok(zeta + offset(y))
    })
}

/// Name and settings of every observer, and itself.
fn baselines() -> Result<Vec<(&'static str, Step)>, Fault> {
    let gains = Vector2::new(5e-6, 0.1);
    let weak = Vector2::new(1e6, 1e10);
    let speed = Vector2::new(1e5, 1e5);
    let gradient = Gradient::diagonal(&gains)?;
    let squares = |beta| LeastSquares::diagonal(&weak, beta);
    let memory = |rate| Kreisselmeier::new(&Vector2::new(2e-3, 40.0), rate);
    Ok(vec![
        ("paper, alpha 1, Gamma (0.01, 0.1)", filtered(1.0, Gradient::diagonal(&Vector2::new(0.01, 0.1))?)?),
        ("paper, alpha 1, Gamma (1, 10)", filtered(1.0, Gradient::diagonal(&Vector2::new(1.0, 10.0))?)?),
        ("I&I, gamma (25, 1)", immersion([25.0, 1.0])),
        ("gradient, alpha 1e3", filtered(1e3, gradient)?),
        ("normalised gradient, mu 1e-9", filtered(1e3, NormalisedGradient::new(gradient, 1e-9)?)?),
        ("least squares, beta 0", filtered(1e3, squares(0.0)?)?),
        ("least squares, beta 100", filtered(1e3, squares(100.0)?)?),
        ("least squares, window of 100, beta 100", windowed::<_, 100>(squares(100.0)?)?),
        ("Kreisselmeier DREM, l 200", filtered(1e3, Drem::new(memory(200.0)?, &speed)?)?),
        ("gradient + DREM", filtered(1e3, Drem::new(Response::<_, _, 2, 2>::new(gradient)?, &speed)?)?),
        (
            "least squares + DREM, beta 0",
            filtered(1e3, Drem::new(Response::<_, _, 2, 2>::new(squares(0.0)?)?, &speed)?)?,
        ),
        ("finite time once, clip 0.1", filtered(1e3, FiniteTime::once(Drem::new(memory(0.0)?, &speed)?, 0.1)?)?),
        (
            "finite time tracking, clip 0.1, 5 ms",
            filtered(1e3, FiniteTime::tracking(Drem::new(memory(200.0)?, &speed)?, 0.1, 5e-3)?)?,
        ),
    ])
}

/// The row of one observer.
#[derive(Clone, Copy)]
struct Row {
    settled: Vector2<f64>,
    at_10_ms: Vector2<f64>,
}

fn run(noise: f64, dt: f64) -> Result<Vec<(&'static str, Row)>, Fault> {
    let mut baselines = baselines()?;
    let mut rows: Vec<Row> =
        baselines.iter().map(|_| Row { settled: Vector2::zeros(), at_10_ms: Vector2::zeros() }).collect();
    let mut random = Noise::new(1);
    let mut plant = Converter::new();
    let initial = plant.transform();
    let (mut d, mut t, mut steps) = (0.5, 0.0, 0_u32);
    while t < DURATION {
        let y = plant.outputs().map(|y| y * (1.0 + noise * random.normal()));
        let (z, x) = (plant.transform(), plant.unmeasured());
        for ((_, step), row) in baselines.iter_mut().zip(&mut rows) {
            let estimate = step(&y, d, dt)?;
            let error = estimate - Vector2::new(0.0, L3 * G / C4 * y.y) - z;
            for (settled, share) in row.settled.iter_mut().zip(error.component_div(&initial).iter()) {
                if share.abs() >= 0.01 {
                    *settled = t + dt;
                }
            }
            if (t - 0.01).abs() < dt / 2.0 {
                row.at_10_ms = (estimate - x).abs();
            }
        }
        d = plant.duty(t);
        plant.advance(d, dt);
        steps += 1;
        t = f64::from(steps) * dt;
    }
    Ok(baselines.iter().map(|(name, _)| *name).zip(rows).collect())
}

fn main() -> Result<(), Fault> {
    for dt in [1e-6, 1e-5] {
        for noise in [0.0, 1e-3, 1e-2] {
            println!("\nsampling {} us, noise {} %", dt * 1e6, noise * 100.0);
            println!("{:42} {:>10} {:>10} {:>11} {:>11}", "", "z1 settles", "z2 settles", "i1 at 10 ms", "v4 at 10 ms");
            for (name, row) in run(noise, dt)? {
                let time = |t: f64| {
                    if t > DURATION - 1e-3 { "-".to_owned() } else { format!("{:.3} ms", t * 1e3) }
                };
                let Row { settled, at_10_ms } = row;
                println!(
                    "{name:42} {:>10} {:>10} {:>9.2e} A {:>9.2e} V",
                    time(settled.x),
                    time(settled.y),
                    at_10_ms.x,
                    at_10_ms.y
                );
            }
        }
    }
    Ok(())
}
