//! Units that cargo builds twice, for programs and for build scripts: each costs a fresh `cargo run --release` its time again.

use std::collections::BTreeMap;
use std::process::Command;

use crate::{step, workspace};

/// Every unit that a fresh build of the command builds more than once, as a line that names it and what differs.
pub fn check_units() -> Result<(), String> {
    let mut command = Command::new(step::cargo());
    // The graph is unstable output of a stable cargo.
    command.args(["build", "--release", "--unit-graph", "-Z", "unstable-options"]).env("RUSTC_BOOTSTRAP", "1");
    let output = command.current_dir(workspace::root()).output().map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        return Err(format!("cargo --unit-graph: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let twice = units_built_twice(&String::from_utf8_lossy(&output.stdout));
    if twice.is_empty() { Ok(()) } else { Err(format!("built twice:\n{}", twice.join("\n"))) }
}

/// The units of a graph with the same package and target that are built with different settings.
fn units_built_twice(graph: &str) -> Vec<String> {
    let mut units: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
    for unit in graph.split("{\"pkg_id\":\"").skip(1) {
        let package = unit.split('"').next().unwrap_or_default().to_owned();
        if !unit.contains("\"mode\":\"build\"") {
            continue;
        }
        let settings = text_between(unit, "\"profile\":", ",\"dependencies\":");
        units.entry((package, text_between(unit, "\"kind\":[", "]"))).or_default().push(settings);
    }
    let several = units.into_iter().filter(|(_, settings)| settings.len() > 1);
    several.map(|((package, kind), settings)| format!("{package} ({kind}):\n  {}", settings.join("\n  "))).collect()
}

/// The text between two others; empty if they do not occur.
fn text_between(text: &str, from: &str, to: &str) -> String {
    let rest = text.split_once(from).map_or("", |(_, rest)| rest);
    rest.split_once(to).map_or("", |(found, _)| found).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_other_settings_are_built_twice() {
        let unit = |package: &str, mode: &str, units: u32| {
            format!(
                "{{\"pkg_id\":\"{package}\",\"target\":{{\"kind\":[\"lib\"]}},\"profile\":{{\"codegen_units\":{units}}},\
                 \"mode\":\"{mode}\",\"features\":[],\"dependencies\":[]}}"
            )
        };
        let graph = |other: &str, mode: &str| format!("{}{}", unit("one", "build", 16), unit(other, mode, 1));
        assert!(units_built_twice(&graph("two", "build")).is_empty());
        assert!(units_built_twice(&graph("one", "run-custom-build")).is_empty());
        let found = units_built_twice(&graph("one", "build"));
        assert_eq!(found.len(), 1);
        assert!(found[0].contains("\"codegen_units\":16") && found[0].contains("\"codegen_units\":1}"), "{found:?}");
    }
}
