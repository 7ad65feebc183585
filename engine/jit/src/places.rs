//! Places of nodes in the frame: given values first, then what pauses read and make, then room for values that registers do not
//! hold, given again after the last use of a value.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::operations::{Action, Node, Operations, index};

/// Places of nodes.
#[derive(Debug)]
pub struct Places {
    /// The place of every node that has one.
    of: Vec<Option<u32>>,
    /// Places that are free again.
    free: BinaryHeap<Reverse<u32>>,
    /// Places that are given again.
    reusable_from: u32,
    count: u32,
}

/// What the caller computes between two parts of the code: `arguments` and `makes` are first places and numbers of places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pause {
    /// Place of the first argument.
    pub arguments: usize,
    /// The number of arguments.
    pub reads: usize,
    /// Place of the first value made.
    pub values: usize,
    /// The number of values made.
    pub makes: usize,
}

impl Places {
    /// Places for the given values and all pauses of operations.
    pub fn assign(operations: &Operations) -> (Self, Vec<Pause>) {
        let given = operations.given.len();
        let mut places =
            Places { of: vec![None; operations.nodes], free: BinaryHeap::new(), reusable_from: 0, count: index(given) };
        for (at, place) in places.of.iter_mut().take(given).enumerate() {
            *place = Some(index(at));
        }
        for (node, _) in &operations.numbers {
            places.give_for_good(*node);
        }
        let mut pauses = Vec::new();
        for action in &operations.actions {
            if let Action::Pause(arguments, first, makes) = action {
                let values = places.count as usize + arguments.len();
                pauses.push(Pause { arguments: places.count as usize, reads: arguments.len(), values, makes: *makes });
                places.count += index(arguments.len());
                (*first..).take(*makes).for_each(|node| places.give_for_good(node));
            }
        }
        (places, pauses)
    }

    /// Places next to each other that are not given again; returns the first.
    pub fn reserve(&mut self, count: usize) -> u32 {
        self.count += index(count);
        self.count - index(count)
    }

    /// The place of a node, one that was reserved.
    pub fn set(&mut self, node: Node, index: u32) {
        self.of[node as usize] = Some(index);
    }

    /// From here on places are given and released; there are as many nodes.
    pub fn open(&mut self, nodes: usize) {
        self.of.resize(nodes, None);
        self.reusable_from = self.count;
    }

    /// The place of a node, if it has one.
    pub fn get(&self, node: Node) -> Option<u32> {
        self.of[node as usize]
    }

    /// A place of its own.
    fn give_for_good(&mut self, node: Node) {
        self.of[node as usize] = Some(self.reserve(1));
    }

    /// The place of a node, now if it has none.
    pub fn give(&mut self, node: Node) -> u32 {
        if let Some(index) = self.of[node as usize] {
            return index;
        }
        let index = match self.free.pop() {
            Some(Reverse(index)) => index,
            None => self.reserve(1),
        };
        self.of[node as usize] = Some(index);
        index
    }

    /// The node is not used again.
    pub fn release(&mut self, node: Node) {
        if let Some(index) = self.of[node as usize].filter(|index| *index >= self.reusable_from) {
            self.of[node as usize] = None;
            self.free.push(Reverse(index));
        }
    }
}
