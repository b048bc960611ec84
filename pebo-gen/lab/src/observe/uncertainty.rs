//! The covariance of an observer's errors where samples drive its model.
//!
//! ```text
//! e' = F e + G n + G n'        the extension goes on from the sample with the noise n to that with n'
//! e+ = (1 - K H) e' + K E n'   least squares take the sample
//! ```
//!
//! In: each step of the observer, and the noise model. Out: the covariance of `(e, n)`, the error of z and the
//! noise of the last sample, and from it standard errors of the estimates and what an innovation should be.
//!
//! The runtime's least squares take the noise of a sample and that of the cascade for independent, and weight both by
//! their variances. It is the same noise. Their own covariance is that of another plant, often twice as large as the
//! true one. Here the gain `K = P H^T R^-1` that they make of it is taken as given, and the covariance of a filter with
//! this gain is computed (Jazwinski, *Stochastic processes and filtering theory*, 1970, chapter 7), with the noise of
//! the last sample as a state beside the error.

use pebo_runtime::nalgebra::{Cholesky, SMatrix, SVector};
use pebo_runtime::{Extension, Fault, Flow, Fundamental, Model};

use super::sizes::{pad, padded};

/// The noise that an observer meets, with a value for every output or coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoiseModel {
    /// The standard deviations of the outputs' samples.
    pub(crate) sensors: Vec<f64>,
    /// Those of the rows of the regression, their weights.
    pub(crate) weights: Vec<f64>,
    /// The variances of the unknown at the start.
    pub(crate) start: Vec<f64>,
    /// Its drift, as a variance per second, without the contribution of the sensors.
    pub(crate) drift: Vec<f64>,
    /// The first coordinates that are rows of the regression: all of these in the output form, else none.
    pub(crate) rows: usize,
    /// The index of each row's output, where outputs may be missing.
    pub(crate) measured: Vec<usize>,
}

/// What a sample says of an observer's numbers, all rows combined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surprise {
    /// The square of the innovation in the norm of its covariance.
    pub(crate) square: f64,
    /// The determinant of that covariance, in units of the rows' own.
    pub(crate) determinant: f64,
}

/// The covariance of error and noise, at the last sample.
#[derive(Clone, Debug)]
pub(crate) struct Uncertainty<const N: usize> {
    sensors: SVector<f64, N>,
    weights: SVector<f64, N>,
    start: SVector<f64, N>,
    drift: SVector<f64, N>,
    /// The drift at present, as a multiple of that: an adaptive estimator's own.
    factor: f64,
    rows: usize,
    measured: Vec<usize>,
    /// None before the first sample.
    joint: Option<JointCovariance<N>>,
}

/// The covariance of the error of z and of the noise of the last sample.
#[derive(Clone, Copy, Debug)]
struct JointCovariance<const N: usize> {
    errors: SMatrix<f64, N, N>,
    /// The expectation of error times noise.
    both: SMatrix<f64, N, N>,
    noise: SMatrix<f64, N, N>,
}

/// The ends of a step, and the estimate at its start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval<'a, const N: usize> {
    pub(crate) before: &'a SVector<f64, N>,
    pub(crate) after: &'a SVector<f64, N>,
    pub(crate) u: &'a SVector<f64, N>,
    pub(crate) dt: f64,
    /// The estimate of z before the step.
    pub(crate) z: SVector<f64, N>,
}

/// The propagation of errors over an interval, before its sample is taken: `F`, `G` and `E`, and the map `H` of the
/// rows.
#[derive(Clone, Copy, Debug)]
struct Propagation<const N: usize> {
    of_errors: SMatrix<f64, N, N>,
    of_noise: SMatrix<f64, N, N>,
    of_sample: SMatrix<f64, N, N>,
    rows: SMatrix<f64, N, N>,
    /// The sample less its expectation, in each row.
    rest: SVector<f64, N>,
}

/// What least squares have after a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Learned<'a, const N: usize> {
    /// A root of their covariance of z.
    pub(crate) root: &'a SMatrix<f64, N, N>,
    /// Their estimate of z.
    pub(crate) z: &'a SVector<f64, N>,
    /// What each row was multiplied by, so that it has the weight of its sensors there.
    pub(crate) shares: &'a SVector<f64, N>,
}

impl<const N: usize> Uncertainty<N> {
    pub(crate) fn new(noise: &NoiseModel) -> Self {
        Self {
            sensors: pad(&noise.sensors),
            weights: padded(&noise.weights, 1.0),
            start: pad(&noise.start),
            drift: pad(&noise.drift),
            factor: 1.0,
            rows: noise.rows,
            measured: noise.measured.clone(),
            joint: None,
        }
    }

