//! Supports with preload and free play.

use std::fmt::Write;

use super::{
    GRAVITY,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, imbalance, timing},
};
use crane_model::dynamics::Method;

const MASS: f64 = 1000.0;
const STIFFNESS: f64 = 1e6;

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for kinematics in ["linear", "exact"] {
        for play in [0.0, -0.05, 0.05, 1.0, -100.0] {
            cases.push(lifted(kinematics, play));
        }
        cases.push(clamped(kinematics));
        cases.push(dropped(kinematics));
    }
    cases
}

fn block(kinematics: &str, plays: [f64; 4], damping: f64) -> Spec {
    let mut text = format!(
        "format: 1
name: block
links:
  - {{name: block, joint: free, mass: {MASS}, com: [0, 0, 0.2], inertia: {{Ixx: 200, Iyy: 300, Izz: 400}}}}
supports:
"
    );
    let corners = [(1.0, 0.7), (1.0, -0.7), (-1.0, 0.7), (-1.0, -0.7)];
    for (index, ((x, y), play)) in corners.into_iter().zip(plays).enumerate() {
        let _ = writeln!(
            text,
            "  - {{name: s{index}, at: [{x}, {y}, 0], stiffness: [1e6, 1e6, {STIFFNESS:e}], damping: \
             [{damping}, {damping}, {damping}], free_play: [0, 0, {play:e}], kinematics: {kinematics}}}"
        );
    }
    Spec::new(text)
}

/// All four springs unloaded at the same height δ: the block rests at `δ − m g/4s` and each carries a quarter of its weight.
fn lifted(kinematics: &'static str, play: f64) -> Case {
    let height = play - MASS * GRAVITY / (4.0 * STIFFNESS);
    let each = MASS * GRAVITY / 4.0;
    let expected = format!("stable at z = {height:.6} m, {each:.1} N on each");
    let name = format!("block on {kinematics} supports, all with δ = {play} m");
    Case::new("preload and free play", name, expected, move || {
        let subject = Subject::new(&block(kinematics, [play; 4], 0.0))?;
        let rest = subject.rest()?;
        let reactions = subject.crane.support_reactions_at(&rest.q, &[0.0; 6]);
        let off = reactions.iter().map(|force| (force.z / each - 1.0).abs()).fold(0.0, f64::max);
        // Forces are s times rounded heights.
        let right = (rest.q[2] - height).abs() < 1e-9 && off < 1e-6;
        expect(right, format!("{rest}; z = {:.6} m, {:.1} N on the first", rest.q[2], reactions[0].z))
    })
}

/// One diagonal is 10 mm higher than the other. No plane meets both, so the block is preloaded: the springs unloaded at δ
/// carry `m g/4 + s δ/2`, the others `m g/4 − s δ/2`.
fn clamped(kinematics: &'static str) -> Case {
    const PLAY: f64 = 0.01;
    let (quarter, more) = (MASS * GRAVITY / 4.0, STIFFNESS * PLAY / 2.0);
    let expected = format!("stable; {:.1} and {:.1} N along the diagonals", quarter + more, quarter - more);
    Case::new(
        "preload and free play",
        format!("block on {kinematics} supports, δ = 10 mm on one diagonal"),
        expected,
        move || {
            let subject = Subject::new(&block(kinematics, [PLAY, 0.0, 0.0, PLAY], 0.0))?;
            let rest = subject.rest()?;
            let reactions = subject.crane.support_reactions_at(&rest.q, &[0.0; 6]);
            let signs = [1.0, -1.0, -1.0, 1.0];
            let off = reactions.iter().zip(signs).map(|(force, sign)| (force.z - quarter - sign * more).abs());
            let off = off.fold(0.0, f64::max);
            expect(off < 1e-4 * quarter, format!("{rest}; {:.1} and {:.1} N", reactions[0].z, reactions[1].z))
        },
    )
}

/// Springs unloaded 1 m above the start of the block pull it up with 4 s δ: it shoots up and comes to rest.
fn dropped(kinematics: &'static str) -> Case {
    let height = 1.0 - MASS * GRAVITY / (4.0 * STIFFNESS);
    let expected = format!("2 s; at rest at z = {height:.4} m, energy balanced to 0.1 %");
    Case::new(
        "preload and free play",
        format!("block shot up by {kinematics} supports, δ = 1 m"),
        expected,
        move || {
            let spec = block(kinematics, [1.0; 4], 1e4).changed("analyses: [dynamics]");
            let recorded = Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-6, 2.0))?;
            let (last, off) = (recorded.table.rows.last().map_or(f64::NAN, |row| row[3]), imbalance(&recorded));
            expect((last - height).abs() < 1e-4 && off < 1e-3, format!("z = {last:.4} m, energy off by {off:.1e}"))
        },
    )
}
