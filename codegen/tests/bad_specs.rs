//! Every rule of the spec language has a spec in `tests/bad` that breaks it, named by the rule's code, and a snapshot of
//! the message that it gives.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use crane_codegen::diagnostic::CATALOGUE;
use crane_codegen::{Diagnostics, SourceFile, read, validate};

/// The mistakes in the bytes of a spec.
fn mistakes(name: &str, bytes: &[u8]) -> Diagnostics {
    SourceFile::from_bytes(name, bytes)
        .and_then(|source| read(&source).and_then(|spec| validate(&spec)))
        .expect_err(&format!("{name} is sound"))
}

/// Bad specs by name, in order.
fn bad_specs() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut specs: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder of bad specs")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read(&path).expect("a bad spec"))
        })
        .collect();
    specs.sort();
    specs
}

#[test]
fn each_bad_spec_gives_its_message() {
    let mut others = Vec::new();
    for (name, bytes) in bad_specs() {
        let diagnostics = mistakes(&format!("{name}.yaml"), &bytes);
        insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "bad_messages", omit_expression => true }, {
            insta::assert_snapshot!(name.as_str(), diagnostics.to_string());
        });
        if let Some((code, _)) = name.split_once('_').filter(|(code, _)| code.starts_with('E')) {
            let codes: Vec<_> = diagnostics.mistakes().iter().map(|mistake| mistake.code).collect();
            if codes != [code] {
                others.push((name, codes));
            }
        }
    }
    assert!(others.is_empty(), "these break other rules, or more than one: {others:?}");
}

#[test]
fn each_rule_has_a_bad_spec() {
    let mut shown: BTreeSet<String> =
        bad_specs().into_iter().filter_map(|(name, _)| Some(name.split_once('_')?.0.to_owned())).collect();
    // Warnings have specs and a test of their own (`implausible_specs.rs`).
    shown.extend(CATALOGUE.iter().map(|rule| rule.code.to_owned()).filter(|code| code.starts_with('W')));
    // Broken by live parameters alone; see `stages/sections.rs`.
    shown.insert("E184".into());
    // Too large for a file in a repository; see below.
    shown.insert("E001".into());
    for rule in CATALOGUE {
        assert!(shown.contains(rule.code), "no bad spec for {}: {}", rule.code, rule.about);
    }
    let mut codes: Vec<_> = CATALOGUE.iter().map(|rule| rule.code).collect();
    codes.dedup();
    assert!(codes.is_sorted() && codes.len() == CATALOGUE.len(), "codes are unique and in order");
}

#[test]
fn ten_mistakes_are_ten_messages() {
    let (name, bytes) = bad_specs().into_iter().find(|(name, _)| name == "ten_mistakes").expect("the spec");
    let diagnostics = mistakes(&name, &bytes);
    let codes: BTreeSet<_> = diagnostics.mistakes().iter().map(|mistake| mistake.code).collect();
    assert_eq!((diagnostics.mistakes().len(), codes.len()), (10, 10), "{diagnostics}");
    assert_eq!(diagnostics.headline(), "ten_mistakes:3:7: `Ten` is not a valid name [E020] (and 9 more)");
}

#[test]
fn a_hundred_megabytes_of_garbage_are_refused_unread() {
    let garbage: Vec<u8> = (0..100_000_000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    // The size alone decides, as the message says.
    let diagnostics = mistakes("garbage.yaml", &garbage);
    assert_eq!(diagnostics.mistakes()[0].code, "E001");
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "bad_messages", omit_expression => true }, {
        insta::assert_snapshot!("E001_garbage", diagnostics.to_string());
    });
}

#[test]
fn the_largest_garbage_that_is_read_is_refused_soon() {
    let size = crane_codegen::diagnostic::MAX_BYTES;
    for unit in
        ["[", "{", "a: 1\n", "- ", "a", "&a [*a, *a]\n", "a: [1, 2]\nb: &x {c: d}\n", "\n", "'", "\u{1F3D7}", "? "]
    {
        let text = unit.repeat(size / unit.len());
        let begin = Instant::now();
        let found = mistakes("garbage.yaml", text.as_bytes()).to_string();
        // Without optimisation, the slowest takes a second or two.
        assert!(begin.elapsed() < Duration::from_secs(20), "{unit:?}: {:?}", begin.elapsed());
        assert!(found.len() < 200_000, "{unit:?}: {} bytes of message", found.len());
    }
}

#[test]
fn too_many_joints_are_counted_and_too_many_values_refused() {
    let links = |count: usize| {
        let link = |index| format!("  - {{name: l{index}, joint: revolute, mass: 1, com: [1, 0, 0]}}\n");
        format!("format: 1\nname: long\nlinks:\n{}", (0..count).map(link).collect::<String>())
    };
    for (count, code) in [(3_001, "E047"), (12_000, "E007")] {
        let diagnostics = mistakes("long.yaml", links(count).as_bytes());
        assert_eq!(diagnostics.mistakes().iter().map(|mistake| mistake.code).collect::<Vec<_>>(), [code], "{count}");
    }
}
