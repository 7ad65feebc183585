//! Steady motions: some coordinates have constant rates, the others constant positions.

use std::{error::Error, fmt};

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::dyn_crane::DynCrane;
use crate::least_squares::LeastSquares;

/// Maximum Newton steps at each fraction of the rates.
const ITERATIONS: usize = 30;
/// A Newton step below this is the last, m and rad: far below any deflection, far above rounding.
const LAST_STEP: f64 = 1e-9;
/// Maximum component of a step, m and rad.
const GREATEST_STEP: f64 = 0.5;
/// Halvings of a Newton step before it is given up.
const HALVINGS: u32 = 12;
/// Minimum increment of the search, as a fraction of the rates.
const LEAST_PART: f64 = 1e-3;
/// Least distance of a column of the tangent from the span of the others, rows and columns scaled to 1, with which every coordinate has its
/// place.
const SINGULAR: f64 = 1e-9;
/// Time over which forces are compared to see whether a motion remains steady, s.
const MOMENT: f64 = 1e-4;

/// A coordinate that is held in a steady motion, by whatever force that takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Its index in q.
    pub coordinate: usize,
    /// Its position, m or rad; that of the start if none is given.
    pub position: Option<f64>,
    /// Its rate, m/s or rad/s.
    pub rate: f64,
}

/// A motion at constant rates.
#[derive(Clone, Debug, PartialEq)]
pub struct Steady {
    /// Time of drives and loads, s.
    pub t: f64,
    /// Pose, m and rad.
    pub q: Vec<f64>,
    /// Rates, m/s and rad/s.
    pub v: Vec<f64>,
    /// Effort that holds a coordinate in addition to its drive, spring and friction, N and N m; 0 for others.
    pub efforts: Vec<f64>,
    /// The maximum rate at which the pose of the other coordinates would have to change for the motion to remain steady, m/s and rad/s:
    /// 0 if it does.
    pub drift: f64,
    /// The maximum acceleration at this time of the motions of drives whose coordinates are not held, m/s² and rad/s².
    pub acceleration: f64,
}

/// Why there is no steady motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSteady {
    /// The fraction of the rates, and of the way to the held positions, up to which one was found.
    pub reached: f64,
    /// A coordinate that no force keeps in its place there.
    pub loose: Option<usize>,
}

impl fmt::Display for NotSteady {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no steady motion: the search ends at {:.1} % of the rates", 100.0 * self.reached)
    }
}

impl Error for NotSteady {}

/// The steady motion with some coordinates held: `(e + f)(t, q, v) = 0` for all others, solved by Newton's method for their positions.
///
/// At time t drives are at the positions of their motions, and driven coordinates have the rates of these motions unless they are held. All
/// other rates are zero. The search starts at rest in the pose `start`, and raises the rates and approaches the held positions as fast as
/// Newton's method converges, so that it follows the pose from rest.
///
/// # Errors
/// No pose is found at the full rates.
pub fn steady(crane: &dyn DynCrane, t: f64, start: &[f64], held: &[Held]) -> Result<Steady, NotSteady> {
    let search = Search::new(crane, t, start, held);
    let (mut reached, mut part) = (0.0, 1.0);
    let mut q = search.start.clone();
    while reached < 1.0 {
        let next = f64::min(reached + part, 1.0);
        match search.pose(&q, next) {
            Some(pose) => (q, reached, part) = (pose, next, 2.0 * part),
            None => part *= 0.5,
        }
        if part < LEAST_PART {
            return Err(NotSteady { reached, loose: search.loose(&q, reached) });
        }
    }
    let v = search.rates.clone();
    let required = search.required(t, &q, &v);
    let mut efforts = vec![0.0; q.len()];
    for held in held {
        efforts[held.coordinate] = required[held.coordinate];
    }
    let drift = search.drift(&q).unwrap_or(f64::INFINITY);
    let acceleration = search.acceleration();
    Ok(Steady { t, q: q.as_slice().to_vec(), v: v.as_slice().to_vec(), efforts, drift, acceleration })
}

/// The equations of a steady motion.
struct Search<'a> {
    crane: &'a dyn DynCrane,
    t: f64,
    start: DVector<f64>,
    /// All rates.
    rates: DVector<f64>,
    /// Held coordinates and their distances from the start.
    held: Vec<(usize, f64)>,
    /// The other coordinates, except those that rigid drives prescribe.
    free: Vec<usize>,
}

impl<'a> Search<'a> {
    fn new(crane: &'a dyn DynCrane, t: f64, start: &[f64], held: &[Held]) -> Self {
        let description = crane.description();
        let (mut start, mut rates) = (DVector::from_column_slice(start), DVector::zeros(start.len()));
        let mut motions = vec![[0.0; 2]; description.drives.len()];
        crane.drive_motions(t, &mut motions);
        for (drive, [_, rate]) in description.drives.iter().zip(&motions) {
            rates[drive.coordinate] = *rate;
        }
        crane.prescribe(t, start.as_mut_slice(), rates.as_mut_slice());
        for held in held {
            rates[held.coordinate] = held.rate;
        }
        let distance = |held: &Held| held.position.map_or(0.0, |position| position - start[held.coordinate]);
        let prescribed = description.prescribed();
        let is_free = |i: &usize| !prescribed.contains(i) && held.iter().all(|held| held.coordinate != *i);
        Self {
            crane,
            t,
            held: held.iter().map(|held| (held.coordinate, distance(held))).collect(),
            free: (0..start.len()).filter(is_free).collect(),
            start,
            rates,
        }
    }

