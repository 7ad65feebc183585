//! What belongs to each body, and bars to whatever of it neither links nor beams reach.
//!
//! A link is drawn from its frame to where the links begin that it carries, and to its points if it carries none; a beam along its axis. Points, pins
//! and centres of mass may be elsewhere: beyond a joint, on the other side of a frame, beside an axis. A bar leads to each of them from the nearest place
//! that is drawn, so that nothing floats.

use crane_codegen::chain::{Body, BodyId, Chain, CoordinateKind, Cylinder, Value};
use crane_live::LiveCrane;
use nalgebra::{Matrix4, Vector3};

/// Distance within which something is on what is drawn, relative to the crane's size: less than links are thick.
const NEAR: f64 = 0.015;
/// The same relative to the larger side of a beam's section.
const IN_BEAM: f64 = 0.5;
/// Part of a segment, from its end, within which a named mass is a block at the end rather than the segment itself.
const AT_END: f64 = 0.15;

/// A place that belongs to a body.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// Index of the body.
    pub body: usize,
    /// Where it is in the body's frame, m.
    pub at: Vector3<f64>,
    /// Of a centre of mass, the mass, kg; `None` for points and pins.
    pub mass: Option<f64>,
}

/// A bar of a body from what is drawn to a place that is not.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// Index of the body.
    pub body: usize,
    /// Where it begins in the body's frame, m.
    pub from: Vector3<f64>,
    /// Where it ends, m.
    pub to: Vector3<f64>,
    /// Mass of a block at its end, kg; 0 for none.
    pub block: f64,
    /// Whether it is the longest part of its body, as thick as a link of its mass.
    pub main: bool,
}

/// A straight part of a body as it is drawn.
type Segment = [Vector3<f64>; 2];

/// The centres of mass of all bodies, or of their parts.
#[must_use]
pub fn masses(live: &LiveCrane) -> Vec<Anchor> {
    let parameters = live.parameters();
    let at = |position: &[Value; 3]| Vector3::from(position.each_ref().map(|x| x.at(parameters)));
    let of_body = |(body, written): (usize, &Body)| {
        let mass = |mass: f64, at: Vector3<f64>| Anchor { body, at, mass: Some(mass) };
        let whole = written.inertia.as_ref().filter(|_| written.parts.len() < 2).and_then(|inertia| {
            let all = inertia.mass.at(parameters);
            (all > 0.0).then(|| mass(all, at(&inertia.first) / all))
        });
        let parts = written.parts.iter().filter(|_| written.parts.len() > 1);
        let parts = parts.map(|part| mass(part.mass.at(parameters), at(&part.com)));
        whole.into_iter().chain(parts.filter(|part| part.mass > Some(0.0))).collect::<Vec<_>>()
    };
    live.chain().bodies.iter().enumerate().flat_map(of_body).collect()
}

/// All points of interest, pins and centres of mass, with the bodies to which they belong.
#[must_use]
pub fn anchors(live: &LiveCrane) -> Vec<Anchor> {
    let (chain, parameters) = (live.chain(), live.parameters());
    let at = |position: &[Value; 3]| Vector3::from(position.each_ref().map(|x| x.at(parameters)));
    let place = |body: usize, position: &[Value; 3]| Anchor { body, at: at(position), mass: None };
    let points = chain.points.iter().map(|point| place(point.body.0, &point.position));
    let attached = chain.attachments().filter_map(|end| Some(place(end.body?.0, &end.position)));
    let pins = chain.cylinders.iter().flat_map(pins).map(|pin| place(pin.body.0, &pin.position));
    // The frame of a truck stands for its mass.
    let truck = chain.base[0].filter(|_| !chain.supports.is_empty()).map(|id| chain.coordinates[id.0].body.0);
    let masses = masses(live).into_iter().filter(|mass| Some(mass.body) != truck);
    points.chain(attached).chain(pins).chain(masses).collect()
}

fn pins(cylinder: &Cylinder) -> impl Iterator<Item = &crane_codegen::chain::Pin> {
    [&cylinder.foot, &cylinder.head].into_iter().chain(cylinder.linkage.as_ref().map(|linkage| &linkage.pivot))
}

