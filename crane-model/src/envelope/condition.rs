//! Tipping moments, stresses, efforts and positions of a crane at rest.

use nalgebra::Vector3;

use super::{Limit, Limits};
use crate::{
    dyn_crane::DynCrane,
    sections::{StressedSection, stressed_sections},
    tipping::{self, TippingLine},
};

/// Tipping moments, stresses, efforts and positions of a crane at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// The pose, m and rad.
    pub q: Vec<f64>,
    /// Moments about the tipping lines.
    pub lines: Vec<TippingLine>,
    /// Stresses of the beams whose moduli are known.
    pub sections: Vec<StressedSection>,
    /// Torques and forces of the drives, N m and N.
    pub efforts: Vec<f64>,
    /// Positions of the points of interest, m.
    pub points: Vec<Vector3<f64>>,
    /// Origin of the last body's frame, m.
    pub end: Vector3<f64>,
}

impl Condition {
    /// The condition at pose `q`, in which drives that hold these positions keep the crane at rest.
    pub fn at(crane: &dyn DynCrane, q: Vec<f64>, positions: &[f64]) -> Self {
        let rest = vec![0.0; q.len()];
        let wrenches = crane.internal_forces_at(0.0, &q, &rest, &rest);
        Self {
            lines: tipping::lines(crane, 0.0, &q, &rest, &rest),
            sections: stressed_sections(crane.description(), &crane.section_moduli_at(), &wrenches),
            efforts: crane.drive_efforts_holding(positions, &q),
            points: crane.points_at(&q),
            end: crane
                .transforms_at(&q)
                .last()
                .map_or_else(Vector3::zeros, |last| last.fixed_view::<3, 1>(0, 3).into()),
            q,
        }
    }

    /// The minimum tipping margin; `None` without tipping lines.
    pub fn margin(&self) -> Option<f64> {
        tipping::governing(&self.lines).map(TippingLine::margin)
    }

    /// The maximum utilisation; `None` if no beam has a yield stress.
    pub fn utilisation(&self) -> Option<f64> {
        self.sections.iter().filter_map(|section| section.utilisation).max_by(f64::total_cmp)
    }

    /// Distances of the points from those of another condition, m.
    pub fn deflections(&self, from: &Condition) -> Vec<f64> {
        self.points.iter().zip(&from.points).map(|(to, from)| (to - from).norm()).collect()
    }

    /// The remaining margin to each limit, relative to the limit except for tipping: 0 at the limit, negative beyond.
    pub(super) fn slacks(&self, limits: &Limits, reference: &[Vector3<f64>]) -> Vec<(Limit, f64)> {
        let mut slacks = Vec::new();
        if let Some(least) = limits.tipping {
            let slack = |line: &TippingLine| (Limit::Tipping { feet: line.feet }, line.margin() - least);
            slacks.extend(self.lines.iter().map(slack));
        }
        if let Some(greatest) = limits.utilisation {
            let slack = |section: &StressedSection| {
                Some((Limit::Utilisation { section: section.section }, 1.0 - section.utilisation? / greatest))
            };
            slacks.extend(self.sections.iter().filter_map(slack));
        }
        let limited = |(_, (_, limit)): &(usize, (_, &f64))| limit.is_finite();
        let efforts = self.efforts.iter().zip(&limits.efforts).enumerate().filter(limited);
        slacks.extend(
            efforts.map(|(drive, (effort, greatest))| (Limit::Effort { drive }, 1.0 - effort.abs() / greatest)),
        );
        for (point, ((to, from), greatest)) in self.points.iter().zip(reference).zip(&limits.deflections).enumerate() {
            if greatest.is_finite() {
                slacks.push((Limit::Deflection { point }, 1.0 - (to - from).norm() / greatest));
            }
        }
        slacks
    }
}
