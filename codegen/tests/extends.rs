//! Specs that extend others.

use std::fs;
use std::path::{Path, PathBuf};

use crane_codegen::chain::{Chain, Group, Profile};
use crane_codegen::{Diagnostics, SourceFile, build, compile};

/// A folder of this test with files in it.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in files {
        fs::write(folder.join(name), text).expect("a file");
    }
    folder
}

/// A crane without its name, title and hash.
fn anonymous(chain: Chain) -> Chain {
    Chain { name: String::new(), title: String::new(), spec_hash: String::new(), ..chain }
}

fn opened(file: &Path) -> SourceFile {
    build::open(file).unwrap_or_else(|failure| panic!("{failure}"))
}

fn mistakes(file: &Path) -> Diagnostics {
    match build::open(file) {
        Ok(source) => compile::load(&source).expect_err("mistakes"),
        Err(build::Failure::Mistakes(mistakes)) => mistakes,
        Err(failure) => panic!("{failure}"),
    }
}

/// Whoever checks uploaded specs must not show the lines of other files: of a file that does not describe a crane, no word is repeated.
#[test]
fn lines_of_a_file_that_is_no_spec_are_not_shown() {
    let secrets = ["root:*:20228:0:99999:7:::\n", "# words\npassword\n", "- secret\n", "secret: {word\n"];
    for (index, secret) in secrets.into_iter().enumerate() {
        let folder = folder(
            &format!("extends_secret_{index}"),
            &[("secret", secret), ("over.yaml", "extends: secret\nname: mine\n")],
        );
        let diagnostics = mistakes(&folder.join("over.yaml"));
        let text = diagnostics.to_string();
        let words = ["root", "20228", "password", "word"];
        assert!(words.iter().all(|word| !text.contains(word)), "{text}");
        assert!(text.contains("is not the spec of a crane") && diagnostics.mistakes()[0].code == "E008", "{text}");
    }
}

/// The third file contains every key of both, as a person would write it without `extends`.
#[test]
fn an_extending_spec_is_the_crane_written_in_full() {
    let base = "
format: 1
name: base
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - name: boom
    joint: revolute
    beam:
      length: 2
      sections: 2
      section_joint: paper
      material: steel
      section: {circle: {diameter: 0.1}}
      damping: {beta: 1e-3}
  - {name: load, joint: revolute, mass: 10, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 1e6, damping: 5, motion: {quintic: {from: 0, to: 1, duration: 5}}}]
run: {duration: 3, output: 0.1}
";
    let over = "
extends: base.yaml
name: mine
materials: {steel: {density: 8000}}
links:
  - name: boom
    beam: {sections: rigid, section_joint: ~, damping: ~}
drives: [{coordinate: boom_psi, damping: ~, motion: {quintic: {duration: 7}}}]
";
    let full = "
format: 1
name: mine
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 8000}}
links:
  - name: boom
    joint: revolute
    beam: {length: 2, sections: rigid, material: steel, section: {circle: {diameter: 0.1}}}
  - {name: load, joint: revolute, mass: 10, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 1e6, motion: {quintic: {from: 0, to: 1, duration: 7}}}]
run: {duration: 3, output: 0.1}
";
    let folder = folder("extends_full", &[("base.yaml", base), ("over.yaml", over), ("full.yaml", full)]);
    let source = opened(&folder.join("over.yaml"));
    let load = |source: &SourceFile| compile::load(source).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let extended = load(&source);
    assert_eq!(anonymous(extended.clone()), anonymous(load(&opened(&folder.join("full.yaml")))));
    // The merged text is a complete spec: wherever it is written, it is the same crane.
    let whole = folder.join("whole.yaml");
    fs::write(&whole, &source.text).expect("a file");
    assert_eq!(load(&opened(&whole)), extended);
    // Changes in memory are the same as those of a file.
    let changes = over.replace("extends: base.yaml\n", "");
    assert_eq!(anonymous(load(&opened(&folder.join("base.yaml")).changed(&changes))), anonymous(extended));
}

