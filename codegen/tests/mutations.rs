//! Valid specs and robots in which one thing is wrong: each value of each shipped spec and each example, and each attribute and element of
//! each robot, replaced by others. Every mutant gets an answer within bounds of memory, without a panic.
//!
//! Random bytes (`stages/any_bytes.rs`) rarely come so far that a crane is expanded; a mutant is a crane except in one place. A run draws some
//! of all mutants, the same ones in every run. `CRANE_THOROUGH=1` takes all of them, which takes 15 minutes; `CRANE_SEED=7` draws others.

use std::fmt::Write as _;
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crane_codegen::chain::Chain;
use crane_codegen::{SourceFile, build, check, exchange, read};
use roxmltree::Document;
use serde_json::{Value, json};

/// Memory that the answer for a small crane allocates in sum, bytes: three times what the largest shipped crane takes.
const MEMORY: u64 = 50_000_000;
/// The same for each coordinate, with matrices of coordinates by coordinates.
const MEMORY_OF_COORDINATE: u64 = 20_000;
/// No answer takes nearly as long; what does is ended, since it may have no end.
const LONGEST: Duration = Duration::from_secs(10);
/// Memory of the process at which a mutant is ended that has no end, kB.
const LARGEST: u64 = 2_000_000;
/// How many mutants of specs, and of robots, a run takes.
const DRAWN: [usize; 2] = [3500, 3000];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The files of some folders with some extension, in order, with their texts.
fn files(folders: &[&str], extensions: &[&str]) -> Vec<(String, String)> {
    let entries = folders.iter().flat_map(|name| std::fs::read_dir(folder(name)).expect("a folder"));
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_one = |path: &PathBuf| path.extension().is_some_and(|own| extensions.iter().any(|one| own == *one));
    let text = |path: PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        Some((name, std::fs::read_to_string(path).ok()?))
    };
    let mut files: Vec<_> = paths.filter(is_one).filter_map(text).collect();
    files.sort();
    files
}

/// A crane that others extend, by name or by file.
fn shipped(name: &str) -> Option<&'static str> {
    let file = format!("{}.yaml", name.trim_end_matches(".yaml"));
    let text = std::fs::read_to_string(folder("../specs").join(file)).ok()?;
    Some(text.leak())
}

/// Pseudo-random numbers (Steele, Lea and Flood 2014, `SplitMix64`).
fn mixed(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Which of all mutants a run takes.
struct Draw {
    seed: u64,
    /// One of so many.
    one_of: u64,
}

impl Draw {
    /// About `wanted` of so many.
    fn of(wanted: usize, all: usize) -> Self {
        let thorough = std::env::var_os("CRANE_THOROUGH").is_some();
        let seed = std::env::var("CRANE_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(2016);
        Draw { seed, one_of: if thorough { 1 } else { (all / wanted).max(1) as u64 } }
    }

    fn takes(&self, index: usize) -> bool {
        mixed(self.seed ^ (index as u64) << 20).is_multiple_of(self.one_of)
    }
}

/// What is being tried, since when; a thread that ends the process if that has no end.
#[derive(Clone, Default)]
struct Tried(Arc<Mutex<Option<(String, Instant)>>>);

impl Tried {
    fn watched() -> Self {
        let tried = Tried::default();
        let watched = tried.clone();
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_millis(20));
                let kept = watched.0.lock().expect("no panic while it is held");
                let Some((what, since)) = &*kept else { continue };
                let memory = resident().unwrap_or_default();
                if since.elapsed() > LONGEST || memory > LARGEST {
                    let seconds = since.elapsed().as_secs_f64();
                    // Not captured by the tests, whose process ends here.
                    let _ = writeln!(std::io::stderr(), "without an end: {seconds:.1} s, {memory} kB, from\n{what}");
                    std::process::exit(101);
                }
            }
        });
        tried
    }

    /// Notes what is tried, and does it: whether it panics, and the bytes that it allocates.
    fn attempt<R>(&self, what: &str, act: impl FnOnce() -> R) -> (Result<R, ()>, u64) {
        *self.0.lock().expect("no panic while it is held") = Some((what.to_owned(), Instant::now()));
        let mut answer = Err(());
        let measured = allocation_counter::measure(|| answer = catch_unwind(AssertUnwindSafe(act)).map_err(drop));
        *self.0.lock().expect("no panic while it is held") = None;
        (answer, measured.bytes_total)
    }
}

