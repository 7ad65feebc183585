//! Stresses of beams and moments about tipping lines, on numbers with slopes: the formulas of `crane_model::SectionModuli` and
//! `crane_model::tipping`.

use crane_codegen::program::FunctionId;
use crane_model::Wrench;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::results::KeyFigure;
use crane_model::rt::derivatives::Constant;
use crane_model::rt::lanes::Function;
use crane_model::sections::{StressedSection, stressed_sections};
use crane_model::tipping::{LinkCut, TippingLine, governing, lines, link_cuts};

use super::outputs::named;
use super::rest::{Rest, constants};
use super::source::Source;
use super::{Group, Output, Valued};
use crate::dual::Dual8;
use crate::machine::Number;

/// Largest difference of wrenches from those of the runtime, relative to the largest one: rounding of both leaves 1e-10.
const SAME: f64 = 1e-6;

/// Three components.
type Vector = [Dual8; 3];
/// Force and moment.
type Twin = [Vector; 2];

/// What governs at rest.
pub(super) struct Strength {
    /// The section that uses most of each beam.
    sections: Vec<StressedSection>,
    /// The section of all with the greatest utilisation, and that with the greatest stress.
    greatest: Option<[StressedSection; 2]>,
    /// The tipping line with the smallest margin.
    line: Option<TippingLine>,
    links: Vec<LinkCut>,
}

impl Strength {
    /// At the pose at rest; `None` if the internal forces there are not those of one set of forces in the loops.
    pub fn new(source: &mut Source<'_>, rest: &Rest, notes: &mut Vec<String>) -> Option<Self> {
        let crane: &dyn DynCrane = source.crane;
        let (description, still) = (crane.description(), vec![0.0; rest.q.len()]);
        let wrenches = crane.internal_forces_at(0.0, &rest.q, &still, &still);
        let own = wrenches_at(source, &constants(&rest.q), &constants(&rest.multipliers));
        if !are_close(&own, &wrenches) {
            notes.push(
                "stresses and tipping are left out: several cylinders hold one loop, and how they share its load is not determined"
                    .to_owned(),
            );
            return None;
        }
        let mut sections: Vec<StressedSection> = Vec::new();
        let all =
            stressed_sections(description, &crane.section_moduli_at(), &crane.section_places_at(&rest.q), &wrenches);
        let used = all.iter().copied().max_by(StressedSection::by_use);
        let stressed = all.iter().copied().max_by(StressedSection::by_stress);
        for section in all {
            let same = |known: &&mut StressedSection| known.beam(description) == section.beam(description);
            match sections.iter_mut().find(same) {
                Some(known) if StressedSection::by_use(known, &section).is_lt() => *known = section,
                Some(_) => {}
                None => sections.push(section),
            }
        }
        let lines = lines(crane, 0.0, &rest.q, &still, &still);
        let line = governing(&lines).copied().filter(|line| line.margin().is_finite());
        let links = if line.is_some() { link_cuts(crane) } else { Vec::new() };
        Some(Self { sections, greatest: used.zip(stressed).map(<[_; 2]>::from), line, links })
    }

