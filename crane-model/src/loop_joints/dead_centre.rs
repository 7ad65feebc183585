//! How far loops are from a dead centre, where joints move the point of a loop joint in too few directions.
//!
//! Column j of the matrix D has, joint by joint, the rows of J that coordinate j moves, in the axes of the joint's first body: those of forces
//! over the greatest distance L of the point from an axis of the loop, those of moments as they are. It is divided by the length that
//! it would have if the point were free: by the full velocity of the point, before J projects it. What is left are directions, which do not
//! depend on units, masses, the size of the crane or how it lies in the world. A `rod` counts as what it stands for, a link that can turn: with
//! three rows, and its own rotations as two columns.
//!
//! ```text
//! G = D Dᵀ,      1/δ_k² = λ_max((G⁺)_kk),      angle = 2 asin(δ_k/√2)
//! ```
//!
//! `(G⁺)_kk` is the block of joint k: `δ_k` is the least singular value of D where there is one loop, and the distance of its equations from
//! those of all others where there are more. Of two directions the angle is the one between them. Equations that are dependent at every
//! pose are not counted: G⁺ leaves out as many of the least eigenvalues as are zero in general. Couplings have no directions: a coordinate that
//! one ties to a coordinate that is held counts as held.

use std::ops::Range;

use crane_quantities::Count;
use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen, Vector3};

use super::Loops;
use crate::{CoordinateKind, CoordinateRole, LoopJointInfo, dyn_crane::Functions};

/// Angle to a dead centre below which there is a caution, rad: 2°.
pub const DEAD_CENTRE: f64 = 0.035;
/// Eigenvalues of G below this are zero: a sine of 1e-5, as for the choice of independent equations.
const DEPENDENT: f64 = 1e-10;
/// The share of L that a joint must be away from the point to count fully: one that nearly passes through it hardly moves it.
const LEVER: f64 = 0.1;
/// Step of the differences that give the full velocities, rad and m: their error, 1e-11, is far below what matters of a length.
const STEP: f64 = 1e-5;
/// Lengths of columns below this are zero.
const NOTHING: f64 = 1e-9;
/// How far away the pose is at which the number of equations that are independent in general is counted, rad and shares of L.
const NEARBY: f64 = 0.1;

/// A loop near a dead centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeadCentre {
    /// The index of its joint.
    pub joint: usize,
    /// The angle from it, rad.
    pub angle: f64,
}

/// Which columns of D count.
#[derive(Clone, Copy, PartialEq)]
enum Columns {
    /// Those of all coordinates: are the equations independent?
    All,
    /// Those that no drive and no stiffness of a beam holds: do the drives determine the loops?
    Free,
}

/// Both choices.
const COLUMNS: [Columns; 2] = [Columns::All, Columns::Free];

/// The matrix D of a pose.
struct Directions {
    /// The joints and their rows.
    joints: Vec<(usize, Range<usize>)>,
    /// D.
    matrix: DMatrix<f64>,
    /// D without the columns that something holds; `None` if no drive moves a loop.
    free: Option<DMatrix<f64>>,
    /// L of the largest loop, m.
    size: f64,
}

