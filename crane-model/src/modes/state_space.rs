//! Small motions about a pose at rest together with the states of forces: pressures, spools and bristles.

use nalgebra::{Complex, DMatrix, DVector};

use super::{DampedMode, NoModes, SmallMotions, damped::eigenpairs};
use crate::{StateAt, dyn_crane::DynCrane, force_states::ForceStates, stateful_force::StatefulForce};

/// The state matrix M of `d/dt [δq; δq̇; δx] = M [δq; δq̇; δx]`: the coordinates that can move, their rates, and the states of forces.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// M, with 2n + m rows for n coordinates that can move and m states of forces.
    pub matrix: DMatrix<f64>,
    /// Mass matrix and indices of the coordinates that can move.
    motions: SmallMotions,
}

impl StateSpace {
    /// At a state at rest; `motions`: without what forces with states contribute, except for the change of their direction.
    ///
    /// # Errors
    /// The mass matrix is not positive definite.
    pub(crate) fn at(
        crane: &dyn DynCrane,
        moment: &StateAt<'_>,
        mut motions: SmallMotions,
        forces: &mut ForceStates,
    ) -> Result<Self, NoModes> {
        let (n, m) = (motions.unknowns.len(), forces.len());
        let mut by_states = DMatrix::zeros(m, m);
        forces.evaluate(crane, moment, &mut vec![0.0; m], Some(&mut by_states));
        // Generalized forces by states; rates of states by positions and by rates, state by state.
        let [mut pushes, mut by_position, mut by_rate] = [(); 3].map(|()| DMatrix::<f64>::zeros(n, m));
        for (force, row) in forces.forces().iter().zip(forces.rows()) {
            let along = motions.along_unknowns(|coordinate| row.entry(coordinate));
            let StatefulForce { first, count, by_length, by_speed, .. } = *force;
            motions.stiffness.ger(-by_length, &along, &along, 1.0);
            motions.damping.ger(-by_speed, &along, &along, 1.0);
            for index in 0..count {
                for (columns, factor) in [
                    (&mut pushes, force.by_states[index]),
                    (&mut by_position, force.rates_by_length[index]),
                    (&mut by_rate, force.rates_by_speed[index]),
                ] {
                    columns.column_mut(first + index).axpy(factor, &along, 1.0);
                }
            }
        }
        let factors = motions.factors()?;
        let [stiffness, damping] = motions.state_blocks(&factors);
        let pushed = factors.solve(&pushes);
        let mut matrix = DMatrix::zeros(2 * n + m, 2 * n + m);
        matrix.view_mut((0, n), (n, n)).fill_with_identity();
        matrix.view_mut((n, 0), (n, n)).copy_from(&stiffness);
        matrix.view_mut((n, n), (n, n)).copy_from(&damping);
        matrix.view_mut((n, 2 * n), (n, m)).copy_from(&pushed);
        matrix.view_mut((2 * n, 0), (m, n)).tr_copy_from(&by_position);
        matrix.view_mut((2 * n, n), (m, n)).tr_copy_from(&by_rate);
        matrix.view_mut((2 * n, 2 * n), (m, m)).copy_from(&by_states);
        Ok(Self { matrix, motions })
    }

    /// About a state with the accelerations `a`: that of an open chain may move, one with loops rests. Dry friction of joints that rest is left
    /// out, as in modes.
    ///
    /// # Errors
    /// The mass matrix is not positive definite.
    pub(crate) fn about(
        crane: &dyn DynCrane,
        moment: &StateAt<'_>,
        a: &[f64],
        forces: &mut ForceStates,
    ) -> Result<Self, NoModes> {
        let mut motions = SmallMotions::about_motion(crane, moment.t, [moment.q, moment.v, a]);
        leave_out_dry_friction(crane, moment, &mut motions);
        let turning = turn(crane, moment, &mut motions, forces);
        let motions = motions.with_closed_loops(crane, moment.t, moment.q);
        let mut space = Self::at(crane, moment, motions, forces)?;
        if let Some(turning) = turning.filter(|_| space.motions.basis.is_none()) {
            let n = space.unknowns().len();
            let mut rates = space.matrix.view_mut((2 * n, 0), turning.shape());
            rates += turning;
        }
        Ok(space)
    }

    /// Accelerations of the coordinates in the state due to generalized forces on all coordinates, N and N m.
    ///
    /// # Errors
    /// The mass matrix is not positive definite.
    pub(crate) fn accelerations_by(&self, forces: &[f64]) -> Result<DVector<f64>, NoModes> {
        let along = self.motions.along_unknowns(|coordinate| forces[coordinate]);
        Ok(self.motions.factors()?.solve(&along))
    }

