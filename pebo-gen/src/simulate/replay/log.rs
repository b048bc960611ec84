//! Recorded data as CSV, row by row.
//!
//! In: bytes. Out: the names of the columns, then the numbers of those columns that are wanted, one row at a time; a
//! cell that is empty or not finite is a fact, one that is no number is a [`Malformed`]. No more than a row is held.

use std::fmt;
use std::io::{BufRead as _, BufReader, Read};
use std::rc::Rc;

use csv::{ByteRecord, Reader, ReaderBuilder};

use super::meter::{Meter, Metered};
use crate::source::quoted;

/// What parts the columns: that of these which the header has most of.
const DELIMITERS: [u8; 3] = [b',', b';', b'\t'];

/// Bytes that are asked for at once.
const BUFFER: usize = 1 << 16;

/// A recording of which the header is read.
pub struct Log<'a> {
    name: String,
    columns: Vec<String>,
    reader: Reader<BufReader<Metered<Box<dyn Read + 'a>>>>,
    meter: Rc<Meter>,
    /// Lines before the first row.
    before: u64,
    record: ByteRecord,
}

/// A cell that holds no finite number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blank {
    /// There is nothing in it.
    Empty,
    /// It is NaN or infinite.
    NotFinite,
}

/// What comes next in a log.
pub(super) enum Next {
    /// A row, which begins in this line.
    Row(u64),
    /// A row that breaks off with the file.
    Cut(u64),
    /// Nothing more.
    End,
}

/// Why a log cannot be read, or not further.
#[derive(Debug)]
#[non_exhaustive]
pub enum Unreadable {
    /// The operating system refused.
    Refused(std::io::Error),
    /// There is no line that names the columns.
    Nameless,
    /// A row has something else than numbers, or not as many as there are columns.
    Malformed(Malformed),
}

/// A cell that should be another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Malformed {
    /// The line, from 1.
    pub line: u64,
    /// The column, from 1; none where it is about the whole row.
    pub column: Option<usize>,
    /// What is wrong.
    pub what: String,
    help: &'static str,
}

