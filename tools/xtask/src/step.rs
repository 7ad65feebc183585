//! One step of a task: a command, or a check in Rust.

use std::fmt::{self, Write as _};
use std::fs;
use std::io::{self, Read};
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::workspace;

/// Before the title of a single step, which runs without headings: how steps beside each other are started.
pub const ONLY: &str = "--only";

/// A named step.
#[derive(Clone)]
pub struct Step {
    /// What it is, for the reader of the output.
    pub title: &'static str,
    /// The jobs that need it; none of other tasks than `test`.
    pub jobs: &'static [&'static str],
    action: Action,
    /// Whether it may run beside its neighbours: it leaves cores idle, and needs nothing that they make.
    is_light: bool,
}

#[derive(Clone)]
enum Action {
    Cargo { arguments: Vec<String>, environment: Vec<(&'static str, &'static str)> },
    Program { name: &'static str, arguments: Vec<String> },
    Check(fn() -> Result<(), String>),
}

impl Step {
    /// Runs cargo at the workspace's root.
    pub fn cargo(title: &'static str, arguments: &[&str]) -> Self {
        let arguments = arguments.iter().map(ToString::to_string).collect();
        Step { title, jobs: &[], action: Action::Cargo { arguments, environment: vec![] }, is_light: false }
    }

    /// Runs a function.
    pub fn check(title: &'static str, check: fn() -> Result<(), String>) -> Self {
        Step { title, jobs: &[], action: Action::Check(check), is_light: false }
    }

    /// Runs a program of the workspace that is already built, at the workspace's root.
    pub fn program(title: &'static str, name: &'static str, arguments: &[&str]) -> Self {
        let arguments = arguments.iter().map(ToString::to_string).collect();
        Step { title, jobs: &[], action: Action::Program { name, arguments }, is_light: false }
    }

    /// The same as part of jobs.
    pub fn of_jobs(self, jobs: &'static [&'static str]) -> Self {
        Self { jobs, ..self }
    }

    /// The same beside its neighbours.
    pub fn light(self) -> Self {
        Self { is_light: true, ..self }
    }

    /// The same with an environment variable.
    pub fn with(mut self, name: &'static str, value: &'static str) -> Self {
        if let Action::Cargo { environment, .. } = &mut self.action {
            environment.push((name, value));
        }
        self
    }

    /// Runs it to its end.
    pub fn run(&self) -> Result<(), String> {
        match &self.action {
            Action::Check(check) => check(),
            Action::Program { name, arguments } => {
                let program = workspace::target().join("release").join(name);
                run_to_end(Command::new(program).args(arguments).current_dir(workspace::root()))
            }
            Action::Cargo { arguments, environment } => {
                let mut command = Command::new(cargo());
                command.args(arguments).envs(environment.iter().copied()).current_dir(workspace::root());
                run_to_end(&mut command)
            }
        }
    }
}

/// Runs all steps of a task in order, and says at the end which failed and how long each took.
pub fn run_steps(task: &str, steps: &[Step]) -> ExitCode {
    let start = Instant::now();
    let summary = Mutex::new(Summary { of: steps.len(), ..Summary::default() });
    for neighbours in steps.chunk_by(|one, other| one.is_light && other.is_light) {
        match neighbours {
            [step] => {
                summary.lock().expect("no step panics").begin(step);
                let (begun, before) = (Instant::now(), processor_time(OWN));
                let outcome = step.run();
                let cost = Cost { elapsed: begun.elapsed(), processor: processor_time(OWN) - before };
                summary.lock().expect("no step panics").end(step, cost, outcome);
            }
            _ => run_beside(task, neighbours, &summary),
        }
    }
    let Summary { text, failed, of, .. } = summary.into_inner().expect("no step panics");
    let cost = Cost { elapsed: start.elapsed(), processor: processor_time(OWN) };
    println!("\n    wall    processor\n{text}\n{failed} of {of} steps failed, {cost}");
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs steps as processes of their own, as many at a time as there are cores; what each prints follows when it is done.
fn run_beside(task: &str, steps: &[Step], summary: &Mutex<Summary>) {
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(step) = steps.get(next.fetch_add(1, Ordering::Relaxed)) {
            println!("... {}", step.title);
            let begun = Instant::now();
            let (printed, processor, outcome) =
                run_apart(task, step).unwrap_or_else(|error| (String::new(), 0.0, Err(error.to_string())));
            let mut summary = summary.lock().expect("no step panics");
            summary.begin(step);
            print!("{printed}");
            summary.end(step, Cost { elapsed: begun.elapsed(), processor }, outcome);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
}

/// Runs a step in a process of its own; returns what it printed and the processor's time that it took.
fn run_apart(task: &str, step: &Step) -> io::Result<(String, f64, Result<(), String>)> {
    let (mut reader, writer) = io::pipe()?;
    let mut command = Command::new(std::env::current_exe()?);
    command.args([task, ONLY, step.title]).stdout(writer.try_clone()?).stderr(writer);
    let mut child = command.spawn()?;
    // The ends of the pipe that this process has: the reader would wait for them.
    drop(command);
    let mut printed = Vec::new();
    reader.read_to_end(&mut printed)?;
    // It has ended; what it took is known until it is waited for.
    let processor = processor_time(&child.id().to_string());
    let status = child.wait()?;
    let outcome = if status.success() { Ok(()) } else { Err("see above".to_owned()) };
    Ok((String::from_utf8_lossy(&printed).into_owned(), processor, outcome))
}

/// This process, in `/proc`.
const OWN: &str = "self";

/// Time of the processor that a process and the ended ones that it started have taken, s; 0 where the system does not tell.
fn processor_time(process: &str) -> f64 {
    /// Units of these times per second, on all processors that Linux runs on.
    const TICKS: f64 = 100.0;
    let text = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // Behind the name, which may contain anything: state, and as the 12th to 15th field the times of the process and of its children.
    let fields = text.rsplit_once(')').map_or("", |(_, fields)| fields).split_whitespace();
    fields.skip(11).take(4).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / TICKS
}

/// What a step took.
#[derive(Clone, Copy)]
struct Cost {
    elapsed: Duration,
    /// Time of the processor, s.
    processor: f64,
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:>6.0} s  {:>6.0} CPU s", self.elapsed.as_secs_f64(), self.processor)
    }
}

/// What is said at the end.
#[derive(Default)]
struct Summary {
    text: String,
    begun: usize,
    failed: usize,
    of: usize,
}

impl Summary {
    fn begin(&mut self, step: &Step) {
        self.begun += 1;
        println!("\n=== {}/{} {}", self.begun, self.of, step.title);
    }

    fn end(&mut self, step: &Step, cost: Cost, outcome: Result<(), String>) {
        match outcome {
            Ok(()) => {
                println!("=== {} done, {:.0} s", step.title, cost.elapsed.as_secs_f64());
                let _ = writeln!(self.text, "{cost}  {}", step.title);
            }
            Err(message) => {
                eprintln!("\n{} failed: {message}", step.title);
                self.failed += 1;
                let _ = writeln!(self.text, "{cost}  {}: FAILED, {message}", step.title);
            }
        }
    }
}

/// The cargo that runs this program.
pub fn cargo() -> String {
    std::env::var("CARGO").unwrap_or_else(|_| "cargo".into())
}

/// Runs a command; anything but success is an error.
pub fn run_to_end(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("{}: {error}", command.get_program().display()))?;
    if status.success() { Ok(()) } else { Err(format!("{} ended with {status}", command.get_program().display())) }
}
