//! Numbers with units: every numeric key of the schema has a dimension, which messages and the schema tell alike.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crane_codegen::chain::Chain;
use crane_codegen::compile::check;
use crane_codegen::{SourceFile, build, json_schema};
use serde_json::{Value, json};

/// A quantity that no key has.
const WRONG: &str = "7 bar s";
/// Forms of the schema that are numbers.
pub const NUMBERS: [&str; 4] = ["Number", "Angle", "Constant", "FixedAngle"];
/// Keys that no spec of the project has, and those of which it has no number without other mistakes. Whether the rest of the crane stands does not matter.
const OTHERS: &str = include_str!("units.yaml");

/// Conditions on results, which are known of whole cranes alone.
const CONDITIONS: &str = "{format: 1, name: conditions, parameters: {log: {value: 10, unit: kg}},
  links: [{name: boom, joint: {prismatic: {axis: z}}, mass: log, com: [0, 0, 0]}],
  events: [{name: up, when: {result: boom_z, above: 1}, set: {log: 30}}, {name: down, when: {result: boom_z, below: 1}, set: {log: 40}}]}";

/// Every motion of everything that follows one: positions, efforts, lengths, factors and inputs.
fn motions() -> String {
    let motions = [
        "hold: 1",
        "quintic: {from: 0, to: 1, duration: 1}",
        "trapezoid: {from: 0, to: 1, duration: 1}",
        "speed: {rate: 1, from: 0}",
        "table: {times: [0, 1], values: [0, 1]}",
    ];
    let list = |row: &dyn Fn(usize, &str) -> String| {
        motions.iter().enumerate().map(|(index, motion)| row(index, motion)).collect::<Vec<_>>().join(", ")
    };
    let links = list(&|i, _| format!("{{name: l{i}, joint: revolute, mass: 9, com: [1, 0, 0]}}"));
    let drives = list(&|i, motion| {
        format!("{{coordinate: l{i}_psi, stiffness: 1e5, motion: {{{motion}}}, effort: {{{motion}}}}}")
    });
    let loads = list(&|i, motion| format!("{{name: f{i}, link: l{i}, force: [1, 0, 0], scale: {{{motion}}}}}"));
    let inputs = list(&|i, motion| format!("i{i}: {{unit: kg, motion: {{{motion}}}}}"));
    let places = "from: {at: [9, 9, 9]}, to: {link: l0, at: [1, 0, 0]}";
    let ropes = list(&|i, motion| {
        format!("{{name: r{i}, {places}, law: {{rope: {{axial_stiffness: 1e6, motion: {{{motion}}}}}}}}}")
    });
    let beam = "{length: 1, sections: 2, material: m, section: {circle: {diameter: 1}}, damping: {beta: {psi: 1, theta: 1, phi: 1}}}";
    format!(
        "{{format: 1, name: motions, materials: {{m: {{E: 2e11, G: 8e10, density: 7850}}}}, links: [{links}, {{name: b, joint: revolute, beam: {beam}}}], \
         drives: [{drives}], loads: [{loads}], inputs: {{{inputs}}}, connectors: [{ropes}]}}"
    )
}

/// The numbers of a spec: their places as JSON pointers, the keys of the schema, and what this says about them.
type Found = Vec<(String, String, Value)>;

struct Walk<'a> {
    schema: &'a Value,
    found: Found,
}

/// The unit of a row: `…` is that of the reference to the mapping to which its key belongs, `…/s` that per second.
fn unit_of(row: &Value, owner: &str) -> String {
    match row["x-unit"].as_str().unwrap_or_default() {
        "…/s" => owner.split(" or ").map(|unit| format!("{unit}/s")).collect::<Vec<_>>().join(" or "),
        unit => unit.replace('…', owner),
    }
}

