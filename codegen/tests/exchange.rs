//! URDF and MJCF: export of the shipped cranes, import of robots, and messages for files that are not cranes.
//!
//! `tools/peers/exchange.py` checks that other programs compute the same results from these files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crane_codegen::chain::{Analyses, Chain, Follower, Form, Frame, RigidCoupling};
use crane_codegen::exchange::ImportOptions;
use crane_codegen::program::{FunctionId, Inputs};
use crane_codegen::{SourceFile, build, compile, exchange, mechanics};

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
    let imported = exchange::import(&SourceFile::new(name, text), &ImportOptions::default());
    imported.unwrap_or_else(|mistakes| panic!("\n{mistakes}")).spec
}

/// The shipped cranes.
fn shipped() -> Vec<Chain> {
    let specs = files("../specs").into_iter().filter(|path| path.extension().is_some_and(|found| found == "yaml"));
    specs.map(|path| chain(&build::open(&path).expect("a shipped spec"))).collect()
}

/// With the guess as the start.
fn mjcf(crane: &Chain) -> Result<String, exchange::Inexpressible> {
    let parameters = crane.parameter_defaults();
    exchange::mjcf(crane, &parameters, &[], (&crane.guess_at(&parameters), "guess"))
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
        let fixed = if name.starts_with("U013") { vec!["sholder".to_owned()] } else { Vec::new() };
        let diagnostics =
            exchange::import(&source, &ImportOptions { fixed, ..ImportOptions::default() }).expect_err(&name);
        snapshot(&name, &diagnostics.to_string());
        let code = name.split('_').next().expect("a code").to_owned();
        assert_eq!(
            diagnostics.mistakes().iter().map(|mistake| mistake.code).collect::<Vec<_>>(),
            [&code],
            "{name}: {diagnostics}"
        );
        shown.insert(code);
    }
    for rule in exchange::CATALOGUE {
        assert!(shown.contains(rule.code), "no bad file for {}: {}", rule.code, rule.about);
    }
}

