//! The model: from a chain to a program, one equation per function.
//!
//! This is the only module that knows both the chain and the graph. Equation numbers are those of A. Urbaś, *Computational
//! implementation of the rigid finite element method in the statics and dynamics analysis of forest cranes*, Applied
//! Mathematical Modelling, 2016; `docs/EQUATIONS.md` explains where we deviate from it.

mod acts;
mod articulated;
mod axis_rotation;
mod beam_axis;
mod columns;
mod connectors;
mod contact;
mod cylinders;
mod drives;
mod effective_mass;
mod elements;
mod energy;
mod factors;
mod forces;
mod forward;
mod functions;
mod gravity;
mod inertia;
mod kinds;
mod kinematics;
mod laws;
mod loads;
mod loop_joints;
mod mass_factors;
mod model;
mod motion_derivatives;
mod newton_euler;
mod omissions;
mod outward;
mod pads;
mod place;
mod points;
mod power_limits;
mod profile;
mod rotation_vector;
mod rotors;
mod saturation;
mod strains;
mod supports;
mod tangent;
#[cfg(test)]
mod tests;
mod transforms;
mod turning;
mod twist;
mod vector;

pub use omissions::left_out;

use crate::chain::{Analyses, Chain};
use crate::program::{Part, Program};
use crate::symbolic::Graph;

/// The functions of a crane that `analyses` request and that the crane needs, over one simplified graph.
#[must_use]
pub fn derive(chain: &Chain, analyses: Analyses) -> Program {
    functions::program(Graph::simplifying(), chain, analyses)
}

/// The same without simplification, to measure its effect.
#[must_use]
pub fn derive_verbatim(chain: &Chain, analyses: Analyses) -> Program {
    functions::program(Graph::verbatim(), chain, analyses)
}

/// The functions of a part that the crane needs, over one simplified graph.
#[must_use]
pub fn derive_part(chain: &Chain, part: Part) -> Program {
    functions::part(Graph::simplifying(), chain, part)
}
