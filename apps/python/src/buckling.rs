//! Buckling, and the first order beside the second: what `crane strength --buckling` prints.

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::envelope::{LoadFactor, SecondOrder, load_factor, second_order};
use crane_model::statics::Status;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::crane::Crane;
use crate::types::Dict;

#[pymethods]
impl Crane {
    /// Critical factors of weight and loads, and displacements and bending moments by both orders: `Crane.buckling` names them. None if the crane does not rest.
    #[pyo3(name = "_buckling")]
    fn buckling<'py>(&self, py: Python<'py>) -> PyResult<Option<Dict<'py>>> {
        if !self.is_single() {
            return Err(PyValueError::new_err("the parameters are arrays: buckling is that of one crane"));
        }
        let (mut crane, parameter) = self.live.with_load_factor();
        let found = py.detach(|| {
            let factors = load_factor(&mut crane, parameter)?;
            let (mut other, _) = self.live.with_load_factor();
            Some((factors, second_order(&mut other, parameter)))
        });
        let Some((LoadFactor { linearised, followed }, orders)) = found else { return Ok(None) };
        let description = crane.description();
        // Of closed loops there is none.
        let beyond = if (&crane as &dyn DynCrane).loop_joints().is_empty() { f64::INFINITY } else { f64::NAN };
        let status = followed.as_ref().map(|followed| followed.beyond.as_ref().map_or("", Status::name));
        let points = description.points.len();
        let known = orders.is_some();
        let SecondOrder { points: moved, beams } = orders.unwrap_or_default();
        let moved: Vec<f64> = moved.iter().flatten().flat_map(|moved| moved.iter().copied()).collect();
        let moved = if known { moved } else { vec![f64::NAN; 6 * points] };
        let all = PyDict::new(py);
        all.set_item("linearised", linearised.unwrap_or(beyond))?;
        all.set_item("followed", followed.map_or(f64::INFINITY, |followed| followed.factor))?;
        all.set_item("status", status.unwrap_or_default())?;
        all.set_item("displacements", array(py, moved, &[points], &[2, 3])?)?;
        all.set_item("beams", beams.iter().map(|(place, _)| place.beam(description)).collect::<Vec<_>>())?;
        all.set_item("places", beams.iter().map(|(place, _)| place.location(description)).collect::<Vec<_>>())?;
        let moments = beams.iter().flat_map(|(_, moments)| *moments).collect();
        all.set_item("moments", array(py, moments, &[beams.len()], &[2])?)?;
        Ok(Some(all.into()))
    }
}
