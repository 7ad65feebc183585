//! Functions of states that include those of forces: pressures, spools, bristles.

use crane_live::LiveCrane;
use crane_model::StateAt;
use crane_model::dyn_crane::Functions;
use crane_model::force_states::{self, ForceStates};
use crane_model::results::{quantities, quantities_at};
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::{StateArguments, settle};
use crate::mistakes::Invalid;
use crate::parallel::map_rows;
use crate::types::{Array, ArrayLike, Given, Numbers};

#[pymethods]
impl Crane {
    /// (..., n + states): accelerations and rates of the states of forces; `Crane.state_derivatives` separates them.
    #[pyo3(name = "_state_derivatives", signature = (q, v, x=None, t=None, *, invalid="raise"))]
    fn state_derivatives_rows<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: ArrayLike<'py>,
        x: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let width = self.live.size() + force_states::columns(self.live.description()).len();
        let (state, finite) = (StateArguments { t, ..StateArguments::moving(q, v) }, self.live.size());
        self.of_states(py, state, (x, invalid), (width, finite), |crane, state| {
            let (accelerations, rates) = force_states::accelerations(crane, state);
            [accelerations, rates].concat()
        })
    }

    /// (..., columns): the columns of a run at states, and their names; `Crane.columns_at` names them.
    #[pyo3(name = "_columns_at", signature = (q, v, x=None, t=None, *, invalid="raise"))]
    fn columns_at_rows<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: ArrayLike<'py>,
        x: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> PyResult<(Numbers<'py>, Vec<String>)> {
        let names: Vec<String> = quantities(self.live.description(), self.live.loop_joints())
            .into_iter()
            .map(|column| column.name)
            .collect();
        let state = StateArguments { t, ..StateArguments::moving(q, v) };
        let all =
            self.of_states(py, state, (x, invalid), (names.len(), 0), |crane, state| quantities_at(crane, state))?;
        Ok((all, names))
    }
}

impl Crane {
    /// States of forces; nothing if they are not given, or empty.
    pub fn read_states(&self, x: Given<'_>) -> PyResult<Argument> {
        let states = force_states::columns(self.live.description());
        let names = if states.is_empty() {
            format!("{} has no states of forces: leave x out", self.live.description().name)
        } else {
            states.join(", ")
        };
        x.map_or_else(|| Ok(Argument::none()), |x| Argument::of_width("x", &x, states.len(), &names))
    }

    /// A function of all rows, of which so many first numbers must be finite; states of forces that are not given hold the pose at rest.
    fn of_states<'py>(
        &self,
        py: Python<'py>,
        state: StateArguments<'py>,
        (x, invalid): (Given<'py>, &str),
        (width, finite): (usize, usize),
        compute: impl Fn(&LiveCrane, &StateAt<'_>) -> Vec<f64> + Sync,
    ) -> Array<'py> {
        let arguments = self.read(state)?;
        let x = self.read_states(x)?;
        let [t, q, v, a] = &arguments;
        let joined =
            Joined::new(&[("t", t), ("q", q), ("v", v), ("a", a), ("the parameters", &self.parameters), ("x", &x)])?;
        let invalid = Invalid::named(invalid)?;
        let mut bad = self.bad_rows(&joined, invalid)?;
        let n = self.live.size();
        let rows = map_rows(py, joined.rows(), |row, _| {
            if bad.iter().any(|bad| bad.row == row) {
                return vec![f64::NAN; width];
            }
            let [t, q, v, x] = [(0, 1), (1, n), (2, n), (5, x.width)].map(|(index, size)| joined.row(index, size, row));
            let (crane, t) = (self.of_joined_row(&joined, row), t.first().copied().unwrap_or(0.0));
            let holding;
            let x = if x.is_empty() {
                holding = ForceStates::new(crane.description()).holding(&crane, t, q);
                &holding
            } else {
                x
            };
            compute(&crane, &StateAt { t, q, v, x })
        })?;
        let mut out = rows.concat();
        settle(py, &mut out, &mut bad, (width, finite), &joined.shape, invalid)?;
        array(py, out, &joined.shape, &[width]).map(Numbers::from)
    }
}
