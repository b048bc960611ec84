//! Antiderivatives of quotients of sines and cosines of one angle.
//!
//! In: such a quotient, the angle affine in a symbol. Out: another over the same denominator, with logarithms of its factors
//! and a multiple of the symbol, if their undetermined coefficients exist.

use std::collections::BTreeSet;

use pebo_cas::linear::comparison::equations;
use pebo_cas::linear::solve;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Function, Node, Rational, Symbol};

use super::logarithm::logarithm;

/// Quotients of a higher degree are not integrated.
const MOST_DEGREE: u32 = 6;

/// An antiderivative by the symbol; none of other functions, or where it has another form.
pub(in crate::search) fn antiderivative(
    arena: &Arena,
    domain: &Domain,
    expr: Expr,
    symbol: Symbol,
) -> Result<Option<Expr>, Obstacle> {
    let moving = BTreeSet::from([symbol]);
    let field = Field::over(arena, &domain.facts, &[expr])?;
    let fraction = field.fraction(expr)?;
    let held: Vec<u32> =
        fraction.variables().filter(|kernel| arena.depends_on(field.kernel(*kernel), &moving)).collect();
    let angle = |kernel: &Expr| match arena.node(*kernel) {
        Node::Call(Function::Sin | Function::Cos, arguments) => Some(arguments[0]),
        _ => None,
    };
    let angles: Option<BTreeSet<Expr>> = held.iter().map(|kernel| angle(&field.kernel(*kernel))).collect();
    let Some(angles) = angles else { return Ok(None) };
    let mut angles = angles.into_iter();
    let (Some(angle), None) = (angles.next(), angles.next()) else { return Ok(None) };
    if arena.depends_on(arena.derivative(angle, symbol), &moving) {
        return Ok(None);
    }
    let below = fraction.denominator();
    let degree = |poly: &Poly| held.iter().map(|kernel| poly.degree(*kernel)).sum::<u32>();
    let degree = degree(fraction.numerator()).max(degree(below));
    if degree > MOST_DEGREE {
        return Ok(None);
    }
    let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[angle]));
    let bar = field.show(&field.of_polynomial(below)?);
    let mut candidates = vec![arena.of_symbol(symbol)];
    for exponent in 0..=degree + 1 {
        let power = arena.div(arena.power(cosine, &Rational::from(i64::from(exponent))), bar);
        candidates.extend([power, arena.mul(sine, power)]);
    }
    let mut bases = vec![sine, cosine];
    for (factor, _) in below.factored(field.limit())?.factors {
        bases.push(field.show(&field.of_polynomial(&factor)?));
    }
    bases.retain(|base| arena.depends_on(*base, &moving));
    candidates.extend(bases.into_iter().map(|base| logarithm(arena, domain, base)));
    let row: Vec<Expr> = candidates.iter().map(|e| arena.derivative(*e, symbol)).chain([expr]).collect();
    let field = Field::over(arena, &domain.facts, &row)?;
    let Some(coefficients) = solve(&field, equations(&field, &[row], &moving)?, candidates.len())? else {
        return Ok(None);
    };
    let terms = coefficients.iter().zip(&candidates).filter(|(coefficient, _)| !Fraction::is_zero(coefficient));
    let whole = arena.sum(terms.map(|(coefficient, e)| arena.mul(field.show(coefficient), *e)).collect::<Vec<Expr>>());
    let field = Field::over(arena, &domain.facts, &[whole])?;
    Ok(Some(field.show(&field.fraction(whole)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pebo_cas::Relation;
    use pebo_cas::domain::zero::is_zero;

    #[test]
    fn quotients_of_waves_have_integrals_that_their_derivatives_show() {
        let arena = Arena::new();
        let [q, l] = ["q", "l"].map(|name| arena.variable(name));
        let symbol = arena.as_symbol(q).unwrap();
        let mut domain = Domain::default();
        let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[q]));
        domain.facts.assume(sine, Relation::Positive);
        domain.facts.assume(l, Relation::Positive);
        let power = |base, exponent: i64| arena.power(base, &Rational::from(exponent));
        let cases = [
            (power(sine, -2), true),
            (arena.div(arena.add(l, cosine), power(sine, 2)), true),
            (arena.div(cosine, sine), true),
            (arena.div(sine, arena.add(arena.number(2), cosine)), true),
            (power(cosine, -2), true),
            (arena.mul(power(sine, 2), cosine), true),
            // An arc of `tan(q/2)`.
            (arena.div(arena.one(), arena.add(arena.number(2), cosine)), false),
            (arena.mul(q, sine), false),
        ];
        for (slope, is_found) in cases {
            let found = antiderivative(&arena, &domain, slope, symbol).unwrap();
            assert_eq!(found.is_some(), is_found, "{}", arena.print(slope));
            if let Some(found) = found {
                let difference = arena.sub(arena.derivative(found, symbol), slope);
                assert!(is_zero(&arena, difference, &domain), "{}", arena.print(found));
            }
        }
    }
}
