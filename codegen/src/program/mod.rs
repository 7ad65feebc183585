//! What is derived from a crane: named functions over one graph of expressions, and their semantics.

mod count;
mod expansion;
mod interpret;
mod layout;
mod longest_chain;
mod product;
mod shape;

use rustc_hash::FxHashMap;

use crate::symbolic::{ExprId, Graph, Nodes, Op, SweepTrace, SymbolId};

pub use count::OperationCount;
pub use crane_quantities::{Argument, Count, Extent, FunctionId, Item, Part};
pub use interpret::Inputs;
pub use layout::{Entry, Layout};
pub use longest_chain::Latencies;
pub use product::{PULLED_BACK, Product, has_products};
pub use shape::{ConcurrentAxes, Shape, Struct};

/// Functions that share one graph of expressions.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// All operations, operands before their users.
    pub operations: Vec<Op>,
    /// The position of each operation.
    pub index: FxHashMap<Op, ExprId>,
    /// Names that the model gives to some of them.
    pub names: FxHashMap<ExprId, String>,
    /// Inputs; [`SymbolId`] is the index in this list.
    pub symbols: Vec<Symbol>,
    /// The functions, in the order in which they are printed.
    pub functions: Vec<Function>,
}

/// An input of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Name of the quantity, an identifier.
    pub name: String,
    /// The argument that carries it.
    pub argument: Argument,
    /// Its index in that argument.
    pub index: usize,
}

/// A function: its documentation, arguments and result.
#[derive(Clone, Debug)]
pub struct Function {
    /// Which one it is.
    pub id: FunctionId,
    /// The product with its derivatives, if it is not the function itself.
    pub product: Option<Product>,
    /// First line of its documentation: what it returns, with units.
    pub doc: &'static str,
    /// Equations it implements, and their source.
    pub equation: &'static str,
    /// Arguments in addition to the live parameters and the inputs, in order.
    pub arguments: Vec<Argument>,
    /// Shape of the result.
    pub shape: Shape,
    /// Expressions of the result's slots, as many as [`Shape::len`], in its order.
    pub outputs: Vec<ExprId>,
    /// The sweeps over the bodies that derived them, if any.
    pub trace: SweepTrace,
}

impl Function {
    /// Its name, an identifier.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}{}", self.id.name(), self.product.map_or("", Product::suffix))
    }

    /// The function with the sweeps that derived it.
    #[must_use]
    pub fn by(self, trace: SweepTrace) -> Self {
        Function { trace, ..self }
    }
}

impl Program {
    /// The program of `functions` over a graph, once it has all its expressions.
    #[must_use]
    pub fn new(graph: Graph, symbols: Vec<Symbol>, functions: Vec<Function>) -> Self {
        let Nodes { operations, index, names } = graph.into_nodes();
        Program { operations, index, names, symbols, functions }
    }

    /// A function, if the crane has it.
    #[must_use]
    pub fn function(&self, id: FunctionId) -> Option<&Function> {
        self.functions.iter().find(|function| function.id == id)
    }

    /// The operation of an expression.
    #[must_use]
    pub fn op(&self, id: ExprId) -> Op {
        self.operations[id.index()]
    }

    /// All expressions, operands before their users.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = ExprId> + use<> {
        (0..self.operations.len()).map(ExprId::at)
    }

    /// Adds an operation, even if an equal one exists.
    ///
    /// # Panics
    /// If there are 2^32 expressions or more, which no graph can hold.
    pub fn append(&mut self, op: Op) -> ExprId {
        self.operations.push(op);
        ExprId::at(self.operations.len() - 1)
    }

    /// Adds an input.
    ///
    /// # Panics
    /// If there are 2^32 inputs or more.
    pub fn append_symbol(&mut self, symbol: Symbol) -> ExprId {
        let id = SymbolId(u32::try_from(self.symbols.len()).expect("fewer than 2^32 inputs"));
        self.symbols.push(symbol);
        self.append(Op::Symbol(id))
    }

    /// The expression of an operation, if the program has it.
    #[must_use]
    pub fn find(&self, op: Op) -> Option<ExprId> {
        self.index.get(&op).copied()
    }

    /// The input behind a symbol.
    #[must_use]
    pub fn symbol(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id.0 as usize]
    }

    /// For every node of the graph, whether `roots` need it.
    #[must_use]
    pub fn needed(&self, roots: impl IntoIterator<Item = ExprId>) -> Vec<bool> {
        let mut needed = vec![false; self.operations.len()];
        for root in roots {
            needed[root.index()] = true;
        }
        // Operands precede their users, so one sweep from the end reaches everything.
        for index in (0..self.operations.len()).rev() {
            if needed[index] {
                for operand in self.operations[index].operands() {
                    needed[operand.index()] = true;
                }
            }
        }
        needed
    }

    /// A program with one of its functions and only the operations that this function needs.
    ///
    /// # Panics
    /// If the function belongs to another program.
    #[must_use]
    pub fn alone(&self, function: &Function) -> Program {
        let needed = self.needed(function.outputs.iter().copied());
        let mut alone = Program { symbols: self.symbols.clone(), ..Program::default() };
        let mut moved: Vec<Option<ExprId>> = vec![None; self.operations.len()];
        for id in self.ids().filter(|id| needed[id.index()]) {
            let op = self.op(id).map(|operand| moved[operand.index()].expect("operands come before their users"));
            let copy = alone.append(op);
            alone.index.entry(op).or_insert(copy);
            moved[id.index()] = Some(copy);
        }
        let outputs = function.outputs.iter().filter_map(|id| moved[id.index()]).collect();
        alone.functions = vec![Function { outputs, trace: SweepTrace::default(), ..function.clone() }];
        alone
    }
}
