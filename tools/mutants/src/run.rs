//! Builds the tests with all switches, and runs them with one after the other.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::draw::Change;
use crate::site::{SWITCH, Site};

/// What is built: the tests of packages with random cranes, and the golden files.
const BUILT: [&[&str]; 2] = [
    &["-p", "crane-codegen", "-p", "crane-model", "-p", "crane-live", "-p", "crane-page", "-p", "crane-combinations"],
    &["-p", "crane-tests", "--test", "golden"],
];
/// Random cranes: few, since they run for every change.
const CRANES: [&str; 9] = ["--from", "100", "--count", "16", "--checks", "5", "--threads", "1", "--no-shrink"];
/// Tests that are too long to run for every change: more random cranes, and runs of many cranes at once.
const LONG: [&str; 2] = ["seeds", "fleets"];
/// Tests that write files at a place of their own, which is one for all changes.
const WRITING: [&str; 3] = ["extends", "build_script", "c"];
/// A test that takes this many times as long as without a change hangs.
const HANGS: u32 = 6;

/// A program that tests.
#[derive(Debug)]
pub struct Test {
    name: String,
    program: PathBuf,
    /// The folder of its package, in the copy, and where it runs.
    package: PathBuf,
    folder: PathBuf,
    /// Held while it runs if it cannot run twice at once.
    alone: Option<Mutex<()>>,
    arguments: Vec<String>,
    /// How long it takes without a change.
    takes: Duration,
}

/// Builds the tests; leaves out changes that do not compile. Tests that fail without a change are not used.
pub fn build(site: &Site, changes: &mut Vec<Change>) -> Result<Vec<Test>, String> {
    let tree = &site.tree;
    loop {
        site.write(changes)?;
        let (programs, refused) = compile(tree, changes)?;
        if refused.is_empty() {
            println!("{} changes compile", changes.len());
            return Ok(sound(tree, programs));
        }
        println!("{} changes do not compile", refused.len());
        let mut number = 0;
        changes.retain(|_| {
            number += 1;
            !refused.contains(&number)
        });
    }
}

/// A program that was built: its name, itself, and the folder of its package.
type Program = (String, PathBuf, PathBuf);

/// Compiles the tests; returns the programs, or the numbers of changes that the compiler refuses.
fn compile(tree: &Path, changes: &[Change]) -> Result<(Vec<Program>, BTreeSet<usize>), String> {
    let (mut programs, mut refused) = (Vec::new(), BTreeSet::new());
    for built in BUILT {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.current_dir(tree).args(["test", "--release", "--no-run", "--message-format=json"]);
        command.args(["--config", "profile.release.lto=\"off\""]).env("CARGO_TARGET_DIR", tree.with_file_name("build"));
        let output =
            command.args(built).stderr(Stdio::inherit()).output().map_err(|error| format!("cargo: {error}"))?;
        let texts = String::from_utf8_lossy(&output.stdout).into_owned();
        for message in texts.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
            if let Some(program) = message["executable"].as_str() {
                let package = Path::new(message["manifest_path"].as_str().unwrap_or_default()).parent().unwrap_or(tree);
                let name = message["target"]["name"].as_str().unwrap_or_default().to_owned();
                programs.push((name, PathBuf::from(program), package.to_owned()));
            }
            if message["message"]["level"] == "error" {
                for span in message["message"]["spans"].as_array().into_iter().flatten() {
                    refused.extend(numbers_at(tree, span, changes));
                }
            }
        }
        if !refused.is_empty() {
            break;
        }
        if !output.status.success() {
            return Err("the copy does not compile, and no change is the cause: see above".to_owned());
        }
    }
    Ok((programs, refused))
}

