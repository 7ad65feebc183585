//! Cylinders with a valve, against hand calculations and a second implementation of the same laws.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings, Simulation};
use crane_model::results::Table;
use crane_model::runs::{self, Start};

const MASS: f64 = 800.0;
const GRAVITY: f64 = 9.81;
const BORE: f64 = 0.08;
const ROD: f64 = 0.045;
/// Length of the cylinder at coordinate 0, and retracted, m.
const LENGTH: f64 = 1.0;
const RETRACTED: f64 = 0.8;
const STROKE: f64 = 0.6;
const BULK: f64 = 1.3e9;
const HOSES: [f64; 2] = [6e-4, 4e-4];
const TANK: f64 = 3e5;
const FLOW: f64 = 6e-4;
const DROP: f64 = 1e6;
const LAG: f64 = 0.03;
const PUMP: f64 = 2e7;
const MAX_FLOW: f64 = 1e-3;
const VOLUME: f64 = 4e-3;
const LARGEST: f64 = 2.5e7;

/// A mass that slides upwards, on a cylinder along its path.
fn lift(valve: &str, motion: &str, pump: f64) -> LiveCrane {
    lift_with("", valve, motion, pump)
}

/// The same with additional keys.
fn lift_with(more: &str, valve: &str, motion: &str, pump: f64) -> LiveCrane {
    let text = format!(
        "format: 1
name: lift
{more}links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: {MASS}, com: [0, 0, 0]}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: slide_z, stiffness: 1e8, motion: {motion}}}
cylinders:
  - name: ram
    coordinate: slide_z
    foot: {{link: post, at: [0, 0, -{LENGTH}]}}
    head: {{link: slide, at: [0, 0, 0]}}
    bore: {BORE}
    rod: {ROD}
    retracted: {RETRACTED}
    stroke: {STROKE}
    back_pressure: {TANK}
    max_pressure: {LARGEST}
    bulk_modulus: {BULK}
    hose_volumes: [{}, {}]
    valve: {{flow: {FLOW}, pressure_drop: {DROP}, lag: {LAG}, {valve}}}
pump: {{max_flow: {MAX_FLOW}, pressure: {pump}, volume: {VOLUME}}}
analyses: [statics, dynamics, modes]
run: {{duration: 4, step: 1e-4, output: 0.01}}
",
        HOSES[0], HOSES[1]
    );
    LiveCrane::from_spec(&SourceFile::new("lift.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn areas() -> [f64; 2] {
    [PI / 4.0 * BORE * BORE, PI / 4.0 * (BORE * BORE - ROD * ROD)]
}

/// Stiffness of the oil with the coordinate at z.
fn stiffness(z: f64) -> f64 {
    let ([piston, ring], y) = (areas(), LENGTH + z - RETRACTED);
    BULK * (piston * piston / (HOSES[0] + piston * y) + ring * ring / (HOSES[1] + ring * (STROKE - y)))
}

fn settings(method: Method, tolerance: f64, duration: f64) -> Settings {
    Settings {
        method,
        tolerance,
        duration,
        step: 5e-5,
        output: 0.01,
        ..Settings::from_description(lift(SHUT, HOLD, PUMP).description())
    }
}

fn record(crane: &LiveCrane, settings: &Settings) -> Table {
    let start = Start::new(crane).expect("it rests");
    let recorded = runs::record(crane, &start, settings, &mut |_| ControlFlow::Continue(()));
    recorded.unwrap_or_else(|failed| panic!("{failed:?}")).table
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table.values(name).unwrap_or_else(|| panic!("{name}")).collect()
}

const SHUT: &str = "gain: 0, feed_forward: 0";
const HOLD: &str = "{hold: 0.1}";

#[test]
fn trapped_oil_is_a_spring() {
    let crane = lift(SHUT, HOLD, PUMP);
    let rest = (&crane as &dyn DynCrane).equilibrium(&crane_model::statics::Settings::default());
    let z = rest.q[1];
    let omega = (stiffness(z) / MASS).sqrt();
    // The modes: exact.
    let motions = (&crane as &dyn DynCrane).small_motions_at(&rest.q);
    let value = (motions.stiffness[(0, 0)] / motions.mass[(0, 0)]).sqrt();
    assert!((value / omega - 1.0).abs() < 1e-12, "{value} against {omega}");
    // A small motion: v/ω after a quarter of a period. The volumes change by 1e-4 meanwhile.
    let v = 1e-3;
    let quarter = PI / (2.0 * omega);
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        let settings = Settings { output: quarter, ..settings(method, 1e-10, quarter) };
        let start = InitialState { q: rest.q.clone(), v: vec![0.0, v], x: Vec::new() };
        let mut end = 0.0;
        let watched = Simulation::new(&crane, &start, &settings).observe(|sample| {
            end = sample.q[1];
            ControlFlow::Continue(())
        });
        watched.expect("a run");
        let off = ((end - z) * omega / v - 1.0).abs();
        assert!(off < 2e-4, "{method:?}: {off:.1e}");
    }
}

