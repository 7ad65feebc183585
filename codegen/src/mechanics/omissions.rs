//! Parts of the model that a crane does not need, which are therefore not derived.

use super::forces::Kind;
use super::kinematics::{Generator, Kinematics};
use super::model::Model;
use super::vector::Vec3;
use crate::chain::{Analyses, Chain, CoordinateKind};
use crate::symbolic::{Expr, Graph};

/// The parts that the crane does not need, and why.
#[must_use]
pub fn left_out(chain: &Chain, analyses: Analyses) -> Vec<(&'static str, &'static str)> {
    let mut rows = Vec::new();
    let mut out = |condition: bool, what: &'static str, why: &'static str| {
        if condition {
            rows.push((what, why));
        }
    };
    out(chain.base.iter().all(Option::is_none), "coordinates of the base", "the base is fixed");
    let absent = chain.base.iter().filter(|c| c.is_none()).count();
    out((1..6).contains(&absent), "some coordinates of the base", "the base moves only as the spec says");
    for kind in Kind::ALL {
        let (what, why) = kind.row().absent;
        out(!kind.is_in(chain), what, why);
    }
    out(chain.points.is_empty(), "points of interest", "the spec has none");
    out(chain.parameters.is_empty(), "live parameters", "the spec has none: all numbers are compiled in");
    out(
        planar(chain),
        "everything out of the crane's plane",
        "all joints rotate about one direction, none translates along it",
    );
    out(!analyses.statics, "static residual and tangent stiffness", "`analyses` does not include statics");
    out(!analyses.dynamics, "mass matrix, bias and kinetic energy", "`analyses` does not include dynamics");
    out(!analyses.modes, "linearisation", "`analyses` does not include modes");
    out(!analyses.internal_forces, "internal forces", "`analyses` does not include internal_forces");
    out(!analyses.derivatives, "∂T/∂q and ∂²T/∂q∂q", "`analyses` does not include derivatives");
    rows
}

/// Whether the chain moves in a plane: all rotations are about one fixed direction of the world, and all translations are normal to it.
fn planar(chain: &Chain) -> bool {
    let graph = Graph::simplifying();
    let kinematics = Kinematics::new(&Model::new(&graph, chain));
    let rotations = kinematics.generators.iter().filter(|g| g.kind == CoordinateKind::Rotation);
    let mut axes = rotations.map(|g| g.omega.0.map(Expr::as_constant));
    let Some(first) = axes.next() else { return false };
    let opposite = first.map(|x| x.map(|x| -x));
    let normal = first.map(|x| x.map(|x| graph.constant(x)));
    let [Some(x), Some(y), Some(z)] = normal else { return false };
    let within = |g: &Generator<'_>| g.upsilon.dot(Vec3([x, y, z])).is_zero();
    let translations = kinematics.generators.iter().filter(|g| g.kind == CoordinateKind::Translation);
    axes.all(|axis| axis == first || axis == opposite) && translations.into_iter().all(within)
}
