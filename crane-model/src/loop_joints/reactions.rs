//! What loop joints transmit, and what to say about them at a pose.

use super::{
    Loops, OPEN, Open,
    dead_centre::{DEAD_CENTRE, DeadCentre, DeadCentres},
    dot,
    drives::{fighting_valves, prescribed_too_much},
};
use crate::{
    LoopEquationInfo, LoopJointInfo, Wrench,
    dyn_crane::{DynCrane, Functions},
    wrench,
};

/// A loop that is open at a pose, or opens.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The joint.
    pub joint: String,
    /// The direction; empty for a rod and a coupling.
    pub direction: String,
    /// Whether it is a coupling.
    pub is_coupling: bool,
    /// The gap, m or rad, or its rate, m/s or rad/s.
    pub gap: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl Gap {
    /// Of an equation of a crane.
    pub(crate) fn new(crane: &dyn Functions, Open { equation, gap, is_rate }: Open) -> Self {
        let (joint, info) = equation_of(crane.loop_joints(), equation);
        let is_coupling = joint.is_coupling();
        // That of an axis is a sine.
        let gap = if info.is_moment && !is_coupling && !is_rate && gap <= 1.0 { gap.asin() } else { gap };
        let unit = if is_rate { info.rate_unit() } else { info.unit() };
        Self { joint: joint.name.to_string(), direction: info.direction.to_string(), is_coupling, gap, unit }
    }
}

impl std::fmt::Display for Gap {
    /// `joint p is open by 3.20 mm along x`
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { joint, direction, is_coupling, gap, unit } = self;
        let along = if direction.is_empty() { "its length" } else { direction };
        match *unit {
            "m" if *is_coupling => write!(f, "coupling {joint} is off by {:.3} mm", gap * 1e3),
            "m/s" if *is_coupling => write!(f, "coupling {joint} slips at {:.3} mm/s", gap * 1e3),
            "rad/s" if *is_coupling => write!(f, "coupling {joint} slips at {:.3} °/s", gap.to_degrees()),
            _ if *is_coupling => write!(f, "coupling {joint} is off by {:.3}°", gap.to_degrees()),
            "m" => write!(f, "joint {joint} is open by {:.3} mm along {along}", gap * 1e3),
            "m/s" => write!(f, "joint {joint} opens at {:.3} mm/s along {along}", gap * 1e3),
            "rad/s" => write!(
                f,
                "the axes of joint {joint} turn against each other at {:.3} °/s about {direction}",
                gap.to_degrees()
            ),
            _ => write!(f, "the axes of joint {joint} differ by {:.3}° about {direction}", gap.to_degrees()),
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
pub fn gap_at(crane: &dyn DynCrane, q: &[f64]) -> Option<Gap> {
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return None;
    }
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    let widest = loops.widest();
    (widest.gap > OPEN).then(|| Gap::new(crane, widest))
}

/// Indices of the equations that are independent at a pose, among those of all joints.
pub fn independent(crane: &dyn DynCrane, q: &[f64]) -> Vec<usize> {
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    loops.independent().to_vec()
}

/// The equations whose forces and moments cannot be determined at a pose, because they depend on others: `pin P along z`.
pub fn undetermined(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let dependent = (0..loops.states.len()).filter(|row| !loops.is_independent(*row));
    let name = |row| {
        let (joint, LoopEquationInfo { direction, is_moment }) = equation_of(crane.loop_joints(), row);
        let way = if *is_moment { "about" } else { "along" };
        match direction.as_str() {
            "" => format!("{} {}", joint.kind, joint.name),
            direction => format!("{} {} {way} {direction}", joint.kind, joint.name),
        }
    };
    dependent.map(name).collect()
}

/// A caution about the loops of a crane.
#[derive(Clone, Debug, PartialEq)]
pub enum Caution {
    /// The equations of a joint's loop nearly depend on each other.
    DeadCentre {
        /// The joint.
        joint: String,
        /// How far it is from the dead centre, rad.
        angle: f64,
    },
    /// The joints without a drive move the point of a joint nearly in too few directions.
    DeadCentreOfDrives {
        /// The joint.
        joint: String,
        /// How far it is from the dead centre, rad.
        angle: f64,
    },
    /// These cylinders with valves can push against each other.
    Fighting(Vec<String>),
    /// What these equations transmit is not determined.
    Undetermined(Vec<String>),
}

impl Caution {
    /// Whether it is of the kind of another one.
    pub fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// The angle from a dead centre, rad.
    pub fn angle(&self) -> Option<f64> {
        match self {
            Self::DeadCentre { angle, .. } | Self::DeadCentreOfDrives { angle, .. } => Some(*angle),
            Self::Fighting(_) | Self::Undetermined(_) => None,
        }
    }
}

impl std::fmt::Display for Caution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::DeadCentre { joint, angle } => write!(
                f,
                "the loop of {joint} is {:.2}° from a dead centre: its forces are large and its motion beyond is not determined",
                angle.to_degrees()
            ),
            Self::DeadCentreOfDrives { joint, angle } => write!(
                f,
                "the loop of {joint} is {:.2}° from a dead centre of its drives: they hardly hold it, and which way it moves on is not determined",
                angle.to_degrees()
            ),
            Self::Fighting(cylinders) => write!(
                f,
                "{} hold one loop together and can push against each other: how they share its load depends on the oil trapped in them; a run \
                 begins with the smallest forces in the loop",
                cylinders.join(" and ")
            ),
            Self::Undetermined(equations) => write!(
                f,
                "reactions of {} cannot be determined: other joints hold the same; they are shown as 0",
                equations.join(", ")
            ),
        }
    }
}

