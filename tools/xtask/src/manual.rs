//! Runs the commands of the manual, `docs/manual`, as a reader would, chapter after chapter in one folder.
//!
//! A block after `<!-- file: NAME -->` is a file to write, a block ```` ```sh ```` commands to run. Other blocks, such as
//! ```` ```console ````, are not run.

use std::process::Command;
use std::{env, fs, io};

use crate::{step, workspace};

/// The list of chapters, in order.
pub const SUMMARY: &str = "docs/SUMMARY.md";

/// Runs all commands of all chapters.
pub fn check_manual() -> Result<(), String> {
    let folder = workspace::target().join("manual");
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(format!("{}: {error}", folder.display())),
        _ => {}
    }
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let programs = workspace::target().join("release");
    let path = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([programs].into_iter().chain(env::split_paths(&path))).map_err(|e| e.to_string())?;
    let mut commands = 0;
    for chapter in chapters_of(&workspace::read_file(SUMMARY)?) {
        for block in blocks_of(&workspace::read_file(&chapter)?) {
            if let Some(name) = &block.file {
                fs::write(folder.join(name), &block.text).map_err(|error| format!("{chapter}: {name}: {error}"))?;
            }
            if block.language == "sh" {
                println!("--- {chapter}\n{}", block.text.trim_end());
                let mut shell = Command::new("sh");
                shell.args(["-e", "-c", &block.text]).current_dir(&folder).env("PATH", &path);
                step::run_to_end(&mut shell).map_err(|error| format!("{chapter}: {error}"))?;
                commands += block.text.lines().count();
            }
        }
    }
    if commands == 0 { Err(format!("{SUMMARY}: no commands found")) } else { Ok(()) }
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
}

/// Blocks of code of a page, in order.
pub fn blocks_of(page: &str) -> Vec<Block> {
    let (mut blocks, mut open, mut file) = (Vec::new(), None::<Block>, None);
    for line in page.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => {
                open = Some(Block { language: language.into(), file: file.take(), ..Block::default() });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => {
                block.text += line;
                block.text.push('\n');
            }
            (None, None) => {
                let name = line.strip_prefix("<!-- file: ").and_then(|rest| rest.strip_suffix(" -->"));
                file = name.map(ToOwned::to_owned).or(file);
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
        let page = "# A\n<!-- file: a.yaml -->\n```yaml\nb: 1\n```\ntext\n```sh\ncrane list\n```\n";
        let expected = [
            Block { language: "yaml".into(), text: "b: 1\n".into(), file: Some("a.yaml".into()) },
            Block { language: "sh".into(), text: "crane list\n".into(), file: None },
        ];
        assert_eq!(blocks_of(page), expected);
        assert_eq!(chapters_of("* [A](manual/a.md)\n* [B](SPEC.md)\n"), ["docs/manual/a.md"]);
    }
}
