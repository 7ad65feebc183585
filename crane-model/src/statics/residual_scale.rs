//! The distance of a pose from equilibrium, as one number.

use crane_quantities::Count;
use nalgebra::{DMatrix, DVector, Vector3};

use super::equations::Equations;
use crate::{CoordinateKind, CoordinateRole, Description, Tension};

/// Minimum ratio of the scale of forces to that of moments, 1/m, and vice versa, m: where all moments cancel, forces with lever arms of
/// several metres leave their rounding errors.
const LEAST: f64 = 1e-5;

/// Size of the forces that balance, by which the residual is measured.
///
/// Every row of `r = ∂E_p/∂q = ∂E_g/∂q − f` balances gravity against springs. A row in N cannot be compared with a row in
/// N m, and one alone may balance nothing at all (a passive hinge in equilibrium: 0 = 0). So the scale of a translation is
/// the greatest force that any translation balances at the guess, that of a rotation the greatest moment of any rotation.
pub(super) struct ResidualScale {
    scale: DVector<f64>,
    /// Size of the numbers whose difference is the elongation of springs, per coordinate, in addition to the coordinate itself, m.
    reach: DVector<f64>,
}

impl ResidualScale {
    /// Scales from the terms of the balance at pose `q`.
    pub(super) fn at(equations: &Equations<'_>, q: &DVector<f64>) -> Self {
        let crane = equations.crane;
        let coordinates = &crane.description().coordinates;
        let n = q.len();
        let [mut springs, mut driving, mut holding] = [(); 3].map(|()| DVector::zeros(n));
        let (t, rest) = (equations.t, vec![0.0; n]);
        crane.forces(t, q.as_slice(), &rest, springs.as_mut_slice());
        crane.drive_forces(t, q.as_slice(), &rest, driving.as_mut_slice());
        crane.drive_forces_at_rest(t, q.as_slice(), &equations.positions, holding.as_mut_slice());
        // The drives may hold other positions than those of their motions; forces of rigid ones are not among the springs.
        for (driving, coordinate) in driving.iter_mut().zip(coordinates) {
            if coordinate.role == CoordinateRole::Prescribed {
                *driving = 0.0;
            }
        }
        let gravity = equations.open_residual(q) + &springs - driving + holding;
        let greatest = |kind: CoordinateKind| {
            (0..n)
                .filter(|&i| coordinates[i].kind == kind)
                .map(|i| springs[i].abs().max(gravity[i].abs()))
                .fold(0.0, f64::max)
        };
        let (force, moment) = (greatest(CoordinateKind::Translation), greatest(CoordinateKind::Rotation));
        // Without gravity and springs there is nothing to compare with.
        let least = |other: f64| if force.max(moment) > 0.0 { LEAST * other } else { 1.0 };
        let (force, moment) = (force.max(least(moment)), moment.max(least(force)));
        let scale = DVector::from_fn(n, |i, _| match coordinates[i].kind {
            CoordinateKind::Translation => force,
            CoordinateKind::Rotation => moment,
        });
        // Exact kinematics subtract the position of a support in the spec from its current position.
        let mut places = vec![Vector3::zeros(); crane.description().supports.len()];
        crane.support_places(&mut places);
        let supports = crane.description().supports.iter().zip(places);
        let exact =
            supports.filter(|(support, _)| !support.linear).flat_map(|(_, position)| <[f64; 3]>::from(position));
        let farthest = exact.fold(0.0, |far: f64, x| far.max(x.abs()));
        let reach = DVector::from_fn(n, |i, _| match (coordinates[i].role, coordinates[i].kind) {
            (CoordinateRole::Base, CoordinateKind::Translation) => farthest,
            _ => 0.0,
        });
        Self { scale, reach }
    }

    /// `‖r/scale‖`, dimensionless: 0 in equilibrium, about 1 where springs do not carry the weight yet.
    pub(super) fn norm(&self, residual: &DVector<f64>) -> f64 {
        self.scaled(residual).norm()
    }

    /// `r/scale`.
    pub(super) fn scaled(&self, residual: &DVector<f64>) -> DVector<f64> {
        residual.component_div(&self.scale)
    }

    /// A number of row i over that row's scale.
    pub(super) fn row(&self, i: usize, number: f64) -> f64 {
        number / self.scale[i]
    }

