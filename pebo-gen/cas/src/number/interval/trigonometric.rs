//! Sine, cosine and tangent.
//!
//! In: an interval of angles and a precision. Out: the image, rounded outward; none of a tangent
//! where there is or may be a pole. Angles of 2^16384 and more have only the trivial enclosure.

use dashu_int::IBig;

use super::angle::{Angle, modulo_four};
use super::dyadic::Dyadic;
use super::{Interval, Precision};

impl Interval {
    /// The sine.
    pub fn sin(&self, p: Precision) -> Option<Self> {
        Some(self.wave(1, |angle| angle.sin, p))
    }

    /// The cosine.
    pub fn cos(&self, p: Precision) -> Option<Self> {
        Some(self.wave(0, |angle| angle.cos, p))
    }

    /// The tangent; none if a pole is in the interval, or not separable from an end of it.
    pub fn tan(&self, p: Precision) -> Option<Self> {
        let more = p.more(4);
        let at = |angle: &Angle| angle.sin.div(&angle.cos, more)?.rounded(p);
        let first = Angle::at(&self.lo, more)?;
        let other = if self.is_point() { None } else { Some(Angle::at(&self.hi, more)?) };
        let last = other.as_ref().unwrap_or(&first);
        // The multiples of pi/2 that may be in the interval; the odd ones are poles.
        let end = &last.quarters.1;
        let multiples = end - &first.quarters.0;
        if multiples > IBig::ONE || (multiples == IBig::ONE && modulo_four(end) % 2 == 1) {
            return None;
        }
        Self::new(at(&first)?.lo, at(last)?.hi)
    }

    /// A function that is 1 at the multiples of pi/2 that are `peak` modulo 4, -1 at those two
    /// further on, and monotone between.
    fn wave(&self, peak: u8, at: impl Fn(Angle) -> Self, p: Precision) -> Self {
        let whole = Self { lo: -&Dyadic::ONE, hi: Dyadic::ONE };
        if self.is_point() {
            return Angle::at(&self.lo, p).map_or(whole, at);
        }
        let Some((first, last)) = Angle::at(&self.lo, p).zip(Angle::at(&self.hi, p)) else {
            return whole;
        };
        // The multiples of pi/2 that may be in the interval.
        let (mut multiple, end) = (first.quarters.0.clone(), last.quarters.1.clone());
        if &end - &multiple >= IBig::from(4) {
            return whole;
        }
        let mut image = at(first).hull(&at(last));
        while multiple < end {
            multiple += IBig::ONE;
            match (modulo_four(&multiple) + 4 - peak) % 4 {
                0 => image.hi = Dyadic::ONE,
                2 => image.lo = -&Dyadic::ONE,
                _ => {}
            }
        }
        image
    }
}