    /// Starts again before the first sample.
    pub(crate) fn reset(&mut self) {
        self.joint = None;
        self.factor = 1.0;
    }

    /// Takes the first sample: in the output form it is the estimate of outputs with rates, and its noise is their error.
    /// If the other rows were taken, that is what least squares have after them.
    pub(crate) fn begin<M>(
        &mut self,
        model: &M,
        (y, u): (&SVector<f64, N>, &SVector<f64, N>),
        learned: Option<Learned<'_, N>>,
    ) where
        M: Model<N, N, N, N, N, N, Scalar = f64, Terms = SVector<f64, N>>,
    {
        let noise = SMatrix::from_diagonal(&self.sensors.component_mul(&self.sensors));
        let (mut errors, mut both) = (SMatrix::from_diagonal(&self.start), SMatrix::zeros());
        if self.rows > 0 {
            let of_sample = self.of_sample(model, y, u, &SVector::zeros());
            both = of_sample * noise;
            let (known, size) = (both * of_sample.transpose(), (self.rows, self.rows));
            errors.view_mut((0, 0), size).copy_from(&known.view((0, 0), size));
            // Where w holds z, the errors of z are in it too.
            let held = -model.regression(&M::Extension::new(SVector::zeros()), y, u).factor;
            let mut map = SMatrix::<f64, N, N>::identity();
            let beside = (self.rows, N - self.rows);
            map.view_mut((0, self.rows), beside).copy_from(&held.view((0, self.rows), beside));
            errors = map * errors * map.transpose();
        }
        if let Some(Learned { root, z, shares }) = learned {
            let mut rows = model.regression(&M::Extension::new(SVector::zeros()), y, u).factor;
            rows.rows_mut(0, self.rows).fill(0.0);
            let gain = root * root.transpose() * rows.transpose() * SMatrix::from_diagonal(&self.weighted(shares));
            let (kept, taken) = (SMatrix::identity() - gain * rows, gain * self.of_sample(model, y, u, z));
            let crossed = kept * both * taken.transpose();
            errors =
                kept * errors * kept.transpose() + crossed + crossed.transpose() + taken * noise * taken.transpose();
            both = kept * both + taken * noise;
        }
        self.joint = Some(JointCovariance { errors, both, noise });
    }

