//! `crane envelope` against the equilibrium of moments, and after interruptions.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

/// A truck of 4 t, centred between four feet 3 m and 2 m apart, with a load on a massless arm that slews and telescopes.
const TRUCK: &str = "format: 1
name: truck
parameters: {payload: {value: 100, unit: kg}, track: {value: 1, unit: m}}
links:
  - {name: truck, joint: free, mass: 4000, com: [0, 0, 0.5], inertia: {Ixx: 3000, Iyy: 3000, Izz: 3000}}
  - {name: column, placement: {transform: {translation: [0, 0, 1]}}, joint: revolute, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
  - {name: arm, joint: {prismatic: {axis: x}}, mass: payload, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
supports:
  - {name: front_left, at: [1.5, track, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: front_right, at: [1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_left, at: [-1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_right, at: [-1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
drives:
  - {coordinate: column_psi, rigid: true, motion: {hold: 0}}
  - {coordinate: arm_x, rigid: true, motion: {hold: 3}}
points: [{name: hook, link: arm, at: [0, 0, 0]}]
";

/// An empty folder of a test, with the spec in it.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("envelope_{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("truck.yaml"), TRUCK).expect("a file");
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    command.current_dir(folder).args(["envelope", "truck.yaml", "--out", "."]).args(arguments);
    command
}

fn run_command(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("it starts")
}

/// The header and the rows of the table of all poses, as texts.
fn table(folder: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut csv = csv::Reader::from_path(folder.join("truck_envelope.csv")).expect("a table");
    let header = csv.headers().expect("a header").iter().map(str::to_owned).collect();
    let rows = csv.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect();
    (header, rows)
}

#[test]
fn a_load_chart_is_the_equilibrium_of_moments() {
    let folder = folder("chart");
    let ranges = ["--range", "column=0:360deg:25", "--range", "arm_x=2:6:9", "--tipping", "0.2", "--format", "json"];
    let output = run_command(&folder, &ranges);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (header, rows) = table(&folder);
    assert_eq!(rows.len(), 25 * 9);
    let column =
        |name: &str| header.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name} of {header:?}"));
    let number = |row: &[String], name: &str| row[column(name)].parse::<f64>().expect("a number");
    for row in &rows {
        let (angle, reach) = (number(row, "column_psi [rad]"), number(row, "arm_x [m]"));
        let (x, y) = (reach * angle.cos(), reach * angle.sin());
        // About each line: m · (distance beyond) = 0.8 · 4001 kg · (distance within).
        let lines = [(x - 1.5, 1.5), (-x - 1.5, 1.5), (y - 1.0, 1.0), (-y - 1.0, 1.0)];
        let loads =
            lines.iter().filter(|(beyond, _)| *beyond > 1e-9).map(|(beyond, within)| 0.8 * 4001.0 * within / beyond);
        let expected = loads.fold(f64::INFINITY, f64::min);
        let load = number(row, "largest_load [kg]");
        if expected < 1e5 {
            assert!((load / expected - 1.0).abs() < 1e-4, "{angle} {reach}: {load} instead of {expected}");
            assert_eq!(row[column("governing")], "tipping");
        }
        assert!((number(row, "radius of hook from the axis of column_psi [m]") - reach).abs() < 1e-3);
    }
    // The chart applies all round, so the sides govern, whose lines are 1 m from the slewing axis; its loads are at least those of
    // the next larger radius of a pose, rounded down.
    let output: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!([&output["point"], &output["radius_from"]], ["hook", "the axis of column_psi"]);
    let chart = output["load_chart"].as_array().expect("a chart");
    assert!(chart.len() >= 5, "{chart:?}");
    for row in chart {
        let radius = row["radius"].as_f64().unwrap();
        let load = row["largest_load"].as_f64().unwrap();
        let (exact, further) = (0.8 * 4001.0 / (radius - 1.0), 0.8 * 4001.0 / (radius + 0.5 - 1.0));
        assert!(load <= exact && load >= 0.99 * further, "{radius} m: {load}, between {further} and {exact}");
    }
    for file in ["npz", "load_chart.csv"] {
        let name = format!("truck_envelope{}{file}", if file == "npz" { "." } else { "_" });
        assert!(folder.join(&name).is_file(), "{name}");
    }
    for picture in ["load_chart", "slew_diagram", "largest_load_map"] {
        let picture = fs::read_to_string(folder.join(format!("truck_envelope_{picture}.svg"))).expect("a picture");
        assert!(picture.starts_with("<svg") && picture.contains("[kg]") | picture.contains(" kg"));
    }
    assert!(!folder.join("truck_envelope.part.csv").exists());
}

/// A chart in tonnes beside the computed one: 0.8 · 4001 kg · 1 m / (radius − 1 m) about the sides, 10 % less than was given.
#[test]
fn a_given_chart_is_compared() {
    let folder = folder("given");
    let file = folder.join("given.csv");
    fs::create_dir_all(&folder).expect("a folder");
    let exact = |radius: f64| 0.8 * 4001.0 / (radius - 1.0);
    let rows: String = [3.0, 5.0].map(|radius| format!("{radius},{}\n", exact(radius) / 0.9 / 1000.0)).concat();
    fs::write(&file, format!("radius [m],load [t]\n{rows}9,1 t\n")).expect("a file");
    let ranges = ["--range", "column=90deg", "--range", "arm_x=2:6:81", "--tipping", "0.2", "--format", "json"];
    let given = ["--given", file.to_str().expect("a path")];
    let output = run_command(&folder, &[&ranges[..], &given].concat());
    assert_eq!(output.status.code(), Some(2), "a unit twice");
    fs::write(&file, format!("radius [m],load [t]\n{rows}9,1\n")).expect("a file");
    let output = run_command(&folder, &[&ranges[..], &given].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let beside = output["beside_the_given_chart"].as_array().expect("a table");
    for (row, radius) in beside.iter().zip([3.0, 5.0]) {
        assert!((row["given_load"].as_f64().unwrap() / (exact(radius) / 0.9) - 1.0).abs() < 1e-12);
        // Both poses around a radius bear the load: that of the farther one, 0.05 m at most.
        assert!((row["difference"].as_f64().unwrap() + 0.1).abs() < 0.025, "{row}");
        let printed = row["largest_load"].as_f64().unwrap() / row["given_load"].as_f64().unwrap() - 1.0;
        assert!((row["difference"].as_f64().unwrap() - printed).abs() < 1e-12, "it follows from its row: {row}");
        assert!(row["limit"].as_str().unwrap().starts_with("tipping"), "{row}");
    }
    assert_eq!(beside[2]["limit"], "no pose");
    // The same by the position of the arm: at one of the range, and between two, of which the farther one bears less.
    let rows: String = [3.0, 5.02].map(|x| format!("{},{}\n", 1000.0 * x, exact(x) / 0.9 / 1000.0)).concat();
    fs::write(&file, format!("arm_x [mm],load [t]\n{rows}9000,1\n")).expect("a file");
    let output = run_command(&folder, &[&ranges[..], &given].concat());
    let output: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let beside = &output["beside_the_given_chart"];
    // Rounded down as printed: 1600.4 kg at 3 m, 790.3 kg at 5.05 m.
    for (row, [at, bears]) in [[3.0, 1600.0], [5.02, 790.0]].into_iter().enumerate() {
        let difference = 0.9 * bears / exact(at) - 1.0;
        assert!((beside[row]["difference"].as_f64().unwrap() - difference).abs() < 1e-12, "{}", beside[row]);
        assert!((beside[row]["arm_x"].as_f64().unwrap() - at).abs() < 1e-12);
    }
    assert_eq!(beside[2]["limit"], "no pose");
    for (content, wanted) in [
        ("jib,load\n3,1\n", "has no drive and no live parameter `jib`"),
        ("payload,load\n3,1\n", "which no range varies"),
        ("arm_x,radius,load\n3,3,1\n", "a radius and the column `arm_x`"),
        ("load\n1\n", "has no column `radius`"),
    ] {
        fs::write(&file, content).expect("a file");
        let output = run_command(&folder, &[&ranges[..], &given].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(wanted), "{content}: {message}");
    }
    fs::write(&file, "radius;load\n3;1\n").expect("a file");
    let output = run_command(&folder, &[&ranges[..], &given].concat());
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("semicolons"),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The load of a chart is without its factors, and the combination that allows least governs: 1.5 times the load tips 1.2 times the
/// truck, before 1.1 times the load tips the truck.
#[test]
fn a_chart_has_the_loads_that_all_combinations_allow() {
    let folder = folder("combinations");
    let working = "{name: working, weight: 1.2, masses: {payload: 1.5}}";
    let light = "{name: light, masses: {payload: 1.1}}";
    fs::write(folder.join("truck.yaml"), format!("{TRUCK}combinations: [{light}, {working}]\n")).expect("a file");
    let chart = |more: &[&str]| -> Value {
        let ranges = ["--range", "column=90deg", "--range", "arm_x=3:5:2", "--format", "json"];
        let output = run_command(&folder, &[&ranges[..], more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let as_written = chart(&[]);
    for (more, limit, factor) in [
        (&["--combinations"][..], "front_left – rear_left, working", 1.2 / 1.5),
        (&["--combination", "light"], "front_left – rear_left", 1.0 / 1.1),
    ] {
        let combined = chart(more);
        for place in ["least", "greatest"] {
            let [own, load] = [&as_written, &combined].map(|chart| chart[place]["load"].as_f64().expect("a load"));
            // The mass of the column, 1 kg in 4001, has the factor of the weight too.
            assert!((load / own / factor - 1.0).abs() < 1e-6, "{load} against {factor} × {own}");
            assert_eq!(combined[place]["of"], limit, "{combined}");
        }
    }
    // Of the crane's own load, the worse of both.
    chart(&["--combinations"]);
    let (header, rows) = table(&folder);
    let margin = header.iter().position(|name| name.starts_with("tipping_margin")).expect("a column");
    let margins =
        |rows: &[Vec<String>]| -> Vec<f64> { rows.iter().map(|row| row[margin].parse().expect("a number")).collect() };
    let alone = ["light", "working"].map(|name| {
        chart(&["--combination", name]);
        margins(&table(&folder).1)
    });
    for (pose, both) in margins(&rows).iter().enumerate() {
        assert!((both - alone[0][pose].min(alone[1][pose])).abs() < 1e-9, "pose {pose}");
    }
    let left: Vec<_> = fs::read_dir(&folder).expect("a folder").flatten().map(|entry| entry.file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().contains("part")), "{left:?}");
}

/// A hook that the wind swings about hangs elsewhere with the least load: the margin with the crane's own load is that of statics all the
/// same. The path from the one pose to the other ends on the way.
#[test]
fn the_own_load_of_a_pose_rests_as_statics_finds_it() {
    let folder = folder("own_load");
    fs::write(folder.join("truck.yaml"), WINDY).expect("a file");
    let ranges = ["--range", "boom_psi=20deg", "--range", "column_psi=0:90deg:2"];
    let output = run_command(&folder, &ranges);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (header, rows) = table(&folder);
    let margin = header.iter().position(|name| name.starts_with("tipping_margin")).expect("a column");
    for (row, column) in rows.iter().zip(["column_psi=0", "column_psi=90deg"]) {
        let mut strength = Command::new(env!("CARGO_BIN_EXE_crane"));
        strength.current_dir(&folder).args(["strength", "truck.yaml", "--hold", "boom_psi=20deg", "--hold", column]);
        let output = strength.args(["--format", "json"]).output().expect("it starts");
        let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let [of_chart, of_strength] = [row[margin].parse().ok(), found["tipping_margin"].as_f64()];
        let (Some(of_chart), Some(of_strength)): (Option<f64>, _) = (of_chart, of_strength) else {
            panic!("{column}: {of_chart:?} in the chart, {of_strength:?} by `strength`");
        };
        assert!((of_chart - of_strength).abs() < 1e-7, "{column}: {of_chart} and {of_strength}");
    }
}

const WINDY: &str = "format: 1
name: truck
parameters: {payload: {value: 500, unit: kg}}
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 355e6}}
links:
  - {name: truck, joint: free, mass: 2500, com: [-0.5, 0, 0.8], inertia: {gyration: [0.8, 1.8, 1.8]}}
  - {name: column, placement: {transform: {translation: [0, 0, 1]}}, joint: revolute, mass: 200, com: [0, 0, 0.6], inertia: {gyration: [0.4, 0.4, 0.1]}}
  - name: boom
    placement: {transform: {translation: [0, 0, 1.3], rotation: {x: 90 deg}}}
    joint: revolute
    beam: {length: 5, sections: 4, material: steel, damping: {beta: 1e-3}, section: {box: {height: 0.22, width: 0.16, thickness: 0.006}}}
  - {name: hook, joint: revolute, mass: payload, com: [0, -1, 0]}
supports:
  - {name: front_left, one_sided: true, at: [1, 1.8, 0], stiffness: [1e7, 1e7, 2e7], damping: [1e5, 1e5, 1e5]}
  - {name: front_right, one_sided: true, at: [1, -1.8, 0], stiffness: [1e7, 1e7, 2e7], damping: [1e5, 1e5, 1e5]}
  - {name: rear_left, one_sided: true, at: [-2, 1.8, 0], stiffness: [1e7, 1e7, 2e7], damping: [1e5, 1e5, 1e5]}
  - {name: rear_right, one_sided: true, at: [-2, -1.8, 0], stiffness: [1e7, 1e7, 2e7], damping: [1e5, 1e5, 1e5]}
drives:
  - {coordinate: column_psi, stiffness: 3e6, damping: 3e4, motion: {hold: 90 deg}}
  - {coordinate: boom_psi, stiffness: 1e8, motion: {hold: 0}}
loads: [{name: push, link: hook, at: [0, -1, 0], force: [0, 105, 0]}]
damping: {hook_psi: 40}
";

/// Killed while it writes, with half a line after what was written: the second command continues, and the result has the same
/// bytes as one that was never interrupted.
#[test]
fn what_is_interrupted_goes_on() {
    let ranges = ["--range", "column=0:350deg:60", "--range", "arm=2:6:100", "--threads", "2"];
    let whole = folder("whole");
    assert!(run_command(&whole, &ranges).status.success());
    let broken = folder("broken");
    let part = broken.join("truck_envelope.part.csv");
    let mut killed = command(&broken, &ranges).stdout(Stdio::null()).spawn().expect("it starts");
    let begin = Instant::now();
    while fs::metadata(&part).map_or(0, |file| file.len()) < 20_000 {
        assert!(begin.elapsed() < Duration::from_secs(120), "it writes as it goes");
        thread::sleep(Duration::from_millis(1));
    }
    killed.kill().expect("it runs");
    killed.wait().expect("it ends");
    let written = fs::read_to_string(&part).expect("what was done");
    assert!(!broken.join("truck_envelope.csv").exists(), "it was interrupted");
    fs::write(&part, format!("{written}5999,tipping,\"a")).expect("half a line");

    // Other limits are refused: they would mix results that do not belong together.
    let other = run_command(&broken, &[&ranges[..], &["--tipping", "0.1"]].concat());
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&other.stderr).contains("--restart"));

    assert!(run_command(&broken, &ranges).status.success());
    let [one, two] = [&whole, &broken].map(|folder| fs::read(folder.join("truck_envelope.csv")).expect("a table"));
    assert!(one == two, "the same bytes");
    assert!(!part.exists());
}

/// What was kept is not computed again: a number that was changed in it stays.
#[test]
fn what_is_kept_is_not_computed_again() {
    let folder = folder("kept");
    let ranges = ["--range", "column=0:350deg:40", "--range", "arm=2:6:100", "--threads", "1"];
    let part = folder.join("truck_envelope.part.csv");
    let mut killed = command(&folder, &ranges).stdout(Stdio::null()).spawn().expect("it starts");
    while fs::metadata(&part).map_or(0, |file| file.len()) < 20_000 {
        thread::sleep(Duration::from_millis(1));
    }
    killed.kill().expect("it runs");
    killed.wait().expect("it ends");
    let written = fs::read_to_string(&part).expect("what was done");
    // The first pose: its number, the limit and what it is a limit of, two positions, the load.
    let mut lines: Vec<String> = written.lines().map(str::to_owned).collect();
    let first = lines.iter().position(|line| line.starts_with("0,")).expect("the first pose");
    let mut fields: Vec<&str> = lines[first].split(',').collect();
    fields[5] = "12345.678";
    lines[first] = fields.join(",");
    fs::write(&part, lines.join("\n") + "\n").expect("the file");
    assert!(run_command(&folder, &ranges).status.success());
    let (_, rows) = table(&folder);
    assert_eq!(rows[0][2], "12345.678");
    assert_eq!(rows.len(), 4000);
}

#[test]
fn mistakes_in_arguments_are_refused() {
    let folder = folder("mistakes");
    for (arguments, expected) in [
        (&["--range", "truck_x=0:1:3"][..], "truck_x has no drive"),
        (&["--range", "colum_psi=0:1:3"], "did you mean `column_psi`"),
        (&["--range", "arm=0:1"], "does not have one or three parts"),
        (&["--range", "arm=0:1:3", "--range", "arm_x=0:1:3"], "has two ranges"),
        (&["--range", "payload=0:1:3"], "payload is the load"),
        (&["--range", "arm=0:1:3", "--effort", "arm_y=3"], "there is no drive `arm_y`"),
        (&["--range", "arm=0:1:3", "--deflection", "hook=-1"], "is not a limit"),
        (&["--range", "arm=0:1:3", "--load", "pay"], "there is no live parameter `pay`"),
        (&["--range", "arm=0:1:3", "--tipping", "1"], "from 0 to below 1"),
        (&["--range", "arm=0:1:90000", "--range", "column=0:1:90000"], "are more than"),
        (&["--range", "arm=0:1:3", "--point", "hok"], "did you mean `hook`"),
        (&["--range", "column=0:70:3"], "`--range column=0:70deg:3`"),
        (&["--range", "arm=0:1:3", "--load", "track"], "`track` is in m: it is not a load"),
        (&["--range", "arm=0:1:3", "--without", "presure"], "pressure"),
        (&["--range", "arm=0:1:3", "--load-factor", "0"], "above 0"),
    ] {
        let output = run_command(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}

/// Limits that were and were not considered, crane and spec stand beside the chart, in every form of it.
#[test]
fn a_chart_has_a_title_and_fits_a_screen() {
    let folder = folder("says");
    let ranges =
        ["--range", "column=0:180deg:7", "--range", "arm_x=2:6:9", "--without", "utilisation", "--load-factor", "1.25"];
    let output = run_command(&folder, &ranges);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let widest = text.lines().filter(|line| !line.starts_with("caution")).map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{widest:?}\n{text}");
    for words in [
        "loads multiplied by",
        "a tipping margin of at least 0",
        "not considered",
        "the first support that pulls",
        "yield_stress",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    let facts = fs::read_to_string(folder.join("truck_envelope.json")).expect("facts");
    let facts: Value = serde_json::from_str(&facts).expect("JSON");
    assert_eq!((&facts["crane"], &facts["limits"]["load_factor"]), (&"truck".into(), &1.25.into()));
    assert!(facts["limits"]["utilisation"].is_null() && facts["parameters"]["track"] == 1.0);
    let hash = facts["spec_hash"].as_str().expect("a hash");
    for picture in ["load_chart", "slew_diagram", "largest_load_map"] {
        let picture = fs::read_to_string(folder.join(format!("truck_envelope_{picture}.svg"))).expect("a picture");
        for words in ["truck, spec", &hash[..12], "1.25 times the load", "Not considered"] {
            assert!(picture.contains(words), "{words}");
        }
    }
    // A load that counts 1.25 times: m · 1.25 · (distance beyond) = 4001 kg · (distance within), beside the truck.
    let (header, rows) = table(&folder);
    let column = |name: &str| header.iter().position(|known| known == name).expect("a column");
    let number = |row: &[String], name: &str| row[column(name)].parse::<f64>().expect("a number");
    let beside = rows
        .iter()
        .find(|row| (number(row, "column_psi [rad]") - std::f64::consts::FRAC_PI_2).abs() < 1e-3 && row[1] == "6.0");
    let load = number(beside.expect("the pose"), "largest_load [kg]");
    assert!((load / (4001.0 / 5.0 / 1.25) - 1.0).abs() < 1e-4, "{load}");
    // The chart over the radius names the limit of each load.
    let chart = facts["load_chart"].as_array().expect("rows");
    assert!(
        chart
            .iter()
            .all(|row| row["limit_of_largest_load"].as_str().is_some_and(|limit| limit.starts_with("tipping: ")))
    );
}

/// Over one drive, the figure has what the table has: between two poses what both bear, in steps.
#[test]
fn the_figure_of_a_chart_has_the_steps_of_its_table() {
    let folder = folder("steps");
    let output = run_command(&folder, &["--range", "arm_x=2:6:5"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = fs::read_to_string(folder.join("truck_envelope_load_chart.svg")).expect("a picture");
    assert!(picture.contains("Radius of hook from the axis of column_psi"), "{picture}");
    let lines = picture.split("points=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let corners = |line: &str| -> Vec<Vec<i32>> {
        let pairs = line.split_whitespace().map(|pair| pair.split(',').filter_map(|x| x.parse().ok()).collect());
        pairs.collect()
    };
    let curve = lines.map(corners).max_by_key(Vec::len).expect("a curve");
    assert_eq!(curve.len(), 8, "two corners between two of five poses: {curve:?}");
    assert!(curve.windows(2).all(|pair| pair[0][0] == pair[1][0] || pair[0][1] == pair[1][1]), "{curve:?}");
}

/// Two drives reach an area: each cell of the chart has the load that all poses around it bear, and a letter.
#[test]
fn a_chart_over_radius_and_height_has_limits_in_its_cells() {
    let folder = folder("area");
    let lift =
        "  - {name: mast, joint: {prismatic: {axis: z}}, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n";
    let text = TRUCK
        .replace("  - {name: arm,", &format!("{lift}  - {{name: arm,"))
        .replace("points:", "  - {coordinate: mast_z, rigid: true, motion: {hold: 1}}\npoints:");
    fs::write(folder.join("truck.yaml"), text).expect("a file");
    let ranges = ["--range", "arm_x=2:6:9", "--range", "mast_z=0.5:3:6", "--set", "payload=100"];
    let radii = ["--radius", "3,4.25,9", "--restart"];
    let output = run_command(&folder, &[&ranges[..], &radii, &["--format", "json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let asked: Vec<_> =
        output["load_chart"].as_array().expect("rows").iter().map(|row| row["radius"].clone()).collect();
    assert_eq!(asked, [3.0, 4.25]);
    let text = String::from_utf8(run_command(&folder, &[&ranges[..], &radii].concat()).stdout).expect("text");
    assert!(text.lines().any(|line| line.trim_start().starts_with("9 ") && line.contains("no pose")), "{text}");
    let places = output["loads_by_place"].as_array().expect("rows");
    let of_radius = places.iter().filter(|row| row["radius"] == 4.25).count();
    assert!(of_radius > 3 && places.len() == 2 * of_radius, "{places:?}");
    for row in places {
        let (radius, load) = (row["radius"].as_f64().unwrap(), row["load"].as_f64().unwrap());
        // In front of the truck, towards x: its line is 1.5 m away. The nearest poses are up to 0.5 m further out.
        let bears = |radius: f64| 4002.0 * 1.5 / (radius - 1.5);
        assert!(load <= bears(radius) * 1.001 && load >= 0.99 * bears(radius + 0.5), "{row}");
        assert_eq!(row["limit"], "tipping");
    }
    let text = String::from_utf8(run_command(&folder, &ranges).stdout).expect("text");
    assert!(text.contains("over radius and height") && text.contains("T tipping") && text.contains(" T"), "{text}");
    let map = fs::read_to_string(folder.join("truck_envelope_largest_load_map.svg")).expect("a picture");
    assert_eq!(map.matches(" T\n").count(), 9 * 6);
}

/// A page shows only charts of its own crane, with its own spec and parameters.
#[test]
fn a_chart_of_another_crane_is_refused() {
    let folder = folder("other");
    assert!(run_command(&folder, &["--range", "arm_x=2:6:5"]).status.success());
    let report = |spec: &str, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.current_dir(&folder).args(["report", spec, "--duration", "0.02", "--no-verify", "-o", "page.html"]);
        command.args(["--envelope", "truck_envelope.csv"]).args(more).output().expect("it starts")
    };
    let output = report("truck.yaml", &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(fs::read_to_string(folder.join("page.html")).expect("a page").contains("\"loads_by_place\""));
    fs::write(folder.join("bus.yaml"), TRUCK.replace("name: truck\n", "name: bus\n")).expect("a file");
    fs::write(folder.join("newer.yaml"), TRUCK.replace("mass: 4000", "mass: 4001")).expect("a file");
    for (spec, more, words) in [
        ("bus.yaml", &[][..], "is a chart of truck, not of bus"),
        ("newer.yaml", &[], "another version of the spec"),
        ("truck.yaml", &["--set", "track=1.2"], "with track = 1.0 m; here it is 1.2"),
    ] {
        let output = report(spec, more);
        assert_eq!(output.status.code(), Some(2), "{spec}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(words) && message.contains("crane envelope"), "{message}");
    }
}
