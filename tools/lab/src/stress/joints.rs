//! Stiff stops, dry friction, drives far too weak.

use std::f64::consts::PI;

use super::{
    GRAVITY,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, imbalance, timing},
};
use crane_cli::toolbox::Timing;
use crane_model::dynamics::Method;

const GROUP: &str = "stops, friction, weak drives";
/// Mass of the slide, kg, and its speed at the start, m/s.
const MASS: f64 = 50.0;
const SPEED: f64 = 1.0;

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for stiffness in [1e6, 1e8, 1e10] {
        for method in [Method::Bdf, Method::Rosenbrock] {
            cases.push(stopped(stiffness, method));
        }
    }
    for width in [1e-2, 1e-4, 1e-6] {
        for method in [Method::Bdf, Method::Rosenbrock] {
            cases.push(rubbed(width, method));
        }
    }
    for stiffness in [1e3, 1.0, 1e-3] {
        cases.push(sagging(stiffness));
        cases.push(falling(stiffness));
    }
    cases
}

/// A weightless slide with additional keys.
fn slide(more: &str) -> Spec {
    Spec::new(format!(
        "format: 1
name: slide
gravity: [0, 0, 0]
analyses: [dynamics]
links: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: {MASS}, com: [0, 0, 0]}}]
{more}
"
    ))
}

/// Options of a run in which the slide moves from the start.
fn moving(method: Method, tolerance: f64, duration: f64) -> Timing {
    let start = vec![format!("slide_x_rate={SPEED}")];
    Timing { start, ..timing(method, tolerance, duration) }
}

/// An undamped stop gives the speed back, `π √(m/k)` after first contact.
fn stopped(stiffness: f64, method: Method) -> Case {
    let at = 0.2;
    let back = at - SPEED * (0.5 - at / SPEED - PI * (MASS / stiffness).sqrt());
    let expected = format!("x = {back:.5} m at 0.5 s, energy balanced to 0.1 %");
    Case::new(GROUP, format!("slide against a stop of {stiffness:e} N/m, {method}"), expected, move || {
        let spec = slide(&format!("stops: {{slide_x: {{max: {at}, stiffness: {stiffness:e}}}}}"));
        let recorded = Subject::new(&spec)?.run(&moving(method, 1e-7, 0.5))?;
        let (x, off) = (recorded.table.rows.last().map_or(f64::NAN, |row| row[1]), imbalance(&recorded));
        expect((x - back).abs() < 1e-3 && off < 1e-3, format!("x = {x:.5} m, energy off by {off:.1e}"))
    })
}

/// Coulomb friction stops it after `m v²/2F_c`, plus `m π² v₀²/12F_c` of creep.
fn rubbed(width: f64, method: Method) -> Case {
    let force = 100.0;
    let distance = MASS / (2.0 * force) * (SPEED * SPEED + PI * PI * width * width / 6.0);
    let expected = format!("at rest after {distance:.5} m");
    Case::new(GROUP, format!("slide with friction of width {width:e} m/s, {method}"), expected, move || {
        let spec = slide(&format!("friction: {{slide_x: {{coulomb: {force}, width: {width:e}}}}}"));
        let recorded = Subject::new(&spec)?.run(&moving(method, 1e-7, 1.0))?;
        let (x, v) = recorded.table.rows.last().map_or((f64::NAN, f64::NAN), |row| (row[1], row[2]));
        expect((x - distance).abs() < 1e-4 && v.abs() < width, format!("x = {x:.5} m, {v:.1e} m/s"))
    })
}

/// An arm of 1 m and 100 kg on a drive that is far too weak to hold it level: it hangs where the moments of spring and weight
/// balance, `s (π/2 − α) = m g sin α` for the angle α from hanging down.
fn arm(stiffness: f64) -> Spec {
    Spec::new(format!(
        "format: 1
name: arm
links: [{{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 100, com: [1, 0, 0]}}]
drives: [{{coordinate: arm_theta, stiffness: {stiffness:e}, damping: {:e}, motion: {{hold: 0}}}}]
run: {{duration: 2}}
",
        0.01 * stiffness
    ))
}

fn sagging(stiffness: f64) -> Case {
    // Newton's method for the scalar balance, from 1 rad.
    let weight = 100.0 * GRAVITY;
    let mut theta = 1.0_f64;
    for _ in 0..100 {
        theta -= (stiffness * theta - weight * theta.cos()) / (stiffness + weight * theta.sin());
    }
    let expected = format!("stable, {:.4}° below its drive", theta.to_degrees());
    Case::new(GROUP, format!("arm of 100 kg on a drive of {stiffness:e} N m/rad, statics"), expected, move || {
        let rest = Subject::new(&arm(stiffness))?.rest()?;
        expect((rest.q[0] - theta).abs() < 1e-7, format!("{rest}; {:.4}°", rest.q[0].to_degrees()))
    })
}

fn falling(stiffness: f64) -> Case {
    let name = format!("arm of 100 kg on a drive of {stiffness:e} N m/rad, dropped");
    Case::new(GROUP, name, "2 s to the end, energy balanced to 0.1 %", move || {
        let spec = arm(stiffness).changed("analyses: [dynamics]");
        balanced(&Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-6, 2.0))?, 1e-3)
    })
}
