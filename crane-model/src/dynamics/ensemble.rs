//! Many cranes at a time: the classical Runge–Kutta method over eight lanes, one crane a lane.
//!
//! All lanes take the same step. Lane by lane the operations are those of [`rk4`], in the same order, with the accelerations of
//! [`LaneDynamics`]: a crane moves alike whatever moves beside it.

use nalgebra::SVector;

use super::{Run, Sample, Settings, Statistics, Stopped, rk4, simulation::divided};
use crate::{Ensemble, LaneDynamics, support::lanes::f64x8};

/// Cranes a batch.
pub const LANES: usize = 8;

/// Poses and velocities of eight cranes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct States<const N: usize> {
    /// Generalized coordinates, m and rad.
    pub q: SVector<f64x8, N>,
    /// Their rates, m/s and rad/s.
    pub v: SVector<f64x8, N>,
}

impl<const N: usize> States<N> {
    /// A state a lane.
    pub fn of(states: [&rk4::State<N>; LANES]) -> Self {
        let lanes = |of: fn(&rk4::State<N>) -> &SVector<f64, N>| {
            SVector::from_fn(|i, _| f64x8::new(states.map(|state| of(state)[i])))
        };
        Self { q: lanes(|state| &state.q), v: lanes(|state| &state.v) }
    }

    /// The state of a lane, below [`LANES`].
    pub fn lane(&self, lane: usize) -> rk4::State<N> {
        rk4::State { q: self.q.map(|x| x.to_array()[lane]), v: self.v.map(|x| x.to_array()[lane]) }
    }

    fn set(&mut self, lane: usize, state: &rk4::State<N>) {
        for (lanes, x) in self.q.iter_mut().zip(&state.q).chain(self.v.iter_mut().zip(&state.v)) {
            lanes.as_mut_array()[lane] = *x;
        }
    }

    /// Whether a lane stays within `bound`, m and rad; false for what is no number.
    fn bounded(&self, bound: f64) -> [bool; LANES] {
        let bound = f64x8::splat(bound);
        let within = self.q.iter().fold(f64x8::splat(0.0).simd_le(bound), |within, x| within & x.abs().simd_le(bound));
        let mask = within.to_bitmask();
        std::array::from_fn(|lane| mask >> lane & 1 == 1)
    }
}

/// `x + ẋ h`
fn moved<const N: usize>(x: &SVector<f64x8, N>, rate: &SVector<f64x8, N>, h: f64) -> SVector<f64x8, N> {
    x.zip_map(rate, |x, rate| x + rate * h)
}

/// Moves eight cranes from `t` to `t + h`, both in s. No allocation.
pub fn step<const N: usize, L: LaneDynamics<N>>(cranes: &L, t: f64, h: f64, states: &mut States<N>) {
    let States { q, v } = &*states;
    let [begin, middle, end] = [t, t + 0.5 * h, t + h].map(f64x8::splat);

    let a1 = cranes.forward_dynamics(begin, q, v);
    let v2 = moved(v, &a1, 0.5 * h);
    let a2 = cranes.forward_dynamics(middle, &moved(q, v, 0.5 * h), &v2);
    let v3 = moved(v, &a2, 0.5 * h);
    let a3 = cranes.forward_dynamics(middle, &moved(q, &v2, 0.5 * h), &v3);
    let v4 = moved(v, &a3, h);
    let a4 = cranes.forward_dynamics(end, &moved(q, &v3, h), &v4);

    let mean = |[x1, x2, x3, x4]: [&SVector<f64x8, N>; 4]| -> SVector<f64x8, N> {
        SVector::from_fn(|i, _| x1[i] + (x2[i] + x3[i]) * 2.0 + x4[i])
    };
    let (rates, accelerations) = (mean([v, &v2, &v3, &v4]), mean([&a1, &a2, &a3, &a4]));
    states.q = moved(&states.q, &rates, h / 6.0);
    states.v = moved(&states.v, &accelerations, h / 6.0);
}

/// Integrates Eq. (23) of every crane from its state at t = 0, eight at a time, and shows `observe` its place in `cranes` and
/// a sample at t = 0, at every interval and at the end, as [`simulate`](super::simulate) without audit.
///
/// A crane that leaves the bound of the settings ends with [`Stopped`], and the others go on. Returns one result a crane.
pub fn simulate<const N: usize, C: Ensemble<N>>(
    cranes: &[(C, rk4::State<N>)],
    settings: &Settings,
    mut observe: impl FnMut(usize, &Sample<'_>),
) -> Vec<Result<Run, Stopped>> {
    let mut results = Vec::with_capacity(cranes.len());
    for (index, cranes) in cranes.chunks(LANES).enumerate() {
        results.extend(batch(cranes, settings, |lane, sample| observe(index * LANES + lane, sample)));
    }
    results
}

/// A run of one to eight cranes.
fn batch<const N: usize, C: Ensemble<N>>(
    cranes: &[(C, rk4::State<N>)],
    settings: &Settings,
    mut observe: impl FnMut(usize, &Sample<'_>),
) -> Vec<Result<Run, Stopped>> {
    // Copies of the last crane fill the lanes; nobody looks at them.
    let members: [_; LANES] = std::array::from_fn(|lane| &cranes[lane.min(cranes.len() - 1)]);
    let lanes = C::lanes(members.map(|(crane, _)| crane));
    let mut states = States::of(members.map(|(_, start)| start));
    let run = Run { statistics: Statistics::default(), step: settings.step_taken(), time: 0.0 };
    let mut results = vec![Ok(run); cranes.len()];
    let intervals = divided(settings.duration, settings.output).0;

    let mut begin = 0.0;
    for interval in 0..=intervals {
        for (lane, _) in results.iter().enumerate().filter(|(_, result)| result.is_ok()) {
            let rk4::State { q, v } = states.lane(lane);
            observe(lane, &Sample { t: begin, q: q.as_slice(), v: v.as_slice(), work: 0.0, dissipated: 0.0 });
        }
        if interval == intervals || results.iter().all(Result::is_err) {
            break;
        }
        let end = (settings.output * (interval + 1) as f64).min(settings.duration);
        let (steps, h) = divided(end - begin, settings.step);
        for k in 0..steps {
            let t = begin + h * k as f64;
            step(&lanes, t, h, &mut states);
            for (lane, _) in states.bounded(settings.bound).iter().enumerate().filter(|(_, bounded)| !**bounded) {
                if let Some(result @ Ok(_)) = results.get_mut(lane) {
                    let q = states.lane(lane).q;
                    *result = Err(Stopped::growth(t, h, q.as_slice(), members[lane].0.description()));
                }
                // It goes on unseen from its start: numbers without bound would slow down all lanes.
                states.set(lane, &members[lane].1);
            }
        }
        for run in results.iter_mut().flatten() {
            run.statistics.steps += steps;
            run.statistics.evaluations += rk4::STAGES * steps;
            run.time = end;
        }
        begin = end;
    }
    results
}
