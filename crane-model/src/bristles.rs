//! Friction of joints that stick: bristles between the surfaces bend before they slide.
//!
//! The mean deflection z of the bristles is a state; with the stiffness σ₀ and the damping σ₁
//!
//! ```text
//! ż = q̇ − σ₀ |q̇| z/g(q̇)        g = F_c + (F_b − F_c) exp(−(q̇/v_s)²)        F = σ₀ z + σ₁ ż
//! ```
//!
//! F resists the motion; viscous friction is part of the generated functions. At rest, z sustains a force up to the breakaway friction
//! without creep; in steady sliding, `F = g`.
//!
//! C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky: A new model for control of systems with
//! friction, IEEE Transactions on Automatic Control 40 (1995).

use crane_quantities::ColumnKind;
use nalgebra::DMatrixViewMut;

use crate::{
    BristleInfo, Description, StateAt,
    column::column_name,
    dyn_crane::Functions,
    stateful_force::{Evaluated, ForceRow, ForceState, StatefulForce, StatefulForces},
};

/// The joints of a crane that stick, with the names of their coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Bristles(Vec<(BristleInfo, String)>);

impl Bristles {
    /// The joints of a description that stick.
    pub fn new(description: &Description) -> Self {
        let named = |joint: &BristleInfo| (*joint, description.coordinates[joint.coordinate].name.to_string());
        Self(description.bristles.iter().map(named).collect())
    }

    fn joints(&self) -> impl Iterator<Item = &BristleInfo> {
        self.0.iter().map(|(joint, _)| joint)
    }
}

impl StatefulForces for Bristles {
    /// Deflections; bristles slide at their scale.
    fn states(&self) -> Vec<ForceState> {
        let state = |(joint, name): &(BristleInfo, String)| ForceState {
            name: column(name),
            scale: joint.breakaway / joint.stiffness,
            range: None,
        };
        self.0.iter().map(state).collect()
    }

    fn rows(&self) -> Vec<ForceRow> {
        self.joints().map(|joint| ForceRow { first: joint.coordinate, entries: vec![1.0] }).collect()
    }

    fn is_local(&self) -> bool {
        true
    }

    fn supplies_power(&self) -> bool {
        false
    }

    /// Bristles that carry nothing.
    fn holding(&mut self, _: &dyn Functions, _: f64, _: &[f64]) -> Vec<f64> {
        vec![0.0; self.0.len()]
    }

    fn evaluate(
        &mut self,
        _: &dyn Functions,
        moment: &StateAt<'_>,
        Evaluated { rates, forces, .. }: Evaluated<'_>,
        mut by_states: Option<DMatrixViewMut<'_, f64>>,
    ) {
        for (state, (joint, force)) in self.joints().zip(forces).enumerate() {
            let slope = evaluate(joint, state, moment.x[state], moment.v[joint.coordinate], force);
            rates[state] = slope.rate;
            if let Some(matrix) = &mut by_states {
                matrix[(state, state)] = slope.by_deflection;
            }
        }
    }

    /// Replaces the slopes of joints that stick, whose bristles hardly slide within `c`, s, by the steeper of those on either side of rest:
    ///
    /// ```text
    /// ∂ż/∂q̇ = 1 + |σ₀ z/g|
    /// ```
    ///
    /// A rate that changes its sign within a step is damped on both sides by this slope. With the slope of one side, a linearly implicit
    /// method lets the rate alternate as far as the tolerance allows, and the joint creeps.
    fn steepen(&self, moment: &StateAt<'_>, c: f64, forces: &mut [StatefulForce]) {
        for (z, (joint, force)) in moment.x.iter().zip(self.joints().zip(forces)) {
            let rate = moment.v[joint.coordinate];
            let slip = joint.stiffness / level(joint, rate);
            if c * slip * rate.abs() < STICKING {
                force.rates_by_speed[0] = 1.0 + (slip * z).abs();
                force.by_speed = -joint.damping * force.rates_by_speed[0];
            }
        }
    }

    /// Appends the direction in which each joint moves.
    fn branches(&mut self, _: &dyn Functions, moment: &StateAt<'_>, out: &mut Vec<bool>) {
        out.extend(self.joints().map(|joint| moment.v[joint.coordinate] > 0.0));
    }
}