/// Memory of this process, kB, where the system says it.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.split_whitespace().next()?.parse().ok()
}

/// Reads and checks: the number of coordinates of a crane without mistakes, or all mistakes as printed.
fn answer(name: &str, text: &str) -> Result<usize, String> {
    let source = build::read_with(name, text.as_bytes(), &shipped).map_err(|failure| {
        assert!(!failure.to_string().is_empty());
        failure.to_string()
    })?;
    match read(&source).and_then(check) {
        Ok(checked) => {
            assert_eq!(checked.chain.guess.len(), checked.chain.coordinates.len());
            assert_eq!(checked.warnings.lines().count(), checked.warnings.mistakes().len());
            Ok(checked.chain.coordinates.len())
        }
        Err(mistakes) => {
            assert!(!mistakes.to_string().is_empty() && !mistakes.headline().contains('\n'));
            assert!(mistakes.mistakes().iter().any(|mistake| !mistake.is_warning()));
            Err(mistakes.to_string())
        }
    }
}

/// What is wrong with a mutant's answer, if anything.
fn judged(tried: &Tried, what: &str, most: usize, act: impl FnOnce() -> Result<usize, String>) -> Option<String> {
    let (answer, bytes) = tried.attempt(what, act);
    let Ok(coordinates) = answer else { return Some(format!("a panic from {what}")) };
    let allowed = MEMORY + MEMORY_OF_COORDINATE * coordinates.unwrap_or(most) as u64;
    (bytes > allowed).then(|| format!("{bytes} bytes instead of {allowed} from {what}"))
}

/// A change of a value in a spec.
#[derive(Clone, Debug)]
enum Change {
    To(Value),
    /// The key or the entry is left out.
    Delete,
    /// An entry of a list twice; the value of a key as a list of it.
    Double,
    /// The key has another name.
    Rename,
}

/// Everything that replaces a value: wrong types, extreme numbers, deep and long values, texts that mean something elsewhere.
fn changes(names: &[String]) -> Vec<Change> {
    let deep = |wrap: fn(Value) -> Value, depth| (0..depth).fold(json!(1), |inner, _| wrap(inner));
    let mut values = vec![
        Value::Null,
        json!(true),
        json!(false),
        json!([]),
        json!({}),
        json!([null]),
        json!([0]),
        json!([1, 2]),
        json!([0, 0, 0]),
        json!([1, 2, 3, 4]),
        json!([["a"]]),
        json!([{}]),
        json!({"a": 1}),
        json!({"value": 1, "unit": "kg"}),
        json!({"link": "", "at": "tip"}),
        json!({"axis": [0, 0, 0]}),
        deep(|inner| json!([inner]), 5),
        deep(|inner| json!([inner]), 40),
        deep(|inner| json!({"link": inner}), 5),
        deep(|inner| json!({"a": inner}), 40),
        json!(vec![0; 3000]),
        json!("x".repeat(20_000)),
    ];
    let numbers = [0.0, -1.0, 0.5, 1.0, 2.0, 3.0, 7.5, 999.0, 1001.0, 1e5, 1e17, 1e308, -1e308, 1e-308, 5e-324, -0.0];
    values.extend(numbers.map(|number| json!(number)));
    let texts = [
        "",
        " ",
        "NaN",
        "inf",
        ".nan",
        "-.inf",
        "1e999",
        "0x10",
        "1,5",
        "90 deg",
        "1/0 pi",
        "z",
        "world",
        "tip",
        "free",
        "fixed",
        "rigid",
        "revolute",
        "</script>",
        "../../x",
        "a\u{0}b",
        "\u{202e}ä",
        "a\nb: c",
        "*x",
        "~",
    ];
    values.extend(texts.map(|text| json!(text)));
    values.extend(names.iter().map(|name| json!(name)));
    let own = [Change::Delete, Change::Double, Change::Rename];
    values.into_iter().map(Change::To).chain(own).collect()
}

