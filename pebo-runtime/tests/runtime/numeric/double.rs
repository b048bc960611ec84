//! The functions of double precision that are our own against those of the standard library.

use pebo_runtime::Real;

/// The distance of two results, in units of the last place of the second.
fn units(found: f64, other: f64) -> f64 {
    let magnitude = other.abs().max(f64::MIN_POSITIVE);
    (found - other).abs() / (f64::EPSILON * magnitude.log2().floor().exp2())
}

#[test]
fn angles_of_points_everywhere() {
    let mut worst = 0.0_f64;
    // Quotients of all magnitudes, and densely where the reduction changes.
    let magnitudes = (-400_000..400_000_i32).map(|k| (f64::from(k) * 1e-4).exp());
    let dense = (0..300_000_i32).map(|k| f64::from(k) * 1e-5);
    for slope in magnitudes.chain(dense) {
        for (y, x) in [(slope, 1.0), (-1.7 * slope, -1.7), (0.3 * slope, -0.3)] {
            worst = worst.max(units(Real::atan2(y, x), f64::atan2(y, x)));
        }
    }
    // Ours is within 1.3 units of the exact angle, the host's within 1: apart by two numbers at most, which are two
    // units.
    assert!(worst <= 2.0, "{worst}");
}

#[test]
fn angles_at_the_limits() {
    let limits = [
        0.0,
        5e-324,
        1e-323,
        1e-310,
        1e-300,
        f64::MIN_POSITIVE,
        1e-200,
        0.3125,
        1.0,
        1e200,
        f64::MAX / 4.0,
        f64::MAX,
        f64::INFINITY,
    ];
    let both = || limits.into_iter().flat_map(|limit| [limit, -limit]);
    for y in both() {
        for x in both() {
            let (found, exact) = (Real::atan2(y, x), y.atan2(x));
            assert_eq!(found.is_sign_negative(), exact.is_sign_negative(), "{y} {x}");
            // A quotient below the normal numbers is rounded to a multiple of the smallest number.
            let close = units(found, exact) <= 2.0 || (found - exact).abs() <= 5e-324;
            assert!(close, "{y} {x}: {found:e} {exact:e}");
        }
        assert!(Real::atan2(y, f64::NAN).is_nan() && Real::atan2(f64::NAN, y).is_nan());
    }
}
