//! Servos: which cylinders have one, and their valves slightly open at rest.

use super::{Hydraulics, STATES, ValveCylinder, valve::flows};
use crate::{Description, StateAt, dyn_crane::Functions};

/// How far beyond its overlap a slightly opened valve is open, as a fraction of the spool's travel.
const SLIGHTLY: f64 = 1e-9;

/// A valve with a servo.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Servo {
    /// Index of its spool among the states of the oil.
    pub spool: usize,
    /// Index of its cylinder among all.
    pub cylinder: usize,
    /// Gain, 1/m.
    pub gain: f64,
}

/// The servos of a crane.
pub(crate) fn servos(description: &Description) -> Vec<Servo> {
    let oil = Hydraulics::new(description);
    let servo = |(index, cylinder): (usize, &ValveCylinder)| {
        let (valve, cylinder) = (&cylinder.valve, cylinder.index);
        (!valve.commanded && valve.gain > 0.0).then_some(Servo {
            spool: STATES * index + 2,
            cylinder,
            gain: valve.gain,
        })
    };
    oil.cylinders.iter().enumerate().filter_map(servo).collect()
}

/// How the spool of a drive's valve is moved.
pub(crate) struct Spool {
    /// Index of its position among the states of the oil.
    pub state: usize,
    /// Lag of the spool, s.
    pub lag: f64,
    /// Derivatives of what the servo commands with respect to the position and the rate of the drive's motion; `None` without a servo.
    pub by_motion: Option<[f64; 2]>,
}

/// The spool of the valve of a drive, if it has one.
pub(crate) fn spool(crane: &dyn Functions, moment: &StateAt<'_>, drive: usize) -> Option<Spool> {
    /// Differences of the motion, m or rad, and m/s or rad/s.
    const DIFFERENCE: f64 = 1e-6;
    let mut oil = Hydraulics::new(crane.description());
    let index = oil.cylinders.iter().position(|cylinder| cylinder.info.drive == drive)?;
    oil.measure(crane, moment.t, moment.q, moment.v);
    let cylinder = oil.cylinders[index].clone();
    let (x, here) = (moment.x, oil.here[cylinder.index]);
    let (sides, pump) = ([x[STATES * index], x[STATES * index + 1]], x[oil.len() - 1]);
    let n = moment.q.len();
    let command = |motion: [f64; 2]| {
        let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
        [q[cylinder.coordinate], v[cylinder.coordinate]] = motion;
        let mut wanted = oil.wanted.clone();
        crane.cylinder_states(&q, &v, &mut wanted);
        cylinder.command(here, wanted[cylinder.index], sides, pump).opening
    };
    let motion = oil.motions[drive];
    let by_motion = [0, 1].map(|which| {
        let [before, after] = [-DIFFERENCE, DIFFERENCE].map(|step| {
            let mut moved = motion;
            moved[which] += step;
            command(moved)
        });
        (after - before) / (2.0 * DIFFERENCE)
    });
    let by_motion = (!cylinder.valve.commanded).then_some(by_motion);
    Some(Spool { state: STATES * index + 2, lag: cylinder.valve.lag, by_motion })
}

impl Hydraulics {
    /// States at rest with all valves opened slightly, in the direction of `towards`, 1 or −1: by a servo, or by what commands them.
    pub(super) fn opened_slightly(&self, holding: &[f64], towards: f64) -> Vec<f64> {
        let mut x = holding.to_vec();
        let Some(&pump) = holding.last() else { return x };
        for (cylinder, own) in self.cylinders.iter().zip(x.chunks_exact_mut(STATES)) {
            cylinder.open_slightly(pump, towards, own);
        }
        x
    }
}

impl ValveCylinder {
    /// Opens the valve in the direction of `towards`, 1 or −1, and sets the pressures, which keep their force.
    fn open_slightly(&self, pump: f64, towards: f64, own: &mut [f64]) {
        let ([area, ring], tank) = (self.info.areas, self.info.back_pressure);
        let [piston, rod] = [own[0], own[1]];
        let force = piston * area - rod * ring;
        let shared = (force + ring * (pump + tank)) / (area + ring);
        if (tank..=pump).contains(&shared) {
            (own[0], own[1]) = (shared, pump + tank - shared);
        }
        let difference = own[0] - own[1];
        let towards = if self.valve.leakage > 0.0 { difference.signum() } else { towards };
        own[2] = towards * (self.valve.overlap + SLIGHTLY);
        let flows = flows(&self.valve, own[2], [own[0], own[1]], pump, tank);
        let leak = self.valve.leakage * difference.abs();
        let slope = flows.by_spool[usize::from(towards < 0.0)].abs();
        if leak > 0.0 && slope > 0.0 {
            own[2] = towards * (self.valve.overlap + leak / slope).min(1.0);
        }
    }
}
