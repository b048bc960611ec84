//! Sums, differences and multiples by integers: one merge of the terms.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::ops::{Add, Neg, Sub};

use super::Poly;
use super::layout::Layout;
use crate::Integer;

impl Poly {
    /// The keys in another layout, which must hold them.
    pub(super) fn keys_in(&self, layout: &Layout) -> Cow<'_, [u64]> {
        if self.layout == *layout {
            Cow::Borrowed(&self.keys)
        } else {
            Cow::Owned(self.layout.convert(&self.keys, layout))
        }
    }

    /// `self + factor * other`.
    pub(super) fn add_scaled(&self, other: &Self, factor: i64) -> Self {
        let factor = Integer::from(factor);
        let layout = self.layout.union(&other.layout);
        let (left, right) = (self.keys_in(&layout), other.keys_in(&layout));
        let words = layout.words();
        let mut keys = Vec::with_capacity(left.len() + right.len());
        let mut coefficients = Vec::with_capacity(self.term_count() + other.term_count());
        let mut lefts = left.chunks_exact(words).zip(&self.coefficients).peekable();
        let mut rights = right.chunks_exact(words).zip(&other.coefficients).peekable();
        loop {
            let order = match (lefts.peek(), rights.peek()) {
                (None, None) => break,
                (Some(_), None) => Ordering::Greater,
                (None, Some(_)) => Ordering::Less,
                (Some((a, _)), Some((b, _))) => a.cmp(b),
            };
            let a = if order.is_ge() { lefts.next() } else { None };
            let b = if order.is_le() { rights.next() } else { None };
            let (key, sum) = match (a, b) {
                (Some((key, a)), Some((_, b))) => {
                    let mut sum = a.clone();
                    sum.add_product(b, &factor);
                    (key, sum)
                }
                (Some((key, a)), None) => (key, a.clone()),
                (None, Some((key, b))) => (key, b * &factor),
                (None, None) => break,
            };
            if !sum.is_zero() {
                keys.extend_from_slice(key);
                coefficients.push(sum);
            }
        }
        Self::from_sorted(layout, keys, coefficients)
    }

    /// The multiple by an integer.
    pub fn scale(&self, factor: &Integer) -> Self {
        if factor.is_zero() {
            return Self::zero();
        }
        self.map_coefficients(|coefficient| coefficient * factor)
    }

    /// The quotient by an integer, if it divides every coefficient.
    pub fn div_integer(&self, divisor: &Integer) -> Option<Self> {
        let quotients: Option<Vec<_>> =
            self.coefficients.iter().map(|coefficient| coefficient.div_exact(divisor)).collect();
        let (layout, keys) = (self.layout.clone(), self.keys.clone());
        quotients.map(|coefficients| Self { layout, keys, coefficients })
    }

    /// The same monomials with other coefficients, none of them zero.
    pub(super) fn map_coefficients(&self, map: impl Fn(&Integer) -> Integer) -> Self {
        Self {
            layout: self.layout.clone(),
            keys: self.keys.clone(),
            coefficients: self.coefficients.iter().map(map).collect(),
        }
    }
}

impl Add for &Poly {
    type Output = Poly;
    fn add(self, other: &Poly) -> Poly {
        self.add_scaled(other, 1)
    }
}

impl Sub for &Poly {
    type Output = Poly;
    fn sub(self, other: &Poly) -> Poly {
        self.add_scaled(other, -1)
    }
}

impl Neg for &Poly {
    type Output = Poly;
    fn neg(self) -> Poly {
        self.map_coefficients(|coefficient| -coefficient)
    }
}
