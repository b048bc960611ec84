//! The YAML reader.
//!
//! In: a source. Out: a [`Model`] as far as it could be read, its mistakes collected.
//!
//! ```text
//! text -> tree::Node -> document::Document -> Model
//!     granit        read
//! ```
//!
//! A decoder as serde's stops at the first mistake, has no spans, and silently keeps the last of two equal keys: good for
//! turning a right document into types, poor at diagnosing a wrong one. Therefore `tree` walks the text with
//! granit-parser, which knows the bytes of every value, and refuses features that model files do without; `read` makes
//! values of the tree by the table of keys (`model::section`), and reports every departure. Faulty parts are left out of
//! the value: one mistake gives one diagnostic, and the rest is still read.
//!
//! Settings of a call are put into the tree (`set`) and checked by the same table.

mod document;
mod json_schema;
mod key;
mod read;
mod refusal;
mod set;
mod tree;
mod values;
mod words;

use super::Model;
use crate::source::{Diagnostics, Source};
pub(in crate::model) use key::{Key, Shape};
pub(in crate::model) use read::{Read, Reader, Section};
use tree::Content;
pub(in crate::model) use tree::Node;

/// The JSON schema of model files.
pub(super) fn json_schema() -> String {
    json_schema::text()
}

/// Reads the model in `source`; nothing where its outline is not recognisable.
pub(super) fn read(source: &Source, diagnostics: &mut Diagnostics) -> Option<Model> {
    let mut tree = tree::grow(source, diagnostics)?;
    set::set(&mut tree, source, diagnostics);
    match &mut tree.content {
        Content::Map(entries) => {
            // The line that names the model is where something is missing from the model.
            let title = entries.iter().find(|(key, _)| key.text == "model").or(entries.first());
            tree.span = title.map_or(tree.span, |(key, _)| key.span);
            // Formulas call the tables that stand there.
            entries.sort_by_key(|(key, _)| key.text != "define");
        }
        Content::Null => {
            diagnostics.push(refusal::empty());
            return None;
        }
        _ => {}
    }
    let mut reader = Reader::new(source, document::FILE, diagnostics);
    document::read(&tree, &mut reader)
}
