//! The derived observer with its settings, as programs to be interpreted.

use std::collections::BTreeMap;

use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::{Derivation, LeftInverse, OutputSlopes, Regression, RegressionKind, RelatedTransform};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, Program, lower};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

use super::certainty::Wanted;
use super::request::Request;
use super::setup::{Operator, Settings};
use super::sizes::LARGEST;
use crate::score::SETTLED;
use crate::score::faults::SignalNames;
use crate::settings::{Prediction, SampleRows, Shown};

/// An observer, ready to be interpreted.
#[derive(Debug)]
pub(crate) struct Design {
    /// The states that it recovers.
    pub(crate) recovered: Vec<Symbol>,
    /// The left side of the regression.
    pub(crate) kind: RegressionKind,
    /// Positions in y of the outputs whose rates the dynamic regression uses.
    pub(crate) rows: Vec<usize>,
    /// The index in y of the output of each row, where the sample of any output may be missing.
    pub(crate) partial: Option<Vec<usize>>,
    /// The number of outputs y.
    pub(crate) outputs: usize,
    /// The number of inputs u.
    pub(crate) inputs: usize,
    /// True if the observer is given the inputs at the end of an interval after those during it: outputs that are given by
    /// their values have these.
    pub(crate) with_instant: bool,
    /// The names of both.
    pub(crate) names: SignalNames,
    /// The number of coordinates z.
    pub(crate) coordinates: usize,
    /// The number of equations of the regression.
    pub(crate) equations: usize,
    /// The number of them that hold at every instant beside those of rates: the last ones.
    pub(crate) instants: usize,
    /// True for a generalised cascade.
    pub(crate) is_generalised: bool,
    /// True for a regression of first order, at the extension.
    pub(crate) is_local: bool,
    /// The periods of the outputs, 0 for one that is no angle.
    pub(crate) periods: Vec<f64>,
    /// From y, u to h, then Lambda by rows in a generalised cascade.
    pub(crate) cascade: Program,
    /// From the extension, y, u to the known side of the regression, then the factor of the unknowns by rows.
    pub(crate) regression: Program,
    /// From the extension and y to the same sides under the derivative, in an implicit regression.
    pub(crate) primitive: Option<Program>,
    /// From y, u to the slopes of the rates by the outputs: of the regression by rows, then of the cascade; in the output
    /// form, where there are some.
    pub(crate) slopes: Option<Program>,
    /// From eta to theta.
    pub(crate) theta: Program,
    /// From theta to eta, then its derivatives by rows, where eta has more components.
    pub(crate) functions: Option<Program>,
    /// From the recovered states and y to the components of phi, then their derivatives by rows, where these depend on
    /// one another.
    pub(crate) transform: Option<Program>,
    /// From z, y to the recovered states.
    pub(crate) phi_left: Program,
    /// The number of unknowns eta of the model's regression.
    pub(crate) unknowns: usize,
    /// The estimated unknowns, as formulas in theta.
    pub(crate) unknown_names: Vec<String>,
    /// The positions of those that the known start fixes.
    pub(crate) fixed: Vec<usize>,
    /// Regression and estimator.
    pub(crate) settings: Settings,
    /// The wanted standard errors.
    pub(crate) wanted: Vec<Wanted>,
}

