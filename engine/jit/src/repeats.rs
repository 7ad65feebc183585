//! Finds operations that repeat: the same kinds on operands that correspond, several times in a row.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use crate::operations::{Action, Node, Operation};

/// Fewer iterations are written out.
const LEAST_ITERATIONS: usize = 4;
/// A loop has to save at least as many operations.
const LEAST_SAVED: usize = 200;
/// The number of operations by which a repeat is recognised.
const WINDOW: usize = 48;
/// An operand made as few operations ago belongs to what is recognised.
const NEAR: usize = 24;
/// A place where no loop begins is passed by as many operations.
const PASSED: usize = 4;

/// Operations that repeat.
#[derive(Debug)]
pub struct Repeat {
    /// The first operation.
    pub start: usize,
    /// Operations per iteration.
    pub period: usize,
    /// The number of iterations.
    pub iterations: usize,
    /// Where the operands of each operation of an iteration come from.
    pub sources: Vec<Vec<Source>>,
}

/// Where an operand comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// An operation of the same iteration, by its number in it.
    Inner(usize),
    /// The same node in every iteration.
    Invariant(Node),
    /// A node from before the loop; then an operation of the iteration before, by its number.
    Carried(Node, usize),
    /// Nodes from before the loop, one per iteration.
    Stream(Vec<Node>),
}

/// The repeats among actions, in order; `made`: the action that makes each node, if one does.
pub fn repeats(actions: &[Action], made: &[Option<usize>]) -> Vec<Repeat> {
    let signatures: Vec<u64> = actions.iter().enumerate().map(|(at, action)| signature(at, action, made)).collect();
    let next = next_alike(&signatures);
    let mut repeats: Vec<Repeat> = Vec::new();
    let mut at = 0;
    while at < next.len() {
        let found = next[at].and_then(|other| {
            let period = other - at;
            let alike = (at..signatures.len() - period).take_while(|at| signatures[*at] == signatures[at + period]);
            let iterations = alike.count() / period + 1;
            (iterations >= LEAST_ITERATIONS).then(|| repeat(actions, made, [at, period, iterations])).flatten()
        });
        match found {
            Some(repeat) => {
                at += repeat.period * repeat.iterations;
                repeats.push(repeat);
            }
            None => at += if next[at].is_some() { PASSED } else { 1 },
        }
    }
    repeats
}

/// What has to be equal for a repeat; operands from farther away are compared later.
fn signature(at: usize, action: &Action, made: &[Option<usize>]) -> u64 {
    let mut hasher = DefaultHasher::new();
    match action {
        Action::Operation(operation) => {
            operation.kind.hash(&mut hasher);
            for node in operation.operands() {
                made[*node as usize].map(|made| at - made).filter(|ago| *ago < NEAR).hash(&mut hasher);
            }
        }
        // Nothing is like it.
        _ => (at, "other").hash(&mut hasher),
    }
    hasher.finish()
}

/// For each place, the next one at which the same signatures follow.
fn next_alike(signatures: &[u64]) -> Vec<Option<usize>> {
    // A window's hash is a polynomial in an odd number, so that of the next window follows from it.
    const BASE: u64 = 0x9e37_79b9_7f4a_7c15;
    let highest = (0..WINDOW).fold(1u64, |power, _| power.wrapping_mul(BASE));
    let mut hash = 0u64;
    let mut hashes = Vec::with_capacity(signatures.len());
    for (at, signature) in signatures.iter().enumerate() {
        let leaving = at.checked_sub(WINDOW).map_or(0, |first| signatures[first]);
        hash = hash.wrapping_mul(BASE).wrapping_add(*signature).wrapping_sub(leaving.wrapping_mul(highest));
        if at + 1 >= WINDOW {
            hashes.push(hash);
        }
    }
    let mut seen: HashMap<u64, usize> = HashMap::new();
    let mut next: Vec<Option<usize>> =
        hashes.iter().enumerate().rev().map(|(at, hash)| seen.insert(*hash, at)).collect();
    next.reverse();
    next
}

/// The iterations from a start on whose operands correspond, if there are enough.
fn repeat(actions: &[Action], made: &[Option<usize>], [start, period, most]: [usize; 3]) -> Option<Repeat> {
    let operation = |k: usize, at: usize| match &actions[start + k * period + at] {
        Action::Operation(operation) => Some(operation),
        _ => None,
    };
    let mut iterations = most;
    let mut sources: Vec<Vec<Source>> = Vec::with_capacity(period);
    for at in 0..period {
        let first: &Operation = operation(0, at)?;
        let mut own = Vec::with_capacity(3);
        for index in 0..first.operands().len() {
            let nodes = (0..iterations).map_while(|k| operation(k, at).map(|operation| operation.operands()[index]));
            let (source, valid) = source(&nodes.collect::<Vec<_>>(), made, [start, period])?;
            if valid < LEAST_ITERATIONS {
                return None;
            }
            iterations = valid;
            own.push(source);
        }
        sources.push(own);
    }
    for nodes in sources.iter_mut().flatten() {
        if let Source::Stream(nodes) = nodes {
            nodes.truncate(iterations);
        }
    }
    // What an iteration takes over from the previous one is at one place: two different ones before the first do not fit there.
    let mut initial: HashMap<usize, Node> = HashMap::new();
    for source in sources.iter().flatten() {
        if let Source::Carried(node, at) = source
            && *initial.entry(*at).or_insert(*node) != *node
        {
            return None;
        }
    }
    ((iterations - 1) * period >= LEAST_SAVED).then_some(Repeat { start, period, iterations, sources })
}

/// The source of an operand, and in how many iterations it is that.
fn source(nodes: &[Node], made: &[Option<usize>], [start, period]: [usize; 2]) -> Option<(Source, usize)> {
    /// Relative to an iteration.
    #[derive(PartialEq)]
    enum From {
        Same(usize),
        Before(usize),
        Outside,
        Earlier,
    }
    let from = |k: usize| {
        let begin = start + k * period;
        match made[nodes[k] as usize] {
            Some(made) if made >= begin => From::Same(made - begin),
            Some(made) if made >= start && made + period >= begin => From::Before(made + period - begin),
            Some(made) if made >= start => From::Earlier,
            _ => From::Outside,
        }
    };
    let valid = |is: &dyn Fn(usize) -> bool| (0..nodes.len()).take_while(|k| is(*k)).count();
    Some(match (from(0), from(1)) {
        (From::Same(at), _) => (Source::Inner(at), valid(&|k| from(k) == From::Same(at))),
        (From::Outside, From::Before(at)) => {
            (Source::Carried(nodes[0], at), valid(&|k| k == 0 || from(k) == From::Before(at)))
        }
        (From::Outside, From::Outside) if nodes[1] == nodes[0] => {
            (Source::Invariant(nodes[0]), valid(&|k| nodes[k] == nodes[0]))
        }
        (From::Outside, From::Outside) => (Source::Stream(nodes.to_vec()), valid(&|k| from(k) == From::Outside)),
        _ => return None,
    })
}
