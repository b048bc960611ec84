//! Piecewise linear functions: exact, as the end points are.

use super::Interval;
use super::dyadic::Dyadic;

impl Interval {
    /// The sign of the numbers, of an interval without zero.
    pub fn sign(&self) -> Option<Self> {
        match (self.is_positive(), self.is_negative()) {
            (true, _) => Some(Self::point(Dyadic::ONE)),
            (_, true) => Some(Self::point(-&Dyadic::ONE)),
            _ => None,
        }
    }

    /// The smaller of two numbers.
    pub fn min(&self, other: &Self) -> Self {
        Self { lo: self.lo.clone().min(other.lo.clone()), hi: self.hi.clone().min(other.hi.clone()) }
    }

    /// The larger of two numbers.
    pub fn max(&self, other: &Self) -> Self {
        Self { lo: self.lo.clone().max(other.lo.clone()), hi: self.hi.clone().max(other.hi.clone()) }
    }

    /// The nearest number in [-1, 1].
    pub fn sat(&self) -> Self {
        self.max(&Self::point(-&Dyadic::ONE)).min(&Self::point(Dyadic::ONE))
    }
}
