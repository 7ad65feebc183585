//! Cranes simulated eight at a time move as each would alone.

use crane_model::{
    CraneModel, dyn_crane,
    dynamics::{Method, Settings, Simulation, Stopped, ensemble, rk4::State},
    statics,
};
use crane_shipped::{eight_link_flexible, knuckle_boom};
use nalgebra::SVector;

/// Knuckle-boom cranes with different loads, each at rest in its own equilibrium.
fn knuckle_booms(count: u32) -> Vec<(knuckle_boom::Crane, State<{ knuckle_boom::N }>)> {
    let crane = |index| {
        let crane = knuckle_boom::Crane::new(knuckle_boom::Params { payload: 100.0 * f64::from(index) })
            .expect("a payload not below zero");
        let q = statics::Problem::new(&crane).solve().q;
        (crane, State::at_rest(SVector::from_column_slice(&q)))
    };
    (0..count).map(crane).collect()
}

/// The first tenth of a second of the knuckle boom, whose largest stable step is about 10 ms.
fn settings() -> Settings {
    Settings {
        method: Method::Rk4,
        duration: 0.1,
        ..Settings::from_description(dyn_crane::boxed::<{ knuckle_boom::N }, knuckle_boom::Crane>().description())
    }
}

/// Kutta's step for one crane, straight from the tableau, with the first and the last stage just within the step.
fn single_step<const N: usize, C: CraneModel<N>>(crane: &C, t: f64, h: f64, State { q, v }: State<N>) -> State<N> {
    let half = 0.5 * h;
    let shift = 16.0 * f64::EPSILON * t.abs().max((t + h).abs());
    let a1 = crane.forward_dynamics(t + shift, &q, &v);
    let v2 = v + a1 * half;
    let a2 = crane.forward_dynamics(t + half, &(q + v * half), &v2);
    let v3 = v + a2 * half;
    let a3 = crane.forward_dynamics(t + half, &(q + v2 * half), &v3);
    let v4 = v + a3 * h;
    let a4 = crane.forward_dynamics(t + h - shift, &(q + v3 * h), &v4);
    State { q: q + (v + (v2 + v3) * 2.0 + v4) * (h / 6.0), v: v + (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0) }
}

fn lanes_are_single_cranes<const N: usize, C: CraneModel<N> + Copy>(cranes: [(C, State<N>); 8], h: f64, steps: u32) {
    let lanes = C::lanes(std::array::from_fn(|lane| &cranes[lane].0));
    let mut states = ensemble::States::from_lanes(std::array::from_fn(|lane| &cranes[lane].1));
    let mut single = cranes.map(|(_, start)| start);
    for k in 0..steps {
        let t = f64::from(k) * h;
        ensemble::step(&lanes, t, h, &mut states);
        for (state, (crane, _)) in single.iter_mut().zip(&cranes) {
            *state = single_step(crane, t, h, *state);
        }
    }
    for (lane, single) in single.iter().enumerate() {
        let state = states.lane(lane);
        if cfg!(target_feature = "fma") {
            // Products and sums may be fused differently: a few rounding errors per step.
            let error = (state.q - single.q).amax().max((state.v - single.v).amax());
            assert!(error <= 1e-12 * single.q.amax().max(single.v.amax()), "lane {lane}: {error:e}");
        } else {
            // The same operations in the same order.
            assert_eq!(state, *single, "lane {lane}");
        }
    }
}

#[test]
fn eight_lanes_are_eight_single_runs() {
    let cranes = knuckle_booms(8).try_into().unwrap_or_else(|_| unreachable!());
    lanes_are_single_cranes(cranes, 1e-3, 100);

    let flexible = |lane: usize| {
        let load_mass = 100.0 * lane as f64;
        let crane =
            eight_link_flexible::Crane::new(eight_link_flexible::Params { load_mass }).expect("a load not below zero");
        let q = statics::Problem::new(&crane).solve().q;
        (crane, State::at_rest(SVector::from_column_slice(&q)))
    };
    lanes_are_single_cranes(std::array::from_fn(flexible), 1e-4, 20);
}

/// Last poses of all cranes, and how many samples each had.
fn run_ensemble(
    cranes: &[(knuckle_boom::Crane, State<{ knuckle_boom::N }>)],
) -> (Vec<Vec<f64>>, Vec<usize>, Vec<Option<Stopped>>) {
    let (mut last, mut samples) = (vec![Vec::new(); cranes.len()], vec![0; cranes.len()]);
    let Ok(results) = ensemble::simulate(cranes, &settings(), |crane, sample| {
        last[crane] = sample.q.to_vec();
        samples[crane] += 1;
    });
    (last, samples, results.into_iter().map(Result::err).collect())
}

#[test]
fn an_ensemble_of_any_size_ends_where_single_runs_end() {
    let cranes = knuckle_booms(11);
    let (last, samples, stopped) = run_ensemble(&cranes);
    // 0.1 s in intervals of 0.01 s, both ends included; copies that fill the last batch are not reported.
    assert_eq!(samples, [11; 11]);
    assert!(stopped.iter().all(Option::is_none), "{stopped:?}");
    for ((crane, start), last) in cranes.iter().zip(&last) {
        let mut single = Vec::new();
        let run = Simulation::new(crane, *start, &settings()).observe(|sample| {
            single = sample.q.to_vec();
            std::ops::ControlFlow::Continue(())
        });
        assert!(run.is_ok());
        let error = single.iter().zip(last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Accelerations by Cholesky's factors there, by articulated bodies here: rounding errors, times the condition number of A.
        assert!(error < 1e-11, "{error:e}");
    }
}

#[test]
fn a_crane_that_blows_up_does_not_harm_its_neighbours() {
    let sound = knuckle_booms(8);
    let (expected, ..) = run_ensemble(&sound);
    for bad in [f64::NAN, 1e9] {
        let mut cranes = sound.clone();
        cranes[3].1.v[0] = bad;
        let (last, _, stopped) = run_ensemble(&cranes);
        for lane in 0..8 {
            if lane == 3 {
                assert!(stopped[lane].as_ref().is_some_and(|stopped| stopped.time == 0.0), "{:?}", stopped[lane]);
            } else {
                assert_eq!(stopped[lane], None);
                let error = expected[lane].iter().zip(&last[lane]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // The sines of all lanes are computed differently in a step in which one lane has huge angles.
                assert!(error < 1e-12, "lane {lane}: {error:e}");
            }
        }
    }
}

#[test]
fn a_step_of_eight_cranes_allocates_nothing() {
    let cranes = knuckle_booms(8);
    let lanes = knuckle_boom::Crane::lanes(std::array::from_fn(|lane| &cranes[lane].0));
    let mut states = ensemble::States::from_lanes(std::array::from_fn(|lane| &cranes[lane].1));
    let info = allocation_counter::measure(|| {
        for k in 0..100 {
            ensemble::step(&lanes, f64::from(k) * 1e-3, 1e-3, &mut states);
        }
    });
    assert_eq!(info.count_total, 0);
}
