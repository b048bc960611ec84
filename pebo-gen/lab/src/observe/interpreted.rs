//! The runtime library's observer on a derived model that is interpreted.
//!
//! The runtime's sizes are constants and a model's are not, so the model is padded with zeros to one of a few sizes;
//! zero rows and columns change no estimate. The code is that of the target, except for the functions of the model.

use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Bounded, Extension, Fault, Flow, Functions, Fundamental, Gate, Integrator, Limits, Model, Observer, OutputSlopes,
    Regression, Sides, Uncertain, Within,
};

use crate::settings::Prediction;
use pebo_design::plant::settings::PATIENCE;
use pebo_design::program::{Interpreter, Program};

use super::design::Design;
use super::excitation::ComponentInformation;
use super::monitored::MonitoredEstimator;
use super::operator::PaddedOperator;
use super::setup::{self, Covariance, Estimator, Operator, Rebase};
use super::sizes::{LARGEST, MOST_MIXED, SMALL, pad, padded};
use super::uncertainty::{Interval, NoiseModel, Surprise, Uncertainty};

/// An observer of any size.
pub(crate) trait DynObserver: fmt::Debug {
    /// Takes the outputs at the end of an interval of `dt` seconds and the inputs during it; writes the estimates. An
    /// output that is missing is NaN, where [`admits_partial`](Self::admits_partial).
    fn sample(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<(), Fault>;

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
    Ok(match (design.is_generalised, design.is_static) {
        (false, false) => Box::new(PaddedObserver::<Integrator<f64, N>, Dynamic, N>::new(design)?),
        (false, true) => Box::new(PaddedObserver::<Integrator<f64, N>, Static, N>::new(design)?),
        (true, false) => Box::new(PaddedObserver::<Fundamental<f64, N>, Dynamic, N>::new(design)?),
        (true, true) => Box::new(PaddedObserver::<Fundamental<f64, N>, Static, N>::new(design)?),
    })
}

/// The kind of a regression, as a type.
trait RegressionType: fmt::Debug + 'static {
    const REGRESSION: Regression;
}

#[derive(Debug)]
struct Dynamic;
#[derive(Debug)]
struct Static;

impl RegressionType for Dynamic {
    const REGRESSION: Regression = Regression::Dynamic;
}

impl RegressionType for Static {
    const REGRESSION: Regression = Regression::Static;
}

/// An extension whose numbers the regression can read.
trait ReadableExtension<const N: usize>: Extension<f64, N> + 'static {
    /// A number of an extension of `n` coordinates: one of these, or after them of its fundamental matrix by rows.
    fn value(&self, n: usize, place: usize) -> f64;

    /// The offset of z, and the factor of theta.
    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>);

    /// The extension with a matrix before theta; of one without a fundamental matrix, which no output form has, itself.
    fn mapped(&self, map: &SMatrix<f64, N, N>) -> Self;
}

impl<const N: usize> ReadableExtension<N> for Integrator<f64, N> {
    fn value(&self, _: usize, place: usize) -> f64 {
        self.chi()[place]
    }

    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        (*self.chi(), SMatrix::identity())
    }

    fn mapped(&self, _: &SMatrix<f64, N, N>) -> Self {
        *self
    }
}

impl<const N: usize> ReadableExtension<N> for Fundamental<f64, N> {
    fn value(&self, n: usize, place: usize) -> f64 {
        if place < n { self.xi()[place] } else { self.psi()[((place - n) / n, (place - n) % n)] }
    }

    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        (*self.xi(), *self.psi())
    }

    fn mapped(&self, map: &SMatrix<f64, N, N>) -> Self {
        Fundamental::mapped(self, map)
    }
}

