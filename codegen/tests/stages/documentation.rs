//! docs/SPEC.md describes every key, docs/messages.md every rule; specs in the documentation are valid.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::units::NUMBERS;
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

/// What the schema says of a number, below a property: words of its units, without that of numbers alone.
fn units_of(schema: &Value, definitions: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(entries) => {
            if let Some(unit) = entries.get("x-unit").and_then(Value::as_str) {
                found.extend(words_of_unit(unit));
            }
            // Positions of motions are of what moves.
            match entries.get("$ref").and_then(Value::as_str).map(|path| path.trim_start_matches("#/$defs/")) {
                Some("Motion") => (),
                Some(name) => units_of(&definitions[name], definitions, found),
                None => entries.values().for_each(|inner| units_of(inner, definitions, found)),
            }
        }
        Value::Array(items) => items.iter().for_each(|inner| units_of(inner, definitions, found)),
        _ => (),
    }
}

/// Units in a text: what stands between commas, semicolons, brackets and `or`.
fn words_of_unit(text: &str) -> impl Iterator<Item = String> {
    let text = text.replace(" or ", ",");
    let words: Vec<_> = text.split([',', ';', '(', ')', '`']).map(|word| word.trim().to_owned()).collect();
    words.into_iter().filter(|word| !["", "1", "…", "its own"].contains(&word.as_str()))
}

/// The number of a property, or those of its list or mapping.
fn number_of(property: &Value) -> Option<&Value> {
    let is_number = |one: &&Value| {
        one["$ref"].as_str().is_some_and(|path| NUMBERS.iter().any(|name| path.ends_with(&format!("/{name}"))))
    };
    [property, &property["items"], &property["additionalProperties"]].into_iter().find(is_number)
}

/// A row of a table: the keys in its first cell, the other cells by their headings.
type Row = (Vec<String>, BTreeMap<String, String>);

/// Tables whose first heading begins with some word.
fn tables(page: &str, first: &str) -> Vec<Vec<Row>> {
    let cells = |line: &str| line.split('|').skip(1).map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let blocks = page.split("\n\n").filter(|block| block.starts_with(&format!("| {first}")));
    let rows = |block: &str| {
        let mut lines = block.lines();
        let headings = cells(lines.next().unwrap_or_default());
        let row = |line: &str| {
            let own = cells(line);
            let codes = own[0].split('`').skip(1).step_by(2);
            let keys = codes.filter(|code| code.chars().all(|c| c.is_alphanumeric() || c == '_')).map(str::to_owned);
            (keys.collect(), headings.iter().cloned().zip(own).collect())
        };
        lines.skip(1).map(row).collect()
    };
    blocks.map(rows).collect()
}

