//! A chain of bars hung between two points, against the equilibrium of its bars.

use std::fmt::Write as _;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::statics::{Problem, Status};

const LENGTH: f64 = 12.0;

/// Bars on hinges from the origin on, whose end a stiff rod of 1 m ties to a point at the same height; about a parabola at the start.
fn chain(bars: usize) -> LiveCrane {
    let bar = LENGTH / bars as f64;
    let mut text = String::from("format: 1\nname: chain\nanalyses: [statics]\nlinks:\n");
    let mut guess = String::from("guess:\n");
    let (mut before, mut span) = (0.0, 0.0);
    for i in 0..bars {
        let at = if i == 0 { 0.0 } else { bar };
        let _ = writeln!(
            text,
            "  - {{name: bar_{i}, placement: {{transform: {{translation: [{at}, 0, 0]}}}}, joint: {{revolute: {{axis: y}}}}, mass: {}, com: [{}, 0, 0], inertia: {{Ixx: 1e-4, Iyy: 1e-3, Izz: 1e-3}}}}",
            3.0 * bar,
            bar / 2.0
        );
        let slope = 1.9 * (1.0 - 2.0 * (i as f64 + 0.5) / bars as f64);
        let _ = writeln!(guess, "  bar_{i}_theta: {}", slope.atan() - before);
        before = slope.atan();
        span += bar * before.cos();
    }
    let _ = writeln!(
        text,
        "connectors:\n  - {{name: tie, from: {{at: [{}, 0, 0]}}, to: {{link: bar_{}, at: [{bar}, 0, 0]}}, law: {{spring: {{stiffness: 1e7, length: 1}}}}}}",
        span + 1.0,
        bars - 1
    );
    text.push_str(&guess);
    LiveCrane::from_spec(&SourceFile::new("chain.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A bar that carries its weight in its middle has the slope of the mean force at its ends, and along the chain the vertical force changes by
/// the weight of each bar: the tangents of the angles are an arithmetic sequence.
#[test]
fn a_chain_between_two_points_is_stable() {
    for bars in [6, 12, 24, 48, 96] {
        let crane = chain(bars);
        let equilibrium = Problem::new(&crane).solve();
        assert_eq!(equilibrium.status, Status::Converged, "{bars} bars: {} steps", equilibrium.steps());
        let mut angle = 0.0;
        let slopes: Vec<f64> = equilibrium
            .q
            .iter()
            .map(|bend| {
                angle += bend;
                angle.tan()
            })
            .collect();
        let step = slopes[1] - slopes[0];
        for pair in slopes.windows(2) {
            assert!((pair[1] - pair[0] - step).abs() < 1e-6, "{bars} bars: {pair:?}, {step}");
        }
    }
}
