//! URDF and MJCF: what is written of the shipped cranes, what is read of robots, and what is said of files that are not cranes.
//!
//! That other programs compute the same of these files is checked by `tools/peers/exchange.py`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crane_codegen::chain::{Chain, Strain};
use crane_codegen::{SourceFile, build, compile, exchange};

/// Files of a folder of this package, in order.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("the folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

fn stem(path: &Path) -> String {
    path.file_stem().expect("a name").to_string_lossy().into_owned()
}

fn chain(source: &SourceFile) -> Chain {
    compile::load(source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// The shipped cranes.
fn shipped() -> Vec<Chain> {
    let specs = files("../specs").into_iter().filter(|path| path.extension().is_some_and(|found| found == "yaml"));
    specs.map(|path| chain(&build::open(&path).expect("a shipped spec"))).collect()
}

fn snapshot(name: &str, text: &str) {
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "exchange", omit_expression => true }, {
        insta::assert_snapshot!(name, text);
    });
}

#[test]
fn a_robot_that_is_no_crane_is_told_why() {
    let mut shown = BTreeSet::new();
    for path in files("tests/bad_urdf") {
        let name = stem(&path);
        let source = SourceFile::new(format!("{name}.urdf"), std::fs::read_to_string(&path).expect("a file"));
        let fixed: &[String] = if name.starts_with("U013") { &["sholder".to_owned()] } else { &[] };
        let found = exchange::import(&source, fixed).expect_err(&name);
        snapshot(&name, &found.to_string());
        let code = name.split('_').next().expect("a code").to_owned();
        assert_eq!(found.mistakes().iter().map(|mistake| mistake.code).collect::<Vec<_>>(), [&code], "{name}: {found}");
        shown.insert(code);
    }
    for rule in exchange::CATALOGUE {
        assert!(shown.contains(rule.code), "no bad file for {}: {}", rule.code, rule.about);
    }
}

#[test]
fn a_crane_comes_back_from_urdf() {
    for crane in shipped() {
        let urdf = exchange::urdf(&crane, &crane.parameter_defaults());
        let spec = exchange::import(&SourceFile::new(format!("{}.urdf", crane.name), urdf), &[]).expect("a robot");
        let back = chain(&SourceFile::new(&crane.name, spec));
        assert_eq!(back.coordinates.len(), crane.coordinates.len());
        for (old, new) in crane.coordinates.iter().zip(&back.coordinates) {
            assert_eq!((old.kind, old.axis), (new.kind, new.axis), "{}: {}", crane.name, old.name);
        }
        let mass = |chain: &Chain| -> f64 {
            let defaults = chain.parameter_defaults();
            chain.bodies.iter().filter_map(|body| Some(body.inertia.as_ref()?.mass.at(&defaults))).sum()
        };
        // Masses are written to their last digit; their sum rounds.
        assert!((mass(&back) / mass(&crane) - 1.0).abs() < 1e-15, "{}", crane.name);
        assert_eq!(back.points.len(), crane.points.len());
    }
}

#[test]
fn friction_of_a_robots_joint_is_that_of_the_crane() {
    let urdf = "<robot name='arm'><link name='base'/>\
                <link name='upper'><inertial><mass value='6'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
                <joint name='shoulder' type='continuous'><parent link='base'/><child link='upper'/><axis xyz='0 0 1'/>\
                <dynamics damping='0.5' friction='2.5'/></joint></robot>";
    let spec = exchange::import(&SourceFile::new("arm.urdf", urdf), &[]).expect("a robot");
    let crane = chain(&SourceFile::new("arm", spec));
    let coulomb: Vec<f64> = crane.frictions().map(|(_, friction)| friction.coulomb.at(&[])).collect();
    assert_eq!(coulomb, [2.5]);
}

#[test]
fn a_joint_that_mimics_another_is_coupled_to_it() {
    let urdf = std::fs::read_to_string("tests/bad_urdf/U010_mimic.urdf").expect("text");
    let urdf = urdf.replace("sholder\" multiplier=\"2\"", "shoulder\" multiplier=\"2\" offset=\"0.3\"");
    let spec = exchange::import(&SourceFile::new("arm.urdf", urdf), &[]).expect("a robot");
    let crane = chain(&SourceFile::new("arm", spec));
    let [connector] = crane.connectors.as_slice() else { panic!("one coupling") };
    let Strain::Coupling { coordinate, leader, ratio } = &connector.strain else { panic!("{connector:?}") };
    assert_eq!([coordinate.0, leader.0], [1, 0]);
    assert_eq!(ratio.at(&[]), 2.0);
    assert!(format!("{:?}", connector.law).contains("0.3"), "{:?}", connector.law);
}

#[test]
fn what_is_written_is_for_people_to_read() {
    let cranes = shipped();
    let named = |name: &str| cranes.iter().find(|crane| crane.name == name).expect("a shipped crane");
    let (planar, rigid) = (named("knuckle_boom"), named("eight_link_rigid"));
    let urdf = exchange::urdf(planar, &planar.parameter_defaults());
    snapshot("knuckle_boom.urdf", &urdf);
    snapshot("knuckle_boom.springs.yaml", &exchange::springs(planar, &planar.parameter_defaults()));
    snapshot("knuckle_boom.xml", &exchange::mjcf(planar, &planar.parameter_defaults()).expect("expressible"));
    snapshot(
        "knuckle_boom.yaml",
        &exchange::import(&SourceFile::new("knuckle_boom.urdf", urdf), &[]).expect("a robot"),
    );
    // A live parameter is written as it is set.
    let heavy = exchange::urdf(rigid, &[800.0]);
    assert!(heavy.contains("load_mass = 800 kg") && heavy.contains("<mass value=\"1076\"/>"));
    snapshot("eight_link_rigid.xml", &exchange::mjcf(rigid, &rigid.parameter_defaults()).expect("expressible"));
}

#[test]
fn any_bytes_get_an_answer() {
    let urdf = std::fs::read_to_string(files("tests/bad_urdf").pop().expect("a file")).expect("text");
    for (at, _) in urdf.char_indices() {
        let cut = SourceFile::new(
            "cut.urdf",
            format!("{}{}", &urdf[..at], &urdf[at..].replacen(['"', '<', 'l', '0'], "é", 1)),
        );
        if let Ok(text) = exchange::import(&cut, &[]) {
            let _ = compile::load(&SourceFile::new("cut.yaml", text));
        }
    }
}
