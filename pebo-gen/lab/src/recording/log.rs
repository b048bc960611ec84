//! Recorded data as CSV, row by row.
//!
//! In: bytes. Out: the names of the columns, then the numbers of the wanted columns, one row at a time; an empty cell
//! or one that is not finite is a fact, other text is a [`Malformed`]. A number may have a decimal comma where commas
//! do not separate columns; a date or a time of day is the seconds since the first one of its column; a row of units below
//! the header is skipped. No more than a row is held.

use std::fmt;
use std::io::{BufRead as _, BufReader, Cursor, Read};

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use pebo_design::source::quoted;

use super::moment::moment;

/// The delimiters of columns: the most frequent one in the header is taken.
const DELIMITERS: [u8; 3] = [b',', b';', b'\t'];

/// Bytes of one read.
const BUFFER: usize = 1 << 16;

/// The most bytes of a row: a file of another kind may have no lines.
pub(super) const LONGEST: usize = 1 << 20;

/// The byte-order mark that some programs write before UTF-8 text.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// A recording whose header has been read.
pub struct Log<'a> {
    name: String,
    columns: Vec<String>,
    /// The units of the columns, where a row has them.
    units: Vec<String>,
    lines: Lines<'a>,
    row: Row,
    values: Values,
    /// True once a line below the header was read.
    has_begun: bool,
}

/// The meaning of cells.
struct Values {
    /// True if a comma may stand before decimals.
    has_decimal_comma: bool,
    /// The first instant of each column of dates or times.
    first: Vec<Option<i128>>,
}

impl Values {
    /// The number of a cell; none for other text.
    fn of(&mut self, column: usize, cell: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(cell).ok()?;
        if let Ok(number) = text.parse() {
            return Some(number);
        }
        if self.has_decimal_comma
            && !text.contains('.')
            && let Ok(number) = text.replacen(',', ".", 1).parse()
        {
            return Some(number);
        }
        let instant = moment(text)?;
        // A difference within centuries, in nanoseconds, is rounded once.
        Some(nanoseconds(instant - *self.first.get_mut(column)?.get_or_insert(instant)) / 1e9)
    }

    /// True if the text is neither a number nor a time.
    fn is_word(&self, text: &[u8]) -> bool {
        Self { first: vec![None], ..*self }.of(0, text).is_none()
    }
}

#[expect(clippy::cast_precision_loss, reason = "a difference of nanoseconds is rounded to a double")]
fn nanoseconds(count: i128) -> f64 {
    count as f64
}

/// Lines that are neither comments nor blank.
struct Lines<'a> {
    bytes: BufReader<Box<dyn Read + 'a>>,
    /// The line that was read, with its end.
    line: Vec<u8>,
    /// Its number, from 1.
    number: u64,
    /// The bytes that have been read.
    read: u64,
}

impl Lines<'_> {
    fn empty() -> Self {
        Self { bytes: BufReader::new(Box::new(std::io::empty())), line: Vec::new(), number: 1, read: 0 }
    }

    /// Reads a line; false at the end.
    fn advance(&mut self) -> Result<bool, Unreadable> {
        loop {
            self.line.clear();
            let most = u64::try_from(LONGEST).unwrap_or(u64::MAX).saturating_add(1);
            let count =
                self.bytes.by_ref().take(most).read_until(b'\n', &mut self.line).map_err(Unreadable::Refused)?;
            self.number += 1;
            self.read += u64::try_from(count).unwrap_or(u64::MAX);
            if count > LONGEST {
                let what = format!("the line has more than {LONGEST} bytes");
                let help = "give CSV text with a line for each sample";
                return Err(Unreadable::Malformed(Malformed { line: self.number, column: None, what, help }));
            }
            if count == 0 {
                return Ok(false);
            }
            if self.number == 1 && self.line.starts_with(MARK) {
                self.line.drain(..MARK.len());
            }
            let text = self.line.trim_ascii_start();
            if !text.is_empty() && !text.starts_with(b"#") {
                return Ok(true);
            }
        }
    }

    /// True if the line has its end; the last of a file may have none.
    fn is_whole(&self) -> bool {
        self.line.ends_with(b"\n")
    }
}

/// The cells of a line.
struct Row {
    reader: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
    count: usize,
}

impl Row {
    fn new(delimiter: u8) -> Self {
        let reader = ReaderBuilder::new().delimiter(delimiter).build();
        Self { reader, text: Vec::new(), ends: Vec::new(), count: 0 }
    }

