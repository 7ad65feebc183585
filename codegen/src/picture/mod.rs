//! A chain as a picture (SVG): bodies, frames, joints, elements, supports, drives, cylinders, points, and a table of coordinates.
//!
//! Drawn at the guess and with default parameters, in cabinet projection: x to the right, z up, y away from the reader at
//! half its length. Colours: M. Okabe, K. Ito, Color Universal Design, 2008.

mod cylinders;

use std::fmt::Write;

use cylinders::Pins;

use crate::chain::{Body, BodyId, Chain, CoordinateId, CoordinateKind, Frame, Vector};
use crate::exchange::xml::escaped;

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

/// A joint's coordinate, where it acts, and along or about which direction.
struct Joint {
    coordinate: CoordinateId,
    at: Vector,
    axis: Vector,
}

/// The picture of a chain.
#[must_use]
pub fn picture(chain: &Chain) -> String {
    let (frames, joints) = poses(chain);
    let pins: Vec<Pins> = chain.cylinders.iter().map(|cylinder| Pins::of(chain, cylinder, &frames, &joints)).collect();
    let mut places = places(chain, &frames);
    places.extend(pins.iter().flat_map(|pins| pins.places()));
    let mut sheet = Sheet::new(places);
    links(&mut sheet, chain, &frames);
    supports(&mut sheet, chain, &frames);
    cylinders::cylinders(&mut sheet, chain, &pins);
    for (body, frame) in chain.bodies.iter().zip(&frames) {
        if body.length.is_zero() || !is_inner(chain, body) {
            sheet.axes(frame);
        }
    }
    masses(&mut sheet, chain, &frames);
    let numbered: Vec<&Joint> = joints.iter().filter(|joint| role(chain, joint.coordinate) != "element").collect();
    // All coordinates of the base act at one place and share one mark.
    let base = numbered.iter().take_while(|joint| role(chain, joint.coordinate) == "base").count();
    if let (Some(first), 1..) = (numbered.first(), base) {
        let at = sheet.project(first.at);
        sheet.label(at, &if base > 1 { format!("0–{}", base - 1) } else { "0".to_owned() });
    }
    pads(&mut sheet, chain, &frames);
    let held = chain.held_by_pads();
    for joint in numbered.iter().skip(base).filter(|joint| !held.contains(&joint.coordinate)) {
        sheet.joint(chain, joint);
    }
    for point in &chain.points {
        let defaults = chain.parameter_defaults();
        let at =
            sheet.project(frames[point.body.0].transform_point([0, 1, 2].map(|i| point.position[i].at(&defaults))));
        let _ = writeln!(
            sheet.svg,
            "<path d='M{0:.1} {1:.1}l8 8m0 -8l-8 8' stroke='{INK}' fill='none'/>",
            at.0 - 4.0,
            at.1 - 4.0
        );
        sheet.label(at, &point.name);
    }
    table(&mut sheet, chain, &numbered);
    sheet.finish(chain)
}

/// Frames of all bodies, and the joints between them.
fn poses(chain: &Chain) -> (Vec<Frame>, Vec<Joint>) {
    let defaults = chain.parameter_defaults();
    let mut joints = Vec::new();
    let mut frames: Vec<Frame> = Vec::new();
    for body in &chain.bodies {
        let mut frame = body.parent.map_or(Frame::WORLD, |BodyId(parent)| frames[parent]);
        for step in &body.path {
            for id in step.coordinates() {
                let axis = frame.axes[chain.coordinates[id.0].axis.index()];
                joints.push(Joint { coordinate: *id, at: frame.origin, axis });
            }
            frame = frame.after(step, chain, &chain.guess, &defaults);
        }
        frames.push(frame);
    }
    (frames, joints)
}

/// The role of a coordinate, in one word.
fn role(chain: &Chain, id: CoordinateId) -> &'static str {
    if chain.base.contains(&Some(id)) {
        "base"
    } else if chain.is_prescribed(id) {
        "prescribed"
    } else if chain.drives.iter().any(|drive| drive.coordinate == id) {
        "driven"
    } else if chain.is_of_element(id) {
        "element"
    } else {
        "passive"
    }
}

/// Whether a rigid element is attached to another one of its link.
fn is_inner(chain: &Chain, body: &Body) -> bool {
    chain.bodies.iter().find(|other| other.link == body.link).is_some_and(|first| first.name != body.name)
}

/// The end of a body, its length away along x.
fn end(chain: &Chain, body: usize, frame: &Frame) -> Vector {
    frame.transform_point([chain.bodies[body].length.at(&chain.parameter_defaults()), 0.0, 0.0])
}

