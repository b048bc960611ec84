//! Parts of pages from the tables of the generator: keys, functions, estimators, diagnostics.

use std::fmt::Write as _;

use pebo_cas::graph::function::{Conditions, Function, FunctionRow};
use pebo_cas::{Arena, Expr};
use pebo_gen::model::{Estimator, json_schema};
use pebo_gen::source::Code;
use serde_yaml::Value;

use super::page::{held, manual, updates};

/// The text of the part of this name.
fn written(name: &str) -> Option<String> {
    match name.split_once(' ') {
        None if name == "functions" => Some(functions()),
        None if name == "estimators" => Some(estimators()),
        None if name == "diagnostics" => Some(diagnostics()),
        None if name == "keys" => keys(""),
        Some(("keys", path)) => keys(path),
        _ => None,
    }
}

/// The schema that editors get, with its keys in their order: JSON is YAML, whose reader keeps it.
fn schema() -> Value {
    serde_yaml::from_str(&json_schema()).expect("a schema")
}

/// The keys below a path, as `simulation/baselines/kalman`.
fn keys(path: &str) -> Option<String> {
    let schema = schema();
    let node = path.split('/').filter(|part| !part.is_empty()).try_fold(&schema, |node, part| below(node, part))?;
    let by_class = &schema["dependentSchemas"]["lti"]["properties"];
    let mut table = "| key | value | what it is | example |\n|---|---|---|---|\n".to_owned();
    // Or of one of several shapes.
    let shapes = node["anyOf"].as_sequence().into_iter().flatten();
    let node = shapes.chain([node]).find(|shape| shape["properties"].is_mapping())?;
    for (key, value) in node["properties"].as_mapping()? {
        let key = key.as_str()?;
        let listed =
            node["required"].as_sequence().is_some_and(|all| all.iter().any(|name| name.as_str() == Some(key)));
        // Required unless a class is there, and given by a class.
        let or_class = path.is_empty() && schema["anyOf"][0]["required"][0].as_str() == Some(key);
        let barred = path.is_empty() && by_class.get(key).is_some() && value["properties"].is_null();
        let needed = match (listed, or_class, barred) {
            (true, ..) => " (needed)",
            (_, true, _) => " (needed, or a class)",
            (_, _, true) => " (not with a class)",
            _ => "",
        };
        let about = value["description"].as_str().unwrap_or_default();
        let example = value["examples"].get(0).map(|example| format!("`{key}: {}`", flow(example))).unwrap_or_default();
        writeln!(table, "| `{key}`{needed} | {} | {} | {} |", kind(value), cell(about), cell(&example)).ok()?;
    }
    Some(table)
}

/// The schema below a key: its own, or that of the entries of a list or of a map of any names.
fn below<'a>(node: &'a Value, key: &str) -> Option<&'a Value> {
    match key {
        "*" => node.get("items").or(node.get("additionalProperties")),
        _ => node["properties"].get(key),
    }
}

/// The kind of value, in words.
fn kind(value: &Value) -> String {
    if let Some(choices) = value["enum"].as_sequence() {
        let names = choices.iter().map(|choice| format!("`{}`", choice.as_str().unwrap_or_default()));
        return names.collect::<Vec<_>>().join(", ");
    }
    if let Some(any) = value["anyOf"].as_sequence() {
        let mut kinds: Vec<String> = any.iter().map(kind).collect();
        kinds.dedup();
        return kinds.join(" or ");
    }
    let first = value["type"].as_str().or_else(|| value["type"][0].as_str()).unwrap_or_default();
    match first {
        "array" if kind(&value["items"]) == "number" => "list of numbers".to_owned(),
        "array" => "list".to_owned(),
        "object" if value["additionalProperties"].is_mapping() => "map".to_owned(),
        "object" => "section".to_owned(),
        "string" => "text".to_owned(),
        other => other.to_owned(),
    }
}

