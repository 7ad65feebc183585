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
//!
//! A torque M that enters at a pad makes that of the beam jump within a section. Its spring twists by the mean, and the beam at the pad further by
//! `M c`, with `c = τ (1 − τ)/k` of the [section](super::beam_axis) with the spring k against twist: a [compliance in series](Series) with the pad.

use std::collections::BTreeMap;

use super::beam_axis::AxisPoint;
use super::kinematics::{Generator, Kinematics};
use super::model::Model;
use super::place::{Along, Place, Pull};
use super::strains::point;
use super::vector::{Rotation, SymmetricMatrix, Vec3};
use crate::chain::{Axis, BodyId, CoordinateId, Group, PadDirection, Sliding, Spring, twist_springs};
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

/// A compliance in series with a force: where a pad against twist is within a section, what the mean of the torque leaves out.
#[derive(Clone, Copy)]
pub struct Series<'g> {
    /// c, rad/(N m).
    pub compliance: Expr<'g>,
    /// `Σ c_k β_k` of the sections, β their damping over their stiffness, rad s/(N m).
    pub viscous: Expr<'g>,
    /// The coordinate on which c depends, with `∂c/∂q_k` and `∂²c/∂q_k²`.
    pub by: (usize, [Expr<'g>; 2]),
}

impl<'g> Series<'g> {
    /// At a pad against twist of a beam that can twist.
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, sliding: &Sliding) -> Option<Self> {
        let springs: Vec<_> = match sliding.direction {
            PadDirection::Along(_) => return None,
            PadDirection::Twist => {
                twist_springs(model.chain.forces_of_group(Group::Elements), &model.chain.coordinates, &sliding.beam)
                    .collect()
            }
        };
        if springs.is_empty() {
            return None;
        }
        let soft = |spring: &Spring| 1.0 / model.number(&spring.stiffness);
        let compliance = |s| {
            let beam = AxisPoint::new(model, kinematics, &sliding.beam, s);
            beam.within_sections(springs.iter().map(|spring| soft(spring)))
        };
        let (sign, s) = place(model, sliding);
        // At any s, to be differentiated.
        let [free, _] = model.free_symbols();
        let slope = model.graph.derivatives(&[compliance(free)], free)[0];
        let bend = model.graph.derivatives(&[slope], free)[0];
        let here = |expression| model.graph.substitute(expression, &[(free, s)]);
        let viscous = springs.iter().map(|spring| model.number(&spring.damping) * soft(spring).squared());
        Some(Series {
            compliance: compliance(s),
            viscous: AxisPoint::new(model, kinematics, &sliding.beam, s).within_sections(viscous),
            by: (sliding.coordinate.0, [sign * here(slope), here(bend)]),
        })
    }

    /// What exceeds the compliance of a spring, which already contains the rest.
    pub fn beyond(self, model: &Model<'g>, spring: &Spring) -> Self {
        let soft = 1.0 / model.number(&spring.stiffness);
        let (zero, more) = (model.zero(), self.compliance - soft);
        let viscous = self.viscous - model.number(&spring.damping) * soft.squared();
        let (coordinate, slopes) = self.by;
        Series {
            compliance: more.max(zero),
            viscous: viscous.max(zero),
            by: (coordinate, slopes.map(|slope| more.select(slope, zero))),
        }
    }
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
        let movers = Movers::new(model, sliding);
        let mut jacobian = model.zeros();
        for (j, slope) in by_beam.into_iter().chain(by_pad).filter(|(j, _)| !movers.as_one(CoordinateId(*j))) {
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

/// A point or direction of a beam at a pad, and a direction of the pad, whose product is ℓ except for a constant of the pad.
struct Product<'g> {
    /// n or z.
    of_pad: Vec3<'g>,
    /// Whether what is measured is a point: then a motion of the pad moves it, else it only turns it.
    is_point: bool,
    /// P or y.
    value: Vec3<'g>,
    /// `∂P/∂q_j` or `∂y/∂q_j`.
    slopes: BTreeMap<usize, Vec3<'g>>,
    /// P′ or y′, and its slopes.
    by_place: (Vec3<'g>, BTreeMap<usize, Vec3<'g>>),
    /// P″, or none.
    bend: Option<Vec3<'g>>,
    /// `Σ_{k ≥ m} c_k x̂_k` or `Σ_{k ≥ m} e_k y_k`.
    beyond: Vec<Vec3<'g>>,
}

impl<'g> Product<'g> {
    fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, sliding: &Sliding) -> Self {
        let (_, s) = place(model, sliding);
        let beam = AxisPoint::new(model, kinematics, &sliding.beam, s);
        let axes = axes(model, kinematics, sliding);
        match sliding.direction {
            PadDirection::Along(axis) => Product {
                of_pad: axes.axis(axis),
                is_point: true,
                value: beam.position(),
                slopes: beam.position_slopes(),
                by_place: (beam.direction(), beam.cross_axis_slopes(Axis::X)),
                bend: Some(beam.turning_slopes(Axis::X).0),
                beyond: beam.ways_beyond(),
            },
            PadDirection::Twist => Product {
                of_pad: axes.axis(Axis::Z),
                is_point: false,
                value: beam.cross_axis(Axis::Y),
                slopes: beam.cross_axis_slopes(Axis::Y),
                by_place: beam.turning_slopes(Axis::Y),
                bend: None,
                beyond: beam.axis_beyond(Axis::Y, false),
            },
        }
    }

    /// What a generator makes of the value if it moves all of the beam.
    fn moved(&self, generator: &Generator<'g>) -> Vec3<'g> {
        if self.is_point { generator.velocity(self.value) } else { generator.rotate(self.value) }
    }
}

/// Adds `F ∂²ℓ/∂q∂q`. With `b_j = ∂P/∂q_j` and `D_j = b_j − Ω_j P`, where the first counts if j moves the beam and the second if it moves the
/// pad, and i ≤ j:
///
/// ```text
/// ∂²ℓ/∂q_i∂q_j = ± ω_i · (b_j × n) − D_i · (n × ω_j)       + if i moves the beam, − if the pad; the second if j moves the pad
/// ∂²ℓ/∂q_i∂q_k has also  ± (n · ∂P′/∂q_i − ω_i · (P′ × n)),    ∂²ℓ/∂q_k² twice that, and n · P″
/// ```
///
/// and the same in twist with z, y and y′ in place of n, P and P′; y″ is zero.
pub fn add_curvature<'g>(
    (model, kinematics): (&Model<'g>, &Kinematics<'g>),
    sliding: &Sliding,
    tension: Expr<'g>,
    matrix: &mut SymmetricMatrix<'g>,
) {
    let product = Product::new(model, kinematics, sliding);
    let (normal, (by_place, by_place_slopes)) = (tension * product.of_pad, &product.by_place);
    let both = Movers::new(model, sliding);
    let zero = Vec3::zero(model.graph);
    let relative = |CoordinateId(j): CoordinateId| {
        let (beam, pad) = (both.beam(j), both.pad(j));
        let of_beam = if beam { product.slopes[&j] } else { zero };
        let of_pad = if pad { product.moved(&kinematics.generators[j]) } else { zero };
        (j, [beam, pad], of_beam, of_beam - of_pad)
    };
    let changing: Vec<_> = model.chain.changing_at(sliding).into_iter().map(relative).collect();
    for (at, (j, [on_beam, on_pad], of_beam, _)) in changing.iter().enumerate() {
        let (turning, turned) = (of_beam.cross(normal), normal.cross(kinematics.generators[*j].omega));
        for (i, [other_on_beam, other_on_pad], _, relative) in &changing[..=at] {
            let mut second = model.zero();
            if *on_beam && other_on_beam != other_on_pad {
                let work = kinematics.generators[*i].omega.dot(turning);
                second = if *other_on_beam { work } else { -work };
            }
            if *on_pad {
                second = second - relative.dot(turned);
            }
            matrix.add(*i, *j, second);
        }
    }
    let (sign, k) = (if sliding.grows { 1.0 } else { -1.0 }, sliding.coordinate.0);
    let turning = by_place.cross(normal);
    for &(i, [on_beam, on_pad], ..) in &changing {
        let of_beam = if on_beam { normal.dot(by_place_slopes[&i]) } else { model.zero() };
        let of_pad = if on_pad { kinematics.generators[i].omega.dot(turning) } else { model.zero() };
        let second = sign * (of_beam - of_pad);
        matrix.add(i.min(k), i.max(k), if i == k { 2.0 * second } else { second });
    }
    if let Some(bend) = product.bend {
        matrix.add(k, k, normal.dot(bend));
    }
    let axis = AxisPoint::new(model, kinematics, &sliding.beam, model.zero());
    for (first, [on_beam, on_pad], ..) in changing {
        let Some(curvature) = kinematics.curvatures.iter().find(|curvature| curvature.first == first) else { continue };
        // The moments about the joint's point with which a force or moment along n turns what the joint moves.
        let lever = |point: Vec3<'g>| if product.is_point { point - curvature.pose.origin } else { point };
        let mut torque = zero;
        if on_beam {
            let moved = match axis.first_moved(curvature.body) {
                0 => lever(product.value),
                element => product.beyond[element],
            };
            torque = torque + moved.cross(normal);
        }
        if on_pad {
            torque = torque - lever(product.value).cross(normal);
        }
        curvature.add_works(torque, matrix);
    }
}

/// Which coordinates move the beam and which the pad; those that move both as one body count as neither.
struct Movers {
    beam: Vec<CoordinateId>,
    pad: Vec<CoordinateId>,
    whole_beam: Vec<CoordinateId>,
}

impl Movers {
    fn new(model: &Model<'_>, sliding: &Sliding) -> Self {
        Movers {
            beam: model.chain.coordinates_of(sliding.beam.last()),
            pad: model.chain.reach(&sliding.pad),
            whole_beam: model.chain.coordinates_of(sliding.beam.first),
        }
    }

    fn as_one(&self, id: CoordinateId) -> bool {
        self.pad.contains(&id) && self.whole_beam.contains(&id)
    }

    fn beam(&self, j: usize) -> bool {
        self.beam.contains(&CoordinateId(j)) && !self.as_one(CoordinateId(j))
    }

    fn pad(&self, j: usize) -> bool {
        self.pad.contains(&CoordinateId(j)) && !self.as_one(CoordinateId(j))
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
