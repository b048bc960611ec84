//! Sines and cosines of rational multiples of pi, and the square roots that are among them.
//!
//! In: a multiple of pi. Out: for multiples of pi/12, radicals of two and three; for all others, polynomials in one
//! kernel `x = 2 cos(pi/m)`, whose minimal polynomial is known. The field of that kernel contains square roots of some
//! primes (Gauss, 1811), which are written over it, so that the relation of `cos(pi/5)` and `sqrt(5)` is found.

use crate::graph::function::Function;
use crate::number::rational::half;
use crate::poly::Poly;
use crate::{Integer, Rational};

use super::AlgebraicRelation;
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

/// The largest m in `cos(pi/m)`: the minimal polynomial has a degree below m.
const FINEST: u32 = 240;

impl Field<'_> {
    /// Sine and cosine of a rational multiple of pi.
    pub(in crate::tower) fn multiple_of_pi(&self, factor: &Rational) -> Result<(Fraction, Fraction), Obstacle> {
        let quarters = Rational::from((factor * &Rational::from(2)).floor());
        let rest = factor - &(&quarters * &half());
        let twelfths = &rest * &Rational::from(12);
        let (sin, cos) = match twelfths.to_i64() {
            Some(number) => (self.radical(number)?, self.radical(6 - number)?),
            None => self.cyclotomic(&rest)?,
        };
        Ok(match quarters.numerator().rem_u64(4) {
            0 => (sin, cos),
            1 => (cos, sin.opposite()),
            2 => (sin.opposite(), cos.opposite()),
            _ => (cos.opposite(), sin),
        })
    }

    /// `sin(number * pi/12)` for a number from 0 to 6.
    fn radical(&self, number: i64) -> Result<Fraction, Obstacle> {
        let root_of = |n: i64| self.root(&Fraction::constant(&Rational::from(n)), &half());
        let quarter = |f: &Fraction| self.scale(f, &(&half() * &half()));
        match number {
            0 => Ok(Fraction::zero()),
            1 => quarter(&self.sub(&root_of(6)?, &root_of(2)?)?),
            2 => Ok(Fraction::constant(&half())),
            3 => self.scale(&root_of(2)?, &half()),
            4 => self.scale(&root_of(3)?, &half()),
            5 => quarter(&self.add(&root_of(6)?, &root_of(2)?)?),
            _ => Ok(Fraction::one()),
        }
    }

    /// Sine and cosine of a multiple of pi between 0 and 1/2 that is not one of pi/12.
    fn cyclotomic(&self, rest: &Rational) -> Result<(Fraction, Fraction), Obstacle> {
        let wanted = rest.denominator().to_i64().and_then(|d| u32::try_from(d).ok()).ok_or(Obstacle::TooLarge)?;
        let finest = self.finest.get();
        let needed = lcm(wanted, finest.unwrap_or(2)).filter(|m| *m <= FINEST).ok_or(Obstacle::TooLarge)?;
        if finest != Some(needed) {
            self.finest.set(Some(needed));
            self.round.finer.set(true);
        }
        let times = (rest * &Rational::from(i64::from(needed))).to_i64().ok_or(Obstacle::TooLarge)?;
        let times = u32::try_from(times).map_err(|_| Obstacle::TooLarge)?;
        let double = |times: u32| -> Result<Fraction, Obstacle> {
            self.scale(&Fraction::polynomial(self.double_cosine(needed, times)?), &half())
        };
        Ok((double((needed / 2).abs_diff(times))?, double(times)?))
    }

    /// `2 cos(times * pi/m)` over the kernel `2 cos(pi/m)`.
    fn double_cosine(&self, m: u32, times: u32) -> Result<Poly, Obstacle> {
        let kernel = self.cosine_kernel(m)?;
        let times = times % (2 * m);
        self.reduce(&chebyshev(kernel, times.min(2 * m - times), self)?)
    }

    fn cosine_kernel(&self, m: u32) -> Result<u32, Obstacle> {
        let share = Rational::new(1, i64::from(m)).ok_or(Obstacle::DivisionByZero)?;
        let cosine = self.arena.call(Function::Cos, &[self.arena.scale(self.arena.pi(), &share)]);
        let expr = self.arena.scale(cosine, &Rational::from(2));
        if let Some(number) = self.round.kernels.borrow().number_of(expr) {
            return Ok(number);
        }
        let number = self.enter(expr, None, true);
        let minimal = minimal_polynomial(number, m, self)?;
        let degree = minimal.degree(number);
        let leading = Poly::variable(number).pow(degree, self.limit())?;
        let value = &leading - &minimal;
        self.round.kernels.borrow_mut().relate(number, AlgebraicRelation { degree, value });
        Ok(number)
    }

    /// The square root of a prime, if the kernel's field contains it.
    pub(in crate::tower) fn gauss_sum(&self, prime: &Integer) -> Result<Option<Poly>, Obstacle> {
        let Some(m) = self.finest.get() else { return Ok(None) };
        let Some(p) = prime.to_i64().and_then(|p| u32::try_from(p).ok()) else { return Ok(None) };
        if p == 2 {
            return if m % 4 == 0 { self.double_cosine(m, m / 4).map(Some) } else { Ok(None) };
        }
        if p < 2 || m % p != 0 {
            return Ok(None);
        }
        // The Gauss sum over half the residues: cosines for p = 1 mod 4, sines for p = 3 mod 4.
        let mut total = Poly::zero();
        for k in 1..=(p - 1) / 2 {
            let times = 2 * k * (m / p);
            let term = self.double_cosine(m, if p % 4 == 1 { times } else { (m / 2).abs_diff(times) })?;
            total = if is_residue(k, p) { &total + &term } else { &total - &term };
        }
        Ok(Some(total))
    }
}

