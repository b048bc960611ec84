//! The Cuk converter, case II, with every estimator of the runtime.

use pebo_runtime::nalgebra::{SVector, Vector2};
use pebo_runtime::{
    Bounded, Drem, Drift, Estimator, Excitation, Fault, Filter, FilteredRegression, FiniteTime, Gap, Gradient, Hold,
    Kreisselmeier, LeastSquares, Limits, Monitor, NormalisedGradient, Real, RegressionOperator, Response,
    WindowedRegression,
};

use crate::emitted::cuk_case2::{CukCase2, Parameters};
use crate::report::Report;

/// Seconds between two samples.
pub const DT: f32 = 1e-5;

/// The circuit `i1`, `v2`, `i3`, `v4`, at a duty cycle that moves in steps.
#[derive(Clone, Copy, Debug)]
pub struct Circuit {
    state: [f32; 4],
    steps: u32,
}

impl Circuit {
    /// The paper's start.
    pub fn new() -> Self {
        Self { state: [0.5, 10.0, -1.0, -12.0], steps: 0 }
    }

    /// The measured pair.
    pub fn outputs(&self) -> Vector2<f32> {
        Vector2::new(self.state[1], self.state[2])
    }

    /// The unmeasured pair.
    pub fn unmeasured(&self) -> Vector2<f32> {
        Vector2::new(self.state[0], self.state[3])
    }

    /// The duty cycle of the interval to come: a square wave.
    pub fn duty(&self) -> f32 {
        if self.steps % 512 < 256 { 0.64 } else { 0.6 }
    }

    /// One step of the midpoint rule.
    pub fn advance(&mut self) {
        let d = self.duty();
        let rate = |[i1, v2, i3, v4]: [f32; 4]| {
            [
                (12.0 - (1.0 - d) * v2) / 10e-3,
                ((1.0 - d) * i1 + d * i3) / 22e-6,
                -(d * v2 + v4) / 10e-3,
                (i3 - 0.0447 * v4) / 22.9e-6,
            ]
        };
        let along = |start: [f32; 4], rate: [f32; 4], dt: f32| {
            let [a, b, c, d] = start;
            let [e, f, g, h] = rate;
            [a + e * dt, b + f * dt, c + g * dt, d + h * dt]
        };
        let middle = along(self.state, rate(self.state), DT / 2.0);
        self.state = along(self.state, rate(middle), DT);
        self.steps += 1;
    }
}

impl Default for Circuit {
    fn default() -> Self {
        Self::new()
    }
}

/// The gains that the observer written by hand has too.
pub const GAINS: [f32; 2] = [1.0, 10.0];

/// The filter that the observer written by hand has too.
pub const ALPHA: f32 = 1.0;

type Observer<E, R> = pebo_runtime::Observer<CukCase2, E, 2, 2, 1, 2, 2, 2, R>;

fn model() -> CukCase2 {
    CukCase2::new(&Parameters::default())
}

/// The observer whose steps are counted.
///
/// # Errors
/// None for the gains here.
pub fn counted() -> Result<crate::emitted::cuk_case2::Observer, Fault> {
    let gradient = Gradient::diagonal(&Vector2::from(GAINS))?;
    crate::emitted::cuk_case2::Observer::new(model(), gradient, Filter::new(ALPHA, Hold::First)?, SVector::zeros())
}

