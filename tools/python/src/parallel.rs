//! Rows on threads, while Python's signals are looked at.
//!
//! Threads live as long as a call: nothing is left for a fork to lose.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// How many threads a call takes; 0: as many as the machine has.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets how many threads a call takes; None: as many as the machine has.
#[pyfunction]
#[pyo3(signature = (count=None))]
pub fn set_threads(count: Option<usize>) -> PyResult<()> {
    if count == Some(0) {
        return Err(PyValueError::new_err("set_threads(0): write a number of 1 or more, or None for all cores"));
    }
    THREADS.store(count.unwrap_or(0), Ordering::Relaxed);
    Ok(())
}

/// How many threads a call takes.
#[pyfunction]
pub fn threads() -> usize {
    match THREADS.load(Ordering::Relaxed) {
        0 => thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get),
        count => count,
    }
}

/// Whether a call has been called off by a signal, such as that of Ctrl-C; and how far it is.
pub struct Watch {
    off: AtomicBool,
    looked: Mutex<(Instant, Option<PyErr>)>,
    /// Rows that are done, and all of them.
    done: AtomicUsize,
    all: usize,
    /// Called with both.
    report: Option<Py<PyAny>>,
}

/// Time between looks at signals.
const BETWEEN: Duration = Duration::from_millis(50);

impl Watch {
    /// A call that begins.
    pub fn new() -> Self {
        Self::reporting(None, 0)
    }

    /// A call over rows that begins, and a Python function that receives the numbers of finished and of all rows.
    pub fn reporting(report: Option<Py<PyAny>>, all: usize) -> Self {
        let looked = Mutex::new((Instant::now(), None));
        Self { off: AtomicBool::new(false), looked, done: AtomicUsize::new(0), all, report }
    }

    /// One more row is done.
    pub fn count(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Whether the call is off, without looking.
    pub fn is_off(&self) -> bool {
        self.off.load(Ordering::Relaxed)
    }

    /// Whether the call is off, after a look at the signals where the last one is long ago. For the thread that was called.
    pub fn look(&self) -> bool {
        let mut looked = self.looked.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.is_off() && looked.0.elapsed() > BETWEEN {
            looked.0 = Instant::now();
            if let Err(signal) = Python::attach(|py| self.report(py).and_then(|()| py.check_signals())) {
                looked.1 = Some(signal);
                self.off.store(true, Ordering::Relaxed);
            }
        }
        self.is_off()
    }

    fn report(&self, py: Python<'_>) -> PyResult<()> {
        match &self.report {
            Some(report) => report.call1(py, (self.done.load(Ordering::Relaxed), self.all)).map(|_| ()),
            None => Ok(()),
        }
    }

    /// The exception that called it off: that of a signal, or of the function that receives the progress.
    pub fn finish(self, py: Python<'_>) -> PyResult<()> {
        let signal = self.looked.lock().unwrap_or_else(PoisonError::into_inner).1.take();
        match signal {
            Some(signal) => Err(signal),
            None => self.report(py),
        }
    }
}

/// Does `work` on pieces of up to `piece` rows of `out`, `width` numbers each, on as many threads as that is worth. Each thread has
/// room of its own from `make`.
pub fn for_rows<R>(
    py: Python<'_>,
    (piece, width): (usize, usize),
    out: &mut [f64],
    make: impl Fn() -> R + Sync,
    work: impl Fn(&mut R, Range<usize>, &mut [f64]) + Sync,
) -> PyResult<()> {
    let count = out.len().div_ceil((piece * width).max(1));
    let watch = Watch::new();
    py.detach(|| {
        let waiting = Mutex::new(out.chunks_mut((piece * width).max(1)).enumerate());
        let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
        let run = |off: &dyn Fn() -> bool| {
            let mut room = None;
            while let Some((index, out)) = next() {
                if off() {
                    break;
                }
                let rows = index * piece..index * piece + out.len() / width.max(1);
                work(room.get_or_insert_with(&make), rows, out);
            }
        };
        thread::scope(|scope| {
            for _ in 1..threads().min(count) {
                scope.spawn(|| run(&|| watch.is_off()));
            }
            run(&|| watch.look());
        });
    });
    watch.finish(py)
}

/// Does `work` on every row on all threads; the results in order. A thread takes the next row when it is done with one. Work that
/// takes long asks now and then whether it is called off.
pub fn map_rows<T: Send>(
    py: Python<'_>,
    rows: usize,
    work: impl Fn(usize, &dyn Fn() -> bool) -> T + Sync,
) -> PyResult<Vec<T>> {
    let watch = Watch::new();
    let finished = Mutex::new(Vec::with_capacity(rows));
    py.detach(|| {
        let next = AtomicUsize::new(0);
        let run = |off: &dyn Fn() -> bool| {
            loop {
                let row = next.fetch_add(1, Ordering::Relaxed);
                if row >= rows || off() {
                    break;
                }
                let result = work(row, off);
                finished.lock().unwrap_or_else(PoisonError::into_inner).push((row, result));
            }
        };
        thread::scope(|scope| {
            for _ in 1..threads().min(rows) {
                scope.spawn(|| run(&|| watch.is_off()));
            }
            run(&|| watch.look());
        });
    });
    watch.finish(py)?;
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|(row, _)| *row);
    Ok(finished.into_iter().map(|(_, result)| result).collect())
}
