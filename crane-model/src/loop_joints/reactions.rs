//! What loop joints transmit, and what to say about them at a pose.

use super::{Loops, OPEN, Open, cholesky, dot, solve_cholesky};
use crate::{
    CoordinateRole, Description, Wrench,
    description::{LoopEquationInfo, LoopJointInfo},
    dyn_crane::{DynDynamics, DynInternalForces, DynModel, DynStatics},
    wrench,
};

/// Sine of the angle to a dead centre below which there is a caution: 2°.
pub const DEAD_CENTRE: f64 = 0.035;

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

/// The equations whose forces and moments cannot be determined at a pose, because they depend on others: `pin P along z`.
pub fn undetermined(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let dependent = (0..loops.states.len()).filter(|row| !loops.independence.is_kept(*row));
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
    let unknown = (!undetermined.is_empty()).then(|| {
        format!(
            "reactions of {} cannot be determined: other joints hold the same; they are shown as 0",
            undetermined.join(", ")
        )
    });
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    let distance = loops.distance_to_dead_centre();
    let near = (distance < DEAD_CENTRE).then(|| {
        let last = loops.independent().last().copied().unwrap_or(0);
        format!(
            "the loop of {} is {:.2}° from a dead centre: its forces are large and its motion beyond is not determined",
            equation_of(crane.loop_joints(), last).0.name,
            distance.asin().to_degrees()
        )
    });
    near.into_iter().chain(unknown).collect()
}

/// λ that the accelerations of a motion require:
///
/// ```text
/// Jᵀ λ = e + f + Cᵀ p − A a
/// ```
///
/// in the rows of the coordinates without drives if these determine λ, since the efforts of drives that hold the crane elsewhere are not
/// known here, otherwise in all that are not prescribed. The pushes p of cylinders with a valve are unknown, too: each follows from the row
/// of its joint.
pub(crate) fn required(crane: &(impl DynDynamics + ?Sized), t: f64, [q, v, a]: [&[f64]; 3]) -> Vec<f64> {
    let n = q.len();
    let (mut mass, mut rest, mut forces) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
    crane.mass_matrix(q, &mut mass);
    crane.bias(q, v, &mut rest);
    crane.forces(t, q, v, &mut forces);
    for (i, (rest, force)) in rest.iter_mut().zip(&forces).enumerate() {
        *rest += force - dot(&mass[i * n..][..n], a);
    }
    let roles: Vec<CoordinateRole> = crane.description().coordinates.iter().map(|info| info.role).collect();
    let free = |i: usize| roles[i] != CoordinateRole::Prescribed;
    let undriven = |i: usize| free(i) && roles[i] != CoordinateRole::Driven;
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, v);
    loops.choose();
    let all = loops.independent().len();
    let counts = |counts: &dyn Fn(usize) -> bool| (0..n).filter(|&i| !counts(i)).collect::<Vec<_>>();
    let mut without_drives = Loops::new(crane);
    without_drives.prescribed = counts(&undriven);
    without_drives.evaluate(crane, q, v);
    for system in [&mut without_drives, &mut loops] {
        take_out_pushes(crane, q, &mut system.jacobian, &mut rest);
        system.choose();
    }
    if without_drives.independent().len() == all {
        balanced(&mut without_drives, &rest)
    } else {
        loops.prescribed = counts(&free);
        loops.choose();
        balanced(&mut loops, &rest)
    }
}

/// Takes the unknown pushes of cylinders with a valve out of `Jᵀ λ = r + Cᵀ p`. With j the joint that a cylinder moves and C its row, the push is
/// `((Jᵀ λ)_j − r_j)/C_j`, and there remains
///
/// ```text
/// (J − J_j C/C_j)ᵀ λ = r − r_j C/C_j
/// ```
fn take_out_pushes(crane: &(impl DynModel + ?Sized), q: &[f64], jacobian: &mut [f64], r: &mut [f64]) {
    let Description { drives, cylinders, .. } = crane.description();
    if !crane.description().has_valves() {
        return;
    }
    let n = q.len();
    let mut rows = vec![0.0; cylinders.len() * n];
    crane.cylinder_jacobians(q, &mut rows);
    for (cylinder, row) in cylinders.iter().zip(rows.chunks_exact(n)).filter(|(cylinder, _)| cylinder.valve.is_some()) {
        let joint = drives[cylinder.drive].coordinate;
        for numbers in jacobian.chunks_exact_mut(n).chain([&mut *r]) {
            let share = numbers[joint] / row[joint];
            numbers.iter_mut().zip(row).for_each(|(number, entry)| *number -= share * entry);
            numbers[joint] = 0.0;
        }
    }
}

/// `Jᵀ λ`: the generalized forces that loop joints resist with.
pub(crate) fn generalized(crane: &(impl DynModel + ?Sized), q: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let mut rows = vec![0.0; multipliers.len() * q.len()];
    crane.loop_jacobians(q, &mut rows);
    let mut sum = vec![0.0; q.len()];
    for (share, row) in multipliers.iter().zip(rows.chunks_exact(q.len())) {
        sum.iter_mut().zip(row).for_each(|(sum, entry)| *sum += share * entry);
    }
    sum
}

/// λ of a crane at rest, with loads and winches as at time `t` and the drives at given positions, by coordinate: `Jᵀ λ = −∂E_p/∂q`.
pub(crate) fn at_rest(crane: &(impl DynStatics + ?Sized), t: f64, positions: &[f64], q: &[f64]) -> Vec<f64> {
    let mut residual = vec![0.0; q.len()];
    crane.static_residual(t, q, positions, &mut residual);
    for entry in &mut residual {
        *entry = -*entry;
    }
    let mut loops = Loops::new(crane);
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    loops.choose();
    balanced(&mut loops, &residual)
}

/// λ with `Jᵀ λ = r` in the coordinates that are not `prescribed`, by least squares of the independent equations.
fn balanced(loops: &mut Loops, r: &[f64]) -> Vec<f64> {
    let free: Vec<f64> = (0..r.len()).map(|i| f64::from(u8::from(!loops.prescribed.contains(&i)))).collect();
    let kept = loops.independent().to_vec();
    let (n, size) = (loops.n, kept.len());
    let row = |row: usize| -> Vec<f64> {
        loops.jacobian()[row * n..][..n].iter().zip(&free).map(|(entry, free)| entry * free).collect()
    };
    let rows: Vec<Vec<f64>> = kept.iter().map(|&equation| row(equation)).collect();
    let lengths: Vec<f64> = rows.iter().map(|row| dot(row, row).sqrt()).collect();
    let mut gram = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..=i {
            gram[i * size + j] = dot(&rows[i], &rows[j]) / (lengths[i] * lengths[j]);
        }
    }
    cholesky(&mut gram, size);
    let mut shares: Vec<f64> = rows.iter().zip(&lengths).map(|(row, length)| dot(row, r) / length).collect();
    solve_cholesky(&gram, size, &mut shares);
    let mut multipliers = vec![0.0; loops.states.len()];
    for ((&equation, share), length) in kept.iter().zip(shares).zip(lengths) {
        multipliers[equation] = share / length;
    }
    multipliers
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
