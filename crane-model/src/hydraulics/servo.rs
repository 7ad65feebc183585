//! Servos: which cylinders have one, and their valves slightly open at rest.

use super::{Hydraulics, STATES, ValveCylinder, valve::flows};
use crate::Description;

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
    let servo = |(place, cylinder): (usize, &ValveCylinder)| {
        let (valve, cylinder) = (&cylinder.valve, cylinder.index);
        (!valve.commanded && valve.gain > 0.0).then_some(Servo {
            spool: STATES * place + 2,
            cylinder,
            gain: valve.gain,
        })
    };
    oil.cylinders.iter().enumerate().filter_map(servo).collect()
}

impl Hydraulics {
    /// States at rest with the valves that have a servo opened slightly, in the direction of `towards`, 1 or −1.
    pub(super) fn opened_slightly(&self, holding: &[f64], towards: f64) -> Vec<f64> {
        let mut x = holding.to_vec();
        let Some(&pump) = holding.last() else { return x };
        for (cylinder, own) in self.cylinders.iter().zip(x.chunks_exact_mut(STATES)) {
            if !cylinder.valve.commanded {
                cylinder.open_slightly(pump, towards, own);
            }
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
