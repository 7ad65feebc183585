//! Coefficients of small motions, of any number of coordinates.

use nalgebra::{Cholesky, ComplexField, DMatrix, DVector, DVectorView, Dyn};

use super::NoModes;
use crate::{
    CoordinateRole, Linearisation,
    dyn_crane::DynCrane,
    loop_joints::{closed_motions, geometric_stiffness, required},
};

/// A coordinate is dominant in a mode if its share of the energy is at least this fraction of the largest one.
const SHARE: f64 = 0.2;
/// How good it is that a loop determines a coordinate with a drive or a spring, relative to one without.
const DRIVEN: f64 = 1e-3;

/// Coefficients of `A δq̈ + D δq̇ + K δq = 0`, of the coordinates that can move. About a pose at rest K and D are symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct SmallMotions {
    /// Mass matrix A.
    pub mass: DMatrix<f64>,
    /// Tangent stiffness K, which includes centrifugal terms about a motion.
    pub stiffness: DMatrix<f64>,
    /// Damping matrix D, which includes gyroscopic terms about a motion.
    pub damping: DMatrix<f64>,
    /// Indices in q of the rows and columns: all except those that rigid drives prescribe.
    pub unknowns: Vec<usize>,
    /// Number of coordinates.
    pub size: usize,
    /// With loops: the motion of all coordinates per unit of each unknown; without, only the unknowns move.
    pub basis: Option<DMatrix<f64>>,
}

/// For all coordinates; a prescribed one oscillates separately at 1 rad/s, unless removed by [`without`](SmallMotions::without).
impl<const N: usize> From<&Linearisation<N>> for SmallMotions {
    fn from(linearisation: &Linearisation<N>) -> Self {
        let Linearisation { mass, stiffness, damping } = linearisation;
        let dynamic = |matrix: &nalgebra::SMatrix<f64, N, N>| DMatrix::from_column_slice(N, N, matrix.as_slice());
        let (mass, stiffness, damping) = (dynamic(mass), dynamic(stiffness), dynamic(damping));
        Self { mass, stiffness, damping, unknowns: (0..N).collect(), size: N, basis: None }
    }
}

impl SmallMotions {
    /// About the pose `q` of a crane of any size.
    pub fn about_pose(crane: &dyn DynCrane, q: &[f64]) -> Self {
        let n = q.len();
        let mut numbers = vec![0.0; 3 * n * n];
        crane.linearise(q, &mut numbers);
        let [mass, stiffness, damping] =
            [0, 1, 2].map(|index| DMatrix::from_column_slice(n, n, &numbers[index * n * n..(index + 1) * n * n]));
        let all = Self { mass, stiffness, damping, unknowns: (0..q.len()).collect(), size: q.len(), basis: None };
        all.without(&crane.description().prescribed())
    }

    /// About a motion of a crane of any size: pose, rates and accelerations at time t.
    pub fn about_motion(crane: &dyn DynCrane, t: f64, motion: [&[f64]; 3]) -> Self {
        let size = crane.size();
        let [mass, stiffness, damping] = crane.linearise_motion(t, motion);
        let all = Self { mass, stiffness, damping, unknowns: (0..size).collect(), size, basis: None };
        all.without(&crane.description().prescribed())
    }

    /// The skew part of D, `(D − Dᵀ)/2`: gyroscopic forces, which do no work.
    pub fn gyroscopic(&self) -> DMatrix<f64> {
        skew(&self.damping)
    }

    /// The skew part of K, `(K − Kᵀ)/2`: circulatory forces, which have no potential.
    pub fn circulatory(&self) -> DMatrix<f64> {
        skew(&self.stiffness)
    }

    /// The coefficients of the other coordinates, with these held fixed.
    #[must_use]
    pub fn without(self, prescribed: &[usize]) -> Self {
        if prescribed.is_empty() {
            return self;
        }
        let kept: Vec<usize> = (0..self.unknowns.len()).filter(|i| !prescribed.contains(&self.unknowns[*i])).collect();
        let of = |matrix: &DMatrix<f64>| matrix.select_rows(&kept).select_columns(&kept);
        Self {
            mass: of(&self.mass),
            stiffness: of(&self.stiffness),
            damping: of(&self.damping),
            unknowns: kept.iter().map(|i| self.unknowns[*i]).collect(),
            size: self.size,
            basis: self.basis,
        }
    }

    /// The coefficients of the motions about the pose `q` that leave the loops of a crane closed: on a basis Z of the null space of J, `Zᵀ A Z`,
    /// `Zᵀ D Z` and `Zᵀ (K + Σ λ_i ∂²φ_i/∂q²) Z`. The motion is at rest at time t.
    pub(crate) fn with_closed_loops(self, crane: &dyn DynCrane, t: f64, q: &[f64]) -> Self {
        if crane.loop_joints().is_empty() {
            return self;
        }
        let rest = vec![0.0; q.len()];
        let multipliers = required(crane, t, [q, &rest, &rest]);
        let geometric = geometric_stiffness(crane, q, &multipliers);
        let (free, basis) = independent_motions(crane, q);
        let of_unknowns = basis.select_rows(&self.unknowns);
        let stiffness = &self.stiffness + geometric.select_rows(&self.unknowns).select_columns(&self.unknowns);
        let of = |matrix: &DMatrix<f64>| of_unknowns.tr_mul(&(matrix * &of_unknowns));
        let symmetric = |matrix: DMatrix<f64>| (&matrix + matrix.transpose()) * 0.5;
        Self {
            mass: symmetric(of(&self.mass)),
            stiffness: of(&stiffness),
            damping: of(&self.damping),
            unknowns: free,
            size: self.size,
            basis: Some(basis),
        }
    }

