//! The `crane` command as a user meets it.

mod cautions;
mod documents;
mod drives;
mod ensemble;
mod margins;
mod messages;
mod new;
mod pictures;
mod places;
mod poses;
mod runs;
mod same_numbers;
mod sensitivity;
mod units;

use std::{
    fs,
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

/// A folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Wrong arguments end with code 2 and a message that contains `expected`.
fn refused(arguments: &[&str], expected: &[&str]) {
    let output = crane(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    for words in expected {
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
    refused(&["simulate", "--interval", "nan"], &["'nan'", "--interval", "write a number of seconds"]);
    // The name that it had before.
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
    // Newton's tolerance: 1e-10 of the largest force.
    assert!(sum.iter().zip(&weight).all(|(sum, weight)| (sum + weight).abs() < 1e-10 * 1.7e5), "{sum:?} {weight:?}");
    let empty = json(&["statics", "--set", "load_mass=0", "--format", "json"]);
    // The log weighs 500 kg, to a similar tolerance.
    let log = sum[2] - forces(&empty, "Σ supports")[2];
    assert!((log - 500.0 * 9.81).abs() < 1e-4, "{log}");
    // The weight of the log is its mass times gravity.
    let log = forces(&empty, "weight")[2] - weight[2];
    assert!((log - 500.0 * 9.81).abs() < 1e-9, "{log}");
}

/// A scene includes its robot, whose inertia is impossible.
#[test]
fn a_robot_is_read_with_what_it_includes_and_repaired_on_request() {
    let out = folder("include");
    fs::create_dir_all(&out).expect("a folder");
    let file = |name: &str| out.join(name).to_str().expect("a path").to_owned();
    let body = "<body name='a'><joint axis='0 1 0'/><inertial pos='0.5 0 0' mass='2' diaginertia='1 2 4'/></body>";
    fs::write(file("a.xml"), format!("<mujocoinclude>{body}</mujocoinclude>")).expect("a file");
    fs::write(file("scene.xml"), "<mujoco><worldbody><include file='a.xml'/></worldbody></mujoco>").expect("a file");
    let spec = file("a.yaml");
    let output = crane(&["import", &file("scene.xml"), "-o", &spec]);
    assert!(
        text(&output.stderr).contains("error[E051]") && output.status.code() == Some(1),
        "{}",
        text(&output.stderr)
    );
    let output = crane(&["import", &file("scene.xml"), "-o", &spec, "--repair", "--force"]);
    assert!(text(&output.stdout).contains("Repaired: the inertia of link `a`"), "{}", text(&output.stderr));
    assert!(fs::read_to_string(&spec).expect("a spec").contains("inertia: {Ixx: 1.5, Iyy: 2.5, Izz: 4}"));
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
        // The hook block weighs 25 kg.
        assert!(fs::read_to_string(target).expect("a file").contains("\"925\""), "{target}");
    }
    assert!(
        fs::read_to_string(file("boom.springs.yaml"))
            .expect("springs")
            .contains("hook_theta: {stiffness: 0, damping: 40")
    );
    let output = crane(&["import", &urdf, "-o", &spec]);
    assert!(text(&output.stdout).contains("knuckle_boom: valid; 4 bodies, 4 coordinates"), "{}", text(&output.stderr));
    // Drives and other changes in a spec are not lost by mistake.
    refused(&["import", &mjcf, "-o", &spec], &["boom.yaml exists", "`--force`"]);
    assert!(crane(&["import", &urdf, "-o", &spec, "--force"]).status.success());
    let again = file("again.yaml");
    let output = crane(&["import", &mjcf, "-o", &again]);
    assert!(text(&output.stdout).contains("knuckle_boom: valid; 4 bodies, 4 coordinates"), "{}", text(&output.stdout));
    assert!(fs::read_to_string(&again).expect("a spec").contains("stiffness: 4000000"));
    // The spec goes to standard output; what is left out stands at its head, and on standard error.
    let output = crane(&["import", "../../codegen/tests/robots/arm.xml"]);
    assert!(text(&output.stdout).starts_with("# The robot arm"));
    for output in [&output.stdout, &output.stderr] {
        assert!(text(output).contains("Left out, actuators: <motor>, <position>."), "{}", text(output));
    }
    let output = crane(&["import", &spec, "-o", &file("nothing.yaml")]);
    assert!(
        text(&output.stderr).contains("error[U001]") && output.status.code() == Some(1) && output.stdout.is_empty()
    );
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), 5, "nothing half-written is left behind");
    refused(
        &["export", "knuckle_boom", "--format", "c", "--input", "pull=3"],
        &["`--input`", "where the exported crane runs"],
    );
    refused(
        &["export", "knuckle_boom", "--format", "c", "--functions", "bias_vjp,mass_matrix_vjp"],
        &["no function `mass_matrix_vjp` in C", "`_vjp` and `_jvp`, of ", "forward_dynamics"],
    );
    refused(
        &["export", "eight_link_hydraulic", "--format", "c", "--functions", "forward_dynamics_jvp"],
        &["`forward_dynamics_jvp` of", "would lack the forces that have states"],
    );
    refused(&["export", "knuckle_bom", "--format", "urdf"], &["there is no crane `knuckle_bom`", "`knuckle_boom`"]);
    refused(
        &["export", "knuckle_boom", "--format", "mjcf", "--set", "load=1"],
        &["no live parameter `load`", "payload"],
    );
}

