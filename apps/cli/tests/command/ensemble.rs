//! Runs of many cranes from a table.

use std::{fs, path::PathBuf};

use super::{crane, folder, json, refused, text};

/// A table for `--ensemble`.
fn table(name: &str, text: &str) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, text).expect("a file");
    path.to_str().expect("a path").to_owned()
}

#[test]
fn a_table_with_mistakes_is_refused_with_its_place() {
    for (text, words) in [
        ("payload;length\n900;0,006\n", &["semicolons between columns", "commas between columns"][..]),
        ("payload,paylod\n1,2\n", &["line 1, column 2", "no live parameter `paylod`", "did you mean `payload`?"][..]),
        ("payload,payload\n1,2\n", &["line 1, column 2", "occurs twice"]),
        ("payload [bar]\n1\n", &["line 1, column 1", "in kg, not in bar", "`payload [kg]`"]),
        ("payload [t]\nheavy\n", &["line 2, column 1", "write a finite number, in t"]),
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
        refused(&["simulate", "knuckle_boom", "--ensemble", &table("mistakes.csv", text)], words);
    }
    refused(&["simulate", "knuckle_boom", "--ensemble", "no_such_table.csv"], &["cannot use no_such_table.csv"]);
    refused(&["simulate", "knuckle_boom", "--threads", "2"], &["--ensemble"]);
    refused(&["simulate", "knuckle_boom", "--ensemble", "t.csv", "--threads", "0"], &["--threads", "1 or more"]);
    refused(&["run", "knuckle_boom", "--ensemble", "t.csv"], &["unexpected argument", "--ensemble"]);
}

#[test]
fn an_ensemble_writes_a_row_for_every_crane() {
    let out = folder("ensemble");
    let file = out.join("peaks.csv");
    // Nine cranes: a batch of eight, and one more. The fifth has a load that its drives cannot hold.
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
    // The last row is the crane of the spec, so it equals that crane's own run.
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
    let index = run.headers().expect("a header").iter().position(|column| column == name).expect("a column");
    let single = run
        .records()
        .map(|row| row.expect("a row")[index].parse().expect("a number"))
        .fold(0.0_f64, |m, x: f64| m.max(x.abs()));
    // One crane and eight lanes, by the same method, differ only by rounding.
    assert!((single - before).abs() < 1e-8 * single, "{single} {before}");
}

#[test]
fn an_ensemble_by_the_default_method_is_its_single_runs() {
    let out = folder("ensemble_bdf");
    let file = out.join("peaks.csv");
    let loads_file = table("two_loads.csv", "payload [t]\n0.2\n0.8\n");
    let arguments = ["simulate", "knuckle_boom", "--ensemble", &loads_file, "--duration", "1", "--format", "json"];
    let report = json(&[&arguments[..], &["-o", file.to_str().expect("a path")]].concat());
    assert_eq!(report["method"], "bdf");
    let mut csv = csv::Reader::from_path(&file).expect("a CSV file");
    let header = csv.headers().expect("a header").clone();
    let index_of =
        |header: &csv::StringRecord, name: &str| header.iter().position(|column| column == name).expect("a column");
    for (row, load) in csv.records().zip(["200", "800"]) {
        let row = row.expect("a row");
        let number = |name: &str| row[index_of(&header, name)].parse::<f64>().expect("a number");
        let set = format!("payload={load}");
        let arguments =
            ["simulate", "knuckle_boom", "--set", &set, "--duration", "1", "--no-verify", "--format", "json"];
        let run = json(&[&arguments[..], &["--out", out.to_str().expect("a path")]].concat());
        let extremes = run["extremes"].as_array().expect("a table");
        let torque = extremes.iter().find(|row| row["quantity"] == "main_boom_theta_drive_torque").expect("a row");
        // The same steps of the same crane: equal to the bit, except for the rounding of times.
        for (column, key) in [("min", "minimum"), ("max", "maximum")] {
            assert_eq!(number(&format!("main_boom_theta_drive_torque_{column} [N m]")), torque[key], "{load} {key}");
        }
        let time = torque["time_of_maximum"].as_f64().expect("a time");
        assert!((number("main_boom_theta_drive_torque_max_time [s]") - time).abs() < 1e-9);
    }
}
