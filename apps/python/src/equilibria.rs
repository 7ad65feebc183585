//! Statics, row by row.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::envelope::{Axis, Varied};
use crane_model::statics::{Diagnosis, Equilibrium, Problem, RestSearch, Settings};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::envelope::{check_axis, drives};
use crate::mistakes::{BadRow, Invalid, NoEquilibrium, describe, warn_of_rows};
use crate::parallel::map_rows;
use crate::types::{ArrayLike, Dict, Given};

/// Status of a row whose arguments or parameters are not allowed.
const INVALID: &str = "invalid";

/// The result of statics for a row.
pub struct FoundEquilibria {
    equilibrium: Equilibrium,
    /// Why it is not stable, if it is not.
    diagnosis: Option<Diagnosis>,
    efforts: Vec<f64>,
    reactions: Vec<f64>,
    points: Vec<f64>,
}

impl FoundEquilibria {
    /// Solves statics of a crane, with the drives at a time or some of them held at positions, and starting from a pose, if these are given.
    fn new(
        crane: &LiveCrane,
        (at, held): (Option<f64>, &[(usize, f64)]),
        from: Option<&[f64]>,
        settings: &Settings,
    ) -> Self {
        let crane: &dyn DynCrane = crane;
        let t = at.unwrap_or(0.0);
        let mut positions = crane.drive_targets_at(t);
        for &(drive, position) in held {
            positions[drive] = position;
        }
        let equilibrium = match (at, from) {
            (_, Some(from)) if !held.is_empty() => {
                Problem::new(crane).holding(&positions).from(from).settings(settings).solve()
            }
            (_, None) if !held.is_empty() => RestSearch { crane, positions: &positions }.find(None),
            (None, None) => crane.equilibrium(settings),
            (at, Some(from)) => Problem::new(crane).at_time(at.unwrap_or(0.0)).from(from).settings(settings).solve(),
            (Some(t), None) => Problem::new(crane).at_time(t).from(&crane.guess()).settings(settings).solve(),
        };
        let diagnosis = (!equilibrium.is_stable()).then(|| Diagnosis::new(crane, &equilibrium));
        let q = &equilibrium.q;
        let efforts = crane.drive_efforts_holding(t, &positions, q);
        let flat = |vectors: Vec<crane_model::nalgebra::Vector3<f64>>| vectors.iter().flatten().copied().collect();
        let reactions = flat(crane.support_reactions_at(q, &vec![0.0; q.len()]));
        let points = flat(crane.points_at(q));
        Self { equilibrium, diagnosis, efforts, reactions, points }
    }

    /// Whether the crane is at rest.
    fn rests(&self) -> bool {
        self.equilibrium.rests()
    }
}

