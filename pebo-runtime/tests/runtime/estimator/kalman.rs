//! With process noise, known sensors and re-basing at each sample, least squares is a Kalman filter: held to one that
//! keeps its covariance in the open and propagates by a series of its own.

use pebo_runtime::nalgebra::{Matrix2, Matrix2x4, Matrix4, SMatrix, SVector, Vector1, Vector2, Vector3, Vector4};
use pebo_runtime::{
    Fault, Flow, Fundamental, LeastSquares, Model, Observer, OutputForm, OutputSlopes, Rebase, Regression,
    RegressionOperator, SampledRegression, Sides, Within,
};

use crate::converter::{Case, CaseOne, Loop};
use crate::noise::Noise;
use crate::observer::rebasing::Pair;

/// The continuous-discrete Kalman filter of `z' = Lambda z + h + noise`, `y = C z + noise`.
struct Kalman<const N: usize, const M: usize> {
    z: SVector<f64, N>,
    p: SMatrix<f64, N, N>,
    output: SMatrix<f64, M, N>,
    /// Variance of each sensor's samples.
    sensor: SVector<f64, M>,
    /// Intensity of the process noise.
    process: SVector<f64, N>,
}

impl<const N: usize, const M: usize> Kalman<N, M> {
    /// Takes a sample; the normalised square of its innovation.
    fn step(&mut self, lambda: &SMatrix<f64, N, N>, h: &SVector<f64, N>, y: &SVector<f64, M>, dt: f64) -> f64 {
        // Taylor's series of e^(Lambda dt) and of its integral, to the last bit.
        let (mut power, mut psi, mut integral) = (SMatrix::identity(), SMatrix::identity(), SMatrix::identity());
        for k in 1..30_u32 {
            power = power * lambda * (dt / f64::from(k));
            psi += power;
            integral += power / f64::from(k + 1);
        }
        self.z = psi * self.z + integral * h * dt;
        self.p = psi * self.p * psi.transpose() + SMatrix::from_diagonal(&(self.process * dt));
        self.correct(y, 0)
    }

    /// Takes the sensors from this one on, one after the other in Joseph's form.
    fn correct(&mut self, y: &SVector<f64, M>, from: usize) -> f64 {
        let mut square = 0.0;
        for i in from..M {
            let row = self.output.row(i).into_owned();
            let variance = (row * self.p * row.transpose()).x + self.sensor[i];
            let gain = self.p * row.transpose() / variance;
            let innovation = y[i] - (row * self.z).x;
            square += innovation * innovation / variance;
            self.z += gain * innovation;
            let left = SMatrix::<f64, N, N>::identity() - gain * row;
            self.p = left * self.p * left.transpose() + gain * self.sensor[i] * gain.transpose();
        }
        square
    }
}

/// The Cuk converter with all of its states for z = (v2, v4, i1, i3): affine, and free of measured outputs.
#[derive(Clone, Debug)]
struct Whole;

const L: f64 = 10e-3;
const C2: f64 = 22e-6;
const C4: f64 = 22.9e-6;
const G: f64 = 0.0447;
const E: f64 = 12.0;

impl Model<4, 2, 1, 4, 2, 4> for Whole {
    type Scalar = f64;
    type Extension = Fundamental<f64, 4>;
    type X = SVector<Self::Scalar, 4>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<f64>;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Vector2<f64>) -> Vector2<f64> {
        *y
    }
    fn flow(&self, _: &Vector2<f64>, u: &Vector1<f64>) -> Flow<f64, 4> {
        let d = u.x;
        #[rustfmt::skip]
        let lambda = Matrix4::new(
            0.0, 0.0, (1.0 - d) / C2, d / C2,
            0.0, -G / C4, 0.0, 1.0 / C4,
            -(1.0 - d) / L, 0.0, 0.0, 0.0,
            -d / L, -1.0 / L, 0.0, 0.0,
        );
        Flow { lambda, h: Vector4::new(0.0, 0.0, E / L, 0.0) }
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<f64>, _: &Vector1<f64>) -> Sides<f64, 2, 4> {
        let seen = Matrix2x4::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
        Sides { known: y - seen * extension.xi(), factor: seen * extension.psi() }
    }
    fn theta(&self, eta: &Vector4<f64>) -> Vector4<f64> {
        *eta
    }
    fn recover(&self, z: &Vector4<f64>, _: &Vector2<f64>) -> Vector4<f64> {
        *z
    }
}

