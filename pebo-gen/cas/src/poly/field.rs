//! The prime fields of one machine word.
//!
//! Products are reduced without division (Montgomery, 1985): a residue is stored as itself times
//! 2^64, which is why it is a type of its own and not a number.

use crate::{Integer, Rational};

/// Integers modulo an odd prime below 2^63.
#[derive(Clone, Debug)]
pub struct PrimeField {
    prime: u64,
    /// `-1 / prime` modulo 2^64.
    negative_inverse: u64,
    one: Residue,
    /// 2^128 modulo the prime, which brings numbers into the stored form.
    square: u64,
}

/// An element of a [`PrimeField`]; equal residues of one field are equal elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Residue(u64);

impl Residue {
    /// The neutral element of addition, of any field.
    pub const ZERO: Self = Self(0);

    /// True if this is zero.
    pub fn is_zero(self) -> bool {
        self.0 == 0
    }
}

impl PrimeField {
    /// The field of 2^61 - 1, for single images.
    pub(super) const MERSENNE: Self = Self::of_odd((1 << 61) - 1);

    /// The fields of the largest primes below 2^62, for divisors that are lifted.
    pub(super) const LARGE: [Self; 4] = [
        Self::of_odd((1 << 62) - 57),
        Self::of_odd((1 << 62) - 87),
        Self::of_odd((1 << 62) - 117),
        Self::of_odd((1 << 62) - 143),
    ];

    /// The field of a prime; `None` if the number is not an odd prime below 2^63.
    pub fn new(prime: u64) -> Option<Self> {
        if prime < 3 || prime.is_multiple_of(2) || prime >= 1 << 63 {
            return None;
        }
        let field = Self::of_odd(prime);
        field.is_field().then_some(field)
    }

    /// The field of the largest prime below a limit, of at most 2^63.
    pub fn below(limit: u64) -> Option<Self> {
        (3..limit).rev().find_map(Self::new)
    }

    /// The ring of an odd number, a field if it is prime.
    #[expect(clippy::cast_possible_truncation, reason = "remainders by a word are words")]
    const fn of_odd(modulus: u64) -> Self {
        // Newton's iteration doubles the correct low bits: 3, 6, .. 96.
        let mut inverse = modulus;
        let mut correct = 3;
        while correct < 64 {
            inverse = inverse.wrapping_mul(2_u64.wrapping_sub(modulus.wrapping_mul(inverse)));
            correct *= 2;
        }
        let one = ((1_u128 << 64) % modulus as u128) as u64;
        let square = (one as u128 * one as u128 % modulus as u128) as u64;
        let negative_inverse = inverse.wrapping_neg();
        Self { prime: modulus, negative_inverse, one: Residue(one), square }
    }

    /// True if the modulus is prime: Miller's test with the bases that decide below 2^64
    /// (Sorenson and Webster, 2015).
    fn is_field(&self) -> bool {
        let minus_one = self.neg(self.one);
        let shift = (self.prime - 1).trailing_zeros();
        let odd = (self.prime - 1) >> shift;
        [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37].into_iter().all(|base: u64| {
            if base.is_multiple_of(self.prime) {
                return true;
            }
            let mut power = self.pow(self.from_u64(base), odd);
            if power == self.one {
                return true;
            }
            (0..shift).any(|_| {
                let found = power == minus_one;
                power = self.mul(power, power);
                found
            })
        })
    }

    /// The prime.
    pub fn prime(&self) -> u64 {
        self.prime
    }

    /// The neutral element of multiplication.
    pub fn one(&self) -> Residue {
        self.one
    }

    /// The residue of a number.
    pub fn from_u64(&self, value: u64) -> Residue {
        self.mul(Residue(value % self.prime), Residue(self.square))
    }

    /// The residue of an integer.
    pub fn from_integer(&self, value: &Integer) -> Residue {
        self.from_u64(value.rem_u64(self.prime))
    }

    /// The residue of a rational number, unless the prime divides its denominator.
    pub fn from_rational(&self, value: &Rational) -> Option<Residue> {
        if value.is_zero() {
            return Some(Residue::ZERO);
        }
        let numerator = self.from_integer(&value.numerator());
        if value.is_integer() {
            return Some(numerator);
        }
        Some(self.mul(numerator, self.inv(self.from_integer(&value.denominator()))?))
    }

