//! Reducible equations: `a^2 - b^2 = 0` on two lines, on one of which a plant may remain.
//!
//! In: a domain with equations. Out: an equation that may hold in several ways: a product of factors each of which may
//! be zero, found by linear factors and squares under roots, or one of several that are solved at once. Holds after: if
//! there is one, a property proved at a point of the domain need not hold at almost every other.

use crate::graph::arena::Arena;
use crate::graph::expr::Expr;
use crate::poly::{Monomial, Poly};
use crate::tower::{Field, Obstacle};
use crate::{Domain, Integer, Relation};

/// An equation of the domain, among those of concern, with several factors that may be zero, as the expression that is
/// zero.
pub fn reducible(arena: &Arena, domain: &Domain, concerns: impl Fn(Expr) -> bool) -> Option<Expr> {
    // By the inequalities alone: where the equations hold, each factor is zero or not by the branch.
    let assumed = domain.without_equations();
    let roots = domain.manifold.steps().iter().filter(|step| step.root.is_some()).map(|step| step.equation(arena));
    let equations = roots.chain(domain.manifold.open_equations().iter().copied());
    let by_factors = equations.filter(|equation| concerns(*equation)).find(|equation| {
        // A failed computation does not prove irreducibility.
        holds_in_several_ways(arena, &assumed, *equation).unwrap_or(true)
    });
    by_factors.or_else(|| domain.manifold.coupled(arena).filter(|equation| concerns(*equation)))
}

fn holds_in_several_ways(arena: &Arena, domain: &Domain, equation: Expr) -> Result<bool, Obstacle> {
    match factors(arena, domain, equation)? {
        Factors::One => Ok(false),
        Factors::Open => Ok(true),
        Factors::Several(ways) => match ways.as_slice() {
            [] => Ok(false),
            // Each is shorter than the equation.
            [parts] => parts
                .iter()
                .try_fold(false, |several, part| Ok(several || holds_in_several_ways(arena, domain, *part)?)),
            _ => Ok(true),
        },
    }
}

/// The ways in which an equation may hold.
pub(super) enum Factors {
    /// It is no product, as far as rules find.
    One,
    /// It holds where all of one of these vanish; a single one is shorter than the equation.
    Several(Vec<Vec<Expr>>),
    /// It perhaps has several roots, or factors that no rule finds.
    Open,
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
    let (mut found, mut is_divided, mut is_open) = (Vec::new(), is_product, false);
    for (factor, _) in parts.factors {
        let whole = field.show(&field.of_polynomial(&factor)?);
        if !may_vanish(&whole) {
            is_divided = true;
            continue;
        }
        if let Some(parts) = squares(&field, &factor) {
            is_divided = true;
            found.push(parts);
            continue;
        }
        let (mut factors, mut is_hidden) = (None, false);
        for variable in factor.variables() {
            match two_roots(&field, domain, &factor, *variable)? {
                Some(TwoRoots::Factors(two)) => {
                    factors = Some(two);
                    break;
                }
                Some(TwoRoots::Unknown) => is_hidden = true,
                None => {}
            }
        }
        if let Some(factors) = factors {
            is_divided = true;
            found.extend(factors.into_iter().filter(may_vanish).map(|factor| vec![factor]));
        } else {
            is_open |= is_hidden;
            // It may have as many roots as its degree, or factors that no rule finds.
            is_open |= match factor.variables() {
                [variable] => factor.degree(*variable) > 2,
                variables => variables.iter().all(|v| factor.degree(*v) > 2) && !factor.is_proved_irreducible(),
            };
            found.push(vec![whole]);
        }
    }
    // Of a square that is shown as such, as `1 - cos(q)` in the half angle, nothing is shorter.
    is_divided &= !matches!(found.as_slice(), [only] if only == &[equation]);
    Ok(match (is_open, is_divided) {
        (true, _) => Factors::Open,
        (false, true) => Factors::Several(found),
        (false, false) => Factors::One,
    })
}

/// The expressions that all vanish where a sum of squares does: `a^2 + b^4` where a and b are zero.
fn squares(field: &Field<'_>, factor: &Poly) -> Option<Vec<Expr>> {
    let negative = factor.leading_coefficient().is_negative();
    let is_square = |(monomial, coefficient): &(Monomial, &Integer)| {
        coefficient.is_negative() == negative && monomial.powers().iter().all(|(_, exponent)| exponent % 2 == 0)
    };
    if factor.term_count() < 2 || !factor.terms().all(|term| is_square(&term)) {
        return None;
    }
    let arena = field.arena();
    let root =
        |monomial: &Monomial| arena.product(monomial.powers().iter().map(|(variable, _)| field.kernel(*variable)));
    Some(factor.terms().map(|(monomial, _)| root(&monomial)).collect())
}

