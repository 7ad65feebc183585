//! Bytes of instructions.

#[cfg(target_arch = "aarch64")]
mod aarch64;
#[cfg(target_arch = "x86_64")]
mod x86_64;

use crate::instruction::Instruction;
use crate::line::Lanes;

/// The code of a function: for x86-64 with the convention `sysv64`, otherwise with that of C.
pub fn encode(instructions: &[Instruction], lanes: Lanes) -> Vec<u8> {
    #[cfg(target_arch = "x86_64")]
    {
        x86_64::encode(instructions, lanes)
    }
    #[cfg(target_arch = "aarch64")]
    {
        assert!(lanes == Lanes::One, "eight numbers at a time are for x86-64");
        aarch64::encode(instructions)
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        let _ = (instructions, lanes);
        unreachable!("`Code::compile` asks for no code on other processors")
    }
}

/// The different steps by which places move in each loop.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
fn loops(instructions: &[Instruction]) -> Vec<std::collections::BTreeSet<i32>> {
    let mut loops = Vec::new();
    for instruction in instructions {
        if let Instruction::Begin(_) = instruction {
            loops.push(std::collections::BTreeSet::new());
        }
        let steps = instruction.places().map(|location| location.step).filter(|step| *step != 0);
        if let Some(own) = loops.last_mut() {
            own.extend(steps);
        }
    }
    loops
}
