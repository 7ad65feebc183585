//! URDF and MJCF: export of the shipped cranes, import of robots, and messages for files that are not cranes.
//!
//! `tools/peers/exchange.py` checks that other programs compute the same results from these files.

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

/// The spec of a robot.
fn spec(name: &str, text: &str) -> String {
    let imported = exchange::import(&SourceFile::new(name, text), &[]);
    imported.unwrap_or_else(|mistakes| panic!("\n{mistakes}")).spec
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
fn unsupported_robots_are_refused_with_the_reason() {
    let mut shown = BTreeSet::new();
    for path in files("tests/bad_robots") {
        let name = stem(&path);
        let file = path.file_name().expect("a name").to_string_lossy();
        let source = SourceFile::new(&*file, std::fs::read_to_string(&path).expect("a file"));
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
        let spec = spec(&format!("{}.urdf", crane.name), &urdf);
        let back = chain(&SourceFile::new(&crane.name, spec));
        assert_eq!(back.coordinates.len(), crane.coordinates.len());
        for (old, new) in crane.coordinates.iter().zip(&back.coordinates) {
            assert_eq!((old.kind, old.axis), (new.kind, new.axis), "{}: {}", crane.name, old.name);
        }
        let mass = |chain: &Chain| -> f64 {
            let defaults = chain.parameter_defaults();
            chain.bodies.iter().filter_map(|body| Some(body.inertia.as_ref()?.mass.at(&defaults))).sum()
        };
        // Masses are written with all their digits; only their sum is rounded.
        assert!((mass(&back) / mass(&crane) - 1.0).abs() < 1e-15, "{}", crane.name);
        assert_eq!(back.points.len(), crane.points.len());
    }
}

/// A robot with two fingers on one arm.
#[test]
fn branches_of_a_robot_are_those_of_the_crane() {
    let spec = spec("branches.urdf", include_str!("robots/branches.urdf"));
    assert!(spec.contains("    on: upper\n"), "{spec}");
    let crane = chain(&SourceFile::new("arm", spec));
    let carriers: Vec<_> = crane.bodies.iter().map(|body| body.parent.map(|parent| parent.0)).collect();
    assert_eq!(carriers, [None, Some(0), Some(0)]);
}

#[test]
fn friction_of_a_robots_joint_is_that_of_the_crane() {
    let urdf = "<robot name='arm'><link name='base'/>\
                <link name='upper'><inertial><mass value='6'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
                <joint name='shoulder' type='continuous'><parent link='base'/><child link='upper'/><axis xyz='0 0 1'/>\
                <dynamics damping='0.5' friction='2.5'/></joint></robot>";
    let spec = spec("arm.urdf", urdf);
    let crane = chain(&SourceFile::new("arm", spec));
    let coulomb: Vec<f64> = crane.frictions().map(|(_, friction)| friction.coulomb.at(&[])).collect();
    assert_eq!(coulomb, [2.5]);
}

#[test]
fn a_joint_that_mimics_another_is_coupled_to_it() {
    let urdf = std::fs::read_to_string("tests/bad_robots/U010_mimic.urdf").expect("text");
    let urdf = urdf.replace("sholder\" multiplier=\"2\"", "shoulder\" multiplier=\"2\" offset=\"0.3\"");
    let spec = spec("arm.urdf", &urdf);
    let crane = chain(&SourceFile::new("arm", spec));
    let [connector] = crane.connectors() else { panic!("one coupling") };
    let Strain::Coupling { coordinate, leader, ratio } = &connector.strain else { panic!("{connector:?}") };
    assert_eq!([coordinate.0, leader.0], [1, 0]);
    assert_eq!(ratio.at(&[]), 2.0);
    assert!(format!("{:?}", connector.law).contains("0.3"), "{:?}", connector.law);
}

/// A finger at `2 · 0 + 0.3` rad is where a placement of 0.3 rad puts it.
#[test]
fn a_joint_that_mimics_a_held_one_is_held_where_it_follows() {
    let hand = |follows: &str, turn: f64, fixed: &[&str]| {
        let mass = "<inertial><origin xyz='0.5 0.1 0'/><mass value='2'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
        let joint = |name: &str, from: &str, to: &str, rest: &str| {
            format!(
                "<joint name='{name}' type='continuous'><parent link='{from}'/><child link='{to}'/><axis xyz='0 0 1'/>{rest}</joint>"
            )
        };
        let joints = [
            joint("shoulder", "base", "upper", "<origin xyz='0 0 1'/>"),
            joint("wrist", "upper", "palm", "<origin xyz='1 0 0'/>"),
            joint("finger", "palm", "tip", &format!("<origin xyz='0.2 0 0' rpy='0 0 {turn}'/>{follows}")),
        ];
        let links = ["upper", "palm", "tip"].map(|name| format!("<link name='{name}'>{mass}</link>"));
        let urdf = format!("<robot name='hand'><link name='base'/>{}{}</robot>", links.concat(), joints.concat());
        let fixed: Vec<String> = fixed.iter().map(ToString::to_string).collect();
        let imported = exchange::import(&SourceFile::new("hand.urdf", urdf), &fixed);
        imported.unwrap_or_else(|mistakes| panic!("\n{mistakes}")).spec
    };
    let followed = hand("<mimic joint='wrist' multiplier='2' offset='0.3'/>", 0.0, &["wrist"]);
    assert!(followed.contains("held at zero: wrist; held at 0.3 rad: finger"), "{followed}");
    let com = |spec: String| {
        let crane = chain(&SourceFile::new("hand", spec));
        format!("{:?}", crane.bodies.iter().map(|body| &body.inertia).collect::<Vec<_>>())
    };
    assert_eq!(com(followed), com(hand("", 0.3, &["wrist", "finger"])));
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
    snapshot("knuckle_boom.yaml", &spec("knuckle_boom.urdf", &urdf));
    // A live parameter is written with the value that it is set to.
    let heavy = exchange::urdf(rigid, &[800.0]);
    assert!(heavy.contains("load_mass = 800 kg") && heavy.contains("<mass value=\"1076\"/>"));
    snapshot("eight_link_rigid.xml", &exchange::mjcf(rigid, &rigid.parameter_defaults()).expect("expressible"));
}

/// A robot arm with everything that the import converts.
const ARM: &str = include_str!("robots/arm.xml");

#[test]
fn a_crane_comes_back_from_mjcf() {
    let mut compared = 0;
    for crane in shipped() {
        let defaults = crane.parameter_defaults();
        let Ok(mjcf) = exchange::mjcf(&crane, &defaults) else { continue };
        let back = chain(&SourceFile::new(&crane.name, spec(&format!("{}.xml", crane.name), &mjcf)));
        assert_eq!(back.coordinates.len(), crane.coordinates.len());
        for (old, new) in crane.coordinates.iter().zip(&back.coordinates) {
            assert_eq!((old.kind, old.axis), (new.kind, new.axis), "{}: {}", crane.name, old.name);
        }
        let mass = |chain: &Chain| -> f64 {
            let defaults = chain.parameter_defaults();
            chain.bodies.iter().filter_map(|body| Some(body.inertia.as_ref()?.mass.at(&defaults))).sum()
        };
        assert!((mass(&back) / mass(&crane) - 1.0).abs() < 1e-14, "{}", crane.name);
        assert_eq!(back.points.len(), crane.points.len(), "{}", crane.name);
        assert_eq!(back.rigid_drives().count(), crane.rigid_drives().count(), "{}", crane.name);
        let apart = |(old, new): (&f64, &f64)| (old - new).abs();
        assert!(crane.guess.iter().zip(&back.guess).map(apart).fold(0.0, f64::max) < 1e-14, "{}", crane.name);
        compared += 1;
    }
    assert!(compared >= 5, "{compared} cranes can be written as MJCF");
}

#[test]
fn an_arm_in_mjcf_is_a_crane() {
    let imported = exchange::import(&SourceFile::new("arm.xml", ARM), &[]).expect("a robot");
    snapshot("arm.yaml", &imported.spec);
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "exchange", omit_expression => true }, {
        insta::assert_snapshot!("arm.left_out", imported.left_out.join("\n"));
    });
    let crane = chain(&SourceFile::new("arm", imported.spec));
    let names: Vec<&str> = crane.coordinates.iter().map(|coordinate| coordinate.name.as_str()).collect();
    assert_eq!(names, ["upper_1_psi", "upper_theta", "fore_theta", "rod_z", "tool_phi"]);
    let [friction] = crane.frictions().map(|(_, friction)| friction.coulomb.at(&[])).collect::<Vec<_>>()[..] else {
        panic!("one joint rubs")
    };
    assert_eq!(friction, 1.5);
    // The rod is coupled to the elbow.
    let [connector] = crane.connectors() else { panic!("one coupling") };
    let Strain::Coupling { coordinate, leader, ratio } = &connector.strain else { panic!("{connector:?}") };
    assert_eq!(([coordinate.0, leader.0], ratio.at(&[])), ([3, 2], -0.25));
    assert_eq!(crane.rigid_drives().count(), 1);
    assert_eq!(crane.gravity.each_ref().map(|g| g.at(&[])), [0.0, 0.0, -3.7]);
    assert_eq!(crane.guess[..4], [0.1, -0.2, 0.3, 0.05]);
}

