//! From a line to operations of a processor. Signs move to where they cost nothing: a value is a node or its negative, sums
//! become differences, and what nobody needs is left out. Each operation rounds as before.

use std::collections::HashMap;

use crate::line::{Rounding, Step, StraightLine, Value};

/// Number of a node: first the given ones, then what operations and pauses make, and numbers that signs need.
pub type Node = u32;

/// An operation, or what else happens in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// An operation and the node that it makes.
    Operation(Operation),
    /// A result: its place, and its node.
    Store(u32, Node),
    /// The caller computes nodes: what it reads, the first it makes, and how many it makes.
    Pause(Vec<Node>, Node, usize),
    /// A loop, by its number, and the nodes that it reads.
    Loop(usize, Vec<Node>),
}

/// An operation on nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operation {
    /// What it computes.
    pub kind: Kind,
    /// The node that it makes.
    pub out: Node,
    operands: [Node; 3],
}

/// What an operation computes of `a`, `b`, `c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// `a + b`
    Sum,
    /// `a − b`
    Difference,
    /// `a b`
    Product,
    /// `a / b`
    Quotient,
    /// The smaller of two.
    Minimum,
    /// The larger of two.
    Maximum,
    /// `√a`
    Root,
    /// `b` if a > 0, otherwise `c`.
    Choice,
    /// `a b + c`, rounded once.
    Fused(Signs),
}

/// Signs of `±a b ± c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signs {
    /// `a b + c`
    Plus,
    /// `a b − c`
    Minus,
    /// `c − a b`
    Reverse,
}

impl Operation {
    /// Its operands.
    pub fn operands(&self) -> &[Node] {
        let count = match self.kind {
            Kind::Root => 1,
            Kind::Sum | Kind::Difference | Kind::Product | Kind::Quotient | Kind::Minimum | Kind::Maximum => 2,
            Kind::Choice | Kind::Fused(_) => 3,
        };
        &self.operands[..count]
    }

    /// Another node as an operand.
    pub fn replace(&mut self, index: usize, node: Node) {
        self.operands[index] = node;
    }
}

impl Action {
    /// The nodes that it reads.
    pub fn reads(&self) -> &[Node] {
        match self {
            Action::Operation(operation) => operation.operands(),
            Action::Store(_, node) => std::slice::from_ref(node),
            Action::Pause(nodes, ..) | Action::Loop(_, nodes) => nodes,
        }
    }
}

/// The operations of a line.
#[derive(Debug, Default)]
pub struct Operations {
    /// What happens, in order.
    pub actions: Vec<Action>,
    /// The number of nodes.
    pub nodes: usize,
    /// The given values that are numbers.
    pub given: Vec<Option<f64>>,
    /// Numbers that signs need in addition to the given ones.
    pub numbers: Vec<(Node, f64)>,
}

/// A node, or its negative.
#[derive(Clone, Copy)]
struct Signed(Node, bool);

impl Operations {
    /// The operations of a line.
    #[must_use]
    pub fn new(line: &StraightLine, rounding: Rounding) -> Self {
        let given = |at: usize| Signed(index(at), false);
        let mut writer = OperationWriter {
            line,
            rounding,
            values: (0..line.given.len()).map(given).collect(),
            negatives: HashMap::new(),
            minus_one: line.given.iter().position(|number| *number == Some(-1.0)).map(index),
            operations: Operations { nodes: line.given.len(), given: line.given.clone(), ..Operations::default() },
        };
        line.steps.iter().for_each(|step| writer.write(step));
        writer.operations.without_unused()
    }

    /// Only what results or pauses need.
    fn without_unused(mut self) -> Self {
        let mut needed = vec![false; self.nodes];
        let mut keep = vec![true; self.actions.len()];
        for (action, keep) in self.actions.iter().zip(&mut keep).rev() {
            if let Action::Operation(Operation { out, .. }) = action {
                *keep = needed[*out as usize];
            }
            if *keep {
                action.reads().iter().for_each(|node| needed[*node as usize] = true);
            }
        }
        let mut keep = keep.into_iter();
        self.actions.retain(|_| keep.next().unwrap_or_default());
        self
    }
}

/// Operations under construction.
struct OperationWriter<'a> {
    line: &'a StraightLine,
    rounding: Rounding,
    /// The node of every value.
    values: Vec<Signed>,
    /// Nodes of negatives that were needed.
    negatives: HashMap<Node, Node>,
    minus_one: Option<Node>,
    operations: Operations,
}

