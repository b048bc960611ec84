//! The plant's equations for the derivatives of `T(y) x + s(y)`.
//!
//! ```text
//! x_i f_yj, f_yj, f_xi -> dT_ij = sum of Gamma T, ds_j = sum of A T -> integrating factors, antiderivatives
//! ```
//!
//! For a plain cascade: with row T, the rate is `sum of dT_ij (x_i f_yj) + sum of ds_j f_yj + sum of T_i f_xi`; its
//! independence of x is a system of linear equations over the functions of y. Where they give `dT_ij = r T_i` for every
//! output, `T_i` is an exponential of an integral; where they give `ds_j`, s is an integral. For a generalised one the
//! rate may be affine in x, which leaves fewer equations. Both lead to functions that the plant's formulas do not hold.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::forms::opaque::OpaqueTerms;
use pebo_cas::linear::Echelon;
use pebo_cas::linear::comparison::equations;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Function, Node, Relation, Symbol};

use crate::search::ansatz::Rate;
use crate::search::integral::antiderivative;
use crate::search::problem::Problem;

/// The equations, solved for derivatives.
#[derive(Debug)]
pub(in crate::search) struct Connection {
    /// For each state and output the coefficients of T in dT, where the equations determine it.
    gamma: Vec<Vec<Option<Vec<Expr>>>>,
    /// For each output the coefficients of T in ds.
    shift: Vec<Option<Vec<Expr>>>,
}

/// Derivatives of unknown functions past which no equations for them are written: these are dense matrices.
pub(in crate::search) const MOST_DERIVATIVES: usize = 1024;

impl Connection {
    /// Solves the equations of a plant for permitted rates.
    pub(in crate::search) fn of(problem: &Problem<'_>, permitted: Rate) -> Result<Self, Obstacle> {
        let arena = problem.arena;
        let mut conditions = conditions(problem, &problem.rates)?;
        if permitted == Rate::Affine {
            // A formula affine in x has slopes that are free of it.
            let slopes = problem.hidden.iter().zip(conditions).flat_map(|(symbol, row)| {
                let by = problem.x.contains(symbol).then_some(&problem.hidden);
                let second = |other| row.iter().map(|e| arena.derivative(*e, other)).collect();
                by.map_or_else(|| vec![row.clone()], |by| by.iter().map(|other| second(*other)).collect())
            });
            conditions = slopes.collect();
        }
        let mut moving = problem.signals.clone();
        moving.retain(|symbol| !problem.y.contains(symbol));
        let mut found = Self::solved(problem, &conditions, &moving)?;
        // Functions of the outputs are left as written, where that is enough: `(q - q0)^4` rather than its terms.
        let mut frozen = OpaqueTerms::new(arena, &moving);
        let written: Vec<Vec<Expr>> = conditions.iter().map(|row| frozen.replace(row)).collect();
        if !frozen.is_empty()
            && let Ok(written) = Self::solved(problem, &written, &moving)
        {
            let entries = found.gamma.iter_mut().flatten().chain(&mut found.shift);
            for (known, written) in entries.zip(written.gamma.iter().flatten().chain(&written.shift)) {
                if let (Some(known), Some(written)) = (known, written) {
                    *known = written.iter().map(|entry| frozen.restore(*entry)).collect();
                }
            }
        }
        Ok(found)
    }

