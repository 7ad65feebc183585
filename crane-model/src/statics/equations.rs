//! The equations of an equilibrium, `r(q) = 0`, and their derivative.

use nalgebra::{DMatrix, DVector};

use crate::{CoordinateRole, Description, dyn_crane::DynStatics};

/// The equations that a pose at rest satisfies.
pub(super) trait Equations {
    /// The crane that rests.
    fn crane(&self) -> &dyn DynStatics;

    /// `r(q)`: N for translations, N m for rotations.
    fn residual(&self, q: &DVector<f64>) -> DVector<f64> {
        let mut residual = DVector::zeros(q.len());
        self.crane().static_residual(q.as_slice(), residual.as_mut_slice());
        residual
    }

    /// `∂r/∂q`
    fn stiffness(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let mut stiffness = DMatrix::zeros(q.len(), q.len());
        self.crane().tangent_stiffness(q.as_slice(), stiffness.as_mut_slice());
        stiffness
    }
}

/// `∂E_p/∂q = 0` at t = 0.
pub(super) struct AtStart<'a>(pub &'a dyn DynStatics);

impl Equations for AtStart<'_> {
    fn crane(&self) -> &dyn DynStatics {
        self.0
    }
}

/// The equilibrium with the drives at given positions, and loads and winches as at another time.
pub(super) struct Held<'a> {
    crane: &'a dyn DynStatics,
    positions: &'a [f64],
    /// Prescribed positions and rates of the drives at t = 0.
    motions: Vec<[f64; 2]>,
    /// The positions, and the prescribed ones at t = 0, at the indices of their coordinates.
    by_coordinate: [Vec<f64>; 2],
    /// The prescribed rates, at which dampers of drives are unloaded, at the indices of their coordinates.
    rates: Vec<f64>,
    /// Time of loads and winches, s.
    t: f64,
}

impl<'a> Held<'a> {
    /// With the drives at `positions`, one per drive, and loads and winches as at time `t`, s.
    pub(super) fn new(crane: &'a dyn DynStatics, t: f64, positions: &'a [f64]) -> Self {
        let Description { drives, coordinates, .. } = crane.description();
        let n = coordinates.len();
        let (mut motions, mut rates, mut by_coordinate) =
            (vec![[0.0; 2]; drives.len()], vec![0.0; n], [vec![0.0; n], vec![0.0; n]]);
        crane.drive_motions(0.0, &mut motions);
        for (drive, (position, [start, rate])) in drives.iter().zip(positions.iter().zip(&motions)) {
            rates[drive.coordinate] = *rate;
            by_coordinate[0][drive.coordinate] = *position;
            by_coordinate[1][drive.coordinate] = *start;
        }
        Self { crane, positions, motions, by_coordinate, rates, t }
    }

    /// Sets the coordinates of rigid drives to the positions of these drives.
    pub(super) fn prescribe(&self, q: &mut [f64]) {
        let drives = self.crane.description().drives.iter().zip(self.positions);
        for (drive, position) in drives.filter(|(drive, _)| self.is_rigid(drive.coordinate)) {
            q[drive.coordinate] = *position;
        }
    }

    /// Whether a rigid drive prescribes the coordinate, which then has no residual.
    fn is_rigid(&self, coordinate: usize) -> bool {
        self.crane.description().coordinates[coordinate].role == CoordinateRole::Prescribed
    }

    /// Whether a drive with a spring moves the coordinate: neither is it rigid, nor does oil move the joint.
    fn is_spring(&self, coordinate: usize) -> bool {
        let Description { drives, cylinders, .. } = self.crane.description();
        let mut by_oil = cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
        !self.is_rigid(coordinate) && !by_oil.any(|cylinder| drives[cylinder.drive].coordinate == coordinate)
    }

    /// Signs and positions with which the forces of cylinders with a valve are added to the residual at t = 0; none without valves.
    fn holding(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let valves = self.crane.description().has_valves();
        let [held, at_start] = &self.by_coordinate;
        [(1.0, at_start.as_slice()), (-1.0, held)].into_iter().filter(move |_| valves)
    }

    /// The pose at which the drives with springs, at their positions of t = 0, are stretched as much as they are here: the effort of such
    /// a drive depends only on the distance of its coordinate from its position.
    fn shifted(&self, q: &DVector<f64>) -> DVector<f64> {
        let mut shifted = q.clone();
        let drives = self.crane.description().drives.iter().zip(self.positions.iter().zip(&self.motions));
        for (drive, (position, [start, _])) in drives {
            shifted[drive.coordinate] -= position - start;
        }
        shifted
    }
}

impl Equations for Held<'_> {
    fn crane(&self) -> &dyn DynStatics {
        self.crane
    }

    fn residual(&self, q: &DVector<f64>) -> DVector<f64> {
        let (crane, description) = (self.crane, self.crane.description());
        let (mut residual, mut forces) = (AtStart(crane).residual(q), vec![0.0; q.len()]);
        for (sign, q) in [(1.0, q), (-1.0, &self.shifted(q))] {
            crane.drive_forces_at_rest(q.as_slice(), &mut forces);
            for drive in description.drives.iter().filter(|drive| self.is_spring(drive.coordinate)) {
                residual[drive.coordinate] += sign * forces[drive.coordinate];
            }
        }
        let [loads_change, winches_move] =
            [!description.loads.is_empty(), !description.connectors.is_empty()].map(|any| any && self.t != 0.0);
        let mut add = |sign: f64, forces: &[f64]| {
            for (index, force) in forces.iter().enumerate().filter(|(index, _)| !self.is_rigid(*index)) {
                residual[index] += sign * force;
            }
        };
        for (sign, positions) in self.holding() {
            crane.holding_forces(q.as_slice(), positions, &mut forces);
            add(sign, &forces);
        }
        for (sign, t) in [(1.0, 0.0), (-1.0, self.t)] {
            if loads_change {
                crane.load_forces(t, q.as_slice(), &mut forces);
                add(sign, &forces);
            }
            if winches_move {
                crane.connector_forces_at_rest(t, q.as_slice(), &mut forces);
                add(sign, &forces);
            }
        }
        residual
    }

    /// The stiffness of drives with limited effort is that at their stretch; that of loads is taken at t = 0.
    fn stiffness(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let mut stiffness = AtStart(self.crane).stiffness(q);
        let drives = &self.crane.description().drives;
        let mut limits = vec![[0.0; 2]; drives.len()];
        for (sign, q) in [(-1.0, q), (1.0, &self.shifted(q))] {
            self.crane.drive_limits(0.0, q.as_slice(), &self.rates, &mut limits);
            for (drive, [_, own]) in drives.iter().zip(&limits).filter(|(drive, _)| self.is_spring(drive.coordinate)) {
                stiffness[(drive.coordinate, drive.coordinate)] += sign * own;
            }
        }
        let mut change = DMatrix::zeros(q.len(), q.len());
        for (sign, positions) in self.holding() {
            self.crane.holding_stiffness(q.as_slice(), positions, change.as_mut_slice());
            stiffness -= &change * sign;
        }
        let winches_move = !self.crane.description().connectors.is_empty() && self.t != 0.0;
        for (sign, t) in [(-1.0, 0.0), (1.0, self.t)].into_iter().filter(|_| winches_move) {
            self.crane.connector_stiffness(t, q.as_slice(), change.as_mut_slice());
            stiffness += &change * sign;
        }
        stiffness
    }
}
