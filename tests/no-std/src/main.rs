//! Calls every function of the crane, so that the linker has to find all of them free of panics.

use std::hint::black_box;

use crane_model::dynamics::rk4::State;
use crane_model::nalgebra::{Matrix4, Vector3};
use no_std_crane::{Crane, DESCRIPTION, Vector};

fn main() {
    let mut crane = black_box(Crane::default());
    let (t, q, v) = black_box((0.5, Vector::from_column_slice(DESCRIPTION.guess), Vector::repeat(0.1)));
    let pairs: usize = DESCRIPTION.bodies.iter().map(|b| b.degrees_of_freedom * (b.degrees_of_freedom + 1) / 2).sum();
    let mut matrices = vec![Matrix4::zeros(); black_box(pairs)];
    let mut vectors = vec![Vector3::zeros(); black_box(DESCRIPTION.supports.len().max(DESCRIPTION.points.len()))];
    let mut motions = vec![[0.0; 2]; black_box(DESCRIPTION.drives.len())];
    let _ = black_box(no_std_crane::set_parameter(&mut crane, black_box(0), black_box(400.0)));
    let _ = black_box(no_std_crane::set_parameters(&mut crane, black_box(&[400.0])));
    no_std_crane::transforms(&crane, &q, &mut matrices);
    no_std_crane::points(&crane, &q, &mut vectors);
    no_std_crane::point_velocities(&crane, &q, &v, &mut vectors);
    black_box(no_std_crane::forces(&crane, t, &q, &v));
    black_box(no_std_crane::support_forces(&crane, &q, &v));
    black_box(no_std_crane::element_forces(&crane, &q, &v));
    black_box(no_std_crane::drive_forces(&crane, t, &q, &v));
    black_box(no_std_crane::hinge_forces(&crane, &v));
    no_std_crane::support_reactions(&crane, &q, &v, &mut vectors);
    no_std_crane::drive_motions(&crane, t, &mut motions);
    black_box(no_std_crane::gravity_energy(&crane, &q));
    black_box(no_std_crane::support_energy(&crane, &q));
    black_box(no_std_crane::element_energy(&crane, &q));
    black_box(no_std_crane::drive_energy(&crane, t, &q));
    black_box(no_std_crane::potential_energy(&crane, t, &q));
    black_box(no_std_crane::drive_power(&crane, t, &q, &v));
    black_box(no_std_crane::dissipation(&crane, t, &q, &v));
    black_box(no_std_crane::mass_matrix(&crane, &q));
    black_box(no_std_crane::bias(&crane, &q, &v));
    black_box(no_std_crane::kinetic_energy(&crane, &q, &v));
    black_box(no_std_crane::static_residual(&crane, &q));
    black_box(no_std_crane::tangent_stiffness(&crane, &q));
    black_box(no_std_crane::linearise(&crane, &q));
    no_std_crane::transform_derivatives(&crane, &q, &mut matrices);
    no_std_crane::transform_second_derivatives(&crane, &q, &mut matrices);
    let mut state = State { q, v };
    black_box(no_std_crane::step(&crane, t, black_box(1e-4), &mut state));
    black_box((state, matrices, vectors, motions));
}
