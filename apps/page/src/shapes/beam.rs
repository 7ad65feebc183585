//! A beam along a curve: a link that bends, drawn through the middles of its elements.

use nalgebra::{Matrix4, Vector3};

use super::mesh::Mesh;
use crate::scene::Section;

/// Rings of the drawn curve in each half of an element.
const STATIONS: usize = 4;
/// Faces of a round beam.
const ROUND: u32 = 24;

/// Height and width at a distance along a beam: linear in between; at a step, those that begin there.
pub fn size_at(along: &[[f64; 3]], x: f64) -> [f64; 2] {
    let next = along.iter().position(|[place, ..]| *place > x).unwrap_or(along.len());
    match (next.checked_sub(1).map(|before| along[before]), along.get(next)) {
        (Some([_, height, width]), None) | (None, Some(&[_, height, width])) => [height, width],
        (Some(a), Some(b)) => {
            let share = (x - a[0]) / (b[0] - a[0]);
            [1, 2].map(|side| a[side] + share * (b[side] - a[side]))
        }
        (None, None) => [0.0; 2],
    }
}

/// A place on the axis of a beam, with the directions of height and width.
#[derive(Clone, Copy)]
struct Station {
    x: f64,
    at: Vector3<f64>,
    high: Vector3<f64>,
    wide: Vector3<f64>,
}

/// The pieces of a beam in the world, one per element; `elements`: frames and lengths.
pub fn pieces(elements: &[(Matrix4<f64>, f64)], section: &Section) -> Vec<Mesh> {
    let faces: Vec<[f64; 2]> = if section.round {
        (0..ROUND)
            .map(|side| (std::f64::consts::TAU * f64::from(side) / f64::from(ROUND)).sin_cos())
            .map(|(z, y)| [y, z])
            .collect()
    } else {
        vec![[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]
    };
    let ring = |station: &Station| -> Vec<Vector3<f64>> {
        let [high, wide] = size_at(&section.along, station.x).map(|side| side / 2.0);
        faces.iter().map(|[y, z]| station.at + y * high * station.high + z * wide * station.wide).collect()
    };
    let rings: Vec<_> = stations(elements).iter().map(ring).collect();
    rings.windows(2 * STATIONS + 1).step_by(2 * STATIONS).map(Mesh::between).collect()
}

/// Straight to the middle of the first element, Hermite's curve from middle to middle, straight to the tip: 2 `STATIONS` per element, and the tip.
fn stations(elements: &[(Matrix4<f64>, f64)]) -> Vec<Station> {
    let column = |frame: &Matrix4<f64>, index: usize| frame.column(index).xyz();
    let mut end = 0.0;
    let middles: Vec<(Station, Vector3<f64>, f64)> = elements
        .iter()
        .map(|(frame, length)| {
            end += length;
            let [x, high, wide] = [0, 1, 2].map(|index| column(frame, index));
            (Station { x: end - length / 2.0, at: column(frame, 3) + x * (length / 2.0), high, wide }, x, *length)
        })
        .collect();
    let (Some(&first), Some(&last)) = (middles.first(), middles.last()) else { return Vec::new() };
    let straight = |(middle, x, length): (Station, Vector3<f64>, f64), share: f64| {
        let on = share * length / 2.0;
        Station { x: middle.x + on, at: middle.at + on * x, ..middle }
    };
    let share = |step: usize| step as f64 / STATIONS as f64;
    let before = (0..STATIONS).map(|step| straight(first, share(step) - 1.0));
    let between = middles.windows(2).flat_map(|pair| {
        let [(a, a_x, a_length), (b, b_x, b_length)] = [pair[0], pair[1]];
        let span = f64::midpoint(a_length, b_length);
        (0..2 * STATIONS).map(move |step| {
            let u = share(step) / 2.0;
            let at = (1.0 + 2.0 * u) * (1.0 - u).powi(2) * a.at + u * u * (3.0 - 2.0 * u) * b.at;
            let slopes = span * u * (1.0 - u).powi(2) * a_x + span * u * u * (u - 1.0) * b_x;
            let mixed = |one: Vector3<f64>, other: Vector3<f64>| one.lerp(&other, u).normalize();
            Station {
                x: a.x + u * (b.x - a.x),
                at: at + slopes,
                high: mixed(a.high, b.high),
                wide: mixed(a.wide, b.wide),
            }
        })
    });
    let after = (0..=STATIONS).map(|step| straight(last, share(step)));
    before.chain(between).chain(after).collect()
}
