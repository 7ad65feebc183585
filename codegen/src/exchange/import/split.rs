//! Joints with several axes as joints with one axis each.
//!
//! A free or floating joint slides along x, y, z and turns about z, y, x; a ball joint turns about z, y, x; a planar joint slides in its
//! plane and turns about its normal. `R = Rz(psi) Ry(theta) Rx(phi)`: rates of these angles are the joint's angular velocity except at
//! theta = ±90°, where two of the axes are parallel. Links between two of the axes have no mass.

use std::collections::BTreeSet;

use super::mistakes::rule;
use super::robot::{Joint, Link, Motion, Named, Robot, SingleAxis};
use crate::chain::{Across, Frame, Vector};
use crate::diagnostic::Mistake;
use crate::exchange::free_name;
use crate::exchange::rotation::roll_pitch_yaw;

const UNITS: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl SingleAxis {
    const fn slide(ending: &'static str, axis: Vector) -> Self {
        SingleAxis { ending, turns: false, axis }
    }

    const fn turn(ending: &'static str, axis: Vector) -> Self {
        SingleAxis { ending, turns: true, axis }
    }

    /// Those of a ball joint.
    pub(super) fn ball() -> Vec<Self> {
        let [x, y, z] = UNITS;
        vec![SingleAxis::turn("psi", z), SingleAxis::turn("theta", y), SingleAxis::turn("phi", x)]
    }

    /// Those of a free joint.
    pub(super) fn free() -> Vec<Self> {
        let [x, y, z] = UNITS;
        let slides = [SingleAxis::slide("x", x), SingleAxis::slide("y", y), SingleAxis::slide("z", z)];
        slides.into_iter().chain(SingleAxis::ball()).collect()
    }

    /// Those of a joint in the plane normal to a direction.
    pub(super) fn planar(normal: Vector) -> Vec<Self> {
        let Across { directions: [u, w], axis, .. } = Across::to(normal);
        vec![SingleAxis::slide("u", u), SingleAxis::slide("w", w), SingleAxis::turn("angle", axis)]
    }
}

/// Positions of a free joint's axes in a pose.
pub(super) fn positions_of_free(pose: &Frame) -> Vec<f64> {
    pose.origin.into_iter().chain(positions_of_ball(pose)).collect()
}

/// Positions of a ball joint's axes in an orientation.
pub(super) fn positions_of_ball(pose: &Frame) -> Vec<f64> {
    let [roll, pitch, yaw] = roll_pitch_yaw(pose);
    vec![yaw, pitch, roll]
}

/// Splits all joints with several axes; those in `fixed` are held where they start. Returns those that cannot be split.
pub(super) fn split_joints(robot: &mut Robot, fixed: &[String]) -> Vec<Mistake> {
    let mut mistakes = Vec::new();
    let mut names: BTreeSet<String> = robot.links.iter().map(|link| link.name.clone()).collect();
    let mut joint_names: BTreeSet<String> = robot.joints.iter().map(|joint| joint.name.clone()).collect();
    for joint in std::mem::take(&mut robot.joints) {
        let Motion::Several { kind, axes, starts } = &joint.motion else {
            robot.joints.push(joint);
            continue;
        };
        if !joint.is_plain() {
            mistakes.push(rule::not_plain(joint.span, &joint.name, kind));
        }
        if joint.range().is_some() {
            robot.left_out.push(format!("The range of joint `{}` is left out: it is {kind}.", joint.name));
        }
        let singles: Vec<Joint> = (axes.iter().zip(starts).enumerate())
            .map(|(index, (&SingleAxis { ending, turns, axis }, start))| {
                let motion = if turns { Motion::Revolute } else { Motion::Prismatic };
                let ends = [joint.parent.clone(), joint.child.clone()];
                let name = free_name(&mut joint_names, &format!("{}_{ending}", joint.name), &|_, _| true);
                let single = Joint::new(&name, joint.span, motion, ends);
                let placement = if index == 0 { joint.placement } else { Frame::WORLD };
                Joint { placement, axis, start: (*start != 0.0).then_some(*start), ..single }
            })
            .collect();
        if fixed.contains(&joint.name) {
            let moved = |pose: Frame, (single, start): (&Joint, &f64)| pose.outer(&single.moved_by(*start));
            let placement = singles.iter().zip(starts).fold(joint.placement, moved);
            robot.joints.push(Joint { placement, motion: Motion::Fixed, limits: None, ..joint });
            continue;
        }
        let last = singles.len() - 1;
        let mut carrier = joint.parent.clone();
        for (index, single) in singles.into_iter().enumerate() {
            let child = if index == last {
                joint.child.clone()
            } else {
                let name = free_name(&mut names, &format!("{}_{}", joint.child.name, index + 1), &|_, _| true);
                robot.links.push(Link {
                    name: name.clone(),
                    span: joint.span,
                    lump: None,
                    shapes: Vec::new(),
                    frame: None,
                });
                Named { name, span: joint.span }
            };
            robot.joints.push(Joint { parent: std::mem::replace(&mut carrier, child.clone()), child, ..single });
        }
    }
    mistakes
}
