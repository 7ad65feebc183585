//! What a crane's functions cost, and what its scene does not need.

use crate::lower::Blocks;
use crate::symbolic::{OperationCount, Program, Shape};

/// Costs and omissions of a generated module.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// One row a function, in the order of the file.
    pub costs: Vec<FunctionCost>,
    /// How many second derivatives of transforms are computed in a loop, if they are.
    pub second_derivative_pairs: Option<usize>,
    /// How the mass matrix is filled, and why.
    pub mass_matrix: Option<&'static str>,
    /// What is left out, and why.
    pub left_out: Vec<(&'static str, &'static str)>,
}

/// Operations of one function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionCost {
    /// Name of the function.
    pub function: String,
    /// What it executes.
    pub operations: OperationCount,
    /// What it would execute without simplification.
    pub verbatim: OperationCount,
}

impl Report {
    /// Counts the operations of every function, as lowered and without simplification.
    #[must_use]
    pub fn new(blocks: &Blocks, verbatim: &Program, left_out: Vec<(&'static str, &'static str)>) -> Self {
        let costs = blocks
            .functions
            .iter()
            .map(|block| FunctionCost {
                function: block.function.name.to_owned(),
                operations: block.count,
                verbatim: verbatim
                    .function(block.function.name)
                    .map(|f| {
                        let mut count = verbatim.count(&f.outputs, |_| false);
                        count += f.shape.closing_count();
                        count
                    })
                    .unwrap_or_default(),
            })
            .collect();
        let in_a_loop = |shape: &&Shape| matches!(shape, Shape::Turned { .. });
        let mut shapes = blocks.functions.iter().map(|block| &block.function.shape);
        let second_derivative_pairs = shapes.find(in_a_loop).map(Shape::matrices);
        let mass_matrix = blocks.functions.iter().find(|block| block.function.name == "mass_matrix");
        let mass_matrix = mass_matrix.map(|block| match block.function.shape {
            Shape::Columns { .. } => "in a loop over rows and columns, which is faster from some 16 coordinates on",
            _ => "written out, which is faster up to some 16 coordinates",
        });
        Report { costs, second_derivative_pairs, mass_matrix, left_out }
    }
}
