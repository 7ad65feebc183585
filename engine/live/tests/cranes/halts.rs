//! Emergency stops of drives, against closed forms.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Method, Settings};
use crane_model::results::Table;
use crane_model::runs::{Start, record};

const SPEED: f64 = 0.1;
const AT: f64 = 1.0;
const LENGTH: f64 = 2.0;
const GRAVITY: f64 = 9.81;

/// A trolley that already moves, halts within a time, and carries a point mass on a rod.
fn trolley(within: f64) -> LiveCrane {
    let text = format!(
        "format: 1\nname: trolley\nlinks:\n\
         - {{name: trolley, joint: {{prismatic: {{axis: x}}}}, mass: 100, com: [0, 0, 0]}}\n\
         - {{name: hook, joint: {{revolute: {{axis: y}}}}, mass: 50, com: [0, 0, -{LENGTH}]}}\n\
         drives: [{{coordinate: trolley_x, rigid: true, motion: {{speed: {{rate: {SPEED}, begin: -1}}}}, halt: {{at: {AT}, within: {within}}}}}]\n"
    );
    LiveCrane::from_spec(&SourceFile::new("trolley.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn run(crane: &LiveCrane, duration: f64) -> Table {
    let settings = Settings {
        method: Method::DormandPrince,
        tolerance: 1e-10,
        duration,
        output: 1e-3,
        ..Settings::from_description(crane.description())
    };
    let crane: &dyn DynCrane = crane;
    let start = Start::new(crane).expect("a start");
    record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("a run").table
}

/// The trolley slows down by v/T and ends v T/2 further. The load swings with 2 v/(g T) |sin(ω T/2)| afterwards; after whole periods, it hangs still.
#[test]
fn a_load_swings_after_an_emergency_stop() {
    let omega = (GRAVITY / LENGTH).sqrt();
    for within in [0.2, 0.6, 1.5, TAU / omega] {
        let table = run(&trolley(within), AT + within + TAU / omega);
        let column = |name: &str| table.values(name).expect("a column").collect::<Vec<f64>>();
        let (t, x, angle) = (column("t"), column("trolley_x"), column("hook_theta"));
        let end = SPEED * (1.0 + AT + 0.5 * within);
        assert!((x.last().expect("rows") - end).abs() < 1e-12, "{within}: {x:?}");
        for (t, x) in t.iter().zip(&x).filter(|(t, _)| **t > AT && **t < AT + within) {
            let expected = SPEED * (1.0 + t - (t - AT).powi(2) / (2.0 * within));
            assert!((x - expected).abs() < 1e-12, "{within}, {t} s: {x}, {expected}");
        }
        let after = t.iter().zip(&angle).filter(|(t, _)| **t >= AT + within);
        let swing = after.fold(0.0_f64, |most, (_, angle)| most.max(angle.abs()));
        let expected = 2.0 * SPEED / (GRAVITY * within) * (0.5 * omega * within).sin().abs();
        // The angles of up to 0.05 rad make the pendulum slower by θ²/16; results are a millisecond apart.
        let largest = 2.0 * SPEED / (GRAVITY * within);
        assert!((swing - expected).abs() < 1e-3 * largest, "{within}: {swing} rad, {expected} rad");
    }
}

/// A motion that halts stays on its way: its position is that of the motion at θ, its rate that of the motion times dθ/dt.
#[test]
fn a_motion_that_halts_stays_on_its_way() {
    let crane = |halt: &str| {
        let text = format!(
            "format: 1\nname: arm\nlinks: [{{name: arm, joint: revolute, mass: 10, com: [1, 0, 0]}}]\n\
             drives: [{{coordinate: arm_psi, stiffness: 1e6, motion: {{quintic: {{from: 0, to: 1, duration: 4}}}}{halt}}}]\n"
        );
        LiveCrane::from_spec(&SourceFile::new("arm.yaml", text)).expect("a crane")
    };
    let (halted, free) = (crane(", halt: {at: 1.5, within: 0.8}"), crane(""));
    let at = |crane: &LiveCrane, t: f64| (crane as &dyn DynCrane).drive_motions_at(t)[0];
    for (t, theta, speed) in [(1.0, 1.0, 1.0), (1.5, 1.5, 1.0), (1.7, 1.675, 0.75), (2.1, 1.875, 0.25), (9.0, 1.9, 0.0)]
    {
        let [position, rate] = at(&halted, t);
        let [own_position, own_rate] = at(&free, theta);
        assert!((position - own_position).abs() < 1e-14, "{t} s: {position}, {own_position}");
        assert!((rate - speed * own_rate).abs() < 1e-14, "{t} s: {rate}, {own_rate}");
    }
}
