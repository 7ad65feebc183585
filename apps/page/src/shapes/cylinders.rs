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

/// Sizes of the parts of a cylinder, m.
pub struct Sizes {
    /// Radius of the barrel.
    pub barrel: f64,
    /// Its length from the foot.
    pub long: f64,
    /// Radius of the rod.
    pub rod: f64,
    /// Sides of rocker and link, across.
    pub bar: [f64; 2],
    /// Radius and length of a pin.
    pub pin: [f64; 2],
}

impl Barrel {
    /// The sizes of its parts, in a crane of this size.
    pub fn sizes(&self, size: f64) -> Sizes {
        let barrel = (OUTER * self.bore).max(LEAST * size);
        let side = SIDE / OUTER * barrel;
        Sizes {
            barrel,
            long: LENGTH * self.retracted,
            rod: (0.5 * self.rod).max(0.45 * barrel),
            bar: [side, 0.6 * side],
            pin: [RADIUS * barrel, LONG * barrel],
        }
    }
}

/// The parts of a cylinder in the world while the bodies have these frames.
pub fn parts(cylinder: &Barrel, size: f64, frames: &[Matrix4<f64>]) -> Vec<(Paint, Mesh)> {
    let pins = cylinder.pins(frames);
    let Pins { foot, rod, head, pivot } = pins;
    let Sizes { barrel, long, rod: thin, bar, pin: [radius, length] } = cylinder.sizes(size);
    let end = foot + (rod - foot).normalize() * long;
    let round = |paint, from, to, radius: f64| (paint, Mesh::rod(from, to, [radius; 2], 20));
    let mut parts = vec![round(ROD, foot, rod, thin), round(BARREL, foot, end, barrel)];
    for ends in pivot.into_iter().flat_map(|pivot| [[pivot, rod], [rod, head]]) {
        parts.push((LINKAGE, Mesh::bar(ends[0], ends[1], bar)));
    }
    let half = cylinder.normal(frames).map(|normal| normal * (length / 2.0));
    parts.extend(
        half.into_iter().flat_map(|half| pins.places().map(move |at| round(PIN, at - half, at + half, radius))),
    );
    parts
}
