//! No function of a generated crane allocates, including those for eight cranes at once, and neither does any step of a run.

use crane_model::statics::Problem;
use std::hint::black_box;
use std::ops::ControlFlow;

use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::nalgebra::{Matrix6, SMatrix, SVector};
use crane_model::rt::lanes::splat;
use crane_model::{CraneModel, LaneDynamics};
use crane_shipped as cranes;
use crane_tests::exact;
use crane_tests::quantities::{At, Lists, call_every};

/// Calls every function of the traits at the guess; lists go into `lists`.
fn every_function<const N: usize>(crane: &mut impl CraneModel<N>, (q, lists): (&SVector<f64, N>, &mut Lists<N>)) {
    let (t, v) = (0.7, &SVector::repeat(0.1));
    let _ = black_box(crane.set_parameter(0, black_box(crane.parameter(0))));
    let at = At { t, q, v, a: v, r: v, positions: &crane.drive_positions(t) };
    call_every(crane, &at, lists, &mut |_, numbers| {
        for number in numbers {
            black_box(number);
        }
    });
    let (mut prescribed_q, mut prescribed_v, mut mass) = (*q, *v, SMatrix::zeros());
    crane.prescribe(t, &mut prescribed_q, &mut prescribed_v);
    black_box(crane.mass_matrix_and_bias(q, v, &mut mass));
    let factors = crane.factorise(q, v, &Matrix6::identity());
    black_box((crane.solve(&factors, v), crane.linearise(q), crane.potential_energy(t, q)));
    let alike: &_ = crane;
    let lanes = CraneModel::lanes([alike; 8]);
    black_box(lanes.forward_dynamics(splat(t), &q.map(splat), &v.map(splat)));
    black_box((prescribed_q, prescribed_v, mass));
}

macro_rules! every_crane {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                let mut crane = cranes::$name::Crane::default();
                let mut lists = Lists::<{ cranes::$name::N }>::new(&crane);
                let guess = SVector::from_vec(Problem::new(&crane).guess());
                let calls = allocation_counter::measure(|| every_function(&mut crane, (&guess, &mut lists)));
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
    let mut lists = Lists::<{ exact::N }>::new(&crane);
    let guess = SVector::from_vec(Problem::new(&crane).guess());
    let calls = allocation_counter::measure(|| every_function(&mut crane, (&guess, &mut lists)));
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
                let defaults = Settings::from_description(crane.description());
                let settings = Settings { method, duration, step: 2e-5, output: 0.01, audit: true, ..defaults };
                let run = || crane.simulate(&start, &settings, &mut |_| ControlFlow::Continue(()));
                allocation_counter::measure(|| run().map(|_| ()).expect("a stable run")).count_total
            });
            assert_eq!(short, long, "{method}, {}", crane.description().name);
        }
    }
}
