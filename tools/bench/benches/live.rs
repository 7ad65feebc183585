//! Live cranes against compiled ones: `cargo bench -p crane-bench --bench live`. Forward dynamics of one state, and of blocks as wide as the
//! lanes of each; medians of alternating rounds, so that both run under the same conditions.

use std::hint::black_box;
use std::time::{Duration, Instant};

use crane_bench::cranes::{self, Entry};
use crane_bench::kernel::Kernel;
use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynBlock, DynDynamics, DynEnsemble, DynModel};
use crane_model::rt::lanes::f64x8;

/// Number of alternating rounds.
const ROUNDS: usize = 31;
/// Approximate duration of a round, s.
const ROUND: f64 = 5e-3;

/// One state of a crane: t, q, v.
struct State {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
}

fn main() {
    println!("forward dynamics, µs per crane, and live over compiled; medians of {ROUNDS} alternating rounds");
    println!("coordinates  compiled      live  ratio  compiled lanes  live block  ratio");
    for entry in cranes::all() {
        let live = LiveCrane::from_spec(&SourceFile::new("crane.yaml", entry.spec)).expect("a spec that was compiled");
        let states = states(&entry);
        let mut singly = compiled(&entry, "forward_dynamics");
        let single = ratio(&mut |calls| singly.time(calls), &mut |calls| one_by_one(&live, &states, calls));
        let mut lanes = compiled(&entry, "forward_dynamics_lanes");
        let parameters = live.parameters().to_vec();
        let mut block = live.block(&vec![parameters.as_slice(); live.lanes()]).expect("the crane's own parameters");
        let width = live.lanes() / 8;
        // A call serves as many cranes as there are lanes.
        let per_call = |duration: Duration, cranes: usize| duration.div_f64(cranes as f64);
        let together = ratio(&mut |calls| per_call(lanes.time(calls), 8), &mut |calls| {
            per_call(in_block(&mut *block, width, &states, calls), 8 * width)
        });
        println!(
            "{:>11}  {:>8.2}  {:>8.2}  {:>5.2}  {:>14.2}  {:>10.2}  {:>5.2}",
            entry.coordinates, single[0], single[1], single[2], together[0], together[1], together[2]
        );
    }
}

fn compiled(entry: &Entry, name: &str) -> Kernel {
    entry.kernel(name).expect("a kernel of every crane")
}

fn states(entry: &Entry) -> Vec<State> {
    let n = entry.coordinates;
    let state = |record: &[f64]| State { t: record[0], q: record[1..=n].to_vec(), v: record[n + 1..=2 * n].to_vec() };
    (entry.records)().chunks_exact(1 + 3 * n).map(state).collect()
}

fn one_by_one(live: &LiveCrane, states: &[State], calls: u64) -> Duration {
    let mut out = vec![0.0; live.size()];
    let begin = Instant::now();
    for (_, State { t, q, v }) in (0..calls).zip(states.iter().cycle()) {
        live.forward_dynamics(black_box(*t), black_box(q), black_box(v), &mut out);
        black_box(&out);
    }
    begin.elapsed()
}

fn in_block(block: &mut (dyn DynBlock + '_), width: usize, states: &[State], calls: u64) -> Duration {
    let spread = |numbers: &[f64]| -> Vec<f64x8> {
        numbers.iter().flat_map(|x| std::iter::repeat_n(f64x8::splat(*x), width)).collect()
    };
    let states: Vec<_> = states.iter().map(|State { t, q, v }| (*t, spread(q), spread(v))).collect();
    let mut out = states[0].1.clone();
    let begin = Instant::now();
    for (_, (t, q, v)) in (0..calls).zip(states.iter().cycle()) {
        block.forward_dynamics(black_box(*t), black_box(q), black_box(v), &mut out);
        black_box(&out);
    }
    begin.elapsed()
}

/// Medians of both, µs per call, and of their ratio.
fn ratio(compiled: &mut dyn FnMut(u64) -> Duration, live: &mut dyn FnMut(u64) -> Duration) -> [f64; 3] {
    let calls_of = |work: &mut dyn FnMut(u64) -> Duration| {
        let mut calls = 16;
        while work(calls).as_secs_f64() < ROUND && calls < 1 << 20 {
            calls *= 2;
        }
        calls
    };
    let counts = [calls_of(compiled), calls_of(live)];
    let per_call = |work: &mut dyn FnMut(u64) -> Duration, calls: u64| 1e6 * work(calls).as_secs_f64() / calls as f64;
    let mut rounds = [const { Vec::new() }; 3];
    for _ in 0..ROUNDS {
        let [one, other] = [per_call(compiled, counts[0]), per_call(live, counts[1])];
        for (round, number) in rounds.iter_mut().zip([one, other, other / one]) {
            round.push(number);
        }
    }
    rounds.map(|mut round| {
        round.sort_by(f64::total_cmp);
        round[ROUNDS / 2]
    })
}
