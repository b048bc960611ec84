//! The constants pi and log 2 as integers.
//!
//! In: a scale. Out: exactly floor(c 2^scale). Holds: the answer does not depend on earlier calls, as the floor of a
//! shifted floor is the floor; so a longer one may be kept for shorter ones. Both constants are irrational, which is
//! why the search for an unambiguous floor ends.

use std::sync::OnceLock;

use dashu_int::IBig;

use super::dyadic::scaled;

/// Kept: the values at scales 2^`SHORTEST` and the next powers of two.
const SHORTEST: i64 = 8;
const KEPT: usize = 8;

/// floor(pi 2^scale).
pub(super) fn pi(scale: i64) -> IBig {
    static VALUES: [OnceLock<IBig>; KEPT] = [const { OnceLock::new() }; KEPT];
    // Machin's formula.
    kept(&VALUES, scale, &[(16, 5), (-4, 239)], true)
}

/// floor(pi/2 2^scale).
pub(super) fn half_pi(scale: i64) -> IBig {
    pi(scale - 1)
}

/// floor(log(2) 2^scale).
pub(super) fn log_two(scale: i64) -> IBig {
    static VALUES: [OnceLock<IBig>; KEPT] = [const { OnceLock::new() }; KEPT];
    // 2 = (27/25)^9 (4802/4800)^-1 (8750/8748)^4, and atanh(1/n) is half the log of (n+1)/(n-1).
    kept(&VALUES, scale, &[(18, 26), (-2, 4801), (8, 8749)], false)
}

type Formula = [(i64, i64)];

fn kept(values: &[OnceLock<IBig>], scale: i64, formula: &Formula, alternating: bool) -> IBig {
    let scales = (SHORTEST..).map(|level| 1 << level);
    match scales.zip(values).find(|(longer, _)| scale <= *longer) {
        Some((longer, value)) => {
            let floor = value.get_or_init(|| exact_floor(longer, formula, alternating));
            scaled(floor, scale - longer)
        }
        None => exact_floor(scale, formula, alternating),
    }
}

/// The floor of a combination of inverse tangents, circular if alternating, else hyperbolic.
fn exact_floor(scale: i64, formula: &Formula, alternating: bool) -> IBig {
    let mut guard = 32;
    loop {
        let mut value = IBig::ZERO;
        let mut error = IBig::ZERO;
        for &(weight, n) in formula {
            let (series, bound) = inverse_tangent(n, scale + guard, alternating);
            value += series * weight;
            error += bound * weight.abs();
        }
        let floor = scaled(&(&value - &error), -guard);
        if floor == scaled(&(value + error), -guard) {
            return floor;
        }
        guard *= 2;
    }
}

/// The sum of (+-1)^j / ((2j+1) n^(2j+1)), n >= 5, and a bound of its error in ulps.
///
/// Each power is off by less than 1/n^2 of the error before it and one ulp, so less than 2; each
/// term by less than 2; the terms after a power that rounds to zero are less than 2 ulps.
fn inverse_tangent(n: i64, scale: i64, alternating: bool) -> (IBig, i64) {
    let square = if alternating { -n * n } else { n * n };
    let mut power = scaled(&IBig::ONE, scale) / n;
    let mut sum = power.clone();
    let mut odd = 1;
    while !power.is_zero() {
        power /= square;
        odd += 2;
        sum += &power / odd;
    }
    (sum, odd + 3)
}
