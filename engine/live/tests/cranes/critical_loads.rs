//! The load that lifts the first foot and the load that tips the crane, against bisection on statics alone.

use std::f64::consts::PI;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::envelope::{Critical, CriticalLoad, NoCriticalLoad, critical_load};
use crane_model::results::cautions;
use crane_model::statics::{Problem, RestSearch, Settings};
use crane_model::tipping::{governing, lines};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("truck.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Feet: name, x and y, m.
type Feet = &'static [(&'static str, f64, f64)];

const FOUR: Feet =
    &[("front_left", 2.1, 1.9), ("front_right", 1.7, -2.2), ("rear_left", -2.3, 1.6), ("rear_right", -1.9, -1.8)];
/// The first of three feet that lifts is the last: the crane tips.
const THREE: Feet = &[("left", 2.1, 2.4), ("right", 1.7, -2.6), ("rear", -3.3, 0.3)];

/// A truck of 8 t on feet, each at another place, which press and do not pull; a boom that slews and carries a load on a joint of its own.
fn truck(feet: Feet, stiffness: f64, slew: f64, drive: &str) -> LiveCrane {
    let foot = |(name, x, y): &(&str, f64, f64)| {
        format!(
            "  - {{name: {name}, one_sided: true, at: [{x}, {y}, 0], stiffness: [{stiffness:e}, {stiffness:e}, {stiffness:e}], \
             damping: [1e4, 1e4, 1e4]}}\n"
        )
    };
    crane(&format!(
        "format: 1\nname: truck\nparameters: {{load: {{value: 500, unit: kg}}}}\nlinks:\n\
         - {{name: truck, joint: free, mass: 8000, com: [-0.2, 0.1, 0.8], inertia: {{Ixx: 6e3, Iyy: 1.8e4, Izz: 2e4}}}}\n\
         - {{name: column, placement: {{transform: {{translation: [0.1, 0, 1.2]}}}}, joint: revolute, mass: 400, \
         com: [0, 0, 0.9], inertia: {{Ixx: 120, Iyy: 120, Izz: 25}}}}\n\
         - {{name: boom, placement: {{transform: {{translation: [0, 0, 1.8], rotation: {{x: 90 deg}}}}}}, joint: revolute, \
         mass: 500, com: [3.2, 0, 0], inertia: {{Ixx: 10, Iyy: 1700, Izz: 1700}}}}\n\
         - {{name: load, placement: {{transform: {{translation: [6.0, 0, 0]}}}}, joint: revolute, mass: load, com: [0, -2, 0]}}\n\
         supports:\n{}drives:\n\
         - {{coordinate: column_psi, {drive}, motion: {{hold: {slew} deg}}}}\n\
         - {{coordinate: boom_psi, {drive}, motion: {{hold: 20 deg}}}}\n\
         guess: {{load_psi: -20 deg}}\n",
        feet.iter().map(foot).collect::<String>()
    ))
}

/// The vertical forces of the feet with a load, as statics finds them; `None` where the crane does not rest.
fn forces(crane: &mut dyn DynCrane, load: f64) -> Option<Vec<f64>> {
    crane.set_parameter(0, load).unwrap();
    let equilibrium = crane.equilibrium(&Settings::default());
    let rest = vec![0.0; equilibrium.q.len()];
    equilibrium
        .is_stable()
        .then(|| crane.support_reactions_at(&equilibrium.q, &rest).iter().map(|force| force.z).collect())
}

/// Where a property of loads changes, by bisection.
fn border(mut holds: f64, mut fails: f64, mut property: impl FnMut(f64) -> bool) -> f64 {
    assert!(property(holds) && !property(fails), "{holds} to {fails}");
    while fails - holds > 1e-8 * fails {
        let middle = 0.5 * (holds + fails);
        *if property(middle) { &mut holds } else { &mut fails } = middle;
    }
    holds
}

const SPRING: &str = "stiffness: 2e7, damping: 1e5";
const RIGID: &str = "rigid: true";

