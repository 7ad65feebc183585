//! Products with the derivatives of a function, without these derivatives.

use std::mem;

use super::{Argument, Extent, Function, FunctionId, Item, Program, Shape, Symbol};
use crate::symbolic::{Expr, ExprId, Graph, Nodes, SweepTrace, SymbolId};

/// A product with the derivatives `J = ∂f/∂x` of a function f of numbers x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Product {
    /// `wᵀ J`: derivatives of the results, weighted and summed.
    Vjp,
    /// `J δx`: changes of the results with changes of the numbers.
    Jvp,
}

/// What results are differentiated by, in the order of products.
pub const PULLED_BACK: [Argument; 6] = [
    Argument::Time,
    Argument::Position,
    Argument::Velocity,
    Argument::Acceleration,
    Argument::Parameters,
    Argument::Inputs,
];

impl Product {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Vjp, Self::Jvp];

    /// What a name has after that of the function.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Product::Vjp => "_vjp",
            Product::Jvp => "_jvp",
        }
    }

    /// The name of a function, and the product that a whole name asks for: `bias_vjp` is one of `bias`.
    #[must_use]
    pub fn split(name: &str) -> (&str, Option<Self>) {
        let of = |product: Self| Some((name.strip_suffix(product.suffix())?, Some(product)));
        Self::ALL.into_iter().find_map(of).unwrap_or((name, None))
    }
}

/// Whether a function has products: its results are numbers of their own, which follow from the state alone. With closed loops, accelerations are not
/// those of the function.
#[must_use]
pub fn has_products(function: FunctionId, closes_loops: bool) -> bool {
    use FunctionId as F;
    let others = [Argument::RightHandSide, Argument::DrivePositions, Argument::AddedInertia, Argument::Factors];
    let of_factors = matches!(function, F::DynamicResidualDerivatives | F::ResidualFactors | F::MassFactors);
    let is_plain = match function.extent() {
        Extent::Number | Extent::Vector => true,
        Extent::List(item, _) => item != Item::Transform,
        Extent::Matrix | Extent::Base | Extent::Other => false,
    };
    let is_open = function == F::ForwardDynamics && closes_loops;
    is_plain && !of_factors && !is_open && !others.iter().any(|other| function.arguments().contains(other))
}

impl Program {
    /// The numbers that results are differentiated by: those of the arguments [`PULLED_BACK`], in this order.
    pub fn differentiated_by(&self) -> impl Iterator<Item = SymbolId> {
        let of = |argument| (0..).zip(&self.symbols).filter(move |(_, symbol)| symbol.argument == argument);
        PULLED_BACK.into_iter().flat_map(of).map(|(id, _)| SymbolId(id))
    }

    /// A program with one function, a product of a function, by [all numbers](Self::differentiated_by).
    ///
    /// # Panics
    /// If the function belongs to another program.
    #[must_use]
    pub fn product_alone(&self, function: &Function, product: Product) -> Program {
        let mut alone = self.alone(function);
        let by: Vec<SymbolId> = alone.differentiated_by().collect();
        let product = alone.product(&alone.functions[0].clone(), product, &by);
        alone.functions = vec![product];
        alone
    }

    /// A product of one of the program's functions with its derivatives by numbers x; the operations become part of the program. Weights of the results,
    /// or changes of x, are its [`Multiplier`](Argument::Multiplier), after the arguments of the function.
    ///
    /// # Panics
    /// If there are 2^32 inputs or more.
    #[must_use]
    pub fn product(&mut self, of: &Function, product: Product, by: &[SymbolId]) -> Function {
        let names: Vec<String> = match product {
            Product::Vjp => (1..=of.outputs.len()).map(|result| format!("weight_{result}")).collect(),
            Product::Jvp => by.iter().map(|x| format!("change_of_{}", self.symbol(*x).name)).collect(),
        };
        let first = self.symbols.len();
        let symbols =
            names.into_iter().enumerate().map(|(index, name)| Symbol { name, argument: Argument::Multiplier, index });
        self.symbols.extend(symbols);
        let graph = Graph::resumed(Nodes {
            operations: mem::take(&mut self.operations),
            index: mem::take(&mut self.index),
            names: mem::take(&mut self.names),
        });
        let outputs: Vec<ExprId> = {
            let symbol = |index: usize| graph.symbol(SymbolId(u32::try_from(index).expect("fewer than 2^32 inputs")));
            let multiplier: Vec<Expr<'_>> = (first..self.symbols.len()).map(symbol).collect();
            let results: Vec<Expr<'_>> = of.outputs.iter().map(|id| graph.expr(*id)).collect();
            let by: Vec<Expr<'_>> = by.iter().map(|x| graph.symbol(*x)).collect();
            let numbers = match product {
                Product::Vjp => graph.pull_back(&results, &multiplier, &by),
                Product::Jvp => graph.push_forward(&results, &by, &multiplier),
            };
            numbers.into_iter().map(Expr::id).collect()
        };
        let Nodes { operations, index, names } = graph.into_nodes();
        (self.operations, self.index, self.names) = (operations, index, names);
        let shape = match product {
            Product::Vjp => Shape::Vector(outputs.len()),
            Product::Jvp => of.shape.clone(),
        };
        let arguments = of.arguments.iter().copied().chain([Argument::Multiplier]).collect();
        let trace = SweepTrace::default();
        Function { product: Some(product), arguments, shape, outputs, trace, ..of.clone() }
    }
}
