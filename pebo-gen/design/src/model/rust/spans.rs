//! Spans of a model in tokens.

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::ToTokens;

use crate::source::Span;

/// Runs of tokens, by their spans.
///
/// Run number n has the span `n..n + 1`; a span that covers several reaches from the first token of
/// the first run to the last token of the last one. Compilers do not tell macros the offsets of tokens, so these are
/// numbers of our own.
#[derive(Debug, Default)]
pub struct TokenSpans {
    spans: Vec<TokenStream>,
}

impl TokenSpans {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a run: these tokens.
    pub(super) fn of(&mut self, tokens: &impl ToTokens) -> Span {
        self.spans.push(tokens.to_token_stream());
        Span::new(self.spans.len() - 1, self.spans.len())
    }

    /// Adds a run: a span of the compiler.
    pub(super) fn at(&mut self, span: proc_macro2::Span) -> Span {
        self.of(&Ident::new("here", span))
    }

    /// The first and the last token of a span; none if nothing was read.
    pub fn ends(&self, span: Span) -> Option<(TokenTree, TokenTree)> {
        let last = span.end.saturating_sub(1).max(span.start).min(self.spans.len().saturating_sub(1));
        let first = self.spans.get(span.start.min(last))?.clone().into_iter().next()?;
        let last = self.spans.get(last)?.clone().into_iter().last()?;
        Some((first, last))
    }

    /// The tokens of a span's first run, as a person would write them on one line.
    pub fn text(&self, span: Span) -> String {
        let text = self.spans.get(span.start).map(ToString::to_string).unwrap_or_default();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        text.replace(" . ", ".").replace(" (", "(").replace("( ", "(").replace(" )", ")").replace(" ,", ",")
    }

    /// A path as it is written.
    pub(super) fn path(path: &syn::Path) -> String {
        path.segments.iter().map(|segment| segment.ident.to_string()).collect::<Vec<_>>().join("::")
    }
}
