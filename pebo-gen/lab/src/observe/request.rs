//! The request for an observer: its model and plant, and the section of the run that needs it.

use std::collections::BTreeMap;

use pebo_cas::{Expr, Symbol};
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

/// The request for an observer, by a run of some kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    pub(crate) model: &'a Model,
    pub(crate) plant: &'a Plant,
    /// The section that describes the run, for complaints about missing keys.
    pub(crate) section: Span,
    /// The subject of complaints: `the simulation`.
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
