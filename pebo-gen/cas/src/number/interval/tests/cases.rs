//! Values known exactly or to many digits, and undefined values.

use super::super::constants;
use super::super::dyadic::scaled;
use super::*;

/// True if the result is the one number.
fn is(result: Option<Interval>, n: i64) -> bool {
    result.is_some_and(|x| x == number(n))
}

#[test]
fn exact_values() {
    let p = bits(128);
    let (zero, one, minus_one) = (number(0), number(1), number(-1));
    for function in [Interval::sin, Interval::tan, Interval::asin, Interval::atan] {
        assert!(is(function(&zero, p), 0));
    }
    for function in [Interval::sinh, Interval::tanh, Interval::asinh, Interval::atanh, Interval::sqrt] {
        assert!(is(function(&zero, p), 0));
    }
    assert!(is(zero.cos(p), 1));
    assert!(is(zero.exp(p), 1));
    assert!(is(one.log(p), 0));
    assert!(is(one.acos(p), 0));
    assert!(is(one.acosh(p), 0));
    assert!(is(zero.atan2(&one, p), 0));
    assert!(is(number(144).sqrt(p), 12));
    assert!(is(number(-3).powi(5, p), -243));
    assert!(is(number(-3).powi(0, p), 1));
    assert!(is(number(8).pow(&ratio(2, 3), p), 4));
    assert!(is(point(&ratio(4, 1), 64).pow(&ratio(-1, 2), p).and_then(|x| x.powi(-1, p)), 2));
    assert!(is(zero.pow(&ratio(17, 19), p), 0));
    assert!(is(minus_one.abs().log(p), 0));
    assert_eq!(zero.atan2(&minus_one, p), Interval::pi(p));
    assert_eq!(minus_one.acos(p), Interval::pi(p));
}

#[test]
fn known_digits() {
    let decimal = |text| Rational::from_decimal(text).expect("a decimal number");
    let p = bits(140);
    let large = decimal("1000000000000000000000000000000");
    let gap = &Rational::ONE - &ratio(1, 1 << 40);
    let cases = [
        (Interval::pi(p), "3.1415926535897932384626433832795028841971694"),
        (number(2).log(p), "0.693147180559945309417232121458176568075500134"),
        (point(&large, 140).sin(p), "-0.090116901912138058030386428952987330274396333"),
        (number(11).tan(p), "-225.95084645419514202579548320345315395165751"),
        (number(-3).atan2(&number(-4), p), "-2.49809154479650885165983415456218024615565881"),
        (number(-20).exp(p), "0.00000000206115362243855782796594038015582097637580728"),
        (point(&gap, 140).acos(p), "0.00000134869915234871123674411922313787867091306525"),
        (number(3).sinh(p), "10.0178749274099018989745936194658280601781041"),
        (number(3).cosh(p), "10.0676619957777658419539360351158898368098037"),
        (number(3).asinh(p), "1.81844645923206682348369896356070899378625394276812161745174"),
        (number(3).acosh(p), "1.76274717403908605046521864995958461805632065652327082150659"),
        (point(&ratio(1, 3), 140).atanh(p), "0.346573590279972654708616060729088284037750067180127627060340004"),
        (
            point(&ratio(1, 1 << 40), 140).asinh(p),
            "0.000000000000909494701772928237915038937113935912289332483334816035575045",
        ),
        (number(7).pow(&ratio(5, 9), p), "2.94780608573672307340623863529620899063899048"),
        (number(7).pow(&ratio(5, 19), p), "1.66876130582960815040539331208170210756261398"),
    ];
    let slack = decimal("0.0000000000000000000000000000000000000001");
    for (enclosure, digits) in cases {
        let (enclosure, value) = (enclosure.expect(digits), decimal(digits));
        let slack = (&value * &slack).abs();
        let known = between(&(&value - &slack), &(&value + &slack), 200);
        assert!(contains(&known, &enclosure), "{enclosure} for {digits}");
    }
}

/// The kept value, another kept value, and one too long to keep are floors of the one constant.
#[test]
fn constants_are_floors() {
    for constant in [constants::pi, constants::half_pi, constants::log_two] {
        let longest = constant(33_000);
        for scale in [1, 60, 256, 257, 3000, 32_768] {
            assert_eq!(constant(scale), scaled(&longest, scale - 33_000));
        }
    }
}

#[test]
fn results_are_undefined_where_the_function_is() {
    let p = bits(64);
    let (zero, one, minus_one, two) = (number(0), number(1), number(-1), number(2));
    let around_zero = minus_one.hull(&one);
    let third = ratio(1, 3);
    assert!(one.div(&zero, p).is_none());
    assert!(one.div(&around_zero, p).is_none());
    assert!(zero.powi(-1, p).is_none());
    assert!(zero.log(p).is_none());
    assert!(zero.hull(&one).log(p).is_none());
    assert!(minus_one.sqrt(p).is_none());
    assert!(around_zero.sqrt(p).is_none());
    assert!(minus_one.pow(&third, p).is_none());
    assert!(zero.pow(&-&third, p).is_none());
    assert!(one.hull(&two).asin(p).is_none());
    assert!(minus_one.hull(&number(-2)).acos(p).is_none());
    assert!(one.hull(&two).tan(p).is_none());
    assert!(one.hull(&number(9)).tan(p).is_none());
    assert!(two.hull(&number(4)).tan(p).is_some());
    assert!(zero.hull(&two).acosh(p).is_none());
    assert!(one.atanh(p).is_none() && minus_one.hull(&zero).atanh(p).is_none());
    assert!(zero.atan2(&zero, p).is_none());
    assert!(around_zero.atan2(&minus_one, p).is_none());
    assert!(around_zero.atan2(&around_zero, p).is_none());
    assert!(zero.hull(&one).atan2(&around_zero, p).is_none());
    assert!(zero.hull(&one).atan2(&minus_one, p).is_some());
    assert!(around_zero.atan2(&one, p).is_some());
}

