//! A figure for the script of a page: shapes that keep their form, in the frames of their bodies, and the sizes of what bends or follows several bodies.

use nalgebra::Matrix4;
use serde_json::{Value, json};

use super::{
    APART, BARREL, BASE, Detail, DrawnBeam, FLEXIBLE, Figure, LINK, LINKAGE, LOAD, Owner, PAD, PASSIVE, PIN, Paint,
    ROD, SHEAVE, SLIDE, STAGE, Shape, cylinders::Sizes,
};
use crate::{
    scene::{Barrel, Body, Connector, Place, Rocker, Scene, matrix},
    strength::packed,
};
use crane_codegen::chain::Form;

/// All colours.
const PAINTS: [Paint; 12] = [BASE, LINK, FLEXIBLE, STAGE, SLIDE, LOAD, PIN, PASSIVE, BARREL, ROD, LINKAGE, PAD];

impl Figure {
    /// Everything that the page draws of the crane.
    pub fn json(&self) -> Value {
        let Scene { pose, reference, vectors, screws, bodies, supports, connectors, points, cylinders, .. } =
            &self.scene;
        let named =
            |name: &str, place: &Place| json!({"name": name, "body": place.body, "at": <[f64; 3]>::from(place.at)});
        let parts = self.shapes.iter().filter(|shape| shape.detail != Detail::Beam);
        let paints = PAINTS.iter().map(|Paint { name, colour: [red, green, blue] }| {
            ((*name).to_owned(), u32::from_be_bytes([0, *red, *green, *blue]).into())
        });
        json!({
            "size": self.size, "pose": pose, "reference": reference, "vectors": vectors, "screws": screws,
            "bodies": bodies.iter().map(body).collect::<Vec<_>>(),
            "supports": supports.iter().map(|(name, at)| json!({"name": name, "at": <[f64; 3]>::from(*at)})).collect::<Vec<_>>(),
            "points": points.iter().map(|(name, place)| named(name, place)).collect::<Vec<_>>(),
            "parts": parts.filter_map(part).collect::<Vec<_>>(),
            "beams": self.beams.iter().map(beam).collect::<Vec<_>>(),
            "connectors": connectors.iter().map(|connector| self.connector(connector)).collect::<Vec<_>>(),
            "cylinders": cylinders.iter().map(|cylinder| self.cylinder(cylinder)).collect::<Vec<_>>(),
            "paints": paints.collect::<serde_json::Map<_, _>>(),
        })
    }

    fn connector(&self, connector: &Connector) -> Value {
        let Connector { points, falls, .. } = connector;
        let (radius, paint) = connector.look(self.size);
        json!({
            "points": points.iter().map(place).collect::<Vec<_>>(), "falls": falls, "paint": paint.name,
            "radius": radius, "apart": APART * radius, "sheave": SHEAVE * self.size,
        })
    }

    fn cylinder(&self, cylinder: &Barrel) -> Value {
        let linkage = cylinder.linkage.as_ref().map(|Rocker { pivot, rocker, link, left }| {
            json!({"pivot": place(pivot), "rocker": rocker, "link": link, "left": left})
        });
        let axis = cylinder.axis.map(|(body, along)| json!({"body": body, "along": <[f64; 3]>::from(along)}));
        let Sizes { barrel, long, rod, bar, pin } = cylinder.sizes(self.size);
        json!({
            "name": cylinder.name, "foot": place(&cylinder.foot), "head": place(&cylinder.head), "linkage": linkage, "axis": axis,
            "sizes": {"barrel": barrel, "long": long, "rod": rod, "bar": bar, "pin": pin},
        })
    }
}

fn place(place: &Place) -> Value {
    json!({"body": place.body, "at": <[f64; 3]>::from(place.at)})
}

fn body(body: &Body) -> Value {
    let Body { name, link, mass, length, parent, along, own: range, frame, .. } = body;
    json!({
        "name": name, "link": link, "mass": mass, "length": length, "parent": parent, "along": along,
        "moved_by": [range.start, range.end], "frame": rows(frame),
    })
}

fn beam(beam: &DrawnBeam) -> Value {
    let DrawnBeam { name, bodies, section, paint } = beam;
    json!({"name": name, "bodies": bodies, "along": section.along, "round": section.round, "paint": paint.name})
}

/// A shape in the frame of its body, or of the world: a solid with its frame and the sides of the box around it, or triangles. What follows several bodies
/// is none.
fn part(shape: &Shape) -> Option<Value> {
    let Shape { owner, paint, mesh, detail } = shape;
    let body = match owner {
        Owner::Body(body) => Some(*body),
        Owner::Ground => None,
        Owner::Part(_) => return None,
    };
    let leg = match detail {
        Detail::Leg(leg) => Some(*leg),
        Detail::None | Detail::Beam => None,
    };
    let mut part = json!({"body": body, "paint": paint.name, "leg": leg});
    let kind = match &mesh.solid {
        Some((_, Form::Box(_))) => "box",
        Some((_, Form::Cylinder { .. })) => "cylinder",
        Some((_, Form::Capsule { .. })) => "capsule",
        Some((_, Form::Mesh { .. })) | None => "surface",
    };
    part["kind"] = kind.into();
    if let Some((frame, form)) = mesh.solid.as_ref().filter(|_| kind != "surface") {
        // As precise as a picture needs it.
        part["frame"] = rows(&matrix(frame)).iter().map(|x| single(*x)).collect();
        part["sides"] = form.sides().iter().map(|side| single(*side)).collect();
    } else {
        part["corners"] = packed(mesh.corners.iter().flat_map(|corner| <[f64; 3]>::from(*corner))).into();
        part["triangles"] = packed(mesh.triangles.iter().flatten().map(|corner| *corner as f64)).into();
    }
    Some(part)
}

/// A number with 7 digits.
#[expect(clippy::cast_possible_truncation, reason = "more digits than anybody can see")]
fn single(number: f64) -> Value {
    (number as f32).into()
}

/// The upper three rows.
fn rows(frame: &Matrix4<f64>) -> Vec<f64> {
    frame.transpose().iter().copied().take(12).collect()
}
