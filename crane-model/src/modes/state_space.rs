//! Small motions about a pose at rest together with the states of forces: pressures, spools and bristles.

use nalgebra::{Complex, DMatrix, DVector};

use super::{DampedMode, NoModes, SmallMotions, damped::eigenpairs};
use crate::{
    dyn_crane::DynModel,
    force_states::ForceStates,
    model::state_blocks,
    stateful_force::{StateAt, StatefulForce},
};

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
        crane: &dyn DynModel,
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
        let [stiffness, damping] =
            state_blocks(motions.mass.clone(), &motions.stiffness, &motions.damping).ok_or(NoModes::MassMatrix)?;
        let pushed = motions.mass.clone().cholesky().ok_or(NoModes::MassMatrix)?.solve(&pushes);
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