/// Units of keys, and limits where they are given, are those of the schema.
#[test]
fn tables_of_keys_agree_with_the_schema() {
    let (page, schema) = (page("docs/SPEC.md"), serde_json::from_str::<Value>(&json_schema()).expect("JSON"));
    let definitions = &schema["$defs"];
    let mappings = definitions.as_object().expect("definitions").values().chain([&schema]);
    let mappings: Vec<&Value> = mappings.map(|one| &one["properties"]).filter(|one| one.is_object()).collect();
    let (mut wrong, mut compared, mut limits) = (Vec::new(), 0, 0);
    let mut compare = |key: &str, property: &Value, text: &str, column: Option<&String>| {
        let (mut all, mut own) = (BTreeSet::new(), BTreeSet::new());
        units_of(property, definitions, &mut all);
        let number = number_of(property);
        own.extend(number.into_iter().flat_map(|one| words_of_unit(one["x-unit"].as_str().unwrap_or_default())));
        let told: BTreeSet<String> = words_of_unit(column.map_or(text, String::as_str)).collect();
        let agrees = match (column, number.is_some()) {
            // A mapping may have a table of its own.
            (Some(_), false) => told.is_empty() || all.is_empty() || told == all,
            (Some(_), true) => told == own,
            // A section says more, or the text does.
            (None, _) => text.contains("](#") || told.is_superset(&own),
        };
        compared += usize::from(!all.is_empty());
        if !agrees {
            wrong.push(format!("`{key}` is in {:?}, not {told:?}", if own.is_empty() { &all } else { &own }));
        }
        let bound = |name: &str| number.unwrap_or(property)[name].as_f64();
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '.').collect::<Vec<_>>();
        for [first, second, third] in words.windows(3).filter_map(|three| <[&str; 3]>::try_from(three).ok()) {
            let holds = match (first, second, third.parse::<f64>()) {
                ("above", "0" | "zero", _) => bound("exclusiveMinimum") == Some(0.0),
                ("1", "to", Ok(most)) if number.is_some() => {
                    (bound("minimum"), bound("maximum")) == (Some(1.0), Some(most))
                }
                _ => continue,
            };
            limits += 1;
            if !holds {
                wrong.push(format!("`{key}`: not {first} {second} in the schema"));
            }
        }
    };
    for rows in tables(&page, "key") {
        // A table may describe a mapping and one in it.
        let mut left: BTreeSet<&String> = rows.iter().flat_map(|(keys, _)| keys).collect();
        while let Some(mapping) =
            mappings.iter().max_by_key(|one| left.iter().filter(|key| one[key.as_str()].is_object()).count())
        {
            let known: BTreeSet<&String> =
                left.iter().copied().filter(|key| mapping[key.as_str()].is_object()).collect();
            assert_eq!(known.is_empty(), left.is_empty(), "keys of no mapping: {left:?}");
            if known.is_empty() {
                break;
            }
            for (key, cells) in rows.iter().flat_map(|(keys, cells)| keys.iter().map(move |key| (key, cells))) {
                if known.contains(key) {
                    compare(key, &mapping[key.as_str()], &cells["meaning"], cells.get("unit"));
                }
            }
            left.retain(|key| !known.contains(key));
        }
    }
    // Laws of connectors: the keys of each are in one cell, each with its unit.
    for (laws, cells) in tables(&page, "[law]").iter().flatten() {
        let choices = definitions["ConnectorLaw"]["oneOf"].as_array().expect("laws").iter();
        let law = choices.map(|one| &one["properties"][laws[0].as_str()]).find(|one| one.is_object()).expect("a law");
        let name = law["$ref"].as_str().expect("a mapping").trim_start_matches("#/$defs/");
        let parts: Vec<&str> = cells["its keys"].split('`').skip(1).collect();
        for part in parts.chunks(2).filter(|part| part.len() == 2) {
            compare(part[0], &definitions[name]["properties"][part[0]], part[1], None);
        }
    }
    assert!(wrong.is_empty(), "docs/SPEC.md: {}", wrong.join("\n"));
    assert!(compared > 120 && limits >= 5, "{compared} units and {limits} limits were found");
}

#[test]
fn every_rule_is_documented() {
    let page = page("docs/messages.md");
    for rule in CATALOGUE {
        let row = format!("| {} | {} |", rule.code, rule.about.trim());
        assert!(page.contains(&row), "docs/messages.md lacks the row\n{row}");
    }
    let rows = ["\n| E0", "\n| E1", "\n| E2", "\n| W0"].map(|row| page.matches(row).count());
    assert_eq!(rows.iter().sum::<usize>(), CATALOGUE.len(), "rows of rules that are gone");
}

#[test]
fn the_example_is_a_crane() {
    let page = page("docs/SPEC.md");
    let (_, rest) = page.split_once("```yaml\n").expect("an example");
    let (example, _) = rest.split_once("```").expect("its end");
    let source = SourceFile::new("docs/SPEC.md", example);
    let chain = read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
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
    let found = read(&source).and_then(|spec| validate(&spec)).expect_err("nothing in it").to_string();
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
            read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
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
