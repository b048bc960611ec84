//! The runtime library's observer of any size.
//!
//! The runtime's sizes are constants and a model's are not, so the model is padded with zeros to one of a few sizes;
//! zero rows and columns change no estimate. The code is that of the target, except for the functions of the model.

use std::fmt;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Bounded, Fault, Fundamental, Gate, Innovation, Integrator, Late, LateObserver, Limits, Model, Observer, Outcome,
    RegressionOperator, Uncertain, Within, unwrapped,
};

use crate::settings::Prediction;
use pebo_design::analysis::RegressionKind;
use pebo_design::plant::settings::PATIENCE;

use super::design::Design;
use super::estimator::PaddedEstimator;
use super::excitation::ComponentInformation;
use super::interpreted::{Derived, Dynamic, ReadableExtension, RegressionType, Static};
use super::operator::PaddedOperator;
use super::setup::{self, Covariance, Estimator, Operator, Rebase};
use super::sizes::{LARGEST, MOST_MIXED, SMALL, pad, padded};
use super::uncertainty::{Interval, Learned, NoiseModel, Surprise, Uncertainty};

/// An observer of any size.
pub(crate) trait DynObserver: fmt::Debug {
    /// Takes the outputs at the end of an interval of `dt` seconds and the inputs during it; writes the estimates. An
    /// output that is missing is NaN, where [`admits_partial`](Self::admits_partial). False if the sample was taken and
    /// there are no estimates: the left inverse has no value.
    fn sample(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<bool, Fault>;

    /// True if a sample may lack outputs.
    fn admits_partial(&self) -> bool;

    /// The standard errors of the estimates, `age` seconds after the last sample; none where they are not known.
    fn standard_errors(&self, age: f64) -> Option<Vec<f64>>;

    /// The number of restarts after gaps that were too long.
    fn restarts(&self) -> u64;

    /// What a sample says of the observer's numbers.
    fn judge(&self, y: &[f64], u: &[f64], dt: f64) -> Option<Judgement>;

    /// The information of the data so far on each component of the unknown.
    fn component_information(&self) -> ComponentInformation;

    /// The coordinates z for a value of theta with the present extension.
    #[cfg(test)]
    fn coordinates(&self, theta: &[f64]) -> Vec<f64>;
}

/// What a sample says of an observer's numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judgement {
    /// The normalised square of its innovation, divided by the number of rows.
    pub(crate) square: f64,
    /// The logarithm of its likelihood, but for a constant of the number of rows.
    pub(crate) likelihood: f64,
}

/// The observer of a design, of the smallest size that has room for it: a step costs the square of the size, or its
/// cube.
pub(crate) fn observer(design: &Design) -> Result<Box<dyn DynObserver>, Fault> {
    const FEW: usize = SMALL[0];
    const SOME: usize = SMALL[1];
    let size = design.size();
    if size <= FEW {
        of_size::<FEW>(design)
    } else if size <= SOME {
        of_size::<SOME>(design)
    } else if size <= MOST_MIXED {
        of_size::<MOST_MIXED>(design)
    } else {
        of_size::<LARGEST>(design)
    }
}

fn of_size<const N: usize>(design: &Design) -> Result<Box<dyn DynObserver>, Fault> {
    if design.settings.output {
        return Ok(Box::new(PaddedObserver::<Fundamental<f64, N>, Static, N>::new(design)?));
    }
    Ok(match (design.is_generalised, design.kind == RegressionKind::Static) {
        (false, false) => Box::new(PaddedObserver::<Integrator<f64, N>, Dynamic, N>::new(design)?),
        (false, true) => Box::new(PaddedObserver::<Integrator<f64, N>, Static, N>::new(design)?),
        (true, false) => Box::new(PaddedObserver::<Fundamental<f64, N>, Dynamic, N>::new(design)?),
        (true, true) => Box::new(PaddedObserver::<Fundamental<f64, N>, Static, N>::new(design)?),
    })
}

type PaddedModel<X, K, const N: usize> = Within<Derived<X, K, N>, f64, N>;

type BoundedEstimator<const N: usize> = Bounded<f64, PaddedEstimator<N>, N>;

type Inner<X, K, const N: usize> =
    Observer<PaddedModel<X, K, N>, BoundedEstimator<N>, N, N, N, N, N, N, PaddedOperator<N>>;

