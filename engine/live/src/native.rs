//! Bytecode as machine code: for functions that are called often, on processors for which there is any.

use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use crane_jit::{Code as MachineCode, Pause, Step, StraightLine, Value, Width, value};
use crane_model::rt::lanes::f64x8;
use crane_model::rt::sin_cos;

use crate::bytecode::{Code, Fixed, Instruction, Instructions, Kind, Operands, ROUNDING};
use crate::dual::eight_orders;
use crate::machine::{ANGLES, Environment, Form, Machine, Number};
use crate::sines::{MOST, with_sines};
use crate::tangent::tangent;

/// After as many calls of interpreted bytecode as machine code saves the time that it took to make it, about 1 µs per operation.
const CALLS: u32 = 500;

/// Whether this processor has machine code of one number, but not of eight: bytecode of eight then takes longer than eight calls.
pub fn is_slower_in_lanes() -> bool {
    static SLOWER: OnceLock<bool> = OnceLock::new();
    *SLOWER.get_or_init(|| {
        let line = StraightLine { given: vec![None], steps: vec![Step::Store { place: 0, value: 0 }], results: 1 };
        let has = |width| MachineCode::compile(&line, ROUNDING, width).is_some();
        has(Width::One) && !has(Width::Eight)
    })
}

/// The machine code of a function, from some call on.
#[derive(Debug, Default)]
pub struct Hot {
    calls: AtomicU32,
    code: OnceLock<Option<Native>>,
}

impl Hot {
    /// The machine code, if the function was called often enough and there is any.
    pub fn called(&self, code: &Code, form: Form) -> Option<&Native> {
        if let Some(known) = self.code.get() {
            return known.as_ref();
        }
        // A call of eight cranes takes as long as three or four of one, a call with derivatives as eight or more.
        let weight = match form {
            Form::One => 1,
            Form::Eight => 4,
            Form::Slopes => 8,
        };
        let before = self.calls.fetch_add(weight, Ordering::Relaxed);
        // One call makes the code; calls on other threads go on with bytecode meanwhile, and wait for nothing.
        (before < CALLS && before + weight >= CALLS).then(|| self.get(code, form)).flatten()
    }

    /// The machine code, made now if it was not made before.
    pub fn get(&self, code: &Code, form: Form) -> Option<&Native> {
        self.code.get_or_init(|| Native::new(code, form)).as_ref()
    }
}

/// A function as machine code, with pauses for what is computed for eight numbers at a time: sines and cosines, Stumpff's functions,
/// exponentials.
#[derive(Debug)]
pub struct Native {
    code: MachineCode,
    /// What is computed in each pause; after them there may be one that checks angles.
    pauses: Vec<Kind>,
    /// The number of places of fixed numbers, and the number of all given ones.
    given: [usize; 2],
    /// Numbers that never change among those given after these, and their places.
    numbers: Vec<(usize, f64)>,
    results: usize,
}

impl Native {
    fn new(code: &Code, form: Form) -> Option<Self> {
        let Instructions::Narrow(instructions) = &code.instructions else { return None };
        let (line, pauses) = line(code, instructions);
        let given = [code.fixed.len(), line.given.len()];
        let (line, pauses, width) = match form {
            Form::One => (line, pauses, Width::One),
            Form::Eight => {
                let (line, pauses) = with_sines(&line, &pauses);
                (line, pauses, Width::Eight)
            }
            Form::Slopes => (tangent(&line, &pauses), pauses, Width::Eight),
        };
        let numbers = line.given.iter().enumerate().skip(given[1]);
        let numbers = numbers.filter_map(|(index, number)| Some((index, (*number)?))).collect();
        Some(Self {
            code: MachineCode::compile(&line, ROUNDING, width)?,
            pauses,
            given,
            numbers,
            results: code.results,
        })
    }

    /// Bytes of machine code.
    pub fn bytes(&self) -> usize {
        self.code.bytes()
    }

    /// The number of results.
    pub fn results(&self) -> usize {
        self.results
    }

    /// A frame with these fixed numbers.
    fn frame<T: Number>(&self, fixed: &[T]) -> Vec<T> {
        let [fixed_places, given] = self.given;
        let mut frame = vec![T::splat(0.0); self.code.places().max(given + self.numbers.len())];
        frame.iter_mut().zip(fixed).take(fixed_places).for_each(|(place, number)| *place = *number);
        let known = self.numbers.iter().copied().chain(self.code.numbers());
        known.for_each(|(index, number)| frame[index] = T::splat(number));
        frame
    }

