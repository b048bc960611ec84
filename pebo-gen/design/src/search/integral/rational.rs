//! Antiderivatives of rational functions.
//!
//! In: a quotient of polynomials in a symbol, over expressions free of it. Out: a rational function, logarithms of the
//! factors of the denominator, and arcs of those of degree two without real roots, if their undetermined coefficients
//! exist (Hermite 1872; of factors of degree one and two that is every antiderivative).

use pebo_cas::linear::{Matrix, solve};
use pebo_cas::number::rational::half;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Function, Rational, Relation, Symbol};

use super::logarithm::logarithm;

/// Quotients of a higher degree are not integrated.
const MOST_DEGREE: u32 = 16;

/// An antiderivative of a quotient of polynomials in the symbol; none of other functions, or where it has another form.
pub(in crate::search) fn antiderivative(
    arena: &Arena,
    domain: &Domain,
    expr: Expr,
    symbol: Symbol,
) -> Result<Option<Expr>, Obstacle> {
    let variable = arena.of_symbol(symbol);
    let field = Field::over(arena, &domain.facts, &[expr, variable])?;
    let moving = field.kernels_of(&[symbol].into());
    let mut moving = moving.into_iter();
    let (Some(kernel), None) = (moving.next(), moving.next()) else { return Ok(None) };
    if field.kernel(kernel) != variable {
        return Ok(None);
    }
    Quotient { arena, domain, field: &field, kernel, variable }.integral(&field.fraction(expr)?)
}

struct Quotient<'a> {
    arena: &'a Arena,
    domain: &'a Domain,
    field: &'a Field<'a>,
    /// The variable, as a kernel of polynomials and as a formula.
    kernel: u32,
    variable: Expr,
}