    /// `−(e + f)`: the forces that the motion requires in addition to those that act.
    fn required(&self, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> DVector<f64> {
        let (mut bias, mut forces) = (DVector::zeros(q.len()), DVector::zeros(q.len()));
        self.crane.bias(q.as_slice(), v.as_slice(), bias.as_mut_slice());
        self.crane.forces(t, q.as_slice(), v.as_slice(), forces.as_mut_slice());
        -(bias + forces)
    }

    /// The same for the free coordinates.
    fn residual(&self, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> DVector<f64> {
        self.required(t, q, v).select_rows(&self.free)
    }

    /// The factorised tangent matrix of the free coordinates.
    fn tangent(&self, q: &DVector<f64>, v: &DVector<f64>) -> LU<f64, Dyn, Dyn> {
        self.stiffness(q, v).lu()
    }

    fn stiffness(&self, q: &DVector<f64>, v: &DVector<f64>) -> DMatrix<f64> {
        let n = q.len();
        let [_, stiffness, _] = self.crane.linearise_motion(self.t, [q.as_slice(), v.as_slice(), &vec![0.0; n]]);
        stiffness.select_rows(&self.free).select_columns(&self.free)
    }

    /// A coordinate that moves without a force that brings it back, if there is one: of the direction in which the tangent is singular, the
    /// one that moves most.
    fn loose(&self, q: &DVector<f64>, part: f64) -> Option<usize> {
        let stiffness = self.stiffness(q, &(&self.rates * part));
        if self.free.is_empty() || stiffness.iter().any(|number| !number.is_finite()) {
            return None;
        }
        // Rows and columns of one size, whatever their units.
        let size = DVector::from_fn(stiffness.nrows(), |i, _| stiffness.row(i).amax().max(stiffness.column(i).amax()));
        if let Some(unknown) = size.iter().position(|size| *size == 0.0) {
            return Some(self.free[unknown]);
        }
        let scaled = DMatrix::from_fn(size.len(), size.len(), |i, j| stiffness[(i, j)] / (size[i] * size[j]).sqrt());
        let direction = LeastSquares::new(scaled, SINGULAR).null_direction()?;
        Some(self.free[direction.abs().argmax().0])
    }

    /// The pose at a fraction of the rates, from a pose nearby.
    fn pose(&self, near: &DVector<f64>, part: f64) -> Option<DVector<f64>> {
        let (mut q, v) = (near.clone(), &self.rates * part);
        for (coordinate, distance) in &self.held {
            q[*coordinate] = self.start[*coordinate] + part * distance;
        }
        let mut residual = self.residual(self.t, &q, &v);
        for _ in 0..ITERATIONS {
            if self.free.is_empty() {
                return Some(q);
            }
            let tangent = self.tangent(&q, &v);
            let step = -tangent.solve(&residual)?;
            let size = step.amax();
            if !size.is_finite() {
                return None;
            }
            let moved = |fraction: f64| {
                let mut pose = q.clone();
                for (i, by) in self.free.iter().zip(&step) {
                    pose[*i] += fraction * by;
                }
                pose
            };
            if size <= LAST_STEP {
                return Some(moved(1.0));
            }
            // The natural monotonicity test: residuals are compared by their Newton steps with the same tangent.
            let longest = f64::min(1.0, GREATEST_STEP / size);
            let (pose, next) = (0..=HALVINGS).find_map(|k| {
                let pose = moved(longest * 0.5_f64.powi(k.cast_signed()));
                let next = self.residual(self.t, &pose, &v);
                (tangent.solve(&next)?.norm() < step.norm()).then_some((pose, next))
            })?;
            (q, residual) = (pose, next);
        }
        None
    }

    /// The maximum acceleration of the drives whose coordinates are not held.
    fn acceleration(&self) -> f64 {
        let drives = &self.crane.description().drives;
        let rates = |t: f64| {
            let mut motions = vec![[0.0; 2]; drives.len()];
            self.crane.drive_motions(t, &mut motions);
            motions.into_iter().map(|[_, rate]| rate)
        };
        let changes =
            rates(self.t + 2.0 * MOMENT).zip(rates(self.t + MOMENT)).map(|(ahead, near)| (ahead - near).abs());
        let of_free = changes
            .zip(drives.iter())
            .filter(|(_, drive)| self.held.iter().all(|(coordinate, _)| *coordinate != drive.coordinate));
        of_free.map(|(change, _)| change / MOMENT).fold(0.0, f64::max)
    }

    /// How fast the free coordinates would have to move for their forces to stay in balance while the others keep moving.
    fn drift(&self, q: &DVector<f64>) -> Option<f64> {
        if self.free.is_empty() {
            return Some(0.0);
        }
        let at = |by: f64| self.residual(self.t + by, &(q + &self.rates * by), &self.rates);
        let rate = (at(2.0 * MOMENT) - at(MOMENT)) / MOMENT;
        Some(self.tangent(q, &self.rates).solve(&rate)?.amax())
    }
}