#[test]
fn a_crane_comes_back_from_urdf() {
    for crane in shipped() {
        let urdf = exchange::urdf(&crane, &crane.parameter_defaults(), &[]).expect("an open chain");
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
    assert_eq!(ties(&crane), [(1, 0, 2.0, 0.3)]);
}

/// Rigid couplings: coordinate, the one that it follows, ratio and offset.
fn ties(crane: &Chain) -> Vec<(usize, usize, f64, f64)> {
    let defaults = crane.parameter_defaults();
    let tie = |RigidCoupling { follower: Follower { coordinate, leader, ratio, offset }, .. }: &RigidCoupling| {
        (coordinate.0, leader.0, ratio.at(&defaults), offset.at(&defaults))
    };
    crane.rigid_couplings.iter().map(tie).collect()
}

/// With a ratio that is live.
#[test]
fn rigid_couplings_come_back_from_urdf_and_mjcf() {
    let link = |name: &str, axis: &str| {
        format!(
            "- {{name: {name}, placement: {{transform: {{translation: [1, 0, 0]}}}}, joint: {{{axis}}}, mass: 2, com: [0.5, 0, 0], \
             inertia: {{Ixx: 0.1, Iyy: 0.1, Izz: 0.1}}}}\n"
        )
    };
    let geared = chain(&SourceFile::new(
        "geared",
        format!(
            "format: 1\nname: geared\nparameters: {{r: {{value: 1.5}}}}\nlinks:\n{}{}{}couplings:\n\
             - {{name: belt, coordinate: two_theta, follows: one_theta, ratio: r, offset: -0.25, rigid: true}}\n\
             - {{name: screw, coordinate: three_x, follows: two_theta, ratio: -0.125, rigid: true}}\n",
            link("one", "revolute: {axis: y}"),
            link("two", "revolute: {axis: y}"),
            link("three", "prismatic: {axis: x}"),
        ),
    ));
    let parameters = [2.0];
    let urdf = exchange::urdf(&geared, &parameters, &[]).expect("rigid couplings are mimicked");
    let mjcf = exchange::mjcf(&geared, &parameters, &[], (&geared.guess_at(&parameters), "guess"))
        .expect("rigid couplings are equalities");
    for (name, text) in [("geared.urdf", urdf), ("geared.xml", mjcf)] {
        let back = chain(&SourceFile::new("geared", spec(name, &text)));
        assert_eq!(ties(&back), [(1, 0, 2.0, -0.25), (2, 1, -0.125, 0.0)], "{name}");
    }
}

/// Names of joints, and poses of frames in the world with each joint, by its name, at a position of its own.
fn places(crane: &Chain) -> (Vec<&str>, Vec<(&str, Frame)>) {
    let defaults = crane.parameter_defaults();
    let mut q = vec![0.0; crane.coordinates.len()];
    for joint in &crane.joints {
        q[joint.coordinate.expect("a joint that moves").0] = 0.3 * joint.name.len() as f64;
    }
    let bodies = crane.frames(&q, &defaults);
    let mut frames: Vec<(&str, Frame)> =
        bodies.iter().zip(&crane.bodies).map(|(at, body)| (&*body.name, *at)).collect();
    frames.extend(crane.frames.iter().map(|frame| {
        let at = frame.pose(crane, &defaults);
        (&*frame.name, frame.body.map_or(at, |body| bodies[body.0].outer(&at)))
    }));
    (crane.joints.iter().map(|joint| &*joint.name).collect(), frames)
}

/// Links that are turned, that fixed joints merge, also with the ground, and that have no names of the language. Angles are written with all
/// digits, and five products of matrices round to 1e-15.
#[test]
fn names_of_frames_and_joints_come_back_from_urdf_and_mjcf() {
    let heavy = "<inertial><mass value='2'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], rest: &str| {
        format!(
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><origin xyz='0.3 0 0.1' rpy='0.1 -0.2 0.3'/>{rest}</joint>"
        )
    };
    let urdf = format!(
        "<robot name='arm'><link name='base'/><link name='Stand'/><link name='upper'>{heavy}</link><link name='boom_theta_frame'>{heavy}</link>\
         <link name='fore &amp; &quot;rod&quot;'>{heavy}</link><link name='tool 0'/>{}{}{}{}{}</robot>",
        joint("floor", "fixed", ["base", "Stand"], ""),
        joint("plate", "fixed", ["upper", "boom_theta_frame"], ""),
        joint("elbow &lt;2>", "continuous", ["boom_theta_frame", "fore &amp; &quot;rod&quot;"], "<axis xyz='1 2 -2'/>"),
        joint("upper_mount", "continuous", ["Stand", "upper"], "<axis xyz='0 -1 0'/>"),
        joint("flange", "fixed", ["fore &amp; &quot;rod&quot;", "tool 0"], ""),
    );
    let crane = chain(&SourceFile::new("arm", spec("arm.urdf", &urdf)));
    let (joints, frames) = places(&crane);
    assert_eq!(joints, ["elbow <2>", "upper_mount"]);
    let of_file = ["base", "Stand", "upper", "boom_theta_frame", "fore & \"rod\"", "tool 0"];
    let parameters = crane.parameter_defaults();
    let urdf = exchange::urdf(&crane, &parameters, &[]).expect("an open chain");
    for (name, text) in [("arm.urdf", urdf), ("arm.xml", mjcf(&crane).expect("an arm"))] {
        let back = chain(&SourceFile::new("arm", spec(name, &text)));
        let (mut joints_back, frames_back) = places(&back);
        // In the order of coordinates, as the export has them.
        joints_back.sort_unstable();
        assert_eq!(joints_back, joints, "{name}");
        for wanted in of_file {
            // Of a name that a link has, too, the frame is meant.
            let of = |frames: &[(&str, Frame)]| frames.iter().rfind(|(name, _)| *name == wanted).map(|(_, at)| *at);
            let [Some(at), Some(back)] = [of(&frames), of(&frames_back)] else {
                panic!("{name}: no `{wanted}`\n{text}")
            };
            let entries = |frame: Frame| [frame.axes.concat(), frame.origin.to_vec()].concat();
            let apart = entries(at).into_iter().zip(entries(back)).map(|(one, other)| (one - other).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-14, "{name}: `{wanted}`\n{text}");
        }
    }
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
        let fixed = fixed.iter().map(ToString::to_string).collect();
        let options = ImportOptions { fixed, ..ImportOptions::default() };
        let imported = exchange::import(&SourceFile::new("hand.urdf", urdf), &options);
        imported.unwrap_or_else(|mistakes| panic!("\n{mistakes}")).spec
    };
    let followed = hand("<mimic joint='wrist' multiplier='2' offset='0.3'/>", 0.0, &["wrist"]);
    assert!(followed.contains("held at zero: wrist; held at 0.3 rad: finger"), "{followed}");
    let com = |spec: String| {
        let crane = chain(&SourceFile::new("hand", spec));
        format!("{:?}", crane.bodies.iter().map(|body| &body.inertia).collect::<Vec<_>>())
    };
    assert_eq!(com(followed), com(hand("", 0.3, &["wrist", "finger"])));
    // The other way round, the wrist is at (0 − 0.3)/2 rad; if both are to be held, it leads.
    let led = hand("<mimic joint='wrist' multiplier='2' offset='0.3'/>", 0.0, &["finger"]);
    assert!(led.contains("held at zero: finger; held at -0.15 rad: wrist"), "{led}");
    let both = hand("<mimic joint='wrist' multiplier='2' offset='0.3'/>", 0.0, &["finger", "wrist"]);
    assert!(both.contains("Joint `finger` is held at 0.3, where `wrist` puts it, and not at 0."), "{both}");
    // Where it follows at no rate, the wrist is anywhere.
    let apart = hand("<mimic joint='wrist' multiplier='0' offset='0.3'/>", 0.0, &["finger"]);
    assert!(apart.contains("held at zero: finger") && apart.contains("# joint wrist"), "{apart}");
}

#[test]
fn what_is_written_is_for_people_to_read() {
    let cranes = shipped();
    let named = |name: &str| cranes.iter().find(|crane| crane.name == name).expect("a shipped crane");
    let (planar, rigid) = (named("knuckle_boom"), named("eight_link_rigid"));
    let urdf = exchange::urdf(planar, &planar.parameter_defaults(), &[]).expect("an open chain");
    snapshot("knuckle_boom.urdf", &urdf);
    snapshot("knuckle_boom.springs.yaml", &exchange::springs(planar, &planar.parameter_defaults()));
    snapshot("knuckle_boom.xml", &mjcf(planar).expect("expressible"));
    snapshot("knuckle_boom.yaml", &spec("knuckle_boom.urdf", &urdf));
    // A live parameter is written with the value that it is set to.
    let heavy = exchange::urdf(rigid, &[800.0], &[]).expect("an open chain");
    assert!(heavy.contains("load_mass = 800 kg") && heavy.contains("<mass value=\"1076\"/>"));
    snapshot("eight_link_rigid.xml", &mjcf(rigid).expect("expressible"));
}

/// A robot arm with everything that the import converts.
const ARM: &str = include_str!("robots/arm.xml");

