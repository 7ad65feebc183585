//! The chain's numbers and inputs as expressions.

use std::collections::BTreeSet;

use crate::chain::{Chain, Inertia, Input, InputId, ParameterId, Value};
use crate::program::{Argument, Symbol};
use crate::symbolic::{Expr, Graph, SymbolId};

use super::axis_rotation::AxisRotation;
use super::vector::{Symmetric3, SymmetricMatrix, Vec3};

/// A chain whose inputs and numbers are expressions of one graph.
#[derive(Clone)]
pub struct Model<'g> {
    pub graph: &'g Graph,
    pub chain: &'g Chain,
    /// Time, s.
    pub t: Expr<'g>,
    /// Coordinates.
    pub q: Vec<Expr<'g>>,
    /// Velocities.
    pub v: Vec<Expr<'g>>,
    /// Accelerations.
    pub a: Vec<Expr<'g>>,
    /// Right-hand side of a linear system.
    pub right_hand_side: Vec<Expr<'g>>,
    /// Positions at which the drives are held, by coordinate.
    pub drive_positions: Vec<Expr<'g>>,
    /// Added inertias of the coordinates.
    pub added_inertia: Vec<Expr<'g>>,
    /// Added inertia of the base, row by row from the diagonal.
    pub base_added_inertia: Vec<Expr<'g>>,
    parameters: Vec<Expr<'g>>,
    inputs: Vec<Expr<'g>>,
}

impl<'g> Model<'g> {
    pub fn new(graph: &'g Graph, chain: &'g Chain) -> Self {
        let symbols = Self::symbols(chain);
        let of = |argument: Argument| -> Vec<Expr<'g>> {
            let own = (0..).zip(&symbols).filter(|(_, symbol)| symbol.argument == argument);
            own.map(|(id, _)| graph.symbol(SymbolId(id))).collect()
        };
        Model {
            graph,
            chain,
            t: of(Argument::Time)[0],
            q: of(Argument::Position),
            v: of(Argument::Velocity),
            a: of(Argument::Acceleration),
            right_hand_side: of(Argument::RightHandSide),
            drive_positions: of(Argument::DrivePositions),
            added_inertia: of(Argument::AddedInertia),
            base_added_inertia: of(Argument::BaseAddedInertia),
            parameters: of(Argument::Parameters),
            inputs: of(Argument::Inputs),
        }
    }

    /// All inputs in their order; the factors of staged functions follow them.
    pub fn symbols(chain: &Chain) -> Vec<Symbol> {
        let symbol = |name: String, argument, index| Symbol { name, argument, index };
        let each = |argument, suffix: &str| {
            let named = chain.coordinates.iter().map(|coordinate| format!("{}{suffix}", coordinate.name));
            named.enumerate().map(|(i, name)| symbol(name, argument, i)).collect::<Vec<_>>()
        };
        // Upper triangle of a matrix stored column by column.
        let base = (0..6).flat_map(|row| (row..6).map(move |column| (row, column)));
        let base = base.map(|(row, column)| {
            symbol(format!("base_{}_{}", row + 1, column + 1), Argument::BaseAddedInertia, row + 6 * column)
        });
        let parameters = chain.parameters.iter().enumerate();
        let inputs = chain.inputs.iter().flat_map(|Input { name, .. }| {
            let named = |suffix: &str| format!("{name}{suffix}");
            [named(""), named("_is_free"), named("_rate")]
        });
        [
            vec![symbol("t".into(), Argument::Time, 0)],
            each(Argument::Position, ""),
            each(Argument::Velocity, "_dot"),
            each(Argument::Acceleration, "_ddot"),
            each(Argument::RightHandSide, "_force"),
            each(Argument::DrivePositions, "_held"),
            each(Argument::AddedInertia, "_added_inertia"),
            base.collect(),
            parameters.map(|(i, parameter)| symbol(parameter.name.clone(), Argument::Parameters, i)).collect(),
            inputs.enumerate().map(|(i, name)| symbol(name, Argument::Inputs, i)).collect(),
        ]
        .concat()
    }

    /// Two inputs on which no law of a force depends; they stand for its strain and rate while it is differentiated.
    pub fn free_symbols(&self) -> [Expr<'g>; 2] {
        [self.base_added_inertia[0], self.base_added_inertia[1]]
    }

    /// The same chain at another pose.
    pub fn at(&self, q: Vec<Expr<'g>>) -> Self {
        Model { q, ..self.clone() }
    }

    /// Adds `−∂f/∂q` of generalized forces that have a potential and depend only on some coordinates.
    pub fn add_tangent(&self, forces: &[Expr<'g>], coordinates: &BTreeSet<usize>, matrix: &mut SymmetricMatrix<'g>) {
        for &j in coordinates {
            for (i, slope) in self.graph.derivatives(forces, self.q[j]).into_iter().enumerate().take(j + 1) {
                matrix.add(i, j, -slope);
            }
        }
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

    /// The rotation by coordinate j.
    pub fn axis_rotation(&self, j: usize) -> AxisRotation<'g> {
        let (coordinate, q) = (&self.chain.coordinates[j], self.q[j]);
        let (sin, cos) = (q.sin(), q.cos());
        self.graph.name(sin, format!("sin_{}", coordinate.name));
        self.graph.name(cos, format!("cos_{}", coordinate.name));
        AxisRotation { axis: coordinate.axis, sin, cos }
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
            Value::Sqrt(a) => self.number(a).sqrt(),
        }
    }

    /// An input: its value at t = 0 while it is set, else 0; 0 while it is set, else 1; and its rate.
    pub fn input(&self, InputId(index): InputId) -> [Expr<'g>; Input::SLOTS] {
        [0, 1, 2].map(|slot| self.inputs[Input::SLOTS * index + slot])
    }

    /// Second moments `∫ r rᵀ dm` of a body about its frame's origin.
    pub fn second_moments(&self, inertia: &Inertia) -> Symmetric3<'g> {
        Symmetric3([0, 1, 2, 3, 4, 5].map(|i| self.number(&inertia.second[i])))
    }

    /// Three numbers of the chain.
    pub fn vector(&self, values: &[Value; 3]) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|i| self.number(&values[i])))
    }
}
