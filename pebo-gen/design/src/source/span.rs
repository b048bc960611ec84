//! A range of bytes in a text.

use std::ops::Range;

/// A byte range of a [`Source`](super::Source)'s text: from `start` up to, not including, `end`.
///
/// An empty span is a point: where something is missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// No span in the text: the cause of a diagnostic is elsewhere, as in the call, or concerns a file as a whole. It
    /// is rendered without an excerpt.
    pub const NOWHERE: Self = Self { start: usize::MAX, end: usize::MAX };

    /// The span from `start` to `end`; an inverted pair is read as the point `start`.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end: end.max(start) }
    }

    /// The point at `offset`.
    pub fn point(offset: usize) -> Self {
        Self { start: offset, end: offset }
    }

    /// The least span that covers both.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// Number of bytes.
    pub fn len(self) -> usize {
        self.end - self.start
    }

    /// Tests whether it is a point.
    pub fn is_empty(self) -> bool {
        self.start == self.end
    }

    /// The same range for slicing.
    pub fn range(self) -> Range<usize> {
        self.start..self.end
    }
}
