//! Reads the tree by the table of keys.
//!
//! In: a [`Node`]. Out: a value of the model, with its formulas parsed. What was faulty is absent, or 0 where a formula
//! has to be, and its diagnostic is out: one mistake gives one diagnostic, and the rest is still read.

use std::sync::Arc;

use super::key::{Key, Role, Shape};
use super::tree::{self, Content, Node};
use super::words::{as_list, course, describe, in_class, is_course, is_empty, unknown_key};
use crate::model::choice::Choice;
use crate::model::formula::{
    Comparison, Decimal, Estimates, Formula, Permitted, SpanMap, Table, Term, parse_comparison, parse_formula,
};
use crate::model::spanned::{Entry, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics, Source, Span, listed, nearest, quoted};

/// A value that is read from a file.
pub(crate) trait Read: Sized {
    /// Its shape, unless a key says more.
    const SHAPE: Shape;

    /// Reads a node of this shape; nothing where it has another, which is reported.
    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self>;
}

/// A map with known keys.
pub(crate) trait Section {
    /// The keys, in the order of the manual.
    const KEYS: &'static [Key];
}

/// The progress of reading a file.
pub(crate) struct Reader<'a> {
    source: &'a Source,
    pub(super) diagnostics: &'a mut Diagnostics,
    /// The keys of the whole file.
    file: &'static [Key],
    /// The tables of the model.
    pub(super) tables: Vec<Arc<Table>>,
    /// Permission for `hat()` under the key at hand.
    estimates: Estimates,
    /// The key at hand, and how it is written.
    key: &'static str,
    pub(super) example: &'static str,
    /// The name in the map at hand.
    entry: Option<&'a str>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a Source, file: &'static [Key], diagnostics: &'a mut Diagnostics) -> Self {
        let (key, example) = ("model", "model: cuk");
        let estimates = Estimates::Refused;
        Self { source, diagnostics, file, tables: Vec::new(), estimates, key, example, entry: None }
    }

    /// Reads into a field, which keeps its value where there is nothing to read.
    pub(crate) fn fill<T: Read>(&mut self, field: &mut T, node: &'a Node, shape: &'static Shape) {
        if let Some(value) = T::read(node, shape, self) {
            *field = value;
        }
    }

    pub(super) fn formula(&mut self, text: &str, span: Span) -> Formula {
        let spans = SpanMap::align(text, span, self.source);
        let permitted = Permitted { estimates: self.estimates, tables: &self.tables };
        let parsed = parse_formula(text, &spans, permitted);
        self.diagnostics.keep(parsed).unwrap_or_else(|| nothing(span))
    }

    fn comparison(&mut self, text: &str, span: Span) -> Option<Comparison> {
        let spans = SpanMap::align(text, span, self.source);
        self.diagnostics.keep(parse_comparison(text, &spans, &self.tables))
    }

    pub(super) fn number(&mut self, text: &str, span: Span) -> Option<Spanned<Decimal>> {
        let value = self.diagnostics.keep(Decimal::parse(text, span))?;
        Some(Spanned { value, span })
    }

    fn choice<T: Choice>(&mut self, text: &str, span: Span) -> Option<Spanned<T>> {
        if let Some(value) = T::of_word(text) {
            return Some(Spanned { value, span });
        }
        let words = || T::WORDS.iter().copied();
        let message = format!("{} is none of the choices", quoted(text));
        let diagnostic = Diagnostic::error(Code::WrongChoice, span, message);
        self.diagnostics.push(match nearest(text, words()) {
            Some(near) => diagnostic.suggest(Some(near)).note(format!("the choices are {}", listed(words()))),
            None => diagnostic.help(format!("write one of {}", listed(words()))),
        });
        None
    }

    /// Reads a map from names.
    pub(super) fn entries<T>(
        &mut self,
        entries: &'a [(tree::Key, Node)],
        mut read: impl FnMut(&str, &'a Node, &mut Self) -> Option<T>,
    ) -> Vec<Entry<T>> {
        let entry = |(key, node): &'a (tree::Key, Node)| {
            self.entry = Some(&key.text);
            Some(Entry { value: read(&key.text, node, self)?, name: spanned(&key.text, key.span) })
        };
        entries.iter().filter_map(entry).collect()
    }

    /// Reads a map with known keys, and puts what is behind each where it belongs.
    pub(crate) fn section(
        &mut self,
        node: &'a Node,
        shape: &'static Shape,
        put: &mut dyn FnMut(&'static Key, &'a Node, &mut Self),
    ) -> Option<()> {
        match (shape, &node.content) {
            (Shape::Record(keys) | Shape::NumberOr(keys) | Shape::FormulaOr(keys), Content::Map(entries)) => {
                self.record(entries, keys, node.span, put);
            }
            (Shape::NumberOr([first, ..]), Content::Scalar(_)) => put(first, node, self),
            _ => return self.refuse(node, shape),
        }
        Some(())
    }

    /// A map with known keys; `span` is the span of a missing one.
    fn record(
        &mut self,
        entries: &'a [(tree::Key, Node)],
        keys: &'static [Key],
        span: Span,
        put: &mut dyn FnMut(&'static Key, &'a Node, &mut Self),
    ) {
        let class = entries.iter().map(|(name, _)| name).find(|name| {
            let key = keys.iter().find(|key| key.name == name.text);
            key.is_some_and(|key| key.role == Role::Class)
        });
        let estimates = self.estimates;
        for (name, node) in entries {
            let Some(key) = keys.iter().find(|key| key.name == name.text) else {
                self.diagnostics.push_with(|| unknown_key(&name.text, name.span, keys, self.file));
                continue;
            };
            (self.key, self.example, self.entry) = (key.name, key.example, None);
            if let Some(class) = class.filter(|class| key.excludes(name, class)) {
                self.diagnostics.push(in_class(name, class));
            } else if key.role.is_filled() && is_empty(node) {
                let message = format!("`{}` is empty", key.name);
                self.diagnostics.push(
                    Diagnostic::error(Code::EmptyList, node.span, message)
                        .help(format!("write for example `{}`", key.example)),
                );
            } else {
                self.estimates = if key.hat { Estimates::Allowed } else { estimates };
                put(key, node, self);
            }
        }
        self.estimates = estimates;
        // A class replaces the keys that it gives.
        let missing = |key: &&Key| match key.role {
            Role::Required => true,
            Role::RequiredOrByClass => class.is_none(),
            Role::Optional | Role::OptionalOrByClass | Role::SearchedOrByClass | Role::Class => false,
        };
        for key in keys.iter().filter(missing) {
            if !entries.iter().any(|(name, _)| name.text == key.name) {
                let message = format!("the key `{}` is missing", key.name);
                self.diagnostics.push(
                    Diagnostic::error(Code::MissingKey, span, message)
                        .help(format!("add it, for example `{}`", key.example)),
                );
            }
        }
    }

    /// Reports a value of the wrong shape.
    pub(super) fn refuse<T>(&mut self, node: &Node, shape: &Shape) -> Option<T> {
        let found = match &node.content {
            Content::Null => "nothing".to_owned(),
            Content::Scalar(text) => quoted(text),
            Content::List(_) => "a list".to_owned(),
            Content::Map(_) => "a map".to_owned(),
            Content::Broken => return None,
        };
        let message = format!("expected {}, found {found}", describe(shape));
        let help = if matches!(shape, Shape::Formula | Shape::FormulaOr(_)) && is_course(node) {
            course(self.key, self.entry)
        } else {
            let is_plain = matches!(shape, Shape::List(Shape::Text | Shape::Number | Shape::Formula));
            let written = is_plain.then(|| as_list(self.key, node)).flatten();
            format!("write {}", written.unwrap_or_else(|| format!("for example `{}`", self.example)))
        };
        self.diagnostics.push(Diagnostic::error(Code::WrongShape, node.span, message).help(help));
        None
    }
}