    /// Runs it on a machine of its bytecode; there is room for all results. Returns whether they count: the sines of large angles are not in the code.
    pub fn run<T: Number>(
        &self,
        code: &Code,
        machine: &mut Machine<T>,
        environment: &Environment<'_, T>,
        out: &mut [T],
    ) -> bool {
        if T::FORM == Form::Slopes {
            self.run_with_slopes(code, machine, environment, out);
            return true;
        }
        let (frame, version) = machine.frame(|fixed| self.frame(fixed));
        environment.write(code, frame, std::mem::replace(version, environment.version));
        for part in 0..self.code.parts() {
            self.code.run(part, T::flat(frame), T::flat(out));
            match (self.code.pause(part), self.pauses.get(part)) {
                (Some(pause), Some(kind)) => compute(*kind, pause, frame),
                (Some(Pause { arguments, .. }), None) => {
                    let squares = T::flat(&mut frame[arguments..=arguments]);
                    return squares.iter().all(|square| *square <= MOST);
                }
                (None, _) => {}
            }
        }
        true
    }
}

impl Native {
    /// The same of numbers with derivatives: cells of given numbers are followed by those of their derivatives, and so are results.
    fn run_with_slopes<T: Number>(
        &self,
        code: &Code,
        machine: &mut Machine<T>,
        environment: &Environment<'_, T>,
        out: &mut [T],
    ) {
        let [fixed, given] = self.given;
        let (registers, [frame, results]) = machine.with_cells();
        if frame.is_empty() {
            let zero = f64x8::splat(0.0);
            frame.resize(self.code.places().max(2 * given + self.numbers.len()), zero);
            results.resize(2 * self.results, zero);
            let known = self.numbers.iter().copied().chain(self.code.numbers());
            known.for_each(|(index, number)| frame[index] = f64x8::splat(number));
            for (index, number) in registers.iter().enumerate().take(fixed) {
                [frame[index], frame[given + index]] = number.cells();
            }
        }
        environment.each(code, |index, number| [frame[index], frame[given + index]] = number.cells());
        for part in 0..self.code.parts() {
            self.code.run(part, f64x8::flat(frame), f64x8::flat(results));
            if let (Some(pause), Some(kind)) = (self.code.pause(part), self.pauses.get(part)) {
                compute_with_slopes(*kind, pause, frame);
            }
        }
        let (values, slopes) = results.split_at(self.results);
        for ((out, value), slopes) in out.iter_mut().zip(values).zip(slopes) {
            *out = T::of_cells([*value, *slopes]);
        }
    }
}

/// What is computed in a pause of machine code with derivatives: functions of the numbers, each of which fills its cell. Those of Stumpff have two
/// more orders.
fn compute_with_slopes(kind: Kind, pause: Pause, frame: &mut [f64x8]) {
    let Pause { arguments, reads, values, makes } = pause;
    let (arguments, values) = frame[arguments..values + makes].split_at_mut(reads);
    for first in (0..reads).step_by(ANGLES) {
        let range = first..reads.min(first + ANGLES);
        let mut eight = [0.0; ANGLES];
        eight.iter_mut().zip(&arguments[range.clone()]).for_each(|(place, argument)| *place = argument.as_array()[0]);
        let mut write = |order: usize, computed: &[f64; ANGLES]| {
            let places = &mut values[order * reads + range.start..order * reads + range.end];
            places.iter_mut().zip(computed).for_each(|(place, number)| *place = f64x8::splat(*number));
        };
        match kind {
            Kind::Angle => {
                let (sines, cosines) = sin_cos(eight);
                write(0, &sines);
                write(1, &cosines);
            }
            Kind::Stumpff => eight_orders(eight).iter().enumerate().for_each(|(order, row)| write(order, row)),
            _ => write(0, &eight.map(crane_model::rt::exp)),
        }
    }
}

