//! Diagnostics for people and for programs.

use std::iter::once;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Renderer, Snippet};

use super::{Diagnostic, Label, Severity, Source, Span};

/// Permission for terminal colours in a rendering.
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
    let primary = Some((AnnotationKind::Primary, &diagnostic.primary)).filter(|(_, label)| label.span != Span::NOWHERE);
    let others = diagnostic.secondary.iter().map(|label| (AnnotationKind::Context, label));
    let labels: Vec<(AnnotationKind, &Label)> =
        primary.into_iter().flat_map(|first| once(first).chain(others.clone())).collect();
    let (mut of_call, mut of_file) = (Vec::new(), Vec::new());
    for (kind, label) in labels {
        match source.call(label.span) {
            Some((_, start)) => of_call.push(annotation((kind, label), source, start)),
            None => of_file.push(annotation((kind, label), source, 0)),
        }
    }
    let call = source.call(Span::point(usize::MAX)).map_or("", |(text, _)| text);
    let snippet = |text, path, annotations: Vec<_>| {
        (!annotations.is_empty()).then(|| Snippet::source(text).path(path).annotations(annotations))
    };
    // The cause comes first.
    let mut snippets = [snippet(source.text(), source.name(), of_file), snippet(call, "the call", of_call)];
    if source.call(diagnostic.primary.span).is_some() {
        snippets.reverse();
    }
    title
        .elements(snippets.into_iter().flatten())
        .elements(diagnostic.notes.iter().map(|note| Level::NOTE.message(note.as_str())))
        .elements(diagnostic.help.iter().map(|help| Level::HELP.message(help.as_ref())))
}

/// The annotation of a text that begins at `start`.
fn annotation<'a>((kind, label): (AnnotationKind, &'a Label), source: &Source, start: usize) -> Annotation<'a> {
    let text = Some(label.text.as_ref()).filter(|text| !text.is_empty());
    let span = first_line(label.span, source);
    kind.span(span.start - start..span.end - start).label(text)
}

/// A span over many lines hides the cause: its first line is enough.
fn first_line(span: Span, source: &Source) -> Span {
    let span = source.fit(span);
    let line = source.slice(span).lines().next().unwrap_or_default();
    Span::new(span.start, span.start + line.trim_end().len())
}

/// A diagnostic as a program reads it: serialises to the object of the JSON report.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LocatedDiagnostic {
    /// The code's name.
    pub code: &'static str,
    /// `error`, `warning` or `note`.
    pub severity: Severity,
    /// The mistake or finding.
    pub message: Box<str>,
    /// Line of the primary span, from 1; 1 where there is none.
    pub line: usize,
    /// Column in characters, from 1; 1 where there is no span.
    pub column: usize,
    /// The remedy, or null.
    pub help: Option<Box<str>>,
    /// The range of bytes of the primary span; none where there is no span.
    pub span: Option<Span>,
    /// The text beside the primary span; may be empty.
    pub label: Box<str>,
    /// Other relevant spans, with the text beside them.
    pub labels: Vec<Label>,
    /// Facts that explain it.
    pub notes: Vec<String>,
    /// The replacement for the primary span, where that is the whole remedy.
    pub replacement: Option<String>,
}

impl LocatedDiagnostic {
    /// The diagnostic with its spans counted in `source`.
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
            span: Some(diagnostic.primary.span).filter(|span| *span != Span::NOWHERE),
            label: diagnostic.primary.text.clone(),
            labels: diagnostic.secondary.clone(),
            notes: diagnostic.notes.clone(),
            replacement: diagnostic.replacement().map(str::to_owned),
        }
    }
}