/// The factors of a polynomial that is quadratic in a power of a variable.
enum TwoRoots {
    /// They vanish nowhere else.
    Factors([Expr; 2]),
    /// There are two, which were not found.
    Unknown,
}

/// The two factors of a polynomial that is quadratic in a power of a variable, as expressions: they exist if the
/// discriminant is a positive number times a square.
fn two_roots(field: &Field<'_>, domain: &Domain, factor: &Poly, variable: u32) -> Result<Option<TwoRoots>, Obstacle> {
    let half = factor.degree(variable) / 2;
    let coefficients = factor.coefficients_in(variable);
    if half == 0 || coefficients.iter().any(|(power, _)| ![0, half, 2 * half].contains(power)) {
        return Ok(None);
    }
    let mut powers = [Poly::zero(), Poly::zero(), Poly::zero()];
    for (power, coefficient) in coefficients {
        powers[(power / half) as usize] = coefficient;
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
    // (2 a v^half + b - root) (2 a v^half + b + root) is the polynomial times 4 a, which may vanish elsewhere.
    let unknown = arena.power(field.kernel(variable), &i64::from(half).into());
    let leading = field.show(&leading);
    let middle = arena.add(arena.mul(arena.scale(leading, &2.into()), unknown), field.show(&linear));
    let factors = [arena.sub(middle, root), arena.add(middle, root)];
    if domain.grants(arena, (leading, Relation::NonZero)) {
        return Ok(Some(TwoRoots::Factors(factors)));
    }
    let whole = field.show(&field.of_polynomial(factor)?);
    let primitive = without_content(arena, domain, factors, field.kernel(variable))?;
    let field = Field::over(arena, &domain.facts, &[primitive.as_slice(), &[whole]].concat())?;
    let product = field.mul(&field.fraction(primitive[0])?, &field.fraction(primitive[1])?)?;
    let is_whole = field.div(&product, &field.fraction(whole)?)?.to_constant().is_some();
    Ok(Some(if is_whole { TwoRoots::Factors(primitive) } else { TwoRoots::Unknown }))
}

/// Polynomials without the common factors of their coefficients in a variable.
fn without_content(
    arena: &Arena,
    domain: &Domain,
    polynomials: [Expr; 2],
    variable: Expr,
) -> Result<[Expr; 2], Obstacle> {
    let field = Field::over(arena, &domain.facts, &[polynomials.as_slice(), &[variable]].concat())?;
    let own = field.fraction(variable)?;
    let primitive = |polynomial: Expr| -> Result<Expr, Obstacle> {
        let numerator = field.fraction(polynomial)?.numerator().clone();
        let content = numerator.content_in(own.numerator().variables(), field.limit())?;
        let rest = numerator.div_exact(&content, field.limit())?.unwrap_or(numerator);
        Ok(field.show(&field.of_polynomial(&rest)?))
    };
    Ok([primitive(polynomials[0])?, primitive(polynomials[1])?])
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

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
        let curve = |a, b| arena.sum([arena.mul(a, square(a)), arena.mul(a, b), arena.mul(b, square(b)), one]);
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
            // A sum of squares is one place; beside another factor it is a second.
            (vec![arena.add(square(a), square(b))], false),
            (vec![arena.mul(arena.add(square(a), square(b)), arena.sub(square(a), b))], true),
            // Equations that no formula solves one after the other.
            (vec![curve(a, b), curve(b, c)], true),
            (vec![curve(a, b)], false),
        ] {
            let text: Vec<String> = equations.iter().map(|e| arena.print(*e)).collect();
            assert_eq!(apart(&equations, &[]), expected, "{text:?}");
        }
        assert!(!apart(&[lines], &[a, b]));
        assert!(!apart(&[arena.sub(square(a), one)], &[a]));
    }

    /// `2*(a - b*c)^2 - d^2` is a product of two, also as a quadratic in b, whose leading coefficient vanishes with c.
    #[test]
    fn factors_vanish_nowhere_else() {
        let arena = Arena::new();
        let names = ["a", "b", "c", "d"].map(|name| arena.variable(name));
        for turn in 0..4 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|place| names[(place + turn) % 4]);
            let square = |e| arena.mul(e, e);
            let difference = arena.sub(a, arena.mul(b, c));
            let whole = arena.sub(arena.scale(square(difference), &2.into()), square(d));
            let Ok(Factors::Several(ways)) = factors(&arena, &Domain::default(), whole) else { panic!("two factors") };
            let ways: Vec<Expr> = ways.concat();
            assert_eq!(ways.len(), 2);
            for zero in [b, c] {
                let at_zero = BTreeMap::from([(arena.as_symbol(zero).unwrap(), arena.zero())]);
                let vanishes = |way: &Expr| arena.is_zero(arena.substitute(*way, &at_zero));
                assert!(!ways.iter().any(vanishes), "{}", arena.print(ways[0]));
            }
        }
    }
}
