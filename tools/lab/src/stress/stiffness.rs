//! Stiffness of drives, elements and supports over ten powers of ten, and damping.

use std::f64::consts::FRAC_PI_2;

use super::{
    DRIVES, GRAVITY, SUPPORT, Specs, WEIGHTLESS,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, cautions, imbalance, timing},
    with_boom, with_drives, with_supports,
};
use crane_model::{
    dynamics::Method,
    modes::{damped, undamped},
};

const OF_DRIVES: &str = "stiffness of drives";
/// Factors of a stiffness.
const FACTORS: [f64; 8] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e2, 1e4, 1e6];
/// Moment of all weights about the pin of the reference crane's boom while boom, outer boom and telescope lie level, N m:
/// boom 408.1 kg at 1.75 m, outer boom 335 kg at 4.76 m, telescope 224 kg at 6.08 m, the rest 846 kg at 7.7 m.
const LEVEL_MOMENT: f64 = GRAVITY * (408.1 * 1.75 + 335.0 * 4.76 + 224.0 * 6.08 + 846.0 * 7.7);
/// Stiffness of its drive, N m/rad.
const BOOM_DRIVE: f64 = DRIVES[1].1;
/// Weight of the reference crane, N.
const WEIGHT: f64 = GRAVITY * (15000.0 + 515.5 + 408.1 + 335.0 + 224.0 + 846.0);
/// Vertical stiffness of its eight supports, N/m.
const GROUND: f64 = 8.0 * SUPPORT[2];
/// Rotation of a base above which linear supports are off by more than half a percent, rad.
const SMALL: f64 = 0.1;
/// Simulated time of a run, s: the beginning of the manoeuvre.
const DURATION: f64 = 1.0;
/// Fraction of the energy exchanged that a run at tolerance 1e-4 may lose or gain.
const BALANCE: f64 = 1e-3;

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    for factor in FACTORS {
        cases.push(drives(specs.reference(), factor));
        cases.push(run_case(OF_DRIVES, stiffened_drives(&specs.reference(), factor), factor));
        cases.push(single_element(specs.cantilever(1), factor));
        cases.push(run_case("stiffness of elements", stiffened_steel(&specs.reference(), factor), factor));
        cases.push(supports(specs.reference(), factor));
        // With softer supports the crane overturns.
        if factor >= 1e-2 {
            cases.push(run_case("stiffness of supports", stiffened_supports(&specs.reference(), factor), factor));
        }
    }
    for beta in [0.0, 1e-6, 1e-4, 1e-2, 1e-1] {
        cases.push(damping(&specs.cantilever(8), beta));
        let spec = with_boom(&specs.reference(), &format!("damping: {{beta: {beta:e}}}"));
        cases.push(run_case("damping of elements", spec, beta));
    }
    cases
}

fn stiffened_drives(spec: &Spec, factor: f64) -> Spec {
    with_drives(spec, |stiffness| format!("stiffness: {:e}", factor * stiffness))
}

/// A crane whose steel has its moduli scaled.
fn stiffened_steel(spec: &Spec, factor: f64) -> Spec {
    spec.changed(&format!("materials: {{steel: {{E: {:e}, G: {:e}}}}}", factor * 2.1e11, factor * 8.1e10))
}

fn stiffened_supports(spec: &Spec, factor: f64) -> Spec {
    with_supports(spec, SUPPORT.map(|stiffness| factor * stiffness))
}

/// A run as the command performs it by default.
fn run_case(group: &'static str, spec: Spec, factor: f64) -> Case {
    let what = if group.starts_with("damping") { "β = " } else { "× " };
    let expected = format!("{DURATION} s to the end, energy balanced to {:.1} %", BALANCE * 100.0);
    let case = Case::new(group, format!("eight_link_flexible {what}{factor:e}, motion"), expected, move || {
        let recorded = Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-4, DURATION))?;
        let (off, steps) = (imbalance(&recorded), recorded.run.statistics.steps);
        let warnings = cautions(&recorded);

        expect(
            recorded.run.time == DURATION && off < BALANCE,
            format!("{steps} steps, energy off by {off:.1e}{warnings}"),
        )
    });
    if factor == 1e-4 || factor == 1e6 && group != OF_DRIVES { case } else { case.long() }
}

fn drives(spec: Spec, factor: f64) -> Case {
    let stiff = factor >= 1.0;
    let expected = if stiff {
        format!("stable; boom drive carries {:.1} kN m ± 2 %, the moment of the horizontal boom", LEVEL_MOMENT / 1e3)
    } else {
        format!(
            "stable; boom sinks and its drive carries its stiffness times the sag: up to {:.1} kN m",
            LEVEL_MOMENT / 1e3
        )
    };
    Case::new(OF_DRIVES, format!("eight_link_flexible × {factor:e}, statics"), expected, move || {
        let subject = Subject::new(&stiffened_drives(&spec, factor))?;
        let rest = subject.rest()?;
        let boom = subject.index("boom_psi")?;
        let drives = &subject.crane.description().drives;
        let index = drives.iter().position(|drive| drive.coordinate == boom).ok_or("no drive of the boom")?;
        let torque = subject.crane.drive_efforts_at(0.0, &rest.q, &vec![0.0; rest.q.len()])[index];
        // Sag of some centimetres and tilt of the truck shorten and lengthen the levers by about a percent.
        let carried = torque / LEVEL_MOMENT;
        // The weight pulls a sinking boom downwards until it hangs; a drive held at 0 rad carries the moment of its spring.
        let spring = -factor * BOOM_DRIVE * rest.q[boom] / torque;
        let right = if stiff {
            (carried - 1.0).abs() < 0.02
        } else {
            (0.0..1.001).contains(&carried) && (spring - 1.0).abs() < 1e-9
        };
        expect(right, format!("{rest}; {:.1} kN m, boom at {:.4} rad", torque / 1e3, rest.q[boom]))
    })
}

