//! The shapes of a crane, for pages, pictures and other programs.
//!
//! | module | content |
//! |---|---|
//! | `mesh` | triangles of boxes, rods, balls and hooks |
//! | `beam`, `cylinders` | beams that bend, hydraulic cylinders |
//! | `data` | the shapes for the script of a page, which moves them |
//! | [`gltf`] | the shapes for other programs |
//! | [`looks`] | the shapes as URDF and MJCF have them |
//! | [`picture`] | the shapes as picture elements |
//! | [`surfaces`] | triangles in files that a spec names |

mod apart;
mod beam;
mod cylinders;
mod data;
pub mod gltf;
pub mod looks;
mod mesh;
pub mod picture;
pub mod surfaces;

use std::collections::HashMap;

use crane_codegen::chain::BodyId;
use crane_codegen::exchange::Look;
use crane_live::LiveCrane;
use crane_model::{CoordinateInfo, CoordinateKind, CoordinateRole, dyn_crane::DynCrane};
use nalgebra::{Matrix4, Vector3};

use crate::scene::{Body, Connector, Hinge, Pad, Place, Scene, Section, is_drawn, sections};
pub use cylinders::LENGTH as BARREL_LENGTH;
pub use mesh::Mesh;

/// Mass per volume within the outline of a link, kg/m³: about a third of steel's.
const FILLING: f64 = 2400.0;
/// Minimum and maximum thickness of a link, relative to the crane's size, as all that follow.
const THICKNESS: [f64; 2] = [0.012, 0.06];
/// A length below this counts as zero.
const NOTHING: f64 = 1e-3;
/// Radii of springs, ropes, and sheaves and points of contact, and size of a hook.
const SPRING: f64 = 0.004;
const ROPE: f64 = 0.0015;
const HOOK: f64 = 0.008;
const SHEAVE: f64 = 0.006;
/// Distance of the falls of a rope, relative to its radius.
const APART: f64 = 4.0;
/// Feet less far below the base's frame than this are on its level.
const LEVEL: f64 = 0.02;
/// Largest height of the frame of a truck above its feet if its spec does not tell.
const HEIGHT: f64 = 0.09;
/// Largest thickness of a leg.
const LEG: f64 = 0.014;
/// Largest side of a block.
const BLOCK: f64 = 0.15;
/// Room around the axes of the links.
const MARGIN: f64 = 0.03;

/// A colour and what has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paint {
    /// What has it.
    pub name: &'static str,
    /// Red, green and blue, sRGB.
    pub colour: [u8; 3],
}

const fn paint(name: &'static str, colour: u32) -> Paint {
    let [_, red, green, blue] = colour.to_be_bytes();
    Paint { name, colour: [red, green, blue] }
}

const BASE: Paint = paint("base", 0x004a_5560);
const LINK: Paint = paint("link", 0x00e2_a32b);
const FLEXIBLE: Paint = paint("flexible", 0x001f_7fc0);
const STAGE: Paint = paint("stage", 0x005a_a9dd);
const SLIDE: Paint = paint("slide", 0x00b9_c2cb);
const LOAD: Paint = paint("load", 0x00a5_784f);
const PIN: Paint = paint("pin", 0x002b_3138);
const PASSIVE: Paint = paint("passive", 0x008d_979f);
const BARREL: Paint = paint("barrel", 0x0059_636e);
const ROD: Paint = paint("rod", 0x00df_e4e8);
const LINKAGE: Paint = paint("linkage", 0x00c9_8a1c);
const PAD: Paint = paint("pad", 0x00f2_f2ee);

/// To what a shape belongs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A body, by its index: the shape is in its frame.
    Body(usize),
    /// The ground: the shape is in the world.
    Ground,
    /// A connector or a cylinder, by its name: the shape is in the world, and follows several bodies.
    Part(String),
}

/// A part of a crane in one colour.
#[derive(Clone, Debug)]
pub struct Shape {
    /// To what it belongs.
    pub owner: Owner,
    /// Its colour.
    pub paint: Paint,
    /// Its surface, m.
    pub mesh: Mesh,
    /// What else is known of it.
    pub detail: Detail,
}

