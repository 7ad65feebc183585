//! The command's help, with its subcommands grouped by task.

use std::fmt::Write as _;

use clap::Command;

/// Tasks, and the subcommands for each. Subcommands that are not listed come last.
const GROUPS: [(&str, &[&str]); 4] = [
    ("Describe a crane", &["list", "info", "check", "explain", "example", "new", "import"]),
    (
        "Compute",
        &[
            "run",
            "compare",
            "statics",
            "strength",
            "fatigue",
            "factors",
            "drives",
            "sensitivity",
            "envelope",
            "simulate",
            "modes",
            "linearise",
            "margins",
            "stability",
        ],
    ),
    ("Show and hand on", &["report", "book", "picture", "export", "eval"]),
    ("For developers", &["generate", "operations", "schema", "completions"]),
];
const OTHERS: &str = "Other commands";

/// The command with its subcommands grouped by task in the help.
pub fn grouped(command: Command) -> Command {
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{}Options:\n{{options}}{{after-help}}",
        groups(&command)
    );
    command.help_template(template)
}

/// One line per subcommand, under the headings of the groups.
fn groups(command: &Command) -> String {
    let listed = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    let others: Vec<&str> = command.get_subcommands().map(Command::get_name).filter(|name| !listed(name)).collect();
    let mut text = String::new();
    for (title, names) in GROUPS.into_iter().chain([(OTHERS, others.as_slice())]) {
        let lines: Vec<String> = names.iter().filter_map(|name| line(command, name)).collect();
        if !lines.is_empty() {
            let _ = writeln!(text, "{title}:\n{}", lines.concat());
        }
    }
    text
}

/// Name and description of a subcommand.
fn line(command: &Command, name: &str) -> Option<String> {
    let about = command.find_subcommand(name)?.get_about().map(ToString::to_string).unwrap_or_default();
    Some(format!("  {name:<12} {about}\n"))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::arguments::Arguments;

    #[test]
    fn every_subcommand_is_in_one_group() {
        let command = Arguments::command();
        let text = groups(&command);
        for subcommand in command.get_subcommands() {
            let start = format!("\n  {:<12} ", subcommand.get_name());
            assert_eq!(text.matches(&start).count(), 1, "{start:?} in {text}");
        }
        for (_, names) in GROUPS {
            for name in names {
                assert!(command.find_subcommand(name).is_some(), "`{name}` does not exist");
            }
        }
    }
}
