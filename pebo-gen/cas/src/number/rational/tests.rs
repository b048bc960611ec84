#![expect(clippy::float_cmp, reason = "roundings are compared bit for bit")]

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use proptest::prelude::*;

use super::super::integer::tests::pair;
use super::InvalidDecimal;
use crate::{Integer, Rational};

fn rational() -> impl Strategy<Value = Rational> {
    let small = (-40_i64..40, 1_i64..40).prop_map(|(n, d)| Rational::new(n, d).expect("d > 0"));
    let word = (any::<i64>(), 1_i64..).prop_map(|(n, d)| Rational::new(n, d).expect("d > 0"));
    let big = (pair(), pair()).prop_filter_map("zero", |((n, _), (d, _))| Rational::new(n, d));
    prop_oneof![small, word, big]
}

fn canonical(value: &Rational) -> bool {
    let (n, d) = (value.numerator(), value.denominator());
    let again = Rational::new(n.clone(), d.clone());
    let hash = |value: &Rational| {
        let mut hasher = DefaultHasher::new();
        value.hash(&mut hasher);
        hasher.finish()
    };
    !d.is_negative()
        && n.gcd(&d).is_one()
        && again.as_ref() == Some(value)
        && again.is_some_and(|again| hash(&again) == hash(value))
}

/// Fractions by their definition, over integers that are tested on their own.
fn fraction(n: Integer, d: Integer) -> Rational {
    Rational::new(n, d).expect("denominator")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn field(x in rational(), y in rational()) {
        let (a, b, c, d) = (x.numerator(), x.denominator(), y.numerator(), y.denominator());
        prop_assert_eq!(&x + &y, fraction(&(&a * &d) + &(&c * &b), &b * &d));
        prop_assert_eq!(&x - &y, fraction(&(&a * &d) - &(&c * &b), &b * &d));
        prop_assert_eq!(&x * &y, fraction(&a * &c, &b * &d));
        prop_assert_eq!(x.cmp(&y), (&a * &d).cmp(&(&c * &b)));
        if y.is_zero() {
            prop_assert_eq!(x.checked_div(&y), None);
        } else {
            prop_assert_eq!(&x / &y, fraction(&a * &d, &b * &c));
        }
        for value in [&x, &y, &(&x + &y), &(&x - &y), &(&x * &y), &-&x, &x.gcd(&y)] {
            prop_assert!(canonical(value), "{}", value);
        }
        let floor = Rational::from(x.floor());
        prop_assert!(floor <= x && x < &floor + &Rational::ONE);
    }

    #[test]
    fn roots_and_powers(x in rational(), exponent in -4_i32..5) {
        if let Some(power) = x.pow(exponent) {
            let mut product = Rational::ONE;
            for _ in 0..exponent.unsigned_abs() {
                product *= &x;
            }
            let expected = if exponent < 0 { product.recip() } else { Some(product) };
            prop_assert_eq!(Some(&power), expected.as_ref());
            if exponent > 0 {
                let root = power.root_exact(exponent.unsigned_abs()).expect("a power");
                let other = exponent % 2 == 0 && root == -&x && !root.is_negative();
                prop_assert!(root == x || other);
            }
        } else {
            prop_assert!(x.is_zero() && exponent < 0);
        }
    }

    #[test]
    fn common_divisor(x in rational(), y in rational()) {
        let common = x.gcd(&y);
        if !common.is_zero() {
            let (m, n) = (&x / &common, &y / &common);
            prop_assert!(m.is_integer() && n.is_integer());
            prop_assert!(m.numerator().gcd(&n.numerator()).is_one());
        }
    }

    #[test]
    fn every_double_survives(bits in any::<u64>()) {
        let value = f64::from_bits(bits);
        match Rational::from_f64_exact(value) {
            Some(exact) => prop_assert_eq!(exact.to_f64(), value),
            None => prop_assert!(!value.is_finite()),
        }
    }

    #[test]
    fn decimal_text_agrees_with_the_standard_library(n in any::<i64>(), places in -340_i32..320) {
        let text = format!("{n}e{places}");
        let exact = Rational::from_decimal(&text).expect("decimal");
        prop_assert_eq!(exact.to_f64(), text.parse::<f64>().expect("decimal"));
    }

    /// The midpoint of two neighbours rounds to the even one, anything beside it to its side.
    #[test]
    fn rounds_to_nearest(bits in 0_u64..0x7fe0_0000_0000_0000, sliver in 60_u32..2000) {
        let (low, high) = (f64::from_bits(bits), f64::from_bits(bits + 1));
        let exact = |value| Rational::from_f64_exact(value).expect("finite");
        let middle = &(&exact(low) + &exact(high)) / &Rational::from(2);
        let even = if bits % 2 == 0 { low } else { high };
        prop_assert_eq!(middle.to_f64(), even);
        let little = &(&exact(high) - &exact(low)) / &Rational::from(Integer::ONE.shl(sliver));
        prop_assert_eq!((&middle + &little).to_f64(), high);
        prop_assert_eq!((&middle - &little).to_f64(), low);
    }
}

#[test]
fn texts() {
    let read = Rational::from_decimal;
    assert_eq!(read("10e-3"), Ok(Rational::new(1, 100).expect("ratio")));
    assert_eq!(read("-0.5"), Ok(Rational::new(-1, 2).expect("ratio")));
    assert_eq!(read(".25"), Ok(Rational::new(1, 4).expect("ratio")));
    assert_eq!(read("3."), Ok(Rational::from(3)));
    assert_eq!(read("+1.5E+1"), Ok(Rational::from(15)));
    for bad in ["", ".", "-", "e5", "1e", "1e+", "1.2.3", "--1", "1_0", "0x1", "nan", ".-5", "-.+5"] {
        assert_eq!(read(bad), Err(InvalidDecimal::Malformed), "{bad}");
    }
    for large in ["1e999999999", "1e-999999999", "1e99999999999999999999"] {
        assert_eq!(read(large), Err(InvalidDecimal::TooLarge), "{large}");
    }
    assert_eq!(Rational::new(3, -6).expect("ratio").to_string(), "-1/2");
    assert_eq!(Rational::from(5).to_string(), "5");
    assert_eq!(Rational::new(1, 0), None);
}

#[test]
fn out_of_range() {
    let ten = Rational::from(10);
    assert_eq!(ten.pow(400).map(|x| x.to_f64()), Some(f64::INFINITY));
    assert_eq!(ten.pow(-400).map(|x| x.to_f64()), Some(0.0));
    assert_eq!((-ten.pow(400).expect("power")).to_f64(), f64::NEG_INFINITY);
    assert_eq!(ten.pow(i32::MAX), None);
    assert_eq!(Rational::from(-1).pow(i32::MAX), Some(Rational::from(-1)));
    assert_eq!(Rational::from(2).sqrt_exact(), None);
    assert_eq!(size_of::<Rational>(), 16);
}
