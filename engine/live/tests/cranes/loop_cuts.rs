//! One mechanism, cut at one pin of its loop or at another: everything else in it is the same crane, with the same results.
//!
//! On a truck with a slewing column, crank, coupler and rocker form a four-bar. In one description the chain ends with the rocker, whose pin on the
//! column closes the loop; in the other with the crank. The bars are then described from their other end, and the angles of both inner joints
//! change their sign. What closes the loop in one description is a joint of the chain in the other, which transmits the same.

use std::fmt::Write;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{Method, Sample, Settings};
use crane_model::nalgebra::Vector3;
use crane_model::results::Table;
use crane_model::runs::{self, Start};
use crane_model::{Cut as Place, StateAt, force_states, modes, results, statics};

/// Lengths of crank, coupler and rocker, and places of both pins on the column, m.
const BARS: [(&str, f64); 3] = [("crank", 1.2), ("coupler", 2.0), ("rocker", 1.5)];
const PINS: [[f64; 2]; 2] = [[0.1, 1.6], [2.6, 1.2]];
/// Directions of the bars near the guess.
const ANGLES: [f64; 3] = [1.35, -0.05, -1.4];

/// Where the loop is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cut {
    AtRocker,
    AtCrank,
}

use Cut::{AtCrank, AtRocker};

impl Cut {
    /// A point of a bar, in its frame.
    fn at(self, bar: &str, [x, y]: [f64; 2]) -> String {
        let length = BARS.iter().find(|(name, _)| *name == bar).expect("a bar").1;
        match self {
            AtRocker => format!("{{link: {bar}, at: [{x}, {y}, 0]}}"),
            AtCrank => format!("{{link: {bar}, at: [{}, {}, 0]}}", length - x, -y),
        }
    }

    /// The coordinates between crank and coupler, and between coupler and rocker.
    fn inner(self) -> [&'static str; 2] {
        match self {
            AtRocker => ["coupler_psi", "rocker_psi"],
            AtCrank => ["crank_psi", "coupler_psi"],
        }
    }

    /// The joint of the chain on the column.
    fn pin_of_chain(self) -> &'static str {
        if self == AtRocker { "crank_psi" } else { "rocker_psi" }
    }

    /// The sign of these coordinates.
    fn sign(self) -> f64 {
        if self == AtRocker { 1.0 } else { -1.0 }
    }
}

/// What the mechanism has besides bars and pins.
#[derive(Clone, Copy)]
struct Features {
    /// Of a rigid truck on feet, or held by the world.
    feet: bool,
    /// A beam in place of the coupler.
    beam: bool,
    joint: &'static str,
    more: fn(Cut) -> String,
}

/// One-sided feet of the truck.
fn feet() -> String {
    let corners = [("fl", [1.4, 1.6]), ("fr", [1.4, -1.6]), ("rl", [-2.5, 1.2]), ("rr", [-2.5, -1.2])];
    let foot = |(name, [x, y]): (&str, [f64; 2])| {
        format!(
            "- {{name: {name}, one_sided: true, at: [{x}, {y}, 0], stiffness: [3e6, 3e6, 6e6], damping: [4e4, 4e4, 6e4]}}\n"
        )
    };
    format!("supports:\n{}", corners.map(foot).concat())
}

