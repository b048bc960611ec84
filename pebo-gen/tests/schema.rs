//! The JSON objects are what the committed schema says.

use std::path::Path;

use pebo_gen::report::{self, SCHEMA};
use pebo_gen::source::Source;
use serde_json::Value;

/// What stands against a value; for the words of JSON schema that ours uses.
fn departures(value: &Value, schema: &Value, at: &str, found: &mut Vec<String>) {
    let mut refuse = |what: &str| found.push(format!("{at}: {what}: {value}"));
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_u64() || number.is_i64() => "integer",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let admits = |name: &Value| name == kind || (name == "number" && kind == "integer");
    match &schema["type"] {
        Value::Array(names) if names.iter().any(admits) => {}
        name if admits(name) => {}
        _ => refuse("wrong type"),
    }
    if schema.get("enum").and_then(Value::as_array).is_some_and(|choices| !choices.contains(value)) {
        refuse("none of the choices");
    }
    if schema["minimum"].as_f64().is_some_and(|least| value.as_f64().is_none_or(|number| number < least)) {
        refuse("too small");
    }
    if let Some(items) = value.as_array() {
        let count = Some(items.len() as u64);
        if schema["minItems"].as_u64().is_some_and(|least| count < Some(least)) {
            refuse("too few");
        }
        if schema["maxItems"].as_u64().is_some_and(|most| count > Some(most)) {
            refuse("too many");
        }
        for (index, item) in items.iter().enumerate() {
            departures(item, &schema["items"], &format!("{at}[{index}]"), found);
        }
    }
    if let Some(fields) = value.as_object() {
        for required in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !fields.contains_key(required) {
                found.push(format!("{at}: `{required}` is missing"));
            }
        }
        for (name, field) in fields {
            let place = format!("{at}.{name}");
            match (schema["properties"].get(name), &schema["additionalProperties"]) {
                (None, Value::Bool(false)) => found.push(format!("{place} is not in the schema")),
                (Some(schema), _) | (None, schema) => departures(field, schema, &place, found),
            }
        }
    }
}

fn check(line: &str) -> Vec<String> {
    let (value, schema) = (serde_json::from_str(line).expect("JSON"), serde_json::from_str(SCHEMA).expect("JSON"));
    let mut found = Vec::new();
    departures(&value, &schema, "", &mut found);
    found
}

#[test]
fn every_model_gives_what_the_schema_says() {
    let mut seen = 0;
    for folder in ["../models", "../tests/models"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for path in std::fs::read_dir(folder).expect("models").map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_some_and(|extension| extension == "yaml") {
                let text = std::fs::read_to_string(&path).expect("a model");
                let source = Source::new("model", text).expect("a text");
                let derived = pebo_gen::derive(&source).expect("a model");
                let line = report::check(&derived.plant, &derived.derivation, &source);
                assert_eq!(check(&line), [""; 0], "{}", path.display());
                seen += 1;
            }
        }
    }
    assert!(seen > 15, "{seen}");
}

#[test]
fn refused_and_malformed_models_too() {
    let text = "model: m\nx: [a]\ny: [b]\nf_x: {a: a^2}\nf_y: {b: a}\nphi: [a]\n";
    let source = Source::new("model", text).expect("a text");
    let derived = pebo_gen::derive(&source).expect("a model");
    let line = report::check(&derived.plant, &derived.derivation, &source);
    assert!(line.contains("\"rejected\"") && line.contains("bounds"), "{line}");
    assert_eq!(check(&line), [""; 0]);
    let source = Source::new("model", "model: [").expect("a text");
    let diagnostics = pebo_gen::derive(&source).expect_err("no model");
    assert_eq!(check(&report::malformed("m", &diagnostics, &source)), [""; 0]);
}

#[test]
fn the_check_finds_departures() {
    let source = Source::new("model", "model: [").expect("a text");
    let line = report::malformed("m", &pebo_gen::derive(&source).expect_err("no model"), &source);
    for (from, to) in [
        ("\"schema\":1", "\"schema\":2"),
        ("\"verdict\":\"rejected\"", "\"verdict\":\"no\""),
        ("\"conditions\":[]", "\"conditions\":[1]"),
        ("\"conditions\":[]", "\"condition\":[]"),
        ("\"line\":1", "\"line\":0"),
        ("\"class\":null", "\"class\":7"),
    ] {
        assert!(line.contains(from), "{from} in {line}");
        assert!(!check(&line.replacen(from, to, 1)).is_empty(), "{to}");
    }
}
