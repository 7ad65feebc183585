//! Repeats become loops. What an iteration leaves for others is in a record of the frame, one record per iteration; so an operand
//! that differs from iteration to iteration is at a place that moves evenly, in another loop's records, among given values, or, if
//! it is not, among copies made before the loop.

use std::collections::HashMap;

use crate::instruction::Location;
use crate::operations::{Action, Node, Operation, Operations, index};
use crate::places::Places;
use crate::repeats::{Repeat, Source, repeats};

/// Records before the first iteration and after the last: for values that were there before the loop, and for those that a loop
/// over other iterations computes outside of it.
const SPARE: usize = 2;
/// Different steps by which places of one loop move, at most.
pub const MOST_STEPS: usize = 6;

/// A loop over the operations of its first iteration.
#[derive(Debug, Default)]
pub struct Loop {
    /// The number of iterations.
    pub iterations: u32,
    /// The operations of an iteration.
    pub operations: Vec<Operation>,
    /// Whether others need what each of them makes.
    pub saved: Vec<bool>,
    /// Places of nodes that move from iteration to iteration.
    pub moving: HashMap<Node, Location>,
    /// Nodes copied to further places before the loop.
    pub copies: Vec<(Node, u32)>,
    /// Numbers in the frame.
    pub numbers: Vec<(usize, f64)>,
}

impl Loop {
    /// Whether a processor has a register for places that move by this step: two are kept for records and for copies.
    fn has_room_for(&self, step: i32) -> bool {
        let mut steps: Vec<i32> = self.moving.values().map(|place| place.step).collect();
        steps.sort_unstable();
        steps.dedup();
        steps.contains(&step) || steps.len() + 2 < MOST_STEPS
    }
}

/// Turns what repeats into loops, whose number is their index.
pub fn roll(operations: &mut Operations, places: &mut Places) -> Vec<Loop> {
    let mut made = vec![None; operations.nodes];
    for (at, action) in operations.actions.iter().enumerate() {
        if let Action::Operation(Operation { out, .. }) = action {
            made[*out as usize] = Some(at);
        }
    }
    let repeats = repeats(&operations.actions, &made);
    if repeats.is_empty() {
        return vec![];
    }
    let mut rolling = Rolling { operations, places, made, repeats, records: vec![], claimed: HashMap::new() };
    rolling.lay_out();
    let loops = rolling.loops();
    rolling.replace(&loops);
    loops
}

/// The records of a loop.
struct Records {
    /// The place of the record before the first iteration.
    before: u32,
    /// Places per record.
    size: usize,
    /// The place in a record of what each operation makes, if others need it.
    cells: Vec<Option<usize>>,
}

struct Rolling<'a> {
    operations: &'a mut Operations,
    places: &'a mut Places,
    made: Vec<Option<usize>>,
    repeats: Vec<Repeat>,
    records: Vec<Records>,
    /// Spare places of records that are in use.
    claimed: HashMap<u32, Node>,
}

