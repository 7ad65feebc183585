//! Starts of runs on the loops: what is given stays as it is, and the rest is solved for.
//!
//! Positions that are not given move by Gauss–Newton steps in the metric of A + T² K, T = 100 s, over these coordinates, until φ = 0: free joints turn
//! before springs K of beams, drives, supports and connectors yield. Then rates that are not given change least in the metric of A, so that J v = 0:
//!
//! ```text
//! v_f ← v_f − A_ff⁻¹ J_fᵀ (J_f A_ff⁻¹ J_fᵀ)⁻¹ J v
//! ```

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix6};

use super::{Gap, Loops, Open};
use crate::dyn_crane::DynCrane;

/// Gaps of a whole state up to this share of the loop's size, and rates of gaps up to this share of what is in them, are those of
/// numbers that were written and read: the state is moved onto the loops.
const SHARE: f64 = 1e-6;
/// T², s²: a crane swings within some seconds, so that springs are much stiffer than inertia.
const SPRINGS: f64 = 1e4;
/// Rates below this are rounding, m/s and rad/s.
const ROUNDING: f64 = 1e-9;

/// The coordinates of a start whose positions and rates are given, by their indices in `q`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Given {
    /// Those whose position is given.
    pub positions: Vec<usize>,
    /// Those whose rate is given.
    pub rates: Vec<usize>,
}

/// Moves a start at time `t`, s, onto the loops of a crane, and its rigid drives to their motions; what is given besides does not change.
///
/// # Errors
/// The joint that is open most, or opens fastest: what is given leaves no way to close it.
pub(crate) fn close_start(
    crane: &dyn DynCrane,
    t: f64,
    (q, v): (&mut [f64], &mut [f64]),
    given: &Given,
) -> Result<(), Gap> {
    crane.prescribe(t, q, v);
    let mut loops = Loops::holding(crane, &given.positions);
    if loops.is_empty() {
        return Ok(());
    }
    let mut mass = HeldMass::with_springs(crane, &loops.prescribed);
    loops.assemble(crane, q, &mut |q, r, x| mass.solve(q, r, x)).map_err(|open| Gap::new(crane, open))?;
    let mut loops = Loops::holding(crane, &given.rates);
    let mut mass = HeldMass::new(crane, &loops.prescribed);
    loops.evaluate(crane, q, v);
    loops.choose();
    {
        let q = &*q;
        loops.factorise(&mut |r, x| mass.solve(q, r, x));
    }
    // The second time for what the first leaves by rounding.
    for _ in 0..2 {
        loops.take_along(v);
        loops.subtract(v);
    }
    loops.evaluate(crane, q, v);
    loops.opening(v).map_or(Ok(()), |open| Err(Gap::new(crane, open)))
}

/// Moves a whole state at time `t`, s, onto the loops of a crane if it is on them to the digits with which states are written.
///
/// # Errors
/// The joint that is open most, or opens fastest.
pub(crate) fn close_state(crane: &dyn DynCrane, t: f64, (q, v): (&mut [f64], &mut [f64])) -> Result<(), Gap> {
    crane.prescribe(t, q, v);
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return Ok(());
    }
    loops.evaluate(crane, q, v);
    let found = loops.open_beyond(crane).or_else(|| loops.opening(v));
    found.map_or(Ok(()), |open| Err(Gap::new(crane, open)))?;
    close_start(crane, t, (q, v), &Given::default())
}

impl Loops {
    /// Of a crane some coordinates of which do not move, besides those of rigid drives.
    fn holding(crane: &dyn DynCrane, held: &[usize]) -> Self {
        let mut loops = Self::new(crane);
        loops.prescribed.extend(held);
        loops.prescribed.sort_unstable();
        loops.prescribed.dedup();
        loops
    }