/// What else is known of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Nothing.
    None,
    /// It is a piece of a beam, which pages bend themselves.
    Beam,
    /// It is of the leg at a support, by its index: pages give it the colour of its load.
    Leg(usize),
}

/// A beam, which pages draw themselves.
#[derive(Debug)]
pub struct DrawnBeam {
    /// Its link.
    pub name: String,
    /// Its bodies, in their order.
    pub bodies: Vec<usize>,
    /// Its outline, written or guessed.
    pub section: Section,
    /// Its colour.
    pub paint: Paint,
}

/// A crane in a pose, as shapes.
pub struct Figure {
    /// What it consists of, with its points.
    pub scene: Scene,
    /// Frames of the bodies in the pose.
    pub frames: Vec<Matrix4<f64>>,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// The beams among them.
    pub beams: Vec<DrawnBeam>,
    /// The size of the crane, m, in which thicknesses are measured.
    pub size: f64,
    /// Height of the ground on which it stands, m.
    pub ground: f64,
}

impl Figure {
    /// The shapes of a crane in pose `q`, as thick as in pose `start`: of one crane, shapes of other poses differ only by what slides, bends or turns.
    pub fn new(live: &LiveCrane, start: &[f64], q: &[f64]) -> Self {
        let scene = Scene::new(live, start);
        let travels = scene.reference.iter().zip(q).map(|(a, b)| [a.min(*b), a.max(*b)]).collect();
        Self::of_scene(live, scene, q, travels)
    }

    /// The shapes of a crane in pose `start` that stay in their sleeves while each coordinate is within its least and greatest value.
    pub fn moving(live: &LiveCrane, start: &[f64], travels: Vec<[f64; 2]>) -> Self {
        Self::of_scene(live, Scene::new(live, start), start, travels)
    }

    fn of_scene(live: &LiveCrane, scene: Scene, q: &[f64], travels: Vec<[f64; 2]>) -> Self {
        let frames = (live as &dyn DynCrane).transforms_at(q);
        let coordinates = &(live as &dyn DynCrane).description().coordinates;
        let mut builder = Builder {
            size: size(&scene, coordinates),
            reference: scene.bodies.iter().map(|body| body.frame).collect(),
            travels,
            scene: &scene,
            coordinates,
            frames: &frames,
            usual: None,
            shapes: Vec::new(),
            beams: Vec::new(),
        };
        builder.build(&sections(live).collect());
        let Builder { shapes, beams, size, .. } = builder;
        let feet =
            scene.supports.iter().map(|(_, at)| Place { body: Some(0), at: *at }.within(&frames).z - 0.008 * size);
        let lowest = || {
            shapes.iter().flat_map(|shape| placed(shape, &frames)).map(|corner| corner.z).fold(f64::INFINITY, f64::min)
        };
        let ground = feet.min_by(f64::total_cmp).unwrap_or_else(lowest);
        Self { scene, frames, shapes, beams, size, ground }
    }

    /// The corners of a shape in the world, m.
    pub fn corners(&self, shape: &Shape) -> Vec<Vector3<f64>> {
        placed(shape, &self.frames).collect()
    }

    /// The corners of all shapes in the world, m.
    pub fn all_corners(&self) -> Vec<Vector3<f64>> {
        self.shapes.iter().flat_map(|shape| placed(shape, &self.frames)).collect()
    }
}

fn placed<'a>(shape: &'a Shape, frames: &'a [Matrix4<f64>]) -> impl Iterator<Item = Vector3<f64>> + 'a {
    let body = match shape.owner {
        Owner::Body(body) => Some(body),
        Owner::Ground | Owner::Part(_) => None,
    };
    shape.mesh.corners.iter().map(move |at| Place { body, at: *at }.within(frames))
}