/// The places of all values within a value, as JSON pointers.
fn places(value: &Value, at: &str, found: &mut Vec<String>) {
    let inner: Vec<(String, &Value)> = match value {
        Value::Array(items) => items.iter().enumerate().map(|(index, item)| (index.to_string(), item)).collect(),
        Value::Object(entries) => {
            entries.iter().map(|(key, item)| (key.replace('~', "~0").replace('/', "~1"), item)).collect()
        }
        _ => Vec::new(),
    };
    for (key, item) in inner {
        let at = format!("{at}/{key}");
        places(item, &at, found);
        found.push(at);
    }
}

/// All names in a spec.
fn names(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| names(item, found)),
        Value::Object(entries) => {
            found.extend(entries.get("name").and_then(Value::as_str).map(str::to_owned));
            entries.values().for_each(|item| names(item, found));
        }
        _ => (),
    }
}

/// A spec with a change at a place.
fn changed(spec: &Value, at: &str, change: &Change) -> Value {
    let mut spec = spec.clone();
    if let Change::To(value) = change {
        if let Some(place) = spec.pointer_mut(at) {
            place.clone_from(value);
        }
        return spec;
    }
    let (around, key) = at.rsplit_once('/').expect("a place in a spec");
    let key = key.replace("~1", "/").replace("~0", "~");
    match (spec.pointer_mut(around), change) {
        (Some(Value::Array(items)), change) => {
            let index: usize = key.parse().expect("an index");
            let item = items.remove(index);
            if matches!(change, Change::Double) {
                items.extend([item.clone(), item]);
            }
        }
        (Some(Value::Object(entries)), change) => {
            let value = entries.remove(&key).unwrap_or_default();
            match change {
                Change::Double => drop(entries.insert(key, json!([value.clone(), value]))),
                Change::Rename => drop(entries.insert(format!("{key}s"), value)),
                _ => (),
            }
        }
        _ => (),
    }
    spec
}

/// Every eighth name, at most eight.
fn some(names: Vec<String>) -> Vec<String> {
    let step = (names.len() / 8).max(1);
    names.into_iter().step_by(step).take(8).collect()
}

#[test]
fn every_value_of_every_spec_may_be_wrong() {
    let tried = Tried::watched();
    let mut specs = Vec::new();
    for (name, text) in files(&["../specs", "../specs/examples"], &["yaml"]) {
        // As specs are read: `y` is an axis.
        let options = serde_yaml::options! { strict_booleans: true };
        let spec: Value = serde_yaml::from_str_with_options(&text, options).expect("a spec");
        let size = answer(&name, &spec.to_string()).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
        let (mut at, mut known) = (Vec::new(), Vec::new());
        places(&spec, "", &mut at);
        names(&spec, &mut known);
        specs.push((name, spec, size, at, changes(&some(known))));
    }
    let all: usize = specs.iter().map(|(.., at, changes)| at.len() * changes.len()).sum();
    let draw = Draw::of(DRAWN[0], all);
    let (mut index, mut count, mut wrong) = (0, 0, Vec::new());
    for (name, spec, size, at, changes) in &specs {
        for (place, change) in at.iter().flat_map(|at| changes.iter().map(move |change| (at, change))) {
            index += 1;
            if !draw.takes(index) {
                continue;
            }
            count += 1;
            let text = changed(spec, place, change).to_string();
            let mut what = format!("{name} with {place}: {change:?}");
            what.truncate(what.floor_char_boundary(300));
            // What was a small number may be the number of sections.
            let grows = matches!(change, Change::To(Value::Number(number)) if number.as_f64() > Some(10.0));
            let most = if grows { Chain::MOST_COORDINATES } else { 2 * size };
            wrong.extend(judged(&tried, &what, most, || answer(name, &text)));
        }
    }
    let shown = wrong.iter().take(20).fold(String::new(), |mut text, line| {
        let _ = writeln!(text, "{line}");
        text
    });
    assert!(wrong.is_empty(), "{} of {count} mutants:\n{shown}", wrong.len());
    assert!(count > DRAWN[0] / 2, "{count} of {all} mutants");
    println!("{count} of {all} mutants of specs");
}

