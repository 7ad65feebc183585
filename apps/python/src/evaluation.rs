//! How a function is computed of states: rows of all arguments, eight at a time or one by one, on all threads.

use crane_live::rows::{BatchEvaluation, ParameterRows};
use crane_live::{FunctionId, Refusal};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::force_states;
use crane_model::rt::lanes::f64x8;
use numpy::PyArrayMethods;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array, zeros};
use crate::crane::Crane;
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::{for_rows, map_rows};
use crate::types::{Array, ArrayLike, Given, Numbers};

/// Rows that a thread takes at a time: some tens of microseconds of work.
const PIECE: usize = 64;
/// Place of the parameters among arguments: behind t, q, v, a.
const PARAMETERS: usize = 4;

/// A state as it was given.
#[derive(Default)]
pub struct StateArguments<'py> {
    /// Time.
    pub t: Given<'py>,
    /// Coordinates.
    pub q: Given<'py>,
    /// Rates.
    pub v: Given<'py>,
    /// Accelerations.
    pub a: Given<'py>,
}

impl<'py> StateArguments<'py> {
    /// At rest.
    pub fn pose(q: ArrayLike<'py>) -> Self {
        Self { q: Some(q), ..Self::default() }
    }

    /// In motion.
    pub fn moving(q: ArrayLike<'py>, v: ArrayLike<'py>) -> Self {
        Self { v: Some(v), ..Self::pose(q) }
    }
}

/// The state of a row; what was not given is empty, and the time 0.
pub struct Moment {
    /// Time, s.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rates.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

impl Crane {
    /// A function of all rows.
    pub fn compute<'py>(
        &self,
        py: Python<'py>,
        function: FunctionId,
        state: StateArguments<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let of_row = &*self.live.shape(function);
        self.refuse(function)?;
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let invalid = Invalid::named(invalid)?;
        let mut bad = self.bad_rows(&joined, invalid)?;
        let [t, q, v, a, parameters] = [0, 1, 2, 3, 4].map(|index| &*joined.arguments[index]);
        let parameters = if self.is_single() { &[][..] } else { parameters };
        let rows = ParameterRows { t, q, v, a, parameters };
        let width = of_row.iter().product::<usize>();
        let finite = if function == FunctionId::ForwardDynamics { width } else { 0 };
        if joined.shape.is_empty() && bad.is_empty() {
            let array = zeros(py, &[], of_row);
            let mut numbers = array.readwrite();
            let out = numbers.as_slice_mut().unwrap_or_default();
            self.with_workspace(function, |evaluation| evaluation.run(&rows, 0..1, out));
            settle(py, out, &mut bad, (width, finite), &joined.shape, invalid)?;
            return Ok(array.into());
        }
        // Room that NumPy asks the system for comes in larger pages.
        let array = zeros(py, &joined.shape, of_row);
        let mut numbers = array.readwrite();
        let out = numbers.as_slice_mut().unwrap_or_default();
        let make = || BatchEvaluation::<f64x8>::new(&self.live, function);
        for_rows(py, (PIECE, width), out, make, |evaluation, range, out| evaluation.run(&rows, range, out))?;
        settle(py, out, &mut bad, (width, finite), &joined.shape, invalid)?;
        Ok(array.into())
    }