/// Size of a crane: the diagonal of the box around its frames and points, with a margin.
fn size(scene: &Scene, coordinates: &[CoordinateInfo]) -> f64 {
    let frames: Vec<Matrix4<f64>> = scene.bodies.iter().map(|body| body.frame).collect();
    let of_body = |body: usize, at: Vector3<f64>| Place { body: Some(body), at }.within(&frames);
    let ends = scene
        .bodies
        .iter()
        .enumerate()
        .flat_map(|(index, body)| [0.0, body.length].map(|x| of_body(index, Vector3::x() * x)));
    let points = scene.points.iter().map(|(_, point)| point.within(&frames));
    let bars = scene.bars.iter().map(|bar| of_body(bar.body, bar.to));
    let forms = scene.forms.iter().flat_map(corners).map(|corner| corner.within(&frames));
    let supports = scene.supports.iter().map(|(_, at)| of_body(0, *at));
    let anchors =
        scene.connectors.iter().flat_map(|one| &one.points).filter(|point| point.body.is_none()).map(|point| point.at);
    let origin = (!has_base(coordinates)).then(Vector3::zeros);
    let places = ends.chain(points).chain(bars).chain(forms).chain(supports).chain(anchors).chain(origin);
    let [low, high] = places
        .fold([Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)], |[low, high], position| {
            [low.inf(&position), high.sup(&position)]
        });
    let diagonal = (high - low).norm();
    ((high - low).add_scalar(2.0 * MARGIN * diagonal)).norm().max(1e-3)
}

/// The corners of a form.
fn corners(form: &Look) -> impl Iterator<Item = Place> {
    let body = form.body.map(|BodyId(body)| body);
    Mesh::solid(&form.frame, &form.form).corners.into_iter().map(move |at| Place { body, at })
}

/// Whether the base moves.
fn has_base(coordinates: &[CoordinateInfo]) -> bool {
    coordinates.first().is_some_and(|first| first.role == CoordinateRole::Base)
}

impl Connector {
    /// The radius of its rods, m, and their colour.
    fn look(&self, size: f64) -> (f64, Paint) {
        if self.rope { (ROPE * size, PIN) } else { (SPRING * size, SLIDE) }
    }
}

/// What is known while the shapes are made.
struct Builder<'a> {
    scene: &'a Scene,
    coordinates: &'a [CoordinateInfo],
    /// Frames of the bodies at the scene's reference.
    reference: Vec<Matrix4<f64>>,
    /// Frames of the bodies in the pose.
    frames: &'a [Matrix4<f64>],
    /// Least and greatest values of all coordinates.
    travels: Vec<[f64; 2]>,
    size: f64,
    /// Thickness of links whose mass tells none.
    usual: Option<f64>,
    shapes: Vec<Shape>,
    beams: Vec<DrawnBeam>,
}

/// The frame of a truck above its feet.
struct Chassis {
    /// Height of its middle in the frame of the base, m.
    level: f64,
    /// Height of its top above the feet, m.
    depth: f64,
    /// Its own height, m.
    height: f64,
    /// Where the crane begins.
    begin: Vector3<f64>,
}

/// A beam as it is drawn: its greatest height and width, m, and how many beams are around it.
type Drawn<'a> = HashMap<&'a str, ([f64; 2], usize)>;

impl<'a> Builder<'a> {
    fn build(&mut self, outlines: &HashMap<&str, Section>) {
        let (scene, chassis) = (self.scene, self.chassis());
        let drawn = self.beams(outlines);
        for (next, body) in scene.bodies.iter().enumerate() {
            let Some(parent) = body.parent else { continue };
            let carrier = &scene.bodies[parent];
            if carrier.rope || carrier.link == body.link && carrier.length > 0.0 {
                continue;
            }
            if carrier.length > 0.0 { self.inner(next) } else { self.link(parent, next, chassis.as_ref()) }
        }
        self.pads(&drawn);
        let rope = [ROPE * self.size; 2];
        for (index, body) in scene.bodies.iter().enumerate().filter(|(_, body)| body.rope) {
            self.part(index, PIN, Mesh::rod(Vector3::zeros(), Vector3::x() * body.length, rope, 12));
        }
        self.pins();
        self.hinges();
        for Place { body, at } in &scene.contacts {
            let body = body.unwrap_or_default();
            self.part(body, PAD, Mesh::ball(*at, SHEAVE * self.size));
        }
        for index in 0..scene.bodies.len() {
            if scene.bodies.iter().all(|body| body.parent != Some(index)) {
                self.end(index);
            }
        }
        self.bars();
        self.forms();
        match chassis {
            Some(chassis) => self.feet(&chassis),
            None if has_base(self.coordinates) => {}
            None => self.pedestal(),
        }
        scene.connectors.iter().for_each(|connector| self.connector(connector));
        for cylinder in &scene.cylinders {
            let parts = cylinders::parts(cylinder, self.size, self.frames);
            let owner = || Owner::Part(cylinder.name.clone());
            let shape = |(paint, mesh)| Shape { owner: owner(), paint, mesh, detail: Detail::None };
            self.shapes.extend(parts.into_iter().map(shape));
        }
    }

