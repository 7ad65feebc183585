//! The suite of stiff and extreme cases, as `crane-lab stress` runs it.

use std::{fs, path::PathBuf, process::Command};

use serde_json::Value;

fn lab(arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_crane-lab")).args(arguments).output().expect("the command starts")
}

#[test]
fn every_quick_case_goes_as_expected() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("stress");
    let output = lab(&["stress", "--quick", "--format", "json", "--out", &folder.to_string_lossy()]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{error}");

    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let cases = report["cases"].as_array().expect("a table");
    assert!(cases.len() > 120, "{} cases", cases.len());
    for case in cases {
        assert_eq!(case["verdict"], "ok", "{case}");
    }
    let table = fs::read_to_string(folder.join("stress.csv")).expect("a table");
    assert_eq!(table.lines().next(), Some("group,case,expected,happened,verdict"));
    assert_eq!(table.lines().count(), cases.len() + 1);
    let page = fs::read_to_string(folder.join("stress.md")).expect("a page");
    assert!(page.contains("## Buckling") && page.contains("| ok |"));
}

#[test]
fn a_word_that_no_case_has_is_refused() {
    let output = lab(&["stress", "--only", "teapot"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("`teapot`"));
}