impl Walk<'_> {
    fn at(&mut self, schema: &Value, value: &Value, place: &str, (key, owner): (&str, &str)) {
        if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
            let unit = unit_of(schema, owner);
            if !NUMBERS.contains(&name) {
                let definition = self.schema["$defs"][name].clone();
                self.at(&definition, value, place, (name, &unit));
            } else if value.is_number() || value.is_string() {
                // A shared type has another unit at every place where it is used.
                let key = if schema["x-unit"] == unit { key.to_owned() } else { format!("{key} in {unit}") };
                self.found.push((place.to_owned(), key, schema.clone()));
                self.found.last_mut().expect("a row").2["x-unit"] = json!(unit);
            }
        }
        for form in ["anyOf", "oneOf"].iter().flat_map(|forms| schema[forms].as_array().into_iter().flatten()) {
            self.at(form, value, place, (key, owner));
        }
        match value {
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.at(&schema["items"], item, &format!("{place}/{index}"), (&format!("{key}.*"), owner));
                }
            }
            Value::Object(entries) => {
                for (name, inner) in entries {
                    let below = [(&schema["properties"][name], name.as_str()), (&schema["additionalProperties"], "*")];
                    for (form, word) in below.into_iter().filter(|(form, _)| form.is_object()) {
                        self.at(form, inner, &format!("{place}/{name}"), (&format!("{key}.{word}"), owner));
                    }
                }
            }
            _ => (),
        }
    }
}

/// All numeric keys of a definition, each with a unit and a text; `owners`: the units that references to it give to those with the unit of their owner.
fn keys(whole: &Value, schema: &Value, (key, about): (&str, bool), owners: &[&str], found: &mut BTreeSet<String>) {
    let about = about || schema["description"].is_string();
    if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
        let units: BTreeSet<String> = owners.iter().map(|owner| unit_of(schema, owner)).collect();
        if NUMBERS.contains(&name) {
            assert!(about && units.iter().all(|unit| !unit.is_empty()) && !units.is_empty(), "{key}: {schema}");
            let is_shared = schema["x-unit"].as_str().is_some_and(|unit| unit.starts_with('…'));
            let of = |unit: &String| if is_shared { format!("{key} in {unit}") } else { key.to_owned() };
            found.extend(units.iter().map(of));
        } else {
            let owners: Vec<&str> = units.iter().map(String::as_str).collect();
            keys(whole, &whole["$defs"][name], (name, false), &owners, found);
        }
    }
    let forms = ["anyOf", "oneOf"].iter().flat_map(|forms| schema[forms].as_array().into_iter().flatten());
    forms.for_each(|form| keys(whole, form, (key, about), owners, found));
    for inner in ["items", "additionalProperties"].iter().filter_map(|inner| schema.get(inner)) {
        keys(whole, inner, (&format!("{key}.*"), about), owners, found);
    }
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        // The word of a choice is described where it is.
        keys(whole, inner, (&format!("{key}.{name}"), about && schema["required"] == json!([name])), owners, found);
    }
}

/// The specs of the project that stand alone, and the keys that they lack.
fn specs() -> Vec<Value> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["../specs", "../specs/examples", "tests/implausible"];
    let mut texts = vec![OTHERS.to_owned(), CONDITIONS.to_owned(), motions()];
    for entry in folders.iter().flat_map(|name| std::fs::read_dir(folder.join(name)).expect("a folder")) {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "yaml") {
            texts.push(std::fs::read_to_string(path).expect("text"));
        }
    }
    texts.sort();
    let read = texts.iter().filter_map(|text| serde_yaml::from_str(text).ok());
    read.filter(|spec: &Value| spec.get("extends").is_none()).collect()
}

/// Messages about a spec with another number at a place, and the texts at which they point.
fn told(spec: &Value, place: &str, number: &Value) -> Vec<(String, String)> {
    let mut spec = spec.clone();
    spec.pointer_mut(place).expect("a place").clone_from(number);
    let text = spec.to_string();
    let source = build::read_with("spec.yaml", text.as_bytes(), &|_| None).expect("a text");
    let Err(mistakes) = check(&source) else { return Vec::new() };
    let of_numbers = ["E031", "E032", "E034", "E035", "E036"];
    let of_numbers = mistakes.mistakes().iter().filter(|mistake| of_numbers.contains(&mistake.code));
    of_numbers.map(|mistake| (mistake.title.clone(), text[mistake.span.start..mistake.span.end].to_owned())).collect()
}

