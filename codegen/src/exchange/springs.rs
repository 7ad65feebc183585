//! Springs and dampers of a crane, joint by joint and support by support.

use std::fmt::Write;

use super::names;
use super::xml::{number_text, numbers};
use crate::chain::{Chain, CoordinateId, Force, SupportKinematics, Vector};
use crate::diagnostic::quoted;

/// What acts on a coordinate: `stiffness (rest − q) − damping q̇ + effort`.
#[derive(Default)]
pub(super) struct JointSpring {
    /// N m/rad or N/m.
    pub(super) stiffness: f64,
    /// N m s/rad or N s/m.
    pub(super) damping: f64,
    /// Position at which the spring is unstressed, rad or m: for a drive, its position at t = 0.
    pub(super) rest: f64,
    /// Of a drive at t = 0, N m or N.
    pub(super) effort: f64,
}

/// The spring of a coordinate: that of an element, of a drive held at its initial position, passive damping, or none.
///
/// The language allows at most one of these per coordinate.
pub(super) fn on(chain: &Chain, id: CoordinateId, parameters: &[f64]) -> JointSpring {
    let number = |value: &crate::chain::Value| value.at(parameters);
    let mut springs = chain.forces.iter().filter(|force| force.coordinate() == Some(id)).filter_map(Force::spring);
    if let Some(drive) = chain.drives.iter().find(|drive| drive.coordinate == id) {
        let rest = drive.profile.start(parameters);
        let (stiffness, damping) = drive.spring().map_or((0.0, 0.0), |(s, d)| (number(s), number(d)));
        JointSpring { stiffness, damping, rest, effort: drive.effort().map_or(0.0, |effort| effort.start(parameters)) }
    } else {
        springs.next().map_or_else(JointSpring::default, |spring| JointSpring {
            stiffness: number(&spring.stiffness),
            damping: number(&spring.damping),
            rest: 0.0,
            effort: 0.0,
        })
    }
}

/// Rows of `U` in the elongation `e = U q̃ − δ` of a linear support at `(x, y, z)`, by x, y, z, ψ, θ, φ of the base, Eq. (16).
pub(super) fn linear_rows([x, y, z]: Vector) -> [[f64; 6]; 3] {
    [[1.0, 0.0, 0.0, -y, z, 0.0], [0.0, 1.0, 0.0, x, 0.0, -z], [0.0, 0.0, 1.0, 0.0, -x, y]]
}

/// The springs and dampers of a crane as YAML, to accompany a URDF file, which cannot contain them; with gravity and the guess.
#[must_use]
pub fn springs(chain: &Chain, parameters: &[f64]) -> String {
    let at = |values: &[crate::chain::Value; 3]| values.each_ref().map(|value| value.at(parameters));
    let list = |values: &[crate::chain::Value; 3]| format!("[{}]", numbers(&at(values)).replace(' ', ", "));
    let mut text = format!("# Springs and dampers of {}\n", super::origin(chain, parameters));
    text += "# URDF cannot contain them: A and e follow from the URDF file, the forces from this file.\n";
    let _ = writeln!(text, "gravity: {}   # m/s^2", list(&chain.gravity));

    let keys: Vec<String> = names::joints(chain)
        .into_iter()
        .zip(&chain.coordinates)
        .map(|(name, coordinate)| if name == coordinate.name { name } else { quoted(&name) })
        .collect();
    text += "\n# Force on a joint: stiffness * (rest - q) - damping * v + effort. Drives are held at their positions and efforts at t = 0.\n";
    text += "# Revolute: N m/rad, N m s/rad, rad; prismatic: N/m, N s/m, m.\njoints:\n";
    for (index, joint) in keys.iter().enumerate() {
        let JointSpring { stiffness, damping, rest, effort } = on(chain, CoordinateId(index), parameters);
        if stiffness != 0.0 || damping != 0.0 || effort != 0.0 {
            let [stiffness, damping, rest] = [stiffness, damping, rest].map(number_text);
            let effort = if effort == 0.0 { String::new() } else { format!(", effort: {}", number_text(effort)) };
            let law = format!("stiffness: {stiffness}, damping: {damping}, rest: {rest}{effort}");
            let _ = writeln!(text, "  {joint}: {{{law}}}");
        }
    }

    if chain.rigid_drives().next().is_some() {
        text += "\n# Joints whose motion rigid drives prescribe: positions at t = 0, rad or m.\nprescribed:\n";
        for drive in chain.rigid_drives() {
            let joint = &keys[drive.coordinate.0];
            let _ = writeln!(text, "  {joint}: {}", number_text(drive.profile.start(parameters)));
        }
    }
    if !chain.rotors.is_empty() {
        text += "\n# Inertia of the joints' rotors, added to the diagonal of A, kg m^2 or kg.\narmature:\n";
        for rotor in &chain.rotors {
            let joint = &keys[rotor.coordinate.0];
            let _ = writeln!(text, "  {joint}: {}", number_text(rotor.armature.at(parameters)));
        }
    }

    if let Some(base) = chain.bodies.first().filter(|_| !chain.supports.is_empty()) {
        let _ = write!(
            text,
            "\n# Springs and dampers along x, y, z of the world between the ground and points of `{}`, N/m, N s/m, m:\n\
             # force on the point: -stiffness * elongation - damping * rate of elongation, each axis separately.\n\
             # linear: elongation = U q - free_play, with the base's coordinates q = (x, y, z, psi, theta, phi) and rows of U\n\
             #   (1, 0, 0, -y, z, 0), (0, 1, 0, x, 0, -z), (0, 0, 1, 0, -x, y) for a point at (x, y, z).\n\
             # exact: elongation = displacement of the point from its position at q = 0, minus free_play.\nsupports:\n",
            base.name
        );
        if chain.has_one_sided_supports() {
            text += "  # one_sided: presses along z and never pulls; its damping along z adds at most the force of its spring.\n  \
                     # Sideways it holds at most friction_coefficient times the force with which it presses, and slides beyond.\n";
        }
        for support in &chain.supports {
            let kinematics = if support.kinematics == SupportKinematics::Linear { "linear" } else { "exact" };
            let one_sided = support.friction.as_ref().map_or_else(String::new, |coefficient| {
                format!(", one_sided: true, friction_coefficient: {}", number_text(coefficient.at(parameters)))
            });
            let _ = writeln!(
                text,
                "  - {{name: {}, kinematics: {kinematics}, at: {}, stiffness: {}, damping: {}, free_play: {}{one_sided}}}",
                support.name,
                list(&support.position),
                list(&support.stiffness),
                list(&support.damping),
                list(&support.free_play)
            );
        }
    }

    text += "\n# Start of the static solution, rad and m.\nguess:\n";
    for (joint, guess) in keys.iter().zip(chain.guess_at(parameters)) {
        let _ = writeln!(text, "  {joint}: {}", number_text(guess));
    }
    text
}
