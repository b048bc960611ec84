//! Functions of unmeasured states that outputs show, in formulas.
//!
//! In: a formula. Out: the same on the identities of the plant, by division: a product of hidden functions that leads
//! one of them is replaced by the rest of it. With `c = cos(p)` measured, the rate `w*cos(p)` of `sin(p)` is `w*c`; with
//! `q = d*sqrt(h)` the rate of `d^2*h` loses its root.

use pebo_cas::poly::{Monomial, Poly};
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Domain, Expr, Rational, Relation};

use super::Plant;

/// Steps of a division, after which it is given up: each lowers the degree, or leaves one term for others of its degree.
const MOST_STEPS: usize = 200;

/// A product of hidden kernels, and what it is by an identity.
struct Rule {
    leading: Monomial,
    rest: Fraction,
}

impl Plant {
    /// A formula with known signals in place of the products of unmeasured signals that identities show.
    pub(crate) fn shown(&self, domain: &Domain, formula: Expr) -> Result<Expr, Obstacle> {
        let identities: Vec<Expr> = self.identities.iter().map(|identity| identity.expr).collect();
        if identities.is_empty() {
            return Ok(formula);
        }
        let field = Field::over(&self.arena, &domain.facts, &[&[formula], identities.as_slice()].concat())?;
        let hidden: Vec<u32> = field.kernels_of(&self.hidden()).into_iter().collect();
        let mut rules = Vec::new();
        for identity in identities {
            rules.extend(rule(&field, domain, identity, &hidden)?);
        }
        let fraction = field.fraction(formula)?;
        let sides = [fraction.numerator(), fraction.denominator()].map(|side| field.of_polynomial(side));
        let [above, below] = sides.map(|side| divided(&field, side?, &rules, &hidden));
        match (above?, below?) {
            (Some(above), Some(below)) if !below.is_zero() => Ok(field.show(&field.div(&above, &below)?)),
            _ => Ok(formula),
        }
    }
}

/// A polynomial in hidden kernels divided by the rules; none where that does not end soon, or a rule divides by them.
fn divided(
    field: &Field<'_>,
    mut fraction: Fraction,
    rules: &[Rule],
    hidden: &[u32],
) -> Result<Option<Fraction>, Obstacle> {
    for _ in 0..MOST_STEPS {
        if fraction.denominator().variables().iter().any(|kernel| hidden.contains(kernel)) {
            return Ok(None);
        }
        let terms = fraction.numerator().collect(hidden);
        let step = terms.iter().find_map(|(monomial, coefficient)| {
            let of = |rule: &Rule| Some((quotient(monomial, &rule.leading)?, rule.rest.clone()));
            rules.iter().find_map(of).map(|(others, rest)| (monomial, coefficient, others, rest))
        });
        let Some((monomial, coefficient, others, rest)) = step else { return Ok(Some(fraction)) };
        let factor = field.quotient(coefficient, fraction.denominator())?;
        let of = |product: &Monomial| field.of_polynomial(&Poly::from_terms([(product.clone(), 1.into())])?);
        let before = field.mul(&factor, &of(monomial)?)?;
        let after = field.mul(&field.mul(&factor, &of(&others)?)?, &rest)?;
        fraction = field.add(&field.sub(&fraction, &before)?, &after)?;
    }
    Ok(None)
}

/// The rule of an identity: its product of highest degree in hidden kernels, where the factor is known and not zero.
fn rule(field: &Field<'_>, domain: &Domain, identity: Expr, hidden: &[u32]) -> Result<Option<Rule>, Obstacle> {
    let fraction = field.fraction(identity)?;
    let terms = fraction.numerator().collect(hidden);
    let Some((leading, factor)) = terms.iter().max_by_key(|(monomial, _)| (monomial.degree(), monomial.clone())) else {
        return Ok(None);
    };
    let shown = field.show(&field.of_polynomial(factor)?);
    if leading.is_one() || !domain.implies(field.arena(), shown, Relation::NonZero) {
        return Ok(None);
    }
    let product = field.of_polynomial(&Poly::from_terms([(leading.clone(), 1.into())])?)?;
    let scaled = field.div(&field.of_polynomial(fraction.numerator())?, &field.of_polynomial(factor)?)?;
    let rest = field.scale(&field.sub(&scaled, &product)?, &Rational::from(-1))?;
    Ok(Some(Rule { leading: leading.clone(), rest }))
}

/// The quotient of two products, if the second divides the first.
fn quotient(product: &Monomial, divisor: &Monomial) -> Option<Monomial> {
    let divides = divisor.powers().iter().all(|(kernel, power)| product.exponent(*kernel) >= *power);
    let power = |(kernel, power): &(u32, u32)| (*kernel, power - divisor.exponent(*kernel));
    divides.then(|| Monomial::new(product.powers().iter().map(power)))
}