#[test]
fn a_shut_valve_holds_the_crane_where_it_rests() {
    let crane = lift(SHUT, HOLD, PUMP);
    let table = record(&crane, &settings(Method::Bdf, 1e-8, 1.0));
    let z = column(&table, "slide_z");
    let moved = z.iter().map(|now| (now - z[0]).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved:.1e} m");
    let push = column(&table, "ram_force")[0];
    assert!((push / (MASS * GRAVITY) - 1.0).abs() < 1e-12, "{push} N");
    assert_eq!(column(&table, "ram_rod_pressure")[0], TANK);
}

/// An open valve lets the cylinder move as fast as both edges in series let the oil through, whatever commands the valve.
#[test]
fn a_commanded_valve_lets_the_oil_through() {
    const OPENING: f64 = 0.25;
    let root = |difference: f64| difference / (difference * difference + 1e10).powf(0.25);
    let edge = OPENING * FLOW / root(DROP);
    let [piston, ring] = areas();
    // The speed at which the pressures, less the drops due to the flows, carry the weight.
    let (mut least, mut greatest) = (0.0, 1.0);
    for _ in 0..60 {
        let speed = 0.5 * (least + greatest);
        let back = TANK + (ring * speed / edge).powi(2);
        // The pump's pressure falls by 5 % up to its maximum flow.
        let flow = piston * speed;
        let fed = PUMP - 0.05 * PUMP * flow / MAX_FLOW - (flow / edge).powi(2);
        let spare = fed * piston - back * ring - MASS * GRAVITY;
        (least, greatest) = if spare > 0.0 { (speed, greatest) } else { (least, speed) };
    }
    let commands = [
        ("", format!("opening: {{table: {{times: [0.1, 0.2], values: [0, {OPENING}]}}}}")),
        ("inputs: {lever: {about: where the lever is}}\n", "opening: {input: lever}".to_owned()),
    ];
    for (more, valve) in commands {
        let crane =
            lift_with(more, &valve, HOLD, PUMP).with_inputs(&vec![Some(OPENING); usize::from(!more.is_empty())]);
        let table = record(&crane, &settings(Method::Bdf, 1e-8, 1.0));
        let (z, spool) = (column(&table, "slide_z"), column(&table, "ram_valve"));
        let speed = (z[100] - z[90]) / 0.1;
        // The edges are laminar below 1 bar, which changes the flow by 1e-4 at the smaller pressure drop, 6.3 MPa.
        assert!((speed / least - 1.0).abs() < 1e-3, "{valve}: {speed} m/s instead of {least}");
        assert!((spool[100] - OPENING).abs() < 1e-9, "{valve}: {}", spool[100]);
    }
}

/// With feed-forward the cylinder moves as fast as its prescribed motion, and both edges carry the oil that the piston displaces.
#[test]
fn a_steady_speed_opens_both_edges_in_series() {
    let speed = 0.05;
    let crane = lift("gain: 0, feed_forward: 1", &format!("{{speed: {{from: 0, rate: {speed}, ramp: 0.5}}}}"), PUMP);
    let table = record(&crane, &settings(Method::Bdf, 1e-8, 3.0));
    let last = |name: &str| *column(&table, name).last().expect("a row");
    let [piston, ring] = areas();
    assert!((last("ram_speed") / speed - 1.0).abs() < 1e-4, "{}", last("ram_speed"));
    let (p, rod, u) = (last("ram_piston_pressure"), last("ram_rod_pressure"), last("ram_valve"));
    let gain = FLOW / DROP.sqrt();
    // Square roots without the laminar range: an error of (1 bar/Δp)²/4.
    let inflow = u * gain * (last("pump_pressure") - p).sqrt();
    let outflow = u * gain * (rod - TANK).sqrt();
    assert!((inflow / (piston * speed) - 1.0).abs() < 5e-3, "{inflow}");
    assert!((outflow / (ring * speed) - 1.0).abs() < 3e-2, "{outflow} {rod}");
    assert!(((p * piston - rod * ring) / (MASS * GRAVITY) - 1.0).abs() < 1e-3);
}

