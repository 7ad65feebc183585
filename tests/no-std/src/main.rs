//! Calls every function of the cranes, so that the linker has to find all of them free of panics.

use std::hint::black_box;

use crane_model::dynamics::rk4::State;
use crane_model::nalgebra::{Matrix4, Vector3};
use crane_model::rt::lanes::splat;
use crane_model::{Ensemble, Implicit, SectionModuli, Tension, Wrench};

/// Calls every function of a crane.
macro_rules! call_all {
    ($crane:ident) => {{
        use no_std_crane::$crane::{self as of, BaseMatrix, Crane, DESCRIPTION, LaneVector, Matrix, Vector};
        let mut crane = black_box(Crane::default());
        let (t, mut q, mut v) = black_box((0.5, Vector::from_column_slice(&DESCRIPTION.guess), Vector::repeat(0.1)));
        let pairs: usize =
            DESCRIPTION.bodies.iter().map(|b| b.degrees_of_freedom * (b.degrees_of_freedom + 1) / 2).sum();
        let mut matrices = vec![Matrix4::zeros(); black_box(pairs)];
        let mut vectors = vec![Vector3::zeros(); black_box(DESCRIPTION.supports.len().max(DESCRIPTION.points.len()))];
        let elements = 1 + DESCRIPTION.connectors.len() + DESCRIPTION.cylinders.len();
        let mut wrenches =
            vec![Wrench::ZERO; black_box(elements * (2 * DESCRIPTION.bodies.len() + DESCRIPTION.sections.len() + 1))];
        let mut moduli = vec![SectionModuli::ZERO; black_box(DESCRIPTION.sections.len())];
        let mut motions = vec![[0.0; 2]; black_box(DESCRIPTION.drives.len())];
        let pieces = DESCRIPTION.drives.iter().map(|drive| drive.pieces).sum();
        let mut pieces = vec![[0.0; 2]; black_box(pieces)];
        let mut stiffness_and_damping = vec![[0.0; 2]; black_box(q.len())];
        let connectors = black_box(DESCRIPTION.connectors.len().max(DESCRIPTION.cylinders.len()));
        let (mut tensions, mut rows) = (vec![Tension::ZERO; connectors], vec![[0.0; of::N]; connectors]);
        let mut gaps = vec![[0.0; 2]; black_box(DESCRIPTION.supports.len())];
        let mut mass = Matrix::zeros();
        let _ = black_box(of::set_parameter(&mut crane, black_box(0), black_box(400.0)));
        let _ = black_box(of::set_parameters(&mut crane, black_box(&[400.0])));
        of::transforms(&crane, &q, &mut matrices);
        of::points(&crane, &q, &mut vectors);
        of::point_velocities(&crane, &q, &v, &mut vectors);
        black_box(of::forces(&crane, t, &q, &v));
        black_box(of::support_forces(&crane, &q, &v));
        black_box(of::element_forces(&crane, &q, &v));
        black_box(of::drive_forces(&crane, t, &q, &v));
        black_box(of::joint_damper_forces(&crane, &v));
        black_box(of::stop_forces(&crane, &q, &v));
        black_box(of::friction_forces(&crane, &v));
        black_box(of::load_forces(&crane, t, &q));
        of::load_pieces(&crane, &mut pieces);
        black_box(of::connector_forces(&crane, t, &q, &v));
        of::connector_lengths(&crane, &q, &v, &mut motions);
        of::connector_tensions(&crane, t, &q, &v, &mut tensions);
        of::connector_jacobians(&crane, &q, &mut rows);
        of::winch_pieces(&crane, &mut pieces);
        black_box(of::connector_energy(&crane, t, &q));
        black_box(of::winch_power(&crane, t, &q, &v));
        of::support_reactions(&crane, &q, &v, &mut vectors);
        of::support_gaps(&crane, &q, &v, &mut gaps);
        of::cylinder_states(&crane, &q, &v, &mut vectors);
        of::cylinder_jacobians(&crane, &q, &mut rows);
        of::drive_limits(&crane, t, &q, &v, &mut motions);
        of::drive_motions(&crane, t, &mut motions);
        of::valve_openings(&crane, t, &mut motions);
        of::drive_pieces(&crane, &mut pieces);
        of::prescribe(&crane, t, &mut q, &mut v);
        black_box(of::gravity_energy(&crane, &q));
        black_box(of::support_energy(&crane, &q));
        black_box(of::element_energy(&crane, &q));
        black_box(of::drive_energy(&crane, t, &q));
        black_box(of::stop_energy(&crane, &q));
        black_box(of::potential_energy(&crane, t, &q));
        black_box(of::drive_power(&crane, t, &q, &v));
        black_box(of::load_power(&crane, t, &q, &v));
        black_box(of::dissipation(&crane, t, &q, &v));
        black_box(of::mass_matrix(&crane, &q));
        black_box(of::mass_matrix_and_bias(&crane, &q, &v, &mut mass));
        black_box(of::bias(&crane, &q, &v));
        black_box(of::forward_dynamics(&crane, t, &q, &v));
        black_box(of::solve_mass(&crane, &q, &v));
        black_box(of::kinetic_energy(&crane, &q, &v));
        let factors: <Crane as Implicit<{ of::N }>>::Factors = of::factorise(&crane, &q, &v, &BaseMatrix::zeros());
        black_box(of::solve(&crane, &factors, &v));
        of::joint_stiffness_and_damping(&crane, &mut stiffness_and_damping);
        of::nonlinear_stiffness_and_damping(&crane, t, &q, &v, &mut stiffness_and_damping);
        black_box(of::base_stiffness(&crane, &q, &v));
        black_box(of::base_damping(&crane, &q, &v));
        let positions = black_box(of::drive_positions(&crane, t));
        black_box(of::static_residual(&crane, t, &q, &positions));
        black_box(of::tangent_stiffness(&crane, t, &q, &positions));
        black_box(of::drive_forces_at_rest(&crane, t, &q, &positions));
        black_box(of::linearise(&crane, &q));
        of::internal_forces(&crane, t, &q, &v, &v, &mut wrenches);
        of::cylinder_wrenches(&crane, &q, &mut wrenches);
        of::connector_wrenches(&crane, &q, &mut wrenches);
        of::support_positions(&crane, &q, &mut vectors);
        of::section_moduli(&crane, &mut moduli);
        of::transform_derivatives(&crane, &q, &mut matrices);
        of::transform_second_derivatives(&crane, &q, &mut matrices);
        let lanes = Crane::lanes([&crane; 8]);
        let [lane_q, lane_v] = [&q, &v].map(|x| LaneVector::from_iterator(x.iter().map(|x| splat(*x))));
        black_box(of::lane_forward_dynamics(&lanes, splat(t), &lane_q, &lane_v));
        let mut state = State { q, v };
        black_box(of::step(&crane, t, black_box(1e-4), &mut state));
        black_box((state, matrices, vectors, motions, pieces, stiffness_and_damping, gaps, mass, wrenches, moduli));
    }};
}

fn main() {
    call_all!(eight_link_flexible);
    call_all!(eight_link_hydraulic);
    call_all!(exact);
}
