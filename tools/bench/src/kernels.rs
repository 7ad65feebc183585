//! What is timed: one entry per kernel.

use crane_model::dynamics::rk4;
use crane_model::nalgebra::{Cholesky, Matrix4, Matrix6, SMatrix, SVector};
use crane_model::rt::lanes::f64x8;
use crane_model::{Ensemble, Implicit, LaneDynamics, MotionDerivatives, TransformDerivatives};

use crate::kernel::{Kernel, Lower, Rows};
use crate::states::{self, State};
use crate::triple_sum::TripleSum;

/// Step size, s: stable for all numbers of sections, so that one step agrees with another library's.
pub const STEP: f64 = 1e-8;

/// Kernels of any crane.
#[must_use]
pub fn all<const N: usize, C>(_spec: &str) -> Vec<Kernel>
where
    C: Implicit<N> + Ensemble<N> + MotionDerivatives<N> + Default + Copy + 'static,
{
    let crane = C::default();
    let lanes = C::lanes([&crane; 8]);
    let states = &states::near_guess::<N>(crane.description());
    let poses = vec![Matrix4::zeros(); crane.description().bodies.len()];
    let (vector, square) = (SVector::<f64, N>::zeros(), SMatrix::<f64, N, N>::zeros());
    vec![
        Kernel::new("transforms", 1, states, poses, move |s, out| crane.transforms(&s.q, out)),
        Kernel::new("mass_matrix", 1, states, square, move |s, out| *out = crane.mass_matrix(&s.q)),
        Kernel::new("bias", 1, states, vector, move |s, out| *out = crane.bias(&s.q, &s.v)),
        Kernel::new("forces", 1, states, vector, move |s, out| *out = crane.forces(s.t, &s.q, &s.v)),
        Kernel::new("mass_matrix_and_bias", 1, states, (Lower(square), vector), move |s, out| {
            out.1 = crane.mass_matrix_and_bias(&s.q, &s.v, &mut out.0.0);
        }),
        Kernel::new("forward_dynamics", 1, states, vector, move |s, out| {
            *out = crane.forward_dynamics(s.t, &s.q, &s.v);
        }),
        Kernel::new(
            "forward_dynamics_lanes",
            8,
            &states::by_eight(states),
            SVector::<f64x8, N>::repeat(f64x8::splat(0.0)),
            move |s, out| {
                *out = lanes.forward_dynamics(s.t, &s.q, &s.v);
            },
        ),
        Kernel::new("dense_forward_dynamics", 1, states, vector, move |s, out| {
            if let Some(factors) = Cholesky::new(crane.mass_matrix(&s.q)) {
                *out = factors.solve(&(crane.bias(&s.q, &s.v) + crane.forces(s.t, &s.q, &s.v)));
            }
        }),
        Kernel::new("solve_mass", 1, states, vector, move |s, out| *out = crane.solve_mass(&s.q, &s.v)),
        Kernel::new("factorise_and_solve", 1, states, vector, move |s, out| {
            *out = crane.solve(&crane.factorise(&s.q, &SVector::repeat(1.0), &Matrix6::identity()), &s.v);
        }),
        Kernel::new("inverse_mass_matrix", 1, states, square, move |s, out| *out = crane.inverse_mass_matrix(&s.q)),
        Kernel::new("dynamic_residual_derivatives", 1, states, Rows(vec![[0.0; N]; 2 * N]), move |s, out| {
            crane.dynamic_residual_derivatives(s.t, &s.q, &s.v, &s.v, &mut out.0);
        }),
        Kernel::new("forward_dynamics_derivatives", 1, states, Rows(vec![[0.0; N]; 3 * N]), move |s, out| {
            crane.forward_dynamics_derivatives(s.t, &s.q, &s.v, &mut out.0);
        }),
        Kernel::new("rk4_step", 1, states, (vector, vector), move |s, out| {
            let mut state = rk4::State { q: s.q, v: s.v };
            if rk4::step(&crane, s.t, STEP, &mut state).is_ok() {
                *out = (state.q, state.v);
            }
        }),
    ]
}

/// These, and those of a crane with derivatives of its transforms.
#[must_use]
pub fn all_of_small<const N: usize, C>(spec: &str) -> Vec<Kernel>
where
    C: Implicit<N> + Ensemble<N> + MotionDerivatives<N> + TransformDerivatives<N> + Default + Copy + 'static,
{
    let crane = C::default();
    let states = &states::near_guess::<N>(crane.description());
    let mut kernels = all::<N, C>(spec);
    kernels.extend(TripleSum::read(spec).map(|sum| {
        let sums = sum.workspace::<N>();
        Kernel::new("triple_sum", 1, states, sums, move |s: &State<N>, out| sum.evaluate(&crane, &s.q, &s.v, out))
    }));
    kernels
}
