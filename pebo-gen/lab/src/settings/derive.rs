//! Derives the settings of least squares from standard deviations.
//!
//! ```text
//! P(0) = D_x phi start^2 D_x phi^T     Q = D phi disturbance^2 D phi^T + D_y z' sensors^2 D_y z'^T dt
//! ```
//!
//! of which the diagonals are taken. Samples drive the cascade where their outputs are no states of the observer: the noise
//! of their sensors is process noise too, and `D_y z'` is without the slopes that the output form has. For a regression
//! whose unknowns are functions of theta, both are carried over to these functions.

use std::collections::BTreeSet;

use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::analysis::{Derivation, OutputSlopes, Regression, RegressionKind, are_affine_in_outputs};
use pebo_design::model::{Decimal, Form, Model};
use pebo_design::plant::Plant;
use pebo_design::plant::settings::{Covariance, Estimator, Frame, Operator, Rebase, Settings};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

use super::derived::DerivedSettings;
use super::digits::rounded;
use super::feedthrough::feedthrough;
use super::kind::ObserverKind;
use super::late::late;
use super::magnitude::Deviations;
use super::point::Point;
#[cfg(feature = "simulate")]
use super::prediction::{Noise, Prediction};
use super::shown::Shown;
use super::spread::Slopes;
use super::start::beginning;
#[cfg(feature = "simulate")]
use crate::settings::words::KnownNumbers;

/// The default bandwidth of a filter, times the period of the samples: ten of them to a time constant.
pub(crate) const BANDWIDTH: f64 = 0.1;

/// The variance at the start of what is known exactly, as a share of the least of the others: zero would be no covariance.
const CERTAIN: f64 = 1e-12;

/// The points on the period of an angle at which slopes are taken: of sines and cosines, and their squares, the mean of so
/// many is that over the period.
const DIRECTIONS: u32 = 8;

