//! Everything that is computed of a live crane.

use crane_codegen::chain::BodyId;
use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{Arguments, Derived, DynBlock, DynCrane, DynSystem, Functions};
use crane_model::{Description, LoopJointInfo, ParameterError, StageInfo};

use super::fleet::Fleet;
use super::loop_stiffness::loop_stiffness;
use super::systems::{Block, LiveSystem};
use super::{LiveCrane, no_rooms};
use crate::inputs::{is_free, slots_of};
use crate::native::is_slower_in_lanes;

impl Functions for LiveCrane {
    fn call(&self, id: FunctionId, arguments: &Arguments<'_>, out: &mut [f64]) -> Derived {
        self.with_evaluation(id, |evaluation| evaluation.call(arguments, out))
    }

    fn description(&self) -> &Description {
        &self.description
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        &self.loop_joints
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.with_evaluation(FunctionId::PrescribedMotions, |motions| {
            let motions = motions.results_at(&Arguments { t, ..Arguments::none() });
            for (drive, [position, rate]) in self.chain().rigid_drives().zip(motions.as_chunks().0) {
                (q[drive.coordinate.0], v[drive.coordinate.0]) = (*position, *rate);
            }
        });
    }

    fn system(&self) -> Box<dyn DynSystem + '_> {
        Box::new(LiveSystem::new(&self.library, &self.parameters))
    }
}

impl DynCrane for LiveCrane {
    fn parents(&self) -> &[usize] {
        self.library.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index).copied().unwrap_or(f64::NAN)
    }

    fn input(&self, index: usize) -> Option<f64> {
        self.inputs.get(index).filter(|slots| !is_free(*slots)).map(|[value, ..]| value)
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

    fn fleet(&self, cranes: &[&dyn DynCrane]) -> Option<Box<dyn Functions>> {
        let has_fleets = self.description.has_fleets(&self.loop_joints) && !cranes.is_empty() && !is_slower_in_lanes();
        has_fleets.then(|| -> Box<dyn Functions> { Box::new(Fleet::new(self, cranes)) })
    }

    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        Ok(Box::new(Block::new(self, parameters)?))
    }
}
