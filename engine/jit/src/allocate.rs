//! Registers for nodes. A line has no branches, so the next use of every node is known: when a register is needed, the node whose
//! next use is furthest gives its own up (L. A. Belady, *A study of replacement algorithms for a virtual-storage computer*, IBM
//! Systems Journal 5, 1966). A node that is in the frame already gives up first: that costs no store.

use crate::instruction::{Instruction, Location, Operand, Register};
use crate::operations::{Action, Kind, Node, Operation, Operations, index};
use crate::places::{Pause, Places};
use crate::roll::{Loop, roll};

/// What matters of a processor here.
#[derive(Clone, Copy, Debug)]
pub struct Processor {
    /// The number of registers.
    pub registers: usize,
    /// Whether one operand may be in memory, and a fused result takes the register of an operand.
    pub operands_in_memory: bool,
}

/// The code between two pauses.
#[derive(Debug, Default)]
pub struct CodePart {
    /// Its instructions.
    pub instructions: Vec<Instruction>,
    /// What follows it.
    pub pause: Option<Pause>,
}

/// Used no more.
const NEVER: u32 = u32::MAX;
/// A node that is needed again within as many operations is loaded, instead of being read from the frame each time.
const SOON: u32 = 40;

/// A line in registers and places.
#[derive(Debug)]
pub struct Allocated {
    /// Its parts.
    pub parts: Vec<CodePart>,
    /// Places of numbers in the frame besides the given values.
    pub numbers: Vec<(usize, f64)>,
}

/// Registers and places for a line.
pub fn allocate(mut operations: Operations, processor: Processor) -> Allocated {
    let (mut places, pauses) = Places::assign(&operations);
    let loops = roll(&mut operations, &mut places);
    places.open(operations.nodes);
    let operations = &operations;
    let mut allocation = Allocation {
        moving: None,
        processor,
        places,
        next: vec![NEVER; operations.nodes],
        register: vec![None; operations.nodes],
        stored: vec![true; operations.nodes],
        held: vec![None; processor.registers],
        ended: vec![],
        instructions: vec![],
    };
    // Everything else is in the frame before it is used.
    for action in &operations.actions {
        if let Action::Operation(Operation { out, .. }) = action {
            allocation.stored[*out as usize] = false;
        }
    }
    let uses = allocation.uses(operations.actions.iter().map(Action::reads));
    let mut pauses = pauses.into_iter();
    let mut parts = Vec::new();
    for (at, (action, after)) in operations.actions.iter().zip(&uses).enumerate() {
        let at = index(at);
        match action {
            Action::Operation(operation) => allocation.compute(at, *operation, after, false),
            Action::Store(place, node) => {
                let register = allocation.bring(at, *node, 0);
                allocation.instructions.push(Instruction::Result(register, fixed(*place)));
                allocation.used(*node, after.first().copied());
            }
            Action::Pause(arguments, ..) => {
                let pause = pauses.next();
                for (offset, (node, after)) in arguments.iter().zip(after).enumerate() {
                    let register = allocation.bring(at, *node, 0);
                    let place = pause.map_or(0, |pause| pause.arguments + offset);
                    allocation.instructions.push(Instruction::Store(register, fixed(index(place))));
                    allocation.used(*node, Some(*after));
                }
                allocation.empty();
                parts.push(CodePart { instructions: std::mem::take(&mut allocation.instructions), pause });
            }
            Action::Loop(of, reads) => {
                allocation.repeat(at, &loops[*of], reads);
                for (node, after) in reads.iter().zip(after) {
                    allocation.used(*node, Some(*after));
                }
            }
        }
        allocation.release();
    }
    parts.push(CodePart { instructions: allocation.instructions, pause: None });
    let place = |node: Node| allocation.places.get(node).unwrap_or_default() as usize;
    let numbers = operations.numbers.iter().map(|(node, number)| (place(*node), *number));
    let numbers = numbers.chain(loops.iter().flat_map(|own| own.numbers.iter().copied())).collect();
    Allocated { parts, numbers }
}

/// A place that does not move. One that is too far away is as far as possible, where `memory` refuses it.
fn fixed(at: u32) -> Location {
    Location { at: i32::try_from(at).unwrap_or(i32::MAX), step: 0 }
}