    fn part(&mut self, body: usize, paint: Paint, mesh: Mesh) {
        self.fixed(Owner::Body(body), paint, mesh);
    }

    fn fixed(&mut self, owner: Owner, paint: Paint, mesh: Mesh) {
        self.shapes.push(Shape { owner, paint, mesh, detail: Detail::None });
    }

    /// The same with what else is known of it.
    fn detail(&mut self, body: usize, paint: Paint, mesh: Mesh, detail: Detail) {
        self.shapes.push(Shape { owner: Owner::Body(body), paint, mesh, detail });
    }

    /// A square box between places of a body, unless it has no length.
    fn bar(&mut self, body: usize, [from, to]: [Vector3<f64>; 2], side: f64, paint: Paint) {
        if !self.is_nothing(to - from) {
            self.part(body, paint, Mesh::bar(from, to, [side; 2]));
        }
    }

    /// The same for what the spec does not tell: nothing of a body that has forms of its own.
    fn guess(&mut self, body: usize, ends: [Vector3<f64>; 2], side: f64, paint: Paint) {
        if !self.scene.bodies[body].formed {
            self.bar(body, ends, side, paint);
        }
    }

    fn is_nothing(&self, way: Vector3<f64>) -> bool {
        way.norm() <= NOTHING * self.size
    }

    fn thickness(&self, mass: f64, length: f64) -> f64 {
        let [least, most] = THICKNESS.map(|part| part * self.size);
        let usual = self.usual.unwrap_or(least);
        let side = if mass > 0.0 && length > 0.0 { (mass / (FILLING * length)).sqrt() } else { usual };
        side.clamp(least, most)
    }

    /// The coordinates of a body's joint that slide.
    fn slides(&self, body: usize) -> Vec<usize> {
        let slides = |index: &usize| {
            let coordinate = &self.coordinates[*index];
            coordinate.kind == CoordinateKind::Translation && coordinate.role != CoordinateRole::Base
        };
        self.scene.bodies[body].own.clone().filter(slides).collect()
    }

    /// A direction of the world in the frame of a body, at the reference.
    fn local(&self, body: usize, direction: Vector3<f64>) -> Vector3<f64> {
        self.reference[body].fixed_view::<3, 3>(0, 0).transpose() * direction
    }

    /// Where a body begins, in the frame of another one, at the reference.
    fn begin(&self, of: usize, within: usize) -> Vector3<f64> {
        let way = (self.reference[of].column(3) - self.reference[within].column(3)).xyz();
        self.local(within, way)
    }

    /// Direction in which a coordinate slides, in the world at the reference.
    fn sliding(&self, coordinate: usize) -> Vector3<f64> {
        let [.., x, y, z] = self.scene.screws[coordinate];
        Vector3::new(x, y, z).normalize()
    }

