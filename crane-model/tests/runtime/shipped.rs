//! Requirements on every shipped crane.

use std::ops::ControlFlow;

use crane_model::{
    CraneModel,
    dyn_crane::{self, DynCrane},
    dynamics::{InitialState, Method, Settings, Simulation, Statistics, rk4},
    modes,
    stability::limit,
    statics,
};
use crane_shipped as cranes;
use nalgebra::{SVector, Vector3};

#[test]
fn every_crane_rests_in_a_stable_equilibrium_within_five_steps() {
    for crane in cranes::all() {
        let equilibrium = crane.equilibrium(&statics::Settings::default());
        let name = &crane.description().name;
        assert!(equilibrium.is_stable(), "{name}: {}: {:?}", equilibrium.status, equilibrium.history);
        assert!(equilibrium.steps() <= 5, "{name}: {:?}", equilibrium.history);
        let at_rest =
            modes::undamped(&crane.small_motions_at(&equilibrium.q)).expect("a positive definite mass matrix");
        assert!(at_rest.iter().all(|mode| mode.omega_squared > 0.0), "{name}");
    }
}

#[test]
fn live_parameters_keep_the_rules_of_the_spec() {
    use cranes::knuckle_boom::{Crane, N, PARAMETERS, Params};
    let refused = Crane::new(Params { payload: -10.0 }).expect_err("a negative mass");
    let message = "parameter `payload`: the mass of body `load` must not be negative, but is -10 [E032]; \
                write 0 or a positive number, in kg";
    assert_eq!(refused.to_string(), message);
    let mut crane = Crane::default();
    for payload in [-1e-6, f64::NAN, f64::INFINITY, 1e19, 1e-31] {
        assert!(CraneModel::<N>::set_parameter(&mut crane, 0, payload).is_err(), "{payload}");
        assert!(CraneModel::<N>::set_parameters(&mut crane, &[payload]).is_err(), "{payload}");
        assert_eq!(crane, Crane::default(), "what is refused changes nothing");
    }
    // The joint also carries the block, so the load may be zero.
    for payload in [0.0, 1e-30, 500.0, 1e18] {
        assert_eq!(CraneModel::<N>::set_parameter(&mut crane, 0, payload), Ok(()));
        assert_eq!(crane.params().payload, payload);
    }
    assert_eq!((PARAMETERS[0].lower_bound.value, PARAMETERS[0].lower_bound.allowed), (0.0, true));
}

#[test]
fn every_spec_asks_for_a_stable_step() {
    for crane in cranes::all() {
        let q = crane.equilibrium(&statics::Settings::default()).q;
        let modes = modes::damped(&crane.small_motions_at(&q)).expect("modes");
        let limit = limit(&modes, &Method::Rk4.stability()).expect("a limit").step;
        let description = crane.description();
        assert!(description.step < limit, "{}: step {}, limit {limit}", description.name, description.step);
    }
}

#[test]
fn steps_of_the_reference_crane_allocate_nothing() {
    use cranes::eight_link_flexible::{Crane, N};
    let crane = Crane::default();
    let equilibrium = statics::Problem::new(&crane).solve();
    let start = rk4::State::at_rest(SVector::<f64, N>::from_column_slice(&equilibrium.q));
    let description = CraneModel::<N>::description(&crane);
    for method in Method::ALL {
        // Memory is allocated once per run: a run ten times as long allocates as often.
        let [short, long] = [0.02, 0.2].map(|duration| {
            let settings = Settings { method, duration, audit: true, ..Settings::from_description(description) };
            let run = || Simulation::new(&crane, start, &settings).run().expect("a stable run");
            allocation_counter::measure(|| _ = run()).count_total
        });
        assert_eq!(short, long, "{method}");
    }
}

/// Path of the points of a run, m, point by point, and its statistics.
fn path(crane: &dyn DynCrane, method: Method, tolerance: f64) -> (Vec<Vec<Vector3<f64>>>, Statistics) {
    let start = crane.equilibrium(&statics::Settings::default()).q;
    let settings = Settings { method, tolerance, step: 1e-4, ..Settings::from_description(crane.description()) };
    let mut path = Vec::new();
    let run = crane
        .simulate(&InitialState::at_rest(start), &settings, &mut |sample| {
            path.push(crane.points_at(sample.q));
            ControlFlow::Continue(())
        })
        .expect("a stable run");
    (path, run.statistics)
}

#[test]
fn implicit_methods_hold_their_tolerance_on_the_reference_crane() {
    use cranes::eight_link_flexible::{Crane, N};
    let crane = dyn_crane::boxed::<N, Crane>();
    // The error of this reference is 1e-13 of the path.
    let (reference, constant) = path(crane.as_ref(), Method::Rk4, f64::NAN);
    // Diagonal of the box around the paths, m.
    let all = || reference.iter().flatten();
    let [low, high] = [f64::min, f64::max]
        .map(|extreme| Vector3::from_fn(|axis, _| all().map(|point| point[axis]).reduce(extreme).expect("points")));
    let size = (high - low).norm();
    let tolerances = [1e-4, 1e-5, 1e-6];
    for (method, tolerance) in [Method::Rosenbrock, Method::Bdf].into_iter().flat_map(|m| tolerances.map(|t| (m, t))) {
        let (path, statistics) = path(crane.as_ref(), method, tolerance);
        let distances = reference.iter().flatten().zip(path.iter().flatten()).map(|(a, b)| (a - b).norm());
        let error = distances.fold(0.0, f64::max) / size;
        println!("{method} {tolerance:e}: {error:.2e} of {size:.1} m, {statistics:?}");
        assert!(error < 10.0 * tolerance && error > 0.1 * tolerance, "{method} {tolerance:e}: {error:e}");
        // Steps resolve the motion, not the stiffest spring.
        assert!(tolerance < 1e-4 || 20 * statistics.evaluations < constant.evaluations, "{statistics:?}");
    }
}

/// Maximum effort of each drive over the run that the spec requests, N or N m.
fn peaks(crane: &dyn DynCrane, method: Method, tolerance: f64) -> Vec<f64> {
    let start = InitialState::at_rest(crane.equilibrium(&statics::Settings::default()).q);
    let defaults = Settings::from_description(crane.description());
    let settings = Settings { method, tolerance, ..defaults };
    let mut peaks = vec![0.0_f64; crane.description().drives.len()];
    crane
        .simulate(&start, &settings, &mut |sample| {
            for (peak, effort) in peaks.iter_mut().zip(crane.drive_efforts_of(sample)) {
                *peak = peak.max(effort.abs());
            }
            ControlFlow::Continue(())
        })
        .expect("a stable run");
    peaks
}

#[test]
fn efforts_of_drives_are_right_to_a_thousandth_at_the_default_tolerance() {
    for crane in cranes::all() {
        let description = crane.description();
        let exact = peaks(crane.as_ref(), Method::Bdf, 1e-8);
        for method in [Method::Bdf, Method::Rosenbrock] {
            let found = peaks(crane.as_ref(), method, Settings::from_description(description).tolerance);
            let errors: Vec<f64> = found.iter().zip(&exact).map(|(value, exact)| value / exact - 1.0).collect();
            println!("{} {method}: {errors:?}", description.name);
            // Where feet lift, joints rub and valves open, forces have kinks.
            let allowed = if description.has_valves() { 5e-3 } else { 1e-3 };
            assert!(errors.iter().all(|error| error.abs() < allowed), "{} {method}: {errors:?}", description.name);
        }
    }
}
