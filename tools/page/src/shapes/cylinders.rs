//! Hydraulic cylinders between their pins, with rocker and link.

use nalgebra::Matrix4;

use super::{BARREL, LINKAGE, Mesh, PIN, Paint, ROD};
use crate::scene::{Barrel, Pins};

/// Smallest radius of a barrel, relative to the crane's size.
const LEAST: f64 = 0.0028;
/// Outer radius of a barrel, and sides of rocker and link, relative to the bore.
const OUTER: f64 = 0.62;
const SIDE: f64 = 0.8;
/// Length of the barrel relative to the distance of the pins of the retracted cylinder.
pub const LENGTH: f64 = 0.9;
/// Length and radius of a pin, relative to the radius of the barrel.
const LONG: f64 = 3.0;
const RADIUS: f64 = 0.6;

/// The parts of a cylinder in the world while the bodies have these frames.
pub fn parts(cylinder: &Barrel, size: f64, frames: &[Matrix4<f64>]) -> Vec<(Paint, Mesh)> {
    let pins = cylinder.pins(frames);
    let Pins { foot, rod, head, pivot } = pins;
    let barrel = (OUTER * cylinder.bore).max(LEAST * size);
    let end = foot + (rod - foot).normalize() * (LENGTH * cylinder.retracted);
    let round = |paint, from, to, radius: f64| (paint, Mesh::rod(from, to, [radius; 2], 20));
    let mut parts =
        vec![round(ROD, foot, rod, (0.5 * cylinder.rod).max(0.45 * barrel)), round(BARREL, foot, end, barrel)];
    let side = SIDE / OUTER * barrel;
    for ends in pivot.into_iter().flat_map(|pivot| [[pivot, rod], [rod, head]]) {
        parts.push((LINKAGE, Mesh::bar(ends[0], ends[1], [side, 0.6 * side])));
    }
    let half = cylinder.normal(frames).map(|normal| normal * (LONG * barrel / 2.0));
    parts.extend(
        half.into_iter()
            .flat_map(|half| pins.places().map(move |at| round(PIN, at - half, at + half, RADIUS * barrel))),
    );
    parts
}

/// The proportions as the page's script has them.
#[cfg(test)]
pub fn written() -> [String; 5] {
    [
        format!("const LEAST = {LEAST};"),
        format!("const BARREL = {OUTER};"),
        format!("const BAR = {SIDE};"),
        format!("const LENGTH = {LENGTH};"),
        format!("const PIN = {{ length: {LONG}, radius: {RADIUS} }};"),
    ]
}
