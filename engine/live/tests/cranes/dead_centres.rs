//! Distances from dead centres, against angles between directions worked out by hand, and what runs say of them.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{Method, Settings};
use crane_model::loop_joints::{Caution, Watch};
use crane_model::results::cautions::of_run;
use crane_model::runs::{Start, record};

fn live(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("bars.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// A four-bar in a vertical plane, of bars of these lengths of which the last is the ground; turned with its gravity about y by an angle, and
/// closed at the end of the rocker by a joint in the world.
fn four_bar([crank, coupler, rocker, ground]: [f64; 4], turn: f64, joint: &str, more: &str) -> LiveCrane {
    let (sin, cos) = turn.sin_cos();
    let bar = |name: &str, placement: &str, length: f64| {
        format!(
            "- {{name: {name}, placement: {{transform: {{{placement}}}}}, joint: revolute, mass: 1, com: [{}, 0.05, 0], \
             inertia: {{Ixx: 0.01, Iyy: 0.2, Izz: 0.2}}}}\n",
            0.5 * length
        )
    };
    live(&format!(
        "format: 1\nname: bars\ngravity: [{}, 0, {}]\nlinks:\n{}{}{}loop_joints:\n\
         - {{name: pin, from: {{at: [{}, 0, {}]}}, to: {{link: rocker, at: [{rocker}, 0, 0]}}, joint: {joint}}}\n{more}\n",
        -9.81 * sin,
        -9.81 * cos,
        bar("crank", &format!("rotation: [{{y: {turn}}}, {{x: {FRAC_PI_2}}}]"), 0.0),
        bar("coupler", &format!("translation: [{crank}, 0, 0]"), coupler),
        bar("rocker", &format!("translation: [{coupler}, 0, 0]"), rocker),
        ground * cos,
        -ground * sin,
    ))
}

/// A guess from which the loop is open by 0.2 m, of a crane for which statics is not asked; and one that a drive holds at rest.
#[test]
fn an_exported_crane_starts_on_its_loops() {
    let guess = "analyses: [dynamics]\nguess: {crank_psi: 60 deg, coupler_psi: -25 deg, rocker_psi: -110 deg}";
    let crane = four_bar([0.4, 1.1, 0.9, 1.2], 0.0, "ball", guess);
    let start = Start::of_or_guess(&crane);
    assert_eq!(start.what, "guess, moved onto the loops, at rest");
    // From the end of the third bar to the pin in the ground.
    let gap = |q: &[f64]| {
        let angles = [q[0], q[0] + q[1], q[0] + q[1] + q[2]];
        let end =
            |of: fn(f64) -> f64| [0.4, 1.1, 0.9].iter().zip(angles).map(|(bar, angle)| bar * of(angle)).sum::<f64>();
        f64::hypot(end(f64::cos) - 1.2, end(f64::sin))
    };
    let open = gap(&crane.chain().guess);
    assert!((0.15..0.2).contains(&open), "{open}");
    assert!(gap(&start.q) < 1e-12, "{}", gap(&start.q));
    // At rest where statics finds it.
    let held = "guess: {coupler_psi: -25 deg, rocker_psi: -110 deg}\ndrives: [{coordinate: crank_psi, stiffness: 4e3, damping: 60, motion: {hold: 1.1}}]";
    let start = Start::of_or_guess(&four_bar([0.4, 1.1, 0.9, 1.2], 0.0, "ball", held));
    assert_eq!((start.what.as_str(), start.rests), ("static equilibrium, at rest", true));
    // The bars do not reach the ground's other end.
    let far = Start::of_or_guess(&four_bar([0.4, 0.1, 0.1, 1.2], 0.0, "ball", "analyses: [dynamics]"));
    assert_eq!(far.what, "guess, whose loops are open, at rest");
}

const SLIDE: &str = "{slide: {axis: [0, 1, 0]}}";

fn cautions(crane: &LiveCrane, q: &[f64]) -> Vec<Caution> {
    Watch::new(crane as &dyn DynCrane).cautions(q)
}

/// 2 asin(σ/√2) of unit vectors in a plane, by the angles of their directions: `σ² = ½ (n − |Σ exp(2 i φ)|)`.
fn distance(directions: &[f64]) -> f64 {
    let (sin, cos) =
        directions.iter().fold((0.0, 0.0), |(s, c), angle| (s + (2.0 * angle).sin(), c + (2.0 * angle).cos()));
    let least = 0.5 * (directions.len() as f64 - f64::hypot(sin, cos));
    2.0 * (0.5 * least.max(0.0)).sqrt().asin()
}

/// The bars of a parallelogram 1° before they are in line: the crank moves the pin upwards, the rocker across itself, and the coupler across the
/// way from its own pin.
#[test]
fn the_distance_does_not_depend_on_how_the_crane_lies() {
    let theta = 1_f64.to_radians();
    let expected = distance(&[0.0, (0.3 * theta.sin()).atan2(1.0 - 0.3 * theta.cos()), -theta]);
    assert!((expected.to_degrees() - 1.466).abs() < 1e-3);
    let pin = "{pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}";
    for turn in [0.0, 0.2, 30_f64.to_radians(), FRAC_PI_2] {
        for joint in [SLIDE, pin, "ball"] {
            let crane = four_bar([0.3, 1.0, 0.3, 1.0], turn, joint, "");
            let found = cautions(&crane, &[theta, -theta, theta - PI]);
            let Some(Caution::DeadCentre { joint, angle }) = found.first() else { panic!("{turn} {joint}: {found:?}") };
            // Differences give lengths of columns to 1e-10, and an eigenvalue its root to 1e-8.
            assert!(joint == "pin" && (angle - expected).abs() < 1e-7, "{turn}: {angle} against {expected}");
            assert!(
                cautions(&crane, &[3.0 * theta, -3.0 * theta, 3.0 * theta - PI])
                    .iter()
                    .all(|own| own.angle().is_none())
            );
            // In line, the reason is the dead centre, and not that other joints hold the same.
            let found = cautions(&crane, &[0.0, 0.0, -PI]);
            assert!(found.len() == 1 && found[0].angle().is_some_and(|angle| angle < 1e-6), "{turn}: {found:?}");
        }
    }
}

/// A rhombus folds up: near the line the pin of the coupler passes through that of the loop, and hardly moves it. With its lever over a tenth
/// of the largest one, the rows have σ² = λ of [[a² + s², −s], [−s, 2]].
#[test]
fn a_joint_that_passes_through_the_pin_counts_for_less() {
    let theta = 0.1_f64.to_radians();
    let (lever, s) = (2.0 * (0.5 * theta).sin() / 0.1, theta.sin());
    let least = lever * lever + 0.5 * s * s;
    for turn in [0.0, 0.5] {
        let found = cautions(&four_bar([1.0; 4], turn, SLIDE, ""), &[theta, -theta, theta - PI]);
        let Some(Caution::DeadCentre { angle, .. }) = found.first() else { panic!("{found:?}") };
        // To the first order in the lever.
        assert!((angle - least.sqrt() * 2_f64.sqrt()).abs() < 1e-3 * angle, "{angle}");
    }
}

/// Angles of coupler and rocker on crank and coupler with the crank at θ; crank 0.8 m, coupler and rocker 0.5 m, ground 1 m.
fn toggle(theta: f64) -> [f64; 3] {
    let way = [1.0 - 0.8 * theta.cos(), -0.8 * theta.sin()];
    let at_crank = f64::acos(way[0].hypot(way[1]));
    let coupler = way[1].atan2(way[0]) + at_crank;
    [theta, coupler - theta, -2.0 * at_crank]
}

const DRIVEN: &str = "drives: [{coordinate: crank_psi, rigid: true, motion: {quintic: {from: 30 deg, to: 100 deg, duration: 2}}}]\n\
                      guess: {coupler_psi: 10 deg, rocker_psi: -100 deg}\nrun: {duration: 3, output: 0.02}";

/// A crank drives coupler and rocker, nearly in line. Seen from the pin between them, whether the coupler is a link or a rod without mass,
/// the directions are those of both bars; seen from the pin on the ground, those of the ways to both ends of the coupler, half as far apart.
#[test]
fn a_rod_counts_as_the_link_that_it_stands_for() {
    let q = toggle(66.42_f64.to_radians());
    let between = -q[2];
    assert!((between.to_degrees() - 0.78).abs() < 5e-3);
    let on_ground = |coupler: &str, from: &str, joint: &str| {
        let guess = if coupler.is_empty() { "rocker_psi: 100 deg" } else { "coupler_psi: 10 deg, rocker_psi: 100 deg" };
        live(&format!(
            "format: 1\nname: bars\nlinks:\n- {{name: ground, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}}}\n\
             - {{name: crank, joint: revolute, mass: 1, com: [0.4, 0, 0], inertia: {{Ixx: 0.001, Iyy: 0.06, Izz: 0.06}}}}\n{coupler}\
             - {{name: rocker, on: {{link: ground, at: [1, 0, 0]}}, joint: revolute, mass: 1, com: [0.25, 0, 0], inertia: {{Ixx: 0.001, Iyy: 0.02, Izz: 0.02}}}}\n\
             loop_joints: [{{name: pin, from: {{{from}}}, to: {{link: rocker, at: [0.5, 0, 0]}}, joint: {joint}}}]\n{}",
            DRIVEN.replace("coupler_psi: 10 deg, rocker_psi: -100 deg", guess)
        ))
    };
    let rod = on_ground("", "link: crank, at: [0.8, 0, 0]", "{rod: {length: 0.5}}");
    let link = on_ground(
        "- {name: coupler, placement: {transform: {translation: [0.8, 0, 0]}}, joint: revolute, mass: 1, com: [0.25, 0, 0], inertia: {Ixx: 0.001, Iyy: 0.02, Izz: 0.02}}\n",
        "link: coupler, at: [0.5, 0, 0]",
        "{slide: {axis: [0, 0, 1]}}",
    );
    let chain = four_bar([0.8, 0.5, 0.5, 1.0], 0.0, SLIDE, DRIVEN);
    let rocker = q[0] + q[1] + q[2] - PI;
    let poses = [vec![q[0], rocker], vec![q[0], q[1], rocker], q.to_vec()];
    for ((crane, pose), expected) in [rod, link, chain].iter().zip(&poses).zip([between, between, 0.5 * between]) {
        let found = cautions(crane, pose);
        let [Caution::DeadCentreOfDrives { angle, .. }] = found.as_slice() else { panic!("{found:?}") };
        assert!((angle - expected).abs() < 1e-7, "{angle} against {expected}");
    }
}

fn run(crane: &LiveCrane, output: f64) -> Result<Vec<String>, String> {
    let crane: &dyn DynCrane = crane;
    let settings =
        Settings { method: Method::Bdf, output, audit: false, ..Settings::from_description(crane.description()) };
    let start = Start::new(crane).map_err(|failed| failed.to_string())?;
    let recorded = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()));
    recorded.map(|recorded| of_run(crane, &recorded.table, 20.0)).map_err(|failed| failed.to_string())
}

