//! Watches whether a run stays in the domain for which alone the claims are proved: where the assumptions of the plant's
//! author and the conditions of the verdict hold.
//!
//! In: both, and the values of states, outputs and inputs at each instant. Out: each that did not hold, with the first time
//! and the number of instants. Those of parameters alone were checked before.

use std::collections::BTreeSet;

use pebo_cas::{Expr, Relation, Symbol};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, Program};
use serde::Serialize;

/// The integrator's error, relative to the largest value that an expression had, with some room: a state that dies out is
/// not outside `> 0` by it.
const ROUNDING: f64 = 1e-9;

/// An assumption or condition that did not hold throughout a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutsideDomain {
    /// The assumption or condition, as `s > 0`.
    pub assumption: String,
    /// True for a condition of the verdict.
    pub is_condition: bool,
    /// The time of the first sample at which it did not hold, in seconds.
    pub since: f64,
    /// The number of samples at which it did not hold.
    pub samples: u64,
}

/// The assumptions and conditions whose values a table has.
#[derive(Debug)]
pub(crate) struct AssumedDomain {
    /// From the table to the expressions that are compared with 0.
    program: Program,
    each: Vec<Comparison>,
}

/// A comparison with 0.
#[derive(Debug)]
struct Comparison {
    text: String,
    relation: Relation,
    is_condition: bool,
}

impl AssumedDomain {
    /// The assumptions of the plant and the conditions of its verdict in these symbols, some of which move; `compile` has
    /// the values of the others.
    pub(crate) fn of(
        plant: &Plant,
        conditions: &[(Expr, Relation)],
        symbols: &[Symbol],
        compile: impl FnOnce(&[Expr]) -> Option<Program>,
    ) -> Option<Self> {
        let arena = &plant.arena;
        let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let table: BTreeSet<Symbol> = symbols.iter().copied().filter(|symbol| !parameters.contains(symbol)).collect();
        let assumptions = plant.assumptions.iter().map(|assumption| (assumption.expr, assumption.relation, false));
        let conditions = conditions.iter().map(|(expr, relation)| (*expr, *relation, true));
        let watched = assumptions.chain(conditions).filter(|(expr, ..)| {
            let moving: BTreeSet<Symbol> =
                arena.symbols_of(&[*expr]).into_iter().filter(|used| !parameters.contains(used)).collect();
            !moving.is_empty() && moving.is_subset(&table)
        });
        let (expressions, each): (Vec<Expr>, Vec<_>) = watched
            .map(|(expr, relation, is_condition)| {
                let text = format!("{} {}", arena.print(expr), relation.sign());
                (expr, Comparison { text, relation, is_condition })
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

/// The assumptions and conditions as time goes on.
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
        for (((value, Comparison { relation, .. }), largest), first) in places {
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

    /// Those that did not hold throughout.
    pub(crate) fn outside(&self) -> Vec<OutsideDomain> {
        let left = |(Comparison { text, is_condition, .. }, first): (&Comparison, &Option<(f64, u64)>)| {
            let (assumption, is_condition) = (text.clone(), *is_condition);
            first.map(|(since, samples)| OutsideDomain { assumption, is_condition, since, samples })
        };
        self.domain.each.iter().zip(&self.outside).filter_map(left).collect()
    }
}
