//! Checks the tree against the schema.
//!
//! In: a [`Node`]. Out: a `serde_yaml` value in canonical form, which always decodes to a
//! [`Document`](super::document::Document). In this form
//! - a scalar is a map `{value, span}`;
//! - a map with names for keys is a list of `{name, value}`, in the order of the file;
//! - a choice of notations is made: parameters are a map, one gain is a list of one, a signal is a
//!   list of pieces;
//! - what was faulty is absent, or `0` where a formula has to be, and its diagnostic is out.

use serde_yaml::{Mapping, Value};

use super::refusal;
use super::schema::{Key, MODEL, OTHERS, Role, Shape};
use super::tree::{self, Content, Node};
use crate::model::formula::Decimal;
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest, quoted};

/// Fits the whole file to the schema; nothing if it is no map.
pub(super) fn fit<'a>(root: &'a Node, diagnostics: &'a mut Diagnostics) -> Option<Value> {
    let mut fitter = Fitter { diagnostics, key: "model", example: "model: cuk", entry: None };
    match &root.content {
        Content::Map(entries) => {
            // The line that names the model is where something is missing from the model.
            let title = entries.iter().find(|(key, _)| key.text == "model").or(entries.first());
            let span = title.map_or(root.span, |(key, _)| key.span);
            Some(fitter.record(entries, MODEL, span))
        }
        Content::Null => {
            fitter.diagnostics.push(refusal::empty());
            None
        }
        _ => fitter.refuse(root, &Shape::Record(MODEL)),
    }
}

struct Fitter<'a> {
    diagnostics: &'a mut Diagnostics,
    /// The key at hand, and how it is written.
    key: &'static str,
    example: &'static str,
    /// The name in the map at hand.
    entry: Option<&'a str>,
}

impl<'a> Fitter<'a> {
    fn fit(&mut self, node: &'a Node, shape: &'static Shape) -> Option<Value> {
        match (shape, &node.content) {
            (Shape::Text | Shape::Formula | Shape::FormulaOr(_), Content::Scalar(text)) => {
                Some(spanned(text, node.span))
            }
            (Shape::Number, Content::Scalar(text)) => self.number(text, node.span),
            (Shape::Choice(words), Content::Scalar(text)) => self.choice(words, text, node.span),
            (Shape::List(item) | Shape::OneOrMore(item), Content::List(items)) => {
                Some(sequence(items.iter().map(|node| self.fit(node, item))))
            }
            (Shape::OneOrMore(item), Content::Scalar(_)) => Some(sequence([self.fit(node, item)])),
            (Shape::AllOrEach, Content::Scalar(text)) => Some(fields([("all", self.number(text, node.span)?)])),
            (Shape::AllOrEach, Content::Map(_)) => {
                Some(fields([("each", self.fit(node, &Shape::Map(&Shape::Number))?)]))
            }
            (Shape::Map(shape), Content::Map(entries)) => Some(sequence(entries.iter().map(|(key, node)| {
                self.entry = Some(&key.text);
                Some(entry(&key.text, key.span, self.fit(node, shape)?))
            }))),
            (Shape::Kinds(keys, other), Content::Map(entries)) => {
                let shape = |name: &str| keys.iter().find(|key| key.name == name).map_or(*other, |key| &key.shape);
                let entries = entries.iter();
                Some(sequence(
                    entries.map(|(key, node)| Some(entry(&key.text, key.span, self.fit(node, shape(&key.text))?))),
                ))
            }
            (Shape::Parameters, Content::Map(entries)) => Some(sequence(entries.iter().map(|(key, node)| {
                let value = match node.content {
                    Content::Null => None,
                    _ => self.fit(node, &Shape::Number),
                };
                Some(entry(&key.text, key.span, value.unwrap_or(Value::Null)))
            }))),
            (Shape::Parameters, Content::List(items)) => Some(sequence(items.iter().map(|node| self.parameter(node)))),
            (Shape::Signal, Content::Scalar(text)) => {
                let start = spanned("0", node.span);
                Some(sequence([Some(piece(start, spanned(text, node.span)))]))
            }
            (Shape::Signal, Content::Map(entries)) => Some(sequence(entries.iter().map(|(key, node)| {
                let start = self.number(&key.text, key.span)?;
                Some(piece(start, self.fit(node, &Shape::Formula)?))
            }))),
            (Shape::FormulaOr(_), Content::Map(_)) if is_course(node) => self.refuse(node, &Shape::Formula),
            (Shape::Record(keys) | Shape::NumberOr(keys) | Shape::FormulaOr(keys), Content::Map(entries)) => {
                Some(self.record(entries, keys, node.span))
            }
            (Shape::NumberOr([first, ..]), Content::Scalar(text)) => {
                Some(fields([(first.name, self.number(text, node.span)?)]))
            }
            (Shape::Matrix, Content::Scalar(text)) => {
                Some(matrix(node.span, 0, sequence([Some(sequence([Some(spanned(text, node.span))]))])))
            }
            (Shape::Matrix, Content::List(rows)) => self.matrix(node, rows),
            _ => self.refuse(node, shape),
        }
    }

