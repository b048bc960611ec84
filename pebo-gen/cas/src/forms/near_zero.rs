//! Functions less their value at 0, written so that the difference keeps its digits where the argument is small.
//!
//! In: an expression. Out: the same value, with `2*sin(x/2)^2` in place of `1 - cos(x)`, `2*sinh(x/2)^2` in place of
//! `cosh(x) - 1`, and `r/(sqrt(k^2 + r) + k)` in place of `sqrt(k^2 + r) - k`, also with a common factor.
//! Holds after: the form has a value wherever the expression has.

use rustc_hash::FxHashMap;

use crate::graph::function::Function;
use crate::{Arena, Expr, Node, Rational, Sum};

/// The expression with such differences written anew; none if there are none.
pub(crate) fn near_zero(arena: &Arena, expr: Expr) -> Option<Expr> {
    let mut forms: FxHashMap<Expr, Expr> = FxHashMap::default();
    for part in arena.postorder(&[expr]) {
        let rebuilt = arena.rebuild(part, &forms);
        let form = match arena.node(rebuilt) {
            Node::Sum(sum) => paired(arena, &sum),
            _ => rebuilt,
        };
        forms.insert(part, form);
    }
    let form = forms[&expr];
    (form != expr).then_some(form)
}

/// The value of a function at 0, and the function less that.
struct Difference {
    at_zero: Rational,
    form: Expr,
}

/// The sum with each term that holds such a function combined with the term it cancels against.
fn paired(arena: &Arena, sum: &Sum) -> Expr {
    let mut terms: Vec<(Expr, Rational)> = sum.terms.clone();
    terms.push((arena.one(), sum.constant.clone()));
    for index in 0..terms.len() {
        let (term, coefficient) = terms[index].clone();
        for (rest, difference) in differences(arena, term) {
            let there = &coefficient * &difference.at_zero;
            // The other sign, and at least as large: the remainder keeps its sign.
            let partner = terms.iter().position(|(other, of_other)| {
                *other == rest && of_other.is_negative() != there.is_negative() && of_other.abs() >= there.abs()
            });
            if let Some(partner) = partner {
                terms[partner].1 = &terms[partner].1 + &there;
                terms[index].0 = arena.mul(rest, difference.form);
                break;
            }
        }
    }
    arena.sum(terms.into_iter().map(|(term, coefficient)| arena.scale(term, &coefficient)))
}

/// The functions among the factors of a term, each with the other factors.
fn differences(arena: &Arena, term: Expr) -> Vec<(Expr, Difference)> {
    match arena.node(term) {
        Node::Call(..) => {
            difference(arena, term, &Rational::ONE).map(|found| (arena.one(), found)).into_iter().collect()
        }
        Node::Product(product) => product
            .factors
            .iter()
            .filter_map(|(base, exponent)| {
                let found = difference(arena, *base, exponent)?;
                Some((arena.div(term, arena.power(*base, exponent)), found))
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// A power less its value at zero: of its function's argument, or of the terms beside the constant in its radicand.
fn difference(arena: &Arena, base: Expr, exponent: &Rational) -> Option<Difference> {
    let two = Rational::from(2);
    let half = Rational::new(1, 2)?;
    let squared = |function, argument| arena.power(arena.call(function, &[arena.scale(argument, &half)]), &two);
    match arena.node(base) {
        Node::Call(Function::Cos, argument) if exponent.is_one() => {
            let form = arena.scale(squared(Function::Sin, argument[0]), &-&two);
            Some(Difference { at_zero: Rational::ONE, form })
        }
        Node::Call(Function::Cosh, argument) if exponent.is_one() => {
            let form = arena.scale(squared(Function::Sinh, argument[0]), &two);
            Some(Difference { at_zero: Rational::ONE, form })
        }
        Node::Sum(radicand) if *exponent == half && !radicand.constant.is_negative() => {
            let at_zero = radicand.constant.sqrt_exact().filter(|root| !root.is_zero())?;
            let beside = arena.sub(base, arena.number(radicand.constant.clone()));
            let over = arena.add(arena.sqrt(base), arena.number(at_zero.clone()));
            Some(Difference { at_zero, form: arena.div(beside, over) })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(build: impl Fn(&Arena, [Expr; 3]) -> Expr) -> Option<String> {
        let arena = Arena::new();
        let symbols = ["a", "x", "w"].map(|name| arena.variable(name));
        near_zero(&arena, build(&arena, symbols)).map(|form| arena.print(form))
    }

    #[test]
    fn a_function_less_its_value_at_zero_is_a_square_or_a_quotient() {
        let cos = |arena: &Arena, x| arena.call(Function::Cos, &[x]);
        let cosh = |arena: &Arena, x| arena.call(Function::Cosh, &[x]);
        let root = |arena: &Arena, w, constant: i64| arena.sqrt(arena.add(arena.mul(w, w), arena.number(constant)));
        assert_eq!(shown(|arena, [_, x, _]| arena.sub(arena.one(), cos(arena, x))).unwrap(), "2*sin(x/2)^2");
        assert_eq!(shown(|arena, [_, x, _]| arena.sub(cosh(arena, x), arena.one())).unwrap(), "2*sinh(x/2)^2");
        assert_eq!(
            shown(|arena, [_, _, w]| arena.sub(root(arena, w, 4), arena.number(2))).unwrap(),
            "w^2/(sqrt(w^2 + 4) + 2)"
        );
        // With factors, beside other terms, and with a larger constant than needed.
        assert_eq!(
            shown(|arena, [a, x, w]| arena.sum([arena.mul(a, cos(arena, x)), arena.neg(a), w])).unwrap(),
            "w - 2*a*sin(x/2)^2"
        );
        let both =
            |arena: &Arena, [_, x, w]: [Expr; 3]| arena.sum([cosh(arena, x), root(arena, w, 1), arena.number(-2)]);
        assert_eq!(shown(both).unwrap(), "2*sinh(x/2)^2 + w^2/(sqrt(w^2 + 1) + 1)");
    }

    #[test]
    fn sums_that_do_not_cancel_at_zero_are_unchanged() {
        let cos = |arena: &Arena, x| arena.call(Function::Cos, &[x]);
        assert_eq!(shown(|arena, [_, x, _]| arena.add(arena.one(), cos(arena, x))), None);
        assert_eq!(shown(|arena, [a, x, _]| arena.sub(a, cos(arena, x))), None);
        let half = |arena: &Arena, x| arena.scale(cos(arena, x), &Rational::from(3));
        assert_eq!(shown(|arena, [_, x, _]| arena.sub(arena.one(), half(arena, x))), None);
        assert_eq!(shown(|arena, [_, x, w]| arena.sub(arena.mul(w, x), arena.sqrt(arena.add(x, w)))), None);
    }
}
