//! How the pose at rest and the forces of loop joints move with the live parameters.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::DynCrane;
use crane_model::loop_joints;
use crane_model::nalgebra::{DMatrix, DVector, Dyn, LU};

use super::source::Source;
use crate::dual::{DIRECTIONS, Dual8};
use crate::machine::Number;

/// Steps that bring the pose of statics to rounding: each gains ten digits.
const STEPS: usize = 2;
/// A larger step, m or rad, is not one from the tolerance of statics to rounding: the pose of statics is kept.
const SMALL: f64 = 1e-4;

/// A crane at rest.
pub(super) struct Rest {
    /// The pose, m and rad.
    pub q: Vec<f64>,
    /// What the equations of loop joints transmit, N and N m.
    pub multipliers: Vec<f64>,
    /// Coordinates that rigid drives prescribe, with the index of the drive.
    pub prescribed: Vec<(usize, usize)>,
    /// Coordinates that are free.
    unknowns: Vec<usize>,
    /// Equations of loop joints that are independent.
    independent: Vec<usize>,
    system: RestSystem,
}

impl Rest {
    /// From the pose that statics found; `None` if its system is singular.
    pub fn new(source: &mut Source<'_>, q: Vec<f64>) -> Option<Self> {
        let crane: &dyn DynCrane = source.crane;
        let description = crane.description();
        let fixed = description.prescribed();
        let drives = description.drives.iter().enumerate().map(|(index, drive)| (drive.coordinate, index));
        let mut rest = Self {
            multipliers: crane.loop_forces_at_rest(&q),
            prescribed: drives.filter(|(coordinate, _)| fixed.contains(coordinate)).collect(),
            unknowns: (0..q.len()).filter(|coordinate| !fixed.contains(coordinate)).collect(),
            independent: loop_joints::independent(crane, &q),
            system: RestSystem::empty(),
            q,
        };
        rest.system = RestSystem::new(rest.matrix(source), rest.unknowns.len())?;
        for _ in 0..STEPS {
            let (q, multipliers) = (constants(&rest.q), constants(&rest.multipliers));
            let missing = rest.missing(source, &q, &multipliers);
            let step = rest.system.solve(&-column(&missing, Dual8::value));
            if !step.iter().all(|entry| entry.is_finite()) || rest.system.size(&step) > SMALL {
                break;
            }
            rest.add(step.as_slice());
        }
        rest.system = RestSystem::new(rest.matrix(source), rest.unknowns.len())?;
        Some(rest)
    }

    /// F of the free coordinates and φ of the independent equations, zero at rest.
    fn missing(&self, source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Dual8> {
        let resisted = source.generalized(q, multipliers);
        let residual = source.at(FunctionId::StaticResidual, q);
        let gaps = if multipliers.is_empty() { Vec::new() } else { source.at(FunctionId::LoopStates, q) };
        let forces = self.unknowns.iter().map(|&i| residual[i] + resisted[i]);
        forces.chain(self.independent.iter().map(|&equation| gaps[3 * equation])).collect()
    }

    /// The derivative of [`missing`](Self::missing) by the free coordinates and by λ.
    fn matrix(&self, source: &mut Source<'_>) -> DMatrix<f64> {
        let (n, free) = (self.q.len(), self.unknowns.len());
        let size = free + self.independent.len();
        let multipliers = constants(&self.multipliers);
        let mut matrix = DMatrix::zeros(size, size);
        for (batch, some) in self.unknowns.chunks(DIRECTIONS).enumerate() {
            let along = |(i, value): (usize, &f64)| Dual8::along(*value, some.iter().position(|own| *own == i));
            let q: Vec<Dual8> = self.q.iter().enumerate().map(along).collect();
            let missing = self.missing(source, &q, &multipliers);
            for direction in 0..some.len() {
                let slopes = column(&missing, |number| number.slope(direction));
                matrix.set_column(DIRECTIONS * batch + direction, &slopes);
            }
        }
        if !self.independent.is_empty() {
            let rows = source.at(FunctionId::LoopJacobians, &constants(&self.q));
            for (index, equation) in self.independent.iter().enumerate() {
                for (row, coordinate) in self.unknowns.iter().enumerate() {
                    matrix[(row, free + index)] = rows[equation * n + coordinate].value();
                }
            }
        }
        matrix
    }

    /// Adds a step to the pose and to λ.
    fn add(&mut self, step: &[f64]) {
        let (of_pose, of_multipliers) = step.split_at(self.unknowns.len());
        self.unknowns.iter().zip(of_pose).for_each(|(i, step)| self.q[*i] += step);
        self.independent.iter().zip(of_multipliers).for_each(|(i, step)| self.multipliers[*i] += step);
    }

    /// The pose and λ with their slopes, for the slopes of the parameters.
    pub fn moved(&self, source: &mut Source<'_>) -> (Vec<Dual8>, Vec<Dual8>) {
        let (mut q, mut multipliers) = (constants(&self.q), constants(&self.multipliers));
        let motions = source.at(FunctionId::DriveMotions, &q);
        for &(coordinate, drive) in &self.prescribed {
            let position = motions[2 * drive];
            q[coordinate] = Dual8::new(self.q[coordinate], std::array::from_fn(|k| position.slope(k)));
        }
        let missing = self.missing(source, &q, &multipliers);
        let steps: [DVector<f64>; DIRECTIONS] =
            std::array::from_fn(|direction| self.system.solve(&-column(&missing, |number| number.slope(direction))));
        let slopes = |row: usize| std::array::from_fn(|direction| steps[direction][row]);
        for (row, &i) in self.unknowns.iter().enumerate() {
            q[i] = Dual8::new(self.q[i], slopes(row));
        }
        for (row, &i) in self.independent.iter().enumerate() {
            multipliers[i] = Dual8::new(self.multipliers[i], slopes(self.unknowns.len() + row));
        }
        (q, multipliers)
    }

    /// `Jᵀ μ = r` in the free coordinates, for μ of the independent equations; r over all coordinates.
    pub fn balanced(&self, source: &mut Source<'_>, r: &[f64]) -> Vec<f64> {
        let mut multipliers = vec![0.0; self.multipliers.len()];
        if self.independent.is_empty() {
            return multipliers;
        }
        let rows = source.at(FunctionId::LoopJacobians, &constants(&self.q));
        let n = self.q.len();
        let matrix = DMatrix::from_fn(self.unknowns.len(), self.independent.len(), |i, k| {
            rows[self.independent[k] * n + self.unknowns[i]].value()
        });
        let right = DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(|i| r[*i]));
        let (basis, triangle) = matrix.qr().unpack();
        if let Some(found) = triangle.solve_upper_triangular(&basis.tr_mul(&right)) {
            self.independent.iter().zip(found.iter()).for_each(|(equation, own)| multipliers[*equation] = *own);
        }
        multipliers
    }
}

