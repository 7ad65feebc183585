//! The chain's numbers and inputs as expressions.

use crate::chain::{Chain, ParameterId, Value};
use crate::symbolic::{Argument, Expr, Graph, Symbol, SymbolId};

use super::vector::Vec3;

/// A chain whose inputs and numbers are expressions of one graph.
pub struct Model<'g> {
    pub graph: &'g Graph,
    pub chain: &'g Chain,
    /// Time, s.
    pub t: Expr<'g>,
    /// Coordinates.
    pub q: Vec<Expr<'g>>,
    /// Velocities.
    pub v: Vec<Expr<'g>>,
    parameters: Vec<Expr<'g>>,
}

impl<'g> Model<'g> {
    pub fn new(graph: &'g Graph, chain: &'g Chain) -> Self {
        let mut next = 0;
        let mut symbols = |count: usize| -> Vec<Expr<'g>> {
            let first = next;
            next += u32::try_from(count).expect("fewer than 2^32 inputs");
            (first..next).map(|i| graph.symbol(SymbolId(i))).collect()
        };
        let n = chain.coordinates.len();
        let t = symbols(1)[0];
        let (q, v) = (symbols(n), symbols(n));
        let parameters = symbols(chain.parameters.len());
        Model { graph, chain, t, q, v, parameters }
    }

    /// The inputs in the order in which [`Model::new`] numbers them.
    pub fn symbols(chain: &Chain) -> Vec<Symbol> {
        let symbol = |name: String, argument, index| Symbol { name, argument, index };
        let mut symbols = vec![symbol("t".into(), Argument::Time, 0)];
        symbols
            .extend(chain.coordinates.iter().enumerate().map(|(i, c)| symbol(c.name.clone(), Argument::Position, i)));
        symbols.extend(
            chain.coordinates.iter().enumerate().map(|(i, c)| symbol(format!("{}_dot", c.name), Argument::Velocity, i)),
        );
        symbols
            .extend(chain.parameters.iter().enumerate().map(|(i, p)| symbol(p.name.clone(), Argument::Parameters, i)));
        symbols
    }

    /// Number of coordinates.
    pub fn size(&self) -> usize {
        self.q.len()
    }

    pub fn zero(&self) -> Expr<'g> {
        self.graph.constant(0.0)
    }

    /// A generalized vector of zeros: forces to be summed, or a state at rest.
    pub fn zeros(&self) -> Vec<Expr<'g>> {
        vec![self.zero(); self.size()]
    }

    /// A number of the chain.
    pub fn number(&self, value: &Value) -> Expr<'g> {
        match value {
            Value::Constant(c) => self.graph.constant(*c),
            Value::Parameter(ParameterId(i)) => self.parameters[*i],
            Value::Neg(a) => -self.number(a),
            Value::Add(a, b) => self.number(a) + self.number(b),
            Value::Mul(a, b) => self.number(a) * self.number(b),
            Value::Div(a, b) => self.number(a) / self.number(b),
            Value::Sin(a) => self.number(a).sin(),
            Value::Cos(a) => self.number(a).cos(),
        }
    }

    /// Three numbers of the chain.
    pub fn vector(&self, values: &[Value; 3]) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|i| self.number(&values[i])))
    }
}