/// The settings derived from known numbers.
pub(super) fn derive(
    model: &Model,
    plant: &Plant,
    derivation: &Derivation,
    shown: &Shown,
    problems: &mut Diagnostics,
) -> Option<DerivedSettings> {
    let can_rebase = derivation.can_rebase(plant);
    let kind = kind(model, plant, derivation, problems)?;
    if let Some(hold) = model.observer.hold.as_ref().filter(|_| kind != ObserverKind::Filtered) {
        problems.push(idle_hold(plant, hold.span));
        return None;
    }
    let frame = frame(model, plant, derivation, problems)?;
    let period = shown.period_beside(model);
    let formulas = Formulas::of(plant, derivation, kind, frame.gate.is_some())?;
    let known = Point::of(model, plant, shown);
    let asked = model.observer.known();
    if let Some(lacking) = known.lacks(&formulas.needed(plant)) {
        // Without known numbers in the section there is no observer either, and no complaint.
        if let Some(asked) = asked {
            problems.push(no_point(plant, asked, lacking));
        }
        return None;
    }
    let none = || vec![Rational::from(0); plant.phi.len()];
    let begun = || beginning(&known, plant, derivation).unwrap_or_else(none);
    let mut chi_0 = frame.chi_0.clone().unwrap_or_else(begun);
    let point = completed(&known, plant, &formulas, &chi_0)?;
    let deviations = Deviations::of(model, plant, &known, (shown, period), formulas.regression.is_at_estimate())?;
    let late = late((model, plant), (derivation, &formulas.regression), (kind, period), problems).ok()?;

    if period.is_none()
        && let Some(lacking) = formulas.without_period(kind, (&point, &deviations), frame.process_noise.is_some())
    {
        if let Some(asked) = asked {
            problems.push(no_period(plant, lacking.word(), asked));
        }
        return None;
    }
    let Coordinates { covariance, mut drift, sensed } =
        Coordinates::of(&formulas, &point, &deviations, &frame, period)?;
    // A guess is corrected by what the samples show; through a filter, their errors are not independent.
    let adapts = deviations.are_assumed && frame.process_noise.is_none() && kind != ObserverKind::Filtered;
    #[cfg(feature = "simulate")]
    let known = {
        let noise: Vec<f64> = drift.iter().zip(&sensed).map(|(drift, sensed)| drift + sensed).collect();
        KnownNumbers::new(plant, (model, shown), &deviations, (kind, can_rebase, adapts), [&covariance, &noise])
    };

    let rows = formulas.deviations(&point, &deviations.sensors, &covariance)?;
    let (operator, covariance, [guess, noise]) = match kind {
        ObserverKind::Output => {
            // An equation of an instant has no unknown of its own.
            let rates = rows.len() - formulas.instants;
            let first = |variances: Vec<f64>| variances.into_iter().take(rates);
            drift.splice(0..0, first(formulas.held.variances(&point, &deviations.of_outputs)?));
            let sensed = first(sensor_noise(&formulas.rates, &point, &deviations, period)?).chain(sensed).collect();
            // The outputs begin at the first sample.
            let start = rows[..rates].iter().map(|deviation| deviation.powi(2));
            let covariance: Vec<f64> = start.chain(covariance).collect();
            chi_0.splice(0..0, vec![Rational::from(0); rates]);
            (Operator::Sampled(rows), covariance, [drift.clone(), sensed])
        }
        ObserverKind::Sampled => {
            let [covariance, guess, noise] = formulas.of_unknowns(&point, [&covariance, &drift, &sensed])?;
            (Operator::Sampled(rows), covariance, [guess, noise])
        }
        ObserverKind::Filtered => {
            filtered(&rows, formulas.of_unknowns(&point, [&covariance, &drift, &sensed])?, period?)
        }
    };
    let noise = if adapts { noise } else { guess.iter().zip(noise).map(|(guess, noise)| guess + noise).collect() };
    let exact = exact(&operator, [&covariance, &noise, &guess]);
    let Some((operator, [start, process_noise, guess])) = exact else {
        problems.push(out_of_range(asked.map_or(model.name.span, |(_, span)| span)));
        return None;
    };
    let process_noise = Some(process_noise).filter(|noise| !adapts || noise.iter().any(|noise| !noise.is_zero()));
    let covariance = Covariance { start, forgetting: Rational::from(0), process_noise };
    let settings = Settings {
        operator,
        output: kind == ObserverKind::Output,
        expected: if kind == ObserverKind::Output { expected(plant, derivation) } else { None },
        errors_in_variables: formulas.errors_in_variables(plant, kind, &deviations.sensors),
        feedthrough: feedthrough(plant, derivation, (&formulas.regression, kind), late.as_ref()),
        late: late.clone(),
        straight: frame.straight,
        estimator: if adapts {
            Estimator::AdaptiveLeastSquares(covariance, guess)
        } else {
            Estimator::LeastSquares(covariance)
        },
        lower: None,
        upper: None,
        within: frame.within,
        rebase: if can_rebase { Some(frame.rebase.unwrap_or(Rebase::Samples(Rational::ONE))) } else { None },
        chi_0,
        gate: frame.gate,
        limits: None,
    };
    #[cfg(feature = "simulate")]
    let prediction = {
        let is_elsewhere = is_elsewhere(plant, derivation, &formulas, kind);
        // With late samples the gain is that of the covariance alone.
        Prediction::of(kind, is_elsewhere && late.is_none(), can_rebase, Noise { sensors: deviations.sensors, drift })
    };
    Some(DerivedSettings {
        settings,
        #[cfg(feature = "simulate")]
        known: Some(known.predicted(&prediction)),
        #[cfg(feature = "simulate")]
        prediction,
    })
}

