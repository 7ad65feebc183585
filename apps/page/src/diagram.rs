//! A scene as a diagram (SVG): links, bars and forms, frames, joints, elements, supports, drives, cylinders, points, and a table of coordinates.
//!
//! Drawn at the guess, in cabinet projection: x to the right, z up, y away from the reader at half its length. Colours: M. Okabe,
//! K. Ito, Color Universal Design, 2008.

use std::fmt::Write;

use crane_codegen::chain::{BodyId, Chain};
use crane_codegen::exchange::xml::escaped;
use crane_live::LiveCrane;
use crane_model::{CoordinateInfo, CoordinateKind, CoordinateRole, dyn_crane::DynCrane};
use nalgebra::{Matrix4, Vector3};

use crate::bars::masses;
use crate::scene::{Body, Connector, Pins, Place, Scene, is_drawn};
use crate::shapes::{BARREL_LENGTH, Mesh};

const BLUE: &str = "#0072b2";
const VERMILLION: &str = "#d55e00";
const GREEN: &str = "#009e73";
const GREY: &str = "#7a828c";
const INK: &str = "#1c2330";

/// Size of the drawing, and of the table beside it.
const DRAWING: (f64, f64) = (740.0, 560.0);
const TABLE: f64 = 380.0;
/// Free space around the drawing.
const MARGIN: f64 = 75.0;
/// Length of the axes of a frame, radius of a joint, height of a row.
const FRAME: f64 = 26.0;
const JOINT: f64 = 6.0;
const ROW: f64 = 19.0;

type Point = Vector3<f64>;

/// A joint's coordinate, where it acts, and what is known of it.
struct Joint<'a> {
    index: usize,
    at: Point,
    info: &'a CoordinateInfo,
}

/// A scene and the frames of its bodies.
struct Drawn<'a> {
    live: &'a LiveCrane,
    scene: Scene,
    frames: Vec<Matrix4<f64>>,
}

/// The diagram of a crane with its present parameters.
#[must_use]
pub fn diagram(live: &LiveCrane) -> String {
    let (chain, crane) = (live.chain(), live as &dyn DynCrane);
    let guess = chain.guess_at(live.parameters());
    let scene = Scene::new(live, &guess);
    let drawn = Drawn { live, frames: scene.bodies.iter().map(|body| body.frame).collect(), scene };
    let mut sheet = Sheet::new(drawn.places());
    drawn.forms(&mut sheet);
    drawn.links(&mut sheet);
    drawn.supports(&mut sheet);
    drawn.connectors(&mut sheet);
    drawn.cylinders(&mut sheet);
    for (index, frame) in drawn.frames.iter().enumerate() {
        if drawn.scene.bodies[index].length == 0.0 || !drawn.is_inner(index) {
            sheet.axes(frame);
        }
    }
    drawn.masses(&mut sheet);
    let joint = |(index, info)| {
        let [at, _] = chain.axis(crane_codegen::chain::CoordinateId(index), &guess, live.parameters());
        Joint { index, at: at.into(), info }
    };
    let joints: Vec<Joint> = crane.description().coordinates.iter().enumerate().map(joint).collect();
    let numbered: Vec<&Joint> = joints.iter().filter(|joint| !joint.info.role.is_element()).collect();
    // All coordinates of the base act at one place and share one mark.
    let base = numbered.iter().take_while(|joint| joint.info.role == CoordinateRole::Base).count();
    if let (Some(first), 1..) = (numbered.first(), base) {
        let at = sheet.project(first.at);
        sheet.label(at, &if base > 1 { format!("0–{}", base - 1) } else { "0".to_owned() });
    }
    drawn.pads(&mut sheet);
    for hinge in &drawn.scene.hinges {
        sheet.ring(hinge.place.within(&drawn.frames));
    }
    let held = chain.held_by_pads();
    let is_held = |joint: &&&Joint| held.iter().any(|coordinate| coordinate.0 == joint.index);
    for joint in numbered.iter().skip(base).filter(|joint| !is_held(joint)) {
        sheet.joint(joint);
    }
    for (name, place) in &drawn.scene.points {
        let at = sheet.project(place.within(&drawn.frames));
        let _ = writeln!(
            sheet.svg,
            "<path d='M{0:.1} {1:.1}l8 8m0 -8l-8 8' stroke='{INK}' fill='none'/>",
            at.0 - 4.0,
            at.1 - 4.0
        );
        sheet.label(at, name);
    }
    table(&mut sheet, chain, &numbered, &guess);
    sheet.finish(&chain.title)
}

