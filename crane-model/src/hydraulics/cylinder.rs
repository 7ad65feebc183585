//! A cylinder with a valve, its servo, and the pump.

use nalgebra::Vector3;

use super::valve::{SUCTION, root};
use crate::{CylinderInfo, PumpInfo, ValveInfo, stateful_force::StatefulForce};

/// Relative band of pressures: a relief valve passes the nominal flow of the valve at `1 + BAND` of its set pressure; the pump delivers its
/// maximum flow below `1 − BAND` of its set pressure.
const BAND: f64 = 0.05;
/// Minimum pressure drop for which the servo computes an opening, as a fraction of the nominal one.
const LEAST_DROP: f64 = 0.1;
/// Penetration of an end stop at which it carries the cylinder's maximum force, m.
const STOP: f64 = 1e-3;
/// Damping a of a stop, s/m: the coefficient of restitution is `1 − ⅔ a v` at a low speed v.
const STOP_DAMPING: f64 = 3.0;

/// A cylinder with a valve.
#[derive(Clone, Debug)]
pub(super) struct ValveCylinder {
    /// Its index among all cylinders.
    pub index: usize,
    pub coordinate: usize,
    pub info: CylinderInfo,
    pub valve: ValveInfo,
    pub bulk_modulus: f64,
    pub max_pressure: f64,
}

/// The spool position that a servo or the spec commands, and its derivatives with respect to the length, to the wanted length, its rate and the
/// opening over time, to the pressures on both sides and the pump's pressure.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Command {
    pub opening: f64,
    pub by_length: f64,
    pub by_wanted: [f64; 3],
    pub by_sides: [f64; 2],
    pub by_pump: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Pump {
    pub info: PumpInfo,
    pub pressure: f64,
    pub bulk_modulus: f64,
}

impl Pump {
    /// Flow that it delivers at a pressure, m³/s, and its derivative.
    pub(super) fn flow(&self, pressure: f64) -> (f64, f64) {
        let band = BAND * self.pressure;
        let share = (self.pressure - pressure) / band;
        let slope = if (0.0..1.0).contains(&share) { -self.info.max_flow / band } else { 0.0 };
        (self.info.max_flow * share.clamp(0.0, 1.0), slope)
    }

    /// Whether it delivers its greatest flow, and whether it delivers nothing.
    pub(super) fn branches(&self, pressure: f64) -> [bool; 2] {
        [pressure < (1.0 - BAND) * self.pressure, pressure > self.pressure]
    }
}

impl ValveCylinder {
    /// Force at given pressures, and its derivatives.
    pub(super) fn force(&self, here: Vector3<f64>, [piston, rod]: [f64; 2]) -> StatefulForce {
        let [area, ring] = self.info.areas;
        let y = here.x - self.info.retracted;
        let beyond = if y > self.info.stroke { y - self.info.stroke } else { y.min(0.0) };
        let stiffness = area * self.max_pressure / STOP;
        let damping = (1.0 + STOP_DAMPING * here.y * beyond.signum()).max(0.0);
        let stopped = beyond != 0.0;
        let (by_length, by_speed) = if stopped && damping > 0.0 {
            (-stiffness * damping, -stiffness * STOP_DAMPING * beyond.abs())
        } else {
            (0.0, 0.0)
        };
        StatefulForce {
            force: piston * area - rod * ring - stiffness * beyond * damping,
            by_length,
            by_speed,
            by_states: [area, -ring, 0.0],
            speed: here.y,
            ..StatefulForce::default()
        }
    }

    /// Flow in through relief and suction valves, m³/s, and its derivative with respect to the pressure.
    pub(super) fn relief_and_suction(&self, pressure: f64) -> (f64, f64) {
        let relief = -self.valve.flow / (BAND * self.max_pressure);
        let suction = -self.valve.flow / SUCTION;
        let (above, below) = (pressure - self.max_pressure, pressure - self.info.back_pressure);
        if above > 0.0 {
            (relief * above, relief)
        } else if below < 0.0 {
            (suction * below, suction)
        } else {
            (0.0, 0.0)
        }
    }

    /// Appends the direction in which the valve is open, whether check, relief and suction valves are open, whether the servo is at one of its
    /// limits, and whether the piston is at one of its stops.
    pub(super) fn branches(
        &self,
        here: Vector3<f64>,
        wanted: Vector3<f64>,
        own: &[f64],
        pump: f64,
        out: &mut Vec<bool>,
    ) {
        let &[piston, rod, u] = own else { return };
        let sides = [piston, rod];
        let y = here.x - self.info.retracted;
        out.extend([u > self.valve.overlap, u < -self.valve.overlap, y < 0.0, y > self.info.stroke]);
        out.push(pump > sides[usize::from(u <= 0.0)]);
        for pressure in sides {
            out.extend([pressure > self.max_pressure, pressure < self.info.back_pressure]);
        }
        if !self.valve.commanded {
            let opening = self.command(here, wanted, sides, pump).opening;
            out.extend([opening >= 1.0, opening <= -1.0]);
        }
    }

    /// The spool position that the spec gives over time.
    pub(super) fn commanded(opening: f64) -> Command {
        let inside = if opening.abs() < 1.0 { 1.0 } else { 0.0 };
        Command { opening: opening.clamp(-1.0, 1.0), by_wanted: [0.0, 0.0, inside], ..Command::default() }
    }

    /// The spool position that the servo commands.
    pub(super) fn command(&self, here: Vector3<f64>, wanted: Vector3<f64>, sides: [f64; 2], pump: f64) -> Command {
        let ValveInfo { flow, pressure_drop, gain, feed_forward, .. } = self.valve;
        let fed = usize::from(wanted.y <= 0.0);
        let difference = pump - sides[fed];
        let least = LEAST_DROP * pressure_drop;
        let drop = root(difference.max(least));
        let (area, nominal) = (self.info.areas[fed], root(pressure_drop).value);
        let share = feed_forward * area * wanted.y * nominal / (flow * drop.value);
        let opening = gain * (wanted.x - here.x) + share;
        if opening.abs() >= 1.0 {
            return Command { opening: opening.clamp(-1.0, 1.0), ..Command::default() };
        }
        let by_pump = if difference > least { -share * drop.slope / drop.value } else { 0.0 };
        let mut by_sides = [0.0; 2];
        by_sides[fed] = -by_pump;
        let by_rate = feed_forward * area * nominal / (flow * drop.value);
        Command { opening, by_length: -gain, by_wanted: [gain, by_rate, 0.0], by_sides, by_pump }
    }
}
