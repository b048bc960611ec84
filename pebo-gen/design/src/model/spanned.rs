//! Values with their spans.

#[cfg(feature = "yaml")]
use serde::Deserialize;

use crate::source::Span;

/// A value and its span.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its span.
    pub span: Span,
}

/// A named value: `name: value` in a map.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
pub struct Entry<T> {
    /// The name.
    pub name: Spanned<String>,
    /// The value.
    pub value: T,
}
