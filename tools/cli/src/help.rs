//! The command's help, with its subcommands grouped by task, and completions of crane names.

use std::fmt::Write as _;

use clap::{Command, builder::PossibleValuesParser};

/// Tasks, and the subcommands for each. Subcommands that are not listed come last.
const GROUPS: [(&str, &[&str]); 4] = [
    ("Describe a crane", &["list", "info", "check", "explain", "new", "import"]),
    ("Compute", &["run", "compare", "statics", "strength", "envelope", "simulate", "modes", "linearise", "stability"]),
    ("Show and hand on", &["report", "export", "eval"]),
    ("For developers", &["generate", "operations", "schema", "completions"]),
];
const OTHERS: &str = "Other commands";
/// Name in the help of an argument that takes a shipped crane.
const CRANE: &str = "CRANE";

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

/// The command with the names of cranes among the values of every argument that takes one, for completions: files remain
/// possible where the shell completes them by default.
pub fn with_cranes(command: Command, names: &[&'static str]) -> Command {
    let names = names.to_vec();
    command.mut_subcommands(move |subcommand| {
        subcommand.mut_args(|argument| {
            let takes_crane =
                argument.get_value_names().is_some_and(|values| values.iter().any(|value| value.as_str() == CRANE));
            if takes_crane { argument.value_parser(PossibleValuesParser::new(names.clone())) } else { argument }
        })
    })
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

    #[test]
    fn bash_completes_the_names_of_cranes() {
        let mut script = Vec::new();
        let mut command = with_cranes(Arguments::command(), &["knuckle_boom", "cantilever"]);
        clap_complete::generate(clap_complete::Shell::Bash, &mut command, "crane", &mut script);
        let script = String::from_utf8(script).expect("a script");
        // Once per subcommand that takes a crane: at least the analyses.
        assert!(script.matches("knuckle_boom cantilever").count() > 8, "{script}");
    }
}
