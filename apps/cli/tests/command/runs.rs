//! Runs: results, starts, steps and stability.

use std::{fs, path::Path};

use serde_json::Value;

use super::{crane, folder, json, refused, text};

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
    // The estimate is the largest difference between these same two runs, which is at least that of their peaks.
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

/// Without drives, a run in two halves ends in the same state as one of the same total length, to the tolerance.
#[test]
fn a_run_goes_on_from_the_end_of_another() {
    let folder = folder("in_two_halves");
    let file = |name: &str| folder.join(name).join("double_pendulum.csv");
    let run = |name: &str, more: &[&str]| {
        let path = folder.join(name).display().to_string();
        let arguments = ["simulate", "double_pendulum", "--method", "bdf", "--tolerance", "1e-10", "--out", &path];
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
    // As a spreadsheet writes it where numbers have commas.
    let separated = folder.join("separated.csv");
    fs::write(&separated, "t [s];upper_theta [rad]\n0;1,5\n").expect("a file");
    let separated = separated.to_str().expect("a path");
    refused(
        &["simulate", "double_pendulum", "--from", separated],
        &["separated.csv has semicolons between columns", "with commas between columns and decimal points"],
    );
    refused(
        &["simulate", "eight_link_hydraulic", "--start", "boom_cylinder_valve=7"],
        &["`boom_cylinder_valve` is 7", "give an opening from −1"],
    );
    // Results without pressures give no force states to continue with.
    let csv = folder.join("pose.csv");
    fs::write(&csv, "t [s],column_psi_rate [rad/s]\n0,0.01\n").expect("a file");
    let from = ["--from", csv.to_str().expect("a path"), "--duration", "0.01", "--output", "0.01"];
    let out = folder.display().to_string();
    let run = crane(&[&["simulate", "eight_link_hydraulic", "--out", &out], &from[..]].concat());
    assert!(
        text(&run.stdout).contains("pose.csv, pressures, bristles and feet as they hold this pose"),
        "{}",
        text(&run.stdout)
    );
}

/// One of several force states is given: the others take the values that hold the pose.
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
    // At most 90 % of 4.57e-3 s, and a whole number of steps in 0.01 s.
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
    // 2.785/(22,921 rad/s).
    assert!((step - 1.2152e-4).abs() < 1e-8, "{step}");
    assert!(rk4["limited_by"].as_str().is_some_and(|words| words.starts_with("torsion of boom elements 3, 2; 22,9")));
    let svg = fs::read_to_string(out.join("eight_link_flexible_stability.svg")).expect("a figure");
    assert!(svg.starts_with("<svg") && svg.contains("Re hλ") && svg.matches("<circle").count() > 40);
}

/// The bytes of everything that a command prints and writes.
fn everything(arguments: &[&str], out: &Path) -> Vec<Vec<u8>> {
    let _ = fs::remove_dir_all(out);
    let output = crane(&[arguments, &["--out", out.to_str().expect("a path")]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut files: Vec<_> = fs::read_dir(out).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    [output.stdout].into_iter().chain(files.iter().map(|file| fs::read(file).expect("a file"))).collect()
}

#[test]
fn reproducible_results_are_the_same_bytes_again() {
    let out = folder("reproducible");
    let arguments = ["run", "double_pendulum", "--duration", "0.5", "--format", "json", "--reproducible"];
    let [one, other] = [(); 2].map(|()| everything(&arguments, &out));
    assert!(one.len() > 3 && one == other);
    let says = |all: &[Vec<u8>], word: &str| all.iter().any(|bytes| text(bytes).contains(word));
    for word in ["wall_time_s", "real_time_factor", "wall time"] {
        assert!(!says(&one, word), "{word}");
        assert!(says(&everything(&arguments[..6], &out), word), "{word}");
    }
}

#[test]
fn a_run_of_too_many_steps_names_their_number_and_time() {
    let output = crane(&["simulate", "knuckle_boom", "--step", "2e-9", "--duration", "10", "--quiet"]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    for words in ["knuckle_boom: a run of 10 s takes 5.0e9 steps of 2.0e-9 s, about", "--force"] {
        assert!(message.contains(words), "`{words}` not in: {message}");
    }
}
