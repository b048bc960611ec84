//! The operators of rational numbers.
//!
//! Small operands stay within `i128`: the greatest common divisors are those of the operands'
//! parts, not of the result's (Knuth, The Art of Computer Programming 2, 4.5.1).

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::super::integer::gcd_u64;
use super::Repr::{Big, Small};
use super::UNIT;
use crate::{Integer, Rational};

impl Rational {
    #[inline]
    fn sum(&self, other: &Self, negate: bool) -> Self {
        let (Small(a, b), Small(c, d)) = (&self.0, &other.0) else {
            return self.sum_big(other, negate);
        };
        let (a, b) = (i128::from(*a), b.get());
        let c = if negate { -i128::from(*c) } else { i128::from(*c) };
        let d = d.get();
        if b == d {
            if b == 1 {
                return Self::from_lowest_wide(a + c, 1);
            }
            let sum = a + c;
            let common = gcd_rest(sum, b);
            return Self::from_lowest_wide(sum / i128::from(common), (b / common).into());
        }
        let common = gcd_word(b, d);
        let (b, d) = (b / common, d / common);
        let sum = a * i128::from(d) + c * i128::from(b);
        let denominator = i128::from(b) * i128::from(d);
        let rest = if common == 1 { 1 } else { gcd_rest(sum, common) };
        Self::from_lowest_wide(sum / i128::from(rest), denominator * i128::from(common / rest))
    }

    #[cold]
    fn sum_big(&self, other: &Self, negate: bool) -> Self {
        let (a, b) = (self.numerator(), self.denominator());
        let (c, d) = (other.numerator(), other.denominator());
        let mut sum = &a * &d;
        if negate {
            sum.sub_product(&c, &b);
        } else {
            sum.add_product(&c, &b);
        }
        let product = &b * &d;
        let common = sum.gcd(&product);
        Self::from_lowest(over(&sum, &common), over(&product, &common))
    }

    #[inline]
    fn product(&self, other: &Self) -> Self {
        let (Small(a, b), Small(c, d)) = (&self.0, &other.0) else {
            return self.product_big(other);
        };
        if *b == UNIT && *d == UNIT {
            return Self::from_lowest_wide(i128::from(*a) * i128::from(*c), 1);
        }
        let (left, right) = (gcd_rest((*a).into(), d.get()), gcd_rest((*c).into(), b.get()));
        Self::from_lowest_wide(
            i128::from(a / left) * i128::from(c / right),
            i128::from(b.get() / right) * i128::from(d.get() / left),
        )
    }

    #[cold]
    fn product_big(&self, other: &Self) -> Self {
        let (a, b) = (self.numerator(), self.denominator());
        let (c, d) = (other.numerator(), other.denominator());
        let (left, right) = (a.gcd(&d), c.gcd(&b));
        Self::from_lowest(&over(&a, &left) * &over(&c, &right), &over(&b, &right) * &over(&d, &left))
    }

    /// Panics on zero, as division of machine integers does.
    fn quotient(&self, divisor: &Self) -> Self {
        self.checked_div(divisor).expect("division of a rational number by zero")
    }
}

/// An integer divided by one that divides it.
fn over(part: &Integer, divisor: &Integer) -> Integer {
    let quotient = part.div_exact(divisor);
    debug_assert!(quotient.is_some(), "{divisor} does not divide {part}");
    quotient.unwrap_or(Integer::ZERO)
}

/// The greatest common divisor of positive words.
fn gcd_word(a: i64, b: i64) -> i64 {
    if a == 1 || b == 1 {
        return 1;
    }
    gcd_u64(a.unsigned_abs(), b.unsigned_abs()).cast_signed()
}

/// The greatest common divisor of any double word and a positive word.
fn gcd_rest(a: i128, b: i64) -> i64 {
    if b == 1 {
        return 1;
    }
    let rest = i64::try_from(a)
        .map_or_else(|_| i64::try_from(a.unsigned_abs() % u128::from(b.unsigned_abs())).unwrap_or(0), |word| word % b);
    gcd_u64(rest.unsigned_abs(), b.unsigned_abs()).cast_signed()
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        match &self.0 {
            Small(n, d) => Rational::from_lowest_wide(-i128::from(*n), d.get().into()),
            Big(parts) => Rational::from_lowest(-&parts.0, parts.1.clone()),
        }
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        -&self
    }
}

macro_rules! operators {
    ($(
        $trait:ident $method:ident, $assign:ident $method_assign:ident,
        |$a:ident, $b:ident| $value:expr;
    )*) => {$(
        impl $trait<&Rational> for &Rational {
            type Output = Rational;
            #[inline]
            fn $method(self, other: &Rational) -> Rational {
                let ($a, $b) = (self, other);
                $value
            }
        }
        impl $trait for Rational {
            type Output = Rational;
            #[inline]
            fn $method(self, other: Rational) -> Rational {
                (&self).$method(&other)
            }
        }
        impl $trait<&Rational> for Rational {
            type Output = Rational;
            #[inline]
            fn $method(self, other: &Rational) -> Rational {
                (&self).$method(other)
            }
        }
        impl $trait<Rational> for &Rational {
            type Output = Rational;
            #[inline]
            fn $method(self, other: Rational) -> Rational {
                self.$method(&other)
            }
        }
        impl $assign<&Rational> for Rational {
            fn $method_assign(&mut self, other: &Rational) {
                *self = (&*self).$method(other);
            }
        }
        impl $assign for Rational {
            fn $method_assign(&mut self, other: Rational) {
                *self = (&*self).$method(&other);
            }
        }
    )*};
}

operators! {
    Add add, AddAssign add_assign, |a, b| a.sum(b, false);
    Sub sub, SubAssign sub_assign, |a, b| a.sum(b, true);
    Mul mul, MulAssign mul_assign, |a, b| a.product(b);
    Div div, DivAssign div_assign, |a, b| a.quotient(b);
}