/// Runs one estimator for 2000 samples, one of them broken and one missing, and reports its estimates.
fn run<E: Estimator<f32, 2, 2>, R: RegressionOperator<f32, 2, 2>>(
    report: &mut impl Report,
    estimator: E,
    regression: R,
    drift: Option<Drift<f32>>,
) -> Result<(), Fault> {
    let limits = Limits::none().outputs(&Vector2::repeat(-100.0), &Vector2::repeat(100.0))?;
    let mut observer: Observer<E, R> =
        pebo_runtime::Observer::with_regression(model(), estimator, regression, SVector::zeros())?;
    let mut circuit = Circuit::new();
    let mut duty = SVector::from([0.5]);
    let mut gap = Gap::new();
    for k in 0..2000_u32 {
        let y = circuit.outputs();
        gap.add(&duty, DT)?;
        if k == 700 {
            let broken = Vector2::new(y.x, f32::NAN);
            report.flag(observer.step(broken, duty, DT) == Err(Fault::Output { index: 1 }));
            report.flag(limits.check(&broken, &duty, DT) == Err(Fault::OutputRange { index: 1 }));
        } else {
            let (duty, dt) = gap.take();
            let estimate = match drift {
                Some(drift) => observer.step_without_drift(y, duty, dt, drift)?,
                None => observer.step(y, duty, dt)?,
            };
            let estimate = Vector2::from(estimate);
            if k % 400 == 399 {
                report.estimate(&estimate, &circuit.unmeasured());
                // From 8 ms on every observer here has the current to 1 % of its error at the start, 0.5 A.
                let error = estimate.x - circuit.unmeasured().x;
                report.flag(k < 800 || Real::abs(error) < 5e-3);
            }
        }
        duty = SVector::from([circuit.duty()]);
        circuit.advance();
    }
    Ok(())
}

/// Every estimator and form in turn.
///
/// # Errors
/// A fault where none should be.
pub fn all(report: &mut impl Report) -> Result<(), Fault> {
    let filtered = FilteredRegression::new(Filter::new(1e3, Hold::First)?);
    let slow = FilteredRegression::new(Filter::new(ALPHA, Hold::First)?);
    let gradient = Gradient::diagonal(&Vector2::new(5e-6, 0.1))?;
    let squares = LeastSquares::diagonal(&Vector2::new(1e2, 1e6), 100.0)?;
    let memory = Kreisselmeier::new(&Vector2::new(2e-3, 40.0), 200.0)?;
    let speed = Vector2::repeat(1e5);
    report.name("paper");
    run(report, Gradient::diagonal(&Vector2::from(GAINS))?, slow, None)?;
    report.name("gradient");
    run(report, gradient, filtered, None)?;
    report.name("normalised");
    run(report, NormalisedGradient::new(gradient, 1e-9)?, filtered, None)?;
    report.name("squares");
    run(report, squares, filtered, None)?;
    report.name("squares-window");
    run(report, squares, WindowedRegression::<f32, 2, 2, 32>::new(Hold::First), None)?;
    report.name("squares-free");
    run(report, squares, filtered, Some(Drift::Free))?;
    report.name("squares-leak");
    run(report, squares, filtered, Some(Drift::Leak(10.0)))?;
    report.name("kreisselmeier");
    run(report, Drem::new(memory, &speed)?, filtered, None)?;
    report.name("squares-drem");
    run(report, Drem::new(Response::<f32, _, 2, 2>::new(squares)?, &speed)?, filtered, None)?;
    report.name("gradient-drem");
    run(report, Drem::new(Response::<f32, _, 2, 2>::new(gradient)?, &speed)?, filtered, None)?;
    report.name("finite-time");
    run(report, FiniteTime::once(Drem::new(memory, &speed)?, 0.1)?, filtered, None)?;
    report.name("tracking");
    run(report, FiniteTime::tracking(Drem::new(memory, &speed)?, 0.1, 5e-3)?, filtered, None)?;
    report.name("bounded");
    run(report, Bounded::new(squares, &Vector2::repeat(-50.0), &Vector2::repeat(50.0))?, filtered, None)?;
    monitor(report)
}

/// The excitation of the regressor at rest.
fn monitor(report: &mut impl Report) -> Result<(), Fault> {
    report.name("monitor");
    let mut monitor = Monitor::of_white(&Vector2::new(1e-3, 1e-2), &Vector2::new(1e-3, 1e-3), 10.0)?;
    let mut duty = 0.6;
    for _ in 0..200_u32 {
        let regressor = pebo_runtime::nalgebra::Matrix2::new((1.0 - duty) / 22e-6, 0.0, 0.0, -100.0);
        monitor.advance(&regressor, DT)?;
        duty = 1.24 - duty;
    }
    report.flag(monitor.excitation() == Excitation::Converged);
    let error = monitor.standard_error().unwrap_or(SVector::zeros());
    report.estimate(&error, &SVector::zeros());
    Ok(())
}