/// True if the noise of a sample is not only in its row of the regression, but in the flow of the extension or in the
/// left inverse.
#[cfg(feature = "simulate")]
fn is_elsewhere(plant: &Plant, derivation: &Derivation, formulas: &Formulas, kind: ObserverKind) -> bool {
    let depends = |slopes: &Slopes| slopes.by.iter().any(|slope| !plant.arena.is_zero(*slope));
    let expected = if kind == ObserverKind::Output { expected(plant, derivation) } else { None };
    let is_sampled = |output: &usize| !expected.iter().flatten().any(|expected| expected == output);
    let y = (0..plant.y.len()).filter(is_sampled).map(|output| plant.y[output].symbol).collect();
    let left_inverse = derivation.left_inverse.result.as_ref();
    let recovered = left_inverse.is_some_and(|i| i.x.iter().any(|(_, formula)| plant.arena.depends_on(*formula, &y)));
    recovered || depends(&formulas.flow) || (kind == ObserverKind::Output && depends(&formulas.rates))
}

/// Variances of the coordinates.
struct Coordinates {
    /// The variances at the start.
    covariance: Vec<f64>,
    /// The variances of their drift in a second.
    drift: Vec<f64>,
    /// Those of what the noise of the sensors adds, where samples drive the cascade.
    sensed: Vec<f64>,
}

impl Coordinates {
    fn of(
        formulas: &Formulas,
        point: &Point,
        deviations: &Deviations,
        frame: &Frame<Rational>,
        period: Option<f64>,
    ) -> Option<Self> {
        let all = |written: &Vec<Rational>| written.iter().map(Rational::to_f64).collect::<Vec<_>>();
        let x_and_y = [deviations.start.as_slice(), &deviations.sensors].concat();
        let at_start = formulas.phi.wide_variances(point, &x_and_y)?;
        let drifts = [deviations.disturbance.as_slice(), &deviations.of_outputs].concat();
        let drift = mean_drift(formulas, point, &drifts)?;
        let sensed = sensor_noise(&formulas.flow, point, deviations, period)?;
        let written = frame.process_noise.as_ref().map(all);
        Some(Self {
            covariance: frame.covariance.as_ref().map_or(at_start, all),
            sensed: if written.is_some() { vec![0.0; sensed.len()] } else { sensed },
            drift: written.unwrap_or(drift),
        })
    }
}

/// The variances that the drift of the states comes to in a second: an angle goes round, and with it the direction in which
/// its drift moves z, so that the mean over its period counts.
fn mean_drift(formulas: &Formulas, point: &Point, deviations: &[f64]) -> Option<Vec<f64>> {
    let here = formulas.phi.variances(point, deviations)?;
    let turned: Vec<Vec<f64>> =
        point.turned(DIRECTIONS).iter().filter_map(|point| formulas.phi.variances(point, deviations)).collect();
    let count = turned.iter().map(|_| 1.0).sum::<f64>();
    let mean = |place: usize| turned.iter().map(|variances| variances[place]).sum::<f64>() / count;
    Some(if turned.is_empty() { here } else { (0..here.len()).map(mean).collect() })
}

/// What the samples' noise adds to rates, held for a period, as variances in a second.
fn sensor_noise(rates: &Slopes, point: &Point, deviations: &Deviations, period: Option<f64>) -> Option<Vec<f64>> {
    let added = rates.variances(point, &deviations.sensors)?;
    Some(added.into_iter().map(|variance| variance * period.unwrap_or_default()).collect())
}

/// The settings of the section beside its standard deviations.
pub(super) fn frame(
    model: &Model,
    plant: &Plant,
    derivation: &Derivation,
    problems: &mut Diagnostics,
) -> Option<Frame<Rational>> {
    let states = derivation.left_inverse.result.as_ref()?.x.len();
    let read = |number: &Decimal| Rational::from_decimal(number.text()).ok();
    Frame::resolve(&model.observer, (plant.phi.len(), states), read, problems)
}

