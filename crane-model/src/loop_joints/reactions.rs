//! What loop joints transmit, and what to say about them at a pose.

use super::{
    Loops, OPEN, Open, dot,
    drives::{DEAD_CENTRE, dead_centre_of_drives, fighting_valves, prescribed_too_much},
};
use crate::{
    Wrench,
    description::{LoopEquationInfo, LoopJointInfo},
    dyn_crane::{DynDynamics, DynInternalForces, DynModel},
    wrench,
};

/// A loop that is open at a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The joint.
    pub joint: String,
    /// The direction; empty for a rod.
    pub direction: String,
    /// The gap, m or rad.
    pub gap: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl Gap {
    /// Of an equation of a crane.
    pub(crate) fn of(crane: &(impl DynModel + ?Sized), Open { equation, gap }: Open) -> Self {
        let (joint, info) = equation_of(crane.loop_joints(), equation);
        // That of an axis is a sine.
        let gap = if info.is_moment && gap <= 1.0 { gap.asin() } else { gap };
        Self { joint: joint.name.to_string(), direction: info.direction.to_string(), gap, unit: info.unit() }
    }
}

impl std::fmt::Display for Gap {
    /// `joint p is open by 3.20 mm along x`
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { joint, direction, gap, unit } = self;
        if *unit == "m" {
            write!(f, "joint {joint} is open by {:.3} mm", gap * 1e3)?;
            if direction.is_empty() { write!(f, " along its length") } else { write!(f, " along {direction}") }
        } else {
            write!(f, "the axes of joint {joint} differ by {:.3}° about {direction}", gap.to_degrees())
        }
    }
}

/// The joint and the equation with an index among those of all joints.
fn equation_of(joints: &[LoopJointInfo], mut index: usize) -> (&LoopJointInfo, &LoopEquationInfo) {
    for joint in joints {
        match joint.equations.get(index) {
            Some(equation) => return (joint, equation),
            None => index -= joint.equations.len(),
        }
    }
    panic!("an index of an equation")
}

/// The loop that is open most at a pose, if any is open by more than a thousandth of a millimetre.
pub fn gap_at(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Option<Gap> {
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return None;
    }
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    let widest = loops.widest();
    (widest.gap > OPEN).then(|| Gap::of(crane, widest))
}

/// Indices of the equations that are independent at a pose, among those of all joints.
pub fn independent(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<usize> {
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    loops.independent().to_vec()
}

/// The equations whose forces and moments cannot be determined at a pose, because they depend on others: `pin P along z`.
pub fn undetermined(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let dependent = (0..loops.states.len()).filter(|row| !loops.is_independent(*row));
    let name = |row| {
        let (joint, LoopEquationInfo { direction, is_moment }) = equation_of(crane.loop_joints(), row);
        let way = if *is_moment { "about" } else { "along" };
        format!("{} {} {way} {direction}", joint.kind, joint.name).trim_end().trim_end_matches(" along").to_owned()
    };
    dependent.map(name).collect()
}

/// Cautions about the loops at a pose.
pub fn cautions(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return Vec::new();
    }
    let undetermined = undetermined(crane, q);
    let is_closed = gap_at(crane, q).is_none();
    let unknown = (is_closed && !undetermined.is_empty() && prescribed_too_much(crane, q).is_empty()).then(|| {
        format!(
            "reactions of {} cannot be determined: other joints hold the same; they are shown as 0",
            undetermined.join(", ")
        )
    });
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let last = loops.independent().last().copied().unwrap_or(0);
    let name = &equation_of(crane.loop_joints(), last).0.name;
    let distance = loops.distance_to_dead_centre();
    let near = (distance < DEAD_CENTRE).then(|| {
        format!(
            "the loop of {name} is {:.2}° from a dead centre: its forces are large and its motion beyond is not determined",
            distance.asin().to_degrees()
        )
    });
    let loose = dead_centre_of_drives(crane, &loops).filter(|_| near.is_none()).map(|angle| {
        format!(
            "the loop of {name} is {:.2}° from a dead centre of its drives: they hardly hold it, and which way it moves on is not determined",
            angle.to_degrees()
        )
    });
    let fighting = fighting_valves(crane, q, &loops).map(|cylinders| {
        format!(
            "{} hold one loop together and can push against each other: how they share its load depends on the oil trapped in them; a run begins \
             with the smallest forces in the loop",
            cylinders.join(" and ")
        )
    });
    near.into_iter().chain(loose).chain(fighting).chain(unknown).collect()
}

/// Adds what loop joints transmit at every cut; only those that hold to the world if `to_world`.
pub(crate) fn add_to_wrenches(
    crane: &(impl DynInternalForces + ?Sized),
    q: &[f64],
    multipliers: &[f64],
    to_world: bool,
    out: &mut [Wrench],
) {
    if multipliers.is_empty() || out.is_empty() {
        return;
    }
    let mut of_equations = vec![Wrench::ZERO; multipliers.len() * out.len()];
    crane.loop_wrenches(q, &mut of_equations);
    let joints = crane.loop_joints().iter();
    let counts = joints.flat_map(|joint| {
        let counts = !to_world || joint.ends.iter().any(|end| end.body.is_none());
        std::iter::repeat_n(counts, joint.equations.len())
    });
    for ((multiplier, own), counts) in multipliers.iter().zip(of_equations.chunks_exact(out.len())).zip(counts) {
        if counts {
            wrench::add(out, *multiplier, own);
        }
    }
}

/// What closing the loops adds to the effort of each rigid drive: its coordinate, and N m or N.
///
/// ```text
/// Δτ = A (q̈ − q̈_open) + Jᵀ λ
/// ```
pub(crate) fn on_rigid_drives(
    crane: &(impl DynDynamics + ?Sized),
    q: &[f64],
    loops: &Loops,
    change: &[f64],
) -> Vec<(usize, f64)> {
    let prescribed = &loops.prescribed;
    if prescribed.is_empty() || loops.is_empty() {
        return Vec::new();
    }
    let n = q.len();
    let mut mass = vec![0.0; n * n];
    crane.mass_matrix(q, &mut mass);
    let added = |&j: &usize| {
        let along = loops.multipliers().iter().enumerate().map(|(row, share)| share * loops.jacobian()[row * n + j]);
        (j, dot(&mass[j * n..][..n], change) + along.sum::<f64>())
    };
    prescribed.iter().map(added).collect()
}
