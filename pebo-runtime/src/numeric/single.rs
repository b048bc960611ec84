//! Elementary functions in single precision throughout, for processors without double precision.
//!
//! A common `f32` sine computes in double precision, in software on such a processor. These reduce the argument in two
//! or three parts (Cody and Waite, *Software manual for the elementary functions*, 1980) and evaluate a polynomial of
//! least maximal error (Remez), whose coefficients were computed for this purpose. Errors, measured against double
//! precision at millions of points by the tests:
//!
//! | function | range | largest error |
//! |---|---|---|
//! | [`sin`], [`cos`] | up to 1e4 rad; the usual functions beyond | 1.0e-7, absolute |
//! | [`atan`], [`atan2`] | all | 3 units in the last place |
//! | [`exp`] | all | 1.5 units in the last place, where the result is normal |

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LOG2_E, PI};

use nalgebra::ComplexField;

/// 1.5 * 2^23: a small number added to it is rounded to an integer, which the last bits of the sum hold.
const ROUNDER: f32 = 12_582_912.0;

/// The largest angle that the reduction below is accurate for.
const LARGEST_ANGLE: f32 = 1e4;

/// An angle less its nearest multiple of pi/2, and that multiple modulo 4.
#[inline]
fn reduce(x: f32) -> (f32, u32) {
    let shifted = x * FRAC_2_PI + ROUNDER;
    let n = shifted - ROUNDER;
    // pi/2 in three parts; n times either of the first two is exact.
    let r = ((x - n * 1.570_312_5) - n * 0.000_483_751_3) - n * 7.549_79e-8;
    (r, shifted.to_bits() & 3)
}

/// The sine of an angle within pi/4 of 0: relative error of the polynomial 4e-9.
#[inline]
fn sin_near_zero(r: f32) -> f32 {
    let t = r * r;
    r + r * t * (-0.166_666_55 + t * (0.008_332_177 - t * 0.000_195_171_38))
}

/// The cosine of an angle within pi/4 of 0: error of the polynomial 1e-10.
#[inline]
fn cos_near_zero(r: f32) -> f32 {
    let t = r * r;
    1.0 - t * 0.5 + t * t * (0.041_666_646 + t * (-0.001_388_736_7 + t * 2.443_827_2e-5))
}

/// Sine of an angle in radians.
#[inline]
pub(crate) fn sin(x: f32) -> f32 {
    if x.abs() > LARGEST_ANGLE {
        return ComplexField::sin(x);
    }
    let (r, quadrant) = reduce(x);
    let value = if quadrant & 1 == 0 { sin_near_zero(r) } else { cos_near_zero(r) };
    if quadrant & 2 == 0 { value } else { -value }
}

/// Cosine of an angle in radians.
#[inline]
pub(crate) fn cos(x: f32) -> f32 {
    if x.abs() > LARGEST_ANGLE {
        return ComplexField::cos(x);
    }
    let (r, quadrant) = reduce(x);
    let value = if quadrant & 1 == 0 { cos_near_zero(r) } else { sin_near_zero(r) };
    if quadrant == 1 || quadrant == 2 { -value } else { value }
}

/// Sine and cosine of an angle in radians, to the last bit the values of [`sin`] and [`cos`].
#[inline]
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    if x.abs() > LARGEST_ANGLE {
        return ComplexField::sin_cos(x);
    }
    let (r, quadrant) = reduce(x);
    let (near, far) = (sin_near_zero(r), cos_near_zero(r));
    let (sine, cosine) = if quadrant & 1 == 0 { (near, far) } else { (far, near) };
    let sine = if quadrant & 2 == 0 { sine } else { -sine };
    (sine, if quadrant == 1 || quadrant == 2 { -cosine } else { cosine })
}

/// The inverse tangent of `small/large`, `0 <= small <= large`, without a quotient above tan(pi/8).
#[inline]
fn atan_of_quotient(small: f32, large: f32) -> f32 {
    let (base, q) = if small > 0.414_213_57 * large {
        (FRAC_PI_4, (small - large) / (small + large))
    } else {
        (0.0, small / large)
    };
    let t = q * q;
    let tail = -0.333_329_56 + t * (0.199_778_96 + t * (-0.138_795 + t * 0.080_590_93));
    base + (q + q * t * tail)
}

/// Inverse tangent, in [-pi/2, pi/2].
#[inline]
pub(crate) fn atan(x: f32) -> f32 {
    let size = x.abs();
    // The quotient of a number beyond 1/f32::EPSILON^2 changes nothing: infinity needs no case of its own below.
    let angle =
        if size > 1.0 { FRAC_PI_2 - atan_of_quotient(1.0, size.min(f32::MAX)) } else { atan_of_quotient(size, 1.0) };
    angle.copysign(x)
}

/// Angle of the point (`x`, `y`), in [-pi, pi].
#[inline]
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    let (mut rise, mut run) = (y.abs(), x.abs());
    if rise.is_infinite() && run.is_infinite() {
        // Their quotient is no number; one alone makes it zero.
        (rise, run) = (1.0, 1.0);
    } else if rise > f32::MAX / 4.0 || run > f32::MAX / 4.0 {
        // Their sum must not overflow.
        (rise, run) = (rise * 0.25, run * 0.25);
    }
    let first = if rise > run {
        FRAC_PI_2 - atan_of_quotient(run, rise)
    } else if run == 0.0 {
        0.0
    } else {
        atan_of_quotient(rise, run)
    };
    let upper = if x.is_sign_negative() { PI - first } else { first };
    upper.copysign(y)
}

/// Exponential.
#[inline]
pub(crate) fn exp(x: f32) -> f32 {
    // Beyond, the result is infinite or 0.
    let bounded = x.clamp(-104.0, 89.0);
    let shifted = bounded * LOG2_E + ROUNDER;
    let n = shifted - ROUNDER;
    // ln 2 in two parts; n times the first is exact.
    let r = (bounded - n * 0.693_115_23) - n * 3.194_618_3e-5;
    let tail = 0.5 + r * (0.166_665_18 + r * (0.041_666_206 + r * (0.008_368_918 + r * 0.001_395_054_2)));
    let value = 1.0 + (r + r * r * tail);
    // 2^n in two factors, either of which is a normal number.
    let exponent = shifted.to_bits().wrapping_sub(ROUNDER.to_bits()).cast_signed();
    let half = exponent >> 1;
    value * power_of_two(half) * power_of_two(exponent - half)
}

/// `2^n` for `-127 < n < 128`.
#[inline]
fn power_of_two(n: i32) -> f32 {
    f32::from_bits((n + 127).cast_unsigned() << 23)
}
