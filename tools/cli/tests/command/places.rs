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
    refused(&["simulate", "knuckle_boom", "--ensemble", name, "-o", name], &["would overwrite its own table"]);
    assert_eq!(fs::read_to_string(&table).expect("a table"), "payload\n200\n");
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