    /// The same by a function of one crane; so many first numbers of a row must be finite.
    pub fn one_by_one<'py>(
        &self,
        py: Python<'py>,
        state: StateArguments<'py>,
        (of_row, finite): (&[usize], usize),
        invalid: &str,
        write: impl Fn(&crane_live::LiveCrane, &Moment, &mut [f64]) + Sync,
    ) -> Array<'py> {
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let invalid = Invalid::named(invalid)?;
        let mut bad = self.bad_rows(&joined, invalid)?;
        let (n, width) = (self.live.size(), of_row.iter().product::<usize>());
        let rows = map_rows(py, joined.rows(), |row, _| {
            let mut out = vec![0.0; width];
            if bad.iter().all(|bad| bad.row != row) {
                let [t, q, v, a] =
                    [(0, 1), (1, n), (2, n), (3, n)].map(|(index, size)| joined.row(index, size, row).to_vec());
                let moment = Moment { t: t.first().copied().unwrap_or(0.0), q, v, a };
                write(&self.of_joined_row(&joined, row), &moment, &mut out);
            }
            out
        })?;
        let mut out = rows.concat();
        settle(py, &mut out, &mut bad, (width, finite), &joined.shape, invalid)?;
        array(py, out, &joined.shape, of_row).map(Numbers::from)
    }

    /// Refuses functions that do not follow from pose, rates and time, or that closed loops change.
    pub fn refuse(&self, function: FunctionId) -> PyResult<()> {
        let refusal = self.live.refusal(function);
        let why = match refusal {
            None => return Ok(()),
            Some(Refusal::ForceStates) => format!("follows from {}, which are states of a run", self.force_states()),
            Some(Refusal::TooLarge) => {
                let most = crane_live::LiveCrane::MOST_COORDINATES_OF_DERIVATIVES;
                format!("is offered up to {most} coordinates, and the crane has {}", self.live.size())
            }
            Some(Refusal::Loop(joint)) => format!("depends on {}", joint.closes()),
        };
        let instead = match function {
            FunctionId::Linearise => "use state_space(q), or modes(q)",
            FunctionId::DriveForcesAtRest => "use statics",
            _ if refusal == Some(Refusal::TooLarge) => "use linearise(q, v, a, t)",
            FunctionId::ForwardDynamicsDerivatives
            | FunctionId::DynamicResidualDerivatives
            | FunctionId::ForceDerivatives => "use state_space, whose A contains those of the accelerations",
            FunctionId::ForwardDynamics | FunctionId::DynamicResidual => "use state_derivatives(q, v, x, t)",
            FunctionId::Forces => {
                "use state_derivatives(q, v, x, t) for accelerations, columns_at(q, v, x, t) for the efforts of drives"
            }
            FunctionId::DrivePower => {
                "use columns_at(q, v, x, t): it is the sum of efforts of drives times rates of their motions"
            }
            FunctionId::Dissipation => "use simulate, whose dissipated_energy is its integral",
            _ => "use columns_at(q, v, x, t), which has what drives, pressures and joints exert",
        };
        let name = &self.live.description().name;
        let or = if let Some(Refusal::Loop(joint)) = refusal { joint.remedy() } else { "" };
        Err(PyValueError::new_err(format!("{} of {name} {why}: {instead}{or}", function.name())))
    }

    /// States of the forces of a crane that has some, in words.
    pub fn force_states(&self) -> &'static str {
        let description = self.live.description();
        match (description.has_valves(), description.bristles.is_empty()) {
            (true, true) => "pressures",
            (true, false) => "pressures and deflections of bristles",
            (false, _) => "deflections of bristles",
        }
    }

    /// The crane with the parameters of a row of all arguments.
    pub fn of_joined_row(&self, joined: &Joined<'_>, row: usize) -> crane_live::LiveCrane {
        let mut crane = self.live.clone();
        if !self.is_single() && self.parameters.width > 0 {
            // Checked when they were given.
            let _ = crane.set_parameters(joined.row(PARAMETERS, self.parameters.width, row));
        }
        crane
    }

    /// t, q, v, a; empty if not given, which means t = 0 for the time.
    pub fn read(&self, state: StateArguments<'_>) -> PyResult<[Argument; 4]> {
        let description = self.live.description();
        let coordinates = |name: &str, given: Given<'_>| {
            given.map_or_else(|| Ok(Argument::none()), |given| Argument::coordinates(name, &given, description))
        };
        Ok([
            state.t.map_or_else(|| Ok(Argument::none()), |t| Argument::scalars("t", &t))?,
            coordinates("q", state.q)?,
            coordinates("v", state.v)?,
            coordinates("a", state.a)?,
        ])
    }

    /// t, q, v, a and the parameters over common leading axes.
    fn joined<'a>(&'a self, [t, q, v, a]: &'a [Argument; 4]) -> PyResult<Joined<'a>> {
        Joined::new(&[("t", t), ("q", q), ("v", v), ("a", a), ("the parameters", &self.parameters)])
    }

    /// Rows with numbers that are not finite, or with parameters that break a rule. The first arguments are a time, coordinates, rates,
    /// accelerations and parameters.
    pub fn bad_rows(&self, joined: &Joined<'_>, invalid: Invalid) -> PyResult<Vec<BadRow>> {
        let description = self.live.description();
        let place = |argument: usize, index: usize| match argument {
            1..PARAMETERS => format!("[{index}] ({})", description.coordinates[index].name),
            _ if joined.names[argument].0 == "x" => {
                format!("[{index}] ({})", force_states::columns(description)[index])
            }
            _ if joined.names[argument].1 > 1 => format!("[{index}]"),
            _ => String::new(),
        };
        let mut bad: Vec<BadRow> = Vec::new();
        for (argument, (name, width)) in joined.names.iter().enumerate() {
            if argument == PARAMETERS || joined.arguments[argument].iter().all(|x| x.is_finite()) {
                continue;
            }
            for row in 0..joined.rows() {
                let numbers = joined.row(argument, *width, row);
                let Some(index) = numbers.iter().position(|x| !x.is_finite()) else { continue };
                let (of, value) = (place(argument, index), numbers[index]);
                bad.push(BadRow { row, reason: format!("{name}{of} is {value}, not a finite number") });
            }
        }
        if !self.bad.is_empty() {
            let refused = |row: &usize| self.live.check(joined.row(PARAMETERS, self.parameters.width, *row)).err();
            bad.extend((0..joined.rows()).filter_map(|row| Some(BadRow { row, reason: refused(&row)?.to_string() })));
        }
        bad.sort_by_key(|bad| bad.row);
        bad.dedup_by_key(|bad| bad.row);
        raise_first(&bad, &joined.shape, invalid)?;
        Ok(bad)
    }
}

