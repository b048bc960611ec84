//! Runs the observer over the rows of a log, piece by piece.
//!
//! In: rows, of which no more than a few are in memory. Out: estimates row by row, and in the end the errors of the
//! longest piece, the faults of rows, and the figure of all pieces one after the other. The record of the run does not
//! grow with it. Where the clock begins again or jumps, the observer begins anew; the first rows of such a piece are held
//! until it is known that they are not out of place.

use std::io::Write;
use std::ops::ControlFlow;

use crate::closed_loop::trace::write_number;
use crate::figure::Sheet;
use crate::figure::label::Label;
use pebo_design::program::Interpreter;

use super::clock::Held;
use super::failure::Failure;
use super::fault::{RowFault, RowFaults};
use super::log::{Blank, Log, Next};
use super::panels::Curves;
use super::piece::{Piece, PieceResult, Placed};
use super::replayed::Replayed;
use super::scene::Replay;

/// Rows from one report of progress to the next.
const LOOKS: u64 = 1024;

impl Replay {
    /// Runs the observer over all rows; estimates go to `estimates` as CSV, row by row. `watch` gets the numbers of
    /// rows and bytes now and then, and may end the run there.
    pub fn run(
        &self,
        log: &mut Log,
        estimates: Option<&mut dyn Write>,
        watch: &mut dyn FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Replayed, Failure> {
        let mut machine = ReplayState::start(self, estimates, false)?;
        machine.header()?;
        machine.rows(log, watch)?;
        machine.finish()
    }

    /// The logarithm of the likelihood of all samples, but for a constant, and the number of innovations behind it; none
    /// where the observer does not say.
    pub(super) fn likelihood(&self, log: &mut Log) -> Option<(f64, f64)> {
        let mut machine = ReplayState::start(self, None, true).ok()?;
        machine.rows(log, &mut |_, _| ControlFlow::Continue(())).ok()?;
        let ((before, judged), (last, more)) = (machine.likelihood, machine.piece.likelihood()?);
        Some((before + last, judged + more))
    }
}

/// A replay at one row.
struct ReplayState<'a, 'w> {
    replay: &'a Replay,
    signals: Interpreter,
    /// The cells of the row, and the values of their signals.
    cells: Vec<f64>,
    values: Vec<f64>,
    piece: Piece<'a>,
    judges_each: bool,
    /// The logarithm of the likelihood of the pieces before, and the number of innovations behind it.
    likelihood: (f64, f64),
    /// Lines and cells of the rows that are astray.
    held: Vec<(u64, Vec<f64>)>,
    /// The result of the longest piece before the present one.
    longest: Option<PieceResult>,
    /// The place of the present piece in the figure, in seconds.
    offset: f64,
    faults: RowFaults,
    curves: Curves<'a>,
    rows: u64,
    estimates: Option<&'w mut dyn Write>,
    text: String,
}

impl<'a, 'w> ReplayState<'a, 'w> {
    fn start(replay: &'a Replay, estimates: Option<&'w mut dyn Write>, judges_each: bool) -> Result<Self, Failure> {
        let signals = &replay.signals;
        Ok(Self {
            replay,
            signals: Interpreter::new(&signals.program),
            cells: vec![0.0; signals.wanted.len()],
            values: vec![0.0; signals.program.outputs.len()],
            piece: Piece::start(replay, judges_each)?,
            judges_each,
            likelihood: (0.0, 0.0),
            held: Vec::new(),
            longest: None,
            offset: 0.0,
            faults: RowFaults::default(),
            curves: replay.panels.start(),
            rows: 0,
            estimates,
            text: String::new(),
        })
    }

    /// Takes all rows.
    fn rows(&mut self, log: &mut Log, watch: &mut dyn FnMut(u64, u64) -> ControlFlow<()>) -> Result<(), Failure> {
        loop {
            let line = match self.read(log)? {
                Next::Row(line) => line,
                Next::Cut(line) => {
                    self.faults.count(RowFault::Cut, line);
                    return Ok(());
                }
                Next::End => return Ok(()),
            };
            self.rows += 1;
            self.row(line)?;
            if self.rows.is_multiple_of(LOOKS) && watch(self.rows, log.bytes()).is_break() {
                return Err(Failure::Stopped { line });
            }
        }
    }

    fn read(&mut self, log: &mut Log) -> Result<Next, Failure> {
        let Self { faults, replay, cells, piece, .. } = self;
        let wanted = &replay.signals.wanted;
        // A missing output is no fault for an observer that leaves its row out.
        let is_part = |column: usize, blank| {
            matches!(blank, Blank::Empty) && piece.admits_partial() && replay.signals.of_outputs[column]
        };
        let place = |column: usize| wanted.iter().position(|known| *known == column).unwrap_or_default();
        let mut count = |column, blank, line| {
            if !is_part(place(column), blank) {
                faults.count(RowFault::of_cell(place(column), blank), line);
            }
        };
        log.next(wanted, cells, &mut count).map_err(Failure::Unreadable)
    }

