//! Common factors taken out of sums: `a*b + a*c` becomes `a*(b + c)`, one multiplication less.
//!
//! In: expressions. Out: equal expressions that need no more multiplications. A factor that the most
//! summands share goes first; powers and denominators count as factors. No denominator appears that
//! was not there. Numbers are arranged by [`super::numbers`].

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::numbers::Numbers;
use pebo_cas::{Arena, Expr, Node, Rational};

/// A summand: its coefficient and the powers it multiplies.
#[derive(Clone, Debug)]
struct Term {
    coefficient: Rational,
    factors: Vec<(Expr, Rational)>,
}

/// Takes common factors out of every sum, as far as `may_leave` lets a base go. A number beside a base that
/// `is_stored`, for the number of its occurrences, costs nothing.
pub(super) fn factor(
    arena: &Arena,
    exprs: &[Expr],
    may_leave: impl Fn(Expr) -> bool,
    is_stored: impl Fn(Expr, usize) -> bool,
) -> Vec<Expr> {
    let mut numbers = Numbers { arena, is_stored, uses: FxHashMap::default() };
    let all = arena.postorder(exprs);
    let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
    for operand in all.iter().flat_map(|expr| arena.operands(*expr)).chain(exprs.iter().copied()) {
        *uses.entry(operand).or_insert(0) += 1;
    }
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for expr in all {
        let factored = match arena.node(expr) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => expr,
            Node::Sum(sum) => {
                let operands = sum.terms.iter().map(|(term, c)| (known[term], c.clone()));
                let sum = arena.combine(&sum.constant, operands);
                numbers.arranged(factor_sum(arena, sum, &may_leave, &numbers))
            }
            Node::Product(product) => {
                let factors = product.factors.iter().map(|(base, e)| (known[base], e.clone()));
                numbers.arranged(arena.multiply(&product.coefficient, factors))
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Expr> = arguments.iter().map(|a| known[a]).collect();
                arena.call(function, &arguments)
            }
        };
        *numbers.uses.entry(factored).or_insert(0) += uses.get(&expr).copied().unwrap_or(0);
        known.insert(expr, factored);
    }
    exprs.iter().map(|expr| known[expr]).collect()
}

fn factor_sum<S: Fn(Expr, usize) -> bool>(
    arena: &Arena,
    expr: Expr,
    may_leave: &impl Fn(Expr) -> bool,
    numbers: &Numbers<'_, S>,
) -> Expr {
    let Node::Sum(sum) = arena.node(expr) else {
        return expr;
    };
    let mut open: Vec<Term> = sum
        .terms
        .iter()
        .map(|(term, coefficient)| match arena.node(*term) {
            Node::Product(product) => {
                Term { coefficient: coefficient * &product.coefficient, factors: product.factors.clone() }
            }
            _ => Term { coefficient: coefficient.clone(), factors: vec![(*term, Rational::ONE)] },
        })
        .collect();
    let mut done: Vec<(Expr, Rational)> = Vec::new();
    while let Some((base, exponent)) = most_common(&open, may_leave) {
        let (with, without): (Vec<Term>, Vec<Term>) =
            open.into_iter().partition(|term| power_in(term, base, &exponent).is_some());
        open = without;
        let quotients = with.into_iter().map(|term| {
            let mut factors = term.factors;
            for factor in factors.iter_mut().filter(|factor| factor.0 == base) {
                factor.1 -= &exponent;
            }
            (arena.multiply(&Rational::ONE, factors), term.coefficient)
        });
        let inner = arena.combine(&Rational::ZERO, quotients);
        let (sign, inner) = oriented(arena, inner);
        let inner = factor_sum(arena, inner, may_leave, numbers);
        let product = arena.multiply(&Rational::ONE, [(base, exponent), (inner, Rational::ONE)]);
        done.push((numbers.arranged(product), sign));
    }
    done.extend(open.into_iter().map(|term| (arena.multiply(&Rational::ONE, term.factors), term.coefficient)));
    arena.combine(&sum.constant, done)
}

/// The power that the most summands share, two at least; of equals, the base entered first.
fn most_common(terms: &[Term], may_leave: &impl Fn(Expr) -> bool) -> Option<(Expr, Rational)> {
    // By base and side of the fraction: the number of summands and the smallest exponent.
    let mut shared: BTreeMap<(Expr, bool), (usize, Rational)> = BTreeMap::new();
    for (base, exponent) in terms.iter().flat_map(|term| &term.factors) {
        if !may_leave(*base) {
            continue;
        }
        let entry = shared.entry((*base, exponent.is_negative())).or_insert_with(|| (0, exponent.clone()));
        entry.0 += 1;
        if exponent.abs() < entry.1.abs() {
            entry.1 = exponent.clone();
        }
    }
    let mut best: Option<(usize, Expr, Rational)> = None;
    for ((base, _), (count, exponent)) in shared {
        if count >= 2 && best.as_ref().is_none_or(|best| count > best.0) {
            best = Some((count, base, exponent));
        }
    }
    best.map(|(_, base, exponent)| (base, exponent))
}

/// The exponent of the base in a summand, if it is on the same side of the fraction.
fn power_in(term: &Term, base: Expr, exponent: &Rational) -> Option<Rational> {
    let found = term.factors.iter().find(|factor| factor.0 == base)?;
    (found.1.is_negative() == exponent.is_negative()).then(|| found.1.clone())
}

/// A sum as sign times a sum that leads with a positive number: `d - 1` is `-(1 - d)`.
///
/// Beside other summands the sign is free, and both spellings of a difference become one.
fn oriented(arena: &Arena, expr: Expr) -> (Rational, Expr) {
    let minus = Rational::from(-1);
    match arena.node(expr) {
        Node::Sum(sum) if sum.constant.is_negative() => {
            (minus.clone(), arena.combine(&Rational::ZERO, [(expr, minus)]))
        }
        Node::Sum(sum) if sum.constant.is_zero() && sum.terms[0].1.is_negative() => {
            (minus.clone(), arena.combine(&Rational::ZERO, [(expr, minus)]))
        }
        _ => (Rational::ONE, expr),
    }
}
