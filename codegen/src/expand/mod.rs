//! Formulas by which links become bodies: placements to steps, mass properties to pseudo-inertias, cross-sections to
//! stiffnesses, flexible links to rigid finite elements, tables to cubic pieces. Nothing here can fail;
//! [`validate`](crate::validate()) has checked the input.

pub(crate) mod beam;
pub(crate) mod curve;
pub(crate) mod inertia;
pub(crate) mod placement;
pub(crate) mod section;
