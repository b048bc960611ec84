//! Puts samples together whose outputs arrive at different times.
//!
//! In: what arrives now, output by output with its age, and the input since the time before. Out: the samples of the
//! past, each whole as soon as the last of its outputs is there.

use core::cmp::Ordering;
use core::ops::Range;

use nalgebra::SVector;

use super::unwrapped;
use crate::Real;
use crate::numeric::sum::all_finite;

/// An instant of the past.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Instant<S: Real, const NY: usize, const NU: usize> {
    /// Seconds since the instant before it.
    pub dt: S,
    /// The mean of the input between the two.
    pub u: SVector<S, NU>,
    /// The outputs; NaN of those that have not arrived, or never will.
    pub y: SVector<S, NY>,
    /// True for outputs that have arrived, or never will.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    is_settled: [bool; NY],
}

impl<S: Real, const NY: usize, const NU: usize> Instant<S, NY, NU> {
    fn new(u: SVector<S, NU>, dt: S) -> Self {
        Self { dt, u, y: SVector::repeat(Real::from_f64(f64::NAN)), is_settled: [false; NY] }
    }

    /// True if it has all outputs.
    pub(crate) fn is_complete(&self) -> bool {
        self.y.iter().all(|output| Real::is_finite(*output))
    }

    /// The same after another interval before its own.
    #[must_use]
    pub(crate) fn after(mut self, before: &Self) -> Self {
        let whole = self.dt + before.dt;
        self.u += (before.u - self.u) * (before.dt / whole);
        self.dt = whole;
        self
    }
}

/// The instants for which outputs are still on their way, at most `N`.
///
/// What arrives is of a time that need not be an instant: an instant between two arrivals has the value on the straight
/// line between them. If the arrival before is missing, the arrival counts for the instant at its time or the last one
/// before that.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Arrivals<S: Real, const NY: usize, const NU: usize, const N: usize> {
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    ring: [Instant<S, NY, NU>; N],
    /// The index of the oldest instant, and the number of instants.
    oldest: usize,
    count: usize,
    /// The last arrival of each output, and its age; NaN for none.
    last: SVector<S, NY>,
    ages: SVector<S, NY>,
}

impl<S: Real, const NY: usize, const NU: usize, const N: usize> Default for Arrivals<S, NY, NU, N> {
    fn default() -> Self {
        const { assert!(N > 1, "a ring has room for the instant of now and one of the past") };
        let none = SVector::repeat(Real::from_f64(f64::NAN));
        let ring = [Instant::new(SVector::zeros(), S::zero()); N];
        Self { ring, oldest: 0, count: 0, last: none, ages: none }
    }
}

impl<S: Real, const NY: usize, const NU: usize, const N: usize> Arrivals<S, NY, NU, N> {
    /// Takes what arrives at the end of an interval of `dt` seconds with this mean input: of each output its value, NaN for
    /// none, its age, and its period, 0 if it is no angle. Where there is no room, the interval is joined to the one before.
    pub(crate) fn take(
        &mut self,
        y: &SVector<S, NY>,
        [delays, periods]: [&SVector<S, NY>; 2],
        u: &SVector<S, NU>,
        dt: S,
    ) {
        let mut now = Instant::new(*u, dt);
        if self.count == N {
            if let Some(newest) = self.ring.get(self.place(N - 1)) {
                now = now.after(newest);
            }
        } else {
            self.count += 1;
        }
        let place = self.place(self.count - 1);
        if let Some(slot) = self.ring.get_mut(place) {
            *slot = now;
        }
        self.ages.iter_mut().for_each(|age| *age += dt);
        for output in 0..NY {
            self.receive(output, y[output], delays[output], periods[output]);
        }
    }

    /// The index of an instant, counted from the oldest.
    fn place(&self, from_oldest: usize) -> usize {
        (self.oldest + from_oldest) % N
    }

