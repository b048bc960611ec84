//! The table of keys as a JSON schema, for editors that complete and check model files.
//!
//! In: the table of keys, by which the reader checks files. Out: JSON schema, draft 2020-12. It describes keys and
//! the shapes of values; the reader checks formulas and names.

use indexmap::IndexMap;
use serde::Serialize;
use serde_json::Value;

use super::document::FILE;
use super::key::{Key, Role, Shape};

/// A schema; an absent field admits everything.
#[derive(Serialize, Default)]
struct Node {
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    dialect: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<&'static str>,
    #[serde(rename = "type", skip_serializing_if = "<[_]>::is_empty")]
    kinds: &'static [&'static str],
    #[serde(rename = "enum", skip_serializing_if = "<[_]>::is_empty")]
    choices: &'static [&'static str],
    #[serde(skip_serializing_if = "Option::is_none")]
    items: Option<Box<Self>>,
    #[serde(rename = "minItems", skip_serializing_if = "Option::is_none")]
    least_items: Option<u32>,
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    properties: IndexMap<&'static str, Admission>,
    #[serde(rename = "minProperties", skip_serializing_if = "Option::is_none")]
    least_properties: Option<u32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    required: Vec<&'static str>,
    #[serde(rename = "additionalProperties", skip_serializing_if = "Option::is_none")]
    others: Option<Box<Admission>>,
    #[serde(rename = "anyOf", skip_serializing_if = "Vec::is_empty")]
    any: Vec<Self>,
    #[serde(rename = "dependentSchemas", skip_serializing_if = "IndexMap::is_empty")]
    dependent: IndexMap<&'static str, Self>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    examples: Vec<Value>,
}

/// A schema, or none of the values.
#[derive(Serialize)]
#[serde(untagged)]
enum Admission {
    By(Box<Node>),
    Never(bool),
}

impl Admission {
    const NEVER: Self = Self::Never(false);

    fn by(node: Node) -> Self {
        Self::By(Box::new(node))
    }
}

/// The schema of a model file, as text.
pub(super) fn text() -> String {
    let mut model = record(FILE);
    model.dialect = Some("https://json-schema.org/draft/2020-12/schema");
    model.title = Some("A model file of pebo-gen");
    let classes: Vec<&Key> = FILE.iter().filter(|key| key.role == Role::Class).collect();
    // A class excludes the keys that it gives, and other classes.
    let given = |class: &Key| {
        let barred = FILE.iter().filter(|key| match key.role {
            Role::Class => key.name != class.name,
            Role::RequiredOrByClass | Role::OptionalOrByClass | Role::SearchedOrByClass => true,
            Role::Required | Role::Optional => false,
        });
        Node { properties: barred.map(|key| (key.name, Admission::NEVER)).collect(), ..Node::default() }
    };
    model.dependent = classes.iter().map(|class| (class.name, given(class))).collect();
    // Without a class these keys are required.
    let by_hand = FILE.iter().filter(|key| key.role == Role::RequiredOrByClass).map(|key| key.name).collect();
    let alternatives = std::iter::once(by_hand).chain(classes.iter().map(|class| vec![class.name]));
    model.any = alternatives.map(|required| Node { required, ..Node::default() }).collect();
    let mut text = serde_json::to_string_pretty(&model).unwrap_or_default();
    text.push('\n');
    text
}

fn record(keys: &[Key]) -> Node {
    let required = keys.iter().filter(|key| key.role == Role::Required).map(|key| key.name);
    Node {
        kinds: &["object"],
        properties: keys.iter().map(|key| (key.name, Admission::by(value(key)))).collect(),
        required: required.collect(),
        others: Some(Box::new(Admission::NEVER)),
        ..Node::default()
    }
}

/// The schema of a key's value.
fn value(key: &Key) -> Node {
    let mut node = shape(&key.shape);
    node.description = Some(key.about);
    node.examples = example(key).into_iter().collect();
    if key.role.is_filled() {
        match key.shape {
            Shape::List(_) => node.least_items = Some(1),
            Shape::Map(_) => node.least_properties = Some(1),
            _ => {}
        }
    }
    node
}

/// The example of a key, `key: value`, as JSON.
fn example(key: &Key) -> Option<Value> {
    let (_, text) = key.example.split_once(':')?;
    serde_yaml::from_str(text).ok()
}

fn shape(shape: &Shape) -> Node {
    match shape {
        // YAML reads some of the texts as numbers; the reader takes the written text.
        Shape::Text | Shape::Formula => Node { kinds: &["string", "number", "boolean"], ..Node::default() },
        Shape::Number => Node { kinds: &["number", "string"], ..Node::default() },
        Shape::Choice(choices) => Node { choices, ..Node::default() },
        Shape::List(item) => list(self::shape(item)),
        Shape::OneOrMore(item) => either([self::shape(item), list(self::shape(item))]),
        Shape::Map(value) => map(self::shape(value)),
        Shape::AllOrEach => either([self::shape(&Shape::Number), map(self::shape(&Shape::Number))]),
        Shape::Kinds(keys, other) => Node {
            properties: keys.iter().map(|key| (key.name, Admission::by(value(key)))).collect(),
            ..map(self::shape(other))
        },
        Shape::Parameters => {
            let value = Node { kinds: &["number", "string", "null"], ..Node::default() };
            either([map(value), list(self::shape(&Shape::Text))])
        }
        Shape::Signal => either([self::shape(&Shape::Formula), map(self::shape(&Shape::Formula))]),
        Shape::Record(keys) => record(keys),
        Shape::NumberOr(keys) => either([self::shape(&Shape::Number), record(keys)]),
        Shape::FormulaOr(keys) => either([self::shape(&Shape::Formula), record(keys)]),
        Shape::Matrix => {
            let row = || Node { least_items: Some(1), ..list(self::shape(&Shape::Formula)) };
            either([self::shape(&Shape::Formula), row(), Node { least_items: Some(1), ..list(row()) }])
        }
    }
}

fn list(item: Node) -> Node {
    Node { kinds: &["array"], items: Some(Box::new(item)), ..Node::default() }
}

/// A map from names.
fn map(value: Node) -> Node {
    Node { kinds: &["object"], others: Some(Box::new(Admission::by(value))), ..Node::default() }
}

fn either<const N: usize>(any: [Node; N]) -> Node {
    Node { any: any.into(), ..Node::default() }
}
