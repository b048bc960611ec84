//! The value of an expression of Rust.

use crate::model::formula::{Formula, SizedFormula, Term};
use crate::model::spanned::Spanned;
use crate::source::Span;

/// A value: numbers are formulas.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// A number.
    Number(SizedFormula),
    /// A struct.
    Record(Vec<Field>),
    /// An array or a tuple.
    List(Vec<Value>),
}

/// A field of a struct.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: Spanned<String>,
    pub(super) value: Value,
}

/// Local names and their values, the innermost last.
pub(super) type Locals = Vec<(String, Value)>;

impl Value {
    /// A declared name.
    pub(super) fn name(name: &str, span: Span) -> Self {
        Self::Number(SizedFormula::leaf(Formula { span, term: Term::Name(name.to_owned()) }))
    }

    /// A struct whose fields are declared names.
    pub(super) fn record(fields: &[Spanned<String>]) -> Self {
        let field = |name: &Spanned<String>| Field { name: name.clone(), value: Self::name(&name.value, name.span) };
        Self::Record(fields.iter().map(field).collect())
    }

    /// The number of components, to bound copies by.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Number(number) => number.parts(),
            Self::Record(fields) => 1 + fields.iter().map(|field| field.value.size()).sum::<usize>(),
            Self::List(items) => 1 + items.iter().map(Self::size).sum::<usize>(),
        }
    }

    /// Its kind, for messages.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Record(_) => "a struct",
            Self::List(_) => "an array or a tuple",
        }
    }
}