impl Drawn<'_> {
    fn within(&self, body: usize, at: Point) -> Point {
        Place { body: Some(body), at }.within(&self.frames)
    }

    /// Whether a rigid element is attached to another one of its link.
    fn is_inner(&self, index: usize) -> bool {
        let bodies = &self.scene.bodies;
        bodies.iter().position(|other| other.link == bodies[index].link).is_some_and(|first| first < index)
    }

    /// The end of a body, its length away along x.
    fn end(&self, index: usize) -> Point {
        self.within(index, Vector3::x() * self.scene.bodies[index].length)
    }

    fn pins(&self) -> impl Iterator<Item = Pins> {
        self.scene.cylinders.iter().map(|cylinder| cylinder.pins(&self.frames))
    }

    /// Everything that must be in view.
    fn places(&self) -> Vec<Point> {
        let scene = &self.scene;
        let bodies = (0..scene.bodies.len()).flat_map(|index| [self.within(index, Vector3::zeros()), self.end(index)]);
        let bars = scene.bars.iter().map(|bar| self.within(bar.body, bar.to));
        let base = usize::from(scene.bodies.is_empty());
        let supports = scene.supports.iter().filter(|_| base == 0).map(|(_, at)| self.within(0, *at));
        let held = scene.points.iter().map(|(_, place)| place);
        let held = held.chain(scene.connectors.iter().flat_map(|one| &one.points));
        let forms = scene.forms.iter().flat_map(|form| form_mesh(form, &self.frames));
        let fixed = held.map(|place| place.within(&self.frames)).chain(self.pins().flat_map(Pins::places));
        std::iter::once(Vector3::zeros()).chain(bodies).chain(bars).chain(supports).chain(fixed).chain(forms).collect()
    }

    /// The outlines of what the spec says that links look like: all forms are convex.
    fn forms(&self, sheet: &mut Sheet) {
        for form in &self.scene.forms {
            let corners = form_mesh(form, &self.frames).into_iter().map(|corner| sheet.project(corner)).collect();
            let outline: Vec<String> = hull(corners).iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            if !outline.is_empty() {
                let _ = writeln!(
                    sheet.svg,
                    "<polygon points='{}' fill='{GREY}' fill-opacity='0.12' stroke='{GREY}' stroke-opacity='0.6'/>",
                    outline.join(" ")
                );
            }
        }
    }

    /// Lines from frame to frame, and bars to what is beside them; elements blue, with ticks between them.
    fn links(&self, sheet: &mut Sheet) {
        let bodies = &self.scene.bodies;
        let fixed = self.live.chain().base.iter().all(Option::is_none);
        let stand = if fixed { Vector3::zeros() } else { self.frames.first().map_or_else(Vector3::zeros, origin) };
        for (index, Body { parent, along, length, .. }) in bodies.iter().enumerate() {
            // From the axis of the body that carries it.
            let carrier = |parent: usize| {
                let along = if bodies[parent].length == 0.0 { 0.0 } else { *along };
                self.within(parent, Vector3::x() * along)
            };
            let begin = origin(&self.frames[index]);
            sheet.line(parent.map_or(stand, carrier), begin, INK, 3.0);
            if *length != 0.0 {
                sheet.line(begin, self.end(index), BLUE, 7.0);
                if self.is_inner(index) {
                    let (x, y) = sheet.project(begin);
                    let _ = writeln!(
                        sheet.svg,
                        "<circle cx='{x:.1}' cy='{y:.1}' r='3.2' fill='#fff' stroke='{BLUE}' stroke-width='1.5'/>"
                    );
                }
            }
        }
        for bar in &self.scene.bars {
            let width = if bar.main { 3.0 } else { 1.6 };
            sheet.line(self.within(bar.body, bar.from), self.within(bar.body, bar.to), INK, width);
        }
        for place in self.scene.points.iter().map(|(_, place)| place) {
            if let Some(body) = place.body {
                sheet.line(origin(&self.frames[body]), place.within(&self.frames), GREY, 1.0);
            }
        }
    }

    /// The pads of telescopes: a bar on both sides of the axis.
    fn pads(&self, sheet: &mut Sheet) {
        /// Half the length of a bar and its distance from the axis, pixels.
        const BAR: [f64; 2] = [5.0, 7.0];
        let [along, across] = BAR.map(|pixels| pixels / sheet.scale);
        for pad in &self.scene.pads {
            for side in [-across, across] {
                let [from, to] = [-along, along].map(|x| self.within(pad.body, Vector3::new(pad.x + x, side, 0.0)));
                sheet.line(from, to, INK, 4.0);
            }
        }
    }

    /// A spring under every support.
    fn supports(&self, sheet: &mut Sheet) {
        for (name, place) in &self.scene.supports {
            let position = self.within(0, *place);
            sheet.line(self.within(0, Vector3::y() * place.y), position, GREY, 1.0);
            let at = sheet.project(position);
            let _ = writeln!(
                sheet.svg,
                "<path d='M{:.1} {:.1}l4 3l-8 4l8 4l-8 4l4 3m-8 0h16' fill='none' stroke='{VERMILLION}' stroke-width='1.3'/>",
                at.0, at.1
            );
            sheet.label((at.0, at.1 + 18.0), name);
        }
    }

    /// Springs, ropes and rods between their points.
    fn connectors(&self, sheet: &mut Sheet) {
        for Connector { rope, points, .. } in &self.scene.connectors {
            let places: Vec<Point> = points.iter().map(|point| point.within(&self.frames)).collect();
            for ends in places.windows(2) {
                sheet.line(ends[0], ends[1], GREEN, if *rope { 1.2 } else { 2.4 });
            }
        }
    }

    /// Barrel and rod between their pins, rocker and link.
    fn cylinders(&self, sheet: &mut Sheet) {
        for (cylinder, pins) in self.scene.cylinders.iter().zip(self.pins()) {
            let Pins { foot, rod, head, pivot } = pins;
            let way = rod - foot;
            if !way.norm().is_normal() {
                continue;
            }
            let barrel = foot + way * (BARREL_LENGTH * cylinder.retracted / way.norm()).min(1.0);
            if let Some(pivot) = pivot {
                sheet.line(pivot, rod, VERMILLION, 2.5);
                sheet.line(rod, head, VERMILLION, 2.5);
            }
            sheet.line(foot, rod, INK, 1.8);
            sheet.line(foot, barrel, GREY, 5.0);
            for point in pins.places() {
                sheet.dot(point, 2.4);
            }
        }
    }

    /// Centres of mass, the larger the heavier.
    fn masses(&self, sheet: &mut Sheet) {
        let rigid = masses(self.live).into_iter().filter(|anchor| self.scene.bodies[anchor.body].length == 0.0);
        let masses: Vec<(Point, f64)> =
            rigid.filter_map(|anchor| Some((self.within(anchor.body, anchor.at), anchor.mass?))).collect();
        let heaviest = masses.iter().map(|(_, mass)| *mass).fold(0.0, f64::max);
        for (at, mass) in masses {
            let (x, y) = sheet.project(at);
            let radius = 2.0 + 9.0 * (mass / heaviest).cbrt();
            let _ = writeln!(
                sheet.svg,
                "<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}' fill='{GREY}' fill-opacity='0.35'/>"
            );
        }
    }
}

