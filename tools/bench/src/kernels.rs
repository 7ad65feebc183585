//! What is timed: one entry per kernel.

use std::cell::RefCell;

use crane_codegen::chain::{Analyses, Input};
use crane_codegen::program::FunctionId;
use crane_codegen::{SourceFile, compile, mechanics};
use crane_live::machine::Environment;
use crane_live::{LiveCrane, Routine};
use crane_model::dyn_crane::{Arguments, Functions};
use crane_model::dynamics::rk4;
use crane_model::nalgebra::{Cholesky, Matrix4, Matrix6, SMatrix, SVector};
use crane_model::rt::lanes::f64x8;
use crane_model::{CraneModel, LaneDynamics};

use crate::kernel::{Kernel, Lower, Rows};
use crate::states::{self, EightStates, State};
use crate::triple_sum::TripleSum;

/// Step size, s: stable for all numbers of sections, so that one step agrees with another library's.
pub const STEP: f64 = 1e-8;

/// Kernels of any crane.
///
/// # Panics
/// If `spec` is not the text that the crane was compiled from.
#[must_use]
pub fn all<const N: usize, C>(spec: &str) -> Vec<Kernel>
where
    C: CraneModel<N> + Default + Copy + 'static,
{
    let crane = C::default();
    let lanes = C::lanes([&crane; 8]);
    let states = &states::near_guess::<N>(&crane);
    let poses = vec![Matrix4::zeros(); crane.description().bodies.len()];
    let live = LiveCrane::from_spec(&SourceFile::new("crane.yaml", spec)).expect("a spec that was compiled");
    let three = Rows(vec![[0.0; N]; 3 * N]);
    let (vector, square) = (SVector::<f64, N>::zeros(), SMatrix::<f64, N, N>::zeros());
    vec![
        Kernel::new("transforms", 1, states, poses, move |s, out| crane.transforms(&s.q, out)),
        Kernel::new("mass_matrix", 1, states, square, move |s, out| crane.mass_matrix(&s.q, out)),
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
            let mut mass = SMatrix::zeros();
            crane.mass_matrix(&s.q, &mut mass);
            if let Some(factors) = Cholesky::new(mass) {
                *out = factors.solve(&(crane.bias(&s.q, &s.v) + crane.forces(s.t, &s.q, &s.v)));
            }
        }),
        Kernel::new("solve_mass", 1, states, vector, move |s, out| *out = crane.solve_mass(&s.q, &s.v)),
        Kernel::new("factorise_and_solve", 1, states, vector, move |s, out| {
            *out = crane.solve(&crane.factorise(&s.q, &SVector::repeat(1.0), &Matrix6::identity()), &s.v);
        }),
        Kernel::new("inverse_mass_matrix", 1, states, square, move |s, out| crane.inverse_mass_matrix(&s.q, out)),
        Kernel::new("dynamic_residual_derivatives", 1, states, Rows(vec![[0.0; N]; 2 * N]), move |s, out| {
            crane.dynamic_residual_derivatives(s.t, &s.q, &s.v, &s.v, &mut out.0);
        }),
        Kernel::new("forward_dynamics_derivatives", 1, states, three.clone(), move |s, out| {
            crane.forward_dynamics_derivatives(s.t, &s.q, &s.v, &mut out.0);
        })
        .compared_by(Kernel::new("", 1, states, three.clone(), move |s, out| at_given_forces(&crane, s, &mut out.0))),
        Kernel::new("forward_dynamics_machine_code", 1, states, vector, accelerations(live.clone())),
        Kernel::new(
            "forward_dynamics_machine_code_lanes",
            8,
            &states::by_eight(states),
            SVector::<f64x8, N>::repeat(f64x8::splat(0.0)),
            accelerations_of_eight(spec),
        ),
        Kernel::new("forward_dynamics_derivatives_live", 1, states, three, move |s, out| {
            live.forward_dynamics_derivatives(s.t, s.q.as_slice(), s.v.as_slice(), out.0.as_flattened_mut());
        }),
        Kernel::new("forward_dynamics_bytecode", 1, states, vector, interpreted(spec)),
        Kernel::new("rk4_step", 1, states, (vector, vector), move |s, out| {
            let mut state = rk4::State { q: s.q, v: s.v };
            if rk4::step(&crane, s.t, STEP, &mut state).is_ok() {
                *out = (state.q, state.v);
            }
        }),
    ]
}

