//! A live crane with its number of coordinates in the type, for functions that need it there: single steps.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::{
    CraneModel, Description, Linearisation, ParameterError,
    dyn_crane::{DynCrane, Functions},
    statics,
};
use nalgebra::{Matrix4, SMatrix, SVector};

/// A crane of `N` coordinates.
#[derive(Clone)]
pub struct Live<const N: usize>(LiveCrane);

impl<const N: usize> Live<N> {
    /// The crane of a spec, which must have `N` coordinates.
    pub fn new(spec: &SourceFile) -> Self {
        let crane = LiveCrane::from_spec(spec).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        assert_eq!(crane.size(), N);
        Self(crane)
    }

    /// The stable equilibrium.
    pub fn equilibrium(&self) -> SVector<f64, N> {
        let equilibrium = statics::Problem::new(&self.0).solve();
        assert!(equilibrium.is_stable(), "{}", equilibrium.status);
        SVector::from_column_slice(&equilibrium.q)
    }
}

/// A vector that `write` writes.
fn vector<const N: usize>(write: impl FnOnce(&mut [f64])) -> SVector<f64, N> {
    let mut out = SVector::<f64, N>::zeros();
    write(out.as_mut_slice());
    out
}

impl<const N: usize> CraneModel<N> for Live<N> {
    crate::common::implicit::by_hand! { N }

    fn description(&self) -> &Description {
        self.0.description()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.0.parameter(index)
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.0.set_parameter(index, value)
    }

    fn body_sizes(&self, out: &mut [[f64; 2]]) {
        self.0.body_sizes(out);
    }

    fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.0.transforms(q.as_slice(), out);
    }

    fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        vector(|out| self.0.forces(t, q.as_slice(), v.as_slice(), out))
    }

    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.0.gravity_energy(q.as_slice())
    }

    fn mass_matrix(&self, q: &SVector<f64, N>, out: &mut SMatrix<f64, N, N>) {
        self.0.mass_matrix(q.as_slice(), out.as_mut_slice());
    }

    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        vector(|out| self.0.bias(q.as_slice(), v.as_slice(), out))
    }

    fn forward_dynamics(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        vector(|out| self.0.forward_dynamics(t, q.as_slice(), v.as_slice(), out))
    }

    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.0.kinetic_energy(q.as_slice(), v.as_slice())
    }

    fn linearise(&self, q: &SVector<f64, N>) -> Linearisation<N> {
        let mut matrices = [SMatrix::<f64, N, N>::zeros(); 3];
        self.0.linearise(q.as_slice(), bytemuck::cast_slice_mut(&mut matrices));
        let [mass, stiffness, damping] = matrices;
        Linearisation { mass, stiffness, damping }
    }
}
