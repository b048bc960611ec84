//! The YAML reader.
//!
//! In: a source. Out: a [`Model`] as far as it could be read, its mistakes collected.
//!
//! ```text
//! text -> tree::Node -> serde_yaml::Value -> document::Document -> Model
//!     granit        shape               serde               formulas
//! ```
//!
//! Two YAML crates share the work, because neither does all of it. serde's typed decoding stops at the first mistake,
//! has no places, and silently keeps the last of two equal keys: good for turning a right document into types, poor at
//! diagnosing a wrong one. Therefore `tree` walks the text with granit-parser, which knows the bytes of every value,
//! and refuses features that model files do without; `shape` checks the tree against the table of keys in `schema`,
//! reports every departure, and rewrites the right parts into one canonical form in which each scalar carries its span;
//! `serde_yaml` decodes that value. It is decoded from the tree, not from the text again, so there are no two readings
//! of the text. Faulty parts are left out of the value: one mistake gives one diagnostic, and the rest is still read.
//!
//! Settings of a call are put into the tree (`set`) and checked by the same table.

mod document;
mod formulas;
mod json_schema;
mod refusal;
mod schema;
mod set;
mod shape;
mod tree;

use crate::source::{Code, Diagnostic, Diagnostics, Source, Span};

use super::Model;
use document::Document;

/// The JSON schema of model files.
pub(super) fn json_schema() -> String {
    json_schema::text()
}

/// Reads the model in `source`; nothing where its outline is not recognisable.
pub(super) fn read(source: &Source, diagnostics: &mut Diagnostics) -> Option<Model> {
    let mut tree = tree::grow(source, diagnostics)?;
    set::set(&mut tree, source, diagnostics);
    let value = shape::fit(&tree, diagnostics)?;
    // Every value that fits the schema decodes: this error is a slip between the two tables.
    let document = serde_yaml::from_value::<Document>(value)
        .map_err(|error| Diagnostic::error(Code::WrongShape, Span::default(), error.to_string()));
    formulas::parse(diagnostics.keep(document)?, source, diagnostics)
}
