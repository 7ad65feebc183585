//! Instructions of x86-64 with AVX, and FMA where sums are fused (Intel 64 and IA-32 Architectures Software Developer's Manual,
//! volume 2: the VEX prefix in 2.3, each instruction under its name). With AVX-512, eight numbers are one register of 32 (the EVEX prefix, 2.7).
//!
//! A displacement of one byte reaches 256 bytes, 32 numbers. So the frame is seen through up to thirteen windows, each with a
//! register of its own: where nearly all numbers are within the windows, an instruction takes six bytes instead of nine, and the
//! code of 25 coordinates fits into the first-level cache.

use std::collections::{BTreeSet, HashMap};

use super::loops;
use crate::instruction::{Instruction, Location, Operand, Register};
use crate::line::Lanes;
use crate::operations::{Kind, Signs};

/// A general register.
type General = u8;

/// First argument: the frame.
const FRAME: General = 7;
/// Second argument: the results.
const RESULTS: General = 6;
/// Registers for windows: those that a call may change, then those that it must keep. Without rsp and r12, which cost a byte.
const WINDOWS: [General; 11] = [0, 1, 2, 8, 9, 10, 11, 3, 5, 13, 14];
/// Registers of [`WINDOWS`] before those that must be kept.
const CHANGEABLE: usize = 7;
/// The mask register of comparisons.
const MASK: u8 = 1;
/// Counts iterations; it must be kept.
const COUNTER: General = 15;
/// Numbers in a window.
const WINDOW: i32 = 32;
/// A window is worth its instruction if as many accesses use it.
const LEAST_ACCESSES: usize = 4;

/// What an instruction's memory operand, or its last register, is.
#[derive(Clone, Copy)]
enum Last {
    Register(Register),
    /// A base and a displacement in bytes.
    Memory(General, i32),
}

/// Opcode maps.
#[derive(Clone, Copy, PartialEq)]
enum Map {
    Of0F = 1,
    Of0F38 = 2,
    Of0F3A = 3,
}

/// The code of instructions: a function of the frame and the results, `extern "sysv64"`.
pub fn encode(instructions: &[Instruction], lanes: Lanes) -> Vec<u8> {
    let mut encoder =
        Encoder { bytes: vec![], lanes, windows: HashMap::new(), moving: HashMap::new(), kept: vec![], begin: 0 };
    let loops = loops(instructions);
    let most = loops.iter().map(BTreeSet::len).max().unwrap_or_default();
    let (windows, moving) = WINDOWS.split_at(WINDOWS.len() - most);
    encoder.open_windows(instructions, windows, moving);
    let mut loops = loops.into_iter();
    for instruction in instructions {
        match instruction {
            Instruction::Begin(iterations) => {
                let steps = loops.next().unwrap_or_default();
                encoder.begin(*iterations, steps.into_iter().zip(moving.iter().copied()).collect());
            }
            Instruction::End => encoder.end(),
            _ => encoder.write(instruction),
        }
    }
    encoder.close();
    encoder.bytes
}

struct Encoder {
    bytes: Vec<u8>,
    lanes: Lanes,
    /// Within a loop: the register for each step by which places move.
    moving: HashMap<i32, General>,
    /// Where the present loop begins.
    begin: usize,
    /// The register of each window that is open, by its number.
    windows: HashMap<i32, General>,
    /// Registers to be given back with their values.
    kept: Vec<General>,
}

impl Encoder {
    /// Bytes from place to place.
    fn stride(&self) -> i32 {
        match self.lanes {
            Lanes::One => 8,
            Lanes::Four | Lanes::Eight => 64,
        }
    }

    /// Keeps the registers that a call must keep, and points others at the windows that are used most.
    fn open_windows(&mut self, instructions: &[Instruction], registers: &[General], moving: &[General]) {
        let mut accesses: HashMap<i32, usize> = HashMap::new();
        for location in instructions.iter().flat_map(Instruction::places).filter(|location| location.step == 0) {
            *accesses.entry(location.at / WINDOW).or_default() += 1;
        }
        // With eight numbers, a window would hold four places.
        let is_worth_it = |(_, count): &(i32, usize)| *count >= LEAST_ACCESSES && self.lanes == Lanes::One;
        let mut accesses: Vec<(i32, usize)> = accesses.into_iter().filter(is_worth_it).collect();
        accesses.sort_by_key(|(window, count)| (std::cmp::Reverse(*count), *window));
        let windows: Vec<(General, i32)> =
            registers.iter().copied().zip(accesses.into_iter().map(|(window, _)| window)).collect();
        let used = windows.iter().map(|(register, _)| *register).chain(moving.iter().copied());
        let counter = (!moving.is_empty()).then_some(COUNTER);
        for register in used.chain(counter).filter(|register| !WINDOWS[..CHANGEABLE].contains(register)) {
            self.keep(register);
        }
        for (register, window) in windows {
            self.windows.insert(window, register);
            self.point(register, self.middle(window));
        }
    }