/// Stiff feet lift by nanometres: a search that mixes their gaps with forces of kilonewtons stops anywhere.
#[test]
fn the_first_foot_lifts_where_statics_says() {
    for (feet, drive) in [(FOUR, RIGID), (FOUR, SPRING), (THREE, RIGID), (THREE, SPRING)] {
        for slew in [37.0, 200.0] {
            for stiffness in [1e7, 1e8, 1e10, 1e12] {
                let mut crane = truck(feet, stiffness, slew, drive);
                let crane: &mut dyn DynCrane = &mut crane;
                let presses =
                    |load: f64| forces(&mut *crane, load).is_some_and(|forces| forces.iter().all(|force| *force > 0.0));
                let truth = border(1.0, 8000.0, presses);
                let mut all = Vec::new();
                for start in [10.0, 500.0, 1500.0, 2150.0, 6000.0] {
                    crane.set_parameter(0, start).unwrap();
                    let critical_load = critical_load(crane, 0, Critical::FirstFoot).expect("a load");
                    // Statics leaves 1e-10 of the forces, about 1e-5 N of a foot that changes by 5 N for each kg.
                    assert!(
                        (critical_load.load / truth - 1.0).abs() < 1e-6,
                        "feet of {stiffness:e} N/m, slewed by {slew}°, from {start} kg: {} instead of {truth}",
                        critical_load.load
                    );
                    all.push(critical_load);
                }
                assert!(all.iter().all(|found| *found == all[0]), "{all:?}");
                // The foot that lifts is the one that carries least just before.
                let before = forces(crane, truth * (1.0 - 1e-5)).expect("it rests");
                let least = (0..feet.len()).min_by(|a, b| before[*a].total_cmp(&before[*b])).expect("feet");
                assert_eq!(all[0].location, crane.description().supports[least].name.as_str());
            }
        }
    }
}

/// Whether the crane stands while its load grows from one with which it does to another one: it rests after each step, not beyond its tipping
/// margin. From the guess, statics misses some poses just below the limit.
fn stands(crane: &mut dyn DynCrane, from: f64, load: f64) -> bool {
    crane.set_parameter(0, from).unwrap();
    let mut equilibrium = crane.equilibrium(&Settings::default());
    assert!(equilibrium.is_stable(), "{from}: {equilibrium}");
    let start = equilibrium.q.clone();
    let rest = vec![0.0; start.len()];
    // Steps that become shorter towards the end, where the pose changes fastest.
    for step in 1..=24 {
        let part = if step == 24 { 1.0 } else { 1.0 - 0.5f64.powi(step) };
        crane.set_parameter(0, from + part * (load - from)).unwrap();
        let next = Problem::new(&*crane).from(&equilibrium.q).solve();
        let margin =
            governing(&lines(crane, 0.0, &next.q, &rest, &rest)).map_or(1.0, crane_model::tipping::TippingLine::margin);
        if !next.is_stable() || crane.description().has_tipped(&start, &next.q) || margin < 0.0 {
            return false;
        }
        equilibrium = next;
    }
    true
}

/// Statics tips over, finds nothing or something unstable beyond the limit: each of these is beyond it.
#[test]
fn the_load_that_tips_is_never_left_out() {
    for (feet, drive) in [(FOUR, RIGID), (FOUR, SPRING), (THREE, RIGID), (THREE, SPRING)] {
        for slew in [37.0, 90.0, 200.0, 300.0] {
            for stiffness in [1e7, 1e8, 1e9, 1e11] {
                let mut crane = truck(feet, stiffness, slew, drive);
                let crane: &mut dyn DynCrane = &mut crane;
                let mut all = Vec::new();
                for start in [10.0, 2000.0, 4000.0, 12_000.0] {
                    crane.set_parameter(0, start).unwrap();
                    all.push(critical_load(crane, 0, Critical::Tipping));
                }
                assert!(all.iter().all(|found| *found == all[0]), "{all:?}");
                let CriticalLoad { load, location: line, .. } = all.remove(0).expect("a load");
                for (share, expected) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
                    let found = stands(crane, 0.9 * load, share * load);
                    assert_eq!(found, expected, "{drive}, {stiffness:e} N/m, {slew}°: {share} of {load}");
                }
                assert!(line.contains(" – "), "{line}");
            }
        }
    }
}

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    LiveCrane::from_spec(&build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"))).unwrap()
}

/// Over the rear, the shipped loader bears a multiple of its load.
#[test]
fn the_shipped_loader_has_critical_loads() {
    let mut crane = shipped("loader_tipping");
    let crane: &mut dyn DynCrane = &mut crane;
    let mut all = Vec::new();
    for start in [2200.0, 2800.0, 40_000.0] {
        crane.set_parameter(0, start).unwrap();
        all.push([Critical::FirstFoot, Critical::Tipping].map(|kind| critical_load(crane, 0, kind).expect("a load")));
    }
    assert!(all.iter().all(|found| *found == all[0]), "{all:?}");
    let [first, tips] = &all[0];
    // Both front feet lift where the lateral springs of the rear ones no longer hold the crane.
    assert!((first.load / tips.load - 1.0).abs() < 0.01, "{first:?}, {tips:?}");
    for (share, expected) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
        assert_eq!(stands(crane, 0.9 * tips.load, share * tips.load), expected, "{share} of {tips:?}");
    }
}

