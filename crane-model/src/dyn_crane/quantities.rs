//! Quantities of a crane as owned lists and matrices, for cranes chosen at run time.

use crane_quantities::Count;
use nalgebra::{DMatrix, DVector, Matrix4, Vector3};

use super::{DynCrane, Functions};
use crate::{CoordinateKind, CoordinateRole, Description, SectionModuli, Tree};

/// Energies of a crane, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Kinetic energy, Eq. (4).
    pub kinetic: f64,
    /// Potential energy of gravity, Eq. (6).
    pub gravity: f64,
    /// Springs of the supports, Eq. (17).
    pub supports: f64,
    /// Springs between rigid elements, Eq. (14).
    pub elements: f64,
    /// Springs of the drives, Eq. (19).
    pub drives: f64,
    /// End stops.
    pub stops: f64,
    /// Springs, gas springs and ropes between two points.
    pub connectors: f64,
}

impl Energies {
    /// Names and values of the parts that a crane has. The columns of results are called `<name>_energy`.
    pub fn parts(&self, description: &Description) -> impl Iterator<Item = (&'static str, f64)> {
        let parts = [
            ("kinetic", self.kinetic, true),
            ("gravity", self.gravity, true),
            ("support", self.supports, true),
            ("element", self.elements, true),
            ("drive", self.drives, true),
            ("stop", self.stops, !description.stops.is_empty()),
            ("connector", self.connectors, !description.connectors.is_empty()),
        ];
        parts.into_iter().filter(|(.., has)| *has).map(|(name, value, _)| (name, value))
    }

    /// Kinetic and potential energy together.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.supports + self.elements + self.drives + self.stops + self.connectors
    }
}

/// Numbers per coordinate, written by `write`.
fn numbers(crane: &dyn DynCrane, write: impl FnOnce(&mut [f64])) -> Vec<f64> {
    let mut out = vec![0.0; crane.size()];
    write(&mut out);
    out
}

/// Stiffness of every drive at rest in a pose, N m/rad or N/m; 0 for rigid drives and for drives beyond their limit.
pub(crate) fn drive_stiffness(crane: &dyn Functions, q: &[f64]) -> Vec<f64> {
    let drives = &crane.description().drives;
    let (mut linear, mut limits) = (vec![[0.0; 2]; q.len()], vec![[0.0; 2]; drives.len()]);
    crane.joint_stiffness_and_damping(&mut linear);
    crane.drive_limits(0.0, q, &vec![0.0; q.len()], &mut limits);
    // The stiffness of a drive with a limit is not among the linear ones.
    drives.iter().zip(limits).map(|(drive, [_, limited])| linear[drive.coordinate][0].max(limited)).collect()
}

