//! Selects the values to compute, and their signs.
//!
//! With `a b + c` alone, a difference needs a negative operand. Users are visited before their operands, so it is known whether a
//! value is needed with its own sign, with the opposite sign, or with both, which costs one more operation.

use crane_codegen::symbolic::{ExprId, Op};

use super::Graph;

/// A value of the graph, or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signed {
    pub id: ExprId,
    pub negative: bool,
}

/// An operand of an operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    /// A number of the program.
    Number(f64),
    /// A constant or a live parameter, available before a call; or a value that is computed or given.
    Value(Signed),
}

/// How a value is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recipe {
    /// It is available.
    Given,
    /// `a b + c`
    MulAdd([Operand; 3]),
    /// `a / b`
    Div([Operand; 2]),
    /// The smaller of two.
    Min([Operand; 2]),
    /// The larger of two.
    Max([Operand; 2]),
    /// Square root.
    Sqrt(Operand),
    /// Exponential.
    Exp(Operand),
    /// The second if the first is above zero, otherwise the third.
    Select([Operand; 3]),
    /// Sine of an angle.
    Sin(Operand),
    /// Cosine of an angle.
    Cos(Operand),
    /// Stumpff's function of this order.
    Stumpff(u8, Operand),
}

/// `x − 0 = x` for every x, −0 too.
pub const NOTHING: Operand = Operand::Number(-0.0);

/// The selected values.
#[derive(Debug)]
pub struct Selection {
    /// For every node, whether its value (0) and its negative (1) are needed.
    pub wanted: Vec<[bool; 2]>,
    /// The operation for the first of the needed signs, and whether that is the negative; the other is its negative.
    pub recipes: Vec<Option<(Recipe, bool)>>,
}

impl Graph<'_> {
    /// Whether it is available before a call and needs no operation with either sign.
    pub fn is_fixed(&self, id: ExprId) -> bool {
        match (self.program.op(id), self.constants) {
            (Op::Constant(_), _) => true,
            (_, Some(constants)) => constants.is_free(self.program, id),
            (_, None) => false,
        }
    }

    /// A value, as a node that is not a negation.
    pub fn operand(&self, mut id: ExprId, mut negative: bool) -> Operand {
        loop {
            match self.program.op(id) {
                Op::Constant(constant) if negative => return Operand::Number(-constant.value()),
                Op::Constant(constant) => return Operand::Number(constant.value()),
                Op::Neg(of) if !self.is_fixed(id) => (id, negative) = (of, !negative),
                _ => return Operand::Value(Signed { id, negative }),
            }
        }
    }
}

impl Selection {
    /// The values that `outputs` need.
    pub fn new(graph: &Graph, outputs: &[ExprId]) -> Self {
        let size = graph.program.operations.len();
        let mut selection = Selection { wanted: vec![[false; 2]; size], recipes: vec![None; size] };
        for output in outputs {
            selection.want(graph, graph.operand(*output, false));
        }
        for id in graph.program.ids().rev() {
            let [positive, negative] = selection.wanted[id.index()];
            if (positive || negative) && !graph.is_fixed(id) {
                let (recipe, sign) = selection.recipe(graph, id, !positive);
                for operand in recipe.operands() {
                    selection.want(graph, operand);
                }
                selection.recipes[id.index()] = Some((recipe, sign));
            }
        }
        selection
    }

    /// Calls `visit` with every value that some results need, each after its operands, result by result.
    pub fn visit_operands_first(&self, results: &[Operand], mut visit: impl FnMut(ExprId)) {
        let mut is_visited = vec![false; self.recipes.len()];
        let value_of = |operand: &Operand| match operand {
            Operand::Value(Signed { id, .. }) if self.recipes[id.index()].is_some() => Some(*id),
            _ => None,
        };
        // Values whose operands are to be visited first, and those whose operands are done.
        let mut waiting: Vec<(ExprId, bool)> = vec![];
        for result in results {
            waiting.extend(value_of(result).map(|id| (id, false)));
            while let Some((id, are_operands_done)) = waiting.pop() {
                if are_operands_done {
                    visit(id);
                } else if !std::mem::replace(&mut is_visited[id.index()], true) {
                    waiting.push((id, true));
                    let operands = self.recipes[id.index()].iter().flat_map(|(recipe, _)| recipe.operands());
                    waiting.extend(operands.filter_map(|operand| value_of(&operand)).map(|id| (id, false)));
                }
            }
        }
    }

    fn want(&mut self, graph: &Graph, operand: Operand) {
        if let Operand::Value(Signed { id, negative }) = operand
            && !graph.is_fixed(id)
        {
            self.wanted[id.index()][usize::from(negative)] = true;
        }
    }