#[test]
fn a_crane_comes_back_from_mjcf() {
    let mut compared = 0;
    for crane in shipped() {
        let Ok(mjcf) = mjcf(&crane) else { continue };
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
    let imported = exchange::import(&SourceFile::new("arm.xml", ARM), &ImportOptions::default()).expect("a robot");
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
    assert_eq!(ties(&crane), [(3, 2, -0.25, 0.1)]);
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
        if let Ok(imported) = exchange::import(&cut, &ImportOptions::default()) {
            let _ = compile::load(&SourceFile::new("cut.yaml", imported.spec));
        }
    }
}

/// A quantity of a crane at a state, as the interpreter computes it: of a symmetric matrix the upper triangle, row by row.
fn quantity(crane: &Chain, function: FunctionId, q: &[f64], v: &[f64]) -> Vec<f64> {
    let program = mechanics::derive(crane, Analyses::ALL);
    let function = program.function(function).expect("a function of every crane");
    let inputs = Inputs::state(0.0, q.to_vec(), v.to_vec(), crane.parameter_defaults());
    function.shape.expand(program.evaluate(function, &inputs))
}

/// A spec that is valid, without a warning about an inertia.
fn accepted(name: &str, spec: &str) -> Chain {
    let checked = compile::check(&SourceFile::new(name, spec)).unwrap_or_else(|mistakes| panic!("{name}:\n{mistakes}"));
    assert!(checked.warnings.mistakes().iter().all(|warning| warning.code != "W011"), "{}", checked.warnings);
    checked.chain
}

/// The first link has moments and no mass. By hand: of the second link, at `p = 0.8 x + 0.2 (cos q₂ x + sin q₂ y)` in the first one's axes,
/// `A₁₁ = 0.03 + (0.8 + 0.2 cos q₂)² + 0.02 sin² q₂ + 0.03 cos² q₂`.
#[test]
fn moments_without_mass_are_part_of_the_crane() {
    let crane = accepted("moments", &spec("moments.urdf", include_str!("robots/moments_without_mass.urdf")));
    let (sin, cos) = 0.2_f64.sin_cos();
    let right = 0.03 + (0.8 + 0.2 * cos).powi(2) + 0.02 * sin * sin + 0.03 * cos * cos;
    // Pinocchio's, to the digits that it was noted with.
    assert!((right - 1.051_647_83_f64).abs() < 1e-8);
    let value = quantity(&crane, FunctionId::MassMatrix, &[0.3, 0.2], &[0.0; 2])[0];
    // Rounding of a dozen operations.
    assert!((value / right - 1.0).abs() < 1e-14, "{value}, {right}");
    // The same in MJCF: a rotor beside the body that has the mass.
    let rotor = "<mujoco><worldbody><body name='arm'><joint axis='0 1 0'/>\
                 <inertial pos='0.5 0 0' mass='1' diaginertia='0.01 0.1 0.1'/>\
                 <body name='rotor' pos='0.3 0 0'><inertial pos='0 0 0' mass='0' diaginertia='0.5 0.5 0.5'/></body></body></worldbody></mujoco>";
    let found =
        quantity(&chain(&SourceFile::new("rotor", spec("rotor.xml", rotor))), FunctionId::MassMatrix, &[0.4], &[0.0]);
    assert!((found[0] - (0.1 + 0.25 + 0.5)).abs() < 1e-15, "{found:?}");
}

/// A rod has no moment about its axis; of bodies that move together only the sum matters; one that never moves does not matter.
#[test]
fn inertias_are_judged_by_what_moves() {
    let rod = accepted("rod", &spec("rod.urdf", include_str!("robots/rod.urdf")));
    assert_eq!(rod.coordinates.len(), 2);
    accepted("rounding", include_str!("robots/rounded_flange.yaml"));
    let inertial = |ixx: &str| {
        format!(
            "<inertial><mass value='1'/><inertia ixx='{ixx}' iyy='0.2' izz='0.2' ixy='0' ixz='0' iyz='0'/></inertial>"
        )
    };
    let robot = |base: &str, tip: &str| {
        let joint =
            "<joint name='j' type='continuous'><parent link='base'/><child link='tip'/><axis xyz='0 0 1'/></joint>";
        format!(
            "<robot name='r'><link name='base'>{}</link><link name='tip'>{}</link>{joint}</robot>",
            inertial(base),
            inertial(tip)
        )
    };
    accepted("still", &spec("still.urdf", &robot("-7", "0.1")));
    // A link that stands on another one by its placement, in the spec language.
    let with = |second: &str| {
        format!(
            "format: 1\nname: two\nlinks:\n\
             \x20 - {{name: arm, joint: revolute, mass: 5, com: [1, 0, 0], inertia: {{Ixx: 0.1, Iyy: 2, Izz: 2}}}}\n\
             \x20 - {{name: plate, placement: {{transform: {{translation: [1, 0, 0], rotation: {{x: 30 deg}}}}}}, {second}mass: 0.1, com: [0, 0, 0], inertia: {{Ixx: 0.01, Iyy: 0.01, Izz: 0.03}}}}\n"
        )
    };
    accepted("together", &with(""));
    let alone = compile::load(&SourceFile::new("alone", with("joint: revolute, "))).expect_err("impossible on its own");
    assert_eq!(alone.mistakes().iter().map(|mistake| mistake.code).collect::<Vec<_>>(), ["E051"], "{alone}");
}