/// # Panics
/// If `q`, `v` or a start does not have as many numbers as the crane has coordinates.
impl dyn DynCrane + '_ {
    /// What the bodies are attached to.
    pub fn tree(&self) -> Tree {
        Tree::new(self.description(), self.parents())
    }

    /// Transforms of all bodies into the world frame.
    pub fn transforms_at(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let mut out = vec![Matrix4::identity(); self.description().bodies.len()];
        self.transforms(q, &mut out);
        out
    }

    /// Mass matrix A.
    pub fn mass_matrix_at(&self, q: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.size(), self.size());
        self.mass_matrix(q, out.as_mut_slice());
        out
    }

    /// Velocity and gravity forces e.
    pub fn bias_at(&self, q: &[f64], v: &[f64]) -> DVector<f64> {
        numbers(self, |out| self.bias(q, v, out)).into()
    }

    /// Maximum efforts of the drives, N m and N; `None` where there is no limit.
    pub fn drive_limits_at(&self) -> Vec<Option<f64>> {
        let mut out = vec![[0.0; 2]; self.description().drives.len()];
        let state = vec![0.0; self.size()];
        self.drive_limits(0.0, &state, &state, &mut out);
        out.into_iter().map(|[limit, _]| (limit > 0.0).then_some(limit)).collect()
    }

    /// Prescribed positions, one per drive. [`drive_positions_at`](super::Functions::drive_positions_at) has them by coordinate, as functions take them.
    pub fn drive_targets_at(&self, t: f64) -> Vec<f64> {
        self.drive_motions_at(t).into_iter().map(|[position, _]| position).collect()
    }

    /// Positions of the supports' attachment points, m.
    pub fn support_positions_at(&self, q: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().supports.len()];
        self.support_positions(q, &mut out);
        out
    }

    /// Mass (kg) and length (m) of every body.
    pub fn body_sizes_at(&self) -> Vec<[f64; 2]> {
        let mut out = vec![[0.0; 2]; self.description().bodies.len()];
        self.body_sizes(&mut out);
        out
    }

    /// Mass of the crane with its load, kg.
    pub fn mass(&self) -> f64 {
        self.body_sizes_at().iter().map(|[mass, _]| mass).sum()
    }

    /// Where every support is attached, in the frame of the base, m.
    pub fn support_places_at(&self) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().supports.len()];
        self.support_places(&mut out);
        out
    }

    /// The points of all connectors, then both ends of all joints that close loops, in the frames of their bodies, m.
    pub fn attachments_at(&self) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.count(Count::Attachments)];
        self.attachments(&mut out);
        out
    }

    /// Distances of all sections from the beginning of their beams, m.
    pub fn section_places_at(&self, q: &[f64]) -> Vec<f64> {
        let mut out = vec![[0.0; 2]; self.description().sections.len()];
        self.section_places(q, &mut out);
        out.into_iter().map(|[x, _]| x).collect()
    }

    /// Where a section is in words, in any pose: one that slides has no distance.
    pub fn section_location(&self, section: usize) -> String {
        let description = self.description();
        let x =
            (!description.sections[section].slides).then(|| self.section_places_at(&vec![0.0; self.size()])[section]);
        crate::sections::location(description, section, x)
    }

    /// Section moduli for stresses of beams, as [`Description::sections`](crate::Description::sections) lists the sections.
    pub fn section_moduli_at(&self) -> Vec<SectionModuli> {
        let mut out = vec![SectionModuli::ZERO; self.description().sections.len()];
        self.section_moduli(&mut out);
        out
    }

    /// Weight of the crane with its load, world frame, N; unknown along an axis that the base cannot move along.
    pub fn weight_at(&self, q: &[f64]) -> [Option<f64>; 3] {
        self.force_on_the_whole(q, self.bias_at(q, &vec![0.0; q.len()]).as_slice())
    }

    /// Sum of the forces of loads, and of connectors attached to the world, on the crane at rest at time `t`, world frame, N; unknown
    /// along an axis that the base cannot move along.
    pub fn applied_force_at(&self, t: f64, q: &[f64]) -> [Option<f64>; 3] {
        // What the residual contains besides weight, drives and supports; beams and stops act between parts of the crane.
        let (positions, rest) = (self.drive_positions_at(t), vec![0.0; q.len()]);
        let vector = |write: &dyn Fn(&mut [f64])| DVector::from(numbers(self, write));
        let known = self.bias_at(q, &rest)
            + vector(&|out| self.drive_forces_at_rest(t, q, &positions, out))
            + vector(&|out| self.static_residual(t, q, &positions, out));
        let reactions: Vector3<f64> = self.support_reactions_at(q, &rest).iter().sum();
        let with_supports = self.force_on_the_whole(q, (-known).as_slice());
        [0, 1, 2].map(|axis| with_supports[axis].map(|force| force - reactions[axis]))
    }

    /// The force whose generalized forces are given: a translation of the base moves everything equally, so its generalized force is
    /// the component of the force along it. Unknown along an axis that the base cannot move along.
    fn force_on_the_whole(&self, q: &[f64], forces: &[f64]) -> [Option<f64>; 3] {
        /// A base moves along an axis if its directions contain the axis, up to rounding.
        const ROUNDING: f64 = 1e-9;
        let place = |q: &[f64]| self.transforms_at(q).first().map(|frame| frame.fixed_view::<3, 1>(0, 3).into_owned());
        let Some(here) = place(q) else { return [None; 3] };
        let (mut total, mut held) = (Vector3::zeros(), Vector3::zeros());
        for (index, (coordinate, force)) in self.description().coordinates.iter().zip(forces).enumerate() {
            if (coordinate.role, coordinate.kind) == (CoordinateRole::Base, CoordinateKind::Translation) {
                let mut moved = q.to_vec();
                moved[index] += 1.0;
                let direction = place(&moved).unwrap_or(here) - here;
                total += direction * *force;
                held += direction.component_mul(&direction);
            }
        }
        [0, 1, 2].map(|axis| (held[axis] > 1.0 - ROUNDING).then_some(total[axis]))
    }
}

/// The derivatives as owned lists.
///
/// # Panics
/// If `q` does not have as many numbers as the crane has coordinates.
impl dyn DynCrane + '_ {
    /// `∂T/∂q_j`, body by body, for the coordinates j that move it.
    pub fn transform_derivatives_at(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let count = self.description().bodies.iter().map(|body| body.degrees_of_freedom).sum();
        let mut out = vec![Matrix4::zeros(); count];
        self.transform_derivatives(q, &mut out);
        out
    }

    /// `∂²T/∂q_m∂q_n`, body by body, for the pairs m ≤ n of the coordinates that move it.
    pub fn transform_second_derivatives_at(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let pairs = |n: usize| n * (n + 1) / 2;
        let count = self.description().bodies.iter().map(|body| pairs(body.degrees_of_freedom)).sum();
        let mut out = vec![Matrix4::zeros(); count];
        self.transform_second_derivatives(q, &mut out);
        out
    }
}
