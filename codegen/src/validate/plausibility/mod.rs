//! Plausibility: numbers that no rule refuses, but that look like a non-SI unit or a slip.
//!
//! The checks run on a crane without mistakes, at the default values of its parameters or at others. Each finding is a
//! warning: the crane is compiled as it is written.

mod angles;
mod beams;
mod connectors;
mod drives;
mod feet;
mod friction;
mod hydraulics;
mod joints;
mod lengths;
mod loops;
mod masses;
mod proportions;
mod telescopes;
mod usual;

pub(super) use usual::Judged;

use crate::chain::Chain;
use crate::diagnostic::{Mistake, Span};
use crate::spec::{Crane, Number, Parameter, Scalar, Spanned};

/// Warnings about a crane without mistakes, with these values of its parameters.
pub(super) fn warnings(crane: &Crane, chain: &Chain, values: Vec<f64>, judged: &[Judged]) -> Vec<Mistake> {
    let mut plausibility = Plausibility { crane, chain, values, warnings: Vec::new() };
    plausibility.usual(judged);
    plausibility.beams();
    plausibility.lengths();
    plausibility.hydraulics();
    plausibility.bristles();
    plausibility.slow_drives();
    plausibility.places_of_feet();
    plausibility.couplings();
    plausibility.overlaps();
    plausibility.pads();
    plausibility.efforts();
    if plausibility.warnings.is_empty() {
        plausibility.far_feet();
        plausibility.far_slides();
        plausibility.large_shapes();
        plausibility.slender_cylinders();
        plausibility.slow_dampers();
        plausibility.aside();
        plausibility.late();
    }
    // Consequences of such numbers, such as frequencies and masses, would be reported as well.
    if plausibility.warnings.is_empty() {
        plausibility.loops();
        plausibility.damping();
        plausibility.masses();
        plausibility.base();
        plausibility.swept_booms();
        // With a wrong mass, an inertia is out of proportion and its weight overcomes drives as well.
        if plausibility.warnings.is_empty() {
            plausibility.spread();
            plausibility.soft_drives();
        }
        plausibility.connectors();
    }
    plausibility.angles();
    plausibility.warnings
}

/// The state of the check: the crane as written, and as validated.
struct Plausibility<'a> {
    crane: &'a Crane,
    chain: &'a Chain,
    /// Values of the parameters at which the numbers are checked.
    values: Vec<f64>,
    warnings: Vec<Mistake>,
}

impl<'a> Plausibility<'a> {
    fn warn(&mut self, warning: Mistake) {
        self.warnings.push(warning);
    }

    /// A number, and its location.
    fn number(&self, given: &Spanned<Number>) -> (f64, Span) {
        (given.value.as_ref().map_or(f64::NAN, |number| self.scalar(&number.0)), given.span)
    }

    fn scalar(&self, scalar: &Scalar) -> f64 {
        match scalar {
            Scalar::Name(name) => self.value(name).unwrap_or(f64::NAN),
            written => written.number().unwrap_or(f64::NAN),
        }
    }

    /// Value of a parameter.
    fn value(&self, name: &str) -> Option<f64> {
        let index = self.chain.parameters.iter().position(|parameter| parameter.name == name)?;
        self.values.get(index).copied()
    }

    /// Whether a parameter has a value other than in the spec.
    fn set(&self, name: &str) -> bool {
        let parameter = self.chain.parameters.iter().find(|parameter| parameter.name == name);
        parameter.is_some_and(|parameter| self.value(name) != Some(parameter.default))
    }

    /// The scalar under `value` of a parameter.
    fn parameter(&self, name: &str) -> Option<&'a Scalar> {
        let entries = &self.crane.parameters.as_ref()?.value.as_ref()?.0;
        let named = entries.iter().find(|(known, _)| known.value.as_deref() == Some(name));
        let Parameter { value, .. } = named?.1.value.as_ref()?;
        value.value.as_ref().map(|value| &value.0)
    }
}

/// A number as a person would write it, to four digits.
pub(super) fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}