/// Texts that replace the values of attributes of a robot.
const TEXTS: [&str; 24] = [
    "",
    " ",
    "0",
    "-1",
    "1e308",
    "NaN",
    "inf",
    "1e999",
    "1 2",
    "0 0 0",
    "1 2 3 4 5 6 7",
    "true",
    "false",
    "world",
    "main",
    "base",
    "upper",
    "fore",
    "shoulder",
    "elbow",
    "ball",
    "../x",
    "&lt;/script&gt;",
    "ä",
];

/// The robots with one thing changed: `(what, text)`; of each attribute its value and itself, of each element itself and what is in it.
fn robots_with(name: &str, text: &str) -> Vec<(String, String)> {
    let Ok(document) = Document::parse(text) else { return Vec::new() };
    let mut mutants = Vec::new();
    let mut push = |what: String, range: std::ops::Range<usize>, by: &str| {
        let what = format!("{name}, {what} at byte {}: {by:.60}", range.start);
        mutants.push((what, [&text[..range.start], by, &text[range.end..]].concat()));
    };
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let (range, tag) = (node.range(), node.tag_name().name());
        let own = &text[range.clone()];
        push(format!("<{tag}> left out"), range.clone(), "");
        push(format!("<{tag}> twice"), range.clone(), &own.repeat(2));
        push(format!("<{tag}> 30 times"), range.clone(), &own.repeat(30));
        push(format!("<{tag}> renamed"), range.clone(), &own.replace(tag, "other"));
        // In itself, once and deeply.
        for depth in [1, 5] {
            let open = own.find('>').map_or("", |end| own[..end].trim_end_matches('/'));
            let nested = format!("{}{own}{}", format!("{open}>").repeat(depth), format!("</{tag}>").repeat(depth));
            push(format!("<{tag}> in itself"), range.clone(), &nested);
            let bare = format!("{}{own}{}", format!("<{tag}>").repeat(depth), format!("</{tag}>").repeat(depth));
            push(format!("<{tag}> in a bare one"), range.clone(), &bare);
        }
        for attribute in node.attributes() {
            let key = attribute.name();
            push(format!("{key} left out"), attribute.range(), "");
            push(format!("{key} renamed"), attribute.range(), &format!("{key}s=\"{}\"", attribute.value()));
            for by in TEXTS {
                push(format!("{key} of <{tag}>"), attribute.range_value(), by);
            }
            let others = document.descendants().flat_map(|node| node.attributes()).filter(|other| other.name() == key);
            for other in others.step_by(3).take(4) {
                push(format!("{key} of <{tag}>"), attribute.range_value(), other.value());
            }
        }
    }
    mutants
}

#[test]
fn everything_in_every_robot_may_be_wrong() {
    let tried = Tried::watched();
    let robots = files(&["tests/robots", "tests/bad_robots"], &["urdf", "xml"]);
    let mutants: Vec<_> = robots.iter().flat_map(|(name, text)| robots_with(name, text)).collect();
    let draw = Draw::of(DRAWN[1], mutants.len());
    let (mut count, mut wrong) = (0, Vec::new());
    for (_, (what, text)) in mutants.iter().enumerate().filter(|(index, _)| draw.takes(*index)) {
        count += 1;
        let import =
            || match exchange::import(&SourceFile::new("robot", text.as_str()), &exchange::ImportOptions::default()) {
                Ok(imported) => answer("robot.yaml", &imported.spec),
                Err(mistakes) => {
                    assert!(!mistakes.to_string().is_empty() && !mistakes.headline().contains('\n'));
                    Err(mistakes.to_string())
                }
            };
        wrong.extend(judged(&tried, what, 100, import));
    }
    let shown: String = wrong.iter().take(20).fold(String::new(), |text, line| text + line + "\n");
    assert!(wrong.is_empty(), "{} of {count} mutants:\n{shown}", wrong.len());
    assert!(count > DRAWN[1] / 2, "{count} of {} mutants", mutants.len());
    println!("{count} of {} mutants of robots", mutants.len());
}