impl Rebase<4, 2, 1, 4, 2> for Whole {}

#[test]
fn a_plant_free_of_its_outputs_is_the_kalman_filter() -> Result<(), Fault> {
    let (dt, sigma) = (1e-5, 0.1);
    let start = Vector4::new(10.0, -12.0, 0.0, 0.0);
    let (prior, process) = (Vector4::new(1.0, 1.0, 4.0, 4.0), Vector4::new(0.0, 0.0, 1.0, 1.0));
    let squares = LeastSquares::diagonal(&prior, 0.0)?.with_process_noise(&process)?;
    let sampled = SampledRegression::new(&Vector2::repeat(sigma))?;
    let mut observer = Observer::with_regression(Whole, squares, sampled, start)?.rebasing(1)?;
    let mut kalman = Kalman {
        z: start,
        p: Matrix4::from_diagonal(&prior),
        output: Matrix2x4::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        sensor: Vector2::repeat(sigma * sigma),
        process,
    };
    let mut noise = Noise::new(5);
    let mut closed = Loop::<f64, CaseOne<f64>>::new(1.0, [1.0, 10.0], dt)?;
    observer.step(closed.outputs(), Vector1::zeros(), dt)?;
    kalman.correct(&closed.outputs(), 0);
    let (mut largest, mut squared) = (0.0_f64, 0.0);
    for k in 1..=20_000_u32 {
        let u = Vector1::new(closed.duty());
        closed.advance()?;
        let y = closed.outputs() + Vector2::new(noise.normal(), noise.normal()) * sigma;
        let estimate = observer.step(y, u, dt)?;
        let Flow { lambda, h } = Whole.flow(&y, &u);
        kalman.step(&lambda, &h, &y, dt);
        largest = largest.max((estimate - kalman.z).abs().max());
        if k > 2000 {
            squared += (estimate.z - closed.circuit.x).powi(2) / 18_000.0;
        }
    }
    println!("largest distance {largest:e}, rms of i1 {:e}", squared.sqrt());
    // Rounding of volts up to 60 in 20000 steps, of which the filter forgets all but the last hundreds.
    assert!(largest < 1e-10, "{largest:e}");
    Ok(())
}

/// `y' = -(1/2 + u/10) y + z1`, `z1' = -2/5 z1 + 3 z2 + u - 2 y`, `z2' = -3 z1 + z2/5 - y`: an output drives both.
#[derive(Clone, Debug)]
struct Driven;

/// `Lambda` of both models of the test by z.
const TURNING: Matrix2<f64> = Matrix2::new(-0.4, 3.0, -3.0, 0.2);

impl Model<2, 1, 1, 2, 1, 2> for Driven {
    type Scalar = f64;
    type Extension = Fundamental<f64, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, y: &Vector1<f64>, u: &Vector1<f64>) -> Flow<f64, 2> {
        Flow { lambda: TURNING, h: Vector2::new(u.x - 2.0 * y.x, -y.x) }
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector1<f64>, u: &Vector1<f64>) -> Sides<f64, 1, 2> {
        let seen = SMatrix::<f64, 1, 2>::new(1.0, 0.0);
        let known = self.output_slopes(y, u, &Vector2::zeros()).rates * y + seen * extension.xi();
        Sides { known, factor: seen * extension.psi() }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector1<f64>) -> Sides<f64, 1, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn output_slopes(&self, _: &Vector1<f64>, u: &Vector1<f64>, _: &Vector2<f64>) -> OutputSlopes<f64, 1, 2> {
        OutputSlopes { rates: SMatrix::from([[-0.5 - 0.1 * u.x]]), cascade: Vector2::new(-2.0, -1.0) }
    }
    fn theta(&self, eta: &Vector2<f64>) -> Vector2<f64> {
        *eta
    }
    fn recover(&self, z: &Vector2<f64>, _: &Vector1<f64>) -> Vector2<f64> {
        *z
    }
}