    /// The conditions, solved for derivatives, as coefficients that are free of moving symbols.
    fn solved(problem: &Problem<'_>, conditions: &[Vec<Expr>], moving: &BTreeSet<Symbol>) -> Result<Self, Obstacle> {
        let (states, outputs) = (problem.x.len(), problem.y.len());
        let roots: Vec<Expr> = conditions.iter().flatten().copied().collect();
        let field = Field::over(problem.arena, &problem.domain.facts, &roots)?;
        let matrix = equations(&field, conditions, moving)?;
        let slopes = states * outputs;
        let echelon = Echelon::in_order(&field, matrix, (slopes, slopes + outputs))?;
        let (mut shift, mut gamma) = (vec![None; outputs], vec![vec![None; outputs]; states]);
        for (pivot, row) in echelon.determined() {
            let entry = match pivot.checked_sub(slopes) {
                Some(output) => &mut shift[output],
                None => &mut gamma[pivot / outputs][pivot % outputs],
            };
            *entry = Some(row[slopes + outputs..].iter().map(|e| field.show(&e.opposite())).collect::<Vec<Expr>>());
        }
        Ok(Self { gamma, shift })
    }

    /// Integrating factors of single states, and the waves or exponentials of pairs that turn into one another.
    pub(in crate::search) fn factors(&self, problem: &Problem<'_>) -> Vec<Expr> {
        let arena = problem.arena;
        let mut found = Vec::new();
        for (state, slopes) in self.gamma.iter().enumerate() {
            let own = slopes.iter().zip(&problem.y).map(|(row, y)| row.as_ref().map(|row| (*y, row[state])));
            let own: Option<Vec<(Symbol, Expr)>> = own.collect();
            if let Some(gradient) = own
                && gradient.iter().any(|(_, e)| !arena.is_zero(*e))
                && let Some(potential) = potential(problem, &gradient)
            {
                found.push(exponential(problem, potential));
            }
        }
        for (output, symbol) in problem.y.iter().enumerate() {
            for (i, k) in (0..self.gamma.len()).flat_map(|i| (0..i).map(move |k| (i, k))) {
                let (Some(first), Some(second)) = (&self.gamma[i][output], &self.gamma[k][output]) else { continue };
                let product = arena.mul(first[k], second[i]);
                if arena.is_zero(product) || arena.depends_on(product, &problem.signals) {
                    continue;
                }
                let y = arena.of_symbol(*symbol);
                if problem.domain.implies(arena, arena.neg(product), Relation::Positive) {
                    let angle = arena.mul(root(problem, arena.neg(product)), y);
                    found.extend([Function::Sin, Function::Cos].map(|f| arena.call(f, &[angle])));
                } else if problem.domain.implies(arena, product, Relation::Positive) {
                    let power = arena.mul(root(problem, product), y);
                    found.extend([power, arena.neg(power)].map(|e| arena.call(Function::Exp, &[e])));
                }
            }
        }
        found.retain(|e| problem.exists(*e));
        found
    }

    /// The functions whose sum s may be, where T is among these functions.
    pub(in crate::search) fn shifts(&self, problem: &Problem<'_>, factors: &[Expr]) -> Vec<Expr> {
        let arena = problem.arena;
        let mut found: Vec<Expr> = Vec::new();
        for (output, symbol) in problem.y.iter().enumerate() {
            let Some(row) = &self.shift[output] else { continue };
            for slope in row.iter().filter(|slope| !arena.is_zero(**slope)) {
                for factor in factors {
                    let whole = arena.mul(*slope, *factor);
                    let Some(integral) = antiderivative(arena, &problem.domain, whole, *symbol) else { continue };
                    for term in terms(problem, integral) {
                        if !found.contains(&term) && problem.exists(term) {
                            found.push(term);
                        }
                    }
                }
            }
        }
        found
    }
}

/// For each hidden symbol a row for the independence of a rate, with a column for each derivative of T, those of one
/// state in sequence, then for each derivative of s, then for each entry of T.
pub(in crate::search) fn conditions(
    problem: &Problem<'_>,
    rates: &BTreeMap<Symbol, Expr>,
) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    if (problem.x.len() + problem.y.len()) * problem.y.len() > MOST_DERIVATIVES {
        return Err(Obstacle::TooLarge);
    }
    let of = |symbols: &[Symbol]| symbols.iter().map(|symbol| rates[symbol]).collect::<Vec<Expr>>();
    let moving = of(&problem.y);
    let mut exprs = Vec::new();
    for x in &problem.x {
        exprs.extend(moving.iter().map(|rate| arena.mul(arena.of_symbol(*x), *rate)));
    }
    exprs.extend(&moving);
    exprs.extend(of(&problem.x));
    let along = |symbol| exprs.iter().map(|e| arena.derivative(*e, symbol)).collect::<Vec<Expr>>();
    Ok(problem.hidden.iter().map(|symbol| along(*symbol)).collect())
}

