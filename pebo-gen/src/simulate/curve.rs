//! What the figure needs to know of a value that is sampled a million times.
//!
//! In: every sample. Out: for each of some hundred equal spans of time, the first, the least, the largest
//! and the last value with their instants. A line through these looks as one through all samples would
//! (Jugel, Jerzak, Hackenbroich, Markl, M4, 2014).

/// Spans of time: more than the figure has columns of dots in print.
const SPANS: u64 = 800;

/// Where a curve goes.
#[derive(Clone, Debug, Default)]
pub(super) struct Curve {
    /// Instants and values, in the order of time; a value that is not finite is a gap.
    points: Vec<(f64, f64)>,
    span: Option<Span>,
}

#[derive(Clone, Copy, Debug)]
struct Span {
    index: u64,
    first: (f64, f64),
    least: (f64, f64),
    largest: (f64, f64),
    last: (f64, f64),
}

impl Curve {
    /// Adds the sample of this number out of `samples`.
    pub(super) fn add(&mut self, sample: u64, samples: u64, point: (f64, f64)) {
        // At most SPANS * 2^28 or so.
        let index = sample * SPANS / samples.max(1);
        match &mut self.span {
            Some(span) if span.index == index && point.1.is_finite() && span.least.1.is_finite() => {
                if point.1 < span.least.1 {
                    span.least = point;
                }
                if point.1 > span.largest.1 {
                    span.largest = point;
                }
                span.last = point;
            }
            _ => {
                self.close();
                self.span = Some(Span { index, first: point, least: point, largest: point, last: point });
            }
        }
    }

    /// The points, after the last sample.
    pub(super) fn finish(mut self) -> Vec<(f64, f64)> {
        self.close();
        self.points
    }

    fn close(&mut self) {
        let Some(Span { first, mut least, mut largest, last, .. }) = self.span.take() else { return };
        if least.0 > largest.0 {
            std::mem::swap(&mut least, &mut largest);
        }
        for point in [first, least, largest, last] {
            if self.points.last().is_none_or(|before| before.0 < point.0) {
                self.points.push(point);
            }
        }
    }
}
