//! What moves, as a page draws it: frames of the bodies at one pose, and a screw for each coordinate.
//!
//! `T_p(q) = exp(ξ₁ (q₁ − q₁⁰)) … exp(ξ_n (q_n − q_n⁰)) T_p(q⁰)`, over the coordinates that move body p: the product of
//! exponentials (R. W. Brockett, Robotic manipulators and the product of exponentials formula, 1984). Exact for any chain,
//! so that the page can draw any pose, exaggerated and modal ones too. Three coordinates that turn by a rotation vector ρ
//! share one factor, `exp(ξ_i ρ_1 + ξ_j ρ_2 + ξ_k ρ_3)`, with screws at ρ = 0: q⁰ is the pose with these at zero.

use std::ops::Range;

use crane_codegen::chain::{
    Beam, BodyId, Coordinate, CoordinateId, CoordinateKind, Cylinder, Form, Frame, Linkage, LoopJoint, LoopJointKind,
    Outline, Pin, Point, Stage, Value as Number,
};
use crane_codegen::exchange::{Look, shapes};
use crane_live::LiveCrane;
use crane_model::{AttachmentInfo, BodyInfo, ConnectorInfo, CoordinateRole, Description, Tree, dyn_crane::DynCrane};
use nalgebra::{Matrix4, Vector3};

use crate::bars::{Bar, bars};

/// What is drawn of a crane, at one pose.
pub struct Scene {
    /// The pose.
    pub pose: Vec<f64>,
    /// The pose with rotation vectors at zero.
    pub reference: Vec<f64>,
    /// Whether a coordinate is a component of a rotation vector.
    pub vectors: Vec<bool>,
    /// Bodies, each after the one that carries it.
    pub bodies: Vec<Body>,
    /// A screw for each coordinate, in the world frame at the reference.
    pub screws: Vec<[f64; 6]>,
    /// Names of the supports and where they are in the frame of the base, m.
    pub supports: Vec<(String, Vector3<f64>)>,
    /// Springs and ropes, and rods that close loops.
    pub connectors: Vec<Connector>,
    /// Pins and balls that close loops.
    pub hinges: Vec<Hinge>,
    /// Points that the ground carries while they touch it.
    pub contacts: Vec<Place>,
    /// Names of the points of interest, and where they are.
    pub points: Vec<(String, Place)>,
    /// Hydraulic cylinders.
    pub cylinders: Vec<Barrel>,
    /// Pads of telescopes.
    pub pads: Vec<Pad>,
    /// Bars to what nothing else reaches.
    pub bars: Vec<Bar>,
    /// What the spec says that links look like.
    pub forms: Vec<Look>,
}

/// A body as it is drawn.
pub struct Body {
    /// Its name.
    pub name: String,
    /// The link to which it belongs.
    pub link: String,
    /// Its mass, kg.
    pub mass: f64,
    /// Its length along x, m: 0 unless it is an element of a beam or a link of a rope.
    pub length: f64,
    /// The body that carries it.
    pub parent: Option<usize>,
    /// Where it is attached along its carrier, m.
    pub along: f64,
    /// The coordinates of its joint.
    pub own: Range<usize>,
    /// Its frame at the reference.
    pub frame: Matrix4<f64>,
    /// Whether it is a link of a rope or chain.
    pub rope: bool,
    /// Whether it has forms to be drawn, in place of what its mass and its joints suggest.
    pub formed: bool,
}

/// A place of a body, in its frame, or of the world, m.
#[derive(Clone, Copy)]
pub struct Place {
    /// The body; `None` for the world.
    pub body: Option<usize>,
    /// Where it is.
    pub at: Vector3<f64>,
}

impl Place {
    /// Where it is in the world while the bodies have these frames, m.
    pub fn within(&self, frames: &[Matrix4<f64>]) -> Vector3<f64> {
        self.body.map_or(self.at, |body| (frames[body] * self.at.push(1.0)).xyz())
    }
}

/// A pin, which may slide along its axis, or a ball that closes a loop.
pub struct Hinge {
    /// Where it is, on one of the bodies that it holds.
    pub place: Place,
    /// The axis of a pin in the frame of this body; none of a ball.
    pub axis: Option<Vector3<f64>>,
}

/// A spring, a rope or a rod.
pub struct Connector {
    /// Its name.
    pub name: String,
    /// Whether it is a rope.
    pub rope: bool,
    /// Its ends, and the sheaves between.
    pub points: Vec<Place>,
    /// Parallel parts of a rope between its last two points.
    pub falls: usize,
}

