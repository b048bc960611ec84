//! Identities between functions: both sides enclose the one value.

use super::*;

/// At a precision from 16 to 400 bits.
fn precision() -> impl Strategy<Value = u32> {
    16_u32..400
}

proptest! {
    #[test]
    fn arithmetic_encloses_the_rational_result(a in wide(), b in wide(), bits in precision()) {
        let (x, y, p) = (point(&a, bits), point(&b, bits), super::bits(bits));
        prop_assert!(!x.add(&y, p).unwrap().excludes(&(&a + &b)));
        prop_assert!(!x.sub(&y, p).unwrap().excludes(&(&a - &b)));
        prop_assert!(!x.mul(&y, p).unwrap().excludes(&(&a * &b)));
        if let Some(quotient) = a.checked_div(&b) {
            prop_assert!(!x.div(&y, p).unwrap().excludes(&quotient));
        }
    }

    #[test]
    fn circle(q in wide(), bits in precision()) {
        let (x, p) = (point(&q, bits), super::bits(bits));
        let (sin, cos) = (x.sin(p).unwrap(), x.cos(p).unwrap());
        let one = sin.powi(2, p).unwrap().add(&cos.powi(2, p).unwrap(), p).unwrap();
        prop_assert!(!one.excludes(&Rational::ONE));
        if let Some((tan, quotient)) = x.tan(p).zip(sin.div(&cos, p)) {
            prop_assert!(meets(&tan, &quotient));
        }
    }

    #[test]
    fn exponential_of_a_sum(a in -400_i64..400, b in 1_i64..400, bits in precision()) {
        let (x, y) = (point(&ratio(a, b), bits), point(&ratio(b, 7), bits));
        let p = super::bits(bits);
        let of_sum = x.add(&y, p).unwrap().exp(p).unwrap();
        let product = x.exp(p).unwrap().mul(&y.exp(p).unwrap(), p).unwrap();
        prop_assert!(meets(&of_sum, &product));
        let difference = x.cosh(p).unwrap().sub(&x.sinh(p).unwrap(), p).unwrap();
        prop_assert!(meets(&difference, &x.neg().exp(p).unwrap()));
    }

    #[test]
    fn inverses_lead_back(q in wide(), bits in precision()) {
        let (x, p) = (point(&q, bits), super::bits(bits));
        prop_assert!(!x.atan(p).unwrap().tan(p).is_some_and(|back| back.excludes(&q)));
        if let Some(angle) = x.asin(p) {
            prop_assert!(!angle.sin(p).unwrap().excludes(&q));
            prop_assert!(!x.acos(p).unwrap().cos(p).unwrap().excludes(&q));
        }
        if let Some(log) = x.log(p) {
            prop_assert!(!log.exp(p).unwrap().excludes(&q));
            prop_assert!(!x.sqrt(p).unwrap().powi(2, p).unwrap().excludes(&q));
        }
    }

    #[test]
    fn powers_and_roots(q in wide(), n in -12_i64..12, d in 1_i64..30, bits in precision()) {
        let (x, p) = (point(&q.abs(), bits), super::bits(bits));
        if let Some(root) = x.pow(&ratio(n, d), p) {
            let back = root.powi(d, p).unwrap();
            prop_assert!(meets(&back, &x.powi(n, p).unwrap()));
        }
    }

    #[test]
    fn angle_of_a_point(a in wide(), b in wide(), bits in precision()) {
        let (y, x, p) = (point(&a, bits), point(&b, bits), super::bits(bits));
        if let Some(angle) = y.atan2(&x, p) {
            let length = x.powi(2, p).unwrap().add(&y.powi(2, p).unwrap(), p).unwrap();
            let length = length.sqrt(p).unwrap();
            prop_assert!(!angle.cos(p).unwrap().mul(&length, p).unwrap().excludes(&b));
            prop_assert!(!angle.sin(p).unwrap().mul(&length, p).unwrap().excludes(&a));
            let above_axis = a.signum() > 0 || (a.is_zero() && b.is_negative());
            prop_assert_eq!(angle.is_positive(), above_axis);
        }
    }
}
