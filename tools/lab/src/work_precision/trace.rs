//! The quantities by which the error of a run is measured, and the differences between two runs.

use crane_model::StateAt;
use std::{ops::ControlFlow, time::Instant};

use nalgebra::Vector3;

use crane_model::{
    dyn_crane::{DynCrane, Energies},
    dynamics::{InitialState, Run, Sample, Settings, Stopped},
};

/// A run, sampled at its results.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Positions of the points of interest, result by result; if there are none, of the last body. m.
    pub path: Vec<Vec<Vector3<f64>>>,
    /// Torques and forces of the drives, result by result. N m and N.
    pub efforts: Vec<Vec<f64>>,
    /// Mechanical energy, result by result. J.
    pub energy: Vec<f64>,
    /// Maximum kinetic energy, J.
    pub kinetic: f64,
}

/// Maximum differences between two runs over all results.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Of the points' positions, relative to the maximum distance of one from its start.
    pub path: f64,
    /// Of a drive's torque or force, relative to its maximum; `None` without drives.
    pub efforts: Option<f64>,
    /// Of the mechanical energy, relative to the maximum kinetic energy.
    pub energy: f64,
}

impl Errors {
    /// The larger of the errors of torques and energy.
    pub fn of_forces(&self) -> f64 {
        self.efforts.unwrap_or(0.0).max(self.energy)
    }
}

impl Trace {
    /// Positions of the points of interest.
    pub fn points(crane: &dyn DynCrane, q: &[f64]) -> Vec<Vector3<f64>> {
        let points = crane.points_at(q);
        if points.is_empty() {
            crane.transforms_at(q).last().map(|frame| frame.fixed_view::<3, 1>(0, 3).into_owned()).into_iter().collect()
        } else {
            points
        }
    }

    /// The run of a crane from t, q and v of every result.
    pub fn new(crane: &dyn DynCrane, samples: &[(f64, Vec<f64>, Vec<f64>)]) -> Self {
        let energies: Vec<Energies> = samples.iter().map(|(t, q, v)| crane.energies_at(*t, q, v)).collect();
        Self {
            path: samples.iter().map(|(_, q, _)| Self::points(crane, q)).collect(),
            efforts: samples.iter().map(|(t, q, v)| crane.drive_efforts_at(*t, q, v)).collect(),
            energy: energies.iter().map(Energies::total).collect(),
            kinetic: greatest(energies.iter().map(|energies| energies.kinetic)),
        }
    }

    /// `self + weight (self − other)`, result by result: extrapolation from `other` beyond `self`.
    pub fn beyond(&self, other: &Self, weight: f64) -> Self {
        let number = |(a, b): (&f64, &f64)| a + weight * (a - b);
        let path = self.path.iter().zip(&other.path);
        let efforts = self.efforts.iter().zip(&other.efforts);
        Self {
            path: path.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + (a - b) * weight).collect()).collect(),
            efforts: efforts.map(|(a, b)| a.iter().zip(b).map(number).collect()).collect(),
            energy: self.energy.iter().zip(&other.energy).map(number).collect(),
            kinetic: self.kinetic,
        }
    }

    /// How far `other` is from this run.
    pub fn errors(&self, other: &Self) -> Errors {
        let path = self.path.iter().zip(&other.path).flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| (a - b).norm());
        let energy = self.energy.iter().zip(&other.energy).map(|(a, b)| (a - b).abs());
        let effort = |(drive, peak): (usize, f64)| {
            greatest(self.efforts.iter().zip(&other.efforts).map(|(a, b)| (a[drive] - b[drive]).abs())) / peak
        };
        let peaks = self.peaks().into_iter().enumerate().filter(|(_, peak)| *peak > 0.0);
        Errors {
            path: greatest(path) / self.size(),
            efforts: peaks.map(effort).reduce(f64::max),
            energy: greatest(energy) / self.kinetic,
        }
    }

    /// Number of results up to which the load path of `other` differs by at most `limit`, relative to its size.
    pub fn agrees_for(&self, other: &Self, limit: f64) -> usize {
        let part = |results: usize| {
            let part = |trace: &Self| Self { path: trace.path[..results].to_vec(), ..Self::default() };
            part(self).errors(&part(other)).path
        };
        let all = self.path.len().min(other.path.len());
        // Bisection: the runs agree up to some result and differ from then on.
        let (mut agrees, mut differs) = (0, all + 1);
        while differs - agrees > 1 {
            let middle = agrees.midpoint(differs);
            *(if part(middle) <= limit { &mut agrees } else { &mut differs }) = middle;
        }
        agrees
    }

    /// The maximum distance of a point from its start, m.
    pub fn size(&self) -> f64 {
        let Some(start) = self.path.first() else { return 0.0 };
        greatest(self.path.iter().flat_map(|points| points.iter().zip(start)).map(|(a, b)| (a - b).norm()))
    }

    /// Maximum torque or force of every drive.
    pub fn peaks(&self) -> Vec<f64> {
        let drives = self.efforts.first().map_or(0, Vec::len);
        (0..drives).map(|drive| greatest(self.efforts.iter().map(|efforts| efforts[drive].abs()))).collect()
    }
}

/// The maximum; NaN if any number is NaN, because such a run has failed.
fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(f64::NEG_INFINITY, |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) })
}

/// A run that was timed.
#[derive(Clone, Debug)]
pub struct Timed {
    /// Its results.
    pub trace: Trace,
    /// Its summary.
    pub run: Run,
    /// Wall time, the median over repeated runs, s.
    pub wall: f64,
}

/// Maximum total time of repeated runs of one setting, s: times of long runs scatter less.
const REPEATED: f64 = 1.0;

/// Runs a crane from `start` at rest up to `repeats` times.
pub fn timed(crane: &dyn DynCrane, start: &[f64], settings: &Settings, repeats: usize) -> Result<Timed, Stopped> {
    let start = InitialState::at_rest(start.to_vec());
    let mut samples = Vec::new();
    let mut walls = Vec::new();
    let run = loop {
        samples.clear();
        let begin = Instant::now();
        let run = crane.simulate(&start, settings, &mut |&Sample { state: StateAt { t, q, v, .. }, .. }| {
            samples.push((t, q.to_vec(), v.to_vec()));
            ControlFlow::Continue(())
        })?;
        walls.push(begin.elapsed().as_secs_f64());
        if walls.len() >= repeats || walls.iter().sum::<f64>() > REPEATED {
            break run;
        }
    };
    walls.sort_unstable_by(f64::total_cmp);
    Ok(Timed { trace: Trace::new(crane, &samples), run, wall: walls[walls.len() / 2] })
}
