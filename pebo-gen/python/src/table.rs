//! The tables that the library writes as CSV, as numbers.
//!
//! In: CSV of the library, at once or in parts. Out: the columns' names, and the numbers row by row, NaN for a cell
//! without one. Holds: they are the numbers that were written, which are as long as it takes to read the same ones
//! back.

use std::io::{self, Write};

/// A table that grows by what is written to it.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) columns: Vec<String>,
    /// The bytes of each number, in this machine's order.
    pub(super) numbers: Vec<u8>,
    /// The line that has no end yet.
    line: String,
}

impl Table {
    /// The table of a text.
    pub(super) fn of(csv: &str) -> Self {
        let mut table = Self::default();
        table.take(csv);
        table
    }

    fn take(&mut self, text: &str) {
        let mut lines = text.split('\n');
        self.line.push_str(lines.next().unwrap_or_default());
        for next in lines {
            let line = std::mem::replace(&mut self.line, next.to_owned());
            if self.columns.is_empty() {
                self.columns = line.split(',').map(str::to_owned).collect();
            } else {
                let numbers = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN));
                self.numbers.extend(numbers.flat_map(f64::to_ne_bytes));
            }
        }
    }
}

impl Write for Table {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // The library writes whole characters.
        let text = std::str::from_utf8(bytes).map_err(io::Error::other)?;
        self.take(text);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