/// A hydraulic cylinder.
pub struct Barrel {
    /// Its name.
    pub name: String,
    /// Where the barrel is held.
    pub foot: Place,
    /// Where the rod, or the link beyond it, acts.
    pub head: Place,
    /// Rocker and link between rod and head.
    pub linkage: Option<Rocker>,
    /// Diameters, m.
    pub bore: f64,
    /// See `bore`.
    pub rod: f64,
    /// Distance of the pins when it is retracted, m.
    pub retracted: f64,
    /// The axis of the joint that it turns, in the frame of a body; none if that slides.
    pub axis: Option<(usize, Vector3<f64>)>,
}

/// A rocker and a link between a rod and what it moves.
pub struct Rocker {
    /// About which the rocker turns.
    pub pivot: Place,
    /// Lengths, m.
    pub rocker: f64,
    /// See `rocker`.
    pub link: f64,
    /// On which side of the line from pivot to head the rod's pin is.
    pub left: bool,
}

/// Pads between two beams of a telescope.
pub struct Pad {
    /// The body on which they are.
    pub body: usize,
    /// Where along it, m.
    pub x: f64,
    /// Names of the outer and the inner beam.
    pub beams: [String; 2],
}

impl Scene {
    /// The scene of a crane for pose `q`.
    pub fn new(live: &LiveCrane, q: &[f64]) -> Self {
        let crane: &dyn DynCrane = live;
        let description = crane.description();
        let vectors: Vec<bool> =
            description.coordinates.iter().map(|coordinate| coordinate.role == CoordinateRole::ElementVector).collect();
        let reference: Vec<f64> = q.iter().zip(&vectors).map(|(q, vector)| if *vector { 0.0 } else { *q }).collect();
        let frames = crane.transforms_at(&reference);
        let (tree, sizes) = ((live as &dyn DynCrane).tree(), crane.body_sizes_at());
        let forms = shapes(live.chain(), live.parameters());
        let body = |(index, (info, frame)): (usize, (&BodyInfo, &Matrix4<f64>))| {
            let [mass, length] = sizes[index];
            Body {
                name: info.name.to_string(),
                link: info.link.to_string(),
                mass,
                length,
                parent: tree.parent(index),
                along: live.chain().bodies[index].along.at(live.parameters()),
                own: tree.own(index),
                frame: *frame,
                // A beam that does not deform is one body, with the name of its link.
                rope: length > 0.0 && info.name != info.link && !deforms(description, &tree, info),
                formed: length == 0.0 && forms.iter().any(|form| form.body == Some(BodyId(index)) && is_drawn(form)),
            }
        };
        let bodies: Vec<Body> = description.bodies.iter().zip(&frames).enumerate().map(body).collect();
        let names = description.supports.iter().map(|support| support.name.to_string());
        let screws = screws(live, &reference);
        Self {
            pose: q.to_vec(),
            vectors,
            bars: bars(live, &frames).into_iter().filter(|bar| !bodies[bar.body].formed).collect(),
            bodies,
            supports: names.zip(crane.support_places_at()).collect(),
            connectors: connectors(crane).into_iter().chain(rods(live)).collect(),
            hinges: live.chain().loop_joints.iter().filter_map(|joint| hinge(live, joint)).collect(),
            contacts: contacts(live),
            points: points(live),
            cylinders: cylinders(live, (&screws, &frames)),
            pads: pads(live),
            forms,
            screws,
            reference,
        }
    }
}

/// Whether its triangles are known: not those of a surface in a file that nobody has read, which exported files name.
pub fn is_drawn(look: &Look) -> bool {
    !matches!(look.form, Form::Mesh { surface: None, .. })
}

/// A frame as a matrix.
pub fn matrix(frame: &Frame) -> Matrix4<f64> {
    let [x, y, z] = frame.axes.map(|axis| Vector3::from(axis).push(0.0));
    Matrix4::from_columns(&[x, y, z, Vector3::from(frame.origin).push(1.0)])
}

/// Springs and ropes between at least two points.
fn connectors(crane: &dyn DynCrane) -> Vec<Connector> {
    let attachments = crane.attachments_at();
    let mut places = attachments.iter();
    let mut of = |connector: &ConnectorInfo| {
        let place = |(point, at): (&AttachmentInfo, &Vector3<f64>)| Place { body: point.body, at: *at };
        let points: Vec<Place> = connector.points.iter().zip(places.by_ref()).map(place).collect();
        let (name, falls) = (connector.name.to_string(), connector.falls);
        (points.len() > 1 && !connector.is_pin()).then_some(Connector { name, rope: connector.is_rope, points, falls })
    };
    crane.description().connectors.iter().filter_map(&mut of).collect()
}