/// The indices of the outputs whose rates are used, if they alone are under the derivative and something depends on their
/// values: states that are recovered, or rates linearised at them. Then the expected outputs serve.
fn expected(plant: &Plant, derivation: &Derivation) -> Option<Vec<usize>> {
    let regression = derivation.regression.result.as_ref()?;
    let inverse = derivation.left_inverse.result.as_ref()?;
    let cascade = derivation.cascade.result.as_ref()?;
    let y = plant.y.iter().map(|output| output.symbol).collect();
    let are_recovered = inverse.x.iter().any(|(_, formula)| plant.arena.depends_on(*formula, &y));
    let depends = || are_recovered || !are_affine_in_outputs(plant, cascade, regression);
    let mut rows = regression.outputs_with_rates(plant).filter(|_| depends())?;
    // A row of an instant expects no output of its own; its entry is that of the first in its equation.
    let instants = regression.sources.iter().skip(rows.len());
    rows.extend(instants.map(|outputs| outputs.first().copied().unwrap_or(0)));
    Some(rows)
}

/// The rates through a filter. The filtered rate of white samples has the standard deviation `alpha s`, correlated over
/// a time constant: the intensity is not too small over any time, and with it least squares have their covariances.
fn filtered(
    rows: &[f64],
    [covariance, drift, sensed]: [Vec<f64>; 3],
    period: f64,
) -> (Operator<f64>, Vec<f64>, [Vec<f64>; 2]) {
    let alpha = BANDWIDTH / period;
    let intensity = rows.iter().fold(0.0, |most: f64, s| most.max(2.0 * alpha * s * s));
    let over = |values: Vec<f64>| values.into_iter().map(|value| value / intensity).collect();
    (Operator::Filter(alpha), over(covariance), [over(drift), over(sensed)])
}

/// The kind of observer that the regression admits and the section asks for.
fn kind(model: &Model, plant: &Plant, derivation: &Derivation, problems: &mut Diagnostics) -> Option<ObserverKind> {
    let regression = derivation.regression.result.as_ref()?;
    let is_static = regression.kind == RegressionKind::Static;
    let written = model.observer.form.as_ref();
    let Some(form) = written.filter(|form| form.value == Form::Output) else {
        return Some(match written {
            _ if is_static => ObserverKind::Sampled,
            None if derivation.can_rebase(plant) => ObserverKind::Output,
            _ => ObserverKind::Filtered,
        });
    };
    let refused = |message: String, help: &str| Diagnostic::error(Code::SettingConflict, form.span, message).help(help);
    let problem = if is_static {
        refused(
            format!("`{}` has no regression of rates", plant.name),
            "remove `form`: a static regression is one of the outputs themselves already",
        )
    } else if !derivation.can_rebase(plant) {
        refused(
            format!("`{}` has no output form", plant.name),
            "remove `form`: it takes a regression that is affine in z, with theta itself as its unknown",
        )
    } else {
        return Some(ObserverKind::Output);
    };
    problems.push(problem);
    None
}

fn idle_hold(plant: &Plant, hold: Span) -> Diagnostic {
    let message = format!("the observer of `{}` takes each sample by itself: there is no hold between two", plant.name);
    Diagnostic::error(Code::SettingConflict, hold, message)
        .help("remove `hold`, or choose a `filter` or `window` and the numbers of an estimator")
}

pub(super) fn no_point(plant: &Plant, (key, span): (&str, Span), lacking: Symbol) -> Diagnostic {
    let name = plant.arena.name(lacking);
    let message = format!("what `{key}` comes to depends on where the plant operates: `{name}` is not known");
    let is_parameter = plant.parameters.iter().any(|parameter| parameter.symbol == lacking);
    let help = if is_parameter {
        format!("write the value of the parameter: `{name}: 1`")
    } else if plant.u.contains(&lacking) {
        format!("say with which input, as `simulation: {{control: {{{name}: 0}}}}`")
    } else {
        format!("say where it starts, as `simulation: {{initial: {{{name}: 0}}}}`")
    };
    Diagnostic::error(Code::SimulationIncomplete, span, message).help(help)
}

pub(super) fn out_of_range(span: Span) -> Diagnostic {
    Diagnostic::error(Code::NumberOutOfRange, span, "the numbers that are derived of these are out of range")
        .help("choose standard deviations, and units, in which numbers are nearer to 1")
}