/// What is computed in a pause, eight by eight: values follow their arguments in the frame, order by order.
fn compute<T: Number>(kind: Kind, pause: Pause, frame: &mut [T]) {
    let Pause { arguments, reads, values, makes } = pause;
    let (arguments, values) = frame[arguments..values + makes].split_at_mut(reads);
    for first in (0..reads).step_by(ANGLES) {
        let range = first..reads.min(first + ANGLES);
        let mut eight = [T::splat(0.0); ANGLES];
        eight.iter_mut().zip(&arguments[range.clone()]).for_each(|(place, argument)| *place = *argument);
        let mut write = |order: usize, computed: &[T; ANGLES]| {
            let Range { start, end } = range;
            values[order * reads + start..order * reads + end].copy_from_slice(&computed[..end - start]);
        };
        match kind {
            Kind::Angle => {
                let (sines, cosines) = T::sin_cos(eight);
                write(0, &sines);
                write(1, &cosines);
            }
            Kind::Stumpff => T::stumpff(eight).iter().enumerate().for_each(|(order, row)| write(order, row)),
            _ => write(0, &eight.map(crane_model::rt::exp)),
        }
    }
}

/// Bytecode as a line, in which each value has its own number; and what its pauses compute.
fn line(code: &Code, mut instructions: &[Instruction]) -> (StraightLine, Vec<Kind>) {
    let number = |fixed: &Fixed| match fixed {
        Fixed::Number(number) => Some(*number),
        Fixed::Parameter { .. } | Fixed::Stored { .. } => None,
    };
    let inputs: usize = code.inputs.iter().map(|inputs| inputs.count).sum();
    let given: Vec<_> = code.fixed.iter().map(number).chain((0..inputs).map(|_| None)).collect();
    let mut of = vec![0; code.registers.max(given.len())];
    (0..given.len()).for_each(|at| of[at] = value(at));
    let mut writer = CompiledFunction {
        of,
        count: given.len(),
        pauses: vec![],
        line: StraightLine { given, steps: vec![], results: code.results },
    };
    let mut stores = code.stores.as_slice();
    for segment in &code.segments {
        let length = segment.length as usize;
        if segment.kind == Kind::Store {
            let (own, rest) = stores.split_at(length);
            stores = rest;
            let step = |store: &crate::bytecode::Store| Step::Store {
                place: store.place,
                value: writer.of[store.register as usize],
            };
            let steps: Vec<Step> = own.iter().map(step).collect();
            writer.line.steps.extend(steps);
        } else {
            let (own, rest) = instructions.split_at(length);
            instructions = rest;
            writer.write(segment.kind, own);
        }
    }
    (writer.line, writer.pauses)
}

/// A line under construction.
struct CompiledFunction {
    /// The value in each register.
    of: Vec<Value>,
    /// The number of values.
    count: usize,
    pauses: Vec<Kind>,
    line: StraightLine,
}

impl CompiledFunction {
    fn write(&mut self, kind: Kind, instructions: &[Instruction]) {
        if matches!(kind, Kind::Angle | Kind::Stumpff | Kind::Exp) {
            self.pause(kind, instructions);
            return;
        }
        for i in instructions {
            let [a, b, c] = [i.a(), i.b(), i.c()].map(|register| self.of[register]);
            self.line.steps.push(match kind {
                Kind::Div => Step::Div([a, b]),
                Kind::Min => Step::Min([a, b]),
                Kind::Max => Step::Max([a, b]),
                Kind::Sqrt => Step::Sqrt(a),
                Kind::Select => Step::Select([a, b, c]),
                _ => Step::MulAdd([a, b, c]),
            });
            self.of[i.out()] = value(self.count);
            self.count += 1;
        }
    }

    /// Functions of several arguments at once: no argument is a value of another.
    fn pause(&mut self, kind: Kind, instructions: &[Instruction]) {
        let per_argument = kind.instructions() as usize;
        let arguments: Vec<Value> = instructions.iter().step_by(per_argument).map(|i| self.of[i.a()]).collect();
        let reads = arguments.len();
        let first = self.count;
        for (at, own) in instructions.chunks(per_argument).enumerate() {
            let outs = own.iter().flat_map(|i| match kind {
                Kind::Exp => vec![i.out()],
                Kind::Angle => vec![i.out(), i.b()],
                _ => vec![i.out(), i.b(), i.c()],
            });
            for (order, register) in outs.enumerate() {
                self.of[register] = value(first + order * reads + at);
                self.count += 1;
            }
        }
        self.line.steps.push(Step::Pause { arguments, makes: self.count - first });
        self.pauses.push(kind);
    }
}
