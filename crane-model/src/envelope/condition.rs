//! A crane at rest: tipping moments, stresses, efforts, cylinders, feet, stops, ropes and positions.

use nalgebra::Vector3;

use super::{Limit, Limits};
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
    /// The first body of each stage of a telescope, its overlap with the outer beam, and how much further it may be pushed in, m; negative beyond.
    pub overlaps: Vec<(usize, [f64; 2])>,
    /// Positions of the points of interest, m.
    pub points: Vec<Vector3<f64>>,
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
            connectors: crane.tensions_at_rest(0.0, &q),
            overlaps: crane
                .stages()
                .iter()
                .zip(overlaps::at(crane, &q))
                .map(|(stage, overlap)| (stage.inner, [overlap.inside, overlap.left()]))
                .collect(),
            points: crane.points_at(&q),
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
    pub fn exceeded(&self, crane: &dyn DynCrane, limits: &Limits) -> Vec<Margin> {
        let margins = self.margins(crane.description(), &limits.with_max_efforts(crane), &self.points);
        margins.into_iter().filter(|margin| margin.slack < 0.0).collect()
    }

    /// What is left of each limit; deflections are measured from `reference`.
    pub(super) fn margins(
        &self,
        description: &Description,
        limits: &Limits,
        reference: &[Vector3<f64>],
    ) -> Vec<Margin> {
        let mut margins = Margins { limits, description, all: Vec::new() };
        for line in &self.lines {
            // Where the crane has tipped, rounding decides the sign of its margin.
            let value = if line.has_tipped { line.margin().min(-1.0) } else { line.margin() };
            margins.add(Limit::Tipping { feet: line.feet }, value, |least| value - least);
        }
        for section in &self.sections {
            let limit = Limit::Utilisation { section: section.place.section };
            if let Some(utilisation) = section.utilisation {
                margins.at_most(limit, utilisation);
            }
        }
        for (drive, effort) in self.efforts.iter().enumerate() {
            margins.at_most(Limit::Effort { drive }, effort.abs());
        }
        for (point, (to, from)) in self.points.iter().zip(reference).enumerate() {
            margins.at_most(Limit::Deflection { point }, (to - from).norm());
        }
        self.of_cylinders(&mut margins);
        self.of_contacts(&mut margins);
        self.of_ropes_and_stages(&mut margins);
        margins.all
    }

    /// Pressures and strokes.
    fn of_cylinders(&self, margins: &mut Margins<'_>) {
        for (cylinder, (info, state)) in margins.description.cylinders.iter().zip(&self.cylinders).enumerate() {
            for (rod, pressure) in [false, true].into_iter().zip(state.pressures) {
                margins.at_most(Limit::Pressure { cylinder, rod }, pressure);
                margins.at_most(Limit::Pump { cylinder, rod }, pressure);
            }
            for (extended, sign) in [(false, 1.0), (true, -1.0)] {
                // A linkage that cannot be assembled has no length.
                let left = |end: f64| match sign * (state.length - end) / info.stroke {
                    left if left.is_nan() => f64::NEG_INFINITY,
                    left => left + ROUNDING,
                };
                margins.add(Limit::Stroke { cylinder, extended }, state.length, left);
            }
        }
    }

    /// Stops that are touched, feet that slide or carry nothing.
    fn of_contacts(&self, margins: &mut Margins<'_>) {
        let Description { drives, stops, .. } = margins.description;
        for (&coordinate, effort) in stops.iter().zip(&self.stops) {
            if drives.iter().any(|drive| drive.coordinate == coordinate) {
                margins.add(Limit::Stop { coordinate }, *effort, |none| if *effort == none { 1.0 } else { -1.0 });
            }
        }
        let longest = self.utilisations_of_friction.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some(&(foot, utilisation)) = longest {
            margins.at_most(Limit::Sliding { foot }, utilisation);
        }
        let sizes = self.feet.iter().map(|[force, _]| force.abs());
        let mean = (sizes.sum::<f64>() / self.feet.len().max(1) as f64).max(f64::MIN_POSITIVE);
        for (foot, &[force, gap]) in self.feet.iter().enumerate() {
            // A gap has another unit than a force: only its sign counts.
            margins.add(Limit::LiftOff { foot }, force, |none| if gap > 0.0 { -gap } else { (force - none) / mean });
            margins.at_most(Limit::Ground { foot }, force.max(0.0));
        }
    }

    /// Ropes without tension or with too much, and stages that have left their outer beams.
    fn of_ropes_and_stages(&self, margins: &mut Margins<'_>) {
        for (rope, (info, &force)) in margins.description.connectors.iter().zip(&self.connectors).enumerate() {
            if info.is_rope {
                let left = |none: f64| if force > none { (force - none) / UNIT_OF_TENSION } else { -1.0 };
                margins.add(Limit::Slack { rope }, force, left);
                margins.at_most(Limit::Tension { rope }, force);
            }
        }
        for &(body, [overlap, left]) in &self.overlaps {
            margins.add(Limit::Overlap { body, pushed: false }, overlap, |none| overlap - none);
            margins.add(Limit::Overlap { body, pushed: true }, left, |none| left - none);
        }
    }
}

/// A number of a crane at rest beside its bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// What is limited.
    pub limit: Limit,
    /// The number, in SI units.
    pub value: f64,
    /// Its [bound](Limits::bound).
    pub bound: f64,
    /// What is left, relative to the bound except for tipping, ends of strokes, lift-off, slack ropes and overlaps: 0 at the bound, negative beyond.
    pub slack: f64,
}

/// Margins that are being collected.
struct Margins<'a> {
    limits: &'a Limits,
    description: &'a Description,
    all: Vec<Margin>,
}

impl Margins<'_> {
    /// Adds a number, if it has a bound. `slack`: what is left of the bound.
    fn add(&mut self, limit: Limit, value: f64, slack: impl FnOnce(f64) -> f64) {
        if let Some(bound) = self.limits.bound(limit, self.description) {
            self.all.push(Margin { limit, value, bound, slack: slack(bound) });
        }
    }

    /// Adds a positive number that must not exceed its bound.
    fn at_most(&mut self, limit: Limit, value: f64) {
        self.add(limit, value, |bound| 1.0 - value / bound);
    }
}

/// Fraction of a stroke by which rounding may place a cylinder beyond its end.
const ROUNDING: f64 = 1e-9;
/// Tension, N, that counts as a margin of 1: any other would do.
const UNIT_OF_TENSION: f64 = 1e3;
