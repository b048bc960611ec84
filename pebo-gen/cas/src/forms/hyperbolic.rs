//! `cosh(u)^2 - sinh(u)^2 = 1` in formulas that keep these functions.
//!
//! In: an expression. Out: the same value without such a difference, and with `cosh(u)^2` for `1 + sinh(u)^2`, also
//! with a common factor. The difference has no digits left for large u, and the square has all. The normal form has
//! this relation by exponentials; formulas that keep the functions do not pass through it.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use crate::graph::function::Function;
use crate::{Arena, Expr, Node, Rational, Sum};

/// The expression without such differences; none if there are none.
pub(crate) fn without_differences(arena: &Arena, expr: Expr) -> Option<Expr> {
    let calls = arena.postorder(&[expr]).into_iter();
    let of = |call: Expr| match arena.node(call) {
        Node::Call(Function::Sinh | Function::Tanh, argument) => Some(argument[0]),
        _ => None,
    };
    let arguments: BTreeSet<Expr> = calls.filter_map(of).collect();
    if arguments.is_empty() {
        return None;
    }
    let mut forms: FxHashMap<Expr, Expr> = FxHashMap::default();
    for part in arena.postorder(&[expr]) {
        let rebuilt = arena.rebuild(part, &forms);
        let form = match arena.node(rebuilt) {
            Node::Sum(sum) => gathered(arena, &sum, &arguments).unwrap_or(rebuilt),
            _ => rebuilt,
        };
        forms.insert(part, form);
    }
    let form = forms[&expr];
    (form != expr).then_some(form)
}

/// The sum with two of its terms combined, as often as there are such.
fn gathered(arena: &Arena, sum: &Sum, arguments: &BTreeSet<Expr>) -> Option<Expr> {
    let mut terms: Vec<(Expr, Rational)> = sum.terms.clone();
    terms.push((arena.one(), sum.constant.clone()));
    let mut changed = false;
    for &argument in arguments {
        let square = |function| arena.power(arena.call(function, &[argument]), &Rational::from(2));
        let (sinh, cosh, tanh) = (square(Function::Sinh), square(Function::Cosh), square(Function::Tanh));
        let (one, steep) = (arena.one(), arena.mul(tanh, cosh));
        // The first term and the second with this sign are the third: cosh^2 - sinh^2 = 1, sinh^2 + 1 = cosh^2, and
        // cosh^2 tanh^2 + 1 = cosh^2.
        for (first, second, both, sign) in [(cosh, sinh, one, -1), (sinh, one, cosh, 1), (steep, one, cosh, 1)] {
            while let Some((index, other)) = pair(arena, &terms, (first, second, sign)) {
                terms[index].0 = arena.mul(arena.div(terms[index].0, first), both);
                let _: (Expr, Rational) = terms.remove(other);
                changed = true;
            }
        }
    }
    changed.then(|| arena.sum(terms.into_iter().map(|(term, coefficient)| arena.scale(term, &coefficient))))
}

/// The positions of a term that holds the first factor, and of the same term with the second in its place and this
/// sign.
fn pair(arena: &Arena, terms: &[(Expr, Rational)], (of, with, sign): (Expr, Expr, i64)) -> Option<(usize, usize)> {
    let has = |term: Expr| match (arena.node(term), arena.node(of)) {
        (Node::Product(product), Node::Product(wanted)) => wanted
            .factors
            .iter()
            .all(|(base, exponent)| product.factors.iter().any(|(own, power)| own == base && power >= exponent)),
        _ => false,
    };
    terms.iter().enumerate().filter(|(_, (term, _))| has(*term)).find_map(|(one, (term, coefficient))| {
        let partner = arena.mul(arena.div(*term, of), with);
        let wanted = coefficient * &Rational::from(sign);
        let other = terms.iter().position(|(other, of_other)| *other == partner && *of_other == wanted)?;
        (other != one).then_some((one, other))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_of_hyperbolic_functions_combine() {
        let arena = Arena::new();
        let [m, q] = ["m", "q"].map(|name| arena.variable(name));
        let square = |function| arena.power(arena.call(function, &[q]), &Rational::from(2));
        let (sinh, cosh, tanh) = (square(Function::Sinh), square(Function::Cosh), square(Function::Tanh));
        let one = arena.one();
        for (expr, expected) in [
            (arena.sub(cosh, sinh), "1"),
            (arena.sub(arena.mul(m, cosh), arena.mul(m, sinh)), "m"),
            (arena.div(m, arena.sub(sinh, cosh)), "-m"),
            (arena.sum([arena.mul(m, sinh), m, q]), "q + m*cosh(q)^2"),
            (arena.div(m, arena.add(arena.mul(cosh, tanh), one)), "m/cosh(q)^2"),
        ] {
            assert_eq!(arena.print(without_differences(&arena, expr).unwrap()), expected);
        }
        for expr in [arena.add(cosh, sinh), arena.sub(arena.mul(m, cosh), sinh), arena.sub(sinh, one), cosh] {
            assert_eq!(without_differences(&arena, expr), None, "{}", arena.print(expr));
        }
    }
}
