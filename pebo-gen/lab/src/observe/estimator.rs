//! Every estimator of the runtime library as one type, so that the observer need not be compiled for each.
//!
//! A model is padded with zeros to one of a few sizes. Zero rows and columns of a regressor change no estimate of a
//! gradient or of least squares. The determinant of DREM would be zero with a column of zeros: the padded block of its
//! extension is replaced by the identity, which leaves the determinant that of the unknowns. So each is compiled once
//! for each size, not for every number of unknowns.

use std::fmt;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    AdaptiveLeastSquares, Drem, Estimator, Fault, FiniteTime, Gradient, Information, Kreisselmeier, LeastSquares,
    NormalisedGradient, RegressorExtension, Response, Turn, Uncertain,
};

use super::excitation::{ComponentInformation, Gramian};
use super::setup::{self, Covariance, Extension};
use super::sizes::{LARGEST, MOST_MIXED, pad, padded, resized};

/// An estimator of a model padded to the size N, with the Gramian of its data.
#[derive(Clone, Debug)]
pub(crate) struct PaddedEstimator<const N: usize> {
    kind: Kind<N>,
    data: Gramian<N>,
}

/// Not behind a pointer where that can be: the observer works on a copy in each step.
#[derive(Debug)]
enum Kind<const N: usize> {
    Gradient(Gradient<f64, N>),
    Normalised(NormalisedGradient<f64, N>),
    /// Those with a covariance.
    Squares(LeastSquares<f64, N>),
    Adaptive(AdaptiveLeastSquares<f64, N, N>),
    Mixed(Box<dyn DynEstimator<N>>),
}

impl<const N: usize> PaddedEstimator<N> {
    /// The estimator with its settings, which have a value for each of so many unknowns.
    pub(crate) fn new(settings: &setup::Estimator, unknowns: usize) -> Result<Self, Fault> {
        // Settings of a padded unknown have no effect, but must be positive.
        let all = |values: &[f64]| -> SVector<f64, N> { padded(values, 1.0) };
        let kind = match settings {
            setup::Estimator::Gradient(gain) => Kind::Gradient(Gradient::diagonal(&all(gain))?),
            setup::Estimator::NormalisedGradient { gain, mu } => {
                Kind::Normalised(NormalisedGradient::new(Gradient::diagonal(&all(gain))?, *mu)?)
            }
            setup::Estimator::LeastSquares(covariance) => Kind::Squares(squares(covariance)?),
            setup::Estimator::AdaptiveLeastSquares(covariance, guess) => {
                Kind::Adaptive(AdaptiveLeastSquares::new(squares(covariance)?, &pad(guess))?)
            }
            setup::Estimator::Drem { gain, extension } if gain.len() <= MOST_MIXED => {
                Kind::Mixed(mixed(gain, extension)?)
            }
            // Refused when the settings are resolved.
            setup::Estimator::Drem { .. } => return Err(Fault::Gain),
        };
        let forgetting = match settings {
            setup::Estimator::LeastSquares(Covariance { forgetting, .. })
            | setup::Estimator::AdaptiveLeastSquares(Covariance { forgetting, .. }, _)
            | setup::Estimator::Drem { extension: Extension::Kreisselmeier { forgetting, .. }, .. }
            | setup::Estimator::Drem { extension: Extension::LeastSquares(Covariance { forgetting, .. }), .. } => {
                *forgetting
            }
            _ => 0.0,
        };
        Ok(Self { kind, data: Gramian::new(unknowns, forgetting) })
    }

    /// The factor of the process noise, as a multiple of the settings'.
    pub(crate) fn factor(&self) -> f64 {
        match &self.kind {
            Kind::Adaptive(squares) => squares.factor(),
            Kind::Gradient(_) | Kind::Normalised(_) | Kind::Squares(_) | Kind::Mixed(_) => 1.0,
        }
    }

    /// The information of the data on each component of the unknown.
    pub(crate) fn component_information(&self) -> ComponentInformation {
        self.data.component_information()
    }
}

impl<const N: usize> Clone for Kind<N> {
    fn clone(&self) -> Self {
        match self {
            Self::Gradient(gradient) => Self::Gradient(*gradient),
            Self::Normalised(gradient) => Self::Normalised(*gradient),
            Self::Squares(squares) => Self::Squares(*squares),
            Self::Adaptive(squares) => Self::Adaptive(*squares),
            Self::Mixed(mixed) => Self::Mixed(mixed.boxed()),
        }
    }
}

impl<const N: usize> Kind<N> {
    fn face(&self) -> &dyn DynEstimator<N> {
        match self {
            Self::Gradient(gradient) => gradient,
            Self::Normalised(gradient) => gradient,
            Self::Squares(squares) => squares,
            Self::Adaptive(squares) => squares,
            Self::Mixed(mixed) => &**mixed,
        }
    }