    /// A list of formulas, or a list of rows; all rows of one length.
    fn matrix(&mut self, node: &'a Node, items: &'a [Node]) -> Option<Value> {
        if items.is_empty() || items.iter().any(is_empty) {
            self.diagnostics.push(
                Diagnostic::error(Code::EmptyList, node.span, "a matrix has at least one entry")
                    .help(format!("write for example `{}`", self.example)),
            );
            return None;
        }
        let formulas = |this: &mut Self, items: &'a [Node]| {
            sequence(items.iter().map(|item| this.fit(item, &Shape::Formula)).collect::<Vec<_>>())
        };
        if !items.iter().any(|item| matches!(item.content, Content::List(_))) {
            let row = formulas(self, items);
            return Some(matrix(node.span, 1, sequence([Some(row)])));
        }
        let mut rows = Vec::new();
        let mut width = None;
        for item in items {
            let Content::List(entries) = &item.content else { return self.refuse(item, &Shape::List(&Shape::Formula)) };
            let first = *width.get_or_insert(entries.len());
            if entries.len() != first {
                let message = format!("a row of {} in a matrix with rows of {first}", entries.len());
                self.diagnostics.push(
                    Diagnostic::error(Code::WrongShape, item.span, message)
                        .help(format!("write {first} formulas in each row, as `{}`", self.example)),
                );
                return None;
            }
            rows.push(Some(formulas(self, entries)));
        }
        Some(matrix(node.span, 2, sequence(rows)))
    }

    /// A parameter in a plain list of names.
    fn parameter(&mut self, node: &'a Node) -> Option<Value> {
        match &node.content {
            Content::Scalar(name) => Some(entry(name, node.span, Value::Null)),
            _ => self.refuse(node, &Shape::Text),
        }
    }

    fn number(&mut self, text: &str, span: Span) -> Option<Value> {
        let number = self.diagnostics.keep(Decimal::parse(text, span))?;
        Some(spanned(number.text(), span))
    }

    fn choice(&mut self, words: &[&'static str], text: &str, span: Span) -> Option<Value> {
        if words.contains(&text) {
            return Some(spanned(text, span));
        }
        let message = format!("{} is none of the choices", quoted(text));
        let choices = listed(words.iter().copied());
        let diagnostic = Diagnostic::error(Code::WrongChoice, span, message);
        self.diagnostics.push(match nearest(text, words.iter().copied()) {
            Some(near) => diagnostic.suggest(Some(near)).note(format!("the choices are {choices}")),
            None => diagnostic.help(format!("write one of {choices}")),
        });
        None
    }

    /// A map with known keys; `span` is the span of a missing one.
    fn record(&mut self, entries: &'a [(tree::Key, Node)], keys: &'static [Key], span: Span) -> Value {
        let mut fields = Mapping::new();
        let class = entries.iter().map(|(name, _)| name).find(|name| {
            let key = keys.iter().find(|key| key.name == name.text);
            key.is_some_and(|key| key.role == Role::Class)
        });
        for (name, node) in entries {
            let Some(key) = keys.iter().find(|key| key.name == name.text) else {
                self.diagnostics.push_with(|| unknown_key(&name.text, name.span, keys));
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
            } else if let Some(value) = self.fit(node, &key.shape) {
                fields.insert(key.name.into(), value);
            }
        }
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
        Value::Mapping(fields)
    }

    /// Reports a value of the wrong shape: there is nothing, or a stand-in for a formula, so that the entry it belongs
    /// to is not missing as well.
    fn refuse(&mut self, node: &Node, shape: &Shape) -> Option<Value> {
        let stand_in = matches!(shape, Shape::Formula | Shape::FormulaOr(_)).then(|| spanned("0", node.span));
        let found = match &node.content {
            Content::Null => "nothing".to_owned(),
            Content::Scalar(text) => quoted(text),
            Content::List(_) => "a list".to_owned(),
            Content::Map(_) => "a map".to_owned(),
            Content::Broken => return stand_in,
        };
        let message = format!("expected {}, found {found}", describe(shape));
        let help = if stand_in.is_some() && is_course(node) {
            course(self.key, self.entry)
        } else {
            let is_plain = matches!(shape, Shape::List(Shape::Text | Shape::Number | Shape::Formula));
            let written = is_plain.then(|| as_list(self.key, node)).flatten();
            format!("write {}", written.unwrap_or_else(|| format!("for example `{}`", self.example)))
        };
        self.diagnostics.push(Diagnostic::error(Code::WrongShape, node.span, message).help(help));
        stand_in
    }
}

