//! The same plant with fewer states to recover: they are unmeasured signals, or outputs.

use std::collections::BTreeSet;

use pebo_cas::{Expr, Symbol};

use super::parts::{Output, State};
use super::plant::Plant;

impl Plant {
    /// The same plant where a state is an output.
    #[must_use]
    pub fn with_measured(&self, state: &State) -> Self {
        let mut plant = self.clone();
        plant.x.retain(|other| other.symbol != state.symbol);
        plant.y.push(Output { symbol: state.symbol, rate: Some(state.rate), value: None, span: state.rate.span });
        plant
    }

    /// The same plant where these states are unmeasured signals instead: their rates are unknown, and so are what holds
    /// of them and the values of outputs that depend on them.
    #[must_use]
    pub fn with_unmeasured(&self, states: &[Symbol]) -> Self {
        let is_unknown = |state: &State| states.contains(&state.symbol);
        let left_out: BTreeSet<Symbol> = states.iter().copied().collect();
        let holds = |expr: Expr| self.arena.depends_on(expr, &left_out);
        let mut plant = self.clone();
        plant.x.retain(|state| !is_unknown(state));
        plant.w.extend(states);
        plant.angles.retain(|(state, _)| !left_out.contains(state));
        plant.identities.retain(|identity| !holds(identity.expr));
        for output in &mut plant.y {
            // A value along which its rate was taken is read off no more.
            let follows = output.moves_with_value();
            output.value = output.value.filter(|value| !holds(value.expr));
            output.rate = output.rate.filter(|_| !follows || output.value.is_some());
        }
        // The conditions of a formula that is left out are not those of the others.
        let unknown = self.x.iter().filter(|state| is_unknown(state));
        let spans: Vec<_> = unknown.map(|state| state.rate.span.range()).collect();
        plant.conditions.retain(|condition| !spans.iter().any(|span| span.contains(&condition.span.range().start)));
        plant
    }
}