/// Registers during a line.
struct Allocation<'a> {
    /// Within a loop: the loop, and the nodes from outside, which its next iteration needs again.
    moving: Option<(&'a Loop, &'a [Node])>,
    processor: Processor,
    places: Places,
    /// The next action that uses each node.
    next: Vec<u32>,
    /// The register of each node that is in one.
    register: Vec<Option<Register>>,
    /// Whether the frame holds it.
    stored: Vec<bool>,
    /// The node of each register.
    held: Vec<Option<Node>>,
    /// Nodes that are used no more, whose places are given again after the present action.
    ended: Vec<Node>,
    instructions: Vec<Instruction>,
}

impl<'a> Allocation<'a> {
    /// For every operand of a line, the next place that uses the same node; `next` is then the first use of each node.
    fn uses<'r>(&mut self, reads: impl DoubleEndedIterator<Item = &'r [Node]> + ExactSizeIterator) -> Vec<Vec<u32>> {
        let mut uses = Vec::with_capacity(reads.len());
        for (at, reads) in reads.enumerate().rev() {
            let mut after = vec![NEVER; reads.len()];
            for (place, node) in reads.iter().enumerate().rev() {
                after[place] = std::mem::replace(&mut self.next[*node as usize], index(at));
            }
            uses.push(after);
        }
        uses.reverse();
        uses
    }

    /// A loop. Registers are empty before each iteration.
    fn repeat(&mut self, at: u32, own: &'a Loop, reads: &'a [Node]) {
        for (node, place) in &own.copies {
            let register = self.bring(at, *node, 0);
            self.instructions.push(Instruction::Store(register, fixed(*place)));
        }
        self.empty();
        self.instructions.push(Instruction::Begin(own.iterations));
        self.moving = Some((own, reads));
        for node in reads {
            self.next[*node as usize] = NEVER;
        }
        let uses = self.uses(own.operations.iter().map(Operation::operands));
        for (place, (operation, after)) in own.operations.iter().zip(&uses).enumerate() {
            self.stored[operation.out as usize] = false;
            self.compute(index(place), *operation, after, own.saved[place]);
            self.release();
        }
        self.moving = None;
        self.instructions.push(Instruction::End);
        for node in self.held.iter_mut().filter_map(Option::take) {
            self.register[node as usize] = None;
        }
        own.operations.iter().for_each(|operation| self.stored[operation.out as usize] = true);
    }

    /// The node was used; `next`: when it is used again.
    fn used(&mut self, node: Node, next: Option<u32>) {
        let next = next.unwrap_or(NEVER);
        self.next[node as usize] = next;
        if next == NEVER {
            if let Some(register) = self.register[node as usize].take() {
                self.held[usize::from(register)] = None;
            }
            if self.moving.is_none_or(|(_, outside)| outside.binary_search(&node).is_err()) {
                self.ended.push(node);
            }
        }
    }

    /// The places of nodes that were used for the last time are free.
    fn release(&mut self) {
        for node in std::mem::take(&mut self.ended) {
            self.places.release(node);
        }
    }

    /// A node in a register; `kept`: registers that keep their nodes, as bits.
    fn bring(&mut self, at: u32, node: Node, kept: u32) -> Register {
        if let Some(register) = self.register[node as usize] {
            return register;
        }
        let register = self.free(at, kept);
        let place = self.place(node);
        self.instructions.push(Instruction::Load(register, place));
        self.hold(register, node);
        register
    }

    fn place(&mut self, node: Node) -> Location {
        let moving = self.moving.and_then(|(own, _)| own.moving.get(&node));
        moving.copied().unwrap_or_else(|| fixed(self.places.give(node)))
    }

    fn hold(&mut self, register: Register, node: Node) {
        self.held[usize::from(register)] = Some(node);
        self.register[node as usize] = Some(register);
    }

    /// A free register, the lowest: their instructions are shorter.
    fn free(&mut self, at: u32, kept: u32) -> Register {
        let registers = 0..self.processor.registers;
        let is_kept = |register: &usize| kept >> register & 1 == 1;
        let free = registers.clone().find(|register| self.held[*register].is_none() && !is_kept(register));
        let register = free.unwrap_or_else(|| {
            let victim =
                registers.filter(|register| !is_kept(register)).max_by_key(|register| self.distance(at, *register));
            let victim = victim.unwrap_or_default();
            self.give_up(victim);
            victim
        });
        u8::try_from(register).unwrap_or_default()
    }

    /// How far the next use of a register's node is, twice as far if it needs no store.
    fn distance(&self, at: u32, register: usize) -> u32 {
        self.held[register].map_or(NEVER, |node| {
            let distance = self.next[node as usize].saturating_sub(at);
            if self.stored[node as usize] { distance.saturating_mul(2) } else { distance }
        })
    }

    /// The node of a register is only in the frame from here on.
    fn give_up(&mut self, register: usize) {
        if let Some(node) = self.held[register].take() {
            self.register[node as usize] = None;
            if !std::mem::replace(&mut self.stored[node as usize], true) {
                let place = self.place(node);
                self.instructions.push(Instruction::Store(u8::try_from(register).unwrap_or_default(), place));
            }
        }
    }

    /// All nodes are only in the frame.
    fn empty(&mut self) {
        (0..self.processor.registers).for_each(|register| self.give_up(register));
    }

    /// Whether a node that is in the frame should be in a register.
    fn is_worth_a_register(&self, at: u32, next: u32) -> bool {
        let distance = next.saturating_sub(at);
        let furthest = (0..self.processor.registers).map(|register| self.distance(at, register)).max();
        next != NEVER && distance < SOON && furthest.is_some_and(|furthest| furthest > 2 * distance)
    }

    /// An operation; `saved`: its result is stored at once.
    fn compute(&mut self, at: u32, operation: Operation, after: &[u32], saved: bool) {
        let Operation { kind, out, .. } = operation;
        let reads = operation.operands();
        let kept = |allocation: &Self| {
            let registers = reads.iter().filter_map(|node| allocation.register[*node as usize]);
            registers.fold(0u32, |kept, register| kept | 1 << register)
        };
        let in_place = self.read_in_place(at, operation, after);
        let mut operands = [Operand::Register(0); 3];
        for (place, node) in reads.iter().enumerate() {
            operands[place] = if in_place == Some(place) {
                Operand::Memory(self.place(*node))
            } else {
                let kept = kept(self);
                Operand::Register(self.bring(at, *node, kept))
            };
        }
        let in_use = kept(self);
        let is_separate = matches!(kind, Kind::Minimum | Kind::Maximum | Kind::Choice);
        for (node, next) in reads.iter().zip(after) {
            self.used(*node, Some(*next));
        }
        let is_fused = matches!(kind, Kind::Fused(_)) && self.processor.operands_in_memory;
        let register = if is_fused {
            self.overwritten(at, in_use, &mut operands)
        } else {
            let kept = if is_separate { in_use } else { kept(self) };
            self.free(at, kept)
        };
        self.hold(register, out);
        let spare = if is_separate { self.free(at, in_use | 1 << register) } else { 0 };
        self.instructions.push(Instruction::Compute { kind, out: register, operands, spare });
        if saved {
            let place = self.place(out);
            self.instructions.push(Instruction::Store(register, place));
            self.stored[out as usize] = true;
        }
        if self.next[out as usize] == NEVER {
            self.used(out, None);
        }
    }

    /// The operand that is read from the frame, if one is: it is not in a register and not needed soon.
    fn read_in_place(&self, at: u32, operation: Operation, after: &[u32]) -> Option<usize> {
        let reads = operation.operands();
        let may_be = |place: usize| match operation.kind {
            Kind::Sum | Kind::Product | Kind::Fused(_) | Kind::Root => true,
            Kind::Difference | Kind::Quotient => place == 1,
            Kind::Minimum | Kind::Maximum | Kind::Choice => false,
        };
        let is_alone = |place: usize| reads.iter().filter(|node| **node == reads[place]).count() == 1;
        let places = (0..reads.len()).filter(|place| {
            self.register[reads[*place] as usize].is_none()
                && may_be(*place)
                && is_alone(*place)
                && !self.is_worth_a_register(at, after[*place])
        });
        places.max_by_key(|place| after[*place]).filter(|_| self.processor.operands_in_memory)
    }

    /// The register that a fused result takes over from an operand, which is copied or loaded if it is needed later.
    fn overwritten(&mut self, at: u32, in_use: u32, operands: &mut [Operand; 3]) -> Register {
        let dying = operands.iter().find_map(|operand| match operand {
            Operand::Register(register) if self.held[usize::from(*register)].is_none() => Some(*register),
            _ => None,
        });
        if let Some(register) = dying {
            return register;
        }
        let register = self.free(at, in_use);
        let memory = operands.iter().position(|operand| matches!(operand, Operand::Memory(_)));
        let taken = memory.unwrap_or(2);
        self.instructions.push(match operands[taken] {
            Operand::Memory(place) => Instruction::Load(register, place),
            Operand::Register(from) => Instruction::Move(register, from),
        });
        operands[taken] = Operand::Register(register);
        register
    }
}
