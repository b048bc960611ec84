//! Sums of many numbers.
//!
//! In: numbers. Out: their sum. Long ones are added over a common denominator and brought to lowest terms once: the
//! denominators of a linear combination have nearly all factors in common, and a greatest common divisor after each
//! addition would cost more than all else.

use crate::cas::integer::Integer;

use super::{Rational, Small};

impl Rational {
    /// The sum.
    pub(in crate::cas) fn total(parts: &[Self]) -> Self {
        if parts.len() < 3 || parts.iter().all(|part| matches!(part.0, Small(..))) {
            return parts.iter().fold(Self::ZERO, |sum, part| &sum + part);
        }
        let mut above = Integer::ZERO;
        let mut below = Integer::ONE;
        for part in parts {
            let (numerator, denominator) = (part.numerator(), part.denominator());
            let multiple = match below.div_rem(&denominator) {
                Some((quotient, rest)) if rest.is_zero() => quotient,
                _ => {
                    let common = below.lcm(&denominator);
                    let more = common.div_exact(&below).unwrap_or(Integer::ONE);
                    above = &above * &more;
                    below = common;
                    below.div_exact(&denominator).unwrap_or(Integer::ONE)
                }
            };
            above.add_product(&numerator, &multiple);
        }
        Self::new(above, below).unwrap_or(Self::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_one_denominator_are_those_of_one_addition_after_another() {
        let long = Rational::from_decimal("1234567890123456789012345678901234567890").unwrap();
        let part = |n: i64, d: i64| Rational::new(n, d).unwrap();
        let over = |n: i64| part(n, 1).checked_div(&long).unwrap();
        let cases: [&[Rational]; 5] = [
            &[],
            &[part(1, 2), part(1, 3), part(-5, 6)],
            &[over(1), over(-3), over(2)],
            &[part(1, 6), over(7), long.clone(), over(-2), part(-1, 4)],
            &[over(1), part(3, 7), over(-1), part(-3, 7)],
        ];
        for parts in cases {
            let one_by_one = parts.iter().fold(Rational::ZERO, |sum, part| &sum + part);
            assert_eq!(Rational::total(parts), one_by_one, "{parts:?}");
        }
    }
}
