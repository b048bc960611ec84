//! Thins a curve of a million samples for the figure.
//!
//! In: every sample. Out: for each of some hundred equal spans of time, the first, the least, the largest
//! and the last value with their instants. A line through these looks as one through all samples would
//! (Jugel, Jerzak, Hackenbroich, Markl, M4, 2014).

use super::panel::Panel;

/// Spans of time: more than the figure has columns of dots in print.
const SPANS: u64 = 800;

/// A curve as it is drawn: instants with values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DrawnCurve {
    pub(crate) line: Vec<(f64, f64)>,
    /// The lower and the upper edge of the band about it.
    pub(crate) band: Option<[Vec<(f64, f64)>; 2]>,
}

/// The curves of each panel, from their points one after the other: the line, then the edges of its band if it has one.
pub(crate) fn drawn(panels: &[Panel], points: impl IntoIterator<Item = Vec<(f64, f64)>>) -> Vec<Vec<DrawnCurve>> {
    let mut points = points.into_iter();
    let mut next = || points.next().unwrap_or_default();
    let mut curve = |has_band: bool| {
        let line = next();
        DrawnCurve { line, band: has_band.then(|| [next(), next()]) }
    };
    panels.iter().map(|panel| panel.curves.iter().map(|of| curve(of.has_band)).collect()).collect()
}

/// The points of a curve.
#[derive(Clone, Debug, Default)]
pub(crate) struct Curve {
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
    pub(crate) fn add(&mut self, sample: u64, samples: u64, point: (f64, f64)) {
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
    pub(crate) fn finish(mut self) -> Vec<(f64, f64)> {
        self.close();
        self.points
    }

    fn close(&mut self) {
        if let Some(span) = self.span.take() {
            span.append(&mut self.points);
        }
    }
}

impl Span {
    /// Adds the points to a line that ends before them.
    fn append(self, points: &mut Vec<(f64, f64)>) {
        let Self { first, mut least, mut largest, last, .. } = self;
        if least.0 > largest.0 {
            std::mem::swap(&mut least, &mut largest);
        }
        for point in [first, least, largest, last] {
            if points.last().is_none_or(|before| before.0 < point.0) {
                points.push(point);
            }
        }
    }

    /// This span and the next in one. Values that are not finite make a gap only where there are no others.
    fn and(self, next: Self) -> Self {
        if !self.least.1.is_finite() {
            return Self { index: self.index, ..next };
        }
        if !next.least.1.is_finite() {
            return self;
        }
        let least = if next.least.1 < self.least.1 { next.least } else { self.least };
        let largest = if next.largest.1 > self.largest.1 { next.largest } else { self.largest };
        Self { least, largest, last: next.last, ..self }
    }
}

/// The same for a curve of unknown length: its spans grow with it.
#[derive(Clone, Debug, Default)]
pub(crate) struct GrowingCurve {
    /// At most twice as many as a curve of known length has.
    spans: Vec<Span>,
    /// A span has two to this power samples.
    doublings: u32,
    samples: u64,
}

impl GrowingCurve {
    /// Adds the next sample.
    pub(crate) fn add(&mut self, point: (f64, f64)) {
        let mut index = self.samples >> self.doublings;
        if index >= 2 * SPANS {
            let halved = self.spans.chunks(2).map(|pair| {
                let both = pair.iter().copied().reduce(Span::and).unwrap_or(pair[0]);
                Span { index: both.index / 2, ..both }
            });
            self.spans = halved.collect();
            self.doublings += 1;
            index /= 2;
        }
        self.samples += 1;
        let span = Span { index, first: point, least: point, largest: point, last: point };
        match self.spans.last_mut() {
            Some(last) if last.index == index => *last = last.and(span),
            _ => self.spans.push(span),
        }
    }

    /// The points, after the last sample.
    pub(crate) fn finish(self) -> Vec<(f64, f64)> {
        let mut points = Vec::new();
        self.spans.into_iter().for_each(|span| span.append(&mut points));
        points
    }
}