/// From the guess statics finds what it finds from the pose with a slightly smaller load, at every slewing angle and with every load up to the
/// one that tips the crane.
#[test]
fn the_shipped_loader_stands_wherever_smaller_loads_lead() {
    let mut crane = shipped("loader_tipping");
    let crane: &mut dyn DynCrane = &mut crane;
    let mut found = 0;
    for slew in 0..12 {
        let mut positions = crane.drive_targets_at(0.0);
        positions[0] = f64::from(slew) * PI / 6.0;
        let mut led: Option<Vec<f64>> = None;
        for hundreds in 1..60 {
            crane.set_parameter(0, 100.0 * f64::from(hundreds)).unwrap();
            let guess = crane.guess();
            let hold = |q: &[f64]| Problem::new(&*crane).holding(&positions).from(q).solve();
            let here = hold(led.as_deref().unwrap_or(&guess));
            if !here.is_stable() {
                break;
            }
            let from_guess = RestSearch { crane, positions: &positions }.find(None);
            assert!(from_guess.is_stable(), "slew {slew}, {hundreds}00 kg: {from_guess}");
            for (one, other) in from_guess.q.iter().zip(&here.q) {
                assert!((one - other).abs() < 1e-6, "slew {slew}, {hundreds}00 kg: {one} for {other}");
            }
            led = Some(here.q);
            found += 1;
        }
    }
    assert!(found > 500, "{found}");
}

#[test]
fn where_there_is_no_critical_load_the_reason_is_known() {
    let hanging = "format: 1\nname: hanging\nparameters: {load: {value: 500, unit: kg}}\nlinks:\n\
                   - {name: load, joint: revolute, mass: load, com: [0, -1, 0]}\n";
    let mut crane = crane(hanging);
    let none = critical_load(&mut crane, 0, Critical::Tipping);
    assert_eq!(none, Err(NoCriticalLoad::NoSupports));
    // Nothing in reach of the feet: the load presses them down.
    let inside = "format: 1\nname: inside\nparameters: {load: {value: 500, unit: kg}}\nlinks:\n\
         - {name: truck, joint: free, mass: 8000, com: [0, 0, 0.8], inertia: {Ixx: 6e3, Iyy: 1.8e4, Izz: 2e4}}\n\
         - {name: load, mass: load, com: [0, 0, 0.5], inertia: {gyration: [0.3, 0.3, 0.3]}}\n\
         supports:\n\
         - {name: one, one_sided: true, at: [2, 2, 0], stiffness: [1e7, 1e7, 1e7]}\n\
         - {name: two, one_sided: true, at: [2, -2, 0], stiffness: [1e7, 1e7, 1e7]}\n\
         - {name: three, one_sided: true, at: [-2, 0, 0], stiffness: [1e7, 1e7, 1e7]}\n";
    let mut crane = self::crane(inside);
    for critical in [Critical::FirstFoot, Critical::Tipping] {
        let none = critical_load(&mut crane, 0, critical);
        assert!(matches!(none, Err(NoCriticalLoad::Beyond { load }) if load > 8e5 - 1.0), "{none:?}");
    }
}

/// A truck on four feet that may lift, and something that holds the tip of its boom to the world.
fn held_truck(payload: f64, held: &str) -> LiveCrane {
    let foot = |(name, x, y): (&str, f64, f64)| {
        format!(
            "  - {{name: {name}, at: [{x}, {y}, 0], one_sided: true, kinematics: exact, stiffness: [3e6, 3e6, 7e6]}}\n"
        )
    };
    let feet = [("fl", 1.5, 2.2), ("fr", 1.5, -2.2), ("rl", -1.5, 2.2), ("rr", -1.5, -2.2)].map(foot).concat();
    crane(&format!(
        "format: 1\nname: held\nanalyses: [statics]\nparameters: {{payload: {{value: {payload:?}, unit: kg}}}}\nlinks:\n\
         - {{name: truck, joint: free, mass: 8000, com: [0, 0, 0.9], inertia: {{Ixx: 6500, Iyy: 36000, Izz: 38000}}}}\n\
         - {{name: boom, placement: {{transform: {{translation: [0, 0, 2.4]}}}}, mass: 200, com: [1.6, 0, 0]}}\n\
         - {{name: hook, placement: {{transform: {{translation: [3.4, 0, 0]}}}}, mass: payload, com: [0, 0, 0]}}\n\
         supports:\n{feet}{held}"
    ))
}

