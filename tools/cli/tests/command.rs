//! The `crane` command as a user meets it.

use std::{
    env, fs,
    io::Read,
    path::PathBuf,
    process::{Command, Output, Stdio},
};

use serde_json::Value;

fn crane(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_crane")).args(arguments).output().expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn json(arguments: &[&str]) -> Value {
    let output = crane(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Wrong arguments end with code 2 and say what was meant.
fn refused(arguments: &[&str], said: &[&str]) {
    let output = crane(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    for words in said {
        assert!(message.contains(words), "{arguments:?}: `{words}` not in: {message}");
    }
    assert!(output.stdout.is_empty());
}

#[test]
fn wrong_arguments_are_refused_with_the_nearest_right_one() {
    refused(&["statics", "eight_link_flexibel"], &["there is no crane `eight_link_flexibel`", "`eight_link_flexible`"]);
    refused(
        &["statics", "--set", "load_mas=3"],
        &["no live parameter `load_mas`", "did you mean `load_mass`?", "[kg]"],
    );
    refused(&["statics", "--set", "load_mass"], &["has no value", "name=value"]);
    refused(&["statics", "--set", "load_mass=heavy"], &["`heavy` is not a valid value for load_mass", "in kg"]);
    refused(&["statics", "--set", "load_mass=inf"], &["finite"]);
    refused(
        &["statics", "--set", "load_mass=-10"],
        &["the mass of body `log` must not be negative, but is -10 [E032]"],
    );
    refused(&["simulate", "--duration", "abc"], &["'abc'", "write a number of seconds"]);
    refused(&["simulate", "--tolerance", "abc"], &["'abc'", "such as 1e-4"]);
    refused(&["simulate", "--step", "0"], &["`--step 0`", "positive"]);
    refused(&["simulate", "--duration", "-1"], &["`--duration -1`", "positive"]);
    refused(&["simulate", "--output", "nan"], &["`--output NaN`", "positive"]);
    refused(&["simulate", "--output", "1e-9"], &["more than a million"]);
    refused(&["simulate", "--step", "1e-300"], &["more than ten billion", "longer `--step`"]);
    refused(&["eval", "--q", "1,2"], &["`--q` has 2 numbers", "25 coordinates", "truck_x [m]"]);
    refused(&["eval", "--q", "no_such_file"], &["neither a list of numbers nor a file"]);
    refused(&["simulate", "--method", "rk5"], &["there is no method `rk5`", "rk4, dopri5, rosw4, bdf"]);
    refused(
        &["simulate", "--method", "rosw4", "--step", "1e-3"],
        &["`--step` has no effect with rosw4", "--tolerance"],
    );
    refused(
        &["simulate", "--method", "rk4", "--tolerance", "1e-3"],
        &["`--tolerance` has no effect with rk4", "--step"],
    );
    refused(&["simulate", "--tolerance", "1e-20"], &["below the rounding errors", "1e-12"]);
    refused(&["dance"], &["unrecognized subcommand"]);
}

#[test]
fn statics_of_the_reference_crane_as_json() {
    let report = json(&["statics", "--format", "json"]);
    let steps = report["history"].as_array().expect("a table").len() - 1;
    assert!(steps <= 5, "{steps} Newton steps");
    let forces = |report: &Value, name: &str| {
        let rows = report["reactions"].as_array().expect("a table");
        let row = rows.iter().find(|row| row["support"] == name).expect("a row");
        ["x", "y", "z"].map(|axis| row[axis].as_f64().expect("a number"))
    };
    let (sum, weight) = (forces(&report, "Σ supports"), forces(&report, "weight"));
    // Newton's tolerance: 1e-10 of the greatest force.
    assert!(sum.iter().zip(&weight).all(|(sum, weight)| (sum + weight).abs() < 1e-10 * 1.7e5), "{sum:?} {weight:?}");
    let empty = json(&["statics", "--set", "load_mass=0", "--format", "json"]);
    // The log weighs 500 kg; likewise.
    let log = sum[2] - forces(&empty, "Σ supports")[2];
    assert!((log - 500.0 * 9.81).abs() < 1e-4, "{log}");
    // Mass times gravity, of the log as well.
    let log = forces(&empty, "weight")[2] - weight[2];
    assert!((log - 500.0 * 9.81).abs() < 1e-9, "{log}");
}

#[test]
fn a_run_writes_columns_with_units_and_a_record() {
    let out = folder("run");
    let path = out.to_str().expect("a path");
    let report = json(&["simulate", "double_pendulum", "--duration", "0.05", "--out", path, "--format", "json"]);
    assert!(report["summary"].as_array().is_some_and(|rows| !rows.is_empty()));
    let csv = fs::read_to_string(out.join("double_pendulum.csv")).expect("a CSV file");
    let header = csv.lines().next().expect("a header");
    for column in header.split(',') {
        assert!(column.contains(" [") && column.ends_with(']'), "{column} has no unit");
    }
    assert!(header.starts_with("t [s],") && header.contains("_rate [rad/s]") && header.ends_with("energy_balance [J]"));
    let record: Value =
        serde_json::from_slice(&fs::read(out.join("double_pendulum.json")).expect("a record")).expect("JSON");
    assert_eq!(record["crane"], "double_pendulum");
    assert!(record["spec_hash"].as_str().is_some_and(|hash| !hash.is_empty()));
    assert_eq!(record["duration_s"], 0.05);
    assert_eq!(record["start"], "guess, at rest");
    assert_eq!(report["start"], record["start"]);
    // Nothing half-written is left behind.
    assert!(
        fs::read_dir(&out)
            .expect("a folder")
            .all(|file| { !file.expect("a file").file_name().to_string_lossy().ends_with(".part") })
    );
}

#[test]
fn a_crane_goes_to_other_programs_and_comes_back() {
    let out = folder("exchange");
    fs::create_dir_all(&out).expect("a folder");
    let file = |name: &str| out.join(name).to_str().expect("a path").to_owned();
    let (urdf, mjcf, spec) = (file("boom.urdf"), file("boom.xml"), file("boom.yaml"));
    let set = ["--set", "payload=900"];
    for (format, target) in [("urdf", &urdf), ("mjcf", &mjcf)] {
        let output = crane(&[&["export", "knuckle_boom", "--format", format, "-o", target][..], &set].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        // The hook's block weighs 25 kg.
        assert!(fs::read_to_string(target).expect("a file").contains("\"925\""), "{target}");
    }
    assert!(
        fs::read_to_string(file("boom.springs.yaml"))
            .expect("springs")
            .contains("hook_theta: {stiffness: 0, damping: 40")
    );
    let output = crane(&["import", &urdf, "-o", &spec]);
    assert!(text(&output.stdout).contains("knuckle_boom: valid; 4 bodies, 4 coordinates"), "{}", text(&output.stderr));
    let output = crane(&["import", &mjcf]);
    assert!(
        text(&output.stderr).contains("error[U002]") && output.status.code() == Some(1) && output.stdout.is_empty()
    );
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), 4, "nothing half-written is left behind");
    refused(
        &["export", "knuckle_boom", "--format", "c", "--input", "pull=3"],
        &["`--input`", "where the exported crane runs"],
    );
    refused(&["export", "knuckle_bom", "--format", "urdf"], &["there is no crane `knuckle_bom`", "`knuckle_boom`"]);
    refused(
        &["export", "knuckle_boom", "--format", "mjcf", "--set", "load=1"],
        &["no live parameter `load`", "payload"],
    );
}

#[test]
fn a_crane_without_statics_swings_from_its_guess() {
    let out = folder("swing");
    let path = out.to_str().expect("a path");
    let report =
        json(&["simulate", "double_pendulum", "--method", "rk4", "--duration", "2", "--out", path, "--format", "json"]);
    let csv = fs::read_to_string(out.join("double_pendulum.csv")).expect("a CSV file");
    let column = csv.lines().next().and_then(|header| header.split(',').position(|name| name == "upper_theta [rad]"));
    let angles: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(column.expect("a column")).expect("a field").parse().expect("a number"))
        .collect();
    // The guess of the spec: the upper rod level. It swings through the vertical and out on the other side.
    assert!((angles[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15, "{}", angles[0]);
    assert!(angles.iter().any(|angle| *angle < -1.0), "{angles:?}");
    // Without springs, dampers and drives the energy is constant up to h⁴: 3.5e-8 J at 1e-3 s, a 16th of it at half the step.
    let rows = report["summary"].as_array().expect("a table");
    let balance = rows.iter().find(|row| row["quantity"] == "energy balance, largest error").expect("a row");
    assert!(balance["value"].as_f64().is_some_and(|error| error < 1e-7), "{balance}");
}

#[test]
fn a_crane_with_statics_starts_in_equilibrium() {
    let out = folder("at_rest");
    let path = out.to_str().expect("a path");
    let report = json(&["simulate", "eight_link_rigid", "--duration", "0.01", "--out", path, "--format", "json"]);
    assert_eq!(report["start"], "static equilibrium, at rest");
    assert_eq!(json(&["info", "eight_link_rigid", "--format", "json"])["start"], report["start"]);
}

#[test]
fn a_run_estimates_its_error_and_names_feet_that_pull() {
    let out = folder("verified");
    let path = out.to_str().expect("a path");
    let run = |more: &[&str]| {
        let common = ["simulate", "eight_link_flexible", "--duration", "1", "--format", "json", "--out", path];
        json(&[&common[..], more].concat())
    };
    let error = |report: &Value, quantity: &str| {
        let rows = report["extremes"].as_array().expect("a table").clone();
        rows.iter().find(|row| row["quantity"] == quantity).expect("a row")["error"].as_f64()
    };
    let verified = run(&["--tolerance", "1e-5"]);
    let finer = run(&["--tolerance", "1e-6", "--no-verify"]);
    assert_eq!(error(&finer, "boom_psi_drive_torque"), None);
    // The estimate is the difference of just these two runs, which is not less than that of their peaks.
    let peak = |report: &Value| {
        let rows = report["extremes"].as_array().expect("a table").clone();
        rows.iter().find(|row| row["quantity"] == "boom_psi_drive_torque").expect("a row")["maximum"].as_f64()
    };
    let difference = (peak(&verified).expect("a number") - peak(&finer).expect("a number")).abs();
    let estimate = error(&verified, "boom_psi_drive_torque").expect("an estimate");
    assert!(difference <= estimate && estimate > 0.0, "{difference} > {estimate}");
    let converged = run(&["--method", "rk4"]);
    assert_eq!(converged["cautions"], serde_json::json!([]));

    let overloaded = run(&["--set", "load_mass=6000"]);
    let cautions = overloaded["cautions"].to_string();
    assert!(cautions.contains("s5 (-") && cautions.contains("real feet would lift off"), "{cautions}");
    let record = fs::read_to_string(out.join("eight_link_flexible.json")).expect("a record");
    assert!(record.contains("real feet would lift off"), "{record}");
    let rest = json(&["statics", "eight_link_flexible", "--set", "load_mass=6000", "--format", "json"]);
    assert!(rest["cautions"].to_string().contains("s5 (-26.49 kN)"), "{}", rest["cautions"]);
}

#[test]
fn the_comparison_writes_figures() {
    let out = folder("comparison");
    let output = crane(&["--duration", "0.02", "--out", out.to_str().expect("a path")]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    for words in ["Deflection of the load points", "boom_psi_drive_torque", "real-time factor", "N m"] {
        assert!(printed.contains(words), "`{words}` not in: {printed}");
    }
    assert!(fs::metadata(out.join("report.html")).is_ok_and(|page| page.len() > 500_000));
    for figure in ["path", "drives", "deviation"] {
        let svg = fs::read_to_string(out.join(format!("comparison_{figure}.svg"))).expect("a figure");
        assert!(svg.starts_with("<svg width=\"") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("[m]") || svg.contains("[mm]") || svg.contains("[kN m]"), "{figure} has no units");
    }
}

#[test]
fn the_comparison_speaks_json() {
    let out = folder("comparison_json");
    let report = json(&["--duration", "0.02", "--format", "json", "--out", out.to_str().expect("a path")]);
    for table in ["pose", "drives", "reactions", "deflection", "summary", "files"] {
        assert!(report[table].as_array().is_some_and(|rows| !rows.is_empty()), "{table}: {report}");
    }
    // The boom bends under load: every load point hangs lower than on the rigid crane.
    let deflection = report["deflection"].as_array().expect("a table");
    assert!(deflection.iter().all(|row| row["z"].as_f64().is_some_and(|z| z < -50.0)), "{deflection:?}");
}

#[test]
fn an_impossible_load_is_told_not_panicked() {
    for (load, command) in [("1e12", "simulate"), ("1e12", "statics")] {
        let output = crane(&[command, "--set", &format!("load_mass={load}")]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command} {load}: {message}");
        assert!(message.contains("\nerror:") && !message.contains("panicked"), "{command} {load}: {message}");
        assert!(!message.contains("singular"), "{command} {load}: {message}");
        assert!(message.starts_with("warning[W010]"), "{command} {load}: {message}");
    }
    refused(&["statics", "--set", "load_mass=1e300"], &["outside the allowed range: 1e300 [E033]"]);
}

#[test]
fn a_step_beyond_stability_ends_with_advice() {
    let out = folder("blown_up");
    let output = crane(&["simulate", "--step", "2e-3", "--force", "--out", out.to_str().expect("a path")]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    for words in
        ["unstable", "at t = ", "largest stable step is 1.215e-4 s", "smaller step than 2.00e-3 s", "2.785/(βω²)"]
    {
        assert!(message.contains(words), "`{words}` not in: {message}");
    }
    assert!(!out.join("eight_link_flexible.csv").exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("in_the_way");
    fs::write(&file, "").expect("a file");
    let inside = file.join("out");
    let output =
        crane(&["simulate", "double_pendulum", "--duration", "0.01", "--out", inside.to_str().expect("a path")]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("in_the_way"), "{}", text(&output.stderr));
}

#[test]
fn evaluation_is_shaped_as_announced() {
    let all = "transforms,transform_derivatives,transform_second_derivatives,mass_matrix,bias";
    let report = json(&["eval", "double_pendulum", "--q", "0.3,-0.2", "--v", "1 2", "--quantities", all]);
    let length = |key: &str| report[key].as_array().expect("an array").len();
    assert_eq!(length("mass_matrix"), 2);
    assert_eq!(length("bias"), 2);
    assert_eq!(length("transforms"), length("bodies"));
    assert_eq!(length("transform_derivatives"), length("transform_derivatives_index"));
    assert_eq!(length("transform_second_derivatives"), length("transform_second_derivatives_index"));
    let npz = crane(&["eval", "double_pendulum", "--format", "npz"]);
    assert!(npz.status.success());
    // A ZIP archive of NPY members, stored.
    assert!(npz.stdout.starts_with(b"PK\x03\x04"));
    assert!(npz.stdout.windows(6).any(|bytes| bytes == b"\x93NUMPY"));
}

/// The motion in a row of results, with its accelerations; about a motion the state matrix has their derivatives.
#[test]
fn a_moment_of_a_run_is_linearised() {
    let folder = folder("moment").display().to_string();
    let run = crane(&[
        "simulate",
        "double_pendulum",
        "--start",
        "upper_theta=0.5",
        "--duration",
        "0.2",
        "--output",
        "0.1",
        "--out",
        &folder,
    ]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let results = format!("{folder}/double_pendulum.csv");
    let found = json(&["linearise", "double_pendulum", "--from", &results, "--time", "0.1", "--format", "json"]);
    assert_eq!((found["about"].as_str(), found["time"].as_f64()), (Some("a moment of a run"), Some(0.1)));
    let column = |key: &str| -> Vec<f64> {
        let rows = found["motion"].as_array().expect("a table");
        rows.iter().map(|row| row[key].as_f64().expect("a number")).collect()
    };
    let joined = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let (q, v) = (column("position"), column("rate"));
    let accelerations = |q: &[f64]| -> Vec<f64> {
        let state = ["--q", &joined(q), "--v", &joined(&v), "--quantities", "accelerations"];
        let found = json(&[&["eval", "double_pendulum"], &state[..]].concat());
        found["accelerations"].as_array().expect("numbers").iter().map(|a| a.as_f64().expect("a number")).collect()
    };
    assert_eq!(column("acceleration"), accelerations(&q));
    // A ∂q̈/∂q = −K, by central differences over 1e-5 rad: 1e-10 by their order, 1e-11 by rounding.
    let entry = |key: &str, i: usize, j: usize| found[key][i][j].as_f64().expect("a number");
    for j in 0..2 {
        let [ahead, behind] = [1e-5, -1e-5].map(|by| {
            let mut q = q.clone();
            q[j] += by;
            accelerations(&q)
        });
        for i in 0..2 {
            let product: f64 = (0..2).map(|k| entry("mass", i, k) * (ahead[k] - behind[k]) / 2e-5).sum();
            let size = entry("stiffness", i, i).abs();
            assert!((product + entry("stiffness", i, j)).abs() < 1e-8 * size, "{i} {j}: {product}");
        }
    }
    refused(
        &["linearise", "double_pendulum", "--from", &results, "--time", "0.13"],
        &["no row at t = 0.13 s", "the nearest row is at t = 0.1 s"],
    );
    refused(
        &["linearise", "double_pendulum", "--hold", "uper_theta=1"],
        &["no coordinate `uper_theta`", "`upper_theta`"],
    );
    refused(&["linearise", "double_pendulum", "--hold", "upper_theta=high"], &["`high` is not a valid value"]);
    refused(&["linearise", "double_pendulum", "-o", "a.json"], &["has not the ending .npz"]);
    refused(&["linearise", "eight_link_hydraulic"], &["pressures of its cylinders", "`crane modes`"]);
    let sticking = std::path::Path::new(&folder).join("arm.yaml");
    let spec = "format: 1\nname: arm\nlinks: [{name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [0, 0, -1]}]\n\
                friction: {arm_theta: {coulomb: 5, bristle: {stiffness: 1e4, damping: 30}}}\n";
    fs::write(&sticking, spec).expect("a file");
    refused(&["linearise", sticking.to_str().expect("a path")], &["bristles of its joints", "`crane modes`"]);
}

/// A run in two halves ends where one of the same length does, to the tolerance, where nothing is driven.
#[test]
fn a_run_goes_on_from_the_end_of_another() {
    let folder = folder("in_two_halves");
    let file = |name: &str| folder.join(name).join("double_pendulum.csv");
    let run = |name: &str, more: &[&str]| {
        let place = folder.join(name).display().to_string();
        let arguments = ["simulate", "double_pendulum", "--method", "bdf", "--tolerance", "1e-10", "--out", &place];
        let output = crane(&[&arguments[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let csv = fs::read_to_string(file(name)).expect("results");
        let last = csv.lines().last().expect("a row").to_owned();
        last.split(',').map(|number| number.parse().expect("a number")).collect::<Vec<f64>>()
    };
    let given = ["--start", "upper_theta=0.5", "--start", "lower_theta_rate=-1"];
    let whole = run("whole", &[&["--duration", "1"], &given[..]].concat());
    run("half", &[&["--duration", "0.5"], &given[..]].concat());
    let first = file("half").display().to_string();
    let second = run("second", &["--duration", "0.5", "--from", &first]);
    // Time, two coordinates, two rates; errors of 1e-10 grow tenfold in a second.
    for (whole, halves) in whole[1..5].iter().zip(&second[1..5]) {
        assert!((whole - halves).abs() < 1e-7, "{whole} {halves}");
    }
    assert!(whole[1..5].iter().all(|x| x.abs() > 1e-3));
    refused(
        &["simulate", "double_pendulum", "--start", "uper_theta=1"],
        &["no coordinate `uper_theta`", "`upper_theta`"],
    );
    refused(
        &["simulate", "double_pendulum", "--start", "upper_theta=x"],
        &["`x` is not a valid value for upper_theta"],
    );
    refused(&["simulate", "double_pendulum", "--from", "no_such.csv"], &["no_such.csv"]);
}

/// A state of many is what it is alone, and nothing is there that was not asked for.
#[test]
fn many_states_are_evaluated_at_once() {
    let names = "points,point_velocities,forces,accelerations,static_residual,tangent_stiffness,energies,drive_efforts";
    let asked =
        |q: &str, v: &str| json(&["eval", "knuckle_boom", "--q", q, "--v", v, "--quantities", names, "--time", "0.5"]);
    let (first, second) = ("0.1,0.2,0.3,0.4", "0.2,0.1,-0.3,0.5");
    let both = asked(&format!("{first},{second}"), "1,2,3,4");
    assert!(both.get("transforms").is_none());
    for (place, q) in [first, second].into_iter().enumerate() {
        let one = asked(q, "1,2,3,4");
        for name in names.split(',') {
            assert_eq!(both[name][place], one[name], "{name}");
        }
    }
    refused(
        &["eval", "knuckle_boom", "--q", &format!("{first},{second}"), "--v", &[first; 3].join(",")],
        &["`--q` has 2 states, but `--v` has 3"],
    );
}

#[test]
fn every_crane_is_listed_described_and_analysed() {
    let list = json(&["list", "--format", "json"]);
    let cranes = list["cranes"].as_array().expect("cranes");
    assert!(cranes.len() >= 7);
    for name in cranes.iter().map(|crane| crane["name"].as_str().expect("a name")) {
        for command in ["info", "statics", "modes"] {
            let output = crane(&[command, name]);
            assert!(output.status.success(), "{command} {name}: {}", text(&output.stderr));
        }
    }
}

/// One of several states of forces: the others are those that hold the pose.
#[test]
fn a_start_may_name_one_state() {
    let out = folder("one_state");
    let out = out.to_str().expect("a path");
    for state in ["boom_cylinder_valve=0.1", "rotator_psi_bristle=1e-5"] {
        let run =
            ["simulate", "eight_link_hydraulic", "--duration", "0.05", "--no-verify", "--out", out, "--start", state];
        let output = crane(&run);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    refused(
        &["simulate", "knuckle_boom", "--ensemble", "rows.csv", "--start", "hook_theta=1"],
        &["do not apply to `--ensemble`"],
    );
}

#[test]
fn a_new_crane_is_a_crate_with_the_comments_of_its_spec() {
    // The folder stands in one of the test's own; its name is the crane's.
    let parent = folder("new");
    let path = parent.join("my-crane");
    let arguments = ["new", path.to_str().expect("a path"), "--from", "knuckle-boom"];
    let output = crane(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let read = |file: &str| fs::read_to_string(path.join(file)).expect(file);
    let spec = read("crane.yaml");
    assert!(spec.contains("\nname: my_crane\n") && spec.contains("# passive"), "{spec}");
    assert!(read("src/main.rs").contains("use my_crane::my_crane::{Crane, N};"));
    assert!(read("Cargo.toml").contains("name = \"my-crane\""));
    let files = ["Cargo.toml", "README.md", "build.rs", "src/lib.rs", "src/main.rs", "tests/identities.rs"];
    for file in files {
        assert!(!read(file).contains("{{"), "{file}");
    }
    assert!(read("build.rs").lines().count() <= 10);
    refused(&arguments, &["already exists"]);
    refused(&["new", "My crane"], &["not a valid name for a crate", "such as my-crane"]);
    refused(&["new", "fn"], &["`fn` is not a valid name: a keyword of Rust", "`fn_1`"]);
    refused(&["new", "crane-model"], &["`crane-model` is the name of a crate", "my-crane-model"]);
    refused(&["new", "other", "--from", "cantilver"], &["no crane `cantilver`", "`cantilever`"]);
}

/// With what it depends on, a crate names no path outside of its folder, and cargo can read all of its manifests.
#[test]
fn a_new_crate_can_have_what_it_depends_on() {
    let folder = folder("new_vendored").join("mine");
    let output = crane(&["new", folder.to_str().expect("a path"), "--vendor"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for manifest in ["Cargo.toml", "crates/crane-model/Cargo.toml", "crates/codegen/Cargo.toml"] {
        let written = fs::read_to_string(folder.join(manifest)).expect(manifest);
        let paths = written.lines().filter_map(|line| line.split_once("path = \"")?.1.split('"').next());
        for path in paths {
            assert!(path.starts_with("crates/") && folder.join(path).join("Cargo.toml").exists(), "{manifest}: {path}");
        }
    }
    let cargo = std::process::Command::new(env!("CARGO"))
        .args(["metadata", "--offline", "--format-version", "1", "--no-deps"])
        .current_dir(&folder)
        .output()
        .expect("cargo runs");
    assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
}

#[test]
fn a_new_crate_starts_from_a_spec_of_your_own() {
    let out = folder("new_from_file");
    fs::create_dir_all(&out).expect("a folder");
    let (spec, target) = (out.join("mine.yaml"), out.join("their-crane"));
    let shipped = fs::read_to_string("../../specs/double_pendulum.yaml").expect("a spec");
    let mine = shipped.replace("name: double_pendulum\n", "name: \"mine\"   # a comment\n");
    fs::write(&spec, &mine).expect("a file");
    let output = crane(&["new", target.to_str().expect("a path"), "--from", spec.to_str().expect("a path")]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = fs::read_to_string(target.join("crane.yaml")).expect("a spec");
    assert_eq!(written, mine.replace("name: \"mine\"", "name: \"their_crane\""));
    // A name that is not on a line of its own.
    fs::write(&spec, "{format: 1, name: mine, links: [{name: a, joint: revolute, mass: 1, com: [1, 0, 0]}]}\n")
        .expect("a file");
    let elsewhere = out.join("other-crane");
    let output = crane(&["new", elsewhere.to_str().expect("a path"), "--from", spec.to_str().expect("a path")]);
    assert!(text(&output.stderr).contains("write `name: mine` on a line of its own"), "{}", text(&output.stderr));
    assert!(!elsewhere.exists());
}

#[test]
fn help_groups_commands_by_task() {
    let help = text(&crane(&["--help"]).stdout);
    let place = |words: &str| help.find(words).unwrap_or_else(|| panic!("`{words}` not in: {help}"));
    assert!(place("Describe a crane:") < place("  check ") && place("  check ") < place("Compute:"), "{help}");
    assert!(place("Compute:") < place("  statics ") && place("  statics ") < place("For developers:"), "{help}");
    assert!(place("For developers:") < place("  schema ") && place("  schema ") < place("Options:"), "{help}");
    assert!(place("Options:") < place("Exit codes:"), "{help}");
}

#[test]
fn a_closed_pipe_is_no_error() {
    for arguments in [&["eval"][..], &["completions", "bash"], &["--help"], &["info"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_crane"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        drop(child.stdout.take());
        let mut message = String::new();
        let stderr = child.stderr.as_mut().expect("a pipe");
        stderr.read_to_string(&mut message).expect("text");
        assert!(child.wait().expect("an end").success(), "{arguments:?}: {message}");
        assert!(message.is_empty(), "{arguments:?}: {message}");
    }
}

#[test]
fn an_unstable_step_is_refused_unless_forced() {
    let out = folder("unstable");
    let path = out.to_str().expect("a path");
    let refused = crane(&["simulate", "eight_link_rigid", "--step", "5e-3", "--out", path]);
    assert_eq!(refused.status.code(), Some(1));
    let message = text(&refused.stderr);
    for words in ["a step of 5e-3 s is unstable", "drive of telescope_z", "--step auto", "--force"] {
        assert!(message.contains(words), "{message}");
    }
    // Stable at the start, where the limit is 6.2e-3 s, and not at the end.
    let forced = crane(&["simulate", "eight_link_rigid", "--step", "5e-3", "--force", "--out", path]);
    let message = text(&forced.stderr);
    assert_eq!(forced.status.code(), Some(1));
    assert!(message.contains("the run is unstable: at t = ") && message.contains("telescope_z"), "{message}");
    assert!(!out.join("eight_link_rigid.csv").exists());
    let report = json(&["simulate", "eight_link_rigid", "--step", "auto", "--out", path, "--format", "json"]);
    // 90 % of 4.57e-3 s, and a whole number of times in 0.01 s.
    assert!((report["step"].as_f64().expect("a number") - 0.01 / 3.0).abs() < 1e-12, "{}", report["step"]);
}

#[test]
fn stability_names_what_limits_the_step_and_draws_it() {
    let out = folder("stability");
    let path = out.to_str().expect("a path");
    let report = json(&["stability", "--out", path, "--format", "json"]);
    let limits = report["limits"].as_array().expect("a table");
    let rk4 = limits.iter().find(|row| row["method"] == "rk4").expect("a row");
    let step = rk4["step"].as_f64().expect("a number");
    // 2.785/22,921 rad/s.
    assert!((step - 1.2152e-4).abs() < 1e-8, "{step}");
    assert!(rk4["limited_by"].as_str().is_some_and(|words| words.starts_with("torsion of boom elements 3, 2; 22,9")));
    let svg = fs::read_to_string(out.join("eight_link_flexible_stability.svg")).expect("a figure");
    assert!(svg.starts_with("<svg") && svg.contains("Re hλ") && svg.matches("<circle").count() > 40);
}

/// A table for `--ensemble`.
fn table(name: &str, text: &str) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, text).expect("a file");
    path.to_str().expect("a path").to_owned()
}

#[test]
fn a_table_with_mistakes_is_refused_with_its_place() {
    for (text, said) in [
        ("payload,paylod\n1,2\n", &["line 1, column 2", "no live parameter `paylod`", "did you mean `payload`?"][..]),
        ("payload,payload\n1,2\n", &["line 1, column 2", "occurs twice"]),
        ("payload [t]\n1\n", &["line 1, column 1", "in kg, not in t", "`payload [kg]`"]),
        (
            "payload\n100\nheavy\n",
            &["line 3, column 1", "`heavy` is not a valid value for payload", "in kg, such as 800"],
        ),
        ("payload\ninf\n", &["line 2, column 1", "finite"]),
        (
            "payload\n100\n-1e6\n",
            &["line 3, column 1", "the mass of body `load` must not be negative, but is -1000000 [E032]"],
        ),
        ("payload\n1,2\n", &["line 2: 2 fields, but the header names 1"]),
        ("payload\n", &["has no rows"]),
        ("", &["has no rows"]),
    ] {
        refused(&["simulate", "knuckle_boom", "--ensemble", &table("mistakes.csv", text)], said);
    }
    refused(&["simulate", "knuckle_boom", "--ensemble", "no_such_table.csv"], &["cannot use no_such_table.csv"]);
    refused(&["simulate", "knuckle_boom", "--threads", "2"], &["--ensemble"]);
    refused(&["simulate", "knuckle_boom", "--ensemble", "t.csv", "--threads", "0"], &["--threads", "1 or more"]);
    refused(&["run", "knuckle_boom", "--ensemble", "t.csv"], &["does not support `--ensemble`", "crane simulate"]);
}

#[test]
fn an_ensemble_writes_a_row_for_every_crane() {
    let out = folder("ensemble");
    let file = out.join("peaks.csv");
    // Nine cranes: a batch, and one more. The fifth has a load that its drives cannot hold.
    let loads = ["0", "100", "200", "300", "1e12", "500", "600", "700", "800"];
    let loads_file = table("loads.csv", &format!("payload [kg]\n{}\n", loads.join("\n")));
    let arguments = ["simulate", "knuckle_boom", "--ensemble", &loads_file, "--duration", "0.5", "--format", "json"];
    let by_rk4 = ["--method", "rk4", "-o", file.to_str().expect("a path"), "--threads", "2"];
    let output = crane(&[&arguments[..], &by_rk4].concat());
    assert_eq!(output.status.code(), Some(1), "a row that failed");
    assert!(text(&output.stderr).contains("1 of 9 cranes did not reach the end"), "{}", text(&output.stderr));
    let report: serde_json::Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!((&report["cranes"], &report["reached_the_end"]), (&9.into(), &8.into()));
    assert_eq!(report["step"], 1e-3);

    let mut csv = csv::Reader::from_path(&file).expect("a CSV file");
    let header = csv.headers().expect("a header").clone();
    let named = |column: &str| ["cautions", "status"].contains(&column) || column.ends_with(']');
    assert!(header.iter().all(named), "{header:?}");
    let rows: Vec<_> = csv.records().map(|row| row.expect("a row")).collect();
    let column = |name: &str| header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{header:?}"));
    let torques = ["min", "max"].map(|end| column(&format!("main_boom_theta_drive_torque_{end} [N m]")));
    let status = column("status");
    assert_eq!(rows.len(), loads.len());
    let mut before = 0.0;
    for (row, load) in rows.iter().zip(loads) {
        assert_eq!(row[0].parse::<f64>(), load.parse::<f64>());
        if load == "1e12" {
            assert!(row[torques[0]].is_empty() && row[status].contains("statics did not find"), "{row:?}");
        } else {
            // More load, more torque.
            let ends = torques.map(|column| row[column].parse::<f64>().expect("a number").abs());
            let peak = ends[0].max(ends[1]);
            assert!(peak > before && &row[status] == "done", "{row:?}");
            before = peak;
        }
    }
    // The last row is the spec's crane: as its own run.
    json(&[
        "simulate",
        "knuckle_boom",
        "--method",
        "rk4",
        "--duration",
        "0.5",
        "--out",
        out.to_str().expect("a path"),
        "--format",
        "json",
    ]);
    let mut run = csv::Reader::from_path(out.join("knuckle_boom.csv")).expect("a CSV file");
    let name = "main_boom_theta_drive_torque [N m]";
    let place = run.headers().expect("a header").iter().position(|column| column == name).expect("a column");
    let single = run
        .records()
        .map(|row| row.expect("a row")[place].parse().expect("a number"))
        .fold(0.0_f64, |m, x: f64| m.max(x.abs()));
    // One crane and eight lanes by the same method: roundings.
    assert!((single - before).abs() < 1e-8 * single, "{single} {before}");
}

#[test]
fn an_ensemble_by_the_default_method_is_its_single_runs() {
    let out = folder("ensemble_bdf");
    let file = out.join("peaks.csv");
    let loads_file = table("two_loads.csv", "payload [kg]\n200\n800\n");
    let arguments = ["simulate", "knuckle_boom", "--ensemble", &loads_file, "--duration", "1", "--format", "json"];
    let report = json(&[&arguments[..], &["-o", file.to_str().expect("a path")]].concat());
    assert_eq!(report["method"], "bdf");
    let mut csv = csv::Reader::from_path(&file).expect("a CSV file");
    let header = csv.headers().expect("a header").clone();
    let place =
        |header: &csv::StringRecord, name: &str| header.iter().position(|column| column == name).expect("a column");
    for (row, load) in csv.records().zip(["200", "800"]) {
        let row = row.expect("a row");
        let number = |name: &str| row[place(&header, name)].parse::<f64>().expect("a number");
        let set = format!("payload={load}");
        let arguments =
            ["simulate", "knuckle_boom", "--set", &set, "--duration", "1", "--no-verify", "--format", "json"];
        let run = json(&[&arguments[..], &["--out", out.to_str().expect("a path")]].concat());
        let extremes = run["extremes"].as_array().expect("a table");
        let torque = extremes.iter().find(|row| row["quantity"] == "main_boom_theta_drive_torque").expect("a row");
        // The same steps of the same crane: not a bit differs, but in the rounding of times.
        for (column, key) in [("min", "minimum"), ("max", "maximum")] {
            assert_eq!(number(&format!("main_boom_theta_drive_torque_{column} [N m]")), torque[key], "{load} {key}");
        }
        let time = torque["time_of_maximum"].as_f64().expect("a time");
        assert!((number("main_boom_theta_drive_torque_max_time [s]") - time).abs() < 1e-9);
    }
}
