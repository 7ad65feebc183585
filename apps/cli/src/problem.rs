//! Failures of the command, and their messages.

use std::{io, path::Path};

use crane_codegen::Diagnostics;
pub use crane_codegen::diagnostic::similar as nearest;
use crane_model::{
    dynamics::{Method, Stopped},
    modes::NoModes,
    runs::{Failed, Reason},
};

/// Exit code where the computation or a file failed.
pub const FAILED: u8 = 1;
/// Exit code where the arguments are wrong.
pub const USAGE: u8 = 2;

/// Exit code where something was noticed that `--fail-on` names.
pub const NOTICED: u8 = 3;

/// A result or a problem for the user.
pub type Outcome<T> = Result<T, Problem>;

/// What to write in place of a word: the nearest of those that are known, and all of them.
pub fn meant(word: &str, known: &[&str], what: &str) -> String {
    hint(nearest(word, known.iter().copied()), &known.join(", "), what)
}

/// The nearest of the words that are known, if there is one, and all of them.
pub fn hint(nearest: Option<&str>, known: &str, what: &str) -> String {
    nearest.map_or_else(String::new, |nearest| format!("did you mean `{nearest}`? ")) + &format!("{what}: {known}")
}

/// What is wrong, and what to do about it.
#[derive(Debug)]
pub enum Problem {
    /// The reader of the output has closed it, so no message reaches anyone.
    OutputClosed,
    /// The spec has mistakes.
    Mistakes(Box<Diagnostics>),
    /// A failure that was already reported, here or by another program.
    AlreadyReported {
        /// Its exit code.
        exit_code: u8,
    },
    /// A message.
    Message {
        /// What is wrong.
        title: String,
        /// What to do about it.
        help: String,
        /// Exit code.
        code: u8,
    },
}

impl Problem {
    /// The arguments are wrong.
    pub fn usage(title: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Message { title: title.into(), help: help.into(), code: USAGE }
    }

    /// The computation failed.
    pub fn failed(title: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Message { title: title.into(), help: help.into(), code: FAILED }
    }

    /// The spec has mistakes.
    pub fn mistakes(mistakes: Diagnostics) -> Self {
        Self::Mistakes(Box::new(mistakes))
    }

    /// A file or folder could not be used.
    pub fn file(path: &Path, error: &io::Error) -> Self {
        Self::failed(format!("cannot use {}: {error}", path.display()), remedy(error.kind()))
    }

    /// Arguments that cannot be read.
    pub fn arguments(error: &clap::Error) -> Self {
        let text = error.to_string();
        let mut words = text.trim_start_matches("error:").trim().splitn(2, "\n\n");
        let [title, help] = [words.next(), words.next()].map(|words| words.unwrap_or_default().trim().to_owned());
        Self::usage(title, help)
    }

    /// What is wrong.
    pub fn title(&self) -> &str {
        match self {
            Problem::Message { title, .. } => title,
            _ => "",
        }
    }

    /// What is wrong and what to do about it, in one line.
    pub fn message(&self) -> String {
        match self {
            Problem::Message { title, help, .. } if !help.is_empty() => format!("{title}; {help}"),
            Problem::Mistakes(mistakes) => mistakes.headline(),
            _ => self.title().to_owned(),
        }
    }
}

/// What to do about an error of the file system.
fn remedy(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space, or name a place on another disk"
        }
        io::ErrorKind::IsADirectory | io::ErrorKind::ResourceBusy => "name a file, not a folder",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => "name a folder, not a file",
        io::ErrorKind::NotFound => "check the path: a folder in it does not exist",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "name a place where you may write",
        _ => "check that the path exists and that you may write there",
    }
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Problem::OutputClosed,
            kind => Problem::failed(format!("cannot write the output: {error}"), remedy(kind)),
        }
    }
}

impl From<Stopped> for Problem {
    fn from(stopped: Stopped) -> Self {
        Problem::failed(stopped.to_string(), stopped.advice())
    }
}

impl From<Failed> for Problem {
    fn from(failed: Failed) -> Self {
        let other = match failed.reason.as_ref() {
            Reason::Stopped { stopped, .. } if stopped.method.is_explicit() => {
                format!("; `--method {}` copes with stiff cranes", Method::RECOMMENDED)
            }
            _ => String::new(),
        };
        Problem::failed(failed.to_string(), failed.advice() + &other)
    }
}

impl From<NoModes> for Problem {
    fn from(error: NoModes) -> Self {
        Problem::failed(error.to_string(), "check masses and inertias in the spec")
    }
}
