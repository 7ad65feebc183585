//! Statics, row by row.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, DynModel};
use crane_model::statics::{Equilibrium, Settings, Status};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::mistakes::{BadRow, Invalid, NoEquilibrium, describe, warn_of_rows};
use crate::parallel::map_rows;

/// The result of statics for a row.
pub struct Found {
    equilibrium: Equilibrium,
    efforts: Vec<f64>,
    reactions: Vec<f64>,
    points: Vec<f64>,
}

impl Found {
    /// Solves statics of a crane, with the drives at a time and starting from a pose, if these are given.
    fn new(crane: &LiveCrane, at: Option<f64>, from: Option<&[f64]>, settings: &Settings) -> Self {
        let crane: &dyn DynCrane = crane;
        let equilibrium = match (at, from) {
            (None, None) => crane.equilibrium(settings),
            (at, Some(from)) => crane.equilibrium_at(at.unwrap_or(0.0), from, settings),
            (Some(t), None) => crane.equilibrium_at(t, &crane.guess(), settings),
        };
        let q = &equilibrium.q;
        let efforts = match at {
            None => crane.drive_efforts_at_rest(q),
            Some(t) => {
                let mut rates = vec![0.0; q.len()];
                for (drive, [_, rate]) in crane.description().drives.iter().zip(crane.drive_motions_at(t)) {
                    rates[drive.coordinate] = rate;
                }
                let mut efforts = crane.drive_efforts_at(t, q, &rates);
                let positions: Vec<f64> = crane.drive_motions_at(t).iter().map(|[position, _]| *position).collect();
                let holding = crane.drive_efforts_holding(&positions, q);
                let cylinders = crane.description().cylinders.iter();
                for cylinder in cylinders.filter(|cylinder| cylinder.valve.is_some()) {
                    efforts[cylinder.drive] = holding[cylinder.drive];
                }
                efforts
            }
        };
        let flat = |vectors: Vec<crane_model::nalgebra::Vector3<f64>>| vectors.iter().flatten().copied().collect();
        let reactions = flat(crane.support_reactions_at(q, &vec![0.0; q.len()]));
        let points = flat(crane.points_at(q));
        Self { equilibrium, efforts, reactions, points }
    }

    /// Whether the pose is an equilibrium of some kind.
    fn rests(&self) -> bool {
        matches!(self.equilibrium.status, Status::Converged | Status::Unstable { .. })
    }
}

#[pymethods]
impl Crane {
    /// Equilibria over parameters, times and guesses.
    #[pyo3(signature = (t=None, guess=None, tolerance=None, iterations=None, load_steps=None, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn equilibria<'py>(
        &self,
        py: Python<'py>,
        t: Option<&Bound<'py, PyAny>>,
        guess: Option<&Bound<'py, PyAny>>,
        tolerance: Option<f64>,
        iterations: Option<usize>,
        load_steps: Option<usize>,
        invalid: &str,
    ) -> PyResult<Bound<'py, PyDict>> {
        let invalid = Invalid::named(invalid)?;
        let own = Settings::default();
        let settings = Settings {
            tolerance: tolerance.unwrap_or(own.tolerance),
            iterations: iterations.unwrap_or(own.iterations),
            load_steps: load_steps.unwrap_or(own.load_steps),
        };
        let description = self.live.description();
        let none = || Argument { shape: Vec::new(), numbers: Vec::new(), width: 0 };
        let times = t.map_or_else(|| Ok(none()), |t| Argument::scalars("t", t))?;
        let guesses = guess.map_or_else(|| Ok(none()), |guess| Argument::coordinates("guess", guess, description))?;
        let nothing = none();
        let joined = Joined::new(&[
            ("t", &times),
            ("guess", &guesses),
            ("v", &nothing),
            ("a", &nothing),
            ("the parameters", &self.parameters),
        ])?;
        let n = self.live.size();
        let found = map_rows(py, joined.rows(), |row, _| {
            let of = |list: &[f64], size: usize| -> Option<Vec<f64>> {
                let row = if list.len() <= size { 0 } else { row };
                list.get(row * size..(row + 1) * size).filter(|row| !row.is_empty()).map(<[f64]>::to_vec)
            };
            let at = of(&joined.arguments[0], 1).map(|t| t[0]);
            let from = of(&joined.arguments[1], n);
            Found::new(&self.of_joined_row(&joined, row), at, from.as_deref(), &settings)
        })?;
        let refused = |row: usize| self.bad.iter().find(|bad| joined.shape == self.parameters.shape && bad.row == row);
        let reason = |row: usize, found: &Found| match refused(row) {
            Some(bad) => Some(bad.reason.clone()),
            None => (!found.equilibrium.is_stable()).then(|| found.equilibrium.to_string()),
        };
        let bad: Vec<BadRow> = found
            .iter()
            .enumerate()
            .filter_map(|(row, found)| Some(BadRow { row, reason: reason(row, found)? }))
            .collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            let hint = "change `guess:` in its spec to a pose near a stable equilibrium, or add a drive or spring to the coordinates named";
            let said = describe(first, &joined.shape);
            return Err(NoEquilibrium::new_err(format!(
                "{}: statics did not find a stable equilibrium ({said}); {hint}",
                description.name
            )));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        let rests = |row: usize, found: &Found| found.rests() && refused(row).is_none();
        let numbers = |of: fn(&Found) -> &Vec<f64>, own: &[usize]| {
            let row = |(row, found): (usize, &Found)| -> Vec<f64> {
                if rests(row, found) { of(found).clone() } else { vec![f64::NAN; of(found).len()] }
            };
            array(py, found.iter().enumerate().flat_map(row).collect(), &joined.shape, own)
        };
        let all = PyDict::new(py);
        all.set_item("q", numbers(|found| &found.equilibrium.q, &[n])?)?;
        all.set_item("drive_efforts", numbers(|found| &found.efforts, &[description.drives.len()])?)?;
        all.set_item("support_reactions", numbers(|found| &found.reactions, &[description.supports.len(), 3])?)?;
        all.set_item("points", numbers(|found| &found.points, &[description.points.len(), 3])?)?;
        let residuals = found.iter().map(|found| found.equilibrium.residual()).collect();
        all.set_item("residual", array(py, residuals, &joined.shape, &[])?)?;
        all.set_item("status", found.iter().map(|found| found.equilibrium.status.name()).collect::<Vec<_>>())?;
        all.set_item("message", found.iter().map(|found| found.equilibrium.to_string()).collect::<Vec<_>>())?;
        all.set_item("steps", found.iter().map(|found| found.equilibrium.steps()).collect::<Vec<_>>())?;
        all.set_item("shape", joined.shape.clone())?;
        Ok(all)
    }
}