    /// Splits a line into cells; true if all its quotes are closed.
    fn split(&mut self, line: &[u8]) -> bool {
        // No cell is longer than the line, nor are there more cells than letters.
        if self.text.len() <= line.len() {
            self.text.resize(line.len() + 1, 0);
            self.ends.resize(line.len() + 2, 0);
        }
        self.reader.reset();
        let (mut result, read, written, count) = self.reader.read_record(line, &mut self.text, &mut self.ends);
        self.count = count;
        if result == ReadRecordResult::InputEmpty && read == line.len() {
            // The end of the line, or of the file.
            let (text, ends) = (&mut self.text[written..], &mut self.ends[count..]);
            let (ended, _, _, more) = self.reader.read_record(b"\n", text, ends);
            result = ended;
            self.count += more;
        }
        result == ReadRecordResult::Record
    }

    fn cell(&self, place: usize) -> &[u8] {
        let start = place.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.text[start..self.ends[place]].trim_ascii()
    }

    fn cells(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.count).map(|place| self.cell(place))
    }
}

/// A cell that holds no finite number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blank {
    /// An empty cell.
    Empty,
    /// NaN or infinity.
    NotFinite,
}

/// The next item of a log.
pub(super) enum Next {
    /// A row, which begins in this line.
    Row(u64),
    /// A row that breaks off with the file.
    Cut(u64),
    /// The end.
    End,
}

/// The reason why a log cannot be read, or not further.
#[derive(Debug)]
pub enum Unreadable {
    /// The operating system refused.
    Refused(std::io::Error),
    /// There is no line that names the columns.
    Nameless,
    /// A row has cells that are no numbers, or a wrong number of cells.
    Malformed(Malformed),
}

/// A malformed row or cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Malformed {
    /// The line, from 1.
    pub line: u64,
    /// The column, from 1; none for the whole row.
    pub column: Option<usize>,
    /// The mistake.
    pub what: String,
    help: &'static str,
}

impl<'a> Log<'a> {
    /// Reads the header of a recording; `name` is its name in messages.
    pub fn open(name: impl Into<String>, bytes: impl Read + 'a) -> Result<Self, Unreadable> {
        let bytes: Box<dyn Read + 'a> = Box::new(bytes);
        let bytes = BufReader::with_capacity(BUFFER, bytes);
        let mut lines = Lines { bytes, line: Vec::new(), number: 0, read: 0 };
        if !lines.advance()? {
            return Err(Unreadable::Nameless);
        }
        let header = lines.line.trim_ascii();
        let delimiter = delimiter(header);
        let mut row = Row::new(delimiter);
        let is_closed = row.split(header);
        if !is_closed || row.cells().all(|name| number(name).is_some()) {
            return Err(Unreadable::Nameless);
        }
        let columns: Vec<String> = row.cells().enumerate().map(|(place, name)| spelled(place, name)).collect();
        let values = Values { has_decimal_comma: delimiter != b',', first: vec![None; columns.len()] };
        Ok(Self { name: name.into(), columns, units: Vec::new(), lines, row, values, has_begun: false })
    }

    /// Its name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The units of the columns, if a row below the header has them and was read.
    pub(super) fn units(&self) -> &[String] {
        &self.units
    }

    /// The names of the columns, as formulas write them.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The bytes that have been read.
    pub fn bytes(&self) -> u64 {
        self.lines.read
    }

    /// The first rows, as many as are there up to `most`, which are read again afterwards: the numbers of the `wanted`
    /// columns, NaN for cells without one. A row that cannot be read ends them, with the reason.
    pub(super) fn head(
        &mut self,
        wanted: &[usize],
        most: usize,
    ) -> std::io::Result<(Vec<Vec<f64>>, Option<Unreadable>)> {
        let mut text = Vec::new();
        for _ in 0..most {
            let limit = u64::try_from(LONGEST).unwrap_or(u64::MAX);
            if text.len() > LONGEST || self.lines.bytes.by_ref().take(limit).read_until(b'\n', &mut text)? == 0 {
                break;
            }
        }
        let nothing: Box<dyn Read + 'a> = Box::new(std::io::empty());
        let rest = std::mem::replace(&mut self.lines.bytes, BufReader::new(nothing));
        let mut lines = Lines { bytes: BufReader::new(Box::new(Cursor::new(text.clone()))), ..Lines::empty() };
        let again: Box<dyn Read + 'a> = Box::new(Cursor::new(text).chain(rest));
        self.lines.bytes = BufReader::with_capacity(BUFFER, again);
        std::mem::swap(&mut self.lines, &mut lines);
        let (first, has_begun) = (self.values.first.clone(), self.has_begun);
        let mut rows = Vec::new();
        let mut numbers = vec![f64::NAN; wanted.len()];
        let unreadable = loop {
            match self.next(wanted, &mut numbers, |_, _, _| {}) {
                Ok(Next::Row(_)) => rows.push(numbers.clone()),
                Ok(_) => break None,
                Err(unreadable) => break Some(unreadable),
            }
        };
        std::mem::swap(&mut self.lines, &mut lines);
        (self.values.first, self.has_begun) = (first, has_begun);
        Ok((rows, unreadable))
    }