impl Directions {
    /// Of the loops of a crane, evaluated at the pose; without equations if there are none but pads, which hold beams and close no linkage, and
    /// couplings.
    fn new(crane: &dyn Functions, loops: &Loops, q: &[f64]) -> Self {
        let (n, all) = (q.len(), crane.loop_joints());
        let mut joints = Vec::new();
        let (mut equation, mut rows) = (0, 0);
        for (index, joint) in all.iter().enumerate() {
            let range = equation..equation + joint.equations.len();
            equation = range.end;
            if closes_linkage(joint) {
                let count = if joint.is_rod() { 3 } else { range.len() };
                joints.push((index, range, rows..rows + count));
                rows += count;
            }
        }
        let in_order: Vec<usize> = joints.iter().map(|(index, ..)| *index).collect();
        let motions = motions(crane, q, &in_order);
        let coordinates = &crane.description().coordinates;
        let turns = |j: usize| coordinates[j].kind == CoordinateKind::Rotation;
        let mut matrix = DMatrix::zeros(rows, n);
        let mut squares = vec![0.0; n];
        let (mut extra, mut size) = (Vec::new(), 0.0_f64);
        for ((index, range, rows), (apart, velocities)) in joints.iter().zip(&motions) {
            let joint = &all[*index];
            let greatest = (0..n).filter(|j| turns(*j)).map(|j| velocities[j].norm()).fold(0.0, f64::max);
            let scale = if greatest > 0.0 { greatest } else { 1.0 };
            size = size.max(scale);
            let across = joint.is_rod().then(|| across(apart));
            for j in 0..n {
                let entry = |equation: usize| loops.jacobian()[equation * n + j];
                let (mut forces, mut moments) = (0.0, 0.0);
                for (row, (equation, info)) in rows.clone().zip(range.clone().zip(&*joint.equations)) {
                    let (unit, sum) = if info.is_moment { (1.0, &mut moments) } else { (scale, &mut forces) };
                    matrix[(row, j)] = entry(equation) / unit;
                    *sum += matrix[(row, j)] * matrix[(row, j)];
                }
                for (row, way) in rows.clone().skip(1).zip(across.iter().flatten()) {
                    matrix[(row, j)] = way.dot(&velocities[j]) / scale;
                }
                squares[j] += f64::max(forces, velocities[j].norm_squared() / (scale * scale)) + moments;
            }
            if across.is_some() {
                extra.extend(rows.clone().skip(1));
            }
        }
        for (j, mut column) in matrix.column_iter_mut().enumerate() {
            let length = squares[j].sqrt();
            let least = if turns(j) { LEVER } else { 0.0 };
            column *= if length > NOTHING { 1.0 / length.max(least) } else { 0.0 };
        }
        let is_driven = |role| matches!(role, CoordinateRole::Driven | CoordinateRole::Prescribed);
        let driven = tied(crane, loops, is_driven);
        let held = tied(crane, loops, |role| role != CoordinateRole::Passive);
        let moved = |j: &usize| squares[*j].sqrt() > NOTHING;
        let with = |columns: Vec<usize>| {
            let mut own = DMatrix::zeros(rows, columns.len() + extra.len());
            for (place, j) in columns.iter().enumerate() {
                own.set_column(place, &matrix.column(*j));
            }
            for (place, row) in extra.iter().enumerate() {
                own[(*row, columns.len() + place)] = 1.0;
            }
            own
        };
        let driven = (0..n).filter(moved).any(|j| driven[j]);
        let free = driven.then(|| with((0..n).filter(|j| moved(j) && !held[*j]).collect()));
        let matrix = with((0..n).filter(moved).collect());
        Self { joints: joints.into_iter().map(|(index, _, rows)| (index, rows)).collect(), matrix, free, size }
    }

    fn rows(&self) -> usize {
        self.matrix.nrows()
    }

    /// G; `None` if no drive moves a loop and only free columns count.
    fn products(&self, columns: Columns) -> Option<DMatrix<f64>> {
        let matrix = match columns {
            Columns::All => Some(&self.matrix),
            Columns::Free => self.free.as_ref(),
        }?;
        Some(matrix * matrix.transpose())
    }

    /// The number of independent equations.
    fn rank(&self, columns: Columns) -> usize {
        let products = self.products(columns);
        let values = products.map(|products| products.symmetric_eigenvalues());
        values.map_or(0, |values| values.iter().filter(|value| **value > DEPENDENT).count())
    }

