//! Masses of bodies from their shapes.
//!
//! Inertias of solid shapes about their centres are as in any book on mechanics; a capsule is a cylinder and two half balls.

use std::f64::consts::PI;

use super::File;
use super::bodies::Placed;
use crate::chain::{Form, Frame, Vector};
use crate::exchange::import::document::Element;
use crate::exchange::import::mistakes::rule;
use crate::exchange::import::robot::is_visible;
use crate::exchange::mass::Lump;
use crate::exchange::rotation::{along_z, length};

/// Density of a shape that has neither density nor mass, kg/m³.
const WATER: f64 = 1000.0;
/// What geoms have besides masses.
pub(super) const SHAPES: &str = "contacts, shapes and colours";
/// Shapes without mass: the ground.
const MASSLESS: [&str; 2] = ["plane", "hfield"];

/// The last group of geoms that MuJoCo shows unless it is asked for others.
const LAST_SHOWN: i64 = 2;

/// Leaves out a geom, or what was not read of it.
pub(super) fn leave_out(node: Element<'_, '_>) {
    node.leave_out(SHAPES);
    node.leave_out_rest(SHAPES);
}

impl<'a, 'i> File<'a, 'i> {
    /// What a body looks like, in its frame: solids of the groups that MuJoCo shows. Others are left out.
    pub(super) fn looks(&mut self, inside: &[Placed<'a, 'i>], body: &str) -> Vec<(Frame, Form)> {
        let mut looks = Vec::new();
        for geom in inside.iter().filter(|inner| inner.node.name() == "geom") {
            let &Placed { node, ref frame, class } = geom;
            let group = self.classes.text(node, class, "group").and_then(|group| group.trim().parse().ok());
            if group.unwrap_or(0) > LAST_SHOWN || self.classes.text(node, class, "mesh").is_some() {
                continue;
            }
            // Numbers that cannot be read are told where a mass depends on them.
            let known = self.reader.mistakes.len();
            let owner = format!("a geom of body `{body}`");
            let kind = self.classes.text(node, class, "type").unwrap_or("sphere");
            let solid = self.sized(node, class, kind, &owner).and_then(|(solid, ends)| Some((solid?, ends)));
            let look = solid.and_then(|(solid, ends)| Some((self.placed(node, class, ends, &owner), solid.form()?)));
            self.reader.mistakes.truncate(known);
            if let Some((placement, form)) = look {
                let _ = node.read();
                looks.push((frame.outer(&placement), form));
            }
        }
        looks
    }

    /// A shape in the frame of its body; `None` if it has no mass. `stands`: whether the body is fixed, so that its mass does not matter.
    pub(super) fn shape(&mut self, shape: &Placed<'a, 'i>, body: &str, stands: bool) -> Option<Lump> {
        let &Placed { node, ref frame, class } = shape;
        // Of a body that stands, the mass counts in the sum alone.
        if stands && self.masses.total.is_none() {
            leave_out(node);
            return None;
        }
        let lump = self.solid(node, frame, class, body);
        node.read().leave_out_rest(SHAPES);
        lump
    }

    fn solid(&mut self, node: Element<'a, 'i>, frame: &Frame, class: Option<&str>, body: &str) -> Option<Lump> {
        let owner = format!("a geom of body `{body}`");
        let mass = self.number(node, class, "mass", &owner);
        let density = self.number(node, class, "density", &owner).unwrap_or(WATER);
        let kind = self.classes.text(node, class, "type").unwrap_or("sphere");
        let mesh = self.classes.text(node, class, "mesh").is_some();
        if mass.unwrap_or(density) == 0.0 || MASSLESS.contains(&kind) {
            return None;
        }
        let (solid, ends) = self.sized(node, class, kind, &owner)?;
        let shell = self.classes.text(node, class, "shellinertia") == Some("true");
        let Some(solid) = solid.filter(|_| !mesh && !shell) else {
            let what = if mesh { "mesh" } else { kind };
            self.reader.mistakes.push(rule::unknown_mass(node.tag(), body, what));
            return None;
        };
        let placement = self.placed(node, class, ends, &owner);
        let mass = mass.unwrap_or_else(|| density * solid.volume());
        let [xx, yy, zz] = solid.squared_radii_of_gyration().map(|square| mass * square);
        Some(Lump { mass, com: [0.0; 3], tensor: [xx, yy, zz, 0.0, 0.0, 0.0] }.seen_through(&frame.outer(&placement)))
    }

