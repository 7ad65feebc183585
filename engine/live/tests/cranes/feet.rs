//! Feet that press and never pull, against exact laws.

use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::runs::{Failed, Reason, Start, record};
use crane_model::statics::{Diagnosis, Settings as Statics, Status};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("feet.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Mass of the truck, kg.
const TRUCK: f64 = 8000.0;
/// Half of its track, m.
const TRACK: f64 = 1.5;
/// Where the load is, m from the truck's middle.
const RADIUS: f64 = 7.5;

/// A rigid truck on four corner feet, and a load at a radius to one side; the height of its mass centre matters only to
/// second order.
fn truck(kinematics: &str, stiffness: f64, more: &str) -> LiveCrane {
    let foot = |name: &str, x: f64, y: f64| {
        format!(
            "  - {{name: {name}, at: [{x}, {y}, 0], stiffness: [{stiffness:e}, {stiffness:e}, {stiffness:e}], \
             damping: [1e4, 1e4, 1e4], kinematics: {kinematics}{more}}}\n"
        )
    };
    let feet = [
        ("near_front", TRACK, 2.0),
        ("near_rear", TRACK, -2.0),
        ("far_rear", -TRACK, -2.0),
        ("far_front", -TRACK, 2.0),
    ];
    crane(&format!(
        "format: 1\nname: truck\nparameters: {{load: {{value: 100, unit: kg}}}}\nlinks:\n\
         - {{name: truck, joint: free, mass: {TRUCK}, com: [0, 0, 0.8], inertia: {{Ixx: 6e3, Iyy: 1.8e4, Izz: 2e4}}}}\n\
         - {{name: load, mass: load, com: [{RADIUS}, 0, 0.8], inertia: {{gyration: [0.3, 0.3, 0.3]}}}}\n\
         supports:\n{}",
        feet.map(|(name, x, y)| foot(name, x, y)).concat()
    ))
}

/// From moment equilibrium about the near feet, `m (R − a) = M a`.
const TIPPING: f64 = TRUCK * TRACK / (RADIUS - TRACK);

#[test]
fn the_far_feet_reach_nothing_at_the_load_of_the_moment_equilibrium() {
    for kinematics in ["linear", "exact"] {
        let mut truck = truck(kinematics, 1e13, ", one_sided: true");
        let crane: &mut dyn DynCrane = &mut truck;
        for (share, stands) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
            crane.set_parameter(0, share * TIPPING).unwrap();
            let equilibrium = crane.equilibrium(&Statics::default());
            if stands {
                assert!(equilibrium.is_stable(), "{kinematics}: {equilibrium}");
                let far = crane.support_reactions_at(&equilibrium.q, &[0.0; 6])[2].z;
                // Each far foot carries half of the remaining moment.
                let expected = (1.0 - share) * TIPPING * 9.81 * (RADIUS - TRACK) / (2.0 * TRACK) / 2.0;
                assert!((far / expected - 1.0).abs() < 0.1 && far > 0.0, "{kinematics}: {far} N for {expected}");
            } else {
                let feet = vec!["near_rear".into(), "near_front".into()];
                assert_eq!(equilibrium.status, Status::TipsOver { feet }, "{kinematics}: {equilibrium}");
            }
        }
    }
}

/// A firmly pressed foot is equivalent to one that can also pull: forces, energies and stiffness are the same.
#[test]
fn pressed_feet_are_anchored_feet() {
    for kinematics in ["linear", "exact"] {
        let [one, two] = ["", ", one_sided: true"].map(|more| truck(kinematics, 1e7, more));
        let [one, two]: [&dyn DynCrane; 2] = [&one, &two];
        let found = [one, two].map(|crane| crane.equilibrium(&Statics::default()));
        for (a, b) in found[0].q.iter().zip(&found[1].q) {
            assert!((a - b).abs() < 1e-15, "{kinematics}: {a} {b}");
        }
        let q = &found[0].q;
        let v = [0.01, -0.02, 0.001, 1e-3, 2e-3, -1e-3];
        for (a, b) in one.support_reactions_at(q, &v).iter().zip(two.support_reactions_at(q, &v)) {
            assert!((a - b).amax() < 1e-12 * a.amax(), "{kinematics}: {a} {b}");
        }
        let [a, b] = [one, two].map(|crane| crane.small_motions_at(q));
        assert!((&a.stiffness - &b.stiffness).amax() < 1e-12 * a.stiffness.amax());
        assert!((&a.damping - &b.damping).amax() < 1e-12 * a.damping.amax());
        assert!((one.support_energy(q) / two.support_energy(q) - 1.0).abs() < 1e-12);
        assert!(two.support_gaps_at(q).iter().all(|gap| *gap < 0.0));
    }
}