impl Rebase<2, 1, 1, 2, 1> for Driven {}

#[test]
fn the_output_form_of_a_plant_free_of_its_outputs_is_too() -> Result<(), Fault> {
    let [a, b, c, d] = [TURNING.m11, TURNING.m12, TURNING.m21, TURNING.m22];
    let whole = SMatrix::<f64, 3, 3>::new(0.0, 1.0, 1.0, 0.0, a, b, 0.0, c, d);
    is_the_kalman_filter(Pair::<f64>::new([a, b, c, d]), |_| whole)
}

#[test]
fn with_slopes_the_output_form_of_a_plant_that_its_output_drives_is_too() -> Result<(), Fault> {
    let [a, b, c, d] = [TURNING.m11, TURNING.m12, TURNING.m21, TURNING.m22];
    is_the_kalman_filter(Driven, |u| SMatrix::<f64, 3, 3>::new(-0.5 - 0.1 * u, 1.0, 0.0, -2.0, a, b, -1.0, c, d))
}

/// Compares the output form of a model with the Kalman filter of the plant with this matrix for an input, which drives
/// the first of the coordinates.
fn is_the_kalman_filter<M>(model: M, whole: impl Fn(f64) -> SMatrix<f64, 3, 3>) -> Result<(), Fault>
where
    M: Rebase<2, 1, 1, 2, 1>
        + Model<2, 1, 1, 2, 1, 2, Scalar = f64, X = Vector2<f64>, Y = Vector1<f64>, U = Vector1<f64>>,
{
    let (dt, sigma) = (1e-2, 0.05);
    let (prior, process) = (Vector3::new(2.0, 4.0, 4.0), Vector3::new(0.0, 0.1, 0.3));
    let squares = LeastSquares::diagonal(&prior, 0.0)?.with_process_noise(&process)?;
    let sampled = SampledRegression::new(&Vector1::new(sigma))?;
    let model = OutputForm::<_, _, 1, 2>::new(model);
    let mut observer = Observer::with_regression(model, squares, sampled, Vector3::zeros())?.rebasing(1)?;
    let mut kalman = Kalman {
        // The first sample is where the observer begins.
        z: Vector3::new(0.3, 0.0, 0.0),
        p: SMatrix::from_diagonal(&prior),
        output: SMatrix::<f64, 1, 3>::new(1.0, 0.0, 0.0),
        sensor: Vector1::new(sigma * sigma),
        process,
    };
    let mut noise = Noise::new(6);
    observer.step(Vector1::new(0.3), Vector1::zeros(), dt)?;
    let mut largest = 0.0_f64;
    for k in 1..=10_000_u32 {
        let t = f64::from(k) * dt;
        let (y, u) = (Vector1::new((3.0 * t).sin() + sigma * noise.normal()), Vector1::new((0.2 * t).cos()));
        let innovation = observer.innovation(y, u, dt)?;
        let estimate: Vector2<f64> = observer.step(y, u, dt)?;
        let square = kalman.step(&whole(u.x), &Vector3::new(0.0, u.x, 0.0), &y, dt);
        // The process noise of the interval is taken at its other end: a part `lambda dt` of what little it is.
        assert!((innovation.normalised_square - square).abs() < 2e-3 * square.max(0.1), "{innovation:?} {square}");
        // Of one row the square is that of its value over its variance.
        let variance = innovation.value.norm_squared() / innovation.normalised_square;
        assert!(variance.is_nan() || (innovation.determinant / variance - 1.0).abs() < 1e-9, "{innovation:?}");
        let errors = observer.standard_error().expect("a linear left inverse");
        let expected = Vector2::new(kalman.p[(1, 1)].sqrt(), kalman.p[(2, 2)].sqrt());
        assert!((errors - expected).component_div(&expected).abs().max() < 1e-9, "{errors} {expected}");
        largest = largest.max((estimate - kalman.z.yz()).abs().max());
    }
    println!("largest distance {largest:e}");
    // Rounding of numbers up to 10.
    assert!(largest < 1e-12, "{largest:e}");
    Ok(())
}

