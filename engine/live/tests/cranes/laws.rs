//! Forces in joints against exact laws: a slide of 2 kg, without weight, and what stops or slows it.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings, Statistics};

const MASS: f64 = 2.0;

/// The slide, with additional keys.
fn slide(more: &str) -> LiveCrane {
    let text = format!(
        "format: 1\nname: slide\ngravity: [0, 0, 0]\n\
         links: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: {MASS}, com: [0, 0, 0]}}]\n{more}"
    );
    LiveCrane::from_spec(&SourceFile::new("slide.yaml", &text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Time, position and rate of a run from q = 0 at the rate v, every millisecond; its energy balances.
fn run_states(crane: &LiveCrane, method: Method, tolerance: f64, duration: f64, v: f64) -> Vec<[f64; 3]> {
    run_counted(crane, method, tolerance, duration, v).0
}

/// The same, and the number of its steps.
fn run_counted(
    crane: &LiveCrane,
    method: Method,
    tolerance: f64,
    duration: f64,
    v: f64,
) -> (Vec<[f64; 3]>, Statistics) {
    let crane: &dyn DynCrane = crane;
    let defaults = Settings::from_description(crane.description());
    let settings = Settings { method, tolerance, duration, output: 1e-3, step: 1e-5, audit: true, ..defaults };
    let start = InitialState { q: vec![0.0], v: vec![v], ..InitialState::default() };
    let energy = |sample: &Sample<'_>| crane.energies_at(sample.t, sample.q, sample.v).total();
    let mut samples = Vec::new();
    let run = crane.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
        samples.push([sample.t, sample.q[0], sample.v[0]]);
        // Of at most 1 J. Error control does not include the integrals.
        let balance = energy(sample) + sample.dissipated - sample.work - 0.5 * MASS * v * v;
        assert!(balance.abs() < 5e-5 + 1e3 * tolerance, "{method:?} at {}: {balance} J", sample.t);
        ControlFlow::Continue(())
    });
    let run = run.unwrap_or_else(|stopped| panic!("{method:?}: {stopped}"));
    (samples, run.statistics)
}

/// Against an undamped stop a mass swings for half a period: it leaves with the speed it came with, π √(m/k) later.
#[test]
fn a_stop_gives_back_the_speed() {
    let (at, stiffness) = (0.1, 8e4);
    let crane = slide(&format!("stops: {{slide_x: {{max: {at}, stiffness: {stiffness}}}}}\n"));
    let contact = PI * (MASS / stiffness).sqrt();
    for method in Method::ALL {
        let samples = run_states(&crane, method, 1e-9, 0.5, 1.0);
        let [t, q, v] = samples[samples.len() - 1];
        // Adaptive steps end at the stop; a constant step of 1e-5 s that meets it is of order 2, with (k/m) h²/2 = 2e-6 of the speed.
        let allowed = if method.is_adaptive() { 2e-7 } else { 4e-6 };
        assert!((v + 1.0).abs() < allowed, "{method:?}: leaves with {v} m/s");
        let expected = at - (t - at - contact);
        assert!((q - expected).abs() < allowed, "{method:?}: {q} m for {expected}");
        assert!(samples.iter().all(|[_, q, _]| *q < at + 1.01 * (MASS / stiffness).sqrt()));
    }
}

/// Adaptive steps end where a contact begins and where it ends: the error of a run across both is in proportion to the tolerance, and as many
/// steps are rejected at any tolerance. Steps that shrink until the contact fits into one of them are rejected up to 35 times at 1e-10.
#[test]
fn steps_end_at_contacts() {
    let (at, stiffness) = (0.1, 8e4);
    let crane = slide(&format!("stops: {{slide_x: {{max: {at}, stiffness: {stiffness}}}}}\n"));
    let contact = PI * (MASS / stiffness).sqrt();
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (samples, statistics) = run_counted(&crane, method, tolerance, 0.5, 1.0);
            let [t, q, v] = samples[samples.len() - 1];
            let error = (q - (at - (t - at - contact))).abs().max((v + 1.0).abs());
            println!("{method} {tolerance:e}: {:.1} of it, {statistics:?}", error / tolerance);
            // Rates count a fifth; what adds up over the steps is up to 170 for the explicit pair.
            assert!(error < 250.0 * tolerance, "{method} {tolerance:e}: {:.1} of it", error / tolerance);
            assert!(statistics.rejections <= 12, "{method} {tolerance:e}: {statistics:?}");
        }
    }
}

/// A damped stop keeps part of the speed: with Hunt and Crossley's law and a linear spring, e solves
/// `a v (1 + e) = ln((1 + a v)/(1 − a e v))`, and the expansion of `1 − e` begins with `2av/3`.
#[test]
fn a_damped_stop_keeps_what_hunt_and_crossley_say() {
    for damping in [0.01, 0.1, 0.5] {
        let crane = slide(&format!("stops: {{slide_x: {{max: 0.1, stiffness: 8e4, damping: {damping}}}}}\n"));
        let samples = run_states(&crane, Method::Bdf, 1e-9, 0.3, 1.0);
        let value = -samples[samples.len() - 1][2];
        let law = |e: f64| damping * (1.0 + e) - ((1.0 + damping) / (1.0 - damping * e)).ln();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            (low, high) = if law(middle) > 0.0 { (middle, high) } else { (low, middle) };
        }
        assert!((value - low).abs() < 1e-5, "a = {damping}: {value} for {low}");
        assert!((1.0 - value - 2.0 / 3.0 * damping).abs() < damping * damping, "a = {damping}: {value}");
    }
}

