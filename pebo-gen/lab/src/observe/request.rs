//! On whose behalf an observer is made, and where it is said what that lacks.

use std::collections::BTreeMap;

use pebo_cas::{Expr, Symbol};
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

/// What an observer is made from, for a run of some kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    pub(crate) model: &'a Model,
    pub(crate) plant: &'a Plant,
    /// Where the run is described, for what is missing there.
    pub(crate) section: Span,
    /// What needs the observer: `the simulation`.
    pub(crate) who: &'static str,
}

impl Request<'_> {
    /// The values of the parameters that have one.
    pub(crate) fn numbers(&self) -> BTreeMap<Symbol, Expr> {
        let given = self.plant.parameters.iter().filter_map(|p| Some((p.symbol, p.value.clone()?)));
        given.map(|(symbol, value)| (symbol, self.plant.arena.number(value))).collect()
    }

    /// Reports parameters without a value.
    pub(crate) fn check(&self, problems: &mut Diagnostics) {
        for parameter in self.plant.parameters.iter().filter(|parameter| parameter.value.is_none()) {
            let name = self.plant.arena.name(parameter.symbol);
            let message = format!("the parameter `{name}` has no value");
            problems.push(
                Diagnostic::error(Code::SimulationIncomplete, parameter.span, message)
                    .also(self.section, format!("{} needs it", self.who))
                    .help(format!("write its value: `{name}: 1`")),
            );
        }
    }
}
