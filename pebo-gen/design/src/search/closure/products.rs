//! Formulas as sums of products of hidden symbols, and reciprocals of sums of them, with known coefficients.

use std::collections::BTreeSet;

use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Rational, Symbol};

use crate::search::problem::Problem;

/// A product of hidden symbols, perhaps divided by polynomials in them, with its coefficient.
pub(in crate::search) struct Term {
    pub(in crate::search) product: Expr,
    pub(in crate::search) coefficient: Expr,
}

/// The terms of a formula; none where hidden symbols occur in functions, or with known signals in a factor of the
/// denominator.
pub(in crate::search) fn terms(
    problem: &Problem<'_>,
    formula: Expr,
    hidden: &BTreeSet<Symbol>,
) -> Result<Option<Vec<Term>>, Obstacle> {
    let arena = problem.arena;
    let field = Field::over(arena, &problem.domain.facts, &[formula])?;
    let fraction = field.fraction(formula)?;
    // Of an angle by its sides, as in a left inverse, the sides alone are left in its sine.
    let occurring: BTreeSet<u32> = fraction.variables().collect();
    let kernels: Vec<u32> = field.kernels_of(hidden).intersection(&occurring).copied().collect();
    if kernels.iter().any(|kernel| arena.as_symbol(field.kernel(*kernel)).is_none()) {
        return Ok(None);
    }
    let known = field.kernels_of(&problem.signals.difference(hidden).copied().collect());
    let hidden = kernels.iter().copied().collect();
    let Some([divisor, rest]) = apart(&field, fraction.denominator(), [&hidden, &known])? else { return Ok(None) };
    let divisor = field.show_factored(&field.quotient(&Poly::one(), &divisor)?);
    let mut terms = Vec::new();
    for (monomial, coefficient) in fraction.numerator().collect(&kernels) {
        let powers = monomial.powers().iter().map(|(kernel, power)| (field.kernel(*kernel), i64::from(*power).into()));
        let product = arena.mul(arena.multiply(&Rational::ONE, powers), divisor);
        terms.push(Term { product, coefficient: field.show(&field.quotient(&coefficient, &rest)?) });
    }
    Ok(Some(terms))
}

/// A polynomial as a product: of the factors that hold hidden kernels, and of the others; none where a factor holds
/// known ones too.
pub(in crate::search) fn apart(
    field: &Field<'_>,
    polynomial: &Poly,
    [hidden, known]: [&BTreeSet<u32>; 2],
) -> Result<Option<[Poly; 2]>, Obstacle> {
    let (work, mut of_hidden) = (field.limit(), Poly::one());
    for (factor, power) in polynomial.factored(work)?.factors {
        let holds = |kernels: &BTreeSet<u32>| factor.variables().iter().any(|kernel| kernels.contains(kernel));
        match (holds(hidden), holds(known)) {
            (true, true) => return Ok(None),
            (true, false) => of_hidden = of_hidden.mul(&factor.pow(power, work)?, work)?,
            (false, _) => {}
        }
    }
    let rest = polynomial.div_exact(&of_hidden, work)?;
    Ok(rest.map(|rest| [of_hidden, rest]))
}
