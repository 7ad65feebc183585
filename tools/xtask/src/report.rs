//! The report page, in `apps/report`: whether the command includes the newest, and how a browser shows it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

const FOLDER: &str = "apps/report";
/// Pages for the browser besides that of the default run: no elements and no supports; nothing that moves; more samples than a
/// page holds; cylinders with valves, feet that lift, friction.
const OTHERS: [(&str, &[&str]); 4] = [
    ("knuckle_boom", &[]),
    ("cantilever", &[]),
    ("double_pendulum", &["--duration", "50", "--output", "0.01"]),
    ("eight_link_hydraulic", &["--duration", "3"]),
];

/// A program that runs in the folder of the pages.
pub fn command_in_folder(program: &str) -> Command {
    let mut command = Command::new(program);
    command.current_dir(workspace::root().join(FOLDER));
    command
}

/// Installs the pinned packages, unless they are installed.
pub fn prepare_packages() -> Result<(), String> {
    let lock = workspace::read_file(&format!("{FOLDER}/package-lock.json"))?;
    let stamp = workspace::root().join(FOLDER).join("node_modules/installed.json");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == lock) {
        println!("{FOLDER}/package-lock.json is installed");
        return Ok(());
    }
    step::run_to_end(command_in_folder("npm").arg("ci"))
        .map_err(|error| format!("{error}; npm is needed (Debian: apt-get install nodejs npm)"))?;
    fs::write(&stamp, lock).map_err(|error| format!("{}: {error}", stamp.display()))
}

/// Checks that the page included in the command is the one built from its sources.
pub fn check_current() -> Result<(), String> {
    step::run_to_end(command_in_folder("node").args(["build.js", "--check"]))
}

/// What a notebook shows of a crane and of a run, in headless Chromium.
pub fn check_in_notebook() -> Result<(), String> {
    let file = workspace::root().join("out/notebook.html");
    fs::create_dir_all(workspace::root().join("out")).map_err(|error| format!("out: {error}"))?;
    step::run_to_end(
        CHECKS.interpreter_command().arg("notebook.py").arg(&file).current_dir(workspace::root().join(FOLDER)),
    )?;
    step::run_to_end(command_in_folder("node").arg("notebook.js").arg(file))
}

/// Pages of several cranes in headless Chromium; that of the default run is compared with its CSV files. Of all shipped cranes, what the
/// pages say is compared with what the command wrote.
pub fn check_in_browser() -> Result<(), String> {
    let out = workspace::root().join("out");
    let files = ["report.html", "eight_link_flexible.csv", "eight_link_rigid.csv"].map(|name| out.join(name));
    step::run_to_end(command_in_folder("node").arg("test.js").args(files))?;
    for (crane, options) in OTHERS {
        step::run_to_end(command_in_folder("node").arg("test.js").arg(write_page(&out, crane, options)?))?;
    }
    let pages = shipped_cranes()?
        .into_iter()
        .map(|crane| write_page(&out.join("pages"), &crane, &[]))
        .collect::<Result<Vec<_>, _>>()?;
    step::run_to_end(command_in_folder("node").arg("text.js").args(pages))
}

/// Writes the page of a crane.
fn write_page(folder: &Path, crane: &str, options: &[&str]) -> Result<PathBuf, String> {
    let page = folder.join(format!("{crane}.html"));
    let mut command = Command::new(workspace::target().join("release/crane"));
    step::run_to_end(command.args(["report", crane, "--sensitivity"]).args(options).arg("-o").arg(&page))?;
    Ok(page)
}

/// Writes a report of every shipped crane into a folder of the site, with a link to the page as an instrument there.
pub fn write_reports(folder: &Path) -> Result<(), String> {
    let crane = workspace::target().join("release/crane");
    shipped_cranes()?.into_iter().try_for_each(|name| {
        let mut command = Command::new(&crane);
        command.args(["report", &name, "--quiet", "--instrument", "../instrument.html", "-o"]);
        step::run_to_end(command.arg(folder.join(name).with_extension("html")))
    })
}

/// Names of the shipped cranes.
fn shipped_cranes() -> Result<Vec<String>, String> {
    let specs = workspace::root().join("specs");
    let files = fs::read_dir(&specs).map_err(|error| format!("{}: {error}", specs.display()))?;
    let names = files.filter_map(|file| Some(file.ok()?.file_name().to_str()?.strip_suffix(".yaml")?.to_owned()));
    let mut names: Vec<String> = names.collect();
    names.sort();
    Ok(names)
}
