//! Files that the command reads and writes: links, devices, pipes, endless ones.

use std::fs;

use super::{crane, folder, refused, text};

#[cfg(unix)]
#[test]
fn links_stay_links_and_devices_devices() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let out = folder("links");
    fs::create_dir_all(&out).expect("a folder");
    let [real, link] = ["real.rs", "link.rs"].map(|name| out.join(name));
    fs::write(&real, "").expect("a file");
    symlink("real.rs", &link).expect("a link");
    let output = crane(&["generate", "double_pendulum", "-o", link.to_str().expect("a path")]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(fs::symlink_metadata(&link).expect("a link").is_symlink());
    assert!(fs::read_to_string(&real).expect("text").contains("pub struct Crane"));
    let output = crane(&["generate", "double_pendulum", "-o", "/dev/full"]);
    assert!(fs::metadata("/dev/full").expect("a device").file_type().is_char_device());
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("free some space"), "{}", text(&output.stderr));
    // A table of results, too, says what to do about a full disk.
    let output = crane(&["statics", "knuckle_boom", "--range", "payload=0:500:2", "-o", "/dev/full"]);
    assert!(text(&output.stderr).contains("free some space"), "{}", text(&output.stderr));
    let output = crane(&["generate", "double_pendulum", "-o", "/dev/stdout"]);
    assert!(text(&output.stdout).contains("pub struct Crane"), "{}", text(&output.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn what_never_ends_is_not_read() {
    let out = folder("endless");
    fs::create_dir_all(&out).expect("a folder");
    let pipe = out.join("pipe.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
    assert!(made.success());
    for file in ["/dev/zero", pipe.to_str().expect("a path")] {
        refused(&["simulate", "knuckle_boom", "--ensemble", file], &["it is a device or a named pipe"]);
        refused(&["simulate", "knuckle_boom", "--from", file], &["it is a device or a named pipe"]);
        refused(&["eval", "knuckle_boom", "--q", file], &["it is a device or a named pipe"]);
    }
    let spec = out.join("pipe.yaml");
    fs::rename(&pipe, &spec).expect("a pipe");
    let output = crane(&["check", spec.to_str().expect("a path")]);
    assert!(output.status.code() == Some(1) && text(&output.stderr).contains("named pipe"), "{}", text(&output.stderr));
}

#[test]
fn a_table_does_not_overwrite_itself() {
    let out = folder("itself");
    fs::create_dir_all(&out).expect("a folder");
    let table = out.join("t.csv");
    fs::write(&table, "payload\n200\n").expect("a table");
    let name = table.to_str().expect("a path");
    refused(&["simulate", "knuckle_boom", "--ensemble", name, "-o", name], &["is an input of this command"]);
    assert_eq!(fs::read_to_string(&table).expect("a table"), "payload\n200\n");
}

/// A crane whose motion comes from a file, and a value of its parameter that is an angle.
const TURNED: &str = "format: 1
name: turned
parameters: {angle: {value: 10 deg, unit: rad}, load: {value: 10, unit: kg}}
links:
  - {name: column, joint: revolute, mass: 100, com: [0.1, 0, 0]}
  - {name: boom, joint: {revolute: {axis: y}}, mass: load, com: [2, 0, 0]}
drives:
  - {coordinate: column_psi, stiffness: 1e6, motion: {table: {file: swing.csv}}}
  - {coordinate: boom_theta, stiffness: 1e6, motion: {hold: angle}}
points: [{name: tip, link: boom, at: [2, 0, 0]}]
";

#[test]
fn results_do_not_overwrite_what_they_are_computed_from() {
    let out = folder("inputs");
    fs::create_dir_all(&out).expect("a folder");
    let [spec, base, data, table] = ["my.yaml", "base.yaml", "swing.csv", "loads.csv"].map(|name| out.join(name));
    let given = [
        (&spec, "extends: base.yaml\nname: mine\n"),
        (&base, TURNED),
        (&data, "0,0\n1,0.3\n"),
        (&table, "load\n10\n20\n"),
    ];
    for (file, content) in given {
        fs::write(file, content).expect("a file");
    }
    let [my, base, data, table] = [&spec, &base, &data, &table].map(|file| file.to_str().expect("a path"));
    let range = ["statics", my, "--range", "load=5:10:2", "-o"];
    let ensemble = ["simulate", my, "--duration", "0.1", "--ensemble", table, "-o"];
    let commands: [(&[&str], &str); 12] = [
        (&["report", my, "--duration", "0.1", "-o"], my),
        (&["report", my, "--duration", "0.1", "-o"], base),
        (&["generate", my, "-o"], my),
        (&["explain", my, "--svg"], my),
        (&["eval", my, "-o"], my),
        (&["export", my, "--format", "urdf", "-o"], my),
        (&["export", my, "--format", "mjcf", "-o"], data),
        (&["export", my, "--format", "c", "-o"], my),
        (&range, data),
        (&range, base),
        (&ensemble, table),
        (&ensemble, data),
    ];
    for (command, target) in commands {
        refused(&[command, &[target]].concat(), &["is an input of this command", "choose another file"]);
    }
    for (file, content) in given {
        assert_eq!(fs::read_to_string(file).expect("a file"), content, "{}", file.display());
    }
    assert!(!out.join("my.springs.yaml").exists() && !out.join("my.h").exists());
    let elsewhere = out.join("my.urdf");
    let output = crane(&["export", my, "--format", "urdf", "-o", elsewhere.to_str().expect("a path")]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn angles_are_degrees_for_people_also_as_parameters() {
    let out = folder("angles");
    fs::create_dir_all(&out).expect("a folder");
    fs::write(out.join("swing.csv"), "0,0\n1,0.3\n").expect("a file");
    let [spec, csv] = ["turned.yaml", "rows.csv"].map(|name| out.join(name).to_str().expect("a path").to_owned());
    fs::write(&spec, TURNED).expect("a file");
    let rows = crane(&["statics", &spec, "--range", "angle=0:30deg:2", "-o", &csv]);
    let table = text(&rows.stdout);
    assert!(table.contains("angle [°]") && table.lines().any(|line| line.trim().starts_with("30.00 ")), "{table}");
    let csv = fs::read_to_string(csv).expect("a table");
    assert!(
        csv.starts_with("angle [rad],") && csv.lines().nth(2).is_some_and(|row| row.starts_with("0.5235987755")),
        "{csv}"
    );
    let dir = out.to_str().expect("a path");
    let chart = text(&crane(&["envelope", &spec, "--range", "angle=0:30deg:2", "--out", dir]).stdout);
    assert!(chart.contains("with angle 30°") || chart.contains("with angle 0°"), "{chart}");
    // The parameter of a motion that `--hold` replaces is not reported as unused, and radians are not degrees.
    for option in [["--hold", "boom=30deg"], ["--range", "boom=0:30deg:2"]] {
        let output = crane(&[&["statics", &spec][..], &option].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    refused(&["statics", &spec, "--hold", "boom=30"], &["is 30 rad, 1719°", "`--hold boom=30deg`"]);
    // A warning names the file that the user wrote.
    let warned = text(&crane(&["statics", &spec, "--set", "angle=30"]).stderr);
    assert!(warned.contains("W008") && warned.contains(&format!("{spec}:9")), "{warned}");
}

/// Implausible numbers are warnings: commands go on, except with `--strict`.
#[test]
fn warnings_do_not_stop_a_command() {
    let out = folder("warned");
    fs::create_dir_all(&out).expect("a folder");
    let spec = out.join("warned.yaml");
    let implausible = concat!(env!("CARGO_MANIFEST_DIR"), "/../../codegen/tests/implausible/W022_lag_in_ms.yaml");
    let written = fs::read_to_string(implausible).expect("a spec");
    fs::write(&spec, written.replace("name: implausible", "name: warned\nrun: {duration: 0.1}")).expect("a spec");
    let spec = spec.to_str().expect("a path");
    let dir = out.to_str().expect("a path");
    let path = |name: &str| out.join(name).to_str().expect("a path").to_owned();
    let [page, rust, urdf] = ["page.html", "crane.rs", "crane.urdf"].map(path);
    let commands: [&[&str]; 11] = [
        &["check"],
        &["statics"],
        &["strength"],
        &["modes"],
        &["info"],
        &["explain"],
        &["run", "--out", dir],
        &["simulate", "--out", dir],
        &["report", "-o", &page],
        &["generate", "-o", &rust],
        &["export", "--format", "urdf", "-o", &urdf],
    ];
    for command in commands {
        let arguments = [&command[..1], &[spec], &command[1..]].concat();
        let output = crane(&arguments);
        let report = text(&output.stderr) + &text(&output.stdout);
        assert!(output.status.success() && report.contains("W022"), "{command:?}: {report}");
    }
    for command in ["check", "statics", "modes"] {
        assert_eq!(crane(&[command, spec, "--strict"]).status.code(), Some(1), "{command}");
    }
}

#[test]
fn two_exports_into_one_folder_have_a_header_each() {
    let out = folder("headers");
    fs::create_dir_all(&out).expect("a folder");
    for (name, precision) in [("a.c", "single"), ("b.c", "double")] {
        let file = out.join(name);
        let file = file.to_str().expect("a path");
        let output = crane(&["export", "knuckle_boom", "--format", "c", "--precision", precision, "-o", file]);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let read = |name: &str| fs::read_to_string(out.join(name)).expect("a file");
    assert!(read("a.c").contains("#include \"a.h\"") && read("b.c").contains("#include \"b.h\""));
    assert!(read("a.h").contains("const float q[") && read("b.h").contains("const double q["));
    refused(&["export", "knuckle_boom", "--format", "c", "-o", "boom.h"], &["cannot be the name of a source in C"]);
}

#[test]
fn options_of_another_language_are_refused() {
    for (format, option, value, of) in [
        ("c", "--library", "nonsense", "fmu"),
        ("c", "--fmi", "3.0", "fmu"),
        ("urdf", "--functions", "x", "c"),
        ("mjcf", "--precision", "double", "c"),
    ] {
        let title = format!("`{option}` is for `--format {of}` alone");
        refused(&["export", "knuckle_boom", "--format", format, option, value], &[&title, "leave"]);
    }
}

#[test]
fn arguments_that_are_refused_leave_no_folder() {
    let out = folder("nothing");
    refused(&["--start", "nonsense", "--out", out.to_str().expect("a path")], &["--start nonsense"]);
    assert!(!out.exists());
}
