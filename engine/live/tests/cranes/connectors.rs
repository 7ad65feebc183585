//! Springs, gas springs and ropes between two points against exact laws.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Run, Sample, Settings};
use crane_model::results::{Recording, cautions};
use crane_model::{Cut, statics};

const GRAVITY: f64 = 9.81;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A body of 50 kg that moves up and down, hung from a point 4 m above the world's origin.
fn hung(law: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: hung\nlinks: [{{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: 50, com: [0, 0, 0]}}]\n\
         connectors: [{{name: hoist, from: {{at: [0, 0, 4]}}, to: {{link: slide, at: [0, 0, 0.5]}}, law: {law}}}]\n"
    ))
}

/// A body of 50 kg that moves in the x-z plane, hung from the world's origin: a connector across two joints.
fn swinging(law: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: swinging\nlinks:\n- {{name: aside, joint: {{prismatic: {{axis: x}}}}}}\n\
         - {{name: load, joint: {{prismatic: {{axis: z}}}}, mass: 50, com: [0, 0, 0]}}\n\
         connectors: [{{name: hoist, from: {{at: [0, 0, 0]}}, to: {{link: load, at: [0, 0, 0]}}, law: {law}}}]\n\
         guess: {{load_z: -2}}\n"
    ))
}

fn rest(crane: &dyn DynCrane) -> Vec<f64> {
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    equilibrium.q
}

