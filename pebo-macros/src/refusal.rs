//! Diagnostics of the generator as errors of the compiler.

use pebo_gen::model::rust::TokenSpans;
use pebo_gen::source::{Diagnostic, Severity};
use proc_macro2::TokenStream;
use syn::Error;

/// Compile errors for what is wrong; warnings and notes have no channel in a macro of stable Rust.
pub(crate) fn errors(diagnostics: &[Diagnostic], spans: &TokenSpans) -> TokenStream {
    let errors = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    errors.map(|diagnostic| error(diagnostic, spans).into_compile_error()).collect()
}

fn error(diagnostic: &Diagnostic, spans: &TokenSpans) -> Error {
    let mut lines = vec![format!("{} [{}]", diagnostic.message, diagnostic.code.name())];
    lines.extend(Some(diagnostic.primary.text.to_string()).filter(|label| !label.is_empty()));
    // The compiler underlines one place: the others are quoted, with their line.
    let labels = diagnostic.secondary.iter().filter(|label| !label.text.is_empty());
    lines.extend(labels.map(|label| {
        let line = spans.ends(label.span).map(|(first, _)| format!(" (line {})", first.span().unwrap().line()));
        format!("note: {}: `{}`{}", label.text, spans.text(label.span), line.unwrap_or_default())
    }));
    lines.extend(diagnostic.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(diagnostic.help.iter().map(|help| format!("help: {help}")));
    // Proposals are written in the grammar of model files.
    if diagnostic.help.iter().any(|help| help.contains("z1") || help.contains('^')) {
        lines.push("note: there, `z1` is `z[0]`, and `a^2` is `a.powi(2)`".to_owned());
    }
    let text = lines.join("\n");
    match spans.ends(diagnostic.primary.span) {
        Some((first, last)) => Error::new_spanned(TokenStream::from_iter([first, last]), text),
        None => Error::new(proc_macro2::Span::call_site(), text),
    }
}