    fn beams(&mut self, outlines: &HashMap<&str, Section>) -> Drawn<'a> {
        let scene = self.scene;
        let mut drawn = Drawn::new();
        let elements: Vec<usize> = (0..scene.bodies.len())
            .filter(|&index| scene.bodies[index].length > 0.0 && !scene.bodies[index].rope)
            .collect();
        for elements in elements.chunk_by(|a, b| scene.bodies[*a].link == scene.bodies[*b].link) {
            let name = scene.bodies[elements[0]].link.as_str();
            let total = |of: fn(&Body) -> f64| elements.iter().map(|&index| of(&scene.bodies[index])).sum::<f64>();
            let (length, mass) = (total(|body| body.length), total(|body| body.mass));
            // A stage without a shape is narrower than the beam in which it slides.
            let outer = scene.pads.iter().find(|pad| pad.beams[1] == name).map(|pad| pad.beams[0].as_str());
            let around =
                outer.and_then(|outer| drawn.get(outer)).map_or(f64::INFINITY, |([height, _], _)| 0.8 * height);
            let likely = self.thickness(mass, length).min(around);
            let likely =
                || Section { size: [likely, 0.8 * likely], along: vec![[0.0, likely, 0.8 * likely]], round: false };
            let given = likely();
            let section = outlines.get(name).unwrap_or(&given);
            // Every other stage of a telescope is lighter, so that it can be told from the one around it.
            let depth = outer.map_or(0, |outer| drawn.get(outer).map_or(0, |(_, depth)| *depth) + 1);
            let paint = if depth % 2 == 1 { STAGE } else { FLEXIBLE };
            let placed: Vec<_> =
                elements.iter().map(|&index| (self.frames[index], scene.bodies[index].length)).collect();
            let mut begin = 0.0;
            for (number, (&index, mut mesh)) in elements.iter().zip(beam::pieces(&placed, section)).enumerate() {
                let inverse = self.frames[index].try_inverse().unwrap_or_else(Matrix4::identity);
                mesh.corners.iter_mut().for_each(|corner| *corner = (inverse * corner.push(1.0)).xyz());
                self.detail(index, paint, mesh, Detail::Beam);
                // Rings between the elements show where it bends.
                if number > 0 {
                    let [height, width] = beam::size_at(&section.along, begin);
                    let side = height.max(width);
                    let half = Vector3::x() * (0.06 * side);
                    let ring = if section.round {
                        Mesh::rod(-half, half, [0.56 * side; 2], 24)
                    } else {
                        Mesh::bar(-half, half, [height, width].map(|across| across + 0.12 * side))
                    };
                    self.part(index, PIN, ring);
                }
                begin += scene.bodies[index].length;
            }
            drawn.insert(name, (section.size, depth));
            self.usual.get_or_insert(section.size[0].max(section.size[1]));
            let (name, bodies, section) = (name.to_owned(), elements.to_vec(), section.clone());
            self.beams.push(DrawnBeam { name, bodies, section, paint });
        }
        drawn
    }

    /// Blocks on the four sides of the inner beam that fill the gap to the outer one, and come a little out of its faces.
    fn pads(&mut self, drawn: &Drawn<'_>) {
        for Pad { body, x, beams } in &self.scene.pads {
            let [outer, inner] =
                beams.each_ref().map(|name| drawn.get(name.as_str()).map_or([0.0; 2], |(size, _)| *size));
            for (side, across) in [(0, 1), (1, 0)] {
                let thick = (0.54 * outer[side] - 0.5 * inner[side]).max(0.04 * inner[side]);
                let mut sizes = [0.6 * inner[0]; 3];
                (sizes[1 + side], sizes[1 + across]) = (thick, 0.6 * inner[across]);
                for sign in [-1.0, 1.0] {
                    let mut middle = Vector3::x() * *x;
                    middle[1 + side] = sign * 0.5 * (inner[side] + thick);
                    self.part(*body, PAD, Mesh::block(middle, sizes));
                }
            }
        }
    }

    /// From a body's origin to where another one begins that it carries; a sliding one comes out of it.
    fn link(&mut self, index: usize, next: usize, chassis: Option<&Chassis>) {
        let (body, far) = (&self.scene.bodies[index], self.begin(next, index));
        let outline = self.thickness(body.mass, far.norm());
        let moved_by_base =
            body.own.end.checked_sub(1).is_some_and(|last| self.coordinates[last].role == CoordinateRole::Base);
        if body.mass > 0.0 && !self.is_nothing(far) && !moved_by_base {
            self.usual.get_or_insert(outline);
        }
        let &[slide] = self.slides(next).as_slice() else {
            let is_base = index == 0 && has_base(self.coordinates);
            // On a truck, from its frame up.
            let from = chassis
                .filter(|_| is_base)
                .map_or_else(Vector3::zeros, |chassis| Vector3::new(far.x, far.y, chassis.level.min(far.z)));
            return self.guess(index, [from, far], outline, if is_base { BASE } else { LINK });
        };
        let (along, [least, most]) = (self.sliding(slide), self.travels[slide]);
        let axis = self.local(index, along);
        let home = far - axis * self.scene.reference[slide];
        let sleeve = if self.is_nothing(home) { home + axis * least } else { home };
        let side = self.thickness(body.mass, sleeve.norm().max(far.norm() / 2.0));
        self.guess(index, [Vector3::zeros(), sleeve], side, LINK);
        // A beam shows itself.
        if self.scene.bodies[next].length == 0.0 {
            // Long enough to stay in its sleeve at the far end of its travel.
            let inside = self.begin(index, next).norm();
            let reach = (most.abs() + 0.5 * side).min(inside + (most - self.scene.reference[slide]).abs());
            let back = -self.local(next, along) * reach;
            self.guess(next, [Vector3::zeros(), back], 0.78 * side, SLIDE);
        }
    }

    /// What slides out of a beam that bends: the beam is its sleeve.
    fn inner(&mut self, next: usize) {
        let body = &self.scene.bodies[next];
        if let (0.0, &[slide]) = (body.length, self.slides(next).as_slice()) {
            let side = 0.7 * self.usual.unwrap_or_else(|| self.thickness(body.mass, 1.0));
            // Far enough back to stay in the beam at the far end of its travel; its part outside is drawn as a link.
            let reach = self.travels[slide].map(f64::abs).into_iter().fold(0.0, f64::max) + 0.5 * side;
            let back = -self.local(next, self.sliding(slide)) * reach;
            self.guess(next, [Vector3::zeros(), back], side, SLIDE);
        }
    }

    /// A pin where a joint turns, on its axis; dark where a drive turns it.
    fn pins(&mut self) {
        let scene = self.scene;
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let driven = matches!(coordinate.role, CoordinateRole::Driven | CoordinateRole::Prescribed);
            if coordinate.kind != CoordinateKind::Rotation || !driven && coordinate.role != CoordinateRole::Passive {
                continue;
            }
            let Some(body) = scene.bodies.iter().position(|body| body.own.end > index) else { continue };
            let own = &scene.bodies[body];
            // Pads hold a stage, no pins.
            let padded = scene.pads.iter().any(|pad| pad.body == body && pad.x == 0.0);
            if own.rope || own.parent.is_some_and(|parent| scene.bodies[parent].rope) || padded {
                continue;
            }
            let [x, y, z, ..] = scene.screws[index];
            let side = self.thickness(own.mass, 0.0);
            let upright = z.abs() > 0.9 && body <= 1;
            let [radius, height] = if upright { [1.1, 0.5] } else { [0.5, 1.35] }.map(|part| part * side);
            let half = self.local(body, Vector3::new(x, y, z)).normalize() * (height / 2.0);
            self.part(body, if driven { PIN } else { PASSIVE }, Mesh::rod(-half, half, [radius; 2], 28));
        }
    }

    /// Pins and balls that close loops.
    fn hinges(&mut self) {
        for Hinge { place, axis } in &self.scene.hinges {
            let Some(body) = place.body else { continue };
            let side = self.thickness(self.scene.bodies[body].mass, 0.0);
            let mesh = match axis {
                Some(axis) => {
                    let half = axis * (0.675 * side);
                    Mesh::rod(place.at - half, place.at + half, [0.5 * side; 2], 28)
                }
                None => Mesh::ball(place.at, 0.6 * side),
            };
            self.part(body, PASSIVE, mesh);
        }
    }

    /// What the last body of a branch carries: a stem to its points, a rod through them, or a block of its mass.
    fn end(&mut self, index: usize) {
        let body = &self.scene.bodies[index];
        let places: Vec<Vector3<f64>> = self
            .scene
            .points
            .iter()
            .filter(|(_, point)| point.body == Some(index))
            .map(|(_, point)| point.at)
            .collect();
        let mut bars = self.scene.bars.iter().filter(|bar| bar.body == index).peekable();
        // Where its mass is known to be elsewhere, a bar leads there.
        if body.length > 0.0 || body.formed || places.is_empty() && bars.peek().is_some() {
            return;
        }
        let mass = if bars.any(|bar| bar.block > 0.0) { 0.0 } else { body.mass };
        let middle = places.iter().sum::<Vector3<f64>>() / places.len().max(1) as f64;
        let pairs = places.iter().flat_map(|a| places.iter().map(move |b| [*a, *b]));
        let [from, to] =
            pairs.max_by(|[a, b], [c, d]| (a - b).norm().total_cmp(&(c - d).norm())).unwrap_or([middle; 2]);
        let hangs = body.parent.is_some_and(|parent| self.scene.bodies[parent].rope);
        let (stem, paint) = if hangs { (2.0 * ROPE * self.size, PIN) } else { (0.5 * self.thickness(0.0, 0.0), LINK) };
        self.bar(index, [Vector3::zeros(), middle], stem, paint);
        let along = if self.is_nothing(middle) { Vector3::x() } else { middle.normalize() };
        if hangs {
            self.part(index, PIN, Mesh::hook(along, HOOK * self.size, 0.3 * HOOK * self.size));
        }
        if !self.is_nothing(to - from) {
            let rod = self.thickness(mass, (to - from).norm()) / 2.0;
            self.part(index, LOAD, Mesh::rod(from, to, [rod; 2], 32));
        } else if mass > 0.0 {
            let side = self.block_side(mass);
            // Below what it hangs from.
            let height = if hangs { side.min((1.4 * middle.norm()).max(0.3 * side)) } else { side };
            let (half, width) = (along * (height / 2.0), (side.powi(3) / height).sqrt());
            self.part(index, LOAD, Mesh::bar(middle - half, middle + half, [width; 2]));
        }
    }

    fn block_side(&self, mass: f64) -> f64 {
        (mass / FILLING).cbrt().min(BLOCK * self.size)
    }

    /// Bars to points, pins and masses that links and beams do not reach; a block for a mass at its end.
    fn bars(&mut self) {
        for bar in &self.scene.bars {
            let (body, way) = (&self.scene.bodies[bar.body], bar.to - bar.from);
            let side = if bar.main { self.thickness(body.mass, way.norm()) } else { 0.7 * self.thickness(0.0, 0.0) };
            self.bar(bar.body, [bar.from, bar.to], side, if body.length > 0.0 { FLEXIBLE } else { LINK });
            if bar.block > 0.0 {
                let (side, along) =
                    (self.block_side(bar.block), if self.is_nothing(way) { Vector3::x() } else { way.normalize() });
                let half = along * (side / 2.0);
                self.part(bar.body, LOAD, Mesh::bar(bar.to - half, bar.to + half, [side; 2]));
            }
        }
    }

    /// What the spec says that links look like.
    fn forms(&mut self) {
        let scene = self.scene;
        for form in scene.forms.iter().filter(|form| is_drawn(form)) {
            let Some(BodyId(body)) = form.body else { continue };
            let paint = if body == 0 && has_base(self.coordinates) { BASE } else { LINK };
            self.part(body, paint, Mesh::solid(&form.frame, &form.form));
        }
    }

    /// The base of a fixed crane: a plate at the world's origin, and a pillar to where its first body begins.
    fn pedestal(&mut self) {
        let Some(body) = self.scene.bodies.first() else { return };
        let (side, first) = (self.thickness(body.mass, 0.0), self.reference[0].column(3).xyz());
        // A beam that begins at the origin is clamped to a wall.
        let wall = body.length > 0.0 && self.is_nothing(first);
        let normal = if wall { self.reference[0].column(0).xyz() } else { Vector3::z() };
        self.fixed(Owner::Ground, BASE, Mesh::rod(-normal * (0.5 * side), Vector3::zeros(), [2.0 * side; 2], 40));
        let slides =
            self.coordinates[body.own.clone()].iter().any(|coordinate| coordinate.kind == CoordinateKind::Translation);
        if !slides && !self.is_nothing(first) {
            self.fixed(Owner::Ground, BASE, Mesh::bar(Vector3::zeros(), first, [1.1 * side; 2]));
        }
    }

    /// The frame of a truck above its feet, if it has any. A spec whose frame is on the ground does not tell how high it is: it is drawn where the crane begins.
    fn chassis(&self) -> Option<Chassis> {
        let low = self.scene.supports.iter().map(|(_, at)| at.z).min_by(f64::total_cmp)?;
        let high = self.scene.supports.iter().map(|(_, at)| at.z).fold(0.0, f64::max);
        let least = LEVEL * self.size;
        let begin = if self.reference.len() > 1 { self.begin(1, 0) } else { Vector3::zeros() };
        let top = if high - low < least { low + begin.z.max(least).min(HEIGHT * self.size) } else { high };
        let depth = (top - low).max(least);
        Some(Chassis { level: top - 0.35 * depth, depth, height: (0.55 * depth).min(2.0 * LEG * self.size), begin })
    }

    /// A frame over the supports with a leg to each.
    fn feet(&mut self, &Chassis { level, depth, height, begin }: &Chassis) {
        let supports: Vec<Vector3<f64>> = self.scene.supports.iter().map(|(_, at)| *at).collect();
        let ends = |axis: usize| {
            let fold = |of: fn(f64, f64) -> f64, start| supports.iter().map(|at| at[axis]).fold(start, of);
            [fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY)]
        };
        let [spread, middle] =
            [[-1.0, 1.0], [0.5, 0.5]].map(|[a, b]| [0, 1].map(|axis| a * ends(axis)[0] + b * ends(axis)[1]));
        // As long as the feet are apart, or wide, so that the crane stands on it.
        let stands = |axis: &usize| (begin[*axis] - middle[*axis]).abs() <= 0.19 * spread[*axis];
        let across = usize::from(spread[0] > spread[1]);
        let wide = [across, 0, 1].into_iter().find(stands).unwrap_or(across);
        let long = 1 - wide;
        let mut sizes = [height; 3];
        sizes[long] = spread[long] + 0.6 * depth.min(2.0 * height);
        sizes[wide] = 0.38 * spread[wide];
        let centre = Vector3::new(middle[0], middle[1], level);
        if !self.scene.bodies[0].formed {
            self.part(0, BASE, Mesh::block(centre, sizes));
        }
        let side = (0.3 * depth).min(LEG * self.size);
        for (index, foot) in supports.into_iter().enumerate() {
            let (mut root, knee) = (centre, Vector3::new(foot.x, foot.y, level));
            root[long] = foot[long];
            self.bar(0, [root, knee], 1.2 * side, BASE);
            let half = Vector3::z() * (0.175 * side);
            self.detail(0, SLIDE, Mesh::rod(foot, knee, [0.55 * side; 2], 20), Detail::Leg(index));
            let plate = Mesh::rod(foot - half, foot + half, [1.6 * side, 1.3 * side], 28);
            self.detail(0, SLIDE, plate, Detail::Leg(index));
        }
    }

    /// A rod for each part of a connector, one for each fall of a rope, and a sheave at each point between.
    fn connector(&mut self, connector: &Connector) {
        let (radius, paint) = connector.look(self.size);
        let places: Vec<Vector3<f64>> = connector.points.iter().map(|point| point.within(self.frames)).collect();
        for (part, ends) in places.windows(2).enumerate() {
            let (from, way) = (ends[0], ends[1] - ends[0]);
            let falls = if part + 2 == places.len() { connector.falls } else { 1 };
            // Falls hang side by side.
            let aside = way.cross(&if way.y.abs() > 0.9 * way.norm() { Vector3::x() } else { Vector3::y() });
            let aside = aside.try_normalize(0.0).unwrap_or_default() * (APART * radius);
            for fall in 0..falls {
                let from = from + aside * (fall as f64 - (falls - 1) as f64 / 2.0);
                self.fixed(Owner::Part(connector.name.clone()), paint, Mesh::rod(from, from + way, [radius; 2], 16));
            }
        }
        for sheave in places.iter().skip(1).take(places.len().saturating_sub(2)) {
            self.fixed(Owner::Part(connector.name.clone()), PIN, Mesh::ball(*sheave, SHEAVE * self.size));
        }
    }
}

#[cfg(test)]
mod tests;