/// A block on two feet in a plane, b to either side, its mass centre at the height h.
fn block(b: f64, h: f64, stiffness: f64, damping: f64) -> LiveCrane {
    let foot = |name: &str, x: f64| {
        format!(
            "  - {{name: {name}, at: [{x}, 0, 0], stiffness: [{stiffness:e}, 0, {stiffness:e}], \
             damping: [{damping:e}, 0, {damping:e}], kinematics: exact, one_sided: true, sticks: true}}\n"
        )
    };
    crane(&format!(
        "format: 1\nname: block\nanalyses: [dynamics]\nlinks:\n  - {{name: block, joint: {{free: [x, z, theta]}}, mass: {BLOCK}, \
         com: [0, 0, {h}], inertia: {{Ixx: {INERTIA}, Iyy: {INERTIA}, Izz: {INERTIA}}}}}\nsupports:\n{}{}",
        foot("left", -b),
        foot("right", b)
    ))
}

/// Mass, kg, and moment of inertia, kg m², of the block.
const BLOCK: f64 = 200.0;
const INERTIA: f64 = 60.0;

/// x, z and θ of the block, rotated by θ about its right foot.
fn turned(b: f64, theta: f64) -> Vec<f64> {
    vec![b * (1.0 - theta.cos()), b * theta.sin(), theta]
}

/// A callback that receives time, pose and rates of every result.
type See<'a> = dyn FnMut(f64, &[f64], &[f64]) + 'a;

