//! What limits a kernel: the longest chain of operations of which each waits for the previous one, and how many operations there are.

use std::hint::black_box;
use std::time::Instant;

use crane_codegen::chain::Analyses;
use crane_codegen::program::Latencies;
use crane_codegen::{SourceFile, compile, mechanics};
use crane_model::rt::{fma, sin_cos};

/// Operations in a measured chain, and repetitions, of which the fastest counts.
const LINKS: u32 = 20_000;
const REPETITIONS: usize = 20;

/// A line for each function of a crane: its name, its operations, its angles, and the time of its longest chain, ns.
///
/// # Panics
/// If the spec has mistakes.
#[must_use]
pub fn lines(spec: &str) -> Vec<String> {
    let chain = compile::load(&SourceFile::new("crane.yaml", spec)).expect("a spec that was compiled");
    let program = mechanics::derive(&chain, Analyses::ALL);
    let latencies = measured();
    let line = |function: &crane_codegen::program::Function| {
        let known = program.known_before(function);
        let count = program.count(&function.outputs, known);
        let longest = program.longest_chain(function, &latencies);
        format!("{} {} {} {longest}", function.id.name(), count.total(), count.angles)
    };
    program.functions.iter().map(line).collect()
}

/// The latencies of this processor, ns.
fn measured() -> Latencies {
    // Numbers that do not leave the range in which operations take their usual time.
    let [one, tiny, half] = [1.0, 1e-9, 0.5].map(black_box);
    Latencies {
        addition: link(|x| x + tiny),
        multiplication: link(|x| x * one),
        fused: link(|x| fma(x, one, tiny)),
        division: link(|x| half / x),
        // Of numbers that are not 1, to which roots of roots tend.
        root: link(|x| (x + one).sqrt()) - link(|x| x + tiny),
        angle: link(|x| sin_cos([x; 8]).0[0]),
    }
}

/// The time of an operation in a chain, ns.
fn link(operation: impl Fn(f64) -> f64) -> f64 {
    let time = || {
        let begin = Instant::now();
        black_box((0..LINKS).fold(black_box(0.7), |x, _| operation(x)));
        begin.elapsed().as_secs_f64() * 1e9 / f64::from(LINKS)
    };
    (0..REPETITIONS).map(|_| time()).fold(f64::INFINITY, f64::min)
}
