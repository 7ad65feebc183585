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

/// Type of an argument.
macro_rules! argument {
    (t) => {
        f64
    };
    ($vector:ident) => {
        &Vector
    };
}

/// Type of a result.
macro_rules! result {
    (number) => {
        f64
    };
    (vector) => {
        Vector
    };
    (base) => {
        BaseMatrix
    };
}

/// Type of an entry of a list.
macro_rules! entry {
    (row) => {
        [f64; N]
    };
    ($item:ident) => {
        crane_model::entry_type!($item)
    };
}

/// One function per row of the table of quantities.
macro_rules! exported {
    ($($trait:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(export! { $result $name($($argument),*) })*)*
    };
}

/// One function.
macro_rules! export {
    (other $($row:tt)*) => {};
    ([$item:ident; $count:ident] $name:ident($($argument:ident),*)) => {
        exported_by_hand! { $name($($argument: argument!($argument),)* out: &mut [entry!($item)]); }
    };
    (matrix $name:ident($($argument:ident),*)) => {
        exported_by_hand! { $name($($argument: argument!($argument),)* out: &mut Matrix); }
    };
    ($result:ident $name:ident($($argument:ident),*)) => {
        exported_by_hand! { $name($($argument: argument!($argument)),*) -> result!($result); }
    };
}

/// One function per method.
macro_rules! exported_by_hand {
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

/// All functions of a generated crane, one per method of the trait.
macro_rules! crane {
    ($(#[$about:meta])* $name:ident) => {
        $(#[$about])*
        pub mod $name {
            use crane_model::dynamics::rk4::{self, State};
            use crane_model::nalgebra::{SMatrix, SVector};
            use crane_model::rt::lanes::f64x8;
            use crane_model::{
                CraneModel, LaneDynamics, Linearisation, ParameterError};
            use crane_quantities::quantities;

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
            pub type Factors = <Crane as CraneModel<N>>::Factors;
            /// Eight cranes.
            pub type Lanes = <Crane as CraneModel<N>>::Lanes;

            quantities! { exported }

            exported_by_hand! {
                prescribe(t: f64, q: &mut Vector, v: &mut Vector);
                potential_energy(t: f64, q: &Vector) -> f64;
                mass_matrix_and_bias(q: &Vector, v: &Vector, mass: &mut Matrix) -> Vector;
                factorise(q: &Vector, added_inertia: &Vector, base: &BaseMatrix) -> Factors;
                solve(factors: &Factors, r: &Vector) -> Vector;
                drive_positions(t: f64) -> Vector;
                linearise(q: &Vector) -> Linearisation<N>;
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
