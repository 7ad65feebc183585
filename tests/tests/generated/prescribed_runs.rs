//! Runs of compiled cranes with rigid drives, by every method.

use crane_model::statics::Problem;
use std::ops::ControlFlow;

use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::ensemble::Member;
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::modes::SmallMotions;
use crane_tests::registry;

/// An instant of a run, with the error of its energy balance, J.
struct Moment {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    balance: f64,
    /// The largest of the work of drives and loads and of what is dissipated, J.
    exchanged: f64,
}

/// Random cranes with rigid drives, and the indices of the prescribed coordinates.
fn cranes() -> Vec<(Box<dyn DynCrane>, Vec<usize>)> {
    let cranes = registry::all().into_iter().filter(|entry| entry.random).map(|entry| (entry.crane)());
    let cranes = cranes.map(|crane| {
        let prescribed = crane.description().prescribed();
        (crane, prescribed)
    });
    let cranes: Vec<_> = cranes.filter(|(_, prescribed)| !prescribed.is_empty()).collect();
    assert!(cranes.len() >= 3, "{} cranes with rigid drives", cranes.len());
    cranes
}

fn settings(crane: &dyn DynCrane, method: Method) -> Settings {
    Settings {
        method,
        duration: 0.6,
        output: 0.05,
        step: 2e-4,
        tolerance: 1e-7,
        audit: true,
        ..Settings::from_description(crane.description())
    }
}

fn record_moments(crane: &dyn DynCrane, settings: &Settings) -> Vec<Moment> {
    let mut moments: Vec<Moment> = Vec::new();
    let mut at_start = None;
    let start = InitialState::at_rest(crane.guess());
    let run = crane.simulate(&start, settings, &mut |sample| {
        let energy = crane.energies_of(sample).total();
        let gained = energy - *at_start.get_or_insert(energy);
        let (q, v) = (sample.q.to_vec(), sample.v.to_vec());
        moments.push(Moment {
            t: sample.t,
            q,
            v,
            balance: gained - sample.work - sample.load_work + sample.dissipated,
            exchanged: [sample.work, sample.load_work, sample.dissipated].into_iter().map(f64::abs).fold(0.0, f64::max),
        });
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{}, {}: {stopped}", crane.description().name, settings.method));
    moments
}

/// At every result, prescribed coordinates follow their motion to the last bit; all methods agree on the others, and the work of
/// drives and loads is the energy gained and dissipated.
#[test]
fn every_method_follows_prescribed_motions() {
    for (crane, prescribed) in cranes() {
        let name = &crane.description().name;
        let exact = Settings { tolerance: 1e-10, ..settings(&*crane, Method::DormandPrince) };
        let exact = record_moments(&*crane, &exact).pop().expect("the end of the run");
        let runs = Method::ALL.map(|method| (method, record_moments(&*crane, &settings(&*crane, method))));
        for (method, moments) in &runs {
            for moment in moments {
                let (mut q, mut v) = (moment.q.clone(), moment.v.clone());
                crane.prescribe(moment.t, &mut q, &mut v);
                assert_eq!((&q, &v), (&moment.q, &moment.v), "{name}, {method}, t = {}", moment.t);
            }
            let last = moments.last().expect("the end of the run");
            assert!(prescribed.iter().any(|j| last.v[*j] != 0.0 || last.q[*j] != 0.0), "{name}");
            let apart = last.q.iter().zip(&exact.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Errors of 1e-7 in each of a thousand steps.
            assert!(apart < 1e-4, "{name}: {method} is off by {apart:.1e}");
            let exchanged = moments.iter().map(|moment| moment.exchanged).fold(1.0, f64::max);
            let balance = moments.iter().map(|moment| moment.balance.abs()).fold(0.0, f64::max);
            assert!(balance < 1e-4 * exchanged, "{name}, {method}: {balance:.1e} J of {exchanged:.1e} J");
        }
    }
}

/// A run in lanes gives the same as a single run. Feet have states, which have no lanes.
#[test]
fn ensembles_follow_prescribed_motions() {
    for (crane, prescribed) in cranes().into_iter().filter(|(crane, _)| !crane.description().has_force_states()) {
        let settings = Settings { audit: false, duration: 0.1, ..settings(&*crane, Method::Rk4) };
        let start = InitialState::at_rest(crane.guess());
        let parameters = crane.parameter_values();
        let mut alone = Vec::new();
        let observe = &mut |sample: &crane_model::dynamics::Sample<'_>| {
            alone.push(sample.q.to_vec());
            ControlFlow::Continue(())
        };
        crane.simulate(&start, &settings, observe).expect("a run");
        let members = vec![Member { parameters, start }; 3];
        let mut seen = 0;
        let results = crane.simulate_ensemble(&members, &settings, &mut |member, sample| {
            let expected = &alone[seen / 3];
            let apart = sample.q.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Lanes use fused multiply-adds where scalar code does not.
            assert!(apart < 1e-11, "member {member}: {apart:.1e} at t = {}", sample.t);
            assert!(prescribed.iter().all(|j| sample.q[*j] == expected[*j]), "member {member}");
            seen += 1;
        });
        assert!(results.expect("sound parameters").iter().all(Result::is_ok));
        assert_eq!(seen, 3 * alone.len());
    }
}

/// Small motions and statics leave prescribed coordinates out.
#[test]
fn modes_and_statics_leave_prescribed_coordinates_out() {
    for (crane, prescribed) in cranes() {
        let q = crane.guess();
        let mut at_start = q.clone();
        crane.prescribe(0.0, &mut at_start, &mut vec![0.0; q.len()]);
        assert_eq!(q, at_start, "the guess stands where the drives do");
        let motions = SmallMotions::about_pose(&*crane, &q);
        assert_eq!(motions.mass.nrows(), q.len() - prescribed.len());
        assert!(prescribed.iter().all(|j| !motions.unknowns.contains(j)));
        for mode in crane_model::modes::undamped(&motions).expect("modes") {
            assert_eq!(mode.shape.len(), q.len());
            assert!(prescribed.iter().all(|j| mode.shape[*j] == 0.0 && !mode.dominating.contains(j)));
        }
        let equilibrium = Problem::new(&*crane).at_time(0.8).from(&q).solve();
        let mut moved = equilibrium.q.clone();
        crane.prescribe(0.8, &mut moved, &mut vec![0.0; q.len()]);
        assert_eq!(equilibrium.q, moved, "{}: {equilibrium}", crane.description().name);
    }
}
