//! Live cranes against compiled ones: every function, statics, modes, runs and ensembles of all shipped cranes.

use std::ops::ControlFlow;

use crane_codegen::build;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, DynDerivatives, DynModel, Instance};
use crane_model::dynamics::{InitialState, Settings, ensemble::Member};
use crane_model::nalgebra::{Matrix4, Matrix6, Vector3};
use crane_model::{ParameterError, SectionModuli};
use crane_model::{modes, statics};

/// Whether a product and a sum round once: a loop of compiled code may then fuse other pairs than bytecode does.
const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

fn live(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

/// Every shipped crane, compiled and live.
fn both() -> Vec<(Box<dyn DynCrane>, LiveCrane)> {
    let beside = |compiled: Box<dyn DynCrane>| {
        let live = live(&compiled.description().name);
        (compiled, live)
    };
    crane_specs::all().into_iter().map(beside).collect()
}

/// A pose near the guess, rates, and a time at which drives move.
fn state(crane: &dyn DynCrane) -> (f64, Vec<f64>, Vec<f64>) {
    let wave = |scale: f64, rate: f64| move |i: usize| scale * (rate * (i as f64 + 1.0)).sin();
    let n = crane.size();
    let q = crane.guess().iter().zip((0..n).map(wave(0.03, 1.3))).map(|(guess, wave)| guess + wave).collect();
    (0.7, q, (0..n).map(wave(0.4, 0.7)).collect())
}

/// Equal, except for the sign of a zero; where products are fused, to rounding.
fn assert_same(what: &str, live: &[f64], compiled: &[f64]) {
    assert_eq!(live.len(), compiled.len(), "{what}");
    let largest = compiled.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let allowed = if FUSES { 1e-11 * largest } else { 0.0 };
    for (live, compiled) in live.iter().zip(compiled) {
        assert!((live - compiled).abs() <= allowed, "{what}: {live} live, {compiled} compiled");
    }
}

/// `count` numbers that a function writes into a list with other contents.
fn numbers(count: usize, write: impl FnOnce(&mut [f64])) -> Vec<f64> {
    let mut out = vec![f64::NAN; count];
    write(&mut out);
    out
}

fn vectors(count: usize, write: impl FnOnce(&mut [Vector3<f64>])) -> Vec<f64> {
    let mut out = vec![Vector3::repeat(f64::NAN); count];
    write(&mut out);
    out.iter().flatten().copied().collect()
}

fn matrices(count: usize, write: impl FnOnce(&mut [Matrix4<f64>])) -> Vec<f64> {
    let mut out = vec![Matrix4::repeat(f64::NAN); count];
    write(&mut out);
    out.iter().flatten().copied().collect()
}

fn pairs(count: usize, write: impl FnOnce(&mut [[f64; 2]])) -> Vec<f64> {
    let mut out = vec![[f64::NAN; 2]; count];
    write(&mut out);
    out.into_flattened()
}

fn wrenches(crane: &dyn DynCrane, t: f64, [q, v, a]: [&[f64]; 3]) -> Vec<f64> {
    let wrenches = crane.internal_forces_at(t, q, v, a);
    wrenches.iter().flat_map(|wrench| wrench.force.iter().chain(&wrench.moment).copied().collect::<Vec<_>>()).collect()
}

fn moduli(crane: &dyn DynCrane) -> Vec<f64> {
    let numbers = |of: &SectionModuli| {
        let SectionModuli { area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress } = *of;
        [area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress]
    };
    crane.section_moduli_at().iter().flat_map(numbers).collect()
}

fn tensions(crane: &dyn DynCrane, t: f64, [q, v]: [&[f64]; 2]) -> Vec<f64> {
    let tensions = crane.connector_tensions_at(t, q, v);
    tensions.iter().flat_map(|tension| [tension.force, tension.stiffness, tension.damping]).collect()
}

/// Everything that a crane computes at a state, by name.
fn everything(crane: &dyn DynCrane) -> Vec<(&'static str, Vec<f64>)> {
    let (t, q, v) = state(crane);
    let held: Vec<f64> = q.iter().map(|q| 0.95 * q).collect();
    let (q, v) = (&q[..], &v[..]);
    let description = crane.description();
    let n = crane.size();
    let degrees: Vec<usize> = description.bodies.iter().map(|body| body.degrees_of_freedom).collect();
    let pieces = description.drives.iter().map(|drive| drive.pieces).sum();
    let connectors = &description.connectors;
    let of_winches = connectors.iter().map(|connector| connector.pieces).sum();
    let of_loads = description.loads.iter().map(|load| load.pieces).sum();
    let (mut mass, mut stiffness, mut damping) = (vec![f64::NAN; n * n], vec![f64::NAN; n * n], vec![f64::NAN; n * n]);
    crane.linearise(q, &mut mass, &mut stiffness, &mut damping);
    let mut system = crane.system();
    let r: Vec<f64> = v.iter().map(|v| 100.0 * v).collect();
    system.factorise(q, &vec![3.0; n], &Matrix6::from_diagonal_element(5.0));
    vec![
        ("transforms", matrices(degrees.len(), |out| crane.transforms(q, out))),
        ("points", vectors(description.points.len(), |out| crane.points(q, out))),
        ("point_velocities", vectors(description.points.len(), |out| crane.point_velocities(q, v, out))),
        ("forces", numbers(n, |out| crane.forces(t, q, v, out))),
        ("element_forces", numbers(n, |out| crane.element_forces(q, v, out))),
        ("drive_forces", numbers(n, |out| crane.drive_forces(t, q, v, out))),
        ("stop_forces", numbers(n, |out| crane.stop_forces(q, v, out))),
        ("friction_forces", numbers(n, |out| crane.friction_forces(v, out))),
        ("load_forces", numbers(n, |out| crane.load_forces(t, q, out))),
        ("load_power", vec![crane.load_power(t, q, v)]),
        ("stop_energy", vec![crane.stop_energy(q)]),
        ("support_reactions", vectors(description.supports.len(), |out| crane.support_reactions(q, v, out))),
        ("support_gaps", pairs(description.supports.len(), |out| crane.support_gaps(q, v, out))),
        ("cylinder_states", vectors(description.cylinders.len(), |out| crane.cylinder_states(q, v, out))),
        ("cylinder_jacobians", numbers(n * description.cylinders.len(), |out| crane.cylinder_jacobians(q, out))),
        ("drive_limits", pairs(description.drives.len(), |out| crane.drive_limits(t, q, v, out))),
        ("drive_motions", pairs(description.drives.len(), |out| crane.drive_motions(t, out))),
        ("valve_openings", pairs(description.drives.len(), |out| crane.valve_openings(t, out))),
        ("drive_forces_at_rest", numbers(n, |out| crane.drive_forces_at_rest(t, q, &held, out))),
        ("drive_pieces", pairs(pieces, |out| crane.drive_pieces(out))),
        ("connector_forces", numbers(n, |out| crane.connector_forces(t, q, v, out))),
        ("connector_lengths", pairs(connectors.len(), |out| crane.connector_lengths(q, v, out))),
        ("connector_tensions", tensions(crane, t, [q, v])),
        ("connector_jacobians", numbers(n * connectors.len(), |out| crane.connector_jacobians(q, out))),
        ("connector_energy", vec![crane.connector_energy(t, q), crane.winch_power(t, q, v)]),
        ("winch_pieces", pairs(of_winches, |out| crane.winch_pieces(out))),
        ("load_pieces", pairs(of_loads, |out| crane.load_pieces(out))),
        ("energies", vec![crane.gravity_energy(q), crane.support_energy(q), crane.element_energy(q)]),
        ("drive_energy", vec![crane.drive_energy(t, q)]),
        ("powers", vec![crane.drive_power(t, q, v), crane.dissipation(t, q, v)]),
        ("prescribed motions", prescribed(crane)),
        ("solve_mass", numbers(n, |out| crane.solve_mass(q, &r, out))),
        ("static_residual", numbers(n, |out| crane.static_residual(t, q, &held, out))),
        ("tangent_stiffness", numbers(n * n, |out| crane.tangent_stiffness(t, q, &held, out))),
        ("mass_matrix", numbers(n * n, |out| crane.mass_matrix(q, out))),
        ("bias", numbers(n, |out| crane.bias(q, v, out))),
        ("forward_dynamics", numbers(n, |out| crane.forward_dynamics(t, q, v, out))),
        ("kinetic_energy", vec![crane.kinetic_energy(q, v)]),
        ("solve", numbers(n, |out| system.solve(&r, out))),
        ("joint_stiffness_and_damping", pairs(n, |out| crane.joint_stiffness_and_damping(out))),
        ("nonlinear_stiffness_and_damping", pairs(n, |out| crane.nonlinear_stiffness_and_damping(t, q, v, out))),
        ("base_stiffness", crane.base_stiffness(q, v).as_slice().to_vec()),
        ("base_damping", crane.base_damping(q, v).as_slice().to_vec()),
        ("linearised mass", mass),
        ("linearised stiffness", stiffness),
        ("linearised damping", damping),
        ("internal_forces", wrenches(crane, t, [q, v, &r])),
        ("section_moduli", moduli(crane)),
        ("support_positions", vectors(description.supports.len(), |out| crane.support_positions(q, out))),
    ]
}

/// Derivatives of the transforms of both, in that order.
fn assert_same_derivatives(live: &LiveCrane, compiled: &dyn DynDerivatives) {
    let (_, q, _) = state(live);
    let [live, compiled] = [live as &dyn DynDerivatives, compiled].map(|crane| {
        [crane.transform_derivatives_at(&q), crane.transform_second_derivatives_at(&q)]
            .map(|matrices| matrices.iter().flatten().copied().collect::<Vec<f64>>())
    });
    for ((what, live), compiled) in ["first derivatives", "second derivatives"].into_iter().zip(&live).zip(&compiled) {
        assert_same(what, live, compiled);
    }
}

#[test]
fn derivatives_give_the_same_bits() {
    macro_rules! check {
        ($($name:ident),*) => {
            $(assert_same_derivatives(&live(stringify!($name)), &Instance::<{ crane_specs::$name::N }, _>(&crane_specs::$name::Crane::default()));)*
        };
    }
    check!(
        cantilever,
        double_pendulum,
        eight_link_flexible,
        eight_link_hydraulic,
        eight_link_identified,
        eight_link_rigid,
        eight_link_two_flexible,
        knuckle_boom
    );
}

/// Pose and rates with the prescribed motions.
fn prescribed(crane: &dyn DynCrane) -> Vec<f64> {
    let (t, mut q, mut v) = state(crane);
    crane.prescribe(t, &mut q, &mut v);
    [q, v].concat()
}

#[test]
fn live_and_compiled_descriptions_are_equal() {
    for (compiled, live) in both() {
        let live: &dyn DynCrane = &live;
        assert_eq!(live.description(), compiled.description());
    }
}

#[test]
fn every_function_gives_the_same_bits() {
    for (compiled, live) in both() {
        for ((what, of_live), (_, of_compiled)) in everything(&live).into_iter().zip(everything(&*compiled)) {
            assert_same(&format!("{} {what}", compiled.description().name), &of_live, &of_compiled);
        }
    }
}

/// Constants computed from parameters follow them, and clones have their own.
#[test]
fn live_parameters_count() {
    for (mut compiled, live) in both() {
        let (mut changed, before) = (live.clone(), everything(&live));
        everything(&changed);
        for index in 0..compiled.description().parameters.len() {
            let value = 1.01 * compiled.parameter(index);
            compiled.set_parameter(index, value).unwrap();
            changed.set_parameter(index, value).unwrap();
        }
        let both = everything(&changed).into_iter().zip(everything(&*compiled));
        for ((what, of_changed), (_, of_compiled)) in both {
            assert_same(&format!("{} {what}", compiled.description().name), &of_changed, &of_compiled);
        }
        assert_eq!(everything(&live), before);
    }
}

/// A wrong value is refused with the message of the spec language, and the crane stays unchanged.
#[test]
fn parameters_keep_the_rules() {
    for (mut compiled, mut live) in both() {
        for index in 0..compiled.description().parameters.len() {
            for value in [f64::NAN, -1e30, -1.0] {
                let [expected, found] = [compiled.set_parameter(index, value), live.set_parameter(index, value)];
                let words = |set: Result<(), ParameterError>| set.map_err(|error| error.to_string());
                assert_eq!(words(found), words(expected));
                assert_eq!(live.parameter(index), compiled.parameter(index));
            }
        }
    }
}

/// To 1e-10 of the largest value; on targets without fused operations the same bits.
#[test]
fn statics_and_modes_agree() {
    for (compiled, live) in both().into_iter().filter(|(compiled, _)| compiled.description().statics) {
        let live: &dyn DynCrane = &live;
        let [expected, found] = [&*compiled, live].map(|crane| crane.equilibrium(&statics::Settings::default()));
        assert_eq!(found.status, expected.status);
        assert_close(&found.q, &expected.q);
        let frequencies = |crane: &dyn DynCrane| -> Vec<f64> {
            let modes = modes::undamped(&crane.small_motions_at(&expected.q)).unwrap();
            modes.iter().map(|mode| mode.frequency().unwrap()).collect()
        };
        assert_close(&frequencies(live), &frequencies(&*compiled));
    }
}

fn assert_close(live: &[f64], compiled: &[f64]) {
    let largest = compiled.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    for (live, compiled) in live.iter().zip(compiled) {
        assert!((live - compiled).abs() <= 1e-10 * largest, "{live} live, {compiled} compiled");
    }
}

/// Ten seconds by the default method, from the guess.
#[test]
fn a_run_of_ten_seconds_agrees() {
    for (compiled, live) in both() {
        // Chaotic: two runs that differ in a last digit diverge.
        if compiled.description().name == "double_pendulum" {
            continue;
        }
        let [expected, found] = [&*compiled, &live as &dyn DynCrane].map(|crane| {
            let settings = Settings { duration: 10.0, ..Settings::of(crane.description()) };
            let mut last = vec![];
            let mut observe = |sample: &crane_model::dynamics::Sample<'_>| {
                last = [sample.q, sample.v].concat();
                ControlFlow::Continue(())
            };
            crane.simulate(&InitialState::at_rest(crane.guess()), &settings, &mut observe).unwrap();
            last
        });
        assert_close(&found, &expected);
    }
}

/// Members with different parameters, in blocks of eight.
#[test]
fn ensembles_agree() {
    // Ensembles in lanes do not support states of forces.
    for (compiled, live) in both().into_iter().filter(|(_, live)| !live.description().has_force_states()) {
        let member = |factor: f64| {
            let parameters = compiled.description().parameters.iter().map(|info| info.default * factor).collect();
            Member { parameters, start: InitialState::at_rest(compiled.guess()) }
        };
        let members: Vec<Member> = (0..10).map(|k| member(1.0 + 0.01 * f64::from(k))).collect();
        let [expected, found] = [&*compiled, &live as &dyn DynCrane].map(|crane| {
            let description = crane.description();
            let settings = Settings {
                duration: 20.0 * description.step,
                output: 20.0 * description.step,
                ..Settings::of(description)
            };
            let mut last = vec![vec![]; members.len()];
            let mut observe =
                |member: usize, sample: &crane_model::dynamics::Sample<'_>| last[member] = sample.v.to_vec();
            let runs = crane.simulate_ensemble(&members, &settings, &mut observe).unwrap();
            assert!(runs.iter().all(Result::is_ok));
            last
        });
        for (found, expected) in found.iter().zip(&expected) {
            assert_close(found, expected);
        }
    }
}