/// A driven parallelogram turns through both lines, at (π − 1)/2 s and (2π − 1)/2 s.
#[test]
fn a_run_through_a_line_says_when() {
    let crane = four_bar(
        [0.3, 1.0, 0.3, 1.0],
        0.0,
        SLIDE,
        "drives: [{coordinate: crank_psi, rigid: true, motion: {speed: {rate: 2, from: 1, begin: 0}}}]\n\
         guess: {coupler_psi: -1, rocker_psi: -2.14159}\nrun: {duration: 3, output: 0.02}",
    );
    let found = run(&crane, 0.02).expect("it runs");
    assert!(
        found.len() == 1
            && found[0].contains("from a dead centre: its forces are large")
            && found[0].ends_with("(nearest at 1.080 s and 2.640 s)"),
        "{found:?}"
    );
}

/// The crank stretches coupler and rocker at cos θ = 0.4: the quintic 30° + 70° s³ (10 − 15 s + 6 s²), s = t/2 s, is there at 1.0217 s.
#[test]
fn a_drive_beyond_the_reach_of_its_loop_is_named() {
    let wanted = (0.4_f64.acos().to_degrees() - 30.0) / 70.0;
    let share = |s: f64| s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if share(middle) < wanted { low = middle } else { high = middle }
    }
    let text = run(&four_bar([0.8, 0.5, 0.5, 1.0], 0.0, SLIDE, DRIVEN), 0.02).expect_err("no pose lies beyond");
    assert!((2.0 * low - 1.0217).abs() < 1e-4, "{low}");
    let words = text.strip_prefix("bars: at t = ").and_then(|rest| rest.split_once(" s the rigid drive of crank_psi"));
    let (time, what) = words.unwrap_or_else(|| panic!("{text}"));
    let time: f64 = time.parse().unwrap();
    // A step ends where its loop cannot be closed: near the end, steps are as short as they can be.
    assert!((time - 2.0 * low).abs() < 1e-4 && what == " moves its loop beyond its reach", "{text}");
}
