//! Samples of angles without the steps of their sensors.

use nalgebra::ComplexField;

use crate::Real;

/// The angle nearest `last` among those that differ from `angle` by whole periods: a sensor that goes from one end of
/// its range to the other has gone on by little. Between two samples the angle has to move by less than half a period.
///
/// The result counts turns, and has the digits that their number leaves: in `f32` an angle of 1000 turns is known to
/// some 0.0005 rad. A period that is not positive changes nothing.
#[inline]
pub fn unwrapped<S: Real>(angle: S, last: S, period: S) -> S {
    if period > S::zero() { angle + ComplexField::round((last - angle) / period) * period } else { angle }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    #[test]
    fn an_angle_goes_on_over_the_end_of_its_range() {
        let mut last = 0.0;
        for k in 0..1000 {
            let angle = 0.37 * f64::from(k) - 40.0;
            let wrapped = angle - TAU * ComplexField::round(angle / TAU);
            last = if k == 0 { angle } else { unwrapped(wrapped, last, TAU) };
            assert!(Real::abs(last - angle) < 1e-12, "{k}: {last} for {angle}");
        }
        assert!(Real::abs(unwrapped(3.0, -40.0, 0.0) - 3.0) < f64::EPSILON);
        assert!(unwrapped(f64::NAN, 1.0, TAU).is_nan());
    }
}
