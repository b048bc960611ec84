//! A reader that counts: how far it is, how its text ends, and that no row is without end.

use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// What has been read.
#[derive(Debug, Default)]
pub(super) struct Meter {
    /// Bytes from the start.
    pub(super) bytes: Cell<u64>,
    /// The last of them.
    last: Cell<u8>,
    /// Bytes since the last row.
    since: Cell<usize>,
}

impl Meter {
    /// The most bytes of a row, and of the buffer in which it is: an open quote would make one row of all that follows.
    pub(super) const LONGEST: usize = 1 << 20;

    /// A row is over.
    pub(super) fn row(&self) {
        self.since.set(0);
    }

    /// Whether a row is longer than it may be.
    pub(super) fn is_over(&self) -> bool {
        self.since.get() > Self::LONGEST
    }

    /// Whether the last line has its end.
    pub(super) fn ends_a_line(&self) -> bool {
        matches!(self.last.get(), b'\n' | b'\r')
    }
}

/// A reader with its meter.
#[derive(Debug)]
pub(super) struct Metered<R> {
    pub(super) inner: R,
    pub(super) meter: Rc<Meter>,
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.meter.is_over() {
            return Err(io::Error::other("a row without end"));
        }
        let count = self.inner.read(buffer)?;
        if let Some(&last) = buffer[..count].last() {
            let Meter { bytes, last: before, since } = &*self.meter;
            bytes.set(bytes.get() + u64::try_from(count).unwrap_or(u64::MAX));
            before.set(last);
            since.set(since.get() + count);
        }
        Ok(count)
    }
}