    /// A, D and K of the coordinates in the state, with what forces with states contribute directly.
    pub fn small_motions(&self) -> &SmallMotions {
        &self.motions
    }

    /// With loops: the motion of all coordinates per unit of each in the state.
    pub(crate) fn basis(&self) -> Option<&DMatrix<f64>> {
        self.motions.basis.as_ref()
    }

    /// Indices in q of the coordinates in the state.
    pub fn unknowns(&self) -> &[usize] {
        &self.motions.unknowns
    }

    /// The eigenvalues with Im λ ≥ 0 and the dominant coordinates of their motions, lowest frequency first.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn modes(&self) -> Result<Vec<DampedMode>, NoModes> {
        let n = self.motions.unknowns.len();
        let mode = |(eigenvalue, vector): (Complex<f64>, DVector<Complex<f64>>)| DampedMode {
            eigenvalue,
            dominating: self.motions.dominating(&vector.rows(0, n).into_owned()),
        };
        let mut modes: Vec<DampedMode> = eigenpairs(self.matrix.clone())?.into_iter().map(mode).collect();
        modes.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
        Ok(modes)
    }
}

/// Takes the dry friction of joints that rest out of D. The slope of its smoothed law at rest, `F_b/v₀`, only holds for rates far below v₀: a joint
/// that swings meets a force that hardly depends on its rate.
fn leave_out_dry_friction(crane: &dyn DynCrane, moment: &StateAt<'_>, motions: &mut SmallMotions) {
    /// A rate at which only viscous friction is left, m/s or rad/s.
    const FAST: f64 = 1e6;
    let damping = |joint: usize, rate: f64| {
        let (mut v, mut all) = (moment.v.to_vec(), vec![[0.0; 2]; moment.v.len()]);
        v[joint] = rate;
        crane.nonlinear_stiffness_and_damping(moment.t, moment.q, &v, &mut all);
        all[joint][1]
    };
    for &joint in crane.description().frictions.iter().filter(|&&joint| moment.v[joint] == 0.0) {
        let Some(index) = motions.unknowns.iter().position(|&unknown| unknown == joint) else { continue };
        // A stop that the joint leaves this fast damps it no more: it does in the other direction.
        let fast = damping(joint, FAST).max(damping(joint, -FAST));
        motions.damping[(index, index)] -= damping(joint, 0.0) - fast;
    }
}

/// Step of the central differences of the rows of cylinders, m or rad: their relative error is 1e-8.
const DIFFERENCE: f64 = 1e-4;

/// Adds to K how the forces of cylinders with a valve turn with the pose, and how their speeds change with it:
///
/// ```text
/// K −= F ∂²ℓ/∂q² + ∂ℓ/∂qᵀ F_ℓ̇ ∂ℓ̇/∂q,      ∂ℓ̇/∂q = (∂²ℓ/∂q²) q̇
/// ```
///
/// Returns what the latter contributes to the rates of their states; `None` without valves.
fn turn(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    motions: &mut SmallMotions,
    forces: &mut ForceStates,
) -> Option<DMatrix<f64>> {
    if !crane.description().has_valves() {
        return None;
    }
    let mut rates = vec![0.0; forces.len()];
    forces.evaluate(crane, moment, &mut rates, None);
    let (here, rows) = (forces.forces().to_vec(), forces.rows().to_vec());
    let mut turning = DMatrix::zeros(forces.len(), motions.unknowns.len());
    for (column, &by) in motions.unknowns.iter().enumerate() {
        if rows.iter().all(|row| row.entries.len() < 2 && row.first != by) {
            continue;
        }
        let [before, after] = [-DIFFERENCE, DIFFERENCE].map(|step| {
            let mut moved = moment.q.to_vec();
            moved[by] += step;
            forces.evaluate(crane, &StateAt { q: &moved, ..*moment }, &mut rates, None);
            forces.rows().to_vec()
        });
        for (force, (row, (before, after))) in here.iter().zip(rows.iter().zip(before.iter().zip(&after))) {
            let curvature = |of: usize| (after.entry(of) - before.entry(of)) / (2.0 * DIFFERENCE);
            let faster = (after.along(moment.v) - before.along(moment.v)) / (2.0 * DIFFERENCE);
            for (index, &of) in motions.unknowns.iter().enumerate() {
                motions.stiffness[(index, column)] -=
                    force.force * curvature(of) + row.entry(of) * force.by_speed * faster;
            }
            for (state, by_speed) in force.rates_by_speed.iter().enumerate().take(force.count) {
                turning[(force.first + state, column)] += by_speed * faster;
            }
        }
    }
    Some(turning)
}
