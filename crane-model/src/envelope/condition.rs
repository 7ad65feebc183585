//! A crane at rest: tipping moments, stresses, efforts, cylinders, feet, stops, ropes and positions.

use nalgebra::Vector3;

use super::{Limit, Limits, PartLimit};
use crate::{
    Description,
    dyn_crane::DynCrane,
    hydraulics::{CylinderState, cylinders_at},
    results::overlaps,
    sections::{StressedSection, stressed_sections},
    tipping::{self, TippingLine},
};

/// Tipping moments, stresses, efforts, cylinders, feet, stops, ropes and positions of a crane at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Condition {
    /// The pose, m and rad.
    pub q: Vec<f64>,
    /// Moments about the tipping lines.
    pub lines: Vec<TippingLine>,
    /// Stresses of the beams whose moduli are known.
    pub sections: Vec<StressedSection>,
    /// Torques and forces of the drives, N m and N.
    pub efforts: Vec<f64>,
    /// The cylinders.
    pub cylinders: Vec<CylinderState>,
    /// Vertical force of each support on the crane, N, and its height above the ground if it is one-sided, m: positive if it has lifted.
    pub feet: Vec<[f64; 2]>,
    /// Index of each foot on the ground among the supports, and how much of its friction it uses: with 1 it begins to slide.
    pub utilisations_of_friction: Vec<(usize, f64)>,
    /// Efforts of the end stops, as [`Description::stops`] lists them, N m and N.
    pub stops: Vec<f64>,
    /// Forces of the connectors, N and N m.
    pub connectors: Vec<f64>,
    /// How far each stage of a telescope is in its outer beam, m, and its first body.
    pub overlaps: Vec<(usize, f64)>,
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
        let efforts = crane.drive_efforts_holding(0.0, positions, &q);
        let reactions = crane.support_reactions_at(&q, &rest).into_iter().zip(crane.support_gaps_at(&q));
        Self {
            lines: tipping::lines(crane, 0.0, &q, &rest, &rest),
            sections: stressed_sections(
                crane.description(),
                &crane.section_moduli_at(),
                &crane.section_places_at(&q),
                &wrenches,
            ),
            cylinders: cylinders_at(crane, &q, &rest, &efforts),
            efforts,
            feet: reactions.map(|(force, gap)| [force.z, gap]).collect(),
            utilisations_of_friction: crane.friction_utilisations_at(&q),
            stops: crane.stop_efforts_at(&q, &rest),
            connectors: crane.connector_tensions_at(0.0, &q, &rest).into_iter().map(|tension| tension.force).collect(),
            overlaps: crane.stages().iter().map(|stage| stage.inner).zip(overlaps::at(crane, &q)).collect(),
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

    /// The limits that it is beyond; deflections are measured from here.
    pub fn exceeded(&self, crane: &dyn DynCrane, limits: &Limits) -> Vec<Limit> {
        let slacks = self.slacks(crane.description(), &limits.with_max_efforts(crane), &self.points);
        slacks.into_iter().filter(|(_, slack)| *slack < 0.0).map(|(limit, _)| limit).collect()
    }

    /// The remaining margin to each limit, relative to the limit except for tipping: 0 at the limit, negative beyond.
    pub(super) fn slacks(
        &self,
        description: &Description,
        limits: &Limits,
        reference: &[Vector3<f64>],
    ) -> Vec<(Limit, f64)> {
        let mut slacks = Vec::new();
        if let Some(least) = limits.tipping {
            // Where the crane has tipped, rounding decides the sign of its margin.
            let left = |line: &TippingLine| if line.has_tipped { -1.0 } else { line.margin() - least };
            let slack = |line: &TippingLine| (Limit::Tipping { feet: line.feet }, left(line));
            slacks.extend(self.lines.iter().map(slack));
        }
        if let Some(greatest) = limits.utilisation {
            let slack = |section: &StressedSection| {
                Some((Limit::Utilisation { section: section.place.section }, 1.0 - section.utilisation? / greatest))
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
        self.of_cylinders(description, limits, &mut slacks);
        self.of_contacts(description, limits, &mut slacks);
        slacks
    }

    /// Pressures and strokes.
    fn of_cylinders(&self, description: &Description, limits: &Limits, slacks: &mut Vec<(Limit, f64)>) {
        let pump = description.pump.and_then(|pump| pump.pressure).filter(|_| limits.has(PartLimit::Pump));
        for (cylinder, (info, state)) in description.cylinders.iter().zip(&self.cylinders).enumerate() {
            for (rod, pressure) in [false, true].into_iter().zip(state.pressures) {
                if let Some(greatest) = info.max_pressure.filter(|_| limits.has(PartLimit::Pressure)) {
                    slacks.push((Limit::Pressure { cylinder, rod }, 1.0 - pressure / greatest));
                }
                slacks.extend(pump.map(|pump| (Limit::Pump { cylinder, rod }, 1.0 - pressure / pump)));
            }
            if limits.has(PartLimit::Stroke) {
                let extension = state.extension(info) / info.stroke;
                let left = extension.min(1.0 - extension) + ROUNDING;
                // A linkage that cannot be assembled has no length.
                slacks.push((Limit::Stroke { cylinder }, if extension.is_nan() { f64::NEG_INFINITY } else { left }));
            }
        }
    }

    /// Stops that are touched, feet that carry nothing, ropes without tension, and stages without overlap.
    fn of_contacts(&self, description: &Description, limits: &Limits, slacks: &mut Vec<(Limit, f64)>) {
        if limits.has(PartLimit::Stops) {
            let driven = |coordinate: usize| description.drives.iter().any(|drive| drive.coordinate == coordinate);
            let stops = description.stops.iter().zip(&self.stops).filter(|(coordinate, _)| driven(**coordinate));
            slacks
                .extend(stops.map(|(&coordinate, effort)| {
                    (Limit::Stop { coordinate }, if *effort == 0.0 { 1.0 } else { -1.0 })
                }));
        }
        if limits.has(PartLimit::Sliding) {
            let longest = self.utilisations_of_friction.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            slacks.extend(longest.map(|&(foot, utilisation)| (Limit::Sliding { foot }, 1.0 - utilisation)));
        }
        if limits.has(PartLimit::LiftOff) {
            let sizes = self.feet.iter().map(|[force, _]| force.abs());
            let mean = (sizes.sum::<f64>() / self.feet.len().max(1) as f64).max(f64::MIN_POSITIVE);
            // A gap has another unit than a force: only its sign counts.
            let slack = |[force, gap]: &[f64; 2]| if *gap > 0.0 { -gap } else { force / mean };
            slacks
                .extend(self.feet.iter().enumerate().map(|(foot, contact)| (Limit::LiftOff { foot }, slack(contact))));
        }
        if limits.has(PartLimit::SlackRopes) {
            let ropes = description.connectors.iter().zip(&self.connectors).enumerate();
            let ropes = ropes.filter(|(_, (info, _))| info.is_rope);
            slacks.extend(ropes.map(|(rope, (_, force))| {
                (Limit::Slack { rope }, if *force > 0.0 { force / UNIT_OF_TENSION } else { -1.0 })
            }));
        }
        if limits.has(PartLimit::Overlap) {
            slacks.extend(self.overlaps.iter().map(|&(body, overlap)| (Limit::Overlap { body }, overlap)));
        }
    }
}

/// Fraction of a stroke by which rounding may place a cylinder beyond its end.
const ROUNDING: f64 = 1e-9;
/// Tension, N, that counts as a margin of 1: any other would do.
const UNIT_OF_TENSION: f64 = 1e3;
