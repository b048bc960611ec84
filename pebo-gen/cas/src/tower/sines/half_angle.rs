//! Half an angle: squares of sums of sines and cosines, which `sin^2 = 1 - cos^2` hides, and the kernels of a half.
//!
//! In: a polynomial over sines and cosines. Out: one whose square it is, up to an integer. With
//! `t = tan(a/2)`, sines and cosines are rational functions of t without relations among them
//! (Weierstrass), so that an ordinary square root of polynomials decides.

use crate::Integer;
use crate::poly::{Monomial, Poly};

use crate::number::rational::half;
use crate::tower::fraction::Fraction;
use crate::tower::kernel::range::{Pair, Range};
use crate::tower::{Field, Obstacle};

/// The greatest number of angles in a square.
const MOST_ANGLES: usize = 3;

/// The greatest number of terms of a polynomial that is tested as a square.
const MOST_TERMS: usize = 60;

impl Field<'_> {
    /// A primitive polynomial and an integer n with `root^2 = n * poly`, if there are any.
    pub(in crate::tower) fn hidden_root(&self, poly: &Poly) -> Result<Option<(Poly, Integer)>, Obstacle> {
        let angles = self.angles_in(poly);
        if angles.is_empty() || angles.len() > MOST_ANGLES || poly.term_count() > MOST_TERMS {
            return Ok(None);
        }
        let mut over_tangents = poly.clone();
        let mut halves = Vec::new();
        for &(cos, sin) in &angles {
            let (converted, half) = self.with_tangent(&over_tangents, cos, sin)?;
            over_tangents = converted;
            halves.push(half);
        }
        let (content, rest) = over_tangents.primitive();
        if content.is_negative() {
            return Ok(None);
        }
        let Some(mut root) = rest.sqrt_exact(self.limit())? else { return Ok(None) };
        for (&(cos, sin), &half) in angles.iter().zip(&halves) {
            root = self.with_sine_and_cosine(&root, cos, sin, half)?;
        }
        let (_, root) = self.reduce(&root)?.primitive();
        let square = self.reduce(&root.mul(&root, self.limit())?)?;
        let multiple = square.content();
        Ok((square == poly.scale(&multiple)).then_some((root, multiple)))
    }

    /// The cosine and sine kernels of the angles with both: over one alone the relation hides no square.
    fn angles_in(&self, poly: &Poly) -> Vec<(u32, u32)> {
        let count = self.round.kernels.borrow().count();
        let pairs = (0..count).filter_map(|cos| Some((cos, self.sine_beside(cos)?)));
        pairs.filter(|(cos, sin)| poly.degree(*cos) > 0 && poly.degree(*sin) > 0).collect()
    }

    /// The numerator over `(1 + t^2)^(2 half)`, with t in place of the sine.
    fn with_tangent(&self, poly: &Poly, cos: u32, sin: u32) -> Result<(Poly, u32), Obstacle> {
        let parts = poly.collect(&[cos, sin]);
        let degree = |m: &Monomial| m.exponent(cos) + m.exponent(sin);
        let half = parts.iter().map(|(m, _)| degree(m)).max().unwrap_or(0).div_ceil(2);
        let t = Poly::variable(sin);
        let square = t.mul(&t, self.limit())?;
        let (denominator, numerator) = (&Poly::one() + &square, &Poly::one() - &square);
        let mut total = Poly::zero();
        for (monomial, coefficient) in parts {
            let mut term = coefficient;
            term = term.mul(&t.scale(&Integer::from(2)).pow(monomial.exponent(sin), self.limit())?, self.limit())?;
            term = term.mul(&numerator.pow(monomial.exponent(cos), self.limit())?, self.limit())?;
            term = term.mul(&denominator.pow(2 * half - degree(&monomial), self.limit())?, self.limit())?;
            total = &total + &term;
        }
        Ok((total, half))
    }

    /// The numerator of `poly(t) / (1 + t^2)^half` in sine and cosine, up to a power of two.
    fn with_sine_and_cosine(&self, poly: &Poly, cos: u32, sin: u32, half: u32) -> Result<Poly, Obstacle> {
        let (c, s) = (Poly::variable(cos), Poly::variable(sin));
        let (up, down) = (&Poly::one() + &c, &Poly::one() - &c);
        let mut total = Poly::zero();
        for (exponent, coefficient) in poly.coefficients_in(sin) {
            let odd = exponent % 2;
            let Some(rest) = half.checked_sub(exponent.div_ceil(2)) else { return Ok(Poly::zero()) };
            let mut term = coefficient.mul(&s.pow(odd, self.limit())?, self.limit())?;
            term = term.mul(&up.pow(rest, self.limit())?, self.limit())?;
            term = term.mul(&down.pow(exponent / 2, self.limit())?, self.limit())?;
            total = &total + &term;
        }
        Ok(total)
    }

    /// Sine and cosine of half an angle, for an angle within a half circle.
    ///
    /// `cos(a/2) = sqrt((1 + cos a)/2)` is not negative for |a| <= pi and not zero for |a| < pi, where
    /// `sin(a/2) = sin(a) / (2 cos(a/2))`; for 0 <= a <= pi, `sin(a/2) = sqrt((1 - cos a)/2)`.
    pub(in crate::tower) fn half_of(&self, (sin, cos): &Pair, range: &Range) -> Result<Option<Pair>, Obstacle> {
        let root = |square: &Fraction| self.root(&self.scale(square, &half())?, &half());
        let half_cos = root(&self.add(&Fraction::one(), cos)?)?;
        if range.is_upper_half() {
            return Ok(Some((root(&self.sub(&Fraction::one(), cos)?)?, half_cos)));
        }
        if !range.is_within_half_turn() || half_cos.is_zero() {
            return Ok(None);
        }
        Ok(Some((self.div(&self.scale(sin, &half())?, &half_cos)?, half_cos)))
    }
}
