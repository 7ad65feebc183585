//! Outputs of linear models: every column of a run.

use nalgebra::DMatrix;

use super::{Directions, differences::NearbyState};
use crate::{
    StateAt,
    dyn_crane::DynCrane,
    results::{Column, quantities, quantities_with},
};

/// A quantity of a run, except time.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its index among the quantities of a run.
    pub index: usize,
    /// Its name and unit.
    pub column: Column,
}

/// All possible outputs of a crane: the columns of a run, except time and the audit of energies.
pub fn outputs(crane: &dyn DynCrane) -> Vec<Output> {
    let all = quantities(crane.description(), crane.loop_joints()).into_iter().enumerate();
    all.skip(1).map(|(index, column)| Output { index, column }).collect()
}

/// The kinds of outputs whose derivatives are known.
enum Known {
    Coordinate(usize),
    Rate(usize),
    /// Row of the Jacobians of the points.
    Point(usize),
}

fn known(crane: &dyn DynCrane, output: &Output) -> Option<Known> {
    let (description, n, index) = (crane.description(), crane.size(), output.index - 1);
    if index < n {
        return Some(Known::Coordinate(index));
    }
    if index < 2 * n {
        return Some(Known::Rate(index - n));
    }
    let (point, axis) = output.column.name.rsplit_once('_')?;
    let axis = ["x", "y", "z"].iter().position(|known| *known == axis)?;
    let point = description.points.iter().position(|name| name.as_str() == point)?;
    Some(Known::Point(3 * point + axis))
}

/// C: outputs by states.
pub(super) fn rows(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    outputs: &[Output],
    directions: &Directions,
    scales: &[f64],
) -> DMatrix<f64> {
    let (n, m) = (directions.q.ncols(), scales.len());
    let mut matrix = DMatrix::zeros(outputs.len(), 2 * n + m);
    let size = crane.size();
    let mut jacobians = vec![0.0; 3 * crane.description().points.len() * size];
    crane.point_jacobians(moment.q, &mut jacobians);
    let mut unknown = Vec::new();
    for (row, output) in outputs.iter().enumerate() {
        match known(crane, output) {
            Some(Known::Coordinate(j)) => matrix.view_mut((row, 0), (1, n)).copy_from(&directions.q.row(j)),
            Some(Known::Rate(j)) => {
                matrix.view_mut((row, 0), (1, n)).copy_from(&directions.rates.row(j));
                matrix.view_mut((row, n), (1, n)).copy_from(&directions.q.row(j));
            }
            Some(Known::Point(of)) => {
                let jacobian = DMatrix::from_row_slice(1, size, &jacobians[of * size..][..size]);
                matrix.view_mut((row, 0), (1, n)).copy_from(&(jacobian * &directions.q));
            }
            None => unknown.push(row),
        }
    }
    if unknown.is_empty() {
        return matrix;
    }
    for column in 0..2 * n + m {
        let mut steps = 0.0;
        let [before, after] = [-1.0, 1.0].map(|sign| {
            let state = NearbyState::moved(moment, directions, column, scales, sign);
            steps += sign * state.step;
            quantities_with(crane, &state.at(moment.t), &[])
        });
        for &row in &unknown {
            let index = outputs[row].index;
            matrix[(row, column)] = (after[index] - before[index]) / steps;
        }
    }
    matrix
}
