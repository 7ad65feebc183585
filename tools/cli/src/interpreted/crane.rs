//! A crane whose functions are run by the interpreter.

use std::{collections::HashMap, sync::Arc};

use crane_codegen::{
    chain::{Analyses, Chain},
    mechanics,
};
use nalgebra::{Matrix4, SMatrix, SVector, Vector3};

use super::{
    describe::describe,
    routine::{Inputs, Routine},
};
use crane_model::{
    CraneModel, Description, Dynamics, Ensemble, Implicit, Linearisation, Linearise, OneByOne, ParameterError, Statics,
    TransformDerivatives,
};

/// A crane of `N` coordinates, with every analysis.
#[derive(Clone, Debug)]
pub struct Interpreted<const N: usize> {
    description: Description,
    routines: Arc<HashMap<&'static str, Routine>>,
    parameters: Vec<f64>,
    /// Coordinates that rigid drives prescribe.
    prescribed: Vec<usize>,
}

impl<const N: usize> Interpreted<N> {
    /// The crane of a chain with `N` coordinates.
    pub fn new(chain: &Chain) -> Self {
        let program = mechanics::derive(chain, Analyses::ALL);
        let routines =
            program.functions.iter().map(|function| (function.name, Routine::new(&program, function))).collect();
        Self {
            description: describe(chain),
            routines: Arc::new(routines),
            parameters: chain.parameter_defaults(),
            prescribed: chain.rigid_drives().map(|drive| drive.coordinate.0).collect(),
        }
    }

    /// The result of a function; `None` where the crane does not need it.
    fn run(&self, function: &str, inputs: Inputs<'_>) -> Option<Vec<f64>> {
        Some(self.routines.get(function)?.run(&Inputs { parameters: &self.parameters, ..inputs }))
    }

    fn vector(&self, function: &str, inputs: Inputs<'_>) -> SVector<f64, N> {
        self.run(function, inputs).map_or(SVector::zeros(), SVector::from_vec)
    }

    fn scalar(&self, function: &str, inputs: Inputs<'_>) -> f64 {
        self.run(function, inputs).map_or(0.0, |result| result[0])
    }

    fn matrix<const M: usize>(&self, function: &str, inputs: Inputs<'_>) -> SMatrix<f64, M, M> {
        self.run(function, inputs).map_or(SMatrix::zeros(), |upper| symmetric(&upper))
    }

    fn vectors(&self, function: &str, inputs: Inputs<'_>, out: &mut [Vector3<f64>]) {
        for (out, vector) in out.iter_mut().zip(self.run(function, inputs).unwrap_or_default().chunks(3)) {
            *out = Vector3::from_column_slice(vector);
        }
    }

    fn pairs(&self, function: &str, inputs: Inputs<'_>, out: &mut [[f64; 2]]) {
        for (out, pair) in out.iter_mut().zip(self.run(function, inputs).unwrap_or_default().chunks(2)) {
            out.copy_from_slice(pair);
        }
    }

    /// Matrices of three rows each; `corner` is the last element of the fourth.
    fn transformations(&self, function: &str, q: &SVector<f64, N>, corner: f64, out: &mut [Matrix4<f64>]) {
        let rows = self.run(function, at(q)).unwrap_or_default();
        for (out, rows) in out.iter_mut().zip(rows.chunks(12)) {
            *out = Matrix4::from_fn(|i, j| match (rows.get(4 * i + j), j) {
                (Some(entry), _) => *entry,
                (None, 3) => corner,
                (None, _) => 0.0,
            });
        }
    }
}

fn at<const N: usize>(q: &SVector<f64, N>) -> Inputs<'_> {
    Inputs { q: q.as_slice(), ..Inputs::default() }
}

fn state<'a, const N: usize>(t: f64, q: &'a SVector<f64, N>, v: &'a SVector<f64, N>) -> Inputs<'a> {
    Inputs { t, q: q.as_slice(), v: v.as_slice(), ..Inputs::default() }
}

/// A matrix of its upper triangle, row by row.
fn symmetric<const M: usize>(upper: &[f64]) -> SMatrix<f64, M, M> {
    let slot = |row: usize, column: usize| row * M + column - row * (row + 1) / 2;
    SMatrix::from_fn(|i, j| upper[slot(i.min(j), i.max(j))])
}

