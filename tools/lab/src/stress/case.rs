//! A case of the suite: what is expected, and a check that says what happened.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};

/// Time limit of a case: one that takes longer counts as an endless loop. The longest takes a few seconds.
const LONGEST: Duration = Duration::from_secs(300);
/// Stack size of a case: matrices of 150 coordinates take 180 kB each on the stack.
const STACK: usize = 64 << 20;

/// What happened: as expected, or otherwise.
pub type Finding = Result<String, String>;

/// A case, with what is expected of it stated in advance.
pub struct Case {
    /// What it belongs to.
    pub group: &'static str,
    /// What is extreme.
    pub name: String,
    /// What must happen.
    pub expected: String,
    /// Whether it is short enough to run in every build.
    pub quick: bool,
    check: Box<dyn FnOnce() -> Finding + Send>,
}

/// A finished case.
pub struct Verdict {
    /// What it belongs to.
    pub group: &'static str,
    /// What was extreme.
    pub name: String,
    /// What had to happen.
    pub expected: String,
    /// What happened.
    pub happened: String,
    /// Whether that is what was expected.
    pub passed: bool,
    /// Time it took.
    pub wall: Duration,
}

impl Case {
    /// A case that runs in every build.
    pub fn new(
        group: &'static str,
        name: impl Into<String>,
        expected: impl Into<String>,
        check: impl FnOnce() -> Finding + Send + 'static,
    ) -> Self {
        Self { group, name: name.into(), expected: expected.into(), quick: true, check: Box::new(check) }
    }

    /// The same, run only if all cases are requested.
    pub fn long(self) -> Self {
        Self { quick: false, ..self }
    }

    /// Runs the check: a panic and an endless loop are findings, too.
    pub fn judge(self) -> Verdict {
        let Self { group, name, expected, check, .. } = self;
        let begin = Instant::now();
        let (send, receive) = mpsc::channel();
        let started = thread::Builder::new().stack_size(STACK).spawn(move || {
            // After the time limit nobody receives the result.
            let _ = send.send(catch_unwind(AssertUnwindSafe(check)));
        });
        let finding = match started {
            Err(error) => Err(format!("not started: {error}")),
            Ok(_) => match receive.recv_timeout(LONGEST) {
                Ok(Ok(finding)) => finding,
                Ok(Err(panic)) => Err(format!("panicked: {}", words(panic.as_ref()))),
                Err(_) => Err(format!("did not end within {} s", LONGEST.as_secs())),
            },
        };
        let passed = finding.is_ok();
        let (Ok(happened) | Err(happened)) = finding;
        Verdict { group, name, expected, happened, passed, wall: begin.elapsed() }
    }
}

/// Message of a panic.
fn words(panic: &(dyn Any + Send)) -> &str {
    panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("without a word")
}

/// As expected if `holds`.
pub fn expect(holds: bool, happened: String) -> Finding {
    if holds { Ok(happened) } else { Err(happened) }
}
