//! Sums of many numbers.
//!
//! In: pairs of numbers. Out: the sum of their products. Long ones are added over a common denominator and brought to
//! lowest terms once: the denominators of a linear combination have nearly all factors in common, and a greatest common
//! divisor after each addition would cost more than all else.

use crate::Integer;

use super::Small;
use crate::Rational;

impl Rational {
    /// The sum of the products of pairs.
    pub(crate) fn total_of_products<'a>(
        mut pairs: impl ExactSizeIterator<Item = (&'a Self, &'a Self)> + Clone,
    ) -> Self {
        let small = |(a, b): (&Self, &Self)| matches!((&a.0, &b.0), (Small(..), Small(..)));
        match pairs.len() {
            1 => return pairs.next().map_or(Self::ZERO, |(a, b)| a * b),
            2 => return pairs.fold(Self::ZERO, |sum, (a, b)| &sum + &(a * b)),
            _ if pairs.clone().all(small) => return pairs.fold(Self::ZERO, |sum, (a, b)| &sum + &(a * b)),
            _ => {}
        }
        let mut total = Integer::ZERO;
        let mut common_denominator = Integer::ONE;
        for (a, b) in pairs {
            let numerator = &a.numerator() * &b.numerator();
            let denominator = &a.denominator() * &b.denominator();
            let multiple = match common_denominator.div_rem(&denominator) {
                Some((quotient, rest)) if rest.is_zero() => quotient,
                _ => {
                    let common = common_denominator.lcm(&denominator);
                    let more = common.div_exact(&common_denominator).unwrap_or(Integer::ONE);
                    total = &total * &more;
                    common_denominator = common;
                    common_denominator.div_exact(&denominator).unwrap_or(Integer::ONE)
                }
            };
            total.add_product(&numerator, &multiple);
        }
        Self::new(total, common_denominator).unwrap_or(Self::ZERO)
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
            for scale in [Rational::ONE, part(-6, 5), over(10)] {
                let one_by_one = parts.iter().fold(Rational::ZERO, |sum, part| &sum + &(part * &scale));
                let total = Rational::total_of_products(parts.iter().map(|part| (part, &scale)));
                assert_eq!(total, one_by_one, "{parts:?}");
            }
        }
    }
}