/// Each slip alone makes an inertia impossible, and the message names it.
#[test]
fn the_message_about_an_impossible_inertia_names_the_slip() {
    for (text, slip) in [
        ("{Ixx: -1, Iyy: 2, Izz: 2}", "the other sign of `Ixx`"),
        ("{Ixx: 1, Iyy: 2, Izz: 2, Ixy: 3}", "with `Ixy` 0.3 instead of 3 kg m²"),
        ("{Ixx: 11, Iyy: 14, Izz: 5, Ixy: 1, Ixz: 30, Iyz: 1}", "with `Ixz` 3 instead of 30 kg m²"),
        ("{about: origin, Ixx: 1, Iyy: 2, Izz: 2}", "leave out `about: origin`"),
    ] {
        let spec = format!(
            "format: 1\nname: slip\nlinks:\n  - {{name: arm, joint: revolute, mass: 10, com: [1, 0.3, 0], inertia: {text}}}\n"
        );
        let found = compile::load(&SourceFile::new("slip", spec)).expect_err(text).to_string();
        assert!(found.contains(slip), "{text}:\n{found}");
    }
}

/// Moments 1, 2, 4 about the centre of mass become 1.5, 2.5, 4, as `mass::tests` work out; nothing else changes, and it is said.
#[test]
fn impossible_inertias_are_repaired_on_request() {
    let urdf = "<robot name='r'><link name='base'/><link name='tip'><inertial><mass value='3'/>\
                <inertia ixx='1' iyy='2' izz='4' ixy='0' ixz='0' iyz='0'/></inertial></link>\
                <joint name='j' type='continuous'><parent link='base'/><child link='tip'/><axis xyz='0 0 1'/></joint></robot>";
    let import = |repair| {
        exchange::import(&SourceFile::new("r.urdf", urdf), &ImportOptions { repair, ..ImportOptions::default() })
    };
    let [as_it_is, repaired] = [false, true].map(|repair| import(repair).expect("a robot"));
    assert!(compile::load(&SourceFile::new("r", as_it_is.spec.as_str())).is_err());
    assert!(repaired.spec.contains("inertia: {Ixx: 1.5, Iyy: 2.5, Izz: 4}"), "{}", repaired.spec);
    accepted("r", &repaired.spec);
    let remark = "Repaired: the inertia of link `tip` about its centre of mass, [1.0, 2.0, 4.0, 0.0, 0.0, 0.0] kg m², is impossible; \
                  written is [1.5, 2.5, 4.0, 0.0, 0.0, 0.0] (Ixx, Iyy, Izz, Ixy, Ixz, Iyz).";
    assert!(repaired.left_out.iter().any(|told| told == remark), "{:?}", repaired.left_out);
    assert!(as_it_is.left_out.iter().all(|told| !told.contains("Repaired")));
}

/// An effort of 700 N m, as an actuator without a command and in the file of springs. That MuJoCo computes it so, checks
/// `tools/peers/exchange.py`.
#[test]
fn efforts_of_drives_are_exported() {
    let spec = "format: 1\nname: effort\nlinks:\n  - {name: boom, joint: revolute, mass: 100, com: [1, 0, 0]}\n\
                drives:\n  - {coordinate: boom_psi, stiffness: 1e5, motion: {hold: 0}, effort: {hold: 700}}\n";
    let crane = chain(&SourceFile::new("effort", spec));
    assert_eq!(exchange::approximations(&crane), None);
    let mjcf = mjcf(&crane).expect("it can be expressed");
    assert!(mjcf.contains("gainprm=\"0\" biastype=\"affine\" biasprm=\"700 0 0\""), "{mjcf}");
    let springs = exchange::springs(&crane, &[]);
    assert!(springs.contains("boom_psi: {stiffness: 100000, damping: 0, rest: 0, effort: 700}"), "{springs}");
}

fn imported(file: &str) -> exchange::Imported {
    let path = Path::new("tests/robots").join(file);
    let source = SourceFile::new(file, std::fs::read_to_string(path).expect("a robot"));
    exchange::import(&source, &ImportOptions::default()).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn accelerations(file: &str, q: &[f64]) -> (Chain, Vec<f64>) {
    let crane = chain(&SourceFile::new(file, imported(file).spec));
    let found = quantity(&crane, FunctionId::ForwardDynamics, q, &vec![0.0; q.len()]);
    (crane, found)
}

/// An arm of 2 kg at 0.4 m with 0.1 kg m²: `q̈ = m g r / (I + m r²)`.
#[test]
fn options_of_mjcf_are_merged_and_flags_hold() {
    let inertia = 0.1 + 2.0 * 0.4 * 0.4;
    // Two `<option>`: the second has no gravity. The moment of the weight is 2.96 N m.
    let (_, found) = accelerations("two_options.xml", &[0.0]);
    assert!((found[0] * inertia - 2.96).abs() < 1e-14, "{found:?}");
    // Flags switch its spring and its damper off.
    let (crane, found) = accelerations("flags.xml", &[0.0]);
    assert!((found[0] - 18.685_714_285_714_28).abs() < 1e-12, "{found:?}");
    assert!(crane.drives.is_empty() && crane.forces.is_empty(), "{crane:?}");
}

/// The defaults of equalities say that none is active. Accelerations are `MuJoCo`'s, noted with six digits.
#[test]
fn equalities_have_their_defaults() {
    let (crane, found) = accelerations("default_equality.xml", &[0.3, 0.1]);
    assert!(crane.connectors().is_empty());
    for (value, right) in found.iter().zip([14.7219, -18.5548]) {
        assert!((value - right).abs() < 5e-5, "{value}, {right}");
    }
    assert!(
        imported("default_equality.xml")
            .left_out
            .contains(&"Left out, equalities that are not active: <joint>.".to_owned())
    );
}

/// Two equalities for one joint are two equations: the second one is that of the other joint. With 0.1 + 2 q₁ and 0.3 − 4 q₁ for the first
/// joint, the third is at (0.3 − q₁) / 4.
#[test]
fn several_equalities_of_one_joint_all_hold() {
    let body = |name: &str, inside: &str| {
        format!(
            "<body name='{name}'><joint name='j{name}' axis='0 1 0'/><inertial pos='0.4 0 0' mass='2' diaginertia='0.1 0.1 0.1'/>{inside}</body>"
        )
    };
    let bodies = body("a", &body("b", &body("c", "")));
    let robot = |equalities: &str| {
        let text = format!("<mujoco><worldbody>{bodies}</worldbody><equality>{equalities}</equality></mujoco>");
        exchange::import(&SourceFile::new("robot.xml", text), &ImportOptions::default())
    };
    let two = "<joint joint1='ja' joint2='jb' polycoef='0.1 2 0 0 0'/><joint joint1='ja' joint2='jc' polycoef='0.3 -4 0 0 0'/>";
    let crane = chain(&SourceFile::new("robot", robot(two).expect("a robot").spec));
    assert_eq!(ties(&crane), [(0, 1, 2.0, 0.1), (2, 0, -0.25, 0.075)]);
    let held = robot("<joint joint1='ja'/><joint joint1='ja' polycoef='0.2 0 0 0 0'/>").expect_err("held twice");
    assert_eq!(held.mistakes()[0].code, "U025");
}

#[test]
fn a_site_and_a_body_of_one_name_are_a_point_and_a_link() {
    let crane = chain(&SourceFile::new("arm", imported("site_and_body.xml").spec));
    assert_eq!(crane.coordinates.len(), 2);
    let names: Vec<&str> = crane.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["arm", "wrist"]);
}