    /// The operation for a value, negative if `negative` and if that costs nothing; and whether it is negative.
    fn recipe(&self, graph: &Graph, id: ExprId, negative: bool) -> (Recipe, bool) {
        let of = |id: ExprId, negative: bool| graph.operand(id, negative);
        let product = |a: ExprId, b: ExprId, negative: bool| self.product(graph, a, b, negative);
        let sum = |[a, b]: [Operand; 2], c: Operand| (Recipe::MulAdd([a, b, c]), negative);
        let op = graph.program.op(id);
        if let (Some(fused), Op::Add(x, y) | Op::Sub(x, y)) = (graph.fused[id.index()], op)
            && let Op::Mul(a, b) = graph.program.op(fused)
        {
            let subtracted = matches!(op, Op::Sub(..));
            return if fused == x {
                sum(product(a, b, negative), of(y, subtracted != negative))
            } else {
                sum(product(a, b, subtracted != negative), of(x, negative))
            };
        }
        let sign = |negative: bool| Operand::Number(if negative { -1.0 } else { 1.0 });
        match op {
            Op::Add(a, b) => {
                // The operand that is known first is multiplied.
                let (first, last) = (a.min(b), a.max(b));
                sum([of(first, false), sign(negative)], of(last, negative))
            }
            Op::Sub(a, b) if negative => sum([of(a, false), sign(true)], of(b, false)),
            Op::Sub(a, b) => sum([of(b, false), sign(true)], of(a, false)),
            Op::Mul(a, b) => sum(product(a, b, negative), NOTHING),
            Op::Div(a, b) => {
                let [a, b] = product(a, b, negative);
                (Recipe::Div([a, b]), negative)
            }
            Op::Min(a, b) => (Recipe::Min([of(a, false), of(b, false)]), false),
            Op::Max(a, b) => (Recipe::Max([of(a, false), of(b, false)]), false),
            Op::Sqrt(a) => (Recipe::Sqrt(of(a, false)), false),
            Op::Exp(a) => (Recipe::Exp(of(a, false)), false),
            Op::Select(a, b, c) => (Recipe::Select([of(a, false), of(b, negative), of(c, negative)]), negative),
            Op::Sin(a) => (Recipe::Sin(of(a, false)), false),
            Op::Cos(a) => (Recipe::Cos(of(a, false)), false),
            Op::Stumpff(k, a) => (Recipe::Stumpff(k, of(a, false)), false),
            // Negations become signs of operands.
            Op::Constant(_) | Op::Symbol(_) | Op::Neg(_) => (Recipe::Given, false),
        }
    }

    /// The factors of `a b`, negative if `negative`, with the cheapest signs; the same for a quotient.
    fn product(&self, graph: &Graph, a: ExprId, b: ExprId, negative: bool) -> [Operand; 2] {
        let choices = [[false, negative], [true, !negative]].map(|[m, n]| [graph.operand(a, m), graph.operand(b, n)]);
        let cost = |factors: &[Operand; 2]| factors.iter().map(|factor| self.cost(graph, *factor)).sum::<u32>();
        let [first, second] = choices;
        if cost(&second) < cost(&first) { second } else { first }
    }

    /// The approximate cost of an operand with its sign.
    fn cost(&self, graph: &Graph, operand: Operand) -> u32 {
        let Operand::Value(Signed { id, negative }) = operand else { return 0 };
        if graph.is_fixed(id) {
            return 0;
        }
        let wanted = self.wanted[id.index()];
        let op = graph.program.op(id);
        let has_a_sign =
            op.is_elementary() || matches!(op, Op::Symbol(_) | Op::Min(..) | Op::Max(..) | Op::Sqrt(_) | Op::Exp(_));
        match (wanted[usize::from(negative)], wanted[usize::from(!negative)] || (negative && has_a_sign)) {
            (true, _) => 0,
            (false, true) => 4,
            (false, false) => u32::from(negative),
        }
    }
}

impl Recipe {
    /// The operands, in order.
    pub fn operands(&self) -> Vec<Operand> {
        match *self {
            Recipe::Given => vec![],
            Recipe::MulAdd(operands) | Recipe::Select(operands) => operands.to_vec(),
            Recipe::Div(operands) | Recipe::Min(operands) | Recipe::Max(operands) => operands.to_vec(),
            Recipe::Sqrt(argument)
            | Recipe::Exp(argument)
            | Recipe::Sin(argument)
            | Recipe::Cos(argument)
            | Recipe::Stumpff(_, argument) => vec![argument],
        }
    }
}