/// Rods that close loops.
fn rods(live: &LiveCrane) -> impl Iterator<Item = Connector> {
    let joints = live.chain().loop_joints.iter().filter(|joint| matches!(joint.kind, LoopJointKind::Rod { .. }));
    joints.map(|joint| {
        let points = joint.ends.iter().map(|end| place(live, end.body, &end.position)).collect();
        Connector { name: joint.name.clone(), rope: false, points, falls: 1 }
    })
}

/// The pin or the ball of a joint that closes a loop, on the first of its bodies that is not the ground and has its axis.
fn hinge(live: &LiveCrane, joint: &LoopJoint) -> Option<Hinge> {
    let [from, to] = &joint.ends;
    let held = match &joint.kind {
        LoopJointKind::Pin { across, to_axis } => vec![(from, Some(across.axis)), (to, Some(*to_axis))],
        LoopJointKind::Slide { across } => vec![(from, Some(across.axis))],
        LoopJointKind::Ball => vec![(from, None), (to, None)],
        LoopJointKind::Rod { .. } | LoopJointKind::Pad { .. } => Vec::new(),
    };
    let (end, axis) = held.into_iter().find(|(end, _)| end.body.is_some())?;
    Some(Hinge { place: place(live, end.body, &end.position), axis: axis.map(Vector3::from) })
}

/// The pads of telescopes: at the end of the outer beam and at the beginning of the inner one, with the names of both links.
fn pads(live: &LiveCrane) -> Vec<Pad> {
    let chain = live.chain();
    let link = |body: BodyId| chain.bodies[body.0].link.clone();
    let of_stage = |stage: &Stage<'_>| {
        let beams = [link(stage.outer.first), link(stage.inner)];
        let last = stage.outer.last();
        let end = chain.bodies[last.0].length.at(live.parameters());
        [(last, end), (stage.inner, 0.0)].map(|(body, x)| Pad { body: body.0, x, beams: beams.clone() })
    };
    chain.stages().iter().flat_map(of_stage).collect()
}

/// Whether a body is of a beam that deforms. Links of ropes and chains have lengths, as elements of beams do, and do not.
fn deforms(description: &Description, tree: &Tree, body: &BodyInfo) -> bool {
    let last = description.bodies.iter().rposition(|other| other.link == body.link);
    let moving = last.map(|last| tree.coordinates(last)).unwrap_or_default();
    moving.last().is_some_and(|&coordinate| description.coordinates[coordinate].role.is_element())
}

/// Cylinders with their pins in the frames of the bodies that carry them; with the joint's axis, if it turns.
fn cylinders(live: &LiveCrane, moving: (&[[f64; 6]], &[Matrix4<f64>])) -> Vec<Barrel> {
    let number = |number: &Number| number.at(live.parameters());
    let pin = |pin: &Pin| place(live, pin.body, &pin.position);
    let data = |cylinder: &Cylinder| {
        let linkage = cylinder.linkage.as_ref().map(|Linkage { pivot, rocker, link, left }| Rocker {
            pivot: pin(pivot),
            rocker: number(rocker),
            link: number(link),
            left: *left,
        });
        Barrel {
            name: cylinder.name.clone(),
            foot: pin(&cylinder.foot),
            head: pin(&cylinder.head),
            linkage,
            bore: cylinder.bore,
            rod: cylinder.rod,
            retracted: cylinder.retracted,
            axis: axis(live, cylinder.coordinate, moving),
        }
    };
    live.chain().cylinders.iter().map(data).collect()
}

/// The pins of a cylinder in a pose, in the world, m.
#[derive(Clone, Copy, Debug)]
pub struct Pins {
    /// Where the barrel is held.
    pub foot: Vector3<f64>,
    /// The end of the rod.
    pub rod: Vector3<f64>,
    /// Where the rod, or the link beyond it, acts.
    pub head: Vector3<f64>,
    /// About which the rocker turns, if there is one.
    pub pivot: Option<Vector3<f64>>,
}

impl Pins {
    /// All of them.
    pub fn places(self) -> impl Iterator<Item = Vector3<f64>> + Clone {
        let linked = self.pivot.into_iter().flat_map(move |pivot| [pivot, self.head]);
        [self.foot, self.rod].into_iter().chain(linked)
    }
}

impl Barrel {
    /// Its axis in the world, of length 1, if the joint turns.
    pub fn normal(&self, frames: &[Matrix4<f64>]) -> Option<Vector3<f64>> {
        self.axis.map(|(body, along)| (frames[body].fixed_view::<3, 3>(0, 0) * along).normalize())
    }