#[test]
fn a_link_and_a_site_may_have_the_name_of_the_ground() {
    let text = "format: 1\nname: a\nlinks: [{name: world, joint: revolute, mass: 2, com: [1, 0, 0]}]\nframes: [{name: world, link: world, transform: {translation: [0.5, 0, 0]}}]";
    let crane = chain(&SourceFile::new("a", text));
    let back = chain(&SourceFile::new("a", spec("a.xml", &mjcf(&crane).expect("a link"))));
    let names: Vec<&str> = back.frames.iter().map(|frame| &*frame.name).collect();
    assert_eq!((&*back.bodies[0].name, names), ("world_2", vec!["world", "world_site"]));
    let urdf = exchange::urdf(&crane, &[], &[]).expect("a link");
    let back = chain(&SourceFile::new("a", spec("a.urdf", &urdf)));
    let names: Vec<&str> = back.frames.iter().map(|frame| &*frame.name).collect();
    assert_eq!((&*back.bodies[0].name, names), ("world_2", vec!["world_3", "world"]));
}

#[test]
fn a_joint_starts_at_its_ref() {
    let text = "<mujoco><compiler angle='radian'/><worldbody><body name='a'><joint axis='0 1 0' ref='0.4'/>\
                <inertial pos='0.4 0 0' mass='2' diaginertia='0.1 0.1 0.1'/></body></worldbody></mujoco>";
    assert_eq!(chain(&SourceFile::new("a", spec("a.xml", text))).guess, [0.4]);
}

#[test]
fn included_files_are_read_where_they_stand() {
    let arm = "<mujocoinclude><body name='arm'><joint name='j' axis='0 1 0'/><include file='mass.xml'/></body></mujocoinclude>";
    let mass = "<m><inertial pos='0.4 0 0' mass='2' diaginertia='0.1 0.1 0.1'/></m>";
    let scene = "<mujoco><worldbody><include file='arm.xml'/></worldbody></mujoco>";
    let mut read = |file: &str| match file {
        "arm.xml" => Some(arm.to_owned()),
        "mass.xml" => Some(mass.to_owned()),
        _ => None,
    };
    let whole = exchange::with_includes(SourceFile::new("scene.xml", scene), &mut read);
    assert_eq!(whole.name, "scene.xml with arm.xml with mass.xml");
    let crane = chain(&SourceFile::new("scene", spec("scene.xml", &whole.text)));
    assert_eq!(crane.bodies[0].inertia.as_ref().map(|inertia| inertia.mass.at(&[])), Some(2.0));
    // A file that includes itself is read once, and the rest is reported.
    let mut itself = |_: &str| Some("<m><include file='a.xml'/></m>".to_owned());
    let text =
        exchange::with_includes(SourceFile::new("a", "<mujoco><include file='a.xml'/></mujoco>"), &mut itself).text;
    assert_eq!(text, "<mujoco><include file='a.xml'/></mujoco>");
}

/// A rotor of 4e-4 kg m² behind a reduction of 100 is 4 kg m² at the joint, beside `0.03 + 3 · 0.4²`.
#[test]
fn rotors_of_transmissions_are_armature() {
    let imported = imported("rotor.urdf");
    assert!(imported.spec.contains("  a_theta: 4\n"), "{}", imported.spec);
    let crane = chain(&SourceFile::new("rotor", imported.spec));
    let value = quantity(&crane, FunctionId::MassMatrix, &[0.3], &[0.0])[0];
    assert!((value - 4.51).abs() < 1e-14, "{value}");
    assert!(
        imported.left_out.contains(
            &"Left out, limits and control of drives: `effort` of <limit>, `velocity` of <limit>, <type>.".to_owned()
        ),
        "{:?}",
        imported.left_out
    );
}

#[test]
fn limits_without_end_and_other_namespaces_are_read() {
    let endless = imported("infinite_limits.urdf");
    assert!(!endless.spec.contains("; from "), "{}", endless.spec);
    let other = imported("namespace.urdf");
    assert_eq!(chain(&SourceFile::new("u13", other.spec)).coordinates.len(), 2);
    let told = "Left out, extensions of other programs: <drake:collision_filter_group>.";
    assert!(other.left_out.contains(&told.to_owned()), "{:?}", other.left_out);
}