#[test]
fn what_is_exported_of_closed_loops_says_what_it_lacks() {
    let out = folder("loops");
    fs::create_dir_all(&out).expect("a folder");
    let file = |name: &str| out.join(name).to_str().expect("a path").to_owned();
    let spec = "../../specs/examples/parallel_harvester.yaml";
    let words = ["has a loop, which `", "URDF describes open chains", "`--format mjcf`"];
    refused(&["export", spec, "--format", "urdf", "-o", &file("model.urdf")], &words);
    let words =
        ["`forward_dynamics` of", "would be that of the open chain", "`loop_jacobians`", "docs/manual/loops.md"];
    refused(&["export", spec, "--format", "c", "-o", &file("loops.c")], &words);
    let product = ["export", spec, "--format", "c", "--functions", "forward_dynamics_vjp", "-o", &file("loops.c")];
    refused(&product, &["`forward_dynamics_vjp` of", "would be that of the open chain"]);
    let functions = ["--functions", "bias,forces,forces_vjp,solve_mass,loop_states,loop_jacobians"];
    assert!(
        crane(&[&["export", spec, "--format", "c", "-o", &file("loops.c")][..], &functions].concat()).status.success()
    );
    let output = crane(&["export", spec, "--format", "fmu", "-o", &file("loops.fmu")]);
    assert!(text(&output.stdout).contains("co-simulation alone because of its loops"), "{}", text(&output.stderr));
}