/// A replacement for a map from numbers to values, which is a course in time or a table.
fn course(key: &str, entry: Option<&str>) -> String {
    match (key, entry) {
        ("control", Some(input)) => format!(
            "give the course a name of its own and set the input to it: `signals: {{{input}_t: {{0: 0, 0.1: 1}}}}` and \
             `control: {{{input}: {input}_t}}`"
        ),
        ("initial", _) => "write a number: the values of a signal over time stand in `signals`, those of a parameter or of a \
                           constant state in `plant`"
            .to_owned(),
        _ => "a table has a name: `define: {ocv: {table: soc, points: [[0, 3.0], [1, 4.2]]}}`; what changes over time is an \
              input, whose course stands in `signals` of the section `simulation`"
            .to_owned(),
    }
}

/// The longest text that is written again in a message.
const SHORT: usize = 60;

/// A value as the list that its author meant; none if that is not known.
fn as_list(key: &str, node: &Node) -> Option<String> {
    let list = match &node.content {
        Content::Scalar(text) if text.contains('(') && text.contains(',') => format!("\"{text}\""),
        Content::Scalar(text) => text.clone(),
        Content::Map(entries) => entries.iter().map(|(key, _)| key.text.as_str()).collect::<Vec<_>>().join(", "),
        Content::Null | Content::List(_) | Content::Broken => return None,
    };
    let is_line =
        !list.is_empty() && list.len() <= SHORT && list.chars().all(|c| !c.is_control() && !"[]{}\\`".contains(c));
    is_line.then(|| format!("`{key}: [{list}]`"))
}

/// Tests whether the keys are numbers, as start times are.
fn is_course(node: &Node) -> bool {
    let Content::Map(entries) = &node.content else { return false };
    !entries.is_empty() && entries.iter().all(|(key, _)| key.text.parse::<f64>().is_ok())
}

fn describe(shape: &Shape) -> String {
    match shape {
        Shape::Text => "a text".to_owned(),
        Shape::Number => "a number".to_owned(),
        Shape::Formula => "a formula".to_owned(),
        Shape::Choice(words) => format!("one of {}", listed(words.iter().copied())),
        Shape::List(item) => format!("a list of {}", plural(item)),
        Shape::OneOrMore(item) => format!("{} or a list of {}", describe(item), plural(item)),
        Shape::Map(value) | Shape::Kinds(_, value) => format!("a map from names to {}", plural(value)),
        Shape::AllOrEach => "a number, or a map from names to numbers".to_owned(),
        Shape::Parameters => "a map from names to numbers, or a list of names".to_owned(),
        Shape::Signal => "a formula, or a map from start times to formulas".to_owned(),
        Shape::Record(keys) => {
            format!("a map with keys of {}", listed(keys.iter().map(|key| key.name)))
        }
        Shape::NumberOr(keys) => {
            format!("a number, or a map with keys of {}", listed(keys.iter().map(|key| key.name)))
        }
        Shape::FormulaOr(keys) => {
            format!("a formula, or a map with keys of {}", listed(keys.iter().map(|key| key.name)))
        }
        Shape::Matrix => "a matrix, as a list of rows".to_owned(),
    }
}