impl Key {
    /// Tests whether the class excludes the key.
    fn excludes(&self, name: &tree::Key, class: &tree::Key) -> bool {
        match self.role {
            Role::Class => name.span != class.span,
            Role::RequiredOrByClass | Role::OptionalOrByClass | Role::SearchedOrByClass => true,
            Role::Required | Role::Optional => false,
        }
    }
}

/// A stand-in for a formula whose diagnostic is out.
pub(super) fn nothing(span: Span) -> Formula {
    Formula { span, term: Term::Number(Decimal::zero()) }
}

pub(super) fn spanned(text: &str, span: Span) -> Spanned<String> {
    Spanned { value: text.to_owned(), span }
}

/// Names are texts here: whether they are names is checked where they are declared.
impl Read for Spanned<String> {
    const SHAPE: Shape = Shape::Text;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => Some(spanned(text, node.span)),
            _ => reader.refuse(node, shape),
        }
    }
}

impl Read for Spanned<Decimal> {
    const SHAPE: Shape = Shape::Number;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => reader.number(text, node.span),
            _ => reader.refuse(node, shape),
        }
    }
}

impl<T: Choice> Read for Spanned<T> {
    const SHAPE: Shape = Shape::Choice(T::WORDS);

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => reader.choice(text, node.span),
            _ => reader.refuse(node, shape),
        }
    }
}

/// Something of the wrong shape is 0, so that the entry that it belongs to is not missing as well.
impl Read for Formula {
    const SHAPE: Shape = Shape::Formula;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        if let Content::Scalar(text) = &node.content {
            return Some(reader.formula(text, node.span));
        }
        reader.refuse(node, shape).or_else(|| Some(nothing(node.span)))
    }
}

impl Read for Comparison {
    const SHAPE: Shape = Shape::Formula;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => reader.comparison(text, node.span),
            _ => reader.refuse(node, shape),
        }
    }
}

impl<T: Read> Read for Option<T> {
    const SHAPE: Shape = T::SHAPE;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        T::read(node, shape, reader).map(Some)
    }
}

impl<T: Read> Read for Vec<T> {
    const SHAPE: Shape = Shape::List(&T::SHAPE);

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match (shape, &node.content) {
            (Shape::List(item) | Shape::OneOrMore(item), Content::List(items)) => {
                Some(items.iter().filter_map(|node| T::read(node, item, reader)).collect())
            }
            (Shape::OneOrMore(item), Content::Scalar(_)) => Some(T::read(node, item, reader).into_iter().collect()),
            _ => reader.refuse(node, shape),
        }
    }
}

impl<T: Read> Read for Vec<Entry<T>> {
    const SHAPE: Shape = Shape::Map(&T::SHAPE);

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Map(entries) => Some(reader.entries(entries, |_, node, reader| T::read(node, &T::SHAPE, reader))),
            _ => reader.refuse(node, shape),
        }
    }
}
