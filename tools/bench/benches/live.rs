//! Live cranes against compiled ones: `cargo bench -p crane-bench --bench live`. Forward dynamics of one state, as machine code and as
//! bytecode, and of blocks as wide as the lanes of each; medians of alternating rounds, so that all run under the same conditions.
//! Then how long it takes to make the machine code from bytecode, for one state and for eight, and for one state from the spec.

use std::hint::black_box;
use std::time::{Duration, Instant};

use crane_bench::cranes::{self, Entry};
use crane_bench::kernel::Kernel;
use crane_codegen::SourceFile;
use crane_codegen::chain::Analyses;
use crane_codegen::mechanics;
use crane_codegen::program::FunctionId;
use crane_live::machine::Number;
use crane_live::{LiveCrane, Routine};
use crane_model::dyn_crane::{DynBlock, DynCrane};
use crane_model::dynamics::ensemble::LANES;
use crane_model::rt::lanes::f64x8;

/// Number of alternating rounds.
const ROUNDS: usize = 31;
/// Approximate duration of a round, s.
const ROUND: f64 = 5e-3;

/// Calls after which a live crane's function is derived and machine code.
const WARM_UP: u64 = 1000;

/// One state of a crane: t, q, v.
struct State {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
}

fn main() {
    println!(
        "forward dynamics, µs per crane, and ratios to compiled code: medians of {ROUNDS} alternating rounds; ms until there is machine code"
    );
    println!("                       one state                     |           lanes            |           ms until");
    println!(
        "coordinates  compiled  machine code  |    bytecode   |  compiled  |  machine code  |    one   eight  from the spec"
    );
    for entry in cranes::all() {
        let live = LiveCrane::from_spec(&SourceFile::new("crane.yaml", entry.spec)).expect("a spec that was compiled");
        let states = states(&entry);
        let [mut singly, mut by_machine_code, mut by_bytecode] =
            ["forward_dynamics", "forward_dynamics_machine_code", "forward_dynamics_bytecode"]
                .map(|name| kernel(&entry, name));
        let [single, machine_code, bytecode] =
            medians([&mut |calls| singly.time(calls), &mut |calls| by_machine_code.time(calls), &mut |calls| {
                by_bytecode.time(calls)
            }]);
        let mut lanes = kernel(&entry, "forward_dynamics_lanes");
        let parameters = live.parameters().to_vec();
        let mut block = live.block(&[parameters.as_slice(); LANES]).expect("the crane's own parameters");
        // A call serves as many cranes as there are lanes.
        let per_call = |duration: Duration, cranes: usize| duration.div_f64(cranes as f64);
        let [eight, in_lanes] = medians([&mut |calls| per_call(lanes.time(calls), LANES), &mut |calls| {
            per_call(in_block(&mut *block, &states, calls), LANES)
        }]);
        let [one, other] = [making::<f64>(&live), making::<f64x8>(&live)];
        let ratio = |[time, ratio]: [f64; 2]| format!("{time:>7.3} {ratio:>5.2}");
        let [code, bytes, together] = [machine_code, bytecode, in_lanes].map(ratio);
        println!(
            "{:>11}  {:>8.3} {code} |{bytes}  |  {:>8.3}  |{together}   |  {one:>5.1}   {other:>5.1}          {:>5.1}",
            entry.coordinates,
            single[0],
            eight[0],
            from_spec(&entry)
        );
    }
}

/// Forward dynamics of a live crane, without its machine code.
fn routine(live: &LiveCrane) -> Routine {
    let program = mechanics::derive(live.chain(), Analyses::ALL);
    let function = program.function(FunctionId::ForwardDynamics).expect("a function of every crane");
    Routine::new(&program, function)
}

/// Time to make machine code of forward dynamics, ms.
fn making<T: Number>(live: &LiveCrane) -> f64 {
    let milliseconds = |_| {
        let routine = routine(live);
        let begin = Instant::now();
        black_box(routine.compile::<T>());
        1e3 * begin.elapsed().as_secs_f64()
    };
    median((0..11).map(milliseconds).collect())
}

/// Time from the text of a spec to machine code of its forward dynamics, ms.
fn from_spec(entry: &Entry) -> f64 {
    let milliseconds = |_| {
        let begin = Instant::now();
        let live = LiveCrane::from_spec(&SourceFile::new("crane.yaml", entry.spec)).expect("a spec that was compiled");
        black_box(live.compile(FunctionId::ForwardDynamics));
        1e3 * begin.elapsed().as_secs_f64()
    };
    median((0..11).map(milliseconds).collect())
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn kernel(entry: &Entry, name: &str) -> Kernel {
    entry.kernel(name).expect("a kernel of every crane")
}

fn states(entry: &Entry) -> Vec<State> {
    let n = entry.coordinates;
    let state = |record: &[f64]| State { t: record[0], q: record[1..=n].to_vec(), v: record[n + 1..=2 * n].to_vec() };
    (entry.records)().chunks_exact(1 + 3 * n).map(state).collect()
}

fn in_block(block: &mut (dyn DynBlock + '_), states: &[State], calls: u64) -> Duration {
    let spread = |numbers: &[f64]| -> Vec<f64x8> { numbers.iter().map(|x| f64x8::splat(*x)).collect() };
    let states: Vec<_> = states.iter().map(|State { t, q, v }| (*t, spread(q), spread(v))).collect();
    let mut out = states[0].1.clone();
    let begin = Instant::now();
    for (_, (t, q, v)) in (0..calls).zip(states.iter().cycle()) {
        block.forward_dynamics(black_box(*t), black_box(q), black_box(v), &mut out);
        black_box(&out);
    }
    begin.elapsed()
}

/// Medians of the time of each, µs per call, and of its ratio to that of the first.
fn medians<const WAYS: usize>(mut ways: [&mut dyn FnMut(u64) -> Duration; WAYS]) -> [[f64; 2]; WAYS] {
    let counts = ways.each_mut().map(|work| {
        work(WARM_UP);
        let mut calls = 16;
        while work(calls).as_secs_f64() < ROUND && calls < 1 << 20 {
            calls *= 2;
        }
        calls
    });
    let mut rounds: [[Vec<f64>; 2]; WAYS] = std::array::from_fn(|_| [vec![], vec![]]);
    for _ in 0..ROUNDS {
        let mut first = None;
        for ((work, calls), [times, ratios]) in ways.iter_mut().zip(counts).zip(&mut rounds) {
            let time = 1e6 * work(calls).as_secs_f64() / calls as f64;
            times.push(time);
            ratios.push(time / *first.get_or_insert(time));
        }
    }
    rounds.map(|[times, ratios]| [median(times), median(ratios)])
}
