//! The functions of single precision against those of double precision, densely.

use pebo_runtime::Real;

/// Numbers of both signs, evenly over the representations up to `largest`: every order of magnitude is equally
/// frequent.
fn representations(largest: f32, count: u32) -> impl Iterator<Item = f32> {
    let last = largest.to_bits();
    (0..count).flat_map(move |k| {
        let bits = u64::from(last) * u64::from(k) / u64::from(count);
        let x = f32::from_bits(u32::try_from(bits).expect("below the largest"));
        [x, -x]
    })
}

/// The distance of a result from the exact one, in units of the last place of the latter.
fn units(found: f32, exact: f64) -> f64 {
    // One unit of the binade that the exact value is in; below the normal numbers, that of the smallest.
    let magnitude = exact.abs().max(f64::from(f32::MIN_POSITIVE));
    let unit = 2.0_f64.powi(-23) * 2.0_f64.powf(magnitude.log2().floor());
    (f64::from(found) - exact).abs() / unit
}

#[test]
fn sine_and_cosine() {
    let mut worst = 0.0_f64;
    let evenly = (0..1_000_000_u32).map(|k| -> f32 { Real::from_f64(f64::from(k) * 0.01) });
    for x in representations(1e4, 1_000_000).chain(evenly) {
        let exact = f64::from(x);
        worst = worst.max((f64::from(Real::sin(x)) - exact.sin()).abs());
        worst = worst.max((f64::from(Real::cos(x)) - exact.cos()).abs());
    }
    // As the module's documentation says.
    assert!(worst < 1.0e-7, "{worst:e}");
    for x in representations(1e9, 10_000) {
        let (sine, cosine) = Real::sin_cos(x);
        let apart: [f32; 2] = [Real::sin(x), Real::cos(x)];
        assert_eq!([sine, cosine].map(f32::to_bits), apart.map(f32::to_bits), "{x}");
    }
    // Near 0 the sine is right to its own last place.
    let near = representations(0.78, 300_000).map(|x| units(Real::sin(x), f64::from(x).sin())).fold(0.0, f64::max);
    assert!(near < 1.5, "{near}");
    for x in [1.1e4_f32, 1e9, 3e38, -2e4] {
        assert!((f64::from(Real::sin(x)) - f64::from(x).sin()).abs() < 1e-7);
        assert!((f64::from(Real::cos(x)) - f64::from(x).cos()).abs() < 1e-7);
    }
    assert!(Real::sin(f32::INFINITY).is_nan() && Real::cos(f32::NAN).is_nan() && Real::sin(f32::NAN).is_nan());
}

#[test]
fn inverse_tangent() {
    let worst =
        representations(f32::MAX, 1_000_000).map(|x| units(Real::atan(x), f64::from(x).atan())).fold(0.0, f64::max);
    assert!(worst < 3.0, "{worst}");
    let special = [0.0, -0.0, 1.0, -1.0, 1e-38, 1e38, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, 1e-45, -3.0];
    let mut worst = 0.0_f64;
    for y in special.into_iter().chain(representations(f32::MAX, 1000)) {
        for x in special.into_iter().chain(representations(f32::MAX, 1000)) {
            let (found, exact) = (Real::atan2(y, x), f64::from(y).atan2(f64::from(x)));
            assert_eq!(found.is_sign_negative(), exact.is_sign_negative(), "{y} {x}");
            worst = worst.max(units(found, exact));
        }
    }
    assert!(worst < 3.0, "{worst}");
    assert!(
        Real::atan2(f32::NAN, 1.0).is_nan() && Real::atan2(1.0, f32::NAN).is_nan() && Real::atan(f32::NAN).is_nan()
    );
}

#[test]
fn exponential() {
    let mut worst = 0.0_f64;
    for x in representations(88.7, 1_000_000).chain(representations(1e-3, 10_000)) {
        let exact = f64::from(x).exp();
        if exact > f64::from(f32::MIN_POSITIVE) {
            worst = worst.max(units(Real::exp(x), exact));
        } else {
            // Below the normal numbers one unit is the smallest number.
            assert!((f64::from(Real::exp(x)) - exact).abs() <= f64::from(f32::from_bits(1)));
        }
    }
    assert!(worst < 1.5, "{worst}");
    for (x, exact) in [(0.0, 1.0), (89.0, f32::INFINITY), (1e9, f32::INFINITY), (-200.0, 0.0), (f32::NEG_INFINITY, 0.0)]
    {
        assert_eq!(Real::exp(x).to_bits(), f32::to_bits(exact), "{x}");
    }
    assert!(Real::exp(f32::NAN).is_nan());
}
