//! Rows compared with the functions of one crane: the same bits, whatever the other rows contain.

use crane_codegen::build;
use crane_live::rows::{BatchEvaluation, ParameterRows};
use crane_live::{FunctionId, LiveCrane};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::nalgebra::{Matrix4, Vector3};
use crane_model::rt::lanes::f64x8;

/// Eight and three more.
const COUNT: usize = 11;

fn crane() -> LiveCrane {
    let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

/// Poses about the guess, row after row.
fn poses(crane: &LiveCrane) -> Vec<f64> {
    let guess = &crane.chain().guess;
    let wave = |k: usize| 0.02 * (1.3 * k as f64).sin();
    (0..COUNT * guess.len()).map(|k| guess[k % guess.len()] + wave(k)).collect()
}

#[test]
fn mass_matrices_with_parameters_of_their_own() {
    let crane = crane();
    let (n, count) = (crane.size(), crane.parameters().len());
    let q = poses(&crane);
    let load = crane.description().parameters.iter().position(|info| info.name == "load_mass").unwrap();
    let parameters: Vec<f64> = (0..COUNT)
        .flat_map(|row| (0..count).map(move |index| (row, index)))
        .map(|(row, index)| if index == load { 50.0 * row as f64 } else { crane.parameters()[index] })
        .collect();
    let mut out = vec![f64::NAN; COUNT * n * n];
    let rows = ParameterRows { q: &q, parameters: &parameters, ..ParameterRows::default() };
    BatchEvaluation::<f64x8>::new(&crane, FunctionId::MassMatrix).run(&rows, 0..COUNT, &mut out);
    let mut alone = vec![f64::NAN; n * n];
    for row in 0..COUNT {
        let mut single = crane.clone();
        single.set_parameters(&parameters[row * count..(row + 1) * count]).unwrap();
        single.mass_matrix(&q[row * n..(row + 1) * n], &mut alone);
        assert_eq!(out[row * n * n..(row + 1) * n * n], alone, "row {row}");
    }
}

#[test]
fn transforms_are_written_row_by_row() {
    let crane = crane();
    let (n, bodies) = (crane.size(), crane.description().bodies.len());
    let q = poses(&crane);
    let mut out = vec![f64::NAN; COUNT * 16 * bodies];
    let rows = ParameterRows { q: &q, ..ParameterRows::default() };
    BatchEvaluation::<f64x8>::new(&crane, FunctionId::Transforms).run(&rows, 0..COUNT, &mut out);
    let mut alone = vec![Matrix4::zeros(); bodies];
    for row in 0..COUNT {
        crane.transforms(&q[row * n..(row + 1) * n], &mut alone);
        let expected: Vec<f64> = alone.iter().flat_map(|matrix| matrix.transpose().as_slice().to_vec()).collect();
        assert_eq!(out[row * 16 * bodies..(row + 1) * 16 * bodies], expected, "row {row}");
    }
}

#[test]
fn jacobians_turn_rates_into_velocities() {
    let crane = crane();
    let (n, points) = (crane.size(), crane.description().points.len());
    let q = poses(&crane);
    let v: Vec<f64> = (0..n).map(|j| (0.7 * (j as f64 + 1.0)).sin()).collect();
    let mut jacobian = vec![f64::NAN; 3 * points * n];
    BatchEvaluation::<f64>::new(&crane, FunctionId::PointJacobians).run(
        &ParameterRows { q: &q[..n], ..ParameterRows::default() },
        0..1,
        &mut jacobian,
    );
    let mut velocities = vec![Vector3::zeros(); points];
    crane.point_velocities(&q[..n], &v, &mut velocities);
    for (row, expected) in jacobian.chunks(n).zip(velocities.iter().flatten()) {
        let velocity: f64 = row.iter().zip(&v).map(|(entry, rate)| entry * rate).sum();
        // Rounding of a sum of some numbers of size 10.
        assert!((velocity - expected).abs() < 1e-12, "{velocity} {expected}");
    }
}

#[test]
fn derivatives_of_accelerations_are_those_of_one_crane() {
    let crane = crane();
    let n = crane.size();
    let q = poses(&crane);
    let v: Vec<f64> = (0..COUNT * n).map(|k| 0.1 * (0.7 * k as f64).cos()).collect();
    let mut out = vec![f64::NAN; COUNT * 3 * n * n];
    let rows = ParameterRows { q: &q, v: &v, ..ParameterRows::default() };
    BatchEvaluation::<f64x8>::new(&crane, FunctionId::ForwardDynamicsDerivatives).run(&rows, 0..COUNT, &mut out);
    let mut alone = vec![f64::NAN; 3 * n * n];
    for (row, found) in out.chunks(3 * n * n).enumerate() {
        let range = row * n..(row + 1) * n;
        crane.forward_dynamics_derivatives(0.0, &q[range.clone()], &v[range], &mut alone);
        let largest = alone.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
        for (k, (number, expected)) in found.iter().zip(&alone).enumerate() {
            assert!((number - expected).abs() <= 1e-12 * largest, "row {row}, {k}: {number}, {expected}");
        }
    }
}
