//! Units that cargo builds twice: for programs and for build scripts, which costs a fresh `cargo run --release` their time again, or for
//! programs and for tests that they do not have.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::{fs, io};

use crate::{step, workspace};

/// The manifest of programs that the command keeps, whose builds of dependencies are those of the workspace.
const KEPT_PROGRAM: &str = "tools/cli/src/compiled/Cargo.toml.template";

/// The profile of programs that the command keeps: that of the workspace, as far as they depend on it.
pub fn profile_of_kept_programs() -> Result<String, String> {
    let settings = release_profile(&workspace::read_file(KEPT_PROGRAM)?);
    let tables: Vec<String> = settings.into_iter().map(|(table, settings)| format!("{table}\n{settings}\n")).collect();
    Ok(tables.concat())
}

/// Finds profiles that should be the same, units that a fresh build of the command builds more than once, with what differs, and units that
/// are built for tests without having any.
pub fn check_units() -> Result<(), String> {
    let [own, copied] = ["Cargo.toml", KEPT_PROGRAM].map(workspace::read_file);
    let differences = differences(&release_profile(&own?), &release_profile(&copied?));
    if !differences.is_empty() {
        return Err(format!("{KEPT_PROGRAM} has another profile than the workspace:\n{}", differences.join("\n")));
    }
    let twice = units_built_twice(&unit_graph(&["build"])?);
    if !twice.is_empty() {
        return Err(format!("built twice:\n{}", twice.join("\n")));
    }
    let idle = without_tests(&unit_graph(&["test", "--workspace", "--exclude", "crane-bench"])?)?;
    let remedy = "built once more for tests, of which they have none; write `test = false` in their manifests";
    if idle.is_empty() { Ok(()) } else { Err(format!("{remedy}:\n{}", idle.join("\n"))) }
}

/// What cargo would build in a release: unstable output of a stable cargo.
fn unit_graph(task: &[&str]) -> Result<String, String> {
    let mut command = Command::new(step::cargo());
    command.args(task).args(["--release", "--unit-graph", "-Z", "unstable-options"]).env("RUSTC_BOOTSTRAP", "1");
    let output = command.current_dir(workspace::root()).output().map_err(|error| format!("cargo: {error}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!("cargo --unit-graph: {}", String::from_utf8_lossy(&output.stderr)))
    }
}

/// Libraries and programs of the workspace that are built for tests although nothing in their folders is a test. An example that is
/// there to be copied has a manifest without such settings.
fn without_tests(graph: &str) -> Result<Vec<String>, String> {
    let examples = workspace::root().join("examples");
    let sources = roots_built_for_tests(graph).into_iter().filter(|root| !Path::new(root).starts_with(&examples));
    let mut idle = vec![];
    for root in sources {
        let folder = Path::new(&root).parent().unwrap_or(Path::new("/"));
        if !has_tests(folder).map_err(|error| format!("{}: {error}", folder.display()))? {
            idle.push(root);
        }
    }
    Ok(idle)
}

/// The files with which libraries and programs begin that a graph builds for tests.
fn roots_built_for_tests(graph: &str) -> BTreeSet<String> {
    let units = graph.split("{\"pkg_id\":\"").skip(1).filter(|unit| unit.contains("\"mode\":\"test\""));
    let own = units.filter(|unit| !text_between(unit, "\"kind\":[", "]").contains("\"test\""));
    own.map(|unit| text_between(unit, "\"src_path\":\"", "\"")).collect()
}

/// Whether a file below a folder has a test.
fn has_tests(folder: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let found =
            if path.is_dir() { has_tests(&path)? } else { fs::read(&path)?.windows(7).any(|at| at == b"#[test]") };
        if found {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The tables of a manifest's release profile by their headers, without comments; those of a template's placeholders are left out.
fn release_profile(manifest: &str) -> BTreeMap<String, String> {
    let tables = manifest.split("\n[").skip(1).filter_map(|table| table.split_once('\n'));
    let profiles = tables.filter(|(header, _)| header.starts_with("profile.release") && !header.contains('{'));
    let settings = |text: &str| {
        let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        lines.collect::<Vec<_>>().join("\n")
    };
    profiles.map(|(header, text)| (format!("[{header}"), settings(text))).collect()
}

/// Where a copied profile is not that of the workspace. It names members that the workspace leaves at the level of a release, since they
/// are none of the copy's.
fn differences(own: &BTreeMap<String, String>, copied: &BTreeMap<String, String>) -> Vec<String> {
    let of_members = "opt-level = 3".to_owned();
    let wanted = copied.iter().map(|(table, settings)| (table, settings, own.get(table).unwrap_or(&of_members)));
    let different = wanted.filter(|(_, settings, wanted)| settings != wanted);
    different.map(|(table, settings, wanted)| format!("{table} {settings} instead of {wanted}")).collect()
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
    fn copied_profiles_are_compared() {
        let own =
            "\n[profile.release]\ncodegen-units = 16\n\n# Quickly.\n[profile.release.package.specs]\nopt-level = 1\n";
        let profile = |specs: u32, live: u32| {
            let specs = format!("\n[profile.release.package.specs]\nopt-level = {specs}\n");
            release_profile(&format!(
                "{specs}[profile.release.package.live]\nopt-level = {live}\n[profile.release.package.{{{{x}}}}]\na = 1\n"
            ))
        };
        assert_eq!(profile(1, 3).len(), 2);
        assert!(differences(&release_profile(own), &profile(1, 3)).is_empty());
        assert_eq!(differences(&release_profile(own), &profile(2, 2)).len(), 2);
    }

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
