//! docs/SPEC.md describes every key, docs/messages.md every rule; specs in the documentation are valid.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crane_codegen::diagnostic::CATALOGUE;
use crane_codegen::{SourceFile, json_schema, read, validate};
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn page(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).expect(path)
}

/// All pages of the documentation, and their text.
fn pages() -> Vec<(PathBuf, String)> {
    let folders = [".", "docs", "docs/manual"].map(|folder| std::fs::read_dir(root().join(folder)).expect("a folder"));
    let files = folders.into_iter().flatten().map(|entry| entry.expect("an entry").path());
    let pages = files.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.map(|path| (path.clone(), std::fs::read_to_string(path).expect("a page"))).collect()
}

/// Keys of mappings and words of choices in a schema.
fn collect_words(schema: &Value, words: &mut BTreeSet<String>) {
    match schema {
        Value::Object(object) => {
            if let Some(Value::Object(properties)) = object.get("properties") {
                words.extend(properties.keys().cloned());
            }
            words.extend(object.get("const").and_then(Value::as_str).map(Into::into));
            let choices = object.get("enum").and_then(Value::as_array).into_iter().flatten();
            words.extend(choices.filter_map(Value::as_str).map(Into::into));
            object.values().for_each(|inner| collect_words(inner, words));
        }
        Value::Array(items) => items.iter().for_each(|inner| collect_words(inner, words)),
        _ => {}
    }
}

#[test]
fn every_key_is_documented() {
    let (page, mut words) = (page("docs/SPEC.md"), BTreeSet::new());
    collect_words(&serde_json::from_str(&json_schema()).expect("JSON"), &mut words);
    assert!(words.len() > 90, "the schema was searched: {}", words.len());
    // The words in code spans.
    let code: BTreeSet<&str> = page
        .split('`')
        .skip(1)
        .step_by(2)
        .flat_map(|code| code.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .collect();
    let missing: Vec<_> = words.iter().filter(|word| !code.contains(word.as_str())).collect();
    assert!(missing.is_empty(), "docs/SPEC.md does not describe {missing:?}");
}

/// The table of units is that of the program, with the SI unit of a symbol's own dimension first.
#[test]
fn every_unit_is_documented() {
    let spec = include_str!("../../../docs/SPEC.md");
    let section = spec.split("### Units").nth(1).expect("a section").split("\n## ").next().expect("its text");
    let rows = section.lines().filter(|line| line.starts_with("| ")).skip(1);
    let told: Vec<&str> = rows.flat_map(|row| row.split('`').skip(1).step_by(2)).collect();
    let known: Vec<&str> = crane_codegen::units::TABLE.iter().map(|symbol| symbol.text).collect();
    assert_eq!(told, known);
}

#[test]
fn every_rule_is_documented() {
    let page = page("docs/messages.md");
    for rule in CATALOGUE {
        let row = format!("| {} | {} |", rule.code, rule.about.trim());
        assert!(page.contains(&row), "docs/messages.md lacks the row\n{row}");
    }
    let rows = ["\n| E0", "\n| E1", "\n| W0"].map(|row| page.matches(row).count());
    assert_eq!(rows.iter().sum::<usize>(), CATALOGUE.len(), "rows of rules that are gone");
}

#[test]
fn the_example_is_a_crane() {
    let page = page("docs/SPEC.md");
    let (_, rest) = page.split_once("```yaml\n").expect("an example");
    let (example, _) = rest.split_once("```").expect("its end");
    let source = SourceFile::new("docs/SPEC.md", example);
    let chain =
        read(&source).and_then(|spec| validate(&spec, &source)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    // Six of the base, two of joints, three of each of three sections, two of the chain.
    assert_eq!(chain.coordinates.len(), 6 + 2 + 3 * 4 + 2);
}

#[test]
fn what_the_schema_requires_the_reader_requires() {
    // Every mapping of the language, empty: the reader asks for each key that the schema requires of it.
    let schema: Value = serde_json::from_str(&json_schema()).expect("JSON");
    let empty = "links: [{}]\nparameters: {a: {}}\nmaterials: {m: {}}\nsupports: [{}]\ndrives: [{}]\npoints: [{}]\n\
                 stops: {a_x: {}}\nfriction: {a_x: {}}\n";
    let source = SourceFile::new("empty.yaml", empty);
    let found = read(&source).and_then(|spec| validate(&spec, &source)).expect_err("nothing in it").to_string();
    // The first alternative is a complete spec; one that extends another requires fewer keys.
    let top = &schema["anyOf"][0]["required"];
    let definitions = ["Link", "Parameter", "Material", "Support", "Drive", "Point", "Stops", "Friction"]
        .map(|name| &schema["$defs"][name]["required"]);
    let mut required = 0;
    for key in [top].into_iter().chain(definitions).flat_map(|keys| keys.as_array().into_iter().flatten()) {
        let key = key.as_str().expect("a key");
        assert!(key == "links" || found.contains(&format!("lacks `{key}`")), "{key} is not asked for:\n{found}");
        required += 1;
    }
    assert_eq!(found.matches("error[E012]").count(), required - 1, "all but `links`, which are there:\n{found}");
}

#[test]
fn specs_of_the_manual_are_cranes() {
    let mut specs = 0;
    for (path, text) in pages().iter().filter(|(path, _)| path.parent().is_some_and(|p| p.ends_with("manual"))) {
        for block in text.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()) {
            let source = SourceFile::new(path.display().to_string(), block);
            read(&source).and_then(|spec| validate(&spec, &source)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
            specs += 1;
        }
    }
    assert!(specs > 0, "the manual was searched");
}

#[test]
fn every_rule_of_imports_is_documented() {
    let page = page("docs/manual/exchange.md");
    let rules = crane_codegen::exchange::CATALOGUE;
    for rule in rules {
        let row = format!("| {} | {} |", rule.code, rule.about.trim());
        assert!(page.contains(&row), "docs/manual/exchange.md lacks the row\n{row}");
    }
    assert_eq!(page.matches("\n| U0").count(), rules.len(), "rows of rules that are gone");
}
