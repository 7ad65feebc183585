//! Start of the static solution.

use nalgebra::Vector3;

use crate::{
    Count, Tension,
    dyn_crane::{DynCrane, Functions},
    loop_joints::Loops,
};

/// A guess within this distance of the drive's position is equal to it, m or rad: above rounding, below the differences that matter in a
/// spec.
const ROUNDING: f64 = 1e-9;

impl dyn DynCrane + '_ {
    /// The guess for the present parameters: that of the description, with drives where their motions begin, coordinates that follow others where their
    /// couplings are without force, and loops closed, if they can be. m and rad.
    pub fn guess(&self) -> Vec<f64> {
        let mut q = open_guess(self);
        let open = q.clone();
        let mut loops = Loops::new(self);
        if loops.assemble(self, &mut q, &mut |q, r, x| self.solve_mass(q, r, x)).is_err() { open } else { q }
    }
}

/// The description's guess, and what follows from the parameters of the crane: drives are where their motions begin, and coordinates that follow
/// others where their couplings are without force. Loops may be open.
pub(crate) fn open_guess(crane: &dyn Functions) -> Vec<f64> {
    let mut motions = vec![[0.0; 2]; crane.description().drives.len()];
    crane.drive_motions(0.0, &mut motions);
    let mut q = guess_with(crane, motions.iter().map(|[position, _]| *position));
    let mut rates = vec![0.0; q.len()];
    crane.prescribe(0.0, &mut q, &mut rates);
    q
}

/// The guess with the drives at given positions, one per drive, instead of those of their motions: driven coordinates that the description
/// has where their drives begin, and coordinates that follow them by couplings, move with them.
pub(super) fn guess_with(crane: &dyn Functions, positions: impl Iterator<Item = f64>) -> Vec<f64> {
    let description = crane.description();
    let mut motions = vec![[0.0; 2]; description.drives.len()];
    crane.drive_motions(0.0, &mut motions);
    let mut known = description.guess.to_vec();
    for ((drive, position), [start, _]) in description.drives.iter().zip(positions).zip(motions) {
        let own = &mut known[drive.coordinate];
        if own.is_none_or(|own| (own - start).abs() < ROUNDING) {
            *own = Some(position);
        }
    }
    if known.contains(&None) {
        follow_couplings(crane, &mut known);
    }
    known.into_iter().map(Option::unwrap_or_default).collect()
}

/// Places coordinates that follow others where their couplings are without force.
fn follow_couplings(crane: &dyn Functions, known: &mut [Option<f64>]) {
    let couplings = couplings(crane);
    // A coordinate that follows one that follows another is known one pass later.
    for _ in &couplings {
        for (offset, row) in &couplings {
            let mut coupled = (0..row.len()).filter(|&i| row[i] != 0.0);
            let (Some(one), Some(other)) = (coupled.next(), coupled.next()) else { continue };
            for (follower, leader) in [(one, other), (other, one)] {
                if let (None, Some(leading)) = (known[follower], known[leader])
                    && row[follower] == 1.0
                {
                    known[follower] = Some(offset - row[leader] * leading);
                }
            }
        }
    }
}

/// The couplings `q_j − r q_i = c` that have a stiffness or hold exactly: c, and the rows of their coefficients.
fn couplings(crane: &dyn Functions) -> Vec<(f64, Vec<f64>)> {
    let (description, n) = (crane.description(), crane.size());
    let (count, equations) = (description.connectors.len(), crane.count(Count::LoopEquations));
    let zero = vec![0.0; n];
    let (mut tensions, mut jacobians) = (vec![Tension::ZERO; count], vec![0.0; count * n]);
    crane.connector_tensions(0.0, &zero, &zero, &mut tensions);
    crane.connector_jacobians(&zero, &mut jacobians);
    let has_stiffness =
        |index: &usize| description.connectors[*index].points.is_empty() && tensions[*index].stiffness != 0.0;
    let spring = |index: usize| {
        let Tension { force, stiffness, .. } = tensions[index];
        (-force / stiffness, jacobians[index * n..][..n].to_vec())
    };
    let springs = (0..count).filter(has_stiffness).map(spring);
    let (mut states, mut rows) = (vec![Vector3::zeros(); equations], vec![0.0; equations * n]);
    crane.loop_states(&zero, &zero, &mut states);
    crane.loop_jacobians(&zero, &mut rows);
    let ties = crane.loop_joints().iter().flat_map(|joint| joint.equations.iter().map(|_| joint.is_coupling()));
    let exact = ties.enumerate().filter(|(_, ties)| *ties);
    springs.chain(exact.map(|(index, _)| (-states[index].x, rows[index * n..][..n].to_vec()))).collect()
}
