//! Equations that are quadratic in a power of one kernel of one unknown, also after removal of a square root.
//!
//! In: a difference that vanishes, with one unknown. Out: the equations `kernel = root`, a root each; the caller
//! selects the unknown's.

use std::collections::BTreeSet;

use super::equation::{Equation, unpower};
use crate::number::rational::half;
use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Arena, Domain, Expr, Integer, Rational, Symbol};

/// The number of square roots that are removed: each doubles the degree.
const MOST_ROOTS: usize = 2;

/// The roots of a difference in the kernel that holds the unknown; none for any other form.
pub(super) fn roots(
    arena: &Arena,
    domain: &Domain,
    difference: Expr,
    unknown: Symbol,
) -> Result<Vec<Equation>, Obstacle> {
    let field = Field::over(arena, &domain.facts, &[difference])?;
    let of_unknown = BTreeSet::from([unknown]);
    let above = field.fraction(difference)?.numerator().clone();
    let poly = without_roots(&field, above, &of_unknown)?;
    let hidden = field.kernels_of(&of_unknown);
    let present: Vec<u32> = poly.variables().iter().copied().filter(|variable| hidden.contains(variable)).collect();
    let [kernel] = present.as_slice() else { return Ok(Vec::new()) };
    let degree = poly.degree(*kernel);
    let [mut a, mut b, mut c] = [Poly::zero(), Poly::zero(), Poly::zero()];
    for (exponent, coefficient) in poly.coefficients_in(*kernel) {
        match exponent {
            0 => c = coefficient,
            _ if exponent == degree => a = coefficient,
            _ if 2 * exponent == degree => b = coefficient,
            _ => return Ok(Vec::new()),
        }
    }
    if c.is_zero() {
        return Ok(Vec::new());
    }
    let powers =
        if b.is_zero() { square_roots(arena, &field, &a, &c, degree)? } else { both(arena, &field, &a, &b, &c)? };
    let (base, step) = (field.kernel(*kernel), if b.is_zero() { degree.div_ceil(2) } else { degree / 2 });
    let step = Rational::from(i64::from(step));
    let roots = powers.into_iter().filter_map(|value| unpower(arena, domain, base, &step, value));
    Ok(roots.map(|inverse| inverse.equation).collect())
}

/// A polynomial that vanishes with this one, with some square roots over unknowns removed.
pub(super) fn without_roots(field: &Field<'_>, mut poly: Poly, unknown: &BTreeSet<Symbol>) -> Result<Poly, Obstacle> {
    for _ in 0..MOST_ROOTS {
        let hidden = field.kernels_of(unknown);
        let Some((root, radicand)) = field.square_roots_in(&poly).into_iter().find(|(root, _)| hidden.contains(root))
        else {
            break;
        };
        // (a + b r)(a - b r) = a^2 - b^2 r^2
        let [mut a, mut b] = [Poly::zero(), Poly::zero()];
        for (exponent, coefficient) in poly.coefficients_in(root) {
            *(if exponent == 0 { &mut a } else { &mut b }) = coefficient;
        }
        let square = b.mul(&b, field.limit())?.mul(&radicand, field.limit())?;
        poly = &a.mul(&a, field.limit())? - &square;
        // Taking the root out of a denominator has brought in its radicand.
        while let Some(quotient) = poly.div_exact(&radicand, field.limit())?
            && !poly.is_zero()
        {
            poly = quotient;
        }
    }
    Ok(poly)
}

/// The values of `v` in `a v^2 + b v + c = 0`, each as a quotient by a sum and as a sum: the one without cancellation
/// keeps its digits.
fn both(arena: &Arena, field: &Field<'_>, a: &Poly, b: &Poly, c: &Poly) -> Result<Vec<Expr>, Obstacle> {
    let four = a.mul(c, field.limit())?.scale(&Integer::from(4));
    let discriminant = &b.mul(b, field.limit())? - &four;
    let common = common_root(&b.primitive().0.abs(), &discriminant.primitive().0.abs());
    let of = |poly: &Poly, scale: &Rational| {
        Ok::<_, Obstacle>(field.show(&field.scale(&field.of_polynomial(poly)?, scale)?))
    };
    let over = Rational::new(1, common).unwrap_or(Rational::ONE);
    let twice = &over * &Rational::from(2);
    let under = field.scale(&field.of_polynomial(&discriminant)?, &(&over * &over))?;
    let root = square_root(arena, field, &under)?;
    let (twice_a, b, twice_c) = (of(a, &twice)?, of(b, &over)?, of(c, &twice)?);
    let (sum, other) = (arena.add(b, root), arena.sub(root, b));
    Ok(vec![
        arena.neg(arena.div(twice_c, sum)),
        arena.div(other, twice_a),
        arena.div(twice_c, other),
        arena.neg(arena.div(sum, twice_a)),
    ])
}

/// A number that divides the first, and its square the second, by small primes only: others would only make the formula
/// longer.
fn common_root(first: &Integer, second: &Integer) -> i64 {
    let mut common = 1;
    for prime in [2, 3, 5, 7] {
        let divides =
            |number: &Integer, by: i64| Rational::new(number.clone(), by).is_some_and(|quotient| quotient.is_integer());
        while common < 1 << 20 && divides(first, common * prime) && divides(second, common * common * prime * prime) {
            common *= prime;
        }
    }
    common
}

/// The two values of `v` in `a v^2 + c = 0`, or the one in `a v + c = 0`, with square factors outside of the root:
/// `z/sqrt(1 - z^2)`, whose sign is that of `z`, for the root of `z^2/(1 - z^2)`.
fn square_roots(arena: &Arena, field: &Field<'_>, a: &Poly, c: &Poly, degree: u32) -> Result<Vec<Expr>, Obstacle> {
    if degree % 2 == 1 {
        let show = |poly: &Poly| Ok::<_, Obstacle>(field.show(&field.of_polynomial(poly)?));
        return Ok(vec![arena.neg(arena.div(show(c)?, show(a)?))]);
    }
    let value = square_root(arena, field, &field.quotient(&-c, a)?)?;
    Ok(vec![value, arena.neg(value)])
}

/// A root of the fraction, with square factors outside: of either sign.
fn square_root(arena: &Arena, field: &Field<'_>, fraction: &Fraction) -> Result<Expr, Obstacle> {
    let (mut outside, mut inside) = (Vec::new(), Vec::new());
    let mut coefficient = Rational::ONE;
    for (part, side) in [(fraction.numerator(), 1), (fraction.denominator(), -1)] {
        let parts = part.square_free(field.limit())?;
        let content = Rational::new(parts.content, 1).and_then(|content| content.pow(side));
        coefficient = &coefficient * &content.unwrap_or(Rational::ONE);
        for (factor, multiplicity) in parts.factors {
            let factor = field.show(&field.of_polynomial(&factor)?);
            outside.push((factor, Rational::from(i64::from(side) * i64::from(multiplicity / 2))));
            inside.push((factor, Rational::from(i64::from(side) * i64::from(multiplicity % 2))));
        }
    }
    // `1 - z^2` rather than `-(z^2 - 1)`.
    if let Some((factor, _)) = inside.iter_mut().find(|(_, power)| coefficient.is_negative() && !power.is_zero()) {
        *factor = arena.neg(*factor);
        coefficient = -&coefficient;
    }
    inside.push((arena.number(coefficient), Rational::ONE));
    let product = |factors| arena.multiply(&Rational::ONE, factors);
    Ok(arena.mul(product(outside), arena.power(product(inside), &half())))
}
