//! Single steps of cranes with their number of coordinates in the type.

use nalgebra::SVector;

use super::{
    adaptive::Formula,
    equations::Equations,
    state::{NotFinite, State},
    step::Step,
};

/// A state as a motion.
pub(super) fn motion_of<const N: usize>(state: &State<N>) -> Vec<f64> {
    [state.q.as_slice(), state.v.as_slice()].concat()
}

/// A motion as a state.
pub(super) fn state_of<const N: usize>(motion: &[f64]) -> State<N> {
    let [q, v] = [&motion[..N], &motion[N..2 * N]].map(SVector::from_column_slice);
    State { q, v }
}

/// State and estimated error after a step from `t` to `t + h`.
pub(super) fn step<const N: usize>(
    equations: &mut Equations<'_>,
    t: f64,
    h: f64,
    state: &State<N>,
    formula: &mut impl Formula,
) -> Result<(State<N>, State<N>), NotFinite> {
    if equations.states() > 0 {
        return Err(NotFinite);
    }
    let mut step = Step { t, length: h, start: motion_of(state), ..Step::new(2 * N) };
    equations.make_relative(t, &mut step.start);
    equations.references.step_within(t, t + h);
    equations.slope(t, &step.start, &mut step.slopes[0])?;
    formula.attempt(equations, &mut step)?;
    equations.make_absolute(t + h, &mut step.end);
    Ok((state_of(&step.end), state_of(&step.error)))
}
