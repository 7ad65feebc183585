//! A cylinder at a state: force, pressures and flow that the effort of its drive requires.
//!
//! A drive with the effort τ on its joint is a cylinder that pushes with `F = τ/(∂ℓ/∂q_j)`: both have the power `τ q̇_j`. With the areas A
//! of the piston and A′ of the ring around the rod, `F = p A − p′ A′`; the side that does not carry the load is at back pressure. Oil
//! flows into the side that grows, at the rate A ℓ̇ or A′ |ℓ̇|. The oil is taken as incompressible; its actual stiffness is
//! [`CylinderState::oil_stiffness`].

use nalgebra::Vector3;

use crate::{CylinderInfo, Text, dyn_crane::Functions};

/// A cylinder at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderState {
    /// Distance ℓ between its pins, m; not a number where its linkage cannot be assembled.
    pub length: f64,
    /// ℓ̇, m/s; positive if it extends.
    pub speed: f64,
    /// `∂ℓ/∂q_j`, m/rad or m/m.
    pub arm: f64,
    /// Force that it pushes with, N; negative if it pulls.
    pub force: f64,
    /// Pressures on the piston's side and on the rod's, Pa.
    pub pressures: [f64; 2],
    /// Flow into the side that grows, m³/s.
    pub flow: f64,
}

impl CylinderState {
    pub(crate) fn new(info: &CylinderInfo, [length, speed, arm]: [f64; 3], effort: f64) -> Self {
        let (force, [piston, ring]) = (effort / arm, info.areas);
        let pressures = pressures(info.areas, info.back_pressure, force);
        let flow = if speed > 0.0 { piston * speed } else { -ring * speed };
        CylinderState { length, speed, arm, force, pressures, flow }
    }

    /// How far it is extended beyond its retracted length, m.
    pub fn extension(&self, info: &CylinderInfo) -> f64 {
        self.length - info.retracted
    }

    /// Stiffness that the oil trapped on both sides gives the joint, N m/rad or N/m: `β (A²/V + A′²/V′) (∂ℓ/∂q_j)²`, if the spec gives its bulk modulus β.
    pub fn oil_stiffness(&self, info: &CylinderInfo) -> Option<f64> {
        Some(self.stiffness_along(info)? * self.arm * self.arm)
    }

    /// Stiffness of this oil along the cylinder, N/m.
    pub(crate) fn stiffness_along(&self, info: &CylinderInfo) -> Option<f64> {
        let ([piston, ring], [of_piston, of_rod]) = (info.areas, info.hose_volumes);
        let y = self.extension(info);
        let volumes = [of_piston + piston * y, of_rod + ring * (info.stroke - y)];
        let along = piston * piston / volumes[0] + ring * ring / volumes[1];
        Some(info.bulk_modulus? * along).filter(|_| volumes.iter().all(|volume| *volume > 0.0))
    }
}

/// Pressures on the piston's side and on the rod's with which a cylinder of these areas, m², pushes with a force, N; the lower one is given, Pa.
pub(crate) fn pressures([piston, ring]: [f64; 2], back: f64, force: f64) -> [f64; 2] {
    if force + back * (ring - piston) > 0.0 {
        [(force + back * ring) / piston, back]
    } else {
        [back, (back * piston - force) / ring]
    }
}

/// Every cylinder at a state, with the efforts of all drives there, N m and N.
pub fn cylinders_at(crane: &dyn Functions, q: &[f64], v: &[f64], efforts: &[f64]) -> Vec<CylinderState> {
    let cylinders = &crane.description().cylinders;
    let mut states = vec![Vector3::zeros(); cylinders.len()];
    crane.cylinder_states(q, v, &mut states);
    let states = states.into_iter().map(Into::into);
    cylinders.iter().zip(states).map(|(info, state)| CylinderState::new(info, state, efforts[info.drive])).collect()
}

/// The first cylinder whose linkage cannot be assembled in a pose.
pub(crate) fn unassembled_at(crane: &dyn Functions, q: &[f64]) -> Option<Text> {
    let cylinders = &crane.description().cylinders;
    let mut states = vec![Vector3::zeros(); cylinders.len()];
    crane.cylinder_states(q, &vec![0.0; q.len()], &mut states);
    cylinders.iter().zip(&states).find_map(|(info, state)| state.x.is_nan().then(|| info.name.clone()))
}
