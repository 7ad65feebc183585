//! Registers by linear scan: a value takes the register that was released last, which is still in the first-level cache.

use super::line::{AssembledLine, Step, Value};
use crate::bytecode::{Code, Instructions, Kind, Segment, Store, WideInstruction};

/// The bytecode of a line.
pub fn assign(line: &AssembledLine) -> Code {
    let last_reads = last_reads(line);
    let mut registers = Registers { of: vec![0; line.values], free: vec![], count: line.fixed.len() };
    for value in 0..line.fixed.len() {
        registers.of[value] = value;
    }
    let inputs: usize = line.inputs.iter().map(|inputs| inputs.count).sum();
    for value in line.fixed.len()..line.fixed.len() + inputs {
        registers.give(value);
    }
    let mut code = Code {
        fixed: line.fixed.clone(),
        inputs: line.inputs.clone(),
        instructions: Instructions::default(),
        stores: vec![],
        segments: vec![],
        registers: 0,
        results: line.results,
    };
    let mut instructions: Vec<WideInstruction> = vec![];
    for (index, step) in line.steps.iter().enumerate() {
        let is_last = |value: &Value| *value >= line.fixed.len() && last_reads[*value] == Some(index);
        let mut ending: Vec<Value> = step.reads().filter(is_last).collect();
        ending.sort_unstable();
        ending.dedup();
        let read = |value: Value| registers.of[value];
        let reads = match *step {
            Step::Operation { operands, .. } => operands.map(read),
            Step::Angle { angle: value, .. } | Step::Stumpff { argument: value, .. } | Step::Store { value, .. } => {
                [read(value); 3]
            }
        };
        // All results of an angle or an argument are written before the next angle is read, and some may be unused.
        registers.free.extend(ending.iter().map(|value| registers.of[*value]));
        for value in step.makes() {
            registers.give(value);
        }
        for value in step.makes().filter(|value| last_reads[*value].is_none()) {
            registers.free.push(registers.of[value]);
        }
        // Steps are fewer than this: each takes some bytes of memory.
        let own = |register: usize| u32::try_from(register).unwrap_or(u32::MAX);
        let [a, b, c] = reads.map(own);
        let kind = match *step {
            Step::Operation { kind, out, .. } => {
                instructions.push(WideInstruction([own(registers.of[out]), a, b, c]));
                kind
            }
            Step::Angle { sin, cos, .. } => {
                let [out, b] = [sin, cos].map(|value| own(registers.of[value]));
                instructions.push(WideInstruction([out, a, b, c]));
                Kind::Angle
            }
            Step::Stumpff { values, .. } => {
                let [c0, c1, c2, c3, c4, c5] = values.map(|value| own(registers.of[value]));
                instructions.extend([WideInstruction([c0, a, c1, c2]), WideInstruction([c3, a, c4, c5])]);
                Kind::Stumpff
            }
            Step::Store { place: index, .. } => {
                code.stores.push(Store { place: u32::try_from(index).unwrap_or(u32::MAX), register: a });
                Kind::Store
            }
        };
        match code.segments.last_mut() {
            Some(segment) if segment.kind == kind => segment.length += kind.instructions(),
            _ => code.segments.push(Segment { kind, length: kind.instructions() }),
        }
    }
    code.registers = registers.count;
    let narrow: Option<Vec<_>> = instructions.iter().map(|instruction| instruction.narrow()).collect();
    code.instructions = narrow.map_or(Instructions::Wide(instructions), Instructions::Narrow);
    code
}

/// For every value, the last step that reads it.
fn last_reads(line: &AssembledLine) -> Vec<Option<usize>> {
    let mut last = vec![None; line.values];
    for (index, step) in line.steps.iter().enumerate() {
        for value in step.reads() {
            last[value] = Some(index);
        }
    }
    last
}

/// The state of the allocation.
struct Registers {
    /// The register of every value that has one.
    of: Vec<usize>,
    /// Free registers, the one released last at the end.
    free: Vec<usize>,
    /// Their number.
    count: usize,
}

impl Registers {
    fn give(&mut self, value: Value) {
        self.of[value] = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
    }
}
