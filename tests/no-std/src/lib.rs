//! The reference crane for a machine without operating system: no `std`, no heap, and no function that can panic.
//!
//! As a static library with the panic handler below it builds only where no crate beneath needs `std` or a heap:
//!
//! ```text
//! cargo rustc --release -p no-std-crane --lib --features bare --crate-type staticlib -- -C panic=abort
//! ```
//!
//! The program of this package links only where the optimiser has found every path to a panic impossible:
//!
//! ```text
//! cargo build --profile no-panic -p no-std-crane --features no-panic
//! ```

#![no_std]

use crane_model::dynamics::rk4::{self, State};
use crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};
use crane_model::{CraneModel, Dynamics, Linearisation, Linearise, ParameterError, Statics, TransformDerivatives};

pub use crane::{Crane, DESCRIPTION, N};

/// The generated module.
mod crane {
    #![allow(dead_code, clippy::all)]
    include!(concat!(env!("OUT_DIR"), "/eight_link_flexible.rs"));
}

/// Coordinates, velocities or generalized forces.
pub type Vector = SVector<f64, N>;
/// Mass or stiffness.
pub type Matrix = SMatrix<f64, N, N>;

/// One function a method of the traits.
macro_rules! exported {
    ($($name:ident($($argument:ident: $of:ty),*) $(-> $result:ty)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "` of the generated crane.")]
            #[cfg_attr(feature = "no-panic", no_panic::no_panic)]
            pub fn $name(crane: &Crane, $($argument: $of),*) $(-> $result)? {
                crane.$name($($argument),*)
            }
        )*
    };
}

exported! {
    transforms(q: &Vector, out: &mut [Matrix4<f64>]);
    points(q: &Vector, out: &mut [Vector3<f64>]);
    point_velocities(q: &Vector, v: &Vector, out: &mut [Vector3<f64>]);
    forces(t: f64, q: &Vector, v: &Vector) -> Vector;
    support_forces(q: &Vector, v: &Vector) -> Vector;
    element_forces(q: &Vector, v: &Vector) -> Vector;
    drive_forces(t: f64, q: &Vector, v: &Vector) -> Vector;
    hinge_forces(v: &Vector) -> Vector;
    support_reactions(q: &Vector, v: &Vector, out: &mut [Vector3<f64>]);
    drive_motions(t: f64, out: &mut [[f64; 2]]);
    gravity_energy(q: &Vector) -> f64;
    support_energy(q: &Vector) -> f64;
    element_energy(q: &Vector) -> f64;
    drive_energy(t: f64, q: &Vector) -> f64;
    potential_energy(t: f64, q: &Vector) -> f64;
    drive_power(t: f64, q: &Vector, v: &Vector) -> f64;
    dissipation(t: f64, q: &Vector, v: &Vector) -> f64;
    mass_matrix(q: &Vector) -> Matrix;
    bias(q: &Vector, v: &Vector) -> Vector;
    kinetic_energy(q: &Vector, v: &Vector) -> f64;
    static_residual(q: &Vector) -> Vector;
    tangent_stiffness(q: &Vector) -> Matrix;
    linearise(q: &Vector) -> Linearisation<N>;
    transform_derivatives(q: &Vector, out: &mut [Matrix4<f64>]);
    transform_second_derivatives(q: &Vector, out: &mut [Matrix4<f64>]);
}

/// Another value of a live parameter.
#[cfg_attr(feature = "no-panic", no_panic::no_panic)]
pub fn set_parameter(crane: &mut Crane, index: usize, value: f64) -> Result<(), ParameterError> {
    crane.set_parameter(index, value)
}

/// Other values of the first live parameters.
#[cfg_attr(feature = "no-panic", no_panic::no_panic)]
pub fn set_parameters(crane: &mut Crane, values: &[f64]) -> Result<(), ParameterError> {
    crane.set_parameters(values)
}

/// One step of the motion; false where the mass matrix is not positive definite.
#[cfg_attr(feature = "no-panic", no_panic::no_panic)]
pub fn step(crane: &Crane, t: f64, h: f64, state: &mut State<N>) -> bool {
    rk4::step(crane, t, h, state).is_ok()
}

/// What a panic does is up to whoever owns the machine. `std` has a handler of its own; two of them do not compile.
#[cfg(all(feature = "bare", not(feature = "no-panic")))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