/// An attribute that no reader asks for is listed wherever it stands, unless all of its element is left out; so is an element.
#[test]
fn what_is_not_understood_is_told() {
    for (file, left_out) in [
        ("branches.urdf", &[][..]),
        ("arm.xml", &["<motor ", "<position ", "<weld ", "<geom name=\"ground\"", "<geom type=\"mesh\""]),
    ] {
        let text = std::fs::read_to_string(Path::new("tests/robots").join(file)).expect("a robot");
        let import =
            |text: &str| exchange::import(&SourceFile::new(file, text), &ImportOptions::default()).expect(file);
        let mut told = 0;
        for (at, _) in
            text.match_indices('<').filter(|(at, _)| text[at + 1..].starts_with(|c: char| c.is_ascii_alphabetic()))
        {
            let name: String = text[at + 1..].chars().take_while(char::is_ascii_alphanumeric).collect();
            let end = at + 1 + name.len();
            let with = import(&format!("{} unheard=\"1\"{}", &text[..end], &text[end..]));
            let remark = with.left_out.iter().find(|remark| remark.contains("`unheard`"));
            if left_out.iter().any(|start| text[at..].starts_with(start)) {
                continue;
            }
            let remark = remark.unwrap_or_else(|| panic!("{file}: {}\n{:?}", &text[at..end + 20], with.left_out));
            assert!(with.spec.contains(&format!("#   {remark}\n")), "{}", with.spec);
            told += 1;
        }
        assert!(told > 10, "{file}: {told}");
        let inner = text.find("</joint>").or(text.find("</body>")).expect("an end");
        let with = import(&format!("{}<unheard/>{}", &text[..inner], &text[inner..]));
        assert!(with.left_out[0].starts_with("Not understood and left out: <unheard>"), "{:?}", with.left_out);
    }
}

/// What is read and has no effect where it stands.
#[test]
fn what_acts_on_nothing_is_told() {
    let told = |name: &str, text: &str| {
        spec(name, text).lines().filter(|line| line.starts_with("#   Left out")).collect::<String>()
    };
    let robot = include_str!("robots/namespace.urdf");
    let fixed = robot.find("type=\"fixed\"").expect("a fixed joint");
    let inner = fixed + robot[fixed..].find('>').expect("an end") + 1;
    let (before, after) = robot.split_at(inner);
    let left_out = told(
        "a.urdf",
        &format!("{before}<dynamics damping='1'/><limit lower='0' upper='1' effort='1' velocity='1'/>{after}"),
    );
    assert!(left_out.contains("what acts on fixed joints: <dynamics>, <limit>."), "{left_out}");
    let tendons =
        "<fixed name='slack'><joint joint='j' coef='2'/></fixed><fixed name='held'><joint joint='k' coef='1'/></fixed>";
    let text = format!(
        "<mujoco><worldbody><body name='stand'><geom size='1'/></body><body name='a'><joint type='free' pos='0 0 1'/>{MASS}\
         <body name='b'><joint name='j' axis='0 1 0'/>{MASS}<body name='c'><joint name='k' axis='0 1 0'/>{MASS}</body></body></body></worldbody>\
         <tendon>{tendons}</tendon><equality><tendon tendon1='held'/></equality></mujoco>"
    );
    let left_out = told("a.xml", &text);
    for remark in ["tendons that exert no force: <fixed>.", "such as the world: 1.", "`pos` of <joint>"] {
        assert!(left_out.contains(remark), "{remark}: {left_out}");
    }
}

