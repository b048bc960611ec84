//! Functions between points.

use crate::Real;

/// A function of one argument that is a polynomial from each of `N` ascending points on, with `D` coefficients.
///
/// A row of coefficients belongs to the powers of the distance from its point, the lowest first. Before the first point
/// the function goes on with its value and slope there; the last row is affine in emitted code, so that it goes on in the
/// same way behind the last point.
///
/// ```
/// use pebo_runtime::Table;
///
/// // A line from 3 to 4, and from there to 10.
/// let curve = Table::new([0.0, 0.5, 1.0], [[3.0, 2.0], [4.0, 12.0], [10.0, 12.0]]);
/// assert_eq!((curve.value(0.25), curve.value(0.75), curve.slope(0.75)), (3.5, 7.0, 12.0));
/// assert_eq!((curve.value(-1.0), curve.value(2.0)), (1.0, 22.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<R, const N: usize, const D: usize> {
    points: [R; N],
    coefficients: [[R; D]; N],
}

impl<R, const N: usize, const D: usize> Table<R, N, D> {
    /// The function from these points on, which ascend, with these coefficients.
    pub const fn new(points: [R; N], coefficients: [[R; D]; N]) -> Self {
        Self { points, coefficients }
    }
}

impl<R: Real, const N: usize, const D: usize> Table<R, N, D> {
    /// The value; not a number where the argument is none, and zero without points.
    #[inline]
    pub fn value(&self, argument: R) -> R {
        self.derivative(0, argument)
    }

    /// The derivative by the argument.
    #[inline]
    pub fn slope(&self, argument: R) -> R {
        self.derivative(1, argument)
    }

    /// The derivative of that order by the argument; at a point, that of the row from it on.
    #[inline]
    pub fn derivative(&self, order: usize, argument: R) -> R {
        let mut rows = self.points.iter().zip(&self.coefficients);
        let Some((mut from, mut row)) = rows.next() else { return R::zero() };
        let mut terms = if *from <= argument { D } else { D.min(2) };
        for (point, own) in rows.take_while(|(point, _)| **point <= argument) {
            (from, row, terms) = (point, own, D);
        }
        let distance = argument - *from;
        let horner =
            |value: R, (power, coefficient): (usize, &R)| value * distance + *coefficient * falling(power, order);
        row.iter().enumerate().take(terms).skip(order).rev().fold(R::zero(), horner)
    }
}

/// `power (power - 1) ..`, with as many factors as the order.
#[inline]
fn falling<R: Real>(power: usize, order: usize) -> R {
    let count = |number: usize| (0..number).fold(R::zero(), |sum: R, _| sum + R::one());
    (0..order).fold(R::one(), |product: R, down| product * count(power.saturating_sub(down)))
}