impl<'a> Log<'a> {
    /// Reads the header of a recording; `name` is what messages call it.
    pub fn open(name: impl Into<String>, bytes: impl Read + 'a) -> Result<Self, Unreadable> {
        let meter = Rc::<Meter>::default();
        let bytes: Box<dyn Read + 'a> = Box::new(bytes);
        let mut bytes = BufReader::with_capacity(BUFFER, Metered { inner: bytes, meter: Rc::clone(&meter) });
        let mut before = 0;
        let header = loop {
            let mut line = Vec::new();
            let limit = u64::try_from(Meter::LONGEST).unwrap_or(u64::MAX);
            let count = bytes.by_ref().take(limit).read_until(b'\n', &mut line).map_err(Unreadable::Refused)?;
            before += 1;
            meter.row();
            if count == 0 || count == Meter::LONGEST {
                return Err(Unreadable::Nameless);
            }
            let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line).trim_ascii();
            if !line.is_empty() && !line.starts_with(b"#") {
                break line.to_vec();
            }
        };
        let delimiter = delimiter(&header);
        let reader = |bytes| rows(delimiter).from_reader(bytes);
        let mut names = ByteRecord::new();
        rows(delimiter).from_reader(header.as_slice()).read_byte_record(&mut names).map_err(refused)?;
        let numbers = names.iter().filter(|name| number(name).is_some()).count();
        if numbers == names.len() {
            return Err(Unreadable::Nameless);
        }
        Ok(Self {
            name: name.into(),
            columns: names.iter().enumerate().map(|(place, name)| spelled(place, name)).collect(),
            reader: reader(bytes),
            meter,
            before,
            record: ByteRecord::new(),
        })
    }

    /// What messages call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The names of the columns, as formulas write them.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The bytes that have been read.
    pub fn bytes(&self) -> u64 {
        self.meter.bytes.get()
    }

    /// Reads a row: the numbers of the `wanted` columns, NaN where there is none; `blank` is told of each of these.
    pub(super) fn next(
        &mut self,
        wanted: &[usize],
        numbers: &mut [f64],
        mut blank: impl FnMut(usize, Blank, u64),
    ) -> Result<Next, Unreadable> {
        self.meter.row();
        let more = self.reader.read_byte_record(&mut self.record);
        // The reader counts the lines behind the header, and those of comments.
        let line = self.before + self.record.position().map_or(1, csv::Position::line);
        if self.meter.is_over() {
            let what = format!("the row has more than {} bytes", Meter::LONGEST);
            return Err(Unreadable::Malformed(Malformed { line, column: None, what, help: "close the quotes in it" }));
        }
        if !more.map_err(refused)? {
            return Ok(Next::End);
        }
        let Err(malformed) = self.row(line, wanted, numbers, &mut blank) else { return Ok(Next::Row(line)) };
        // A log that ends with the power supply ends within a row.
        let is_last = !self.reader.read_byte_record(&mut self.record).map_err(refused)?;
        let is_cut = is_last && !self.meter.ends_a_line();
        if is_cut { Ok(Next::Cut(line)) } else { Err(Unreadable::Malformed(malformed)) }
    }

    fn row(
        &self,
        line: u64,
        wanted: &[usize],
        numbers: &mut [f64],
        blank: &mut impl FnMut(usize, Blank, u64),
    ) -> Result<(), Malformed> {
        let (found, columns) = (self.record.len(), self.columns.len());
        // Some loggers write a comma behind the last cell too.
        let is_wide = self.record.iter().skip(columns).any(|cell| !cell.trim_ascii().is_empty());
        if found < columns || is_wide {
            let what = format!("the row has {found} cells and the header {columns}");
            let help = "complete the row or remove it; a value that is not known is an empty cell";
            return Err(Malformed { line, column: Some(found.min(columns) + 1), what, help });
        }
        for (value, &column) in numbers.iter_mut().zip(wanted) {
            let cell = &self.record[column];
            *value = match number(cell) {
                Some(value) if value.is_finite() => value,
                Some(_) => {
                    blank(column, Blank::NotFinite, line);
                    f64::NAN
                }
                None if cell.trim_ascii().is_empty() => {
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
        let what = format!("{} in the column `{}` is not a number", quoted(text.trim()), self.columns[column]);
        let decimal_comma = number(text.replace(',', ".").as_bytes()).is_some();
        let help = match decimal_comma {
            true => "write decimals with a point",
            false => "write a number as `-1.5e-3`, or leave the cell empty; lines that begin with # are comments",
        };
        Malformed { line, column: Some(column + 1), what, help }
    }
}

impl fmt::Debug for Log<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("name", &self.name).field("columns", &self.columns).finish_non_exhaustive()
    }
}

fn rows(delimiter: u8) -> ReaderBuilder {
    let mut builder = ReaderBuilder::new();
    builder.has_headers(false).flexible(true).comment(Some(b'#')).delimiter(delimiter).buffer_capacity(BUFFER);
    builder
}

fn refused(error: csv::Error) -> Unreadable {
    Unreadable::Refused(error.into())
}

fn delimiter(header: &[u8]) -> u8 {
    let count = |delimiter: u8| header.iter().filter(|byte| **byte == delimiter).count();
    // Of equals the first: `max_by_key` takes the last.
    DELIMITERS.into_iter().rev().max_by_key(|delimiter| count(*delimiter)).unwrap_or(b',')
}

fn number(cell: &[u8]) -> Option<f64> {
    std::str::from_utf8(cell.trim_ascii()).ok()?.parse().ok()
}

/// The name by which formulas call a column: what cannot be in a name is an underscore, of which there is none at the end.
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
    /// What to do about it.
    pub fn help(&self) -> &'static str {
        self.help
    }
}
