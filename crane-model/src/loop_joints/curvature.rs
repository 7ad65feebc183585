//! How the forces of loop joints turn with the pose, and motions that leave loops closed.

use nalgebra::{DMatrix, Vector3};

use super::Loops;
use crate::dyn_crane::DynCrane;

/// `Σ λ_i ∂²φ_i/∂q²`, n × n: the geometric stiffness of loop joints that transmit λ.
///
/// `J̇ q̇` is the quadratic form of the second derivatives, so that its values for pairs of coordinates give them exactly. Cranes with
/// derivatives of J need no pairs.
pub(crate) fn geometric_stiffness(crane: &dyn DynCrane, q: &[f64], multipliers: &[f64]) -> DMatrix<f64> {
    let n = q.len();
    let mut matrix = DMatrix::zeros(n, n);
    if crane.loop_stiffness(q, multipliers, matrix.as_mut_slice()) {
        return matrix;
    }
    let (mut states, mut v) = (vec![Vector3::zeros(); multipliers.len()], vec![0.0; n]);
    let spans = crane.loop_joints().iter().filter(|joint| !joint.is_coupling()).map(|joint| joint.spanned);
    let is_spanned = |both: &[usize]| spans.clone().any(|[first, end]| both.iter().all(|j| (first..end).contains(j)));
    let spanned: Vec<usize> = (0..n).filter(|j| is_spanned(&[*j])).collect();
    let mut along = |coordinates: &[usize]| {
        for &j in coordinates {
            v[j] = 1.0;
        }
        crane.loop_states(q, &v, &mut states);
        for &j in coordinates {
            v[j] = 0.0;
        }
        states.iter().zip(multipliers).map(|(state, multiplier)| multiplier * state.z).sum::<f64>()
    };
    for &j in &spanned {
        matrix[(j, j)] = along(&[j]);
    }
    for (index, &j) in spanned.iter().enumerate() {
        for &i in spanned[..index].iter().filter(|i| is_spanned(&[**i, j])) {
            let both = along(&[i, j]);
            let entry = 0.5 * (both - matrix[(i, i)] - matrix[(j, j)]);
            (matrix[(i, j)], matrix[(j, i)]) = (entry, entry);
        }
    }
    matrix
}

/// Motions that leave the loops closed: the coordinates that are free in them, and a basis Z with a column for each, `J Z = 0`, over all
/// coordinates. `preferred`: how good it is to determine a coordinate by the others.
pub(crate) fn closed_motions(
    crane: &dyn DynCrane,
    q: &[f64],
    preferred: impl Fn(usize) -> f64,
) -> (Vec<usize>, DMatrix<f64>) {
    let n = q.len();
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; n]);
    loops.choose();
    let prescribed = crane.description().prescribed();
    let rows = loops.independent().len();
    let mut matrix = DMatrix::from_fn(rows, n, |i, j| {
        if prescribed.contains(&j) { 0.0 } else { loops.jacobian()[loops.independent()[i] * n + j] }
    });
    // Gauss–Jordan elimination: every row determines one coordinate.
    let mut determined: Vec<usize> = Vec::new();
    let mut is_determined = vec![false; n];
    for row in 0..rows {
        let places = (row..rows).flat_map(|i| (0..n).map(move |j| (i, j)));
        let places = places.filter(|(_, j)| !is_determined[*j]);
        let size = |(i, j): (usize, usize)| matrix[(i, j)].abs() * preferred(j);
        let Some((i, j)) = places.max_by(|&a, &b| size(a).total_cmp(&size(b))) else { break };
        matrix.swap_rows(row, i);
        let pivot = matrix[(row, j)];
        matrix.row_mut(row).iter_mut().for_each(|entry| *entry /= pivot);
        for other in (0..rows).filter(|&other| other != row) {
            let factor = matrix[(other, j)];
            if factor == 0.0 {
                continue;
            }
            for column in 0..n {
                let entry = matrix[(row, column)];
                matrix[(other, column)] -= factor * entry;
            }
        }
        determined.push(j);
        is_determined[j] = true;
    }
    let free: Vec<usize> = (0..n).filter(|j| !is_determined[*j] && !prescribed.contains(j)).collect();
    let basis = DMatrix::from_fn(n, free.len(), |j, column| match determined.iter().position(|&own| own == j) {
        Some(row) => -matrix[(row, free[column])],
        None => f64::from(u8::from(free[column] == j)),
    });
    (free, basis)
}
