//! Texts, spans in them, and diagnostics.
//!
//! In: bytes. Out: a [`Source`], a UTF-8 text of bounded size with a name; and [`Diagnostic`]s, which are data with a
//! [`Span`] into that text. After this layer a span is a byte range: lines and columns exist only where a diagnostic is
//! printed, as a picture ([`render()`]) or as a JSON object ([`LocatedDiagnostic`]).
//!
//! This layer knows neither model files nor formulas; it holds the one table of [`Code`]s that
//! every layer uses.

mod codes;
mod diagnostic;
#[cfg(feature = "yaml")]
mod render;
mod span;
mod spelling;
mod text;

#[cfg(all(test, feature = "yaml"))]
mod tests;

pub use codes::Code;
pub use diagnostic::{Diagnostic, Diagnostics, Label, Severity};
#[cfg(feature = "yaml")]
pub use render::{Colour, LocatedDiagnostic, render, render_within};
pub use span::Span;
pub use spelling::{counted, listed, nearest, quoted};
pub use text::{Position, SIZE_LIMIT, Source};
