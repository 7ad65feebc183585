//! A crane without coordinates.

mod common;

use std::ops::ControlFlow;

use common::Fixed;
use crane_model::{
    dynamics, modes,
    rig::{Instance, Rig},
    statics,
};

#[test]
fn a_crane_without_coordinates_rests_and_does_not_vibrate() {
    let rig = Instance(Fixed);
    let equilibrium = rig.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable() && equilibrium.q.is_empty() && equilibrium.steps() == 0);
    assert_eq!(modes::undamped(&rig.small_motions(&[])), Ok(Vec::new()));
    assert_eq!(modes::damped(&rig.small_motions(&[])), Ok(Vec::new()));
    assert_eq!(rig.weight(&[]), [None; 3]);
    let settings = dynamics::Settings { duration: 0.01, ..dynamics::Settings::of(rig.description()) };
    let run = rig.simulate(&[], &settings, &mut |_| ControlFlow::Continue(())).expect("a run");
    assert_eq!(run.statistics.steps, 10);
}