/// Truck, column and bars, in the order of the chain.
fn links(cut: Cut, features: Features) -> String {
    let mut links = if features.feet {
        String::from(
            "- {name: truck, joint: free, mass: 5000, com: [-0.5, 0.1, 0.8], inertia: {Ixx: 3e3, Iyy: 9e3, Izz: 1e4}}\n",
        )
    } else {
        String::new()
    };
    links += "- {name: column, placement: {transform: {translation: [0, 0, 0.9]}}, joint: revolute, mass: 300, com: [0.02, 0.05, 0.7], inertia: {Ixx: 60, Iyy: 60, Izz: 20}}\n";
    let order = if cut == AtRocker { [0, 1, 2] } else { [2, 1, 0] };
    let mut length_before = None;
    for index in order {
        let (name, length) = BARS[index];
        let placement = match length_before {
            None => {
                let [x, z] = PINS[usize::from(cut == AtCrank)];
                format!("rotation: {{x: 90 deg}}, translation: [{x}, 0, {z}]")
            }
            Some(length) => format!("translation: [{length}, 0, 0]"),
        };
        let body = if features.beam && name == "coupler" {
            format!(
                "beam: {{length: {length}, sections: 3, material: steel, section: {{box: {{height: 0.12, width: 0.1, thickness: 0.005}}}}, damping: {{beta: 2e-3}}}}"
            )
        } else {
            let mass = 60.0 * length;
            let com = if cut == AtRocker { [0.4 * length, 0.05] } else { [0.6 * length, -0.05] };
            format!(
                "mass: {mass}, com: [{}, {}, 0], inertia: {{about: com, Ixx: 1.5, Iyy: {i}, Izz: {i}}}",
                com[0],
                com[1],
                i = mass * length * length / 12.0
            )
        };
        let placement = if features.beam && length_before == Some(2.0) {
            String::new()
        } else {
            format!("placement: {{transform: {{{placement}}}}}, ")
        };
        writeln!(links, "- {{name: {name}, {placement}joint: revolute, {body}}}").expect("text");
        length_before = Some(length);
    }
    links
}

fn text(cut: Cut, features: Features) -> String {
    let (last, pin) = if cut == AtRocker { ("rocker", PINS[1]) } else { ("crank", PINS[0]) };
    let end = BARS.iter().find(|(name, _)| *name == last).expect("a bar").1;
    let joint = features.joint;
    let first = if cut == AtRocker { ["crank_psi", "rocker_psi"] } else { ["rocker_psi", "crank_psi"] };
    let guess = if cut == AtRocker {
        [ANGLES[0], ANGLES[1] - ANGLES[0], ANGLES[2] - ANGLES[1]]
    } else {
        [ANGLES[2] + std::f64::consts::PI, ANGLES[1] - ANGLES[2], ANGLES[0] - ANGLES[1]]
    };
    let more = (features.more)(cut);
    let mut guess: Vec<(&str, f64)> = [first[0], "coupler_psi", first[1]].into_iter().zip(guess).collect();
    // A rigid drive prescribes its own.
    guess.retain(|(name, _)| !more.contains(&format!("{name}, rigid")));
    let guess: Vec<String> = guess.iter().map(|(name, angle)| format!("{name}: {angle}")).collect();
    let feet = if features.feet { feet() } else { String::new() };
    format!(
        "format: 1\nname: cut\nanalyses: [statics, dynamics, modes, internal_forces]\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}\n\
         links:\n{}\
         loop_joints: [{{name: hinge, from: {{link: column, at: [{}, 0, {}]}}, to: {{link: {last}, at: [{end}, 0, 0]}}, joint: {joint}}}]\n\
         {feet}points: [{{name: middle, {}}}]\n\
         guess: {{{}}}\nrun: {{duration: 3, output: 0.05}}\n{}",
        links(cut, features),
        pin[0],
        pin[1],
        cut.at("coupler", [1.3, 0.2]).trim_matches(['{', '}']),
        guess.join(", "),
        more
    )
}

