//! What loop joints transmit so that a crane moves or rests in a given way.

use nalgebra::{DMatrix, DVector};

use super::{Loops, dot};
use crate::least_squares::LeastSquares;
use crate::{CoordinateRole, Description, dyn_crane::Functions};

/// Distances of a row from the span of others below this are zero: a sine of 1e-5, as for the choice of independent equations.
const SINGULAR: f64 = 1e-5;

/// λ that the accelerations of a motion require:
///
/// ```text
/// Jᵀ λ = e + f + Cᵀ p − A a
/// ```
///
/// in the rows of the coordinates without drives if these determine λ, since the efforts of drives that hold the crane elsewhere are not
/// known here, otherwise in all that are not prescribed. The pushes p of cylinders with a valve are unknown, too: each follows from the row
/// of its joint. What is not determined even so, because several cylinders hold a loop together, is chosen as small as possible.
pub(crate) fn required(crane: &dyn Functions, t: f64, [q, v, a]: [&[f64]; 3]) -> Vec<f64> {
    let n = q.len();
    let (mut mass, mut rest, mut forces) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
    crane.mass_matrix(q, &mut mass);
    crane.bias(q, v, &mut rest);
    crane.forces(t, q, v, &mut forces);
    for (i, (rest, force)) in rest.iter_mut().zip(&forces).enumerate() {
        *rest += force - dot(&mass[i * n..][..n], a);
    }
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, v);
    loops.choose();
    let mut jacobian = loops.jacobian.clone();
    without_pushes(crane, q, &mut jacobian, &mut rest);
    let coordinates = &crane.description().coordinates;
    let among = |roles: &[CoordinateRole]| -> Vec<usize> {
        (0..n).filter(|&i| !roles.contains(&coordinates[i].role)).collect()
    };
    let undriven = among(&[CoordinateRole::Prescribed, CoordinateRole::Driven]);
    let free = among(&[CoordinateRole::Prescribed]);
    Balance::new(&loops, &jacobian, &undriven)
        .and_then(|balance| balance.is_unique().then(|| balance.multipliers(&rest)).flatten())
        .or_else(|| Balance::new(&loops, &jacobian, &free)?.multipliers(&rest))
        .unwrap_or_else(|| vec![0.0; loops.states.len()])
}

/// λ of a crane at rest, with loads and winches as at time `t` and the drives at given positions, by coordinate: `Jᵀ λ = −∂E_p/∂q`.
pub(crate) fn at_rest(crane: &dyn Functions, t: f64, positions: &[f64], q: &[f64]) -> Vec<f64> {
    let mut residual = vec![0.0; q.len()];
    crane.static_residual(t, q, positions, &mut residual);
    for entry in &mut residual {
        *entry = -*entry;
    }
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let free: Vec<usize> = (0..q.len()).filter(|i| !loops.prescribed.contains(i)).collect();
    let balance = Balance::new(&loops, loops.jacobian(), &free);
    balance.and_then(|balance| balance.multipliers(&residual)).unwrap_or_else(|| vec![0.0; loops.states.len()])
}

/// Takes the unknown pushes of cylinders with a valve out of `Jᵀ λ = r + Cᵀ p`. With j the joint that a cylinder moves and C its row, the push is
/// `((Jᵀ λ)_j − r_j)/C_j`, and there remains
///
/// ```text
/// (J − J_j C/C_j)ᵀ λ = r − r_j C/C_j
/// ```
pub(super) fn without_pushes(crane: &dyn Functions, q: &[f64], jacobian: &mut [f64], r: &mut [f64]) {
    let Description { drives, cylinders, .. } = crane.description();
    if !crane.description().has_valves() {
        return;
    }
    let n = q.len();
    let mut rows = vec![0.0; cylinders.len() * n];
    crane.cylinder_jacobians(q, &mut rows);
    for (cylinder, row) in cylinders.iter().zip(rows.chunks_exact(n)).filter(|(cylinder, _)| cylinder.valve.is_some()) {
        let joint = drives[cylinder.drive].coordinate;
        for numbers in jacobian.chunks_exact_mut(n).chain([&mut *r]) {
            let share = numbers[joint] / row[joint];
            numbers.iter_mut().zip(row).for_each(|(number, entry)| *number -= share * entry);
            numbers[joint] = 0.0;
        }
    }
}

/// `Jᵀ λ`: the generalized forces that loop joints resist with.
pub(crate) fn generalized(crane: &dyn Functions, q: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let mut rows = vec![0.0; multipliers.len() * q.len()];
    crane.loop_jacobians(q, &mut rows);
    let mut sum = vec![0.0; q.len()];
    for (share, row) in multipliers.iter().zip(rows.chunks_exact(q.len())) {
        sum.iter_mut().zip(row).for_each(|(sum, entry)| *sum += share * entry);
    }
    sum
}

/// `Jᵀ λ = r` in some coordinates, for the independent equations.
pub(super) struct Balance<'a> {
    loops: &'a Loops,
    coordinates: &'a [usize],
    /// Lengths of the rows of J, over which they are divided here: equations in m and in rad become comparable.
    lengths: Vec<f64>,
    equations: LeastSquares,
}

impl<'a> Balance<'a> {
    /// With the rows of `jacobian` in place of those of J; `None` without equations or coordinates, and if numbers are not finite.
    pub fn new(loops: &'a Loops, jacobian: &[f64], coordinates: &'a [usize]) -> Option<Self> {
        let (kept, n) = (loops.independent(), loops.n);
        if kept.is_empty() || coordinates.is_empty() || !jacobian.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let row = |equation: &usize| &loops.jacobian[equation * n..][..n];
        let lengths: Vec<f64> = kept.iter().map(|equation| dot(row(equation), row(equation)).sqrt()).collect();
        let unit =
            DMatrix::from_fn(coordinates.len(), kept.len(), |i, k| jacobian[kept[k] * n + coordinates[i]] / lengths[k]);
        Some(Self { loops, coordinates, lengths, equations: LeastSquares::new(unit, SINGULAR) })
    }

    /// Whether only one λ balances.
    pub fn is_unique(&self) -> bool {
        self.equations.is_unique()
    }

    /// The smallest λ with the least squares of what remains.
    fn multipliers(&self, r: &[f64]) -> Option<Vec<f64>> {
        let right = DVector::from_iterator(self.coordinates.len(), self.coordinates.iter().map(|&i| r[i]));
        let shares = self.equations.solve(&right)?;
        let mut multipliers = vec![0.0; self.loops.states.len()];
        for ((&equation, share), length) in self.loops.independent().iter().zip(shares.iter()).zip(&self.lengths) {
            multipliers[equation] = share / length;
        }
        Some(multipliers)
    }
}