/// `a' = -b`, `b' = 0`, of which one output has the rate `a/2 - r` and the other the value `3 a + k r + v`.
#[derive(Clone, Debug)]
struct RateAndValue {
    /// `k`; where it is not 0, the model gives the slopes by `r`.
    share: f64,
}

impl Model<2, 2, 1, 2, 2, 2> for RateAndValue {
    type Scalar = f64;
    type Extension = Fundamental<f64, 2>;
    type X = SVector<Self::Scalar, 2>;
    type Y = SVector<Self::Scalar, 2>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector2<f64>;
    const REGRESSION: Regression = Regression::Dynamic;
    const INSTANTS: usize = 1;

    fn terms(&self, y: &Vector2<f64>) -> Vector2<f64> {
        *y
    }
    fn flow(&self, _: &Vector2<f64>, _: &Vector1<f64>) -> Flow<f64, 2> {
        Flow { lambda: Matrix2::new(0.0, -1.0, 0.0, 0.0), h: Vector2::zeros() }
    }
    fn regression(&self, extension: &Self::Extension, y: &Vector2<f64>, u: &Vector1<f64>) -> Sides<f64, 2, 2> {
        let factor = Matrix2::new(0.5, 0.0, -3.0, 0.0);
        let known = Vector2::new(-y.x, y.y - u.x - self.share * y.x);
        Sides { known: known + factor * extension.xi(), factor: factor * extension.psi() }
    }
    fn primitive(&self, _: &Self::Extension, y: &Vector2<f64>) -> Sides<f64, 2, 2> {
        Sides { known: Vector2::new(y.x, 0.0), factor: Matrix2::zeros() }
    }
    fn output_slopes(&self, _: &Vector2<f64>, _: &Vector1<f64>, _: &Vector2<f64>) -> OutputSlopes<f64, 2, 2> {
        let own = if self.share == 0.0 { 0.0 } else { -1.0 };
        OutputSlopes { rates: Matrix2::new(own, 0.0, -self.share, 0.0), cascade: Matrix2::zeros() }
    }
    fn theta(&self, eta: &Vector2<f64>) -> Vector2<f64> {
        *eta
    }
    fn recover(&self, z: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        *z
    }
}

impl Rebase<2, 2, 1, 2, 2> for RateAndValue {}

