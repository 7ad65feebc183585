//! Cranes run by the interpreter: any spec, any scalar, no rustc.

use crane_codegen::chain::{Analyses, Chain, Cylinder};
use crane_codegen::mechanics;
use crane_codegen::program::{Argument, FunctionId, Inputs, Layout, Program};
use crane_codegen::symbolic::Scalar;
use crane_model::nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::dual::Dual;
use crate::quantities::State;

/// A chain and its program.
pub struct Interpreted {
    /// The chain.
    pub chain: Chain,
    /// All its functions.
    pub program: Program,
}

impl Interpreted {
    /// All functions of a chain.
    #[must_use]
    pub fn new(chain: Chain) -> Self {
        let program = mechanics::derive(&chain, Analyses::ALL);
        Interpreted { chain, program }
    }

    /// Number of coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.chain.coordinates.len()
    }

    /// Coordinates that rigid drives prescribe.
    #[must_use]
    pub fn prescribed(&self) -> Vec<usize> {
        self.chain.rigid_drives().map(|drive| drive.coordinate.0).collect()
    }

    /// A matrix and the right-hand side of its system, with the prescribed unknowns eliminated: x = 0 there.
    #[must_use]
    pub fn unknowns(&self, mut matrix: DMatrix<f64>, mut right: DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
        for j in self.prescribed() {
            matrix.column_mut(j).fill(0.0);
            matrix.row_mut(j).fill(0.0);
            matrix[(j, j)] = 1.0;
            right[j] = 0.0;
        }
        (matrix, right)
    }

    /// Inputs at a state with the spec's parameters.
    #[must_use]
    pub fn inputs(&self, state: &State) -> Inputs<f64> {
        Inputs::state(state.t, state.q.clone(), state.v.clone(), self.chain.parameter_defaults())
    }

    /// A function's result, or `otherwise` zeros if the program lacks it. Unless `inputs` has the positions of drives, they are those of
    /// their motions.
    pub fn get<S: Scalar>(&self, function: &str, inputs: &Inputs<S>, otherwise: usize) -> Vec<S> {
        let id = FunctionId::named(function).unwrap_or_else(|| panic!("there is no function `{function}`"));
        match self.program.function(id) {
            Some(function) if function.arguments.contains(&Argument::DrivePositions) => {
                let given = inputs.get(Argument::DrivePositions);
                let positions = if given.is_empty() { self.drive_positions(inputs) } else { given };
                let inputs = inputs.clone().with(Argument::DrivePositions, positions);
                function.shape.fill(Layout::Rows, &self.program.evaluate(function, &inputs))
            }
            Some(function) => function.shape.fill(Layout::Rows, &self.program.evaluate(function, inputs)),
            None => vec![S::from_f64(0.0); otherwise],
        }
    }

    /// Positions of the drives' motions, by coordinate.
    fn drive_positions<S: Scalar>(&self, inputs: &Inputs<S>) -> Vec<S> {
        let mut positions = vec![S::from_f64(0.0); self.size()];
        let motions = self.get("drive_motions", inputs, 0);
        for (drive, motion) in self.chain.drives.iter().zip(motions.chunks_exact(2)) {
            positions[drive.coordinate.0] = motion[0].clone();
        }
        positions
    }

    /// A vector with one entry per coordinate.
    #[must_use]
    pub fn vector(&self, function: &str, state: &State) -> DVector<f64> {
        DVector::from_vec(self.get(function, &self.inputs(state), self.size()))
    }

    /// A square matrix.
    #[must_use]
    pub fn matrix(&self, function: &str, state: &State) -> DMatrix<f64> {
        let n = self.size();
        DMatrix::from_row_slice(n, n, &self.get(function, &self.inputs(state), n * n))
    }

    /// One number.
    #[must_use]
    pub fn scalar(&self, function: &str, state: &State) -> f64 {
        self.get(function, &self.inputs(state), 1)[0]
    }

    /// Accelerations q̈.
    #[must_use]
    pub fn acceleration(&self, state: &State) -> DVector<f64> {
        self.vector("forward_dynamics", state)
    }

    /// Plain Newton iteration on the static residual from the spec's guess.
    #[must_use]
    pub fn equilibrium(&self) -> State {
        let mut state = State { t: 0.0, q: self.chain.guess.clone(), v: vec![0.0; self.size()] };
        for _ in 0..30 {
            let step = self
                .matrix("tangent_stiffness", &state)
                .lu()
                .solve(&self.vector("static_residual", &state))
                .expect("the tangent stiffness is regular");
            for (q, s) in state.q.iter_mut().zip(&step) {
                *q -= s;
            }
        }
        state
    }

    /// Derivative of the energy `½ k (ℓ − ℓ₀)²` of springs that stand for cylinders with a valve at rest, along `inputs`; ℓ₀ and the lever
    /// arm in `k = s/(∂ℓ/∂q_j)²` are those of the crane with straight beams and its drives at their positions.
    #[must_use]
    pub fn slope_of_holding_energy(&self, state: &State, inputs: &Inputs<Dual>) -> f64 {
        let chain = &self.chain;
        let mut straight = State { q: vec![0.0; self.size()], ..state.clone() };
        let motions = self.get("drive_motions", &self.inputs(state), 2 * chain.drives.len());
        for (drive, motion) in chain.drives.iter().zip(motions.chunks_exact(2)) {
            straight.q[drive.coordinate.0] = motion[0];
        }
        let meant = self.get("cylinder_states", &self.inputs(&straight), 3 * chain.cylinders.len());
        let now = self.get("cylinder_states", inputs, 3 * chain.cylinders.len());
        let of_cylinder = |(index, cylinder): (usize, &Cylinder)| {
            let stiffness = chain.drives[chain.drive_of(cylinder)].oil()?.at(&chain.parameter_defaults());
            let (meant, now) = (&meant[3 * index..], now[3 * index]);
            Some(stiffness / meant[2].powi(2) * (now.value() - meant[0]) * now.derivative())
        };
        chain.cylinders.iter().enumerate().filter_map(of_cylinder).sum()
    }

    /// The lowest undamped angular frequency at a pose in stable equilibrium, rad/s: `1/ω²` is the largest eigenvalue of
    /// `L⁻¹ A L⁻ᵀ` with `K = L Lᵀ`. With `A = L Lᵀ`, ω² would be the smallest one of `L⁻¹ K L⁻ᵀ`, with an error of
    /// 1e-16 of the largest: a relative error of 1e-5 for 32 sections.
    pub fn lowest_frequency(&self, state: &State) -> f64 {
        let lower = self.matrix("tangent_stiffness", state).cholesky().expect("K is positive definite").l();
        let half = lower.solve_lower_triangular(&self.matrix("mass_matrix", state)).expect("L is regular");
        let reduced = lower.solve_lower_triangular(&half.transpose()).expect("L is regular");
        SymmetricEigen::new(reduced).eigenvalues.max().sqrt().recip()
    }
}