    /// Registers for what moves, and the number of iterations.
    fn begin(&mut self, iterations: u32, moving: HashMap<i32, General>) {
        let mut registers: Vec<General> = moving.values().copied().collect();
        registers.sort_unstable();
        for register in registers {
            self.point(register, 0);
        }
        self.moving = moving;
        // mov r15d, iterations
        self.bytes.extend([0x41, 0xb8 | COUNTER & 7]);
        self.bytes.extend(iterations.to_le_bytes());
        self.begin = self.bytes.len();
    }

    /// Moves on, and repeats unless it was the last iteration.
    fn end(&mut self) {
        let mut moving: Vec<(i32, General)> = std::mem::take(&mut self.moving).into_iter().collect();
        moving.sort_unstable();
        for (step, register) in moving {
            // lea register, [register + step]
            self.lea(register, register, step * self.stride());
        }
        // dec r15; jnz begin
        self.bytes.extend([0x49, 0xff, 0xc8 | COUNTER & 7, 0x0f, 0x85]);
        let length = i32::try_from(self.bytes.len() + 4 - self.begin).unwrap_or(i32::MAX);
        self.bytes.extend((-length).to_le_bytes());
    }

    /// Displacement of the middle of a window, bytes.
    fn middle(&self, window: i32) -> i32 {
        (window * WINDOW + WINDOW / 2) * self.stride()
    }

    /// `push register`
    fn keep(&mut self, register: General) {
        self.kept.push(register);
        if register >= 8 {
            self.bytes.push(0x41);
        }
        self.bytes.push(0x50 | register & 7);
    }

    /// `lea register, [frame + displacement]`
    fn point(&mut self, register: General, displacement: i32) {
        self.lea(register, FRAME, displacement);
    }

    fn lea(&mut self, register: General, base: General, displacement: i32) {
        self.bytes.extend([0x48 | (register >> 3) << 2 | base >> 3, 0x8d]);
        self.address(register, base, displacement);
    }

    /// Gives registers back, and returns.
    fn close(&mut self) {
        if self.lanes != Lanes::One {
            // vzeroupper
            self.bytes.extend([0xc5, 0xf8, 0x77]);
        }
        for register in std::mem::take(&mut self.kept).into_iter().rev() {
            if register >= 8 {
                self.bytes.push(0x41);
            }
            self.bytes.push(0x58 | register & 7);
        }
        self.bytes.push(0xc3);
    }

    /// The operand of a place in the frame.
    fn memory(&self, location: Location) -> Last {
        let window = location.at / WINDOW;
        if let Some(register) = self.moving.get(&location.step) {
            return Last::Memory(*register, location.at * self.stride());
        }
        match self.windows.get(&window) {
            Some(register) => Last::Memory(*register, location.at * self.stride() - self.middle(window)),
            None => Last::Memory(FRAME, location.at * self.stride()),
        }
    }

    fn operand(&self, operand: Operand) -> Last {
        match operand {
            Operand::Register(register) => Last::Register(register),
            Operand::Memory(location) => self.memory(location),
        }
    }

    fn write(&mut self, instruction: &Instruction) {
        match *instruction {
            Instruction::Load(to, from) => self.arithmetic(0x10, to, None, self.memory(from)),
            Instruction::Store(from, to) => self.arithmetic(0x11, from, None, self.memory(to)),
            Instruction::Result(from, to) => {
                self.arithmetic(0x11, from, None, Last::Memory(RESULTS, to.at * self.stride()));
            }
            // vmovaps, vmovapd
            Instruction::Move(to, from) if self.lanes == Lanes::Eight => {
                self.evex(Map::Of0F, 0x28, [to, 0], Last::Register(from), 0);
            }
            Instruction::Move(to, from) => self.vex(Map::Of0F, [0, 0], 0x28, [to, 0], Last::Register(from)),
            Instruction::Compute { kind, out, operands, spare } => self.compute(kind, out, operands, spare),
            Instruction::Begin(_) | Instruction::End => {}
        }
    }

