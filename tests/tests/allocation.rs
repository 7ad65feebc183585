//! No function of a generated crane allocates, including those for eight cranes at once, and neither does any step of a run.

use std::hint::black_box;
use std::ops::ControlFlow;

use crane_model::dyn_crane::{Crane, DynCrane};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector3};
use crane_model::rt::lanes::splat;
use crane_model::{CraneModel, Ensemble, LaneDynamics, SectionModuli, Tension, TransformDerivatives, Wrench};
use crane_specs as cranes;
use crane_tests::exact;

/// Calls every function of the traits at the guess; vectors and matrices stay on the stack, lists go into `places`.
fn every_function<const N: usize>(crane: &mut (impl Crane<N> + TransformDerivatives<N>), places: &mut Places) {
    let (t, q, v) = (0.7, SVector::<f64, N>::from_column_slice(&crane.description().guess), SVector::repeat(0.1));
    let (q, v) = (&q, &v);
    let _ = black_box(crane.set_parameter(0, black_box(crane.parameter(0))));
    crane.transforms(q, &mut places.matrices);
    crane.transform_derivatives(q, &mut places.matrices);
    crane.transform_second_derivatives(q, &mut places.matrices);
    crane.points(q, &mut places.vectors);
    crane.point_velocities(q, v, &mut places.vectors);
    crane.support_reactions(q, v, &mut places.vectors);
    crane.support_positions(q, &mut places.vectors);
    crane.internal_forces(t, q, v, v, &mut places.wrenches);
    crane.section_moduli(&mut places.moduli);
    crane.support_gaps(q, v, &mut places.motions);
    crane.cylinder_states(q, v, &mut places.vectors);
    crane.cylinder_jacobians(q, &mut [[0.0; N]; 6]);
    crane.cylinder_wrenches(q, &mut places.wrenches);
    crane.connector_wrenches(q, &mut places.wrenches);
    crane.drive_limits(t, q, v, &mut places.motions);
    crane.drive_motions(t, &mut places.motions);
    crane.valve_openings(t, &mut places.motions);
    crane.drive_pieces(&mut places.pieces);
    crane.load_pieces(&mut places.pieces);
    crane.connector_lengths(q, v, &mut places.motions);
    crane.connector_tensions(t, q, v, &mut [Tension::ZERO; 6]);
    crane.connector_jacobians(q, &mut [[0.0; N]; 6]);
    crane.winch_pieces(&mut places.pieces);
    black_box(crane.connector_forces(t, q, v));
    black_box((crane.connector_energy(t, q), crane.winch_power(t, q, v)));
    crane.joint_stiffness_and_damping(&mut places.stiffness_and_damping);
    let (mut prescribed_q, mut prescribed_v, mut mass) = (*q, *v, SMatrix::zeros());
    crane.prescribe(t, &mut prescribed_q, &mut prescribed_v);
    black_box(crane.mass_matrix_and_bias(q, v, &mut mass));
    let factors = crane.factorise(q, v, &Matrix6::identity());
    black_box((crane.solve(&factors, v), crane.solve_mass(q, v), crane.forward_dynamics(t, q, v)));
    black_box((
        crane.base_stiffness(q, v),
        crane.base_damping(q, v),
        crane.drive_forces_at_rest(t, q, &crane.drive_positions(t)),
    ));
    let alike: &_ = crane;
    let lanes = Ensemble::lanes([alike; 8]);
    black_box(lanes.forward_dynamics(splat(t), &q.map(splat), &v.map(splat)));
    black_box((prescribed_q, prescribed_v, mass));
    black_box((
        crane.support_forces(q, v),
        crane.element_forces(q, v),
        crane.drive_forces(t, q, v),
        crane.joint_damper_forces(v),
        crane.stop_forces(q, v),
        crane.friction_forces(v),
        crane.load_forces(t, q),
    ));
    black_box((crane.forces(t, q, v), crane.mass_matrix(q), crane.bias(q, v), crane.linearise(q)));
    black_box((crane.static_residual(t, q, v), crane.tangent_stiffness(t, q, v)));
    black_box((crane.gravity_energy(q), crane.support_energy(q), crane.element_energy(q), crane.drive_energy(t, q)));
    black_box((crane.stop_energy(q), crane.load_power(t, q, v)));
    crane.nonlinear_stiffness_and_damping(t, q, v, &mut places.motions);
    black_box((crane.potential_energy(t, q), crane.kinetic_energy(q, v)));
    black_box((crane.drive_power(t, q, v), crane.dissipation(t, q, v)));
}