    fn face_mut(&mut self) -> &mut dyn DynEstimator<N> {
        match self {
            Self::Gradient(gradient) => gradient,
            Self::Normalised(gradient) => gradient,
            Self::Squares(squares) => squares,
            Self::Adaptive(squares) => squares,
            Self::Mixed(mixed) => &mut **mixed,
        }
    }
}

impl<const N: usize> Uncertain<f64, N> for PaddedEstimator<N> {
    fn covariance_root(&self, dt: f64) -> Option<SMatrix<f64, N, N>> {
        match &self.kind {
            Kind::Squares(squares) => squares.covariance_root(dt),
            Kind::Adaptive(squares) => squares.covariance_root(dt),
            Kind::Gradient(_) | Kind::Normalised(_) | Kind::Mixed(_) => None,
        }
    }
}

impl<const N: usize> Estimator<f64, N, N> for PaddedEstimator<N> {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        self.data.add(regressor, dt);
        self.kind.face_mut().advance(regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        self.kind.face().estimate()
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.kind.face_mut().shift(shift);
    }

    fn information(&self) -> Option<&Information<f64, N>> {
        match &self.kind {
            Kind::Squares(squares) => Estimator::<f64, N, N>::information(squares),
            Kind::Adaptive(squares) => Estimator::<f64, N, N>::information(squares),
            Kind::Gradient(_) | Kind::Normalised(_) | Kind::Mixed(_) => None,
        }
    }

    fn turn(&mut self, turn: &Turn<f64, N>) {
        self.data.turn(turn);
        self.kind.face_mut().turn(turn);
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        self.data.reset();
        self.kind.face_mut().reset(estimate);
    }

    fn is_finite(&self) -> bool {
        self.kind.face().is_finite()
    }
}

/// Least squares with their settings; a padded unknown does not wander.
fn squares<const N: usize>(settings: &Covariance) -> Result<LeastSquares<f64, N>, Fault> {
    let Covariance { start, forgetting, process_noise } = settings;
    let squares = LeastSquares::diagonal(&padded(start, 1.0), *forgetting)?;
    match process_noise {
        Some(noise) => squares.with_process_noise(&pad(noise)),
        None => Ok(squares),
    }
}

/// An estimator as a trait object.
pub(crate) trait DynEstimator<const N: usize>: fmt::Debug {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault>;
    fn estimate(&self) -> SVector<f64, N>;
    fn shift(&mut self, shift: &SVector<f64, N>);
    fn turn(&mut self, turn: &Turn<f64, N>);
    fn reset(&mut self, estimate: &SVector<f64, N>);
    fn is_finite(&self) -> bool;
    fn boxed(&self) -> Box<dyn DynEstimator<N>>;
}

impl<E: Estimator<f64, N, N> + fmt::Debug + 'static, const N: usize> DynEstimator<N> for E {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        Estimator::advance(self, regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        Estimator::estimate(self)
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        Estimator::shift(self, shift);
    }

    fn turn(&mut self, turn: &Turn<f64, N>) {
        Estimator::turn(self, turn);
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        Estimator::reset(self, estimate);
    }

    fn is_finite(&self) -> bool {
        Estimator::is_finite(self)
    }

    fn boxed(&self) -> Box<dyn DynEstimator<N>> {
        Box::new(self.clone())
    }
}

/// DREM of as many unknowns as there are gains.
fn mixed<const N: usize>(gain: &[f64], extension: &Extension) -> Result<Box<dyn DynEstimator<N>>, Fault> {
    // Padding has no error to lose, and with the largest gain a finite-time estimator never waits for it.
    let gains = padded(gain, gain.iter().copied().fold(f64::MIN_POSITIVE, f64::max));
    let all = |values: &[f64]| -> SVector<f64, MOST_MIXED> { padded(values, 1.0) };
    let (extension, finite_time): (Box<dyn DynExtension>, _) = match extension {
        Extension::Kreisselmeier { gain, forgetting, finite_time } => {
            (Box::new(Kreisselmeier::new(&all(gain), *forgetting)?), finite_time.as_ref())
        }
        Extension::Gradient(gain) => (Box::new(response(Gradient::diagonal(&all(gain))?)?), None),
        Extension::LeastSquares(Covariance { start, forgetting, .. }) => {
            (Box::new(response(LeastSquares::diagonal(&all(start), *forgetting)?)?), None)
        }
    };
    let drem = Drem::new(CompletedExtension { extension, unknowns: gain.len() }, &gains)?;
    Ok(match finite_time {
        None => Box::new(PaddedDrem(drem)),
        Some(setup::FiniteTime { clip, period: None }) => Box::new(PaddedDrem(FiniteTime::once(drem, *clip)?)),
        Some(setup::FiniteTime { clip, period: Some(period) }) => {
            Box::new(PaddedDrem(FiniteTime::tracking(drem, *clip, *period)?))
        }
    })
}

