//! Rows on threads, while Python's signals are checked.
//!
//! Threads end with the call: none is left that a fork could lose.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::types::Progress;

/// How many threads a call uses; 0: as many as the machine has.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// How many the machine has. Asked once: the system takes longer to answer than a small crane to step.
static CORES: LazyLock<usize> =
    LazyLock::new(|| thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get));

/// Sets how many threads a call uses; None: as many as the machine has.
#[pyfunction]
#[pyo3(signature = (count=None))]
pub fn set_threads(count: Option<i64>) -> PyResult<()> {
    let threads = match count {
        None => 0,
        Some(count) => usize::try_from(count).ok().filter(|count| *count > 0).ok_or_else(|| {
            PyValueError::new_err(format!("set_threads({count}): write a number of 1 or more, or None for all cores"))
        })?,
    };
    THREADS.store(threads, Ordering::Relaxed);
    Ok(())
}

/// How many threads a call uses.
#[pyfunction]
pub fn threads() -> usize {
    match THREADS.load(Ordering::Relaxed) {
        0 => *CORES,
        count => count,
    }
}

/// Whether a call has been cancelled by a signal, such as that of Ctrl-C, and how many of its rows are finished.
pub struct Watch {
    off: AtomicBool,
    looked: Mutex<(Instant, Option<PyErr>)>,
    /// Number of finished rows, and of all rows.
    done: AtomicUsize,
    all: usize,
    /// Called with both numbers.
    report: Option<Progress>,
}

/// Time between checks for signals.
const BETWEEN: Duration = Duration::from_millis(50);

impl Watch {
    /// Watches a new call.
    pub fn new() -> Self {
        Self::reporting(None, 0)
    }

    /// Watches a new call over rows, with a Python function that receives the numbers of finished and of all rows.
    pub fn reporting(report: Option<Progress>, all: usize) -> Self {
        let looked = Mutex::new((Instant::now(), None));
        Self { off: AtomicBool::new(false), looked, done: AtomicUsize::new(0), all, report }
    }

    /// Counts one more finished row.
    pub fn count(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Whether the call has been cancelled, without a check for signals.
    pub fn is_off(&self) -> bool {
        self.off.load(Ordering::Relaxed)
    }

    /// Whether the call has been cancelled, after a check for signals if it is time for one. For the thread that called.
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

    /// Returns the exception that cancelled the call, if any: that of a signal, or of the function that receives the progress.
    pub fn finish(self, py: Python<'_>) -> PyResult<()> {
        let signal = self.looked.lock().unwrap_or_else(PoisonError::into_inner).1.take();
        match signal {
            Some(signal) => Err(signal),
            None => self.report(py),
        }
    }
}

/// Does `work` on pieces of up to `piece` rows of `out`, `width` numbers each, on no more threads than pieces. Each thread has its
/// own workspace from `make`.
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
            let mut workspace = None;
            while let Some((index, out)) = next() {
                if off() {
                    break;
                }
                let rows = index * piece..index * piece + out.len() / width.max(1);
                work(workspace.get_or_insert_with(&make), rows, out);
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

/// Does `work` on every row on all threads; the results are in order. A thread takes the next row when it has finished one. Work that
/// takes long should check now and then whether it has been cancelled.
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
