//! New crates for your own crane.

use std::fs;

use super::{crane, folder, refused, text};

#[test]
fn a_new_crane_is_a_crate_with_the_comments_of_its_spec() {
    // The folder is inside that of the test; its name becomes the crane's.
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

/// A crate with copies of its dependencies names no path outside of its folder, and cargo can read all of its manifests.
#[test]
fn a_new_crate_can_have_what_it_depends_on() {
    let folder = folder("new_vendored").join("mine");
    let output = crane(&["new", folder.to_str().expect("a path"), "--vendor"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let manifests =
        ["Cargo.toml", "crates/crane-model/Cargo.toml", "crates/codegen/Cargo.toml", "crates/quantities/Cargo.toml"];
    for manifest in manifests {
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
