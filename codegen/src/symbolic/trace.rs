//! The expressions that a sweep over the bodies of a chain requests, body by body: lowering looks for repeated work here.

use rustc_hash::FxHashSet;

use super::graph::Graph;
use super::op::ExprId;

/// The visits of all sweeps of a function, in order.
#[derive(Clone, Debug, Default)]
pub struct SweepTrace {
    /// Bodies visited, sweep by sweep.
    pub visits: Vec<Visit>,
}

impl SweepTrace {
    /// Appends the sweeps of another trace.
    #[must_use]
    pub fn then(mut self, other: SweepTrace) -> SweepTrace {
        let first = self.visits.last().map_or(0, |visit| visit.sweep + 1);
        self.visits.extend(other.visits.into_iter().map(|visit| Visit { sweep: first + visit.sweep, ..visit }));
        self
    }
}

/// One visit of a sweep to a body.
#[derive(Clone, Debug)]
pub struct Visit {
    /// Number of the sweep.
    pub sweep: usize,
    /// Name of the body.
    pub body: String,
    /// Whether the sweep goes from base to tip.
    pub outward: bool,
    /// The expressions that the sweep requested at this body for the first time in this function, in that order.
    pub nodes: Vec<ExprId>,
}

/// A trace while it is recorded.
#[derive(Debug, Default)]
pub(super) struct Recorder {
    trace: SweepTrace,
    seen: FxHashSet<ExprId>,
    sweeps: usize,
    at_a_body: bool,
}

impl Recorder {
    /// Records that an expression was requested.
    pub fn ask(&mut self, id: ExprId) {
        if self.at_a_body
            && self.seen.insert(id)
            && let Some(visit) = self.trace.visits.last_mut()
        {
            visit.nodes.push(id);
        }
    }
}

/// A sweep in progress; it ends when it is dropped.
#[derive(Debug)]
pub struct Sweep<'g> {
    graph: &'g Graph,
}

impl Graph {
    /// Begins a sweep over bodies, before the first.
    pub fn sweep(&self) -> Sweep<'_> {
        self.recorder.borrow_mut().sweeps += 1;
        let sweep = Sweep { graph: self };
        sweep.visit("");
        sweep
    }

    /// The result of `derive`, and its sweeps.
    pub fn recorded<T>(&self, derive: impl FnOnce() -> T) -> (T, SweepTrace) {
        self.taken();
        let derived = derive();
        (derived, self.taken())
    }

    /// The sweeps so far, of which nothing is left.
    fn taken(&self) -> SweepTrace {
        std::mem::take(&mut *self.recorder.borrow_mut()).trace
    }
}

impl Sweep<'_> {
    /// The sweep reaches a body, and the joints between it and the previous one.
    pub fn visit(&self, body: &str) {
        let mut recorder = self.graph.recorder.borrow_mut();
        let sweep = recorder.sweeps;
        recorder.at_a_body = true;
        recorder.trace.visits.push(Visit { sweep, body: body.to_owned(), outward: false, nodes: vec![] });
    }

    /// The sweep has passed the joints of a body and continues from the body.
    pub fn leave(&self, body: &str) {
        if let Some(visit) = self.graph.recorder.borrow_mut().trace.visits.last_mut() {
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
