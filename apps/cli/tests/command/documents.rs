//! The README lists what the command lists. What pages show of outputs is compared with them where their commands run: `cargo xtask test`.

use std::collections::BTreeMap;

use super::json;

const README: &str = include_str!("../../../../README.md");

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
