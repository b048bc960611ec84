//! Diagnostics of the generator as errors of the compiler.

use pebo_gen::model::rust::Places;
use pebo_gen::source::{Diagnostic, Severity};
use proc_macro2::TokenStream;
use syn::Error;

/// Compile errors for what is wrong; warnings and notes have no channel in a macro of stable Rust.
pub(crate) fn errors(diagnostics: &[Diagnostic], places: &Places) -> TokenStream {
    let errors = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    errors.map(|diagnostic| error(diagnostic, places).into_compile_error()).collect()
}

fn error(diagnostic: &Diagnostic, places: &Places) -> Error {
    let mut text = format!("{} [{}]", diagnostic.message, diagnostic.code.name());
    if !diagnostic.primary.text.is_empty() {
        text.push_str(&format!("\n{}", diagnostic.primary.text));
    }
    // The compiler underlines one place: the others are quoted.
    for label in diagnostic.secondary.iter().filter(|label| !label.text.is_empty()) {
        text.push_str(&format!("\nnote: {}: `{}`", label.text, places.text(label.span)));
    }
    for note in &diagnostic.notes {
        text.push_str(&format!("\nnote: {note}"));
    }
    if let Some(help) = &diagnostic.help {
        text.push_str(&format!("\nhelp: {help}"));
    }
    match places.ends(diagnostic.primary.span) {
        Some((first, last)) => Error::new_spanned(TokenStream::from_iter([first, last]), text),
        None => Error::new(proc_macro2::Span::call_site(), text),
    }
}
