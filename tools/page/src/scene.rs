//! What moves, as a page draws it: frames of the bodies at one pose, and a screw for each coordinate.
//!
//! `T_p(q) = exp(ξ₁ (q₁ − q₁⁰)) … exp(ξ_n (q_n − q_n⁰)) T_p(q⁰)`, over the coordinates that move body p: the product of
//! exponentials (R. W. Brockett, Robotic manipulators and the product of exponentials formula, 1984). Exact for any chain,
//! so that the page can draw any pose, exaggerated and modal ones too. Three coordinates that turn by a rotation vector ρ
//! share one factor, `exp(ξ_i ρ_1 + ξ_j ρ_2 + ξ_k ρ_3)`, with screws at ρ = 0: q⁰ is the pose with these at zero.

use crane_codegen::chain::{
    BodyId, Coordinate, CoordinateId, CoordinateKind, Cylinder, Linkage, Pin, Point, Stage, Value as Number,
};
use crane_live::LiveCrane;
use crane_model::{
    AttachmentInfo, BodyInfo, CoordinateRole, Description, Tree,
    dyn_crane::{DynCrane, DynModel},
};
use nalgebra::{Matrix4, Vector3};
use serde_json::{Value, json};

use crate::bars::{Bar, bars};

/// Frames, screws, supports, connectors, pads and points of a crane for pose `q`.
pub fn scene(live: &LiveCrane, q: &[f64]) -> Value {
    let crane: &dyn DynCrane = live;
    let description = crane.description();
    let is_vector: Vec<bool> =
        description.coordinates.iter().map(|coordinate| coordinate.role == CoordinateRole::ElementVector).collect();
    let reference: Vec<f64> = q.iter().zip(&is_vector).map(|(q, vector)| if *vector { 0.0 } else { *q }).collect();
    let frames = crane.transforms_at(&reference);
    let (tree, sizes) = ((live as &dyn DynModel).tree(), crane.body_sizes_at());
    let bodies: Vec<Value> = description
        .bodies
        .iter()
        .zip(&frames)
        .enumerate()
        .map(|(index, (body, frame))| {
            let own = tree.own(index);
            let (written, parameters) = (&live.chain().bodies[index], live.parameters());
            let [mass, length] = sizes[index];
            json!({
                "name": body.name.as_str(), "link": body.link.as_str(), "mass": mass, "length": length,
                "parent": tree.parent(index), "along": written.along.at(parameters),
                "moved_by": [own.start, own.end], "frame": rows(frame), "rope": length > 0.0 && !deforms(description, &tree, body),
            })
        })
        .collect();
    let supports: Vec<Value> = description
        .supports
        .iter()
        .zip(crane.support_places_at())
        .map(|(support, place)| json!({"name": support.name.as_str(), "at": <[f64; 3]>::from(place)}))
        .collect();
    let attachments = crane.attachments_at();
    let mut places = attachments.iter();
    let connectors: Vec<Value> = description
        .connectors
        .iter()
        .map(|connector| (connector, connector.points.iter().zip(places.by_ref().take(connector.points.len())).collect()))
        .filter(|(connector, points): &(_, Vec<_>)| points.len() > 1 && !connector.is_pin())
        .map(|(connector, points)| {
            let point = |(point, at): (&AttachmentInfo, &Vector3<f64>)| json!({"body": point.body, "at": <[f64; 3]>::from(*at)});
            let points: Vec<Value> = points.into_iter().map(point).collect();
            json!({"rope": connector.is_rope, "points": points, "falls": connector.falls})
        })
        .collect();
    let screws = screws(live, &reference);
    let cylinders = cylinders(live, (&screws, &frames));
    json!({
        "pose": q, "reference": reference, "vectors": is_vector, "bodies": bodies,
        "screws": screws, "supports": supports, "connectors": connectors, "points": points(live),
        "cylinders": cylinders, "pads": pads(live), "bars": bars(live, &frames).iter().map(bar).collect::<Vec<_>>(),
    })
}

fn bar(bar: &Bar) -> Value {
    let [from, to] = [bar.from, bar.to].map(<[f64; 3]>::from);
    json!({"body": bar.body, "from": from, "to": to, "block": bar.block, "main": bar.main})
}

/// The pads of telescopes: at the end of the outer beam and at the beginning of the inner one, with the names of both links.
fn pads(live: &LiveCrane) -> Vec<Value> {
    let chain = live.chain();
    let link = |body: BodyId| chain.bodies[body.0].link.as_str();
    let of_stage = |stage: &Stage<'_>| {
        let beams = [link(stage.outer.first), link(stage.inner)];
        let last = stage.outer.last();
        let end = chain.bodies[last.0].length.at(live.parameters());
        [(last, end), (stage.inner, 0.0)].map(|(body, x)| json!({"body": body.0, "x": x, "beams": beams}))
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
fn cylinders(live: &LiveCrane, moving: (&[[f64; 6]], &[Matrix4<f64>])) -> Vec<Value> {
    let chain = live.chain();
    let number = |number: &Number| number.at(live.parameters());
    let pin = |pin: &Pin| json!({"body": pin.body.0, "at": pin.position.each_ref().map(number)});
    let data = |cylinder: &Cylinder| {
        let linkage = cylinder.linkage.as_ref().map(|Linkage { pivot, rocker, link, left }| {
            json!({"pivot": pin(pivot), "rocker": number(rocker), "link": number(link), "left": left})
        });
        json!({
            "name": cylinder.name, "foot": pin(&cylinder.foot), "head": pin(&cylinder.head), "linkage": linkage,
            "bore": cylinder.bore, "rod": cylinder.rod, "retracted": cylinder.retracted,
            "axis": axis(live, cylinder.coordinate, moving),
        })
    };
    chain.cylinders.iter().map(data).collect()
}

/// The axis about which a coordinate turns, in the frame of the first body that it moves; none if it slides.
fn axis(live: &LiveCrane, coordinate: CoordinateId, (screws, frames): (&[[f64; 6]], &[Matrix4<f64>])) -> Option<Value> {
    let body = live.chain().coordinates[coordinate.0].body.0;
    let [x, y, z, ..] = screws[coordinate.0];
    let local = frames[body].fixed_view::<3, 3>(0, 0).transpose() * Vector3::new(x, y, z);
    (local.norm() > 0.0).then(|| json!({"body": body, "along": <[f64; 3]>::from(local)}))
}

/// The upper three rows.
fn rows(frame: &Matrix4<f64>) -> Vec<f64> {
    frame.transpose().iter().copied().take(12).collect()
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
fn points(live: &LiveCrane) -> Vec<Value> {
    let number = |number: &Number| number.at(live.parameters());
    let point =
        |point: &Point| json!({"name": point.name, "body": point.body.0, "at": point.position.each_ref().map(number)});
    live.chain().points.iter().map(point).collect()
}