fn origin(frame: &Matrix4<f64>) -> Point {
    frame.column(3).xyz()
}

/// The corners of a form in the world; none of a surface in a file.
fn form_mesh(form: &crane_codegen::exchange::Look, frames: &[Matrix4<f64>]) -> Vec<Point> {
    let Some(BodyId(body)) = form.body.filter(|_| is_drawn(form)) else { return Vec::new() };
    let corners = Mesh::solid(&form.frame, &form.form).corners;
    corners.into_iter().map(|at| Place { body: Some(body), at }.within(frames)).collect()
}

/// The convex hull of points, counter-clockwise (A. M. Andrew, Another efficient algorithm for convex hulls in two dimensions, 1979).
fn hull(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let half = |points: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut hull: Vec<(f64, f64)> = Vec::new();
        for (x, y) in points {
            while let [.., (a, b), (c, d)] = hull[..]
                && (c - a) * (y - b) <= (d - b) * (x - a)
            {
                hull.pop();
            }
            hull.push((x, y));
        }
        hull.pop();
        hull
    };
    let lower = half(&mut points.iter().copied());
    [lower, half(&mut points.iter().rev().copied())].concat()
}

/// Coordinates of base and joints with their places in q, and flexible links in one line each.
fn table(sheet: &mut Sheet, chain: &Chain, joints: &[&Joint], guess: &[f64]) {
    let left = DRAWING.0 + 10.0;
    let mut y = 62.0;
    let mut row = |cells: [&str; 4], colour: &str| {
        for (cell, x) in cells.iter().zip([0.0, 28.0, 190.0, 250.0]) {
            let _ =
                writeln!(sheet.svg, "<text x='{:.0}' y='{y:.0}' fill='{colour}'>{}</text>", left + x, escaped(cell));
        }
        y += ROW;
    };
    row(["", "coordinate", "role", "start"], GREY);
    for Joint { index, info, .. } in joints {
        let start = format!("{:.4} {}", guess[*index], info.kind.unit());
        row([&index.to_string(), &info.name, info.role.name(), &start], INK);
    }
    for (index, body) in chain.bodies.iter().enumerate().filter(|(_, body)| !body.length.is_zero()) {
        if chain.bodies[..index].iter().all(|other| other.link != body.link) {
            let count = chain.bodies.iter().filter(|other| other.link == body.link).count();
            let springs = chain.degrees_of_freedom(BodyId(index + count - 1)) - chain.degrees_of_freedom(BodyId(index));
            row(["", &format!("{}: {count} rigid elements, {springs} coordinates between", body.link), "", ""], BLUE);
        }
    }
}