/// Looks at the loops of a crane, pose by pose.
pub struct Watch<'a> {
    crane: &'a dyn DynCrane,
    loops: Loops,
    dead_centres: DeadCentres,
}

impl<'a> Watch<'a> {
    /// Of a crane.
    pub fn new(crane: &'a dyn DynCrane) -> Self {
        Self { crane, loops: Loops::new(crane), dead_centres: DeadCentres::new() }
    }

    /// Cautions about a pose, the most important first.
    pub fn cautions(&mut self, q: &[f64]) -> Vec<Caution> {
        /// As near as this to a dead centre, rad, equations are dependent because of it.
        const AT: f64 = 1e-4;
        let Self { crane, loops, .. } = self;
        if loops.is_empty() {
            return Vec::new();
        }
        let undetermined = undetermined(*crane, q);
        let is_closed = gap_at(*crane, q).is_none();
        let too_much = !prescribed_too_much(*crane, q).is_empty();
        let dead_centre = self.dead_centre(q);
        let is_at = dead_centre.as_ref().and_then(Caution::angle).is_some_and(|angle| angle < AT);
        let unknown = is_closed && !undetermined.is_empty() && !too_much && !is_at;
        self.loops.choose();
        let fighting = fighting_valves(self.crane, q, &self.loops).map(Caution::Fighting);
        let undetermined = unknown.then_some(Caution::Undetermined(undetermined));
        dead_centre.filter(|_| is_closed && !too_much).into_iter().chain(fighting).chain(undetermined).collect()
    }

    /// The dead centre to which a loop is near, if there is one.
    fn dead_centre(&mut self, q: &[f64]) -> Option<Caution> {
        let Self { crane, loops, dead_centres } = self;
        loops.evaluate(*crane, q, &vec![0.0; q.len()]);
        let near = dead_centres.nearest(*crane, loops, q);
        let name = |index: usize| crane.loop_joints()[index].name.to_string();
        let [of_loop, of_drives] = near.map(|near| near.filter(|DeadCentre { angle, .. }| *angle < DEAD_CENTRE));
        let of_loop = of_loop.map(|near| Caution::DeadCentre { joint: name(near.joint), angle: near.angle });
        of_loop.or_else(|| {
            of_drives.map(|near| Caution::DeadCentreOfDrives { joint: name(near.joint), angle: near.angle })
        })
    }
}

/// Cautions about the loops at a pose.
pub fn cautions(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    Watch::new(crane).cautions(q).iter().map(Caution::to_string).collect()
}

/// The rigid drives that hold a loop, if it is as near to a dead centre of them as it is where they moved it beyond its reach.
pub(crate) fn drives_beyond_reach(crane: &dyn Functions, q: &[f64]) -> Vec<String> {
    /// A loop that opens within a step is not yet in line, rad: 10°.
    const NEAR: f64 = 0.17;
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    let [_, of_drives] = DeadCentres::new().nearest(crane, &loops, q);
    let Some(DeadCentre { joint, .. }) = of_drives.filter(|near| near.angle < NEAR) else { return Vec::new() };
    let [first, end] = crane.loop_joints()[joint].spanned;
    let in_loop = loops.prescribed.iter().filter(|j| (first..end).contains(*j));
    in_loop.map(|j| crane.description().coordinates[*j].name.to_string()).collect()
}

/// Adds what loop joints transmit at every cut; only those that hold to the world if `to_world`.
pub(crate) fn add_to_wrenches(
    crane: &dyn DynCrane,
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
        let counts = !to_world || joint.holds_to_world();
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
pub(crate) fn on_rigid_drives(crane: &dyn Functions, q: &[f64], loops: &Loops, change: &[f64]) -> Vec<(usize, f64)> {
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
