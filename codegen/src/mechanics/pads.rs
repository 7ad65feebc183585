//! Pads on which beams slide.
//!
//! Notation
//! : p the pad, n the direction in which it holds, fixed to its body; P(s) and P′(s) the [axis of the beam](super::beam_axis) and its
//!   direction at the pad, `s = s₀ ± q_k`; y(s) the axis across the beam, z that of the pad's body.
//!
//! ```text
//! along n     ℓ = n · (P − p)     J_j = n · (∂P/∂q_j − Ω_j P)              J_k has also  ± n · P′
//! twist       ℓ = z · y           J_j = z · ∂y/∂q_j + (ω_j × z) · y        J_k has also  ± z · y′
//! ```
//!
//! The first part counts if j moves the beam, the second if it moves the pad; if j moves both as one body, ℓ does not change. A tension of
//! 1 N pulls the pad with n at P, and the beam with −n there; in twist, a moment `y × z` turns the pad, and its opposite the beam. A pad is frictionless: no force acts on what slides except through the directions of n.

use super::beam_axis::AxisPoint;
use super::kinematics::Kinematics;
use super::model::Model;
use super::place::{Along, Place, Pull};
use super::strains::point;
use super::vector::{Rotation, Vec3};
use crate::chain::{Axis, BodyId, CoordinateId, PadDirection, Sliding};
use crate::symbolic::Expr;

/// A beam at a pad.
pub struct AtPad<'g> {
    /// ℓ, m or rad.
    pub length: Expr<'g>,
    /// Indices and values of the entries of J.
    pub jacobian: Vec<(usize, Expr<'g>)>,
    /// What a tension of 1 N exerts on bodies.
    pub pulls: Vec<(Place<'g>, Pull<'g>)>,
}

/// A direction at a pad: ℓ, and what changes it.
struct Measured<'g> {
    length: Expr<'g>,
    /// ∂ℓ/∂s
    by_place: Expr<'g>,
    /// `∂ℓ/∂q_j` of the coordinates that move the beam.
    by_beam: Vec<(usize, Expr<'g>)>,
    /// `∂ℓ/∂q_j` of those that move the pad.
    by_pad: Vec<(usize, Expr<'g>)>,
    on_pad: Pull<'g>,
    on_beam: Pull<'g>,
}

impl<'g> AtPad<'g> {
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, sliding: &Sliding) -> Self {
        let CoordinateId(slid) = sliding.coordinate;
        let (sign, s) = place(model, sliding);
        let Measured { length, by_place, by_beam, by_pad, on_pad, on_beam } = match sliding.direction {
            PadDirection::Along(axis) => along(model, kinematics, sliding, (axis, s)),
            PadDirection::Twist => twist(model, kinematics, sliding, s),
        };
        let of_both = {
            let (of_pad, of_beam) = (model.chain.reach(&sliding.pad), model.chain.coordinates_of(sliding.beam.first));
            move |j: usize| of_pad.contains(&CoordinateId(j)) && of_beam.contains(&CoordinateId(j))
        };
        let mut jacobian = model.zeros();
        for (j, slope) in by_beam.into_iter().chain(by_pad).filter(|(j, _)| !of_both(*j)) {
            jacobian[j] = jacobian[j] + slope;
        }
        jacobian[slid] = jacobian[slid] + sign * by_place;
        let changing = model.chain.changing_at(sliding).into_iter();
        let jacobian = changing.map(|CoordinateId(j)| (j, jacobian[j])).collect();
        let fixed = || Along::Fixed(sliding.pad.position[0].clone());
        let of_pad = sliding.pad.body.map(|body| (Place { body, along: fixed() }, on_pad));
        let here = AxisPoint::new(model, kinematics, &sliding.beam, s).here();
        let on = place_on_beam(model, sliding);
        let of_beam = sliding
            .beam
            .elements()
            .zip(here)
            .map(|(body, here)| (Place { body, along: Along::Pad(on) }, on_beam.times(here)));
        AtPad { length, jacobian, pulls: of_pad.into_iter().chain(of_beam).collect() }
    }
}

/// The derivative of s by the coordinate along which the beam slides, and s, m.
pub fn place<'g>(model: &Model<'g>, sliding: &Sliding) -> (f64, Expr<'g>) {
    let CoordinateId(slid) = sliding.coordinate;
    let sign = if sliding.grows { 1.0 } else { -1.0 };
    (sign, model.number(&sliding.start) + sign * model.q[slid])
}

/// Where on the beam the pad acts, m: at s, and at the end of a beam that has left it.
pub fn place_on_beam<'g>(model: &Model<'g>, sliding: &Sliding) -> Expr<'g> {
    let (_, s) = place(model, sliding);
    s.clamp(model.zero(), model.number(&sliding.beam.length))
}

/// The axes of the body that carries a pad.
fn axes<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, sliding: &Sliding) -> Rotation<'g> {
    sliding.pad.body.map_or(Rotation::identity(model.graph), |BodyId(body)| kinematics.poses[body].rotation)
}

fn along<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    sliding: &Sliding,
    (axis, s): (Axis, Expr<'g>),
) -> Measured<'g> {
    let beam = AxisPoint::new(model, kinematics, &sliding.beam, s);
    let (normal, position) = (axes(model, kinematics, sliding).axis(axis), beam.position());
    let of_pad = model.chain.reach(&sliding.pad).into_iter();
    Measured {
        length: normal.dot(position - point(model, kinematics, &sliding.pad)),
        by_place: normal.dot(beam.direction()),
        by_beam: beam.position_slopes().into_iter().map(|(j, slope)| (j, normal.dot(slope))).collect(),
        by_pad: of_pad.map(|CoordinateId(j)| (j, -normal.dot(kinematics.generators[j].velocity(position)))).collect(),
        on_pad: Pull::of_force(position, normal),
        on_beam: Pull::of_force(position, -normal),
    }
}

fn twist<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, sliding: &Sliding, s: Expr<'g>) -> Measured<'g> {
    let beam = AxisPoint::new(model, kinematics, &sliding.beam, s);
    let z = axes(model, kinematics, sliding).axis(Axis::Z);
    let y = beam.cross_axis(Axis::Y);
    let of_pad = model.chain.reach(&sliding.pad).into_iter();
    let turned = |moment: Vec3<'g>| Pull {
        point: Vec3::zero(model.graph),
        force: Vec3::zero(model.graph),
        moment: Some(moment),
    };
    // At any s, to be differentiated.
    let [free, _] = model.free_symbols();
    let anywhere = z.dot(AxisPoint::new(model, kinematics, &sliding.beam, free).cross_axis(Axis::Y));
    let slope = model.graph.derivatives(&[anywhere], free)[0];
    Measured {
        length: z.dot(y),
        by_place: model.graph.substitute(slope, &[(free, s)]),
        by_beam: beam.cross_axis_slopes(Axis::Y).into_iter().map(|(j, slope)| (j, z.dot(slope))).collect(),
        by_pad: of_pad.map(|CoordinateId(j)| (j, kinematics.generators[j].omega.dot(z.cross(y)))).collect(),
        on_pad: turned(y.cross(z)),
        on_beam: turned(z.cross(y)),
    }
}
