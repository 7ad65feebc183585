//! What holds a crane at rest besides its springs: oil that shut valves trap, and bristles that stick.

use super::SmallMotions;
use crate::{
    CylinderInfo, Description,
    dyn_crane::DynCrane,
    hydraulics::{CylinderState, cylinders_at},
};

/// Adds the stiffness of the oil that shut valves trap to that of small motions about a pose at rest, and the change of the direction of its
/// forces.
pub(crate) fn stiffen_by_oil(crane: &dyn DynCrane, q: &[f64], motions: &mut SmallMotions) {
    add_cylinders(crane, q, motions, |info, state| state.stiffness_along(info).unwrap_or(f64::NAN));
}

/// Adds what cylinders with the forces F contribute, `k Jᵀ J − F ∂J/∂q` with `J = ∂ℓ/∂q` to the stiffness of small motions about a pose at rest, for each cylinder with a valve; `along`: its
/// stiffness k, N/m.
pub(super) fn add_cylinders(
    crane: &dyn DynCrane,
    q: &[f64],
    motions: &mut SmallMotions,
    along: impl Fn(&CylinderInfo, &CylinderState) -> f64,
) {
    /// Step of the central difference of J, m or rad: the relative error of the second term is 1e-8.
    const DIFFERENCE: f64 = 1e-4;
    let (cylinders, n) = (&crane.description().cylinders, q.len());
    if !crane.description().has_valves() {
        return;
    }
    let states = cylinders_at(crane, q, &vec![0.0; n], &crane.drive_efforts_at_rest(q));
    let jacobians_at = |coordinate: usize, step: f64| {
        let (mut moved, mut rows) = (q.to_vec(), vec![0.0; cylinders.len() * n]);
        moved[coordinate] += step;
        crane.cylinder_jacobians(&moved, &mut rows);
        rows
    };
    let here = jacobians_at(0, 0.0);
    for (column, &by) in motions.unknowns.iter().enumerate() {
        let [before, after] = [-DIFFERENCE, DIFFERENCE].map(|step| jacobians_at(by, step));
        for (index, (info, state)) in cylinders.iter().zip(&states).enumerate() {
            let [first, end] = info.spanned;
            if info.valve.is_none() || !(first..end).contains(&by) {
                continue;
            }
            let stiffness = along(info, state);
            for (row, &of) in motions.unknowns.iter().enumerate() {
                let [entry, other] = [of, by].map(|coordinate| index * n + coordinate);
                let curvature = (after[entry] - before[entry]) / (2.0 * DIFFERENCE);
                motions.stiffness[(row, column)] += stiffness * here[entry] * here[other] - state.force * curvature;
            }
        }
    }
}

/// Adds the stiffness and damping of sticking bristles to those of small motions about a pose at rest.
pub(crate) fn stiffen_by_bristles(description: &Description, motions: &mut SmallMotions) {
    for joint in &description.bristles {
        let Some(unknown) = motions.unknowns.iter().position(|unknown| *unknown == joint.coordinate) else { continue };
        motions.stiffness[(unknown, unknown)] += joint.stiffness;
        motions.damping[(unknown, unknown)] += joint.damping;
    }
}
