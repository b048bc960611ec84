//! The factors of a fraction: primes, parts with known signs, and parts with unknown signs.
//!
//! Roots and logarithms of products are products and sums of those of the elements, in order: the first element has the
//! first kernel.

use crate::Integer;
use crate::poly::Poly;

use crate::tower::fraction::{Fraction, primitive};
use crate::tower::sign::Sign;
use crate::tower::{Field, Obstacle};

/// The factors of a fraction without its elements of known sign.
pub(in crate::tower) struct UnsignedFactors {
    /// True if the product must be negated.
    pub negative: bool,
    /// Parts of unknown sign, with their exponents.
    pub parts: Vec<(Poly, i64)>,
}

impl Field<'_> {
    /// Hands over each positive element of a fraction that is not zero, with its exponent, and returns the other
    /// factors.
    pub(in crate::tower) fn elements_of(
        &self,
        fraction: &Fraction,
        each: &mut dyn FnMut(&Poly, i64) -> Result<(), Obstacle>,
    ) -> Result<UnsignedFactors, Obstacle> {
        let mut left = UnsignedFactors { negative: false, parts: Vec::new() };
        for (poly, direction) in [(&fraction.num, 1), (&fraction.den, -1)] {
            let mut primes = |number: &Integer, direction: i64| -> Result<(), Obstacle> {
                let mut powers = prime_powers(number).into_iter();
                powers.try_for_each(|(prime, times)| each(&Poly::constant(prime), direction * i64::from(times)))
            };
            let (content, rest) = primitive(poly);
            primes(&content, direction)?;
            let product = self.product_of(&rest)?;
            left.negative ^= product.negative;
            primes(&product.divisor, -direction)?;
            for (part, times) in product.powers {
                let times = direction * i64::from(times);
                match self.signs().of_part(&part)? {
                    Some(Sign::Negative) => {
                        left.negative ^= times % 2 != 0;
                        each(&-&part, times)?;
                    }
                    Some(_) => each(&part, times)?,
                    None => left.parts.push((part, times)),
                }
            }
        }
        Ok(left)
    }
}

/// The prime factors of a positive integer, small ones by trial; the cofactor counts as one.
fn prime_powers(number: &Integer) -> Vec<(Integer, u32)> {
    const LARGEST: i64 = 1000;
    let mut rest = number.abs();
    let mut powers = Vec::new();
    let mut candidate = 2;
    while candidate <= LARGEST && !rest.is_one() && !rest.is_zero() {
        let prime = Integer::from(candidate);
        let mut times = 0;
        while let Some(quotient) = rest.div_exact(&prime) {
            rest = quotient;
            times += 1;
        }
        if times > 0 {
            powers.push((prime, times));
        }
        candidate += 1;
    }
    if !rest.is_one() && !rest.is_zero() {
        powers.push((rest, 1));
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_products_of_prime_powers() {
        let powers = |number: i64| -> Vec<(String, u32)> {
            prime_powers(&Integer::from(number)).into_iter().map(|(prime, times)| (prime.to_string(), times)).collect()
        };
        let expected = |powers: &[(&str, u32)]| -> Vec<(String, u32)> {
            powers.iter().map(|(prime, times)| ((*prime).to_owned(), *times)).collect()
        };
        for (number, found) in [
            (0, &[][..]),
            (1, &[]),
            (2, &[("2", 1)]),
            (720, &[("2", 4), ("3", 2), ("5", 1)]),
            (997 * 997, &[("997", 2)]),
            (2 * 1009, &[("2", 1), ("1009", 1)]),
            (1009 * 1013, &[("1022117", 1)]),
        ] {
            assert_eq!(powers(number), expected(found), "{number}");
        }
    }
}