/// Accelerations by machine code, made before the first call.
fn accelerations<const N: usize>(live: LiveCrane) -> impl Fn(&State<N>, &mut SVector<f64, N>) {
    live.compile(FunctionId::ForwardDynamics);
    move |s, out| live.forward_dynamics(s.t, s.q.as_slice(), s.v.as_slice(), out.as_mut_slice())
}

/// Forward dynamics of the crane of a spec, with its live parameters, and its inputs, none of which is set: they follow the spec.
fn forward_dynamics(spec: &str) -> (Routine, Vec<f64>, Vec<f64>) {
    let chain = compile::load(&SourceFile::new("crane.yaml", spec)).expect("a spec that was compiled");
    let program = mechanics::derive(&chain, Analyses::ALL);
    let function = program.function(FunctionId::ForwardDynamics).expect("a function of every crane");
    let routine = Routine::new(&program, function);
    (routine, chain.parameter_defaults(), Input::NOT_SET.repeat(chain.inputs.len()))
}

/// Accelerations of eight cranes by machine code, made before the first call.
fn accelerations_of_eight<const N: usize>(spec: &str) -> impl Fn(&EightStates<N>, &mut SVector<f64x8, N>) + use<N> {
    let (routine, parameters, inputs) = forward_dynamics(spec);
    let [parameters, inputs] = [parameters, inputs].map(|all| all.into_iter().map(f64x8::splat).collect::<Vec<_>>());
    routine.compile::<f64x8>();
    let machine = RefCell::new(routine.machine(&parameters));
    move |s, out| {
        let arguments = Arguments { t: s.t, q: s.q.as_slice(), v: s.v.as_slice(), ..Arguments::none() };
        let environment = Environment { inputs: &inputs, ..arguments.into() };
        routine.run(&mut machine.borrow_mut(), &environment, out.as_mut_slice());
    }
}

/// Accelerations by bytecode.
fn interpreted<const N: usize>(spec: &str) -> impl Fn(&State<N>, &mut SVector<f64, N>) + use<N> {
    let (routine, parameters, inputs) = forward_dynamics(spec);
    let machine = RefCell::new(routine.machine(&parameters));
    move |s, out| {
        let (t, q, v) = (s.t, s.q.as_slice(), s.v.as_slice());
        let environment = Environment { inputs: &inputs, ..Arguments { t, q, v, ..Arguments::none() }.into() };
        routine.interpret(&mut machine.borrow_mut(), &environment, out.as_mut_slice());
    }
}

/// Derivatives of accelerations while the forces keep their values, as other libraries have them: `∂q̈/∂q − A⁻¹ ∂f/∂q`, and with v.
fn at_given_forces<const N: usize>(crane: &impl CraneModel<N>, s: &State<N>, out: &mut [[f64; N]]) {
    crane.forward_dynamics_derivatives(s.t, &s.q, &s.v, out);
    let mut forces = vec![[0.0; N]; 2 * N];
    crane.force_derivatives(s.t, &s.q, &s.v, &mut forces);
    let (slopes, inverse) = out.split_at_mut(2 * N);
    for (slopes, forces) in slopes.chunks_mut(N).zip(forces.chunks(N)) {
        for (slopes, inverse) in slopes.iter_mut().zip(&*inverse) {
            for (j, slope) in slopes.iter_mut().enumerate() {
                *slope -= inverse.iter().zip(forces).map(|(inverse, force)| inverse * force[j]).sum::<f64>();
            }
        }
    }
}

/// These, and those of a crane with derivatives of its transforms.
///
/// # Panics
/// If `spec` is not the text that the crane was compiled from.
#[must_use]
pub fn all_of_small<const N: usize, C>(spec: &str) -> Vec<Kernel>
where
    C: CraneModel<N> + Default + Copy + 'static,
{
    let crane = C::default();
    let states = &states::near_guess::<N>(&crane);
    let mut kernels = all::<N, C>(spec);
    kernels.extend(TripleSum::read(spec).map(|sum| {
        let sums = sum.workspace::<N>();
        Kernel::new("triple_sum", 1, states, sums, move |s: &State<N>, out| sum.evaluate(&crane, &s.q, &s.v, out))
    }));
    kernels
}