    /// The loop that is nearest to a dead centre, if `rank` equations are independent in general.
    fn nearest(&self, columns: Columns, rank: usize) -> Option<DeadCentre> {
        let products = self.products(columns)?;
        let inverse = inverse(&products, self.rows() - rank);
        let angle = |rows: &Range<usize>| {
            let block = inverse.view((rows.start, rows.start), (rows.len(), rows.len())).into_owned();
            let distance = 1.0 / block.symmetric_eigenvalues().max().sqrt();
            2.0 * (distance * std::f64::consts::FRAC_1_SQRT_2).min(1.0).asin()
        };
        let of_joints = self.joints.iter().map(|(joint, rows)| DeadCentre { joint: *joint, angle: angle(rows) });
        of_joints.reduce(|one, other| if other.angle < one.angle { other } else { one })
    }
}

/// Whether the equations of a joint are directions of a linkage.
fn closes_linkage(joint: &LoopJointInfo) -> bool {
    !joint.is_pad() && !joint.is_coupling()
}

/// Which coordinates have a role, or are coupled to one that has it.
fn tied(crane: &dyn Functions, loops: &Loops, has_role: impl Fn(CoordinateRole) -> bool) -> Vec<bool> {
    let coordinates = &crane.description().coordinates;
    let n = coordinates.len();
    let mut held: Vec<bool> = coordinates.iter().map(|info| has_role(info.role)).collect();
    let mut equation = 0;
    let mut coupled: Vec<Vec<usize>> = Vec::new();
    for joint in crane.loop_joints() {
        if joint.is_coupling() {
            let row = &loops.jacobian()[equation * n..][..n];
            coupled.push((0..n).filter(|j| row[*j] != 0.0).collect());
        }
        equation += joint.equations.len();
    }
    // A coordinate that is tied to one that is tied to another is known one pass later.
    for _ in &coupled {
        for both in &coupled {
            let is_held = both.iter().any(|j| held[*j]);
            for j in both {
                held[*j] = is_held;
            }
        }
    }
    held
}

