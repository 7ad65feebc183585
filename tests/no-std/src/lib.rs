//! Three cranes for a machine without operating system: no `std`, no heap, and no function that can panic.
//!
//! As a static library with the panic handler below it builds only if no dependency needs `std` or a heap:
//!
//! ```text
//! cargo rustc --release -p no-std-crane --lib --features bare --crate-type staticlib -- -C panic=abort
//! ```
//!
//! The program of this package links only if the optimiser has proved that no panic can be reached:
//!
//! ```text
//! cargo build --release -p no-std-crane --features no-panic --config 'profile.release.lto="fat"' --config profile.release.codegen-units=1
//! ```

#![no_std]

/// All functions of a generated crane, one per method of the traits.
macro_rules! crane {
    ($(#[$about:meta])* $name:ident) => {
        $(#[$about])*
        pub mod $name {
            use crane_model::dynamics::rk4::{self, State};
            use crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};
            use crane_model::rt::lanes::f64x8;
            use crane_model::{
                CraneModel, Dynamics, Ensemble, Implicit, InternalForces, LaneDynamics, Linearisation, Linearise,
                ParameterError, SectionModuli, Statics, Tension, TransformDerivatives, Wrench,
            };

            pub use generated::{Crane, DESCRIPTION, N};

            /// The generated module.
            mod generated {
                #![allow(dead_code, clippy::all)]
                include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
            }

            /// Coordinates, velocities or generalized forces.
            pub type Vector = SVector<f64, N>;
            /// The same of eight cranes.
            pub type LaneVector = SVector<f64x8, N>;
            /// Mass or stiffness.
            pub type Matrix = SMatrix<f64, N, N>;
            /// Stiffness or damping of the base.
            pub type BaseMatrix = SMatrix<f64, 6, 6>;
            /// Factors of a system.
            pub type Factors = <Crane as Implicit<N>>::Factors;
            /// Eight cranes.
            pub type Lanes = <Crane as Ensemble<N>>::Lanes;

            exported! {
                Crane;
                transforms(q: &Vector, out: &mut [Matrix4<f64>]);
                points(q: &Vector, out: &mut [Vector3<f64>]);
                point_velocities(q: &Vector, v: &Vector, out: &mut [Vector3<f64>]);
                forces(t: f64, q: &Vector, v: &Vector) -> Vector;
                support_forces(q: &Vector, v: &Vector) -> Vector;
                element_forces(q: &Vector, v: &Vector) -> Vector;
                drive_forces(t: f64, q: &Vector, v: &Vector) -> Vector;
                joint_damper_forces(v: &Vector) -> Vector;
                stop_forces(q: &Vector, v: &Vector) -> Vector;
                friction_forces(v: &Vector) -> Vector;
                load_forces(t: f64, q: &Vector) -> Vector;
                load_pieces(out: &mut [[f64; 2]]);
                connector_forces(t: f64, q: &Vector, v: &Vector) -> Vector;
                connector_lengths(q: &Vector, v: &Vector, out: &mut [[f64; 2]]);
                connector_tensions(t: f64, q: &Vector, v: &Vector, out: &mut [Tension]);
                connector_jacobians(q: &Vector, out: &mut [[f64; N]]);
                winch_pieces(out: &mut [[f64; 2]]);
                support_reactions(q: &Vector, v: &Vector, out: &mut [Vector3<f64>]);
                support_gaps(q: &Vector, v: &Vector, out: &mut [[f64; 2]]);
                cylinder_states(q: &Vector, v: &Vector, out: &mut [Vector3<f64>]);
                cylinder_jacobians(q: &Vector, out: &mut [[f64; N]]);
                drive_limits(t: f64, q: &Vector, v: &Vector, out: &mut [[f64; 2]]);
                drive_motions(t: f64, out: &mut [[f64; 2]]);
                valve_openings(t: f64, out: &mut [[f64; 2]]);
                drive_pieces(out: &mut [[f64; 2]]);
                prescribe(t: f64, q: &mut Vector, v: &mut Vector);
                gravity_energy(q: &Vector) -> f64;
                support_energy(q: &Vector) -> f64;
                element_energy(q: &Vector) -> f64;
                drive_energy(t: f64, q: &Vector) -> f64;
                stop_energy(q: &Vector) -> f64;
                potential_energy(t: f64, q: &Vector) -> f64;
                drive_power(t: f64, q: &Vector, v: &Vector) -> f64;
                connector_energy(t: f64, q: &Vector) -> f64;
                winch_power(t: f64, q: &Vector, v: &Vector) -> f64;
                load_power(t: f64, q: &Vector, v: &Vector) -> f64;
                dissipation(t: f64, q: &Vector, v: &Vector) -> f64;
                mass_matrix(q: &Vector) -> Matrix;
                mass_matrix_and_bias(q: &Vector, v: &Vector, mass: &mut Matrix) -> Vector;
                bias(q: &Vector, v: &Vector) -> Vector;
                forward_dynamics(t: f64, q: &Vector, v: &Vector) -> Vector;
                solve_mass(q: &Vector, r: &Vector) -> Vector;
                kinetic_energy(q: &Vector, v: &Vector) -> f64;
                factorise(q: &Vector, added_inertia: &Vector, base: &BaseMatrix) -> Factors;
                solve(factors: &Factors, r: &Vector) -> Vector;
                joint_stiffness_and_damping(out: &mut [[f64; 2]]);
                nonlinear_stiffness_and_damping(t: f64, q: &Vector, v: &Vector, out: &mut [[f64; 2]]);
                base_stiffness(q: &Vector, v: &Vector) -> BaseMatrix;
                base_damping(q: &Vector, v: &Vector) -> BaseMatrix;
                static_residual(t: f64, q: &Vector, positions: &Vector) -> Vector;
                tangent_stiffness(t: f64, q: &Vector, positions: &Vector) -> Matrix;
                drive_forces_at_rest(t: f64, q: &Vector, positions: &Vector) -> Vector;
                drive_positions(t: f64) -> Vector;
                linearise(q: &Vector) -> Linearisation<N>;
                internal_forces(t: f64, q: &Vector, v: &Vector, a: &Vector, out: &mut [Wrench]);
                cylinder_wrenches(q: &Vector, out: &mut [Wrench]);
                connector_wrenches(q: &Vector, out: &mut [Wrench]);
                support_positions(q: &Vector, out: &mut [Vector3<f64>]);
                section_moduli(out: &mut [SectionModuli]);
                transform_derivatives(q: &Vector, out: &mut [Matrix4<f64>]);
                transform_second_derivatives(q: &Vector, out: &mut [Matrix4<f64>]);
            }

            /// Accelerations of eight cranes.
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn lane_forward_dynamics(cranes: &Lanes, t: f64x8, q: &LaneVector, v: &LaneVector) -> LaneVector {
                cranes.forward_dynamics(t, q, v)
            }

            /// Sets a live parameter.
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn set_parameter(crane: &mut Crane, index: usize, value: f64) -> Result<(), ParameterError> {
                crane.set_parameter(index, value)
            }

            /// Sets the first live parameters.
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn set_parameters(crane: &mut Crane, values: &[f64]) -> Result<(), ParameterError> {
                crane.set_parameters(values)
            }

            /// One step of the motion; false where an acceleration is not finite.
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn step(crane: &Crane, t: f64, h: f64, state: &mut State<N>) -> bool {
                rk4::step(crane, t, h, state).is_ok()
            }
        }
    };
}

/// One function per method.
macro_rules! exported {
    ($crane:ident; $($name:ident($($argument:ident: $of:ty),*) $(-> $result:ty)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "` of the generated crane.")]
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn $name(crane: &$crane, $($argument: $of),*) $(-> $result)? {
                crane.$name($($argument),*)
            }
        )*
    };
}

crane! {
    /// The reference crane.
    eight_link_flexible
}
crane! {
    /// Feet that lift, joints that stick, cylinders with valves.
    eight_link_hydraulic
}
crane! {
    /// Exact kinematics, rotation vectors, a rigid drive, rotors.
    exact
}

/// The owner of the machine decides what a panic does. `std` has its own handler; two of them do not compile.
#[cfg(all(feature = "bare", not(feature = "no-panic")))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
