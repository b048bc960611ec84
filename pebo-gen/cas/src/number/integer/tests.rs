use num_bigint::{BigInt, Sign as BigSign};
use proptest::prelude::*;

use super::{Integer, gcd_u64};

/// The same number in both libraries: words near the limits, and up to some thousand bits.
pub(crate) fn pair() -> impl Strategy<Value = (Integer, BigInt)> {
    let word = prop_oneof![-3_i64..4, any::<i64>(), Just(i64::MAX), Just(i64::MIN), Just(i64::MIN + 1)];
    let big =
        (any::<bool>(), prop::collection::vec(any::<u8>(), 0..400), 0_u32..2).prop_map(|(negative, bytes, sparse)| {
            // Runs of zeros and ones reach the carry chains that random digits miss.
            let bytes: Vec<u8> =
                bytes.iter().map(|b| if sparse == 1 { if b & 4 == 0 { 0 } else { 255 } } else { *b }).collect();
            BigInt::from_bytes_le(if negative { BigSign::Minus } else { BigSign::Plus }, &bytes)
        });
    prop_oneof![word.prop_map(BigInt::from), any::<i128>().prop_map(BigInt::from), big]
        .prop_map(|oracle| (read(&oracle), oracle))
}

pub(crate) fn read(oracle: &BigInt) -> Integer {
    Integer::from_digits(&oracle.to_string()).expect("digits")
}

fn big_gcd(a: &BigInt, b: &BigInt) -> BigInt {
    let (mut a, mut b) = (a.clone(), b.clone());
    while b != BigInt::from(0) {
        let rest = &a % &b;
        a = std::mem::replace(&mut b, rest);
    }
    if a < BigInt::from(0) { -a } else { a }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn ring((a, x) in pair(), (b, y) in pair(), (c, z) in pair()) {
        prop_assert_eq!(&a + &b, read(&(&x + &y)));
        prop_assert_eq!(&a - &b, read(&(&x - &y)));
        prop_assert_eq!(&a * &b, read(&(&x * &y)));
        prop_assert_eq!(-&a, read(&-&x));
        prop_assert_eq!(a.cmp(&b), x.cmp(&y));
        prop_assert_eq!(a.to_string(), x.to_string());
        prop_assert_eq!(a.bits(), x.bits());
        prop_assert_eq!(u64::from(a.trailing_zeros()), x.trailing_zeros().unwrap_or(0));
        prop_assert_eq!(a.to_i128(), i128::try_from(&x).ok());
        let (mut sum, mut difference) = (c.clone(), c);
        sum.add_product(&a, &b);
        difference.sub_product(&a, &b);
        prop_assert_eq!(sum, read(&(&z + &x * &y)));
        prop_assert_eq!(difference, read(&(&z - &x * &y)));
    }

    #[test]
    fn division((a, x) in pair(), (b, y) in pair(), modulus in 1_u64..) {
        let residue = ((&x % modulus) + modulus) % modulus;
        prop_assert_eq!(BigInt::from(a.rem_u64(modulus)), residue);
        if b.is_zero() {
            prop_assert_eq!(a.div_rem(&b), None);
            prop_assert_eq!(a.div_exact(&b), None);
        } else {
            prop_assert_eq!(a.div_rem(&b), Some((read(&(&x / &y)), read(&(&x % &y)))));
            prop_assert_eq!((&a * &b).div_exact(&b), Some(a.clone()));
            let floor = a.div_floor(&b).expect("not zero");
            let rest = &a - &(&floor * &b);
            prop_assert!(rest.is_zero() || rest.is_negative() == b.is_negative());
            prop_assert!(rest.abs() < b.abs());
        }
    }

    #[test]
    fn gcds((a, x) in pair(), (b, y) in pair(), (g, z) in pair()) {
        prop_assert_eq!(a.gcd(&b), read(&big_gcd(&x, &y)));
        prop_assert_eq!((&a * &g).gcd(&(&b * &g)), read(&big_gcd(&(&x * &z), &(&y * &z))));
        prop_assert_eq!(&a.gcd(&b) * &a.lcm(&b), (&a * &b).abs());
    }

    #[test]
    fn powers((a, x) in pair(), exponent in 0_u32..5, shift in 0_u32..200) {
        prop_assert_eq!(a.pow(exponent), read(&x.pow(exponent)));
        prop_assert_eq!(a.shl(shift), read(&(&x << shift)));
        if exponent > 0 {
            let power = a.pow(exponent);
            let root = power.root_exact(exponent).expect("a power");
            prop_assert_eq!(&root, &if exponent % 2 == 0 { a.abs() } else { a.clone() });
            if a.bits() > 2 && exponent > 1 {
                prop_assert_eq!((&power + &Integer::ONE).root_exact(exponent), None);
            }
        }
    }

    #[test]
    fn words(a in any::<u64>(), b in any::<u64>()) {
        prop_assert_eq!(BigInt::from(gcd_u64(a, b)), big_gcd(&a.into(), &b.into()));
    }
}
