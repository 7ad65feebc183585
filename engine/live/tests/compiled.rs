//! Live cranes against compiled ones: every function, statics, modes, runs and ensembles of all shipped cranes.

mod every;

use std::ops::ControlFlow;

use crane_codegen::build;
use crane_codegen::program::{Count, Extent, FunctionId};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{Arguments, DynCrane, Functions, Instance};
use crane_model::dynamics::{InitialState, Settings, ensemble::Member};
use crane_model::nalgebra::Matrix6;
use crane_model::{ParameterError, modes, statics};
use every::call_every;

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
    crane_shipped::all().into_iter().map(beside).collect()
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

/// Everything that a crane computes at a state, by name.
fn everything(crane: &dyn DynCrane) -> Vec<(&'static str, Vec<f64>)> {
    let (t, q, v) = state(crane);
    let held: Vec<f64> = q.iter().map(|q| 0.95 * q).collect();
    let r: Vec<f64> = v.iter().map(|v| 100.0 * v).collect();
    let n = crane.size();
    let at = Arguments { t, q: &q, v: &v, a: &r, r: &r, positions: &held };
    let mut all = Vec::new();
    call_every(crane, at, &mut |_, call| call(), &mut |id, numbers| all.push((id.name(), numbers)));
    let mut linearisation = vec![f64::NAN; 3 * n * n];
    crane.linearise(&q, &mut linearisation);
    let (mut system, mut solution) = (crane.system(), vec![f64::NAN; n]);
    system.factorise(&q, &vec![3.0; n], Matrix6::from_diagonal_element(5.0).as_slice());
    system.solve(&r, &mut solution);
    all.extend([("prescribed motions", prescribed(crane)), ("solve", solution), ("linearisation", linearisation)]);
    all
}

/// Derivatives of the transforms of both, in that order.
fn assert_same_derivatives(live: &LiveCrane, compiled: &dyn DynCrane) {
    let (_, q, _) = state(live);
    let [live, compiled] = [live as &dyn DynCrane, compiled].map(|crane| {
        [crane.transform_derivatives_at(&q), crane.transform_second_derivatives_at(&q)]
            .map(|matrices| matrices.iter().flatten().copied().collect::<Vec<f64>>())
    });
    for ((what, live), compiled) in ["first derivatives", "second derivatives"].into_iter().zip(&live).zip(&compiled) {
        assert_same(what, live, compiled);
    }
}

/// Derivatives of the dynamics of both, in that order.
fn assert_same_derivatives_of_motion(live: &LiveCrane, compiled: &dyn DynCrane) {
    let (t, q, v) = state(live);
    let n = live.size();
    let of = |crane: &dyn DynCrane| {
        let lengths = [3 * n * crane.count(Count::Points), n, 2 * n * n, 3 * n * n];
        let mut results = lengths.map(|length| vec![f64::NAN; length]);
        let [points, required, slopes, accelerations] = &mut results;
        crane.point_jacobians(&q, points);
        crane.inverse_dynamics(&q, &v, &v, required);
        crane.dynamic_residual_derivatives(t, &q, &v, &v, slopes);
        crane.forward_dynamics_derivatives(t, &q, &v, accelerations);
        results
    };
    let (live_results, compiled_results) = (of(live), of(compiled));
    let name = &live.description().name;
    for (live, compiled) in live_results.iter().zip(&compiled_results).take(3) {
        assert_same(name, live, compiled);
    }
    for (live, compiled) in live_results[3].chunks(n * n).zip(compiled_results[3].chunks(n * n)) {
        let largest = compiled.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        for (live, compiled) in live.iter().zip(compiled) {
            // By the same loops of factors that may differ where the target fuses multiply-adds: rounding, times the condition of A.
            assert!((live - compiled).abs() <= 1e-10 * largest, "{name}: {live} live, {compiled} compiled");
        }
    }
}

#[test]
fn derivatives_give_the_same_bits() {
    macro_rules! check {
        ($($name:ident),*) => {
            $({
                let (live, compiled) = (live(stringify!($name)), crane_shipped::$name::Crane::default());
                assert_same_derivatives(&live, &Instance::<{ crane_shipped::$name::N }, _>(compiled));
                assert_same_derivatives_of_motion(&live, &Instance::<{ crane_shipped::$name::N }, _>(compiled));
            })*
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

/// The lists of compiled cranes, of live cranes and of their descriptions are of one length.
#[test]
fn a_chain_and_its_description_count_the_same_parts() {
    for (compiled, live) in both() {
        for id in FunctionId::ALL {
            let Extent::List(_, count) = id.extent() else { continue };
            let name = &compiled.description().name;
            assert_eq!(compiled.count(count), live.chain().count(count), "{count:?} of {name}");
        }
        assert_eq!(compiled.count(Count::Cuts), compiled.description().cuts().len());
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
        let [expected, equilibrium] = [&*compiled, live].map(|crane| crane.equilibrium(&statics::Settings::default()));
        assert_eq!(equilibrium.status, expected.status);
        assert_close(&equilibrium.q, &expected.q);
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
            let settings = Settings { duration: 10.0, ..Settings::from_description(crane.description()) };
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
                ..Settings::from_description(description)
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