/// Runs a crane and passes on its samples; its energy balances to 0.3 % of the energy at stake.
fn run_watched(crane: &LiveCrane, start: &InitialState, settings: &Settings, at_stake: f64, see: &mut See<'_>) {
    let crane: &dyn DynCrane = crane;
    let mut begin = None;
    let run = crane.simulate(start, settings, &mut |sample: &Sample<'_>| {
        let energy = crane.energies_of(sample).total();
        let balance = energy + sample.dissipated - sample.work - *begin.get_or_insert(energy);
        // The errors of the energy integrals are not controlled.
        assert!(balance.abs() < 3e-3 * at_stake, "{:?} at {}: {balance} J of {at_stake}", settings.method, sample.t);
        see(sample.t, sample.q, sample.v);
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{:?}: {stopped}", settings.method));
}

fn settings(crane: &LiveCrane, method: Method, tolerance: f64, duration: f64, output: f64) -> Settings {
    let crane: &dyn DynCrane = crane;
    Settings {
        method,
        tolerance,
        duration,
        output,
        step: 1e-5,
        audit: true,
        ..Settings::from_description(crane.description())
    }
}

/// Released at θ₀ about one foot, a slender block lands on the other after a quarter of Housner's period, `arcosh(1/(1 − θ₀/α))/p` with
/// p² = m g R/I₀.
/// G. W. Housner, Bull. Seism. Soc. Am. 53 (1963) 403.
#[test]
fn a_slender_block_rocks_as_housner_says() {
    let (b, h) = (0.1, 1.5);
    let block = block(b, h, 1e9, 1e5);
    let (radius, alpha) = (b.hypot(h), (b / h).atan());
    let p = (BLOCK * 9.81 * radius / (INERTIA + BLOCK * radius * radius)).sqrt();
    let theta = 0.6 * alpha;
    let expected = (1.0 / (1.0 - theta / alpha)).acosh() / p;
    let start = InitialState { q: turned(b, theta), v: vec![0.0; 3], ..InitialState::default() };
    let at_stake = BLOCK * 9.81 * radius * ((alpha - theta).cos() - alpha.cos()).abs();
    let mut landed = None;
    let crane: &dyn DynCrane = &block;
    run_watched(
        &block,
        &start,
        &settings(&block, Method::Bdf, 1e-7, 1.2 * expected, 1e-4),
        at_stake,
        &mut |t, q, _| {
            if crane.support_gaps_at(q)[0] < 0.0 {
                landed.get_or_insert(t);
            }
        },
    );
    let landed = landed.expect("it lands");
    // The law is that of small angles, off by α²/6 or so, and the foot below gives way by 2 µm.
    assert!((landed / expected - 1.0).abs() < alpha * alpha / 3.0, "{landed} s for {expected} s");
}

/// A rocking block loses the energy that its dampers dissipate, at every landing and lifting. The errors of the energy integrals of
/// `rosw4` are not controlled and larger at landings, which a run then reports.
#[test]
fn energy_balances_over_lifting_and_landing() {
    let (b, h) = (0.3, 0.8);
    let block = block(b, h, 1e7, 2e4);
    let start = InitialState { q: turned(b, 0.2), v: vec![0.0; 3], ..InitialState::default() };
    let at_stake = BLOCK * 9.81 * b * 0.2;
    for (method, tolerance) in [(Method::Bdf, 1e-8), (Method::Rosenbrock, 1e-8), (Method::DormandPrince, 1e-7)] {
        let crane: &dyn DynCrane = &block;
        let mut lifted = [0; 2];
        run_watched(&block, &start, &settings(&block, method, tolerance, 2.0, 1e-3), at_stake, &mut |_, q, _| {
            for (samples, gap) in lifted.iter_mut().zip(crane.support_gaps_at(q)) {
                *samples += usize::from(gap > 1e-3);
            }
        });
        // Each foot lifts off for a while.
        assert!(lifted.iter().all(|samples| *samples > 100), "{method:?}: {lifted:?}");
    }
}

/// A mass falls through the gap below its foot, is thrown back by an undamped spring, and is back where it began after two falls and a
/// contact of `(2/ω)(π − atan(v ω/g))`.
#[test]
fn free_play_is_a_gap() {
    let (mass, stiffness, gap, gravity) = (50.0_f64, 2e6_f64, 0.02_f64, 9.81_f64);
    let jumper = crane(&format!(
        "format: 1\nname: jumper\nanalyses: [dynamics]\nlinks:\n  - {{name: jumper, joint: {{free: [z]}}, mass: {mass}, com: [0, 0, 0]}}\n\
         supports:\n  - {{name: foot, at: [0, 0, 0], stiffness: [0, 0, {stiffness}], free_play: [0, 0, -{gap}], one_sided: true}}\n"
    ));
    let (fall, omega) = ((2.0 * gap / gravity).sqrt(), (stiffness / mass).sqrt());
    let contact = 2.0 / omega * (std::f64::consts::PI - (gravity * fall * omega / gravity).atan());
    let period = 2.0 * fall + contact;
    let start = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        let mut last = 0.0;
        run_watched(
            &jumper,
            &start,
            &settings(&jumper, method, 1e-9, period, 1e-4),
            mass * gravity * gap,
            &mut |t, q, _| {
                if t < 0.99 * fall {
                    assert!((q[0] + 0.5 * gravity * t * t).abs() < 1e-7, "{method:?} at {t}: {}", q[0]);
                }
                last = q[0];
            },
        );
        assert!(last.abs() < 1e-5, "{method:?}: {last} m");
    }
}

/// A load on a long rope that hangs to the side on a slope: about the lower feet the moments at rest are `m g (2.5 cos α + 4 sin α)` against
/// `M g (1.5 cos α − 0.6 sin α)`. At the guess the load hangs beside the crane, and its moment is smaller.
#[test]
fn moments_of_a_crane_that_tips_are_those_at_rest() {
    let foot = |name: &str, x: f64, y: f64| {
        format!("- {{name: {name}, one_sided: true, at: [{x}, {y}, 0], stiffness: [2e7, 2e7, 2e7]}}\n")
    };
    let feet = [("fl", 2.0, 1.5), ("fr", 2.0, -1.5), ("rl", -2.0, 1.5), ("rr", -2.0, -1.5)];
    let live = crane(&format!(
        "format: 1\nname: slope\nslope: {{angle: 4 deg, towards: -90 deg}}\nlinks:\n\
         - {{name: truck, joint: free, mass: 4000, com: [0, 0, 0.6], inertia: {{Ixx: 2500, Iyy: 8000, Izz: 9000}}}}\n\
         - {{name: load, placement: {{transform: {{translation: [0, -4, 4]}}}}, joint: {{revolute: {{axis: x}}}}, mass: 2200, com: [0, 0, -2]}}\n\
         supports:\n{}",
        feet.map(|(name, x, y)| foot(name, x, y)).concat()
    ));
    let crane: &dyn DynCrane = &live;
    let equilibrium = crane.equilibrium(&Statics::default());
    let Diagnosis::Overturned { line, .. } = Diagnosis::new(crane, &equilibrium) else { panic!("{equilibrium}") };
    let (sin, cos) = 4.0_f64.to_radians().sin_cos();
    let expected = [2200.0 * 9.81 * (2.5 * cos + 4.0 * sin), 4000.0 * 9.81 * (1.5 * cos - 0.6 * sin)];
    for (moment, expected) in [line.overturning, line.stabilising].into_iter().zip(expected) {
        // Newton's tolerance.
        assert!((moment / expected - 1.0).abs() < 1e-9, "{line:?} for {expected:?}");
    }
}

