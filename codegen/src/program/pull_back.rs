//! The product of weights and the derivatives of a function.

use super::{Argument, Function, Program, Shape, Symbol};
use crate::symbolic::{Expr, ExprId, Graph, SweepTrace, SymbolId};

/// What results are differentiated by, in the order of a pulled back function.
pub const PULLED_BACK: [Argument; 6] = [
    Argument::Time,
    Argument::Position,
    Argument::Velocity,
    Argument::Acceleration,
    Argument::Parameters,
    Argument::Inputs,
];

impl Program {
    /// A program with one function, `wᵀ ∂f/∂x` of a function f: of its numbers with as many weights w, which are read as
    /// [`RightHandSide`](Argument::RightHandSide) in addition to the arguments of f, with respect to all numbers x of the arguments [`PULLED_BACK`], in this order.
    ///
    /// # Panics
    /// If the function belongs to another program, or has a right-hand side itself.
    #[must_use]
    pub fn pull_back(&self, function: &Function) -> Program {
        assert!(!function.arguments.contains(&Argument::RightHandSide), "the argument is taken");
        let graph = Graph::simplifying();
        let mut symbols = self.symbols.clone();
        let outputs = {
            let needed = self.needed(function.outputs.iter().copied());
            let mut moved: Vec<Option<Expr<'_>>> = vec![None; self.operations.len()];
            let id_of = |id: Option<Expr<'_>>| id.expect("operands come before their users").id();
            for id in self.ids().filter(|id| needed[id.index()]) {
                moved[id.index()] = Some(graph.build(self.op(id).map(|operand| id_of(moved[operand.index()]))));
            }
            let of: Vec<Expr<'_>> = function.outputs.iter().filter_map(|id| moved[id.index()]).collect();
            let weights: Vec<Expr<'_>> = (0..of.len())
                .map(|index| {
                    symbols.push(Symbol {
                        name: format!("weight_{}", index + 1),
                        argument: Argument::RightHandSide,
                        index,
                    });
                    graph.symbol(SymbolId(u32::try_from(symbols.len() - 1).expect("fewer than 2^32 inputs")))
                })
                .collect();
            let by: Vec<Expr<'_>> = PULLED_BACK
                .into_iter()
                .flat_map(|argument| (0..).zip(&self.symbols).filter(move |(_, symbol)| symbol.argument == argument))
                .map(|(id, _)| graph.symbol(SymbolId(id)))
                .collect();
            graph.pull_back(&of, &weights, &by).into_iter().map(Expr::id).collect::<Vec<ExprId>>()
        };
        let function =
            Function { shape: Shape::Vector(outputs.len()), outputs, trace: SweepTrace::default(), ..function.clone() };
        Program::new(graph, symbols, vec![function])
    }
}
