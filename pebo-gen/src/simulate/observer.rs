//! The observer as it was derived, with its settings: what the interpreted model computes.

use std::collections::BTreeMap;

use pebo_runtime::Hold;

use crate::analysis::{Derivation, Regression, RegressionKind};
use crate::cas::{Expr, Symbol};
use crate::model::{self, Decimal, Spanned};
use crate::program::Program;
use crate::source::{Code, Diagnostic, Diagnostics, Span};

use super::derived::LARGEST;
use super::layout::program;
use super::scope::Names;

/// The estimators that the runtime library has.
const ESTIMATORS: &[&str] = &["gradient"];

/// An observer, ready to be interpreted.
#[derive(Debug)]
pub(super) struct Design {
    /// The states that it recovers.
    pub(super) recovered: Vec<Symbol>,
    /// Whether the regression is static.
    pub(super) is_static: bool,
    /// Positions in y of the outputs whose rates the dynamic regression uses.
    pub(super) rows: Vec<usize>,
    /// The number of outputs y.
    pub(super) outputs: usize,
    /// The number of inputs u.
    pub(super) inputs: usize,
    /// The number of coordinates z.
    pub(super) coordinates: usize,
    /// From y, u to h.
    pub(super) h: Program,
    /// From y, u to Lambda by rows, in a generalised cascade.
    pub(super) lambda: Option<Program>,
    /// From the extension, y, u to the known part of the regression.
    pub(super) phi_0: Program,
    /// From the extension, y, u to the factor of the unknowns, by rows.
    pub(super) phi_1: Program,
    /// From the extension and y to what is known under the derivative, and the factor of the unknowns there by
    /// rows, in an implicit regression.
    pub(super) primitives: Option<[Program; 2]>,
    /// From eta to theta.
    pub(super) theta: Program,
    /// From z, y to the recovered states.
    pub(super) phi_left: Program,
    /// The filter's alpha.
    pub(super) filter: f64,
    /// How samples are joined.
    pub(super) hold: Hold,
    /// A gain for each eta.
    pub(super) gains: Vec<f64>,
    /// The extension at the start.
    pub(super) chi_0: Vec<f64>,
}

impl Design {
    /// The design of an accepted derivation; `numbers` are the values of the parameters.
    pub(super) fn resolve(
        names: &Names,
        derivation: &Derivation,
        numbers: &BTreeMap<Symbol, Expr>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let plant = names.plant;
        let span = names.model.name.span;
        let cascade = derivation.cascade.result.as_ref()?;
        let inverse = derivation.left_inverse.result.as_ref()?;
        let regression = derivation.regression.result.as_ref()?;
        let settings = Settings::resolve(names, regression, problems)?;
        let arena = &plant.arena;
        let mut compile = |inputs: &[&[Symbol]], outputs: &[Expr]| {
            let outputs = arena.substitute_all(outputs, numbers);
            problems.keep(program(arena, &inputs.concat(), &outputs, span))
        };
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let extension = match cascade.lambda {
            Some(_) => [plant.xi.clone(), plant.psi.concat()].concat(),
            None => plant.chi.clone(),
        };
        let at_sample: [&[Symbol]; 2] = [&y, &plant.u];
        let regressed: [&[Symbol]; 3] = [&extension, &y, &plant.u];
        let states: Vec<Expr> = inverse.x.iter().map(|(_, formula)| *formula).collect();
        let design = Self {
            h: compile(&at_sample, &cascade.h)?,
            lambda: match &cascade.lambda {
                Some(lambda) => Some(compile(&at_sample, &lambda.concat())?),
                None => None,
            },
            phi_0: compile(&regressed, &regression.phi_0)?,
            phi_1: compile(&regressed, &regression.phi_1.concat())?,
            primitives: match regression.kind {
                RegressionKind::Implicit => Some([
                    compile(&[&extension, &y], &regression.primitive_0)?,
                    compile(&[&extension, &y], &regression.primitive_1.concat())?,
                ]),
                RegressionKind::Dynamic | RegressionKind::Static => None,
            },
            theta: compile(&[&regression.eta_symbols], &regression.theta)?,
            phi_left: compile(&[&plant.z, &y], &states)?,
            recovered: inverse.x.iter().map(|(state, _)| *state).collect(),
            is_static: regression.kind == RegressionKind::Static,
            rows: regression.rows.clone(),
            outputs: plant.y.len(),
            inputs: plant.u.len(),
            coordinates: plant.phi.len(),
            filter: settings.filter,
            hold: settings.hold,
            gains: settings.gains,
            chi_0: settings.chi_0,
        };
        problems.keep(design.admit_size(span))?;
        Some(design)
    }

    /// The largest number of quantities of one kind.
    pub(super) fn size(&self) -> usize {
        let regression = self.phi_0.outputs.len().max(self.gains.len());
        let plant = self.outputs.max(self.inputs).max(self.coordinates);
        plant.max(regression).max(self.recovered.len())
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

/// The section `observer`, complete.
struct Settings {
    filter: f64,
    hold: Hold,
    gains: Vec<f64>,
    chi_0: Vec<f64>,
}

impl Settings {
    fn resolve(names: &Names, regression: &Regression, problems: &mut Diagnostics) -> Option<Self> {
        let (written, section) = (&names.model.observer, names.section());
        let lacking = |what: &str, help: &str| {
            let message = format!("the simulation needs {what}");
            Diagnostic::error(Code::SimulationIncomplete, section, message).help(help)
        };
        if let Some(estimator) = written.estimator.as_ref().filter(|e| !ESTIMATORS.contains(&e.value.as_str())) {
            let message = format!("there is no estimator `{}`", estimator.value);
            problems.push(
                Diagnostic::error(Code::WrongChoice, estimator.span, message)
                    .help(format!("write one of `{}`", ESTIMATORS.join("`, `"))),
            );
        }
        if written.filter.is_none() {
            problems.push(lacking("the observer's filter", "add `observer: {filter: 1}`, in rad/s"));
        }
        if written.gain.is_empty() {
            problems.push(lacking("the estimator's gain", "add `observer: {gain: 1}`, or a list with one each"));
        }
        let gains = values(&written.gain, regression.eta.len(), "a gain for each unknown", problems);
        let chi_0 = values(&written.extension, names.plant.phi.len(), "a start for each component of phi", problems);
        Some(Self {
            filter: written.filter.as_ref()?.value.to_f64(),
            hold: match written.hold.as_ref().map(|hold| hold.value) {
                Some(model::Hold::ZeroOrder) => Hold::Zero,
                Some(model::Hold::FirstOrder) | None => Hold::First,
            },
            gains: gains?,
            chi_0: chi_0?,
        })
    }
}

/// As many values as needed: all given, or one for all, or zeros where the list is empty.
fn values(written: &[Spanned<Decimal>], count: usize, what: &str, problems: &mut Diagnostics) -> Option<Vec<f64>> {
    match written {
        [] => Some(vec![0.0; count]),
        [one] => Some(vec![one.value.to_f64(); count]),
        all if all.len() == count => Some(all.iter().map(|value| value.value.to_f64()).collect()),
        all => {
            let message = format!("{} values where {what} is expected, {count} in all", all.len());
            problems.push(
                Diagnostic::error(Code::WrongShape, all[0].span.to(all[all.len() - 1].span), message)
                    .help(format!("write {count} values, or one for all")),
            );
            None
        }
    }
}
