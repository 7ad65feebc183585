//! What links look like.

use std::f64::consts::FRAC_PI_2;

use super::{Check, LinkBodies};
use crate::chain::{Axis, Form, Shape, Value};
use crate::diagnostic::rule;
use crate::expand::placement;
use crate::node::Limit;
use crate::spec::{self, AxisName, Link, RoundShape};

/// Ends of the names of files that readers of URDF and MJCF know alike.
const MESHES: [&str; 2] = ["stl", "obj"];

impl Check<'_> {
    /// The forms of a link; on a beam, each is carried by the element at its place.
    pub(super) fn shapes_of(&mut self, link: &Link, bodies: &LinkBodies) {
        let given = link.shape.as_ref().and_then(|shape| shape.value.as_ref());
        for shape in given.into_iter().flat_map(|shapes| &shapes.0).filter_map(|shape| shape.value.as_ref()) {
            let (form, at, rotation) = match shape {
                spec::Shape::Box(shape) => {
                    let sides = self.vector(&shape.size, "`size`");
                    (Form::Box(sides), &shape.at, &shape.rotation)
                }
                spec::Shape::Cylinder(shape) => {
                    let [diameter, length] = self.round(shape, Limit::Positive);
                    (Form::Cylinder { diameter, length }, &shape.at, &shape.rotation)
                }
                spec::Shape::Capsule(shape) => {
                    let [diameter, length] = self.round(shape, Limit::NotNegative);
                    (Form::Capsule { diameter, length }, &shape.at, &shape.rotation)
                }
                spec::Shape::Mesh(shape) => {
                    let file = self.text(Some(&shape.file), "`file` of a mesh").unwrap_or_default();
                    let end = file.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
                    if shape.file.value.is_some() && !end.is_some_and(|end| MESHES.contains(&end.as_str())) {
                        self.report(rule::unknown_mesh(shape.file.span, &file));
                    }
                    let scale = shape.scale.as_ref();
                    let scale = scale.map_or(1.0, |scale| self.constant(scale, "`scale`"));
                    (Form::Mesh { file, scale, surface: None }, &shape.at, &shape.rotation)
                }
            };
            let [x, y, z] = self.vector_or_zero(at.as_ref(), "`at`");
            let mut turns = self.turns(rotation.as_ref());
            if let spec::Shape::Cylinder(round) | spec::Shape::Capsule(round) = shape {
                turns.extend(onto(round.axis.as_ref().and_then(|axis| axis.value)));
            }
            let (body, x) = self.element_at(bodies, x);
            if let Some(body) = body {
                let path = placement::transform([x, y, z], &turns, Vec::new());
                self.shapes.push(Shape { body, path, form });
            }
        }
    }

    /// Diameter and length.
    fn round(&mut self, given: &RoundShape, length: Limit) -> [Value; 2] {
        [self.number(&given.diameter, "`diameter`"), self.number_within(&given.length, length, "`length`")]
    }
}

/// The turn that brings z onto an axis.
fn onto(axis: Option<AxisName>) -> Option<(Axis, Value)> {
    match axis? {
        AxisName::X => Some((Axis::Y, Value::Constant(FRAC_PI_2))),
        AxisName::Y => Some((Axis::X, Value::Constant(-FRAC_PI_2))),
        AxisName::Z => None,
    }
}
