//! Cautions of shipped cranes and examples, out of the box: those that comments in their specs expect, with reasons, and no others.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::{crane, folder, text};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// What a user asks first.
const COMMANDS: [&str; 6] = ["check", "statics", "modes", "strength", "run", "sensitivity"];
/// Begins a comment with the command and its caution, in which `…` stands for anything.
const EXPECTED: &str = "# expected caution: ";
/// What moves what is a question about live parameters.
const WITHOUT_PARAMETERS: &str = "has no live parameters";

/// Specs of all shipped cranes and examples. `examples/python/slewing_crane.yaml` is left out: torques of a controller hold it.
fn specs() -> Vec<PathBuf> {
    let in_folder = |folder: &str| -> Vec<PathBuf> {
        let entries = fs::read_dir(Path::new(ROOT).join(folder)).expect("a folder");
        entries
            .map(|entry| entry.expect("a file").path())
            .filter(|path| path.extension().is_some_and(|e| e == "yaml"))
            .collect()
    };
    let folders = ["specs", "specs/examples", "examples/own-crane", "examples/python"];
    folders.into_iter().flat_map(in_folder).filter(|path| !path.ends_with("slewing_crane.yaml")).collect()
}

/// Whether a caution is the expected one.
fn is_expected(caution: &str, pattern: &str) -> bool {
    let mut pieces = pattern.split('…');
    let first = pieces.next().unwrap_or_default();
    let rest = caution
        .strip_prefix(first)
        .map(|rest| pieces.try_fold(rest, |rest, piece| rest.find(piece).map(|index| &rest[index + piece.len()..])));
    rest.flatten().is_some_and(|rest| rest.is_empty() || pattern.ends_with('…'))
}

/// Cautions that are not expected, and expected ones that do not come.
fn surprises(spec: &Path) -> Vec<String> {
    let name = spec.strip_prefix(ROOT).unwrap_or(spec).display().to_string();
    let comments = fs::read_to_string(spec).expect("a spec");
    let mut expected: Vec<&str> = comments.lines().filter_map(|line| line.strip_prefix(EXPECTED)).collect();
    let out = folder(&format!("cautions_{}", name.replace('/', "_")));
    let mut found = Vec::new();
    for command in COMMANDS {
        let mut arguments = vec![command, spec.to_str().expect("a path")];
        if command == "run" {
            arguments.extend(["--out", out.to_str().expect("a path")]);
        }
        let output = crane(&arguments);
        let printed = text(&output.stdout) + &text(&output.stderr);
        if !(output.status.success() || command == "sensitivity" && printed.contains(WITHOUT_PARAMETERS)) {
            found.push(format!("{name}: {command} fails:\n{printed}"));
        }
        for line in printed.lines() {
            let Some(caution) = line.strip_prefix("caution: ").or_else(|| line.strip_prefix("warning")) else {
                continue;
            };
            let said = format!("{command}: {caution}");
            match expected.iter().position(|pattern| is_expected(&said, pattern)) {
                Some(index) => drop(expected.remove(index)),
                None => found.push(format!("{name}: {said}")),
            }
        }
    }
    found.extend(expected.into_iter().map(|pattern| format!("{name}: no longer: {pattern}")));
    found
}

#[test]
fn shipped_cranes_and_examples_cause_no_unexpected_caution() {
    let specs = specs();
    assert!(specs.len() > 14, "{specs:?}");
    let found: Vec<String> = std::thread::scope(|scope| {
        let running: Vec<_> = specs.iter().map(|spec| scope.spawn(|| surprises(spec))).collect();
        running.into_iter().flat_map(|running| running.join().expect("no panic")).collect()
    });
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// The manual has a row for each crane and command with cautions.
#[test]
fn the_manual_explains_the_expected_cautions() {
    let page = include_str!("../../../../docs/manual/troubleshooting.md");
    let (_, section) = page.split_once("## Cautions of the shipped cranes").expect("a section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let cell = |text: &str| text.trim().trim_matches('`').to_owned();
    let row = |line: &str| {
        let mut cells = line.strip_prefix("| `")?.split('|');
        Some((cell(cells.next()?), cell(cells.next()?)))
    };
    let explained: BTreeSet<(String, String)> = section.lines().filter_map(row).collect();
    let expected = |spec: &PathBuf| {
        let comments = fs::read_to_string(spec).expect("a spec");
        let name = comments.lines().find_map(|line| line.strip_prefix("name: ")).expect("a name").to_owned();
        let commands =
            comments.lines().filter_map(|line| line.strip_prefix(EXPECTED)?.split(':').next().map(str::to_owned));
        commands.map(|command| (name.clone(), command)).collect::<Vec<_>>()
    };
    assert_eq!(explained, specs().iter().flat_map(expected).collect::<BTreeSet<_>>());
}

/// After the motions of the loader crane its tip comes to rest: its servos are stable.
#[test]
fn the_loader_crane_comes_to_rest() {
    let (spec, out) = (format!("{ROOT}/specs/examples/loader_crane.yaml"), folder("loader_at_rest"));
    let output = crane(&["run", &spec, "--duration", "40", "--no-verify", "--out", out.to_str().expect("a path")]);
    let printed = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success() && !printed.contains("caution"), "{printed}");
    let results = fs::read_to_string(out.join("my_loader_crane.csv")).expect("results");
    let mut lines = results.lines();
    let index = lines.next().expect("a header").split(',').position(|name| name == "tip_z [m]").expect("a column");
    let number = |line: &str, place: usize| {
        line.split(',').nth(place).and_then(|word| word.parse::<f64>().ok()).expect("a number")
    };
    let heights: Vec<[f64; 2]> = lines.map(|line| [number(line, 0), number(line, index)]).collect();
    let swing = |from: f64| {
        let heights = heights.iter().filter(|[t, _]| (from..=from + 5.0).contains(t)).map(|[_, z]| *z);
        let [low, high] = heights.fold([f64::MAX, f64::MIN], |[low, high], z| [low.min(z), high.max(z)]);
        high - low
    };
    // The load swings with 2 % of damping and 0.3 Hz, so that 25 s leave e^(-0.02 · 1.9 · 25) = 0.4 of what moves the tip; it sinks
    // besides, since oil leaks. Without leakage it swings by 0.4 m.
    assert!(swing(15.0) < 2e-3 && swing(35.0) < 0.5 * swing(15.0), "{} m, {} m", swing(15.0), swing(35.0));
}
