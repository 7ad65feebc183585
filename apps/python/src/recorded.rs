//! What recorded runs say afterwards: what drives must be able to do, and fatigue.

use std::collections::HashMap;

use crane_model::dyn_crane::DynCrane;
use crane_model::fatigue::{self, Cycle, Detail, LEAST_LIKELY_CATEGORY, Manoeuvre};
use crane_model::results::{Duties, Instant, Recording, Table, instants};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::Argument;
use crate::crane::Crane;
use crate::types::Rows;

/// Rows of numbers as the table of a run.
pub fn table_of(crane: &dyn DynCrane, rows: &PyReadonlyArray2<'_, f64>) -> PyResult<Table> {
    let mut table = Recording::new(crane).into_table();
    let rows = rows.as_array();
    let name = &crane.description().name;
    if rows.ncols() != table.columns.len() || rows.nrows() == 0 {
        let (given, expected) = (rows.shape(), table.columns.len());
        return Err(PyValueError::new_err(format!(
            "the table of a run of {name} has {expected} columns, not {given:?}"
        )));
    }
    table.rows = rows.outer_iter().map(|row| row.to_vec()).collect();
    Ok(table)
}

/// A drive: its name, the units of efforts and of rates, and what it must be able to do.
type OfDrive = (String, String, String, [f64; 7]);
/// A cylinder: its name, and what it must be able to do.
type OfCylinder = (String, [f64; 7]);
/// Drives, cylinders, and the pump.
type OfAll = (Vec<OfDrive>, Vec<OfCylinder>, Option<[f64; 4]>);

/// What drives, cylinders and the pump of a run must be able to do: `Run.duties` names it.
#[pyfunction]
pub fn duties_of(crane: PyRef<'_, Crane>, table: Rows<'_>) -> PyResult<OfAll> {
    let crane: &dyn DynCrane = &crane.live;
    let Duties { drives, cylinders, pump } = Duties::new(crane.description(), &table_of(crane, &table)?);
    let drives = drives.into_iter().map(|duty| {
        let numbers = [duty.effort, duty.rms, duty.rate, duty.power, duty.braking_power, duty.work, duty.braking_work];
        (duty.name, duty.kind.force_unit().to_owned(), format!("{}/s", duty.kind.unit()), numbers)
    });
    let cylinders = cylinders.into_iter().map(|duty| {
        let [shortest, longest] = duty.lengths;
        (duty.name, [duty.push, duty.pull, duty.pressure, duty.speed, duty.flow, shortest, longest])
    });
    let pump = pump.map(|pump| [pump.flow, pump.pressure, pump.power, pump.energy]);
    Ok((drives.collect(), cylinders.collect(), pump))
}

/// A place: its beam, its place along it in m, its location in words, its category in Pa, the history parameter, and for each manoeuvre damage, stresses, and
/// cycles: range, mean, count, times of both ends.
type OfPlace = (String, f64, String, f64, f64, Vec<(f64, Vec<f64>, Vec<[f64; 5]>)>);

/// What runs that repeat do to every place of beams: `crane.fatigue` names it. `categories`: of beams by their names, `None` that of all others.
#[pyfunction]
pub fn fatigue_of(
    manoeuvres: Vec<(PyRef<'_, Crane>, Rows<'_>, f64)>,
    categories: Vec<(Option<String>, Bound<'_, PyAny>)>,
    slope: f64,
    safety_factor: f64,
) -> PyResult<Vec<OfPlace>> {
    let Some((first, ..)) = manoeuvres.first() else {
        return Err(PyValueError::new_err(
            "there are no manoeuvres: give at least one run and how often it is repeated",
        ));
    };
    let description = (&first.live as &dyn DynCrane).description();
    let names = description.beams();
    let above_zero = |name: &str, number: f64| {
        let wrong = || PyValueError::new_err(format!("{name}={number}: write a finite number above 0"));
        (number.is_finite() && number > 0.0).then_some(number).ok_or_else(wrong)
    };
    above_zero("slope", slope)?;
    above_zero("safety_factor", safety_factor)?;
    let mut known: HashMap<Option<String>, f64> = HashMap::new();
    for (beam, given) in &categories {
        let named = beam.as_ref().map_or_else(|| "category".to_owned(), |beam| format!("category[{beam:?}]"));
        if let Some(beam) = beam.as_ref().filter(|beam| !names.contains(&beam.as_str())) {
            return Err(PyValueError::new_err(format!("`{beam}` is not a beam: beams are {}", names.join(", "))));
        }
        let numbers = Argument::scalars_in("Pa", &named, given)?;
        let [number] = numbers.numbers[..] else {
            return Err(PyValueError::new_err(format!("{named}: write one number")));
        };
        if above_zero(&named, number)? < LEAST_LIKELY_CATEGORY {
            return Err(PyValueError::new_err(format!(
                "{named}={number}: a number is in Pa: write \"{number} MPa\", if it is meant in MPa"
            )));
        }
        known.insert(beam.clone(), number / safety_factor);
    }
    let detail = |beam: &str| known.get(&Some(beam.to_owned())).or(known.get(&None)).copied();
    if let Some(beam) = names.iter().find(|beam| detail(beam).is_none()) {
        return Err(PyValueError::new_err(format!(
            "no category for {beam}: write one number for all beams, or add this one"
        )));
    }
    let mut histories: Vec<Vec<Instant>> = Vec::new();
    for (crane, table, repetitions) in &manoeuvres {
        above_zero("repetitions", *repetitions)?;
        let crane: &dyn DynCrane = &crane.live;
        let own = crane.description();
        if own.sections != description.sections || own.beams() != names {
            return Err(PyValueError::new_err(format!(
                "{} has other places along its beams than {}: manoeuvres are of one crane, with other motions, loads and parameters alone",
                own.name, description.name
            )));
        }
        histories.push(instants(crane, table_of(crane, table)?.rows.iter()));
    }
    let moduli: Vec<_> =
        manoeuvres.iter().map(|(crane, ..)| (&crane.live as &dyn DynCrane).section_moduli_at()).collect();
    let all: Vec<Manoeuvre<'_>> = manoeuvres
        .iter()
        .zip(&histories)
        .zip(&moduli)
        .map(|(((.., repetitions), history), moduli)| Manoeuvre {
            moduli,
            states: history.iter().map(Instant::state).collect(),
            repetitions: *repetitions,
        })
        .collect();
    let found = fatigue::of_manoeuvres(description, &all, |beam| Detail {
        category: detail(beam).unwrap_or(f64::INFINITY),
        slope,
    });
    let of_place = |fatigue: &fatigue::Fatigue| {
        let beam = fatigue.place.beam(description);
        let parts = fatigue.parts.iter().zip(&histories).map(|(part, history)| {
            let cycle = |&Cycle { range, mean, count, ends }: &Cycle| {
                let [from, to] = ends.map(|index| history[index].t);
                [range, mean, count, from, to]
            };
            (part.damage, part.history.clone(), part.cycles.iter().map(cycle).collect())
        });
        let category = detail(beam).unwrap_or(f64::INFINITY);
        let location = fatigue.location(description);
        (beam.to_owned(), fatigue.place.x, location, category, fatigue.history_parameter(slope), parts.collect())
    };
    Ok(found.iter().map(of_place).collect())
}
