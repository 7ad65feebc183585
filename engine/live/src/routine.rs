//! A function that is ready to run with any live parameters.

use crane_codegen::lower::Constants;
use crane_codegen::program::{Function, Program, Shape};
use crane_codegen::symbolic::{ExprId, Op};

use crate::assemble::{assemble, assemble_constants};
use crate::bytecode::Code;
use crate::machine::{Environment, Form, Machine, Number};
use crate::native::{Hot, Native};

/// A function as bytecode, with its constants computed from live parameters; and as machine code, once it was called often.
#[derive(Debug)]
pub struct Routine {
    shape: Shape,
    code: Code,
    constants: Code,
    /// Places of the slots of its result that are not always zero.
    places: Vec<usize>,
    /// Machine code for one state, for eight, and for one with derivatives.
    native: [Hot; 3],
}

impl Routine {
    /// A function of a program.
    #[must_use]
    pub fn new(program: &Program, function: &Function) -> Self {
        let alone = program.alone(function);
        let constants = Constants::new(&alone);
        let code = alone.functions.iter().map(|function| assemble(&alone, &constants, function)).next();
        let is_zero = |slot: &ExprId| matches!(program.op(*slot), Op::Constant(number) if number.value() == 0.0);
        let slots = function.outputs.iter().enumerate();
        Self {
            places: slots.filter(|(_, slot)| !is_zero(slot)).map(|(index, _)| index).collect(),
            shape: function.shape.clone(),
            code: code.unwrap_or_default(),
            constants: assemble_constants(&alone, &constants),
            native: Default::default(),
        }
    }

    /// The shape of its result.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The number of its results, as [`Shape::entries`](crane_codegen::program::Shape::entries) has them.
    #[must_use]
    pub fn results(&self) -> usize {
        self.code.results
    }

    /// Places of the slots of its result that are not always zero.
    #[must_use]
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// Its bytecode.
    #[must_use]
    pub fn code(&self) -> &Code {
        &self.code
    }

    /// A machine for runs with these live parameters.
    pub fn machine<T: Number>(&self, parameters: &[T]) -> Machine<T> {
        let mut machine = Machine::new(&self.code);
        self.set_parameters(&mut machine, parameters);
        machine
    }

    /// Gives a machine of this function other live parameters.
    pub fn set_parameters<T: Number>(&self, machine: &mut Machine<T>, parameters: &[T]) {
        let zero = T::splat(0.0);
        let nothing = |_| zero;
        let mut stored = vec![zero; self.constants.results];
        let environment = Environment { parameters, ..Environment::none() };
        let mut constants = Machine::new(&self.constants);
        constants.fix(&self.constants, nothing, nothing);
        constants.run(&self.constants, &environment, &mut stored);
        let at = |values: &[T], index: usize| values.get(index).copied().unwrap_or(zero);
        machine.fix(&self.code, |index| at(parameters, index), |index| at(&stored, index));
    }

    /// Runs it on a machine that it made: from some hundred calls on as machine code, with the same results.
    pub fn run<T: Number>(&self, machine: &mut Machine<T>, environment: &Environment<'_, T>, out: &mut [T]) {
        let native = self.hot::<T>().called(&self.code, T::FORM).filter(|native| out.len() >= native.results());
        if !native.is_some_and(|native| native.run(&self.code, machine, environment, out)) {
            machine.run(&self.code, environment, out);
        }
    }

    /// Runs its bytecode.
    pub fn interpret<T: Number>(&self, machine: &mut Machine<T>, environment: &Environment<'_, T>, out: &mut [T]) {
        machine.run(&self.code, environment, out);
    }

    /// Makes its machine code now, instead of after some hundred calls; returns its bytes, or `None` if this processor or
    /// system has none.
    pub fn compile<T: Number>(&self) -> Option<usize> {
        self.hot::<T>().get(&self.code, T::FORM).map(Native::bytes)
    }

    fn hot<T: Number>(&self) -> &Hot {
        let [one, eight, slopes] = &self.native;
        match T::FORM {
            Form::One => one,
            Form::Eight => eight,
            Form::Slopes => slopes,
        }
    }
}