/// The polynomial with `V_n(2 cos a) = 2 cos(n a)`.
fn chebyshev(variable: u32, n: u32, field: &Field<'_>) -> Result<Poly, Obstacle> {
    let x = Poly::variable(variable);
    let (mut below, mut value) = (x.clone(), Poly::constant(2));
    for _ in 0..n {
        let next = &x.mul(&value, field.limit())? - &below;
        below = value;
        value = next;
    }
    Ok(value)
}

/// The minimal polynomial of `2 cos(pi/m)`, monic.
///
/// The roots of `V_m + 2` are `2 cos(j pi/m)` for odd j, which are those of m and of m over its odd
/// divisors.
fn minimal_polynomial(variable: u32, m: u32, field: &Field<'_>) -> Result<Poly, Obstacle> {
    let work = field.limit();
    let all = &chebyshev(variable, m, field)? + &Poly::constant(2);
    let mut rest = Poly::one();
    for (factor, _) in all.square_free(work)?.factors {
        rest = rest.mul(&factor, work)?;
    }
    for divisor in (3..=m).step_by(2).filter(|d| m.is_multiple_of(*d)) {
        let other = minimal_polynomial(variable, m / divisor, field)?;
        rest = rest.div_exact(&other, work)?.ok_or(Obstacle::TooLarge)?;
    }
    Ok(rest)
}

fn is_residue(k: u32, p: u32) -> bool {
    (1..=p / 2).any(|i| u64::from(i) * u64::from(i) % u64::from(p) == u64::from(k))
}

fn lcm(a: u32, b: u32) -> Option<u32> {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    (a / x).checked_mul(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Facts;

    /// `2 cos(pi/m)` has degree `phi(2m)/2`: half the odd numbers below 2m that have no factor in common with m.
    #[test]
    fn minimal_polynomials_have_the_degree_of_their_number() {
        let arena = Arena::new();
        let field = Field::over(&arena, &Facts::new(), &[]).unwrap();
        for m in 2..40_u32 {
            let poly = minimal_polynomial(0, m, &field).unwrap();
            let units = (1..2 * m).step_by(2).filter(|j| lcm(*j, m) == Some(j * m)).count();
            assert_eq!(poly.degree(0) as usize, units / 2, "{m}: {poly:?}");
            let x = 2.0 * (std::f64::consts::PI / f64::from(m)).cos();
            let value: f64 = poly
                .terms()
                .map(|(monomial, c)| {
                    Rational::from(c.clone()).to_f64() * x.powi(i32::try_from(monomial.degree()).unwrap())
                })
                .sum();
            // Coefficients up to a binomial of 20, some 2e5, times rounding.
            assert!(value.abs() < 1e-8, "{m}: {value}");
        }
    }

    #[test]
    fn multiples_of_fifteen_degrees_are_radicals() {
        let arena = Arena::new();
        let sine = |n: i64| {
            let call = arena.call(Function::Sin, &[arena.scale(arena.pi(), &Rational::new(n, 12).unwrap())]);
            let field = Field::over(&arena, &Facts::new(), &[call]).unwrap();
            let shown = field.show(&field.fraction(call).unwrap());
            (
                arena.print(shown),
                field.round.kernels.borrow().iter().any(|(_, kernel)| {
                    matches!(arena.node(kernel.expr), crate::Node::Call(Function::Cos | Function::Sin, _))
                }),
            )
        };
        for (n, expected) in [
            (0, "0"),
            (1, "sqrt(2)*(sqrt(3) - 1)/4"),
            (2, "1/2"),
            (3, "sqrt(2)/2"),
            (4, "sqrt(3)/2"),
            (5, "sqrt(2)*(sqrt(3) + 1)/4"),
            (6, "1"),
            (8, "sqrt(3)/2"),
            (14, "-1/2"),
        ] {
            assert_eq!(sine(n), (expected.to_owned(), false), "{n}");
        }
        assert!((1..24).all(|n| !sine(n).1), "no sine or cosine is left");
    }

    #[test]
    fn printed_multiples_of_pi_have_their_value() {
        let arena = Arena::new();
        for (n, d) in [(1, 7), (2, 5), (3, 8), (5, 9)] {
            let angle = arena.scale(arena.pi(), &Rational::new(n, d).unwrap());
            for function in [Function::Sin, Function::Cos] {
                let call = arena.call(function, &[angle]);
                let field = Field::over(&arena, &Facts::new(), &[call]).unwrap();
                let shown = field.show(&field.fraction(call).unwrap());
                let difference = arena.sub(shown, call);
                let apart = arena.separated_from_zero(difference, &crate::graph::enclosure::Point::new());
                assert!(apart.is_none(), "{n}/{d}: {}", arena.print(shown));
            }
        }
    }

    #[test]
    fn quadratic_residues_are_squares() {
        let residues = |p: u32| (1..p).filter(|k| is_residue(*k, p)).collect::<Vec<u32>>();
        assert_eq!(residues(5), [1, 4]);
        assert_eq!(residues(7), [1, 2, 4]);
        assert_eq!(residues(11), [1, 3, 4, 5, 9]);
    }
}
