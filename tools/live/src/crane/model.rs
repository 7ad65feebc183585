//! Poses, forces, energies and motions of a live crane.

use crane_codegen::chain::BodyId;
use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::DynModel;
use crane_model::nalgebra::Matrix4;
use crane_model::{Description, LoopJointInfo, StageInfo, entry_type, slice_argument};
use crane_quantities::quantities;

use super::LiveCrane;
use super::linearise::loop_stiffness;
use super::methods::{method, methods};
use crate::inputs::is_free;
use crate::machine::Arguments;

impl DynModel for LiveCrane {
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

    quantities! { methods of CraneModel }
}
