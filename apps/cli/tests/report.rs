//! The report page as the command writes it; how a browser shows it is tested in `apps/report`.

use std::{env, fs, path::PathBuf, process::Command};

use crane_model::nalgebra::{Matrix3, Matrix4, Rotation3, Unit, Vector3};
use serde_json::Value;

fn crane(arguments: &[&str]) -> Vec<u8> {
    let output = Command::new(env!("CARGO_BIN_EXE_crane")).args(arguments).output().expect("the command starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

fn page(name: &str, duration: &str) -> String {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("report_{name}.html"));
    crane(&["report", name, "--duration", duration, "-o", file.to_str().expect("a path")]);
    fs::read_to_string(file).expect("a page")
}

/// The data in a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("data");
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|number| number.as_f64().expect("a number")).collect()
}

#[test]
fn a_page_is_whole_and_asks_for_nothing() {
    let page = page("knuckle_boom", "0.05");
    assert!(page.contains("content=\"default-src 'none'; script-src 'sha256-"));
    // Data and script: no text of a spec has ended an element.
    assert_eq!(page.matches("</script>").count(), 2);
    for reference in ["src=\"", "href=\"http", "url(http", "@import", "import("] {
        assert!(!page.contains(reference), "{reference}");
    }
    for licence in ["three.js authors", "Leon Sorokin", "Permission is hereby granted"] {
        assert!(page.contains(licence), "{licence}");
    }
    let data = data(&page);
    assert!(data["spec"].as_str().is_some_and(|spec| spec.contains("name: knuckle_boom")));
    assert!(
        data["command"].as_str().is_some_and(|command| command.starts_with("crane report knuckle_boom --duration"))
    );
    let record = &data["cranes"][0]["record"];
    for fact in ["spec_hash", "version", "method", "step_s", "parameters", "wall_time_s"] {
        assert!(!record[fact].is_null(), "{fact}: {record}");
    }
}

#[test]
fn a_flexible_crane_is_shown_with_the_rigid_one_of_the_same_drives() {
    let names = |name: &str| -> Vec<String> {
        let data = data(&page(name, "0.01"));
        data["cranes"].as_array().expect("cranes").iter().map(|crane| crane["name"].to_string()).collect()
    };
    assert_eq!(names("eight_link_flexible"), ["\"eight_link_rigid\"", "\"eight_link_flexible\""]);
    assert_eq!(names("eight_link_two_flexible"), ["\"eight_link_rigid\"", "\"eight_link_two_flexible\""]);
    // Other drives; no elements.
    assert_eq!(names("eight_link_identified"), ["\"eight_link_identified\""]);
    assert_eq!(names("eight_link_rigid"), ["\"eight_link_rigid\""]);
}

#[test]
fn the_screws_of_a_page_move_its_frames_as_the_crane_does() {
    for (name, index) in [("eight_link_flexible", 1), ("two_arms", 0)] {
        let data = data(&page(name, "0.01"));
        let scene = &data["cranes"][index]["scene"];
        let reference = numbers(&scene["reference"]);
        let screws: Vec<Vec<f64>> = scene["screws"].as_array().expect("screws").iter().map(numbers).collect();
        let vectors = scene["vectors"].as_array().expect("flags");
        // Every coordinate displaced from the reference, each by a different amount.
        let q: Vec<f64> = reference.iter().enumerate().map(|(i, q)| q + 0.3 * (1.0 + i as f64).sin()).collect();
        let text = q.iter().map(|q| format!("{q:?}")).collect::<Vec<_>>().join(",");
        let exact: Value = serde_json::from_slice(&crane(&["eval", name, "--q", &text])).expect("JSON");
        let mut motions: Vec<Matrix4<f64>> = Vec::new();
        for (body, exact) in
            scene["bodies"].as_array().expect("bodies").iter().zip(exact["transforms"].as_array().expect("T"))
        {
            let index = |value: &Value| usize::try_from(value.as_u64().expect("an index")).expect("an index");
            let parent = body["parent"].as_u64().map(|_| motions[index(&body["parent"])]);
            let mut motion = parent.unwrap_or_else(Matrix4::identity);
            let mut range = index(&body["moved_by"][0])..index(&body["moved_by"][1]);
            while let Some(j) = range.next() {
                if vectors[j] == true {
                    // A rotation vector is one turn about the sum of its screws.
                    let sum: Vec<f64> = (0..6).map(|k| (j..j + 3).map(|i| q[i] * screws[i][k]).sum()).collect();
                    let angle = Vector3::new(q[j], q[j + 1], q[j + 2]).norm();
                    motion *= exponential(&sum.iter().map(|entry| entry / angle).collect::<Vec<_>>(), angle);
                    range.nth(1);
                } else {
                    motion *= exponential(&screws[j], q[j] - reference[j]);
                }
            }
            motions.push(motion);
            let rows = numbers(&body["frame"]);
            let frame =
                motion * Matrix4::from_fn(|i, j| if i < 3 { rows[4 * i + j] } else { f64::from(u8::from(j == 3)) });
            let exact: Vec<f64> = exact.as_array().expect("rows").iter().flat_map(numbers).collect();
            let error = (frame - Matrix4::from_row_slice(&exact)).amax();
            // Rounding of a product of 25 matrices, on a crane of 10 m.
            assert!(error < 1e-12, "{}: {error:e}", body["name"]);
        }
    }
}

/// `exp(ξ̂ q)`, here as `[R, (1 − R)(ω × v) + ω ωᵀ v q]`.
fn exponential(screw: &[f64], q: f64) -> Matrix4<f64> {
    let (w, v) = (Vector3::new(screw[0], screw[1], screw[2]), Vector3::new(screw[3], screw[4], screw[5]));
    if w.norm() == 0.0 {
        return Matrix4::new_translation(&(v * q));
    }
    let rotation = *Rotation3::from_axis_angle(&Unit::new_normalize(w), q).matrix();
    let mut motion = rotation.to_homogeneous();
    motion
        .fixed_view_mut::<3, 1>(0, 3)
        .copy_from(&((Matrix3::identity() - rotation) * w.cross(&v) + w * w.dot(&v) * q));
    motion
}

#[test]
fn moments_of_elements_balance_the_load_of_a_cantilever() {
    let out = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("moments");
    crane(&["simulate", "cantilever", "--duration", "0.001", "--out", out.to_str().expect("a path")]);
    let csv = fs::read_to_string(out.join("cantilever.csv")).expect("a CSV file");
    let mut lines = csv.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let (header, first) = (lines.next().expect("a header"), lines.next().expect("a row"));
    let value = |name: &str| -> f64 {
        first[header.iter().position(|column| column == name).expect(name)].parse().expect("a number")
    };
    // The first spring, at 1/16 of 2 m: 20 kg at the tip, and the beam beyond, 0.04 m by 0.06 m of 7850 kg/m³. Angles about
    // y are positive where the tip goes down, so the spring's moment is too.
    let arm = 2.0 * 15.0 / 16.0;
    let moment = 9.81 * (20.0 * arm + 7850.0 * 0.04 * 0.06 * arm * arm / 2.0);
    let error = value("beam_1_theta_moment [N m]").abs().max(value("beam_1_psi_moment [N m]").abs()) / moment - 1.0;
    // The tip goes 13 mm down over 2 m, which shortens the arms by some 1e-4.
    assert!(error.abs() < 2e-4, "{error:e} of {moment} N m");
}
