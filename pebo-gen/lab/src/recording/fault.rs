//! Faults of rows, counted by kind: facts about the data that do not end a run.

use std::fmt;

use serde::Serialize;

use super::log::Blank;

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RowFault {
    /// A cell of this column is empty.
    Empty(usize),
    /// A cell of this column is NaN or infinite.
    NotFinite(usize),
    /// A row has no instant.
    Timeless,
    /// The time of a row does not go on from that of the row before, and those after it do.
    Misplaced,
    /// The clock begins again or jumps: a piece of its own begins.
    Piece,
    /// More time than a row and a half has passed.
    Gap,
    /// The last row breaks off with the file.
    Cut,
    /// This input has no value.
    Input(usize),
}

impl RowFault {
    /// The fault of a cell of this column.
    pub(super) fn of_cell(column: usize, blank: Blank) -> Self {
        match blank {
            Blank::Empty => Self::Empty(column),
            Blank::NotFinite => Self::NotFinite(column),
        }
    }
}

/// The number of faults of each kind, and the line of the first.
#[derive(Debug, Default)]
pub(super) struct RowFaults {
    counts: Vec<(RowFault, u64, u64)>,
}

impl RowFaults {
    /// Counts one.
    pub(super) fn count(&mut self, kind: RowFault, line: u64) {
        match self.counts.iter_mut().find(|(known, ..)| *known == kind) {
            Some((_, count, _)) => *count += 1,
            None => self.counts.push((kind, 1, line)),
        }
    }

    /// In words, in the order of their first lines; `columns` and `inputs` are the names that kinds number.
    pub(super) fn worded(&self, [columns, inputs]: [&[String]; 2]) -> Vec<FaultCount> {
        let word = |kind: RowFault| match kind {
            RowFault::Empty(column) => format!("empty cells of `{}`", columns[column]),
            RowFault::NotFinite(column) => format!("cells of `{}` that are NaN or infinite", columns[column]),
            RowFault::Timeless => "rows skipped that have no time".to_owned(),
            RowFault::Misplaced => "rows skipped whose time is not between those of their neighbours".to_owned(),
            RowFault::Piece => "new pieces, where the clock begins again or jumps and the observer with it".to_owned(),
            RowFault::Gap => "gaps, where the time steps by more than one and a half periods".to_owned(),
            RowFault::Cut => "last row dropped, as it breaks off with the file".to_owned(),
            RowFault::Input(input) => format!("rows without a value of `{}`: the value before was held", inputs[input]),
        };
        let mut counts = self.counts.clone();
        counts.sort_by_key(|(.., line)| *line);
        counts.into_iter().map(|(kind, count, line)| FaultCount { what: word(kind), count, line }).collect()
    }
}

impl fmt::Display for FaultCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, first in line {}", self.what, self.count, self.line)
    }
}

/// A kind of fault with its count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FaultCount {
    /// The fault in words.
    pub what: String,
    /// The number of such faults.
    pub count: u64,
    /// The line of the first.
    pub line: u64,
}
