//! Quotients of polynomials over kernels, as values: canonical with respect to the field that makes them.

use crate::poly::Poly;
use crate::{Integer, Rational};

/// A quotient of polynomials, canonical with respect to one [`Field`](super::Field).
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Fraction {
    pub(in crate::tower) num: Poly,
    pub(in crate::tower) den: Poly,
}

impl Fraction {
    /// Zero.
    pub fn zero() -> Self {
        Self { num: Poly::zero(), den: Poly::one() }
    }

    /// One.
    pub fn one() -> Self {
        Self { num: Poly::one(), den: Poly::one() }
    }

    /// A rational number.
    pub fn constant(value: &Rational) -> Self {
        Self { num: Poly::constant(value.numerator()), den: Poly::constant(value.denominator()) }
    }

    /// A polynomial.
    pub(in crate::tower) fn polynomial(num: Poly) -> Self {
        Self { num, den: Poly::one() }
    }

    /// True if this is zero.
    pub fn is_zero(&self) -> bool {
        self.num.is_zero()
    }

    /// True if this is one.
    pub fn is_one(&self) -> bool {
        self.num.is_one() && self.den.is_one()
    }

    /// The value, if this is a number.
    pub fn to_constant(&self) -> Option<Rational> {
        Rational::new(self.num.to_constant()?, self.den.to_constant()?)
    }

    /// The numerator.
    pub fn numerator(&self) -> &Poly {
        &self.num
    }

    /// The denominator.
    pub fn denominator(&self) -> &Poly {
        &self.den
    }

    /// The kernels that occur.
    pub fn variables(&self) -> impl Iterator<Item = u32> + '_ {
        self.num.variables().iter().chain(self.den.variables()).copied()
    }

    /// `-self`
    #[must_use]
    pub fn opposite(&self) -> Self {
        Self { num: -&self.num, den: self.den.clone() }
    }

    /// A measure of how unwieldy this is as a pivot.
    pub(crate) fn weight(&self) -> usize {
        self.num.term_count() + self.den.term_count()
    }
}

/// A positive rational that makes the polynomial primitive, and the primitive polynomial.
pub(in crate::tower) fn primitive(poly: &Poly) -> (Integer, Poly) {
    let content = poly.content();
    match poly.div_integer(&content) {
        Some(rest) if !content.is_zero() => (content, rest),
        _ => (Integer::ONE, poly.clone()),
    }
}