impl<const N: usize> CraneModel<N> for Interpreted<N> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index).copied().unwrap_or(f64::NAN)
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        if let (Some(parameter), Some(info)) = (self.parameters.get_mut(index), self.description.parameters.get(index))
        {
            info.check(value)?;
            *parameter = value;
        }
        Ok(())
    }

    fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.transformations("transforms", q, 1.0, out);
    }

    fn points(&self, q: &SVector<f64, N>, out: &mut [Vector3<f64>]) {
        self.vectors("points", at(q), out);
    }

    fn point_velocities(&self, q: &SVector<f64, N>, v: &SVector<f64, N>, out: &mut [Vector3<f64>]) {
        self.vectors("point_velocities", state(0.0, q, v), out);
    }

    fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("forces", state(t, q, v))
    }

    fn support_forces(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("support_forces", state(0.0, q, v))
    }

    fn element_forces(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("element_forces", state(0.0, q, v))
    }

    fn drive_forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("drive_forces", state(t, q, v))
    }

    fn hinge_forces(&self, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("hinge_forces", Inputs { v: v.as_slice(), ..Inputs::default() })
    }

    fn support_reactions(&self, q: &SVector<f64, N>, v: &SVector<f64, N>, out: &mut [Vector3<f64>]) {
        self.vectors("support_reactions", state(0.0, q, v), out);
    }

    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.pairs("drive_motions", Inputs { t, ..Inputs::default() }, out);
    }

    fn prescribe(&self, t: f64, q: &mut SVector<f64, N>, v: &mut SVector<f64, N>) {
        let motions = self.run("prescribed_motions", Inputs { t, ..Inputs::default() }).unwrap_or_default();
        for (&j, motion) in self.prescribed.iter().zip(motions.chunks(2)) {
            (q[j], v[j]) = (motion[0], motion[1]);
        }
    }

    fn drive_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs("drive_pieces", Inputs::default(), out);
    }

    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.scalar("gravity_energy", at(q))
    }

    fn support_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.scalar("support_energy", at(q))
    }

    fn element_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.scalar("element_energy", at(q))
    }

    fn drive_energy(&self, t: f64, q: &SVector<f64, N>) -> f64 {
        self.scalar("drive_energy", Inputs { t, ..at(q) })
    }

    fn drive_power(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.scalar("drive_power", state(t, q, v))
    }

    fn dissipation(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.scalar("dissipation", state(t, q, v))
    }
}

impl<const N: usize> Dynamics<N> for Interpreted<N> {
    fn mass_matrix(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.matrix("mass_matrix", at(q))
    }

    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("bias", state(0.0, q, v))
    }

    fn forward_dynamics(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("forward_dynamics", state(t, q, v))
    }

    fn solve_mass(&self, q: &SVector<f64, N>, r: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("solve_mass", Inputs { right: r.as_slice(), ..at(q) })
    }

    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.scalar("kinetic_energy", state(0.0, q, v))
    }
}

impl<const N: usize> Implicit<N> for Interpreted<N> {
    type Factors = Vec<f64>;

    fn factorise(&self, q: &SVector<f64, N>, resistance: &SVector<f64, N>, base: &SMatrix<f64, 6, 6>) -> Vec<f64> {
        let inputs = Inputs { resistance: resistance.as_slice(), base: base.as_slice(), ..at(q) };
        self.run("factorise", inputs).unwrap_or_default()
    }

    fn solve(&self, factors: &Vec<f64>, r: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("solve", Inputs { factors, right: r.as_slice(), ..Inputs::default() })
    }

    fn joint_impedances(&self, out: &mut [[f64; 2]]) {
        self.pairs("joint_impedances", Inputs::default(), out);
    }

    fn base_stiffness(&self, q: &SVector<f64, N>) -> SMatrix<f64, 6, 6> {
        self.matrix("base_stiffness", at(q))
    }

    fn base_damping(&self, q: &SVector<f64, N>) -> SMatrix<f64, 6, 6> {
        self.matrix("base_damping", at(q))
    }
}

impl<const N: usize> Ensemble<N> for Interpreted<N> {
    type Lanes = OneByOne<Self>;

    fn lanes(cranes: [&Self; 8]) -> OneByOne<Self> {
        OneByOne(cranes.map(Clone::clone))
    }
}

impl<const N: usize> Statics<N> for Interpreted<N> {
    fn static_residual(&self, q: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector("static_residual", at(q))
    }

    fn tangent_stiffness(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.matrix("tangent_stiffness", at(q))
    }

    fn drive_forces_at_rest(&self, q: &SVector<f64, N>) -> SVector<f64, N> {
        match self.run("drive_forces_at_rest", at(q)) {
            Some(forces) => SVector::from_vec(forces),
            None => {
                let mut motions = vec![[0.0; 2]; self.description.drives.len()];
                self.drive_motions(0.0, &mut motions);
                let mut v = SVector::zeros();
                for (drive, [_, rate]) in self.description.drives.iter().zip(motions) {
                    v[drive.coordinate] = rate;
                }
                self.drive_forces(0.0, q, &v)
            }
        }
    }
}

impl<const N: usize> Linearise<N> for Interpreted<N> {
    fn linearise(&self, q: &SVector<f64, N>) -> Linearisation<N> {
        let slots = self.run("linearise", at(q)).unwrap_or_default();
        let mut parts = slots.chunks((N * (N + 1) / 2).max(1)).map(symmetric);
        let mut next = || parts.next().unwrap_or_else(SMatrix::zeros);
        Linearisation { mass: next(), stiffness: next(), damping: next() }
    }
}

impl<const N: usize> TransformDerivatives<N> for Interpreted<N> {
    fn transform_derivatives(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.transformations("transform_derivatives", q, 0.0, out);
    }

    fn transform_second_derivatives(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.transformations("transform_second_derivatives", q, 0.0, out);
    }
}
