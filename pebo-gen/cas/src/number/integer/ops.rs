//! The operators of integers: words while nothing overflows, else the big-number library.

use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::Integer;
use super::Repr::{Big, Small};

impl Neg for &Integer {
    type Output = Integer;
    fn neg(self) -> Integer {
        match &self.0 {
            Small(value) => Integer::from(-i128::from(*value)),
            Big(value) => Integer::from_big(-value.as_ref()),
        }
    }
}

impl Neg for Integer {
    type Output = Integer;
    fn neg(self) -> Integer {
        -&self
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident, $assign:ident $method_assign:ident, $checked:ident;)*) => {$(
        impl $trait<&Integer> for &Integer {
            type Output = Integer;
            #[inline]
            fn $method(self, other: &Integer) -> Integer {
                if let (Small(a), Small(b)) = (&self.0, &other.0)
                    && let Some(small) = a.$checked(*b)
                {
                    return Integer(Small(small));
                }
                Integer::from_big(self.big().as_ref().$method(other.big().as_ref()))
            }
        }
        impl $trait for Integer {
            type Output = Integer;
            fn $method(self, other: Integer) -> Integer {
                (&self).$method(&other)
            }
        }
        impl $assign<&Integer> for Integer {
            #[inline]
            fn $method_assign(&mut self, other: &Integer) {
                *self = (&*self).$method(other);
            }
        }
    )*};
}

operators! {
    Add add, AddAssign add_assign, checked_add;
    Sub sub, SubAssign sub_assign, checked_sub;
    Mul mul, MulAssign mul_assign, checked_mul;
}
