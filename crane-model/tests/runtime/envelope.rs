//! Envelopes compared with the equilibrium of moments, and with single cranes.

use crane_model::statics::Problem;
use std::sync::Mutex;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::{
    dyn_crane::{DynCrane, Functions},
    envelope::{Axes, Axis, Envelope, Execution, Limit, Limits, Rating, Varied},
    statics::Settings,
};

fn crane(spec: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", format!("format: 1\nname: crane\n{spec}"))).expect("sound")
}

/// All ratings, in the order of the poses; every pose must be rated exactly once.
fn rate(envelope: &Envelope, crane: &dyn DynCrane, threads: usize) -> Vec<Rating> {
    let found = Mutex::new(vec![None; envelope.axes.poses()]);
    let done = |piece: usize, ratings: &[Rating]| {
        for (pose, rating) in envelope.poses_of(piece).zip(ratings) {
            assert!(found.lock().unwrap()[pose].replace(rating.clone()).is_none(), "pose {pose} is rated once");
        }
    };
    let pieces: Vec<usize> = (0..envelope.pieces()).collect();
    envelope.run(crane, &pieces, &Execution { threads, done: &done, cancelled: &|| false }).expect("allowed");
    found.into_inner().unwrap().into_iter().map(|rating| rating.expect("every pose is rated")).collect()
}