/// A value on one line, as a model file may have it.
fn flow(value: &Value) -> String {
    match value {
        Value::Sequence(items) => format!("[{}]", items.iter().map(flow).collect::<Vec<_>>().join(", ")),
        Value::Mapping(map) => {
            let entries = map.iter().map(|(key, value)| format!("{}: {}", flow(key), flow(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        Value::String(text) => text.clone(),
        // As a person writes it: 1e-6, and 12 rather than 12.0.
        Value::Number(number) => number.as_f64().map_or_else(String::new, |number| {
            let short = number == 0.0 || (1e-3..1e5).contains(&number.abs());
            if short { number.to_string() } else { format!("{number:e}") }
        }),
        Value::Bool(value) => value.to_string(),
        Value::Null | Value::Tagged(_) => String::new(),
    }
}

/// In a table a bar would begin the next cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// The functions of formulas.
fn functions() -> String {
    let mut table =
        "| function | also | in emitted code | has a value where | derivative |\n|---|---|---|---|---|\n".to_owned();
    for row in Function::table() {
        let arena = Arena::new();
        let names = &["a", "b"][..row.arity];
        let arguments: Vec<Expr> = names.iter().map(|name| arena.variable(name)).collect();
        let list = |names: &[&str]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let derivative = (row.derivative)(&arena, &arguments);
        let derivative: Vec<String> = derivative.into_iter().map(|d| format!("`{}`", arena.print(d))).collect();
        writeln!(
            table,
            "| `{}({})` | {} | `Real::{}` | {} | {} |",
            row.name,
            names.join(", "),
            list(row.aliases),
            row.rust,
            everywhere(&arena, (row.conditions)(&arena, &arguments)),
            with_smooth(row, &arena, &arguments, &derivative.join(", ")),
        )
        .expect("a string");
    }
    table
}

/// The domain conditions of a value.
fn everywhere(arena: &Arena, asks: Conditions) -> String {
    if asks.is_empty() { "everywhere".to_owned() } else { conditions(arena, asks) }
}

fn conditions(arena: &Arena, asks: Conditions) -> String {
    let each = asks.into_iter().map(|(expr, relation)| format!("`{} {}`", arena.print(expr), relation.sign()));
    each.collect::<Vec<_>>().join(", ")
}

/// The derivative, with its conditions beyond those of the value.
fn with_smooth(row: &FunctionRow, arena: &Arena, arguments: &[Expr], derivative: &str) -> String {
    match row.smooth {
        Some(smooth) => format!("{derivative} where {}", conditions(arena, smooth(arena, arguments))),
        None => derivative.to_owned(),
    }
}

/// The estimators with their settings.
fn estimators() -> String {
    let mut table = "| `estimator` | needs | may have |\n|---|---|---|\n".to_owned();
    let list = |keys: &[&str]| keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    for estimator in Estimator::ALL {
        writeln!(table, "| `{}` | {} | {} |", estimator.name(), list(estimator.needs()), list(estimator.admits()))
            .expect("a string");
    }
    table
}

/// The output of `pebo-gen explain` for each code.
fn diagnostics() -> String {
    let mut text = String::new();
    for code in Code::ALL {
        let example = code.example().trim_end();
        let language = match example {
            command if command.starts_with("$ ") => "console",
            module if module.starts_with("#[pebo_model]") => "rust",
            _ => "yaml",
        };
        let paper = code.paper().map_or_else(String::new, |place| format!("In Ortega et al. 2015: {place}.\n\n"));
        let title = code.title();
        let explanation = wrapped(code.explanation());
        write!(text, "\n## `{}`\n\n*{title}*\n\n{explanation}\n\n{paper}```{language}\n{example}\n```\n", code.name())
            .expect("a string");
    }
    text.push('\n');
    text
}

/// In lines of at most 120 columns.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut width = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if width > 0 {
            let fits = width + 1 + length <= 120;
            lines.push(if fits { ' ' } else { '\n' });
            width = if fits { width + 1 } else { 0 };
        }
        lines.push_str(word);
        width += length;
    }
    lines
}

#[test]
fn generated_parts_are_up_to_date() {
    let _held = held();
    let mut found = 0;
    for mut page in manual() {
        for (name, range) in page.generated().into_iter().rev() {
            let text = written(&name).unwrap_or_else(|| panic!("{}: nothing is named `{name}`", page.path.display()));
            found += 1;
            if updates() {
                page.text.replace_range(range, &text);
            } else {
                let stale = "stale: UPDATE_DOCS=1 cargo test -p pebo-gen --test manual";
                assert!(page.text[range] == text, "{}: {name} is {stale}\n{text}", page.path.display());
            }
        }
        if updates() {
            std::fs::write(&page.path, &page.text).expect("a page");
        }
    }
    assert!(found > 0);
}

#[test]
fn every_key_is_in_the_manual() {
    let _held = held();
    let mut shown = String::new();
    for page in manual() {
        for (name, range) in page.generated() {
            if name.starts_with("keys") {
                shown.push_str(&page.text[range]);
            }
        }
    }
    let schema = schema();
    let mut missing = Vec::new();
    missing_keys(&schema, &shown, &mut missing);
    assert!(missing.is_empty(), "{missing:?}");
}

/// The keys with a description that is in no table.
fn missing_keys(node: &Value, shown: &str, missing: &mut Vec<String>) {
    if let Some(keys) = node["properties"].as_mapping() {
        for (key, value) in keys {
            if let Some(about) = value["description"].as_str() {
                let key = key.as_str().unwrap_or_default();
                if !shown.contains(&format!("| `{key}`")) || !shown.contains(&cell(about)) {
                    missing.push(key.to_owned());
                }
            }
            missing_keys(value, shown, missing);
        }
    }
    for inner in ["items", "additionalProperties"] {
        if node[inner].is_mapping() {
            missing_keys(&node[inner], shown, missing);
        }
    }
}
