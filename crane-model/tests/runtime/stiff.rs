//! A stiff nonlinear motion: a pendulum whose rod is a stiff spring.

use std::ops::ControlFlow;

use crate::common::{GRAVITY, coordinate, description, implicit::mass_matrix};
use crane_model::{
    CoordinateInfo,
    CoordinateKind::{Rotation, Translation},
    CoordinateRole::Passive,
    CraneModel, Description, ParameterError,
    dynamics::{Method, Run, Settings, Simulation, rk4::State},
};
use nalgebra::{Matrix2, Matrix4, Vector2};

const COORDINATES: &[CoordinateInfo] =
    &[coordinate("rod_x", Translation, Passive), coordinate("rod_psi", Rotation, Passive)];
static DESCRIPTION: Description = description("elastic pendulum", COORDINATES, &[Some(0.0), Some(0.0)]);

/// A unit mass on a rod of length 1 + x at the angle ψ from hanging:
/// `ẍ = (1 + x) ψ̇² + g cos ψ − k x − d ẋ`, `(1 + x) ψ̈ = −2 ẋ ψ̇ − g sin ψ`.
#[derive(Clone)]
struct ElasticPendulum {
    /// k, N/m.
    stiffness: f64,
    /// d, N s/m.
    damping: f64,
}

impl CraneModel<2> for ElasticPendulum {
    crate::common::implicit::by_hand! { 2 }

    fn description(&self) -> &Description {
        &DESCRIPTION
    }
    fn parameter(&self, _: usize) -> f64 {
        f64::NAN
    }
    fn set_parameter(&mut self, _: usize, _: f64) -> Result<(), ParameterError> {
        Ok(())
    }
    fn transforms(&self, _: &Vector2<f64>, _: &mut [Matrix4<f64>]) {}

    fn body_sizes(&self, _: &mut [[f64; 2]]) {}
    fn forces(&self, _: f64, q: &Vector2<f64>, v: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(-self.stiffness * q.x - self.damping * v.x, 0.0)
    }
    fn gravity_energy(&self, q: &Vector2<f64>) -> f64 {
        -GRAVITY * (1.0 + q.x) * q.y.cos()
    }

    fn mass_matrix(&self, q: &Vector2<f64>, out: &mut Matrix2<f64>) {
        *out = Matrix2::from_diagonal(&Vector2::new(1.0, (1.0 + q.x).powi(2)));
    }
    fn bias(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Vector2<f64> {
        let length = 1.0 + q.x;
        let (sin, cos) = q.y.sin_cos();
        Vector2::new(length * v.y * v.y + GRAVITY * cos, -2.0 * length * v.x * v.y - GRAVITY * length * sin)
    }
    fn kinetic_energy(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        0.5 * v.dot(&(mass_matrix(self, q) * v))
    }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.copy_from_slice(&[[self.stiffness, self.damping], [0.0; 2]]);
    }
}

/// Three seconds from 60°, with the rod stretched by gravity as at rest there; poses every 0.1 s.
fn swing(stiffness: f64, method: Method, tolerance: f64) -> (Vec<Vector2<f64>>, Run) {
    let pendulum = ElasticPendulum { stiffness, damping: 1e-3 * stiffness };
    let settings =
        Settings { method, tolerance, duration: 3.0, output: 0.1, ..Settings::from_description(&DESCRIPTION) };
    let angle = 60_f64.to_radians();
    let start = State::at_rest(Vector2::new(GRAVITY * angle.cos() / stiffness, angle));
    let mut poses = Vec::new();
    let run = Simulation::new(&pendulum, start, &settings).observe(|sample| {
        poses.push(Vector2::from_column_slice(sample.q));
        ControlFlow::Continue(())
    });
    (poses, run.expect("a run"))
}

fn distance(a: &[Vector2<f64>], b: &[Vector2<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
}

#[test]
fn the_tolerance_is_held_on_a_stiff_nonlinear_motion() {
    // 1e5 N/m and 100 N s/m on 1 kg: decays at 50 1/s and oscillates at 312 rad/s, which the explicit pair can still follow.
    let (exact, _) = swing(1e5, Method::DormandPrince, 1e-11);
    for method in [Method::Rosenbrock, Method::Bdf] {
        for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
            let (poses, run) = swing(1e5, method, tolerance);
            let ratio = distance(&poses, &exact) / tolerance;
            println!("{method} {tolerance:e}: error {ratio:.2} of it, {run:?}");
            assert!((0.1..10.0).contains(&ratio), "{method} {tolerance:e}: {ratio} of it, {run:?}");
        }
    }
}

#[test]
fn stiffness_does_not_cost_implicit_methods_steps() {
    for method in [Method::Rosenbrock, Method::Bdf] {
        let (soft, run) = swing(1e5, method, 1e-5);
        let steps = run.statistics.steps;
        for stiffness in [1e7, 1e9, 1e11] {
            let (poses, run) = swing(stiffness, method, 1e-5);
            println!("{method}, {stiffness:e} N/m: {run:?}");
            assert!(run.statistics.steps < 2 * steps, "{method}, {stiffness:e} N/m: {run:?}, {steps}");
            // A stiffer rod is stretched less, by up to 3 g/k with the centrifugal force; its length determines the period.
            let off = distance(&poses, &soft);
            assert!(off < 10.0 * GRAVITY / 1e5, "{method}, {stiffness:e} N/m: {off}");
        }
    }
}