/// The largest distance between the estimates of the observer and of the Kalman filter.
fn beside_kalman_of_rate_and_value(share: f64) -> Result<f64, Fault> {
    let (dt, sigma) = (1e-2, Vector2::new(1.0, 1e-4));
    let (prior, process) = (Vector3::new(1.0, 4.0, 4.0), Vector3::new(0.0, 0.01, 0.1));
    let squares = LeastSquares::diagonal(&prior, 0.0)?.with_process_noise(&process)?;
    let model = OutputForm::<_, _, 2, 2>::new(RateAndValue { share });
    let mut observer =
        Observer::with_regression(model, squares, SampledRegression::new(&sigma)?, Vector3::zeros())?.rebasing(1)?;
    let mut kalman = Kalman {
        z: Vector3::zeros(),
        p: SMatrix::from_diagonal(&prior),
        output: SMatrix::<f64, 2, 3>::new(1.0, 0.0, 0.0, share, 3.0, 0.0),
        sensor: sigma.component_mul(&sigma),
        process,
    };
    // Without its slope the first output drives its own rate.
    let own = if share == 0.0 { 0.0 } else { -1.0 };
    #[rustfmt::skip]
    let whole = SMatrix::<f64, 3, 3>::new(
        own, 0.5, 0.0,
        0.0, 0.0, -1.0,
        0.0, 0.0, 0.0,
    );
    let mut noise = Noise::new(7);
    observer.step(Vector2::new(0.0, 3.0), Vector1::zeros(), dt)?;
    // The first sample of a rate is where its output begins.
    kalman.correct(&Vector2::new(0.0, 3.0), 1);
    let (mut r, mut before, mut largest) = (0.0, 0.0, 0.0_f64);
    for k in 1..=2_000_u32 {
        let t = f64::from(k) * dt;
        let a = 1.0 - 0.2 * t;
        // By the rule of the midpoint, which errs by 1e-5.
        r += dt * (0.5 * (a + 0.1 * dt) - r) / (1.0 + 0.5 * dt);
        let seen = if share == 0.0 { sigma.x * noise.normal() } else { r + sigma.x * noise.normal() };
        let y = Vector2::new(seen, 3.0 * a + share * r + t.sin() + sigma.y * noise.normal());
        let estimate: Vector2<f64> = observer.step(y, Vector1::new(t.sin()), dt)?;
        // Over an interval the mean of both ends drives it.
        let rate = Vector3::new(-0.5 * (1.0 + own) * (before + y.x), 0.0, 0.0);
        kalman.step(&whole, &rate, &Vector2::new(y.x, y.y - t.sin()), dt);
        before = y.x;
        largest = largest.max((estimate - kalman.z.yz()).abs().max());
        // Ten deviations of the better sensor, of 3 a; the other alone has more than 0.3.
        assert!(share != 0.0 || k < 100 || (estimate.x - a).abs() < 1e-3, "{estimate} {a}");
    }
    println!("largest distance {largest:e}");
    Ok(largest)
}

#[test]
fn a_value_beside_a_rate_is_a_measurement_of_its_own() -> Result<(), Fault> {
    let largest = beside_kalman_of_rate_and_value(0.0)?;
    // Rounding of numbers up to 10, weighted with 1e4.
    assert!(largest < 1e-9, "{largest:e}");
    Ok(())
}

#[test]
fn an_output_beside_others_in_a_value_is_that_state_and_not_its_sample() -> Result<(), Fault> {
    let largest = beside_kalman_of_rate_and_value(2.0)?;
    // As above; by its sample the distance is that of a sensor which errs by 2.
    assert!(largest < 1e-9, "{largest:e}");
    Ok(())
}

/// The output form of the Cuk converter, case I, before its first sample.
type Parted =
    Observer<OutputForm<CaseOne<f64>, f64, 2, 2>, LeastSquares<f64, 4>, 2, 2, 1, 4, 2, 4, SampledRegression<f64, 2, 4>>;

fn parted() -> Result<Parted, Fault> {
    let squares = LeastSquares::diagonal(&Vector4::new(0.01, 0.01, 4.0, 4.0), 0.0)?;
    let squares = squares.with_process_noise(&Vector4::new(0.0, 0.0, 1.0, 1.0))?;
    let sampled = SampledRegression::new(&Vector2::repeat(0.1))?;
    Observer::with_regression(OutputForm::new(CaseOne::<f64>::new()), squares, sampled, Vector4::zeros())?.rebasing(1)
}