    /// The widest gap of those that are too wide for the size of their loop, the longest way that a rotation of 1 rad moves its joint, as last evaluated.
    fn open_beyond(&self, crane: &dyn DynCrane) -> Option<Open> {
        let mut first = 0;
        let mut worst: Option<Open> = None;
        for joint in crane.loop_joints() {
            let range = first..first + joint.equations.len();
            first = range.end;
            let forces = range.clone().zip(&*joint.equations).filter(|(_, info)| !info.is_moment);
            let entries = forces.flat_map(|(row, _)| &self.jacobian[row * self.n..][..self.n]);
            let size = entries.fold(0.0, |size: f64, entry| size.max(entry.abs()));
            for (equation, info) in range.zip(&*joint.equations) {
                let gap = self.states[equation].x.abs();
                let allowed = SHARE * if info.is_moment || size == 0.0 { 1.0 } else { size };
                // The comparison is false for NaN.
                let is_closed = gap <= allowed;
                if !is_closed && worst.is_none_or(|known| gap > known.gap) {
                    worst = Some(Open { equation, gap, is_rate: false });
                }
            }
        }
        worst
    }

    /// The equation whose gap grows fastest, if one grows beyond rounding of the rates, as last evaluated.
    fn opening(&self, v: &[f64]) -> Option<Open> {
        let grows = |equation: usize| {
            let gap = self.states[equation].y.abs();
            let row = &self.jacobian[equation * self.n..][..self.n];
            let parts: f64 = row.iter().zip(v).map(|(entry, rate)| (entry * rate).abs()).sum();
            let is_closed = gap <= (SHARE * parts).max(ROUNDING);
            (!is_closed).then_some(Open { equation, gap, is_rate: true })
        };
        (0..self.states.len()).filter_map(grows).max_by(|one, other| one.gap.total_cmp(&other.gap))
    }
}

/// The mass matrix of the coordinates that move, factorised at a pose.
struct HeldMass<'a> {
    crane: &'a dyn DynCrane,
    held: Vec<usize>,
    /// T² K is added.
    has_springs: bool,
    pose: Vec<f64>,
    factors: Option<Cholesky<f64, Dyn>>,
}

impl<'a> HeldMass<'a> {
    fn new(crane: &'a dyn DynCrane, held: &[usize]) -> Self {
        Self { crane, held: held.to_vec(), has_springs: false, pose: Vec::new(), factors: None }
    }

    /// With the springs, each times [`SPRINGS`].
    fn with_springs(crane: &'a dyn DynCrane, held: &[usize]) -> Self {
        Self { has_springs: true, ..Self::new(crane, held) }
    }

    /// Adds the stiffness of springs on single coordinates, over the base's, and of connectors.
    fn add_springs(&self, q: &[f64], mass: &mut DMatrix<f64>) {
        let mut joints = vec![[0.0; 2]; q.len()];
        self.crane.joint_stiffness_and_damping(&mut joints);
        joints.iter().enumerate().for_each(|(j, [stiffness, _])| mass[(j, j)] += SPRINGS * stiffness);
        let mut base = Matrix6::zeros();
        self.crane.base_stiffness(q, &vec![0.0; q.len()], base.as_mut_slice());
        let size = q.len().min(6);
        let mut block = mass.view_mut((0, 0), (size, size));
        block += base.view((0, 0), (size, size)) * SPRINGS;
        let tensions = self.crane.connector_tensions_at(0.0, q, &vec![0.0; q.len()]);
        let mut rows = vec![0.0; tensions.len() * q.len()];
        self.crane.connector_jacobians(q, &mut rows);
        for (tension, row) in tensions.iter().zip(rows.chunks_exact(q.len().max(1))) {
            let row = DVector::from_column_slice(row);
            mass.ger(SPRINGS * tension.stiffness.max(0.0), &row, &row, 1.0);
        }
    }

    /// `A_ff⁻¹ r_f`; 0 for coordinates that are held, and everywhere without inertia: a run then says so.
    fn solve(&mut self, q: &[f64], r: &[f64], x: &mut [f64]) {
        if self.pose != q {
            let mut mass = DMatrix::zeros(q.len(), q.len());
            self.crane.mass_matrix(q, mass.as_mut_slice());
            if self.has_springs {
                self.add_springs(q, &mut mass);
            }
            for &j in &self.held {
                mass.row_mut(j).fill(0.0);
                mass.column_mut(j).fill(0.0);
                mass[(j, j)] = 1.0;
            }
            self.factors = mass.cholesky();
            self.pose = q.to_vec();
        }
        let mut right = DVector::from_column_slice(r);
        self.held.iter().for_each(|j| right[*j] = 0.0);
        match &self.factors {
            Some(factors) => x.copy_from_slice(factors.solve(&right).as_slice()),
            None => x.fill(0.0),
        }
    }
}