/// At the guess a rope to the world is so tight that it would tip the truck, which yields by millimetres and stands; the rope of the load is slack
/// there, so that nothing holds it. Statics finds no pose from there, and does not say that the truck tips.
#[test]
fn a_tight_rope_to_the_world_tips_no_crane() {
    let foot = |name: &str, x: f64, y: f64| {
        format!("- {{name: {name}, one_sided: true, at: [{x}, {y}, 0], stiffness: [1e7, 1e7, 2e7]}}\n")
    };
    let feet = [("fl", 2.0, 1.5), ("fr", 2.0, -1.5), ("rl", -2.0, 1.5), ("rr", -2.0, -1.5)];
    for (guess, stands) in [(-1.0001, true), (-0.9, false)] {
        let live = crane(&format!(
            "format: 1\nname: guyed\nlinks:\n\
             - {{name: truck, joint: free, mass: 4000, com: [-0.5, 0.1, 0.6], inertia: {{Ixx: 2500, Iyy: 8000, Izz: 9000}}}}\n\
             - {{name: mast, placement: {{transform: {{translation: [0, 0, 1.2]}}}}, joint: fixed, mass: 500, com: [0.5, 0, 1.6], \
             inertia: {{Ixx: 80, Iyy: 80, Izz: 20}}}}\n\
             - {{name: load, placement: {{transform: {{translation: [3, 0, 1.6]}}}}, joint: {{prismatic: {{axis: z}}}}, mass: 0.01, com: [0, 0, 0]}}\n\
             connectors:\n\
             - {{name: guy, from: {{at: [-6, 3, 0]}}, to: {{link: mast, at: [-0.2, 0, 1.6]}}, law: {{rope: {{stiffness: 300 kN/m, length: 6.6, damping: 0.02}}}}}}\n\
             - {{name: hang, from: {{link: mast, at: [3, 0, 1.6]}}, to: {{link: load, at: [0, 0, 0]}}, law: {{rope: {{stiffness: 1e6, length: 1, damping: 0.02}}}}}}\n\
             guess: {{load_z: {guess}}}\nsupports:\n{}",
            feet.map(|(name, x, y)| foot(name, x, y)).concat()
        ));
        let equilibrium = (&live as &dyn DynCrane).equilibrium(&Statics::default());
        assert_eq!(equilibrium.is_stable(), stands, "{equilibrium}");
        assert!(!matches!(equilibrium.status, Status::TipsOver { .. }), "{equilibrium}");
    }
}

/// At twice the tipping load: about the near feet the truck holds with `M g a`, the load overturns with `m g (R − a)`, and the message says so.
#[test]
fn a_truck_that_tips_names_the_moments_and_the_links() {
    let mut truck = truck("exact", 1e7, ", one_sided: true");
    let crane: &mut dyn DynCrane = &mut truck;
    let load = 2.0 * TIPPING;
    crane.set_parameter(0, load).unwrap();
    let equilibrium = crane.equilibrium(&Statics::default());
    let Diagnosis::Overturned { feet, line, most: [Some(worst), Some(best)] } = Diagnosis::new(crane, &equilibrium)
    else {
        panic!("{equilibrium}");
    };
    assert_eq!(feet.each_ref().map(crane_model::Text::as_str), ["near_rear", "near_front"]);
    // Rounding alone: the guess is level.
    let off = |found: f64, expected: f64| (found / expected - 1.0).abs();
    let held = TRUCK * 9.81 * TRACK;
    assert!(off(line.stabilising, held) < 1e-12 && off(line.overturning, 2.0 * held) < 1e-12, "{line:?}");
    assert_eq!([worst.link.as_str(), best.link.as_str()], ["load", "truck"]);
    assert!(off(worst.weight, load * 9.81) < 1e-12 && off(-worst.moment / worst.weight, RADIUS - TRACK) < 1e-12);
    let reason = Reason::no_equilibrium(crane, &equilibrium);
    let (message, advice) =
        (Failed { crane: "truck".into(), reason: Box::new(reason.clone()) }.to_string(), reason.advice());
    assert!(message.contains("load overturns it most") && message.contains("6.00 m outside the line"), "{message}");
    assert!(advice.contains("wider stance") && !advice.contains("guess"), "{advice}");
    // Seven times the tipping load, divided by 9.81, is less than it; twenty times is not; twice is an ordinary overload.
    for (times, suspected) in [(2.0, false), (7.0, true), (20.0, false)] {
        crane.set_parameter(0, times * TIPPING).unwrap();
        let equilibrium = crane.equilibrium(&Statics::default());
        let advice = Diagnosis::new(crane, &equilibrium).advice();
        assert!(advice.contains("wider stance"), "{advice}");
        assert_eq!(advice.contains("the mass of `load` is a weight in N"), suspected, "{times}: {advice}");
    }
}