/// Buffers for lists, allocated before counting begins.
struct Places {
    matrices: Vec<Matrix4<f64>>,
    vectors: Vec<Vector3<f64>>,
    motions: Vec<[f64; 2]>,
    pieces: Vec<[f64; 2]>,
    stiffness_and_damping: Vec<[f64; 2]>,
    wrenches: Vec<Wrench>,
    moduli: Vec<SectionModuli>,
}

impl Places {
    fn of<const N: usize>(crane: &impl CraneModel<N>) -> Self {
        let description = crane.description();
        let degrees = description.bodies.iter().map(|body| body.degrees_of_freedom);
        Self {
            matrices: vec![
                Matrix4::zeros();
                degrees.map(|n| n * (n + 1) / 2).sum::<usize>().max(description.bodies.len())
            ],
            vectors: vec![Vector3::zeros(); description.points.len().max(description.supports.len())],
            motions: vec![[0.0; 2]; description.drives.len()],
            pieces: vec![[0.0; 2]; description.drives.iter().map(|drive| drive.pieces).sum()],
            stiffness_and_damping: vec![[0.0; 2]; N],
            wrenches: vec![Wrench::ZERO; description.cuts().len()],
            moduli: vec![SectionModuli::ZERO; description.sections.len()],
        }
    }
}

macro_rules! every_crane {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                let mut crane = cranes::$name::Crane::default();
                let mut places = Places::of::<{ cranes::$name::N }>(&crane);
                let calls = allocation_counter::measure(|| every_function(&mut crane, &mut places));
                assert_eq!(calls.count_total, 0);
            }
        )*

        #[test]
        fn none_is_missing() {
            let names: Vec<String> = cranes::all().iter().map(|crane| crane.description().name.to_string()).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

every_crane! {
    cantilever double_pendulum eight_link_flexible eight_link_hydraulic eight_link_identified eight_link_rigid eight_link_two_flexible knuckle_boom
    loader_tipping two_arms
}

/// Exact kinematics, rotation vectors, a rigid drive, stops, cylinders, springs and ropes between points.
#[test]
fn exact() {
    let mut crane = exact::Crane::default();
    let mut places = Places::of::<{ exact::N }>(&crane);
    let calls = allocation_counter::measure(|| every_function(&mut crane, &mut places));
    assert_eq!(calls.count_total, 0);
}

/// Memory is allocated once per run: a run four times as long makes as many allocations, whatever the method.
#[test]
fn steps_allocate_nothing() {
    let cranes = [
        crane_model::dyn_crane::boxed::<{ cranes::eight_link_flexible::N }, cranes::eight_link_flexible::Crane>(),
        crane_model::dyn_crane::boxed::<{ cranes::cantilever::N }, cranes::cantilever::Crane>(),
        crane_model::dyn_crane::boxed::<{ cranes::double_pendulum::N }, cranes::double_pendulum::Crane>(),
        crane_model::dyn_crane::boxed::<{ exact::N }, exact::Crane>(),
        // Feet that lift; oil, and joints that stick.
        crane_model::dyn_crane::boxed::<{ cranes::loader_tipping::N }, cranes::loader_tipping::Crane>(),
        crane_model::dyn_crane::boxed::<{ cranes::eight_link_hydraulic::N }, cranes::eight_link_hydraulic::Crane>(),
    ];
    for crane in &cranes {
        let crane: &dyn DynCrane = crane.as_ref();
        let start = InitialState::at_rest(crane.guess());
        for method in Method::ALL {
            let [short, long] = [0.05, 0.2].map(|duration| {
                let defaults = Settings::of(crane.description());
                let settings = Settings { method, duration, step: 2e-5, output: 0.01, audit: true, ..defaults };
                let run = || crane.simulate(&start, &settings, &mut |_| ControlFlow::Continue(()));
                allocation_counter::measure(|| run().map(|_| ()).expect("a stable run")).count_total
            });
            assert_eq!(short, long, "{method}, {}", crane.description().name);
        }
    }
}
