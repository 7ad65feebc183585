//! One step of a task: a command, or a check in Rust.

use std::process::Command;

use crate::workspace;

/// A named step.
#[derive(Clone)]
pub struct Step {
    /// What it is, for the reader of the output.
    pub title: &'static str,
    action: Action,
}

#[derive(Clone)]
enum Action {
    Cargo { arguments: Vec<String>, environment: Vec<(&'static str, &'static str)> },
    Program(&'static str),
    Check(fn() -> Result<(), String>),
}

impl Step {
    /// Runs cargo at the workspace's root.
    pub fn cargo(title: &'static str, arguments: &[&str]) -> Self {
        let arguments = arguments.iter().map(ToString::to_string).collect();
        Step { title, action: Action::Cargo { arguments, environment: vec![] } }
    }

    /// Runs a function.
    pub fn check(title: &'static str, check: fn() -> Result<(), String>) -> Self {
        Step { title, action: Action::Check(check) }
    }

    /// Runs a program of the workspace that is already built, at the workspace's root.
    pub fn program(title: &'static str, name: &'static str) -> Self {
        Step { title, action: Action::Program(name) }
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
            Action::Program(name) => {
                let program = workspace::target().join("release").join(name);
                run_to_end(Command::new(program).current_dir(workspace::root()))
            }
            Action::Cargo { arguments, environment } => {
                let mut command = Command::new(cargo());
                command.args(arguments).envs(environment.iter().copied()).current_dir(workspace::root());
                run_to_end(&mut command)
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
