//! Oil about a pose at rest: the decay rates of its pressures, and the stiffness of the oil that shut valves trap.

use nalgebra::{Complex, Vector3};

use super::{cylinder::SUCTION, valve::root};
use crate::{
    CylinderInfo,
    dyn_crane::DynCrane,
    modes::{DampedMode, SmallMotions},
    results::cylinders_at,
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

/// Adds the stiffness of the oil that shut valves trap, `k (∂ℓ/∂q)² − F ∂²ℓ/∂q²`, to that of small motions about a pose at rest.
pub(crate) fn stiffen(crane: &dyn DynCrane, q: &[f64], motions: &mut SmallMotions) {
    /// Step of the central difference of a lever arm, m or rad: the relative error of the second term is 1e-8.
    const DIFFERENCE: f64 = 1e-4;
    let cylinders = &crane.description().cylinders;
    if !crane.description().has_valves() {
        return;
    }
    let rest = vec![0.0; q.len()];
    let states = cylinders_at(crane, q, &rest, &crane.drive_efforts_at_rest(q));
    for (index, (info, state)) in
        cylinders.iter().zip(&states).enumerate().filter(|(_, (info, _))| info.valve.is_some())
    {
        let coordinate = crane.description().drives[info.drive].coordinate;
        let lever = |step: f64| {
            let mut moved = q.to_vec();
            moved[coordinate] += step;
            let mut lengths = vec![Vector3::zeros(); cylinders.len()];
            crane.cylinder_states(&moved, &rest, &mut lengths);
            lengths[index].z
        };
        let curvature = (lever(DIFFERENCE) - lever(-DIFFERENCE)) / (2.0 * DIFFERENCE);
        let Some(place) = motions.unknowns.iter().position(|unknown| *unknown == coordinate) else { continue };
        let oil = state.oil_stiffness(info).unwrap_or(f64::NAN);
        motions.stiffness[(place, place)] += oil - state.force * curvature;
    }
}