/// The samples that may be on their way: the most that settings ask for. More room changes no estimate.
pub(crate) const ON_THEIR_WAY: usize = 1024;

type Delayed<X, K, const N: usize> =
    LateObserver<PaddedModel<X, K, N>, BoundedEstimator<N>, N, N, N, N, N, N, PaddedOperator<N>, ON_THEIR_WAY>;

/// The runtime's observer at size N, with samples on time or late.
#[allow(clippy::large_enum_variant, reason = "one of a run, and the smaller variant is the usual one")]
enum Running<X: ReadableExtension<N>, K: RegressionType, const N: usize> {
    OnTime(Inner<X, K, N>),
    Late(Box<Delayed<X, K, N>>),
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> Running<X, K, N> {
    fn new(observer: Inner<X, K, N>, design: &Design) -> Result<Self, Fault> {
        let Some(late) = &design.settings.late else { return Ok(Self::OnTime(observer)) };
        let mut rows = [usize::MAX; N];
        rows.iter_mut().zip(&late.rows).for_each(|(row, output)| *row = *output);
        let mut is_expected = [false; N];
        is_expected.iter_mut().zip(&late.is_expected).for_each(|(padded, expected)| *padded = *expected);
        let late = Late { delays: pad(&late.delays), rows, is_expected };
        Ok(Self::Late(Box::new(LateObserver::new(observer, late)?)))
    }

    /// The observer at the present, or before its first sample.
    fn now(&self) -> &Inner<X, K, N> {
        match self {
            Self::OnTime(observer) => observer,
            Self::Late(late) => late.now().unwrap_or(late.past()),
        }
    }

    /// A step; with `parted`, outputs that have these rows may be missing. None where the state has no value, and the
    /// sample is taken all the same.
    fn step(
        &mut self,
        y: &[f64],
        parted: Option<[usize; N]>,
        u: &[f64],
        dt: f64,
    ) -> Result<Option<SVector<f64, N>>, Fault> {
        let taken = match (&mut *self, parted) {
            (Self::OnTime(observer), Some(rows)) => observer.step_partly(pad(y), &rows, pad(u), dt),
            (Self::OnTime(observer), None) => observer.step(pad(y), pad(u), dt),
            (Self::Late(late), Some(_)) => late.step_partly(pad(y), pad(u), dt),
            (Self::Late(late), None) => late.step(pad(y), pad(u), dt),
        };
        match (self, taken) {
            (Self::OnTime(observer), Err(Fault::Estimate)) if parted.is_none() && observer.terms().is_some() => {
                observer.learn(pad(y), pad(u), dt).map(|()| None)
            }
            (_, taken) => taken.map(Some),
        }
    }

    /// That of a sample that lacks outputs is known of an observer that waits for none.
    fn innovation(
        &self,
        y: &[f64],
        parted: Option<[usize; N]>,
        u: &[f64],
        dt: f64,
    ) -> Result<Innovation<f64, N>, Fault> {
        match (self, parted) {
            (Self::OnTime(observer), None) => observer.innovation(pad(y), pad(u), dt),
            (Self::OnTime(observer), Some(rows)) => observer.innovation_partly(pad(y), &rows, pad(u), dt),
            (Self::Late(late), _) => late.innovation(pad(y), pad(u), dt),
        }
    }

    fn restart(&mut self, chi_0: SVector<f64, N>) -> Result<(), Fault> {
        match self {
            Self::OnTime(observer) => observer.restart(chi_0, &SVector::zeros()),
            Self::Late(late) => late.restart(chi_0, &SVector::zeros()),
        }
    }
}

/// The runtime's observer with what it is asked for in a run.
struct PaddedObserver<X: ReadableExtension<N>, K: RegressionType, const N: usize> {
    observer: Running<X, K, N>,
    /// Refuses outliers.
    gate: Option<Gate<f64>>,
    /// Refuses samples out of range, and finds gaps that are too long.
    limits: Option<Limits<f64, N, N>>,
    /// The extension at the start.
    chi_0: SVector<f64, N>,
    /// The number of restarts.
    restarts: u64,
    /// Seconds since the last sample with outputs.
    waited: f64,
    /// The index of each row's output, where rows may be left out.
    rows: Option<[usize; N]>,
    /// The recovered states, and the rows of the regression.
    sizes: (usize, usize),
    /// True if errors are predicted from the known numbers of the sensors.
    is_certain: bool,
    /// The covariance of the errors, where the noise of a sample is not only in its row.
    uncertainty: Option<Uncertainty<N>>,
    /// The standard deviations of the rows of samples.
    weights: Vec<f64>,
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> PaddedObserver<X, K, N> {
    fn new(design: &Design) -> Result<Self, Fault> {
        let settings = &design.settings;
        let [lower, upper] = settings.bounds.each_ref().map(|bounds| pad(bounds));
        let estimator = Bounded::new(PaddedEstimator::new(&settings.estimator, design.estimated())?, &lower, &upper)?;
        let passage = PaddedOperator::new(settings)?;
        let [lower, upper] = settings.within.each_ref().map(|bounds| pad(bounds));
        let model = Within::new(Derived::new(design), &lower, &upper)?;
        let observer = Observer::with_regression(model, estimator, passage, pad(&settings.chi_0))?;
        let observer = match &settings.errors_in_variables {
            Some(sensors) => observer.with_errors_in_variables(&pad(sensors))?,
            None => observer,
        };
        // With the inputs of an instant beside those of an interval, a sample holds the input that comes after it.
        let observer = match &settings.feedthrough {
            Some(outputs) if !design.with_instant => {
                let mut padded = [None; N];
                padded.iter_mut().zip(outputs).for_each(|(padded, output)| *padded = *output);
                observer.with_feedthrough(padded)?
            }
            _ => observer,
        };
        let rows = design.partial.as_ref().map(|outputs| {
            let mut rows = [usize::MAX; N];
            rows.iter_mut().zip(outputs).for_each(|(row, output)| *row = *output);
            rows
        });
        let observer = match settings.rebase {
            Some(Rebase::Samples(every)) => observer.rebasing(every)?,
            Some(Rebase::Drift(form)) => observer.without_drift(form)?,
            None => observer,
        };
        Ok(Self {
            observer: Running::new(observer, design)?,
            gate: settings.gate.map(|limit| Gate::new(limit, PATIENCE)).transpose()?,
            limits: settings.limits.as_ref().map(limits).transpose()?,
            chi_0: pad(&settings.chi_0),
            restarts: 0,
            waited: 0.0,
            rows,
            sizes: (design.recovered.len(), design.equations),
            is_certain: design.predicts(),
            uncertainty: noise_model(design).map(|noise| Uncertainty::new(&noise)),
            weights: match &settings.operator {
                Operator::Sampled(deviations) => deviations.clone(),
                Operator::Filter(_) | Operator::Window(_) => Vec::new(),
            },
        })
    }

    /// The rows of a sample that lacks outputs, where it may.
    fn parted(&self, y: &[f64]) -> Option<[usize; N]> {
        self.rows.filter(|_| y.iter().any(|output| output.is_nan()))
    }

    /// The estimate of z with the present extension.
    fn coordinates_now(&self) -> SVector<f64, N> {
        let now = self.observer.now();
        now.extension().coordinates(&now.theta())
    }

    /// The same of the estimator, which takes unknowns that depend on one another for independent.
    fn independent_now(&self) -> SVector<f64, N> {
        let now = self.observer.now();
        now.extension().coordinates(&now.model().theta(&pebo_runtime::Estimator::estimate(now.estimator())))
    }

    /// The map from an error of the one to an error of the other, where they differ.
    fn projection_now(&self) -> Option<SMatrix<f64, N, N>> {
        let now = self.observer.now();
        let (_, map) = now.extension().parts();
        Some(map * now.projection()? * map.try_inverse()?)
    }

    /// True where no sample of a late output has become whole: that is no innovation.
    fn is_pending(&self, innovation: &Innovation<f64, N>) -> bool {
        matches!(self.observer, Running::Late(_)) && innovation.value.iter().all(|value| *value == 0.0)
    }

    /// Propagates the covariance over a step.
    fn follow(&mut self, before: Option<(SVector<f64, N>, SVector<f64, N>)>, y: &[f64], u: &[f64], dt: f64) {
        let observer = self.observer.now();
        let (Some(uncertainty), Some(after)) = (&mut self.uncertainty, observer.terms()) else { return };
        let (model, u) = (observer.model(), pad(u));
        let (_, map) = observer.extension().parts();
        let Some((before, z)) = before else {
            let rows: SMatrix<f64, N, N> = RegressionOperator::regressor(observer.regression());
            let root = observer.estimator().covariance_root(0.0).filter(|_| rows.amax() > 0.0);
            let z = &observer.extension().coordinates(&observer.theta());
            let root = root.map(|root| map * root);
            let shares = &shares(observer, (after, &u), dt * Inner::<X, K, N>::INSTANT);
            return uncertainty.begin(model, (after, &u), root.as_ref().map(|root| Learned { root, z, shares }));
        };
        let shares = &shares(observer, (after, &u), dt);
        let taken = observer.estimator().covariance_root(0.0).is_some_and(|root| {
            let missing: Vec<bool> = y.iter().map(|output| output.is_nan()).collect();
            let interval = Interval { before: &before, after, u: &u, dt, z };
            let factor = observer.estimator().estimator().factor();
            let learned = Learned { root: &(map * root), z: &z, shares };
            uncertainty.take(model, &interval, (learned, factor), &missing).is_ok()
        });
        if !taken {
            uncertainty.reset();
        }
    }
}

/// What each row of the last sample was multiplied by, so that it has the weight of its sensors there.
fn shares<X: ReadableExtension<N>, K: RegressionType, const N: usize>(
    observer: &Inner<X, K, N>,
    (y, u): (&SVector<f64, N>, &SVector<f64, N>),
    dt: f64,
) -> SVector<f64, N> {
    let taken: SMatrix<f64, N, N> = RegressionOperator::regressor(observer.regression());
    let plain = observer.model().regression(observer.extension(), y, u);
    let plain = RegressionOperator::step(observer.regression(), [&plain; 2], dt);
    let plain: SMatrix<f64, N, N> = Outcome::regressor(&plain);
    SVector::from_fn(|row, _| {
        let share = taken.row(row).norm() / plain.row(row).norm();
        if share.is_finite() && share > 0.0 { share } else { 1.0 }
    })
}

/// The noise model of a design, where the noise of a sample is not only in its row.
fn noise_model(design: &Design) -> Option<NoiseModel> {
    let settings = &design.settings;
    let (Some(Prediction::Noise(noise)), Operator::Sampled(weights)) = (&settings.prediction, &settings.operator)
    else {
        return None;
    };
    let (Estimator::LeastSquares(Covariance { start, .. })
    | Estimator::AdaptiveLeastSquares(Covariance { start, .. }, _)) = &settings.estimator
    else {
        return None;
    };
    Some(NoiseModel {
        sensors: noise.sensors.clone(),
        weights: weights.clone(),
        start: start.clone(),
        drift: noise.drift.clone(),
        rows: if settings.output { design.rates() } else { 0 },
        measured: design.partial.clone().unwrap_or_default(),
    })
}

/// The limits of a run in the runtime's type.
fn limits<const N: usize>(known: &setup::Limits) -> Result<Limits<f64, N, N>, Fault> {
    let side = |each: &[Option<[f64; 2]>], side: usize, other: f64| {
        let values: Vec<f64> = each.iter().map(|limit| limit.map_or(other, |limit| limit[side])).collect();
        padded::<N>(&values, other)
    };
    let least = |each: &[Option<[f64; 2]>]| side(each, 0, f64::NEG_INFINITY);
    let most = |each: &[Option<[f64; 2]>]| side(each, 1, f64::INFINITY);
    let limits = Limits::none()
        .outputs(&least(&known.outputs), &most(&known.outputs))?
        .inputs(&least(&known.inputs), &most(&known.inputs))?;
    match known.gap {
        Some(longest) => limits.gap(longest),
        None => Ok(limits),
    }
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> fmt::Debug for PaddedObserver<X, K, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Padded").field(self.observer.now().model()).finish()
    }
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> DynObserver for PaddedObserver<X, K, N> {
    fn sample(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<bool, Fault> {
        if let Some(limits) = &self.limits {
            // A missing output is in no range: it is left out, or refused for that.
            let present = y.iter().map(|output| if output.is_nan() { 0.0 } else { *output }).collect::<Vec<_>>();
            match limits.check(&pad(&present), &pad(u), self.waited + dt) {
                Err(Fault::Gap) => {
                    self.observer.restart(self.chi_0)?;
                    self.restarts += 1;
                    self.uncertainty.iter_mut().for_each(Uncertainty::reset);
                }
                Err(Fault::OutputRange { index }) if y[index].is_nan() => {}
                checked => checked?,
            }
        }
        let parted = self.parted(y);
        let waits = matches!(self.observer, Running::Late(_)) && parted.is_some();
        if let Some(gate) = self.gate.as_mut().filter(|_| !waits) {
            gate.admit(&self.observer.innovation(y, parted, u, dt)?)?;
        }
        let estimate = if self.uncertainty.is_some() {
            let before = self.observer.now().terms_with(&pad(u)).map(|before| (before, self.independent_now()));
            let estimate = self.observer.step(y, parted, u, dt)?;
            self.follow(before, y, u, dt);
            estimate
        } else {
            self.observer.step(y, parted, u, dt)?
        };
        self.waited = if y.iter().all(|output| output.is_nan()) { self.waited + dt } else { 0.0 };
        if let Some(estimate) = &estimate {
            hat.copy_from_slice(&estimate.as_slice()[..hat.len()]);
        }
        Ok(estimate.is_some())
    }

    fn admits_partial(&self) -> bool {
        self.rows.is_some()
    }

    fn standard_errors(&self, age: f64) -> Option<Vec<f64>> {
        let errors = match &self.uncertainty {
            Some(uncertainty) => {
                let now = self.observer.now();
                let (at, through) = ((&self.coordinates_now(), now.terms()?), self.projection_now());
                uncertainty.of(at, through.as_ref(), age, |z, y| now.model().recover_unbounded(z, y))?
            }
            None => self.is_certain.then(|| self.observer.now().standard_error_after(age))??,
        };
        Some(errors.as_slice()[..self.sizes.0].to_vec())
    }

    fn judge(&self, y: &[f64], u: &[f64], dt: f64) -> Option<Judgement> {
        let parted = self.parted(y);
        // With the noise of samples elsewhere, that of a sample which lacks outputs is not predicted.
        let is_known = self.is_certain && (parted.is_none() || self.uncertainty.is_none());
        let innovation = is_known.then(|| self.observer.innovation(y, parted, u, dt).ok())??;
        let is_present =
            |row: &usize| parted.is_none_or(|rows| y.get(rows[*row]).is_none_or(|output| !output.is_nan()));
        let present: Vec<usize> = (0..self.sizes.1).filter(is_present).collect();
        let now = self.observer.now();
        if self.is_pending(&innovation) {
            return None;
        }
        let with_noise_elsewhere =
            self.uncertainty.as_ref().zip(now.terms_with(&pad(u))).and_then(|(uncertainty, before)| {
                let (sample, periods): (SVector<f64, N>, _) = (pad(y), now.model().periods());
                let after = &SVector::from_fn(|i, _| unwrapped(sample[i], before[i], periods[i]));
                let interval = Interval { before: &before, after, u: &pad(u), dt, z: self.independent_now() };
                uncertainty.surprise(now.model(), &interval, self.sizes.1)
            });
        // A sample so far off that its covariance is beyond a double's range stands out by its row alone.
        let own = Surprise { square: innovation.normalised_square, determinant: innovation.determinant };
        let Surprise { square, determinant } = with_noise_elsewhere.unwrap_or(own);
        let weights = present.iter().filter_map(|row| self.weights.get(*row));
        let likelihood = -0.5 * (square + determinant.ln()) - weights.map(|weight| weight.ln()).sum::<f64>();
        let count = crate::timing::real(u64::try_from(present.len()).ok()?);
        (!present.is_empty()).then(|| Judgement { square: square / count, likelihood })
    }

    fn restarts(&self) -> u64 {
        self.restarts
    }

    fn component_information(&self) -> ComponentInformation {
        self.observer.now().estimator().estimator().component_information()
    }

    #[cfg(test)]
    fn coordinates(&self, theta: &[f64]) -> Vec<f64> {
        self.observer.now().extension().coordinates(&pad(theta)).as_slice()[..theta.len()].to_vec()
    }
}