    /// What a row over all coordinates is along the unknowns.
    pub(super) fn along_unknowns(&self, entry: impl Fn(usize) -> f64) -> DVector<f64> {
        match &self.basis {
            Some(basis) => basis.tr_mul(&DVector::from_fn(self.size, |j, _| entry(j))),
            None => DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(|&j| entry(j))),
        }
    }

    /// A shape over all coordinates; fixed ones have zeros.
    pub(super) fn shape(&self, of_unknowns: &DVector<f64>) -> DVector<f64> {
        if let Some(basis) = &self.basis {
            return basis * of_unknowns;
        }
        let mut shape = DVector::zeros(self.size);
        for (coordinate, x) in self.unknowns.iter().zip(of_unknowns) {
            shape[*coordinate] = *x;
        }
        shape
    }

    /// Cholesky's factors of A.
    ///
    /// # Errors
    /// A is not positive definite, or a coefficient is not a finite number.
    pub(super) fn factors(&self) -> Result<Cholesky<f64, Dyn>, NoModes> {
        let Self { mass, stiffness, damping, .. } = self;
        if [mass, stiffness, damping].into_iter().flatten().any(|number| !number.is_finite()) {
            return Err(NoModes::NotFinite);
        }
        mass.clone().cholesky().ok_or(NoModes::MassMatrix)
    }

    /// `−A⁻¹K` and `−A⁻¹D`.
    pub(super) fn state_blocks(&self, factors: &Cholesky<f64, Dyn>) -> [DMatrix<f64>; 2] {
        [&self.stiffness, &self.damping].map(|matrix| -factors.solve(matrix))
    }

    /// State matrix `[[0, I], [−A⁻¹K, −A⁻¹D]]` of `d/dt [δq; δq̇]`, 2N × 2N.
    ///
    /// # Errors
    /// The mass matrix is not positive definite, or a coefficient is not a finite number.
    pub fn state_matrix(&self) -> Result<DMatrix<f64>, NoModes> {
        let n = self.mass.nrows();
        let [stiffness, damping] = self.state_blocks(&self.factors()?);
        let mut state = DMatrix::zeros(2 * n, 2 * n);
        state.view_mut((0, n), (n, n)).fill_with_identity();
        state.view_mut((n, 0), (n, n)).copy_from(&stiffness);
        state.view_mut((n, n), (n, n)).copy_from(&damping);
        Ok(state)
    }

    /// Indices of the dominant coordinates, by their share in the energy of a mode, `|x̄ᵢ (A x)ᵢ|`, largest first.
    ///
    /// In an undamped mode `K x = ω² A x`, so that the shares of kinetic and strain energy are equal, whatever the units.
    pub(super) fn dominating<T: ComplexField<RealField = f64>>(&self, shape: &DVector<T>) -> Vec<usize> {
        // A is symmetric: its rows are its columns, which are contiguous in memory.
        let momentum = |column: DVectorView<'_, f64>| {
            shape.iter().zip(&column).fold(T::zero(), |sum, (x, &a)| sum + x.clone().scale(a)).modulus()
        };
        let columns = self.mass.column_iter();
        let share: Vec<f64> = shape.iter().zip(columns).map(|(x, a)| x.clone().modulus() * momentum(a)).collect();
        let least = SHARE * share.iter().copied().fold(0.0, f64::max);
        let mut dominating: Vec<usize> = (0..share.len()).filter(|&i| share[i] >= least).collect();
        dominating.sort_by(|&i, &j| share[j].total_cmp(&share[i]));
        dominating.into_iter().map(|i| self.unknowns[i]).collect()
    }
}

/// The independent coordinates of a crane with loops, and the motion of all coordinates per unit of each. Coordinates without drives and springs
/// are determined by the others.
pub(crate) fn independent_motions(crane: &dyn DynCrane, q: &[f64]) -> (Vec<usize>, DMatrix<f64>) {
    let coordinates = &crane.description().coordinates;
    let preferred = |j: usize| if coordinates[j].role == CoordinateRole::Passive { 1.0 } else { DRIVEN };
    closed_motions(crane, q, preferred)
}

/// `(X − Xᵀ)/2`
fn skew(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix - matrix.transpose()) * 0.5
}

impl dyn DynCrane + '_ {
    /// `A`, `K = ∂(A a − e − f)/∂q` and `D = −∂(e + f)/∂v` at time t, pose q, rates v and accelerations a:
    /// `A δq̈ + D δq̇ + K δq = 0`. K and D contain centrifugal and gyroscopic terms and need not be symmetric. Coordinates that
    /// rigid drives prescribe oscillate separately at 1 rad/s, as in [`linearise`](crate::dyn_crane::Functions::linearise). NaN for a crane without derivatives of the dynamics.
    pub fn linearise_motion(&self, t: f64, [q, v, a]: [&[f64]; 3]) -> [DMatrix<f64>; 3] {
        let size = self.size();
        let mut mass = self.mass_matrix_at(q);
        let mut rows = vec![0.0; 2 * size * size];
        self.dynamic_residual_derivatives(t, q, v, a, &mut rows);
        let (of_pose, of_rates) = rows.split_at(size * size);
        let [mut stiffness, mut damping] = [of_pose, of_rates].map(|rows| DMatrix::from_row_slice(size, size, rows));
        for j in self.description().prescribed() {
            for (matrix, diagonal) in [(&mut mass, 1.0), (&mut stiffness, 1.0), (&mut damping, 0.0)] {
                matrix.row_mut(j).fill(0.0);
                matrix.column_mut(j).fill(0.0);
                matrix[(j, j)] = diagonal;
            }
        }
        [mass, stiffness, damping]
    }
}