    /// The solid of a geom, if it is one whose mass is known, and the ends of its axis if these are given; `None` after a mistake.
    fn sized(&mut self, node: Element<'a, 'i>, class: Option<&str>, kind: &str, owner: &str) -> Option<Sized> {
        let size = match self.classes.find(node, class, "size") {
            Some(attribute) => self.reader.some_numbers(attribute, &format!("`size` of {owner}"))?,
            None => Vec::new(),
        };
        let ends = self.numbers::<6>(node, class, "fromto", owner);
        Some((Solid::new(kind, &size, ends), ends))
    }

    /// The pose of a geom, with z along its axis.
    fn placed(&mut self, node: Element<'a, 'i>, class: Option<&str>, ends: Option<[f64; 6]>, owner: &str) -> Frame {
        match ends {
            Some([a, b, c, d, e, f]) => {
                let middle = [a + d, b + e, c + f].map(|sum| 0.5 * sum);
                Frame { origin: middle, ..along_z([d - a, e - b, f - c]) }
            }
            None => self.pose(node, class, owner),
        }
    }
}

/// A solid, and the ends of its axis.
type Sized = (Option<Solid>, Option<[f64; 6]>);

/// A solid about its centre, z along its axis.
enum Solid {
    /// By its three semi-axes, m.
    Ellipsoid(Vector),
    /// By half its sides, m.
    Block(Vector),
    /// By radius and half its length, m.
    Cylinder(f64, f64),
    /// By its radius and half the length between the centres of its ends, m.
    Capsule(f64, f64),
}

impl Solid {
    /// The solid of a `<geom>`; `None` if its mass is not known.
    fn new(kind: &str, size: &[f64], ends: Option<[f64; 6]>) -> Option<Self> {
        let along = ends.map(|[a, b, c, d, e, f]| 0.5 * length([d - a, e - b, f - c]));
        let radius = *size.first()?;
        // With `fromto`, the first size is the one across the axis.
        let half_length = || along.or_else(|| size.get(1).copied());
        let half_sides = || match along {
            Some(along) => Some([radius, radius, along]),
            None => <Vector>::try_from(size.get(..3)?).ok(),
        };
        let solid = match kind {
            "sphere" => Solid::Ellipsoid([radius; 3]),
            "ellipsoid" => Solid::Ellipsoid(half_sides()?),
            "box" => Solid::Block(half_sides()?),
            "cylinder" => Solid::Cylinder(radius, half_length()?),
            "capsule" => Solid::Capsule(radius, half_length()?),
            _ => return None,
        };
        Some(solid)
    }

    /// What it looks like; `None` of an ellipsoid, and of what is too small or too large to be seen.
    fn form(&self) -> Option<Form> {
        let form = match *self {
            Solid::Ellipsoid([a, b, c]) if a == b && b == c => Form::Capsule { diameter: 2.0 * a, length: 0.0 },
            Solid::Ellipsoid(_) => return None,
            Solid::Block(sides) => Form::Box(sides.map(|side| 2.0 * side)),
            Solid::Cylinder(r, h) => Form::Cylinder { diameter: 2.0 * r, length: 2.0 * h },
            Solid::Capsule(r, h) => Form::Capsule { diameter: 2.0 * r, length: 2.0 * h },
        };
        is_visible(&form).then_some(form)
    }

    /// Volume, m³.
    fn volume(&self) -> f64 {
        match *self {
            Solid::Ellipsoid([a, b, c]) => 4.0 / 3.0 * PI * a * b * c,
            Solid::Block([a, b, c]) => 8.0 * a * b * c,
            Solid::Cylinder(r, h) => PI * r * r * 2.0 * h,
            Solid::Capsule(r, h) => PI * r * r * (2.0 * h + 4.0 / 3.0 * r),
        }
    }

    /// Squares of the radii of gyration about x, y, z, m².
    fn squared_radii_of_gyration(&self) -> Vector {
        let of_three =
            |[a, b, c]: Vector, share: f64| [b * b + c * c, a * a + c * c, a * a + b * b].map(|sum| share * sum);
        match *self {
            Solid::Ellipsoid(axes) => of_three(axes, 1.0 / 5.0),
            Solid::Block(sides) => of_three(sides, 1.0 / 3.0),
            Solid::Cylinder(r, h) => {
                let across = 0.25 * r * r + h * h / 3.0;
                [across, across, 0.5 * r * r]
            }
            Solid::Capsule(r, h) => {
                // Fractions of the volume.
                let ball = 4.0 / 3.0 * r / (2.0 * h + 4.0 / 3.0 * r);
                let cylinder = 1.0 - ball;
                let along = cylinder * 0.5 * r * r + ball * 0.4 * r * r;
                // The centre of a half ball is 3/8 of its radius beyond the end of the cylinder.
                let across = cylinder * (0.25 * r * r + h * h / 3.0) + ball * (0.4 * r * r + h * h + 0.75 * h * r);
                [across, across, along]
            }
        }
    }
}