    /// The smallest scaled residual that poses in double precision can reach: stiff springs turn the rounding errors of coordinates into
    /// forces.
    pub(super) fn rounding(&self, equations: &Equations<'_>, stiffness: &DMatrix<f64>, q: &DVector<f64>) -> f64 {
        /// Number of rounding errors of a coordinate and of the sums that contain it.
        const ROUNDINGS: f64 = 4.0;
        let of_coordinates = stiffness.abs() * (q.abs() + &self.reach);
        ROUNDINGS * f64::EPSILON * self.norm(&(of_coordinates + of_lengths(equations, q) + of_cylinders(equations, q)))
    }

    /// Diagonal of a stiffness at which the forces here move no coordinate by more than about 1 rad or 1 m; each entry is at
    /// least the coordinate's own stiffness. N m/rad and N/m.
    pub(super) fn springs(&self, stiffness: &DMatrix<f64>) -> DVector<f64> {
        DVector::from_fn(self.scale.len(), |i, _| self.scale[i] + stiffness[(i, i)].abs())
    }
}

/// Size of the forces that connectors would have if stretched by as much as the numbers from which their lengths are computed: a length is
/// the difference of two positions.
fn of_lengths(&Equations { crane, t, .. }: &Equations<'_>, q: &DVector<f64>) -> DVector<f64> {
    let connectors = &crane.description().connectors;
    let mut sum = DVector::zeros(q.len());
    if connectors.is_empty() {
        return sum;
    }
    let rest = vec![0.0; q.len()];
    let mut jacobians = vec![0.0; connectors.len() * q.len()];
    let (mut lengths, mut tensions) = (vec![[0.0; 2]; connectors.len()], vec![Tension::ZERO; connectors.len()]);
    crane.connector_jacobians(q.as_slice(), &mut jacobians);
    crane.connector_lengths(q.as_slice(), &rest, &mut lengths);
    crane.connector_tensions(t, q.as_slice(), &rest, &mut tensions);
    let mut attachments = vec![Vector3::zeros(); crane.count(Count::Attachments)];
    crane.attachments(&mut attachments);
    let mut points = attachments.iter();
    let rows = jacobians.chunks_exact(q.len()).zip(connectors.iter().zip(lengths.iter().zip(&tensions)));
    for (row, (connector, ([length, _], tension))) in rows {
        #[allow(clippy::cast_precision_loss)] // at most 100
        let falls = connector.falls as f64;
        let own = points.by_ref().take(connector.points.len());
        let places = own.flat_map(|point| point.iter().map(|x| x * falls));
        // At a pad, two positions of a few metres are close to each other.
        let least = if connector.is_pad() { 1.0 } else { *length };
        let size = places.fold(least, |size: f64, x| size.max(x.abs()));
        for (sum, slope) in sum.iter_mut().zip(row) {
            *sum += tension.stiffness * slope.abs() * size;
        }
    }
    sum
}

/// The same for the springs that stand for cylinders with a valve at rest.
fn of_cylinders(&Equations { crane, t, ref positions, .. }: &Equations<'_>, q: &DVector<f64>) -> DVector<f64> {
    /// Change of the drives' positions by which their stiffness is measured, m or rad.
    const MOVED: f64 = 1e-4;
    let Description { cylinders, drives, .. } = crane.description();
    let (n, mut sum) = (q.len(), DVector::zeros(q.len()));
    if !crane.description().has_valves() {
        return sum;
    }
    // The pose without force: straight beams, and joints at the positions of their drives.
    let moved: Vec<f64> = positions.iter().map(|position| position + MOVED).collect();
    let (rest, mut forces, mut jacobians) = (vec![0.0; n], vec![0.0; n], vec![0.0; cylinders.len() * n]);
    let mut lengths = vec![Vector3::zeros(); cylinders.len()];
    crane.drive_forces_at_rest(t, positions, &moved, &mut forces);
    crane.cylinder_states(positions, &rest, &mut lengths);
    crane.cylinder_jacobians(q.as_slice(), &mut jacobians);
    let rows = jacobians.chunks_exact(n).zip(cylinders.iter().zip(&lengths));
    for (row, (cylinder, length)) in rows.filter(|(_, (cylinder, _))| cylinder.valve.is_some()) {
        let joint = drives[cylinder.drive].coordinate;
        let along = forces[joint] / (MOVED * length.z * length.z);
        for (sum, slope) in sum.iter_mut().zip(row) {
            *sum += along * slope.abs() * length.x;
        }
    }
    sum
}
