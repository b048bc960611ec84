//! Antiderivatives of simple functions.
//!
//! In: a formula and a symbol. Out: a function whose derivative it is, proved; none where the rules end: sums, powers
//! and functions of affine arguments, products of these with polynomials, `c g' g^n`, and quotients of polynomials, or
//! of sines and cosines.

pub(crate) mod logarithm;
mod rational;
mod trigonometric;

use std::collections::BTreeMap;

use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy;
use pebo_cas::tower::Field;
use pebo_cas::{Arena, Domain, Expr, Function, Node, Rational, Relation, Symbol};

use logarithm::logarithm;

/// Derivatives of a polynomial factor that are taken before it is given up.
const MOST_PARTS: usize = 8;

/// Terms into which a product is multiplied out.
const MOST_TERMS: usize = 64;

/// An antiderivative by the symbol.
pub(super) fn antiderivative(arena: &Arena, domain: &Domain, expr: Expr, symbol: Symbol) -> Option<Expr> {
    let rules = Rules { arena, domain, symbol };
    let found = rules.of(expr).or_else(|| rules.expanded(expr));
    // Terms may have arcs and logarithms that their sum has not.
    let has_calls = found.is_some_and(|e| !tidy::functions(arena, &[e]).is_subset(&tidy::functions(arena, &[expr])));
    let found = match (found, if has_calls || found.is_none() { rules.quotient(expr) } else { None }) {
        (Some(first), Some(other)) => tidy::shorter(arena, first, other),
        (first, other) => first.or(other)?,
    };
    let difference = arena.sub(arena.derivative(found, symbol), expr);
    is_zero(arena, difference, domain).then_some(found)
}

struct Rules<'a> {
    arena: &'a Arena,
    domain: &'a Domain,
    symbol: Symbol,
}

