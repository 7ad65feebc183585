//! The functions of a crane: a part of them is derived when one of it is first asked for, assembled one by one.

use std::sync::OnceLock;

use crane_codegen::chain::Chain;
use crane_codegen::mechanics;
use crane_codegen::program::{FunctionId, Part, Product, Program};

use crate::assemble::TooLarge;
use crate::routine::Routine;

/// A product of a function, once it was asked for.
type OfFunction = OnceLock<Result<Option<Routine>, TooLarge>>;

/// The functions of a chain.
#[derive(Debug)]
pub struct Library {
    chain: Chain,
    parents: Vec<usize>,
    programs: [OnceLock<Program>; Part::ALL.len()],
    routines: [OnceLock<Option<Routine>>; FunctionId::COUNT],
    /// For each of [`Product::ALL`].
    products: [[OfFunction; FunctionId::COUNT]; Product::ALL.len()],
}

impl Library {
    /// The functions of a chain, none of them derived yet.
    pub fn new(chain: Chain) -> Self {
        let routines = std::array::from_fn(|_| OnceLock::new());
        let products = std::array::from_fn(|_| std::array::from_fn(|_| OnceLock::new()));
        Self { parents: chain.parents(), chain, programs: Default::default(), routines, products }
    }

    /// The chain.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// What the bodies of a chain with branches are attached to.
    pub fn parents(&self) -> &[usize] {
        &self.parents
    }

    /// A function; `None` if the crane does not need it.
    pub fn routine(&self, id: FunctionId) -> Option<&Routine> {
        self.routines[id as usize].get_or_init(|| self.assemble(id)).as_ref()
    }

    /// A product of a function, see [`Program::product_alone`]; `None` if the crane does not need it.
    ///
    /// # Errors
    /// It needs too many registers: the numbers of the function are all kept until they are used on the way back.
    pub fn product(&self, id: FunctionId, product: Product) -> Result<Option<&Routine>, TooLarge> {
        let derive = || {
            let program = self.program(id);
            let alone = program.function(id).map(|function| program.product_alone(function, product));
            let routine = alone.map(|alone| Routine::new(&alone, &alone.functions[0]));
            let wide = routine.as_ref().map(Routine::code).filter(|code| code.is_wide());
            wide.map_or(Ok(()), |code| Err(TooLarge { registers: code.registers }))?;
            Ok(routine)
        };
        let kept = &self.products[product as usize][id as usize];
        kept.get_or_init(derive).as_ref().map(Option::as_ref).map_err(|large| *large)
    }

    fn assemble(&self, id: FunctionId) -> Option<Routine> {
        let program = self.program(id);
        Some(Routine::new(program, program.function(id)?))
    }

    /// The program with a function.
    fn program(&self, id: FunctionId) -> &Program {
        let part = id.part();
        self.programs[part as usize].get_or_init(|| mechanics::derive_part(&self.chain, part))
    }
}
