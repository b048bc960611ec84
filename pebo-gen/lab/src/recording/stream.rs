//! The rows of a log one by one, in the order of their times.
//!
//! In: a log, of which no more than a few rows are in memory. Out: rows with their times and signals, piece by piece: where
//! the clock begins again or jumps, a piece ends. The first rows of the next one are held until it is known that they are
//! not out of place. Faults are counted.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use super::clock::{Clock, Held, Instant};
use super::failure::Failure;
use super::fault::{RowFault, RowFaults};
use super::log::{Blank, Log, Next};
use super::scene::Replay;
use crate::experiment::formulas::Formulas;

/// Rows from one report of progress to the next.
const LOOKS: u64 = 1024;

/// A row that was read.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) line: u64,
    /// Its time, NaN where none is recorded.
    time: f64,
    /// Measured states, outputs, and inputs without the time.
    pub(super) signals: Vec<f64>,
}

/// What comes next.
#[derive(Debug)]
pub(super) enum Coming {
    /// A row at its instant, after so many seconds since the one before in its piece.
    Row(Row, f64, Option<f64>),
    /// A new piece.
    Piece,
    End,
}

/// The rows that are to come.
pub(super) struct RowStream<'a, 's> {
    replay: &'a Replay,
    log: &'a mut Log<'s>,
    /// Gets the numbers of rows and bytes now and then, and may end the run.
    watch: &'a mut dyn FnMut(u64, u64) -> ControlFlow<()>,
    clock: Clock,
    signals: Formulas,
    cells: Vec<f64>,
    /// Rows that are astray.
    held: Vec<Row>,
    /// Those of them that begin the present piece.
    first: VecDeque<Row>,
    pub(super) faults: RowFaults,
    pub(super) rows: u64,
    /// The last line that was read.
    line: u64,
}

impl<'a, 's> RowStream<'a, 's> {
    pub(super) fn new(
        replay: &'a Replay,
        log: &'a mut Log<'s>,
        watch: &'a mut dyn FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Self {
        let signals = &replay.signals;
        Self {
            replay,
            log,
            watch,
            clock: Clock::new(signals.period),
            signals: Formulas::new(&signals.program),
            cells: vec![0.0; signals.wanted.len()],
            held: Vec::new(),
            first: VecDeque::new(),
            faults: RowFaults::default(),
            rows: 0,
            line: 0,
        }
    }

    /// Goes on to the next row that has its place in time.
    pub(super) fn next(&mut self) -> Result<Coming, Failure> {
        loop {
            let Some(row) = self.first.pop_front().map_or_else(|| self.read(), |row| Ok(Some(row)))? else {
                // Too few to be a piece.
                self.misplaced();
                return Ok(Coming::End);
            };
            let (instant, held) = self.clock.row(row.time);
            if held == Held::Misplaced {
                self.misplaced();
            }
            match instant {
                Instant::First(t) => return Ok(Coming::Row(row, t, None)),
                Instant::Later { t, dt, gap } => {
                    if gap {
                        self.faults.count(RowFault::Gap, row.line);
                    }
                    return Ok(Coming::Row(row, t, Some(dt)));
                }
                Instant::Astray => self.held.push(row),
                Instant::Timeless => self.faults.count(RowFault::Timeless, row.line),
            }
            if held == Held::Piece {
                self.first.extend(self.held.drain(..));
                self.clock = Clock::new(self.replay.signals.period);
                self.first.iter().take(1).for_each(|row| self.faults.count(RowFault::Piece, row.line));
                return Ok(Coming::Piece);
            }
        }
    }

    /// Counts the rows that are held as out of place.
    fn misplaced(&mut self) {
        self.held.drain(..).for_each(|row| self.faults.count(RowFault::Misplaced, row.line));
    }

    /// Reads a row.
    fn read(&mut self) -> Result<Option<Row>, Failure> {
        if self.rows > 0 && self.rows.is_multiple_of(LOOKS) && (self.watch)(self.rows, self.log.bytes()).is_break() {
            return Err(Failure::Stopped { line: self.line });
        }
        let Self { replay, faults, cells, .. } = self;
        let wanted = &replay.signals.wanted;
        // A missing output is no fault for an observer that leaves its row out.
        let is_part = |column: usize, blank| {
            let admits = replay.experiment.design.partial.is_some();
            matches!(blank, Blank::Empty) && admits && replay.signals.of_outputs[column]
        };
        let place = |column: usize| wanted.iter().position(|known| *known == column).unwrap_or_default();
        let mut count = |column, blank, line| {
            if !is_part(place(column), blank) {
                faults.count(RowFault::of_cell(place(column), blank), line);
            }
        };
        self.line = match self.log.next(wanted, cells, &mut count).map_err(Failure::Unreadable)? {
            Next::Row(line) => line,
            Next::Cut(line) => {
                faults.count(RowFault::Cut, line);
                return Ok(None);
            }
            Next::End => return Ok(None),
        };
        self.rows += 1;
        let values = self.signals.of(cells);
        let (time, signals) = match replay.signals.period {
            Some(_) => (f64::NAN, values),
            None => (values[0], &values[1..]),
        };
        Ok(Some(Row { line: self.line, time, signals: signals.to_vec() }))
    }
}
