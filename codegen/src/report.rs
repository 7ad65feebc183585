//! The cost of a crane's functions, and what the crane does not need.

use crate::chain::Loops;
use crate::lower::LoweredProgram;
use crate::program::{FunctionId, OperationCount, Program, Shape};

/// Costs and omissions of a generated module.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// One row per function, in the order of the file.
    pub costs: Vec<FunctionCost>,
    /// The number of second derivatives of transforms that are computed in a loop, if any.
    pub second_derivative_pairs: Option<usize>,
    /// Functions with loops over bodies with equal work, and the number of bodies of each loop.
    pub loops: Vec<(String, Vec<usize>)>,
    /// Why repeated work is a loop, or is written out.
    pub loops_because: &'static str,
    /// Whether the mass matrix is filled in a loop, if there is one.
    pub mass_matrix_in_a_loop: Option<bool>,
    /// What is left out, and why.
    pub left_out: Vec<(&'static str, &'static str)>,
}

/// Operations of one function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionCost {
    /// Name of the function.
    pub function: String,
    /// Operations that it executes.
    pub operations: OperationCount,
    /// Operations that it would execute without simplification.
    pub verbatim: OperationCount,
    /// The number of statements that rustc has to compile.
    pub statements: usize,
}

/// rustc's time per statement at level 2, s: 2.8 s for the dynamics of 25 coordinates, 4.7 s for those of 103.
const COMPILE_TIME: f64 = 3.5e-4;
/// A compile time, s, above which there is a warning.
const COMPILE_BUDGET: f64 = 60.0;

impl Report {
    /// Counts the operations of every function, as lowered and without simplification.
    #[must_use]
    pub fn new(
        lowered: &LoweredProgram,
        verbatim: &Program,
        loops: Loops,
        left_out: Vec<(&'static str, &'static str)>,
    ) -> Self {
        let costs = lowered
            .functions
            .iter()
            .map(|code| FunctionCost {
                function: code.function.id.name().to_owned(),
                operations: code.count,
                verbatim: verbatim
                    .function(code.function.id)
                    .map(|f| {
                        let mut count = verbatim.count(&f.outputs, |_| false);
                        count += f.shape.expansion_count();
                        count
                    })
                    .unwrap_or_default(),
                statements: code.statements(),
            })
            .collect();
        let in_a_loop = |shape: &&Shape| matches!(shape, Shape::TransformFactors { .. });
        let mut shapes = lowered.functions.iter().map(|code| &code.function.shape);
        let second_derivative_pairs = shapes.find(in_a_loop).map(Shape::matrices);
        let mass_matrix = lowered.functions.iter().find(|code| code.function.id == FunctionId::MassMatrix);
        let mass_matrix_in_a_loop = mass_matrix.map(|code| matches!(code.function.shape, Shape::Columns { .. }));
        let rerolled = lowered.functions.iter().filter(|code| !code.rerolled.loops.is_empty());
        let iterations = rerolled.map(|code| {
            (code.function.id.name().to_owned(), code.rerolled.loops.iter().map(|of| of.iterations).collect())
        });
        let loops_because = loops.reason();
        Report {
            costs,
            second_derivative_pairs,
            loops: iterations.collect(),
            loops_because,
            mass_matrix_in_a_loop,
            left_out,
        }
    }

    /// A warning if rustc will take long, and what helps.
    #[must_use]
    pub fn warning(&self, crane: &str) -> Option<String> {
        let statements: usize = self.costs.iter().map(|cost| cost.statements).sum();
        #[expect(clippy::cast_precision_loss, reason = "far fewer statements than a float has digits for")]
        let seconds = COMPILE_TIME * statements as f64;
        let longest = self.costs.iter().max_by_key(|cost| cost.statements).filter(|_| seconds > COMPILE_BUDGET)?;
        Some(format!(
            "`{crane}` is {statements} statements, about {seconds:.0} s of rustc, {} of them in `{}`: list fewer `analyses`, \
             use fewer sections, or write `loops: auto` instead of `never`",
            longest.statements, longest.function
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(statements: usize) -> Report {
        let cost = |function: &str, statements| FunctionCost {
            function: function.to_owned(),
            operations: OperationCount::default(),
            verbatim: OperationCount::default(),
            statements,
        };
        Report {
            costs: vec![cost("linearise", statements), cost("bias", 1)],
            second_derivative_pairs: None,
            loops: vec![],
            loops_because: "",
            mass_matrix_in_a_loop: None,
            left_out: vec![],
        }
    }

    #[test]
    fn a_warning_names_what_takes_longest() {
        assert_eq!(report(1000).warning("crane"), None);
        let warning = report(399_999).warning("crane").expect("140 s");
        assert!(
            warning.starts_with("`crane` is 400000 statements, about 140 s of rustc, 399999 of them in `linearise`")
        );
    }
}
