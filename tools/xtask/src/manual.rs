//! Runs the commands of README.md and of the manual, `docs/manual`, as a reader would, page after page in one folder, and compares what pages show with
//! what is printed.
//!
//! * A block after `<!-- file: NAME -->` is a file to write.
//! * Each line of a block ```` ```sh ```` is a command, which runs as it stands: `target/release` and the folder of the shell's programs hold the
//!   built ones, and `cargo run --release -p PACKAGE` is the built program of this name. It ends well, or with an error that the page shows.
//! * A block ```` ```text ```` shows what the commands of the last `sh` block before it print, unless it follows `<!-- not compared: REASON -->`.
//!   How lines are compared: [`shown`].
//! * The page shows each caution that its commands print.
//!
//! Other blocks, such as ```` ```console ````, are not run.

mod shown;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use crate::workspace;
use shown::Line;

/// The list of chapters, in order.
pub const SUMMARY: &str = "docs/SUMMARY.md";
/// What a command of a package's program begins with.
const BY_CARGO: &str = "cargo run --release -p ";

/// Runs all commands of all pages; says at the end what pages show otherwise.
pub fn check_manual() -> Result<(), String> {
    let folder = prepare_folder()?;
    let mut commands = 0;
    let mut problems = Vec::new();
    for page in std::iter::once("README.md".to_owned()).chain(chapters_of(&workspace::read_file(SUMMARY)?)) {
        let (run, found) = check_page(&workspace::read_file(&page)?, &folder, &page)?;
        commands += run;
        problems.extend(found);
    }
    match (commands, problems.is_empty()) {
        (0, _) => Err(format!("{SUMMARY}: no commands found")),
        (_, true) => Ok(()),
        _ => Err(format!("pages show what is not so:\n{}", problems.join("\n"))),
    }
}

/// A new folder, in which `target/release` are the built programs.
fn prepare_folder() -> Result<PathBuf, String> {
    let folder = workspace::target().join("manual");
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
        _ => {}
    }
    fs::create_dir_all(folder.join("target")).map_err(failed)?;
    std::os::unix::fs::symlink(workspace::target().join("release"), folder.join("target/release")).map_err(failed)?;
    Ok(folder)
}

/// Runs the commands of a page; returns their number and what the page shows otherwise.
fn check_page(page: &str, folder: &Path, name: &str) -> Result<(usize, Vec<String>), String> {
    let blocks = blocks_of(page);
    let is_output = |block: &Block| block.language == "text" && block.file.is_none() && block.reason.is_none();
    let quoted: Vec<Line> =
        blocks.iter().filter(|block| is_output(block)).flat_map(|block| shown::lines_of(&block.text)).collect();
    let (mut commands, mut problems) = (0, Vec::new());
    let mut printed: Option<Vec<Line>> = None;
    for block in &blocks {
        if let Some(file) = &block.file {
            fs::write(folder.join(file), &block.text).map_err(|error| format!("{name}: {file}: {error}"))?;
        }
        if block.language == "sh" {
            let mut all = Vec::new();
            for command in block.text.lines().filter(|line| !line.trim().is_empty()) {
                println!("--- {name}: {command}");
                let (output, is_well) = run(command, folder)?;
                let lines = shown::printed_lines(&output);
                if is_well == shown::fails(&lines) {
                    let end = if is_well { "ends well with an error" } else { "fails without an error" };
                    problems.push(format!("{name}: `{command}` {end}:\n{output}"));
                }
                let unquoted = shown::unquoted(&lines, &quoted).into_iter();
                problems.extend(
                    unquoted.map(|line| {
                        format!("{name}: `{command}` prints `{}`, which the page does not show", line.text())
                    }),
                );
                all.extend(lines);
                commands += 1;
            }
            printed = Some(all);
        }
        if let Some(printed) = printed.as_ref().filter(|_| is_output(block)) {
            let lines = shown::lines_of(&block.text);
            let missing = shown::missing(&lines, printed).into_iter();
            problems
                .extend(missing.map(|line| format!("{name} shows `{}`, which its commands do not print", line.text())));
        }
    }
    Ok((commands, problems))
}

