//! The oil of a crane at a state.

use super::{CylinderState, Hydraulics};
use crate::{
    Description, StateAt,
    dyn_crane::Functions,
    stateful_force::{Evaluated, STATES, StatefulForce, StatefulForces},
};

/// The cylinders with a valve: index among all cylinders, state, and position of the spool; flow (m³/s), power (W) and pressure (Pa) of the
/// pump.
pub(crate) struct Oil {
    pub cylinders: Vec<(usize, CylinderState, f64)>,
    pub pump: [f64; 3],
}

impl Oil {
    /// At a state of the crane and its oil.
    pub fn at(crane: &dyn Functions, moment: &StateAt<'_>) -> Option<Self> {
        let x = moment.x;
        if !crane.description().has_valves() {
            return None;
        }
        let mut hydraulics = Hydraulics::new(crane.description());
        if hydraulics.is_empty() || x.len() < hydraulics.len() {
            return None;
        }
        let (mut rates, mut rows) = (vec![0.0; x.len()], hydraulics.rows());
        let mut forces = vec![StatefulForce::default(); rows.len()];
        hydraulics.evaluate(crane, moment, Evaluated { rates: &mut rates, forces: &mut forces, rows: &mut rows }, None);
        let cylinders =
            hydraulics.cylinders.iter().zip(&forces).zip(x.chunks_exact(STATES)).map(|((cylinder, force), x)| {
                let here = hydraulics.here[cylinder.index];
                let state = CylinderState {
                    length: here.x,
                    speed: here.y,
                    arm: here.z,
                    force: force.force,
                    pressures: [x[0], x[1]],
                    flow: force.from_pump,
                };
                (cylinder.index, state, x[2])
            });
        Some(Self { cylinders: cylinders.collect(), pump: hydraulics.delivered(x) })
    }

    /// Replaces the efforts of drives by those of their cylinders with a valve.
    pub fn give_efforts(&self, description: &Description, efforts: &mut [f64]) {
        for (index, state, _) in &self.cylinders {
            efforts[description.cylinders[*index].drive] = state.force * state.arm;
        }
    }

    /// Replaces the states that the drives' efforts would require by those of the cylinders with a valve.
    pub fn give_states(&self, cylinders: &mut [CylinderState]) {
        for (index, state, _) in &self.cylinders {
            cylinders[*index] = *state;
        }
    }

    /// Flow, power and pressure of the pump, and the openings of the valves.
    pub fn pump_and_spools(&self) -> impl Iterator<Item = f64> {
        self.pump.into_iter().chain(self.cylinders.iter().map(|(.., spool)| *spool))
    }
}
