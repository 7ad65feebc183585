//! Functions of a state: arrays in, arrays out.

use crane_live::FunctionId;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_quantities::{axes, quantities};
use pyo3::prelude::*;

use crate::crane::Crane;
use crate::evaluation::{Moment, StateArguments};
use crate::types::{Array, ArrayLike, Given};

/// The methods of the table of quantities, with its documentation.
macro_rules! methods {
    ($($trait:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(method! {
            $(($($python)*))? $id $name
            [#[doc = concat!("(...", axes!($result), "): ", $doc)] $(#[doc = $remark])*]
        })*)*
    };
}

/// A method, if the row has one.
macro_rules! method {
    ($id:ident $name:ident $about:tt) => {};
    (($($required:ident),* $(; $optional:ident)?) $id:ident $name:ident [$($about:tt)*]) => {
        #[pymethods]
        impl Crane {
            $($about)*
            $(#[doc = concat!(stringify!($optional), ": s, 0 unless given.")])?
            #[pyo3(signature = ($($required,)* $($optional=None,)? *, invalid="raise"))]
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($required: ArrayLike<'py>,)*
                $($optional: Given<'py>,)?
                invalid: &str,
            ) -> Array<'py> {
                #[allow(clippy::needless_update, reason = "a row with all arguments leaves none to the default")]
                let state = StateArguments { $($required: Some($required),)* $($optional,)? ..StateArguments::default() };
                self.function(py, FunctionId::$id, state, invalid)
            }
        }
    };
}

quantities! { methods }

/// Methods of the table of quantities: name, arguments, and axes of the result of one state.
#[pyfunction]
pub fn functions() -> Vec<(&'static str, Vec<&'static str>, Vec<String>)> {
    let of_row = |id: &FunctionId| {
        let python = id.python()?;
        Some((id.name(), python.names().collect(), id.axes().split(", ").skip(1).map(str::to_owned).collect()))
    };
    FunctionId::ALL.iter().filter_map(of_row).collect()
}

#[pymethods]
impl Crane {
    /// (..., bodies, n, n, 4, 4): `∂²T/∂q_m∂q_n`.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transform_second_derivatives<'py>(&self, py: Python<'py>, q: ArrayLike<'py>, invalid: &str) -> Array<'py> {
        let (bodies, n) = (self.live.description().bodies.len(), self.live.size());
        let state = StateArguments::pose(q);
        self.one_by_one(py, state, (&[bodies, n, n, 4, 4], 0), invalid, |crane, Moment { q, .. }, out| {
            let crane: &dyn DynCrane = crane;
            let mut matrices = crane.transform_second_derivatives_at(q).into_iter();
            let tree = (crane as &dyn DynCrane).tree();
            for (body, of_body) in out.chunks_mut(16 * n * n).enumerate() {
                let moving = tree.coordinates(body);
                for (index, &m) in moving.iter().enumerate() {
                    for &k in &moving[index..] {
                        let rows = matrices.next().unwrap_or_default().transpose();
                        for index in [m * n + k, k * n + m] {
                            of_body[16 * index..16 * (index + 1)].copy_from_slice(rows.as_slice());
                        }
                    }
                }
            }
        })
    }

    /// (..., 3, n, n): derivatives ∂q̈/∂q, ∂q̈/∂v and ∂q̈/∂τ = A⁻¹ of the accelerations of `forward_dynamics`, τ generalized forces; row i and
    /// column j of each: the change of `q̈_i` with `q_j`, with `q̇_j` and with `τ_j`. For coordinates that rigid drives prescribe the rows are zero, and so
    /// are their columns of A⁻¹.
    /// t: s, 0 unless given.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn forward_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: ArrayLike<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.compute(
            py,
            FunctionId::ForwardDynamicsDerivatives,
            StateArguments { t, ..StateArguments::moving(q, v) },
            invalid,
        )
    }

    /// (..., 3, n, n): A, K and D of small motions about poses at rest; `linearise` names them.
    #[pyo3(name = "_small_motions", signature = (q, *, invalid="raise"))]
    fn small_motions<'py>(&self, py: Python<'py>, q: ArrayLike<'py>, invalid: &str) -> Array<'py> {
        self.compute(py, FunctionId::Linearise, StateArguments::pose(q), invalid)
    }
}

impl Crane {
    /// A function of all rows. Accelerations are those with closed loops, as far as they follow from the state.
    fn function<'py>(&self, py: Python<'py>, id: FunctionId, state: StateArguments<'py>, invalid: &str) -> Array<'py> {
        let has_loops = !self.live.loop_joints().is_empty() && !self.live.description().has_hidden_forces();
        if id == FunctionId::ForwardDynamics && has_loops {
            let n = self.live.size();
            return self.one_by_one(py, state, (&[n], n), invalid, |crane, at, out| {
                let crane: &dyn DynCrane = crane;
                out.copy_from_slice(crane.accelerations_at(at.t, &at.q, &at.v).as_slice());
            });
        }
        self.compute(py, id, state, invalid)
    }
}