/// Runs a command in a folder; returns what it prints and whether it succeeds.
fn run(command: &str, folder: &Path) -> Result<(String, bool), String> {
    let path = env::var_os("PATH").unwrap_or_default();
    let programs = workspace::target().join("release");
    let path = env::join_paths([programs].into_iter().chain(env::split_paths(&path))).map_err(|e| e.to_string())?;
    let built = command.strip_prefix(BY_CARGO).unwrap_or(command);
    let mut shell = Command::new("sh");
    // Both streams in the order of a terminal.
    shell.args(["-c", &format!("exec 2>&1\n{built}")]).current_dir(folder).env("PATH", &path);
    let output = shell.output().map_err(|error| format!("sh: {error}"))?;
    Ok((String::from_utf8_lossy(&output.stdout).into_owned(), output.status.success()))
}

/// Chapters of the manual that a list links to.
pub fn chapters_of(summary: &str) -> Vec<String> {
    let links = summary.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    links.filter(|link| link.starts_with("manual/")).map(|link| format!("docs/{link}")).collect()
}

/// A block of code.
#[derive(Debug, Default, PartialEq)]
pub struct Block {
    /// What follows the fence.
    pub language: String,
    /// Its lines.
    pub text: String,
    /// Name of the file that it is.
    pub file: Option<String>,
    /// Why it is not compared with an output.
    pub reason: Option<String>,
}

/// Blocks of code of a page, in order.
pub fn blocks_of(page: &str) -> Vec<Block> {
    let (mut blocks, mut open) = (Vec::new(), None::<Block>);
    let [mut file, mut reason] = [None, None];
    for line in page.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => {
                open = Some(Block {
                    language: language.into(),
                    file: file.take(),
                    reason: reason.take(),
                    ..Block::default()
                });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => {
                block.text += line;
                block.text.push('\n');
            }
            (None, None) => {
                let comment = |begin: &str| {
                    line.strip_prefix("<!-- ")?.strip_prefix(begin)?.strip_suffix(" -->").map(ToOwned::to_owned)
                };
                file = comment("file: ").or(file);
                reason = comment("not compared: ").or(reason);
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_found() {
        let page =
            "# A\n<!-- file: a.yaml -->\n```yaml\nb: 1\n```\ntext\n<!-- not compared: a formula -->\n```text\nx\n```\n";
        let yaml = Block { language: "yaml".into(), text: "b: 1\n".into(), file: Some("a.yaml".into()), reason: None };
        let text = Block { language: "text".into(), text: "x\n".into(), file: None, reason: Some("a formula".into()) };
        assert_eq!(blocks_of(page), [yaml, text]);
        assert_eq!(chapters_of("* [A](manual/a.md)\n* [B](SPEC.md)\n"), ["docs/manual/a.md"]);
    }

    #[test]
    fn a_page_must_show_what_its_commands_print() {
        let check = |page: &str| check_page(page, &env::temp_dir(), "page").expect("a shell").1;
        let page = |command: &str, shown: &str| format!("```sh\n{command}\n```\n```text\n{shown}\n```\n");
        assert_eq!(check(&page("echo a 1.2", "a 1.2")), [""; 0]);
        assert_eq!(check("```text\na formula\n```\n"), [""; 0]);
        assert_eq!(check(&page("echo error: none; false", "error: none")), [""; 0]);
        for (command, shown, problem) in [
            ("echo a 1.2", "a 1.4", "shows `a 1.4`"),
            ("echo a; echo caution: b >&2", "a", "prints `caution: b`"),
            ("echo error: none", "error: none", "ends well with an error"),
            ("echo a; false", "a", "fails without an error"),
        ] {
            let problems = check(&page(command, shown));
            assert!(problems.len() == 1 && problems[0].contains(problem), "{problems:?}");
        }
    }
}
