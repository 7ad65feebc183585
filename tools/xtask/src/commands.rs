//! Commands that README.md and CONTRIBUTING.md show in indented blocks: those of `crane` are run, in a folder of their own; of others, whatever
//! they name must exist. Tests, builds and tasks of hours have steps of their own, and so have blocks `sh`: [`manual`](crate::manual).

use std::process::Command;
use std::{env, fs};

use crate::{step, workspace};

/// The pages.
pub const PAGES: [&str; 2] = ["README.md", "CONTRIBUTING.md"];
/// Beginnings of a command of `crane`.
pub const CRANE: [&str; 3] = ["cargo run --release -- ", "target/release/crane ", "crane "];

/// Checks all commands of both pages.
pub fn check_commands(tasks: &str) -> Result<(), String> {
    let folder = workspace::target().join("commands");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let copied = |name: &str, text: String| {
        let file = folder.join(name);
        let parent = file.parent().map_or(Ok(()), fs::create_dir_all);
        parent.and_then(|()| fs::write(&file, text)).map_err(|error| format!("{}: {error}", file.display()))
    };
    for spec in workspace::find_files("specs", "yaml")? {
        copied(&spec, workspace::read_file(&spec)?)?;
    }
    let mut checked = 0;
    for page in PAGES {
        let text = workspace::read_file(page)?;
        for line in commands_of(&text) {
            let located = |problem: String| format!("{page}: `{line}`: {problem}");
            match CRANE.iter().find_map(|start| line.strip_prefix(start)) {
                Some(arguments) => run_crane(arguments, &folder).map_err(located)?,
                None => check_program(line, tasks).map_err(located)?,
            }
            checked += 1;
        }
    }
    if checked == 0 { Err("no commands found".into()) } else { Ok(()) }
}

/// Lines of indented blocks, without their comments, that begin with a program.
pub fn commands_of(page: &str) -> impl Iterator<Item = &str> {
    let indented = page.lines().filter_map(|line| line.strip_prefix("    "));
    let uncommented = indented.map(|line| line.split(" #").next().unwrap_or(line).trim_end());
    uncommented.filter(|line| {
        let program = line.split(' ').find(|word| !word.contains('=')).unwrap_or_default();
        matches!(program, "cargo" | "crane" | "target/release/crane" | "pip")
    })
}

/// Runs a command of `crane` in a folder.
fn run_crane(arguments: &str, folder: &std::path::Path) -> Result<(), String> {
    println!("--- crane {arguments}");
    let programs = workspace::target().join("release");
    let path = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([programs].into_iter().chain(env::split_paths(&path))).map_err(|e| e.to_string())?;
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", &format!("crane {arguments} > output.txt")]).current_dir(folder).env("PATH", path);
    step::run_to_end(&mut shell)
}

/// Checks that the task, the package and the test that a command names exist.
pub fn check_program(command: &str, tasks: &str) -> Result<(), String> {
    let words: Vec<&str> = command.split_whitespace().collect();
    let after =
        |flag: &str| words.iter().position(|word| *word == flag).and_then(|index| words.get(index + 1).copied());
    if let Some(task) = after("xtask") {
        let known = tasks.lines().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
        return known.into_iter().any(|known| known == task).then_some(()).ok_or(format!("there is no task `{task}`"));
    }
    if let Some(package) = after("-p") {
        let members = workspace::read_file("Cargo.toml")?;
        let manifests = members.split('"').skip(1).step_by(2).map(|member| format!("{member}/Cargo.toml"));
        let is_it = |file: &String| {
            workspace::read_file(file).is_ok_and(|text| text.contains(&format!("name = \"{package}\"")))
        };
        let mut manifests = manifests;
        let manifest = manifests.find(is_it).ok_or(format!("there is no package `{package}`"))?;
        if let Some(test) = after("--test") {
            let tests = manifest.replace("Cargo.toml", "tests/");
            let places = [format!("{tests}{test}.rs"), format!("{tests}{test}/main.rs")];
            return places
                .iter()
                .any(|index| workspace::root().join(index).is_file())
                .then_some(())
                .ok_or(format!("{package} has no test `{test}`"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_found_and_names_checked() {
        let page = "text\n\n    cargo test -p crane-cli    # tests\n    UPDATE=1 cargo xtask lint\n    codegen/   the compiler\n    crane list\n";
        let found: Vec<&str> = commands_of(page).collect();
        assert_eq!(found, ["cargo test -p crane-cli", "UPDATE=1 cargo xtask lint", "crane list"]);
        let tasks = "  lint     formatting\n";
        assert!(check_program("cargo xtask lint", tasks).is_ok());
        assert!(check_program("cargo xtask dance", tasks).unwrap_err().contains("no task `dance`"));
        assert!(check_program("cargo test -p crane-codegen --test c", tasks).is_ok());
        assert!(check_program("cargo test -p crane-codegen --test d", tasks).unwrap_err().contains("no test `d`"));
        assert!(check_program("cargo test -p crane-nowhere", tasks).unwrap_err().contains("no package"));
    }

    #[test]
    fn the_pages_name_only_what_exists() {
        for page in PAGES {
            let text = workspace::read_file(page).unwrap();
            let others = commands_of(&text).filter(|line| !CRANE.iter().any(|start| line.starts_with(start)));
            for line in others {
                check_program(line, crate::USAGE).unwrap_or_else(|problem| panic!("{page}: `{line}`: {problem}"));
            }
        }
    }
}