/// `G⁺` without the given number of least eigenvalues, which are zero at every pose.
fn inverse(products: &DMatrix<f64>, zeros: usize) -> DMatrix<f64> {
    /// Rounding of eigenvalues.
    const ROUNDING: f64 = 1e-16;
    if zeros == 0
        && let Some(factors) = products.clone().cholesky()
    {
        return factors.inverse();
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = products.clone().symmetric_eigen();
    let mut order: Vec<usize> = (0..eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigenvalues[a].total_cmp(&eigenvalues[b]));
    let mut inverses = DVector::zeros(eigenvalues.len());
    for &index in &order[zeros.min(order.len())..] {
        inverses[index] = 1.0 / eigenvalues[index].max(ROUNDING);
    }
    &eigenvectors * DMatrix::from_diagonal(&inverses) * eigenvectors.transpose()
}

/// Two directions across another one.
fn across(along: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let one = along.cross(&Vector3::ith(along.iamin(), 1.0)).normalize();
    [one, along.cross(&one).normalize()]
}

/// Of each joint the way from its first point to its second one, and the velocity of the second relative to the first body for a unit rate of
/// each coordinate, in the axes of the first body; m, m/rad and 1.
fn motions(crane: &dyn Functions, q: &[f64], joints: &[usize]) -> Vec<(Vector3<f64>, Vec<Vector3<f64>>)> {
    let (description, all) = (crane.description(), crane.loop_joints());
    let mut frames = vec![Matrix4::identity(); description.bodies.len()];
    let mut attachments = vec![Vector3::zeros(); crane.count(Count::Attachments)];
    crane.attachments(&mut attachments);
    // Couplings, which have no points, come last.
    let (places, _) = attachments[description.points_of_connectors()..].as_chunks::<2>();
    let relative = |frames: &[Matrix4<f64>], index: usize| {
        let Some(ends) = &all[index].ends else { return Vector3::zeros() };
        let in_world = |end: usize| {
            let at = places[index][end].push(1.0);
            ends[end].body.map_or(at, |body| frames[body] * at).xyz()
        };
        let [one, other] = [0, 1].map(in_world);
        match ends[0].body {
            Some(body) => frames[body].fixed_view::<3, 3>(0, 0).transpose() * (other - one),
            None => other - one,
        }
    };
    crane.transforms(q, &mut frames);
    let zeros = vec![Vector3::zeros(); q.len()];
    let mut motions: Vec<_> = joints.iter().map(|joint| (relative(&frames, *joint), zeros.clone())).collect();
    let mut moved = q.to_vec();
    for j in 0..q.len() {
        let spans = |joint: &usize| (all[*joint].spanned[0]..all[*joint].spanned[1]).contains(&j);
        if !joints.iter().any(spans) {
            continue;
        }
        for sign in [1.0, -1.0] {
            moved[j] = q[j] + sign * STEP;
            crane.transforms(&moved, &mut frames);
            for (joint, (_, velocities)) in joints.iter().zip(&mut motions).filter(|(joint, _)| spans(joint)) {
                velocities[j] += sign / (2.0 * STEP) * relative(&frames, *joint);
            }
        }
        moved[j] = q[j];
    }
    motions
}

/// Watches how near the loops of a crane come to dead centres, over poses.
pub(super) struct DeadCentres {
    /// Numbers of equations that are independent in general, of all columns and of free ones, once known.
    ranks: Option<[usize; 2]>,
}

impl DeadCentres {
    pub const fn new() -> Self {
        Self { ranks: None }
    }

    /// The loop nearest to a dead centre, where its equations depend on each other, and the one nearest to a dead centre of its drives, where they
    /// do not determine it; at a pose at which `loops` are closed and evaluated. The second is `None` if no drive moves a loop, or if drives hold more
    /// than the loops leave free.
    pub fn nearest(&mut self, crane: &dyn Functions, loops: &Loops, q: &[f64]) -> [Option<DeadCentre>; 2] {
        let directions = Directions::new(crane, loops, q);
        if directions.rows() == 0 {
            return [None; 2];
        }
        let known = self.ranks.unwrap_or([0; 2]);
        let mut ranks = known;
        // A rank that is full cannot grow.
        if known.iter().any(|rank| *rank < directions.rows()) {
            ranks = std::array::from_fn(|k| known[k].max(directions.rank(COLUMNS[k])));
        }
        if self.ranks.is_none()
            && ranks.iter().any(|rank| *rank < directions.rows())
            && let Some(nearby) = closed_nearby(crane, q, directions.size)
        {
            ranks = std::array::from_fn(|k| ranks[k].max(nearby.rank(COLUMNS[k])));
        }
        self.ranks = Some(ranks);
        let [all, free] = ranks;
        let of_drives = (all == free).then(|| directions.nearest(Columns::Free, free)).flatten();
        [directions.nearest(Columns::All, all), of_drives]
    }
}

/// The directions at another pose with closed loops, from which a dead centre differs.
fn closed_nearby(crane: &dyn Functions, q: &[f64], size: f64) -> Option<Directions> {
    let mut pose = q.to_vec();
    let joints = crane.loop_joints();
    for (j, (number, info)) in pose.iter_mut().zip(&*crane.description().coordinates).enumerate() {
        let spans = |joint: &LoopJointInfo| closes_linkage(joint) && (joint.spanned[0]..joint.spanned[1]).contains(&j);
        if joints.iter().any(spans) && !info.role.is_element() {
            let unit = if info.kind == CoordinateKind::Rotation { 1.0 } else { size };
            // Any numbers in which no linkage has its branch.
            *number += NEARBY * unit * (1.0 + 2.4 * j as f64).cos();
        }
    }
    let mut loops = Loops::new(crane);
    loops.assemble(crane, &mut pose, &mut |_, r, x| x.copy_from_slice(r)).ok()?;
    loops.evaluate(crane, &pose, &vec![0.0; q.len()]);
    Some(Directions::new(crane, &loops, &pose))
}