#[test]
fn a_bound_and_the_time_since_a_sample_are_in_the_standard_error() -> Result<(), Fault> {
    let squares = LeastSquares::diagonal(&Vector4::new(0.01, 0.01, 4.0, 4.0), 0.0)?;
    let squares = squares.with_process_noise(&Vector4::new(0.0, 0.0, 1.0, 1.0))?;
    let bounded = Within::new(CaseOne::<f64>::new(), &Vector2::repeat(7.0), &Vector2::repeat(9.0))?;
    let sampled = SampledRegression::<f64, 2, 4>::new(&Vector2::repeat(0.1))?;
    let observer = Observer::with_regression(OutputForm::new(bounded), squares, sampled, Vector4::zeros())?;
    let (mut bounded, mut free) = (observer.rebasing(1)?, parted()?);
    for _ in 0..10 {
        let (y, u) = (Vector2::new(10.0, -12.0), Vector1::new(0.5));
        let estimate: Vector2<f64> = bounded.step(y, u, 1e-5)?;
        free.step(y, u, 1e-5)?;
        assert!(estimate.iter().all(|state| (7.0..=9.0).contains(state)), "{estimate}");
    }
    assert_eq!(bounded.standard_error(), free.standard_error());
    // z is x here, and drifts by 1 per root second.
    let [now, later] = [0.0, 0.5].map(|dt| free.standard_error_after(dt).expect("a linear left inverse"));
    let drifted = (later.component_mul(&later) - now.component_mul(&now)).map(|square| square - 0.5);
    assert!(drifted.amax() < 1e-9, "{drifted}");
    Ok(())
}

#[test]
fn outputs_with_periods_of_their_own_are_rows_left_out() -> Result<(), Fault> {
    let dt = 1e-5;
    let (mut whole, mut slow) = (parted()?, parted()?);
    let mut closed = Loop::<f64, CaseOne<f64>>::new(1.0, [1.0, 10.0], dt)?;
    let mut noise = Noise::new(9);
    let nothing = Vector2::new(f64::NAN, 1.0);
    // The first sample must be whole, and a missing output must have a row.
    assert_eq!(slow.step_partly(nothing, &[0, 1], Vector1::zeros(), dt).unwrap_err(), Fault::Output { index: 0 });
    let [mut squared, mut surprise] = [[0.0; 2]; 2];
    whole.step_partly(closed.outputs(), &[0, 1], Vector1::zeros(), dt)?;
    slow.step_partly(closed.outputs(), &[0, 1], Vector1::zeros(), dt)?;
    for k in 1..=20_000_u32 {
        let u = Vector1::new(closed.duty());
        closed.advance()?;
        let mut y = closed.outputs() + Vector2::new(noise.normal(), noise.normal()) * 0.1;
        if k > 2000 {
            surprise[0] += whole.innovation(y, u, dt)?.normalised_square / (18_000.0 * 2.0);
        }
        let estimate = whole.step_partly(y, &[0, 1], u, dt)?;
        if k == 1 {
            assert_eq!(slow.step_partly(nothing, &[1, 1], u, dt).unwrap_err(), Fault::Output { index: 0 });
        }
        if k % 10 != 0 {
            y.y = f64::NAN;
        }
        let innovation = slow.innovation_partly(y, &[0, 1], u, dt)?;
        if k == 10_001 {
            // An outlier of the output that is there: 100 standard deviations, of which the estimate's are few.
            let outlier = slow.innovation_partly(y + Vector2::new(10.0, 0.0), &[0, 1], u, dt)?;
            assert!(outlier.normalised_square > 50.0_f64.powi(2), "{outlier:?}");
            assert!(outlier.value.y == 0.0, "{outlier:?}");
        }
        let other = slow.step_partly(y, &[0, 1], u, dt)?;
        if k > 2000 {
            surprise[1] += innovation.normalised_square / (18_000.0 * if y.y.is_nan() { 1.0 } else { 2.0 });
            for (square, estimate) in squared.iter_mut().zip([estimate, other]) {
                *square += (estimate.x - closed.circuit.x).powi(2) / 18_000.0;
            }
        }
    }
    let [all, some] = squared.map(f64::sqrt);
    println!("rms of i1 with all samples {all:e}, with a tenth of those of v4 {some:e}");
    // v2 says most of i1: with a tenth of the samples of the other it is still known to a few mA.
    assert!(all < 1e-2 && some < 2e-2, "{all} {some}");
    // As much for each row that is there; process noise, which the plant has not, makes it less than 1. The mean of 18000
    // squares has a standard deviation of 0.01.
    let [of_whole, of_parts] = surprise;
    assert!((of_whole - of_parts).abs() < 0.05 && (of_whole - 1.0).abs() < 0.1, "{surprise:?}");
    // Without missing outputs a partial step is a step.
    let (mut plain, mut same) = (parted()?, parted()?);
    for k in 0..100_u32 {
        let (y, u) = (Vector2::new(10.0 + 0.01 * f64::from(k), -12.0), Vector1::new(0.5));
        assert_eq!(plain.step(y, u, dt)?, same.step_partly(y, &[0, 1], u, dt)?);
    }
    Ok(())
}

