//! Whether a state at rest is an equilibrium: oil that leaks past pistons moves a crane whose valves are shut.
//!
//! The rates ẋ of pressures move the pose as fast as the forces stay in balance. With the blocks of A for the accelerations by coordinates,
//! `A_q`, and by states of forces, `A_x`, and for the rates of these states by coordinates, rates and states, `X_q`, `X_v`, `X_x`:
//!
//! ```text
//! (A_q + A_x X_v) q̇ = −A_x ẋ,     (A_q + A_x X_v) q̈ = −A_x (X_q q̇ + X_x (ẋ + X_v q̇))
//! ```
//!
//! A disturbance of a state that moves changes how it moves. What thereby grows at the rate of the leak is a part of the drift and no instability, so
//! a verdict about such a state is that about the crane without leakage.

use nalgebra::{DMatrix, DVector};

use crate::{least_squares::LeastSquares, modes::StateSpace};

/// A drift up to this, m/s or rad/s, is rounding or takes longer than any manoeuvre: 0.1 mm in three hours.
const STILL: f64 = 1e-8;
/// Size of a pivot of the stiffness, rows and columns of one size, up to which nothing holds a coordinate.
const FREE: f64 = 1e-9;

/// How a pose at rest moves that is not an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Rates of the coordinates in the state, m/s and rad/s.
    pub rates: Vec<f64>,
    /// Index in them of the fastest.
    pub fastest: usize,
    /// Rate at which its rate decays, 1/s; negative if it speeds up.
    pub decay: f64,
}

impl Drift {
    /// Of a state space at rest with these rates of the states of forces; `None` for an equilibrium.
    pub(super) fn new(space: &StateSpace, rates: &[f64]) -> Option<Self> {
        let (n, m) = (space.unknowns().len(), rates.len());
        if n == 0 || m == 0 {
            return None;
        }
        let block =
            |row: usize, column: usize, size: (usize, usize)| space.matrix.view((row, column), size).into_owned();
        let (by_q, by_x) = (block(n, 0, (n, n)), block(n, 2 * n, (n, m)));
        let [x_by_q, x_by_v] = [0, n].map(|column| block(2 * n, column, (m, n)));
        let x_by_x = block(2 * n, 2 * n, (m, m));
        let stiffness = Scaled::new(&by_q + &by_x * &x_by_v);
        let states = DVector::from_column_slice(rates);
        let found = stiffness.solve(&-(&by_x * &states))?;
        let change = x_by_q * &found + x_by_x * (states + &x_by_v * &found);
        let faster = stiffness.solve(&-(by_x * change))?;
        let fastest = found.iamax();
        let decay = -faster[fastest] / found[fastest];
        (found[fastest].abs() > STILL).then(|| Self { rates: found.as_slice().to_vec(), fastest, decay })
    }
}

/// Linear equations with rows and columns of one size, whatever their units; what nothing holds stays where it is.
struct Scaled {
    rows: DVector<f64>,
    columns: DVector<f64>,
    equations: LeastSquares,
}

impl Scaled {
    fn new(mut matrix: DMatrix<f64>) -> Self {
        let inverse = |size: f64| if size > 0.0 { size.recip() } else { 1.0 };
        let columns = DVector::from_fn(matrix.ncols(), |j, _| inverse(matrix.column(j).amax()));
        for (mut column, factor) in matrix.column_iter_mut().zip(&columns) {
            column *= *factor;
        }
        let rows = DVector::from_fn(matrix.nrows(), |i, _| inverse(matrix.row(i).amax()));
        for (mut row, factor) in matrix.row_iter_mut().zip(&rows) {
            row *= *factor;
        }
        Self { rows, columns, equations: LeastSquares::new(matrix, FREE) }
    }

    fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        Some(self.equations.solve(&right.component_mul(&self.rows))?.component_mul(&self.columns))
    }
}
