//! How a function is computed of states: rows of all arguments, eight at a time or one by one, on all threads.

use crane_live::FunctionId;
use crane_live::rows::{Evaluation, Quantity, Rows};
use crane_model::dyn_crane::{DynCrane, DynModel};
use crane_model::rt::lanes::f64x8;
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array, zeros};
use crate::crane::Crane;
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::{for_rows, map_rows};

/// A result, over the leading axes and its own.
pub type Array<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
/// An argument that may be left out.
pub type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Rows that a thread takes at a time: some tens of microseconds of work.
const PIECE: usize = 64;

/// A state as it was given.
#[derive(Clone, Copy, Default)]
pub struct State<'a, 'py> {
    /// Time.
    pub t: Given<'a, 'py>,
    /// Coordinates.
    pub q: Given<'a, 'py>,
    /// Rates.
    pub v: Given<'a, 'py>,
    /// Accelerations.
    pub a: Given<'a, 'py>,
}

impl<'a, 'py> State<'a, 'py> {
    /// At rest.
    pub fn pose(q: &'a Bound<'py, PyAny>) -> Self {
        Self { q: Some(q), ..Self::default() }
    }

    /// In motion.
    pub fn moving(q: &'a Bound<'py, PyAny>, v: &'a Bound<'py, PyAny>) -> Self {
        Self { v: Some(v), ..Self::pose(q) }
    }