/// A wrong dimension at every numeric key of the schema gets a message at its place, with both units; a number with the unit of the message is right; the
/// schema has this unit; and what is below its limit is refused.
#[test]
fn a_wrong_dimension_is_told_at_every_numeric_key() {
    let schema: Value = serde_json::from_str(&json_schema()).expect("JSON");
    let mut covered: BTreeMap<String, String> = BTreeMap::new();
    let mut wrong = Vec::new();
    for spec in specs() {
        let mut walk = Walk { schema: &schema, found: Vec::new() };
        walk.at(&schema, &spec, "", ("Crane", ""));
        for (place, key, row) in walk.found {
            if covered.contains_key(&key) {
                continue;
            }
            let title = |number: &Value| {
                let shown = number.as_str().map_or(number.to_string(), str::to_owned);
                let told_of = told(&spec, &place, number).into_iter();
                told_of.filter(|(_, text)| text.trim_matches('"') == shown).map(|(title, _)| title).next()
            };
            // Where another mistake hides it, another spec must have the key.
            let Some(told_of) = title(&json!(WRONG)) else { continue };
            let unit = match told_of.split_once(" is in ").and_then(|(_, rest)| rest.split_once(", and `7 bar s` is "))
            {
                Some((unit, _)) => unit,
                None => "",
            };
            if unit.is_empty() && !told_of.contains(" has no unit, and `7 bar s` is another quantity (m^-1 kg s^-1)") {
                wrong.push(format!("{place}: {told_of}"));
            }
            let of_row = row["x-unit"].as_str().unwrap_or_default();
            let known = of_row
                .split(" or ")
                .flat_map(|unit| unit.split(", "))
                .any(|one| one == unit || one == "1" && unit.is_empty());
            if !known && !of_row.starts_with("its own") {
                wrong.push(format!("{key} in {unit}: {row}"));
            }
            let right = if unit.is_empty() { "100 %".to_owned() } else { format!("1 {unit}") };
            wrong.extend(title(&json!(right)).map(|title| format!("{place}: {right} is refused: {title}")));
            let has_limit = [&row["minimum"], &row["exclusiveMinimum"]].into_iter().any(Value::is_number);
            if has_limit && row["maximum"].is_null() && title(&json!(-1.0)).is_none() {
                wrong.push(format!("{place}: −1 is allowed"));
            }
            if row["exclusiveMinimum"].is_number() && title(&json!(0.0)).is_none() {
                wrong.push(format!("{place}: 0 is allowed"));
            }
            covered.insert(key, unit.to_owned());
        }
    }
    let mut all = BTreeSet::new();
    keys(&schema, &schema, ("Crane", false), &[""], &mut all);
    assert!(all.len() > 150, "{}", all.len());
    let missing: Vec<&String> = all.iter().filter(|key| !covered.contains_key(*key)).collect();
    assert!(missing.is_empty() && wrong.is_empty(), "not tried: {missing:?}\n{}", wrong.join("\n"));
    // Some by hand, of every way in which a unit is found.
    for (key, unit) in [
        ("Bristle.stiffness", "N/m"),
        ("Pad.stiffness.*", "N/m"),
        ("Directions.phi in s", "s"),
        ("Directions.phi in N m/rad", "N m/rad"),
        ("Directions.phi in N m s/rad", "N m s/rad"),
        ("Speed.rate in rad/s or m/s", "rad/s"),
        ("Turn.x", "rad"),
        ("Run.step", "s"),
        ("Beam.length", "m"),
        ("Material.E", "Pa"),
        ("Valve.flow", "m³/s"),
        ("Section.numbers.Jy", "m⁴"),
        ("Valve.leakage", "m³/(s Pa)"),
        ("Crane.gravity.*", "m/s²"),
        ("LoopJoint.damping", "N m s/rad"),
        ("Support.friction_coefficient", ""),
    ] {
        assert_eq!(covered[key], unit, "{key}");
    }
}

/// The same crane with units as a person writes them has the same numbers, to the bit.
#[test]
fn units_do_not_change_numbers() {
    let plain = include_str!("../../../specs/cantilever.yaml");
    let chain = |text: &str| check(&SourceFile::new("cantilever.yaml", text)).map(|checked| checked.chain);
    let spec: Value = serde_yaml::from_str(plain).expect("YAML");
    let schema: Value = serde_json::from_str(&json_schema()).expect("JSON");
    let mut walk = Walk { schema: &schema, found: Vec::new() };
    walk.at(&schema, &spec, "", ("Crane", ""));
    let checked = check(&SourceFile::new("cantilever.yaml", spec.to_string())).expect("a crane");
    let mut changed = spec.clone();
    let mut count = 0;
    for (place, ..) in walk.found {
        let unit = checked.unit_at(&place[1..].replace('/', "."));
        let Some(number) = spec.pointer(&place).and_then(Value::as_f64) else { continue };
        let [from, to, power] = match unit {
            "m" => ["m", "mm", "3"],
            "Pa" => ["Pa", "GPa", "-9"],
            "kg/m³" => ["kg/m³", "t/m³", "-3"],
            "N" => ["N", "kN", "-3"],
            _ => continue,
        };
        assert_eq!(from, unit);
        // The decimal number, shifted as text.
        *changed.pointer_mut(&place).expect("a place") = json!(format!("{number}e{power} {to}"));
        count += 1;
    }
    assert!(count >= 5, "{count}");
    let [before, after] = [spec.to_string(), changed.to_string()].map(|text| {
        let chain = chain(&text).expect("a crane");
        Chain { spec_hash: String::new(), ..chain }
    });

    // Debug writes the shortest decimal that is this double, so the same text is the same bits.
    assert!(format!("{before:?}") == format!("{after:?}"));
}

