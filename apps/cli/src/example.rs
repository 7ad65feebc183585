//! `crane example`: commented specs to start from.

use std::io::Write;

use crate::{
    arguments::Example,
    problem::{Outcome, Problem, nearest},
    selection::Registry,
};

/// Prints the spec of an example, or lists all.
pub fn example(options: &Example, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let examples: Vec<(&str, &str)> = crane_specs::EXAMPLES.iter().chain(registry.shipped()).copied().collect();
    let Some(name) = &options.name else {
        let width = examples.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        writeln!(out, "Examples; `crane example NAME > my_crane.yaml` writes one to a file:")?;
        for (name, text) in examples {
            writeln!(out, "  {name:<width$}  {}", title(text))?;
        }
        return Ok(());
    };
    let found = examples.iter().find(|(known, _)| known == name);
    let (_, text) = found.ok_or_else(|| {
        let names: Vec<&str> = examples.iter().map(|(name, _)| *name).collect();
        let guess = nearest(name, names.iter().copied());
        let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
        Problem::usage(format!("there is no example `{name}`"), format!("{guess}examples: {}", names.join(", ")))
    })?;
    // The first line of a shipped spec names a schema beside it, which a copy elsewhere does not have.
    let text = text.strip_prefix("# yaml-language-server: $schema=crane.schema.json\n").unwrap_or(text);
    Ok(out.write_all(text.as_bytes())?)
}

/// The title of a spec; the last one of a spec that extends others.
fn title(text: &str) -> &str {
    text.lines().rev().find_map(|line| line.strip_prefix("title:")).unwrap_or_default().trim()
}
