//! Diagnostics, as data.

use super::{Code, Span};

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Severity {
    /// Nothing can be made from this input.
    Error,
    /// The input is used, though probably not as its author meant.
    Warning,
    /// A fact worth knowing.
    Note,
}

/// A span and the text beside it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
pub struct Label {
    /// The span; serialises to the range of bytes, or null where there is none.
    #[cfg_attr(feature = "yaml", serde(serialize_with = "byte_range"))]
    pub span: Span,
    /// The text beside it; may be empty.
    pub text: Box<str>,
}

#[cfg(feature = "yaml")]
fn byte_range<S: serde::Serializer>(span: &Span, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Some(*span).filter(|span| *span != Span::NOWHERE), serializer)
}

/// One mistake, or one finding.
///
/// Texts are lower case without a full stop. The message states the mistake, `help` the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
pub struct Diagnostic {
    /// Its row in the table of codes.
    pub code: Code,
    /// The severity.
    pub severity: Severity,
    /// The mistake or finding.
    pub message: Box<str>,
    /// The main span.
    pub primary: Label,
    /// Other relevant spans, as the first of two declarations.
    pub secondary: Vec<Label>,
    /// Facts that explain it.
    pub notes: Vec<String>,
    /// The remedy.
    pub help: Option<Box<str>>,
    /// True if the primary span is a name that is nearly right, and the help says which is: a change that takes no
    /// thought.
    pub misspelt: bool,
}

/// The text before the nearest name.
const DID_YOU_MEAN: &str = "did you mean `";

impl Diagnostic {
    /// An error at `span`.
    pub fn error(code: Code, span: Span, message: impl Into<Box<str>>) -> Self {
        Self::new(Severity::Error, code, span, message)
    }

    /// A warning at `span`.
    pub fn warning(code: Code, span: Span, message: impl Into<Box<str>>) -> Self {
        Self::new(Severity::Warning, code, span, message)
    }

    /// Reports that the budget of the command ended in this phase of it.
    pub fn limit_reached(phase: &str, span: Span) -> Self {
        Self::error(Code::LimitReached, span, format!("the limit on time or memory was reached in {phase}"))
            .note("what was not decided by then is undecided: nothing is known to be wrong")
            .help("allow more with `--limit SECONDS` (`Builder::limit` in a build script), or write shorter formulas with fewer functions")
    }

    fn new(severity: Severity, code: Code, span: Span, message: impl Into<Box<str>>) -> Self {
        let primary = Label { span, text: Box::default() };
        let message = message.into();
        Self { code, severity, message, primary, secondary: Vec::new(), notes: Vec::new(), help: None, misspelt: false }
    }

    /// With `text` beside the primary span.
    #[must_use]
    pub fn label(mut self, text: impl Into<Box<str>>) -> Self {
        self.primary.text = text.into();
        self
    }

    /// With another relevant span.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<Box<str>>) -> Self {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// With a fact that explains it.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// With a remedy.
    #[must_use]
    pub fn help(mut self, text: impl Into<Box<str>>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// The replacement for the primary span, where that is the whole remedy.
    pub fn replacement(&self) -> Option<&str> {
        let help = self.help.as_deref().filter(|_| self.misspelt)?;
        help.strip_prefix(DID_YOU_MEAN)?.strip_suffix("`?")
    }

    /// With "did you mean" for help, where there is a nearest name for the text at the primary span.
    #[must_use]
    pub fn suggest(self, name: Option<&str>) -> Self {
        match name {
            Some(name) => {
                Self { misspelt: self.primary.span != Span::NOWHERE, ..self.help(format!("{DID_YOU_MEAN}{name}`?")) }
            }
            None => self,
        }
    }
}

/// More diagnostics than this help nobody.
const LIMIT: usize = 40;

/// The diagnostics of a pass, which goes on after a mistake to find the next one.
#[derive(Debug, Default)]
pub struct Diagnostics {
    found: Vec<Diagnostic>,
    unlisted: usize,
}

impl Diagnostics {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.push_with(|| diagnostic);
    }

    /// Adds one that is only worded if it will be printed: a search for a nearest name takes time, and hostile input
    /// may have ten thousand names that are wrong.
    pub fn push_with(&mut self, word: impl FnOnce() -> Diagnostic) {
        if self.found.len() < LIMIT {
            self.found.push(word());
        } else {
            self.unlisted += 1;
        }
    }

    /// The value, or nothing and its diagnostic added: for use where a mistake must not stop the
    /// pass.
    pub fn keep<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.push(diagnostic)).ok()
    }

    /// Tests whether there is an error among them.
    pub fn has_errors(&self) -> bool {
        self.found.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Ends a pass: all diagnostics, in the order of the text, if there is an error among them.
    /// Without an error, warnings stay collected for [`Diagnostics::into_vec`].
    pub fn propagate(&mut self) -> Result<(), Vec<Diagnostic>> {
        if self.has_errors() { Err(std::mem::take(self).into_vec()) } else { Ok(()) }
    }

    /// All of them, in the order of the text; a note tells how many were left out beyond the first
    /// forty.
    pub fn into_vec(mut self) -> Vec<Diagnostic> {
        self.found.sort_by_key(|diagnostic| diagnostic.primary.span);
        if self.unlisted > 0
            && let Some(last) = self.found.last_mut()
        {
            last.notes.push(format!("{} more are not shown", self.unlisted));
        }
        self.found
    }
}
