//! What a motion requires beyond the forces that act, and derivatives of the dynamics.

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap()
}

/// At a = q̈ nothing is missing, and at other accelerations A (a − q̈) is: two recursions against each other.
#[test]
fn residuals_vanish_at_the_accelerations() {
    for name in ["knuckle_boom", "eight_link_rigid", "eight_link_flexible", "loader_tipping", "two_arms"] {
        let live = shipped(name);
        let (crane, n, t): (&dyn DynCrane, _, _) = (&live, live.size(), 0.4);
        let q: Vec<f64> = crane.guess().iter().enumerate().map(|(i, guess)| guess + 0.1 * (i as f64).sin()).collect();
        let v: Vec<f64> = (0..n).map(|i| 0.5 * (1.7 * i as f64).cos()).collect();
        let (mut accelerations, mut residual, mut required) = (vec![0.0; n], vec![f64::NAN; n], vec![f64::NAN; n]);
        live.forward_dynamics(t, &q, &v, &mut accelerations);
        live.dynamic_residual(t, &q, &v, &accelerations, &mut residual);
        live.inverse_dynamics(&q, &v, &accelerations, &mut required);
        let size = required.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let prescribed = live.description().prescribed();
        for (i, residual) in residual.iter().enumerate().filter(|(i, _)| !prescribed.contains(i)) {
            // Rounding, times the condition of A.
            assert!(residual.abs() <= 1e-9 * size, "{name}, {i}: {residual:e} of {size:e}");
        }
        let more: Vec<f64> = accelerations.iter().map(|a| a + 1.0).collect();
        let mut with_more = vec![f64::NAN; n];
        live.dynamic_residual(t, &q, &v, &more, &mut with_more);
        let mass = crane.mass_matrix_at(&q);
        for (i, (with_more, residual)) in with_more.iter().zip(&residual).enumerate() {
            let expected = mass.row(i).sum();
            // Rounding of forces of this size.
            assert!((with_more - residual - expected).abs() <= 1e-11 * size.max(expected.abs()), "{name}, {i}");
        }
    }
}

/// A pendulum by its textbook: `r = (J + m l²) a − m g l sin q + d v`, q from the horizontal; ∂q̈/∂q = −m g l sin q/(J + m l²).
#[test]
fn a_pendulum_has_the_derivatives_of_its_textbook() {
    let text = "format: 1\nname: pendulum\nlinks:\n  - name: rod\n    joint: {revolute: {axis: y}}\n    mass: 2\n    com: [0.5, 0, 0]\n    \
                inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}\ndamping: {rod_theta: 0.3}\n";
    let live =
        LiveCrane::from_spec(&SourceFile::new("pendulum.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let (inertia, moment, damping, q) = (0.05 + 2.0 * 0.25, 2.0 * 9.81 * 0.5, 0.3, 0.4_f64);
    let mut out = [f64::NAN; 3];
    live.forward_dynamics_derivatives(0.0, &[q], &[1.5], &mut out);
    for (value, expected) in out.into_iter().zip([-moment * q.sin() / inertia, -damping / inertia, 1.0 / inertia]) {
        // Rounding of numbers of order 10.
        assert!((value - expected).abs() < 1e-14, "{out:?} for {expected}");
    }
}