#[test]
fn rigid_couplings_are_exported_and_refused_with_what_to_write_instead() {
    let out = folder("couplings");
    fs::create_dir_all(&out).expect("a folder");
    let file = |name: &str| out.join(name).to_str().expect("a path").to_owned();
    let link = |name: &str| {
        format!(
            "  - {{name: {name}, joint: revolute, mass: 2, com: [0.5, 0, 0], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}\n"
        )
    };
    let coupling = |name: &str, coordinate: &str, follows: &str| {
        format!("  - {{name: {name}, coordinate: {coordinate}, follows: {follows}, ratio: -2, rigid: true}}\n")
    };
    let links = format!("format: 1\nname: geared\nlinks:\n{}{}{}", link("one"), link("two"), link("three"));
    let (spec, twice) = (file("geared.yaml"), file("twice.yaml"));
    let gear = coupling("gear", "two_psi", "one_psi");
    fs::write(&spec, format!("{links}couplings:\n{gear}")).expect("a spec");
    let second = coupling("belt", "two_psi", "three_psi");
    fs::write(&twice, format!("{links}couplings:\n{gear}{second}")).expect("a spec");
    assert!(crane(&["export", &spec, "--format", "urdf", "-o", &file("geared.urdf")]).status.success());
    let urdf = fs::read_to_string(file("geared.urdf")).expect("a file");
    assert!(urdf.contains("<mimic joint=\"one_psi\" multiplier=\"-2\" offset=\"0\"/>"), "{urdf}");
    refused(
        &["export", &twice, "--format", "urdf", "-o", &file("twice.urdf")],
        &["`belt` makes a joint of geared follow a second one", "`--format mjcf`"],
    );
    let instead = "give the coupling a `stiffness` instead of `rigid: true`";
    refused(
        &["export", &spec, "--format", "c", "-o", &file("geared.c")],
        &["without the rigid coupling `gear`", "`loop_jacobians`", instead],
    );
    refused(&["linearise", &spec, "--hold", "one_psi=0.1"], &["geared has loops, rigid couplings", instead]);
    let output = crane(&["export", &spec, "--format", "fmu", "-o", &file("geared.fmu")]);
    assert!(
        text(&output.stdout).contains("co-simulation alone because of rigid coupling gear"),
        "{}",
        text(&output.stderr)
    );
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
        assert!(svg.contains("role=\"img\"") && svg.contains("<title>") && !svg.contains("<title></title>"), "{svg}");
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
    assert!(deflection.iter().all(|row| row["z"].as_f64().is_some_and(|z| z < -0.05)), "{deflection:?}");
}

#[test]
fn an_impossible_load_is_refused_without_a_panic() {
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

/// A crane whose valves are shut and whose cylinders leak is in no equilibrium: the command says how fast it sinks, and not that it is unstable.
#[test]
fn a_crane_that_drifts_is_not_unstable() {
    let found = json(&["linearise", "eight_link_hydraulic", "--format", "json"]);
    assert_eq!((&found["stable"], &found["valves"]), (&true.into(), &"shut".into()));
    let drift = &found["drift"];
    let [rate, decay] = ["rate", "decay"].map(|key| drift[key].as_f64().expect("a number"));
    assert!(rate.abs() > 1e-8 && rate.abs() < 1e-3 && decay > 0.0, "{drift}");
    let printed = text(&crane(&["linearise", "eight_link_hydraulic"]).stdout);
    assert!(
        printed.contains("no equilibrium") && printed.contains("drifts by") && !printed.contains("unstable"),
        "{printed}"
    );
    let steady = json(&["linearise", "knuckle_boom", "--format", "json"]);
    assert!(steady["drift"].is_null() && steady["valves"].is_null(), "{steady:.300}");
}

/// Linearised about a row of results, the motion has its accelerations, and the matrices have their derivatives.
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
    for (found, expected) in column("acceleration").into_iter().zip(accelerations(&q)) {
        // Two ways of rounding.
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} of the moment, {expected} of its state");
    }
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
    // No crane is that far, that fast or that late: statics and linearise refuse the same.
    for command in ["linearise", "statics"] {
        refused(&[command, "knuckle_boom", "--hold", "main_boom_theta=1e308"], &["out of range", "at most 1e6"]);
        refused(&[command, "knuckle_boom", "--hold", "main_boom_theta=1e14deg"], &["out of range", "at most 1e6"]);
    }
    refused(&["linearise", "knuckle_boom", "--hold", "main_boom_theta_rate=-1e308"], &["out of range", "rad/s"]);
    refused(&["linearise", "knuckle_boom", "--time", "1e308"], &["out of range", "seconds"]);
    refused(&["linearise", "double_pendulum", "--hold", "upper_theta=30"], &["`--hold upper_theta=30deg`"]);
    refused(&["linearise", "double_pendulum", "-o", "a.json"], &["cannot write a.json", "ends in `.npz`"]);
    refused(&["linearise", "eight_link_hydraulic", "--hold", "boom_psi=0"], &["valves", "motion: {hold: 30 deg}"]);
    refused(
        &["linearise", "knuckle_boom", "--on", "main_bom_theta_prescribed"],
        &["did you mean `main_boom_theta_prescribed`"],
    );
    refused(&["linearise", "knuckle_boom", "--measure", "speed"], &["no output `speed`", "boom_tip_x"]);
    let sticking = std::path::Path::new(&folder).join("arm.yaml");
    let spec = "format: 1\nname: arm\nlinks: [{name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [0, 0, -1]}]\n\
                friction: {arm_theta: {coulomb: 5, bristle: {stiffness: 1e4, damping: 30}}}\n";
    fs::write(&sticking, spec).expect("a file");
    let sticking = sticking.to_str().expect("a path");
    let found = json(&["linearise", sticking, "--format", "json"]);
    // The bristle is a spring: (k + m g l)/(m l²) = (1e4 + 98.1)/10.
    let state_space = &found["state_space"];
    assert_eq!(state_space["states"][2], "arm_theta_bristle");
    let entry = |row: usize, column: usize| state_space["a"][row][column].as_f64().expect("a number");
    assert!((entry(1, 2) + 1e3).abs() < 1e-6 && (entry(1, 0) + 9.81).abs() < 1e-6 && (entry(2, 1) - 1.0).abs() < 1e-9);
    assert!(found.get("mass").is_none() && found["modes"].as_array().is_some_and(|modes| !modes.is_empty()));
    // Nothing holds a turntable in its place.
    let turntable = "format: 1\nname: arm\nlinks: [{name: arm, joint: revolute, mass: 10, com: [1, 0, 0]}]\n";
    fs::write(sticking, turntable).expect("a file");
    let message = text(&crane(&["linearise", sticking]).stderr);
    assert!(
        message.contains("no force keeps arm_psi in its place") && message.contains("`--hold arm_psi=0`"),
        "{message}"
    );
}