    /// At a time.
    pub fn at(self, t: Given<'a, 'py>) -> Self {
        Self { t, ..self }
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
    /// A function of all rows, `own`: the axes of one of its results.
    pub fn function<'py>(
        &self,
        py: Python<'py>,
        function: FunctionId,
        state: State<'_, 'py>,
        own: &[usize],
        invalid: &str,
    ) -> Array<'py> {
        self.compute(py, Quantity::Of(function), state, own, invalid)
    }

    /// A quantity of all rows, `own`: the axes of one of them.
    pub fn compute<'py>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: State<'_, 'py>,
        own: &[usize],
        invalid: &str,
    ) -> Array<'py> {
        let by_forces = matches!(
            quantity,
            Quantity::Of(
                FunctionId::ForwardDynamics
                    | FunctionId::Forces
                    | FunctionId::DriveForces
                    | FunctionId::DrivePower
                    | FunctionId::Linearise
            )
        );
        if by_forces && self.live.description().has_force_states() {
            return Err(PyValueError::new_err(
                "forces of this crane follow from pressures or bristles, which are states of a run: use simulate, simulation or modes",
            ));
        }
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let bad = self.bad_rows(&joined, Invalid::named(invalid)?)?;
        let [t, q, v, a, parameters] = [0, 1, 2, 3, 4].map(|index| &*joined.arguments[index]);
        let parameters = if self.is_single() { &[][..] } else { parameters };
        let rows = Rows { t, q, v, a, parameters };
        let (count, width) = (joined.rows(), own.iter().product::<usize>());
        if joined.shape.is_empty() && bad.is_empty() {
            let out = zeros(py, &[], own);
            self.in_room(quantity, |room| room.run(&rows, 0..1, out.readwrite().as_slice_mut().unwrap_or_default()));
            return Ok(out);
        }
        let mut out = vec![0.0; count * width];
        let make = || Evaluation::<f64x8>::new(&self.live, quantity);
        for_rows(py, (PIECE, width), &mut out, make, |room, range, out| room.run(&rows, range, out))?;
        forget(&mut out, &bad, width);
        warn_of_rows(py, &bad, &joined.shape)?;
        array(py, out, &joined.shape, own)
    }

    /// The same by a function of one crane.
    pub fn one_by_one<'py>(
        &self,
        py: Python<'py>,
        state: State<'_, 'py>,
        own: &[usize],
        invalid: &str,
        write: impl Fn(&crane_live::LiveCrane, &Moment, &mut [f64]) + Sync,
    ) -> Array<'py> {
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let bad = self.bad_rows(&joined, Invalid::named(invalid)?)?;
        let (n, width) = (self.live.size(), own.iter().product::<usize>());
        let of = |list: &[f64], size: usize, row: usize| -> Vec<f64> {
            let row = if list.len() <= size { 0 } else { row };
            list.get(row * size..(row + 1) * size).unwrap_or_default().to_vec()
        };
        let rows = map_rows(py, joined.rows(), |row, _| {
            let mut out = vec![0.0; width];
            if bad.iter().all(|bad| bad.row != row) {
                let [t, q, v, a] =
                    [(0, 1), (1, n), (2, n), (3, n)].map(|(index, size)| of(&joined.arguments[index], size, row));
                let moment = Moment { t: t.first().copied().unwrap_or(0.0), q, v, a };
                write(&self.of_joined_row(&joined, row), &moment, &mut out);
            }
            out
        })?;
        let mut out = rows.concat();
        forget(&mut out, &bad, width);
        warn_of_rows(py, &bad, &joined.shape)?;
        array(py, out, &joined.shape, own)
    }

    /// The crane with the parameters of a row of all arguments.
    pub fn of_joined_row(&self, joined: &Joined<'_>, row: usize) -> crane_live::LiveCrane {
        let mut crane = self.live.clone();
        let (width, parameters) = (self.parameters.width, &joined.arguments[4]);
        if !self.is_single() && width > 0 {
            let row = if parameters.len() <= width { 0 } else { row };
            // Checked when they were given.
            let _ = crane.set_parameters(&parameters[row * width..(row + 1) * width]);
        }
        crane
    }

    /// t, q, v, a; empty if not given, which means t = 0 for the time.
    fn read(&self, state: State<'_, '_>) -> PyResult<[Argument; 4]> {
        let description = self.live.description();
        let none = || Argument { shape: Vec::new(), numbers: Vec::new(), width: 0 };
        let coordinates = |name: &str, given: Given<'_, '_>| {
            given.map_or_else(|| Ok(none()), |given| Argument::coordinates(name, given, description))
        };
        Ok([
            state.t.map_or_else(|| Ok(none()), |t| Argument::scalars("t", t))?,
            coordinates("q", state.q)?,
            coordinates("v", state.v)?,
            coordinates("a", state.a)?,
        ])
    }

    /// t, q, v, a and the parameters over common leading axes.
    fn joined<'a>(&'a self, [t, q, v, a]: &'a [Argument; 4]) -> PyResult<Joined<'a>> {
        Joined::new(&[("t", t), ("q", q), ("v", v), ("a", a), ("the parameters", &self.parameters)])
    }

    /// Rows with numbers that are not finite, or with parameters that break a rule.
    fn bad_rows(&self, joined: &Joined<'_>, invalid: Invalid) -> PyResult<Vec<BadRow>> {
        let n = self.live.size();
        let coordinates = &self.live.description().coordinates;
        let mut bad: Vec<BadRow> = Vec::new();
        for (name, list, size) in [("t", 0, 1), ("q", 1, n), ("v", 2, n), ("a", 3, n)]
            .map(|(name, i, size)| (name, &joined.arguments[i], size))
        {
            if list.iter().all(|x| x.is_finite()) {
                continue;
            }
            for row in 0..joined.rows() {
                let first = if list.len() <= size { 0 } else { row * size };
                let Some(place) = list[first..first + size].iter().position(|x| !x.is_finite()) else { continue };
                let value = list[first + place];
                let of = coordinates
                    .get(place)
                    .filter(|_| name != "t")
                    .map_or(String::new(), |info| format!("[{place}] ({})", info.name));
                bad.push(BadRow { row, reason: format!("{name}{of} is {value}, not a finite number") });
            }
        }
        if !self.bad.is_empty() {
            let width = self.parameters.width;
            let parameters = &joined.arguments[4];
            let refused = |row: &usize| {
                let row = if parameters.len() <= width { 0 } else { *row };
                self.live.check(&parameters[row * width..(row + 1) * width]).err()
            };
            bad.extend((0..joined.rows()).filter_map(|row| Some(BadRow { row, reason: refused(&row)?.to_string() })));
        }
        bad.sort_by_key(|bad| bad.row);
        bad.dedup_by_key(|bad| bad.row);
        match (bad.first(), invalid) {
            (Some(first), Invalid::Raise) => {
                let hint =
                    if joined.shape.is_empty() { "" } else { "; invalid=\"nan\" makes the results of such rows NaN" };
                Err(PyValueError::new_err(format!("{}{hint}", describe(first, &joined.shape))))
            }
            _ => Ok(bad),
        }
    }
}

/// Makes the numbers of bad rows NaN.
fn forget(out: &mut [f64], bad: &[BadRow], width: usize) {
    for bad in bad {
        out[bad.row * width..(bad.row + 1) * width].fill(f64::NAN);
    }
}