/// The drawing, and the positions of labels.
struct Sheet {
    svg: String,
    scale: f64,
    shift: (f64, f64),
    /// Left edge, base line and width of occupied places.
    labels: Vec<(f64, f64, f64)>,
    /// Drawn last, over everything.
    texts: String,
}

/// Cabinet projection: right and up, m.
fn cabinet(point: Point) -> (f64, f64) {
    /// Half the length, at 30°.
    const AWAY: (f64, f64) = (0.433, 0.25);
    (point.x + AWAY.0 * point.y, point.z + AWAY.1 * point.y)
}

impl Sheet {
    fn new(places: Vec<Point>) -> Self {
        let flat: Vec<(f64, f64)> = places.into_iter().map(cabinet).collect();
        let range = |of: fn(&(f64, f64)) -> f64| {
            flat.iter().map(of).fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (across, up) = (range(|point| point.0), range(|point| point.1));
        let drawing = (DRAWING.0 - 2.0 * MARGIN, DRAWING.1 - 2.0 * MARGIN);
        let scale = (drawing.0 / (across.1 - across.0).max(1e-6)).min(drawing.1 / (up.1 - up.0).max(1e-6));
        let shift =
            (DRAWING.0 / 2.0 - scale * (across.0 + across.1) / 2.0, DRAWING.1 / 2.0 + scale * (up.0 + up.1) / 2.0);
        Self { svg: String::new(), scale, shift, labels: Vec::new(), texts: String::new() }
    }

    fn project(&self, point: Point) -> (f64, f64) {
        let (across, up) = cabinet(point);
        (self.shift.0 + self.scale * across, self.shift.1 - self.scale * up)
    }

    fn line(&mut self, from: Point, to: Point, colour: &str, width: f64) {
        let (a, b) = (self.project(from), self.project(to));
        let _ = writeln!(
            self.svg,
            "<line x1='{:.1}' y1='{:.1}' x2='{:.1}' y2='{:.1}' stroke='{colour}' stroke-width='{width}' stroke-linecap='round'/>",
            a.0, a.1, b.0, b.1
        );
    }

    /// A small filled circle.
    fn dot(&mut self, point: Point, radius: f64) {
        let (x, y) = self.project(point);
        let _ = writeln!(self.svg, "<circle cx='{x:.1}' cy='{y:.1}' r='{radius}' fill='{INK}'/>");
    }

    /// The axes of a frame: x, y, z in three colours.
    fn axes(&mut self, frame: &Matrix4<f64>) {
        for (axis, colour) in [VERMILLION, GREEN, BLUE].into_iter().enumerate() {
            let from = origin(frame);
            self.line(from, from + frame.column(axis).xyz() * (FRAME / self.scale), colour, 1.4);
        }
    }

    /// An empty circle: a pin or a ball that closes a loop.
    fn ring(&mut self, point: Point) {
        let (x, y) = self.project(point);
        let _ = writeln!(
            self.svg,
            "<circle cx='{x:.1}' cy='{y:.1}' r='4.5' fill='#fff' stroke='{INK}' stroke-width='1.6'/>"
        );
    }

    /// A circle for a rotation, a square for a translation, filled if a drive moves it; with its index in q.
    fn joint(&mut self, joint: &Joint) {
        let (x, y) = self.project(joint.at);
        let driven = matches!(joint.info.role, CoordinateRole::Driven | CoordinateRole::Prescribed);
        let style = format!("fill='{}' stroke='{INK}' stroke-width='1.6'", if driven { INK } else { "#fff" });
        let _ = match joint.info.kind {
            CoordinateKind::Rotation => writeln!(self.svg, "<circle cx='{x:.1}' cy='{y:.1}' r='{JOINT}' {style}/>"),
            CoordinateKind::Translation => writeln!(
                self.svg,
                "<rect x='{:.1}' y='{:.1}' width='{2}' height='{2}' {style}/>",
                x - JOINT,
                y - JOINT,
                2.0 * JOINT
            ),
        };
        self.labels.push((x - JOINT, y + JOINT, 2.0 * JOINT));
        self.label((x, y), &joint.index.to_string());
    }

    /// A label near a position, at a place that is still free.
    fn label(&mut self, (x, y): (f64, f64), text: &str) {
        /// Width of a letter, and height of a line.
        const LETTER: (f64, f64) = (7.2, 14.0);
        let width = LETTER.0 * text.chars().count() as f64;
        let free = |(at, level): (f64, f64), labels: &[(f64, f64, f64)]| {
            labels.iter().all(|&(other, line, length)| {
                (level - line).abs() >= LETTER.1 || at + width < other || other + length < at
            })
        };
        // Diagonally first, where no line of a link runs; then further away.
        let candidates = (0..40_u8).map(|k| {
            let turn = f64::from([1, 7, 3, 5, 2, 6, 0, 4][usize::from(k % 8)]) * std::f64::consts::FRAC_PI_4;
            let reach = 17.0 + 11.0 * f64::from(k / 8);
            let (across, up) = (turn.cos(), turn.sin());
            (x + reach * across - if across < -0.1 { width } else { 0.0 }, y - reach * up + 4.0)
        });
        let spot = candidates.into_iter().find(|spot| free(*spot, &self.labels)).unwrap_or((x + 15.0, y + 4.0));
        self.labels.push((spot.0, spot.1, width));
        let _ = writeln!(self.texts, "<text x='{:.1}' y='{:.1}'>{}</text>", spot.0, spot.1, escaped(text));
    }

    fn finish(self, title: &str) -> String {
        let (width, height) = (DRAWING.0 + TABLE, DRAWING.1);
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}' \
             font-family='sans-serif' font-size='13' fill='{INK}'>\n<title>{0}</title>\n<rect width='100%' height='100%' \
             fill='#fff'/>\n<text x='20' y='30' font-size='16'>{0}</text>\n{1}<g stroke='#fff' stroke-width='3' \
             paint-order='stroke'>\n{3}</g>\n<text x='20' y='{2}' fill='{GREY}'>\
             ○ turns  □ slides  ● driven  |  axes: x orange, y green, z blue  |  grey: centres of mass, cylinders, shapes  |  green: ropes, springs\
             </text>\n</svg>\n",
            escaped(title),
            self.svg,
            height - 14.0,
            self.texts
        )
    }
}