impl Rules<'_> {
    fn is_free(&self, expr: Expr) -> bool {
        !self.arena.symbols_of(&[expr]).contains(&self.symbol)
    }

    /// The slope of an affine function.
    fn slope(&self, expr: Expr) -> Option<Expr> {
        let slope = self.arena.derivative(expr, self.symbol);
        (self.is_free(slope) && !self.arena.is_zero(slope)).then_some(slope)
    }

    fn of(&self, expr: Expr) -> Option<Expr> {
        let arena = self.arena;
        if self.is_free(expr) {
            return Some(arena.mul(expr, arena.of_symbol(self.symbol)));
        }
        match arena.node(expr) {
            Node::Sum(sum) => {
                let constant = arena.mul(arena.number(sum.constant.clone()), arena.of_symbol(self.symbol));
                let terms = sum.terms.iter().map(|(term, c)| Some(arena.scale(self.of(*term)?, c)));
                Some(arena.add(constant, arena.sum(terms.collect::<Option<Vec<_>>>()?)))
            }
            Node::Product(product) => {
                let (fixed, moving): (Vec<_>, Vec<_>) =
                    product.factors.iter().map(|factor| self.raised(factor)).partition(|(base, _)| self.is_free(*base));
                let factor = arena.multiply(&product.coefficient, fixed);
                let integral = match moving.as_slice() {
                    [(base, exponent)] => self.power(*base, exponent),
                    _ => None,
                };
                let rest = arena.multiply(&Rational::ONE, moving.iter().cloned());
                let integral = integral.or_else(|| self.by_parts(&moving)).or_else(|| self.chain(&moving, rest));
                let integral = integral.or_else(|| self.term_by_term(&moving)).or_else(|| self.quotient(rest));
                Some(arena.mul(factor, integral?))
            }
            _ => self.power(expr, &Rational::ONE),
        }
    }

    /// A factor, a power of an exponential as the exponential of a multiple.
    fn raised(&self, (base, exponent): &(Expr, Rational)) -> (Expr, Rational) {
        match self.arena.node(*base) {
            Node::Call(Function::Exp, arguments) => {
                (self.arena.call(Function::Exp, &[self.arena.scale(arguments[0], exponent)]), Rational::ONE)
            }
            _ => (*base, exponent.clone()),
        }
    }

    /// The antiderivative of a power of an affine function, or of a function with an affine argument.
    fn power(&self, base: Expr, exponent: &Rational) -> Option<Expr> {
        let arena = self.arena;
        if let Some(slope) = self.slope(base) {
            let next = exponent + &Rational::ONE;
            let integral = match Rational::ONE.checked_div(&next) {
                Some(scale) => arena.scale(arena.power(base, &next), &scale),
                None => logarithm(arena, self.domain, base),
            };
            return Some(arena.div(integral, slope));
        }
        if *exponent == -pebo_cas::number::rational::half() {
            return self.arc(base);
        }
        let Node::Call(function, arguments) = arena.node(base) else { return None };
        let (argument, slope) = (arguments[0], self.slope(arguments[0])?);
        let call = |function| arena.call(function, &[argument]);
        let integral = match function {
            Function::Exp => {
                let whole = arena.call(Function::Exp, &[arena.scale(argument, exponent)]);
                return Some(arena.div(whole, arena.scale(slope, exponent)));
            }
            _ if !exponent.is_one() => return None,
            Function::Sin => arena.neg(call(Function::Cos)),
            Function::Cos => call(Function::Sin),
            Function::Sinh => call(Function::Cosh),
            Function::Cosh => call(Function::Sinh),
            Function::Tanh => arena.call(Function::Log, &[call(Function::Cosh)]),
            Function::Log => arena.sub(arena.mul(argument, base), argument),
            Function::Atan => {
                let square = arena.add(arena.one(), arena.mul(argument, argument));
                let half = pebo_cas::number::rational::half();
                arena.sub(arena.mul(argument, base), arena.scale(arena.call(Function::Log, &[square]), &half))
            }
            _ => return None,
        };
        Some(arena.div(integral, slope))
    }

    /// The antiderivative of `1/sqrt(a - b s^2)`, an arcsine; of an angle that a sensor shows by its sine.
    fn arc(&self, base: Expr) -> Option<Expr> {
        let arena = self.arena;
        let symbol = arena.of_symbol(self.symbol);
        let first = arena.derivative(base, self.symbol);
        let bend = arena.scale(arena.derivative(first, self.symbol), &-pebo_cas::number::rational::half());
        let at_zero = |expr: Expr| arena.substitute(expr, &BTreeMap::from([(self.symbol, arena.zero())]));
        if !self.is_free(bend) || !arena.is_zero(at_zero(first)) {
            return None;
        }
        let constant = self.tidied(arena.div(at_zero(base), bend))?;
        let is_positive = |expr: Expr| self.domain.implies(arena, expr, Relation::Positive);
        let [reach, steepness] = [self.tidied(arena.sqrt(constant))?, self.tidied(arena.sqrt(bend))?];
        let arc = arena.call(Function::Asin, &[arena.div(symbol, reach)]);
        (is_positive(constant) && is_positive(bend)).then(|| arena.div(arc, steepness))
    }

    /// A polynomial times a sine, cosine or exponential.
    fn by_parts(&self, factors: &[(Expr, Rational)]) -> Option<Expr> {
        let arena = self.arena;
        let is_wave =
            |base: Expr| matches!(arena.node(base), Node::Call(Function::Sin | Function::Cos | Function::Exp, _));
        let (waves, rest): (Vec<_>, Vec<_>) = factors.iter().cloned().partition(|(base, _)| is_wave(*base));
        let [(wave, exponent)] = waves.as_slice() else { return None };
        if !exponent.is_one() {
            return None;
        }
        let (mut slope, mut wave, mut total) = (arena.multiply(&Rational::ONE, rest), *wave, arena.zero());
        for part in 0..MOST_PARTS {
            if arena.is_zero(slope) {
                return Some(total);
            }
            wave = self.of(wave)?;
            let term = arena.mul(slope, wave);
            total = if part % 2 == 0 { arena.add(total, term) } else { arena.sub(total, term) };
            slope = arena.derivative(slope, self.symbol);
        }
        None
    }

    /// `c g' g^n`, which is `c g^(n + 1)/(n + 1)`, for a factor `g^n`.
    fn chain(&self, factors: &[(Expr, Rational)], whole: Expr) -> Option<Expr> {
        let arena = self.arena;
        factors.iter().find_map(|(base, exponent)| {
            let inner = match arena.node(*base) {
                // exp(g) g'
                Node::Call(Function::Exp, arguments) if exponent.is_one() => arguments[0],
                _ => *base,
            };
            let slope = arena.derivative(inner, self.symbol);
            let ratio = arena.div(arena.div(whole, arena.power(*base, exponent)), slope);
            let ratio = self.tidied(ratio)?;
            if !self.is_free(ratio) {
                return None;
            }
            let next = exponent + &Rational::ONE;
            let integral = match (inner == *base, Rational::ONE.checked_div(&next)) {
                (false, _) => *base,
                (true, Some(scale)) => arena.scale(arena.power(*base, &next), &scale),
                (true, None) => logarithm(arena, self.domain, *base),
            };
            Some(arena.mul(ratio, integral))
        })
    }

    /// A product with a sum multiplied out, powers left as they are: `1 + (q - r)^4` is two powers of affine functions.
    fn term_by_term(&self, factors: &[(Expr, Rational)]) -> Option<Expr> {
        let arena = self.arena;
        let terms = |(base, exponent): &(Expr, Rational)| match arena.node(*base) {
            Node::Sum(sum) if exponent.is_one() => Some(sum.terms.len() + 1),
            _ => None,
        };
        let most: usize = factors.iter().filter_map(terms).try_fold(1, usize::checked_mul)?;
        let position = factors.iter().position(|factor| terms(factor).is_some()).filter(|_| most <= MOST_TERMS)?;
        let Node::Sum(sum) = arena.node(factors[position].0) else { return None };
        let others = factors.iter().enumerate().filter(|(index, _)| *index != position);
        let others = arena.multiply(&Rational::ONE, others.map(|(_, factor)| factor.clone()));
        let products = sum.terms.iter().map(|(term, c)| arena.scale(arena.mul(*term, others), c));
        self.of(arena.sum(products.chain([arena.mul(arena.number(sum.constant.clone()), others)])))
    }

    /// A quotient of polynomials in the symbol, or in sine and cosine of an angle.
    fn quotient(&self, expr: Expr) -> Option<Expr> {
        let &Self { arena, domain, symbol } = self;
        let found = rational::antiderivative(arena, domain, expr, symbol).ok()?;
        found.or_else(|| trigonometric::antiderivative(arena, domain, expr, symbol).ok()?)
    }

    fn tidied(&self, expr: Expr) -> Option<Expr> {
        let field = Field::over(self.arena, &self.domain.facts, &[expr]).ok()?;
        Some(field.show(&field.fraction(expr).ok()?))
    }

    /// The terms of the numerator over the denominator, each on its own; a power of one affine function in the
    /// denominator becomes a power of the variable.
    fn expanded(&self, expr: Expr) -> Option<Expr> {
        let arena = self.arena;
        let field = Field::over(arena, &self.domain.facts, &[expr]).ok()?;
        let fraction = field.fraction(expr).ok()?;
        let below = field.show(&field.of_polynomial(fraction.denominator()).ok()?);
        let shifted = self.is_free(below).then(|| (arena.zero(), below)).or_else(|| {
            let factors = match arena.node(below) {
                Node::Product(product) => product.factors.clone(),
                _ => vec![(below, Rational::ONE)],
            };
            let moving: Vec<_> = factors.iter().filter(|(base, _)| !self.is_free(*base)).collect();
            let [(base, exponent)] = moving.as_slice() else { return None };
            let slope = self.slope(*base)?;
            let origin = BTreeMap::from([(self.symbol, arena.zero())]);
            let shift = arena.div(arena.substitute(*base, &origin), slope);
            let rest = arena.div(below, arena.power(*base, exponent));
            let unit = arena.mul(slope, arena.of_symbol(self.symbol));
            Some((shift, arena.mul(rest, arena.power(unit, exponent))))
        });
        let (shift, below) = shifted?;
        // In t = s + shift the denominator is a power of t.
        let moved = arena.sub(arena.of_symbol(self.symbol), shift);
        let above = field.show(&field.of_polynomial(fraction.numerator()).ok()?);
        let above = arena.substitute(above, &BTreeMap::from([(self.symbol, moved)]));
        let field = Field::over(arena, &self.domain.facts, &[above]).ok()?;
        let above = field.fraction(above).ok()?;
        let scale = field.show(&field.of_polynomial(above.denominator()).ok()?);
        let mut total = Vec::new();
        for (monomial, coefficient) in above.numerator().terms() {
            let powers = monomial
                .powers()
                .iter()
                .map(|(kernel, exponent)| (field.kernel(*kernel), Rational::from(i64::from(*exponent))));
            let term = arena.multiply(&Rational::from(coefficient.clone()), powers);
            total.push(self.of(arena.div(term, arena.mul(below, scale)))?);
        }
        let back = arena.add(arena.of_symbol(self.symbol), shift);
        Some(arena.substitute(arena.sum(total), &BTreeMap::from([(self.symbol, back)])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_root_of_what_is_left_of_a_square_is_an_arc() {
        let arena = Arena::new();
        let [q, e, x] = ["q", "e", "x"].map(|name| arena.variable(name));
        let symbol = arena.as_symbol(q).unwrap();
        let mut domain = Domain::default();
        for positive in [e, x] {
            domain.facts.assume(positive, Relation::Positive);
        }
        let square = |expr| arena.mul(expr, expr);
        let root = |above: Expr| arena.power(arena.sub(above, square(q)), &-pebo_cas::number::rational::half());
        let amplitude = arena.div(e, x);
        let cases = [(root(square(e)), "asin(q/e)"), (root(square(amplitude)), "asin(q*x/e)")];
        for (slope, expected) in cases {
            let found = antiderivative(&arena, &domain, slope, symbol).map(|found| arena.print(found));
            assert_eq!(found.as_deref(), Some(expected));
        }
    }

    #[test]
    fn powers_of_differences_are_kept() {
        let arena = Arena::new();
        let [q, r, k] = ["q", "r", "k"].map(|name| arena.variable(name));
        let symbol = arena.as_symbol(q).unwrap();
        let offset = arena.sub(q, r);
        let power = |exponent: i64| arena.power(offset, &Rational::from(exponent));
        let bent = arena.add(arena.one(), power(4));
        let cases = [
            (arena.mul(k, bent), "k*(q + (q - r)^5/5)"),
            (arena.mul(bent, arena.add(k, power(2))), "(q - r)^3/3 + q*k + (q - r)^7/7 + k*(q - r)^5/5"),
        ];
        for (slope, expected) in cases {
            let found = antiderivative(&arena, &Domain::default(), slope, symbol).unwrap();
            assert_eq!(arena.print(found), expected);
        }
    }
}