impl Crane {
    /// Drives that are held, with their positions, by the name of a coordinate or of a link with one drive.
    fn held(&self, given: &[(String, ArrayLike<'_>)]) -> PyResult<Vec<(usize, Argument)>> {
        let description = self.live.description();
        let mut held: Vec<(usize, Argument)> = Vec::new();
        for (name, positions) in given {
            let Some(Varied::Drive(drive)) = Varied::named(name, description) else {
                return Err(PyValueError::new_err(format!(
                    "{} has no drive `{name}`; drives: {}",
                    description.name,
                    drives(description).join(", ")
                )));
            };
            if held.iter().any(|(other, _)| *other == drive) {
                return Err(PyValueError::new_err(format!("hold: `{name}` is given twice")));
            }
            let unit = description.coordinates[description.drives[drive].coordinate].kind.unit();
            let text = format!("hold['{name}']");
            let argument = Argument::scalars_in(unit, &text, positions)?;
            check_axis(&Axis { varied: Varied::Drive(drive), values: argument.numbers.clone() }, &text, description)?;
            held.push((drive, argument));
        }
        Ok(held)
    }
}

#[pymethods]
impl Crane {
    /// Equilibria over parameters, times, guesses and positions of drives: `Crane.statics` makes an `Equilibrium` of them.
    #[pyo3(name = "_equilibria", signature = (t=None, hold=None, guess=None, tolerance=None, iterations=None, load_steps=None, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn equilibria<'py>(
        &self,
        py: Python<'py>,
        t: Given<'py>,
        hold: Option<Vec<(String, ArrayLike<'py>)>>,
        guess: Given<'py>,
        tolerance: Option<f64>,
        iterations: Option<usize>,
        load_steps: Option<usize>,
        invalid: &str,
    ) -> PyResult<Dict<'py>> {
        let invalid = Invalid::named(invalid)?;
        let defaults = Settings::default();
        let settings = Settings {
            tolerance: tolerance.unwrap_or(defaults.tolerance),
            iterations: iterations.unwrap_or(defaults.iterations),
            load_steps: load_steps.unwrap_or(defaults.load_steps),
        };
        if !(settings.tolerance > 0.0 && settings.tolerance < 1.0) {
            return Err(PyValueError::new_err(format!(
                "tolerance={}: write a number between 0 and 1, the part of the balancing forces that may be left over ({:e})",
                settings.tolerance, defaults.tolerance
            )));
        }
        if settings.iterations == 0 {
            return Err(PyValueError::new_err("iterations=0: write how many Newton steps may be taken, 1 or more"));
        }
        let description = self.live.description();
        let none = Argument::none;
        let times = t.as_ref().map_or_else(|| Ok(none()), |t| Argument::scalars("t", t))?;
        let guesses = guess.map_or_else(|| Ok(none()), |guess| Argument::coordinates("guess", &guess, description))?;
        let nothing = none();
        let held = self.held(hold.as_deref().unwrap_or_default())?;
        if !held.is_empty() && t.is_some() {
            let told = "drives are held at t = 0: give `t` or `hold`";
            return Err(PyValueError::new_err(told));
        }
        let mut arguments = vec![
            ("t", &times),
            ("guess", &guesses),
            ("v", &nothing),
            ("a", &nothing),
            ("the parameters", &self.parameters),
        ];
        let first_held = arguments.len();
        arguments.extend(held.iter().map(|(_, positions)| ("hold", positions)));
        let joined = Joined::new(&arguments)?;
        let wrong = self.bad_rows(&joined, invalid)?;
        let refused = |row: usize| wrong.iter().find(|bad| bad.row == row);
        let n = self.live.size();
        let found = map_rows(py, joined.rows(), |row, _| {
            if refused(row).is_some() {
                return None;
            }
            let at = joined.row(0, 1, row).first().copied();
            let from = Some(joined.row(1, n, row)).filter(|row| !row.is_empty());
            let held = held.iter().enumerate();
            let held: Vec<_> =
                held.map(|(index, (drive, _))| (*drive, joined.row(first_held + index, 1, row)[0])).collect();
            Some(FoundEquilibria::new(&self.of_joined_row(&joined, row), (at, &held), from, &settings))
        })?;
        let message = |(row, found): (usize, &Option<FoundEquilibria>)| match found {
            Some(FoundEquilibria { equilibrium, diagnosis, .. }) => {
                format!("{equilibrium}{}", diagnosis.as_ref().map_or_else(String::new, Diagnosis::to_string))
            }
            None => refused(row).map_or_else(String::new, |bad| bad.reason.clone()),
        };
        let reason = |row: usize, found: &Option<FoundEquilibria>| {
            let stands = found.as_ref().is_some_and(|found| found.equilibrium.is_stable());
            (!stands).then(|| message((row, found)))
        };
        let bad: Vec<BadRow> = found
            .iter()
            .enumerate()
            .filter_map(|(row, found)| Some(BadRow { row, reason: reason(row, found)? }))
            .collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            let hint = found[first.row]
                .as_ref()
                .and_then(|found| found.diagnosis.as_ref())
                .unwrap_or(&Diagnosis::Unknown)
                .advice();
            let found_at = describe(first, &joined.shape);
            return Err(NoEquilibrium::new_err(format!(
                "{}: statics did not find a stable equilibrium ({found_at}); {hint}",
                description.name
            )));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        let numbers = |of: fn(&FoundEquilibria) -> &Vec<f64>, defaults: &[usize]| {
            let row = |found: &Option<FoundEquilibria>| -> Vec<f64> {
                let found = found.as_ref().filter(|found| found.rests());
                found.map_or_else(|| vec![f64::NAN; defaults.iter().product()], |found| of(found).clone())
            };
            array(py, found.iter().flat_map(row).collect(), &joined.shape, defaults)
        };
        let all = PyDict::new(py);
        all.set_item("q", numbers(|found| &found.equilibrium.q, &[n])?)?;
        all.set_item("drive_efforts", numbers(|found| &found.efforts, &[description.drives.len()])?)?;
        all.set_item("support_reactions", numbers(|found| &found.reactions, &[description.supports.len(), 3])?)?;
        all.set_item("points", numbers(|found| &found.points, &[description.points.len(), 3])?)?;
        let equilibria = || found.iter().map(|found| found.as_ref().map(|found| &found.equilibrium));
        let residuals = equilibria().map(|found| found.map_or(f64::NAN, Equilibrium::residual)).collect();
        all.set_item("residual", array(py, residuals, &joined.shape, &[])?)?;
        let status = |found: Option<&Equilibrium>| found.map_or(INVALID, |found| found.status.name());
        all.set_item("status", equilibria().map(status).collect::<Vec<_>>())?;
        all.set_item("message", found.iter().enumerate().map(message).collect::<Vec<_>>())?;
        all.set_item("steps", equilibria().map(|found| found.map_or(0, Equilibrium::steps)).collect::<Vec<_>>())?;
        all.set_item("shape", joined.shape.clone())?;
        Ok(all.into())
    }
}
