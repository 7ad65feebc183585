//! What the command says besides its results: warnings, problems and progress, in words and colours or as JSON.

use std::{
    env,
    io::{self, IsTerminal, Write},
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

/// As the arguments ask for.
static MANNER: OnceLock<Manner> = OnceLock::new();
/// The crane that was read last, and its number of coordinates.
static CRANE: Mutex<Option<(String, usize)>> = Mutex::new(None);
/// Whether the crane has had a warning, and results a caution.
static WARNED: AtomicBool = AtomicBool::new(false);
static CAUTIONED: AtomicBool = AtomicBool::new(false);

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const CYAN: &str = "\x1b[1;36m";
const PLAIN: &str = "\x1b[0m";

/// Sets the manner, once.
pub fn choose(manner: &Manner) {
    let _ = MANNER.set(manner.clone());
}

/// Whether only results and errors are wanted.
pub fn is_quiet() -> bool {
    MANNER.get().is_some_and(|manner| manner.quiet)
}

/// How long it took since then, s, if results may say so.
pub fn seconds_since(begin: Instant) -> Option<f64> {
    (!is_reproducible()).then(|| begin.elapsed().as_secs_f64())
}

/// Whether results may not depend on how long they took.
pub fn is_reproducible() -> bool {
    MANNER.get().is_some_and(|manner| manner.reproducible)
}

/// Whether the arguments ask for JSON, wherever they do: also those that cannot be read.
pub fn is_json() -> bool {
    let arguments: Vec<_> = env::args_os().skip(1).collect();
    let joined = arguments.iter().any(|argument| argument == "--format=json");
    joined || arguments.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json")
}

/// Whether to colour what goes to a stream: <https://no-color.org>, <https://bixense.com/clicolors>.
fn has_colours(terminal: bool) -> bool {
    let is_set = |name| env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0");
    if is_set("NO_COLOR") {
        return false;
    }
    is_set("CLICOLOR_FORCE") || (terminal && env::var_os("TERM").is_none_or(|terminal| terminal != "dumb"))
}

/// Writes to standard error; if that is closed, the words are lost.
fn tell(words: &str) {
    let _ = writeln!(io::stderr(), "{}", words.trim_end());
}

fn drawn(found: &Diagnostics) -> String {
    if has_colours(io::stderr().is_terminal()) { found.coloured() } else { found.to_string() }
}

/// Notes the crane that work begins on.
pub fn begin(chain: &Chain) {
    let of = (chain.name.clone(), chain.coordinates.len());
    *CRANE.lock().unwrap_or_else(PoisonError::into_inner) = Some(of);
}

/// The crane that was read last, in words.
pub fn crane_at_work() -> Option<String> {
    let crane = CRANE.lock().unwrap_or_else(PoisonError::into_inner).clone();
    crane.map(|(name, count)| format!("{name}, with {count} coordinates,"))
}

/// Shows warnings about a spec.
pub fn warn(found: &Diagnostics) {
    WARNED.store(true, Ordering::Relaxed);
    if is_quiet() {
    } else if is_json() {
        tell(&json!({"warnings": diagnostics(found)}).to_string());
    } else {
        tell(&drawn(found));
    }
}

/// Shows a remark that is not part of the results.
pub fn remark(words: &str) {
    if !is_quiet() && !is_json() {
        tell(words);
    }
}

/// Shows a problem; returns the exit code.
pub fn report(problem: &Problem) -> u8 {
    let (title, help, code) = match problem {
        Problem::OutputClosed => return 0,
        Problem::AlreadyReported { exit_code } => return *exit_code,
        Problem::Mistakes(mistakes) => (mistakes.headline(), "", FAILED),
        Problem::Message { title, help, code } => (title.clone(), help.as_str(), *code),
    };
    if is_json() {
        let found = if let Problem::Mistakes(found) = problem { diagnostics(found) } else { json!([]) };
        tell(&json!({"error": {"message": title, "help": help, "code": code, "diagnostics": found}}).to_string());
        return code;
    }
    if let Problem::Mistakes(found) = problem {
        tell(&drawn(found));
        return code;
    }
    let [red, cyan, plain] = if has_colours(io::stderr().is_terminal()) { [RED, CYAN, PLAIN] } else { [""; 3] };
    let help = if help.is_empty() { String::new() } else { format!("\n  {cyan}help{plain}: {help}") };
    tell(&format!("{red}error{plain}: {title}{help}"));
    code
}

/// Prints a report for people: cautions in colours on a terminal.
///
/// # Errors
/// The output is closed.
pub fn print(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    if !has_colours(io::stdout().is_terminal()) {
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
pub fn note(report: &Report) {
    if report.has_cautions() {
        CAUTIONED.store(true, Ordering::Relaxed);
    }
}

/// A problem if something was noticed that the arguments do not accept.
pub fn unaccepted() -> Option<Problem> {
    let noticed = |severity: &Severity| match severity {
        Severity::Warning => WARNED.load(Ordering::Relaxed),
        Severity::Caution => CAUTIONED.load(Ordering::Relaxed),
    };
    MANNER.get()?.fail_on.iter().any(noticed).then_some(Problem::AlreadyReported { exit_code: NOTICED })
}

/// Does what may take long for a large crane, and says so.
pub fn working<T>(chain: &Chain, work: impl FnOnce() -> T) -> T {
    /// From here on it takes more than some seconds.
    const LARGE: usize = 300;
    let count = chain.coordinates.len();
    if count < LARGE {
        return work();
    }
    remark(&format!("{} has {count} coordinates: this may take minutes; Ctrl-C ends it", chain.name));
    let bar = ProgressBar::new_spinner().with_message("deriving");
    bar.enable_steady_tick(Duration::from_millis(200));
    let done = work();
    bar.finish_and_clear();
    done
}
