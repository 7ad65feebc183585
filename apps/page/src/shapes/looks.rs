//! Shapes as URDF and MJCF have them: boxes, cylinders and balls; what else there is has files of triangles, STL.

use std::collections::BTreeMap;

use crane_codegen::chain::{BodyId, Form, Frame};
use crane_codegen::exchange::Look;
use nalgebra::Vector3;

use super::{Figure, Mesh, Owner, Shape};
use crate::scene::{Body, is_drawn};

/// Files of triangles, STL, by their paths from the exported file.
pub type Surfaces = BTreeMap<String, Vec<u8>>;

/// The looks of a crane, and the files that they need. `folder`: where these are, as the exported file names it.
///
/// Cylinders, springs and ropes lead from body to body, which no link does: they are left out.
pub fn looks(figure: &Figure, folder: &str) -> (Vec<Look>, Surfaces) {
    let mut files = Surfaces::new();
    // What is guessed of a link whose spec names surfaces is in place of these, if nobody has read them.
    let named: Vec<&Look> = figure.scene.forms.iter().filter(|form| !is_drawn(form)).collect();
    let replaced = |body: usize| {
        let Body { length, formed, .. } = figure.scene.bodies[body];
        length == 0.0 && !formed && named.iter().any(|form| form.body == Some(BodyId(body)))
    };
    let mut looks: Vec<Look> = named.iter().map(|form| (*form).clone()).collect();
    for Shape { owner, paint, mesh, .. } in &figure.shapes {
        let (body, of) = match owner {
            Owner::Body(body) if replaced(*body) => continue,
            Owner::Body(body) => (Some(BodyId(*body)), figure.scene.bodies[*body].name.as_str()),
            Owner::Ground => (None, "ground"),
            Owner::Part(_) => continue,
        };
        let (frame, form) = mesh.solid.clone().unwrap_or_else(|| {
            // No body has a dot in its name.
            let name = format!("{of}.{}", files.len() + 1);
            let file = format!("{folder}/{name}.stl");
            files.insert(file.clone(), stl(mesh));
            (Frame::WORLD, Form::Mesh { file, scale: 1.0, surface: None })
        });
        let colour = paint.colour.map(|channel| f64::from(channel) / 255.0);
        looks.push(Look { body, frame, form, paint: Some((paint.name, colour)) });
    }
    (looks, files)
}

/// Triangles as binary STL, m: a head of 80 bytes, their number, and for each its normal, its corners and two bytes.
pub(super) fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(u32::try_from(mesh.triangles.len()).unwrap_or(u32::MAX).to_le_bytes());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        for vector in [normal, a, b, c] {
            bytes.extend(Vector3::iter(&vector.cast::<f32>()).flat_map(|number| number.to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}
