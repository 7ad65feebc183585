//! No allocation in the inner loop.

mod common;

use std::ops::ControlFlow;

use common::{DoublePendulum, Lift};
use crane_model::dynamics::{Settings, rk4, simulate};
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
fn a_run_with_audit_allocates_nothing() {
    let lift = Lift::default();
    let settings = Settings { audit: true, ..Settings::of(&common::description("", &[], &[])) };
    let info = allocation_counter::measure(|| {
        simulate(&lift, rk4::State::at_rest(Vector1::zeros()), &settings, |_| ControlFlow::Continue(()))
            .expect("a stable run");
    });
    assert_eq!(info.count_total, 0);
}
