//! Decay rates of states of forces about a pose, as modes of their joints: they limit the step size of explicit methods.

use nalgebra::{Complex, Vector3};

use super::DampedMode;
use crate::{BristleInfo, CylinderInfo, bristles, dyn_crane::DynCrane, hydraulics};

/// Decay rates of the pressures of cylinders with a valve, and of the bristles of joints that stick, at time t.
pub fn decays(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Vec<DampedMode> {
    [of_oil(crane, q), of_bristles(crane, t)].concat()
}

/// An upper bound on the decay rate of the pressures of each cylinder with a valve at a pose, as a mode of its joint: the one with open
/// suction valves and nearly equal pressures on both sides of the valve's edges. It limits explicit methods.
fn of_oil(crane: &dyn DynCrane, q: &[f64]) -> Vec<DampedMode> {
    let cylinders = &crane.description().cylinders;
    let mut lengths = vec![Vector3::zeros(); cylinders.len()];
    crane.cylinder_states(q, &vec![0.0; q.len()], &mut lengths);
    let decay = |(info, length): (&CylinderInfo, &Vector3<f64>)| {
        let (valve, bulk_modulus) = (info.valve?, info.bulk_modulus?);
        let y = (length.x - info.retracted).clamp(0.0, info.stroke);
        let [of_piston, of_rod] = info.hose_volumes;
        let volume = (of_piston + info.areas[0] * y).min(of_rod + info.areas[1] * (info.stroke - y));
        let eigenvalue = Complex::new(-bulk_modulus / volume * hydraulics::steepest_flow(&valve), 0.0);
        Some(DampedMode { eigenvalue, dominating: vec![crane.description().drives[info.drive].coordinate] })
    };
    cylinders.iter().zip(&lengths).filter_map(decay).collect()
}

/// Decay rates σ₀ |q̇|/g of the bristles of sliding joints, as modes of the joints: q̇ is the rate of the drive's motion at time t, or the
/// Stribeck velocity for a joint without a drive.
fn of_bristles(crane: &dyn DynCrane, t: f64) -> Vec<DampedMode> {
    let description = crane.description();
    let motions = crane.drive_motions_at(t);
    let decay = |joint: &BristleInfo| {
        let drive = description.drives.iter().position(|drive| drive.coordinate == joint.coordinate);
        let rate = drive.map_or(joint.stribeck, |drive| motions[drive][1]);
        DampedMode { eigenvalue: Complex::new(bristles::decay(joint, rate), 0.0), dominating: vec![joint.coordinate] }
    };
    description.bristles.iter().map(decay).filter(|mode| mode.eigenvalue.re != 0.0).collect()
}