fn axis(varied: Varied, from: f64, to: f64, count: usize) -> Axis {
    let values = (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect();
    Axis { varied, values }
}

/// A truck of 4 t, its centre in the middle of four feet 3 m and 2 m apart on almost rigid ground, and a load on an arm of 5 m that slews;
/// the arm is massless.
const TRUCK: &str = "
parameters: {payload: {value: 100, unit: kg}}
links:
  - {name: truck, joint: free, mass: 4000, com: [0, 0, 0.5], inertia: {Ixx: 3000, Iyy: 3000, Izz: 3000}}
  - {name: arm, placement: {transform: {translation: [0.25, 0, 1]}}, joint: revolute, mass: payload, com: [5, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
supports:
  - {name: front_left, at: [1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: front_right, at: [1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_left, at: [-1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_right, at: [-1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
drives: [{coordinate: arm_psi, rigid: true, motion: {hold: 0}}]
points: [{name: hook, link: arm, at: [5, 0, 0]}]
";

#[test]
fn a_slewing_load_is_limited_by_the_nearest_tipping_line() {
    let truck = crane(TRUCK);
    let margin = 0.25;
    let limits = Limits { tipping: Some(margin), ..Limits::none(truck.description()) };
    let axes = Axes(vec![axis(Varied::Drive(0), 0.0, 6.0, 61)]);
    let envelope = Envelope { axes, load: 0, loads: [0.0, 1e5], limits, factor: 1.0 };
    for (pose, rating) in rate(&envelope, &truck, 1).iter().enumerate() {
        let angle = envelope.axes.values(pose)[0];
        let (x, y) = (0.25 + 5.0 * angle.cos(), 5.0 * angle.sin());
        // For each line that the load is beyond: m (distance beyond) = (1 − margin) 4000 kg (distance within).
        let lines = [(x - 1.5, 1.5), (-x - 1.5, 1.5), (y - 1.0, 1.0), (-y - 1.0, 1.0)];
        let loads = lines.iter().filter(|(beyond, _)| *beyond > 0.0);
        let expected = loads.map(|(beyond, within)| (1.0 - margin) * 4000.0 * within / beyond).fold(f64::MAX, f64::min);
        let load = rating.load.expect("the truck alone stands");
        // Feet give way by micrometres at a height of 1 m; loads are found to 1e-6.
        assert!((load / expected - 1.0).abs() < 1e-5, "at {angle}: {load} instead of {expected}");
        assert!(matches!(rating.governing, Some(Limit::Tipping { .. })));
        let left = rating.loaded.as_ref().unwrap().margin().unwrap() - margin;
        assert!((0.0..2e-6).contains(&left), "never beyond the limit: {left}");
    }
}

/// A massless boom of 4 m over the ground, lifted by a drive; its load is a point.
const BOOM: &str = "
parameters: {payload: {value: 100, unit: kg}}
links:
  - {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: payload, com: [4, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives: [DRIVE]
points: [{name: hook, link: boom, at: [4, 0, 0]}]
";

#[test]
fn an_effort_limits_by_its_lever() {
    let rigid = crane(&BOOM.replace("DRIVE", "{coordinate: boom_psi, rigid: true, motion: {hold: 0}}"));
    let mut limits = Limits::none(rigid.description());
    limits.efforts[0] = 2e4;
    let axes = Axes(vec![axis(Varied::Drive(0), -1.4, 1.4, 57)]);
    let envelope = Envelope { axes, load: 0, loads: [1.0, 1e6], limits, factor: 1.0 };
    for (pose, rating) in rate(&envelope, &rigid, 1).iter().enumerate() {
        let angle: f64 = envelope.axes.values(pose)[0];
        let expected = 2e4 / (9.81 * 4.0 * angle.cos());
        let load = rating.load.unwrap();
        assert!(load <= expected * (1.0 + 1e-12) && load > expected * (1.0 - 1.1e-6), "{angle}: {load}, {expected}");
        assert_eq!(rating.governing, Some(Limit::Effort { drive: 0 }));
        let of_load = rating.with_spec_load.as_ref().unwrap();
        assert!((of_load.efforts[0] - 100.0 * 9.81 * 4.0 * angle.cos()).abs() < 1e-9);
    }
}

/// The load sinks by as much as its drive's spring gives way: `k δ = m g L cos(α − δ)`, starting from the minimum load.
#[test]
fn a_deflection_limits_by_the_way_of_the_point() {
    let stiffness = 1e6;
    let soft = format!("{{coordinate: boom_psi, stiffness: {stiffness}, motion: {{hold: 0}}}}");
    let soft = crane(&BOOM.replace("DRIVE", &soft));
    let mut limits = Limits::none(soft.description());
    limits.deflections[0] = 0.05;
    let axes = Axes(vec![axis(Varied::Drive(0), 0.2, 1.0, 5)]);
    let envelope = Envelope { axes, load: 0, loads: [1e-3, 1e6], limits, factor: 1.0 };
    for (pose, rating) in rate(&envelope, &soft, 1).iter().enumerate() {
        let position: f64 = envelope.axes.values(pose)[0];
        let given_way = 2.0 * (0.05_f64 / 2.0 / 4.0).asin();
        let expected = stiffness * given_way / (9.81 * 4.0 * (position - given_way).cos());
        let load = rating.load.unwrap();
        // The minimum load of 1 g moves the point by 1e-7 of that.
        assert!((load / expected - 1.0).abs() < 3e-6, "{position}: {load} instead of {expected}");
        assert_eq!(rating.governing, Some(Limit::Deflection { point: 0 }));
    }
}

#[test]
fn a_load_without_limits_is_the_greatest_and_one_without_rest_is_none() {
    let soft = "{coordinate: boom_psi, stiffness: 1e6, motion: {hold: 0}}";
    let soft = crane(&BOOM.replace("DRIVE", soft));
    let axes = Axes(vec![axis(Varied::Drive(0), 0.2, 0.4, 2)]);
    let limits = Limits::none(soft.description());
    let envelope = Envelope { axes, load: 0, loads: [1.0, 5000.0], limits, factor: 1.0 };
    for rating in rate(&envelope, &soft, 1) {
        assert_eq!((rating.load, rating.governing), (Some(5000.0), None));
    }
}

/// The shipped crane with 25 coordinates, over slewing, lifting and length: all drives are flexible.
fn forest_crane(positions: Option<[f64; 3]>, load: f64) -> LiveCrane {
    let shipped = crane_specs::spec("eight_link_flexible").expect("a shipped crane");
    let mut changes =
        format!("materials: {{steel: {{yield_stress: 355e6}}}}\nparameters: {{load_mass: {{value: {load:?}}}}}\n");
    if let Some([slew, boom, telescope]) = positions {
        let hold = |coordinate: &str, at: f64| format!("  - {{coordinate: {coordinate}, motion: {{hold: {at:?}}}}}\n");
        changes += "drives:\n";
        changes += &(hold("column_psi", slew) + &hold("boom_psi", boom) + &hold("telescope_z", telescope));
    }
    LiveCrane::from_spec(&SourceFile::new("eight_link_flexible.yaml", shipped).changed(&changes)).expect("sound")
}

/// Each pose of the envelope is compared with a separate spec whose drives hold that pose.
#[test]
fn every_pose_is_as_a_crane_alone() {
    let whole = forest_crane(None, 500.0);
    let mut limits = Limits { tipping: Some(0.3), utilisation: Some(1.0), ..Limits::none(whole.description()) };
    limits.efforts[1] = 1.2e5;
    let axes = Axes(vec![
        axis(Varied::Drive(0), -1.5, 1.5, 3),
        axis(Varied::Drive(1), -0.3, 1.2, 3),
        axis(Varied::Drive(3), 0.5, 2.5, 2),
    ]);
    let envelope = Envelope { axes, load: 0, loads: [1.0, 1e5], limits: limits.clone(), factor: 1.0 };
    let ratings = rate(&envelope, &whole, 2);
    let mut governing = Vec::new();
    for (pose, rating) in ratings.iter().enumerate() {
        let values = envelope.axes.values(pose);
        let load = rating.load.expect("the empty crane is within its limits");
        let mut alone = forest_crane(Some([values[0], values[1], values[2]]), load);
        let near = &rating.loaded.as_ref().unwrap().q;
        let mut slack = |load: f64| {
            DynCrane::set_parameter(&mut alone, 0, load).unwrap();
            let crane: &dyn DynCrane = &alone;
            let equilibrium = Problem::new(crane).from(near).solve();
            assert!(equilibrium.is_stable());
            let (rest, q) = (vec![0.0; equilibrium.q.len()], &equilibrium.q);
            let lines = crane_model::tipping::lines(crane, 0.0, q, &rest, &rest);
            let margin = crane_model::tipping::governing(&lines).unwrap().margin();
            let wrenches = crane.internal_forces_at(0.0, q, &rest, &rest);
            let description = crane.description();
            let sections = crane_model::sections::stressed_sections(
                description,
                &crane.section_moduli_at(),
                &crane.section_places_at(q),
                &wrenches,
            );
            let utilisation = sections.iter().filter_map(|section| section.utilisation).fold(0.0, f64::max);
            let effort = crane.drive_efforts_at_rest(q)[1].abs();
            // Poses of the same crane are equal to the tolerance of statics.
            let apart = near.iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (margin - 0.3, 1.0 - utilisation, 1.0 - effort / 1.2e5, apart)
        };
        let (margin, utilisation, effort, apart) = slack(load);
        assert!(apart < 1e-7, "pose {pose}: {apart}");
        let least = margin.min(utilisation).min(effort);
        assert!((-1e-9..1e-5).contains(&least), "pose {pose}: {least} left at {load} kg");
        let (margin, utilisation, effort, _) = slack(load * 1.001);
        assert!(margin.min(utilisation).min(effort) < 0.0, "pose {pose}: more is beyond a limit");
        governing.push(rating.governing.unwrap().kind());
    }
    governing.sort_unstable();
    governing.dedup();
    assert!(governing.len() > 1, "{governing:?}");
}

/// For flexible and for rigid drives, holding a position is equivalent to a motion that holds it.
#[test]
fn positions_held_are_motions_that_hold() {
    for drive in ["stiffness: 1e6, damping: 10", "rigid: true"] {
        let spec =
            |motion: &str| BOOM.replace("DRIVE", &format!("{{coordinate: boom_psi, {drive}, motion: {motion}}}"));
        let moving = crane(&spec("{quintic: {from: 0.3, to: 1, duration: 2}}"));
        let held = crane(&spec("{hold: 0.9}"));
        let (moving, held): (&dyn DynCrane, &dyn DynCrane) = (&moving, &held);
        let settings = Settings::default();
        let one = Problem::new(moving).holding(&[0.9]).from(&[0.3]).settings(&settings).solve();
        let other = held.equilibrium(&settings);
        assert!(one.is_stable() && (one.q[0] - other.q[0]).abs() < 1e-12, "{} {}", one.q[0], other.q[0]);
        let efforts = [moving.drive_efforts_holding(0.0, &[0.9], &one.q)[0], held.drive_efforts_at_rest(&other.q)[0]];
        assert!((efforts[0] / efforts[1] - 1.0).abs() < 1e-9, "{efforts:?}");
    }
}

/// Rows longer than a piece, on one thread and on three: the same to the last bit.
#[test]
fn ratings_do_not_depend_on_threads() {
    let truck = crane(TRUCK);
    let limits = Limits { tipping: Some(0.0), ..Limits::none(truck.description()) };
    let axes = Axes(vec![axis(Varied::Parameter(0), 50.0, 60.0, 2), axis(Varied::Drive(0), 0.0, 6.0, 61)]);
    let envelope = Envelope { axes, load: 0, loads: [0.0, 1e5], limits, factor: 1.0 };
    assert_eq!(envelope.pieces(), 6);
    assert_eq!(rate(&envelope, &truck, 1), rate(&envelope, &truck, 3));
}
