//! Maps the bytes of a formula to spans of the file.

use crate::source::{Source, Span};

/// Maps ranges of a text to spans of the file that it was taken from.
///
/// YAML folds lines, strips indentation and replaces escapes: a scalar's text is not always a slice of the file.
/// Unchanged runs of it map exactly; if anything but white space was changed, every range maps to the whole scalar.
#[derive(Clone, Debug)]
pub struct SpanMap {
    whole: Span,
    /// Starts of runs, ascending: offset in the text, offset in the file.
    runs: Vec<(usize, usize)>,
}

impl SpanMap {
    /// For `text`, the value of the scalar at `whole` in `source`.
    pub fn align(text: &str, whole: Span, source: &Source) -> Self {
        let raw = source.slice(whole);
        let quote = usize::from(raw.starts_with(['"', '\'']));
        let mut runs = Vec::new();
        let mut at = quote;
        let mut offset = 0;
        for piece in text.split_inclusive(char::is_whitespace) {
            let word = piece.trim_end();
            if !word.is_empty() {
                at += raw[at..].len() - raw[at..].trim_start().len();
                if !raw[at..].starts_with(word) {
                    return Self { whole, runs: Vec::new() };
                }
                runs.push((offset, whole.start + at));
                at += word.len();
            }
            offset += piece.len();
        }
        Self { whole, runs }
    }

    /// For a text that is a slice of the file, from byte `start` on.
    pub fn verbatim(text: &str, start: usize) -> Self {
        Self { whole: Span::new(start, start + text.len()), runs: vec![(0, start)] }
    }

    /// The span of the bytes `start..end` of the text.
    pub fn span(&self, start: usize, end: usize) -> Span {
        match (self.place(start), self.place(end.saturating_sub(1).max(start))) {
            (Some(first), Some(_)) if start == end => Span::point(first),
            (Some(first), Some(last)) => Span::new(first, last + 1),
            _ => self.whole,
        }
    }

    /// The span of the whole text.
    pub fn whole(&self) -> Span {
        self.whole
    }

    fn place(&self, offset: usize) -> Option<usize> {
        let run = self.runs.partition_point(|(start, _)| *start <= offset).checked_sub(1)?;
        let (start, place) = self.runs[run];
        Some(place + (offset - start))
    }
}
