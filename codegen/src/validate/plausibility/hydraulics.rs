//! Cylinders, valves, oil and the pump: pressures in bar, flows in l/min, diameters in mm, and cylinders that are beyond their stroke.

use std::ops::RangeInclusive;

use super::{Plausibility, angles::positions, beams::in_metres, rounded};
use crate::chain::{Chain, CoordinateKind, Cylinder as ChainCylinder, Linkage, Pin};
use crate::diagnostic::{Span, rule};
use crate::spec::{Constant, Cylinder, Motion, Pump, Spanned, Valve, entries};

/// A hydraulic quantity: its unit, its usual range, and how to write a number that was given in another unit.
struct Usual {
    unit: &'static str,
    range: RangeInclusive<f64>,
    range_text: &'static str,
    help: fn(f64) -> String,
}

/// Diameters of pistons and rods.
const DIAMETER: Usual = Usual { unit: "m", range: 2e-3..=2.0, range_text: "0.002 to 2 m", help: in_metres };
/// Lengths between pins, and strokes.
const LENGTH: Usual = Usual { unit: "m", range: 1e-3..=50.0, range_text: "0.001 to 50 m", help: in_metres };
/// Pressures of pumps and relief valves, and pressure drops.
const PRESSURE: Usual = Usual { unit: "Pa", range: 1e4..=5e8, range_text: "1e4 to 5e8 Pa", help: in_pascal };
/// Back pressures, of tank lines.
const BACK_PRESSURE: Usual = Usual { unit: "Pa", range: 1e3..=1e7, range_text: "0 to 1e7 Pa", help: in_pascal };
/// Nominal flows of valves and pumps.
const FLOW: Usual = Usual {
    unit: "m³/s",
    range: 1e-8..=0.1,
    range_text: "1e-8 to 0.1 m³/s",
    help: |flow| format!("write it in m³/s: {flow} l/min = {:e} m³/s", rounded(flow / 6e4)),
};
/// Bulk moduli, from oil with air to the purest.
const BULK_MODULUS: Usual = Usual { unit: "Pa", range: 5e7..=5e9, range_text: "5e7 to 5e9 Pa", help: in_pascal };
/// Volumes of hoses, and of the oil between pump and valves.
const VOLUME: Usual = Usual {
    unit: "m³",
    range: 0.0..=0.1,
    range_text: "at most 0.1 m³",
    help: |volume| format!("write it in m³: {volume} l = {:e} m³", rounded(1e-3 * volume)),
};
/// Time constants of spools.
const LAG: Usual = Usual {
    unit: "s",
    range: 1e-5..=2.0,
    range_text: "1e-5 to 2 s",
    help: |lag| format!("write it in s: {lag} ms = {:e} s", rounded(1e-3 * lag)),
};

fn in_pascal(pressure: f64) -> String {
    /// No pressure in bar or megapascal is as large.
    const LARGEST: f64 = 1e5;
    if pressure > LARGEST {
        return format!("it is {:e} bar: write a smaller pressure, in Pa", rounded(1e-5 * pressure));
    }
    let (bar, mega) = (rounded(1e5 * pressure), rounded(1e6 * pressure));
    format!("write it in Pa: {pressure} bar = {bar:e} Pa, {pressure} MPa = {mega:e} Pa")
}

impl Plausibility<'_> {
    pub(super) fn hydraulics(&mut self) {
        let before = self.warnings.len();
        let pump = self.crane.pump.as_ref().and_then(|pump| pump.value.as_ref());
        for cylinder in entries(self.crane.cylinders.as_ref()) {
            self.cylinder(cylinder);
        }
        if let Some(pump) = pump {
            let pressure = pump.pressure.as_ref().map(|given| ("the pressure of the pump", given, &PRESSURE));
            let volume = pump.volume.as_ref().map(|given| ("the volume between pump and valves", given, &VOLUME));
            let flow = ("the maximum flow of the pump", &pump.max_flow, &FLOW);
            self.usual([Some(flow), pressure, volume]);
        }
        // The consequences of such numbers would be reported as well.
        if self.warnings.len() == before {
            if let Some(pump) = pump {
                self.reliefs(pump);
            }
            self.strokes();
        }
    }

    fn cylinder(&mut self, cylinder: &Cylinder) {
        let name = cylinder.name.value.as_deref().unwrap_or_default();
        let of = |what: &str| format!("the {what} of cylinder `{name}`");
        let [bore, rod] = [of("bore"), of("rod")];
        let [retracted, stroke] = [of("retracted length"), of("stroke")];
        let [most, modulus, hoses] = [of("maximum pressure"), of("bulk modulus"), of("hose volume")];
        self.usual([Some((&bore, &cylinder.bore, &DIAMETER)), Some((&rod, &cylinder.rod, &DIAMETER))]);
        self.usual([Some((&retracted, &cylinder.retracted, &LENGTH)), Some((&stroke, &cylinder.stroke, &LENGTH))]);
        let back = of("back pressure");
        self.usual([cylinder.back_pressure.as_ref().map(|given| (back.as_str(), given, &BACK_PRESSURE))]);
        self.usual([cylinder.max_pressure.as_ref().map(|given| (most.as_str(), given, &PRESSURE))]);
        self.usual([cylinder.bulk_modulus.as_ref().map(|given| (modulus.as_str(), given, &BULK_MODULUS))]);
        let volumes = cylinder.hose_volumes.as_ref().and_then(|volumes| volumes.value.as_ref());
        for volume in volumes.into_iter().flatten() {
            self.usual([Some((&hoses, volume, &VOLUME))]);
        }
        if let Some(valve) = cylinder.valve.as_ref().and_then(|valve| valve.value.as_ref()) {
            self.valve(valve, name);
        }
    }

    fn valve(&mut self, valve: &Valve, cylinder: &str) {
        let of = |what: &str| format!("the {what} of the valve of cylinder `{cylinder}`");
        let [flow, drop, lag] = [of("flow"), of("pressure drop"), of("lag")];
        let numbers = [(&flow, &valve.flow, &FLOW), (&drop, &valve.pressure_drop, &PRESSURE), (&lag, &valve.lag, &LAG)];
        self.usual(numbers.map(|(what, given, usual)| Some((what.as_str(), given, usual))));
        if let Some(opening) = valve.opening.as_ref().and_then(|opening| opening.value.as_ref()) {
            self.opening(opening, cylinder);
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

    /// Warns of numbers outside the usual range.
    fn usual<const N: usize>(&mut self, numbers: [Option<(&str, &Spanned<Constant>, &Usual)>; N]) {
        for (what, given, usual) in numbers.into_iter().flatten() {
            let Some(number) = given.value.as_ref().map(|number| self.scalar(&number.0)) else { continue };
            if number != 0.0 && !usual.range.contains(&number) {
                self.warn(rule::hydraulics(
                    given.span,
                    what,
                    number,
                    usual.unit,
                    usual.range_text,
                    (usual.help)(number),
                ));
            }
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
