//! The wording of what is expected of a value, and of a key that is not known.

use super::key::{Key, Role, Shape};
use super::tree::{self, Content, Node};
use crate::source::{Code, Diagnostic, Span, listed, nearest, quoted};

/// Names of keys in other tools and textbooks, beside the names here.
const OTHERS: &[(&str, &str)] = &[
    ("params", "parameters"),
    ("param", "parameters"),
    ("constants", "parameters"),
    ("p", "parameters"),
    ("state", "x"),
    ("states", "x"),
    ("output", "y"),
    ("outputs", "y"),
    ("measured", "y"),
    ("measurements", "y"),
    ("input", "u"),
    ("inputs", "u"),
    ("controls", "u"),
    ("disturbances", "w"),
    ("name", "model"),
    ("description", "title"),
    ("assumptions", "assume"),
    ("constraints", "assume"),
    ("definitions", "define"),
    ("where", "define"),
    ("dynamics", "f_x"),
    ("equations", "f_x"),
    ("dx", "f_x"),
    ("f", "f_x"),
    ("dy", "f_y"),
    ("g", "g_y"),
    ("h", "g_y"),
    ("transform", "phi"),
    ("z", "phi"),
    ("noise", "sensors"),
    ("measurement_noise", "sensors"),
    ("process_noise", "disturbance"),
    ("dt", "step"),
    ("x0", "initial"),
    ("tend", "duration"),
    ("t_end", "duration"),
];

/// A replacement for a map from numbers to values, which is a course in time or a table.
pub(super) fn course(key: &str, entry: Option<&str>) -> String {
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
pub(super) fn as_list(key: &str, node: &Node) -> Option<String> {
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
pub(super) fn is_course(node: &Node) -> bool {
    let Content::Map(entries) = &node.content else { return false };
    !entries.is_empty() && entries.iter().all(|(key, _)| key.text.parse::<f64>().is_ok())
}

pub(super) fn describe(shape: &Shape) -> String {
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

pub(super) fn unknown_key(name: &str, span: Span, keys: &'static [Key], file: &'static [Key]) -> Diagnostic {
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
    let section = file.iter().find(|section| match &section.shape {
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

/// A key that the class gives, or a second class.
pub(super) fn in_class(name: &tree::Key, class: &tree::Key) -> Diagnostic {
    let message = format!("`{}` cannot stand beside the class `{}`", name.text, class.text);
    Diagnostic::error(Code::ClassConflict, name.span, message)
        .also(class.span, "this class gives the equations of the plant and its transform")
        .help(format!("remove `{}`, or `{}` and write f_x, f_y and phi", name.text, class.text))
}

pub(super) fn is_empty(node: &Node) -> bool {
    match &node.content {
        Content::List(items) => items.is_empty(),
        Content::Map(entries) => entries.is_empty(),
        _ => false,
    }
}