/// The positive root, without one where it can be.
fn root(problem: &Problem<'_>, square: Expr) -> Expr {
    let arena = problem.arena;
    let root = arena.sqrt(square);
    let tidied = || {
        let field = Field::over(arena, &problem.domain.facts, &[root]).ok()?;
        Some(field.show(&field.fraction(root).ok()?))
    };
    tidied().unwrap_or(root)
}

/// A function with these derivatives by outputs, as far as it is found.
pub(in crate::search) fn potential(problem: &Problem<'_>, gradient: &[(Symbol, Expr)]) -> Option<Expr> {
    let arena = problem.arena;
    let mut total = arena.zero();
    for (symbol, slope) in gradient {
        let known = arena.derivative(total, *symbol);
        let mut missing = arena.sub(*slope, known);
        if !arena.is_zero(known) {
            // The contribution of the first integrals along this output cancels in a normal form.
            let field = Field::over(arena, &problem.domain.facts, &[missing]).ok()?;
            missing = field.show(&field.fraction(missing).ok()?);
        }
        if !arena.is_zero(missing) {
            total = arena.add(total, antiderivative(arena, &problem.domain, missing, *symbol)?);
        }
    }
    Some(total)
}

/// `exp` of a sum, with powers in place of multiples of logarithms.
pub(in crate::search) fn exponential(problem: &Problem<'_>, expr: Expr) -> Expr {
    let arena = problem.arena;
    let (mut powers, mut rest) = (Vec::new(), Vec::new());
    for term in summands(problem, expr) {
        let factors = match arena.node(term) {
            Node::Product(product) => product.factors.clone(),
            _ => vec![(term, 1.into())],
        };
        let logarithm = factors.iter().find_map(|(base, exponent)| match arena.node(*base) {
            Node::Call(Function::Log, arguments) if exponent.is_one() => Some((*base, arguments[0])),
            _ => None,
        });
        match logarithm {
            Some((call, base)) => {
                let exponent = arena.div(term, call);
                // The sign of a component is free: whole powers need no absolute value.
                let whole = arena.as_number(exponent).is_some_and(|number| number.is_integer());
                let base = match arena.node(base) {
                    Node::Call(Function::Abs, inner) if whole => inner[0],
                    _ => base,
                };
                powers.push(arena.raise(base, exponent));
            }
            None => rest.push(term),
        }
    }
    let rest = arena.sum(rest);
    if arena.is_zero(rest) {
        return arena.product(powers);
    }
    powers.push(arena.call(Function::Exp, &[rest]));
    arena.product(powers)
}

fn summands(problem: &Problem<'_>, expr: Expr) -> Vec<Expr> {
    match problem.arena.node(expr) {
        Node::Sum(sum) => sum.terms.iter().map(|(term, c)| problem.arena.scale(*term, c)).collect(),
        _ => vec![expr],
    }
}

/// The summands of an expression without their constant factors.
fn terms(problem: &Problem<'_>, expr: Expr) -> Vec<Expr> {
    let arena = problem.arena;
    let bare = |term: Expr| match arena.node(term) {
        Node::Product(product) => {
            let moving = product.factors.iter().filter(|(base, _)| arena.depends_on(*base, &problem.signals));
            arena.multiply(&1.into(), moving.cloned())
        }
        _ => term,
    };
    let found = summands(problem, expr).into_iter().map(bare);
    found.filter(|e| arena.depends_on(*e, &problem.signals)).collect()
}
