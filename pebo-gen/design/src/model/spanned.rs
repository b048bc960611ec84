//! Values with their spans.

use crate::source::Span;

/// A value and its span.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its span.
    pub span: Span,
}

/// A named value: `name: value` in a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry<T> {
    /// The name.
    pub name: Spanned<String>,
    /// The value.
    pub value: T,
}
