//! Central differences for a crane with loops that moves: of its directions and of its accelerations.

use nalgebra::{DMatrix, DVector};

use super::Directions;
use crate::{
    StateAt, dyn_crane::DynCrane, dynamics::InitialState, force_states::motion_at, modes::independent_motions,
};

/// Step along a coordinate or its rate, m, rad, m/s or rad/s: rounding and curvature are then some 1e-8 of an entry.
pub(super) const STEP: f64 = 1e-6;

/// How all coordinates and rates change with independent ones, `Q = Z` and `R_j = ∂Z/∂z_j ż`.
pub(super) fn directions(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    free: &[usize],
    basis: &DMatrix<f64>,
) -> Directions {
    let rates = DVector::from_iterator(free.len(), free.iter().map(|&j| moment.v[j]));
    let mut change = DMatrix::zeros(basis.nrows(), basis.ncols());
    for column in 0..basis.ncols() {
        let [before, after] = [-STEP, STEP].map(|step| {
            let moved = moved(moment.q, basis.column(column).as_slice(), step);
            let (own, basis) = independent_motions(crane, &moved);
            if own == free { basis * &rates } else { DVector::from_element(moved.len(), f64::NAN) }
        });
        change.set_column(column, &((after - before) / (2.0 * STEP)));
    }
    Directions { q: basis.clone(), rates: change }
}

/// A by differences of the accelerations with loops closed.
pub(super) fn state_matrix(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    free: &[usize],
    directions: &Directions,
    scales: &[f64],
) -> DMatrix<f64> {
    let (n, m) = (free.len(), scales.len());
    let mut matrix = DMatrix::zeros(2 * n + m, 2 * n + m);
    matrix.view_mut((0, n), (n, n)).fill_with_identity();
    for column in 0..2 * n + m {
        let mut steps = 0.0;
        let [before, after] = [-1.0, 1.0].map(|sign| {
            let state = NearbyState::moved(moment, directions, column, scales, sign);
            steps += sign * state.step;
            let motion = motion_at(crane, &state.at(moment.t));
            let free = free.iter().map(|&j| motion.accelerations[j]);
            DVector::from_iterator(n + m, free.chain(motion.rates))
        });
        matrix.view_mut((n, column), (n + m, 1)).copy_from(&((after - before) / steps));
    }
    matrix
}

/// A state near another one.
pub(super) struct NearbyState {
    state: InitialState,
    /// How far, in the unit of the state that changed.
    pub step: f64,
}

impl NearbyState {
    /// One of the states moved by a step in the direction of `sign`.
    pub fn moved(moment: &StateAt<'_>, directions: &Directions, index: usize, scales: &[f64], sign: f64) -> Self {
        let n = directions.q.ncols();
        let mut step = sign * STEP;
        let mut state = InitialState::from(*moment);
        let column = |matrix: &DMatrix<f64>, of: usize| matrix.column(of).iter().copied().collect::<Vec<f64>>();
        if index < n {
            state.q = moved(moment.q, &column(&directions.q, index), step);
            state.v = moved(moment.v, &column(&directions.rates, index), step);
        } else if index < 2 * n {
            state.v = moved(moment.v, &column(&directions.q, index - n), step);
        } else {
            step *= scales[index - 2 * n];
            state.x[index - 2 * n] += step;
        }
        Self { state, step }
    }

    pub fn at(&self, t: f64) -> StateAt<'_> {
        self.state.at_time(t)
    }
}

fn moved(from: &[f64], along: &[f64], step: f64) -> Vec<f64> {
    from.iter().zip(along).map(|(from, along)| from + step * along).collect()
}
