//! Hydraulic cylinders between their pins.

use std::f64::consts::PI;

use super::{
    BodyId, Chain, CoordinateId, Value,
    frame::{Vector, cross},
};

/// The hydraulic cylinder of a driven joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    /// Unique name.
    pub name: String,
    /// The coordinate of the joint.
    pub coordinate: CoordinateId,
    /// The pin of its barrel.
    pub foot: Pin,
    /// The pin on the other side of the joint: that of its rod, or of the linkage.
    pub head: Pin,
    /// Rocker and link between its rod and the head.
    pub linkage: Option<Linkage>,
    /// Diameter of the piston, m.
    pub bore: f64,
    /// Diameter of the rod, m.
    pub rod: f64,
    /// Distance of its pins when it is retracted, m.
    pub retracted: f64,
    /// Stroke, m.
    pub stroke: f64,
    /// Maximum pressure, Pa.
    pub max_pressure: Option<f64>,
    /// Pressure on the side that does not carry the load, Pa.
    pub back_pressure: f64,
    /// Bulk modulus of the oil, Pa.
    pub bulk_modulus: Option<f64>,
    /// Oil in hoses and valves on the piston's side and on the rod's, m³.
    pub hose_volumes: [f64; 2],
    /// The valve that moves it, if its pressures are states of the motion.
    pub valve: Option<Valve>,
}

/// A proportional directional valve and its servo.
#[derive(Clone, Debug, PartialEq)]
pub struct Valve {
    /// Flow through a fully open edge at the pressure drop, m³/s.
    pub flow: f64,
    /// That pressure drop, Pa.
    pub pressure_drop: f64,
    /// Fraction of the spool's travel before an edge opens.
    pub overlap: f64,
    /// Time constant of the spool, s.
    pub lag: f64,
    /// Opening per error of length, 1/m; 0 if the drive has a command.
    pub gain: f64,
    /// Fraction of the opening required by the speed of the motion that is applied before any error.
    pub feed_forward: f64,
    /// Leakage past the piston, m³/(s Pa).
    pub leakage: f64,
}

/// The pump that supplies the cylinders.
#[derive(Clone, Debug, PartialEq)]
pub struct Pump {
    /// Maximum flow, m³/s.
    pub max_flow: f64,
    /// Pressure at which it delivers nothing, Pa.
    pub pressure: Option<f64>,
    /// Oil between pump and valves, m³.
    pub volume: f64,
}

/// A point of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Pin {
    /// The body.
    pub body: BodyId,
    /// Position in its frame, m.
    pub position: [Value; 3],
}

/// Rocker and link between a cylinder's rod and its head.
#[derive(Clone, Debug, PartialEq)]
pub struct Linkage {
    /// The rocker's pivot, on the link of the foot.
    pub pivot: Pin,
    /// Length of the rocker, m.
    pub rocker: Value,
    /// Length of the link, m.
    pub link: Value,
    /// Whether the rod's pin is to the left of the line from the pivot to the head, looking against the direction of the joint's axis.
    pub left: bool,
}

impl Cylinder {
    /// Areas of the piston and of the ring around the rod, m².
    #[must_use]
    pub fn areas(&self) -> [f64; 2] {
        let circle = |diameter: f64| PI / 4.0 * diameter * diameter;
        [circle(self.bore), circle(self.bore) - circle(self.rod)]
    }

    /// Foot, head and, with a linkage, the pivot of its rocker.
    pub fn pins(&self) -> impl Iterator<Item = &Pin> {
        [&self.foot, &self.head].into_iter().chain(self.linkage.as_ref().map(|linkage| &linkage.pivot))
    }
}

impl Chain {
    /// The length of a cylinder at a pose, m; NaN if its linkage cannot be assembled. Then the distance from the linkage's pivot to its head, m.
    #[must_use]
    pub fn cylinder_length(&self, cylinder: &Cylinder, q: &[f64], parameters: &[f64]) -> [f64; 2] {
        let frames = self.frames(q, parameters);
        let place = |Pin { body, position }: &Pin| {
            frames[body.0].transform_point(position.each_ref().map(|x| x.at(parameters)))
        };
        let [foot, head] = [&cylinder.foot, &cylinder.head].map(place);
        let Some(linkage) = &cylinder.linkage else {
            let length = norm(difference(head, foot));
            return [length, length];
        };
        let [_, axis] = self.axis(cylinder.coordinate, q, parameters);
        let pivot = place(&linkage.pivot);
        let [rocker, link] = [&linkage.rocker, &linkage.link].map(|length| length.at(parameters));
        let across = difference(head, pivot);
        let distance = norm(across);
        // The pin between rocker and link is this far along the line from the pivot to the head, and this far to its left.
        let along = (distance * distance + rocker * rocker - link * link) / (2.0 * distance);
        let height = (rocker * rocker - along * along).sqrt() * if linkage.left { 1.0 } else { -1.0 };
        let normal = cross(axis, across);
        let aside = height / norm(normal);
        let pin = [0, 1, 2].map(|i| pivot[i] + along / distance * across[i] + aside * normal[i]);
        [norm(difference(pin, foot)), distance]
    }

    /// The coordinates that move only some of a cylinder's pins, and so change its length: that of its joint and those of beams.
    #[must_use]
    pub fn spanned_by(&self, cylinder: &Cylinder) -> Vec<CoordinateId> {
        let pins: Vec<_> = cylinder.pins().map(|pin| self.coordinates_of(pin.body)).collect();
        self.between(&pins)
    }

    /// The index of the drive whose effort is that of a cylinder.
    #[must_use]
    pub fn drive_of(&self, cylinder: &Cylinder) -> usize {
        self.drives.iter().position(|drive| drive.coordinate == cylinder.coordinate).unwrap_or_default()
    }
}

fn difference(to: Vector, from: Vector) -> Vector {
    [0, 1, 2].map(|i| to[i] - from[i])
}

fn norm(vector: Vector) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
