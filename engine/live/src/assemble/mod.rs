//! From a function over a graph to bytecode.
//!
//! | pass | file | after it |
//! |---|---|---|
//! | select | `select` | each value is one operation, with the signs that its users need |
//! | order | `line` | straight-line code: angles first, then in the order of derivation, or result by result where that needs too many registers; results as soon as a batch of them is known |
//! | registers | `registers` | registers are reused after the last use of their values |

mod line;
mod registers;
mod select;

use crane_codegen::lower::{Constants, fuse};
use crane_codegen::program::{Entry, Function, Layout, Program};
use crane_codegen::symbolic::ExprId;

use crate::bytecode::Code;
use line::{AssembledLine, Order};
use select::Selection;

/// A product of a function needs more registers than narrow bytecode can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// Their number.
    pub registers: usize,
}

/// A function of a program; `constants` are those of the program.
#[must_use]
pub fn assemble(program: &Program, constants: &Constants, function: &Function) -> Code {
    let fused = fuse(program, constants, &function.outputs);
    let graph = Graph { program, constants: Some(constants), fused };
    let entries = function.shape.entries(Layout::Columns);
    let selection = Selection::new(&graph, &function.outputs);
    let line = |order| AssembledLine::new(&graph, &selection, &function.outputs, &entries, order);
    let code = registers::assign(&line(Order::Derivation));
    if code.is_wide() { registers::assign(&line(Order::Results)) } else { code }
}

/// The stored constants of a program, as a function of its live parameters: each operation rounds, as in compiled code.
#[must_use]
pub fn assemble_constants(program: &Program, constants: &Constants) -> Code {
    let graph = Graph { program, constants: None, fused: vec![None; program.operations.len()] };
    let outputs = &constants.stored;
    let entries: Vec<_> = (0..outputs.len()).map(Entry::Slot).collect();
    let selection = Selection::new(&graph, outputs);
    registers::assign(&AssembledLine::new(&graph, &selection, outputs, &entries, Order::Derivation))
}

/// A program, and its expressions that need no separate operation.
struct Graph<'p> {
    program: &'p Program,
    /// Values available before a call.
    constants: Option<&'p Constants>,
    /// For every sum or difference, the product that is fused into it.
    fused: Vec<Option<ExprId>>,
}

#[cfg(test)]
mod tests {
    use crane_codegen::build;
    use crane_codegen::chain::Analyses;
    use crane_codegen::mechanics;
    use crane_codegen::program::FunctionId;
    use crane_model::dyn_crane::{Arguments, DynCrane};

    use super::*;
    use crate::LiveCrane;
    use crate::bytecode::{Instructions, Operands, WideInstruction};
    use crate::machine::{Environment, Machine};

    /// The results of a function for arbitrary numbers in place of live parameters and what follows from them, and its registers.
    fn results(code: &Code, environment: &Environment<'_, f64>) -> (Vec<u64>, usize) {
        let mut machine = Machine::new(code);
        machine.fix(code, |index| 1.0 + index as f64, |index| 0.5 + 0.1 * index as f64);
        let mut out = vec![f64::NAN; code.results];
        machine.run(code, environment, &mut out);
        assert!(out.iter().all(|x| x.is_finite()));
        (out.into_iter().map(f64::to_bits).collect(), code.registers)
    }

    #[test]
    fn wide_instructions_give_the_bits_of_narrow_ones() {
        let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
        let crane = LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap();
        let q = (&crane as &dyn DynCrane).guess();
        let program = mechanics::derive(crane.chain(), Analyses { statics: true, ..Analyses::ALL });
        for id in [FunctionId::TangentStiffness, FunctionId::ForwardDynamics, FunctionId::Transforms] {
            let alone = program.alone(program.function(id).unwrap());
            let narrow = assemble(&alone, &Constants::new(&alone), &alone.functions[0]);
            let Instructions::Narrow(instructions) = &narrow.instructions else { panic!("{id:?} is wide") };
            let wide = instructions
                .iter()
                .map(|i| [i.out(), i.a(), i.b(), i.c()].map(|register| u32::try_from(register).unwrap()));
            // As many registers as no narrow instruction can name.
            let wide = Code {
                instructions: Instructions::Wide(wide.map(WideInstruction).collect()),
                registers: 70_000,
                ..narrow.clone()
            };
            let environment = Arguments { q: &q, v: &q, a: &q, positions: &q, ..Arguments::none() }.into();
            assert_eq!(results(&narrow, &environment).0, results(&wide, &environment).0, "{id:?}");
        }
    }

    #[test]
    fn result_by_result_a_dense_matrix_takes_fewer_registers_for_the_same_bits() {
        // The tangent of springs between distant points is dense.
        const STAYS: &str = "links: [{name: boom, beam: {sections: 12}}]\nconnectors:\n  \
            - {name: one, from: {link: truck, at: [0, 0, 3]}, to: {link: telescope, at: [0, 0, 0.3]}, law: {spring: {stiffness: 1e5, length: 4}}}\n  \
            - {name: other, from: {link: column, at: [0, 0, 2]}, to: {link: telescope, at: [0.5, 0, 0]}, law: {spring: {stiffness: 1e5, length: 4}}}\n";
        let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
        let crane = LiveCrane::from_spec(&build::open(path.as_ref()).unwrap().changed(STAYS)).unwrap();
        let q = (&crane as &dyn DynCrane).guess();
        let wanted = Analyses { derivatives: false, motion_derivatives: false, ..Analyses::ALL };
        let program = mechanics::derive(crane.chain(), wanted);
        let function = program.function(FunctionId::TangentStiffness).unwrap();
        let alone = program.alone(function);
        let function = &alone.functions[0];
        let constants = Constants::new(&alone);
        let fused = fuse(&alone, &constants, &function.outputs);
        let graph = Graph { program: &alone, constants: Some(&constants), fused };
        let selection = Selection::new(&graph, &function.outputs);
        let entries = function.shape.entries(Layout::Columns);
        let [derived, by_result] = [Order::Derivation, Order::Results].map(|order| {
            let line = AssembledLine::new(&graph, &selection, &function.outputs, &entries, order);
            let environment = Arguments { q: &q, v: &q, a: &q, positions: &q, ..Arguments::none() }.into();
            results(&registers::assign(&line), &environment)
        });
        assert_eq!(derived.0, by_result.0);
        assert!(by_result.1 < derived.1, "{} registers instead of {}", by_result.1, derived.1);
    }
}