fn crane(cut: Cut, features: Features) -> LiveCrane {
    let text = text(cut, features);
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text.as_str()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

const PIN: &str = "{pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}";
const SLEWING: &str =
    "- {coordinate: column_psi, stiffness: 2e6, damping: 3e4, motion: {quintic: {from: 0, to: 40 deg, duration: 2}}}\n";
/// Angles between crank and coupler, and between coupler and rocker.
const INNER: [f64; 2] = [ANGLES[1] - ANGLES[0], ANGLES[2] - ANGLES[1]];

/// A servo valve at the cylinder between crank and coupler; `commanded`, with its opening over time.
fn with_valve(cut: Cut, commanded: bool) -> String {
    let [one, _] = cut.inner();
    let [from, to] = [INNER[0], INNER[0] + 0.35].map(|angle| cut.sign() * angle);
    let (foot, head) = (cut.at("crank", [0.3, -0.15]), cut.at("coupler", [0.4, -0.15]));
    let (motion, valve, inputs) = if commanded {
        (format!("{{hold: {from}}}"), "opening: {input: lever}", "inputs: {lever: {value: 0.15}}\n")
    } else {
        (format!("{{quintic: {{from: {from}, to: {to}, duration: 2}}}}"), "gain: 15", "")
    };
    format!(
        "{inputs}drives:\n{SLEWING}- {{coordinate: {one}, stiffness: 2e7, motion: {motion}}}\n\
         cylinders:\n- {{name: ram, coordinate: {one}, foot: {foot}, head: {head}, bore: 0.09, rod: 0.05, retracted: 0.5, stroke: 0.9,\n\
         \u{20}  back_pressure: 3e5, max_pressure: 3e7, bulk_modulus: 1.2e9, hose_volumes: [8e-4, 8e-4],\n\
         \u{20}  valve: {{flow: 1e-3, pressure_drop: 1e6, lag: 0.03, {valve}}}}}\n\
         pump: {{max_flow: 2e-3, pressure: 2.5e7}}\n"
    )
}

fn valve(cut: Cut) -> String {
    with_valve(cut, false)
}

/// A spring and a rope with a winch, friction with bristles, an end stop that is met, a coupling of both inner joints, a load that turns with the
/// coupler.
fn forces(cut: Cut) -> String {
    let ([one, other], sign) = (cut.inner(), cut.sign());
    let (low, high) = if cut == AtRocker { ("min", INNER[1] + 0.1) } else { ("max", -INNER[1] - 0.1) };
    format!(
        "connectors:\n- {{name: strut, from: {}, to: {}, law: {{spring: {{stiffness: 2e4, length: 1.2, damping: 300}}}}}}\n\
         - {{name: hoist, from: {{link: column, at: [0.2, 0, 4.5]}}, to: {}, law: {{rope: {{stiffness: 1e5, damping: 0.02, motion: {{quintic: {{from: 2.3, to: 2, duration: 2}}}}}}}}}}\n\
         friction: {{{other}: {{coulomb: 60, breakaway: 90, viscous: 20, bristle: {{stiffness: 2e5, damping: 300}}}}}}\n\
         stops: {{{other}: {{{low}: {high}, stiffness: 1e5, damping: 0.1}}}}\n\
         couplings: [{{name: gear, coordinate: {other}, follows: {one}, ratio: 0.9, offset: {}, stiffness: 3e3, damping: 20}}]\n\
         loads: [{{name: pull, link: coupler, at: {}, force: [0, {}, 40], moment: [0, 0, 70], axes: link, scale: {{cubic: {{from: 0.5, to: 1, duration: 1}}}}}}]\n",
        cut.at("crank", [0.7, -0.1]),
        cut.at("rocker", [0.5, 0.1]),
        cut.at("coupler", [0.8, 0.15]),
        sign * (INNER[1] - 0.9 * INNER[0] + 0.1),
        if cut == AtRocker { "[0.8, 0.1, 0]" } else { "[1.2, -0.1, 0]" },
        sign * 300.0,
    )
}

fn slewing_and_forces(cut: Cut) -> String {
    format!("drives:\n{SLEWING}{}", forces(cut))
}

/// Friction and damping of both pins on the column: of one in its loop joint, of the other in its joint of the chain.
const RUBBING: &str = "{pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}, damping: 15, friction: {coulomb: 60, breakaway: 90, stribeck: 0.05, width: 2e-3, viscous: 20}";

fn rubbing(cut: Cut) -> String {
    let ([one, _], sign) = (cut.inner(), cut.sign());
    let [from, to] = [INNER[0], INNER[0] + 0.35].map(|angle| sign * angle);
    let (_, keys) = RUBBING.split_once("damping: 15, friction: ").expect("keys");
    let pin = cut.pin_of_chain();
    format!(
        "drives:\n{SLEWING}- {{coordinate: {one}, stiffness: 2e6, damping: 2e4, motion: {{quintic: {{from: {from}, to: {to}, duration: 2}}}}}}\n\
         damping: {{{pin}: 15}}\nfriction: {{{pin}: {keys}}}\n\
         connectors: [{{name: strut, from: {}, to: {}, law: {{spring: {{stiffness: 2e4, length: 1.2, damping: 300}}}}}}]\n",
        cut.at("crank", [0.7, -0.1]),
        cut.at("rocker", [0.5, 0.1]),
    )
}

fn valve_and_forces(cut: Cut) -> String {
    valve(cut) + &forces(cut)
}

fn command_and_forces(cut: Cut) -> String {
    with_valve(cut, true) + &forces(cut)
}

/// Both joints that can move are prescribed.
fn rigid(cut: Cut) -> String {
    let [one, _] = cut.inner();
    let [from, to] = [INNER[0], INNER[0] + 0.35].map(|angle| cut.sign() * angle);
    format!(
        "drives:\n- {{coordinate: column_psi, rigid: true, motion: {{quintic: {{from: 0, to: 40 deg, duration: 2}}}}}}\n\
         - {{coordinate: {one}, rigid: true, motion: {{quintic: {{from: {from}, to: {to}, duration: 2}}}}}}\n{}",
        forces(cut)
    )
}

/// A cylinder with a drive that is a spring, without a valve.
fn cylinder(cut: Cut) -> String {
    let text = valve(cut);
    let (before, _) =
        text.split_once(", back_pressure").or_else(|| text.split_once(",\n   back_pressure")).expect("a key");
    format!("{before}}}\n{}", forces(cut))
}

fn settings(crane: &dyn DynCrane, method: Method) -> Settings {
    Settings { method, tolerance: 1e-8, step: 2e-4, audit: true, ..Settings::from_description(crane.description()) }
}

fn run(crane: &LiveCrane, method: Method) -> Table {
    let start = Start::new(crane).unwrap_or_else(|failed| panic!("{failed:?}"));
    let recorded = runs::record(crane, &start, &settings(crane, method), &mut |_| ControlFlow::Continue(()));
    recorded.unwrap_or_else(|failed| panic!("{failed:?}")).table
}

/// The name of a column in the description that is cut at the crank, and its sign; `None` if it is about a pin of the column.
fn at_crank(name: &str) -> Option<(String, f64)> {
    for (here, there) in [("coupler_psi", "crank_psi"), ("rocker_psi", "coupler_psi"), ("gear_", "gear_")] {
        if let Some(rest) = name.strip_prefix(here) {
            return Some((format!("{there}{rest}"), -1.0));
        }
    }
    let own = ["crank", "coupler_", "hinge", "energy_balance"].iter().any(|own| name.starts_with(own));
    (!own).then(|| (name.to_owned(), 1.0))
}

/// Asserts that all columns of runs of both descriptions agree, except those about the pins of the column and the sections of the beam.
fn assert_equal_runs(label: &str, [one, other]: [&Table; 2], accuracy: f64) {
    let mut compared = 0;
    for column in &one.columns {
        let Some((name, sign)) = at_crank(&column.name) else { continue };
        let a: Vec<f64> = one.values(&column.name).expect("a column").collect();
        let b: Vec<f64> = other.values(&name).unwrap_or_else(|| panic!("{label}: {name}")).collect();
        let size = a.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let off = a.iter().zip(&b).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f64::max);
        assert!(off <= accuracy * size + 1e-8, "{label}, {name}: {off:.1e} of {size:.1e}");
        compared += 1;
    }
    assert!(compared > 20, "{compared} columns");
}

