//! The states at which everything is timed and compared.

use crane_model::dyn_crane::{DynCrane, Instance};
use crane_model::nalgebra::SVector;
use crane_model::rt::lanes::f64x8;
use crane_model::{CoordinateKind, CoordinateRole, CraneModel, Description};
use fastrand::Rng;

/// Enough that neither registers nor the branch predictor remember a result, and few enough that all stay in the L1 cache.
const COUNT: usize = 64;
const SEED: u64 = 3;

/// Time, pose and velocities.
#[derive(Clone, Debug)]
pub struct State<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// Coordinates, m and rad.
    pub q: SVector<f64, N>,
    /// Their rates, m/s and rad/s.
    pub v: SVector<f64, N>,
}

/// The guess of a crane, which has no statics.
pub fn guess<const N: usize>(model: &impl CraneModel<N>) -> Vec<f64> {
    let on_slices: &dyn DynCrane = &Instance::<N, _>(model.clone());
    on_slices.guess()
}

/// Random states about the guess of the spec, before the drives begin to move: other libraries then see springs.
#[must_use]
pub fn near_guess<const N: usize>(model: &impl CraneModel<N>) -> Vec<State<N>> {
    let (crane, guess) = (model.description(), guess(model));
    let mut rng = Rng::with_seed(SEED);
    let mut symmetric = |scale: f64| scale * (2.0 * rng.f64() - 1.0);
    (0..COUNT)
        .map(|_| State {
            t: symmetric(0.25) - 0.5,
            q: SVector::from_fn(|i, _| guess[i] + symmetric(reach(crane, i))),
            v: SVector::from_fn(|_, _| symmetric(0.5)),
        })
        .collect()
}

/// Eight states, one per lane.
#[derive(Clone, Debug)]
pub struct EightStates<const N: usize> {
    /// Times, s.
    pub t: f64x8,
    /// Coordinates, m and rad.
    pub q: SVector<f64x8, N>,
    /// Their rates, m/s and rad/s.
    pub v: SVector<f64x8, N>,
}

/// The states eight by eight, in their order.
#[must_use]
pub fn by_eight<const N: usize>(states: &[State<N>]) -> Vec<EightStates<N>> {
    let vector = |eight: &[State<N>; 8], of: fn(&State<N>) -> &SVector<f64, N>| {
        SVector::from_fn(|i, _| f64x8::new(std::array::from_fn(|lane| of(&eight[lane])[i])))
    };
    let eights = states.as_chunks::<8>().0.iter();
    eights
        .map(|eight| EightStates {
            t: f64x8::new(std::array::from_fn(|lane| eight[lane].t)),
            q: vector(eight, |state| &state.q),
            v: vector(eight, |state| &state.v),
        })
        .collect()
}

/// How far a coordinate strays from the guess, m and rad.
fn reach(crane: &Description, index: usize) -> f64 {
    let coordinate = &crane.coordinates[index];
    match (coordinate.role, coordinate.kind) {
        (CoordinateRole::Driven | CoordinateRole::Prescribed | CoordinateRole::Passive, CoordinateKind::Rotation) => {
            0.3
        }
        _ => 0.02,
    }
}

/// These states as records `t, q, v, f`, `f` being the generalized forces.
#[must_use]
pub fn records<const N: usize, C: CraneModel<N> + Default>() -> Vec<f64> {
    let crane = C::default();
    near_guess(&crane)
        .iter()
        .flat_map(|State { t, q, v }| {
            let forces = crane.forces(*t, q, v);
            [*t].into_iter().chain([q, v, &forces].map(|vector| vector.as_slice().to_vec()).concat())
        })
        .collect()
}
