//! The crane as an HTML page, for notebooks and files.

use std::time::Duration;

use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{Run, Settings, Statistics};
use crane_model::results::{Verification, cautions};
use crane_model::runs::Recorded;
use crane_page::shapes::{
    Figure,
    picture::{View, draw},
};
use crane_page::tables::{Case, of_page};
use crane_page::{Program, Subject, Texts, page};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::Argument;
use crate::crane::Crane;
use crate::recorded::table_of;
use crate::types::{ArrayLike, Keys, Numbers};

/// This package, in records of runs.
const PROGRAM: Program = Program { name: "crane for Python", version: env!("CARGO_PKG_VERSION") };

/// A run as Python keeps it.
#[derive(FromPyObject)]
pub struct Given<'py> {
    #[pyo3(item)]
    table: PyReadonlyArray2<'py, f64>,
    #[pyo3(item)]
    start: String,
    #[pyo3(item)]
    method: String,
    #[pyo3(item)]
    tolerance: Option<f64>,
    #[pyo3(item)]
    step: f64,
    /// Steps, rejections, evaluations, factorisations.
    #[pyo3(item)]
    statistics: [usize; 4],
    #[pyo3(item)]
    errors: Option<Vec<f64>>,
    #[pyo3(item)]
    missed: Option<Vec<f64>>,
    #[pyo3(item)]
    divergence: Option<f64>,
    #[pyo3(item)]
    cautions: Vec<String>,
    #[pyo3(item)]
    wall_time: f64,
}

impl Given<'_> {
    /// The run, and the settings with which it was computed.
    fn recorded(&self, crane: &dyn DynCrane) -> PyResult<(Settings, Recorded)> {
        let table = table_of(crane, &self.table)?;
        let times: Vec<f64> = table.rows.iter().map(|row| row[0]).collect();
        let duration = times[times.len() - 1];
        let expected = Settings::from_description(crane.description());
        let settings = Settings {
            duration,
            output: times.get(1).map_or(duration, |second| second - times[0]),
            method: self.method.parse().map_err(|_| PyValueError::new_err(format!("method={:?}", self.method)))?,
            tolerance: self.tolerance.unwrap_or(expected.tolerance),
            ..expected
        };
        let [steps, rejections, evaluations, factorisations] = self.statistics;
        let statistics = Statistics { steps, rejections, evaluations, factorisations };
        let found = self.errors.clone().zip(self.missed.clone());
        let verification = found.map(|(errors, missed)| Verification { errors, missed, divergence: self.divergence });
        let recorded = Recorded {
            start: self.start.clone(),
            run: Run { statistics, step: self.step, time: duration, efforts: Vec::new() },
            table,
            wall: Duration::try_from_secs_f64(self.wall_time).ok(),
            verification,
            cautions: self.cautions.clone(),
        };
        Ok((settings, recorded))
    }
}

#[pymethods]
impl Crane {
    /// The crane in pose `q`, as the page shows it in 3-D, height × width × 3; `shown`: poses for which there is room, too.
    #[pyo3(name = "_render", signature = (q, shown, width, height, azimuth=None, elevation=None))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        shown: ArrayLike<'py>,
        width: i64,
        height: i64,
        azimuth: Option<f64>,
        elevation: Option<f64>,
    ) -> PyResult<Numbers<'py, u8>> {
        let view = View::new([width, height], azimuth, elevation).map_err(PyValueError::new_err)?;
        let crane: &dyn DynCrane = &self.live;
        let read = |name: &str, given| Argument::coordinates(name, given, crane.description());
        let (pose, shown) = (read("q", &q)?, read("shown", &shown)?);
        if !pose.shape.is_empty() {
            let shape = &pose.shape;
            return Err(PyValueError::new_err(format!("q: poses of shape {shape:?}: a picture shows one, as in q[0]")));
        }
        if !pose.numbers.iter().chain(&shown.numbers).all(|number| number.is_finite()) {
            return Err(PyValueError::new_err("q: not all numbers are finite: give a pose that the crane can have"));
        }
        let elements = py.detach(|| {
            let start = crane.guess();
            let figure = |q: &[f64]| Figure::new(&self.live, &start, q);
            let room: Vec<_> = shown.numbers.chunks(shown.width).flat_map(|q| figure(q).all_corners()).collect();
            draw(&figure(&pose.numbers), &view, &room)
        });
        let [width, height] = view.sides();
        Ok(PyArray1::from_vec(py, elements).reshape(vec![height, width, 3])?.into())
    }

    /// The crane in 3-D and in tables as an HTML page that needs no network: at rest, or with a run of it.
    #[pyo3(name = "_page", signature = (run=None))]
    fn page_with(&self, py: Python<'_>, run: Option<Keys<Given<'_>>>) -> PyResult<String> {
        let run = run.map(|run| run.recorded(&self.live)).transpose()?;
        let (crane, live, spec) = (&self.live as &dyn DynCrane, &self.live, &self.source.text);
        let made = py.detach(|| {
            let case = Case::new(&crane.description().name, crane);
            let run = run.as_ref().map(|(settings, recorded)| (settings, recorded));
            let runs: Vec<&Recorded> = run.iter().map(|(_, recorded)| *recorded).collect();
            let cases = [case];
            let tables = of_page(&cases, &runs, cautions::BEND, None).map_err(|failed| failed.to_string())?;
            let [Case { label, equilibrium, .. }] = &cases;
            let subject = Subject { label, crane, live, equilibrium, run };
            let texts = Texts { tables: Some(tables), spec: Some(spec), ..Texts::default() };
            page(&[subject], texts, PROGRAM).map_err(|error| error.to_string())
        });
        made.map_err(PyArithmeticError::new_err)
    }
}