fn greatest(table: &Table, name: &str) -> f64 {
    table.values(name).expect("a column").fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// What the first bar exerts on the column, in the axes of the column, at a motion.
fn on_column(crane: &dyn DynCrane, state: &StateAt<'_>, a: &[f64]) -> Vector3<f64> {
    let description = crane.description();
    let column = description.bodies.iter().position(|body| body.name == "column").expect("a column");
    let is_pin = |cut: &Place| matches!(cut, Place::Joint { body } if *body == column + 1);
    let pin = description.cuts().iter().position(is_pin).expect("a cut");
    let force = crane.internal_forces_of(state, a)[pin].force;
    let slewing = description.coordinates.iter().position(|info| info.name == "column_psi").expect("a joint");
    let (sin, cos) = state.q[slewing + 1].sin_cos();
    Vector3::new(cos * force.x - sin * force.y, -force.z, sin * force.x + cos * force.y)
}

/// The same at the end of a run.
fn on_column_at_end(crane: &dyn DynCrane, method: Method) -> Vector3<f64> {
    let start = Start::new(crane).expect("it rests");
    let mut force = Vector3::zeros();
    let mut observe = |sample: &Sample<'_>| {
        let (a, _) = force_states::accelerations(crane, sample);
        force = on_column(crane, sample, &a);
        ControlFlow::Continue(())
    };
    crane.simulate(&start.state, &settings(crane, method), &mut observe).unwrap_or_else(|stopped| panic!("{stopped}"));
    force
}