    /// An instruction of map 0F on one number, on four or on eight: `out = a ∘ last`.
    fn arithmetic(&mut self, opcode: u8, out: Register, a: Option<Register>, last: Last) {
        let prefix = match self.lanes {
            Lanes::One => 3,
            Lanes::Four => 1,
            Lanes::Eight => return self.evex(Map::Of0F, opcode, [out, a.unwrap_or_default()], last, 0),
        };
        self.vex(Map::Of0F, [prefix, 0], opcode, [out, a.unwrap_or_default()], last);
    }

    fn compute(&mut self, kind: Kind, out: Register, operands: [Operand; 3], spare: Register) {
        let register = |operand: Operand| match operand {
            Operand::Register(register) => Some(register),
            Operand::Memory(_) => None,
        };
        let [a, b, c] = operands;
        match kind {
            // Both commute: the operand in memory is the last.
            Kind::Sum | Kind::Product => {
                let (first, last) = match (register(a), register(b)) {
                    // Of two registers, a low one last saves a byte.
                    (Some(x), Some(y)) if y >= 8 && x < 8 => (y, Last::Register(x)),
                    (Some(x), _) => (x, self.operand(b)),
                    (None, y) => (y.unwrap_or_default(), self.operand(a)),
                };
                self.arithmetic(if kind == Kind::Sum { 0x58 } else { 0x59 }, out, Some(first), last);
            }
            Kind::Difference => self.arithmetic(0x5c, out, register(a), self.operand(b)),
            Kind::Quotient => self.arithmetic(0x5e, out, register(a), self.operand(b)),
            Kind::Root => {
                // On one number, the upper half of the result is that of the first operand.
                let first = match self.lanes {
                    Lanes::One => register(a).or(Some(out)),
                    Lanes::Four | Lanes::Eight => None,
                };
                self.arithmetic(0x51, out, first, self.operand(a));
            }
            Kind::Fused(signs) => self.fused(signs, out, operands),
            Kind::Minimum | Kind::Maximum => {
                if let (Some(a), Some(b)) = (register(a), register(b)) {
                    self.extremum(if kind == Kind::Minimum { 0x5d } else { 0x5f }, out, [a, b], spare);
                }
            }
            Kind::Choice => {
                if let (Some(b), Some(c), Lanes::Eight) = (register(b), register(c), self.lanes) {
                    // vpxorq, then 0 < a without a signal for NaN, then vblendmpd
                    self.evex(Map::Of0F, 0xef, [out, out], Last::Register(out), 0);
                    self.evex(Map::Of0F, 0xc2, [MASK, out], self.operand(a), 0);
                    self.bytes.push(0x11);
                    self.evex(Map::Of0F38, 0x65, [out, c], Last::Register(b), MASK);
                } else if let (Some(b), Some(c)) = (register(b), register(c)) {
                    // vxorps, then 0 < a without a signal for NaN, then vblendvpd
                    self.vex(Map::Of0F, [0, 0], 0x57, [out, out], Last::Register(out));
                    self.arithmetic(0xc2, out, Some(out), self.operand(a));
                    self.bytes.push(0x11);
                    self.vex(Map::Of0F3A, [1, 0], 0x4b, [out, c], Last::Register(b));
                    self.bytes.push(out << 4);
                }
            }
        }
    }

    /// As `f64::min`: NaN gives way to a number. The instruction returns its last operand if one is NaN or both are zero; one
    /// number and eight differ in which of two zeros they return.
    fn extremum(&mut self, opcode: u8, out: Register, [a, b]: [Register; 2], spare: Register) {
        let [a, b] = match self.lanes {
            Lanes::One => [b, a],
            Lanes::Four | Lanes::Eight => [a, b],
        };
        self.arithmetic(opcode, spare, Some(a), Last::Register(b));
        if self.lanes == Lanes::Eight {
            // b is NaN, then vblendmpd
            self.evex(Map::Of0F, 0xc2, [MASK, b], Last::Register(b), 0);
            self.bytes.push(3);
            self.evex(Map::Of0F38, 0x65, [out, spare], Last::Register(a), MASK);
            return;
        }
        // b is NaN.
        self.arithmetic(0xc2, out, Some(b), Last::Register(b));
        self.bytes.push(3);
        self.vex(Map::Of0F3A, [1, 0], 0x4b, [out, spare], Last::Register(a));
        self.bytes.push(out << 4);
    }