/// Driven beyond its stroke by a pump of 300 bar, it pushes against its end with the pressure of the relief valve.
#[test]
fn against_its_end_the_relief_valve_limits_the_pressure() {
    let crane = lift("gain: 20", "{quintic: {from: 0.2, to: 0.6, duration: 2}}", 3e7);
    let table = record(&crane, &settings(Method::Bdf, 1e-6, 4.0));
    let (length, p) = (column(&table, "ram_length"), column(&table, "ram_piston_pressure"));
    let [piston, _] = areas();
    let (length, p) = (length[length.len() - 1], p[p.len() - 1]);
    // The fully open valve lets in what the relief valve lets out: its nominal flow at 5 % above the maximum pressure.
    let inflow = FLOW * ((column(&table, "pump_pressure").last().expect("a row") - p) / DROP).sqrt();
    let relief = FLOW * (p - LARGEST) / (0.05 * LARGEST);
    assert!(p > LARGEST && (inflow / relief - 1.0).abs() < 5e-3, "{p} Pa: {inflow} against {relief} m³/s");
    // The stop yields by 1 mm at the maximum force.
    let beyond = length - RETRACTED - STROKE;
    let expected = (p * piston - MASS * GRAVITY) / (LARGEST * piston / 1e-3);
    assert!(beyond > 0.9 * expected && beyond < 1.1 * expected, "{beyond} against {expected}");
}

/// A second implementation of the laws: z, ż, p, p′, u and the pressure of the pump, of the lift that follows a quintic motion, by the
/// classical Runge–Kutta method.
fn by_hand(end: f64, [from, to, duration]: [f64; 3], start: [f64; 6], [gain, share]: [f64; 2]) -> [f64; 6] {
    let root = |d: f64| d / (d * d + 1e10).powf(0.25);
    let k = FLOW / root(DROP);
    let wanted = |t: f64| {
        let s = (t / duration).clamp(0.0, 1.0);
        let position = from + (to - from) * s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
        let rate = (to - from) / duration * 30.0 * s * s * (1.0 - s).powi(2);
        (position, rate)
    };
    let [a, b] = areas();
    let slope = |t: f64, [z, v, p, r, u, s]: [f64; 6]| {
        let y = LENGTH + z - RETRACTED;
        let forward = |d: f64| if d > 0.0 { root(d) } else { 0.0 };
        let (q_a, q_b, q_s) = if u > 0.0 {
            let q = u * k * forward(s - p);
            (q, -u * k * root(r - TANK), q)
        } else {
            let q = -u * k * forward(s - r);
            (u * k * root(p - TANK), q, q)
        };
        let suck = |p: f64| if p < TANK { FLOW * (TANK - p) / 1e5 } else { 0.0 };
        let (position, rate) = wanted(t);
        let (side, area) = if rate > 0.0 { (p, a) } else { (r, b) };
        let command = gain * (position - z) + share * area * rate / (k * root(s - side));
        let pump = MAX_FLOW * ((PUMP - s) / (0.05 * PUMP)).clamp(0.0, 1.0);
        [
            v,
            (p * a - r * b) / MASS - GRAVITY,
            BULK / (HOSES[0] + a * y) * (q_a - a * v + suck(p)),
            BULK / (HOSES[1] + b * (STROKE - y)) * (q_b + b * v + suck(r)),
            (command.clamp(-1.0, 1.0) - u) / LAG,
            BULK / VOLUME * (pump - q_s),
        ]
    };
    let count = 80_000;
    let h = end / f64::from(count);
    let mut x = start;
    for step in 0..count {
        let t = h * f64::from(step);
        let add = |k: &[f64; 6], f: f64| std::array::from_fn(|i| x[i] + f * k[i]);
        let k1 = slope(t, x);
        let k2 = slope(t + h / 2.0, add(&k1, h / 2.0));
        let k3 = slope(t + h / 2.0, add(&k2, h / 2.0));
        let k4 = slope(t + h, add(&k3, h));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    x
}

#[test]
fn every_method_follows_the_laws_written_a_second_time() {
    let crane = lift("gain: 10, feed_forward: 0.8", "{quintic: {from: 0.1, to: 0.3, duration: 2}}", PUMP);
    let rest = (&crane as &dyn DynCrane).equilibrium(&crane_model::statics::Settings::default());
    let [a, b] = areas();
    let start = [rest.q[1], 0.0, (MASS * GRAVITY + TANK * b) / a, TANK, 0.0, PUMP];
    let end = 1.5;
    let expected = by_hand(end, [0.1, 0.3, 2.0], start, [10.0, 0.8]);
    for (method, tolerance, close) in [
        (Method::Bdf, 1e-9, 2e-5),
        (Method::Rosenbrock, 1e-9, 2e-5),
        (Method::DormandPrince, 1e-9, 2e-5),
        (Method::Rk4, 1e-9, 1e-8),
    ] {
        let mut found = [0.0; 6];
        let start = InitialState::at_rest(rest.q.clone());
        let settings = Settings { audit: true, ..settings(method, tolerance, end) };
        let run = Simulation::new(&crane, &start, &settings).observe(|sample| {
            found = [sample.q[1], sample.v[1], sample.x[0], sample.x[1], sample.x[2], sample.x[3]];
            ControlFlow::Continue(())
        });
        run.expect("a run");
        let sizes = [0.3, 0.1, PUMP, PUMP, 1.0, PUMP];
        for ((value, expected), size) in found.iter().zip(expected).zip(sizes) {
            let off = (value - expected).abs() / size;
            assert!(off < close, "{method:?}: {value} against {expected}, {off:.1e}");
        }
    }
}

/// The work of the cylinders equals the change of the crane's energies, with every method.
#[test]
fn energy_is_balanced() {
    let crane = lift("gain: 10", "{quintic: {from: 0.1, to: 0.4, duration: 2}}", PUMP);
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        let table = record(&crane, &Settings { audit: true, ..settings(method, 1e-8, 2.5) });
        let balance = column(&table, "energy_balance").into_iter().map(f64::abs).fold(0.0, f64::max);
        let work = *column(&table, "drive_work").last().expect("a row");
        assert!(work > 2000.0 && balance < 1e-5 * work, "{method:?}: {balance} of {work} J");
    }
}

