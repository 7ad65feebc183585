//! Cylinders, valves and the pump: openings, relief valves, and cylinders that are beyond their stroke.

use std::ops::RangeInclusive;

use super::{Plausibility, angles::positions, rounded};
use crate::chain::{Chain, CoordinateKind, Cylinder as ChainCylinder, Linkage, Pin};
use crate::diagnostic::{Span, rule};
use crate::spec::{Motion, Pump, entries};

impl Plausibility<'_> {
    pub(super) fn hydraulics(&mut self) {
        // The consequences of unusual numbers would be reported as well.
        let before = self.warnings.len();
        for cylinder in entries(self.crane.cylinders.as_ref()) {
            let valve = cylinder.valve.as_ref().and_then(|valve| valve.value.as_ref());
            if let Some(opening) = valve.and_then(|valve| valve.opening.as_ref()?.value.as_ref()) {
                self.opening(opening, cylinder.name.value.as_deref().unwrap_or_default());
            }
        }
        if before == 0 && self.warnings.is_empty() {
            if let Some(pump) = self.crane.pump.as_ref().and_then(|pump| pump.value.as_ref()) {
                self.reliefs(pump);
            }
            self.strokes();
        }
    }

    /// The command of a valve; only the first opening beyond the ends of the spool's travel is reported.
    fn opening(&mut self, motion: &Motion, cylinder: &str) {
        if let Motion::Input(name) = motion {
            let input = self.named_input(name);
            let value = input.and_then(|input| input.value.as_ref());
            if let Some(value) = value {
                let number = value.value.as_ref().map_or(0.0, |value| self.scalar(&value.0));
                if number.abs() > 1.0 {
                    self.warn(rule::opening_beyond(value.span, cylinder, number));
                }
            }
            let motion = input.and_then(|input| input.motion.as_ref()?.value.as_ref());
            if let Some(motion) = motion {
                self.opening(motion, cylinder);
            }
            return;
        }
        let numbers = positions(motion).into_iter().map(|(scalar, at)| (scalar.map_or(0.0, |s| self.scalar(s)), at));
        let beyond = numbers.into_iter().find(|(number, _)| number.abs() > 1.0);
        if let Some((number, at)) = beyond {
            self.warn(rule::opening_beyond(at, cylinder, number));
        }
    }

    /// Relief valves that open before the pump reaches its pressure.
    fn reliefs(&mut self, pump: &Pump) {
        let Some(pressure) = pump.pressure.as_ref() else { return };
        let of_pump = pressure.value.as_ref().map_or(f64::NAN, |number| self.scalar(&number.0));
        for cylinder in &self.chain.cylinders {
            if let Some(relief) = cylinder.max_pressure.filter(|relief| cylinder.valve.is_some() && *relief < of_pump) {
                self.warn(rule::relief_below_pump(
                    pressure.span,
                    format!("{of_pump:e}"),
                    &cylinder.name,
                    format!("{relief:e}"),
                ));
            }
        }
    }

    /// Cylinders that are too short or too long, cannot be assembled or have no lever arm, where their drives start.
    fn strokes(&mut self) {
        /// Least lever arm of a cylinder, m, or its rate of extension with a slide.
        const LEAST_LEVER: f64 = 0.01;
        /// Step of the central difference of a length, rad or m: the relative error is 1e-8.
        const DIFFERENCE: f64 = 1e-4;
        let chain = self.chain;
        let mut q = self.pose_at_start();
        for (given, cylinder) in entries(self.crane.cylinders.as_ref()).zip(&chain.cylinders) {
            if cylinder.linkage.is_none() {
                let mut moved = |by: f64| {
                    q[cylinder.coordinate.0] += by;
                    let [length, _] = chain.cylinder_length(cylinder, &q, &self.values);
                    q[cylinder.coordinate.0] -= by;
                    length
                };
                let lever = (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE);
                if lever.abs() < LEAST_LEVER {
                    self.warn(rule::no_lever(given.name.span, &cylinder.name, rounded(lever.abs())));
                }
            }
            if cylinder.stroke > cylinder.retracted {
                let [stroke, retracted] = [cylinder.stroke, cylinder.retracted].map(rounded);
                self.warn(rule::long_stroke(given.stroke.span, &cylinder.name, stroke, retracted));
            }
            self.pins_in_plane(given.foot.span, cylinder, &q);
            let (least, most) = (cylinder.retracted, cylinder.retracted + cylinder.stroke);
            let [length, distance] = chain.cylinder_length(cylinder, &q, &self.values);
            if let (Some(linkage), true) = (&cylinder.linkage, length.is_nan()) {
                let [rocker, link] = [&linkage.rocker, &linkage.link].map(|length| rounded(length.at(&self.values)));
                self.warn(rule::unassembled(given.name.span, &cylinder.name, rocker, link, rounded(distance)));
            } else if !(least..=most).contains(&length) {
                self.warn(rule::out_of_stroke(
                    given.name.span,
                    &cylinder.name,
                    rounded(length),
                    rounded(least),
                    rounded(most),
                    other_side(chain, cylinder, &q, &self.values, least..=most),
                ));
            }
        }
    }
}

impl Plausibility<'_> {
    /// Pins that are apart along the axis about which their cylinder turns a joint: the force along it bends pins.
    fn pins_in_plane(&mut self, span: Span, cylinder: &ChainCylinder, q: &[f64]) {
        /// Largest usual distance along the axis, relative to that of the pins.
        const ASIDE: f64 = 0.3;
        let chain = self.chain;
        let coordinate = &chain.coordinates[cylinder.coordinate.0];
        if coordinate.kind != CoordinateKind::Rotation {
            return;
        }
        let frames = chain.frames(q, &self.values);
        let world = |pin: &Pin| frames[pin.body.0].transform_point(pin.position.each_ref().map(|x| x.at(&self.values)));
        let ([foot, head], [_, axis]) =
            ([&cylinder.foot, &cylinder.head].map(world), chain.axis(cylinder.coordinate, q, &self.values));
        let way: Vec<f64> = foot.iter().zip(head).map(|(foot, head)| head - foot).collect();
        let aside: f64 = way.iter().zip(axis).map(|(x, along)| x * along).sum::<f64>().abs();
        let length = way.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        if aside > ASIDE * length {
            let share = (100.0 * aside / length).round();
            self.warn(rule::pins_aside(span, &cylinder.name, rounded(aside), &coordinate.name, share));
        }
    }
}

/// What to do about a cylinder that is out of its stroke: its linkage may be on the other side.
fn other_side(
    chain: &Chain,
    cylinder: &ChainCylinder,
    q: &[f64],
    values: &[f64],
    stroke: RangeInclusive<f64>,
) -> String {
    let check = "check `retracted`, `stroke`, the pins and the motion of the drive";
    let Some(linkage) = &cylinder.linkage else { return check.to_owned() };
    let turned = Linkage { left: !linkage.left, ..linkage.clone() };
    let other = ChainCylinder { linkage: Some(turned), ..cylinder.clone() };
    let [length, _] = chain.cylinder_length(&other, q, values);
    let side = if linkage.left { "right" } else { "left" };
    if stroke.contains(&length) {
        format!("did you mean `side: {side}`? Then it is {} m long", rounded(length))
    } else {
        format!("{check}; with `side: {side}` it would be {} m long", rounded(length))
    }
}
