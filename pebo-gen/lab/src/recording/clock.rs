//! The clock of a recording: the time of each row.

use crate::timing::real;

/// The number of intervals whose median is the usual one; odd.
const USUAL: usize = 15;

/// A gap is longer than so many usual intervals: half-way between one, and the two that a missing row leaves.
const GAP: f64 = 1.5;

/// The time of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Instant {
    /// The first row with a time.
    First(f64),
    /// A later row, after so many seconds, which are a gap or not.
    Later { t: f64, dt: f64, gap: bool },
    /// The time is not later than that of the row before.
    Backwards,
    /// The row has no time.
    Timeless,
}

/// The present time of a log.
#[derive(Debug)]
pub(super) enum Clock {
    /// Rows with this period in seconds, a fraction, so that instants are rounded once.
    Steady { row: u64, fraction: (f64, f64) },
    /// Rows with recorded times.
    Recorded { last: Option<f64>, recent: [f64; USUAL], known: usize, next: usize },
}

impl Clock {
    /// The clock of rows with this period, or with recorded times.
    pub(super) fn new(period: Option<(f64, f64)>) -> Self {
        match period {
            Some(fraction) => Self::Steady { row: 0, fraction },
            None => Self::Recorded { last: None, recent: [0.0; USUAL], known: 0, next: 0 },
        }
    }

    /// The time of the next row, which may be recorded.
    pub(super) fn row(&mut self, measured_time: f64) -> Instant {
        match self {
            Self::Steady { row, fraction: (numerator, denominator) } => {
                let t = real(*row) * *numerator / *denominator;
                *row += 1;
                let dt = *numerator / *denominator;
                if *row == 1 { Instant::First(t) } else { Instant::Later { t, dt, gap: false } }
            }
            Self::Recorded { .. } if !measured_time.is_finite() => Instant::Timeless,
            Self::Recorded { last, recent, known, next } => {
                let Some(before) = last.filter(|before| measured_time > *before) else {
                    return if last.is_some() {
                        Instant::Backwards
                    } else {
                        *last = Some(measured_time);
                        Instant::First(measured_time)
                    };
                };
                let dt = measured_time - before;
                *last = Some(measured_time);
                // Two intervals do not determine the usual one.
                let gap = *known > 2 && dt > GAP * middle(&recent[..*known]);
                recent[*next] = dt;
                *next = (*next + 1) % USUAL;
                *known = (*known + 1).min(USUAL);
                Instant::Later { t: measured_time, dt, gap }
            }
        }
    }
}

fn middle(intervals: &[f64]) -> f64 {
    let mut sorted = [0.0; USUAL];
    let sorted = &mut sorted[..intervals.len()];
    sorted.copy_from_slice(intervals);
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