/// A run in two pieces, the second from where the first ended, is the same run.
#[test]
fn a_run_goes_on_from_the_states_of_its_oil() {
    let crane = lift("gain: 10", "{quintic: {from: 0.1, to: 0.4, duration: 2}}", PUMP);
    let start = Start::new(&crane).expect("it rests").state;
    let go = |from: &InitialState, begin: f64, duration: f64| {
        let settings = Settings { output: duration, ..settings(Method::Rk4, 1e-8, duration) };
        let mut motion =
            crane_live::Motion::new(Box::new(crane.clone()), begin, from, &settings, None).expect("a start");
        let _ = motion.advance(begin + duration, &mut |_| ControlFlow::Continue(())).expect("a run");
        let sample = motion.sample();
        InitialState { q: sample.q.to_vec(), v: sample.v.to_vec(), x: sample.x.to_vec() }
    };
    let whole = go(&start, 0.0, 1.0);
    let parts = go(&go(&start, 0.0, 0.5), 0.5, 0.5);
    for (one, two) in [(&whole.q, &parts.q), (&whole.v, &parts.v), (&whole.x, &parts.x)] {
        for (one, two) in one.iter().zip(two) {
            assert!((one - two).abs() <= 1e-11 * one.abs().max(1.0), "{one} against {two}");
        }
    }
    assert_eq!(crane.description().cylinders.len(), 1);
}

/// The largest stable step accounts for the oil, and a run by the classical method with 0.9 times that step is accurate.
#[test]
fn oil_limits_the_step_of_explicit_methods() {
    let crane = lift("gain: 10", "{quintic: {from: 0.1, to: 0.4, duration: 2}}", PUMP);
    let start = Start::new(&crane).expect("it rests");
    let limit = runs::step_limit(&crane, &start).expect("a limit").limit;
    assert!(limit.step < 0.2 * 2.8 / (stiffness(0.1) / MASS).sqrt(), "{} s", limit.step);
    let cause = crane_model::stability::cause(crane.description(), &limit.mode);
    assert!(cause.starts_with("oil of ram; "), "{cause}");
    let exact = column(&record(&crane, &settings(Method::Bdf, 1e-8, 0.5)), "slide_z");
    let short = Settings { step: 0.9 * limit.step, ..settings(Method::Rk4, 1e-8, 0.5) };
    let found = column(&record(&crane, &short), "slide_z");
    let off = exact.iter().zip(&found).map(|(exact, value)| (exact - value).abs()).fold(0.0, f64::max);
    assert!(off < 1e-5, "{off:.1e} m");
}
