//! An estimator with the Gramian of its data.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Estimator, Fault, Information, Turn, Uncertain};

use super::estimator::PaddedEstimator;
use super::excitation::{ComponentInformation, Gramian};
use super::setup::{self, Covariance, Extension};

/// An estimator of a padded model, with the Gramian of its data.
#[derive(Clone, Debug)]
pub(crate) struct MonitoredEstimator<const N: usize> {
    estimator: PaddedEstimator<N>,
    information: Gramian<N>,
}

impl<const N: usize> MonitoredEstimator<N> {
    /// The estimator with its settings, for this number of unknowns before padding.
    pub(crate) fn new(settings: &setup::Estimator, unknowns: usize) -> Result<Self, Fault> {
        let forgetting = match settings {
            setup::Estimator::LeastSquares(Covariance { forgetting, .. })
            | setup::Estimator::AdaptiveLeastSquares(Covariance { forgetting, .. }, _)
            | setup::Estimator::Drem { extension: Extension::Kreisselmeier { forgetting, .. }, .. }
            | setup::Estimator::Drem { extension: Extension::LeastSquares(Covariance { forgetting, .. }), .. } => {
                *forgetting
            }
            _ => 0.0,
        };
        Ok(Self { estimator: PaddedEstimator::new(settings)?, information: Gramian::new(unknowns, forgetting) })
    }

    /// The factor of the process noise, as a multiple of the settings'.
    pub(crate) fn factor(&self) -> f64 {
        self.estimator.factor()
    }

    /// The information of the data on each component of the unknown.
    pub(crate) fn component_information(&self) -> ComponentInformation {
        self.information.component_information()
    }
}

impl<const N: usize> Estimator<f64, N, N> for MonitoredEstimator<N> {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        self.information.add(regressor, dt);
        self.estimator.advance(regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        self.estimator.estimate()
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.estimator.shift(shift);
    }

    fn information(&self) -> Option<&Information<f64, N>> {
        self.estimator.information()
    }

    fn turn(&mut self, turn: &Turn<f64, N>) {
        self.information.turn(turn);
        self.estimator.turn(turn);
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        self.information.reset();
        self.estimator.reset(estimate);
    }

    fn is_finite(&self) -> bool {
        self.estimator.is_finite()
    }
}

impl<const N: usize> Uncertain<f64, N> for MonitoredEstimator<N> {
    fn covariance_root(&self, dt: f64) -> Option<SMatrix<f64, N, N>> {
        self.estimator.covariance_root(dt)
    }
}
