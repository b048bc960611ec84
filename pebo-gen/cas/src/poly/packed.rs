//! Dense polynomials in one variable as single integers: their products and powers are those of the integers.

use super::Poly;
use super::layout::Layout;
use super::sums::PackedTerms;
use super::work::TooLarge;
use crate::Integer;

/// Terms from which on packing pays, if sums of products fit words and if not.
const TERMS_OF_WORDS: usize = 40;
const TERMS_OF_INTEGERS: usize = 8;

/// Powers of polynomials of fewer terms are found by products as quickly.
const TERMS_OF_POWERS: usize = 2;

/// The coefficients of a product with at most so many bits, if its factors are dense and long enough.
pub(super) fn product(layout: &Layout, a: &Poly, b: &Poly, bits: u64) -> Option<PackedTerms> {
    let least = if bits <= 127 { TERMS_OF_WORDS } else { TERMS_OF_INTEGERS };
    if a.term_count().min(b.term_count()) < least || layout.variables().len() != 1 {
        return None;
    }
    let (left, right) = (dense(a)?, dense(b)?);
    // The absolute value and a sign.
    let slot = usize::try_from(bits / 8 + 1).ok()?;
    let whole = &pack(a, slot, left) * &pack(b, slot, right);
    Some(terms(layout, whole.unpacked(slot, left + right - 1)))
}

/// The power of a dense polynomial.
pub(super) fn power(layout: &Layout, a: &Poly, exponent: u32) -> Result<Option<PackedTerms>, TooLarge> {
    if exponent < 2 || a.term_count() < TERMS_OF_POWERS || layout.variables().len() != 1 {
        return Ok(None);
    }
    let Some(places) = dense(a) else { return Ok(None) };
    // A coefficient is at most the power of the sum of all absolute values.
    let bits = (a.bits() + u64::from(usize::BITS - a.term_count().leading_zeros())) * u64::from(exponent);
    let slot = usize::try_from(bits / 8 + 1).map_err(|_| TooLarge)?;
    let whole = pack(a, slot, places).pow(exponent);
    Ok(Some(terms(layout, whole.unpacked(slot, (places - 1) * exponent as usize + 1))))
}

/// The number of coefficients up to the degree, if at least half of them are not zero.
pub(super) fn dense(poly: &Poly) -> Option<usize> {
    let places = poly.degrees().first().map_or(1, |degree| *degree as usize + 1);
    (places <= 2 * poly.term_count()).then_some(places)
}

/// The value at `256^slot`.
pub(super) fn pack(poly: &Poly, slot: usize, places: usize) -> Integer {
    let place = |key| poly.layout.get(key, 0) as usize;
    Integer::packed(poly.keys().map(place).zip(&poly.coefficients).rev(), slot, places)
}

/// The terms with these coefficients by ascending powers, in a layout of one variable that has room for them.
fn terms(layout: &Layout, coefficients: Vec<Integer>) -> PackedTerms {
    let (_, shift) = layout.place(0);
    let mut keys = Vec::with_capacity(coefficients.len());
    let mut kept = Vec::with_capacity(coefficients.len());
    for (exponent, coefficient) in coefficients.into_iter().enumerate().rev() {
        if !coefficient.is_zero() {
            keys.push((exponent as u64) << shift);
            kept.push(coefficient);
        }
    }
    (keys, kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::{Monomial, Work};

    fn poly(terms: u32, step: u32, size: i64) -> Poly {
        let entry = |k: u32| {
            let wave = i64::from((k * 7919) % 1009) - 504;
            (Monomial::new([(0, k * step)]), Integer::from(wave * size + 1))
        };
        Poly::from_terms((0..terms).map(entry)).unwrap()
    }

    #[test]
    fn long_products_are_sums_of_short_ones() {
        let work = Work::new(u64::MAX);
        for (terms, size) in [(160, 3), (200, 1 << 40), (12, 1 << 52)] {
            let (a, b) = (poly(terms, 1, size), poly(terms + 5, 1, -size));
            let term_by_term = b.terms().try_fold(Poly::zero(), |sum, (monomial, coefficient)| {
                Ok::<_, TooLarge>(&sum + &a.mul_term(&monomial, coefficient, &work)?)
            });
            assert_eq!(a.mul(&b, &work), term_by_term, "{terms}, {size}");
        }
    }

    #[test]
    fn powers_are_products() {
        let work = Work::new(u64::MAX);
        for (terms, step, size) in [(2, 1, 1), (3, 1, 1), (3, 2, 1), (30, 1, 1 << 33), (9, 3, 5)] {
            let base = poly(terms, step, size);
            for exponent in 0..7 {
                let product = (0..exponent).try_fold(Poly::one(), |product, _| product.mul(&base, &work));
                assert_eq!(base.pow(exponent, &work), product, "{terms}, {step}, {size}");
            }
        }
    }
}
