//! Linear models about a state, of every crane, with inputs and outputs by their names.
//!
//! ```text
//! d/dt δx = A δx + B δu,     δy = C δx + D δu
//! ```
//!
//! The state x has the coordinates that can move, their rates, and the states of forces: pressures, spools and bristles. Coordinates that
//! rigid drives prescribe are not part of it. A crane with loops is described in independent coordinates, as many as it has degrees of
//! freedom: with all of them the model would contain motions that the loops do not permit, which no input reaches and which are not damped.
//!
//! A and what efforts contribute to B are exact derivatives, except those of a crane with loops that moves. Inputs of the spec enter by
//! central differences, exact to rounding where accelerations are linear in them, as they are in efforts, motions and loads. Outputs are
//! exact for coordinates, rates and points, others are central differences, to some 1e-7 of an entry.

mod differences;
mod drift;
mod inputs;
mod outputs;

pub use drift::Drift;
pub use inputs::Input;
pub use outputs::{Output, outputs};

use std::{error::Error, fmt};

use crane_quantities::ColumnKind;
use nalgebra::{Complex, DMatrix, DVector};

use crate::{
    StateAt,
    column::columns_of,
    dyn_crane::DynCrane,
    force_states::{self, ForceStates, states_of_small_motions},
    modes::{DampedMode, NoModes, SmallMotions, StateSpace, eigenvalues, grows},
    results::{Column, quantities},
};

/// Accelerations up to this, m/s² and rad/s², are those of a crane at rest.
const REST: f64 = 1e-4;

/// The state about which a crane is linearised.
#[derive(Clone, Copy, Debug)]
pub struct About<'a> {
    /// Time of drives, loads and winches, s.
    pub t: f64,
    /// Coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// States of forces.
    pub x: Forces<'a>,
    /// Whether the motion is steady, whatever holds it: accelerations are zero instead of those that follow from the state.
    pub steady: bool,
}

/// States of forces about which a crane is linearised.
#[derive(Clone, Copy, Debug)]
pub enum Forces<'a> {
    /// These, in the order of [`force_states::columns`]; those of feet, which stick in small motions, or are free if they slide, may be left out.
    Given(&'a [f64]),
    /// Those that hold the pose at rest: shut valves, bristles that carry nothing.
    Holding,
    /// Those with valves that have opened slightly, with the mean of the slopes in both directions, as an oscillation about a shut valve meets them:
    /// those with a servo, and those that are commanded.
    SlightlyOpen,
}

/// A linear model.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearModel {
    /// A: states by states.
    pub a: DMatrix<f64>,
    /// B: states by inputs.
    pub b: DMatrix<f64>,
    /// C: outputs by states.
    pub c: DMatrix<f64>,
    /// D: outputs by inputs.
    pub d: DMatrix<f64>,
    /// Names and units of the states.
    pub states: Vec<Column>,
    /// Names and units of the inputs.
    pub inputs: Vec<Column>,
    /// Names and units of the outputs.
    pub outputs: Vec<Column>,
    /// How the state moves if it is at rest and no equilibrium: shut valves, whose cylinders leak.
    pub drift: Option<Drift>,
    space: StateSpace,
    /// A without leakage, if the state drifts.
    sealed: Option<DMatrix<f64>>,
}

/// Why there is no linear model.
#[derive(Clone, Debug, PartialEq)]
pub enum NoModel {
    /// There are no small motions.
    Modes(NoModes),
    /// An input cannot act: which, why, and what to do.
    Input(String, &'static str, &'static str),
    /// An output depends on accelerations, which this input changes.
    Output(String, String),
    /// The numbers of states of forces that are given and needed.
    States(usize, usize),
}

impl fmt::Display for NoModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoModel::Modes(none) => none.fmt(f),
            NoModel::Input(name, why, help) => write!(f, "the input `{name}` {why}: {help}"),
            NoModel::Output(output, input) => {
                write!(f, "`{output}` follows from accelerations, at once with `{input}`: leave out one of them")
            }
            NoModel::States(given, needed) => {
                write!(f, "{given} states of forces are given, and the crane has {needed}")
            }
        }
    }
}

impl Error for NoModel {}

impl From<NoModes> for NoModel {
    fn from(none: NoModes) -> Self {
        NoModel::Modes(none)
    }
}

/// The linear model of a crane about a state.
///
/// # Errors
/// The mass matrix is not positive definite, or an input or output is not possible.
///
/// # Panics
/// If `q` or `v` does not have as many numbers as the crane has coordinates.
pub fn linear_model(
    crane: &dyn DynCrane,
    about: &About<'_>,
    inputs: &[Input],
    outputs: &[Output],
) -> Result<LinearModel, NoModel> {
    let description = crane.description();
    let mut forces = ForceStates::of_small_motions(description);
    let About { t, q, v, .. } = *about;
    let at = |x: &[f64]| part(crane, &StateAt { t, q, v, x }, about.steady, inputs, outputs);
    match about.x {
        Forces::Given(x) if x.len() == forces.len() => at(x),
        Forces::Given(x) if x.len() == ForceStates::new(description).len() => {
            at(&states_of_small_motions(description, x))
        }
        Forces::Given(x) => Err(NoModel::States(x.len(), forces.len())),
        Forces::Holding => at(&forces.holding(crane, t, q)),
        Forces::SlightlyOpen => {
            let [one, other] = forces.slightly_open(crane, t, q);
            let model = at(&one)?;
            if one == other { Ok(model) } else { Ok(model.mean(&at(&other)?)) }
        }
    }
}

