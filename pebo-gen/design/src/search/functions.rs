//! The functions of an ansatz for a transform: functions in the plant's own formulas, and their neighbours.

use std::collections::BTreeSet;

use pebo_cas::graph::conditions::Regularity;
use pebo_cas::number::rational::half;
use pebo_cas::solve::cleared;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Function, Node, Rational, Relation, Symbol};

use super::closure::products::terms;
use super::integral::logarithm::logarithm;
use super::problem::Problem;
use super::sample::independent;

/// More products than this are not made of one pool.
const MOST_PRODUCTS: usize = 80;

/// Nor more power products than this of the outputs alone: the null space of as many columns is found in no time.
const MOST_MONOMIALS: usize = 290;

/// Functions of outputs and constants alone: the outputs, such functions in the rates, and their derivatives.
pub(super) fn of_outputs(problem: &Problem<'_>) -> Vec<Expr> {
    let outputs: BTreeSet<Symbol> = problem.y.iter().copied().collect();
    let mut found: Vec<Expr> = problem.y.iter().map(|symbol| problem.arena.of_symbol(*symbol)).collect();
    let is_of_outputs = |e: Expr| {
        let symbols = problem.arena.symbols_of(&[e]);
        !symbols.is_disjoint(&outputs) && symbols.iter().all(|s| outputs.contains(s) || !problem.signals.contains(s))
    };
    let rates: Vec<Expr> = problem.rates.values().copied().collect();
    add_atoms(problem, &rates, &is_of_outputs, &mut found);
    let slopes: Vec<Expr> =
        found.iter().flat_map(|e| problem.y.iter().map(|y| problem.arena.derivative(*e, *y))).collect();
    add_atoms(problem, &slopes, &is_of_outputs, &mut found);
    found.retain(|e| problem.exists(*e));
    found
}

/// Functions of states, and perhaps outputs: the states, and such functions in the rates.
pub(super) fn of_states(problem: &Problem<'_>) -> Vec<Expr> {
    let arena = problem.arena;
    let states = problem.states();
    let known: BTreeSet<Symbol> = problem.y.iter().copied().collect();
    let mut found: Vec<Expr> = problem.x.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let is_of_states = |e: Expr| {
        let symbols = arena.symbols_of(&[e]);
        let admitted = |s: &Symbol| states.contains(s) || known.contains(s) || !problem.signals.contains(s);
        !symbols.is_disjoint(&states) && symbols.iter().all(admitted)
    };
    let rates: Vec<Expr> = problem.rates.values().copied().collect();
    add_atoms(problem, &rates, &is_of_states, &mut found);
    found.retain(|e| problem.exists(*e) && !problem.is_non_smooth_in_states(*e));
    found
}

/// Square roots of positive denominators of the functions, and their reciprocals.
pub(super) fn roots(problem: &Problem<'_>, of: &[Expr]) -> Vec<Expr> {
    let arena = problem.arena;
    let bases = of.iter().filter_map(|e| match arena.node(*e) {
        Node::Product(product) => match product.factors.as_slice() {
            [(base, exponent)] if exponent.is_integer() && exponent.is_negative() => Some(*base),
            _ => None,
        },
        _ => None,
    });
    let positive = bases.filter(|base| problem.domain.implies(arena, *base, Relation::Positive));
    positive.flat_map(|base| [half(), -&half()].map(|exponent| arena.power(base, &exponent))).collect()
}

/// Sine and cosine of the outputs that occur in no rate: equations that do not change along one have solutions that
/// turn with it.
pub(super) fn waves(problem: &Problem<'_>) -> Vec<Expr> {
    let arena = problem.arena;
    let rates: Vec<Expr> = problem.rates.values().copied().collect();
    let known = arena.symbols_of(&rates);
    let cyclic = problem.y.iter().filter(|symbol| !known.contains(symbol));
    cyclic.flat_map(|y| [Function::Sin, Function::Cos].map(|f| arena.call(f, &[arena.of_symbol(*y)]))).collect()
}

/// Logarithms of signals, of sums, and of factors: of states where their sign is known.
pub(super) fn logarithms(problem: &Problem<'_>, of: &[Expr]) -> Vec<Expr> {
    let arena = problem.arena;
    let bases = of.iter().flat_map(|e| match arena.node(*e) {
        Node::Symbol(_) | Node::Sum(_) => vec![*e],
        Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
        _ => Vec::new(),
    });
    let mut found = Vec::new();
    for base in bases {
        let moves = arena.depends_on(base, &problem.signals);
        let logarithm = logarithm(arena, &problem.domain, base);
        let signed = arena
            .domain_conditions(&[logarithm], Regularity::Differentiable)
            .iter()
            .all(|(_, relation)| *relation != Relation::NonZero);
        if moves && !found.contains(&logarithm) && (signed || !arena.depends_on(base, &problem.hidden)) {
            found.push(logarithm);
        }
    }
    found
}

