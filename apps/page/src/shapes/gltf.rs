//! Shapes as glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021): a node per body, named as in the spec, in those that carry them.

use std::collections::BTreeSet;
use std::f64::consts::FRAC_1_SQRT_2;

use base64::{Engine, engine::general_purpose::STANDARD};
use crane_codegen::exchange::free_name;
use nalgebra::{Matrix4, Rotation3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

use super::{Figure, Owner, Paint, Shape};
use crate::Program;

/// Words of the format: numbers of four bytes, and what they are for.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const CORNERS: u32 = 34962;
const INDICES: u32 = 34963;

/// A document and its numbers.
#[derive(Default)]
struct Document {
    numbers: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    paints: Vec<Paint>,
    nodes: Vec<Value>,
}

/// The document as text, its numbers inside.
pub fn text(figure: &Figure, name: &str, program: Program) -> String {
    let (mut document, numbers) = document(figure, name, program);
    document["buffers"][0]["uri"] = format!("data:application/octet-stream;base64,{}", STANDARD.encode(numbers)).into();
    format!("{document:#}\n")
}

/// The document as bytes, a GLB file.
pub fn binary(figure: &Figure, name: &str, program: Program) -> Vec<u8> {
    let (document, numbers) = document(figure, name, program);
    let chunk = |mut content: Vec<u8>, kind: &[u8; 4], filling: u8| {
        content.resize(content.len().next_multiple_of(4), filling);
        [&length(content.len()), &kind[..], &content].concat()
    };
    let chunks = [chunk(document.to_string().into(), b"JSON", b' '), chunk(numbers, b"BIN\0", 0)].concat();
    [&b"glTF"[..], &2_u32.to_le_bytes(), &length(12 + chunks.len()), &chunks].concat()
}

/// A length as the format writes it. Shapes are far below its limit of 4 GB.
fn length(bytes: usize) -> [u8; 4] {
    u32::try_from(bytes).unwrap_or(u32::MAX).to_le_bytes()
}

/// The document without its numbers, and these. The root turns z, which points up in a spec, to y.
fn document(figure: &Figure, name: &str, program: Program) -> (Value, Vec<u8>) {
    let Figure { scene, frames, shapes, .. } = figure;
    let mut document = Document { nodes: vec![Value::Null], ..Document::default() };
    // Other programs find nodes by their names.
    let mut names = BTreeSet::new();
    let mut free = |name: &str| free_name(&mut names, name, &|_, _| true);
    for (index, (body, frame)) in scene.bodies.iter().zip(frames).enumerate() {
        let carrier = body.parent.map_or_else(Matrix4::identity, |parent| frames[parent]);
        let mut node = place(&(carrier.try_inverse().unwrap_or_else(Matrix4::identity) * frame));
        node["name"] = free(&body.name).into();
        document.dress(&mut node, &Owner::Body(index), shapes);
        document.nodes.push(node);
    }
    // Node 0 is the root, those of the bodies follow.
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); scene.bodies.len() + 1];
    for (index, body) in scene.bodies.iter().enumerate() {
        children[body.parent.map_or(0, |parent| parent + 1)].push(index + 1);
    }
    for (point, place) in &scene.points {
        children[place.body.map_or(0, |body| body + 1)].push(document.nodes.len());
        document.nodes.push(json!({"name": free(point), "translation": <[f64; 3]>::from(place.at)}));
    }
    let mut last = None;
    for Shape { owner, .. } in shapes {
        let part = match owner {
            Owner::Body(_) => continue,
            Owner::Ground => "ground",
            Owner::Part(part) => part.as_str(),
        };
        if last != Some(owner) {
            let mut node = json!({"name": free(part)});
            document.dress(&mut node, owner, shapes);
            children[0].push(document.nodes.len());
            document.nodes.push(node);
            last = Some(owner);
        }
    }
    document.nodes[0] = json!({"name": free(name), "rotation": [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]});
    for (node, children) in document.nodes.iter_mut().zip(children).filter(|(_, children)| !children.is_empty()) {
        node["children"] = children.into();
    }
    let written = json!({
        "asset": {"version": "2.0", "generator": format!("{} {}", program.name, program.version)},
        "scene": 0, "scenes": [{"name": name, "nodes": [0]}],
        "nodes": document.nodes, "meshes": document.meshes, "accessors": document.accessors, "bufferViews": document.views,
        "materials": document.paints.iter().map(material).collect::<Vec<_>>(),
        "buffers": [{"byteLength": document.numbers.len()}],
    });
    (written, document.numbers)
}

