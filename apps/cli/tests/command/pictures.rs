//! Pictures of cranes, and glTF for other programs.

use std::fs;

use serde_json::Value;

use super::{crane, folder, json, refused, text};

/// A written file, by its end, in a folder of its command.
fn written(arguments: &[&str], end: &str) -> Vec<u8> {
    let file = folder(&format!("{}_written_as_{end}", arguments[0])).join(format!("crane.{end}"));
    let output = crane(&[arguments, &["-o", &file.display().to_string()]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    fs::read(file).expect("a file")
}

#[test]
fn a_picture_has_the_size_that_is_asked_for() {
    let picture = written(&["picture", "knuckle_boom", "--width", "60", "--height", "40"], "png");
    // The head of a PNG file: signature, length and name of its first part, width, height, 8 bits of red, green and blue.
    assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(&picture[12..26], b"IHDR\0\0\0\x3c\0\0\0\x28\x08\x02");
    let aside = ["picture", "knuckle_boom", "--width", "60", "--height", "40", "--azimuth", "-90deg"];
    assert_ne!(written(&aside, "png"), picture);
    assert_eq!(written(&[&aside[..7], &["-1.5707963267948966"]].concat(), "png"), written(&aside, "png"));
    refused(&["picture", "--width", "4097"], &["4097 × 800", "1 to 4096 picture elements", "--width 1200"]);
    refused(&["picture", "--azimuth", "1 m"], &["write an angle"]);
    refused(&["picture", "-o", "crane.jpg"], &["cannot write crane.jpg", "ends in `.png`"]);
    refused(
        &["export", "--format", "gltf", "-o", "crane.obj"],
        &["cannot write crane.obj", "ends in `.gltf` or `.glb`"],
    );
    assert_eq!(&written(&["export", "knuckle_boom", "--format", "gltf"], "GLB")[..4], b"glTF");
}

/// What is drawn is part of the files for other programs; surfaces of beams that bend are files beside them.
#[test]
fn urdf_and_mjcf_show_the_crane() {
    let out = folder("shown");
    let exported = |format: &str, name: &str| {
        let file = out.join(name);
        let output = crane(&["export", "cantilever", "--format", format, "-o", &file.display().to_string()]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        fs::read_to_string(file).expect("a file")
    };
    let urdf = exported("urdf", "crane.urdf");
    let mesh = urdf.split('"').find(|word| word.contains(".stl")).expect("a mesh").to_owned();
    let surface = fs::read(out.join(&mesh)).expect("a surface");
    assert!(surface.len() > 84 && mesh.starts_with("crane.meshes/"), "{mesh}");
    assert!(urdf.contains("<visual>") && urdf.contains("<material name=\"flexible\">"), "{urdf}");
    let mjcf = exported("mjcf", "crane.xml");
    assert!(mjcf.contains(&format!("file=\"{mesh}\"")), "{mjcf}");
    assert!(mjcf.contains("contype=\"0\" conaffinity=\"0\" mass=\"0\" group=\"2\""), "{mjcf}");
    assert!(mjcf.contains("Key frame `start`: static equilibrium, at rest."), "{mjcf}");
}

/// glTF shows the pose that `statics` finds with the same options.
#[test]
fn gltf_has_the_pose_that_is_held() {
    let exported = |more: &[&str]| -> Value {
        let file = written(&[&["export", "knuckle_boom", "--format", "gltf"], more].concat(), "gltf");
        serde_json::from_slice(&file).expect("JSON")
    };
    // The inner boom slides along x of its own frame.
    let extension = |document: &Value| {
        let nodes = document["nodes"].as_array().expect("nodes");
        let node = nodes.iter().find(|node| node["name"] == "extension").expect("a node");
        node["translation"][0].as_f64().expect("a number")
    };
    let [near, far] = ["0.3", "0.5"].map(|held| {
        let held = format!("extension_x={held}");
        let pose = &json(&["statics", "knuckle_boom", "--hold", &held, "--format", "json"])["pose"];
        let rest = pose.as_array().and_then(|pose| pose.iter().find(|row| row["coordinate"] == "extension_x"));
        extension(&exported(&["--hold", &held])) - rest.and_then(|row| row["value"].as_f64()).expect("a number")
    });
    // The distance of the link's place from where it slides, to rounding.
    assert!((near - far).abs() < 1e-12, "{near}, {far}");
    assert_eq!(&written(&["export", "knuckle_boom", "--format", "gltf"], "glb")[..4], b"glTF");
    refused(
        &["export", "knuckle_boom", "--format", "urdf", "--hold", "extension_x=0.3"],
        &["`--hold` is for `--format gltf` alone"],
    );
}
