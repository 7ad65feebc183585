//! Commands that README.md, CONTRIBUTING.md and the manual name in a sentence or show without being run: what they name must exist. For
//! `crane` these are the command and its options, as `--help` lists them; for others see [`commands::check_program`].

use std::collections::BTreeMap;
use std::process::Command;

use crate::{commands, manual, workspace};

/// Programs whose commands are checked.
const PROGRAMS: [&str; 3] = ["crane", "cargo", "pip"];

/// Checks all of them.
pub fn check_named(tasks: &str) -> Result<(), String> {
    let mut helps = BTreeMap::new();
    let mut checked = 0;
    for page in commands::PAGES
        .iter()
        .map(ToString::to_string)
        .chain(manual::chapters_of(&workspace::read_file(manual::SUMMARY)?))
    {
        for command in named(&workspace::read_file(&page)?) {
            let locate = |problem: String| format!("{page}: `{command}`: {problem}");
            match commands::CRANE.iter().find_map(|start| command.strip_prefix(start)) {
                Some(arguments) => has(arguments, &mut helps).map_err(locate)?,
                None => commands::check_program(&command, tasks).map_err(locate)?,
            }
            checked += 1;
        }
    }
    if checked == 0 { Err("no commands found".into()) } else { Ok(()) }
}

/// Commands between backticks, and in blocks that are shown.
fn named(page: &str) -> Vec<String> {
    let shown = manual::blocks_of(page).into_iter().filter(|block| block.language == "console");
    let shown: Vec<String> =
        shown.flat_map(|block| block.text.lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    let prose: String = {
        let mut within = false;
        let outside = |line: &&str| {
            let fence = line.starts_with("```");
            within ^= fence;
            !within && !fence && !line.starts_with("    ")
        };
        page.lines().filter(outside).collect::<Vec<_>>().join(" ")
    };
    let between = prose.split('`').skip(1).step_by(2).map(str::to_owned);
    let uncommented = |command: String| {
        let command = command.split(" #").next().unwrap_or_default().trim();
        command.strip_prefix("$ ").unwrap_or(command).to_owned()
    };
    let of_program = |command: &String| command.split_once(' ').is_some_and(|(program, _)| PROGRAMS.contains(&program));
    shown.into_iter().chain(between).map(uncommented).filter(of_program).collect()
}

/// Whether `crane` has a command and its options. What is written in capitals stands for something else.
fn has(arguments: &str, helps: &mut BTreeMap<String, String>) -> Result<(), String> {
    let mut words = arguments.split([' ', '[', ']', '|']).filter(|word| !word.is_empty());
    let is_command = |word: &&str| *word == word.to_lowercase() && !word.starts_with('-');
    let Some(command) = words.next().filter(is_command) else { return Ok(()) };
    let mut help = |arguments: &[&str]| -> Result<String, String> {
        let key = arguments.join(" ");
        if let Some(known) = helps.get(&key) {
            return Ok(known.clone());
        }
        let mut crane = Command::new(workspace::target().join("release/crane"));
        let output = crane.args(arguments).arg("--help").output().map_err(|error| format!("crane: {error}"))?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        helps.insert(key, text.clone());
        Ok(text)
    };
    if !lists(&help(&[])?, command) {
        return Err(format!("there is no command `{command}`"));
    }
    let own = help(&[command])?;
    let options = words.filter(|word| word.starts_with("--"));
    for option in options.map(|option| option.split('=').next().unwrap_or(option)) {
        if !lists(&own, option) {
            return Err(format!("`crane {command}` has no option `{option}`"));
        }
    }
    Ok(())
}

/// Whether a help has this word.
fn lists(help: &str, word: &str) -> bool {
    help.split(|c: char| !c.is_alphanumeric() && c != '-' && c != '_').any(|own| own == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_in_sentences_and_blocks_are_found() {
        let page = "Use `crane list` or `q`, and\n`cargo xtask\nlint`.\n```sh\ncrane run\n```\n```console\n$ crane new x  # made\nout\n```\n    crane no\n";
        assert_eq!(named(page), ["crane new x", "crane list", "cargo xtask lint"]);
    }

    #[test]
    fn a_command_and_its_options_must_be_listed() {
        let mut helps = BTreeMap::from([
            (String::new(), "  run    computes\n  list   lists".to_owned()),
            ("list".to_owned(), "lists".to_owned()),
            ("run".to_owned(), "  -o, --file <FILE>\n      --set NAME=VALUE".to_owned()),
        ]);
        for right in ["run SPEC --set a=3 [--file x]", "list", "COMMAND --help"] {
            assert_eq!(has(right, &mut helps), Ok(()), "{right}");
        }
        assert!(has("dance", &mut helps).unwrap_err().contains("no command `dance`"));
        assert!(has("run SPEC --fil x", &mut helps).unwrap_err().contains("no option `--fil`"));
    }
}