/// What depends on the period of the samples.
#[derive(Clone, Copy, Debug)]
enum OfPeriod {
    Filter,
    ProcessNoise,
}

impl OfPeriod {
    fn word(self) -> &'static str {
        match self {
            Self::Filter => "filter",
            Self::ProcessNoise => "process noise",
        }
    }
}

pub(super) fn no_period(plant: &Plant, what: &str, (key, span): (&str, Span)) -> Diagnostic {
    let instead = if what == OfPeriod::ProcessNoise.word() {
        "`process_noise`".to_owned()
    } else {
        format!("a `filter` and gains in place of `{key}`")
    };
    let message = format!("the {what} of `{}` depends on the period of its samples", plant.name);
    Diagnostic::error(Code::SimulationIncomplete, span, message)
        .help(format!("say it, as `simulation: {{step: 1e-3}}`, or write {instead}"))
}

/// The point, completed with numbers for symbols that slopes do not depend on, and for z, extension and unknowns.
fn completed<'a>(known: &Point<'a>, plant: &Plant, formulas: &Formulas, chi_0: &[Rational]) -> Option<Point<'a>> {
    let signals = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol)).chain(plant.u.clone());
    let all: Vec<Symbol> = signals.chain(plant.w.clone()).chain(plant.parameters.iter().map(|p| p.symbol)).collect();
    let missing: Vec<Symbol> = all.into_iter().filter(|symbol| known.of_symbol(*symbol).is_none()).collect();
    let point = known.with(&missing, &vec![0.0; missing.len()]);
    let phi: Vec<Expr> = plant.phi.iter().map(|phi| phi.expr).collect();
    let z = point.values(&phi)?;
    let chi_0: Vec<f64> = chi_0.iter().map(Rational::to_f64).collect();
    let theta: Vec<f64> = z.iter().zip(&chi_0).map(|(z, chi)| z - chi).collect();
    let count = z.len();
    let identity: Vec<f64> = (0..count * count).map(|k| if k / count == k % count { 1.0 } else { 0.0 }).collect();
    let point = point.with(&plant.z, &z).with(&plant.chi, &chi_0).with(&plant.xi, &chi_0);
    let point = point.with(&plant.psi.concat(), &identity).with(&plant.theta, &theta);
    let eta = point.values(&formulas.unknowns.formulas)?;
    Some(point.with(&formulas.eta, &eta))
}

/// The formulas whose slopes are needed.
struct Formulas {
    /// phi with the values of outputs that are given by them, by x and y.
    phi: Slopes,
    /// The rates of z, by the samples of y.
    flow: Slopes,
    /// The primitive under the derivative, by y.
    held: Slopes,
    /// Its rate, or the residual of a static regression, by the samples of y.
    rates: Slopes,
    /// The derivatives of these slopes by the unknowns, for each row.
    curvatures: Vec<Expr>,
    /// The unknowns, by theta.
    unknowns: Slopes,
    eta: Vec<Symbol>,
    /// The number of rows of an instant beside those of rates: the last ones.
    instants: usize,
    /// The equations that the observer runs.
    regression: Regression,
}

