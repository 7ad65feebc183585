//! Straight-line operations on values: angles first, then everything in the order of its derivation, in which independent
//! operations are close together, or result by result, which keeps fewer values at a time. Results are copied in batches, as soon as
//! a batch of them is known.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crane_codegen::program::Entry;
use crane_codegen::symbolic::{ExprId, Op};

use super::Graph;
use super::select::{NOTHING, Operand, Recipe, Selection, Signed};
use crate::bytecode::{Fixed, Inputs, Kind};

/// Number of results copied at a time: a copy ends a run, but a waiting result keeps a register.
const BATCH: usize = 256;

/// Number of a value.
pub type Value = usize;

/// A function as a straight line.
#[derive(Debug, Default)]
pub struct AssembledLine {
    /// The first values, which are available before a call.
    pub fixed: Vec<Fixed>,
    /// The next values, in sequence, which are read at the start of a call.
    pub inputs: Vec<Inputs>,
    /// The number of values.
    pub values: usize,
    /// The operations, in order.
    pub steps: Vec<Step>,
    /// The number of results.
    pub results: usize,
}

/// An operation, or a result to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// An operation on values.
    Operation {
        /// Its kind.
        kind: Kind,
        /// Its result.
        out: Value,
        /// Its operands; unused ones are arbitrary.
        operands: [Value; 3],
    },
    /// Sine and cosine of an angle.
    Angle {
        /// The angle.
        angle: Value,
        /// Its sine.
        sin: Value,
        /// Its cosine.
        cos: Value,
    },
    /// Stumpff's functions of an argument.
    Stumpff {
        /// The argument.
        argument: Value,
        /// c₀ to c₅.
        values: [Value; Op::STUMPFF_ORDERS],
    },
    /// A result.
    Store {
        /// Its place.
        place: usize,
        /// Its value.
        value: Value,
    },
}

impl Step {
    /// Values it reads.
    pub fn reads(&self) -> impl Iterator<Item = Value> {
        let (values, count) = match *self {
            Step::Operation { kind: Kind::MulAdd | Kind::Select, operands, .. } => (operands, 3),
            Step::Operation { kind: Kind::Sqrt | Kind::Exp, operands, .. } => (operands, 1),
            Step::Operation { operands, .. } => (operands, 2),
            Step::Angle { angle: value, .. } | Step::Stumpff { argument: value, .. } | Step::Store { value, .. } => {
                ([value; 3], 1)
            }
        };
        values.into_iter().take(count)
    }

    /// Values it computes.
    pub fn makes(&self) -> impl Iterator<Item = Value> {
        let (values, count) = match *self {
            Step::Operation { out, .. } => ([out; Op::STUMPFF_ORDERS], 1),
            Step::Angle { sin, cos, .. } => ([sin, cos, sin, sin, sin, sin], 2),
            Step::Stumpff { values, .. } => (values, Op::STUMPFF_ORDERS),
            Step::Store { .. } => ([0; Op::STUMPFF_ORDERS], 0),
        };
        values.into_iter().take(count)
    }
}

/// Code under construction.
struct LineWriter<'a> {
    graph: &'a Graph<'a>,
    selection: &'a Selection,
    line: AssembledLine,
    fixed: FxHashMap<Key, Value>,
    /// Values of every node and its negative.
    values: Vec<[Option<Value>; 2]>,
}

/// A number that is available before a call.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Key {
    Number(u64),
    Node(ExprId, bool),
}

/// The order of the operations after the angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// As they were derived.
    Derivation,
    /// What the first result needs, then what the second one needs besides, and so on: of a dense matrix of n² results, few are then
    /// under way at a time.
    Results,
}

impl AssembledLine {
    /// The line of a selection; `entries` are the results, of `outputs`.
    pub fn new(graph: &Graph, selection: &Selection, outputs: &[ExprId], entries: &[Entry], order: Order) -> Self {
        let mut writer = LineWriter {
            graph,
            selection,
            line: AssembledLine { results: entries.len(), ..AssembledLine::default() },
            fixed: FxHashMap::default(),
            values: vec![[None; 2]; graph.program.operations.len()],
        };
        let copied = entries.iter().map(|entry| match entry {
            Entry::Number(number) => Operand::Number(*number),
            Entry::Slot(slot) => graph.operand(outputs[*slot], false),
        });
        let copied: Vec<Operand> = copied.collect();
        writer.write_fixed(&copied);
        writer.write_inputs();
        writer.write_angles();
        let mut copies = Copies::new(&writer, &copied);
        let write = |id| {
            writer.write(id);
            copies.note(&mut writer, id);
        };
        match order {
            Order::Derivation => graph.program.ids().for_each(write),
            Order::Results => selection.visit_operands_first(&copied, write),
        }
        copies.flush(&mut writer);
        writer.line
    }
}

