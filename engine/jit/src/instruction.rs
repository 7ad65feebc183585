//! Operations on registers and places of the frame, as processors have them.

use crate::operations::Kind;

/// Number of a floating-point register.
pub type Register = u8;

/// A place in the frame: its number in the first iteration of a loop, and by how much it moves from iteration to iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Location {
    /// Its number.
    pub at: i32,
    /// Places per iteration; 0 outside of loops.
    pub step: i32,
}

/// Where an operand is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// In a register.
    Register(Register),
    /// In the frame.
    Memory(Location),
}

/// An instruction, or a few that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instruction {
    /// From the frame to a register.
    Load(Register, Location),
    /// From a register to the frame.
    Store(Register, Location),
    /// From a register to the results.
    Result(Register, Location),
    /// From a register (the second) to another.
    Move(Register, Register),
    /// An operation. At most one operand is in memory: the last, or any of a fused one. Without three-operand forms, the result
    /// of a fused operation is in the register of one of its operands. `spare`: a register for the choices of an extremum.
    Compute {
        /// What it computes.
        kind: Kind,
        /// Register of the result.
        out: Register,
        /// As many operands as the kind has.
        operands: [Operand; 3],
        /// Any register that is neither result nor operand.
        spare: Register,
    },
    /// The first instruction of a loop: iterations.
    Begin(u32),
    /// The last instruction of a loop.
    End,
}

impl Instruction {
    /// The places of the frame that it reads or writes.
    pub fn places(&self) -> impl Iterator<Item = Location> {
        let of = |operand: Operand| match operand {
            Operand::Memory(location) => Some(location),
            Operand::Register(_) => None,
        };
        let places = match *self {
            Instruction::Load(_, location) | Instruction::Store(_, location) => [Some(location), None, None],
            Instruction::Compute { operands, .. } => operands.map(of),
            Instruction::Result(..) | Instruction::Move(..) | Instruction::Begin(_) | Instruction::End => [None; 3],
        };
        places.into_iter().flatten()
    }

    /// Raises the numbers of places of the frame and of the results to what it reads and writes; `iterations` is that of the loop
    /// around it.
    ///
    /// # Panics
    /// If a place is before the frame.
    pub fn reach(&self, places: &mut usize, results: &mut usize, iterations: &mut u32) {
        match self {
            Instruction::Begin(count) => *iterations = *count,
            Instruction::End => *iterations = 1,
            _ => {}
        }
        let end = |place: Location| {
            let first = i64::from(place.at);
            let last = first + i64::from(place.step) * (i64::from(*iterations) - 1);
            assert!(first >= 0 && last >= 0, "a place before the frame");
            usize::try_from(first.max(last)).map_or(usize::MAX, |last| last + 1)
        };
        for location in self.places() {
            *places = end(location).max(*places);
        }
        if let Instruction::Result(_, location) = self {
            *results = end(*location).max(*results);
        }
    }
}