impl Design {
    /// The design of an accepted derivation; `numbers` are the values of the parameters.
    pub(crate) fn resolve(
        request: &Request,
        derivation: &Derivation,
        numbers: &BTreeMap<Symbol, Expr>,
        shown: &Shown,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let plant = request.plant;
        let span = request.model.name.span;
        let cascade = derivation.cascade.result.as_ref()?;
        let inverse = derivation.left_inverse.result.as_ref()?;
        let regression = derivation.regression.result.as_ref()?;
        let settings = Settings::resolve(request, derivation, (regression, inverse), shown, problems)?;
        let arena = &plant.arena;
        let regression = &regression.computed(arena, settings.output || settings.gate.is_some());
        let mut compile = |inputs: &[&[Symbol]], outputs: &[Expr]| {
            let outputs = arena.substitute_all(outputs, numbers);
            problems.keep(program(arena, &inputs.concat(), &outputs, span))
        };
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let extension = match cascade.lambda {
            Some(_) => [plant.xi.clone(), plant.psi.concat()].concat(),
            None => plant.chi.clone(),
        };
        let sides = |known: &[Expr], factor: &[Vec<Expr>]| [known, &factor.concat()].concat();
        let lambda = cascade.lambda.as_ref().map(|rows| rows.concat()).unwrap_or_default();
        let at_sample: [&[Symbol]; 2] = [&y, &plant.u];
        let regressed: [&[Symbol]; 3] = [&extension, &y, &plant.u];
        // The unknowns of the output form are the primitives at the start, as a rule outputs, then those of z.
        let instants = regression.instants(arena);
        let primitives = match regression.kind {
            RegressionKind::Dynamic => {
                regression.rows().into_iter().map(|row| arena.of_symbol(plant.y[row].symbol)).collect()
            }
            RegressionKind::Implicit => regression.primitive_0[..regression.primitive_0.len() - instants].to_vec(),
            RegressionKind::Static => Vec::new(),
        };
        let starts: Vec<Expr> = primitives.into_iter().filter(|_| settings.output).collect();
        let by_start = derivation.identifiability.result.iter().flat_map(|result| &result.by_start);
        let fixed = by_start.map(|position| starts.len() + position).collect();
        let states: Vec<Expr> = inverse.x.iter().map(|(_, formula)| *formula).collect();
        let periods = match plant.periods_of_outputs() {
            Some(periods) => Interpreter::new(&compile(&[], &periods)?).evaluate(|_| f64::NAN).collect(),
            None => vec![0.0; plant.y.len()],
        };
        let design = Self {
            periods,
            equations: regression.phi_0.len(),
            instants,
            is_generalised: cascade.lambda.is_some(),
            is_local: regression.is_at_estimate(),
            cascade: compile(&at_sample, &[cascade.h.as_slice(), &lambda].concat())?,
            regression: compile(&regressed, &sides(&regression.phi_0, &regression.phi_1))?,
            primitive: match regression.kind {
                RegressionKind::Implicit => {
                    Some(compile(&[&extension, &y], &sides(&regression.primitive_0, &regression.primitive_1))?)
                }
                RegressionKind::Dynamic | RegressionKind::Static => None,
            },
            slopes: match OutputSlopes::of(plant, cascade, regression).filter(|_| settings.output) {
                Some(slopes) => Some(compile(
                    &[&y, &plant.u, &plant.z],
                    &[slopes.rates.concat(), slopes.cascade.concat()].concat(),
                )?),
                None => None,
            },
            theta: compile(&[&regression.eta_symbols], &regression.theta)?,
            functions: match regression.slopes(plant).filter(|_| !settings.output) {
                Some(slopes) => Some(compile(&[&plant.theta], &sides(&regression.eta, &slopes))?),
                None => None,
            },
            transform: match RelatedTransform::of(plant, cascade, inverse, regression) {
                Some(RelatedTransform { phi, slopes }) => {
                    let recovered: Vec<Symbol> = inverse.x.iter().map(|(state, _)| *state).collect();
                    Some(compile(&[&recovered, &y], &sides(&phi, &slopes))?)
                }
                None => None,
            },
            phi_left: compile(&[&plant.z, &y], &states)?,
            recovered: inverse.x.iter().map(|(state, _)| *state).collect(),
            kind: regression.kind,
            rows: regression.rows(),
            partial: partial(plant, regression, &settings),
            outputs: plant.y.len(),
            inputs: plant.u.len(),
            with_instant: false,
            names: SignalNames {
                outputs: y.iter().map(|output| arena.name(*output)).collect(),
                inputs: plant.u.iter().map(|input| arena.name(*input)).collect(),
            },
            coordinates: plant.phi.len(),
            unknowns: regression.eta.len(),
            fixed,
            unknown_names: starts
                .into_iter()
                .map(|primitive| match arena.as_symbol(primitive) {
                    Some(output) => format!("{}(0)", arena.name(output)),
                    None => format!("({})(0)", arena.print(primitive)),
                })
                .chain(regression.eta.iter().map(|unknown| arena.print(*unknown)))
                .collect(),
            settings,
            wanted: wanted(request, inverse, problems),
        };
        problems.keep(design.admit_size(span))?;
        Some(design)
    }