#[test]
fn kinds_are_replaced_entries_are_merged_and_removed_and_added() {
    let base = "
format: 1
name: base
links:
  - {name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [1, 0, 0], inertia: {Ixx: 1, Iyy: 2, Izz: 2}}
  - {name: hand, joint: {revolute: {axis: z}}, mass: 2, com: [0.1, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives:
  - {coordinate: arm_theta, stiffness: 1e5, damping: 10, motion: {hold: 0}}
damping: {hand_psi: 5}
loads: [{name: wind, link: arm, at: [1, 0, 0], force: [0, 0, 9], scale: {cubic: {from: 0, to: 1, duration: 2}}}]
connectors: [{name: guy, from: {at: [0, 0, 5]}, to: {link: arm, at: [1, 0, 0]}, law: {rope: {stiffness: 2e4, length: 40}}}]
run: {duration: 3, output: 0.1}
";
    let middle = "
extends: base.yaml
links:
  - {name: hand, joint: {prismatic: {axis: x}}, mass: 3}
drives: [{coordinate: arm_theta, motion: {speed: {from: 0, rate: 0.1, ramp: 1}}}]
damping: ~
loads: [{name: wind, scale: {speed: {from: 0, rate: 0.1, ramp: 1}}}]
connectors: [{name: guy, law: {spring: {stiffness: 2e4, length: 40}}}]
run: {duration: 4}
";
    let last = "
extends: sub/middle.yaml
name: mine
links:
  - {name: hand, remove: true}
  - {name: tip, joint: {revolute: {axis: x}}, mass: 1, com: [0, 0.1, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
  - {name: sleeve, after: arm, joint: {prismatic: {axis: x}}, mass: 1, com: [0, 0, 0]}
";
    let whole = folder("extends_chain", &[("last.yaml", last)]);
    folder("extends_chain/sub", &[("base.yaml", base), ("middle.yaml", middle)]);
    let load = |file: &str| compile::load(&opened(&whole.join(file))).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let names = |chain: &Chain| chain.coordinates.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    let middle = load("sub/middle.yaml");
    assert_eq!(names(&middle), ["arm_theta", "hand_x"]);
    assert_eq!((middle.run.duration, middle.run.output), (4.0, 0.1));
    assert_eq!((middle.drives.len(), middle.forces_of_group(Group::JointDampers).len()), (1, 0));
    let last = load("last.yaml");
    assert_eq!(
        (last.name.as_str(), names(&last)),
        ("mine", ["arm_theta", "sleeve_x", "tip_phi"].map(str::to_owned).to_vec())
    );
}

#[test]
fn mistakes_name_the_file_and_the_line_that_they_are_in() {
    let base = "format: 1\nname: base\nlinks:\n  - {name: arm, joint: revolute, mass: -1, com: [1, 0, 0]}\n";
    let files =
        [("base.yaml", base), ("mine.yaml", "extends: base.yaml\nname: mine\nlinks:\n  - {name: arm, masss: 2}\n")];
    let folder = folder("extends_mistakes", &files);
    let lines: Vec<String> = mistakes(&folder.join("mine.yaml")).lines().collect();
    let mine = folder.join("mine.yaml");
    assert!(lines.iter().any(|line| line.starts_with("base.yaml:4:") && line.ends_with("[E031]")), "{lines:#?}");
    let unknown = format!("{}:4:17: unknown key `masss` [E010]", mine.display());
    assert!(lines.contains(&unknown), "{unknown}\n{lines:#?}");
}

#[test]
fn many_specs_that_extend_one_another_are_no_circle() {
    let files: Vec<(String, String)> = (0..70)
        .map(|index| match index {
            0 => {
                "format: 1\nname: base\nlinks:\n  - {name: arm, joint: revolute, mass: 1, com: [1, 0, 0]}\n".to_owned()
            }
            _ => format!("extends: s{}.yaml\nname: mine_{index}\n", index - 1),
        })
        .enumerate()
        .map(|(index, text)| (format!("s{index}.yaml"), text))
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let folder = folder("extends_long", &files);
    assert_eq!(compile::load(&build::open(&folder.join("s17.yaml")).unwrap()).unwrap().name, "mine_17");
    let long = mistakes(&folder.join("s69.yaml"));
    assert!(long.headline().contains("more than 64 specs extend one another"), "{}", long.headline());
}

#[test]
fn a_base_that_cannot_be_read_and_a_circle_are_mistakes() {
    let files = [
        ("lost.yaml", "name: mine\nextends: nowhere.yaml\n"),
        ("one.yaml", "extends: other.yaml\n"),
        ("other.yaml", "extends: one.yaml\n"),
    ];
    let folder = folder("extends_nothing", &files);
    for (file, expected) in [("lost.yaml", "lost.yaml:2:10: `extends: nowhere.yaml`"), ("one.yaml", "in a circle")] {
        let diagnostics = mistakes(&folder.join(file));
        assert_eq!(diagnostics.mistakes()[0].code, "E008");
        assert!(diagnostics.headline().contains(expected), "{}", diagnostics.headline());
    }
}

#[test]
fn what_is_given_twice_in_an_extending_spec_is_a_mistake() {
    let base = "format: 1\nname: base\nlinks:\n  - {name: arm, joint: revolute, mass: 1, com: [1, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n";
    let twice = [
        ("extends: base.yaml\nname: mine\nrun: {duration: 4, duration: 5}\n", "[E011]"),
        ("extends: base.yaml\nname: mine\nname: yours\n", "[E011]"),
        ("extends: base.yaml\nname: mine\nlinks: [{name: arm, mass: 2}, {name: arm, mass: 3}]\n", "`arm`"),
    ];
    for (index, (text, expected)) in twice.iter().enumerate() {
        let folder = folder(&format!("extends_twice_{index}"), &[("base.yaml", base), ("mine.yaml", text)]);
        let lines: Vec<String> = mistakes(&folder.join("mine.yaml")).lines().collect();
        assert!(lines.iter().any(|line| line.contains(expected)), "{lines:#?}");
    }
}

/// Tables of files are the tables written in the spec, each from the folder of the spec that refers to it; the text of the whole spec contains
/// them, and mistakes in them are shown where they are.
#[test]
fn tables_are_read_from_files() {
    let inline = "
format: 1
name: lift
links: [{name: boom, joint: revolute, mass: 10, com: [1, 0, 0]}, {name: jib, joint: revolute, mass: 5, com: [1, 0, 0]}]
drives:
  - {coordinate: boom_psi, stiffness: 1e6, motion: {table: {times: [0, 1.5, 4], values: [0, 0.3, 0.5], shape: spline}}}
  - {coordinate: jib_psi, stiffness: 1e6, motion: {table: {times: [0, 2], values: [0.1, -0.2]}}}
loads: [{name: gust, link: jib, force: [0, 1, 0], scale: {table: {times: [0, 1, 2], values: [0, 250, 0], shape: spline}}}]
";
    let base = "
format: 1
name: base
links: [{name: boom, joint: revolute, mass: 10, com: [1, 0, 0]}, {name: jib, joint: revolute, mass: 5, com: [1, 0, 0]}]
drives:
  - {coordinate: boom_psi, stiffness: 1e6, motion: {table: {file: data.csv, column: boom}}}
  - {coordinate: jib_psi, stiffness: 1e6, motion: {table: {times: [0, 1], values: [0, 1]}}}
";
    let over = "
extends: ../tables/base.yaml
name: lift
drives: [{coordinate: jib_psi, motion: {table: {file: data.csv}}}]
loads: [{name: gust, link: jib, force: [0, 1, 0], scale: {table: {file: wind.csv}}}]
";
    let of_base = folder(
        "tables",
        &[("base.yaml", base), ("data.csv", "t [s],jib [rad],boom [rad]\r\n0,7,0\r\n1.5,7,0.3\r\n4,7,0.5\r\n")],
    );
    let wind = ("wind.csv", "0, 0\n1, 250\n2, 0\n");
    let dir = folder(
        "tables_over",
        &[("lift.yaml", over), ("inline.yaml", inline), ("data.csv", "\u{feff}0,0.1\n2,-0.2"), wind],
    );
    let source = opened(&dir.join("lift.yaml"));
    let expected = compile::load(&opened(&dir.join("inline.yaml"))).expect("a sound spec");
    for source in [source.clone(), SourceFile::new("elsewhere.yaml", source.text)] {
        assert_eq!(
            anonymous(compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"))),
            anonymous(expected.clone())
        );
    }
    // What an extending spec writes replaces what the extended spec has: a column, a file, or a table in the spec.
    let jib = "drives: [{coordinate: boom_psi, motion: {table: {column: jib}}}]";
    let own_data = "drives: [{coordinate: boom_psi, motion: {table: {file: own.csv}}}]";
    let written = "drives: [{coordinate: boom_psi, motion: {table: {times: [0, 1], values: [0, 9]}}}]";
    let own_csv = ("own.csv", "0,-3\n1,-3\n");
    for (name, drives, start, end) in
        [("jib", jib, 7.0, 7.0), ("own", own_data, -3.0, -3.0), ("written", written, 0.0, 9.0)]
    {
        let text = format!("extends: base.yaml\nname: {name}\n{drives}\n")
            .replace("file: own.csv", "file: own.csv, column: ~");
        let file = folder("tables", &[(&format!("{name}.yaml"), text.as_str()), own_csv]).join(format!("{name}.yaml"));
        let chain = compile::load(&opened(&file)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let Profile::Table { from, segments } = &chain.drives[0].profile else { panic!("a table") };
        let changes: f64 = segments.iter().map(|segment| segment.coefficients.iter().sum::<f64>()).sum();
        assert!(
            (from - start).abs() < 1e-12 && (name == "jib" || name == "own") == (changes == 0.0),
            "{name}: {from} to {end}"
        );
    }
    fs::write(dir.join("wind.csv"), "0,1,\n1,strong,\n").expect("a file");
    assert_eq!(
        mistakes(&dir.join("lift.yaml")).headline(),
        "wind.csv:2:1: `strong` in column 2 is not a number [E137]"
    );
    fs::write(dir.join("wind.csv"), "0, 0\n1, strong\n").expect("a file");
    assert_eq!(
        mistakes(&dir.join("lift.yaml")).headline(),
        "wind.csv:2:1: `strong` in column 2 is not a number [E137]"
    );
    fs::remove_file(dir.join("wind.csv")).expect("the file");
    let found = mistakes(&dir.join("lift.yaml")).to_string();
    assert!(
        found.contains("`file: wind.csv` cannot be read: there is no such file") && found.contains("lift.yaml:5:"),
        "{found}"
    );
    fs::remove_file(of_base.join("data.csv")).expect("the file");
    let found = mistakes(&dir.join("lift.yaml")).to_string();
    assert!(found.contains("`file: wind.csv`") || found.contains("base.yaml"), "{found}");
}
