//! Derivatives of a crane at rest by its numbers, row by row.

use crane_codegen::{Checked, compile};
use crane_live::LiveCrane;
use crane_live::sensitivity::{
    Differences, FixedNumber, Output, Refused, Sensitivity, Settings, sensitivity, with_live_numbers,
};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::runs::Failed;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::crane::{Crane, parameter_index};
use crate::mistakes::{BadRow, Invalid, NoEquilibrium, describe, spec_error, warn_of_rows};
use crate::parallel::map_rows;
use crate::types::Dict;

#[pymethods]
impl Crane {
    /// Derivatives over parameters, by numbers of these names or places: `Crane.sensitivity` makes a `Sensitivity` of them.
    #[pyo3(name = "_sensitivity", signature = (numbers, frequencies=3, invalid="raise"))]
    fn sensitivity_rows<'py>(
        &self,
        py: Python<'py>,
        numbers: Vec<String>,
        frequencies: usize,
        invalid: &str,
    ) -> PyResult<Dict<'py>> {
        let invalid = Invalid::named(invalid)?;
        let (with_numbers, checked, names) = self.with_live_numbers(py, &numbers)?;
        let description = with_numbers.description();
        let (mut parameters, mut fixed) = (Vec::new(), Vec::new());
        for name in &names {
            if name.contains('.') {
                fixed.push(FixedNumber::new(&checked, name).map_err(|refused| refusal(py, refused))?);
            } else {
                parameters.push(parameter_index(description, name)?);
            }
        }
        let settings = Settings { frequencies };
        let shape = &self.parameters.shape;
        let found: Vec<Option<Result<Sensitivity, Failed>>> = map_rows(py, self.parameters.rows(), |row, _| {
            if self.bad.iter().any(|bad| bad.row == row) {
                return None;
            }
            let mut crane = with_numbers.clone();
            // Checked when they were given; the numbers at places keep their values.
            let _ = crane.set_parameters(self.of_row(row).parameters());
            Some(by_all(&crane, &parameters, &fixed, &names, settings))
        })?;
        let reason = |row: usize, found: &Option<Result<Sensitivity, Failed>>| match found {
            Some(Ok(_)) => None,
            Some(Err(failed)) => Some(failed.to_string()),
            None => self.bad.iter().find(|bad| bad.row == row).map(|bad| bad.reason.clone()),
        };
        let bad: Vec<BadRow> = found
            .iter()
            .enumerate()
            .filter_map(|(row, found)| Some(BadRow { row, reason: reason(row, found)? }))
            .collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            return Err(NoEquilibrium::new_err(describe(first, shape)));
        }
        warn_of_rows(py, &bad, shape)?;
        let found: Vec<Option<&Sensitivity>> =
            found.iter().map(|found| found.as_ref().and_then(|found| found.as_ref().ok())).collect();
        let Some(first) = found.iter().flatten().next() else {
            return Err(NoEquilibrium::new_err(format!("{}: no row has a stable equilibrium", description.name)));
        };
        let rows = CaseRows { found: &found, outputs: &first.outputs, count: names.len(), n: self.live.size() };
        let (outputs, count, n) = (rows.outputs.len(), rows.count, rows.n);
        let all = PyDict::new(py);
        all.set_item("q", array(py, rows.pose(|sensitivity| sensitivity.q.clone(), n), shape, &[n])?)?;
        all.set_item("values", array(py, rows.values(), shape, &[outputs])?)?;
        all.set_item("derivatives", array(py, rows.derivatives(), shape, &[outputs, count])?)?;
        let transposed = |found: &Sensitivity| (0..n).flat_map(|i| found.pose.iter().map(move |of| of[i])).collect();
        all.set_item("pose_derivatives", array(py, rows.pose(transposed, n * count), shape, &[n, count])?)?;
        all.set_item("outputs", rows.words(|output| &output.name))?;
        all.set_item("groups", rows.words(|output| output.group.name()))?;
        all.set_item("units", rows.words(|output| output.unit))?;
        all.set_item("places", rows.places())?;
        let notes: Vec<Vec<String>> =
            found.iter().map(|found| found.map_or_else(Vec::new, |sensitivity| sensitivity.notes.clone())).collect();
        all.set_item("notes", notes)?;
        let defaults: Vec<f64> = description.parameters.iter().map(|info| info.default).collect();
        let value = |row: &LiveCrane, index: usize| row.parameters().get(index).copied().unwrap_or(defaults[index]);
        let of_numbers = (0..self.parameters.rows()).flat_map(|row| {
            let row = self.of_row(row);
            in_order(
                &names,
                parameters.iter().map(|&index| value(&row, index)),
                fixed.iter().map(|number| number.value),
            )
        });
        let of_numbers = of_numbers.collect();
        all.set_item("numbers", array(py, of_numbers, shape, &[count])?)?;
        let units = parameters.iter().map(|&index| description.parameters[index].unit.as_str());
        let units: Vec<&str> = in_order(&names, units, fixed.iter().map(|number| number.unit.as_str()));
        all.set_item("number_units", units)?;
        all.set_item("shape", shape.clone())?;
        Ok(all.into())
    }
}

