//! What the default runs of the shipped cranes cost: reveals a method that takes more steps than before.

use std::ops::ControlFlow;

use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::statics;

/// Steps and evaluations of the run that each spec asks for, by method; recorded with the default tolerance.
const RECORDED: [(&str, Method, [usize; 2]); 10] = [
    ("eight_link_flexible", Method::Bdf, [1394, 1519]),
    ("eight_link_identified", Method::Bdf, [829, 1040]),
    ("eight_link_rigid", Method::Bdf, [1473, 1622]),
    ("eight_link_two_flexible", Method::Bdf, [1511, 1642]),
    ("knuckle_boom", Method::Bdf, [488, 564]),
    ("eight_link_flexible", Method::Rosenbrock, [1532, 9307]),
    ("eight_link_identified", Method::Rosenbrock, [1157, 8023]),
    ("eight_link_rigid", Method::Rosenbrock, [1444, 8923]),
    ("eight_link_two_flexible", Method::Rosenbrock, [1885, 11425]),
    ("knuckle_boom", Method::Rosenbrock, [337, 2762]),
];
/// A rounding may change a step here and there.
const ALLOWED: f64 = 0.03;

#[test]
fn statistics_of_runs_are_unchanged() {
    let cranes = crane_shipped::all();
    for (name, method, recorded) in RECORDED {
        let crane = cranes.iter().find(|crane| crane.description().name == name).expect("a shipped crane");
        let rest = crane.equilibrium(&statics::Settings::default());
        let settings = Settings { method, audit: true, ..Settings::from_description(crane.description()) };
        let run = crane.simulate(&InitialState::at_rest(rest.q), &settings, &mut |_| ControlFlow::Continue(()));
        let statistics = run.expect("a stable run").statistics;
        for (value, recorded) in [statistics.steps, statistics.evaluations].into_iter().zip(recorded) {
            let ratio = value as f64 / recorded as f64;
            assert!((ratio - 1.0).abs() < ALLOWED, "{name} by {method}: {statistics:?}, recorded {recorded:?}");
        }
    }
}
