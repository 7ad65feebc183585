//! `crane simulate --ensemble` that is interrupted and continues.

use std::{
    collections::BTreeSet,
    env, fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

/// Enough runs that a command can be interrupted midway.
const ROWS: usize = 400;

/// An empty folder of a test, with a table of loads in it.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("interrupted_ensemble_{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    // One load that the drives cannot hold: its row has no numbers, and a reason.
    let load = |row: usize| if row == 100 { "1e12".to_owned() } else { row.to_string() };
    let loads: Vec<String> = (0..ROWS).map(load).collect();
    fs::write(folder.join("loads.csv"), format!("payload [kg]\n{}\n", loads.join("\n"))).expect("a file");
    folder
}

/// Rows of a fleet.
const FLEET: usize = 8;

/// The command, which can be interrupted even where it runs in the background of a script.
fn command(folder: &Path, method: &str, more: &[&str]) -> Command {
    let mut command = Command::new("env");
    command
        .args(["--default-signal=INT", env!("CARGO_BIN_EXE_crane"), "simulate", "knuckle_boom", "--method", method])
        .args(["--ensemble", "loads.csv", "--file", "peaks.csv", "--duration", "0.5", "--threads", "2"])
        .args(["--format", "json"])
        .args(more)
        .current_dir(folder);
    command
}

/// The report of a command that runs to its end; the load of 1e12 kg makes its exit code 1.
fn finish(folder: &Path, method: &str, more: &[&str]) -> Value {
    let output = command(folder, method, more).output().expect("it starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("1 of 400 cranes did not reach the end"), "{message}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The fleets of which all rows are in a file of finished rows: those that are kept.
fn whole_fleets(part: &Path) -> Vec<usize> {
    let text = fs::read_to_string(part).unwrap_or_default();
    let complete = text.rsplit_once('\n').map_or("", |(complete, _)| complete);
    let row = |line: &str| line.split(',').next()?.parse::<usize>().ok();
    // Some are written twice, before and after an interruption.
    let rows: BTreeSet<usize> = complete.lines().filter_map(row).collect();
    (0..ROWS / FLEET).filter(|fleet| rows.range(fleet * FLEET..(fleet + 1) * FLEET).count() == FLEET).collect()
}

/// Starts the command and stops it as soon as one more fleet is finished; returns how many lines the file of finished rows has then.
fn interrupt(folder: &Path, method: &str, stop: impl Fn(&mut Child)) -> usize {
    let part = folder.join("peaks.part.csv");
    let before = whole_fleets(&part).len();
    let mut child =
        command(folder, method, &[]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let begin = Instant::now();
    while whole_fleets(&part).len() == before {
        assert!(begin.elapsed() < Duration::from_secs(120), "it writes as it goes");
        thread::sleep(Duration::from_millis(1));
    }
    stop(&mut child);
    assert!(!child.wait().expect("it ends").success());
    assert!(!folder.join("peaks.csv").exists(), "it was interrupted");
    fs::read_to_string(&part).expect("finished rows").lines().count()
}

fn by_ctrl_c(child: &mut Child) {
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("it starts");
    assert!(status.success());
}

/// Interrupted by Ctrl-C, killed, and with half a line after what was written: the third command continues, and the table has the
/// same bytes as one that was never interrupted. Finished rows are kept: a number that was changed in one of them stays.
fn continues(method: &str) {
    let whole = folder(&format!("whole_{method}"));
    assert_eq!(finish(&whole, method, &[])["kept_from_before"], 0);
    let broken = folder(&format!("broken_{method}"));
    let part = broken.join("peaks.part.csv");
    interrupt(&broken, method, by_ctrl_c);
    let lines = interrupt(&broken, method, |child| child.kill().expect("it runs"));
    let written = fs::read_to_string(&part).expect("finished rows");
    let complete = written.rfind('\n').expect("a line") + 1;
    fs::write(&part, format!("{}399,399.0,1.2", &written[..complete])).expect("half a line");

    let other = command(&broken, method, &["--set", "payload=1"]).output().expect("it starts");
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&other.stderr).contains("--restart"));

    let report = finish(&broken, method, &[]);
    let kept = usize::try_from(report["kept_from_before"].as_u64().expect("a count")).expect("a count");
    // The first line is not a row, and the last one may have been cut. Of a fleet, either all rows are kept or none: each thread had one when it was
    // interrupted, whose rows were written again, and when it was killed.
    let incomplete = if method == "bdf" { 2 * 2 * FLEET } else { 0 };
    assert!(kept < lines && kept + incomplete + 2 >= lines, "{kept} of {lines} lines");
    assert!(method != "bdf" || kept.is_multiple_of(FLEET), "{kept} rows of whole fleets");
    assert!(kept > 0 && kept < ROWS);
    let [one, two] = [&whole, &broken].map(|folder| fs::read(folder.join("peaks.csv")).expect("a table"));
    assert!(one == two, "the same bytes");
    assert!(!part.exists());
}

#[test]
fn by_the_default_method_it_continues() {
    continues("bdf");
}

#[test]
fn in_lanes_it_continues() {
    continues("rk4");
}

#[test]
fn finished_rows_are_not_computed_again() {
    let folder = folder("kept");
    let part = folder.join("peaks.part.csv");
    interrupt(&folder, "bdf", by_ctrl_c);
    let written = fs::read_to_string(&part).expect("finished rows");
    let mut lines: Vec<String> = written.lines().map(str::to_owned).collect();
    let row = FLEET * whole_fleets(&part)[0];
    let line = lines.iter_mut().find(|line| line.starts_with(&format!("{row},"))).expect("a row");
    // The number of the row, the load, the first of the extremes.
    let mut fields: Vec<&str> = line.split(',').collect();
    fields[2] = "12345.678";
    *line = fields.join(",");
    fs::write(&part, lines.join("\n") + "\n").expect("a file");
    finish(&folder, "bdf", &[]);
    let table = fs::read_to_string(folder.join("peaks.csv")).expect("a table");
    let changed: Vec<usize> =
        table.lines().skip(1).enumerate().filter(|(_, l)| l.contains("12345.678")).map(|(r, _)| r).collect();
    assert_eq!(changed, [row]);

    // From the start, if asked to.
    fs::remove_file(folder.join("peaks.csv")).expect("a table");
    fs::write(&part, lines.join("\n") + "\n").expect("a file");
    assert_eq!(finish(&folder, "bdf", &["--restart"])["kept_from_before"], 0);
    assert!(!fs::read_to_string(folder.join("peaks.csv")).expect("a table").contains("12345.678"));
}