/// Why a number cannot change.
fn refusal(py: Python<'_>, refused: Refused) -> PyErr {
    match refused {
        Refused::Mistakes { mistakes, .. } => spec_error(py, &mistakes),
        other => PyValueError::new_err(other.words().join("; ")),
    }
}

/// What belongs to parameters and to fixed numbers in the order in which both were given; places of fixed numbers have points.
fn in_order<T>(names: &[String], mut live: impl Iterator<Item = T>, mut fixed: impl Iterator<Item = T>) -> Vec<T> {
    names.iter().filter_map(|name| if name.contains('.') { fixed.next() } else { live.next() }).collect()
}

/// Derivatives by parameters, and by fixed numbers as differences, in the order of the names.
fn by_all(
    crane: &LiveCrane,
    parameters: &[usize],
    fixed: &[FixedNumber],
    names: &[String],
    settings: Settings,
) -> Result<Sensitivity, Failed> {
    let mut sensitivity = sensitivity(crane, parameters, &settings)?;
    let differences: Vec<Differences> =
        fixed.iter().map(|number| number.differentiate(crane, &sensitivity, &settings)).collect::<Result<_, _>>()?;
    let of_fixed = differences.iter().map(|own| own.derivatives.clone());
    sensitivity.derivatives = in_order(names, std::mem::take(&mut sensitivity.derivatives).into_iter(), of_fixed);
    sensitivity.pose = in_order(
        names,
        std::mem::take(&mut sensitivity.pose).into_iter(),
        differences.iter().map(|own| own.pose.clone()),
    );
    sensitivity.notes.extend(fixed.iter().map(|number| {
        format!("{} cannot be a live parameter: its derivatives are differences of whole cranes", number.place)
    }));
    Ok(sensitivity)
}

impl Crane {
    /// The crane with the numbers at places of the spec as live parameters, what checking it found, and the names of all.
    fn with_live_numbers(&self, py: Python<'_>, numbers: &[String]) -> PyResult<(LiveCrane, Checked, Vec<String>)> {
        let mut names = numbers.to_vec();
        let checked = compile::check(&self.source).map_err(|mistakes| spec_error(py, &mistakes))?;
        let changed = with_live_numbers(&checked, &mut names).map_err(|refused| refusal(py, refused))?;
        let Some(changed) = changed else { return Ok((self.live.clone(), checked, names)) };
        let live = LiveCrane::new(changed.chain.clone());
        let inputs = (0..self.live.description().inputs.len()).map(|index| self.live.input(index));
        Ok((live.with_inputs(&inputs.collect::<Vec<_>>()), changed, names))
    }
}

/// Results of all rows, with the outputs of the first that has any.
struct CaseRows<'a> {
    found: &'a [Option<&'a Sensitivity>],
    outputs: &'a [Output],
    count: usize,
    n: usize,
}

impl CaseRows<'_> {
    /// Numbers of each row; NaN where there are none.
    fn pose(&self, numbers: impl Fn(&Sensitivity) -> Vec<f64>, count: usize) -> Vec<f64> {
        self.found.iter().flat_map(|found| found.map_or_else(|| vec![f64::NAN; count], &numbers)).collect()
    }

    /// The place of an output in a row.
    fn place(found: Option<&Sensitivity>, output: &Output) -> Option<usize> {
        found.and_then(|sensitivity| sensitivity.index_of(&output.name))
    }

    fn values(&self) -> Vec<f64> {
        let value = |found: Option<&Sensitivity>, output| match (found, Self::place(found, output)) {
            (Some(sensitivity), Some(index)) => sensitivity.values[index],
            _ => f64::NAN,
        };
        self.found.iter().flat_map(|found| self.outputs.iter().map(move |output| value(*found, output))).collect()
    }

    fn derivatives(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for found in self.found {
            for output in self.outputs {
                let place = Self::place(*found, output);
                all.extend((0..self.count).map(|k| match (found, place) {
                    (Some(sensitivity), Some(index)) => sensitivity.derivatives[k][index],
                    _ => f64::NAN,
                }));
            }
        }
        all
    }

    fn words<'b>(&'b self, of: impl Fn(&'b Output) -> &'b str) -> Vec<&'b str> {
        self.outputs.iter().map(of).collect()
    }

    fn places(&self) -> Vec<Vec<String>> {
        let place = |found: Option<&Sensitivity>, output: &Output| match (found, Self::place(found, output)) {
            (Some(sensitivity), Some(index)) => sensitivity.outputs[index].place.clone(),
            _ => String::new(),
        };
        self.found.iter().map(|found| self.outputs.iter().map(|output| place(*found, output)).collect()).collect()
    }
}