/// A joint sticks if its bristles slide by less than this share of their deflection within the implicit part of a step.
const STICKING: f64 = 0.1;

/// ż and its derivative with respect to z.
struct Slope {
    rate: f64,
    by_deflection: f64,
}

/// Friction of steady sliding without its viscous part, `g(q̇)`, N m or N.
fn level(joint: &BristleInfo, rate: f64) -> f64 {
    joint.coulomb + (joint.breakaway - joint.coulomb) * (-(rate / joint.stribeck).powi(2)).exp()
}

/// The friction at a deflection and a rate of the joint.
fn evaluate(joint: &BristleInfo, first: usize, z: f64, rate: f64, force: &mut StatefulForce) -> Slope {
    let &BristleInfo { coordinate: _, coulomb, breakaway: _, stribeck, stiffness, damping } = joint;
    let level = level(joint, rate);
    let level_by_rate = -2.0 * rate / (stribeck * stribeck) * (level - coulomb);
    let by_deflection = -stiffness * rate.abs() / level;
    let by_rate = 1.0 - stiffness * z / level * (rate.signum() - rate.abs() * level_by_rate / level);
    let slope = rate + by_deflection * z;
    *force = StatefulForce {
        first,
        count: 1,
        force: -(stiffness * z + damping * slope),
        by_speed: -damping * by_rate,
        by_states: [-(stiffness + damping * by_deflection), 0.0, 0.0],
        rates_by_speed: [by_rate, 0.0, 0.0],
        speed: rate,
        ..StatefulForce::default()
    };
    Slope { rate: slope, by_deflection }
}

/// Derivative of the rate of a bristle at rest with respect to its deflection, 1/s, in a joint that slides at `rate`.
pub(crate) fn decay(joint: &BristleInfo, rate: f64) -> f64 {
    evaluate(joint, 0, 0.0, rate, &mut StatefulForce::default()).by_deflection
}

/// Torques and forces of the bristles on their joints, by coordinate, N m and N.
pub(crate) fn efforts(description: &Description, v: &[f64], x: &[f64]) -> Vec<(usize, f64)> {
    let first = x.len().saturating_sub(description.bristles.len());
    let effort = |(joint, z): (&BristleInfo, &f64)| {
        let mut force = StatefulForce::default();
        evaluate(joint, 0, *z, v[joint.coordinate], &mut force);
        (joint.coordinate, force.force)
    };
    description.bristles.iter().zip(&x[first..]).map(effort).collect()
}

/// Name of the column of results with the deflection in a joint.
pub(crate) fn column(coordinate: &str) -> String {
    column_name(ColumnKind::Bristle, coordinate, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences over 1e-6 of each argument.
    #[test]
    fn friction_has_its_derivatives() {
        let joint = BristleInfo {
            coordinate: 0,
            coulomb: 80.0,
            breakaway: 120.0,
            stribeck: 0.02,
            stiffness: 1e5,
            damping: 300.0,
        };
        let at = |z: f64, v: f64| {
            let mut force = StatefulForce::default();
            let slope = evaluate(&joint, 0, z, v, &mut force);
            (slope, force)
        };
        for (z, v) in [(5e-4, 0.013), (-3e-4, 0.04), (8e-4, -0.002)] {
            let (slope, force) = at(z, v);
            let by = |of: &dyn Fn(f64) -> f64, h: f64| (of(h) - of(-h)) / (2.0 * h);
            let differences = [
                (slope.by_deflection, by(&|h| at(z + h, v).0.rate, 1e-9)),
                (force.rates_by_speed[0], by(&|h| at(z, v + h).0.rate, 1e-7)),
                (force.by_states[0], by(&|h| at(z + h, v).1.force, 1e-9)),
                (force.by_speed, by(&|h| at(z, v + h).1.force, 1e-7)),
            ];
            for (index, (value, difference)) in differences.into_iter().enumerate() {
                assert!((value / difference - 1.0).abs() < 1e-6, "{index}: {value} for {difference}");
            }
        }
    }
}