/// When both rear feet have lifted, the moments about the front ones balance for any load, up to rounding, and a rope that was slack before
/// may carry the crane. It has tipped. The load is that of Newton's method on the rigid truck on its four springs, written by itself.
#[test]
fn a_slack_rope_does_not_raise_the_load_that_tips() {
    for length in [6.3, 6.4, 6.6, 100.0] {
        let rope = format!(
            "connectors: [{{name: guy, from: {{at: [-3, 1, 5]}}, to: {{link: boom, at: [2.5, 0, 0]}}, law: {{rope: {{stiffness: 1e5, length: {length}}}}}}}]\n"
        );
        let mut crane = held_truck(300.0, &rope);
        let critical_load = critical_load(&mut crane, 0, Critical::Tipping).unwrap();
        assert!((critical_load.load / 6_264.869_851 - 1.0).abs() < 2e-8, "{length}: {critical_load:?}");
        assert_eq!(critical_load.location, "fr – fl");
    }
}

/// Hung on the rope with its rear feet in the air, the moments about the front feet balance for any load: the sign of the margin is rounding.
#[test]
fn a_crane_on_two_feet_and_a_rope_has_tipped() {
    let rope = "connectors: [{name: guy, from: {at: [-3, 1, 5]}, to: {link: boom, at: [2.5, 0, 0]}, law: {rope: {stiffness: 1e5, length: 6.3}}}]\n";
    for payload in [6500.0, 7000.0, 7500.0, 8000.0] {
        let crane = held_truck(payload, rope);
        let crane: &dyn DynCrane = &crane;
        let equilibrium = crane.equilibrium(&Settings::default());
        assert!(equilibrium.is_stable(), "{payload}: {equilibrium}");
        let rest = vec![0.0; equilibrium.q.len()];
        let forces =
            crane.support_reactions_at(&equilibrium.q, &rest).iter().map(|force| force.z > 0.0).collect::<Vec<_>>();
        assert_eq!(forces, [true, true, false, false], "{payload}");
        let lines = lines(crane, 0.0, &equilibrium.q, &rest, &rest);
        let line = governing(&lines).unwrap();
        assert!(line.has_tipped && line.margin() <= 0.0, "{payload}: {line:?}");
        let words = cautions::of_pose(crane, &equilibrium.q, cautions::BEND).join("\n");
        assert!(words.contains("tips over the line fr – fl: no other foot carries anything"), "{payload}: {words}");
    }
}

/// A counterweight of 3 t, 1 m behind the rear feet, a truck of 2 t above the middle between them and the front feet, 2 m apart, and a load 4 m before the
/// middle: with less than (3 − 2) t · 1 m/5 m it tips backwards, with more than (3 · 3 + 2) t m/3 m forwards.
#[test]
fn a_counterweight_asks_for_a_load() {
    let text = "format: 1\nname: counterweight\nparameters: {load: {value: 500, unit: kg}}\nlinks:\n\
        - {name: truck, joint: free, mass: 2000, com: [0, 0, 0.8], inertia: {gyration: [1, 1, 1]}}\n\
        - {name: column, placement: {transform: {translation: [0, 0, 1]}}, mass: 3000, com: [-2, 0, 0], inertia: {gyration: [0.4, 0.4, 0.4]}}\n\
        - {name: load, on: truck, placement: {transform: {translation: [4, 0, 1]}}, joint: revolute, mass: load, com: [0, 0, 0], inertia: {gyration: [0.1, 0.1, 0.1]}}\n\
        supports:\n\
        - {name: front_left, one_sided: true, at: [1, 1, 0], stiffness: [1e9, 1e9, 1e9]}\n\
        - {name: front_right, one_sided: true, at: [1, -1, 0], stiffness: [1e9, 1e9, 1e9]}\n\
        - {name: rear_left, one_sided: true, at: [-1, 1, 0], stiffness: [1e9, 1e9, 1e9]}\n\
        - {name: rear_right, one_sided: true, at: [-1, -1, 0], stiffness: [1e9, 1e9, 1e9]}\n\
        drives: [{coordinate: load_psi, stiffness: 1e6, motion: {hold: 0}}]\n";
    let mut crane = crane(text);
    for critical in [Critical::Tipping, Critical::FirstFoot] {
        let CriticalLoad { load, at_least, .. } = critical_load(&mut crane, 0, critical).expect("a load");
        let least = at_least.expect("a least load");
        // Feet of 1e9 N/m give way by 5e-5 m at levers of 1 m; the search ends at 1e-6 of the first load that holds.
        assert!((least / 200.0 - 1.0).abs() < 1e-3, "{critical:?}: at least {least} kg");
        assert!((load / (11_000.0 / 3.0) - 1.0).abs() < 1e-3, "{critical:?}: at most {load} kg");
    }
    let mut truck = truck(FOUR, 1e7, 30.0, "stiffness: 1e7");
    assert_eq!(critical_load(&mut truck, 0, Critical::Tipping).expect("a load").at_least, None);
}