/// A sliding mass comes to rest after a distance of `m v²/2F_c`, plus creep: with `F_c tanh(v/v₀)` the distance is longer by
/// `m v₀² π²/12 F_c` (from `∫ v dv/tanh(v/v₀)`), which tends to zero with the square of the width v₀.
#[test]
fn a_sliding_mass_stops_where_coulomb_says() {
    let force = 5.0;
    for width in [0.1, 1e-2, 1e-3] {
        let crane = slide(&format!("friction: {{slide_x: {{coulomb: {force}, width: {width}}}}}\n"));
        for method in [Method::Bdf, Method::Rosenbrock] {
            let samples = run_states(&crane, method, 1e-8, 1.5, 1.0);
            let [_, q, v] = samples[samples.len() - 1];
            let expected = MASS / (2.0 * force) * (1.0 + width * width * PI * PI / 6.0);
            assert!(v.abs() < 1e-2 * width, "{method:?}, {width}: {v} m/s");
            assert!((q - expected).abs() < 1e-5, "{method:?}, {width}: {q} m for {expected}");
        }
    }
}

/// Breaking away takes more force: pulled slowly by a spring, a mass sticks until the spring force reaches `breakaway`, then slips.
/// Compared with a second implementation of the laws with steps of 1e-5 s, a third of the largest explicit step while it sticks.
#[test]
fn a_mass_sticks_and_slips() {
    let (coulomb, breakaway, stribeck, width, stiffness, rate) = (4.0, 6.0, 0.02, 1e-4, 100.0, 0.02);
    let crane = slide(&format!(
        "friction: {{slide_x: {{coulomb: {coulomb}, breakaway: {breakaway}, stribeck: {stribeck}, width: {width}}}}}\n\
         drives: [{{coordinate: slide_x, stiffness: {stiffness}, motion: {{speed: {{rate: {rate}}}}}}}]\n",
    ));
    let samples = run_states(&crane, Method::Bdf, 1e-8, 4.0, 0.0);
    let acceleration = |t: f64, [x, v]: [f64; 2]| {
        let size = coulomb + (breakaway - coulomb) * (-(v / stribeck).powi(2)).exp();
        (stiffness * (rate * t - x) - size * (v / width).tanh()) / MASS
    };
    let (steps, h) = (100, 1e-5);
    let mut state = [0.0; 2];
    let mut slips = 0.0_f64;
    for (index, [t, q, v]) in samples.iter().enumerate() {
        slips = slips.max(*v);
        // The slip begins where two large forces cease to balance, which magnifies errors about a hundredfold.
        assert!((q - state[0]).abs() < 1e-5 && (v - state[1]).abs() < 1e-4, "{t} s: {q}, {v} for {state:?}");
        for step in 0..steps {
            let t = (index * steps + step) as f64 * h;
            let slope = |by: f64, k: [f64; 2]| {
                let moved = [state[0] + by * k[0], state[1] + by * k[1]];
                [moved[1], acceleration(t + by, moved)]
            };
            let first = slope(0.0, [0.0; 2]);
            let second = slope(0.5 * h, first);
            let third = slope(0.5 * h, second);
            let fourth = slope(h, third);
            state = [0, 1].map(|i| state[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]));
        }
    }
    // It sticks for 3 s, then slips nearly as if friction were only `coulomb`: by 2 N/√(m k) about the speed of the drive.
    assert!(samples.iter().all(|[t, _, v]| *t > 2.9 || v.abs() < 1e-3));
    assert!((0.14..0.2).contains(&slips), "{slips} m/s");
}

#[test]
fn statics_rest_on_a_stop_and_know_no_friction() {
    let text = "format: 1\nname: arm\nlinks:\n  - {name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [1, 0, 0]}\n\
                stops: {arm_theta: {min: -1, max: 20 deg, stiffness: 1e6, damping: 0.1}}\n\
                friction: {arm_theta: {coulomb: 1000, viscous: 3}}\n";
    let crane = LiveCrane::from_spec(&SourceFile::new("arm.yaml", text)).unwrap();
    let crane: &dyn DynCrane = &crane;
    let equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    // About y a positive angle lowers the arm: the stop holds m g l cos θ.
    let (stop, theta) = (20.0_f64.to_radians(), equilibrium.q[0]);
    let expected = stop + 98.1 * theta.cos() / 1e6;
    assert!((theta - expected).abs() < 1e-12, "{theta} for {expected}");
    assert!((crane.stop_efforts_at(&equilibrium.q, &[0.0])[0] + 98.1 * theta.cos()).abs() < 1e-6);
    assert_eq!(crane.friction_efforts_at(&[0.0]), [0.0]);
    let small = crane.small_motions_at(&equilibrium.q);
    // The stiffness due to gravity is m g l sin θ.
    assert!((small.stiffness[(0, 0)] - (1e6 + 98.1 * theta.sin())).abs() < 1e-6);
    assert!((small.damping[(0, 0)] - (3.0 + 1e6 * 0.1 * (theta - stop))).abs() < 1e-9);
}
