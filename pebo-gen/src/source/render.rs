//! Diagnostics for people and for programs.

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Renderer, Snippet};

use super::{Diagnostic, Label, Severity, Source, Span};

/// Whether to mark the parts of a rendering with terminal colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Plain text.
    Never,
    /// With ANSI escape sequences.
    Always,
}

/// The diagnostics as text, each with its excerpt of the source, separated by blank lines; ends
/// with a newline.
pub fn render(diagnostics: &[Diagnostic], source: &Source, colour: Colour) -> String {
    render_within(diagnostics, source, colour, None)
}

/// The same, with excerpts cut to so many columns.
pub fn render_within(diagnostics: &[Diagnostic], source: &Source, colour: Colour, width: Option<usize>) -> String {
    let renderer = match colour {
        Colour::Never => Renderer::plain(),
        Colour::Always => Renderer::styled(),
    };
    let renderer = match width {
        Some(width) => renderer.term_width(width),
        None => renderer,
    };
    let pictures: Vec<String> =
        diagnostics.iter().map(|diagnostic| renderer.render(&[picture(diagnostic, source)]) + "\n").collect();
    pictures.join("\n")
}

fn picture<'a>(diagnostic: &'a Diagnostic, source: &'a Source) -> Group<'a> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let title = level.primary_title(diagnostic.message.as_ref()).id(diagnostic.code.name());
    let snippet = (diagnostic.primary.span != Span::NOWHERE).then(|| {
        Snippet::source(source.text())
            .path(source.name())
            .annotation(annotation(AnnotationKind::Primary, &diagnostic.primary, source))
            .annotations(diagnostic.secondary.iter().map(|label| annotation(AnnotationKind::Context, label, source)))
    });
    title
        .elements(snippet)
        .elements(diagnostic.notes.iter().map(|note| Level::NOTE.message(note.as_str())))
        .elements(diagnostic.help.iter().map(|help| Level::HELP.message(help.as_ref())))
}

fn annotation<'a>(kind: AnnotationKind, label: &'a Label, source: &Source) -> Annotation<'a> {
    let text = Some(label.text.as_ref()).filter(|text| !text.is_empty());
    kind.span(first_line(label.span, source).range()).label(text)
}

/// A span over many lines hides what it means to show: its first line says where to look.
fn first_line(span: Span, source: &Source) -> Span {
    let span = source.fit(span);
    let line = source.slice(span).lines().next().unwrap_or_default();
    Span::new(span.start, span.start + line.trim_end().len())
}

/// A diagnostic as a program reads it: serialises to the object of the JSON report.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct Located {
    /// The code's name.
    pub code: &'static str,
    /// `error`, `warning` or `note`.
    pub severity: Severity,
    /// What is wrong.
    pub message: Box<str>,
    /// Line of the primary place, from 1; 1 where there is none.
    pub line: usize,
    /// Column in characters, from 1; 1 where there is no place.
    pub column: usize,
    /// What to do, or null.
    pub help: Option<Box<str>>,
}

impl Located {
    /// The diagnostic with its place counted in `source`.
    pub fn new(diagnostic: &Diagnostic, source: &Source) -> Self {
        let start = if diagnostic.primary.span == Span::NOWHERE { 0 } else { diagnostic.primary.span.start };
        let position = source.position(start);
        Self {
            code: diagnostic.code.name(),
            severity: diagnostic.severity,
            message: diagnostic.message.clone(),
            line: position.line,
            column: position.column,
            help: diagnostic.help.clone(),
        }
    }
}
