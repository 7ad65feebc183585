//! The longest chain of operations of a function of which each waits for the previous one.

use super::{Argument, Function, Program};
use crate::symbolic::{ExprId, Op};

/// Times from the operands of an operation to its result.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Latencies {
    /// Sums and differences, minima and maxima, choices.
    pub addition: f64,
    /// Products.
    pub multiplication: f64,
    /// A product and its sum with another number, rounded once.
    pub fused: f64,
    /// Quotients.
    pub division: f64,
    /// Square roots.
    pub root: f64,
    /// Sines and cosines, Stumpff's functions and exponentials.
    pub angle: f64,
}

impl Program {
    /// Which expressions of a function are known before a call: they depend on live parameters alone.
    pub fn known_before(&self, function: &Function) -> impl Fn(ExprId) -> bool + use<> {
        let needed = self.needed(function.outputs.iter().copied());
        let mut known = vec![false; self.operations.len()];
        for id in self.ids().filter(|id| needed[id.index()]) {
            known[id.index()] = match self.op(id) {
                Op::Symbol(symbol) => self.symbols[symbol.0 as usize].argument == Argument::Parameters,
                op => op.operands().all(|operand| known[operand.index()]),
            };
        }
        move |id| known[id.index()]
    }

    /// The time of the longest chain of a function: no processor computes it in less, however many operations it executes at once.
    #[must_use]
    pub fn longest_chain(&self, function: &Function, latencies: &Latencies) -> f64 {
        let known = self.known_before(function);
        let needed = self.needed(function.outputs.iter().copied());
        // When the operands of each operation are there, and its result.
        let mut times = vec![[0.0; 2]; self.operations.len()];
        for id in self.ids().filter(|id| needed[id.index()] && !known(*id)) {
            let op = self.op(id);
            let begin = op.operands().map(|operand| times[operand.index()][1]).fold(0.0, f64::max);
            let end = match op {
                Op::Add(a, b) | Op::Sub(a, b) => {
                    let of = |operand: ExprId| {
                        let positive = if let Op::Neg(operand) = self.op(operand) { operand } else { operand };
                        let [begin, end] = times[positive.index()];
                        match self.op(positive) {
                            _ if known(positive) => 0.0,
                            Op::Mul(..) => begin + latencies.fused,
                            _ => end + latencies.addition,
                        }
                    };
                    of(a).max(of(b))
                }
                Op::Mul(..) => begin + latencies.multiplication,
                Op::Div(..) => begin + latencies.division,
                Op::Sqrt(_) => begin + latencies.root,
                Op::Sin(_) | Op::Cos(_) | Op::Stumpff(..) | Op::Exp(_) => begin + latencies.angle,
                Op::Min(..) | Op::Max(..) | Op::Select(..) => begin + latencies.addition,
                // A sign changes in the operation that follows.
                Op::Neg(_) | Op::Constant(_) | Op::Symbol(_) => begin,
            };
            times[id.index()] = [begin, end];
        }
        function.outputs.iter().map(|id| times[id.index()][1]).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Analyses;
    use crate::program::FunctionId;
    use crate::{SourceFile, compile, mechanics};

    /// ψ̈ = −(g/l) sin ψ of a pendulum, and of two in a row.
    #[test]
    fn the_chain_of_a_pendulum_has_a_sine_and_a_division_at_most() {
        let link = |k: usize| {
            format!(
                "  - {{name: rod_{k}, mass: 2, com: [0, 0, -0.5], inertia: {{Ixx: 0.2, Iyy: 0.2, Izz: 0.01}}, joint: {{revolute: {{axis: y}}}}, \
                 placement: {{transform: {{translation: [0, 0, -1]}}}}}}\n"
            )
        };
        let chain = |count: usize| {
            let links: String = (0..count).map(link).collect();
            let text = format!("format: 1\nname: pendulum\nanalyses: [dynamics]\nlinks:\n{links}");
            let chain =
                compile::load(&SourceFile::new("pendulum.yaml", text)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
            let program = mechanics::derive(&chain, Analyses::ALL);
            let function = program.function(FunctionId::ForwardDynamics).expect("a function of every crane");
            let of = |latencies| program.longest_chain(function, &latencies);
            let angles = of(Latencies { angle: 1.0, ..Latencies::default() });
            let all =
                of(Latencies { addition: 1.0, multiplication: 1.0, fused: 1.0, division: 1.0, root: 1.0, angle: 1.0 });
            (angles, all)
        };
        let (one, two) = (chain(1), chain(2));
        assert_eq!((one.0, two.0), (1.0, 1.0), "no angle depends on a sine");
        assert!(one.1 < 6.0 && two.1 > 1.5 * one.1, "{one:?}, {two:?}");
    }
}
