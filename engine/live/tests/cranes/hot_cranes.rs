//! Cranes whose functions became machine code while they were called: on several threads, in clones, with other parameters.

use crane_codegen::build;
use crane_codegen::program::FunctionId;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::rt::lanes::f64x8;

/// Calls after which a function is surely machine code, where there is any.
const CALLS: usize = 1200;

fn crane() -> LiveCrane {
    let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

/// The crane with its first parameter times a factor.
fn with_parameter(mut crane: LiveCrane, factor: f64) -> LiveCrane {
    let value = crane.parameters()[0] * factor;
    crane.set_parameter(0, value).unwrap();
    crane
}

/// Accelerations at a rate of all coordinates.
fn accelerations(crane: &LiveCrane, rate: f64) -> Vec<f64> {
    let n = crane.size();
    let mut out = vec![f64::NAN; n];
    crane.forward_dynamics(0.1, &crane.chain().guess, &vec![rate; n], &mut out);
    out
}

fn rate(call: usize) -> f64 {
    0.1 + 1e-3 * (call % 7) as f64
}

/// Several threads call a function that becomes machine code meanwhile: clones with parameters of their own, and one crane.
#[test]
fn threads_and_clones_agree_with_bytecode() {
    let crane = crane();
    let factors: Vec<f64> = (0..4).map(|thread| 1.0 + 0.01 * f64::from(thread)).collect();
    // Seven calls are far from the machine code.
    let expected: Vec<Vec<Vec<f64>>> = factors
        .iter()
        .map(|factor| {
            let crane = with_parameter(self::crane(), *factor);
            (0..7).map(|call| accelerations(&crane, rate(call))).collect()
        })
        .collect();
    assert_ne!(expected[0], expected[1], "the parameter matters");
    std::thread::scope(|scope| {
        for (factor, expected) in factors.iter().zip(&expected) {
            let clone = with_parameter(crane.clone(), *factor);
            scope.spawn(move || {
                for call in 0..CALLS {
                    assert_eq!(accelerations(&clone, rate(call)), expected[call % 7], "call {call}, {factor}");
                }
            });
        }
        for _ in 0..2 {
            scope.spawn(|| {
                for call in 0..CALLS {
                    assert_eq!(accelerations(&crane, rate(call)), expected[0][call % 7], "call {call}");
                }
            });
        }
    });
}

#[test]
fn machine_code_follows_parameters() {
    let mut crane = crane();
    let compiles = crane.compile(FunctionId::ForwardDynamics);
    println!("machine code: {compiles}");
    for factor in [1.0, 1.02, 0.97] {
        let fresh = with_parameter(self::crane(), factor);
        crane.set_parameter(0, fresh.parameters()[0]).unwrap();
        assert_eq!(accelerations(&crane, 0.1), accelerations(&fresh, 0.1), "{factor}");
    }
}

/// Lanes with parameters of their own are the cranes with these, before and after there is machine code for eight.
#[test]
fn lanes_are_the_cranes_one_by_one() {
    let crane = crane();
    let cranes: Vec<LiveCrane> =
        (0..8).map(|lane| with_parameter(self::crane(), 1.0 + 1e-3 * f64::from(lane))).collect();
    let expected: Vec<Vec<f64>> = cranes.iter().map(|crane| accelerations(crane, 0.1)).collect();
    let parameters: Vec<&[f64]> = cranes.iter().map(LiveCrane::parameters).collect();
    let mut block = crane.block(&parameters).unwrap();
    let spread = |numbers: &[f64]| -> Vec<f64x8> { numbers.iter().map(|x| f64x8::splat(*x)).collect() };
    let (q, v) = (spread(&crane.chain().guess), spread(&vec![0.1; crane.size()]));
    let mut out = v.clone();
    for call in 0..CALLS / 4 {
        out.fill(f64x8::splat(f64::NAN));
        block.forward_dynamics(0.1, &q, &v, &mut out);
        for (lane, expected) in expected.iter().enumerate() {
            let computed = out.iter().map(|eight| eight.as_array()[lane]);
            assert!(computed.eq(expected.iter().copied()), "call {call}, lane {lane}");
        }
    }
}
