//! Random cranes contain every form of the language, or the reason why not stands here.

use std::collections::BTreeSet;

use crane_combinations::crane::crane;
use serde_json::Value;

/// A key of a type of the schema, or a word that it may be.
type Form = (String, String);

/// Seeds that together contain every form.
const SEEDS: std::ops::Range<u64> = 700..940;

/// Forms that no random crane has, and why: a type and one of its keys or words, or `*` for all of them.
const LEFT_OUT: [(&str, &str, &str); 16] = [
    ("Analysis", "*", "every check derives what it needs"),
    ("crane", "analyses", "every check derives what it needs"),
    ("Combination", "*", "the check of combinations adds them"),
    ("Preset", "*", "the check of combinations adds one, and a test of the compiler all"),
    ("Hoisting", "*", "the check of combinations adds it"),
    ("HoistingClass", "*", "the check of combinations adds one, and a test of the compiler all"),
    ("crane", "combinations", "the check of combinations adds them"),
    ("crane", "combination", "the check of combinations adds it"),
    ("crane", "events", "the check of events adds them"),
    ("Event", "*", "the check of events adds them"),
    ("Condition", "*", "the check of events adds them"),
    ("Joins", "*", "momentum that joins has closed forms of its own"),
    ("crane", "extends", "each crane is one text; changes of cranes extend it"),
    ("PinAxis", "to_axis", "written by the second description of a turned boom"),
    ("Table", "file", "a table from a file is read into `times` and `values`; tests of data files compare both"),
    ("Table", "column", "as above"),
];

/// All forms of a part of the schema.
fn expected(schema: &Value, name: &str, found: &mut BTreeSet<Form>) {
    for form in ["anyOf", "oneOf"].iter().flat_map(|forms| schema[forms].as_array().into_iter().flatten()) {
        expected(form, name, found);
    }
    for word in schema["enum"].as_array().into_iter().flatten().chain(schema.get("const")).filter_map(Value::as_str) {
        found.insert((name.to_owned(), word.to_owned()));
    }
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        found.insert((name.to_owned(), key.clone()));
        expected(inner, &format!("{name}.{key}"), found);
    }
    for inner in ["items", "additionalProperties"].iter().filter_map(|inner| schema.get(inner)) {
        expected(inner, &format!("{name}.*"), found);
    }
}

/// The forms of a value.
fn written(whole: &Value, schema: &Value, value: &Value, name: &str, found: &mut BTreeSet<Form>) {
    if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
        return written(whole, &whole["$defs"][name], value, name, found);
    }
    for form in ["anyOf", "oneOf"].iter().flat_map(|forms| schema[forms].as_array().into_iter().flatten()) {
        written(whole, form, value, name, found);
    }
    match value {
        Value::String(word) => {
            let words = schema["enum"].as_array().into_iter().flatten().chain(schema.get("const"));
            found.extend(words.filter(|known| *known == word).map(|_| (name.to_owned(), word.clone())));
        }
        Value::Object(entries) => {
            for (key, inner) in entries {
                if let Some(form) = schema["properties"].get(key) {
                    found.insert((name.to_owned(), key.clone()));
                    written(whole, form, inner, &format!("{name}.{key}"), found);
                } else if schema["additionalProperties"].is_object() {
                    written(whole, &schema["additionalProperties"], inner, &format!("{name}.*"), found);
                }
            }
        }
        Value::Array(items) => {
            for item in items {
                written(whole, &schema["items"], item, &format!("{name}.*"), found);
            }
        }
        _ => (),
    }
}

#[test]
fn random_cranes_have_every_form_of_the_language() {
    let schema: Value = serde_json::from_str(&crane_codegen::json_schema()).expect("JSON");
    let mut wanted = BTreeSet::new();
    expected(&schema, "crane", &mut wanted);
    for (name, definition) in schema["$defs"].as_object().expect("definitions") {
        expected(definition, name, &mut wanted);
    }
    let mut found = BTreeSet::new();
    for seed in SEEDS {
        written(&schema, &schema, &crane(seed).tree, "crane", &mut found);
    }
    let left_out = |(name, form): &Form| LEFT_OUT.iter().any(|(of, one, _)| of == name && (*one == "*" || one == form));
    let missing: Vec<&Form> = wanted.difference(&found).filter(|form| !left_out(form)).collect();
    assert!(missing.is_empty(), "no random crane has {missing:#?}");
    let idle = |(of, one, _): &&(&str, &str, &str)| {
        !wanted.difference(&found).any(|(name, form)| of == name && (*one == "*" || one == form))
    };
    let there: Vec<_> = LEFT_OUT.iter().filter(idle).collect();
    assert!(there.is_empty(), "some random crane has {there:?}");
}