fn response<E>(estimator: E) -> Result<Response<f64, E, LARGEST, MOST_MIXED>, Fault>
where
    E: Estimator<f64, LARGEST, MOST_MIXED> + Copy,
{
    Response::new(estimator)
}

/// A regressor extension as a trait object.
trait DynExtension: fmt::Debug {
    fn advance(&mut self, regressor: &Rows, regressand: &SVector<f64, LARGEST>, dt: f64) -> Result<(), Fault>;
    fn matrix(&self) -> SMatrix<f64, MOST_MIXED, MOST_MIXED>;
    fn vector(&self) -> SVector<f64, MOST_MIXED>;
    fn shift(&mut self, shift: &SVector<f64, MOST_MIXED>);
    fn turn(&mut self, turn: &Turn<f64, MOST_MIXED>);
    fn reset(&mut self);
    fn is_finite(&self) -> bool;
    fn boxed(&self) -> Box<dyn DynExtension>;
}

/// The equations of DREM, padded to the largest size.
type Rows = SMatrix<f64, LARGEST, MOST_MIXED>;

impl<X: RegressorExtension<f64, LARGEST, MOST_MIXED> + fmt::Debug + 'static> DynExtension for X {
    fn advance(&mut self, regressor: &Rows, regressand: &SVector<f64, LARGEST>, dt: f64) -> Result<(), Fault> {
        RegressorExtension::advance(self, regressor, regressand, dt)
    }

    fn matrix(&self) -> SMatrix<f64, MOST_MIXED, MOST_MIXED> {
        RegressorExtension::matrix(self)
    }

    fn vector(&self) -> SVector<f64, MOST_MIXED> {
        RegressorExtension::vector(self)
    }

    fn shift(&mut self, shift: &SVector<f64, MOST_MIXED>) {
        RegressorExtension::shift(self, shift);
    }

    fn turn(&mut self, turn: &Turn<f64, MOST_MIXED>) {
        RegressorExtension::turn(self, turn);
    }

    fn reset(&mut self) {
        RegressorExtension::reset(self);
    }

    fn is_finite(&self) -> bool {
        RegressorExtension::is_finite(self)
    }

    fn boxed(&self) -> Box<dyn DynExtension> {
        Box::new(self.clone())
    }
}

/// An extension of a padded regression, with the identity for the padding.
#[derive(Debug)]
struct CompletedExtension {
    extension: Box<dyn DynExtension>,
    unknowns: usize,
}

impl Clone for CompletedExtension {
    fn clone(&self) -> Self {
        Self { extension: self.extension.boxed(), unknowns: self.unknowns }
    }
}

impl RegressorExtension<f64, LARGEST, MOST_MIXED> for CompletedExtension {
    fn advance(&mut self, regressor: &Rows, regressand: &SVector<f64, LARGEST>, dt: f64) -> Result<(), Fault> {
        self.extension.advance(regressor, regressand, dt)
    }

    fn matrix(&self) -> SMatrix<f64, MOST_MIXED, MOST_MIXED> {
        let mut matrix = self.extension.matrix();
        (self.unknowns..MOST_MIXED).for_each(|padding| matrix[(padding, padding)] = 1.0);
        matrix
    }

    fn vector(&self) -> SVector<f64, MOST_MIXED> {
        self.extension.vector()
    }

    fn shift(&mut self, shift: &SVector<f64, MOST_MIXED>) {
        self.extension.shift(shift);
    }

    fn turn(&mut self, turn: &Turn<f64, MOST_MIXED>) {
        self.extension.turn(turn);
    }

    fn reset(&mut self) {
        self.extension.reset();
    }

    fn is_finite(&self) -> bool {
        self.extension.is_finite()
    }
}

/// DREM in a padded model. It takes the first unknowns, up to its own size; its equations are padded to the largest
/// size.
#[derive(Clone, Debug)]
struct PaddedDrem<E>(E);

impl<E: Estimator<f64, LARGEST, MOST_MIXED>, const N: usize> Estimator<f64, N, N> for PaddedDrem<E> {
    fn advance(&mut self, regressor: &SMatrix<f64, N, N>, regressand: &SVector<f64, N>, dt: f64) -> Result<(), Fault> {
        let mut rows = Rows::zeros();
        for (mut wide, column) in rows.column_iter_mut().zip(regressor.column_iter()) {
            wide.rows_mut(0, N).copy_from(&column);
        }
        self.0.advance(&rows, &resized(regressand), dt)
    }

    fn estimate(&self) -> SVector<f64, N> {
        resized(&self.0.estimate())
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.0.shift(&resized(shift));
    }

    fn turn(&mut self, turn: &Turn<f64, N>) {
        // The difference of the sizes is padding, which no turn mixes with the unknowns.
        self.0.turn(&turn.leading());
    }

    fn reset(&mut self, estimate: &SVector<f64, N>) {
        self.0.reset(&resized(estimate));
    }

    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
}