/// Bars to all anchors that nothing else reaches; `frames` those of the bodies in the pose that is drawn.
#[must_use]
pub fn bars(live: &LiveCrane, frames: &[Matrix4<f64>]) -> Vec<Bar> {
    let chain = live.chain();
    let anchors = anchors(live);
    let near = NEAR * size(frames, &anchors);
    let mut bars = Vec::new();
    for (body, written) in chain.bodies.iter().enumerate() {
        let carried = carried_beside(live, body, frames);
        let mut own: Vec<&Anchor> = anchors.iter().chain(&carried).filter(|anchor| anchor.body == body).collect();
        let mut segments = drawn(live, body, frames, &own);
        let beam = beam_size(live, body);
        let near = if beam > 0.0 { beam } else { near };
        // Points and pins from the farthest on, then masses, which are often on the way to them.
        own.sort_by(|a, b| a.mass.is_some().cmp(&b.mass.is_some()).then(b.at.norm().total_cmp(&a.at.norm())));
        for anchor in own {
            let to = anchor.at;
            let length = |[from, to]: &Segment| (to - from).norm();
            let longest = segments.iter().map(length).fold(0.0, f64::max);
            let places = segments.iter().map(|segment| {
                let (from, share) = nearest_on(segment, to);
                ((to - from).norm(), from, share > 1.0 - AT_END && length(segment) > near)
            });
            let nearest = places.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
            let (distance, from, at_end) = nearest.unwrap_or((to.norm(), Vector3::zeros(), false));
            let at_end = at_end && written.parts.len() > 1;
            let block = anchor.mass.filter(|_| distance > near || at_end).unwrap_or(0.0);
            if distance > near || block > 0.0 {
                let main = beam == 0.0 && anchor.mass.is_none() && distance > longest;
                bars.push(Bar { body, from, to, block, main });
                segments.push([from, to]);
            }
        }
    }
    bars
}

/// Where bodies begin that a beam carries, unless they slide in it.
fn carried_beside(live: &LiveCrane, body: usize, frames: &[Matrix4<f64>]) -> Vec<Anchor> {
    let chain = live.chain();
    let (own, inverse) = (&chain.bodies[body], frames[body].try_inverse().unwrap_or_else(Matrix4::identity));
    let is_beam = own.length.at(live.parameters()) > 0.0;
    let carried = chain.bodies.iter().zip(frames).enumerate().filter(|(next, (other, _))| {
        let mut slides = chain.coordinates.iter().filter(|coordinate| coordinate.body == BodyId(*next));
        is_beam
            && other.parent == Some(BodyId(body))
            && other.link != own.link
            && slides.all(|coordinate| coordinate.kind == CoordinateKind::Rotation)
    });
    carried.map(|(_, (_, frame))| Anchor { body, at: (inverse * frame.column(3)).xyz(), mass: None }).collect()
}

/// The place on a segment that is nearest to a point, and where it is along the segment, from 0 to 1.
fn nearest_on([from, to]: &Segment, point: Vector3<f64>) -> (Vector3<f64>, f64) {
    let way = to - from;
    let share = (point - from).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 1.0);
    (from + share * way, share)
}

/// What is drawn of a body anyway.
fn drawn(live: &LiveCrane, body: usize, frames: &[Matrix4<f64>], own: &[&Anchor]) -> Vec<Segment> {
    let (chain, origin) = (live.chain(), Vector3::zeros());
    let length = chain.bodies[body].length.at(live.parameters());
    if length > 0.0 {
        return vec![[origin, Vector3::x() * length]];
    }
    let inverse = frames[body].try_inverse().unwrap_or_else(Matrix4::identity);
    let begins = |next: usize| (inverse * frames[next].column(3)).xyz();
    let carried =
        (0..chain.bodies.len()).filter(|next| chain.bodies[*next].parent.is_some_and(|parent| parent.0 == body));
    let segments: Vec<Segment> = carried.map(|next| [origin, begins(next)]).collect();
    let points = chain.points.iter().filter(|point| point.body.0 == body).count();
    if !segments.is_empty() || points == 0 {
        return segments;
    }
    // A stem to the middle of its points, which come first, and a rod between those farthest apart.
    let places: Vec<Vector3<f64>> = own.iter().take(points).map(|point| point.at).collect();
    let middle = places.iter().sum::<Vector3<f64>>() / points as f64;
    let pairs = places.iter().flat_map(|a| places.iter().map(move |b| [*a, *b]));
    let rod = pairs.max_by(|[a, b], [c, d]| (a - b).norm().total_cmp(&(c - d).norm()));
    [[origin, middle]].into_iter().chain(rod).collect()
}

/// Distance from its axis within which something is on a beam, m; 0 for a body that is none or whose shape is not given.
fn beam_size(live: &LiveCrane, body: usize) -> f64 {
    let chain: &Chain = live.chain();
    let own = &chain.bodies[body];
    let beam = chain.beams.iter().find(|beam| beam.link == own.link).filter(|_| own.length.at(live.parameters()) > 0.0);
    let sides = beam.into_iter().flat_map(|beam| &beam.outlines).flat_map(|(_, outline)| &outline.size);
    IN_BEAM * sides.map(|side| side.at(live.parameters())).fold(0.0, f64::max)
}

/// Diagonal of the box around frames and anchors, m.
fn size(frames: &[Matrix4<f64>], anchors: &[Anchor]) -> f64 {
    let origins = frames.iter().map(|frame| frame.column(3).xyz());
    let places = origins.chain(anchors.iter().map(|anchor| (frames[anchor.body] * anchor.at.push(1.0)).xyz()));
    let [low, high] = places
        .fold([Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)], |[low, high], position| {
            [low.inf(&position), high.sup(&position)]
        });
    if frames.is_empty() { 0.0 } else { (high - low).norm() }
}