impl Formulas {
    /// The formulas of the whole regression where all equations serve, else of those with an unknown.
    fn of(plant: &Plant, derivation: &Derivation, kind: ObserverKind, is_gated: bool) -> Option<Self> {
        let arena = &plant.arena;
        let cascade = derivation.cascade.result.as_ref()?;
        let is_output = kind == ObserverKind::Output;
        let regression = derivation.regression.result.as_ref()?.computed(arena, is_output || is_gated);
        let x: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let eta = regression.eta_symbols.clone();
        let times = |factors: &[Expr], unknowns: &[Symbol]| {
            let terms = factors.iter().zip(unknowns).map(|(factor, s)| arena.mul(*factor, arena.of_symbol(*s)));
            terms.fold(arena.zero(), |sum, term| arena.add(sum, term))
        };
        // An output that is given by its value moves with the states.
        let given = plant.y.iter().filter_map(|output| Some((output.symbol, output.value?.expr)));
        let phi = arena.substitute_all(&plant.transform(), &given.collect());
        let flow: Vec<Expr> = match &cascade.lambda {
            Some(lambda) => {
                let rates = cascade.h.iter().zip(lambda);
                rates.map(|(h, row)| arena.add(*h, times(row, &plant.z))).collect()
            }
            None => cascade.h.clone(),
        };
        let is_static = regression.kind == RegressionKind::Static;
        let both = |known: &[Expr], factor: &[Vec<Expr>], minus: bool| -> Vec<Expr> {
            let rows = known.iter().zip(factor);
            let row = |(known, factor): (&Expr, &Vec<Expr>)| {
                let rest = times(factor, &eta);
                if minus { arena.sub(*known, rest) } else { arena.add(*known, rest) }
            };
            rows.map(row).collect()
        };
        let rates = both(&regression.phi_0, &regression.phi_1, is_static);
        let instants = if is_static { rates.len() } else { regression.instants(arena) };
        let held: Vec<Expr> = match regression.kind {
            RegressionKind::Static => Vec::new(),
            RegressionKind::Dynamic => regression.rows().into_iter().map(|row| arena.of_symbol(y[row])).collect(),
            RegressionKind::Implicit => both(&regression.primitive_0, &regression.primitive_1, false),
        };
        let bent = |row: &Expr| {
            let slopes = y.iter().flat_map(|output| {
                let slope = arena.derivative(*row, *output);
                eta.iter().map(move |unknown| arena.derivative(slope, *unknown))
            });
            slopes.collect::<Vec<_>>()
        };
        let [mut flow, mut driven] = [&flow, &rates].map(|formulas| Slopes::new(plant, formulas, &y));
        // Outputs that are states of the observer drive it as such, not by their samples. The noise of what has no slope
        // still counts as drift.
        if let Some(slopes) = OutputSlopes::of(plant, cascade, &regression).filter(|_| is_output) {
            let states: Vec<Symbol> = slopes.outputs.iter().map(|output| y[*output]).collect();
            flow = flow.without(plant, &slopes.cascade, &states);
            driven = driven.without(plant, &slopes.rates, &states);
        }
        Some(Self {
            phi: Slopes::new(plant, &phi, &[x.as_slice(), &y].concat()),
            flow,
            curvatures: rates[rates.len() - instants..].iter().flat_map(bent).collect(),
            held: Slopes::new(plant, &held, &y),
            rates: driven,
            unknowns: Slopes::new(plant, &regression.eta, &plant.theta),
            eta,
            instants,
            regression,
        })
    }

    /// The formulas that must have numbers: all slopes, and phi itself, at which most of them are taken.
    fn needed(&self, plant: &Plant) -> Vec<Expr> {
        let slopes = [&self.phi.by, &self.flow.by, &self.held.by, &self.rates.by, &self.curvatures];
        let mut needed: Vec<Expr> = slopes.into_iter().flatten().copied().collect();
        let here = plant.z.iter().chain(&self.eta).chain(&plant.chi).chain(&plant.xi).copied().collect();
        if needed.iter().any(|slope| plant.arena.depends_on(*slope, &here)) {
            needed.extend(&self.phi.formulas);
        }
        needed
    }

    /// What lacks the period of the samples, if that is not known: the noise of samples that drive the observer adds up.
    fn without_period(
        &self,
        kind: ObserverKind,
        (point, deviations): (&Point, &Deviations),
        has_noise: bool,
    ) -> Option<OfPeriod> {
        if kind == ObserverKind::Filtered {
            return Some(OfPeriod::Filter);
        }
        let driven = if kind == ObserverKind::Output { vec![&self.flow, &self.rates] } else { vec![&self.flow] };
        let variances = driven.into_iter().filter_map(|slopes| slopes.variances(point, &deviations.sensors)).flatten();
        (!has_noise && variances.into_iter().any(|variance| variance > 0.0)).then_some(OfPeriod::ProcessNoise)
    }