const CASES: [(&str, Features); 7] = [
    ("a valve", Features { feet: false, beam: false, joint: PIN, more: valve }),
    ("forces", Features { feet: false, beam: false, joint: "ball", more: slewing_and_forces }),
    ("a cylinder without a valve", Features { feet: false, beam: false, joint: "ball", more: cylinder }),
    ("rigid drives", Features { feet: false, beam: false, joint: PIN, more: rigid }),
    ("a valve on feet", Features { feet: true, beam: false, joint: PIN, more: valve_and_forces }),
    ("an open valve and a beam on feet", Features { feet: true, beam: true, joint: PIN, more: command_and_forces }),
    ("friction in pins", Features { feet: false, beam: false, joint: RUBBING, more: rubbing }),
];

#[test]
fn runs_do_not_depend_on_where_the_loop_is_cut() {
    for (label, features) in CASES {
        let cranes = [AtRocker, AtCrank].map(|cut| crane(cut, features));
        let tables = cranes.each_ref().map(|crane| run(crane, Method::Bdf));
        // Both runs have errors of 1e-8 per step. Where a pin nearly sticks, differences scatter from 3e-5 to 1e-5 among tolerances from 1e-8 to 1e-9.
        assert_equal_runs(label, tables.each_ref(), if label == "friction in pins" { 1e-4 } else { 2e-5 });
        let pins = cranes.each_ref().map(|crane| on_column_at_end(crane, Method::Bdf));
        for (table, pin) in tables.iter().zip([pins[1], pins[0]]) {
            let off = greatest(table, "energy_balance") / greatest(table, "drive_work");
            assert!(off < 1e-7, "{label}: {off:.1e} of the work");
            // Across the plane, a pin of a rigid loop transmits what cannot be determined.
            let [x, z] = ["hinge_force_x", "hinge_force_z"].map(|name| table.values(name).expect("a column").last());
            let off = Vector3::new(pin.x - x.expect("a row"), 0.0, pin.z - z.expect("a row")).norm();
            assert!(off < 1e-5 * pin.norm(), "{label}: {pin} for {x:?}, {z:?}");
        }
    }
}

#[test]
fn rest_and_vibrations_do_not_depend_on_where_the_loop_is_cut() {
    for (label, features) in CASES {
        let [one, other] = [AtRocker, AtCrank].map(|cut| {
            let crane = crane(cut, features);
            let crane: &dyn DynCrane = &crane;
            let rest = crane.equilibrium(&statics::Settings::default());
            assert!(rest.is_stable(), "{label}: {rest}");
            let modes = modes::undamped(&crane.small_motions_at(&rest.q)).expect("modes");
            let omegas: Vec<f64> = modes.iter().map(|mode| mode.omega_squared).collect();
            (crane.points_at(&rest.q)[0], omegas)
        });
        // Rounding of stiff springs, and differences that give the curvature of cylinders.
        assert!((one.0 - other.0).norm() < 1e-11, "{label}: {} {}", one.0, other.0);
        assert_eq!(one.1.len(), other.1.len());
        for (one, other) in one.1.iter().zip(&other.1) {
            assert!((one / other - 1.0).abs() < 1e-8, "{label}: {one} {other}");
        }
    }
}

#[test]
fn every_method_starts_at_rest_and_agrees() {
    let features = Features { feet: true, beam: false, joint: "ball", more: valve_and_forces };
    let one = crane(AtRocker, features);
    let exact = run(&one, Method::Bdf);
    for method in [Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        let other = crane(AtCrank, features);
        assert_equal_runs(&method.to_string(), [&exact, &run(&other, method)], 1e-4);
    }
    // The oil holds the crane at rest: it begins as smoothly as the motion of its drive, which has 1 % of its greatest rate after 0.05 s.
    let speed = greatest(&exact, "ram_speed");
    let begin = exact.values("ram_speed").expect("a column").nth(1).expect("a row");
    assert!(begin.abs() < 2e-2 * speed, "{begin} {speed}");
}

