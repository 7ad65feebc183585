//! The suite of stiff and extreme cases, as `crane-lab stress` runs it.

use std::{collections::BTreeSet, fs, path::PathBuf, process::Command};

use serde_json::Value;

fn lab(arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_crane-lab")).args(arguments).output().expect("the command starts")
}

/// A line with `#` for each run of digits, points and exponents.
fn without_numbers(line: &str) -> String {
    let mut words = String::new();
    let mut in_number = false;
    for c in line.chars() {
        let of_number = c.is_ascii_digit() || in_number && matches!(c, '.' | 'e' | '-');
        if of_number && !in_number {
            words.push('#');
        }
        if !of_number {
            words.push(c);
        }
        in_number = of_number;
    }
    words
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
    // Each case is counted once, and as expected.
    let counts = |column: usize| -> usize {
        let rows = page.lines().filter_map(|row| row.split(" | ").nth(column)?.parse::<usize>().ok());
        rows.sum()
    };
    assert_eq!([counts(1), counts(2)], [cases.len(); 2], "{page}");
    // The table of the manual has each of these cases in the same words; another processor may round numbers differently.
    let written =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/stress.csv")).expect("docs/stress.csv");
    let written: BTreeSet<String> = written.lines().map(without_numbers).collect();
    for line in table.lines() {
        assert!(
            written.contains(&without_numbers(line)),
            "docs/stress.csv lacks {line}: `crane-lab stress --out docs`"
        );
    }
}

#[test]
fn a_word_that_no_case_has_is_refused() {
    let output = lab(&["stress", "--only", "teapot"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("`teapot`"));
}