/// Mass and second moments about the centre of bodies with the density of water, compared with sums over a grid.
#[test]
fn shapes_have_the_masses_of_solids() {
    type Inside = fn([f64; 3]) -> bool;
    let shapes: [(&str, Inside); 4] = [
        ("type='ellipsoid' size='0.3 0.2 0.5'", |[x, y, z]| {
            (x / 0.3).powi(2) + (y / 0.2).powi(2) + (z / 0.5).powi(2) <= 1.0
        }),
        ("type='box' size='0.3 0.2 0.5'", |[x, y, z]| x.abs() <= 0.3 && y.abs() <= 0.2 && z.abs() <= 0.5),
        ("type='cylinder' size='0.3 0.5'", |[x, y, z]| x.hypot(y) <= 0.3 && z.abs() <= 0.5),
        ("type='capsule' size='0.3 0.5'", |[x, y, z]| {
            let beyond = (z.abs() - 0.5).max(0.0);
            x * x + y * y + beyond * beyond <= 0.09
        }),
    ];
    for (geom, inside) in shapes {
        let mjcf = format!(
            "<mujoco><worldbody><body name='a'><joint axis='1 0 0'/><geom {geom}/></body></worldbody></mujoco>"
        );
        let crane = chain(&SourceFile::new("a", spec("a.xml", &mjcf)));
        let inertia = crane.bodies[0].inertia.as_ref().expect("a mass");
        let step = 0.025;
        let places = || (-34..34).map(|i| (f64::from(i) + 0.5) * step);
        let (mut mass, mut second) = (0.0, [0.0; 3]);
        for point in places().flat_map(|x| places().flat_map(move |y| places().map(move |z| [x, y, z]))) {
            if inside(point) {
                mass += 1000.0 * step * step * step;
                for (sum, x) in second.iter_mut().zip(point) {
                    *sum += 1000.0 * step * step * step * x * x;
                }
            }
        }
        // Cubes of 25 mm approximate shapes of this size to about one per cent.
        let close = |given: f64, found: f64| (given / found - 1.0).abs() < 0.02;
        assert!(close(inertia.mass.at(&[]), mass), "{geom}: {} kg, {mass}", inertia.mass.at(&[]));
        for k in 0..3 {
            assert!(close(inertia.second[k].at(&[]), second[k]), "{geom}: {:?}, {second:?}", inertia.second);
        }
    }
}

#[test]
fn any_bytes_get_an_answer() {
    // In the longer file, only every 29th position.
    for (file, every) in [("tests/bad_robots/U015_negative_mass.urdf", 1), ("tests/robots/arm.xml", 29)] {
        any_bytes_of(&std::fs::read_to_string(file).expect("text"), every);
    }
}

fn any_bytes_of(text: &str, every: usize) {
    for (at, _) in text.char_indices().step_by(every) {
        let cut =
            SourceFile::new("cut", format!("{}{}", &text[..at], &text[at..].replacen(['"', '<', 'l', '0'], "é", 1)));
        if let Ok(imported) = exchange::import(&cut, &[]) {
            let _ = compile::load(&SourceFile::new("cut.yaml", imported.spec));
        }
    }
}