/// The model of a design. The trait's methods take `&self`, but an interpreter needs its table mutable: hence the
/// cells.
#[derive(Debug)]
struct Derived<X, K, const N: usize> {
    ny: usize,
    inputs: usize,
    nz: usize,
    nr: usize,
    ne: usize,
    /// The numbers of the extension that the functions read.
    known: usize,
    rows: Vec<usize>,
    periods: SVector<f64, N>,
    cascade: RefCell<Interpreter>,
    regression: RefCell<Interpreter>,
    primitive: Option<RefCell<Interpreter>>,
    slopes: Option<RefCell<Interpreter>>,
    theta: RefCell<Interpreter>,
    functions: Option<RefCell<Interpreter>>,
    phi_left: RefCell<Interpreter>,
    /// In the output form: the rows of the regression with a rate, and the model's own extension, which its functions read at its
    /// start. That of the output form is another.
    output: Option<(usize, X)>,
    /// In the output form: the indices of the outputs whose expected values estimates are made of.
    expected: Option<Vec<usize>>,
    kind: PhantomData<(X, K)>,
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> Derived<X, K, N> {
    fn new(design: &Design) -> Self {
        let nz = design.coordinates;
        Self {
            expected: design.settings.expected.clone(),
            output: design.settings.output.then(|| (design.rates(), X::new(SVector::zeros()))),
            known: if design.is_generalised { nz + nz * nz } else { nz },
            ny: design.outputs,
            inputs: design.inputs,
            nz: design.coordinates,
            nr: design.equations,
            ne: design.unknowns,
            rows: design.rows.clone(),
            periods: pad(&design.periods),
            cascade: interpreter(&design.cascade),
            regression: interpreter(&design.regression),
            primitive: design.primitive.as_ref().map(interpreter),
            slopes: design.slopes.as_ref().map(interpreter),
            theta: interpreter(&design.theta),
            functions: design.functions.as_ref().map(interpreter),
            phi_left: interpreter(&design.phi_left),
            kind: PhantomData,
        }
    }

    /// The cascade of the model itself.
    fn cascade(&self, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Flow<f64, N> {
        let mut cascade = self.cascade.borrow_mut();
        let mut values = cascade.evaluate(|place| if place < self.ny { y[place] } else { u[place - self.ny] });
        let h = column(&mut values, self.nz);
        Flow { lambda: rows(&mut values, self.nz), h }
    }

    /// The sides of the model's own regression; in the output form, functions of z.
    fn sides(&self, extension: &X, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Sides<f64, N, N> {
        self.both(&mut self.regression.borrow_mut(), extension, y, u)
    }

    /// Both sides of equations by a program: the known side, then the factor by rows.
    fn both(
        &self,
        function: &mut Interpreter,
        extension: &X,
        y: &SVector<f64, N>,
        u: &SVector<f64, N>,
    ) -> Sides<f64, N, N> {
        let extension = self.output.as_ref().map_or(extension, |(_, start)| start);
        let mut values = function.evaluate(|place| match place.checked_sub(self.known) {
            None => extension.value(self.nz, place),
            Some(place) if place < self.ny => y[place],
            Some(place) => u[place - self.ny],
        });
        let known = column(&mut values, self.nr);
        Sides { known, factor: rows(&mut values, self.ne) }
    }
}

fn interpreter(program: &Program) -> RefCell<Interpreter> {
    RefCell::new(Interpreter::new(program))
}

/// The next `n` values, padded with zeros.
fn column<const N: usize>(values: &mut impl Iterator<Item = f64>, n: usize) -> SVector<f64, N> {
    let mut padded = SVector::zeros();
    for (place, value) in values.take(n).enumerate() {
        padded[place] = value;
    }
    padded
}

/// All remaining values as rows of this number of columns, padded with zeros.
fn rows<const N: usize>(values: &mut impl Iterator<Item = f64>, columns: usize) -> SMatrix<f64, N, N> {
    let mut padded = SMatrix::zeros();
    let (mut row, mut column) = (0, 0);
    for value in values {
        padded[(row, column)] = value;
        column += 1;
        if column == columns {
            (row, column) = (row + 1, 0);
        }
    }
    padded
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> Model<N, N, N, N, N, N> for Derived<X, K, N> {
    type Scalar = f64;
    type Extension = X;
    type X = SVector<Self::Scalar, N>;
    type Y = SVector<Self::Scalar, N>;
    type U = SVector<Self::Scalar, N>;
    type Terms = SVector<f64, N>;
    const REGRESSION: Regression = K::REGRESSION;

    fn periods(&self) -> SVector<f64, N> {
        self.periods
    }

    fn terms(&self, y: &SVector<f64, N>) -> SVector<f64, N> {
        *y
    }

    const LINEARISED: bool = true;

    fn flow(&self, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Flow<f64, N> {
        self.flow_near(y, u, &SVector::zeros())
    }

    fn flow_near(&self, y: &SVector<f64, N>, u: &SVector<f64, N>, z: &SVector<f64, N>) -> Flow<f64, N> {
        let inner = self.cascade(y, u);
        let Some((rows, _)) = self.output else { return inner };
        // As the runtime's `OutputForm`, whose sizes are constants.
        let start = X::new(SVector::zeros());
        let (rate, held) = (self.sides(&start, y, u), self.primitive(&start, y));
        let mut inner_z = SVector::zeros();
        (0..self.nz).for_each(|i| inner_z[i] = z[rows + i]);
        let slopes = self.output_slopes(y, u, &inner_z);
        let [known, rest] = [(rate.known, slopes.rates), (inner.h, slopes.cascade)].map(|(h, s)| h - s * held.known);
        let [factor, plain] =
            [(rate.factor, slopes.rates), (inner.lambda, slopes.cascade)].map(|(factor, s)| factor - s * held.factor);
        let (mut lambda, mut h) = (SMatrix::zeros(), SVector::zeros());
        for i in 0..rows + self.nz {
            h[i] = if i < rows { known[i] } else { rest[i - rows] };
            for j in 0..rows {
                lambda[(i, j)] = if i < rows { slopes.rates[(i, j)] } else { slopes.cascade[(i - rows, j)] };
            }
            for j in 0..self.nz {
                lambda[(i, rows + j)] = if i < rows { factor[(i, j)] } else { plain[(i - rows, j)] };
            }
        }
        Flow { lambda, h }
    }

    fn output_slopes(&self, y: &SVector<f64, N>, u: &SVector<f64, N>, z: &SVector<f64, N>) -> OutputSlopes<f64, N, N> {
        let Some(slopes) = &self.slopes else {
            return OutputSlopes { rates: SMatrix::zeros(), cascade: SMatrix::zeros() };
        };
        let mut slopes = slopes.borrow_mut();
        let inputs = self.inputs;
        let mut values = slopes.evaluate(|place| match place.checked_sub(self.ny) {
            None => y[place],
            Some(place) if place < inputs => u[place],
            Some(place) => z[place - inputs],
        });
        let rates = rows(&mut values.by_ref().take(self.nr * self.nr), self.nr);
        OutputSlopes { rates, cascade: rows(&mut values, self.nr) }
    }

    fn regression(&self, extension: &X, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Sides<f64, N, N> {
        let Some((rows, _)) = self.output else { return self.sides(extension, y, u) };
        let mut held = self.primitive(extension, y);
        if rows < self.nr {
            let instant = self.sides(extension, y, u);
            for row in rows..self.nr {
                held.known[row] = instant.known[row];
                held.factor.set_row(row, &instant.factor.row(row));
            }
        }
        let mut through = SMatrix::<f64, N, N>::zeros();
        for i in 0..self.nr {
            through[(i, i)] = if i < rows { 1.0 } else { 0.0 };
            for j in 0..self.nz {
                through[(i, rows + j)] = -held.factor[(i, j)];
            }
        }
        let (offset, map) = extension.parts();
        Sides { known: held.known - through * offset, factor: through * map }
    }

    fn primitive(&self, extension: &X, y: &SVector<f64, N>) -> Sides<f64, N, N> {
        if let Some(primitive) = &self.primitive {
            return self.both(&mut primitive.borrow_mut(), extension, y, &SVector::zeros());
        }
        let mut used = SVector::zeros();
        for (row, &output) in self.rows.iter().enumerate() {
            used[row] = y[output];
        }
        Sides { known: used, factor: SMatrix::zeros() }
    }

    fn theta(&self, eta: &SVector<f64, N>) -> SVector<f64, N> {
        if self.output.is_some() {
            return *eta;
        }
        column(&mut self.theta.borrow_mut().evaluate(|place| eta[place]), self.nz)
    }

    fn functions(&self, theta: &SVector<f64, N>) -> Option<Functions<f64, N, N>> {
        let mut functions = self.functions.as_ref()?.borrow_mut();
        let mut values = functions.evaluate(|place| theta[place]);
        let eta = column(&mut values, self.ne);
        Some(Functions { values: eta, slopes: rows(&mut values, self.nz) })
    }

    fn begin(&self, extension: &X, y: &SVector<f64, N>) -> X {
        if self.output.is_none() {
            return *extension;
        }
        let known = self.regression(extension, y, &SVector::zeros()).known;
        let rates = self.output.as_ref().map_or(0, |(rates, _)| *rates);
        let mut begun = *extension;
        begun.rebase(&SVector::from_fn(|row, _| if row < rates { -known[row] } else { 0.0 }));
        let held = self.primitive(extension, y).factor;
        let mut map = SMatrix::<f64, N, N>::identity();
        map.view_mut((0, rates), (rates, self.nz)).copy_from(&held.view((0, 0), (rates, self.nz)));
        begun.mapped(&map)
    }

    fn recover(&self, z: &SVector<f64, N>, y: &SVector<f64, N>) -> SVector<f64, N> {
        let mut y = *y;
        let first = self.output.as_ref().map_or(0, |(rows, _)| *rows);
        for (row, place) in self.expected.iter().flatten().take(first).enumerate() {
            y[*place] = z[row];
        }
        let of = |place: usize| if place < self.nz { z[first + place] } else { y[place - self.nz] };
        column(&mut self.phi_left.borrow_mut().evaluate(of), N)
    }
}

/// A design is re-based only where the condition is proved.
impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> pebo_runtime::Rebase<N, N, N, N, N>
    for Derived<X, K, N>
{
}

type Inner<X, K, const N: usize> = Observer<
    Within<Derived<X, K, N>, f64, N>,
    Bounded<f64, MonitoredEstimator<N>, N>,
    N,
    N,
    N,
    N,
    N,
    N,
    PaddedOperator<N>,
>;

/// The runtime's observer at size N.
struct PaddedObserver<X: ReadableExtension<N>, K: RegressionType, const N: usize> {
    observer: Inner<X, K, N>,
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
        let estimator =
            Bounded::new(MonitoredEstimator::new(&settings.estimator, design.estimated())?, &lower, &upper)?;
        let passage = PaddedOperator::new(settings)?;
        let [lower, upper] = settings.within.each_ref().map(|bounds| pad(bounds));
        let model = Within::new(Derived::new(design), &lower, &upper)?;
        let observer = Observer::with_regression(model, estimator, passage, pad(&settings.chi_0))?;
        let observer = match &settings.errors_in_variables {
            Some(sensors) => observer.with_errors_in_variables(&pad(sensors))?,
            None => observer,
        };
        let mut rows = [usize::MAX; N];
        rows.iter_mut().zip(&design.rows).for_each(|(row, output)| *row = *output);
        let whole = settings.output && design.primitive.is_none();
        Ok(Self {
            observer: match settings.rebase {
                Some(Rebase::Samples(every)) => observer.rebasing(every)?,
                Some(Rebase::Drift(form)) => observer.without_drift(form)?,
                None => observer,
            },
            gate: settings.gate.map(|limit| Gate::new(limit, PATIENCE)).transpose()?,
            limits: settings.limits.as_ref().map(limits).transpose()?,
            chi_0: pad(&settings.chi_0),
            restarts: 0,
            waited: 0.0,
            rows: whole.then_some(rows),
            sizes: (design.recovered.len(), design.equations),
            is_certain: design.predicts(),
            uncertainty: noise_model(design, whole).map(|noise| Uncertainty::new(&noise)),
            weights: match &settings.operator {
                Operator::Sampled(deviations) => deviations.clone(),
                Operator::Filter(_) | Operator::Window(_) => Vec::new(),
            },
        })
    }

    /// The estimate of z with the present extension.
    fn coordinates_now(&self) -> SVector<f64, N> {
        self.observer.extension().coordinates(&self.observer.theta())
    }

    /// A step of the observer; with `parted`, outputs that have these rows may be missing.
    fn step(&mut self, y: &[f64], parted: Option<[usize; N]>, u: &[f64], dt: f64) -> Result<SVector<f64, N>, Fault> {
        match parted {
            Some(rows) => self.observer.step_partly(pad(y), &rows, pad(u), dt),
            None => self.observer.step(pad(y), pad(u), dt),
        }
    }

    /// Propagates the covariance over a step.
    fn follow(&mut self, before: Option<(SVector<f64, N>, SVector<f64, N>)>, y: &[f64], u: &[f64], dt: f64) {
        let (Some(uncertainty), Some(after)) = (&mut self.uncertainty, self.observer.terms()) else { return };
        let (model, u) = (self.observer.model(), pad(u));
        let Some((before, z)) = before else { return uncertainty.begin(model, after, &u) };
        let (_, map) = self.observer.extension().parts();
        let taken = self.observer.estimator().covariance_root(0.0).is_some_and(|root| {
            let missing: Vec<bool> = y.iter().map(|output| output.is_nan()).collect();
            let interval = Interval { before: &before, after, u: &u, dt, z };
            let factor = self.observer.estimator().estimator().factor();
            uncertainty.take(model, &interval, (&(map * root), factor), &missing).is_ok()
        });
        if !taken {
            uncertainty.reset();
        }
    }
}

/// The noise model of a design, where the noise of a sample is not only in its row.
fn noise_model(design: &Design, whole: bool) -> Option<NoiseModel> {
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
        measured: if whole { design.rows.clone() } else { Vec::new() },
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
        f.debug_tuple("Padded").field(self.observer.model()).finish()
    }
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> DynObserver for PaddedObserver<X, K, N> {
    fn sample(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<(), Fault> {
        if let Some(limits) = &self.limits {
            // A missing output is in no range: it is left out, or refused for that.
            let present = y.iter().map(|output| if output.is_nan() { 0.0 } else { *output }).collect::<Vec<_>>();
            match limits.check(&pad(&present), &pad(u), self.waited + dt) {
                Err(Fault::Gap) => {
                    self.observer.restart(self.chi_0, &SVector::zeros())?;
                    self.restarts += 1;
                    self.uncertainty.iter_mut().for_each(Uncertainty::reset);
                }
                Err(Fault::OutputRange { index }) if y[index].is_nan() => {}
                checked => checked?,
            }
        }
        let parted = self.rows.filter(|_| y.iter().any(|output| output.is_nan()));
        if let (Some(gate), None) = (&mut self.gate, parted) {
            gate.admit(&self.observer.innovation(pad(y), pad(u), dt)?)?;
        }
        let estimate = if self.uncertainty.is_some() {
            let before = self.observer.terms().map(|before| (*before, self.coordinates_now()));
            let estimate = self.step(y, parted, u, dt)?;
            self.follow(before, y, u, dt);
            estimate
        } else {
            self.step(y, parted, u, dt)?
        };
        self.waited = if y.iter().all(|output| output.is_nan()) { self.waited + dt } else { 0.0 };
        hat.copy_from_slice(&estimate.as_slice()[..hat.len()]);
        Ok(())
    }

    fn admits_partial(&self) -> bool {
        self.rows.is_some()
    }

    fn standard_errors(&self, age: f64) -> Option<Vec<f64>> {
        let errors = match &self.uncertainty {
            Some(uncertainty) => {
                let at = (&self.coordinates_now(), self.observer.terms()?);
                uncertainty.of(at, age, |z, y| self.observer.model().recover_unbounded(z, y))?
            }
            None => self.is_certain.then(|| self.observer.standard_error_after(age))??,
        };
        Some(errors.as_slice()[..self.sizes.0].to_vec())
    }

    fn judge(&self, y: &[f64], u: &[f64], dt: f64) -> Option<Judgement> {
        let innovation = self.is_certain.then(|| self.observer.innovation(pad(y), pad(u), dt).ok())??;
        let Surprise { square, determinant } = match (&self.uncertainty, self.observer.terms()) {
            (Some(uncertainty), Some(before)) => {
                let (after, u) = (&pad(y), &pad(u));
                let interval = Interval { before, after, u, dt, z: self.coordinates_now() };
                uncertainty.surprise(self.observer.model(), &interval, &innovation.value, self.sizes.1)?
            }
            _ => Surprise { square: innovation.normalised_square, determinant: innovation.determinant },
        };
        let likelihood =
            -0.5 * (square + determinant.ln()) - self.weights.iter().map(|weight| weight.ln()).sum::<f64>();
        Some(Judgement { square: square / crate::timing::real(u64::try_from(self.sizes.1).ok()?), likelihood })
    }

    fn restarts(&self) -> u64 {
        self.restarts
    }

    fn component_information(&self) -> ComponentInformation {
        self.observer.estimator().estimator().component_information()
    }

    #[cfg(test)]
    fn coordinates(&self, theta: &[f64]) -> Vec<f64> {
        self.observer.extension().coordinates(&pad(theta)).as_slice()[..theta.len()].to_vec()
    }
}