    /// The largest number of quantities of one kind.
    pub(crate) fn size(&self) -> usize {
        let regression = self.equations.max(self.unknowns);
        let inputs = if self.with_instant { 2 * self.inputs } else { self.inputs };
        let plant = self.outputs.max(inputs).max(self.coordinates);
        plant.max(regression).max(self.recovered.len()).max(self.settings.chi_0.len())
    }

    /// The same with the inputs at the end of an interval beside those during it; as it is where samples are not taken as
    /// they are, or there is no room.
    pub(crate) fn with_instant(self) -> Self {
        let has_room = 2 * self.inputs <= LARGEST;
        Self { with_instant: has_room && matches!(self.settings.operator, Operator::Sampled(_)), ..self }
    }

    /// True if it predicts the standard errors of its estimates.
    pub(crate) fn predicts(&self) -> bool {
        matches!(self.settings.prediction, Some(Prediction::Covariance | Prediction::Noise(_)))
    }

    /// The number of equations of rates.
    pub(crate) fn rates(&self) -> usize {
        self.equations - self.instants
    }

    /// The number of unknowns that are estimated.
    pub(crate) fn estimated(&self) -> usize {
        self.unknown_names.len()
    }

    /// True if a value of a recovered state is beyond its bounds in `within` by more than the tolerance of settling.
    pub(crate) fn is_outside(&self, state: usize, value: f64) -> bool {
        let [lower, upper] = &self.settings.within;
        let slack = SETTLED * value.abs();
        lower.get(state).is_some_and(|lower| value + slack < *lower)
            || upper.get(state).is_some_and(|upper| value - slack > *upper)
    }

    fn admit_size(&self, span: Span) -> Result<(), Diagnostic> {
        let size = self.size();
        if size <= LARGEST {
            return Ok(());
        }
        let message = format!("an observer with {size} quantities of one kind is too large to be simulated");
        Err(Diagnostic::error(Code::SimulationUnsupported, span, message).help(format!(
            "the simulator has room for {LARGEST} states, outputs, inputs or unknowns: simulate the emitted code"
        )))
    }
}

/// The index in y of the output of each row, where the observer expects any of them by its row, or waits for it.
fn partial(plant: &Plant, regression: &Regression, settings: &Settings) -> Option<Vec<usize>> {
    if !matches!(settings.operator, Operator::Sampled(_)) {
        return None;
    }
    let SampleRows { rows, is_expected } = SampleRows::of(plant, regression, settings.output);
    let may_lack = match &settings.late {
        Some(late) => late.may_lack_any(),
        None => rows.iter().all(|output| is_expected[*output]),
    };
    may_lack.then_some(rows)
}

/// The wanted standard errors of the recovered states; one of another state is reported.
fn wanted(request: &Request, inverse: &LeftInverse, problems: &mut Diagnostics) -> Vec<Wanted> {
    let arena = &request.plant.arena;
    let mut found = Vec::new();
    for entry in &request.model.observer.wanted {
        let state = &entry.name.value;
        let Some(estimate) = inverse.x.iter().position(|(recovered, _)| arena.name(*recovered) == *state) else {
            let message = format!("`wanted` names `{state}`, which this observer does not recover");
            problems.push(
                Diagnostic::error(Code::SettingConflict, entry.name.span, message)
                    .help("remove it, or add its formula to `phi_left`"),
            );
            continue;
        };
        found.push(Wanted { estimate, state: state.clone(), error: entry.value.value.to_f64() });
    }
    found
}

/// Lowers formulas to a program; a symbol without a value is a diagnostic at `span`.
pub(crate) fn program(arena: &Arena, inputs: &[Symbol], outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
    lower(arena, inputs, outputs).map_err(|undeclared| {
        let message = format!("`{}` has no value in the simulation", arena.name(undeclared.0));
        Diagnostic::error(Code::SimulationIncomplete, span, message).help("give its values over time under `signals`")
    })
}
