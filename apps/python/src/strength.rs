//! What joints, sections and the ground carry, stresses of beams, and moments about tipping lines, row by row.

use crane_live::FunctionId;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::sections::stressed_sections;
use crane_model::{Stress, tipping};
use pyo3::prelude::*;

use crate::crane::Crane;
use crate::evaluation::{Moment, StateArguments};
use crate::types::{Array, ArrayLike, Given};

/// Numbers of a section: normal, shear, torsional and equivalent stress, utilisation.
const OF_SECTION: usize = 5;
/// Numbers of the governing tipping line: margin, stabilising and overturning moment, indices of its two supports.
const OF_LINE: usize = 5;

#[pymethods]
impl Crane {
    /// (..., cuts, 6): force, N, and moment, N m, that the part beyond each cut exerts on the part before it, with the forces of cylinders
    /// and of joints that close loops; `Crane.info["cuts"]` lists the cuts. a: accelerations; at rest unless v and a are given.
    #[pyo3(signature = (q, v=None, a=None, t=None, *, invalid="raise"))]
    fn internal_forces<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: Given<'py>,
        a: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let state = StateArguments {
            t,
            q: Some(q),
            v: v.or_else(|| Some(self.rest(py))),
            a: a.or_else(|| Some(self.rest(py))),
        };
        let of_row = [self.live.description().cuts().len(), 6];
        if self.live.refusal(FunctionId::InternalForces).is_some() {
            return self.one_by_one(py, state, (&of_row, 0), invalid, write_wrenches);
        }
        self.compute(py, FunctionId::InternalForces, state, invalid)
    }

    /// (..., 5 sections + 5): stresses and utilisation of every section of beams, then margin, moments and supports of the governing
    /// tipping line; `Crane.strength` names them.
    #[pyo3(name = "_strength", signature = (q, v=None, a=None, t=None, *, invalid="raise"))]
    fn strength_rows<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: Given<'py>,
        a: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let state = StateArguments {
            t,
            q: Some(q),
            v: v.or_else(|| Some(self.rest(py))),
            a: a.or_else(|| Some(self.rest(py))),
        };
        let width = OF_SECTION * self.live.description().sections.len() + OF_LINE;
        self.one_by_one(py, state, (&[width], 0), invalid, write_wrenches_of)
    }
}

impl Crane {
    /// Rates and accelerations at rest.
    fn rest<'py>(&self, py: Python<'py>) -> ArrayLike<'py> {
        numpy::PyArray1::<f64>::zeros(py, self.live.size(), false).into_any().into()
    }
}

/// Internal forces, including those of cylinders with a valve and of joints that close loops.
fn write_wrenches(crane: &LiveCrane, Moment { t, q, v, a }: &Moment, out: &mut [f64]) {
    let crane: &dyn DynCrane = crane;
    for (wrench, out) in crane.internal_forces_at(*t, q, v, a).iter().zip(out.chunks_mut(6)) {
        let (force, moment) = out.split_at_mut(3);
        force.copy_from_slice(wrench.force.as_slice());
        moment.copy_from_slice(wrench.moment.as_slice());
    }
}

/// Stresses and the governing tipping line of a crane; NaN where moduli or lines are unknown.
fn write_wrenches_of(crane: &LiveCrane, Moment { t, q, v, a }: &Moment, out: &mut [f64]) {
    let crane: &dyn DynCrane = crane;
    let description = crane.description();
    out.fill(f64::NAN);
    let wrenches = crane.internal_forces_at(*t, q, v, a);
    let known = stressed_sections(description, &crane.section_moduli_at(), &crane.section_places_at(q), &wrenches);
    for section in known {
        let Stress { normal, shear, torsion, equivalent } = section.stress;
        let of_section = [normal, shear, torsion, equivalent, section.utilisation.unwrap_or(f64::NAN)];
        out[OF_SECTION * section.place.section..][..OF_SECTION].copy_from_slice(&of_section);
    }
    let lines = tipping::lines(crane, *t, q, v, a);
    if let (Some(line), Some(out)) = (tipping::governing(&lines), out.last_chunk_mut::<OF_LINE>()) {
        let [from, to] = line.feet.map(|foot| foot as f64);
        *out = [line.margin(), line.stabilising, line.overturning, from, to];
    }
}
