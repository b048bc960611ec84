//! The gains that correct a baseline's prediction: Kalman's and Luenberger's.
//!
//! In: the transition of a step, and the derivatives of the outputs. Out: the correction of the states. Sizes are
//! padded with zeros, which neither changes.

use pebo_runtime::nalgebra::{SMatrix, SVector};

use super::linearised::Transition;

/// The outputs of a sample.
#[derive(Clone, Debug)]
pub(super) struct Sample<const N: usize> {
    /// Measured less predicted.
    pub(super) innovation: SVector<f64, N>,
    /// The derivatives of the outputs by the states.
    pub(super) slopes: SMatrix<f64, N, N>,
}

/// A rule that corrects predictions.
#[derive(Clone, Debug)]
pub(super) enum Gain<const N: usize> {
    Kalman(Kalman<N>),
    Luenberger(Luenberger<N>),
}

impl<const N: usize> Gain<N> {
    /// Follows the states over a step of `dt` seconds.
    pub(super) fn predict(&mut self, step: &Transition<N>, dt: f64) {
        match self {
            Self::Kalman(filter) => filter.predict(step, dt),
            Self::Luenberger(_) => {}
        }
    }

    /// The correction of the states by a sample at the end of a step of `dt` seconds; nothing where there is none.
    pub(super) fn correct(&mut self, step: &Transition<N>, sample: &Sample<N>, dt: f64) -> Option<SVector<f64, N>> {
        match self {
            Self::Kalman(filter) => Some(filter.correct(sample)),
            Self::Luenberger(observer) => observer.correct(step, sample, dt),
        }
    }
}

/// The covariance of a Kalman filter.
#[derive(Clone, Debug)]
pub(super) struct Kalman<const N: usize> {
    /// Of the states' errors.
    pub(super) covariance: SMatrix<f64, N, N>,
    /// The growth of each variance in a second.
    pub(super) intensity: SVector<f64, N>,
    /// The variances of the outputs' samples.
    pub(super) sensors: Vec<f64>,
}

/// The covariance after a transition.
fn carried<const N: usize>(transition: &SMatrix<f64, N, N>, covariance: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    transition * covariance * transition.transpose()
}

impl<const N: usize> Kalman<N> {
    /// Method: the integral of the disturbance by Simpson's rule, of fourth order in the step and never indefinite.
    fn predict(&mut self, step: &Transition<N>, dt: f64) {
        let intensity = SMatrix::from_diagonal(&self.intensity);
        let disturbed = intensity + carried(&step.half, intensity * 4.0) + carried(&step.whole, intensity);
        self.covariance = carried(&step.whole, self.covariance) + disturbed * (dt / 6.0);
    }

    /// Method: the outputs one by one, which independent sensors allow, in Joseph's form.
    fn correct(&mut self, sample: &Sample<N>) -> SVector<f64, N> {
        let mut correction = SVector::zeros();
        for (row, &variance) in self.sensors.iter().enumerate() {
            let slope = sample.slopes.row(row).transpose();
            let shared = self.covariance * slope;
            let gain = shared / (slope.dot(&shared) + variance);
            correction += gain * (sample.innovation[row] - slope.dot(&correction));
            let kept = SMatrix::identity() - gain * slope.transpose();
            self.covariance = carried(&kept, self.covariance) + gain * gain.transpose() * variance;
        }
        correction
    }
}

/// The poles of a Luenberger observer, and its gain.
#[derive(Clone, Debug)]
pub(super) struct Luenberger<const N: usize> {
    /// Of continuous time, in 1/s.
    pub(super) poles: Vec<f64>,
    /// The number of outputs.
    pub(super) outputs: usize,
    /// The last transition and output slopes with their gain: with constant inputs it is computed once.
    pub(super) known: Option<(SMatrix<f64, N, N>, SMatrix<f64, N, N>, SMatrix<f64, N, N>)>,
}

impl<const N: usize> Luenberger<N> {
    fn correct(&mut self, step: &Transition<N>, sample: &Sample<N>, dt: f64) -> Option<SVector<f64, N>> {
        let known = self.known.filter(|(transition, slopes, _)| (transition, slopes) == (&step.whole, &sample.slopes));
        let gain = match known {
            Some((.., gain)) => gain,
            None => self.gain(&step.whole, &(sample.slopes * step.whole), dt)?,
        };
        self.known = Some((step.whole, sample.slopes, gain));
        Some(gain * sample.innovation)
    }

    /// The gain `L` for which `A - L C` has the poles, `A` the transition and `C` the output slopes.
    ///
    /// Method: rows `x_i (A - f_i) = g_i C` with any `g_i` make `X A - F X = G C`, so that with `L = X^-1 G` the matrix
    /// `A - L C = X^-1 F X` has the poles `F`. Source: Luenberger, *Observing the state of a
    /// linear system*, IEEE Trans. Military Electronics, 1964. Here each `g_i` takes one output, in turn, so that
    /// outputs of unequal units are not mixed: `X` has an inverse where the states of its poles are observable from
    /// each output.
    fn gain(
        &self,
        transition: &SMatrix<f64, N, N>,
        output_slopes: &SMatrix<f64, N, N>,
        dt: f64,
    ) -> Option<SMatrix<f64, N, N>> {
        let (mut rows, mut mixing) = (SMatrix::<f64, N, N>::identity(), SMatrix::<f64, N, N>::zeros());
        for (row, pole) in self.poles.iter().enumerate() {
            mixing[(row, row % self.outputs)] = 1.0;
            let shifted = transition - SMatrix::identity() * (pole * dt).exp();
            let right = output_slopes.transpose() * mixing.row(row).transpose();
            rows.set_row(row, &(shifted.transpose().try_inverse()? * right).transpose());
        }
        Some(rows.try_inverse()? * mixing)
    }
}