    /// The number of a residue, from 0 to the prime less one.
    pub fn value(&self, a: Residue) -> u64 {
        self.mul(a, Residue(1)).0
    }

    /// The sum.
    #[inline]
    pub fn add(&self, a: Residue, b: Residue) -> Residue {
        let sum = a.0 + b.0;
        Residue(if sum >= self.prime { sum - self.prime } else { sum })
    }

    /// The difference.
    #[inline]
    pub fn sub(&self, a: Residue, b: Residue) -> Residue {
        let (difference, borrowed) = a.0.overflowing_sub(b.0);
        Residue(if borrowed { difference.wrapping_add(self.prime) } else { difference })
    }

    /// The negative.
    pub fn neg(&self, a: Residue) -> Residue {
        self.sub(Residue::ZERO, a)
    }

    /// The product.
    #[inline]
    pub fn mul(&self, a: Residue, b: Residue) -> Residue {
        let wide = u128::from(a.0) * u128::from(b.0);
        #[expect(clippy::cast_possible_truncation, reason = "the low word is what is wanted")]
        let multiple = (wide as u64).wrapping_mul(self.negative_inverse);
        // Below 2^126 + 2^127, and divisible by 2^64.
        let sum = wide + u128::from(multiple) * u128::from(self.prime);
        let reduced = (sum >> 64) as u64;
        Residue(if reduced >= self.prime { reduced - self.prime } else { reduced })
    }

    /// The power.
    pub fn pow(&self, base: Residue, exponent: u64) -> Residue {
        let mut power = self.one;
        for bit in (0..64 - exponent.leading_zeros()).rev() {
            power = self.mul(power, power);
            if exponent >> bit & 1 == 1 {
                power = self.mul(power, base);
            }
        }
        power
    }

    /// The reciprocal; `None` of zero.
    pub fn inv(&self, a: Residue) -> Option<Residue> {
        (!a.is_zero()).then(|| self.pow(a, self.prime - 2))
    }

    /// True if this is the square of an element (Euler's criterion).
    pub fn is_square(&self, a: Residue) -> bool {
        a.is_zero() || self.pow(a, self.prime >> 1) == self.one
    }
}

#[cfg(test)]
mod tests {
    use super::PrimeField;

    #[test]
    fn primes() {
        let small: Vec<u64> = (0..60).filter(|n| PrimeField::new(*n).is_some()).collect();
        assert_eq!(small, [3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59]);
        // Strong pseudoprimes to several bases, Carmichael numbers, squares.
        for composite in [2047, 3_215_031_751, 3_825_123_056_546_413_051, 561, 1_373_653, 10_201] {
            assert!(PrimeField::new(composite).is_none(), "{composite}");
        }
        assert!(PrimeField::new(PrimeField::MERSENNE.prime()).is_some());
        let mut limit = 1 << 62;
        for field in PrimeField::LARGE {
            limit = PrimeField::below(limit).expect("there are many").prime();
            assert_eq!(field.prime(), limit);
        }
    }

    #[test]
    fn arithmetic() {
        for prime in [3, 65_537, (1 << 61) - 1, (1 << 63) - 25] {
            let field = PrimeField::new(prime).expect("prime");
            for seed in 1..200_u64 {
                let (a, b) = (seed.wrapping_mul(0x9e37_79b9_7f4a_7c15), seed.wrapping_mul(seed << 50 | 3));
                let (x, y) = (field.from_u64(a), field.from_u64(b));
                let wide = |value: u128| u64::try_from(value % u128::from(prime)).expect("word");
                assert_eq!(field.value(x), a % prime);
                assert_eq!(field.value(field.mul(x, y)), wide(u128::from(a) * u128::from(b)));
                assert_eq!(field.value(field.add(x, y)), wide(u128::from(a) + u128::from(b)));
                assert_eq!(field.add(field.sub(x, y), y), x);
                assert!(field.is_square(field.mul(x, x)));
                let inverse = field.inv(x).map(|inverse| field.mul(inverse, x));
                assert_eq!(inverse, (!x.is_zero()).then(|| field.one()));
            }
        }
    }
}
