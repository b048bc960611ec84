//! Watches whether a run stays in the domain that the plant's author assumes, for which alone the claims are proved.
//!
//! In: the plant's assumptions, and the values of states, outputs and inputs at each instant. Out: each assumption that
//! did not hold, with the first time and the number of instants. Assumptions of parameters alone were checked before.

use std::collections::BTreeSet;

use pebo_cas::{Expr, Relation, Symbol};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, Program};
use serde::Serialize;

/// The integrator's error, relative to the largest value that an expression had, with some room: a state that dies out is
/// not outside `> 0` by it.
const ROUNDING: f64 = 1e-9;

/// An assumption that did not hold throughout a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutsideDomain {
    /// The assumption, as `s > 0`.
    pub assumption: String,
    /// The time of the first sample at which it did not hold, in seconds.
    pub since: f64,
    /// The number of samples at which it did not hold.
    pub samples: u64,
}

/// The assumptions whose values a table has.
#[derive(Debug)]
pub(crate) struct AssumedDomain {
    /// From the table to the expressions that are compared with 0.
    program: Program,
    /// Each as text, with its comparison.
    each: Vec<(String, Relation)>,
}

impl AssumedDomain {
    /// The assumptions of the plant in these symbols, some of which move; `compile` has the values of the others.
    pub(crate) fn of(
        plant: &Plant,
        symbols: &[Symbol],
        compile: impl FnOnce(&[Expr]) -> Option<Program>,
    ) -> Option<Self> {
        let arena = &plant.arena;
        let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let table: BTreeSet<Symbol> = symbols.iter().copied().filter(|symbol| !parameters.contains(symbol)).collect();
        let watched = plant.assumptions.iter().filter(|assumption| {
            let moving: BTreeSet<Symbol> =
                arena.symbols_of(&[assumption.expr]).into_iter().filter(|used| !parameters.contains(used)).collect();
            !moving.is_empty() && moving.is_subset(&table)
        });
        let (expressions, each): (Vec<Expr>, Vec<_>) = watched
            .map(|assumption| {
                let text = format!("{} {}", arena.print(assumption.expr), assumption.relation.sign());
                (assumption.expr, (text, assumption.relation))
            })
            .unzip();
        Some(Self { program: compile(&expressions)?, each })
    }

    /// The watch before the first instant.
    pub(crate) fn watch(&self) -> DomainMonitor<'_> {
        DomainMonitor {
            domain: self,
            interpreter: Interpreter::new(&self.program),
            values: vec![0.0; self.each.len()],
            largest: vec![0.0; self.each.len()],
            outside: vec![None; self.each.len()],
        }
    }
}

/// The assumptions as time goes on.
#[derive(Debug)]
pub(crate) struct DomainMonitor<'a> {
    domain: &'a AssumedDomain,
    interpreter: Interpreter,
    values: Vec<f64>,
    /// The largest absolute value of each so far.
    largest: Vec<f64>,
    /// The first time, and how often.
    outside: Vec<Option<(f64, u64)>>,
}

impl DomainMonitor<'_> {
    /// Takes the values of an instant. Where one is not known, nothing is said.
    pub(crate) fn look(&mut self, t: f64, table: &[f64]) {
        self.interpreter.run(table, &mut self.values);
        let places = self.values.iter().zip(&self.domain.each).zip(&mut self.largest).zip(&mut self.outside);
        for (((value, (_, relation)), largest), first) in places {
            *largest = largest.max(value.abs());
            let is_outside = match relation {
                Relation::Positive => *value == 0.0 || *value < -ROUNDING * *largest,
                Relation::NonNegative => *value < -ROUNDING * *largest,
                Relation::NonZero => *value == 0.0,
            };
            if is_outside {
                first.get_or_insert((t, 0)).1 += 1;
            }
        }
    }

    /// The assumptions that did not hold throughout.
    pub(crate) fn outside(&self) -> Vec<OutsideDomain> {
        let left = |((assumption, _), first): (&(String, Relation), &Option<(f64, u64)>)| {
            first.map(|(since, samples)| OutsideDomain { assumption: assumption.clone(), since, samples })
        };
        self.domain.each.iter().zip(&self.outside).filter_map(left).collect()
    }
}