/// The rms error of i1 of the Cuk converter, case I, by the output form; measured voltages drive h.
fn output_form_of_cuk(process: f64, offset: f64) -> Result<f64, Fault> {
    let (dt, sigma) = (1e-5, 0.1);
    let prior = Vector4::new(100.0, 100.0, 4.0, 4.0);
    let wander = process * process;
    let squares = LeastSquares::diagonal(&prior, 0.0)?.with_process_noise(&Vector4::new(0.0, 0.0, wander, wander))?;
    let sampled = SampledRegression::new(&Vector2::repeat(sigma))?;
    let model = OutputForm::<_, _, 2, 2>::new(CaseOne::<f64>::new());
    let mut observer =
        Observer::<_, _, 2, 2, 1, 4, 2, 4, _>::with_regression(model, squares, sampled, Vector4::zeros())?
            .rebasing(1)?;
    let mut noise = Noise::new(5);
    let mut closed = Loop::<f64, CaseOne<f64>>::new(1.0, [1.0, 10.0], dt)?;
    let mut squared = 0.0;
    observer.step(closed.outputs(), Vector1::zeros(), dt)?;
    for k in 1..=20_000_u32 {
        let u = Vector1::new(closed.duty());
        closed.advance()?;
        let y = closed.outputs() + Vector2::new(noise.normal(), noise.normal()) * sigma + Vector2::repeat(offset);
        let estimate = observer.step(y, u, dt)?;
        if k > 2000 {
            squared += (estimate.x - closed.circuit.x).powi(2) / 18_000.0;
        }
    }
    Ok(squared.sqrt())
}

#[test]
fn measured_outputs_may_drive_the_model() -> Result<(), Fault> {
    // At 1 A per root second the Kalman filter above has 7.4 mA. An offset of 0.1 V is an error of the model that
    // process noise of this size mends.
    let [plain, offset] = [output_form_of_cuk(1.0, 0.0)?, output_form_of_cuk(1.0, 0.1)?];
    println!("rms {plain:e}, under an offset {offset:e}");
    assert!(plain < 8e-3, "{plain}");
    assert!(offset < 2e-2, "{offset}");
    Ok(())
}

#[test]
fn samples_are_weighed_by_their_sensors() {
    let side = |known: [f64; 2]| Sides { known: Vector2::from(known), factor: Matrix2::new(1.0, 2.0, 3.0, 4.0) };
    let sampled = SampledRegression::<f64, 2, 2>::new(&Vector2::new(0.5, 2.0)).unwrap();
    let step = sampled.step([&side([9.0, 9.0]), &side([1.0, 4.0])], 0.25);
    // Rows over s sqrt(dt) = 0.25 and 1.
    assert_eq!(RegressionOperator::regressand(&step), Vector2::new(4.0, 4.0));
    assert_eq!(RegressionOperator::regressor(&step), Matrix2::new(4.0, 8.0, 3.0, 4.0));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(SampledRegression::<f64, 2, 2>::new(&Vector2::new(1.0, bad)), Err(Fault::Gain));
    }
    let squares = LeastSquares::<f64, 1>::diagonal(&Vector1::new(1.0), 0.0).unwrap();
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(squares.with_process_noise(&Vector1::new(bad)), Err(Fault::Gain));
    }
}