/// Place and direction of a node.
fn place(frame: &Matrix4<f64>) -> Value {
    let turn =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(frame.fixed_view::<3, 3>(0, 0).into()));
    json!({"translation": <[f64; 3]>::from(frame.column(3).xyz()), "rotation": <[f64; 4]>::from(turn.coords)})
}

/// The colour of a shape, in linear light, as dull as the page shows it.
fn material(paint: &Paint) -> Value {
    let linear = |channel: u8| {
        let share = f64::from(channel) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
    };
    let [red, green, blue] = paint.colour.map(linear);
    let look = json!({"baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.15, "roughnessFactor": 0.62});
    json!({"name": paint.name, "pbrMetallicRoughness": look})
}

impl Document {
    /// Gives a node the shapes that belong to it, one primitive for each colour.
    fn dress(&mut self, node: &mut Value, owner: &Owner, shapes: &[Shape]) {
        let mut own: Vec<Shape> = Vec::new();
        for shape in shapes.iter().filter(|shape| shape.owner == *owner) {
            match own.iter_mut().find(|other| other.paint == shape.paint) {
                Some(other) => other.mesh.add(&shape.mesh),
                None => own.push(shape.clone()),
            }
        }
        if !own.is_empty() {
            let primitives: Vec<Value> = own.iter().map(|shape| self.primitive(shape)).collect();
            node["mesh"] = self.meshes.len().into();
            self.meshes.push(json!({"name": node["name"], "primitives": primitives}));
        }
    }

    fn primitive(&mut self, Shape { paint, mesh, .. }: &Shape) -> Value {
        let known = self.paints.iter().position(|known| known == paint);
        let material = known.unwrap_or_else(|| {
            self.paints.push(*paint);
            self.paints.len() - 1
        });
        let corners: Vec<Vector3<f32>> = mesh.corners.iter().map(|corner| corner.cast::<f32>()).collect();
        let [least, most] = [Vector3::inf, Vector3::sup]
            .map(|of| corners.iter().copied().reduce(|a, b| of(&a, &b)).unwrap_or_default());
        let range = json!({"min": <[f32; 3]>::from(least), "max": <[f32; 3]>::from(most)});
        let numbers = corners.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
        let corners = self.accessor(
            numbers,
            CORNERS,
            json!({"componentType": FLOAT, "type": "VEC3", "count": corners.len()}),
            range,
        );
        let indices: Vec<u8> = mesh.triangles.iter().flatten().flat_map(|corner| length(*corner)).collect();
        let count = json!({"componentType": UNSIGNED, "type": "SCALAR", "count": 3 * mesh.triangles.len()});
        let indices = self.accessor(indices, INDICES, count, json!({}));
        json!({"attributes": {"POSITION": corners}, "indices": indices, "material": material})
    }

    /// Appends numbers, all of four bytes; returns the index of the accessor.
    fn accessor(&mut self, numbers: Vec<u8>, target: u32, mut accessor: Value, range: Value) -> usize {
        let place =
            json!({"buffer": 0, "byteOffset": self.numbers.len(), "byteLength": numbers.len(), "target": target});
        self.numbers.extend(numbers);
        accessor["bufferView"] = self.views.len().into();
        self.views.push(place);
        if let (Value::Object(accessor), Value::Object(range)) = (&mut accessor, range) {
            accessor.extend(range);
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