/// Numbers without slopes.
pub(super) fn constants(numbers: &[f64]) -> Vec<Dual8> {
    numbers.iter().map(|number| Dual8::splat(*number)).collect()
}

/// A part of every number.
fn column(numbers: &[Dual8], part: impl Fn(&Dual8) -> f64) -> DVector<f64> {
    DVector::from_iterator(numbers.len(), numbers.iter().map(part))
}

/// A linear system in scaled unknowns, `S M S y = S b`, `x = S y`: m, rad, N and N m become comparable.
struct RestSystem {
    matrix: DMatrix<f64>,
    scale: DVector<f64>,
    factors: LU<f64, Dyn, Dyn>,
    /// Number of coordinates among the unknowns.
    free: usize,
}

impl RestSystem {
    fn empty() -> Self {
        let matrix = DMatrix::zeros(0, 0);
        Self { factors: matrix.clone().lu(), matrix, scale: DVector::zeros(0), free: 0 }
    }

    /// Factorises a matrix; `None` if it is singular or not finite. The first `free` unknowns are coordinates.
    fn new(matrix: DMatrix<f64>, free: usize) -> Option<Self> {
        let size = matrix.nrows();
        let mut scale = DVector::repeat(size, 1.0);
        for i in 0..free {
            let own = matrix[(i, i)].abs();
            scale[i] = if own > 0.0 { own.sqrt().recip() } else { 1.0 };
        }
        for i in free..size {
            let own = (0..free).map(|j| (matrix[(i, j)] * scale[j]).abs()).fold(0.0, f64::max);
            scale[i] = if own > 0.0 { own.recip() } else { 1.0 };
        }
        let scaled = DMatrix::from_fn(size, size, |i, j| matrix[(i, j)] * scale[i] * scale[j]);
        let factors = scaled.iter().all(|entry| entry.is_finite()).then(|| scaled.lu())?;
        (size == 0 || factors.is_invertible()).then_some(Self { matrix, scale, factors, free })
    }

    /// The solution, refined once.
    fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let once = |right: &DVector<f64>| {
            let mut x = right.component_mul(&self.scale);
            self.factors.solve_mut(&mut x);
            x.component_mul(&self.scale)
        };
        let first = once(right);
        let rest = right - &self.matrix * &first;
        first + once(&rest)
    }

    /// The largest change of a coordinate, m or rad.
    fn size(&self, step: &DVector<f64>) -> f64 {
        step.iter().take(self.free).fold(0.0, |size: f64, entry| size.max(entry.abs()))
    }
}
