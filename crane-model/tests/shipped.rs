//! What every shipped crane must do.

use std::ops::ControlFlow;

use crane_model::{
    cranes,
    dynamics::{Method, Settings, rk4, simulate},
    modes, rig,
    stability::limit,
    statics,
};
use nalgebra::SVector;

#[test]
fn every_crane_rests_in_a_stable_equilibrium_within_five_steps() {
    for rig in cranes::all() {
        let equilibrium = rig.equilibrium(&statics::Settings::default());
        let name = rig.description().name;
        assert!(equilibrium.is_stable(), "{name}: {}: {:?}", equilibrium.status, equilibrium.history);
        assert!(equilibrium.steps() <= 5, "{name}: {:?}", equilibrium.history);
        let at_rest = modes::undamped(&rig.small_motions(&equilibrium.q)).expect("a positive definite mass matrix");
        assert!(at_rest.iter().all(|mode| mode.omega_squared > 0.0), "{name}");
    }
}

#[test]
fn every_spec_asks_for_a_stable_step() {
    for rig in cranes::all() {
        let q = rig.equilibrium(&statics::Settings::default()).q;
        let modes = modes::damped(&rig.small_motions(&q)).expect("modes");
        let limit = limit(&modes, &Method::Rk4.stability()).expect("a limit").step;
        let description = rig.description();
        assert!(description.step < limit, "{}: step {}, limit {limit}", description.name, description.step);
    }
}

#[test]
fn a_run_of_the_reference_crane_allocates_nothing() {
    use cranes::eight_link_flexible::{Crane, N};
    let crane = Crane::default();
    let equilibrium = statics::solve(&crane, &statics::Settings::default());
    let start = rk4::State::at_rest(SVector::<f64, N>::from_column_slice(&equilibrium.q));
    let rig = rig::boxed::<N, Crane>();
    let settings = Settings { duration: 0.01, audit: true, ..Settings::of(rig.description()) };
    let info = allocation_counter::measure(|| {
        simulate(&crane, start, &settings, |_| ControlFlow::Continue(())).expect("a stable run");
    });
    assert_eq!(info.count_total, 0);
}
