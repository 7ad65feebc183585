//! Everything that is computed of a live crane.

use crane_codegen::chain::BodyId;
use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{DynBlock, DynCrane, DynSystem};
use crane_model::nalgebra::Matrix4;
use crane_model::rt::derivatives::EightColumns;
use crane_model::{Description, LoopJointInfo, ParameterError, StageInfo, entry_type, slice_argument};
use crane_quantities::{Count, Part, quantities};

use super::fleet::Fleet;
use super::loop_stiffness::loop_stiffness;
use super::methods::{method, methods};
use super::systems::{Block, LiveSystem};
use super::{LiveCrane, at, copy, no_rooms};
use crate::derivatives::Storage;
use crate::inputs::{is_free, slots_of};
use crate::machine::Arguments;
use crate::native::is_slower_in_lanes;
use crate::routine::Routine;

impl DynCrane for LiveCrane {
    fn parts(&self) -> &[Part] {
        &Part::ALL
    }

    fn description(&self) -> &Description {
        &self.description
    }

    fn parents(&self) -> &[usize] {
        self.library.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index).copied().unwrap_or(f64::NAN)
    }

    fn input(&self, index: usize) -> Option<f64> {
        self.inputs.get(index).filter(|slots| !is_free(*slots)).map(|[value, ..]| value)
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        &self.loop_joints
    }

    fn stages(&self) -> &[StageInfo] {
        &self.stages
    }

    fn stage_height(&self, stage: usize) -> f64 {
        let height = self.stages.get(stage).and_then(|stage| self.chain().height_of(BodyId(stage.inner)));
        height.map_or(0.0, |height| height.at(&self.parameters))
    }

    fn loop_stiffness(&self, q: &[f64], multipliers: &[f64], out: &mut [f64]) -> bool {
        loop_stiffness(self, q, multipliers, out);
        true
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.call(FunctionId::PrescribedMotions, &Arguments { t, ..Arguments::none() }, |_, results| {
            for (drive, [position, rate]) in self.chain().rigid_drives().zip(results.as_chunks().0) {
                (q[drive.coordinate.0], v[drive.coordinate.0]) = (*position, *rate);
            }
        });
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        let mut values = self.parameters.clone();
        if let Some(parameter) = values.get_mut(index) {
            *parameter = value;
        }
        self.set_parameters(&values)
    }

    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        self.parameters = self.with_first(values)?;
        // The workspaces contain constants computed from parameters.
        self.rooms = no_rooms();
        Ok(())
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) {
        self.inputs.set(index, slots_of(value));
    }

    fn boxed_clone(&self) -> Box<dyn DynCrane> {
        Box::new(self.clone())
    }

    fn system(&self) -> Box<dyn DynSystem + '_> {
        Box::new(LiveSystem::new(self))
    }

    fn fleet(&self, cranes: &[&dyn DynCrane]) -> Option<Box<dyn DynCrane>> {
        let has_fleets = self.description.has_fleets(&self.loop_joints) && !cranes.is_empty() && !is_slower_in_lanes();
        has_fleets.then(|| -> Box<dyn DynCrane> { Box::new(Fleet::new(self, cranes)) })
    }

    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        Ok(Box::new(Block::new(self, parameters)?))
    }

    fn linearise(&self, q: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]) {
        self.call(FunctionId::Linearise, &at(q), |_, results| {
            let mut rest: &[f64] = results;
            for matrix in [mass, stiffness, damping] {
                let (own, others) = rest.split_at(matrix.len().min(rest.len()));
                copy(own, matrix);
                rest = others;
            }
        });
    }

    fn dynamic_residual_derivatives(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        let mut factors = vec![0.0; Count::RESIDUAL_FACTORS * q.len()];
        self.residual_factors(q, v, a, &mut factors);
        self.force_derivatives(t, q, v, out);
        Storage::<EightColumns>::new(self.links()).residual_derivatives(&factors, out);
    }

    fn inverse_mass_matrix(&self, q: &[f64], out: &mut [f64]) {
        let mut factors = vec![0.0; Count::MASS_FACTORS * q.len()];
        self.mass_factors(q, &mut factors);
        Storage::<EightColumns>::new(self.links()).inverse_mass_matrix(&factors, out);
    }

    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let n = q.len();
        let mut a = vec![0.0; n];
        self.forward_dynamics(t, q, v, &mut a);
        let [mut of_residual, mut of_mass] =
            [Count::RESIDUAL_FACTORS, Count::MASS_FACTORS].map(|count| vec![0.0; count * n]);
        self.residual_factors(q, v, &a, &mut of_residual);
        self.mass_factors(q, &mut of_mass);
        let mut forces = vec![0.0; 2 * n * n];
        self.force_derivatives(t, q, v, &mut forces);
        let library = self.library();
        let places = library.routine(FunctionId::ForceDerivatives).map_or(&[][..], Routine::places);
        let factors = [&*of_residual, &of_mass];
        Storage::<EightColumns>::new(self.links()).forward_dynamics_derivatives(factors, (&forces, places), out);
    }

    quantities! { methods }
}