/// A cantilever of one section is a rod on one spring in its middle: `s θ = g cos θ (m l/2 + μ l²/8)`, s = EI/l.
fn single_element(spec: Spec, factor: f64) -> Case {
    /// Steel of 60 × 40 mm, 2 m long, 20 kg at its end; weak axis.
    const LENGTH: f64 = 2.0;
    const LOAD: f64 = 20.0;
    const LINE: f64 = 7850.0 * 0.06 * 0.04;
    const RIGIDITY: f64 = 2.1e11 * 0.06 * 0.04 * 0.04 * 0.04 / 12.0;
    let spring = factor * RIGIDITY / LENGTH;
    let moment = GRAVITY * (LOAD * LENGTH / 2.0 + LINE * LENGTH * LENGTH / 8.0);
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        if spring * middle < moment * middle.cos() { low = middle } else { high = middle }
    }
    let (angle, sunk) = (low, LENGTH / 2.0 * low.sin());
    // A symmetric section joint is regular there.
    let expected = format!("stable; tip sinks by {sunk:.6} m, spring rotated by {angle:.6} rad; no caution about ±90°");
    Case::new("stiffness of elements", format!("cantilever of 1 section × {factor:e}, statics"), expected, move || {
        let subject = Subject::new(&stiffened_steel(&spec, factor))?;
        let rest = subject.rest()?;
        let description = subject.crane.description();
        let tip = subject.crane.points_at(&rest.q)[1];
        let value = rest.q[subject.index("beam_1_theta")?];
        let caution = description.near_singular(&rest.q);
        let right = (tip.z + sunk).abs() < 1e-8 && (value - angle).abs() < 1e-8 && caution.is_none();
        let warning = caution.map_or(String::new(), |caution| format!("; {caution}"));
        expect(right, format!("{rest}; tip {:.6} m, {value:.6} rad{warning}", tip.z))
    })
}

fn supports(spec: Spec, factor: f64) -> Case {
    // The load's moment over the supports' stiffness against tilting about y, 1.5 m to either side.
    let tilt = LEVEL_MOMENT / (factor * GROUND * 1.5 * 1.5);
    let small = tilt < SMALL;
    let sunk = WEIGHT / (factor * GROUND);
    let expected = if small {
        format!("stable; supports compressed by {sunk:.4e} m on average, weight over stiffness")
    } else {
        format!("a caution that the base rotates too far for linear supports, by about {tilt:.2} rad")
    };
    Case::new("stiffness of supports", format!("eight_link_flexible × {factor:e}, statics"), expected, move || {
        let subject = Subject::new(&stiffened_supports(&spec, factor))?;
        let equilibrium = subject.equilibrium();
        if !small {
            let caution = subject.crane.description().large_tilt(&equilibrium.q);
            let happened = caution.as_ref().map_or(String::new(), |caution| format!("; {caution}"));
            return expect(caution.is_some(), format!("{equilibrium}{happened}"));
        }
        let rest = subject.rest()?;
        let reactions = subject.crane.support_reactions_at(&rest.q, &vec![0.0; rest.q.len()]);
        let pressed = reactions.iter().map(|force| force.z).sum::<f64>() / (factor * GROUND);
        // Newton's method leaves a residual of 1e-10 of the forces.
        expect((pressed / sunk - 1.0).abs() < 1e-8, format!("{rest}; {pressed:.4e} m"))
    })
}

/// Damping in proportion to stiffness, `D = β K`: mode by mode `ζ = β ω/2`.
fn damping(spec: &Spec, beta: f64) -> Case {
    // The stiffness due to gravity is not damped.
    let changes = format!("links: [{{name: beam, beam: {{damping: {{beta: {beta:e}}}}}}}]\n");
    let spec = spec.changed(&(changes + WEIGHTLESS));
    let expected = "every underdamped mode has ζ = β ω/2 to 1e-6, all others decay without oscillating";
    Case::new("damping of elements", format!("cantilever β = {beta:e}, modes"), expected, move || {
        let subject = Subject::new(&spec)?;
        let motions = subject.crane.small_motions_at(&subject.rest()?.q);
        let (free, modes) = (undamped(&motions), damped(&motions));
        let (free, modes) = (free.map_err(|e| e.to_string())?, modes.map_err(|e| e.to_string())?);
        let below: Vec<f64> =
            free.iter().map(|mode| mode.omega_squared.sqrt()).filter(|omega| beta * omega / 2.0 < 1.0).collect();
        let swinging: Vec<_> = modes.iter().filter(|mode| mode.eigenvalue.im > 0.0).collect();
        let off = below.iter().zip(&swinging).map(|(omega, mode)| {
            ((mode.eigenvalue.norm() / omega - 1.0).abs()).max((mode.damping_ratio() - beta * omega / 2.0).abs())
        });
        let off = off.fold(0.0, f64::max);
        let happened = format!("{} of {} modes oscillate, error {off:.1e}", swinging.len(), free.len());
        expect(below.len() == swinging.len() && off < 1e-6, happened)
    })
}