/// Of a pin that is a loop joint in one description and a joint of the chain in the other: its angle from the guess, rate and torque, which has the
/// opposite sign, because joints of the chain turn about −y.
#[test]
fn friction_of_a_loop_joint_is_that_of_a_joint_of_the_chain() {
    let features = Features { feet: false, beam: false, joint: RUBBING, more: rubbing };
    let cranes = [AtRocker, AtCrank].map(|cut| crane(cut, features));
    for method in [Method::Bdf, Method::Rosenbrock] {
        let tables = cranes.each_ref().map(|crane| run(crane, method));
        for (of_loop, of_chain, cut) in [(&tables[0], &tables[1], AtCrank), (&tables[1], &tables[0], AtRocker)] {
            let pin = cut.pin_of_chain();
            for (own, other) in [
                ("hinge_angle", pin.to_owned()),
                ("hinge_angle_rate", format!("{pin}_rate")),
                ("hinge_friction_torque", format!("{pin}_friction_torque")),
            ] {
                let a: Vec<f64> = of_loop.values(own).expect("a column").collect();
                let mut b: Vec<f64> = of_chain.values(&other).expect("a column").collect();
                if own == "hinge_friction_torque" {
                    // That of the joint is without its damping.
                    let rate = format!("{pin}_rate");
                    let rates = of_chain.values(&rate).expect("a column");
                    b.iter_mut().zip(rates).for_each(|(torque, rate)| *torque = -*torque + 15.0 * rate);
                }
                // The guess is 1e-2 rad beside the loop.
                let offset = if own == "hinge_angle" { a[0] + b[0] } else { 0.0 };
                let size = a.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                let off = a.iter().zip(&b).map(|(a, b)| (a + b - offset).abs()).fold(0.0, f64::max);
                // Both runs have errors of 1e-8 per step; friction rises by 90 N m within 2e-3 rad/s.
                assert!(size > 0.01 && off <= 1e-4 * size, "{method}, {own}: {off:.1e} of {size:.1e}");
            }
        }
        let lost = greatest(&tables[0], "dissipated_energy");
        assert!(lost > 20.0, "{lost} J");
    }
}

/// A joint without a drive transmits no moment about its axis except its friction: what is beyond the cut includes the friction of the loop joint.
#[test]
fn internal_forces_include_the_friction_of_loop_joints() {
    let features = Features { feet: false, beam: false, joint: RUBBING, more: rubbing };
    let crane = crane(AtRocker, features);
    let crane: &dyn DynCrane = &crane;
    let start = Start::new(crane).expect("it rests");
    let joints = |name: &str| {
        let body = crane.description().bodies.iter().position(|body| body.name == name).expect("a body");
        let is_joint = |cut: &Place| matches!(cut, Place::Joint { body: of } if *of == body);
        crane.description().cuts().iter().position(is_joint).expect("a cut")
    };
    let rocker = joints("rocker");
    let friction = results::quantities(crane.description(), crane.loop_joints());
    let friction = friction.iter().position(|column| column.name == "hinge_friction_torque").expect("a column");
    let mut greatest = [0.0_f64; 2];
    let mut observe = |sample: &Sample<'_>| {
        let (a, _) = force_states::accelerations(crane, sample);
        let moment = crane.internal_forces_of(sample, &a)[rocker].moment.z;
        let torque = results::quantities_at(crane, sample)[friction];
        greatest = [greatest[0].max(moment.abs()), greatest[1].max(torque.abs())];
        ControlFlow::Continue(())
    };
    crane
        .simulate(&start.state, &settings(crane, Method::Bdf), &mut observe)
        .unwrap_or_else(|stopped| panic!("{stopped}"));
    // Forces of some kN, and reactions that follow from accelerations.
    assert!(greatest[1] > 60.0 && greatest[0] < 1e-6, "{greatest:?} N m");
}