    /// Takes a step that went well, with what least squares have after it, and process noise times the factor. A missing
    /// output has been replaced by what the observer expects of it.
    ///
    /// # Errors
    /// [`Fault::Singular`] where the flow has no exponential, as of the step itself.
    pub(crate) fn take<M>(
        &mut self,
        model: &M,
        interval: &Interval<'_, N>,
        (Learned { root, shares, .. }, factor): (Learned<'_, N>, f64),
        missing: &[bool],
    ) -> Result<(), Fault>
    where
        M: Model<N, N, N, N, N, N, Scalar = f64, Terms = SVector<f64, N>>,
    {
        let Some(JointCovariance { errors, both, noise }) = self.joint else { return Ok(()) };
        let Propagation { of_errors, of_noise, of_sample, rows, .. } = self.propagated(model, interval)?;
        let one = SMatrix::<f64, N, N>::identity();
        let (mut present, mut expected) = (one, SMatrix::<f64, N, N>::zeros());
        let mut weights = self.weighted(shares);
        for (row, output) in self.measured.iter().enumerate().filter(|(_, output)| missing[**output]) {
            // The substitute for a missing output has the error of its expectation.
            present[(*output, *output)] = 0.0;
            if !self.measured[..row].contains(output) {
                expected.set_row(*output, &rows.row(row));
            }
            weights[row] = 0.0;
        }
        let gain = root * root.transpose() * rows.transpose() * SMatrix::from_diagonal(&weights);
        let kept = (one - gain * rows) * (one + of_noise * expected);
        // The maps of error, noise of the last sample, and noise of this one to the new error and the new noise.
        let fresh = of_noise * present;
        let to_errors = [kept * of_errors, kept * of_noise, kept * fresh + gain * of_sample * present];
        let to_noise = [expected * of_errors, expected * of_noise, expected * fresh + present];
        let drift = self.drift_over(interval.dt);
        self.factor = factor;
        let sensors = SMatrix::from_diagonal(&self.sensors.component_mul(&self.sensors));
        let between = |left: &[SMatrix<f64, N, N>; 3], right: &[SMatrix<f64, N, N>; 3]| {
            let [by_error, by_noise, by_sample] = left;
            by_error * (errors * right[0].transpose() + both * right[1].transpose())
                + by_noise * (both.transpose() * right[0].transpose() + noise * right[1].transpose())
                + by_sample * sensors * right[2].transpose()
        };
        self.joint = Some(JointCovariance {
            errors: between(&to_errors, &to_errors) + kept * drift * kept.transpose(),
            both: between(&to_errors, &to_noise) + kept * drift * expected.transpose(),
            noise: between(&to_noise, &to_noise) + expected * drift * expected.transpose(),
        });
        Ok(())
    }

    /// The square of an innovation in the norm of its covariance.
    pub(crate) fn surprise<M>(&self, model: &M, interval: &Interval<'_, N>, equations: usize) -> Option<Surprise>
    where
        M: Model<N, N, N, N, N, N, Scalar = f64, Terms = SVector<f64, N>>,
    {
        let JointCovariance { errors, both, noise } = self.joint?;
        let Propagation { of_errors, of_noise, of_sample, rows, rest } = self.propagated(model, interval).ok()?;
        let (by_error, by_noise, by_sample) = (-rows * of_errors, -rows * of_noise, of_sample - rows * of_noise);
        let sensors = SMatrix::from_diagonal(&self.sensors.component_mul(&self.sensors));
        let drift = self.drift_over(interval.dt);
        let covariance = by_error * (errors * by_error.transpose() + both * by_noise.transpose())
            + by_noise * (both.transpose() * by_error.transpose() + noise * by_noise.transpose())
            + by_sample * sensors * by_sample.transpose()
            + rows * drift * rows.transpose();
        let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| match (i < equations, j < equations) {
            (true, true) => covariance[(i, j)] / (self.weights[i] * self.weights[j]),
            _ => f64::from(u8::from(i == j)),
        });
        let scaled = Cholesky::new(scaled)?;
        let innovation = rest.component_div(&self.weights);
        let square = innovation.dot(&scaled.solve(&innovation));
        square.is_finite().then(|| Surprise { square, determinant: scaled.determinant() })
    }

    /// The standard errors of functions of z and a sample: by their change with each column of a root of the
    /// covariance, to the side where that is less, as an angle may come round on the other. An error of z is mapped by
    /// `through`, if there is such a map. The last sample is `age` seconds old, in which z has drifted.
    pub(crate) fn of(
        &self,
        (z, y): (&SVector<f64, N>, &SVector<f64, N>),
        through: Option<&SMatrix<f64, N, N>>,
        age: f64,
        value: impl Fn(&SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, N>,
    ) -> Option<SVector<f64, N>> {
        let middle = value(z, y);
        let mut squares = SVector::<f64, N>::zeros();
        for (error, noise) in self.columns(age)? {
            let error = through.map_or(error, |through| through * error);
            let sides = [value(&(z + error), &(y + noise)) - middle, value(&(z - error), &(y - noise)) - middle];
            for (place, square) in squares.iter_mut().enumerate() {
                let [above, below] = sides.each_ref().map(|side| side[place].abs());
                // The lesser of NaN and a number would be the number.
                *square += above.min(below).powi(2) + 0.0 * (above + below);
            }
        }
        squares.iter().all(|square| square.is_finite()).then(|| squares.map(f64::sqrt))
    }

    /// The weights of the rows with these shares.
    fn weighted(&self, shares: &SVector<f64, N>) -> SVector<f64, N> {
        self.weights.zip_map(shares, |deviation, share| (share / deviation).powi(2))
    }

    /// What z drifts in this time, as a covariance.
    fn drift_over(&self, seconds: f64) -> SMatrix<f64, N, N> {
        SMatrix::from_diagonal(&(self.drift * (self.factor * seconds)))
    }

    /// The columns of a root of the covariance of z and the outputs.
    fn columns(&self, age: f64) -> Option<Vec<(SVector<f64, N>, SVector<f64, N>)>> {
        let JointCovariance { errors, both, noise } = self.joint.as_ref()?;
        let errors = errors + self.drift_over(age);
        let at = |i: usize, j: usize| match (i.checked_sub(N), j.checked_sub(N)) {
            (None, None) => errors[(i, j)],
            (None, Some(j)) => both[(i, j)],
            (Some(i), None) => both[(j, i)],
            (Some(i), Some(j)) => noise[(i, j)],
        };
        let mut left: Vec<Vec<f64>> = (0..2 * N).map(|i| (0..2 * N).map(|j| at(i, j)).collect()).collect();
        let mut columns: Vec<(SVector<f64, N>, SVector<f64, N>)> = Vec::new();
        // By pivots, largest share first: the rest of a singular matrix is rounding.
        let whole: Vec<f64> = (0..2 * N).map(|i| left[i][i]).collect();
        if whole.iter().any(|variance| !variance.is_finite()) {
            return None;
        }
        let mut open: Vec<usize> = (0..2 * N).filter(|i| whole[*i] > 0.0).collect();
        while let Some(place) =
            open.iter().copied().max_by(|a, b| (left[*a][*a] / whole[*a]).total_cmp(&(left[*b][*b] / whole[*b])))
        {
            if left[place][place] <= ROUNDING * whole[place] {
                break;
            }
            let root = left[place][place].sqrt();
            let column: Vec<f64> = (0..2 * N).map(|i| left[i][place] / root).collect();
            for (i, row) in left.iter_mut().enumerate() {
                row.iter_mut().zip(&column).for_each(|(entry, other)| *entry -= column[i] * other);
            }
            open.retain(|other| *other != place);
            columns.push((pad(&column[..N]), pad(&column[N..])));
        }
        columns.iter().all(|(e, n)| e.iter().chain(n.iter()).all(|value| value.is_finite())).then_some(columns)
    }

    fn propagated<M>(&self, model: &M, interval: &Interval<'_, N>) -> Result<Propagation<N>, Fault>
    where
        M: Model<N, N, N, N, N, N, Scalar = f64, Terms = SVector<f64, N>>,
    {
        let Interval { before, after, u, dt, z } = interval;
        let first = model.flow_near(before, u, z);
        let ahead = model.ahead(&first, z, *dt);
        let flows = [first, model.flow_near(after, u, &ahead)];
        let mut extension = Fundamental::<f64, N>::new(*z);
        let [first, last] = &flows;
        extension.advance(first, last, *dt)?;
        let of_errors = *extension.psi();
        let z = extension.xi();
        let rate = |y: &SVector<f64, N>| {
            let Flow { lambda, h } = model.flow_near(y, u, &ahead);
            lambda * z + h
        };
        let one = SMatrix::<f64, N, N>::identity();
        // The mean of both ends drives the flow over the interval, by the trapezoidal rule.
        let of_noise = (one + of_errors) * self.slopes(after, rate) * (0.25 * dt);
        let sides = model.regression(&M::Extension::new(SVector::zeros()), after, u);
        let (rows, rest) = (sides.factor, sides.known - sides.factor * z);
        Ok(Propagation { of_errors, of_noise, of_sample: self.of_sample(model, after, u, z), rows, rest })
    }

    /// The derivative of a sample's rows by its outputs: the known side, less its expectation at z.
    fn of_sample<M>(
        &self,
        model: &M,
        y: &SVector<f64, N>,
        u: &SVector<f64, N>,
        z: &SVector<f64, N>,
    ) -> SMatrix<f64, N, N>
    where
        M: Model<N, N, N, N, N, N, Scalar = f64, Terms = SVector<f64, N>>,
    {
        let extension = M::Extension::new(SVector::zeros());
        self.slopes(y, |y| {
            let sides = model.regression(&extension, y, u);
            sides.known - sides.factor * z
        })
    }

    /// The derivative of a function by the outputs, over a standard deviation of their sensors to either side; to one
    /// side where the function has no value on the other, as a root near 0.
    fn slopes(&self, y: &SVector<f64, N>, value: impl Fn(&SVector<f64, N>) -> SVector<f64, N>) -> SMatrix<f64, N, N> {
        let mut slopes = SMatrix::<f64, N, N>::zeros();
        for (output, &deviation) in self.sensors.iter().enumerate().filter(|(_, deviation)| **deviation > 0.0) {
            let side = |sign: f64| {
                let mut beside = *y;
                beside[output] += sign * deviation;
                let value = value(&beside);
                value.iter().all(|entry| entry.is_finite()).then_some((beside[output], value))
            };
            let here = || (y[output], value(y));
            let (above, below) = (side(1.0).unwrap_or_else(here), side(-1.0).unwrap_or_else(here));
            slopes.set_column(output, &((above.1 - below.1) / (above.0 - below.0)));
        }
        slopes
    }
}

/// The share of a variance that is rounding where others determine it.
const ROUNDING: f64 = 1e-12;
