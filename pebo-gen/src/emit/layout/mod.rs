//! The tokens as text that rustfmt leaves as it is.
//!
//! In: the tokens of a module. Out: its text, items apart by blank lines. Only the forms that the
//! emitter uses are known. The widths are those of rustfmt's default configuration.
//!
//! One thing with `items` and `syntax`: items hold expressions, and both ask here for the width that is left.

mod items;
mod syntax;

use proc_macro2::TokenStream;
use quote::ToTokens;

use super::error::EmitError;

/// The longest line.
const LINE: usize = 100;
/// One step of indentation.
const STEP: usize = 4;

/// The text of a module.
pub(super) fn text(tokens: &TokenStream) -> Result<String, EmitError> {
    let file: syn::File =
        syn::parse2(tokens.clone()).map_err(|error| EmitError::Unreadable { code: error.to_string() })?;
    items::module(&file)
}

fn unknown(code: &impl ToTokens) -> EmitError {
    EmitError::Unreadable { code: code.to_token_stream().to_string() }
}

/// Text that grows by lines.
#[derive(Debug, Default)]
struct Page {
    text: String,
}

impl Page {
    /// Adds a line, which may contain the rest of a statement.
    fn line(&mut self, indent: usize, line: &str) {
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n(' ', indent));
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// The lines between delimiters, the closing one at the indentation.
    fn within(self, open: &str, close: &str, indent: usize) -> String {
        format!("{open}\n{}{}{close}", self.text, " ".repeat(indent))
    }
}