/// Adds the calls, roots and reciprocals in formulas, with the functions that their derivatives lead to.
fn add_atoms(problem: &Problem<'_>, formulas: &[Expr], admits: &impl Fn(Expr) -> bool, found: &mut Vec<Expr>) {
    let arena = problem.arena;
    let mut add = |e: Expr| {
        if !found.contains(&e) && arena.as_number(e).is_none() && admits(e) {
            found.push(e);
        }
    };
    for part in arena.postorder(formulas) {
        match arena.node(part) {
            Node::Call(function, arguments) => {
                add(part);
                let partner = match function {
                    Function::Sin => Some(Function::Cos),
                    Function::Cos => Some(Function::Sin),
                    Function::Sinh => Some(Function::Cosh),
                    Function::Cosh => Some(Function::Sinh),
                    _ => None,
                };
                if let Some(partner) = partner {
                    add(arena.call(partner, &arguments));
                }
                if function == Function::Exp {
                    add(arena.call(Function::Exp, &[arena.neg(arguments[0])]));
                }
            }
            Node::Product(product) => {
                for (base, exponent) in &product.factors {
                    if !exponent.is_integer() {
                        add(arena.power(*base, exponent));
                        add(arena.power(*base, &-exponent));
                    } else if exponent.is_negative() {
                        add(arena.power(*base, &Rational::from(-1)));
                    }
                }
            }
            _ => {}
        }
    }
}

/// The power products of the outputs to a degree, each with its degree as weight, beginning with 1; none where they are
/// too many, or where a rate is no polynomial in the outputs as it is written: `(q - q0)^4` loses digits as a sum.
pub(super) fn monomials(problem: &Problem<'_>, outputs: &[Expr], degree: usize) -> Option<Vec<(Expr, usize)>> {
    let arena = problem.arena;
    let moving: BTreeSet<Symbol> = problem.y.iter().copied().collect();
    let rates: Vec<Expr> = problem.rates.values().copied().collect();
    let is_whole = |part: Expr| match arena.node(part) {
        Node::Call(..) => !arena.depends_on(part, &moving),
        Node::Product(product) => product.factors.iter().all(|(base, exponent)| {
            let is_plain = exponent.is_one() || arena.as_symbol(*base).is_some();
            is_plain && exponent.is_integer() && !exponent.is_negative() || !arena.depends_on(*base, &moving)
        }),
        _ => true,
    };
    if !arena.postorder(&rates).into_iter().all(is_whole) {
        return None;
    }
    let mut found = vec![(arena.one(), 0)];
    let mut last: Vec<(Expr, usize)> = vec![(arena.one(), 0)];
    for weight in 1..=degree {
        let next = last.iter().flat_map(|(product, first)| {
            let with = |(index, factor): (usize, &Expr)| (arena.mul(*product, *factor), index);
            outputs.iter().enumerate().skip(*first).map(with).collect::<Vec<_>>()
        });
        last = next.collect();
        found.extend(last.iter().map(|(product, _)| (*product, weight)));
        if found.len() > MOST_MONOMIALS {
            return None;
        }
    }
    Some(found)
}

/// The products of at most so many of the functions, each with that number as its weight, beginning with 1; without
/// combinations of others.
pub(super) fn products(
    problem: &Problem<'_>,
    functions: &[Expr],
    degree: usize,
) -> Result<Vec<(Expr, usize)>, Obstacle> {
    let arena = problem.arena;
    let mut found = vec![(arena.one(), 0)];
    let mut last: Vec<(Expr, usize)> = vec![(arena.one(), 0)];
    for weight in 1..=degree {
        let mut next = Vec::new();
        for (product, first) in &last {
            for (index, function) in functions.iter().enumerate().skip(*first) {
                next.push((arena.mul(*product, *function), index));
            }
        }
        if found.len() + next.len() > MOST_PRODUCTS {
            break;
        }
        for (product, _) in &next {
            if found.iter().all(|(known, _)| known != product) {
                found.push((*product, weight));
            }
        }
        last = next;
    }
    let kept: BTreeSet<Expr> =
        independent(problem, &found.iter().map(|(e, _)| *e).collect::<Vec<_>>())?.into_iter().collect();
    found.retain(|(e, _)| kept.contains(e));
    Ok(found)
}

/// An identity cleared of the roots and angles around states: of `r - sqrt(p^2 + s^2)` the functions are not separable,
/// of its square they are. The first form that is a combination of products, as later ones may hold for one sign alone:
/// `r^2 - p^2 - 1` leads to `p - sqrt(r^2 - 1)`.
pub(super) fn without_roots(problem: &Problem<'_>, identity: Expr) -> Expr {
    let forms = cleared(problem.arena, &problem.domain, identity, &problem.hidden);
    let is_of_products = |form: &&Expr| matches!(terms(problem, **form, &problem.hidden), Ok(Some(_)));
    forms.iter().find(is_of_products).or(forms.last()).copied().unwrap_or(identity)
}
