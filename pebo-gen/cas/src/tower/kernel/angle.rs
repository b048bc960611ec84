//! Angles with their sine, cosine and range, as values.

use super::range::Range;
use crate::tower::fraction::Fraction;

/// Sine and cosine of one angle.
pub(in crate::tower) type Pair = (Fraction, Fraction);

/// An angle with its sine and cosine.
#[derive(Clone, Debug)]
pub(in crate::tower) struct InverseAngle {
    pub value: Fraction,
    pub pair: Pair,
    pub range: Range,
}
