//! What rank the transforms with a plain cascade have at most, and how many there are, whatever functions they are made of.
//!
//! ```text
//! plant, values of its parameters -> equations for unknown functions -> completed -> rank, number, relations
//! ```
//!
//! That the rate is free of x, of unmeasured signals and the same for all inputs are linear equations. Of `T(y) x + s(y)` they
//! hold the functions T and the gradient of s, over the functions of y; of any smooth phi(x, y) its gradient, over those of x
//! and y. What their completion leaves bounds the rank of dphi/dx everywhere but at single points, and where it ends
//! flat the number of transforms is known, whether or not anybody can write them down. The parameters have values that are
//! named with it. Where each state is driven alone by inputs, every smooth transform is affine in x.
//!
//! Holds after: what is said was shown by exact algebra, if the kernels of the equations are independent: symbols, and sines,
//! cosines, exponentials, logarithms and roots of rational functions are (see [`crate::cas::field`]). The coefficients
//! that are compared belong to functions of other symbols than those of the unknown functions, so that these may be any.

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::combination::equations;
use crate::cas::enclosure::Point;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::linear::Echelon;
use crate::cas::{Expr, Function, Node, Symbol};

use super::bound::{Bound, BoundClass, Evidence};
use super::completion::{Completed, Derivations, Solutions, System};
use super::connection::conditions;
use super::question::Question;

/// The part of what is left of the budget that a decision may take: of functions of y, and of functions of x and y, where
/// equations soon have more terms than series have coefficients.
const SHARES: [u64; 2] = [8, 200];

/// How often the kernels of derivatives may bring new ones.
const MOST_ROUNDS: usize = 3;

/// The rank that smooth transforms of the class can have, for values of the parameters that are found after so many others;
/// none where the formulas hold what is not known to be independent, or it takes too long.
pub(super) fn decided(question: &Question<'_>, class: BoundClass, others: usize) -> Option<Bound> {
    if !question.plant.identities.is_empty() || question.y.is_empty() {
        return None;
    }
    let arena = question.arena;
    let formulas: Vec<Expr> = question.rates.values().copied().collect();
    let mut domain = question.domain.clone();
    // Claims are for all values of the parameters with these signs: those with few digits make short proofs.
    domain.fixed.clear();
    let mut point: Point = domain.points(arena, &formulas).nth(others)?;
    point.retain(|symbol, _| !question.signals.contains(symbol));
    let rates: BTreeMap<Symbol, Expr> =
        question.rates.iter().map(|(symbol, rate)| (*symbol, arena.substitute(*rate, &point))).collect();
    let (posed, share) = match class {
        BoundClass::Affine => (Posed::affine(question, &rates), SHARES[0]),
        BoundClass::Smooth => (Posed::smooth(question, &rates), SHARES[1]),
        BoundClass::AffineRate => return None,
    };
    let found = arena.budget().share(share, || posed.decided(question)).ok()??;
    let relations = found.relations;
    Some(Bound {
        states: question.x.len(),
        rank: question.x.len() - relations.len(),
        class,
        proved: true,
        point: point.into_iter().collect(),
        x: question.x.clone(),
        relations,
        evidence: Evidence::Completion { transforms: found.transforms },
    })
}

/// Equations for unknown functions, those for the entries of dphi/dx first.
struct Posed {
    /// What the unknown functions are functions of.
    base: Vec<Symbol>,
    /// For each hidden symbol a row that says that a rate is free of it: a column for each derivative of an unknown
    /// function, those of one together, and one for each function.
    conditions: Vec<Vec<Expr>>,
    /// The unknown functions that are entries of a gradient: of which and by which symbol of the base.
    gradient: Vec<(usize, usize)>,
}

/// What a completion says of dphi/dx.
struct Decision {
    relations: Vec<Vec<Expr>>,
    transforms: Option<usize>,
}

impl Posed {
    /// For T and the gradient of s, functions of y.
    fn affine(question: &Question<'_>, rates: &BTreeMap<Symbol, Expr>) -> Self {
        let (states, outputs) = (question.x.len(), question.y.len());
        let arena = question.arena;
        let conditions = conditions(question, rates).into_iter().map(|row| {
            let (slopes, rest) = row.split_at(states * outputs);
            let (shifts, values) = rest.split_at(outputs);
            let padding = vec![arena.zero(); outputs * outputs];
            [slopes, &padding, values, shifts].concat()
        });
        let gradient = (0..outputs).map(|output| (states + output, output)).collect();
        Self { base: question.y.clone(), conditions: conditions.collect(), gradient }
    }