    /// Stress and utilisation of every beam at its governing section, the largest of all, and the margin of the governing tipping line.
    pub fn outputs(&self, source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Valued> {
        let mut all = Vec::new();
        if self.sections.is_empty() && self.line.is_none() {
            return all;
        }
        let description = source.crane.description();
        let wrenches = wrenches_at(source, q, multipliers);
        let moduli = source.at(FunctionId::SectionModuli, q);
        let each = self.sections.iter().map(|section| (section, section.beam(description).to_owned() + "_", [true; 2]));
        let greatest = self.greatest.iter().flat_map(|[used, stressed]| {
            [(used, [true, false]), (stressed, [false, true])]
                .map(|(section, what)| (section, KeyFigure::GREATEST.to_owned(), what))
        });
        for (section, beam, [use_counts, stress_counts]) in greatest.chain(each) {
            let moduli: [Dual8; 8] = std::array::from_fn(|number| {
                let of = |section: usize| moduli[8 * section + number];
                section.place.moduli.mean(of, |one, other, part| one + Dual8::constant(part) * (other - one))
            });
            let stress = equivalent(&moduli, &wrenches[section.place.cut]);
            let named = |figure: KeyFigure| Output {
                place: section.location(description),
                ..named(format!("{beam}{}", figure.key), figure.unit, Group::Stresses)
            };
            if use_counts && section.utilisation.is_some() {
                all.push((named(KeyFigure::UTILISATION), stress / moduli[7]));
            }
            if stress_counts {
                all.push((named(KeyFigure::EQUIVALENT_STRESS), stress));
            }
        }
        if let Some(line) = &self.line {
            let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
            let margin = self.margin(source, line.feet, q, multipliers, wrenches);
            let KeyFigure { key, unit, .. } = KeyFigure::TIPPING_MARGIN;
            let output = Output { place: format!("{from} – {to}"), ..named(key, unit, Group::Tipping) };
            all.push((output, margin));
        }
        all
    }

    /// `1 − overturning / stabilising` about the line between two feet.
    fn margin(
        &self,
        source: &mut Source<'_>,
        feet: [usize; 2],
        q: &[Dual8],
        multipliers: &[Dual8],
        internal: Vec<Twin>,
    ) -> Dual8 {
        let external = without_internal(source, q, multipliers, internal);
        let frames = source.at(FunctionId::Transforms, q);
        let places = source.at(FunctionId::SupportPositions, q);
        let [from, to] = feet.map(|foot| [0, 1, 2].map(|axis| places[3 * foot + axis]));
        let beyond = |link: &LinkCut| -> Twin {
            let frame = &frames[16 * link.body..][..16];
            let turned =
                |v: &Vector| -> Vector { [0, 1, 2].map(|row| (0..3).map(|k| frame[4 * k + row] * v[k]).sum()) };
            let [force, moment] = &external[link.cut];
            let (force, moment) = (turned(force), turned(moment));
            let position = [12, 13, 14].map(|index| frame[index]);
            [force, sum(&moment, &cross(&position, &force))]
        };
        let all: Vec<Twin> = self.links.iter().map(beyond).collect();
        let along = difference(&to, &from);
        let length = dot(&along, &along).sqrt();
        let (mut stabilising, mut overturning) = (Dual8::splat(0.0), Dual8::splat(0.0));
        for (link, own) in self.links.iter().zip(&all) {
            let [force, moment] = link.carried.iter().fold(*own, |[force, moment], &carried| {
                [difference(&force, &all[carried][0]), difference(&moment, &all[carried][1])]
            });
            let held = -(dot(&along, &difference(&moment, &cross(&from, &force))) / length);
            if held.value() > 0.0 {
                stabilising = stabilising + held;
            } else {
                overturning = overturning - held;
            }
        }
        Dual8::splat(1.0) - overturning / stabilising
    }
}

/// The wrench at every cut, with what cylinders with a valve and loop joints transmit.
fn wrenches_at(source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Twin> {
    let mut wrenches = twins(&source.at(FunctionId::InternalForces, q));
    if source.crane.description().has_valves() {
        let pushes = pushes(source, q, multipliers);
        add(&mut wrenches, &pushes, &source.at(FunctionId::CylinderWrenches, q), |_| true);
    }
    if !multipliers.is_empty() {
        add(&mut wrenches, multipliers, &source.at(FunctionId::LoopWrenches, q), |_| true);
    }
    wrenches
}

/// The same without forces that are internal to the crane: cylinders with a valve, loop joints and connectors between two bodies.
fn without_internal(source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8], mut wrenches: Vec<Twin>) -> Vec<Twin> {
    let negative = |numbers: &[Dual8]| -> Vec<Dual8> { numbers.iter().map(|number| -*number).collect() };
    let crane = source.crane;
    if crane.description().has_valves() {
        let pushes = negative(&pushes(source, q, multipliers));
        add(&mut wrenches, &pushes, &source.at(FunctionId::CylinderWrenches, q), |_| true);
    }
    if !multipliers.is_empty() {
        let joints = crane.loop_joints().iter();
        let holds: Vec<bool> =
            joints.flat_map(|joint| std::iter::repeat_n(joint.holds_to_world(), joint.equations.len())).collect();
        let rows = source.at(FunctionId::LoopWrenches, q);
        add(&mut wrenches, &negative(multipliers), &rows, |equation| !holds[equation]);
    }
    let tensions = source.at(FunctionId::ConnectorTensions, q);
    let forces: Vec<Dual8> = tensions.chunks_exact(3).map(|tension| -tension[0]).collect();
    if !forces.is_empty() {
        add(&mut wrenches, &forces, &source.at(FunctionId::ConnectorWrenches, q), |_| true);
    }
    wrenches
}

/// Forces with which cylinders with a valve push at rest, N; 0 for others: `((Jᵀ λ)_j − e_j − f_j)/(∂ℓ/∂q_j)`.
fn pushes(source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Dual8> {
    let description = source.crane.description();
    let resisted = source.generalized(q, multipliers);
    let [bias, forces, states] =
        [FunctionId::Bias, FunctionId::Forces, FunctionId::CylinderStates].map(|id| source.at(id, q));
    let cylinders = description.cylinders.iter().zip(states.chunks_exact(3));
    let push = |(cylinder, state): (&crane_model::CylinderInfo, &[Dual8])| {
        let j = description.drives[cylinder.drive].coordinate;
        let is_moved = cylinder.valve.is_some();
        if is_moved { (resisted[j] - bias[j] - forces[j]) / state[2] } else { Dual8::splat(0.0) }
    };
    cylinders.map(push).collect()
}

/// Adds forces times the wrenches that each of them causes at the cuts.
fn add(sums: &mut [Twin], forces: &[Dual8], rows: &[Dual8], counts: impl Fn(usize) -> bool) {
    for ((index, force), own) in forces.iter().enumerate().zip(rows.chunks_exact(6 * sums.len().max(1))) {
        // A cylinder without a valve may have a linkage that does not reach.
        if force.is_zero() || !counts(index) {
            continue;
        }
        for (total, wrench) in sums.iter_mut().zip(twins(own)) {
            *total = std::array::from_fn(|part| sum(&total[part], &wrench[part].map(|component| *force * component)));
        }
    }
}

/// Von Mises' equivalent stress of a section, `√(σ² + 3 (τ_Q + τ_M)²)`.
fn equivalent(moduli: &[Dual8], [force, moment]: &Twin) -> Dual8 {
    let [area, bending_y, bending_z, torsion, shear_y, shear_z, corners] = std::array::from_fn(|index| moduli[index]);
    let (about_y, about_z) = ((moment[1] / bending_y).abs(), (moment[2] / bending_z).abs());
    let bending = if corners.value() > 0.5 { about_y + about_z } else { about_y.hypot(about_z) };
    let normal = (force[0] / area).abs() + bending;
    let shear = (force[1] / shear_y).hypot(force[2] / shear_z) + (moment[0] / torsion).abs();
    normal.hypot(shear * 3.0_f64.sqrt())
}

/// Whether wrenches are those of the runtime.
fn are_close(own: &[Twin], wrenches: &[Wrench]) -> bool {
    let both = own.iter().zip(wrenches).map(|([force, moment], wrench)| {
        let components = |own: &Vector, other: &crane_model::nalgebra::Vector3<f64>| -> [[f64; 2]; 3] {
            std::array::from_fn(|axis| [own[axis].value(), other[axis]])
        };
        [components(force, &wrench.force), components(moment, &wrench.moment)]
    });
    let (mut size, mut off) = ([0.0_f64; 2], [0.0_f64; 2]);
    for parts in both {
        for (part, components) in parts.iter().enumerate() {
            for [own, other] in components {
                size[part] = size[part].max(other.abs());
                off[part] = off[part].max((own - other).abs());
            }
        }
    }
    (0..2).all(|part| off[part] <= SAME * size[part])
}

fn twins(numbers: &[Dual8]) -> Vec<Twin> {
    numbers.chunks_exact(6).map(|six| [[six[0], six[1], six[2]], [six[3], six[4], six[5]]]).collect()
}

fn sum(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn difference(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: &Vector, b: &Vector) -> Dual8 {
    a.iter().zip(b).map(|(a, b)| *a * *b).sum()
}

fn cross(&[a, b, c]: &Vector, &[x, y, z]: &Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}
