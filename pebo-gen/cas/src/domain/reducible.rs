//! Reducible equations: `a^2 - b^2 = 0` on two lines, on one of which a plant may remain.
//!
//! In: a domain with equations. Out: an equation that is a product of factors each of which may be zero, found by
//! linear factors and squares under roots. Holds after: if there is one, a property proved at a point of the domain
//! need not hold at almost every other.

use crate::graph::arena::Arena;
use crate::graph::expr::Expr;
use crate::poly::Poly;
use crate::tower::{Field, Obstacle};
use crate::{Domain, Relation};

/// An equation of the domain, among those of concern, with several factors that may be zero, as the expression that is
/// zero.
pub fn reducible(arena: &Arena, domain: &Domain, concerns: impl Fn(Expr) -> bool) -> Option<Expr> {
    // By the inequalities alone: where the equations hold, each factor is zero or not by the branch.
    let assumed = domain.without_equations();
    let roots = domain.manifold.steps().iter().filter(|step| step.root.is_some()).map(|step| step.equation(arena));
    let equations = roots.chain(domain.manifold.open_equations().iter().copied());
    equations.filter(|equation| concerns(*equation)).find(|equation| {
        // A failed computation does not prove irreducibility.
        factors(arena, &assumed, *equation).map_or(true, |factors| factors.are_several())
    })
}

/// The ways in which an equation may hold.
pub(super) enum Factors {
    /// It is no product, as far as rules find.
    One,
    /// It holds where one of these vanishes; a single one is shorter than the equation.
    Several(Vec<Expr>),
    /// It is a polynomial in one symbol, with perhaps several roots.
    Roots,
}

impl Factors {
    fn are_several(&self) -> bool {
        match self {
            Self::One => false,
            Self::Several(factors) => factors.len() > 1,
            Self::Roots => true,
        }
    }
}

/// The factors of an equation that may vanish by the inequalities of the domain.
pub(super) fn factors(arena: &Arena, domain: &Domain, equation: Expr) -> Result<Factors, Obstacle> {
    let field = Field::over(arena, &domain.facts, &[equation])?;
    let may_vanish = |factor: &Expr| !domain.implies(arena, *factor, Relation::NonZero);
    let fraction = field.fraction(equation)?;
    if fraction.is_zero() {
        return Ok(Factors::One);
    }
    let parts = fraction.numerator().factored(field.limit())?;
    // A number that is not zero has no factors: the equation holds nowhere.
    let is_product = parts.factors.len() != 1 || parts.factors.iter().any(|(_, exponent)| *exponent > 1);
    let (mut found, mut is_divided, mut has_roots) = (Vec::new(), is_product, false);
    for (factor, _) in parts.factors {
        let whole = field.show(&field.of_polynomial(&factor)?);
        if !may_vanish(&whole) {
            is_divided = true;
            continue;
        }
        let roots = factor.variables().iter().find_map(|variable| two_roots(&field, &factor, *variable).transpose());
        if let Some(roots) = roots.transpose()? {
            is_divided = true;
            found.extend(roots.into_iter().filter(may_vanish));
        } else {
            // It may have as many roots as its degree.
            has_roots |= matches!(factor.variables(), [variable] if factor.degree(*variable) > 2);
            found.push(whole);
        }
    }
    Ok(match (has_roots, is_divided) {
        (true, _) => Factors::Roots,
        (false, true) => Factors::Several(found),
        (false, false) => Factors::One,
    })
}

/// The two linear factors of a polynomial that is quadratic in a variable, as expressions: they exist if the
/// discriminant is a positive number times a square.
fn two_roots(field: &Field<'_>, factor: &Poly, variable: u32) -> Result<Option<[Expr; 2]>, Obstacle> {
    if factor.degree(variable) != 2 {
        return Ok(None);
    }
    let mut powers = [Poly::zero(), Poly::zero(), Poly::zero()];
    for (power, coefficient) in factor.coefficients_in(variable) {
        powers[power as usize] = coefficient;
    }
    let [constant, linear, leading] = powers.map(|poly| field.of_polynomial(&poly));
    let (constant, linear, leading) = (constant?, linear?, leading?);
    let product = field.scale(&field.mul(&leading, &constant)?, &4.into())?;
    let discriminant = field.sub(&field.mul(&linear, &linear)?, &product)?;
    if discriminant.is_zero() {
        return Ok(None);
    }
    let parts = discriminant.numerator().factored(field.limit())?;
    if parts.content.is_negative() || parts.factors.iter().any(|(_, exponent)| exponent % 2 != 0) {
        return Ok(None);
    }
    let arena = field.arena();
    let square = field.show(&discriminant);
    let root = parts.factors.iter().map(|(factor, exponent)| {
        Ok(arena.power(field.show(&field.of_polynomial(factor)?), &i64::from(exponent / 2).into()))
    });
    let root = arena.product(root.collect::<Result<Vec<Expr>, Obstacle>>()?);
    let scale = arena.sqrt(arena.div(square, arena.mul(root, root)));
    let root = arena.mul(scale, root);
    // 2 a v + b -+ root
    let middle =
        arena.add(arena.mul(arena.scale(field.show(&leading), &2.into()), field.kernel(variable)), field.show(&linear));
    Ok(Some([arena.sub(middle, root), arena.add(middle, root)]))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::domain::manifold::Manifold;

    #[test]
    fn equations_that_hold_in_several_ways_are_found() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let square = |e| arena.mul(e, e);
        let apart = |equations: &[Expr], positive: &[Expr]| {
            let mut domain = Domain::default();
            for fact in positive {
                domain.facts.assume(*fact, Relation::Positive);
            }
            let symbols = [a, b, c].iter().filter_map(|e| arena.as_symbol(*e)).collect();
            domain.manifold = Manifold::new(&arena, &domain.facts, equations.to_vec(), vec![symbols, BTreeSet::new()]);
            reducible(&arena, &domain, |_| true).is_some()
        };
        let one = arena.one();
        let lines = arena.sub(square(a), square(b));
        for (equations, expected) in [
            (vec![lines], true),
            (vec![arena.sub(square(a), one)], true),
            (vec![arena.sub(square(a), arena.scale(square(b), &2.into()))], true),
            (vec![arena.mul(a, arena.sub(b, one))], true),
            (vec![arena.sub(arena.mul(a, square(a)), a)], true),
            (vec![arena.sub(square(a), b), arena.sub(b, square(c))], true),
            (vec![arena.sub(arena.add(square(a), square(b)), one)], false),
            (vec![arena.sub(square(a), b)], false),
            (vec![arena.mul(a, arena.add(square(b), one))], false),
            (vec![arena.sub(a, b), arena.sub(b, c)], false),
        ] {
            let text: Vec<String> = equations.iter().map(|e| arena.print(*e)).collect();
            assert_eq!(apart(&equations, &[]), expected, "{text:?}");
        }
        assert!(!apart(&[lines], &[a, b]));
        assert!(!apart(&[arena.sub(square(a), one)], &[a]));
    }
}
