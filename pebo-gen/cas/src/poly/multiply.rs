//! Products.
//!
//! Every product of two terms is computed once and added to a sum per monomial. The sums are in an array indexed by the
//! exponents if the box of exponents is not much larger than the number of products, else in a hash table, whose keys
//! are sorted at the end. They are words, double words, or integers of any size, by the sizes of the coefficients.

use super::boxed::ExponentBox;
use super::layout::{Exponents, Layout, MAX_WORDS};
use super::sums::{CoefficientSum, PackedFactor, PackedTerms};
use super::work::{TooLarge, Work, steps};
use super::{Poly, hashed, packed};
use crate::Integer;

impl Poly {
    /// The product.
    pub fn mul(&self, other: &Self, work: &Work) -> Result<Self, TooLarge> {
        if self.is_zero() || other.is_zero() {
            return Ok(Self::zero());
        }
        work.begin(steps(self.term_count() + other.term_count()))?;
        let (bits, other_bits) = (self.bits(), other.bits());
        let pairs = steps(self.term_count()).saturating_mul(steps(other.term_count()));
        work.spend(pairs.saturating_mul(bits.div_ceil(64)).saturating_mul(other_bits.div_ceil(64)))?;
        let (layout, degrees) = self.product_layout(other)?;
        let (left, right) = (self.keys_in(&layout), other.keys_in(&layout));
        if self.term_count() == 1 || other.term_count() == 1 {
            let (keys, coefficients) = single(&left, &right, &self.coefficients, &other.coefficients);
            return Ok(Self::from_sorted(layout, keys, coefficients));
        }
        let fewer = self.term_count().min(other.term_count());
        let bits = bits + other_bits + u64::from(usize::BITS - fewer.leading_zeros());
        if let Some((keys, coefficients)) = packed::product(&layout, self, other, bits) {
            return Ok(Self::from_sorted(layout, keys, coefficients));
        }
        let (keys, coefficients) = match (self.small_coefficients(), other.small_coefficients()) {
            (Some(a), Some(b)) if bits <= 63 => {
                product::<i64>(&layout, &degrees, &factor(&left, &a), &factor(&right, &b))
            }
            (Some(a), Some(b)) if bits <= 127 => {
                product::<i128>(&layout, &degrees, &factor(&left, &a), &factor(&right, &b))
            }
            _ => product::<Integer>(
                &layout,
                &degrees,
                &factor(&left, &self.coefficients),
                &factor(&right, &other.coefficients),
            ),
        }?;
        Ok(Self::from_sorted(layout, keys, coefficients))
    }

    /// The power, by repeated multiplication: for a sparse polynomial that is less work than by repeated squaring
    /// (Fateman, 1974). For a dense one in one variable it is that of an integer.
    pub fn pow(&self, exponent: u32, work: &Work) -> Result<Self, TooLarge> {
        if self.term_count() <= 1 {
            return self.power_of_term(exponent, work);
        }
        let degree = self.degrees().first().copied().unwrap_or(0);
        let layout = self.layout.widened(u64::from(degree) * u64::from(exponent))?;
        // As for products: the number of terms, and the words of each.
        let terms = u64::from(degree).saturating_mul(u64::from(exponent));
        let words = self.bits().saturating_mul(u64::from(exponent)) / 64 + 1;
        if layout.variables().len() == 1 && exponent > 1 {
            work.spend(terms.saturating_mul(words))?;
        }
        if let Some((keys, coefficients)) = packed::power(&layout, self, exponent)? {
            return Ok(Self::from_sorted(layout, keys, coefficients));
        }
        let mut power = Self::one();
        for _ in 0..exponent {
            power = power.mul(self, work)?;
        }
        Ok(power)
    }

    fn power_of_term(&self, exponent: u32, work: &Work) -> Result<Self, TooLarge> {
        let Some((monomial, coefficient)) = self.leading_term() else {
            return Ok(if exponent == 0 { Self::one() } else { Self::zero() });
        };
        let bits = if coefficient.bits() < 2 { 1 } else { coefficient.bits() };
        work.spend(bits.saturating_mul(u64::from(exponent)) / 64)?;
        let powers: Option<Vec<_>> =
            monomial.powers().iter().map(|(v, e)| Some((*v, e.checked_mul(exponent)?))).collect();
        let monomial = super::Monomial::new(powers.ok_or(TooLarge)?);
        Self::from_terms([(monomial, coefficient.pow(exponent))])
    }

    /// The coefficients as words, if all of them fit.
    pub(super) fn small_coefficients(&self) -> Option<Vec<i64>> {
        self.coefficients.iter().map(Integer::to_i64).collect()
    }

    /// The layout that holds the product, and its degrees.
    fn product_layout(&self, other: &Self) -> Result<(Layout, Exponents), TooLarge> {
        let union = self.layout.union(&other.layout);
        let mut degrees = Exponents::from_elem(0, union.variables().len());
        let mut largest = 0;
        for poly in [self, other] {
            for (variable, degree) in poly.variables().iter().zip(poly.degrees()) {
                if let Some(index) = union.position(*variable) {
                    // Each is below 2^31.
                    degrees[index] += degree;
                    largest = largest.max(degrees[index].into());
                }
            }
        }
        let layout = union.widened(largest)?;
        if layout.words() > MAX_WORDS { Err(TooLarge) } else { Ok((layout, degrees)) }
    }
}

fn factor<'a, C>(keys: &'a [u64], coefficients: &'a [C]) -> PackedFactor<'a, C> {
    PackedFactor { keys, coefficients }
}

/// The product if one factor, or both, is a single term: nothing coincides, the order is kept.
fn single(left: &[u64], right: &[u64], a: &[Integer], b: &[Integer]) -> PackedTerms {
    let (one, many, term, rest) = if a.len() == 1 { (left, right, &a[0], b) } else { (right, left, &b[0], a) };
    let keys = many.chunks_exact(one.len()).flat_map(|key| key.iter().zip(one).map(|(x, y)| x + y));
    (keys.collect(), rest.iter().map(|coefficient| coefficient * term).collect())
}

/// The terms of a product, where its layout and degrees are known.
fn product<S: CoefficientSum>(
    layout: &Layout,
    degrees: &[u32],
    left: &PackedFactor<'_, S::Factor>,
    right: &PackedFactor<'_, S::Factor>,
) -> Result<PackedTerms, TooLarge> {
    let pairs = left.coefficients.len().saturating_mul(right.coefficients.len());
    match ExponentBox::new(layout, degrees, pairs.saturating_mul(2)) {
        Some(cells) => Ok(cells.product::<S>(left, right)),
        None => hashed::product::<S>(layout.words(), left, right),
    }
}