impl Quotient<'_> {
    fn integral(&self, of: &Fraction) -> Result<Option<Expr>, Obstacle> {
        let &Self { arena, field, kernel, .. } = self;
        let work = field.limit();
        let (above, below) = (of.numerator(), of.denominator());
        if above.degree(kernel).max(below.degree(kernel)) > MOST_DEGREE {
            return Ok(None);
        }
        let mut factors: Vec<(Poly, u32)> = Vec::new();
        let (mut rest, symbol) = (below.clone(), Poly::variable(kernel));
        let mut times = 0;
        while let Some(lower) = rest.div_exact(&symbol, work)? {
            rest = lower;
            times += 1;
        }
        if times > 0 {
            factors.push((symbol, times));
        }
        factors.extend(rest.factored(work)?.factors.into_iter().filter(|(factor, _)| factor.degree(kernel) > 0));
        // below = constant * repeated * single
        let (mut single, mut repeated) = (Poly::one(), Poly::one());
        for (factor, exponent) in &factors {
            single = single.mul(factor, work)?;
            repeated = repeated.mul(&factor.pow(exponent - 1, work)?, work)?;
        }
        let Some(constant) = below.div_exact(&single.mul(&repeated, work)?, work)? else { return Ok(None) };
        // repeated' / repeated = slope / single
        let mut slope = Poly::zero();
        let mut others = Vec::new();
        for (factor, exponent) in &factors {
            let Some(rest) = single.div_exact(factor, work)? else { return Ok(None) };
            let own = factor.derivative(kernel).mul(&rest, work)?;
            slope = &slope + &own.scale(&i64::from(*exponent - 1).into());
            others.push((rest, own));
        }
        let degree = repeated.degree(kernel) + (above.degree(kernel) + 1).saturating_sub(below.degree(kernel));
        let power = |exponent: u32| Poly::variable(kernel).pow(exponent, work);
        let mut columns: Vec<(Expr, Poly)> = Vec::new();
        let bar = field.show(&field.of_polynomial(&repeated)?);
        for exponent in 0..=degree {
            let power = power(exponent)?;
            let column = &power.derivative(kernel).mul(&single, work)? - &power.mul(&slope, work)?;
            let function = arena.div(arena.power(self.variable, &Rational::from(i64::from(exponent))), bar);
            columns.push((function, column));
        }
        for ((factor, _), (rest, own)) in factors.iter().zip(&others) {
            let printed = field.show(&field.of_polynomial(factor)?);
            columns.push((logarithm(arena, self.domain, printed), own.mul(&repeated, work)?));
            if let Some(arc) = self.arc(factor)? {
                columns.push((arc, rest.mul(&repeated, work)?));
            }
        }
        let highest = columns.iter().map(|(_, column)| column.degree(kernel)).chain([above.degree(kernel)]).max();
        let mut rows = vec![vec![Fraction::zero(); columns.len() + 1]; highest.map_or(0, |degree| degree as usize + 1)];
        for (index, column) in columns.iter().map(|(_, column)| column).chain([above]).enumerate() {
            for (degree, coefficient) in column.coefficients_in(kernel) {
                rows[degree as usize][index] = field.of_polynomial(&coefficient)?;
            }
        }
        let Some(coefficients) = solve(field, Matrix::new(rows), columns.len())? else { return Ok(None) };
        let constant = field.of_polynomial(&constant)?;
        let mut terms = Vec::new();
        for ((function, _), coefficient) in columns.iter().zip(&coefficients) {
            terms.push(arena.mul(field.show(&field.div(coefficient, &constant)?), *function));
        }
        Ok(Some(arena.sum(terms)))
    }

    /// The antiderivative of `1/(a s^2 + b s + c)`, where that has no real roots.
    fn arc(&self, factor: &Poly) -> Result<Option<Expr>, Obstacle> {
        let &Self { arena, field, kernel, .. } = self;
        if factor.degree(kernel) != 2 {
            return Ok(None);
        }
        let mut coefficients = [Fraction::zero(), Fraction::zero(), Fraction::zero()];
        for (degree, coefficient) in factor.coefficients_in(kernel) {
            coefficients[degree as usize] = field.of_polynomial(&coefficient)?;
        }
        let [c, b, a] = &coefficients;
        let b = field.scale(b, &half())?;
        let square = field.sub(&field.mul(a, c)?, &field.mul(&b, &b)?)?;
        let square = field.show(&square);
        if !self.domain.implies(arena, square, Relation::Positive) {
            return Ok(None);
        }
        let root = arena.sqrt(square);
        let line = arena.add(arena.mul(field.show(a), self.variable), field.show(&b));
        Ok(Some(arena.div(arena.call(Function::Atan, &[arena.div(line, root)]), root)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pebo_cas::domain::zero::is_zero;

    #[test]
    fn quotients_have_integrals_that_their_derivatives_show() {
        let arena = Arena::new();
        let [q, a] = ["q", "a"].map(|name| arena.variable(name));
        let symbol = arena.as_symbol(q).unwrap();
        let mut domain = Domain::default();
        domain.facts.assume(a, Relation::Positive);
        let power = |base, exponent: i64| arena.power(base, &Rational::from(exponent));
        let one_more = |e| arena.add(arena.one(), e);
        let cases = [
            // (1 - q^2)/(q (q^2 + 1))
            (arena.div(arena.sub(arena.one(), power(q, 2)), arena.mul(q, one_more(power(q, 2)))), true),
            (arena.div(arena.one(), arena.add(a, power(q, 2))), true),
            (arena.div(power(q, 3), power(one_more(power(q, 2)), 2)), true),
            (power(one_more(arena.mul(a, power(q, 2))), -3), true),
            (arena.div(one_more(power(q, 5)), arena.mul(power(q, 2), arena.sub(q, a))), true),
            (arena.div(one_more(q), arena.add(one_more(q), power(q, 2))), true),
            // Its arcs hold the roots of a polynomial of degree three.
            (arena.div(arena.one(), arena.add(one_more(q), power(q, 3))), false),
            (arena.call(Function::Sin, &[q]), false),
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