    /// One of three forms, by the operand whose register the result takes: `out = out·last ± b`, `b·out ± last`, `b·last ± out`.
    fn fused(&mut self, signs: Signs, out: Register, [a, b, c]: [Operand; 3]) {
        let is_out = |operand: Operand| operand == Operand::Register(out);
        let (form, first, last) = match (a, b, c) {
            (a, b, c) if is_out(c) => match (a, b) {
                (Operand::Register(a), b) => (0xb8, a, b),
                (a, Operand::Register(b)) => (0xb8, b, a),
                _ => unreachable!("one operand at most is in memory"),
            },
            (a, b, c) => {
                let other = if is_out(a) { b } else { a };
                match (other, c) {
                    (Operand::Register(other), last) => (0xa8, other, last),
                    (last, Operand::Register(c)) => (0x98, c, last),
                    _ => unreachable!("one operand at most is in memory"),
                }
            }
        };
        let signs = match signs {
            Signs::Plus => 0,
            Signs::Minus => 2,
            Signs::Reverse => 4,
        };
        if self.lanes == Lanes::Eight {
            self.evex(Map::Of0F38, form + signs, [out, first], self.operand(last), 0);
            return;
        }
        let scalar = u8::from(self.lanes == Lanes::One);
        self.vex(Map::Of0F38, [1, 1], form + signs + scalar, [out, first], self.operand(last));
    }

    /// A VEX prefix, an opcode and operands; `prefix`: the implied prefix (none, 66, F3, F2), and the bit W.
    fn vex(&mut self, map: Map, [prefix, wide]: [u8; 2], opcode: u8, [out, first]: [Register; 2], last: Last) {
        let long = u8::from(self.lanes == Lanes::Four);
        let high = |register: u8| register >> 3 & 1;
        let number = match last {
            Last::Register(number) | Last::Memory(number, _) => number,
        };
        let rest = (first ^ 15) << 3 | long << 2 | prefix;
        if map == Map::Of0F && wide == 0 && high(number) == 0 {
            self.bytes.extend([0xc5, (high(out) ^ 1) << 7 | rest]);
        } else {
            let [r, b] = [out, number].map(|register| high(register) ^ 1);
            self.bytes.extend([0xc4, r << 7 | 1 << 6 | b << 5 | map as u8, wide << 7 | rest]);
        }
        self.bytes.push(opcode);
        match last {
            Last::Register(number) => self.bytes.push(0xc0 | (out & 7) << 3 | number & 7),
            Last::Memory(base, displacement) => self.address(out, base, displacement),
        }
    }

    /// An EVEX prefix, an opcode and operands, of eight numbers of 64 bits; `mask`: the register that chooses among them, or 0. A displacement of one
    /// byte counts in operands.
    fn evex(&mut self, map: Map, opcode: u8, [out, first]: [Register; 2], last: Last, mask: u8) {
        let bit = |register: u8, bit: u8| register >> bit & 1 ^ 1;
        let [x, b] = match last {
            Last::Register(number) => [bit(number, 4), bit(number, 3)],
            Last::Memory(base, _) => [1, bit(base, 3)],
        };
        let registers = bit(out, 3) << 7 | x << 6 | b << 5 | bit(out, 4) << 4;
        self.bytes.extend([0x62, registers | map as u8, 1 << 7 | (first & 15 ^ 15) << 3 | 1 << 2 | 1]);
        self.bytes.extend([2 << 5 | bit(first, 4) << 3 | mask, opcode]);
        match last {
            Last::Register(number) => self.bytes.push(0xc0 | (out & 7) << 3 | number & 7),
            Last::Memory(base, displacement) => match i8::try_from(displacement / 64) {
                Ok(short) if displacement % 64 == 0 => {
                    self.bytes.extend([0x40 | (out & 7) << 3 | base & 7, short.cast_unsigned()]);
                }
                _ => {
                    self.bytes.push(0x80 | (out & 7) << 3 | base & 7);
                    self.bytes.extend(displacement.to_le_bytes());
                }
            },
        }
    }

    /// The bytes of an operand in memory, `ModRM` and displacement. rsp and r12 are never bases.
    fn address(&mut self, register: u8, base: General, displacement: i32) {
        let low = (register & 7) << 3 | base & 7;
        if let Ok(short) = i8::try_from(displacement) {
            self.bytes.extend([0x40 | low, short.cast_unsigned()]);
        } else {
            self.bytes.push(0x80 | low);
            self.bytes.extend(displacement.to_le_bytes());
        }
    }
}