impl LineWriter<'_> {
    fn value(&mut self) -> Value {
        self.line.values += 1;
        self.line.values - 1
    }

    /// A value for every number that operations and results read and that is available before a call.
    fn write_fixed(&mut self, copied: &[Operand]) {
        let recipes = self.selection.recipes.iter().flatten();
        let operands: Vec<Operand> = recipes.flat_map(|(recipe, _)| recipe.operands()).collect();
        // The operation that changes a sign.
        let signs = [Operand::Number(-1.0), NOTHING];
        for operand in signs.iter().chain(copied).chain(&operands) {
            if let Some((key, fixed)) = self.fixed(*operand)
                && !self.fixed.contains_key(&key)
            {
                let value = self.value();
                self.fixed.insert(key, value);
                self.line.fixed.push(fixed);
            }
        }
    }

    /// The number of an operand that is available before a call, and its key.
    fn fixed(&self, operand: Operand) -> Option<(Key, Fixed)> {
        match operand {
            Operand::Number(number) => Some((Key::Number(number.to_bits()), Fixed::Number(number))),
            Operand::Value(Signed { id, negative }) if self.graph.is_fixed(id) => {
                let fixed = if let Op::Symbol(symbol) = self.graph.program.op(id) {
                    Fixed::Parameter { index: self.graph.program.symbol(symbol).index, negative }
                } else {
                    let stored = self.graph.constants.map_or(&[][..], |constants| &constants.stored);
                    Fixed::Stored { index: stored.binary_search(&id).unwrap_or_default(), negative }
                };
                Some((Key::Node(id, negative), fixed))
            }
            Operand::Value(_) => None,
        }
    }

    /// The value of an operand that is available before a call.
    fn fixed_value(&self, operand: Operand) -> Option<Value> {
        self.fixed(operand).and_then(|(key, _)| self.fixed.get(&key).copied())
    }

    fn operand(&self, operand: Operand) -> Value {
        match self.fixed_value(operand) {
            Some(value) => value,
            None => match operand {
                Operand::Value(Signed { id, negative }) => {
                    self.values[id.index()][usize::from(negative)].expect("operands come before their users")
                }
                Operand::Number(_) => unreachable!("a number is there before a call"),
            },
        }
    }

    fn write_inputs(&mut self) {
        for id in self.graph.program.ids() {
            if let (Op::Symbol(symbol), Some(_)) = (self.graph.program.op(id), self.selection.recipes[id.index()]) {
                let symbol = self.graph.program.symbol(symbol);
                let value = self.value();
                self.values[id.index()][0] = Some(value);
                match self.line.inputs.last_mut() {
                    Some(last) if last.argument == symbol.argument && last.first + last.count == symbol.index => {
                        last.count += 1;
                    }
                    _ => {
                        let first = symbol.index;
                        self.line.inputs.push(Inputs { argument: symbol.argument, first, count: 1 });
                    }
                }
            }
        }
    }

    /// Sines and cosines of all angles and Stumpff's functions of all arguments, after their operands. If one depends on the sine
    /// of another, it comes later.
    fn write_angles(&mut self) {
        let program = self.graph.program;
        // The nesting depth of sines before a value.
        let mut depth = vec![0u32; program.operations.len()];
        let mut deepest = 0;
        for id in program.ids().filter(|id| self.selection.recipes[id.index()].is_some()) {
            let op = program.op(id);
            let before = op.operands().map(|operand| depth[operand.index()]).max().unwrap_or(0);
            depth[id.index()] = before + u32::from(op.is_elementary());
            deepest = deepest.max(depth[id.index()]);
        }
        for inner in 1..=deepest {
            self.write_stumpff(&depth, inner);
            // Sine and cosine of each angle.
            let mut angles: BTreeMap<ExprId, (Operand, [Option<ExprId>; 2])> = BTreeMap::new();
            for id in program.ids().filter(|id| depth[id.index()] == inner) {
                let (angle, side) = match self.selection.recipes[id.index()] {
                    Some((Recipe::Sin(angle), _)) => (angle, 0),
                    Some((Recipe::Cos(angle), _)) => (angle, 1),
                    _ => continue,
                };
                let written = program.op(id).operands().next().unwrap_or(id);
                angles.entry(written).or_insert((angle, [None; 2])).1[side] = Some(id);
            }
            let operands: Vec<Operand> = angles.values().map(|(angle, _)| *angle).collect();
            self.write_all(&operands);
            for (angle, sides) in angles.into_values() {
                let angle = self.operand(angle);
                let [sin, cos] = [self.value(), self.value()];
                self.line.steps.push(Step::Angle { angle, sin, cos });
                for (id, value) in sides.into_iter().zip([sin, cos]) {
                    if let Some(id) = id {
                        self.values[id.index()][0] = Some(value);
                    }
                }
            }
        }
    }

    /// Stumpff's functions of all arguments of a depth.
    fn write_stumpff(&mut self, depth: &[u32], inner: u32) {
        let program = self.graph.program;
        let mut arguments: BTreeMap<ExprId, (Operand, [Option<ExprId>; Op::STUMPFF_ORDERS])> = BTreeMap::new();
        for id in program.ids().filter(|id| depth[id.index()] == inner) {
            let (Op::Stumpff(k, of), Some((Recipe::Stumpff(_, argument), _))) =
                (program.op(id), self.selection.recipes[id.index()])
            else {
                continue;
            };
            arguments.entry(of).or_insert((argument, [None; Op::STUMPFF_ORDERS])).1[usize::from(k)] = Some(id);
        }
        let operands: Vec<Operand> = arguments.values().map(|(argument, _)| *argument).collect();
        self.write_all(&operands);
        for (argument, orders) in arguments.into_values() {
            let argument = self.operand(argument);
            let values = orders.map(|_| self.value());
            self.line.steps.push(Step::Stumpff { argument, values });
            for (id, value) in orders.into_iter().zip(values) {
                if let Some(id) = id {
                    self.values[id.index()][0] = Some(value);
                }
            }
        }
    }

    /// All operations that some operands need and that do not exist yet.
    fn write_all(&mut self, operands: &[Operand]) {
        let mut needed = vec![false; self.graph.program.operations.len()];
        let mark = |operand: &Operand, needed: &mut Vec<bool>| {
            if let Operand::Value(Signed { id, .. }) = operand {
                needed[id.index()] = true;
            }
        };
        for operand in operands {
            mark(operand, &mut needed);
        }
        for id in self.graph.program.ids().rev().filter(|id| self.selection.recipes[id.index()].is_some()) {
            if needed[id.index()]
                && self.values[id.index()] == [None; 2]
                && let Some((recipe, _)) = &self.selection.recipes[id.index()]
            {
                for operand in recipe.operands() {
                    mark(&operand, &mut needed);
                }
            }
        }
        for id in self.graph.program.ids().filter(|id| needed[id.index()]) {
            self.write(id);
        }
    }

    /// The operations of a value and its negative, if they are needed and do not exist.
    fn write(&mut self, id: ExprId) {
        let Some((recipe, sign)) = self.selection.recipes[id.index()] else { return };
        let own = usize::from(sign);
        if self.values[id.index()][own].is_none() {
            let step = match recipe {
                Recipe::MulAdd([a, b, c]) => Some((Kind::MulAdd, [a, b, c])),
                Recipe::Div([a, b]) => Some((Kind::Div, [a, b, b])),
                Recipe::Min([a, b]) => Some((Kind::Min, [a, b, b])),
                Recipe::Max([a, b]) => Some((Kind::Max, [a, b, b])),
                Recipe::Sqrt(a) => Some((Kind::Sqrt, [a, a, a])),
                Recipe::Exp(a) => Some((Kind::Exp, [a, a, a])),
                Recipe::Select(operands) => Some((Kind::Select, operands)),
                Recipe::Given | Recipe::Sin(_) | Recipe::Cos(_) | Recipe::Stumpff(..) => None,
            };
            let Some((kind, operands)) = step else { return };
            let operands = operands.map(|operand| self.operand(operand));
            let out = self.value();
            self.line.steps.push(Step::Operation { kind, out, operands });
            self.values[id.index()][own] = Some(out);
        }
        let other = 1 - own;
        if self.selection.wanted[id.index()][other]
            && self.values[id.index()][other].is_none()
            && let Some(value) = self.values[id.index()][own]
        {
            let [minus, nothing] = [Operand::Number(-1.0), NOTHING].map(|operand| self.operand(operand));
            let out = self.value();
            self.line.steps.push(Step::Operation { kind: Kind::MulAdd, out, operands: [value, minus, nothing] });
            self.values[id.index()][other] = Some(out);
        }
    }
}