/// Everything that must be in view.
fn places(chain: &Chain, frames: &[Frame]) -> Vec<Vector> {
    let defaults = chain.parameter_defaults();
    let mut places: Vec<Vector> = vec![[0.0; 3]];
    for (index, frame) in frames.iter().enumerate() {
        places.extend([frame.origin, end(chain, index, frame)]);
    }
    let base = frames.first().unwrap_or(&Frame::WORLD);
    places.extend(
        chain.supports.iter().map(|support| base.transform_point([0, 1, 2].map(|i| support.position[i].at(&defaults)))),
    );
    places.extend(
        chain
            .points
            .iter()
            .map(|point| frames[point.body.0].transform_point([0, 1, 2].map(|i| point.position[i].at(&defaults)))),
    );
    places
}

/// Lines from frame to frame; elements blue, with ticks between them.
fn links(sheet: &mut Sheet, chain: &Chain, frames: &[Frame]) {
    let fixed = chain.base.iter().all(Option::is_none);
    let stand = if fixed { [0.0; 3] } else { frames.first().map_or([0.0; 3], |frame| frame.origin) };
    let defaults = chain.parameter_defaults();
    for (index, (body, frame)) in chain.bodies.iter().zip(frames).enumerate() {
        // From the axis of the body that carries it.
        let along = |BodyId(parent): BodyId| {
            let carrier = &chain.bodies[parent];
            let along = if carrier.length.is_zero() { 0.0 } else { body.along.at(&defaults) };
            frames[parent].transform_point([along, 0.0, 0.0])
        };
        sheet.line(body.parent.map_or(stand, along), frame.origin, INK, 3.0);
        if !body.length.is_zero() {
            sheet.line(frame.origin, end(chain, index, frame), BLUE, 7.0);
            if is_inner(chain, body) {
                let (x, y) = sheet.project(frame.origin);
                let _ = writeln!(
                    sheet.svg,
                    "<circle cx='{x:.1}' cy='{y:.1}' r='3.2' fill='#fff' stroke='{BLUE}' stroke-width='1.5'/>"
                );
            }
        }
    }
    for point in &chain.points {
        let frame = &frames[point.body.0];
        sheet.line(frame.origin, frame.transform_point([0, 1, 2].map(|i| point.position[i].at(&defaults))), GREY, 1.0);
    }
}

/// The pads of telescopes: a bar on both sides of the axis, at the end of the outer beam and at the beginning of the inner one.
fn pads(sheet: &mut Sheet, chain: &Chain, frames: &[Frame]) {
    /// Half the length of a bar and its distance from the axis, pixels.
    const BAR: [f64; 2] = [5.0, 7.0];
    for stage in chain.stages() {
        let BodyId(last) = stage.outer.last();
        let front = (&frames[last], end(chain, last, &frames[last]));
        let rear = &frames[stage.inner.0];
        for (frame, at) in [front, (rear, rear.origin)] {
            let [along, across] = BAR.map(|pixels| pixels / sheet.scale);
            let [x, y, _] = frame.axes;
            for side in [-across, across] {
                let place = |along: f64| [0, 1, 2].map(|i| at[i] + along * x[i] + side * y[i]);
                sheet.line(place(-along), place(along), INK, 4.0);
            }
        }
    }
}

/// A spring under every support.
fn supports(sheet: &mut Sheet, chain: &Chain, frames: &[Frame]) {
    let defaults = chain.parameter_defaults();
    let Some(base) = frames.first() else { return };
    for support in &chain.supports {
        let position = base.transform_point([0, 1, 2].map(|i| support.position[i].at(&defaults)));
        sheet.line(base.transform_point([0.0, support.position[1].at(&defaults), 0.0]), position, GREY, 1.0);
        let at = sheet.project(position);
        let _ = writeln!(
            sheet.svg,
            "<path d='M{:.1} {:.1}l4 3l-8 4l8 4l-8 4l4 3m-8 0h16' fill='none' stroke='{VERMILLION}' stroke-width='1.3'/>",
            at.0, at.1
        );
        sheet.label((at.0, at.1 + 18.0), &support.name);
    }
}

/// Centres of mass, the larger the heavier.
fn masses(sheet: &mut Sheet, chain: &Chain, frames: &[Frame]) {
    let defaults = chain.parameter_defaults();
    let heaviest =
        chain.bodies.iter().flat_map(|body| &body.parts).map(|part| part.mass.at(&defaults)).fold(0.0, f64::max);
    for (body, frame) in chain.bodies.iter().zip(frames).filter(|(body, _)| body.length.is_zero()) {
        for part in &body.parts {
            let (x, y) = sheet.project(frame.transform_point([0, 1, 2].map(|i| part.com[i].at(&defaults))));
            let radius = 2.0 + 9.0 * (part.mass.at(&defaults) / heaviest).max(0.0).cbrt();
            let _ = writeln!(
                sheet.svg,
                "<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}' fill='{GREY}' fill-opacity='0.35'/>"
            );
        }
    }
}

