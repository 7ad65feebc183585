//! What a sweep over the bodies of a chain asks for, body by body: where lowering looks for work that repeats.

use std::collections::HashSet;

use super::graph::Graph;
use super::op::ExprId;

/// The visits of all sweeps of a function, in order.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    /// Bodies visited, sweep by sweep.
    pub visits: Vec<Visit>,
}

impl Tape {
    /// The sweeps of another tape after these.
    #[must_use]
    pub fn then(mut self, other: Tape) -> Tape {
        let first = self.visits.last().map_or(0, |visit| visit.sweep + 1);
        self.visits.extend(other.visits.into_iter().map(|visit| Visit { sweep: first + visit.sweep, ..visit }));
        self
    }
}

/// A sweep at a body.
#[derive(Clone, Debug)]
pub struct Visit {
    /// Number of the sweep.
    pub sweep: usize,
    /// Name of the body.
    pub body: String,
    /// Whether the sweep goes from base to tip.
    pub outward: bool,
    /// What the sweep asked for at this body for the first time in this function, in the order in which it did.
    pub nodes: Vec<ExprId>,
}

/// A tape while it is written.
#[derive(Debug, Default)]
pub(super) struct Recorder {
    tape: Tape,
    seen: HashSet<ExprId>,
    sweeps: usize,
    at_a_body: bool,
}

impl Recorder {
    /// An expression was asked for.
    pub fn ask(&mut self, id: ExprId) {
        if self.at_a_body
            && self.seen.insert(id)
            && let Some(visit) = self.tape.visits.last_mut()
        {
            visit.nodes.push(id);
        }
    }
}

/// A sweep under way; it ends when it is dropped.
#[derive(Debug)]
pub struct Sweep<'g> {
    graph: &'g Graph,
}

impl Graph {
    /// Begins a sweep over bodies, on the way to the first.
    pub fn sweep(&self) -> Sweep<'_> {
        self.recorder.borrow_mut().sweeps += 1;
        let sweep = Sweep { graph: self };
        sweep.visit("");
        sweep
    }

    /// What `derive` derives, and the sweeps it makes.
    pub fn recorded<T>(&self, derive: impl FnOnce() -> T) -> (T, Tape) {
        *self.recorder.borrow_mut() = Recorder::default();
        let derived = derive();
        (derived, std::mem::take(&mut *self.recorder.borrow_mut()).tape)
    }
}

impl Sweep<'_> {
    /// The sweep comes to a body, and to the joints between it and the one before.
    pub fn visit(&self, body: &str) {
        let mut recorder = self.graph.recorder.borrow_mut();
        let sweep = recorder.sweeps;
        recorder.at_a_body = true;
        recorder.tape.visits.push(Visit { sweep, body: body.to_owned(), outward: false, nodes: vec![] });
    }

    /// The sweep has come to a body by its joints, and goes on from it.
    pub fn leave(&self, body: &str) {
        if let Some(visit) = self.graph.recorder.borrow_mut().tape.visits.last_mut() {
            body.clone_into(&mut visit.body);
            visit.outward = true;
        }
        self.visit("");
    }
}

impl Drop for Sweep<'_> {
    fn drop(&mut self) {
        self.graph.recorder.borrow_mut().at_a_body = false;
    }
}