    /// Reads a row: the numbers of the `wanted` columns, NaN for blank cells, each of which is passed to `blank`.
    pub(super) fn next(
        &mut self,
        wanted: &[usize],
        numbers: &mut [f64],
        blank: impl FnMut(usize, Blank, u64),
    ) -> Result<Next, Unreadable> {
        if !self.lines.advance()? {
            return Ok(Next::End);
        }
        if !self.has_begun {
            self.has_begun = true;
            if self.is_row_of_units() && !self.lines.advance()? {
                return Ok(Next::End);
            }
        }
        let line = self.lines.number;
        match self.take(line, wanted, numbers, blank) {
            Ok(()) => Ok(Next::Row(line)),
            // A log that ends with the power supply ends within a row.
            Err(_) if !self.lines.is_whole() => Ok(Next::Cut(line)),
            Err(malformed) => Err(Unreadable::Malformed(malformed)),
        }
    }

    /// True if the line has words and no value, but for the unit 1.
    fn is_row_of_units(&mut self) -> bool {
        let Self { row, values, lines, .. } = self;
        let is_closed = row.split(&lines.line);
        let mut others = row.cells().filter(|cell| !cell.is_empty() && *cell != b"1").peekable();
        let is_row = is_closed && others.peek().is_some() && others.all(|cell| values.is_word(cell));
        if is_row {
            self.units = row.cells().map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect();
        }
        is_row
    }

    fn take(
        &mut self,
        line: u64,
        wanted: &[usize],
        numbers: &mut [f64],
        mut blank: impl FnMut(usize, Blank, u64),
    ) -> Result<(), Malformed> {
        let columns = self.columns.len();
        if !self.row.split(&self.lines.line) {
            let what = "a quote is not closed".to_owned();
            return Err(Malformed { line, column: None, what, help: "close it, in the same line" });
        }
        let found = self.row.count;
        // Some loggers write a comma behind the last cell too.
        if found < columns || self.row.cells().skip(columns).any(|cell| !cell.is_empty()) {
            let what = format!("the row has {found} cells and the header {columns}");
            let help = "complete the row or remove it; a value that is not known is an empty cell";
            return Err(Malformed { line, column: Some(found.min(columns) + 1), what, help });
        }
        for (value, &column) in numbers.iter_mut().zip(wanted) {
            let cell = self.row.cell(column);
            *value = match self.values.of(column, cell) {
                Some(value) if value.is_finite() => value,
                Some(_) => {
                    blank(column, Blank::NotFinite, line);
                    f64::NAN
                }
                None if cell.is_empty() => {
                    blank(column, Blank::Empty, line);
                    f64::NAN
                }
                None => return Err(self.no_number(line, column, cell)),
            };
        }
        Ok(())
    }

    fn no_number(&self, line: u64, column: usize, cell: &[u8]) -> Malformed {
        let text = String::from_utf8_lossy(cell);
        let what = format!("{} in the column `{}` is not a number", quoted(&text), self.columns[column]);
        let help = if number(text.replace(',', ".").as_bytes()).is_some() {
            "write decimals with a point"
        } else {
            "write a number as `-1.5e-3`, a time as `2026-11-25T10:00:00.25`, or leave the cell empty; lines that begin \
             with # are comments"
        };
        Malformed { line, column: Some(column + 1), what, help }
    }
}

impl fmt::Debug for Log<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("name", &self.name).field("columns", &self.columns).finish_non_exhaustive()
    }
}

fn delimiter(header: &[u8]) -> u8 {
    let count = |delimiter: u8| header.split(|byte| *byte == delimiter).count();
    // Of equals the first: `max_by_key` takes the last.
    DELIMITERS.into_iter().rev().max_by_key(|delimiter| count(*delimiter)).unwrap_or(b',')
}

fn number(cell: &[u8]) -> Option<f64> {
    std::str::from_utf8(cell).ok()?.parse().ok()
}

/// The name of a column in formulas: other characters become underscores, which are removed at the end.
fn spelled(place: usize, name: &[u8]) -> String {
    let mut spelled = String::new();
    for letter in String::from_utf8_lossy(name).chars() {
        if letter.is_ascii_alphanumeric() || letter == '_' {
            spelled.push(letter);
        } else if !spelled.is_empty() && !spelled.ends_with('_') {
            spelled.push('_');
        }
    }
    if spelled.starts_with(|first: char| first.is_ascii_digit()) {
        spelled.insert(0, '_');
    }
    if spelled.ends_with('_') && !name.ends_with(b"_") {
        spelled.pop();
    }
    if spelled.is_empty() || spelled == "_" { format!("column_{}", place + 1) } else { spelled }
}

impl Malformed {
    /// The help for the user.
    pub fn help(&self) -> &'static str {
        self.help
    }
}
