//! The differential equations for the gradient of a transform with a plain cascade.
//!
//! In: a plant, and rates of its signals. Out: linear partial differential equations of first order for unknown
//! functions, over a field that holds the derivatives of its elements. Of `T(y) x + s(y)` they hold the functions T and
//! the gradient of s, over the functions of y; of any smooth phi(x, y) its gradient, over those of x and y.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::linear::comparison::equations;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::connection::conditions;
use crate::search::problem::Problem;

/// Most rounds in which the kernels of derivatives may bring new ones.
const MOST_ROUNDS: usize = 3;

/// Equations for unknown functions, those for the entries of dphi/dx first.
pub(in crate::search) struct GradientEquations {
    /// The arguments of the unknown functions.
    pub(in crate::search) base: Vec<Symbol>,
    /// For each hidden symbol a row for the independence of a rate: a column for each derivative of an unknown
    /// function, those of one in sequence, and one for each function.
    conditions: Vec<Vec<Expr>>,
    /// The unknown functions that are entries of a gradient: the function and the symbol of the base.
    gradient: Vec<(usize, usize)>,
}

/// The equations over a field.
pub(in crate::search) struct EquationRows {
    /// The unknown functions that the equations hold.
    pub(in crate::search) kept: Vec<usize>,
    /// Over the derivatives of those, those of one function in sequence, and then over the functions.
    pub(in crate::search) rows: Vec<Vec<Fraction>>,
}

impl GradientEquations {
    /// For T and the gradient of s, functions of y.
    pub(in crate::search) fn affine(problem: &Problem<'_>, rates: &BTreeMap<Symbol, Expr>) -> Result<Self, Obstacle> {
        let (states, outputs) = (problem.x.len(), problem.y.len());
        let arena = problem.arena;
        let conditions = conditions(problem, rates)?.into_iter().map(|row| {
            let (slopes, rest) = row.split_at(states * outputs);
            let (shifts, values) = rest.split_at(outputs);
            let padding = vec![arena.zero(); outputs * outputs];
            [slopes, &padding, values, shifts].concat()
        });
        let gradient = (0..outputs).map(|output| (states + output, output)).collect();
        Ok(Self { base: problem.y.clone(), conditions: conditions.collect(), gradient })
    }

    /// For the gradient of phi, functions of x and y.
    pub(in crate::search) fn smooth(problem: &Problem<'_>, rates: &BTreeMap<Symbol, Expr>) -> Self {
        let arena = problem.arena;
        let base: Vec<Symbol> = problem.x.iter().chain(&problem.y).copied().collect();
        let conditions = problem.hidden.iter().map(|hidden| {
            let slopes = base.iter().flat_map(|function| {
                let is_this = |by: &Symbol| if by == hidden { rates[function] } else { arena.zero() };
                base.iter().map(is_this).collect::<Vec<Expr>>()
            });
            slopes.chain(base.iter().map(|function| arena.derivative(rates[function], *hidden))).collect()
        });
        let conditions = conditions.collect();
        let gradient = (0..base.len()).map(|index| (index, index)).collect();
        Self { base, conditions, gradient }
    }

    /// The moving symbols besides the base.
    pub(in crate::search) fn moving(&self, problem: &Problem<'_>) -> BTreeSet<Symbol> {
        problem.signals.iter().filter(|symbol| !self.base.contains(symbol)).copied().collect()
    }

    /// The field of the conditions and all derivatives by the base; none if these lead to ever new functions.
    pub(in crate::search) fn field<'a>(&self, problem: &Problem<'a>) -> Result<Option<Field<'a>>, Obstacle> {
        let arena = problem.arena;
        let symbols: BTreeSet<Symbol> = self.base.iter().copied().collect();
        let mut roots = self.conditions.concat();
        for _ in 0..MOST_ROUNDS {
            let field = Field::over(arena, &problem.domain.facts, &roots)?;
            let kernels = field.kernels_of(&symbols);
            let pairs = kernels.iter().flat_map(|kernel| self.base.iter().map(move |symbol| (*kernel, *symbol)));
            let slopes: Vec<Expr> = pairs.map(|(kernel, by)| arena.derivative(field.kernel(kernel), by)).collect();
            let closed = slopes.iter().all(|e| roots.contains(e));
            if closed {
                return Ok(Some(field));
            }
            roots.extend(slopes);
        }
        Ok(None)
    }

    /// The equations over the field; none if there are none.
    pub(in crate::search) fn rows(
        &self,
        problem: &Problem<'_>,
        field: &Field<'_>,
    ) -> Result<Option<EquationRows>, Obstacle> {
        let (states, directions) = (problem.x.len(), self.base.len());
        let Some(all) = self.conditions.first().map(|row| row.len() / (directions + 1)) else { return Ok(None) };
        let mut rows = equations(field, &self.conditions, &self.moving(problem))?.into_rows();
        // phi may be any function of an output in whose rate there is nothing hidden.
        let occurs = |function: &usize| {
            let columns = (0..directions).map(|by| function * directions + by).chain([all * directions + function]);
            columns.into_iter().any(|column| rows.iter().any(|row| !row[column].is_zero()))
        };
        let kept: Vec<usize> = (0..all).filter(|function| *function < states || occurs(function)).collect();
        let functions = kept.len();
        for row in &mut rows {
            let slopes = kept.iter().flat_map(|function| &row[function * directions..(function + 1) * directions]);
            *row = slopes.chain(kept.iter().map(|function| &row[all * directions + function])).cloned().collect();
        }
        // The derivatives of a gradient agree.
        let entries = self.gradient.iter().filter_map(|(of, by)| Some((kept.iter().position(|kept| kept == of)?, *by)));
        let entries: Vec<(usize, usize)> = entries.collect();
        for (index, (first, j)) in entries.iter().enumerate() {
            for (second, k) in &entries[index + 1..] {
                let mut row = vec![Fraction::zero(); functions * (directions + 1)];
                row[first * directions + k] = Fraction::one();
                row[second * directions + j] = Fraction::one().opposite();
                rows.push(row);
            }
        }
        Ok(Some(EquationRows { kept, rows }))
    }
}