    /// Takes the row whose cells were read.
    fn row(&mut self, line: u64) -> Result<(), Failure> {
        self.signals.run(&self.cells, &mut self.values);
        let (measured_time, signals) = match self.replay.signals.period {
            Some(_) => (f64::NAN, self.values.as_slice()),
            None => (self.values[0], &self.values[1..]),
        };
        let is_listed = self.estimates.is_some();
        let (placed, held) = self.piece.row((line, measured_time), signals, is_listed, &mut self.faults);
        if held == Held::Misplaced {
            self.misplaced();
        }
        match placed {
            Placed::Timeless => {}
            Placed::Astray => self.held.push((line, self.cells.clone())),
            Placed::At(t) => {
                let Piece { table, .. } = &self.piece;
                let place = self.offset + self.piece.since_start(t);
                self.curves.add(place, table, self.piece.errors(), self.piece.residuals());
                self.write(t)?;
            }
        }
        if held == Held::Piece { self.begin_anew() } else { Ok(()) }
    }

    /// Counts the rows that are held as out of place.
    fn misplaced(&mut self) {
        for (line, _) in self.held.drain(..) {
            self.faults.count(RowFault::Misplaced, line);
        }
    }

    /// Begins a piece with the rows that are held.
    fn begin_anew(&mut self) -> Result<(), Failure> {
        let (duration, period) = self.piece.duration();
        self.offset += duration + period;
        self.curves.interrupt(self.offset);
        let result = self.piece.finish();
        self.keep(result);
        let (before, judged) = self.piece.likelihood().unwrap_or_default();
        self.likelihood = (self.likelihood.0 + before, self.likelihood.1 + judged);
        self.piece = Piece::start(self.replay, self.judges_each)?;
        let held = std::mem::take(&mut self.held);
        if let Some((line, _)) = held.first() {
            self.faults.count(RowFault::Piece, *line);
        }
        held.into_iter().try_for_each(|(line, cells)| {
            self.cells = cells;
            self.row(line)
        })
    }

    /// Keeps the result of a piece if it is the longest; of equals the first.
    fn keep(&mut self, result: Option<PieceResult>) {
        let rows = |result: &Option<PieceResult>| result.as_ref().map_or(0, |result| result.rows);
        if rows(&result) > rows(&self.longest) {
            self.longest = result;
        }
    }

    fn header(&mut self) -> Result<(), Failure> {
        let Some(file) = &mut self.estimates else { return Ok(()) };
        writeln!(file, "{}", self.replay.columns.join(",")).map_err(Failure::Unwritten)
    }

    /// Writes the row, with empty cells for unknown values.
    fn write(&mut self, t: f64) -> Result<(), Failure> {
        let Some(file) = &mut self.estimates else { return Ok(()) };
        let text = &mut self.text;
        text.clear();
        let mut cell = |value: f64| {
            if !text.is_empty() {
                text.push(',');
            }
            if value.is_finite() {
                let written = write_number(text, value);
                debug_assert!(written.is_ok(), "a string takes everything");
            }
        };
        cell(t);
        let (layout, table) = (&self.replay.layout, &self.piece.table);
        let mut errors = self.replay.measured.iter().zip(self.piece.errors()).peekable();
        for (recovered, hat) in table[layout.hat.clone()].iter().enumerate() {
            cell(*hat);
            if let Some((_, error)) = errors.next_if(|(state, _)| **state == recovered) {
                cell(*error);
            }
        }
        table[layout.baselines.clone()].iter().for_each(|hat| cell(*hat));
        table[layout.standard_errors.clone()].iter().for_each(|error| cell(*error));
        text.push('\n');
        file.write_all(text.as_bytes()).map_err(Failure::Unwritten)
    }

    fn finish(mut self) -> Result<Replayed, Failure> {
        // Too few to be a piece.
        self.misplaced();
        let Replay { names, panels, title, .. } = self.replay;
        let (faults, rows) = (self.faults.worded([&names.columns, &names.u]), self.rows);
        let refused = self.piece.refusals();
        let result = self.piece.finish();
        self.keep(result);
        let Some(PieceResult { rows: scored, start, summary, residuals }) = self.longest else {
            return Err(Failure::Silent { rows, faults, refused });
        };
        let from_zero = self.offset == 0.0 && start == 0.0;
        let sheet = Sheet {
            title: (title, Label::text(title).remark("replay")),
            time: (
                [0.0, self.offset + self.piece.duration().0],
                if from_zero { Label::name("t") } else { Label::text("t since the first row") },
            ),
            panels: panels.panels(),
            curves: &self.curves.finish(),
        };
        let figure = sheet.draw();
        let inputs_at_once = self.replay.design.with_instant;
        Ok(Replayed {
            rows,
            scored,
            start,
            inputs_at_once,
            summary,
            residuals,
            left_out: names.left_out.clone(),
            faults,
            figure,
        })
    }
}
