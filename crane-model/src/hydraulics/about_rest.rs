//! Oil about a pose at rest: the decay rates of its pressures, and the stiffness of the oil that shut valves trap.

use nalgebra::{Complex, Vector3};

use super::{CylinderState, cylinder::SUCTION, cylinders_at, valve::root};
use crate::{
    CylinderInfo,
    dyn_crane::DynCrane,
    modes::{DampedMode, SmallMotions},
};

/// An upper bound on the decay rate of the pressures of each cylinder with a valve at a pose, as a mode of its joint: the one with open
/// suction valves and nearly equal pressures on both sides of the valve's edges. It limits explicit methods.
pub fn decays(crane: &dyn DynCrane, q: &[f64]) -> Vec<DampedMode> {
    let cylinders = &crane.description().cylinders;
    let mut lengths = vec![Vector3::zeros(); cylinders.len()];
    crane.cylinder_states(q, &vec![0.0; q.len()], &mut lengths);
    let decay = |(info, length): (&CylinderInfo, &Vector3<f64>)| {
        let (valve, bulk_modulus) = (info.valve?, info.bulk_modulus?);
        let y = (length.x - info.retracted).clamp(0.0, info.stroke);
        let [of_piston, of_rod] = info.hose_volumes;
        let volume = (of_piston + info.areas[0] * y).min(of_rod + info.areas[1] * (info.stroke - y));
        let slope = 1.0 / SUCTION + root(0.0).slope / root(valve.pressure_drop).value;
        let eigenvalue = Complex::new(-bulk_modulus / volume * valve.flow * slope, 0.0);
        Some(DampedMode { eigenvalue, dominating: vec![crane.description().drives[info.drive].coordinate] })
    };
    cylinders.iter().zip(&lengths).filter_map(decay).collect()
}

/// Adds the stiffness of the oil that shut valves trap to that of small motions about a pose at rest, and the change of the direction of its
/// forces.
pub(crate) fn stiffen(crane: &dyn DynCrane, q: &[f64], motions: &mut SmallMotions) {
    hold(crane, q, motions, |info, state| state.stiffness_along(info).unwrap_or(f64::NAN));
}

/// Adds what cylinders with the forces F contribute, `k Jᵀ J − F ∂J/∂q` with `J = ∂ℓ/∂q` to the stiffness of small motions about a pose at rest, for each cylinder with a valve; `along`: its
/// stiffness k, N/m.
pub(super) fn hold(
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
                let [place, other] = [of, by].map(|coordinate| index * n + coordinate);
                let curvature = (after[place] - before[place]) / (2.0 * DIFFERENCE);
                motions.stiffness[(row, column)] += stiffness * here[place] * here[other] - state.force * curvature;
            }
        }
    }
}
