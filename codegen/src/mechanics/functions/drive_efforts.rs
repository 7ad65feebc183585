//! Efforts, motions and limits of drives.

use super::{Derivation, shaped};
use crate::mechanics::{acts, drives};
use crate::program::{Function, FunctionId, Shape};
use crate::symbolic::{Expr, SweepTrace};

impl<'g> Derivation<'g> {
    /// Motions and limits of drives.
    pub(super) fn drives(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let mut functions = vec![self.function(FunctionId::DriveMotions, drives::motions(model, chain.drives.iter()))];
        if chain.has_limited_drives() {
            functions.push(self.function(FunctionId::DriveLimits, drives::limits(model)));
        }
        if chain.drives.iter().any(|drive| drive.opening().is_some()) {
            functions.push(self.function(FunctionId::ValveOpenings, drives::openings(model)));
        }
        let pieces = drives::pieces(model);
        if !pieces.is_empty() {
            functions.push(self.function(FunctionId::DrivePieces, pieces));
        }
        if self.rigid {
            functions.push(shaped(
                FunctionId::PrescribedMotions,
                Shape::Pairs(chain.rigid_drives().count()),
                drives::motions(model, chain.rigid_drives()),
            ));
        }
        functions
    }

    /// Generalized forces of all drives: those of the springs, and those that the prescribed motions require.
    pub(super) fn drive_forces(&self) -> Vec<Expr<'g>> {
        let model = &self.model;
        let flexible = drives::forces(model, model.t, &model.v);
        if self.rigid { acts::add(&flexible, &self.rigid_efforts()) } else { flexible }
    }

    /// Efforts of rigid drives: the forces that the prescribed motions require, minus the other forces on their joints.
    pub(super) fn rigid_efforts(&self) -> Vec<Expr<'g>> {
        let model = &self.model;
        let given = self.forces().all();
        let mut efforts = self.motion().efforts;
        for drive in model.chain.rigid_drives() {
            let j = drive.coordinate.0;
            if !given[j].is_zero() {
                efforts[j] = efforts[j] - given[j];
            }
        }
        efforts
    }

    /// Runs `derive`. If there are rigid drives, also records the recursion that computes their efforts, whose order the operations
    /// then follow.
    pub(super) fn recorded_if_rigid<T>(&self, derive: impl FnOnce() -> T) -> (T, SweepTrace) {
        if self.rigid { self.model.graph.recorded(derive) } else { (derive(), SweepTrace::default()) }
    }
}