fn run_watched(
    crane: &dyn DynCrane,
    settings: &Settings,
    start: &InitialState,
    see: &mut dyn FnMut(&Sample<'_>),
) -> Run {
    let run = crane.simulate(start, settings, &mut |sample: &Sample<'_>| {
        see(sample);
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{stopped}"))
}

/// `k (ℓ − ℓ₀) = m g` and ω² = k/m.
#[test]
fn a_hung_weight_stretches_its_spring() {
    let (mass, stiffness) = (50.0, 2e4);
    for law in ["{spring: {stiffness: 2e4, damping: 60, length: 2}}", "{rope: {stiffness: 2e4, length: 2}}"] {
        let crane = hung(law);
        let crane: &dyn DynCrane = &crane;
        let q = rest(crane);
        let droop = mass * GRAVITY / stiffness;
        assert!((q[0] - (4.0 - 0.5 - 2.0 - droop)).abs() < 1e-10, "{law}: {}", q[0]);
        assert!((crane.connector_tensions_at(0.0, &q, &[0.0])[0].force - mass * GRAVITY).abs() < 1e-7);
        let small = crane.small_motions_at(&q);
        assert!((small.stiffness[(0, 0)] / small.mass[(0, 0)] - stiffness / mass).abs() < 1e-9, "{law}");
        let damping = if law.contains("damping") { 60.0 } else { 0.0 };
        assert!((small.damping[(0, 0)] - damping).abs() < 1e-12);
    }
}

/// A flap that rotates about the origin, held by a spring from below the hinge: `F a b cos θ/ℓ = m g r cos θ` is linear in ℓ.
#[test]
fn a_gas_spring_carries_a_weight() {
    let [(mass, reach), (arm, below)] = [(20.0, 1.2), (1.0, 0.5)];
    let (push, extended, stiffness) = (300.0, 1.3, 400.0);
    let flap = crane(&format!(
        "format: 1\nname: flap\nlinks: [{{name: flap, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: {mass}, com: [{reach}, 0, 0]}}]\n\
         connectors: [{{name: strut, from: {{at: [0, 0, -{below}]}}, to: {{link: flap, at: [{arm}, 0, 0]}}, law: {{gas_spring: {{force: {push}, length: {extended}, stiffness: {stiffness}}}}}}}]\n"
    ));
    let flap: &dyn DynCrane = &flap;
    let q = rest(flap);
    let (moment, lever) = (mass * GRAVITY * reach, arm * below);
    let length = lever * (push + stiffness * extended) / (moment + stiffness * lever);
    let angle = ((length * length - arm * arm - below * below) / (2.0 * lever)).asin();
    assert!((q[0] - angle).abs() < 1e-10, "{} instead of {angle}", q[0]);
    let force = flap.connector_tensions_at(0.0, &q, &[0.0])[0].force;
    assert!((force + moment * length / lever).abs() < 1e-8 * moment, "it pushes: {force} N");
}

/// `f · δq = −F δℓ` with the length from trigonometry; the joint before both points gets no force.
#[test]
fn a_spring_between_two_links_does_virtual_work() {
    let arm = |name: &str, x: f64| {
        format!(
            "- {{name: {name}, placement: {{transform: {{translation: [{x}, 0, 0]}}}}, joint: revolute, mass: 10, com: [0.5, 0, 0], inertia: {{gyration: [0.1, 0.3, 0.3]}}}}\n"
        )
    };
    let arms = crane(&format!(
        "format: 1\nname: arms\nlinks:\n{}{}{}\
         connectors: [{{name: tie, from: {{link: one, at: [0.3, 0.2, 0]}}, to: {{link: three, at: [0.6, -0.1, 0]}}, law: {{spring: {{stiffness: 700, damping: 40, length: 0.9}}}}}}]\n",
        arm("one", 0.0),
        arm("two", 1.0),
        arm("three", 0.8)
    ));
    let arms: &dyn DynCrane = &arms;
    let (q, v) = ([0.3, 0.7, -0.4], [0.5, -0.8, 1.1]);
    // In the frame of the first arm.
    let length = |[_, second, third]: [f64; 3]| {
        let (sin, cos) = (second + third).sin_cos();
        let x = 1.0 + 0.8 * second.cos() + 0.6 * cos + 0.1 * sin;
        let y = 0.8 * second.sin() + 0.6 * sin - 0.1 * cos;
        (x - 0.3).hypot(y - 0.2)
    };
    // Rounding error of a length divided by the step, and the third derivative times the step squared.
    let (step, tolerance) = (1e-5, 1e-9);
    let slope = |j: usize| {
        let moved = |by: f64| length(std::array::from_fn(|i| q[i] + if i == j { by } else { 0.0 }));
        (moved(step) - moved(-step)) / (2.0 * step)
    };
    let slopes = [0, 1, 2].map(slope);
    let rate: f64 = slopes.iter().zip(v).map(|(slope, v)| slope * v).sum();
    let force = 700.0 * (length(q) - 0.9) + 40.0 * rate;
    let [value, found_rate] = arms.connector_lengths_at(&q, &v)[0];
    assert!((value - length(q)).abs() < 1e-14 && (found_rate - rate).abs() < tolerance);
    let mut forces = [f64::NAN; 3];
    arms.connector_forces(0.0, &q, &v, &mut forces);
    for (value, slope) in forces.iter().zip(slopes) {
        assert!((value + force * slope).abs() < tolerance * force.abs(), "{value} instead of {}", -force * slope);
    }
    assert_eq!(forces[0], 0.0);
}

/// A weight on a rope swings as a pendulum of the rope's stretched length: ω² = g/ℓ.
#[test]
fn a_load_on_a_rope_is_a_pendulum() {
    let crane = swinging("{rope: {stiffness: 1e5, length: 2}}");
    let crane: &dyn DynCrane = &crane;
    let q = rest(crane);
    let length = 2.0 + 50.0 * GRAVITY / 1e5;
    assert!((q[1] + length).abs() < 1e-10 && q[0].abs() < 1e-10, "{q:?}");
    let small = crane.small_motions_at(&q);
    assert!((small.stiffness[(0, 0)] / small.mass[(0, 0)] - GRAVITY / length).abs() < 1e-9);
    assert!(small.stiffness[(0, 1)].abs() < 1e-6);
}

/// At a later time a pendulum hangs from its winch by the rope length at that time: with the length at t = 0 the rope would be slack.
#[test]
fn a_pendulum_hangs_from_its_winch_at_any_time() {
    let crane = swinging("{rope: {stiffness: 1e5, motion: {quintic: {from: 2, to: 1.2, duration: 3}}}}");
    let crane: &dyn DynCrane = &crane;
    let start = rest(crane);
    let later = statics::Problem::new(crane).at_time(3.0).from(&start).solve();
    assert!(later.is_stable(), "{later}");
    let length = 1.2 + 50.0 * GRAVITY / 1e5;
    assert!((later.q[1] + length).abs() < 1e-10 && later.q[0].abs() < 1e-10, "{:?}", later.q);
}

/// A weight that falls into its rope: free until it is taut, down to where `k x²/2 = m g (h + x)`, and up to where it came from.
#[test]
fn a_falling_weight_is_caught_by_its_rope() {
    let (fall, stiffness, mass) = (0.4_f64, 2e4, 50.0);
    let crane = hung("{rope: {stiffness: 2e4, length: 2}}");
    let crane: &dyn DynCrane = &crane;
    let taut = 4.0 - 0.5 - 2.0;
    let start = InitialState { q: vec![taut + fall], v: vec![0.0], ..InitialState::default() };
    assert_eq!(cautions::of_pose(crane, &start.q, cautions::BEND), ["rope hoist is slack"]);
    // Down, up again, and half of the second fall.
    let duration = 2.6 * (2.0 * fall / GRAVITY).sqrt();
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince] {
        let of_spec = Settings::from_description(crane.description());
        let settings = Settings { method, tolerance: 1e-7, duration, output: 1e-3, audit: true, ..of_spec };
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut recording = Recording::new(crane);
        run_watched(crane, &settings, &start, &mut |sample| {
            recording.push(sample);
            lowest = lowest.min(sample.q[0]);
            if sample.t > 0.5 * duration {
                highest = highest.max(sample.q[0]);
            }
        });
        let weight = mass * GRAVITY;
        let stretch = (weight + (weight * weight + 2.0 * stiffness * weight * fall).sqrt()) / stiffness;
        // Results every millisecond miss the lowest point by a t²/2, with an acceleration a of some 16 g.
        assert!((lowest - (taut - stretch)).abs() < 3e-5, "{method}: {lowest}");
        assert!((highest - (taut + fall)).abs() < 1e-4, "{method}: {highest}");
        let table = recording.into_table();
        let balance =
            table.values("energy_balance").expect("it is audited").fold(0.0, |size: f64, x| size.max(x.abs()));
        assert!(balance < 1e-3 * weight * fall, "{method}: {balance:.1e} J");
        let least = table.values("hoist_force").expect("a column").fold(f64::INFINITY, f64::min);
        assert_eq!(least, 0.0, "{method}: it never pushes");
    }
}

/// A winch that hoists a weight does the work m g h, whatever the rope stores on the way.
#[test]
fn a_winch_does_the_work_of_the_weight() {
    let crane =
        hung("{rope: {stiffness: 2e4, damping: 5, motion: {quintic: {from: 2, to: 0.8, begin: 0.5, duration: 3}}}}");
    let crane: &dyn DynCrane = &crane;
    let start = InitialState { q: rest(crane), v: vec![0.0], ..InitialState::default() };
    let of_spec = Settings::from_description(crane.description());
    let settings = Settings { tolerance: 1e-7, duration: 10.0, output: 0.1, audit: true, ..of_spec };
    let mut end = (0.0, 0.0);
    run_watched(crane, &settings, &start, &mut |sample| end = (sample.q[0], sample.work));
    assert!((end.0 - start.q[0] - 1.2).abs() < 1e-6, "{}", end.0);
    let work = 50.0 * GRAVITY * 1.2;
    // The rope's damper dissipates the vibration that the winch's acceleration excites.
    assert!((end.1 / work - 1.0).abs() < 2e-3, "{} J instead of {work} J", end.1);
    let later = statics::Problem::new(crane).at_time(10.0).from(&start.q).solve();
    assert!((later.q[0] - start.q[0] - 1.2).abs() < 1e-9, "{later}");
}

/// A boom on a pin, held by a rope: the pin carries only the boom's thrust, because the rope runs past it.
#[test]
fn a_rope_goes_past_the_joint() {
    let (reach, height, mass) = (3.0, 2.0, 80.0);
    let boom = crane(&format!(
        "format: 1\nname: boom\nlinks: [{{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: {mass}, com: [{reach}, 0, 0]}}]\n\
         connectors: [{{name: guy, from: {{at: [0, 0, {height}]}}, to: {{link: boom, at: [{reach}, 0, 0]}}, law: {{rope: {{stiffness: 1e6, length: 3.6}}}}}}]\n"
    ));
    let boom: &dyn DynCrane = &boom;
    let q = rest(boom);
    let still = [0.0];
    let (x, z) = (reach * q[0].cos(), reach * q[0].sin());
    // In the triangle of pin, anchor and tip: tension m g ℓ/h, thrust m g r/h along the boom.
    let length = x.hypot(height - z);
    let tension = mass * GRAVITY * length / height;
    assert!((boom.connector_tensions_at(0.0, &q, &still)[0].force / tension - 1.0).abs() < 1e-9);
    let thrust = mass * GRAVITY * reach / height;
    for (cut, wrench) in boom.description().cuts().into_iter().zip(boom.internal_forces_at(0.0, &q, &still, &still)) {
        let force =
            if cut == Cut::Ground { [-thrust * q[0].cos(), 0.0, -thrust * q[0].sin()] } else { [-thrust, 0.0, 0.0] };
        for (value, expected) in wrench.force.iter().zip(force) {
            assert!((value - expected).abs() < 1e-8 * thrust, "{cut:?}: {value} instead of {expected}");
        }
        assert!(wrench.moment.amax() < 1e-7 * thrust, "{cut:?}: {:?}", wrench.moment);
    }
}

/// A spring along a slide is equivalent to the spring of a drive: the same steps, and the same motion to rounding.
#[test]
fn a_spring_along_a_slide_steps_like_that_of_a_drive() {
    let slide = |spring: &str| {
        crane(&format!(
            "format: 1\nname: slide\nlinks: [{{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: 50, com: [0, 0, 0]}}]\n{spring}\n"
        ))
    };
    let between = "connectors: [{name: tie, from: {at: [0, 0, 0]}, to: {link: slide, at: [0, 0, 2]}, law: {spring: {stiffness: 2e6, damping: 900, length: 2}}}]";
    let driven = "drives: [{coordinate: slide_z, stiffness: 2e6, damping: 900, motion: {hold: 0}}]";
    let start = InitialState { q: vec![0.1], v: vec![0.0], ..InitialState::default() };
    for method in [Method::Bdf, Method::Rosenbrock] {
        let [one, other] = [between, driven].map(|spring| {
            let slide = slide(spring);
            let slide: &dyn DynCrane = &slide;
            let of_spec = Settings::from_description(slide.description());
            let settings = Settings { method, tolerance: 1e-6, duration: 0.5, output: 0.5, ..of_spec };
            let mut end = f64::NAN;
            let run = run_watched(slide, &settings, &start, &mut |sample| end = sample.q[0]);
            (end, run.statistics.steps)
        });
        assert_eq!(one.1, other.1, "{method}: steps");
        assert!((one.0 - other.0).abs() < 1e-12, "{method}: {} and {}", one.0, other.0);
    }
}

/// Three arms in a row with a stiff spring across all joints: `bdf` takes it into account and needs far fewer steps than an explicit
/// method, which must follow its vibration.
#[test]
fn implicit_steps_know_springs_across_several_joints() {
    let arms = crane(
        "format: 1\nname: arms\nlinks:\n\
         - {name: one, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 30, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}\n\
         - {name: two, placement: {transform: {translation: [1, 0, 0]}}, joint: revolute, mass: 20, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}\n\
         - {name: three, placement: {transform: {translation: [1, 0, 0]}}, joint: revolute, mass: 10, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}\n\
         drives:\n- {coordinate: one_psi, stiffness: 3e3, damping: 300, motion: {cubic: {from: 0.2, to: 0.9, duration: 1}}}\n\
         - {coordinate: two_psi, stiffness: 1e3, damping: 60, motion: {hold: 0.5}}\n\
         - {coordinate: three_psi, stiffness: 500, damping: 30, motion: {hold: 0.4}}\n\
         connectors: [{name: tie, from: {at: [0, 0, 1]}, to: {link: three, at: [0.8, 0, 0]}, law: {spring: {stiffness: 1e8, damping: 1e5, length: 2.2}}}]\n",
    );
    let arms: &dyn DynCrane = &arms;
    let start = InitialState { q: rest(arms), v: vec![0.0; 3], ..InitialState::default() };
    let of_spec = Settings::from_description(arms.description());
    let [(q, steps), (exact, most)] = [Method::Bdf, Method::DormandPrince].map(|method| {
        let settings = Settings { method, tolerance: 1e-5, duration: 0.6, output: 0.6, ..of_spec };
        let mut q = Vec::new();
        let run = run_watched(arms, &settings, &start, &mut |sample| q = sample.q.to_vec());
        (q, run.statistics.steps)
    });
    let off = q.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4, "off by {off:.1e}");
    assert!(5 * steps < most, "{steps} steps, {most} of dopri5");
}

