//! Diagnostics for a text that is not the YAML of a model file.

use granit_parser::{ErrorKind, ScanError};

use crate::source::{Code, Diagnostic, Span, quoted};

/// The text, which begins at `start`, is not YAML.
pub(super) fn syntax(error: &ScanError, start: usize) -> Diagnostic {
    let span = Span::point(start + error.marker().byte_offset().unwrap_or(0));
    let (code, help) = match error.kind() {
        ErrorKind::RecursionLimitExceeded => {
            return Diagnostic::error(Code::NestedTooDeep, span, "lists or maps are nested too deep")
                .help("model files need five levels; remove the brackets that are not needed");
        }
        ErrorKind::DirectiveDisallowed => {
            return feature(span, "directives", "put a formula in quotes if it begins with `%`");
        }
        ErrorKind::UnclosedFlowCollection { .. }
        | ErrorKind::MisplacedFlowCollectionEnd
        | ErrorKind::MismatchedFlowCollectionEnd { .. }
        | ErrorKind::ExpectedFlowMappingSeparator
        | ErrorKind::ExpectedFlowSequenceSeparator => {
            (Code::YamlSyntax, "check that every bracket is closed and that entries have commas between them")
        }
        ErrorKind::UnclosedQuotedScalar => (Code::YamlSyntax, "close the quote"),
        ErrorKind::TabNotAllowed
        | ErrorKind::TabInBlockIndentation
        | ErrorKind::TabInIndentation
        | ErrorKind::TabInPlainScalar
        | ErrorKind::TabAtBlockScalarStart => (Code::YamlSyntax, "indent with spaces, not with tabs"),
        ErrorKind::MappingValueNotAllowed => {
            (Code::YamlSyntax, "put a text that contains a colon in quotes; check that the indentation is consistent")
        }
        ErrorKind::BlockSequenceEntryNotAllowed
        | ErrorKind::UnexpectedCharacter { .. }
        | ErrorKind::PlainScalarStartsWithDashFlowIndicator
        | ErrorKind::MissingAnchorOrAliasName => {
            (Code::YamlSyntax, "put a formula in quotes if it begins with `- ` or a special character")
        }
        _ => (Code::YamlSyntax, "check the indentation, the brackets and the quotes"),
    };
    Diagnostic::error(code, span, format!("this is not YAML: {}", error.info())).help(help)
}

/// The text has no values.
pub(super) fn empty() -> Diagnostic {
    Diagnostic::error(Code::EmptyFile, Span::default(), "the model file is empty")
        .help("write at least the keys model, x, y and f_x, and f_y or g_y for an output")
}

/// The text has too many values.
pub(super) fn too_many(span: Span, limit: usize) -> Diagnostic {
    Diagnostic::error(Code::TooManyValues, span, format!("the file has more than {limit} values"))
        .label("this value is beyond the limit")
        .help("give a model file; a model has a few hundred values")
}

/// YAML has this, model files have not.
pub(super) fn feature(span: Span, what: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::YamlFeature, span, format!("model files cannot contain {what}")).help(help)
}

/// An alias, or a formula that begins like one.
pub(super) fn alias(span: Span, text: &str) -> Diagnostic {
    let message = format!("model files cannot contain aliases, and YAML reads {} as one", quoted(text));
    Diagnostic::error(Code::YamlFeature, span, message)
        .help("write the value out; put a formula in quotes if it begins with `*`")
}

/// A list or a map as a key.
pub(super) fn key(span: Span) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, span, "a key is a list or a map")
        .help("write `key: value`, with a name for the key")
}

/// A formula that its own comma has cut; `text` is the whole of it.
pub(super) fn cut(span: Span, text: &str) -> Diagnostic {
    let message = "the comma ends this formula, since it is not quoted";
    Diagnostic::error(Code::UnclosedParenthesis, span, message).help(format!("put it in quotes: \"{text}\""))
}

/// A key that its map has already.
pub(super) fn duplicate(key: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(Code::DuplicateKey, span, format!("the key {} occurs twice", quoted(key)))
        .also(first, "first here")
        .help("remove one of them")
}