impl Rolling<'_> {
    /// The loop and the iteration that make a node, and the number of the operation.
    fn origin(&self, node: Node) -> Option<[usize; 3]> {
        let at = self.made[node as usize]?;
        let of = self.repeats.partition_point(|repeat| repeat.start <= at).checked_sub(1)?;
        let Repeat { start, period, iterations, .. } = &self.repeats[of];
        let offset = at - start;
        (offset < period * iterations).then(|| [of, offset / period, offset % period])
    }

    /// Records for what is needed outside of its iteration.
    fn lay_out(&mut self) {
        let mut needed: Vec<Vec<bool>> = self.repeats.iter().map(|repeat| vec![false; repeat.period]).collect();
        let mut of = 0;
        for (at, action) in self.operations.actions.iter().enumerate() {
            while self.repeats.get(of).is_some_and(|repeat| at >= repeat.start + repeat.period * repeat.iterations) {
                of += 1;
            }
            let here = self.repeats.get(of).filter(|repeat| at >= repeat.start);
            let here = here.map(|repeat| [of, (at - repeat.start) / repeat.period]);
            for node in action.reads() {
                if let Some([of, k, place]) = self.origin(*node)
                    && here != Some([of, k])
                {
                    needed[of][place] = true;
                }
            }
        }
        for (of, needed) in needed.iter().enumerate() {
            let Repeat { start, period, iterations, .. } = self.repeats[of];
            let mut size = 0;
            let cell = |needed: &bool| {
                size += usize::from(*needed);
                needed.then(|| size - 1)
            };
            let cells: Vec<Option<usize>> = needed.iter().map(cell).collect();
            let first = self.places.reserve(size * (iterations + 2 * SPARE));
            let records = Records { before: first + index(size * (SPARE - 1)), size, cells };
            for k in 0..iterations {
                for at in 0..period {
                    if let (Some(cell), Action::Operation(operation)) =
                        (records.cells[at], &self.operations.actions[start + k * period + at])
                    {
                        self.places.set(operation.out, records.before + index((k + 1) * size + cell));
                    }
                }
            }
            self.records.push(records);
        }
    }

    fn loops(&mut self) -> Vec<Loop> {
        let mut loops: Vec<Loop> = (0..self.repeats.len()).map(|_| Loop::default()).collect();
        // What the first iteration takes over, before others claim the places.
        let mut nodes: Vec<HashMap<Vec<Node>, Node>> = vec![HashMap::new(); self.repeats.len()];
        for carried in [true, false] {
            for of in 0..self.repeats.len() {
                let sources: Vec<Source> = self.repeats[of].sources.iter().flatten().cloned().collect();
                for source in sources {
                    let (key, place) = match source {
                        Source::Carried(initial, at) if carried => {
                            let key = self.key(of, initial, at);
                            (!nodes[of].contains_key(&key)).then(|| (key, self.carry(of, initial, at, &mut loops[of])))
                        }
                        Source::Stream(stream) if !carried => (!nodes[of].contains_key(&stream)).then(|| {
                            let place = self.follow(&stream, &mut loops[of]);
                            (stream, place)
                        }),
                        _ => None,
                    }
                    .unzip();
                    if let (Some(key), Some(place)) = (key, place) {
                        let node = index(self.operations.nodes);
                        self.operations.nodes += 1;
                        nodes[of].insert(key, node);
                        loops[of].moving.insert(node, place);
                    }
                }
            }
        }
        for (of, nodes) in nodes.iter().enumerate() {
            self.write(of, nodes, &mut loops[of]);
        }
        loops
    }

    /// The node before the loop, and the one that the first iteration makes.
    fn key(&self, of: usize, initial: Node, at: usize) -> Vec<Node> {
        let Action::Operation(operation) = &self.operations.actions[self.repeats[of].start + at] else { return vec![] };
        vec![initial, operation.out]
    }

    /// The place from which an iteration takes a value of the previous one.
    fn carry(&mut self, of: usize, initial: Node, at: usize, own: &mut Loop) -> Location {
        let Records { before, size, cells } = &self.records[of];
        let (first, step) = (before + index(cells[at].unwrap_or_default()), *size);
        self.claimed.insert(first, initial);
        if self.places.get(initial).is_none() && self.origin(initial).is_none() {
            self.places.set(initial, first);
        } else if self.places.get(initial) != Some(first) {
            own.copies.push((initial, first));
        }
        moving(first, step)
    }

    /// The place of nodes, one per iteration: where they are if that moves evenly, otherwise that of copies.
    fn follow(&mut self, stream: &[Node], own: &mut Loop) -> Location {
        let known: Vec<Option<i64>> = stream.iter().map(|node| self.places.get(*node).map(i64::from)).collect();
        let pair = known.windows(2).position(|pair| pair[0].is_some() && pair[1].is_some());
        let even = pair.and_then(|k| {
            let step = known[k + 1]? - known[k]?;
            let first = known[k]? - step * i64::try_from(k).ok()?;
            let wanted = |k: usize| u32::try_from(first + step * i64::try_from(k).ok()?).ok();
            let fits = |k: usize| match known[k] {
                Some(place) => wanted(k).map(i64::from) == Some(place),
                // A node has one place, so one that comes twice does not move evenly.
                None => !stream[..k].contains(&stream[k]) && wanted(k).is_some_and(|place| self.is_spare(place)),
            };
            (0..stream.len()).all(fits).then(|| (wanted(0), i32::try_from(step).ok()))
        });
        let Some((Some(first), Some(step))) = even.filter(|(_, step)| step.is_some_and(|step| own.has_room_for(step)))
        else {
            return self.gather(stream, own);
        };
        for (k, node) in stream.iter().enumerate().filter(|(k, _)| known[*k].is_none()) {
            let place = i64::from(first) + i64::from(step) * i64::try_from(k).unwrap_or_default();
            let place = u32::try_from(place).unwrap_or_default();
            self.claimed.insert(place, *node);
            self.places.set(*node, place);
        }
        Location { at: first.cast_signed(), step }
    }

    /// Whether a place is in a spare record and not in use.
    fn is_spare(&self, place: u32) -> bool {
        let within = |(records, repeat): (&Records, &Repeat)| {
            let from = |record: usize| records.before + index(record * records.size);
            let first = from(0) - index((SPARE - 1) * records.size);
            let end = from(repeat.iterations + 1 + SPARE);
            (first..end).contains(&place) && !(from(1)..from(repeat.iterations + 1)).contains(&place)
        };
        !self.claimed.contains_key(&place) && self.records.iter().zip(&self.repeats).any(within)
    }

    /// Copies of nodes next to each other.
    fn gather(&mut self, nodes: &[Node], own: &mut Loop) -> Location {
        let first = self.places.reserve(nodes.len());
        for (place, node) in (first..).zip(nodes) {
            if let Some(number) = self.operations.given.get(*node as usize).copied().flatten() {
                own.numbers.push((place as usize, number));
            } else if self.places.get(*node).is_none() {
                self.places.set(*node, place);
            } else {
                own.copies.push((*node, place));
            }
        }
        moving(first, 1)
    }

    /// The operations of an iteration, on nodes of the first and on those that move.
    fn write(&self, of: usize, nodes: &HashMap<Vec<Node>, Node>, own: &mut Loop) {
        let Repeat { start, period, iterations, sources } = &self.repeats[of];
        own.iterations = index(*iterations);
        for at in 0..*period {
            let Action::Operation(mut operation) = self.operations.actions[start + at] else { continue };
            for (place, source) in sources[at].iter().enumerate() {
                let moved = match source {
                    Source::Inner(_) | Source::Invariant(_) => None,
                    Source::Carried(initial, at) => nodes.get(&self.key(of, *initial, *at)),
                    Source::Stream(stream) => nodes.get(stream),
                };
                if let Some(moved) = moved {
                    operation.replace(place, *moved);
                }
            }
            let Records { before, size, cells } = &self.records[of];
            if let Some(cell) = cells[at] {
                own.moving.insert(operation.out, moving(before + index(size + cell), *size));
            }
            own.saved.push(cells[at].is_some());
            own.operations.push(operation);
        }
    }

    /// Loops instead of what they repeat.
    fn replace(&mut self, loops: &[Loop]) {
        let mut actions = std::mem::take(&mut self.operations.actions).into_iter();
        let mut at = 0;
        for (of, repeat) in self.repeats.iter().enumerate() {
            self.operations.actions.extend(actions.by_ref().take(repeat.start - at));
            let length = repeat.period * repeat.iterations;
            actions.by_ref().take(length).for_each(drop);
            at = repeat.start + length;
            let mut reads: Vec<Node> = loops[of].copies.iter().map(|(node, _)| *node).collect();
            for source in repeat.sources.iter().flatten() {
                match source {
                    Source::Inner(_) => {}
                    Source::Invariant(node) | Source::Carried(node, _) => reads.push(*node),
                    Source::Stream(nodes) => reads.extend(nodes),
                }
            }
            reads.sort_unstable();
            reads.dedup();
            self.operations.actions.push(Action::Loop(of, reads));
        }
        self.operations.actions.extend(actions);
    }
}

fn moving(first: u32, step: usize) -> Location {
    Location { at: first.cast_signed(), step: index(step).cast_signed() }
}
