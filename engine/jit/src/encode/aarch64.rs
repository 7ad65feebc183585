//! Instructions of aarch64 (Arm Architecture Reference Manual for A-profile, C7: each instruction under its name), for one number.

use std::collections::BTreeMap;

use super::loops;
use crate::instruction::{Instruction, Operand, Place, Register};
use crate::operations::{Kind, Signs};

/// First argument: the frame.
const FRAME: u32 = 0;
/// Second argument: the results.
const RESULTS: u32 = 1;
/// For addresses beyond the reach of a displacement.
const SCRATCH: u32 = 9;
/// Counts iterations.
const COUNTER: u32 = 8;
/// Registers for places that move, of those that a call may change.
const MOVING: std::ops::Range<u32> = 10..16;
/// Bytes up to which one instruction adds a number.
const SUM: u32 = 1 << 12;
/// The stack pointer.
const STACK: u32 = 31;
/// Registers of which a function keeps the lower halves.
const KEPT: std::ops::Range<u32> = 8..16;
/// Bytes within the reach of a displacement: twelve bits times eight.
const REACH: u32 = 1 << 15;

/// The code of instructions: a function of the frame and the results, `extern "C"`.
pub fn encode(instructions: &[Instruction]) -> Vec<u8> {
    let mut encoder = Encoder { words: vec![], moving: BTreeMap::new(), begin: 0 };
    // stp first, second, [sp, #-16]!
    KEPT.step_by(2).for_each(|first| encoder.words.push(0x6dbf_0000 | (first + 1) << 10 | STACK << 5 | first));
    let mut steps = loops(instructions).into_iter();
    for instruction in instructions {
        match instruction {
            Instruction::Begin(iterations) => {
                let steps = steps.next().unwrap_or_default();
                encoder.begin(*iterations, steps.into_iter().zip(MOVING).collect());
            }
            Instruction::End => encoder.end(),
            _ => encoder.write(instruction),
        }
    }
    // ldp first, second, [sp], #16
    KEPT.step_by(2).rev().for_each(|first| encoder.words.push(0x6cc1_0000 | (first + 1) << 10 | STACK << 5 | first));
    // ret
    encoder.words.push(0xd65f_03c0);
    encoder.words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

struct Encoder {
    words: Vec<u32>,
    /// Within a loop: the register for each step by which places move.
    moving: BTreeMap<i32, u32>,
    /// Where the present loop begins.
    begin: usize,
}

impl Encoder {
    fn write(&mut self, instruction: &Instruction) {
        match *instruction {
            Instruction::Load(to, from) => self.access(0xfd40_0000, to, self.base(from), from),
            Instruction::Store(from, to) => self.access(0xfd00_0000, from, self.base(to), to),
            Instruction::Result(from, to) => self.access(0xfd00_0000, from, RESULTS, to),
            // fmov
            Instruction::Move(to, from) => self.words.push(0x1e60_4000 | u32::from(from) << 5 | u32::from(to)),
            Instruction::Compute { kind, out, operands, .. } => self.compute(kind, u32::from(out), operands),
            Instruction::Begin(_) | Instruction::End => {}
        }
    }

    /// The register from which a place is counted.
    fn base(&self, place: Place) -> u32 {
        self.moving.get(&place.step).copied().unwrap_or(FRAME)
    }

    /// Registers for what moves, and the number of iterations.
    fn begin(&mut self, iterations: u32, moving: BTreeMap<i32, u32>) {
        // mov register, frame
        self.words.extend(moving.values().map(|register| 0xaa00_03e0 | FRAME << 16 | register));
        self.moving = moving;
        // movz counter, #low; movk counter, #high, lsl #16
        self.words.push(0xd280_0000 | (iterations & 0xffff) << 5 | COUNTER);
        self.words.push(0xf2a0_0000 | iterations >> 16 << 5 | COUNTER);
        self.begin = self.words.len();
    }

    /// Moves on, and repeats unless it was the last iteration.
    fn end(&mut self) {
        for (step, register) in std::mem::take(&mut self.moving) {
            let (bytes, forward) = (step.unsigned_abs() * 8, step > 0);
            // add or sub register, register, #units, and the same with units of 4096 bytes
            let opcode = if forward { 0x9100_0000 } else { 0xd100_0000 };
            let mut add = |shift: u32, units: u32| {
                if units > 0 {
                    self.words.push(opcode | shift << 22 | units << 10 | register << 5 | register);
                }
            };
            add(0, bytes % SUM);
            add(1, bytes / SUM);
        }
        // subs counter, counter, #1; b.ne begin
        self.words.push(0xf100_0400 | COUNTER << 5 | COUNTER);
        let back = u32::try_from(self.words.len() - self.begin).unwrap_or_default();
        self.words.push(0x5400_0001 | (back.wrapping_neg() & 0x7_ffff) << 5);
    }

    /// ldr or str with a displacement, of eight bytes times twelve bits.
    fn access(&mut self, opcode: u32, register: Register, base: u32, place: Place) {
        let displacement = place.at.unsigned_abs() * 8;
        let (near, far) = (displacement % REACH, displacement / REACH);
        let base = if far == 0 {
            base
        } else {
            // add scratch, base, #far, with far in units of 4096 bytes
            self.words.push(0x9140_0000 | far * (REACH / SUM) << 10 | base << 5 | SCRATCH);
            SCRATCH
        };
        self.words.push(opcode | near / 8 << 10 | base << 5 | u32::from(register));
    }

    fn compute(&mut self, kind: Kind, out: u32, operands: [Operand; 3]) {
        let [a, b, c] = operands.map(|operand| match operand {
            Operand::Register(register) => u32::from(register),
            Operand::Memory(_) => unreachable!("operands are in registers"),
        });
        let of_two = |opcode: u32| opcode | b << 16 | a << 5 | out;
        let word = match kind {
            Kind::Sum => of_two(0x1e60_2800),
            Kind::Difference => of_two(0x1e60_3800),
            Kind::Product => of_two(0x1e60_0800),
            Kind::Quotient => of_two(0x1e60_1800),
            // fmaxnm, fminnm: NaN gives way to a number.
            Kind::Maximum => of_two(0x1e60_6800),
            Kind::Minimum => of_two(0x1e60_7800),
            Kind::Root => 0x1e61_c000 | a << 5 | out,
            Kind::Choice => {
                // fcmp a, #0.0; fcsel out, b, c, gt
                self.words.push(0x1e60_2008 | a << 5);
                0x1e60_cc00 | c << 16 | b << 5 | out
            }
            Kind::Fused(signs) => {
                // fmadd: c + a b; fmsub: c − a b; fnmsub: a b − c
                let opcode = match signs {
                    Signs::Plus => 0x1f40_0000,
                    Signs::Reverse => 0x1f40_8000,
                    Signs::Minus => 0x1f60_8000,
                };
                opcode | b << 16 | c << 10 | a << 5 | out
            }
        };
        self.words.push(word);
    }
}