#[test]
fn gravity_upwards_and_feet_in_one_place_are_named() {
    let text = |gravity: f64, y: f64| {
        let foot = |name: &str, x: f64, y: f64| {
            format!("  - {{name: {name}, at: [{x}, {y}, 0], stiffness: [1e6, 1e6, 1e6], one_sided: true}}\n")
        };
        let feet = [foot("a", y, y), foot("b", -y, y), foot("c", 0.0, -y)].concat();
        format!(
            "format: 1\nname: block\ngravity: [0, 0, {gravity}]\nlinks:\n\
             - {{name: block, joint: free, mass: 1000, com: [0.01, 0, 0.5], inertia: {{Ixx: 100, Iyy: 100, Izz: 100}}}}\n\
             supports:\n{feet}"
        )
    };
    let floating = crane(&text(9.81, 1.0));
    let floating: &dyn DynCrane = &floating;
    let equilibrium = floating.equilibrium(&Statics::default());
    assert_eq!(equilibrium.status, Status::Floats, "{equilibrium}");
    let Diagnosis::Floats { upwards } = Diagnosis::new(floating, &equilibrium) else { panic!("{equilibrium}") };
    assert!((upwards - 9810.0).abs() < 1e-9, "{upwards}");
    let stacked = crane(&text(-9.81, 0.0));
    let stacked: &dyn DynCrane = &stacked;
    let equilibrium = stacked.equilibrium(&Statics::default());
    assert_eq!(Diagnosis::new(stacked, &equilibrium), Diagnosis::NoPolygon { one_place: true }, "{equilibrium}");
}

/// What statics ends with if a number of one foot has a wrong place or exponent.
#[test]
fn a_foot_in_the_air_and_a_spring_beyond_reason_are_named() {
    let (_, loader) = crane_specs::EXAMPLES.iter().find(|(name, _)| *name == "loader_crane").expect("an example");
    let diagnosis = |from: &str, to: &str| {
        assert!(loader.contains(from), "{from}");
        let changed = crane(&loader.replacen(from, to, 1));
        let crane: &dyn DynCrane = &changed;
        let equilibrium = crane.equilibrium(&Statics::default());
        assert!(!equilibrium.is_stable(), "{to}: {equilibrium}");
        Diagnosis::new(crane, &equilibrium)
    };
    let found = diagnosis(
        "at: [0, 2.4, 0], stiffness: [3 kN/mm, 3 kN/mm, 8 kN/mm]",
        "at: [0, 2.4, 3], stiffness: [3e6, 3e6, 1e18]",
    );
    assert_eq!(found, Diagnosis::RaisedFoot { foot: "front_left".into(), height: 3.0 });
    let found = diagnosis("stiffness: [3 kN/mm, 3 kN/mm, 8 kN/mm]", "stiffness: [3e6, 3e6, 1e18]");
    let Diagnosis::TooStiff { stiffness, .. } = &found else { panic!("{found:?}") };
    assert!(*stiffness > 1e17, "{found}");
    assert!(found.advice().contains("N/m"), "{}", found.advice());
}