#[test]
fn straight_pieces_are_exact() {
    let zero = number(0);
    let (low, high) = (number(-2).hull(&number(1)), zero.hull(&number(3)));
    assert_eq!(low.min(&high), number(-2).hull(&number(1)));
    assert_eq!(low.max(&high), zero.hull(&number(3)));
    assert_eq!(low.sat(), number(-1).hull(&number(1)));
    assert_eq!(number(5).sat(), number(1));
    assert_eq!((number(-5).sign(), number(5).sign()), (Some(number(-1)), Some(number(1))));
    assert!(zero.sign().is_none() && low.sign().is_none(), "a sign is asked for off zero");
}

#[test]
fn absolute_values_are_bounded() {
    let p = bits(64);
    let million = number(1_048_576);
    assert!(million.exp(p).is_none());
    assert!(million.sinh(p).is_none());
    assert!(million.cosh(p).is_none());
    assert!(million.neg().exp(p).is_some_and(|x| x.contains_zero() && x.width() < 1e-300));
    assert!(million.tanh(p).is_some_and(|x| !x.excludes(&Rational::ONE) && x.is_positive()));

    let huge = number(2).powi(1 << 40, p).expect("in range");
    assert!(huge.mul(&huge, p).is_none());
    assert!(number(2).powi(i64::MAX, p).is_none());
    assert_eq!(huge.sin(p), Some(number(-1).hull(&number(1))));
    assert!(huge.tan(p).is_none());
    assert!(meets(&huge.add(&number(1), p).expect("in range"), &huge));
    let tiny = number(2).powi(-(1 << 39), p).expect("in range");
    let odd = [Interval::sin, Interval::atan, Interval::sinh, Interval::tanh, Interval::asin];
    for function in odd.into_iter().chain([Interval::asinh, Interval::atanh]) {
        let image = function(&tiny, p).expect("in the domain");
        assert!(meets(&image, &tiny) && image.is_positive());
    }
    let cube = tiny.powi(3, p).expect("widened to reach zero");
    assert!(cube.contains_zero() && cube.width() > 0.0);
}

#[test]
fn extrema_inside_the_interval() {
    let p = bits(64);
    let whole = number(-1).hull(&number(1));
    let of = |from, to| number(from).hull(&number(to));
    let upper_is_one = |x: Option<Interval>| x.is_some_and(|x| x.hi == number(1).hi);
    let lower_is_minus_one = |x: Option<Interval>| x.is_some_and(|x| x.lo == number(-1).lo);
    assert!(upper_is_one(of(1, 2).sin(p)) && !lower_is_minus_one(of(1, 2).sin(p)));
    assert!(lower_is_minus_one(of(4, 5).sin(p)) && !upper_is_one(of(4, 5).sin(p)));
    assert!(lower_is_minus_one(of(-2, -1).sin(p)));
    assert!(upper_is_one(of(-1, 1).cos(p)));
    assert!(lower_is_minus_one(of(3, 4).cos(p)));
    assert!(!upper_is_one(of(2, 4).sin(p)) && !lower_is_minus_one(of(2, 4).sin(p)));
    assert_eq!(of(0, 7).sin(p), Some(whole.clone()));
    assert_eq!(of(-100, 100).cos(p), Some(whole));
    assert_eq!(of(-2, 1).powi(2, p), Some(of(0, 4)));
    assert_eq!(of(-2, 1).powi(3, p), Some(of(-8, 1)));
    assert_eq!(of(-2, 1).abs(), of(0, 2));
}

#[test]
fn shown_and_in_floating_point() {
    assert_eq!(number(-2).to_string(), "-2.00000000000e0");
    let third = point(&ratio(1, 3), 64);
    assert_eq!(third.to_string(), "3.33333333333e-1 +- 1.4e-20");
    assert!(third.lo() < third.hi() && third.hi() - third.lo() <= f64::EPSILON / 4.0);
    assert!(third.excludes(&ratio(1, 2)) && !third.excludes(&ratio(1, 3)));
    let tiny = number(2).powi(-2000, bits(64)).expect("in range");
    assert_eq!((tiny.lo(), tiny.hi()), (0.0, f64::from_bits(1)));
    let huge = number(-2).powi(1025, bits(64)).expect("in range");
    assert_eq!((huge.lo(), huge.hi()), (f64::NEG_INFINITY, f64::MIN));
    assert_eq!((huge.neg().lo(), huge.neg().hi()), (f64::MAX, f64::INFINITY));
}
