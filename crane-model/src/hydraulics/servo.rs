//! Servos: which cylinders have one, and their valves slightly open at rest.

use super::{Hydraulics, STATES, ValveCylinder, valve::flows};
use crate::{Description, dyn_crane::DynCrane};

/// How far beyond its overlap a slightly opened valve is open, as a fraction of the spool's travel.
const SLIGHTLY: f64 = 1e-9;

/// A valve with a servo.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Servo {
    /// Its place among the cylinders with a valve.
    pub place: usize,
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
        (!valve.commanded && valve.gain > 0.0).then_some(Servo { place, cylinder, gain: valve.gain })
    };
    oil.cylinders.iter().enumerate().filter_map(servo).collect()
}

impl Hydraulics {
    /// The states that hold a pose at rest with valves that a servo has opened slightly, towards the pump and towards the tank.
    pub(crate) fn slightly_open(&mut self, crane: &dyn DynCrane, t: f64, q: &[f64]) -> [Vec<f64>; 2] {
        let holding = self.holding(crane, t, q);
        let Some(&pump) = holding.last() else { return [Vec::new(), Vec::new()] };
        [1.0, -1.0].map(|towards| {
            let mut x = holding.clone();
            for (cylinder, own) in self.cylinders.iter().zip(x.chunks_exact_mut(STATES)) {
                if !cylinder.valve.commanded {
                    cylinder.open_slightly(pump, towards, own);
                }
            }
            x
        })
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
