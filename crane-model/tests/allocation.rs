//! No allocation in the inner loop.

mod common;

use common::{DoublePendulum, Lift};
use crane_model::dynamics::{Method, Settings, Simulation, rk4};
use nalgebra::{Vector1, Vector2};

#[test]
fn a_step_allocates_nothing() {
    let pendulum = DoublePendulum::hanging();
    let mut state = rk4::State::at_rest(Vector2::new(1.2, -0.5));
    let info = allocation_counter::measure(|| {
        for k in 0..1000 {
            rk4::step(&pendulum, f64::from(k) * 1e-3, 1e-3, &mut state).expect("a pendulum has mass");
        }
    });
    assert_eq!(info.count_total, 0);
}

#[test]
fn steps_of_every_method_allocate_nothing() {
    let lift = Lift::default();
    for method in Method::ALL {
        // Memory is allocated once per run: a run ten times as long allocates as often.
        let [short, long] = [1.0, 10.0].map(|duration| {
            let settings = Settings { method, duration, audit: true, ..Settings::from_description(lift.description) };
            let start = rk4::State::at_rest(Vector1::new(lift.sag()));
            let run = || Simulation::new(&lift, start, &settings).run().expect("a stable run");
            allocation_counter::measure(|| _ = run()).count_total
        });
        assert_eq!(short, long, "{method}");
    }
}
