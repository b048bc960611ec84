//! Every estimator of the runtime library behind one face, so that the observer need not be compiled for each.
//!
//! A model is padded with zeros to one of a few sizes. Zero rows and columns of a regressor change no estimate of a
//! gradient or of least squares, which run at the padded size. The determinant of DREM is zero with a column of zeros,
//! so DREM runs at the very number of unknowns.

use std::fmt;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Drem, Estimator, Fault, FiniteTime, Gradient, Kreisselmeier, LeastSquares, NormalisedGradient, Response,
};

use super::derived::{LARGEST, pad};
use super::settings::{self, Covariance, Extension};

/// The most unknowns of DREM: one instance of each kind is compiled for each number up to it.
pub(super) const MOST_MIXED: usize = 6;

/// An estimator of a model that was padded to the size N.
#[derive(Debug)]
pub(super) struct Chosen<const N: usize>(Box<dyn Face<N>>);

impl<const N: usize> Chosen<N> {
    /// The estimator with its settings, which have a value for each of the unknowns.
    pub(super) fn new(settings: &settings::Estimator) -> Result<Self, Fault> {
        // What is set for a padded unknown has no effect, but must be positive.
        let all = |values: &[f64]| -> SVector<f64, N> { padded(values, 1.0) };
        Ok(Self(match settings {
            settings::Estimator::Gradient(gain) => Box::new(Gradient::diagonal(&all(gain))?),
            settings::Estimator::NormalisedGradient { gain, mu } => {
                Box::new(NormalisedGradient::new(Gradient::diagonal(&all(gain))?, *mu)?)
            }
            settings::Estimator::LeastSquares(Covariance { start, forgetting }) => {
                Box::new(LeastSquares::diagonal(&all(start), *forgetting)?)
            }
            settings::Estimator::Drem { gain, extension } => match gain.len() {
                1 => mixed::<1, N>(gain, extension)?,
                2 => mixed::<2, N>(gain, extension)?,
                3 => mixed::<3, N>(gain, extension)?,
                4 => mixed::<4, N>(gain, extension)?,
                5 => mixed::<5, N>(gain, extension)?,
                MOST_MIXED => mixed::<MOST_MIXED, N>(gain, extension)?,
                // None and more were refused with the settings.
                _ => return Err(Fault::Gain),
            },
        }))
    }
}

impl<const N: usize> Clone for Chosen<N> {
    fn clone(&self) -> Self {
        Self(self.0.boxed())
    }
}

impl<const N: usize> Estimator<f64, N, N> for Chosen<N> {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        self.0.advance(regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        self.0.estimate()
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.0.shift(shift);
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        self.0.reset(estimate);
    }

    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
}

/// An estimator whose type is not known.
trait Face<const N: usize>: fmt::Debug {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault>;
    fn estimate(&self) -> SVector<f64, N>;
    fn shift(&mut self, shift: &SVector<f64, N>);
    fn reset(&mut self, estimate: &SVector<f64, N>);
    fn is_finite(&self) -> bool;
    fn boxed(&self) -> Box<dyn Face<N>>;
}

impl<E: Estimator<f64, N, N> + fmt::Debug + 'static, const N: usize> Face<N> for E {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        Estimator::advance(self, regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        Estimator::estimate(self)
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        Estimator::shift(self, shift);
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        Estimator::reset(self, estimate);
    }

    fn is_finite(&self) -> bool {
        Estimator::is_finite(self)
    }

    fn boxed(&self) -> Box<dyn Face<N>> {
        Box::new(self.clone())
    }
}

/// DREM of `NE` unknowns.
fn mixed<const NE: usize, const N: usize>(gain: &[f64], extension: &Extension) -> Result<Box<dyn Face<N>>, Fault> {
    let all = |values: &[f64]| -> SVector<f64, NE> { padded(values, 1.0) };
    let gains = all(gain);
    Ok(match extension {
        Extension::Kreisselmeier { gain, forgetting, finite_time } => {
            let drem = Drem::new(Kreisselmeier::new(&all(gain), *forgetting)?, &gains)?;
            match finite_time {
                None => Exact::boxed(drem),
                Some(settings::FiniteTime { clip, period: None }) => Exact::boxed(FiniteTime::once(drem, *clip)?),
                Some(settings::FiniteTime { clip, period: Some(period) }) => {
                    Exact::boxed(FiniteTime::tracking(drem, *clip, *period)?)
                }
            }
        }
        Extension::Gradient(gain) => Exact::boxed(Drem::new(response(Gradient::diagonal(&all(gain))?)?, &gains)?),
        Extension::LeastSquares(Covariance { start, forgetting }) => {
            Exact::boxed(Drem::new(response(LeastSquares::diagonal(&all(start), *forgetting)?)?, &gains)?)
        }
    })
}

fn response<E, const NE: usize>(estimator: E) -> Result<Response<f64, E, LARGEST, NE>, Fault>
where
    E: Estimator<f64, LARGEST, NE> + Copy,
{
    Response::new(estimator)
}

/// An estimator of exactly `NE` unknowns in a padded model. Its equations are padded to the largest size, so that it is
/// compiled once for each number of unknowns.
#[derive(Clone, Debug)]
struct Exact<E, const NE: usize>(E);

impl<E: Estimator<f64, LARGEST, NE> + fmt::Debug + 'static, const NE: usize> Exact<E, NE> {
    fn boxed<const N: usize>(estimator: E) -> Box<dyn Face<N>> {
        Box::new(Self(estimator))
    }
}

impl<E: Estimator<f64, LARGEST, NE>, const NE: usize, const N: usize> Estimator<f64, N, N> for Exact<E, NE> {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        let mut rows = SMatrix::<f64, LARGEST, NE>::zeros();
        for column in 0..NE {
            rows.column_mut(column).rows_mut(0, N).copy_from(&regressor.column(column));
        }
        self.0.advance(&rows, &pad(regressand.as_slice()), dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        pad(self.0.estimate().as_slice())
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.0.shift(&padded(&shift.as_slice()[..NE], 0.0));
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        self.0.reset(&padded(&estimate.as_slice()[..NE], 0.0));
    }

    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
}

/// The values, and behind them as many of another as there is room for.
pub(super) fn padded<const N: usize>(values: &[f64], other: f64) -> SVector<f64, N> {
    let mut vector = SVector::<f64, N>::repeat(other);
    vector.as_mut_slice()[..values.len()].copy_from_slice(values);
    vector
}