/// A state gives the same results among many as alone, and only the requested quantities are returned.
#[test]
fn many_states_are_evaluated_at_once() {
    let names = "points,point_velocities,forces,accelerations,static_residual,tangent_stiffness,energies,drive_efforts";
    let asked =
        |q: &str, v: &str| json(&["eval", "knuckle_boom", "--q", q, "--v", v, "--quantities", names, "--time", "0.5"]);
    let (first, second) = ("0.1,0.2,0.3,0.4", "0.2,0.1,-0.3,0.5");
    let both = asked(&format!("{first},{second}"), "1,2,3,4");
    assert!(both.get("transforms").is_none());
    for (row, q) in [first, second].into_iter().enumerate() {
        let one = asked(q, "1,2,3,4");
        for name in names.split(',') {
            assert_eq!(both[name][row], one[name], "{name}");
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

#[test]
fn help_groups_commands_by_task() {
    let help = text(&crane(&["--help"]).stdout);
    let position = |words: &str| help.find(words).unwrap_or_else(|| panic!("`{words}` not in: {help}"));
    assert!(
        position("Describe a crane:") < position("  check ") && position("  check ") < position("Compute:"),
        "{help}"
    );
    assert!(
        position("Compute:") < position("  statics ") && position("  statics ") < position("For developers:"),
        "{help}"
    );
    assert!(
        position("For developers:") < position("  schema ") && position("  schema ") < position("Options:"),
        "{help}"
    );
    assert!(position("Options:") < position("Exit codes:"), "{help}");
}

#[test]
fn a_shell_asks_for_names_of_cranes_and_of_their_parameters() {
    let answer = |line: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.env("COMPLETE", "bash").env("_CLAP_COMPLETE_INDEX", (line.len() - 1).to_string());
        let output = command.args(["--"]).args(line).output().expect("the command starts");
        text(&output.stdout)
    };
    assert_eq!(answer(&["crane", "statics", "cantil"]).trim(), "cantilever");
    assert_eq!(answer(&["crane", "statics", "cantilever", "--set", "t"]).trim(), "tip_mass=");
    assert_eq!(
        answer(&["crane", "margins", "knuckle_boom", "--on", "main_boom_theta_"]).trim(),
        "main_boom_theta_rate"
    );
    let script = crane(&["completions", "bash"]);
    let (script, program) = (text(&script.stdout), env!("CARGO_BIN_EXE_crane"));
    assert!(script.contains(program) && script.contains("COMPLETE="), "{script}");
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
