//! Hydraulic cylinders in a picture: barrel and rod between their pins, rocker and link.

use super::{GREY, INK, Joint, Sheet, VERMILLION};
use crate::chain::{Chain, Cylinder, Frame, Linkage, Pin, Vector, cross};

/// Length of the barrel relative to the distance of the pins of the retracted cylinder.
const BARREL: f64 = 0.9;

/// Pins of a cylinder in a pose: foot, end of the rod, head, and the rocker's pivot if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pins {
    pub foot: Vector,
    pub rod: Vector,
    pub head: Vector,
    pub pivot: Option<Vector>,
}

impl Pins {
    /// All of them that are known.
    pub fn places(self) -> impl Iterator<Item = Vector> {
        let all = [Some(self.foot), Some(self.rod), Some(self.head), self.pivot].into_iter().flatten();
        all.filter(|point| point.iter().all(|x| x.is_finite()))
    }

    /// At a pose; not numbers where rocker and link do not reach each other.
    pub fn of(chain: &Chain, cylinder: &Cylinder, frames: &[Frame], joints: &[Joint]) -> Self {
        let defaults = chain.parameter_defaults();
        let world = |pin: &Pin| frames[pin.body.0].transform_point([0, 1, 2].map(|i| pin.position[i].at(&defaults)));
        let [foot, head] = [&cylinder.foot, &cylinder.head].map(world);
        let joint = joints.iter().find(|joint| joint.coordinate == cylinder.coordinate);
        let (Some(Linkage { pivot, rocker, link, left }), Some(joint)) = (&cylinder.linkage, joint) else {
            return Self { foot, rod: head, head, pivot: None };
        };
        let pivot = world(pivot);
        let [rocker, link] = [rocker, link].map(|length| length.at(&defaults));
        let across = difference(head, pivot);
        let distance = dot(across, across).sqrt();
        let along = (distance * distance + rocker * rocker - link * link) / (2.0 * distance);
        let height = (rocker * rocker - along * along).sqrt() * if *left { 1.0 } else { -1.0 };
        let aside = cross(joint.axis, across);
        let aside_length = dot(aside, aside).sqrt();
        let rod = [0, 1, 2].map(|i| pivot[i] + along / distance * across[i] + height / aside_length * aside[i]);
        Self { foot, rod, head, pivot: Some(pivot) }
    }
}

/// Draws all cylinders that can be assembled.
pub(super) fn cylinders(sheet: &mut Sheet, chain: &Chain, pins: &[Pins]) {
    for (cylinder, pins) in chain.cylinders.iter().zip(pins) {
        let &Pins { foot, rod, head, pivot } = pins;
        let axis = difference(rod, foot);
        let length = dot(axis, axis).sqrt();
        if length.is_nan() || length == 0.0 {
            continue;
        }
        let share = (BARREL * cylinder.retracted / length).min(1.0);
        let barrel = [0, 1, 2].map(|i| foot[i] + share * axis[i]);
        if let Some(pivot) = pivot {
            sheet.line(pivot, rod, VERMILLION, 2.5);
            sheet.line(rod, head, VERMILLION, 2.5);
        }
        sheet.line(foot, rod, INK, 1.8);
        sheet.line(foot, barrel, GREY, 5.0);
        for point in pins.places() {
            sheet.dot(point, 2.4);
        }
    }
}

fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        SourceFile,
        chain::Analyses,
        compile, mechanics,
        picture::poses,
        program::{FunctionId, Inputs},
    };

    /// A boom whose cylinder moves it through rocker and link, on one side of their line.
    fn boom(side: &str) -> Chain {
        let text = format!(
            "format: 1\nname: boom\nlinks:\n  - {{name: mast, mass: 100, com: [0, 0, 1], inertia: {{Ixx: 9, Iyy: 9, Izz: 1}}}}\n  \
             - {{name: boom, placement: {{transform: {{translation: [0, 0, 2], rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 50, \
             com: [1, 0, 0], inertia: {{Ixx: 1, Iyy: 9, Izz: 9}}}}\n\
             drives:\n  - {{coordinate: boom_psi, stiffness: 1e7, motion: {{hold: 0.3}}}}\n\
             cylinders:\n  - name: lift\n    coordinate: boom_psi\n    foot: {{link: mast, at: [0.3, 0, 0.6]}}\n    \
             head: {{link: boom, at: [0.5, -0.1, 0]}}\n    \
             linkage: {{pivot: [0.1, 0, 1.7], rocker: 0.4, link: 0.45, side: {side}}}\n    \
             bore: 0.1\n    rod: 0.06\n    retracted: 0.9\n    stroke: 0.8\n"
        );
        compile::load(&SourceFile::new("boom.yaml", text)).unwrap_or_else(|mistakes| panic!("{mistakes}"))
    }

    #[test]
    fn a_cylinder_is_drawn_as_long_as_it_is() {
        let lengths = ["left", "right"].map(|side| {
            let mut chain = boom(side);
            chain.guess = vec![0.3];
            let (frames, joints) = poses(&chain);
            let pins = Pins::of(&chain, &chain.cylinders[0], &frames, &joints);
            let length = |a: Vector, b: Vector| dot(difference(a, b), difference(a, b)).sqrt();
            let program = mechanics::derive(&chain, Analyses::COMMAND);
            let function = program.function(FunctionId::CylinderStates).expect("the crane has a cylinder");
            let inputs = Inputs::state(0.0, chain.guess.clone(), vec![0.0], chain.parameter_defaults());
            let computed = program.evaluate(function, &inputs)[0];
            let drawn = length(pins.foot, pins.rod);
            // A few roundings.
            assert!((drawn - computed).abs() < 1e-14 * computed * 8.0, "{side}: drawn {drawn}, computed {computed}");
            assert!((length(pins.pivot.expect("a pivot"), pins.rod) - 0.4).abs() < 1e-15 * 8.0);
            assert!((length(pins.head, pins.rod) - 0.45).abs() < 1e-15 * 8.0);
            drawn
        });
        assert!((lengths[0] - lengths[1]).abs() > 0.1, "the sides differ: {lengths:?}");
    }
}