    /// For the gradient of phi, functions of x and y.
    fn smooth(question: &Question<'_>, rates: &BTreeMap<Symbol, Expr>) -> Self {
        let arena = question.arena;
        let base: Vec<Symbol> = question.x.iter().chain(&question.y).copied().collect();
        let conditions = question.hidden.iter().map(|hidden| {
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

    fn decided(&self, question: &Question<'_>) -> Result<Option<Decision>, Obstacle> {
        let Some(field) = field_of(question, &self.base, &self.conditions.concat())? else { return Ok(None) };
        let mut moving = question.signals.clone();
        moving.retain(|symbol| !self.base.contains(symbol));
        if !are_independent(&field, question, &moving) {
            return Ok(None);
        }
        let (states, directions) = (question.x.len(), self.base.len());
        let Some(all) = self.conditions.first().map(|row| row.len() / (directions + 1)) else { return Ok(None) };
        let mut rows = equations(&field, &self.conditions, &moving)?;
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
        let places = self.gradient.iter().filter_map(|(of, by)| Some((kept.iter().position(|kept| kept == of)?, *by)));
        let places: Vec<(usize, usize)> = places.collect();
        for (index, (first, j)) in places.iter().enumerate() {
            for (second, k) in &places[index + 1..] {
                let mut row = vec![Fraction::zero(); functions * (directions + 1)];
                row[first * directions + k] = Fraction::one();
                row[second * directions + j] = Fraction::one().opposite();
                rows.push(row);
            }
        }
        let by = Derivations::of(&field, &self.base)?;
        let system = System::new(&by, (states, functions), rows);
        let trivial = system.vanishing();
        let Completed { lift, functions, solutions } = system.completed()?;
        let transforms = match solutions {
            // Without those that hold no state.
            Solutions::AsFunctions => {
                let trivial = trivial.completed()?;
                (trivial.solutions == Solutions::AsFunctions).then(|| functions - trivial.functions)
            }
            _ => None,
        };
        let transposed = (0..functions).map(|column| lift.iter().map(|row| row[column].clone()).collect()).collect();
        let (echelon, _) = Echelon::of(&field, transposed, states)?;
        let shown = |row: &Vec<Fraction>| row.iter().map(|e| field.show(e)).collect();
        Ok(Some(Decision { relations: echelon.null_space().iter().map(shown).collect(), transforms }))
    }
}

/// The field of formulas and all derivatives by the base; none if these lead to ever new functions.
fn field_of<'a>(question: &Question<'a>, base: &[Symbol], formulas: &[Expr]) -> Result<Option<Field<'a>>, Obstacle> {
    let arena = question.arena;
    let symbols: BTreeSet<Symbol> = base.iter().copied().collect();
    let mut roots = formulas.to_vec();
    for _ in 0..MOST_ROUNDS {
        let field = Field::over(arena, &question.domain.facts, &roots)?;
        let kernels = field.kernels_of(&symbols);
        let pairs = kernels.iter().flat_map(|kernel| base.iter().map(move |symbol| (*kernel, *symbol)));
        let slopes: Vec<Expr> = pairs.map(|(kernel, by)| arena.derivative(field.kernel(kernel), by)).collect();
        let closed = slopes.iter().all(|e| roots.contains(e));
        if closed {
            return Ok(Some(field));
        }
        roots.extend(slopes);
    }
    Ok(None)
}

/// Whether the kernels are known to be independent, and those of moving symbols hold none of the base.
fn are_independent(field: &Field<'_>, question: &Question<'_>, moving: &BTreeSet<Symbol>) -> bool {
    let arena = question.arena;
    let is_rational = |of: Expr| {
        arena.postorder(&[of]).into_iter().all(|part| match arena.node(part) {
            Node::Call(..) | Node::Pi => false,
            Node::Product(product) => product.factors.iter().all(|(_, exponent)| exponent.is_integer()),
            _ => true,
        })
    };
    let is_known = |kernel: Expr| match arena.node(kernel) {
        Node::Symbol(_) => true,
        Node::Call(Function::Sin | Function::Cos | Function::Exp | Function::Log, arguments) => {
            is_rational(arguments[0])
        }
        Node::Product(product) => product.factors.iter().all(|(base, _)| is_rational(*base)),
        _ => false,
    };
    field.kernels().into_iter().all(|kernel| {
        let signals = arena.symbols_of(&[kernel]);
        let moves = |symbol: &Symbol| question.signals.contains(symbol);
        let mixed = !signals.is_disjoint(moving) && signals.iter().any(|s| moves(s) && !moving.contains(s));
        is_known(kernel) && !mixed && signals.iter().any(moves)
    })
}