/// Numbers of the changes on the lines of a message.
fn numbers_at(tree: &Path, span: &Value, changes: &[Change]) -> Vec<usize> {
    let file = span["file_name"].as_str().unwrap_or_default();
    let lines = [&span["line_start"], &span["line_end"]].map(|line| line.as_u64().unwrap_or(0) as usize);
    let Ok(text) = std::fs::read_to_string(tree.join(file)) else { return Vec::new() };
    let said: String = text.lines().skip(lines[0].saturating_sub(1)).take(lines[1] + 1 - lines[0]).collect();
    let of_text = said.split("crate::mutants::is(").skip(1).filter_map(|rest| rest.split(')').next()?.parse().ok());
    of_text
        .filter(|number: &usize| changes.get(number - 1).is_some_and(|change| change.file == Path::new(file)))
        .collect()
}

/// The tests that pass without a change, the fastest first.
fn sound(tree: &Path, programs: Vec<Program>) -> Vec<Test> {
    let mut tests: Vec<Test> = Vec::new();
    for (name, program, package) in programs {
        // Programs that are no tests, but for random cranes.
        let is_test = program.parent().is_some_and(|folder| folder.ends_with("deps"));
        let is_cranes = name == "combinations" && !is_test;
        if LONG.contains(&name.as_str()) || !is_test && !is_cranes {
            continue;
        }
        let mut test = Test {
            alone: WRITING.contains(&name.as_str()).then(Mutex::default),
            folder: if is_cranes { tree.to_owned() } else { package.clone() },
            arguments: if is_cranes { CRANES.map(str::to_owned).to_vec() } else { Vec::new() },
            takes: Duration::from_secs(600),
            package: package.strip_prefix(tree).unwrap_or(&package).to_owned(),
            name,
            program,
        };
        let begin = Instant::now();
        let passes = test.passes(0);
        test.takes = begin.elapsed();
        println!(
            "{}: {:.1} s{}",
            test.name,
            test.takes.as_secs_f64(),
            if passes { "" } else { ", fails without a change: not used" }
        );
        if passes {
            tests.push(test);
        }
    }
    tests.sort_by_key(|test| test.takes);
    tests
}

impl Test {
    /// Whether its program contains a change: each crate is linked into those above it alone.
    fn contains(&self, change: &Change) -> bool {
        let of = |folder: &str| self.package == Path::new(folder);
        if change.file.starts_with("codegen") {
            true
        } else if change.file.starts_with("apps/page") {
            of("apps/page") || of("tests/combinations")
        } else {
            !of("codegen") && !of("tests")
        }
    }

    /// Whether it passes with a change; one that hangs does not.
    fn passes(&self, number: usize) -> bool {
        let _alone = self.alone.as_ref().map(Mutex::lock);
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).current_dir(&self.folder).stdout(Stdio::null()).stderr(Stdio::null());
        command.env(SWITCH, number.to_string()).env("INSTA_UPDATE", "no").env("RUST_TEST_THREADS", "1");
        let Ok(mut child) = command.spawn() else { return false };
        let end = Instant::now() + HANGS * self.takes + Duration::from_secs(5);
        loop {
            match child.try_wait() {
                Ok(Some(status)) => return status.success(),
                Ok(None) if Instant::now() < end => thread::sleep(Duration::from_millis(20)),
                _ => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return false;
                }
            }
        }
    }
}

/// Runs all tests with every change; returns the changes with which they all pass.
pub fn run<'a>(tests: &[Test], changes: &'a [Change]) -> Result<Vec<&'a Change>, String> {
    let (next, survivors) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(change) = changes.get(next.fetch_add(1, Ordering::Relaxed)) {
            let number = 1 + changes.iter().position(|other| std::ptr::eq(other, change)).unwrap_or(0);
            let killer = tests.iter().find(|test| test.contains(change) && !test.passes(number));
            println!(
                "{number}/{} {}: {}",
                changes.len(),
                killer.map_or("SURVIVES", |test| test.name.as_str()),
                change.line()
            );
            if killer.is_none() {
                survivors.lock().map_err(|_| "a thread panicked")?.push(change);
            }
        }
        Ok::<(), String>(())
    };
    thread::scope(|scope| {
        let threads: Vec<_> =
            (0..thread::available_parallelism().map_or(1, usize::from)).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().map_err(|_| "a thread panicked".to_owned())?)
    })?;
    survivors.into_inner().map_err(|_| "a thread panicked".to_owned())
}
