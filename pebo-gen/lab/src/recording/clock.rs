//! The clock of a recording: the time of each row.

use crate::timing::real;

/// The number of intervals whose median is the usual one; odd.
const USUAL: usize = 15;

/// A gap is longer than so many usual intervals: half-way between one, and the two that a missing row leaves.
const GAP: f64 = 1.5;

/// A step of the clock over so many usual intervals is none of the plant: by then even what the observer assumes of
/// constants has wandered by their own size.
const JUMP: f64 = 1000.0;

/// So many rows in a row, each later than the one before, are a clock that began again or jumped; fewer are late rows, or
/// a time that was read wrongly.
const AGAIN: usize = 3;

/// The time of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Instant {
    /// The first row with a time, of the recording or of a clock that began again.
    First(f64),
    /// A later row, after so many seconds, which are a gap or not.
    Later { t: f64, dt: f64, gap: bool },
    /// The time does not go on from that of the row before: the row may be out of place, or the first of a new piece.
    Astray,
    /// The row has no time.
    Timeless,
}

/// What becomes of rows that were astray, once the next one is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Held {
    /// It is not yet known.
    Open,
    /// They are out of place: the clock goes on without them.
    Misplaced,
    /// They begin a new piece, with the present row as their last.
    Piece,
}

/// The present time of a log.
#[derive(Debug)]
pub(super) enum Clock {
    /// Rows with this period in seconds, a fraction, so that instants are rounded once.
    Steady { row: u64, fraction: (f64, f64) },
    /// Rows with recorded times.
    Recorded(RecordedTime),
}

/// The time of rows that have one.
#[derive(Debug, Default)]
pub(super) struct RecordedTime {
    last: Option<f64>,
    /// Recent intervals, of which so many are known, and the place of the next.
    recent: [f64; USUAL],
    known: usize,
    next: usize,
    /// The time of the last row that was astray, and the number of those in a row.
    astray: Option<(f64, usize)>,
}

impl Clock {
    /// The clock of rows with this period, or with recorded times.
    pub(super) fn new(period: Option<(f64, f64)>) -> Self {
        match period {
            Some(fraction) => Self::Steady { row: 0, fraction },
            None => Self::Recorded(RecordedTime::default()),
        }
    }

    /// The time of the next row, which may be recorded, and what becomes of rows that were astray. Where these begin a
    /// piece, they are to be passed again, to a clock of their own.
    pub(super) fn row(&mut self, measured_time: f64) -> (Instant, Held) {
        match self {
            Self::Steady { row, fraction: (numerator, denominator) } => {
                let t = real(*row) * *numerator / *denominator;
                *row += 1;
                let dt = *numerator / *denominator;
                let instant = if *row == 1 { Instant::First(t) } else { Instant::Later { t, dt, gap: false } };
                (instant, Held::Open)
            }
            Self::Recorded(_) if !measured_time.is_finite() => (Instant::Timeless, Held::Open),
            Self::Recorded(time) => time.row(measured_time),
        }
    }
}

impl RecordedTime {
    fn row(&mut self, t: f64) -> (Instant, Held) {
        let Some(before) = self.last else {
            self.last = Some(t);
            return (Instant::First(t), Held::Open);
        };
        let dt = t - before;
        // Two intervals do not determine the usual one.
        let usual = (self.known > 2).then(|| middle(&self.recent[..self.known]));
        if dt <= 0.0 || usual.is_some_and(|usual| dt > JUMP * usual) {
            let (latest, count) = self.astray.unwrap_or((f64::NEG_INFINITY, 0));
            let count = if t > latest { count + 1 } else { 1 };
            self.astray = Some((t, count));
            let held = match count {
                1 if latest > f64::NEG_INFINITY => Held::Misplaced,
                AGAIN => Held::Piece,
                _ => Held::Open,
            };
            return (Instant::Astray, held);
        }
        let held = if self.astray.take().is_some() { Held::Misplaced } else { Held::Open };
        self.last = Some(t);
        self.recent[self.next] = dt;
        self.next = (self.next + 1) % USUAL;
        self.known = (self.known + 1).min(USUAL);
        let gap = usual.is_some_and(|usual| dt > GAP * usual);
        (Instant::Later { t, dt, gap }, held)
    }
}

fn middle(intervals: &[f64]) -> f64 {
    let mut sorted = [0.0; USUAL];
    let sorted = &mut sorted[..intervals.len()];
    sorted.copy_from_slice(intervals);
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::{Clock, Held, Instant};

    /// The instants of rows with these times, as letters: first, later, gap, astray; and what becomes of those astray.
    fn read(times: &[f64]) -> String {
        let mut clock = Clock::new(None);
        let letters = times.iter().flat_map(|t| {
            let (instant, held) = clock.row(*t);
            let instant = match instant {
                Instant::First(_) => 'f',
                Instant::Later { gap: false, .. } => 'l',
                Instant::Later { gap: true, .. } => 'g',
                Instant::Astray => 'a',
                Instant::Timeless => 't',
            };
            let held = match held {
                Held::Open => None,
                Held::Misplaced => Some('-'),
                Held::Piece => Some('+'),
            };
            [Some(instant), held].into_iter().flatten()
        });
        letters.collect()
    }

    #[test]
    fn late_rows_are_told_from_a_clock_that_begins_again() {
        assert_eq!(read(&[0.0, 1.0, 2.0, 3.0, 5.0]), "flllg");
        // One row or two out of place, a repeated one, and a time that was read wrongly.
        assert_eq!(read(&[0.0, 1.0, 2.0, 1.5, 3.0, 4.0]), "fllal-l");
        assert_eq!(read(&[0.0, 1.0, 2.0, 1.5, 1.6, 3.0]), "fllaal-");
        assert_eq!(read(&[0.0, 1.0, 1.0, 1.0, 2.0]), "flaa-l-");
        assert_eq!(read(&[0.0, 1.0, 2.0, 3.0, 9e9, 4.0]), "flllal-");
        // It begins again, wraps, or jumps.
        assert_eq!(read(&[0.0, 1.0, 2.0, 0.0, 1.0, 1.5]), "fllaaa+");
        assert_eq!(read(&[0.0, 1.0, 2.0, 3.0, 7e9, 7e9 + 1.0, 7e9 + 2.0]), "flllaaa+");
        assert_eq!(read(&[f64::NAN, 0.0, f64::NAN, 1.0]), "tftl");
    }
}