/// Solids that a file shows are shapes of the spec, in the frame of its link, with that of a link that a fixed joint merges. Surfaces, solids without a size and
/// groups that MuJoCo does not show are left out. A cylinder of two ends is at their middle. Rounding of numbers about 1.
#[test]
fn solids_that_are_shown_are_shapes() {
    let inertial = "<inertial><mass value='2'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let visual = |origin: &str, solid: &str| {
        format!("<visual><origin {origin}/><geometry>{solid}</geometry><material name='m'/></visual>")
    };
    let urdf = format!(
        "<robot name='r'><link name='base'/><link name='arm'>{inertial}{}{}{}</link><link name='tool'>{}{}</link>\
         <joint name='j' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/></joint>\
         <joint name='f' type='fixed'><parent link='arm'/><child link='tool'/><origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/></joint></robot>",
        visual("xyz='0.5 0 0'", "<box size='1 0.2 0.1'/>"),
        visual("rpy='0 1.5707963267948966 0'", "<cylinder radius='0.1' length='0.6'/>"),
        visual("", "<mesh filename='a.stl'/>"),
        visual("xyz='0.2 0 0'", "<sphere radius='0.3'/>"),
        visual("", "<cylinder radius='0' length='1'/>"),
    );
    let seen = "<mujoco><worldbody><body name='arm'><joint axis='0 0 1'/><inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/>\
         <geom type='box' size='0.5 0.1 0.05' pos='0.5 0 0'/><geom type='cylinder' size='0.1' fromto='-0.3 0 0 0.3 0 0'/>\
         <body name='tool' pos='1 0 0' euler='0 0 90'><geom size='0.3' pos='0.2 0 0' mass='0'/><geom size='1' group='3' mass='0'/></body></body></worldbody></mujoco>";
    let expected = [
        (Form::Box([1.0, 0.2, 0.1]), [0.5, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (Form::Cylinder { diameter: 0.2, length: 0.6 }, [0.0; 3], [1.0, 0.0, 0.0]),
        (Form::Capsule { diameter: 0.6, length: 0.0 }, [1.0, 0.2, 0.0], [0.0, 0.0, 1.0]),
    ];
    for (name, text) in [("r.urdf", urdf.as_str()), ("r.xml", seen)] {
        let written = spec(name, text);
        let crane = chain(&SourceFile::new("robot", &written));
        let found: Vec<_> = crane.shapes.iter().map(|shape| shape.at(&crane, &[])).collect();
        assert_eq!(found.len(), expected.len(), "{written}");
        for ((frame, form), (solid, at, axis)) in found.iter().zip(&expected) {
            assert_eq!(form, solid, "{written}");
            let off = [0, 1, 2].map(|i| (frame.origin[i] - at[i]).abs() + (frame.axes[2][i] - axis[i]).abs());
            assert!(off.iter().sum::<f64>() < 1e-15 * 8.0, "{name}: {frame:?}");
        }
        // And back: the same forms.
        let forms = |crane: &Chain| crane.shapes.iter().map(|shape| shape.at(crane, &[]).1).collect::<Vec<_>>();
        let urdf = exchange::urdf(&crane, &[], &[]).expect("an open chain");
        for (name, text) in [("again.urdf", urdf), ("again.xml", mjcf(&crane).expect("an open chain"))] {
            let again = chain(&SourceFile::new("again", spec(name, &text)));
            assert_eq!(forms(&again), forms(&crane), "{name}");
        }
    }
    let left_out = spec("r.urdf", &urdf);
    assert!(left_out.contains("shapes and colours: <material> (3), <visual> (2)."), "{left_out}");
}

/// Names of the coordinates of a robot in MJCF or URDF.
fn coordinates(name: &str, text: &str) -> Vec<String> {
    chain(&SourceFile::new("robot", spec(name, text))).coordinates.into_iter().map(|c| c.name).collect()
}

/// A body of 2 kg with moments of 0.1 kg m², its centre 0.4 m along x.
const MASS: &str = "<inertial pos='0.4 0 0' mass='2' diaginertia='0.1 0.1 0.1'/>";

#[test]
fn joints_with_several_axes_become_joints_of_one_axis() {
    let body = |joint: &str, inside: &str| {
        format!("<mujoco><worldbody><body name='a' pos='1 2 3'>{joint}{MASS}{inside}</body></worldbody></mujoco>")
    };
    let arm = format!("<body name='b' pos='1 0 0'><joint name='j' type='ball' pos='0.1 0 0'/>{MASS}</body>");
    let free = body("<freejoint name='root'/>", &arm);
    let names = ["a_x", "a_y", "a_z", "a_psi", "a_theta", "a_phi", "b_1_psi", "b_2_theta", "b_phi"];
    assert_eq!(coordinates("a.xml", &free), names);
    // Positions of a free joint are those in the world, and it starts where the body is.
    let crane = chain(&SourceFile::new("a", spec("a.xml", &free)));
    assert_eq!(crane.guess[..6], [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    // Half a turn about z of the root, a quarter turn about x of the ball.
    let key = "<keyframe><key qpos='4 5 6 0 0 0 1 0.7071067811865476 0.7071067811865476 0 0'/></keyframe></mujoco>";
    let posed = free.replace("</mujoco>", key);
    let guess = chain(&SourceFile::new("a", spec("a.xml", &posed))).guess;
    let expected = [4.0, 5.0, 6.0, std::f64::consts::PI, 0.0, 0.0, 0.0, 0.0, std::f64::consts::FRAC_PI_2];
    for (found, expected) in guess.iter().zip(expected) {
        // Angles are written to a relative 1e-15.
        assert!((found - expected).abs() < 1e-14, "{guess:?}");
    }
    let urdf = |kind: &str| {
        format!(
            "<robot name='a'><link name='base'/><link name='b'><inertial><mass value='2'/>\
             <inertia ixx='1' iyy='1' izz='1'/></inertial></link><joint name='j' type='{kind}'><parent link='base'/>\
             <child link='b'/><axis xyz='0 0 1'/></joint></robot>"
        )
    };
    assert_eq!(coordinates("a.urdf", &urdf("floating")), ["b_x", "b_y", "b_z", "b_psi", "b_theta", "b_phi"]);
    assert_eq!(coordinates("a.urdf", &urdf("planar")), ["b_x", "b_y", "b_psi"]);
    // All axes are held together, where they start.
    let options = ImportOptions { fixed: vec!["root".to_owned()], ..ImportOptions::default() };
    let held = exchange::import(&SourceFile::new("a.xml", free), &options).expect("a robot").spec;
    let crane = chain(&SourceFile::new("a", held));
    assert_eq!(crane.coordinates.len(), 3);
    assert!((crane.frames(&[0.0; 3], &[])[1].origin[0] - 2.1).abs() < 1e-15);
}

/// Two equal bodies of 2 kg, together 3 kg; of moments 1, 2 and 4 kg m², the mean.
#[test]
fn masses_are_changed_as_the_compiler_of_mujoco_does() {
    let bodies = "<body name='a'><joint axis='0 1 0'/><inertial pos='0 0 0' mass='2' diaginertia='1 2 4'/>\
                  <body name='b'><joint axis='0 0 1'/><inertial pos='0.5 0 0' mass='2' diaginertia='0.1 0.1 0.1'/></body></body>";
    let robot = |compiler: &str| {
        let text = format!("<mujoco><compiler {compiler}/><worldbody>{bodies}</worldbody></mujoco>");
        chain(&SourceFile::new("robot", spec("robot.xml", &text)))
    };
    let balanced = robot("settotalmass='3' balanceinertia='true'");
    let mass = |body: usize| balanced.bodies[body].inertia.as_ref().map_or(0.0, |inertia| inertia.mass.at(&[]));
    assert!((mass(0) - 1.5).abs() < 1e-15 && (mass(1) - 1.5).abs() < 1e-15);
    // About y: three quarters of 7/3 of the first body and of `0.1 + 2 · 0.5²` of the second.
    let about_y = quantity(&balanced, FunctionId::MassMatrix, &[0.0, 0.0], &[0.0, 0.0])[0];
    assert!((about_y - 0.75 * (7.0 / 3.0 + 0.6)).abs() < 1e-14, "{about_y}");
    let bounded = robot("balanceinertia='true' boundmass='5' boundinertia='0.3'");
    let about_z = quantity(&bounded, FunctionId::MassMatrix, &[0.0, 0.0], &[0.0, 0.0])[2];
    assert!((about_z - (0.3 + 5.0 * 0.25)).abs() < 1e-14, "{about_z}");
}

/// `L = 2 q₁ − q₂` with 5 N/m and 3 N s/m, relaxed at 0.4 m: of q₁, 20 N m/rad to `q₂/2 + 0.2`.
#[test]
fn fixed_tendons_are_springs_and_equations_of_joints() {
    let body = |name: &str, inside: &str| {
        format!("<body name='{name}'><joint name='j{name}' axis='0 1 0' ref='0.1'/>{MASS}{inside}</body>")
    };
    let robot = |tendon: &str, equality: &str| {
        let bodies = body("a", &body("b", &body("c", "")));
        let text = format!(
            "<mujoco><compiler angle='radian'/><worldbody>{bodies}</worldbody><tendon><fixed name='t' {tendon}>\
             <joint joint='ja' coef='2'/><joint joint='jb' coef='-1'/></fixed></tendon><equality>{equality}</equality></mujoco>"
        );
        exchange::import(&SourceFile::new("robot.xml", text), &ImportOptions::default())
    };
    let spring = robot("stiffness='5' damping='3' springlength='0.4'", "").expect("a robot").spec;
    let line =
        "- {name: t, coordinate: a_theta, follows: b_theta, ratio: 0.5, offset: 0.2, stiffness: 20, damping: 12}";
    assert!(spring.contains(line), "{spring}");
    // Without a rest length, it is relaxed where both joints are at their `springref`, which is 0.
    assert!(robot("stiffness='5'", "").expect("a robot").spec.contains("ratio: 0.5, stiffness: 20, damping: 0}"));
    // 2 (q₁ − 0.1) − (q₂ − 0.1) = 0.6.
    let equation = robot("", "<tendon tendon1='t' polycoef='0.6 0 0 0 0'/>").expect("a robot").spec;
    assert!(equation.contains("coordinate: a_theta, follows: b_theta, ratio: 0.5, offset: 0.35,"), "{equation}");
    let three = robot("", "<joint joint1='jc'/><tendon tendon1='t'/><tendon tendon1='t' tendon2='t'/>");
    assert!(three.expect_err("no joint").to_string().contains("the equality of 0 joints"));
}

/// A joint with J = 0.1 + 2 · 0.4² + 0.08 = 0.5 kg m², T = 0.5 s and ζ = 0.8: k = J/(T ζ)² = 3.125 N m/rad, d = 2 J/T = 2 N m s/rad.
#[test]
fn springs_and_dampers_of_a_time_constant_and_a_damping_ratio() {
    let text = format!(
        "<mujoco><worldbody><body name='a'><joint axis='0 1 0' springdamper='0.5 0.8' armature='0.08'/>{MASS}</body></worldbody></mujoco>"
    );
    let found = spec("a.xml", &text);
    assert!(found.contains("stiffness: 3.125, damping: 2, motion: {hold: 0}, armature: 0.08}"), "{found}");
}

#[test]
fn what_an_import_cannot_keep_is_told() {
    let robot = |compiler: &str, inside: &str, fixed: &[&str]| {
        let bodies = format!(
            "<body name='a'><freejoint name='root'/>{MASS}<body name='b'><joint name='j' axis='0 1 0'/>{MASS}\
             <body name='c'><joint name='k' axis='0 1 0'/>{MASS}</body></body></body>"
        );
        let text = format!("<mujoco><compiler {compiler}/><worldbody>{bodies}</worldbody>{inside}</mujoco>");
        let options =
            ImportOptions { fixed: fixed.iter().map(ToString::to_string).collect(), ..ImportOptions::default() };
        exchange::import(&SourceFile::new("robot.xml", text), &options)
    };
    // A follower that is held holds its leader.
    let tied = "<equality><joint joint1='k' joint2='j'/></equality>";
    let held = robot("", tied, &["k"]).expect("a robot").spec;
    assert!(held.contains("held at zero: j, k"), "{held}");
    // Bodies without shapes keep their inertial frames.
    let crane = chain(&SourceFile::new("a", robot("inertiafromgeom='true'", "", &[]).expect("a robot").spec));
    let mass = |body: &crane_codegen::chain::Body| body.inertia.as_ref().map_or(0.0, |inertia| inertia.mass.at(&[]));
    assert!((crane.bodies.iter().map(mass).sum::<f64>() - 6.0).abs() < 1e-15);
    // A quaternion without length does not turn; the place counts.
    let key = "<keyframe><key qpos='1 2 3 0 0 0 0 0.3 0.2'/></keyframe>";
    let guess = chain(&SourceFile::new("a", robot("", key, &[]).expect("a robot").spec)).guess;
    assert_eq!(guess, [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.3, 0.2]);
    let global = robot("coordinate='global'", "", &[]).expect_err("not local");
    assert_eq!(global.mistakes()[0].code, "U016");
}