/// Raises why the first bad row is bad, if that was asked for.
fn raise_first(bad: &[BadRow], shape: &[usize], invalid: Invalid) -> PyResult<()> {
    let (Some(first), Invalid::Raise) = (bad.first(), invalid) else { return Ok(()) };
    let hint = if shape.is_empty() { "" } else { "; invalid=\"nan\" makes the results of such rows NaN" };
    Err(PyValueError::new_err(format!("{}{hint}", describe(first, shape))))
}

/// Makes the numbers of bad rows NaN, and warns of them. Rows are also bad whose `finite` first numbers, of `width`, are not all finite.
pub fn settle(
    py: Python<'_>,
    out: &mut [f64],
    bad: &mut Vec<BadRow>,
    (width, finite): (usize, usize),
    shape: &[usize],
    invalid: Invalid,
) -> PyResult<()> {
    let known: Vec<usize> = bad.iter().map(|bad| bad.row).collect();
    let rows = if finite > 0 { out.len() / width } else { 0 };
    let overflows = |row: &usize| out[row * width..][..finite].iter().any(|number| !number.is_finite());
    let found = (0..rows).filter(|row| known.binary_search(row).is_err()).filter(overflows);
    bad.extend(found.map(|row| {
        BadRow {
            row,
            reason: "accelerations are not finite: rates are too large, or a linkage cannot be assembled in this pose"
                .to_owned(),
        }
    }));
    raise_first(bad, shape, invalid)?;
    for bad in &*bad {
        out[bad.row * width..(bad.row + 1) * width].fill(f64::NAN);
    }
    warn_of_rows(py, bad, shape)
}
