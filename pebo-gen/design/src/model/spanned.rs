//! Values with their places.

#[cfg(feature = "yaml")]
use serde::Deserialize;

use crate::source::Span;

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its place.
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