    /// Settles the output of the instants up to the time that its arrival is of.
    fn receive(&mut self, output: usize, value: S, delay: S, period: S) {
        let (mut age, mut is_first) = (S::zero(), true);
        for from_oldest in (0..self.count).rev() {
            let found = self.at(output, (value, delay, period), age, is_first);
            let place = self.place(from_oldest);
            let Some(instant) = self.ring.get_mut(place) else { return };
            if let Some(found) = found {
                is_first = false;
                if instant.is_settled.get(output) == Some(&false) {
                    instant.y[output] = found;
                    instant.is_settled[output] = true;
                }
            }
            age += instant.dt;
        }
        if self.is_newer(output, delay) {
            (self.last[output], self.ages[output]) = (value, delay);
        }
    }

    /// True if an arrival of this age is of a time after the last one.
    fn is_newer(&self, output: usize, delay: S) -> bool {
        // That of none is NaN.
        self.ages[output].partial_cmp(&delay).is_none_or(Ordering::is_gt)
    }

    /// What an arrival says of the output at an instant of this age; none if that is after the time that it is of.
    fn at(&self, output: usize, (value, delay, period): (S, S, S), age: S, is_first: bool) -> Option<S> {
        // Ages are sums of periods: what is above their rounding, and far below a period, makes no difference.
        let slack = Real::sqrt(S::EPSILON) * (age + delay);
        if age < delay - slack {
            return None;
        }
        let (last, before) = (self.last[output], self.ages[output]);
        if age <= delay + slack || (is_first && !Real::is_finite(last)) {
            return Some(if Real::is_finite(last) { unwrapped(value, last, period) } else { value });
        }
        // Where the arrival before is missing, so is what is between the two.
        let value = unwrapped(value, last, period);
        Some(value + (last - value) * ((age - delay) / (before - delay)))
    }

    /// The oldest instant, if nothing that belongs to it is on its way.
    pub(crate) fn whole(&self) -> Option<Instant<S, NY, NU>> {
        let oldest = self.ring.get(self.oldest).filter(|_| self.count > 0)?;
        oldest.is_settled.iter().all(|settled| *settled).then_some(*oldest)
    }

    /// The oldest instant as it will be when this arrives after `dt` seconds, if it is whole then.
    pub(crate) fn whole_with(
        &self,
        y: &SVector<S, NY>,
        ages: [&SVector<S, NY>; 2],
        u: &SVector<S, NU>,
        dt: S,
    ) -> Option<Instant<S, NY, NU>> {
        let mut later = *self;
        later.take(y, ages, u, dt);
        later.whole()
    }

    /// Lets go of the oldest instant.
    pub(crate) fn pass(&mut self) {
        if self.count > 0 {
            (self.oldest, self.count) = (self.place(1), self.count - 1);
        }
    }

    /// Lets go of the oldest instant as if it had not been: its interval is joined to the next one's.
    pub(crate) fn skip(&mut self) {
        let skipped = self.ring.get(self.oldest).copied();
        self.pass();
        let oldest = self.oldest;
        if let (Some(skipped), Some(next)) = (skipped, self.ring.get_mut(oldest).filter(|_| self.count > 0)) {
            *next = next.after(&skipped);
        }
    }

    /// The number of instants.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// These instants, counted from the oldest, as one interval with the outputs at its end; none of none.
    pub(crate) fn joined(&self, range: Range<usize>) -> Option<Instant<S, NY, NU>> {
        let instants = range.filter_map(|from_oldest| self.ring.get(self.place(from_oldest)));
        instants.copied().reduce(|before, instant| instant.after(&before))
    }

    /// True if every number is finite, or NaN for an output that is missing.
    pub(crate) fn is_sound(&self) -> bool {
        let is_number = |value: &S| Real::is_finite(*value) || value.partial_cmp(value).is_none();
        let is_good = |instant: &Instant<S, NY, NU>| {
            all_finite(&instant.u) && Real::is_finite(instant.dt) && instant.y.iter().all(is_number)
        };
        self.oldest < N && self.count <= N && self.ring.iter().all(is_good)
    }
}
