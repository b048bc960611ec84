//! Divisors of dense polynomials in one variable by those of integers (Char, Geddes and Gonnet 1989).
//!
//! In: two primitive polynomials a and b. Out: their greatest common divisor, or none if the attempt fails. With
//! `c = gcd(a(xi), b(xi))` written in digits of at most `xi/2` in absolute value, c = G(xi); g is G without its
//! content, and if g divides both it is the divisor: else that is `g*q`, and q(xi) divides the content, which is at
//! most `xi/2`. But q divides a, whose roots are less than 1 + |a| in absolute value (Cauchy), so with `xi >= 2|a| + 2`
//! any q that is no number has `|q(xi)| > xi/2`.

use super::super::work::{TooLarge, Work};
use super::super::{Monomial, Poly, packed};

/// Bytes of xi beyond those of the largest coefficient, in turn: a divisor may have larger ones.
const MARGINS: [u64; 2] = [2, 6];

/// Words of an evaluated polynomial from which on images modulo primes are as fast.
const MOST_WORDS: u64 = 4000;

/// The divisor, if it is found.
pub(super) fn divisor(a: &Poly, b: &Poly, work: &Work) -> Result<Option<Poly>, TooLarge> {
    let (&[variable], Some(left), Some(right)) = (a.variables(), packed::dense(a), packed::dense(b)) else {
        return Ok(None);
    };
    for margin in MARGINS {
        // At least 256 times the required value.
        let bytes = a.bits().max(b.bits()) / 8 + margin;
        let words = bytes.saturating_mul(left.max(right) as u64) / 8 + 1;
        if words > MOST_WORDS {
            return Ok(None);
        }
        work.spend(words * words / 4)?;
        let slot = usize::try_from(bytes).map_err(|_| TooLarge)?;
        let common = packed::pack(a, slot, left).gcd(&packed::pack(b, slot, right));
        let places = usize::try_from(common.bits() / 8).map_err(|_| TooLarge)? / slot + 2;
        let coefficients = (0_u32..).zip(common.unpacked(slot, places)).filter(|(_, c)| !c.is_zero());
        let (_, found) = Poly::from_terms(coefficients.map(|(k, c)| (Monomial::new([(variable, k)]), c)))?.primitive();
        if found.degree(variable) > a.degree(variable).min(b.degree(variable)) {
            continue;
        }
        if a.div_exact(&found, work)?.is_some() && b.div_exact(&found, work)?.is_some() {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Integer;

    fn poly(terms: u32, seed: u32, size: i64) -> Poly {
        let entry = |k: u32| {
            let wave = i64::from((k * 7919 + seed * 131) % 1009) - 504;
            (Monomial::new([(3, k)]), Integer::from(wave * size + 1))
        };
        Poly::from_terms((0..terms).map(entry)).unwrap().primitive().1
    }

    #[test]
    fn common_factors_are_found_whole() {
        let work = Work::new(u64::MAX);
        for (terms, size) in [(2, 1), (5, 1), (30, 3), (12, 1 << 40)] {
            let [g, a, b] = [poly(terms, 5, size), poly(terms + 3, 1, size), poly(terms + 1, 77, size)];
            assert_eq!(divisor(&a, &b, &work), Ok(Some(Poly::one())), "{terms}, {size}");
            let [x, y] = [&a, &b].map(|part| part.mul(&g, &work).unwrap());
            assert_eq!(divisor(&x, &y, &work), Ok(Some(g.clone())), "{terms}, {size}");
            let square = x.mul(&g, &work).unwrap();
            assert_eq!(divisor(&square, &x, &work), Ok(Some(x)), "{terms}, {size}");
        }
    }
}
