//! Numbers with units as arguments.

use super::{crane, text};

/// What a command prints with two ways to write the same number.
fn same(arguments: &[&str], [with, without]: [[&str; 2]; 2]) {
    let printed = |given: &[&str]| {
        let output = crane(&[arguments, given].concat());
        assert!(output.status.success(), "{given:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    // Conversion rounds once, so all digits are the same.
    assert_eq!(printed(&with), printed(&without), "{with:?}");
}

#[test]
fn arguments_take_units() {
    let statics = ["statics", "knuckle_boom", "--format", "json", "--reproducible"];
    same(&statics, [["--set", "payload=0.9t"], ["--set", "payload=900"]]);
    same(&statics, [["--set", "payload=900 kg"], ["--set", "payload=900"]]);
    same(&statics, [["--hold", "main_boom_theta=-500 mrad"], ["--hold", "main_boom_theta=-0.5"]]);
    same(&statics, [["--range", "payload=0:1.5t:3"], ["--range", "payload=0:1500:3"]]);
    let out = concat!(env!("CARGO_TARGET_TMPDIR"), "/units");
    let run = ["run", "double_pendulum", "--duration", "0.1", "--out", out, "--format", "json", "--reproducible"];
    same(&run, [["--start", "upper_theta=0.2"], ["--start", "upper_theta=200 mrad"]]);
}

#[test]
fn wrong_units_are_told() {
    for (argument, title, help) in [
        (["--set", "payload=1.5m"], "payload is in kg, and `1.5m` is a length (m)", "in kg"),
        (["--set", "payload=1.5 tons"], "there is no unit `tons`", "did you mean `t`?"),
        (["--hold", "main_boom_theta=500mm"], "main_boom_theta is in rad, and `500mm` is a length (m)", "in rad"),
        (["--range", "payload=0:1.5bar:3"], "payload is in kg, and `0bar` is a pressure (Pa)", "in kg"),
    ] {
        let output = crane(&[&["statics", "knuckle_boom"], &argument[..]].concat());
        let said = text(&output.stderr);
        assert!(!output.status.success() && said.contains(title) && said.contains(help), "{argument:?}: {said}");
    }
}
