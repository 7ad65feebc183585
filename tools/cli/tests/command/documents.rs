//! What the README shows is what the command prints.

use std::collections::BTreeMap;

use super::{crane, folder, json, text};

const README: &str = include_str!("../../../../README.md");

/// Whether two words are the same, or numbers that differ by no more than the rounding of another processor may: errors are estimated
/// from differences, to a few percent, and a residual of zero is any small number.
fn alike(one: &str, other: &str) -> bool {
    match [one, other].map(|word| word.parse::<f64>().ok()) {
        [Some(a), Some(b)] => (a - b).abs() <= 0.05 * a.abs().max(b.abs()) || a.abs().max(b.abs()) < 1e-9,
        _ => one == other,
    }
}

#[test]
fn the_readme_shows_what_a_run_prints() {
    let block = README.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block");
    let shown: Vec<&str> = block.lines().filter(|line| !matches!(line.trim(), "" | "…")).collect();
    assert!(shown.len() > 8, "{block}");
    let spec = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/own-crane/crane.yaml");
    let output = crane(&["run", spec, "--output", "0.02", "--out", &folder("readme").to_string_lossy()]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    let words = |line: &str| -> Vec<String> { line.split_whitespace().map(str::to_owned).collect() };
    let lines: Vec<Vec<String>> = printed.lines().map(words).collect();
    for line in shown {
        let wanted = words(line);
        let is_it =
            |line: &Vec<String>| line.len() == wanted.len() && line.iter().zip(&wanted).all(|(a, b)| alike(a, b));
        assert!(lines.iter().any(is_it), "README.md shows `{line}`, which is not in\n{printed}");
    }
}

#[test]
fn the_readme_lists_the_shipped_cranes() {
    let list = json(&["list", "--format", "json"]);
    let cranes = list["cranes"].as_array().expect("cranes");
    let known: BTreeMap<String, u64> = cranes
        .iter()
        .map(|crane| {
            (crane["name"].as_str().expect("a name").to_owned(), crane["coordinates"].as_u64().expect("a count"))
        })
        .collect();
    let table = README.split("## Shipped cranes").nth(1).and_then(|rest| rest.split("\n## ").next()).expect("a table");
    let row = |line: &str| {
        let mut cells = line.strip_prefix("| `")?.split(" | ");
        Some((cells.next()?.trim_end_matches('`').to_owned(), cells.next()?.parse::<u64>().ok()?))
    };
    assert_eq!(table.lines().filter_map(row).collect::<BTreeMap<_, _>>(), known);
}

#[test]
fn the_manual_shows_what_moves_what() {
    let page = include_str!("../../../../docs/manual/sensitivity.md");
    let strength = include_str!("../../../../docs/manual/strength.md");
    let spec = strength.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a spec");
    let place = folder("sensitivity_page");
    std::fs::create_dir_all(&place).expect("a folder");
    let file = place.join("truck_crane.yaml");
    std::fs::write(&file, spec).expect("a file");
    let command = page.lines().filter(|line| line.starts_with("crane sensitivity")).nth(1).expect("a command");
    let file = file.to_string_lossy();
    let arguments: Vec<&str> =
        command.split_whitespace().skip(1).map(|word| if word == "truck_crane.yaml" { &*file } else { word }).collect();
    let output = crane(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    let words = |line: &str| -> Vec<String> { line.split_whitespace().map(str::to_owned).collect() };
    let lines: Vec<Vec<String>> = printed.lines().map(words).collect();
    let block = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block");
    let shown: Vec<&str> = block.lines().filter(|line| !matches!(line.trim(), "" | "…")).collect();
    assert!(shown.len() > 8, "{block}");
    for line in shown {
        let wanted = words(line);
        let is_it =
            |line: &Vec<String>| line.len() == wanted.len() && line.iter().zip(&wanted).all(|(a, b)| alike(a, b));
        assert!(lines.iter().any(is_it), "docs/manual/sensitivity.md shows `{line}`, which is not in\n{printed}");
    }
}
