//! The JSON objects satisfy the committed schemas, and model files the schema of their keys.

use std::path::Path;

use pebo_gen::model::{Model, json_schema};
use pebo_gen::report::{CHECK_SCHEMA, SOLVE_SCHEMA};
use pebo_gen::source::{Code, Source};
use pebo_gen::{Request, answer, solve};
use serde_json::Value;

/// The departures of a value from a schema, for the words of JSON schema that ours use.
fn departures(value: &Value, schema: &Value, at: &str, found: &mut Vec<String>) {
    let mut refuse = |what: &str| found.push(format!("{at}: {what}: {value}"));
    if schema == &Value::Bool(false) {
        return refuse("not admitted here");
    }
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
        Value::Null if schema.get("enum").or(schema.get("anyOf")).is_some() => {}
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
    let fits = |schema: &Value| {
        let mut against = Vec::new();
        departures(value, schema, at, &mut against);
        against.is_empty()
    };
    // The alternatives of a map require keys.
    let has = |keys: &Value| {
        keys.as_array().is_some_and(|keys| keys.iter().all(|key| !value[key.as_str().unwrap()].is_null()))
    };
    let holds = |schema: &Value| if schema.get("type").is_some() { fits(schema) } else { has(&schema["required"]) };
    if schema["anyOf"].as_array().is_some_and(|any| !any.iter().any(holds)) {
        refuse("none of the alternatives");
    }
    for (key, barred) in schema["dependentSchemas"].as_object().into_iter().flatten() {
        for name in barred["properties"].as_object().into_iter().flatten().map(|(name, _)| name) {
            if !value[key].is_null() && !value[name].is_null() {
                found.push(format!("{at}: `{name}` beside `{key}`"));
            }
        }
    }
    if schema["minProperties"]
        .as_u64()
        .is_some_and(|least| value.as_object().is_some_and(|map| (map.len() as u64) < least))
    {
        found.push(format!("{at}: too few entries"));
    }
    if let Some(items) = value.as_array() {
        let count = Some(items.len() as u64);
        if schema["minItems"].as_u64().is_some_and(|least| count < Some(least)) {
            found.push(format!("{at}: too few"));
        }
        if schema["maxItems"].as_u64().is_some_and(|most| count > Some(most)) {
            found.push(format!("{at}: too many"));
        }
        if schema.get("items").is_none() {
            return;
        }
        for (index, item) in items.iter().enumerate() {
            departures(item, &schema["items"], &format!("{at}[{index}]"), found);
        }
    }
    if let Some(fields) = value.as_object().filter(|_| schema.get("type").is_some()) {
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
    against(CHECK_SCHEMA, line)
}

fn against(schema: &str, line: &str) -> Vec<String> {
    let (value, schema) = (serde_json::from_str(line).expect("JSON"), serde_json::from_str(schema).expect("JSON"));
    let mut found = Vec::new();
    departures(&value, &schema, "", &mut found);
    found
}

/// The object of a model.
fn line(source: &Source) -> String {
    answer(source, &Request::new()).report.line()
}

#[test]
fn every_model_satisfies_the_schema() {
    let mut seen = 0;
    for folder in ["../models", "../tests/models"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for path in std::fs::read_dir(folder).expect("models").map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_some_and(|extension| extension == "yaml") {
                let text = std::fs::read_to_string(&path).expect("a model");
                let source = Source::new("model", text).expect("a text");
                assert_eq!(check(&line(&source)), [""; 0], "{}", path.display());
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
    let line = line(&source);
    assert!(line.contains("\"rejected\"") && line.contains("bounds"), "{line}");
    assert_eq!(check(&line), [""; 0]);
    let source = Source::new("model", "model: [").expect("a text");
    assert_eq!(check(&self::line(&source)), [""; 0]);
}

/// A search that finds a transform, one that proves that there is none, one that would find one with other assumptions,
/// and none at all.
#[test]
fn searches_satisfy_the_schema() {
    let plant = |rates: &str| format!("model: m\nx: [a]\ny: [b]\nu: [v]\n{rates}\n");
    let cases = [
        (plant("f_x: {a: v - sin(b)}\nf_y: {b: a}"), r#""verdict":"found""#),
        (plant("f_x: {a: sin(a) + v*a^2}\nf_y: {b: a}"), r#""bound":{"#),
        ("model: [".to_owned(), r#""span":{"#),
    ];
    for (text, part) in cases {
        let line = solve(&Source::new("m", text.as_str()).expect("a text"), None, &Request::new()).report.line();
        assert!(line.contains(part), "{part} in {line}");
        assert_eq!(against(SOLVE_SCHEMA, &line), [""; 0], "{text}");
        assert!(!against(SOLVE_SCHEMA, &line.replacen("\"tried\"", "\"tries\"", 1)).is_empty());
    }
}

/// Both objects have the same diagnostics.
#[test]
fn diagnostics_are_described_alike() {
    let diagnostics = |schema: &str| {
        let schema: Value = serde_json::from_str(schema).expect("JSON");
        schema["properties"]["diagnostics"].clone()
    };
    assert!(diagnostics(CHECK_SCHEMA)["items"]["properties"]["span"].is_object());
    assert_eq!(diagnostics(CHECK_SCHEMA), diagnostics(SOLVE_SCHEMA));
}

#[test]
fn the_check_finds_departures() {
    let source = Source::new("model", "model: [").expect("a text");
    let line = line(&source);
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

fn model_schema() -> Value {
    serde_json::from_str(&json_schema()).expect("JSON")
}

/// The departures of a model file from the schema of its keys.
fn against_model(text: &str) -> Vec<String> {
    let value: Value = serde_yaml::from_str(text).expect("YAML");
    let mut found = Vec::new();
    departures(&value, &model_schema(), "", &mut found);
    found
}

#[test]
fn every_model_file_fits_the_schema_of_its_keys() {
    let mut seen = 0;
    for folder in ["../models", "../models/recordings", "../tests/models", "../tests/cases", "../tests/cases/plants"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for path in std::fs::read_dir(folder).expect("models").map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_some_and(|extension| extension == "yaml") {
                let text = std::fs::read_to_string(&path).expect("a model");
                assert_eq!(against_model(&text), [""; 0], "{}", path.display());
                seen += 1;
            }
        }
    }
    assert!(seen > 40, "{seen}");
}

#[test]
fn the_schema_and_the_reader_refuse_the_same() {
    let plant = "model: m\nx: [a]\ny: [b]\n";
    let by_hand = format!("{plant}f_x: {{a: b}}\nphi: [a]\n");
    let by_class = format!("{plant}lti: {{A11: [[-1]], A21: 2}}\n");
    let without_phi = format!("{plant}f_x: {{a: b}}\n");
    for right in [&by_hand, &by_class, &without_phi] {
        assert_eq!(against_model(right), [""; 0]);
    }
    for wrong in [
        format!("{by_hand}fy: {{b: a}}\n"),
        format!("{by_hand}class: either\n"),
        format!("{by_hand}observer: {{estimator: kalman}}\n"),
        format!("{by_hand}observer: {{gain: [[1]]}}\n"),
        format!("{by_hand}simulation: {{panels: [{{title: a}}]}}\n"),
        format!("{by_class}phi: [a]\n"),
        format!("{by_class}mechanical: {{M: 1, T: 1}}\n"),
        format!("{plant}lti: {{A11: [[-1]]}}\n"),
        by_hand.replace("phi: [a]", "phi: []"),
        by_hand.replace("x: [a]", "x: a"),
        plant.to_owned(),
    ] {
        assert!(!against_model(&wrong).is_empty(), "{wrong}");
        assert!(Model::parse(&Source::new("m", wrong.as_str()).expect("a text")).is_err(), "{wrong}");
    }
}

/// The keys that the reader lists where it finds an unknown one.
fn keys_of_the_reader(model: &str) -> Vec<String> {
    let diagnostics = Model::parse(&Source::new("m", model).expect("a text")).expect_err("an unknown key");
    let unknown = diagnostics.iter().find(|diagnostic| diagnostic.code == Code::UnknownKey).expect(model);
    let said = unknown.notes.iter().map(String::as_str).chain(unknown.help.as_deref());
    let list = said.into_iter().find_map(|line| line.strip_prefix("valid keys here are ")).expect(model);
    let mut keys: Vec<String> =
        list.split(['`', ',', ' ']).filter(|word| !["", "and", "or"].contains(word)).map(str::to_owned).collect();
    keys.sort();
    keys
}

/// Both ways: a key that only one of the two has makes the lists differ.
#[test]
fn the_schema_has_the_keys_of_the_reader() {
    let schema = model_schema();
    let places = [
        ("", "unknown_key: 1"),
        ("/lti", "lti: {unknown_key: 1}"),
        ("/mechanical", "mechanical: {unknown_key: 1}"),
        ("/electromechanical", "electromechanical: {unknown_key: 1}"),
        ("/observer", "observer: {unknown_key: 1}"),
        ("/observer/bounds", "observer: {bounds: {unknown_key: 1}}"),
        ("/observer/within", "observer: {within: {unknown_key: 1}}"),
        ("/simulation", "simulation: {unknown_key: 1}"),
        ("/simulation/baselines/kalman", "simulation: {baselines: {kalman: {unknown_key: 1}}}"),
        ("/simulation/baselines/ekf", "simulation: {baselines: {ekf: {unknown_key: 1}}}"),
        ("/simulation/baselines/luenberger", "simulation: {baselines: {luenberger: {unknown_key: 1}}}"),
        ("/simulation/baselines/*", "simulation: {baselines: {rival: {unknown_key: 1}}}"),
        ("/simulation/panels/0", "simulation: {panels: [{unknown_key: 1}]}"),
    ];
    let mut records = Vec::new();
    collect(&schema, "", &mut records);
    let expected: Vec<&str> = places.iter().map(|place| place.0).collect();
    let mut found: Vec<&str> = records.iter().map(|record| record.0.as_str()).collect();
    found.sort_by_key(|place| expected.iter().position(|known| known == place));
    assert_eq!(found, expected, "every map with keys is looked at");
    for (place, text) in places {
        let (_, keys) = records.iter().find(|record| record.0 == place).expect("found above");
        assert_eq!(keys_of_the_reader(&format!("model: m\n{text}\n")), *keys, "{place}");
    }
}

/// The maps of a schema that have keys and no others, with these, sorted.
fn collect(schema: &Value, place: &str, records: &mut Vec<(String, Vec<String>)>) {
    if let Some(properties) = schema["properties"].as_object() {
        let mut keys: Vec<String> = properties.keys().cloned().collect();
        keys.sort();
        for (key, value) in properties {
            collect(value, &format!("{place}/{key}"), records);
        }
        // With free names, no key is unknown.
        if !schema["additionalProperties"].is_object() {
            records.push((place.to_owned(), keys));
        }
    }
    for (key, inner) in [("*", &schema["additionalProperties"]), ("0", &schema["items"])] {
        if inner.is_object() {
            collect(inner, &format!("{place}/{key}"), records);
        }
    }
}

/// The examples that an editor shows beside a key are accepted.
#[test]
fn the_examples_of_the_schema_fit_it() {
    fn look(schema: &Value, seen: &mut usize) {
        for (key, value) in schema["properties"].as_object().into_iter().flatten() {
            let mut found = Vec::new();
            let examples = value["examples"].as_array().unwrap_or_else(|| panic!("an example of {key}"));
            assert!(!value["description"].as_str().unwrap_or_default().is_empty(), "{key}");
            for example in examples {
                departures(example, value, key, &mut found);
            }
            assert_eq!(found, [""; 0]);
            look(value, seen);
            look(&value["items"], seen);
            look(&value["additionalProperties"], seen);
            *seen += 1;
        }
    }
    let mut seen = 0;
    look(&model_schema(), &mut seen);
    assert!(seen > 60, "{seen}");
}
