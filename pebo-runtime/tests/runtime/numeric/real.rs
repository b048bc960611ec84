//! The scalar's functions, by the one import that emitted code has.

use pebo_runtime::Real;

/// Inside every function's domain.
const POINTS: [f64; 4] = [0.125, 0.3, 0.75, 0.96];

/// Each function, the runtime's beside the standard library's, at every point.
macro_rules! agree {
    ($scalar:ident: $($function:ident),+) => {
        for point in POINTS.map(<$scalar as Real>::from_f64) {
            $(
                let (ours, theirs) = (Real::$function(point), point.$function());
                // Either library is within 1 ulp of the true value here, and one ulp is at most eps of the value.
                assert!(
                    (ours - theirs).abs() <= 2.0 * $scalar::EPSILON * theirs.abs(),
                    "{}({point}) = {ours}, not {theirs}", stringify!($function),
                );
            )+
        }
    };
}

#[test]
fn functions_are_the_standard_ones() {
    agree!(f64: sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, atanh, exp, exp_m1, ln, sqrt, abs);
    agree!(f32: sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, atanh, exp, exp_m1, ln, sqrt, abs);
}

#[test]
fn the_inverse_hyperbolic_cosine_is_the_standard_one() {
    for point in POINTS.map(|point| 1.0 + point) {
        // Both subtract 1 from the point, which is exact, and round a few times after.
        assert!((Real::acosh(point) - point.acosh()).abs() <= 8.0 * f64::EPSILON * point.acosh());
    }
    assert!(Real::acosh(0.5_f32).is_nan());
}

#[test]
#[expect(clippy::float_cmp, reason = "these are exact")]
fn the_rest() {
    assert_eq!(Real::abs(-3.0_f64), 3.0);
    assert_eq!(Real::powi(-2.0_f32, 3), -8.0);
    assert_eq!([-2.5, 0.0, 0.1].map(|a: f64| Real::sign(a)), [-1.0, 0.0, 1.0]);
    assert_eq!([-2.5, -0.5, 7.0].map(|a: f32| Real::sat(a)), [-1.0, -0.5, 1.0]);
    assert_eq!((Real::smaller(2.0_f64, -3.0), Real::larger(2.0_f64, -3.0)), (-3.0, 2.0));
    // A quadrant each, and the axis that a quotient y/x does not have.
    assert!((Real::atan2(1.0_f64, -1.0) - 2.356_194_490_192_345).abs() < 1e-15);
    assert!((Real::atan2(-1.0_f64, -1.0) + 2.356_194_490_192_345).abs() < 1e-15);
    assert!((Real::atan2(1.0_f64, 0.0) - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!((Real::powf(2.0_f64, 0.5) - core::f64::consts::SQRT_2).abs() < 1e-15);
    assert_eq!(<f32 as Real>::EPSILON, f32::EPSILON);
    assert_eq!(Real::to_f64(<f32 as Real>::from_f64(0.1)), f64::from(0.1_f32));
    assert!(Real::is_finite(f64::MAX) && !Real::is_finite(f64::INFINITY) && !Real::is_finite(f64::NAN));
}