    /// Its pins while the bodies have these frames: the geometry of `codegen/src/mechanics/cylinders.rs`.
    pub fn pins(&self, frames: &[Matrix4<f64>]) -> Pins {
        let [foot, head] = [&self.foot, &self.head].map(|pin| pin.within(frames));
        let Some(Rocker { pivot, rocker, link, left }) = &self.linkage else {
            return Pins { foot, rod: head, head, pivot: None };
        };
        let pivot = pivot.within(frames);
        let across = head - pivot;
        let along = (across.norm_squared() + rocker.powi(2) - link.powi(2)) / (2.0 * across.norm());
        let height = (rocker.powi(2) - along.powi(2)).max(0.0).sqrt() * if *left { 1.0 } else { -1.0 };
        let normal = self.normal(frames).unwrap_or_default();
        let aside = normal.cross(&across).try_normalize(0.0).unwrap_or_default();
        let rod = pivot + across.normalize() * along + aside * height;
        Pins { foot, rod, head, pivot: Some(pivot) }
    }
}

/// The axis about which a coordinate turns, in the frame of the first body that it moves; none if it slides.
fn axis(
    live: &LiveCrane,
    coordinate: CoordinateId,
    (screws, frames): (&[[f64; 6]], &[Matrix4<f64>]),
) -> Option<(usize, Vector3<f64>)> {
    let body = live.chain().coordinates[coordinate.0].body.0;
    let [x, y, z, ..] = screws[coordinate.0];
    let local = frames[body].fixed_view::<3, 3>(0, 0).transpose() * Vector3::new(x, y, z);
    (local.norm() > 0.0).then_some((body, local))
}

fn place(live: &LiveCrane, body: impl Into<Option<BodyId>>, position: &[Number; 3]) -> Place {
    let at = Vector3::from(position.each_ref().map(|x| x.at(live.parameters())));
    Place { body: body.into().map(|BodyId(body)| body), at }
}

/// Screws of all coordinates in the world frame at pose `q`, direction ω, then velocity at the origin.
fn screws(live: &LiveCrane, q: &[f64]) -> Vec<[f64; 6]> {
    let (chain, parameters) = (live.chain(), live.parameters());
    let screw = |(index, coordinate): (usize, &Coordinate)| {
        let [point, along] = chain.axis(CoordinateId(index), q, parameters).map(Vector3::from);
        let (omega, upsilon) = match coordinate.kind {
            CoordinateKind::Rotation => (along, point.cross(&along)),
            CoordinateKind::Translation => (Vector3::zeros(), along),
        };
        [omega.x, omega.y, omega.z, upsilon.x, upsilon.y, upsilon.z]
    };
    chain.coordinates.iter().enumerate().map(screw).collect()
}

/// Points of interest with the body that carries each.
fn points(live: &LiveCrane) -> Vec<(String, Place)> {
    let point = |point: &Point| (point.name.clone(), place(live, point.body, &point.position));
    live.chain().points.iter().map(point).collect()
}

/// Points that touch the ground at times.
fn contacts(live: &LiveCrane) -> Vec<Place> {
    let contacts = live.chain().connectors().iter().filter(|connector| connector.is_contact());
    let ends = contacts.flat_map(|contact| contact.strain.points());
    ends.map(|end| place(live, end.body, &end.position)).filter(|place| place.body.is_some()).collect()
}

/// The outline of a beam whose spec gives a shape.
#[derive(Clone, Debug)]
pub struct Section {
    /// Largest height and width, m.
    pub size: [f64; 2],
    /// Distances along the beam, with height and width there, m.
    pub along: Vec<[f64; 3]>,
    /// Whether it is round.
    pub round: bool,
}

/// Outlines of beams, by the names of their links.
pub fn sections(live: &LiveCrane) -> impl Iterator<Item = (&str, Section)> {
    let number = |number: &Number| number.at(live.parameters());
    let of = move |beam: &Beam| {
        let along: Vec<[f64; 3]> = beam
            .outlines
            .iter()
            .map(|(x, Outline { size: [height, width], .. })| [x, height, width].map(number))
            .collect();
        let greatest = |side: usize| along.iter().map(|sides| sides[side]).fold(0.0, f64::max);
        Some(Section { size: [greatest(1), greatest(2)], round: beam.outlines.first()?.1.round, along })
    };
    live.chain().beams.iter().filter_map(move |beam| Some((beam.link.as_str(), of(beam)?)))
}