impl OperationWriter<'_> {
    fn write(&mut self, step: &Step) {
        let value = match step {
            Step::MulAdd(operands) => self.multiply_and_add(*operands),
            Step::Div([a, b]) => {
                let [Signed(a, minus_a), Signed(b, minus_b)] = [self.signed(*a), self.signed(*b)];
                Signed(self.make(Kind::Quotient, [a, b, b]), minus_a != minus_b)
            }
            Step::Min([a, b]) => self.plain(Kind::Minimum, [*a, *b, *b]),
            Step::Max([a, b]) => self.plain(Kind::Maximum, [*a, *b, *b]),
            Step::Sqrt(a) => self.plain(Kind::Root, [*a, *a, *a]),
            Step::Select(operands) => self.plain(Kind::Choice, *operands),
            Step::Store { place: index, value } => {
                let node = self.positive(self.signed(*value));
                self.operations.actions.push(Action::Store(*index, node));
                return;
            }
            Step::Pause { arguments, makes } => {
                let arguments = arguments.iter().map(|value| self.positive(self.signed(*value))).collect();
                let first = index(self.operations.nodes);
                self.operations.actions.push(Action::Pause(arguments, first, *makes));
                self.operations.nodes += makes;
                self.values.extend((0..*makes).map(|next| Signed(first + index(next), false)));
                return;
            }
        };
        self.values.push(value);
    }

    fn signed(&self, value: Value) -> Signed {
        self.values[value as usize]
    }

    /// The number that a value always is.
    fn number(&self, value: Value) -> Option<f64> {
        self.line.given.get(value as usize).copied().flatten()
    }

    fn node(&mut self) -> Node {
        self.operations.nodes += 1;
        index(self.operations.nodes - 1)
    }

    fn make(&mut self, kind: Kind, operands: [Node; 3]) -> Node {
        let out = self.node();
        self.operations.actions.push(Action::Operation(Operation { kind, out, operands }));
        out
    }

    /// An operation of values with their signs.
    fn plain(&mut self, kind: Kind, operands: [Value; 3]) -> Signed {
        let operands = operands.map(|value| self.positive(self.signed(value)));
        Signed(self.make(kind, operands), false)
    }

    /// The node of a value; its negative costs a product with −1, once.
    fn positive(&mut self, Signed(node, negative): Signed) -> Node {
        if !negative {
            return node;
        }
        if let Some(known) = self.negatives.get(&node) {
            return *known;
        }
        let minus_one = self.minus_one.unwrap_or_else(|| {
            let number = self.node();
            self.operations.numbers.push((number, -1.0));
            number
        });
        self.minus_one = Some(minus_one);
        let negated = self.make(Kind::Product, [node, minus_one, minus_one]);
        self.negatives.insert(node, negated);
        negated
    }

    /// `a b + c`: a factor ±1 and a summand −0 need no operation.
    fn multiply_and_add(&mut self, [a, b, c]: [Value; 3]) -> Signed {
        let unit = |value: Value| self.number(value).filter(|number| number.abs() == 1.0);
        let (unit, factor) = match (unit(a), unit(b)) {
            (Some(unit), _) => (Some(unit), b),
            (None, unit) => (unit, a),
        };
        let is_nothing = self.number(c).is_some_and(|number| number == 0.0 && number.is_sign_negative());
        let product = match unit {
            Some(unit) => {
                let Signed(node, negative) = self.signed(factor);
                Signed(node, negative != (unit < 0.0))
            }
            None if is_nothing || self.rounding == Rounding::Separate => {
                let [Signed(a, minus_a), Signed(b, minus_b)] = [self.signed(a), self.signed(b)];
                Signed(self.make(Kind::Product, [a, b, b]), minus_a != minus_b)
            }
            None => {
                let [Signed(a, minus_a), Signed(b, minus_b), Signed(c, minus_c)] =
                    [a, b, c].map(|value| self.signed(value));
                let (signs, negative) = match (minus_a != minus_b, minus_c) {
                    (false, false) => (Signs::Plus, false),
                    (true, true) => (Signs::Plus, true),
                    (false, true) => (Signs::Minus, false),
                    (true, false) => (Signs::Reverse, false),
                };
                return Signed(self.make(Kind::Fused(signs), [a, b, c]), negative);
            }
        };
        if is_nothing { product } else { self.add(product, self.signed(c)) }
    }

    fn add(&mut self, Signed(a, minus_a): Signed, Signed(b, minus_b): Signed) -> Signed {
        match (minus_a, minus_b) {
            (false, true) => Signed(self.make(Kind::Difference, [a, b, b]), false),
            (true, false) => Signed(self.make(Kind::Difference, [b, a, a]), false),
            (negative, _) => Signed(self.make(Kind::Sum, [a, b, b]), negative),
        }
    }
}

/// An index of a list that memory holds.
#[expect(clippy::cast_possible_truncation, reason = "a line has far fewer than 2^32 values")]
pub fn index(at: usize) -> u32 {
    at as u32
}
