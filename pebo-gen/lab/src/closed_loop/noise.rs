//! White random numbers, the same in every run with the same seed.
//!
//! In: a seed, a stream and a sample; an output is a stream. Out: a normal number, or a uniform one. Nothing is kept
//! from one number to the next, so that the noise of an output does not depend on the noise of others or on the number
//! of calls. It is our own, because a figure must not change with a library's version.
//!
//! Method: the finaliser of `SplitMix64` (Steele, Lea, Flood, *Fast splittable pseudorandom number generators*, 2014)
//! as a hash of the three; Box and Muller's method.

use std::f64::consts::TAU;

use crate::timing::real;

/// `SplitMix64`'s increment, the golden ratio's fraction of 2^64.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The stream that decides about dropped samples.
pub(crate) const DROPPED: u64 = u64::MAX;

/// The stream that moves instants from their places.
pub(crate) const JITTER: u64 = u64::MAX - 1;

/// A normal number of variance 1.
pub(crate) fn normal(seed: u64, stream: u64, sample: u64) -> f64 {
    let [radius, angle] = [2 * sample + 1, 2 * sample + 2].map(|number| drawn(seed, stream, number));
    (-2.0 * radius.ln()).sqrt() * (TAU * angle).cos()
}

/// A number uniformly distributed between 0 and 1.
pub(crate) fn even(seed: u64, stream: u64, sample: u64) -> f64 {
    drawn(seed, stream, sample + 1)
}

fn drawn(seed: u64, stream: u64, number: u64) -> f64 {
    let stream = mixed(mixed(seed.wrapping_add(STEP)).wrapping_add(stream.wrapping_mul(STEP)));
    uniform(mixed(stream.wrapping_add(number.wrapping_mul(STEP))))
}

fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Uniformly distributed between 0 and 1, 0 excluded: of the 53 bits that a number holds.
fn uniform(bits: u64) -> f64 {
    (real(bits >> 11) + 1.0) / real(1 << 53)
}

#[cfg(test)]
mod tests {
    use super::{DROPPED, even, normal};

    /// Moments of many numbers, and correlations with those beside them in all three directions.
    #[test]
    fn numbers_are_normal_and_white() {
        const COUNT: u32 = 200_000;
        let mean = |value: &dyn Fn(u64) -> f64| (0..u64::from(COUNT)).map(value).sum::<f64>() / f64::from(COUNT);
        // Five standard deviations of a mean of so many, whose terms have the variance that is given.
        let near = |found: f64, expected: f64, variance: f64| {
            let bound = 5.0 * (variance / f64::from(COUNT)).sqrt();
            assert!((found - expected).abs() < bound, "{found}, {expected}");
        };
        let at = |k: u64| normal(7, 2, k);
        near(mean(&at), 0.0, 1.0);
        near(mean(&|k| at(k).powi(2)), 1.0, 2.0);
        near(mean(&|k| at(k).powi(3)), 0.0, 15.0);
        near(mean(&|k| at(k).powi(4)), 3.0, 96.0);
        near(mean(&|k| at(k) * at(k + 1)), 0.0, 1.0);
        near(mean(&|k| at(k) * normal(7, 3, k)), 0.0, 1.0);
        near(mean(&|k| at(k) * normal(8, 2, k)), 0.0, 1.0);
        let share = |k: u64| even(7, DROPPED, k);
        assert!((0..u64::from(COUNT)).all(|k| share(k) > 0.0 && share(k) <= 1.0));
        near(mean(&share), 0.5, 1.0 / 12.0);
        near(mean(&|k| (share(k) - 0.5).powi(2)), 1.0 / 12.0, 1.0 / 180.0);
        near(mean(&|k| (share(k) - 0.5) * (share(k + 1) - 0.5)), 0.0, 1.0 / 144.0);
        near(mean(&|k| (share(k) - 0.5) * at(k)), 0.0, 1.0 / 12.0);
    }
}