    /// Variances of the unknowns at the start, of their drift and of what sensors add, from those of theta.
    fn of_unknowns(&self, point: &Point, [covariance, drift, sensed]: [&[f64]; 3]) -> Option<[Vec<f64>; 3]> {
        let roots = |variances: &[f64]| variances.iter().map(|variance| variance.sqrt()).collect::<Vec<_>>();
        let start = self.unknowns.wide_variances(point, &roots(covariance))?;
        let noise = |variances: &[f64]| self.unknowns.variances(point, &roots(variances));
        Some([start, noise(drift)?, noise(sensed)?])
    }

    /// The standard deviations of the sensors, where their noise is in the factor of the unknown, or a row of an instant has a
    /// slope by an output that is not constant.
    fn errors_in_variables(&self, plant: &Plant, kind: ObserverKind, sensors: &[f64]) -> Option<Vec<Rational>> {
        let instants = plant.y.len() * self.instants;
        let of_instants = &self.rates.by[self.rates.by.len().saturating_sub(instants)..];
        let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let is_constant =
            |slope: &Expr| plant.arena.symbols_of(&[*slope]).iter().all(|symbol| parameters.contains(symbol));
        let eta = self.eta.iter().copied().collect();
        let is_in_factor = |slope: &Expr| plant.arena.depends_on(*slope, &eta);
        let varies = self.held.by.iter().any(is_in_factor) || !of_instants.iter().all(is_constant);
        let deviations = || sensors.iter().map(|deviation| rounded(*deviation)).collect();
        if varies && kind != ObserverKind::Filtered { deviations() } else { None }
    }

    /// The standard deviation of each row's samples.
    fn deviations(&self, point: &Point, sensors: &[f64], covariance: &[f64]) -> Option<Vec<f64>> {
        let mut variances = self.held.variances(point, sensors)?;
        let of_rates = self.rates.variances(point, sensors)?;
        let first = of_rates.len() - self.instants;
        variances.truncate(first);
        variances.extend_from_slice(&of_rates[first..]);
        let curvatures = point.values(&self.curvatures)?;
        let width = sensors.len() * self.eta.len();
        let deviation = |(row, variance): (usize, f64)| {
            if variance > 0.0 {
                return variance.sqrt();
            }
            // A row without slope at the operating point has one away from it.
            let curvature = |(place, curvature): (usize, &f64)| {
                let (sensor, unknown) = (place / self.eta.len(), place % self.eta.len());
                let spread = covariance.get(unknown).copied().unwrap_or(1.0);
                (curvature * sensors[sensor]).powi(2) * spread
            };
            let own = row.checked_sub(first).map(|row| curvatures.iter().skip(row * width).take(width));
            let around: f64 = own.into_iter().flatten().enumerate().map(curvature).sum();
            if around > 0.0 { around.sqrt() } else { 1.0 }
        };
        Some(variances.into_iter().enumerate().map(deviation).collect())
    }
}

/// Operator, covariance, process noise and its guess in four digits, if all are in range.
type Exact = (Operator<Rational>, [Vec<Rational>; 3]);

fn exact(operator: &Operator<f64>, [covariance, noise, guess]: [&[f64]; 3]) -> Option<Exact> {
    let all = |values: &[f64]| values.iter().map(|value| rounded(*value)).collect::<Option<Vec<_>>>();
    let operator = match operator {
        Operator::Filter(alpha) => Operator::Filter(rounded(*alpha)?),
        Operator::Window(samples) => Operator::Window(rounded(*samples)?),
        Operator::Sampled(deviations) => Operator::Sampled(all(deviations)?),
    };
    // Units set variances apart by any factor: each that is there stays as it is.
    let least = covariance.iter().copied().filter(|variance| *variance > 0.0).reduce(f64::min).unwrap_or(1.0);
    let known = |variance: &f64| if *variance > 0.0 { *variance } else { CERTAIN * least };
    let covariance: Vec<f64> = covariance.iter().map(known).collect();
    Some((operator, [all(&covariance)?, all(noise)?, all(guess)?]))
}
