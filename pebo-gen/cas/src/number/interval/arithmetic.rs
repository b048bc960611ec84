//! Sum, difference, product, quotient, negation and absolute value.
//!
//! In: intervals. Out: the exact image, rounded outward. Holds: the image of a part of an operand
//! lies in the image of the whole.

use super::dyadic::{Dyadic, Side};
use super::{Interval, Precision};

impl Interval {
    /// a + b.
    pub fn add(&self, other: &Self, p: Precision) -> Option<Self> {
        Self::new(self.lo.sum(&other.lo, p.bits(), Side::Below), self.hi.sum(&other.hi, p.bits(), Side::Above))
    }

    /// a - b.
    pub fn sub(&self, other: &Self, p: Precision) -> Option<Self> {
        self.add(&other.neg(), p)
    }

    /// -a.
    pub fn neg(&self) -> Self {
        Self { lo: -&self.hi, hi: -&self.lo }
    }

    /// |a|.
    pub fn abs(&self) -> Self {
        if self.lo.is_negative() && self.hi.is_positive() {
            Self { lo: Dyadic::ZERO, hi: self.hi.clone().max(-&self.lo) }
        } else if self.lo.is_negative() {
            self.neg()
        } else {
            self.clone()
        }
    }

    /// a b.
    pub fn mul(&self, other: &Self, p: Precision) -> Option<Self> {
        if self.is_point() && other.is_point() {
            return Self::point(self.lo.product(&other.lo)).rounded(p);
        }
        let (least, greatest) = if self.is_mixed() && other.is_mixed() {
            (
                self.lo.product(&other.hi).min(self.hi.product(&other.lo)),
                self.lo.product(&other.lo).max(self.hi.product(&other.hi)),
            )
        } else if self.is_mixed() {
            return other.mul(self, p);
        } else if self.lo.is_negative() {
            return Some(self.neg().mul(other, p)?.neg());
        } else {
            // a >= 0: each end point of b goes with the end of a that takes it further out.
            let least_with = if other.lo.is_negative() { &self.hi } else { &self.lo };
            let greatest_with = if other.hi.is_negative() { &self.lo } else { &self.hi };
            (least_with.product(&other.lo), greatest_with.product(&other.hi))
        };
        Self { lo: least, hi: greatest }.rounded(p)
    }

    /// a / b; none where b contains zero.
    pub fn div(&self, other: &Self, p: Precision) -> Option<Self> {
        if other.contains_zero() {
            return None;
        }
        if other.is_negative() {
            return Some(self.div(&other.neg(), p)?.neg());
        }
        let least_by = if self.lo.is_negative() { &other.lo } else { &other.hi };
        let greatest_by = if self.hi.is_negative() { &other.hi } else { &other.lo };
        Self::new(
            self.lo.quotient(least_by, p.bits(), Side::Below),
            self.hi.quotient(greatest_by, p.bits(), Side::Above),
        )
    }

    /// a 2^places, exactly.
    pub(super) fn shifted(&self, places: i64) -> Self {
        Self { lo: self.lo.shifted(places), hi: self.hi.shifted(places) }
    }

    /// True if there are numbers on both sides of zero.
    fn is_mixed(&self) -> bool {
        self.lo.is_negative() && self.hi.is_positive()
    }
}