/// Results that wait for their values, or to be copied.
struct Copies {
    /// Indices of the results that a node and its negative provide.
    waiting: FxHashMap<ExprId, [Vec<usize>; 2]>,
    /// Results that are known.
    known: Vec<Step>,
}

impl Copies {
    fn new(writer: &LineWriter, copied: &[Operand]) -> Self {
        let mut copies = Copies { waiting: FxHashMap::default(), known: vec![] };
        for (index, operand) in copied.iter().enumerate() {
            match (writer.fixed_value(*operand), *operand) {
                (Some(value), _) => copies.known.push(Step::Store { place: index, value }),
                (None, Operand::Value(Signed { id, negative })) => {
                    copies.waiting.entry(id).or_default()[usize::from(negative)].push(index);
                }
                (None, Operand::Number(_)) => {}
            }
        }
        copies
    }

    /// The values of a node are available.
    fn note(&mut self, writer: &mut LineWriter, id: ExprId) {
        let Some(places) = self.waiting.remove(&id) else { return };
        for (places, value) in places.into_iter().zip(writer.values[id.index()]) {
            let Some(value) = value else { continue };
            self.known.extend(places.into_iter().map(|index| Step::Store { place: index, value }));
        }
        if self.known.len() >= BATCH {
            self.flush(writer);
        }
    }

    fn flush(&mut self, writer: &mut LineWriter) {
        writer.line.steps.append(&mut self.known);
    }
}
