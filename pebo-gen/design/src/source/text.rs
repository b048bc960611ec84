//! A named text.

use super::{Code, Diagnostic, Span};

/// The largest text that is read, in bytes. The largest model written by hand is some thousand
/// times smaller.
pub const SIZE_LIMIT: usize = 1 << 20;

/// The byte order mark.
const MARK: char = '\u{feff}';

/// A text with a name by which diagnostics call it: a path, or a word like `<stdin>`.
///
/// Holds: at most [`SIZE_LIMIT`] bytes; no byte order mark, which would take a column that no
/// screen shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    name: String,
    /// The text of the file, and behind it the settings of the call, so that spans reach both.
    text: String,
    /// The end of the file's text.
    end: usize,
    /// The settings, without their marks.
    settings: Vec<Span>,
}

/// The text before a setting, as in a call.
const SETTING: &str = "--set ";

/// A position as people count it: the first line is 1, and so is the first column, in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Source {
    /// A text under a name, unless it is too large.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Result<Self, Diagnostic> {
        let (name, mut text) = (name.into(), text.into());
        admit(text.len())?;
        if text.starts_with(MARK) {
            text.drain(..MARK.len_utf8());
        }
        Ok(Self { name, end: text.len(), text, settings: Vec::new() })
    }

    /// The same with settings of a call, each `NAME=VALUE`: the text is read as if it said so. A name is that of a
    /// parameter, or a key of the file with the keys above it, as `simulation.noise.v2`. The last of two settings of
    /// one key counts.
    ///
    /// ```
    /// use pebo_design::source::Source;
    ///
    /// let text = "model: m\nparameters: {a: 1}\nx: [p]\ny: [q]\nf_x: {p: -a*p}\nf_y: {q: p}\nphi: [p]\n"; let source =
    /// Source::new("m.yaml", text).and_then(|source| source.set(["a=2", "title=faster"])).expect("it is small"); let
    /// model = pebo_design::model::Model::parse(&source).expect("both are right");
    /// assert_eq!(model.parameters[0].value.as_ref().map(|number| number.value.text()), Some("2"));
    /// assert_eq!(source.text(), text);
    /// ```
    pub fn set<S: AsRef<str>>(mut self, settings: impl IntoIterator<Item = S>) -> Result<Self, Diagnostic> {
        for setting in settings {
            self.text.extend(["\n", SETTING]);
            let start = self.text.len();
            self.text.push_str(setting.as_ref());
            self.settings.push(Span::new(start, self.text.len()));
        }
        admit(self.text.len())?;
        Ok(self)
    }

    /// The text that `bytes` encode, unless it is too large or not UTF-8.
    ///
    /// A diagnostic from here has no text to underline: print it over [`Source::unread`].
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Result<Self, Diagnostic> {
        admit(bytes.len())?;
        match String::from_utf8(bytes) {
            Ok(text) => Self::new(name, text),
            Err(error) => {
                let valid = error.utf8_error().valid_up_to();
                let byte = error.as_bytes()[valid];
                Err(Diagnostic::error(
                    Code::NotText,
                    Span::default(),
                    format!("the file is not UTF-8 text: byte {valid} is 0x{byte:02x}"),
                )
                .help("give a model file, which is YAML text encoded in UTF-8"))
            }
        }
    }

    /// A name without a text: the header of a diagnostic when the file could not be read.
    pub fn unread(name: impl Into<String>) -> Self {
        Self { name: name.into(), text: String::new(), end: 0, settings: Vec::new() }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text, without settings of the call.
    pub fn text(&self) -> &str {
        &self.text[..self.end]
    }

    /// The spans of the settings of the call.
    #[cfg(feature = "yaml")]
    pub(crate) fn settings(&self) -> &[Span] {
        &self.settings
    }

    /// The settings of the call, a line each, and their offset; nothing if `span` is in the file.
    #[cfg(feature = "yaml")]
    pub(super) fn call(&self, span: Span) -> Option<(&str, usize)> {
        let start = self.end + 1;
        (span.start >= start && start < self.text.len()).then(|| (&self.text[start..], start))
    }

    /// The text under `span`, shrunk to whole characters of the text where it does not fit.
    pub fn slice(&self, span: Span) -> &str {
        &self.text[self.fit(span).range()]
    }

    /// `span`, shrunk until it lies on whole characters of the text.
    pub(super) fn fit(&self, span: Span) -> Span {
        let end = self.floor(span.end);
        Span { start: self.floor(span.start).min(end), end }
    }

    /// The start of the character that holds the byte `offset`.
    fn floor(&self, offset: usize) -> usize {
        (0..=offset.min(self.text.len())).rev().find(|&at| self.text.is_char_boundary(at)).unwrap_or(0)
    }

    /// The line and column of a byte; settings of a call are the lines behind the file's. A position past the end is
    /// the end.
    pub fn position(&self, offset: usize) -> Position {
        let before = &self.text[..self.floor(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Position {
            line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

fn admit(size: usize) -> Result<(), Diagnostic> {
    if size <= SIZE_LIMIT {
        return Ok(());
    }
    Err(Diagnostic::error(Code::FileTooLarge, Span::default(), format!("the file has more than {SIZE_LIMIT} bytes"))
        .help("give a model file; a model needs a few kilobytes"))
}