/// Coordinates of base and joints with their places in q, and flexible links in one line each.
fn table(sheet: &mut Sheet, chain: &Chain, joints: &[&Joint]) {
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
    for joint in joints {
        let coordinate = &chain.coordinates[joint.coordinate.0];
        let unit = if coordinate.kind == CoordinateKind::Rotation { "rad" } else { "m" };
        let start = format!("{:.4} {unit}", chain.guess[joint.coordinate.0]);
        row([&joint.coordinate.0.to_string(), &coordinate.name, role(chain, joint.coordinate), &start], INK);
    }
    for (index, body) in chain.bodies.iter().enumerate().filter(|(_, body)| !body.length.is_zero()) {
        if !is_inner(chain, body) {
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
fn cabinet([x, y, z]: Vector) -> (f64, f64) {
    /// Half the length, at 30°.
    const AWAY: (f64, f64) = (0.433, 0.25);
    (x + AWAY.0 * y, z + AWAY.1 * y)
}

impl Sheet {
    fn new(places: Vec<Vector>) -> Self {
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

    fn project(&self, point: Vector) -> (f64, f64) {
        let (across, up) = cabinet(point);
        (self.shift.0 + self.scale * across, self.shift.1 - self.scale * up)
    }

    fn line(&mut self, from: Vector, to: Vector, colour: &str, width: f64) {
        let (a, b) = (self.project(from), self.project(to));
        let _ = writeln!(
            self.svg,
            "<line x1='{:.1}' y1='{:.1}' x2='{:.1}' y2='{:.1}' stroke='{colour}' stroke-width='{width}' stroke-linecap='round'/>",
            a.0, a.1, b.0, b.1
        );
    }

    /// A small filled circle.
    fn dot(&mut self, point: Vector, radius: f64) {
        let (x, y) = self.project(point);
        let _ = writeln!(self.svg, "<circle cx='{x:.1}' cy='{y:.1}' r='{radius}' fill='{INK}'/>");
    }

    /// The axes of a frame: x, y, z in three colours.
    fn axes(&mut self, frame: &Frame) {
        for (axis, colour) in frame.axes.iter().zip([VERMILLION, GREEN, BLUE]) {
            let length = FRAME / self.scale;
            self.line(frame.origin, [0, 1, 2].map(|i| frame.origin[i] + length * axis[i]), colour, 1.4);
        }
    }

    /// A circle for a rotation, a square for a translation, filled if a drive moves it; with its index in q.
    fn joint(&mut self, chain: &Chain, joint: &Joint) {
        let (x, y) = self.project(joint.at);
        let fill = if matches!(role(chain, joint.coordinate), "driven" | "prescribed") { INK } else { "#fff" };
        let style = format!("fill='{fill}' stroke='{INK}' stroke-width='1.6'");
        let _ = match chain.coordinates[joint.coordinate.0].kind {
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
        self.label((x, y), &joint.coordinate.0.to_string());
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
            let (across, up) = (libm::cos(turn), libm::sin(turn));
            (x + reach * across - if across < -0.1 { width } else { 0.0 }, y - reach * up + 4.0)
        });
        let spot = candidates.into_iter().find(|spot| free(*spot, &self.labels)).unwrap_or((x + 15.0, y + 4.0));
        self.labels.push((spot.0, spot.1, width));
        let _ = writeln!(self.texts, "<text x='{:.1}' y='{:.1}'>{}</text>", spot.0, spot.1, escaped(text));
    }

    fn finish(self, chain: &Chain) -> String {
        let (width, height) = (DRAWING.0 + TABLE, DRAWING.1);
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}' \
             font-family='sans-serif' font-size='13' fill='{INK}'>\n<title>{0}</title>\n<rect width='100%' height='100%' \
             fill='#fff'/>\n<text x='20' y='30' font-size='16'>{0}</text>\n{1}<g stroke='#fff' stroke-width='3' \
             paint-order='stroke'>\n{3}</g>\n<text x='20' y='{2}' fill='{GREY}'>\
             ○ turns  □ slides  ● driven  |  axes: x orange, y green, z blue  |  grey: centres of mass, cylinders  |  spring: support\
             </text>\n</svg>\n",
            escaped(&chain.title),
            self.svg,
            height - 14.0,
            self.texts
        )
    }
}