/// Messages for people who slip.
#[test]
fn slips_of_units_are_told() {
    let with = |parameter: &str, mass: &str| {
        let text = format!(
            "format: 1\nname: rod\nparameters: {{load: {parameter}}}\nlinks:\n  - name: rod\n    joint: revolute\n    mass: {mass}\n    \
             com: [500 mm, 0, 0]\n    inertia: {{gyration: [0, 1, 1]}}\n"
        );
        match check(&SourceFile::new("rod.yaml", text)) {
            Ok(checked) => Ok((checked.chain.parameters[0].default, checked.chain.parameters[0].unit.clone())),
            Err(mistakes) => Err(mistakes.to_string()),
        }
    };
    assert_eq!(with("{value: 1.5 t, unit: kg}", "load"), Ok((1500.0, "kg".into())));
    assert_eq!(with("{value: 1.5 t}", "load"), Ok((1500.0, "kg".into())));
    assert_eq!(with("{value: 1.5, unit: loads}", "load"), Ok((1.5, "loads".into())));
    for (parameter, mass, words) in [
        ("{value: 1.5 m, unit: kg}", "load", "parameter `load` is in kg, and `1.5 m` is a length (m)"),
        ("{value: 1.5 m}", "load", "is in kg, and `1.5 m` is a length (m)"),
        ("{value: 1.5 t, unit: t}", "load", "write `unit: kg`"),
        ("{value: 1.5, unit: kg}", "5 kgs", "there is no unit `kgs`"),
        ("{value: 1.5, unit: kg}", "5 KG", "did you mean `kg`?"),
        ("{value: 1.5, unit: kg}", "320 bar", "and `320 bar` is a pressure (Pa)"),
    ] {
        let told = with(parameter, mass).expect_err(parameter);
        assert!(told.contains(words), "{parameter} {mass}: {told}");
    }
}

/// A data file whose headings have units, and a drive that follows it.
fn following(headings: &str, rows: &str) -> SourceFile {
    SourceFile::new(
        "lift.yaml",
        format!(
            "--- # data: lift.csv\n{headings}\n{rows}--- # part: crane.yaml\nformat: 1\nname: lift\nlinks:\n  - {{name: boom, joint: revolute, mass: 100, com: [2, 0, \
             0]}}\ndrives:\n  - {{coordinate: boom_psi, stiffness: 1e6, motion: {{table: {{file: lift.csv}}}}}}\n"
        ),
    )
}

#[test]
fn columns_of_data_files_have_units() {
    let motion = |headings: &str, rows: &str| {
        let chain = check(&following(headings, rows)).unwrap_or_else(|mistakes| panic!("\n{mistakes}")).chain;
        format!("{:?}", chain.drives[0])
    };
    let si = motion("t [s],boom [rad]", "0,0\n0.25,0.5235987755982988\n2,1.5707963267948966\n");
    assert_eq!(motion("t [ms],boom [deg]", "0,0\n250,30\n2000,90\n"), si);
    assert_eq!(motion("t,boom", "0,0\n0.25,0.5235987755982988\n2,1.5707963267948966\n"), si);
    // The drive turns; the message is about the first row.
    let refused = |headings: &str| check(&following(headings, "0,0\n1,2\n")).expect_err("a wrong unit").to_string();
    let wrong = refused("t [s],boom [mm]");
    assert!(wrong.contains("is in rad, and `0 mm` is a length") && wrong.matches("error").count() == 1, "{wrong}");
    assert!(refused("t [m],boom [deg]").contains("is in s, and `0 m` is a length"));
}
