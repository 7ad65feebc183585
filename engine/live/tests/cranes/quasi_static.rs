//! What a crane carries at rest along a motion: nothing of what resists its rates.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::results::{Extremes, Recording};
use crane_model::runs::{QuasiStatic, Start};

/// A column that slews, a beam on rails that a rigid drive moves, and a weight on the damped rope of a winch, which all start at once; a lever in a
/// loop that a damped drive holds.
const CRANE: &str = "
format: 1
name: moving
links:
  - {name: frame, mass: 10, com: [0, 0, 0], inertia: {gyration: [0.2, 0.2, 0.2]}}
  - {name: column, on: frame, joint: revolute, mass: 100, com: [0.5, 0, 0], inertia: {gyration: [0.2, 0.2, 0.2]}}
  - {name: trolley, on: frame, joint: {prismatic: {axis: x}}, mass: 300, com: [0, 0, 0], inertia: {gyration: [0.2, 0.2, 0.2]}}
  - {name: weight, on: frame, placement: {transform: {translation: [5, 0, 0]}}, joint: {prismatic: {axis: z}}, mass: 500, com: [0, 0, 0], inertia: {gyration: [0.2, 0.2, 0.2]}}
connectors:
  - {name: hoist, from: {at: [5, 0, 10]}, to: {link: weight, at: [0, 0, 0]}, law: {rope: {stiffness: 2e6, damping: 0.4, motion: {speed: {from: 8, rate: -0.5}}}}}
drives:
  - {coordinate: column_psi, stiffness: 1e6, damping: 2e4, motion: {speed: {from: 0, rate: 0.5}}}
  - {coordinate: trolley_x, rigid: true, motion: {quintic: {from: 0, to: 2, duration: 4}}}
guess: {weight_z: 2}
run: {duration: 4, output: 0.25}
";

#[test]
fn motions_stand_at_rest() {
    let crane =
        LiveCrane::from_spec(&SourceFile::new("crane.yaml", CRANE)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let crane: &dyn DynCrane = &crane;
    let start = Start::new(crane).expect("it rests");
    let mut recording = Recording::new(crane);
    for step in 0..=16 {
        recording.push_rest(0.25 * f64::from(step), &start.q, &[]);
    }
    let along = QuasiStatic::along(crane, &start, &recording.into_table(), 20, &mut |_| ControlFlow::Continue(()));
    assert!(along.restless.is_empty() && along.table.rows.len() == 17);
    let weight = 500.0 * 9.81;
    // Newton's method ends at 1e-10 of the largest force, the weight; the rope's rate is known to 1e-9 m/s.
    for (column, expected) in
        [("column_psi_drive_torque", 0.0), ("trolley_x_drive_force", 0.0), ("hoist_force", weight)]
    {
        let Extremes { minimum, maximum, .. } = Extremes::of_column(&along.table, column);
        for value in [minimum, maximum] {
            assert!((value - expected).abs() < 1e-6 * weight, "{column}: {minimum} to {maximum}");
        }
    }
}
