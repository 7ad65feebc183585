//! A call in a loop allocates nothing, and a dropped crane leaves no memory allocated.

mod every;

use crane_codegen::build;
use crane_codegen::program::FunctionId;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{Arguments, DynCrane, Functions};
use crane_model::nalgebra::Matrix6;
use crane_model::rt::lanes::f64x8;
use every::call_every;

fn crane() -> LiveCrane {
    let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

#[test]
fn a_second_call_allocates_nothing() {
    let crane = crane();
    let n = crane.size();
    let (q, v) = (crane.chain().guess.clone(), vec![0.1; n]);
    let at = Arguments { t: 0.1, q: &q, v: &v, a: &v, r: &v, positions: &q };
    let mut of_second = |id: FunctionId, call: &mut dyn FnMut()| {
        call();
        assert_eq!(allocation_counter::measure(&mut *call).count_total, 0, "{}", id.name());
        // Machine code has a frame of its own, from its first call on.
        crane.compile(id);
        call();
        assert_eq!(allocation_counter::measure(call).count_total, 0, "machine code of {}", id.name());
    };
    call_every(&crane, at, &mut of_second, &mut |_, _| {});
    let mut numbers = vec![0.0; 3 * n * n];
    for (id, matrices) in [
        (FunctionId::Linearise, 3),
        (FunctionId::InverseMassMatrix, 1),
        (FunctionId::DynamicResidualDerivatives, 2),
        (FunctionId::ForwardDynamicsDerivatives, 3),
    ] {
        of_second(id, &mut || {
            crane.call(id, &at, &mut numbers[..matrices * n * n]);
        });
    }

    let mut out = vec![0.0; n];
    let mut system = crane.system();
    let mut block = crane.block(&[]).unwrap();
    let lanes = |x: &[f64]| -> Vec<f64x8> { x.iter().map(|x| f64x8::splat(*x)).collect() };
    let (q8, v8, mut out8) = (lanes(&q), lanes(&v), lanes(&out));
    let mut calls = || {
        system.factorise(&q, &v, Matrix6::identity().as_slice());
        system.solve(&v, &mut out);
        block.forward_dynamics(0.1, &q8, &v8, &mut out8);
    };
    calls();
    assert_eq!(allocation_counter::measure(calls).count_total, 0);
}

#[test]
fn a_crane_leaves_nothing_behind() {
    let used = || {
        let crane = crane();
        let mut out = vec![0.0; crane.size()];
        crane.forward_dynamics(0.1, &crane.chain().guess, &out.clone(), &mut out);
        drop(crane.clone());
    };
    // The first call allocates what libraries keep for the life of the process.
    used();
    let counted = allocation_counter::measure(used);
    assert!(counted.count_total > 0);
    assert_eq!((counted.count_current, counted.bytes_current), (0, 0));
}
