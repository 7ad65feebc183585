//! A crane without coordinates.

use std::ops::ControlFlow;

use crate::common::Fixed;
use crane_model::{
    dyn_crane::{DynCrane, Instance},
    dynamics, modes, statics,
};

#[test]
fn a_crane_without_coordinates_rests_and_does_not_vibrate() {
    let crane: Box<dyn DynCrane> = Box::new(Instance(Fixed));
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable() && equilibrium.q.is_empty() && equilibrium.steps() == 0);
    assert_eq!(modes::undamped(&crane.small_motions_at(&[])), Ok(Vec::new()));
    assert_eq!(modes::damped(&crane.small_motions_at(&[])), Ok(Vec::new()));
    assert_eq!(crane.weight_at(&[]), [None; 3]);
    let settings = dynamics::Settings {
        method: dynamics::Method::Rk4,
        duration: 0.01,
        ..dynamics::Settings::from_description(crane.description())
    };
    let run = crane
        .simulate(&dynamics::InitialState::default(), &settings, &mut |_| ControlFlow::Continue(()))
        .expect("a run");
    assert_eq!(run.statistics.steps, 10);
}
