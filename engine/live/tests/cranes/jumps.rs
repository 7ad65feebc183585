//! Motions whose accelerations jump, against closed forms.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Sample, Settings};

/// Mass, kg, and angular frequency of the oscillator, rad/s.
const MASS: f64 = 8.0;
const OMEGA: f64 = 5.0;
const METHODS: [Method; 4] = [Method::Rk4, Method::DormandPrince, Method::Rosenbrock, Method::Bdf];

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("jumps.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A mass on a spring on a cart.
fn oscillator(cart: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: oscillator\ngravity: [0, 0, 0]\nlinks:\n\
         - {{name: cart, joint: {{prismatic: {{axis: x}}}}, mass: 3, com: [0, 0, 0]}}\n\
         - {{name: load, joint: {{prismatic: {{axis: x}}}}, mass: {MASS}, com: [0, 0, 0]}}\n\
         drives:\n- {{coordinate: cart_x, {cart}}}\n\
         - {{coordinate: load_x, stiffness: {}, motion: {{hold: 0}}}}\n",
        MASS * OMEGA * OMEGA
    ))
}

/// Position and rate of an oscillator after a while at a constant acceleration a of its cart:
/// `ÿ + ω² y = −a`.
fn after([y, v]: [f64; 2], a: f64, while_: f64) -> [f64; 2] {
    let (sin, cos) = (OMEGA * while_).sin_cos();
    let rest = -a / (OMEGA * OMEGA);
    [rest + (y - rest) * cos + v / OMEGA * sin, v * cos - (y - rest) * OMEGA * sin]
}

/// The same at a time, with the accelerations from each time on.
fn at(t: f64, accelerations: &[(f64, f64)]) -> [f64; 2] {
    let mut state = [0.0; 2];
    for (index, (begin, a)) in accelerations.iter().enumerate() {
        let end = accelerations.get(index + 1).map_or(f64::INFINITY, |next| next.0);
        if t > *begin {
            state = after(state, *a, t.min(end) - begin);
        }
    }
    state
}

/// Greatest errors of positions, and of rates relative to the frequency, of all results.
fn error(crane: &LiveCrane, settings: &Settings, expected: &dyn Fn(f64) -> [f64; 2]) -> f64 {
    let crane: &dyn DynCrane = crane;
    let start = InitialState { q: vec![0.0; 2], v: vec![0.0; 2], ..InitialState::default() };
    let mut greatest: f64 = 0.0;
    let run = crane.simulate(&start, settings, &mut |sample: &Sample<'_>| {
        let [y, v] = expected(sample.t);
        greatest = greatest.max((sample.q[1] - y).abs()).max((sample.v[1] - v).abs() / OMEGA);
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{}: {stopped}", settings.method));
    greatest
}

/// A cart that accelerates evenly, moves on and brakes: what its load does between and right before the jumps is exact up to the tolerance.
#[test]
fn results_before_a_jump_know_nothing_of_it() {
    // A quarter of the time to accelerate.
    let (begin, duration, way, blend) = (0.33, 1.7, 1.3, 0.25);
    let blending = blend * duration;
    let a = way / (blending * (duration - blending));
    let end = begin + duration;
    let crane = oscillator(&format!(
        "rigid: true, motion: {{trapezoid: {{from: 0, to: {way}, begin: {begin}, duration: {duration}, blend: {blend}}}}}"
    ));
    let jumps = [(begin, a), (begin + blending, 0.0), (end - blending, -a), (end, 0.0)];
    for method in METHODS {
        let settings = Settings {
            method,
            tolerance: 1e-7,
            duration: 2.6,
            output: 0.0017,
            step: 1e-3,
            ..Settings::from_description(crane.description())
        };
        let error = error(&crane, &settings, &|t| at(t, &jumps));
        // rk4's own error is 1e-10, that of the others some times the tolerance.
        assert!(error < if method == Method::Rk4 { 1e-9 } else { 2e-6 }, "{method}: {error:e}");
    }
}

/// The classical method has order 4 across jumps.
#[test]
fn rk4_has_order_four_across_jumps() {
    let (begin, duration, way) = (0.25, 1.5, 1.0);
    let cart = format!(
        "rigid: true, motion: {{trapezoid: {{from: 0, to: {way}, begin: {begin}, duration: {duration}, blend: 0.5}}}}"
    );
    let a = way / (0.5 * duration * 0.5 * duration);
    let jumps = [(begin, a), (begin + 0.5 * duration, -a), (begin + duration, 0.0)];
    let crane = oscillator(&cart);
    let errors = [0.05, 0.025].map(|step| {
        let settings = Settings {
            method: Method::Rk4,
            step,
            duration: 2.5,
            output: 0.25,
            ..Settings::from_description(crane.description())
        };
        error(&crane, &settings, &|t| at(t, &jumps))
    });
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 4.0).abs() < 0.2, "{order}: {errors:?}");
}
