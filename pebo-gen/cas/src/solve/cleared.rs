//! Equations cleared of inverse functions, roots and denominators around their unknowns.
//!
//! In: a difference that vanishes, and the unknowns in it. Out: others that vanish with it, in which the unknowns are
//! more often linear: `s*sin(v) - p*cos(v)` for `v - atan2(p, s)`, `p - v^2` for `v - sqrt(p)`, `p - v*(1 + p)` for
//! `v - p/(1 + p)`. The steps are taken as they come; the caller proves their result.

use std::collections::BTreeSet;

use super::equation::Equation;
use super::quadratic::without_roots;
use super::turned_once;
use crate::forms::opaque::OpaqueTerms;
use crate::graph::function::Function;
use crate::tower::{Field, Obstacle};
use crate::{Arena, Domain, Expr, Node, Symbol};

/// The forms of `difference = 0`, those with fewer steps first.
pub fn cleared(arena: &Arena, domain: &Domain, difference: Expr, unknown: &BTreeSet<Symbol>) -> Vec<Expr> {
    let mut equation = Equation { formula: difference, value: arena.zero() };
    let mut forms = vec![difference];
    while let Some(inner) = turned_once(arena, domain, equation, unknown).or_else(|| angle_apart(arena, equation)) {
        equation = inner;
        forms.extend(without_angle(arena, equation));
    }
    if without_angle(arena, equation).is_none() {
        forms.push(arena.sub(equation.formula, equation.value));
    }
    let mut found = Vec::new();
    for form in forms {
        for above in above_the_line(arena, domain, form, unknown).unwrap_or_default() {
            if above != difference && !found.contains(&above) {
                found.push(above);
            }
        }
    }
    found
}

/// The one angle by its sides in a sum, on a side of its own: a bearing is one less the heading of the vehicle.
fn angle_apart(arena: &Arena, Equation { formula, value }: Equation) -> Option<Equation> {
    let Node::Sum(sum) = arena.node(formula) else { return None };
    let is_angle = |term: Expr| {
        let Node::Call(function, _) = arena.node(term) else { return false };
        matches!(function, Function::Atan2 | Function::Atan | Function::Asin | Function::Acos)
    };
    let (angles, rest): (Vec<_>, Vec<_>) = sum.terms.iter().cloned().partition(|(term, _)| is_angle(*term));
    let [(angle, slope)] = angles.as_slice() else { return None };
    let rest = arena.combine(&sum.constant, rest);
    Some(Equation { formula: *angle, value: arena.scale(arena.sub(value, rest), &slope.recip()?) })
}

/// An angle or tangent, as a relation of its sides.
fn without_angle(arena: &Arena, Equation { formula, value }: Equation) -> Option<Expr> {
    let Node::Call(function, arguments) = arena.node(formula) else { return None };
    let of = |function, angle| arena.call(function, &[angle]);
    let sides = match (function, arguments.as_ref()) {
        (Function::Atan2, [y, x]) => [arena.mul(of(Function::Sin, value), *x), arena.mul(of(Function::Cos, value), *y)],
        (Function::Tan, [angle]) => [arena.mul(value, of(Function::Cos, *angle)), of(Function::Sin, *angle)],
        _ => return None,
    };
    Some(arena.sub(sides[0], sides[1]))
}

/// The numerator, as it is and without the roots over unknowns.
fn above_the_line(
    arena: &Arena,
    domain: &Domain,
    form: Expr,
    unknown: &BTreeSet<Symbol>,
) -> Result<Vec<Expr>, Obstacle> {
    // Known terms are opaque: an exponential of a sum that is split overflows where the sum is small.
    let mut opaque = OpaqueTerms::new(arena, unknown);
    let form = opaque.replace(&[form])[0];
    let field = Field::over(arena, &domain.facts, &[form])?;
    let above = field.fraction(form)?.numerator().clone();
    let rational = without_roots(&field, above.clone(), unknown)?;
    [above, rational].iter().map(|poly| Ok(opaque.restore(field.show(&field.of_polynomial(poly)?)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rational;
    use crate::Relation;

    #[test]
    fn equations_are_cleared_around_unknowns() {
        let arena = Arena::new();
        let [p, s, v, k] = ["p", "s", "v", "k"].map(|name| arena.variable(name));
        let unknown = arena.symbols_of(&[p, s]);
        let mut domain = Domain::default();
        domain.facts.assume(k, Relation::Positive);
        let call = |function, argument| arena.call(function, &[argument]);
        let one = arena.one();
        let share = arena.div(p, arena.add(one, p));
        let norm = arena.sqrt(arena.add(arena.mul(p, p), arena.mul(s, s)));
        let cases = [
            (share, "p*(1 - v) - v"),
            (arena.div(p, s), "p - s*v"),
            (arena.sqrt(p), "p - v^2"),
            (norm, "p^2 + s^2 - v^2"),
            (arena.add(p, arena.sqrt(s)), "v^2 - s + p*(p - 2*v)"),
            (arena.call(Function::Atan2, &[p, s]), "s*sin(v) - p*cos(v)"),
            (
                arena.sub(arena.call(Function::Atan2, &[p, k]), s),
                "p*(sin(v)*sin(s) - cos(v)*cos(s)) + k*(sin(v)*cos(s) + cos(v)*sin(s))",
            ),
            (arena.sub(call(Function::Asin, p), s), "p - sin(v)*cos(s) - cos(v)*sin(s)"),
            (call(Function::Tan, p), "v*cos(p) - sin(p)"),
            (call(Function::Atan, arena.div(p, k)), "p - k*tan(v)"),
            // The exponential of a sum is not split.
            (arena.add(k, call(Function::Log, share)), "p*(1 - exp(v - k)) - exp(v - k)"),
            (arena.power(arena.add(k, p), &Rational::new(1, 3).unwrap()), "p + k - v^3"),
        ];
        for (value, expected) in cases {
            let forms = cleared(&arena, &domain, arena.sub(v, value), &unknown);
            let shown: Vec<String> = forms.iter().map(|form| arena.print(*form)).collect();
            assert!(shown.iter().any(|form| form == expected), "{}: {shown:?}", arena.print(value));
        }
    }
}
