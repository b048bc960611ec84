//! The reader of models in plain Rust.
//!
//! In: a module's tokens, and those of its attribute. Out: a [`Model`] as far as it could be read, its mistakes collected.
//!
//! ```text
//! tokens -> items::Items -> evaluate::Reader -> Model
//! ```
//!
//! Functions are run with names for numbers: `let`, helper functions, fields and indices disappear, and each component
//! of the result keeps the formula of its computation. Rust's own rules hold: an accepted model means what the compiled
//! function computes, but for rounding.
//!
//! There is no text here: a [`Span`](crate::source::Span) is a range of [`TokenSpans`], each of which is a run of
//! tokens.

mod spans;

mod arguments;
mod block;
mod evaluate;
mod functions;
mod imports;
mod items;
mod plant;
mod refusal;
mod value;

use proc_macro2::TokenStream;

use super::{Model, check};
use crate::source::{Diagnostic, Diagnostics};
pub use spans::TokenSpans;

impl Model {
    /// Reads a module of plain Rust; `arguments` are those of its attribute. `spans` resolves its spans.
    pub fn read_rust(
        arguments: TokenStream,
        module: &syn::ItemMod,
        spans: &mut TokenSpans,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut diagnostics = Diagnostics::new();
        let model = plant::read(arguments, module, spans, &mut diagnostics);
        if let Some(model) = &model {
            check(model, &mut diagnostics);
        }
        diagnostics.propagate()?;
        // Without a model there is an error, which was propagated.
        model.map(Self::ordered).ok_or_else(Vec::new)
    }
}
