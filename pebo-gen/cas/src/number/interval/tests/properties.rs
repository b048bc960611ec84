//! Properties of every function: inclusion, refinement, tightness, agreement with `f64`, no panic.

use proptest::num::f64::{NORMAL, SUBNORMAL};

use super::*;

/// The neighbours four units of the last place below and above.
fn widened(value: f64) -> (f64, f64) {
    let slack = value.abs() * 4.0 * f64::EPSILON + f64::MIN_POSITIVE;
    (value - slack, value + slack)
}

/// The interval, one unit of the precision wider at either end.
fn loosened(x: &Interval, precision: u32) -> Interval {
    let p = bits(precision);
    let unit = number(2).powi(1 - i64::from(precision), p).expect("in range");
    x.add(&x.mul(&unit.hull(&unit.neg()), p).expect("in range"), p).expect("in range")
}

/// The ends of a part of a domain; some of them a turn or less apart.
fn ends() -> impl Strategy<Value = [i64; 2]> {
    let near = |(a, step): (i64, i64)| [a, (a + step).min((1 << 20) - 1)];
    prop_oneof![[part(), part()], (part(), 0_i64..4000).prop_map(near)]
}

/// True if a function is within two units at a precision, and its enclosure with more bits within the coarse one.
fn tight_and_finer(function: &Unary, argument: &Rational, precision: u32) -> Result<(), TestCaseError> {
    let at = |n: u32| (function.enclose)(&point(argument, 64.max(n)), bits(n)).unwrap();
    let (coarse, fine) = (at(precision), at(precision + 100));
    let scale = coarse.lo().abs().max(coarse.hi().abs());
    let unit = 2_f64.powi(2 - i32::try_from(precision).unwrap());
    prop_assert!(coarse.width() <= unit * scale, "{} {argument} at {precision} bits", function.name);
    prop_assert!(contains(&loosened(&coarse, precision), &fine), "{} {argument} at {precision} bits", function.name);
    Ok(())
}

/// Small arguments, where a function hands over from its series to a few terms: at every precision about there.
#[test]
fn tight_next_to_zero() {
    for function in FUNCTIONS.iter().filter(|function| function.domain.0 < 0) {
        for precision in 16_u32..90 {
            for places in (precision / 2).saturating_sub(4)..precision / 2 + 5 {
                for numerator in [1025, 1535, 1536, 2047, -1535] {
                    let argument = ratio(numerator, 1_i64 << (10 + places));
                    tight_and_finer(function, &argument, precision).unwrap();
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn agrees_with_floating_point(part in part()) {
        for function in &FUNCTIONS {
            let argument = function.argument(part);
            let (lo, hi) = widened((function.value)(argument.to_f64()));
            let image = (function.enclose)(&point(&argument, 64), bits(64)).unwrap();
            prop_assert!(lo <= image.hi() && image.lo() <= hi, "{} {argument}", function.name);
        }
    }

    #[test]
    fn tight_and_finer_with_more_bits(part in part(), precision in 16_u32..200) {
        for function in &FUNCTIONS {
            tight_and_finer(function, &function.argument(part), precision)?;
        }
    }

    #[test]
    fn image_of_a_part_is_part_of_the_image(ends in ends(), inner in [0_i64..=8, 0..=8]) {
        for function in &FUNCTIONS {
            let [a, b] = ends.map(|part| function.argument(part));
            let step = &(&b - &a) * &ratio(1, 8);
            let [c, d] = inner.map(|n| &a + &(&step * &ratio(n, 1)));
            let whole = (function.enclose)(&between(&a, &b, 64), bits(64)).unwrap();
            let part = (function.enclose)(&between(&c, &d, 64), bits(200)).unwrap();
            prop_assert!(contains(&loosened(&whole, 64), &part), "{} {a} {b}", function.name);
        }
    }

    #[test]
    fn arithmetic_is_monotone(
        [a, b, c, d] in [wide(), wide(), wide(), wide()],
        inner in [0_i64..=8, 0..=8],
    ) {
        let p = bits(64);
        let at = |n| &a + &(&(&b - &a) * &ratio(n, 8));
        let (x, y) = (between(&a, &b, 400), between(&c, &d, 400));
        let part = between(&at(inner[0]), &at(inner[1]), 300);
        let part = Interval { lo: part.lo.max(x.lo.clone()), hi: part.hi.min(x.hi.clone()) };
        for operation in [Interval::add, Interval::sub, Interval::mul, Interval::div] {
            if let Some(whole) = operation(&x, &y, p) {
                prop_assert!(contains(&whole, &operation(&part, &y, p).unwrap()));
            }
            if let Some(whole) = operation(&y, &x, p) {
                prop_assert!(contains(&whole, &operation(&y, &part, p).unwrap()));
            }
        }
        prop_assert!(contains(&x.abs(), &part.abs()));
        prop_assert!(contains(&x.powi(2, p).unwrap(), &part.powi(2, p).unwrap()));
    }

    #[test]
    fn floating_point_round_trip(value in NORMAL | SUBNORMAL) {
        let x = point(&Rational::from_f64_exact(value).unwrap(), 64);
        prop_assert_eq!((x.lo(), x.hi(), x.width()), (value, value, 0.0));
    }

    /// A stack machine: every operation is applied to the results of earlier ones.
    #[test]
    fn never_panics(code in prop::collection::vec((0_usize..32, wide(), 0_u32..300), 1..40)) {
        let mut stack = vec![number(1), number(-2).hull(&number(3))];
        for (operation, q, n) in code {
            let (p, last) = (bits(n), stack.len() - 1);
            let (x, y) = (stack[last].clone(), stack[last - 1].clone());
            let result = match operation {
                0..14 => (FUNCTIONS[operation].enclose)(&x, p),
                14 => x.atan2(&y, p),
                15 => x.pow(&q, p),
                16 => x.powi(i64::from(n).pow(7), p),
                17 => x.add(&y, p),
                18 => x.sub(&y, p),
                19 => x.mul(&y, p),
                20 => x.div(&y, p),
                21 => Some(x.hull(&y)),
                22 => x.powi(-i64::from(n), p),
                _ => Some(point(&q, n)),
            };
            if let Some(result) = result {
                prop_assert!(result.lo <= result.hi);
                prop_assert!(result.lo() <= result.hi() && result.width() >= 0.0);
                prop_assert!(!result.to_string().is_empty());
                stack.push(result);
            }
        }
    }
}