/// The second stage of a telescope follows the first. The chain carries the second stage's weight, and the drive lifts both: by
/// virtual work with `δy = δx`, it carries the second stage's weight twice.
#[test]
fn a_second_stage_follows_the_first() {
    let [first, second] = [30.0, 20.0];
    let telescope = crane(&format!(
        "format: 1\nname: telescope\nlinks:\n- {{name: one, joint: {{prismatic: {{axis: z}}}}, mass: {first}, com: [0, 0, 0]}}\n\
         - {{name: two, joint: {{prismatic: {{axis: z}}}}, mass: {second}, com: [0, 0, 0]}}\n\
         drives: [{{coordinate: one_z, stiffness: 1e7, damping: 1e4, motion: {{quintic: {{from: 0.2, to: 1.4, duration: 2}}}}}}]\n\
         couplings: [{{name: chain, coordinate: two_z, follows: one_z, ratio: 1, offset: 0.3, stiffness: 4e6, damping: 2e4}}]\n"
    ));
    let telescope: &dyn DynCrane = &telescope;
    let q = rest(telescope);
    let (slip, effort) = (-second * GRAVITY / 4e6, (first + 2.0 * second) * GRAVITY);
    assert!((q[1] - q[0] - 0.3 - slip).abs() < 1e-11, "{q:?}");
    assert!((telescope.drive_efforts_at_rest(&q)[0] / effort - 1.0).abs() < 1e-9);
    // At the end of the motion both stages have moved equally far.
    let start = InitialState { q: q.clone(), v: vec![0.0; 2], ..InitialState::default() };
    let of_spec = Settings::from_description(telescope.description());
    let settings = Settings { tolerance: 1e-6, duration: 6.0, output: 1.0, audit: true, ..of_spec };
    let (mut end, mut recording) = (Vec::new(), Recording::new(telescope));
    run_watched(telescope, &settings, &start, &mut |sample| {
        recording.push(sample);
        end = sample.q.to_vec();
    });
    assert!((end[0] - q[0] - 1.2).abs() < 1e-5 && (end[1] - q[1] - 1.2).abs() < 1e-5, "{end:?}");
    let table = recording.into_table();
    let last = |name: &str| table.values(name).and_then(Iterator::last).expect("a column");
    assert!((last("chain_force") + second * GRAVITY).abs() < 1e-2 && (last("chain_slip") - 0.3 - slip).abs() < 1e-8);
    // The work of the drive is the potential energy gained by both.
    let work = (first + 2.0 * second) * GRAVITY * 1.2;
    assert!((last("drive_work") / work - 1.0).abs() < 1e-3, "{} J instead of {work} J", last("drive_work"));
}
