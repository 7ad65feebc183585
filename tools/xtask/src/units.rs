//! Units that cargo builds twice: for programs and for build scripts, which costs a fresh `cargo run --release` their time again, or for
//! programs and for tests that they do not have.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::{fs, io};

use crate::{commands, step, workspace};

/// The manifest of programs that the command keeps, whose builds of dependencies are those of the workspace.
const KEPT_PROGRAM: &str = "apps/cli/src/compiled/Cargo.toml.template";

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
    let mut graphs = vec![];
    for command in documented_builds()? {
        let words: Vec<&str> = command.split(' ').collect();
        graphs.push((command.clone(), unit_graph(&words)?));
    }
    graphs.push(("all programs".to_owned(), unit_graph(&crate::ALL_PROGRAMS)?));
    let again = units_built_again(&graphs);
    if !again.is_empty() {
        let remedy = "built again with other settings; give their features in the root's Cargo.toml, or list them where they are `not used`";
        return Err(format!("{remedy}:\n{}", again.join("\n")));
    }
    let idle = without_tests(&unit_graph(&["test", "--workspace", "--exclude", "crane-bench"])?)?;
    let remedy = "built once more for tests, of which they have none; write `test = false` in their manifests";
    if idle.is_empty() { Ok(()) } else { Err(format!("{remedy}:\n{}", idle.join("\n"))) }
}

/// What cargo would build in a release: unstable output of a stable cargo.
fn unit_graph(task: &[&str]) -> Result<String, String> {
    let mut command = Command::new(step::cargo());
    command.args(task.iter().filter(|word| **word != "--release")).args([
        "--release",
        "--unit-graph",
        "-Z",
        "unstable-options",
    ]);
    command.env("RUSTC_BOOTSTRAP", "1");
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
    for (unit, settings) in built_units(graph) {
        units.entry(unit).or_default().push(settings);
    }
    let several = units.into_iter().filter(|(_, settings)| settings.len() > 1);
    several.map(|((package, kind), settings)| format!("{package} ({kind}):\n  {}", settings.join("\n  "))).collect()
}

/// What the commands of README.md and CONTRIBUTING.md build in a release: the first two words of cargo's tasks, and packages.
fn documented_builds() -> Result<Vec<String>, String> {
    let mut builds = vec!["build".to_owned()];
    for page in commands::PAGES {
        let text = workspace::read_file(page)?;
        for line in commands::commands_of(&text) {
            let words: Vec<&str> = line.split(" -- ").next().unwrap_or(line).split_whitespace().collect();
            let task = words.iter().position(|word| *word == "cargo").and_then(|cargo| words.get(cargo + 1));
            let task = match task {
                Some(&"run" | &"build") if words.contains(&"--release") => "build",
                Some(&"test") if words.contains(&"--release") => "test",
                _ => continue,
            };
            let package = words.iter().position(|word| *word == "-p").and_then(|flag| words.get(flag + 1));
            let build = package.map_or(task.to_owned(), |package| format!("{task} -p {package}"));
            if !builds.contains(&build) {
                builds.push(build);
            }
        }
    }
    Ok(builds)
}

/// Units that a command builds with settings which none of the earlier commands that need the unit has.
fn units_built_again(graphs: &[(String, String)]) -> Vec<String> {
    let mut known: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
    let mut again = vec![];
    for (command, graph) in graphs {
        let mut units: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
        for (unit, settings) in built_units(graph) {
            units.entry(unit).or_default().insert(settings);
        }
        for (unit, settings) in units {
            let earlier = known.entry(unit.clone()).or_insert_with(|| settings.clone());
            let new = settings
                .difference(earlier)
                .map(|settings| format!("{} ({}) by `cargo {command}`: {settings}", unit.0, unit.1));
            again.extend(new.collect::<Vec<_>>());
            earlier.extend(settings);
        }
    }
    again
}

/// Libraries, build scripts and macros that a graph builds, by package and kind, with their settings.
fn built_units(graph: &str) -> impl Iterator<Item = ((String, String), String)> {
    let units = graph.split("{\"pkg_id\":\"").skip(1).filter(|unit| unit.contains("\"mode\":\"build\""));
    units.map(|unit| {
        let package = unit.split('"').next().unwrap_or_default().to_owned();
        ((package, text_between(unit, "\"kind\":[", "]")), text_between(unit, "\"profile\":", ",\"dependencies\":"))
    })
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
        // The same unit in two commands, once with other settings.
        let graphs = |settings: u32| {
            let other = unit("one", "build", settings);
            [("build".to_owned(), unit("one", "build", 16)), ("test".to_owned(), other + &unit("two", "build", 1))]
        };
        assert!(units_built_again(&graphs(16)).is_empty());
        assert!(units_built_again(&graphs(1))[0].starts_with("one (\"lib\") by `cargo test`"));
    }
}
