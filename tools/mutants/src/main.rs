//! Which change of an operator does no test notice?
//!
//!     cargo xtask mutants [--seed N] [--count N] [--since COMMIT] [FILE …]
//!
//! Draws operators, numbers and calls of the files by a seed, builds the workspace once with all of them as switches, and runs the tests
//! with one switch after the other. Survivors are changes that no test notices: each is a test that is missing, or a change that changes
//! nothing, which `equivalent.txt` lists with the reason.

mod draw;
mod run;
mod site;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

/// Crates whose files may be changed: they are linked into the tests that run. Roots of generated code and of build scripts are not.
const CRATES: [&str; 4] = ["codegen/src", "crane-model/src", "engine/live/src", "apps/page/src"];
/// Changes that change nothing, with the reasons.
const EQUIVALENT: &str = include_str!("../equivalent.txt");

/// What the arguments ask for.
struct Asked {
    seed: u64,
    count: usize,
    since: Option<String>,
    files: Vec<String>,
}

fn main() -> ExitCode {
    match asked().and_then(|asked| search(&asked)) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(survivors) => {
            println!(
                "{survivors} survive: write a test that notices them, or the reason into tools/mutants/equivalent.txt"
            );
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn asked() -> Result<Asked, String> {
    let mut asked = Asked { seed: 1, count: 100, since: None, files: Vec::new() };
    let mut words = env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("`{word}` has no value"));
        match word.as_str() {
            "--seed" => asked.seed = number(&value()?)?,
            "--count" => asked.count = number(&value()?)?,
            "--since" => asked.since = Some(value()?),
            file if !file.starts_with('-') => asked.files.push(file.to_owned()),
            other => return Err(format!("there is no option `{other}`: --seed N, --count N, --since COMMIT, files")),
        }
    }
    Ok(asked)
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("`{text}` is not a whole number"))
}

/// Runs the tests with every change; returns how many survive without a reason.
fn search(asked: &Asked) -> Result<usize, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).ok_or("no workspace")?.to_owned();
    let files = files(asked, &root)?;
    let mut changes = draw::draw(&root, &files, asked)?;
    println!("{} changes in {} files, by seed {}", changes.len(), files.len(), asked.seed);
    let tests = run::build(&site::Site::new(&root), &mut changes)?;
    let survivors = run::run(&tests, &changes)?;
    let mut unexplained = 0;
    println!("\nsurvivors");
    for change in survivors {
        let reason =
            EQUIVALENT.lines().filter_map(|line| line.split_once(" # ")).find(|(line, _)| *line == change.name());
        unexplained += usize::from(reason.is_none());
        println!("  {}{}", change.line(), reason.map_or(String::new(), |(_, why)| format!(" # {why}")));
    }
    Ok(unexplained)
}

/// The files to change: those that are named, those that changed since a commit, or all.
fn files(asked: &Asked, root: &Path) -> Result<Vec<PathBuf>, String> {
    let mut command = Command::new("git");
    command.current_dir(root);
    match &asked.since {
        Some(commit) => command.args(["diff", "--name-only", commit, "--"]),
        None => command.args(["ls-files", "--"]),
    };
    let output = command.args(CRATES).output().map_err(|error| format!("git: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let listed = String::from_utf8_lossy(&output.stdout).into_owned();
    let is_wanted = |file: &&str| {
        let is_test = file.ends_with("tests.rs") || file.contains("/tests/");
        let is_named = asked.files.is_empty() || asked.files.iter().any(|named| file.starts_with(named.as_str()));
        file.ends_with(".rs") && !is_test && is_named && root.join(file).exists()
    };
    let files: Vec<PathBuf> = listed.lines().filter(is_wanted).map(PathBuf::from).collect();
    if files.is_empty() { Err(format!("no files of {}", CRATES.join(", "))) } else { Ok(files) }
}

/// Reads a file.
fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}