fn plural(shape: &Shape) -> &'static str {
    match shape {
        Shape::Text => "names",
        Shape::Number => "numbers",
        Shape::Formula | Shape::FormulaOr(_) => "formulas",
        Shape::Record(_) => "maps",
        _ => "values",
    }
}

fn unknown_key(name: &str, span: Span, keys: &'static [Key]) -> Diagnostic {
    let names = || keys.iter().map(|key| key.name);
    let valid = format!("valid keys here are {}", listed(names()));
    let message = format!("unknown key {}", quoted(name));
    let diagnostic = Diagnostic::error(Code::UnknownKey, span, message);
    let other =
        OTHERS.iter().find(|(other, key)| name.eq_ignore_ascii_case(other) && names().any(|known| known == *key));
    if let Some(near) = other.map(|(_, key)| *key).or_else(|| nearest(name, names())) {
        return diagnostic.suggest(Some(near)).note(valid);
    }
    if let Some(help) = of_class(name, keys) {
        return diagnostic.help(help).note(valid);
    }
    // A key of a section one level too high, or in another section.
    let section = MODEL.iter().find(|section| match &section.shape {
        Shape::Record(inner) => section.role != Role::Class && inner.iter().any(|key| key.name == name),
        _ => false,
    });
    match section {
        Some(section) => diagnostic.help(format!("write it under `{}`", section.name)).note(valid),
        None => diagnostic.help(valid),
    }
}

/// A replacement for a matrix that a class does not have.
fn of_class(name: &str, keys: &'static [Key]) -> Option<&'static str> {
    let has = |key: &str| keys.iter().any(|known| known.name == key);
    match name {
        "A" | "B" | "C" if has("A11") => Some(
            "the matrices are those of x' = A11 x + A12 y + B1 u, y' = A21 x + A22 y + B2 u; for y = C x write f_x and g_y",
        ),
        "D" | "R" | "B" | "friction" | "damping" if has("M") && has("G") => {
            Some("a mechanical plant has no friction: with friction, write f_x and f_y")
        }
        _ => None,
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

/// A key that the class gives, or a second class.
fn in_class(name: &tree::Key, class: &tree::Key) -> Diagnostic {
    let message = format!("`{}` cannot stand beside the class `{}`", name.text, class.text);
    Diagnostic::error(Code::ClassConflict, name.span, message)
        .also(class.span, "this class gives the equations of the plant and its transform")
        .help(format!("remove `{}`, or `{}` and write f_x, f_y and phi", name.text, class.text))
}

fn is_empty(node: &Node) -> bool {
    match &node.content {
        Content::List(items) => items.is_empty(),
        Content::Map(entries) => entries.is_empty(),
        _ => false,
    }
}

/// The items that are there.
fn sequence(items: impl IntoIterator<Item = Option<Value>>) -> Value {
    Value::Sequence(items.into_iter().flatten().collect())
}

fn spanned(text: &str, span: Span) -> Value {
    fields([("value", text.into()), ("span", span_value(span))])
}

fn span_value(span: Span) -> Value {
    fields([("start", span.start.into()), ("end", span.end.into())])
}

fn entry(name: &str, span: Span, value: Value) -> Value {
    fields([("name", spanned(name, span)), ("value", value)])
}

/// Rows of formulas, with the depth of the lists that they were written in.
fn matrix(span: Span, depth: u64, rows: Value) -> Value {
    fields([("span", span_value(span)), ("depth", depth.into()), ("rows", rows)])
}

fn piece(from: Value, formula: Value) -> Value {
    fields([("from", from), ("formula", formula)])
}

fn fields<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Mapping(entries.into_iter().map(|(key, value)| (key.into(), value)).collect())
}
