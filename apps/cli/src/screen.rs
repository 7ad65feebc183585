//! What the command says besides its results: warnings, problems and progress, in words and colours or as JSON.

use std::{
    env,
    ffi::OsString,
    io::{self, IsTerminal, Write},
    path::PathBuf,
    sync::{
        Mutex, OnceLock, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use clap::{Args, ValueEnum};
use crane_codegen::{Diagnostics, chain::Chain};
use crane_page::tables::{Report, diagnostics};
use indicatif::ProgressBar;
use serde_json::json;

use crate::problem::{FAILED, NOTICED, Problem};

/// Something that a script may not accept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Severity {
    /// Something implausible in the spec.
    Warning,
    /// A result that is unsafe, or valid only in part.
    Caution,
}

/// What the command says besides its results.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Messages")]
pub struct Manner {
    /// Only results and errors: no warnings, no progress
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// End with code 3 if there are warnings about the spec or cautions about results, for scripts
    #[arg(long, global = true, value_enum, value_delimiter = ',', value_name = "SEVERITY")]
    pub fail_on: Vec<Severity>,
    /// Leave out of results how long they took, so that the same command gives the same bytes again
    #[arg(long, global = true)]
    pub reproducible: bool,
}

/// What a command was asked for, where its messages go, and what it has noticed and read. Each command has its own, also where one process runs
/// several.
pub struct Console {
    /// The words of the command, its name first.
    pub(super) words: Vec<OsString>,
    /// As the arguments ask for, once they are read.
    manner: OnceLock<Manner>,
    messages: Mutex<Box<dyn Write + Send>>,
    /// Whether results and messages are coloured.
    colours: [bool; 2],
    /// The crane that was read last, and its number of coordinates.
    crane: Mutex<Option<(String, usize)>>,
    /// Whether the crane has had a warning, and results a caution.
    warned: AtomicBool,
    cautioned: AtomicBool,
    /// Files that this command has read: it does not write to them.
    pub(super) inputs: Mutex<Vec<PathBuf>>,
}

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const CYAN: &str = "\x1b[1;36m";
const PLAIN: &str = "\x1b[0m";

/// Whether to colour what goes to a stream: <https://no-color.org>, <https://bixense.com/clicolors>.
fn has_colours(terminal: bool) -> bool {
    let is_set = |name| env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0");
    if is_set("NO_COLOR") {
        return false;
    }
    is_set("CLICOLOR_FORCE") || (terminal && env::var_os("TERM").is_none_or(|terminal| terminal != "dumb"))
}

/// Of a command without words, whose messages go to standard error.
impl Default for Console {
    fn default() -> Self {
        Self::new(Vec::new(), io::stderr(), [false, io::stderr().is_terminal()])
    }
}

impl Console {
    /// Of a command in words, its name first; `terminals`: whether results and messages go to terminals.
    pub fn new(words: Vec<OsString>, messages: impl Write + Send + 'static, terminals: [bool; 2]) -> Self {
        Self {
            words,
            manner: OnceLock::new(),
            messages: Mutex::new(Box::new(messages)),
            colours: terminals.map(has_colours),
            crane: Mutex::default(),
            warned: AtomicBool::new(false),
            cautioned: AtomicBool::new(false),
            inputs: Mutex::default(),
        }
    }

    /// Of the command that this process runs.
    pub fn of_process() -> Self {
        Self::new(env::args_os().collect(), io::stderr(), [io::stdout().is_terminal(), io::stderr().is_terminal()])
    }

    /// Sets the manner, once.
    pub(super) fn choose(&self, manner: &Manner) {
        let _ = self.manner.set(manner.clone());
    }

    /// Whether only results and errors are wanted.
    pub(super) fn is_quiet(&self) -> bool {
        self.manner.get().is_some_and(|manner| manner.quiet)
    }

    /// How long it took since then, s, if results may say so.
    pub(super) fn seconds_since(&self, begin: Instant) -> Option<f64> {
        (!self.is_reproducible()).then(|| begin.elapsed().as_secs_f64())
    }

    /// Whether results may not depend on how long they took.
    pub(super) fn is_reproducible(&self) -> bool {
        self.manner.get().is_some_and(|manner| manner.reproducible)
    }

    /// Whether the words ask for JSON, wherever they do: also those that cannot be read.
    pub(super) fn is_json(&self) -> bool {
        let arguments = self.words.get(1..).unwrap_or_default();
        let joined = arguments.iter().any(|argument| argument == "--format=json");
        joined || arguments.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json")
    }

    /// Writes a message; if no one can read it, the words are lost.
    pub(super) fn tell(&self, words: &str) {
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = writeln!(messages, "{}", words.trim_end());
    }

    fn drawn(&self, found: &Diagnostics) -> String {
        if self.colours[1] { found.coloured() } else { found.to_string() }
    }

    /// Notes the crane that work begins on.
    pub(super) fn begin(&self, chain: &Chain) {
        let of = (chain.name.clone(), chain.coordinates.len());
        *self.crane.lock().unwrap_or_else(PoisonError::into_inner) = Some(of);
    }

    /// The crane that was read last, in words.
    pub(super) fn crane_at_work(&self) -> Option<String> {
        let crane = self.crane.lock().unwrap_or_else(PoisonError::into_inner).clone();
        crane.map(|(name, count)| format!("{name}, with {count} coordinates,"))
    }

    /// Shows warnings about a spec.
    pub(super) fn warn(&self, found: &Diagnostics) {
        self.warned.store(true, Ordering::Relaxed);
        if self.is_quiet() {
        } else if self.is_json() {
            self.tell(&json!({"warnings": diagnostics(found)}).to_string());
        } else {
            self.tell(&self.drawn(found));
        }
    }

    /// Shows a remark that is not part of the results.
    pub(super) fn remark(&self, words: &str) {
        if !self.is_quiet() && !self.is_json() {
            self.tell(words);
        }
    }

    /// Shows a problem; returns the exit code.
    pub(super) fn report(&self, problem: &Problem) -> u8 {
        let (title, help, code) = match problem {
            Problem::OutputClosed => return 0,
            Problem::AlreadyReported { exit_code } => return *exit_code,
            Problem::Mistakes(mistakes) => (mistakes.headline(), "", FAILED),
            Problem::Message { title, help, code } => (title.clone(), help.as_str(), *code),
        };
        if self.is_json() {
            let found = if let Problem::Mistakes(found) = problem { diagnostics(found) } else { json!([]) };
            self.tell(
                &json!({"error": {"message": title, "help": help, "code": code, "diagnostics": found}}).to_string(),
            );
            return code;
        }
        if let Problem::Mistakes(found) = problem {
            self.tell(&self.drawn(found));
            return code;
        }
        let [red, cyan, plain] = if self.colours[1] { [RED, CYAN, PLAIN] } else { [""; 3] };
        let help = if help.is_empty() { String::new() } else { format!("\n  {cyan}help{plain}: {help}") };
        self.tell(&format!("{red}error{plain}: {title}{help}"));
        code
    }

    /// Prints a report for people: cautions in colours on a terminal.
    ///
    /// # Errors
    /// The output is closed.
    pub(super) fn print(&self, report: &Report, out: &mut dyn Write) -> io::Result<()> {
        if !self.colours[0] {
            return report.print(out);
        }
        let mut text = Vec::new();
        report.print(&mut text)?;
        for line in text.split_inclusive(|byte| *byte == b'\n') {
            match line.strip_prefix(b"caution:") {
                Some(words) => {
                    write!(out, "{YELLOW}caution{PLAIN}:")?;
                    out.write_all(words)?;
                }
                None => out.write_all(line)?,
            }
        }
        Ok(())
    }

    /// Notes whether results come with cautions.
    pub(super) fn note(&self, report: &Report) {
        if report.has_cautions() {
            self.cautioned.store(true, Ordering::Relaxed);
        }
    }

    /// A problem if something was noticed that the arguments do not accept.
    pub(super) fn unaccepted(&self) -> Option<Problem> {
        let noticed = |severity: &Severity| match severity {
            Severity::Warning => self.warned.load(Ordering::Relaxed),
            Severity::Caution => self.cautioned.load(Ordering::Relaxed),
        };
        self.manner.get()?.fail_on.iter().any(noticed).then_some(Problem::AlreadyReported { exit_code: NOTICED })
    }

    /// Does what may take long for a large crane, and says so.
    pub(super) fn working<T>(&self, chain: &Chain, work: impl FnOnce() -> T) -> T {
        /// From here on it takes more than some seconds.
        const LARGE: usize = 300;
        let count = chain.coordinates.len();
        if count < LARGE {
            return work();
        }
        self.remark(&format!("{} has {count} coordinates: this may take minutes; Ctrl-C ends it", chain.name));
        let bar = ProgressBar::new_spinner().with_message("deriving");
        bar.enable_steady_tick(Duration::from_millis(200));
        let done = work();
        bar.finish_and_clear();
        done
    }
}