impl LinearModel {
    /// Indices in q of the coordinates in the state.
    pub fn coordinates(&self) -> &[usize] {
        self.space.unknowns()
    }

    /// A, D and K of `A δq̈ + D δq̇ + K δq = 0`, from which the model of an open chain without states of forces is made.
    pub fn small_motions(&self) -> &SmallMotions {
        self.space.small_motions()
    }

    /// The eigenvalues with Im λ ≥ 0 and the dominant coordinates of their motions, lowest frequency first.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn modes(&self) -> Result<Vec<DampedMode>, NoModes> {
        self.space.modes()
    }

    /// The motion that grows fastest, if any does: its eigenvalue, 1/s. What only grows with a drift does not count.
    ///
    /// # Errors
    /// The QR algorithm does not converge.
    pub fn growing(&self) -> Result<Option<Complex<f64>>, NoModes> {
        let found = eigenvalues(self.sealed.as_ref().unwrap_or(&self.a).clone())?;
        Ok(found.into_iter().filter(|value| grows(*value)).max_by(|a, b| a.re.total_cmp(&b.re)))
    }

    fn mean(mut self, other: &Self) -> Self {
        let mean = |one: DMatrix<f64>, other: &DMatrix<f64>| (one + other) * 0.5;
        self.space.matrix = mean(self.space.matrix, &other.space.matrix);
        self.sealed = self.sealed.zip(other.sealed.as_ref()).map(|(one, other)| mean(one, other));
        Self {
            a: mean(self.a, &other.a),
            b: mean(self.b, &other.b),
            c: mean(self.c, &other.c),
            d: mean(self.d, &other.d),
            ..self
        }
    }
}

/// Changes of all coordinates and rates with the coordinates in the state: δq = Q δz, δq̇ = Q δż + R δz.
pub(super) struct Directions {
    pub q: DMatrix<f64>,
    pub rates: DMatrix<f64>,
}

/// A linear model at given states of forces.
fn part(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    steady: bool,
    inputs: &[Input],
    outputs: &[Output],
) -> Result<LinearModel, NoModel> {
    let mut forces = ForceStates::of_small_motions(crane.description());
    let a = if steady { vec![0.0; moment.q.len()] } else { force_states::motion_at(crane, moment).accelerations };
    let rests = moment.v.iter().all(|v| *v == 0.0) && a.iter().all(|a| a.abs() < REST);
    let mut space = StateSpace::about(crane, moment, &a, &mut forces)?;
    let (size, n, m) = (moment.q.len(), space.unknowns().len(), forces.len());
    let directions = match space.basis() {
        Some(basis) if !rests => differences::directions(crane, moment, space.unknowns(), basis),
        Some(basis) => Directions { q: basis.clone(), rates: DMatrix::zeros(size, n) },
        None => Directions {
            q: DMatrix::from_fn(size, n, |j, column| f64::from(u8::from(space.unknowns()[column] == j))),
            rates: DMatrix::zeros(size, n),
        },
    };
    if space.basis().is_some() && !rests {
        space.matrix = differences::state_matrix(crane, moment, space.unknowns(), &directions, &forces.scales());
    }
    let drift = if rests { drift_of(crane, moment, &space, &mut forces) } else { None };
    let sealed = match &drift {
        Some(_) => Some(StateSpace::about(crane, moment, &a, &mut ForceStates::sealed(crane.description()))?.matrix),
        None => None,
    };
    let mut model = LinearModel {
        a: space.matrix.clone(),
        b: DMatrix::zeros(2 * n + m, inputs.len()),
        c: outputs::rows(crane, moment, outputs, &directions, &forces.scales()),
        d: DMatrix::zeros(outputs.len(), inputs.len()),
        states: states(crane, &space),
        inputs: inputs.iter().map(|input| input.column(crane.description())).collect(),
        outputs: outputs.iter().map(|output| output.column.clone()).collect(),
        drift,
        space: space.clone(),
        sealed,
    };
    for (index, input) in inputs.iter().enumerate() {
        let effect = inputs::effect(crane, moment, *input, &space, outputs)?;
        model.b.set_column(index, &effect.states);
        model.d.set_column(index, &DVector::from_vec(effect.outputs));
    }
    Ok(model)
}

/// How a state at rest moves if its valves are shut.
fn drift_of(crane: &dyn DynCrane, moment: &StateAt<'_>, space: &StateSpace, forces: &mut ForceStates) -> Option<Drift> {
    if !crane.description().has_valves() {
        return None;
    }
    let mut rates = vec![0.0; forces.len()];
    forces.evaluate(crane, moment, &mut rates, None);
    Drift::new(space, &rates)
}

/// Names and units of the states.
fn states(crane: &dyn DynCrane, space: &StateSpace) -> Vec<Column> {
    let description = crane.description();
    let of_coordinates = |kind: ColumnKind| {
        let coordinates = space.unknowns().iter().map(|&index| &description.coordinates[index]);
        coordinates.flat_map(move |info| columns_of(kind, &info.name, info.kind.turns()))
    };
    let all = quantities(description, crane.loop_joints());
    let of_forces = force_states::columns_of_small_motions(description).into_iter().map(|name| {
        let unit =
            all.iter().find(|column| column.name == name).map_or_else(|| "1".to_owned(), |found| found.unit.clone());
        Column::new(name, unit)
    });
    of_coordinates(ColumnKind::Position).chain(of_coordinates(ColumnKind::Rate)).chain(of_forces).collect()
}
