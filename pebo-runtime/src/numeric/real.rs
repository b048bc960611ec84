//! The scalar: `f32` or `f64`, with the functions that a formula may use.
//!
//! Emitted code is written for one concrete scalar and calls `Real::sin(x)`, which needs neither `std` nor any other
//! import. Those that are our own are named in the last lines.

use nalgebra::{ComplexField, RealField};

use super::{double, single};

/// A real scalar: `f32` or `f64`.
///
/// The functions bear the names of those of [`nalgebra`]: on a generic scalar write `Real::sqrt(x)`, not `x.sqrt()`.
/// Out of its domain a function returns NaN, which an [`Observer`](crate::Observer) refuses.
#[allow(clippy::return_self_not_must_use, reason = "nobody calls a sine for its effect")]
pub trait Real: RealField + Copy {
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;

    /// The nearest number of this precision.
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision (exact).
    fn to_f64(self) -> f64;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Sine and cosine of an angle in radians, for less than both by themselves.
    fn sin_cos(self) -> (Self, Self);
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Inverse sine, in [-pi/2, pi/2].
    fn asin(self) -> Self;
    /// Inverse cosine, in [0, pi].
    fn acos(self) -> Self;
    /// Inverse tangent, in [-pi/2, pi/2].
    fn atan(self) -> Self;
    /// Angle of the point (`x`, `self`), in [-pi, pi]: `Real::atan2(y, x)`.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Inverse hyperbolic sine.
    fn asinh(self) -> Self;
    /// Inverse hyperbolic cosine of a number of at least 1, not negative.
    fn acosh(self) -> Self;
    /// Inverse hyperbolic tangent of a number in (-1, 1).
    fn atanh(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// `exp(self) - 1`, accurate near 0.
    fn exp_m1(self) -> Self;
    /// Natural logarithm of 1 plus the number, with all digits also where that is small.
    fn ln_1p(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// -1, 0 or 1 as the number is negative, zero or positive.
    fn sign(self) -> Self {
        if self == Self::zero() { self } else { self.signum() }
    }
    /// The smaller of two numbers.
    fn smaller(self, other: Self) -> Self {
        RealField::min(self, other)
    }
    /// The larger of two numbers.
    fn larger(self, other: Self) -> Self {
        RealField::max(self, other)
    }
    /// The nearest number in [-1, 1].
    fn sat(self) -> Self {
        RealField::clamp(self, -Self::one(), Self::one())
    }
    /// `self` to a real power.
    fn powf(self, exponent: Self) -> Self;
    /// `self` to an integer power.
    fn powi(self, exponent: i32) -> Self;
}

macro_rules! real {
    ($scalar:ident: $($function:ident),+; atan2 = $atan2:path, sin_cos = $sin_cos:path $(, $own:ident = $path:path)*) => {
        impl Real for $scalar {
            const EPSILON: Self = $scalar::EPSILON;

            #[inline]
            #[allow(clippy::cast_possible_truncation, reason = "rounding to the precision in use is the purpose")]
            fn from_f64(value: f64) -> Self {
                value as Self
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn is_finite(self) -> bool {
                Self::is_finite(self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                ComplexField::powf(self, exponent)
            }
            #[inline]
            fn powi(self, exponent: i32) -> Self {
                ComplexField::powi(self, exponent)
            }
            $(
                #[inline]
                fn $function(self) -> Self {
                    ComplexField::$function(self)
                }
            )+
            $(
                #[inline]
                fn $own(self) -> Self {
                    $path(self)
                }
            )*
        }
    };
}

real!(
    f64: sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, exp, exp_m1, ln, ln_1p, sqrt, abs;
    atan2 = double::atan2, sin_cos = ComplexField::sin_cos
);
real!(
    f32: tan, asin, acos, sinh, cosh, tanh, asinh, acosh, atanh, exp_m1, ln, ln_1p, sqrt, abs;
    atan2 = single::atan2, sin_cos = single::sin_cos, sin = single::sin, cos = single::cos, atan = single::atan, exp = single::exp
);