/// A cylinder that is 3e11 m long: its spring turns the rounding errors of its length into a tenth of the weight. No pose is an equilibrium to six
/// digits, and the reason is said.
#[test]
fn an_equilibrium_that_rounding_hides_is_none() {
    // Where a pendulum hangs, its moment is rounding alone: the only force there is, and no reason to refuse the pose.
    let pendulum = crane(
        "format: 1\nname: pendulum\nanalyses: [statics, dynamics, modes, internal_forces]\n\
         links: [{name: rod, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 60, com: [1, 0, 0]}]\n\
         guess: {rod_psi: -90 deg}\n",
    );
    assert!((&pendulum as &dyn DynCrane).equilibrium(&Statics::default()).is_stable());
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/eight_link_hydraulic.yaml");
    let open = build::open(path.as_ref()).expect("a spec");
    for (far, hidden) in [(3e9, true), (3e11, true), (3.0, false)] {
        let changes =
            format!("name: far\ncylinders:\n  - {{name: telescope_cylinder, foot: {{at: [0, -{far:e}, 0]}}}}\n");
        let changed = LiveCrane::from_spec(&open.changed(&changes)).expect("valid");
        let crane: &dyn DynCrane = &changed;
        let equilibrium = crane.equilibrium(&Statics::default());
        assert_eq!(
            (equilibrium.status == Status::NotConverged, equilibrium.is_stable()),
            (hidden, !hidden),
            "{far:e}: {equilibrium}"
        );
        assert!(hidden || equilibrium.residual() < 1e-8);
        if hidden {
            let why = Diagnosis::new(crane, &equilibrium);
            assert!(matches!(why, Diagnosis::Rounding { residual } if residual > 1e-6), "{why:?}");
            assert!(why.to_string().contains("rounding"), "{why}");
        }
    }
}

/// A loader crane that a rope pulls sideways with 17 kN: all its meshes rest with the same force on the foot at the rear.
#[test]
fn all_meshes_of_a_crane_that_a_rope_pulls_rest_alike() {
    let text = include_str!("../specs/two_rests.yaml");
    for sections in [3, 14, 16, 18] {
        let loader = crane(&text.replace("SECTIONS", &sections.to_string()));
        let loader: &dyn DynCrane = &loader;
        let equilibrium = loader.equilibrium(&Statics::default());
        assert!(equilibrium.is_stable(), "{sections}: {equilibrium}");
        let reactions = loader.support_reactions_at(&equilibrium.q, &vec![0.0; equilibrium.q.len()]);
        // Three sections are 0.5 N from the limit.
        assert!((reactions[3].z - 9005.0).abs() < 2.0, "{sections}: {reactions:?}");
    }
}

/// A block that rocks without damping on stiff ground keeps its energy. Its feet land beside where they stood, where a law changes within
/// 1e-11 s: steps must be able to follow it.
#[test]
fn a_block_that_rocks_on_stiff_ground_keeps_its_energy() {
    let foot = |name: &str, x: f64, y: f64| {
        format!("  - {{name: {name}, at: [{x}, {y}, 0], stiffness: [1e9, 1e9, 1e9], one_sided: true}}\n")
    };
    let feet = [foot("a", 0.3, 0.3), foot("b", 0.3, -0.3), foot("c", -0.3, 0.3), foot("d", -0.3, -0.3)].concat();
    let block = crane(&format!(
        "format: 1\nname: block\nlinks:\n\
         - {{name: block, joint: free, mass: 1000, com: [0, 0, 0.5], inertia: {{Ixx: 170, Iyy: 170, Izz: 170}}}}\n\
         supports:\n{feet}\
         loads:\n  - {{name: push, link: block, at: [0, 0, 1], force: [3500, 300, 0], scale: {{table: {{\
         times: [0, 0.02, 0.1, 0.12, 0.14, 0.16, 0.2, 0.3, 0.5, 1, 9], values: [0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0], shape: spline}}}}}}\n\
         run: {{duration: 3, output: 0.05}}\n"
    ));
    for (method, tolerance) in [(Method::Bdf, 1e-7), (Method::Bdf, 1e-8), (Method::Rosenbrock, 1e-8)] {
        let settings = Settings { method, tolerance, audit: true, ..Settings::from_description(block.description()) };
        let start = Start::new(&block).expect("it stands");
        let recorded = record(&block, &start, &settings, &mut |_| ControlFlow::Continue(()));
        let table = recorded.unwrap_or_else(|failed| panic!("{method:?} {tolerance:e}: {failed:?}")).table;
        let column = |name: &str| table.values(name).expect("a column").fold(0.0_f64, |most, x| most.max(x.abs()));
        // The push does about 200 J of work.
        assert!(column("kinetic_energy") > 100.0);
        assert!(column("energy_balance") < 0.05, "{method:?} {tolerance:e}: {} J", column("energy_balance"));
    }
}
