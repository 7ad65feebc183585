//! `crane new`: a crate for your own crane, starting from a shipped one.

mod sources;
mod vendored;

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

use crane_codegen::{SourceFile, compile};

use crate::{
    arguments::New,
    compiled, files,
    problem::{Outcome, Problem},
    screen::Console,
    selection::Registry,
};

/// Files of a new crate: where they go, and what they are made from.
const FILES: [(&str, &str); 6] = [
    ("Cargo.toml", include_str!("new/Cargo.toml.template")),
    ("README.md", include_str!("new/README.md.template")),
    ("build.rs", include_str!("new/build.rs.template")),
    ("src/lib.rs", include_str!("new/lib.rs.template")),
    ("src/main.rs", include_str!("new/main.rs.template")),
    ("tests/identities.rs", include_str!("new/identities.rs.template")),
];
const SPEC: &str = "crane.yaml";
const SCHEMA: (&str, &str) = ("crane.schema.json", crane_specs::SCHEMA);

/// Writes the crate.
pub fn new(options: &New, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let package = package(&options.folder)?;
    let name = package.replace('-', "_");
    // The name of a shipped crane may be written like that of a crate.
    let shipped = options.from.replace('-', "_");
    let from = if registry.spec(&shipped).is_some() { &shipped } else { &options.from };
    let (from, text) = registry.load(from, false)?;
    let spec = renamed(&text, &from.name, &name).ok_or_else(|| {
        Problem::failed(
            format!("cannot rename the crane {} in its spec", from.name),
            format!("write `name: {}` on a line of its own", from.name),
        )
    })?;
    // Before anything is written: not every name of a crate can be that of a crane.
    compile::load(&SourceFile::new(SPEC, spec.as_str())).map_err(|mistakes| {
        let message =
            mistakes.mistakes().first().map(|first| (format!("{}: {}", first.title, first.label), first.help.clone()));
        let (title, help) = message.unwrap_or_default();
        Problem::usage(title, help)
    })?;

    if options.folder.exists() {
        return Err(Problem::usage(
            format!("{} already exists", options.folder.display()),
            "name a folder that does not exist yet",
        ));
    }
    let carried = registry.carried();
    let vendor = options.vendor || !carried.sources.is_empty();
    if carried.sources.is_empty() && !vendored::has_tree() {
        return Err(Problem::failed(
            format!(
                "the source of `crane`, which the new crate depends on, is no longer at {}",
                compiled::root().display()
            ),
            "build `crane` again from its new location",
        ));
    }
    let from_tree = |folder: &str| compiled::root().join(folder).to_string_lossy().into_owned();
    let copied = |folder: &str| format!("{}/{folder}", vendored::FOLDER);
    let [model, codegen, ..] = sources::CRATES.map(|folder| if vendor { copied(folder) } else { from_tree(folder) });
    let values = [
        ("{{package}}", package.as_str()),
        ("{{name}}", &name),
        ("{{title}}", from.title.as_str()),
        ("{{from}}", &from.name),
        ("{{model}}", &model),
        ("{{codegen}}", &codegen),
    ];
    let filled = |template: &str| {
        values.iter().fold(template.to_owned(), |text, (placeholder, value)| text.replace(placeholder, value))
    };
    let mut texts: Vec<(PathBuf, String)> =
        FILES.iter().map(|(file, template)| (PathBuf::from(file), filled(template))).collect();
    texts.push((SPEC.into(), spec));
    texts.push((SCHEMA.0.into(), SCHEMA.1.to_owned()));
    texts.push(("Cargo.lock".into(), compiled::LOCK.to_owned()));
    if vendor {
        let sources = vendored::Sources::read(carried)?;
        let inherited = sources.inherited();
        for (_, manifest) in texts.iter_mut().filter(|(file, _)| file == Path::new("Cargo.toml")) {
            *manifest = manifest.replace("[workspace]\n", &inherited);
        }
        texts.extend(sources.crates());
    }
    write_folder(&registry.console, &options.folder, &texts)?;
    writeln!(
        out,
        "{} written, based on {}: edit {SPEC} there, then run `cargo run --release`; the first build takes a few minutes",
        options.folder.display(),
        from.name
    )?;
    Ok(())
}

/// Writes a folder with its files, completely or not at all.
fn write_folder(console: &Console, folder: &Path, texts: &[(PathBuf, String)]) -> Outcome<()> {
    let part = folder.with_extension("part");
    let written = (|| {
        for (file, text) in texts {
            let file = part.join(file);
            files::folder(file.parent().unwrap_or(&part))?;
            console.write_text(&file, text)?;
        }
        fs::rename(&part, folder).map_err(|error| Problem::file(folder, &error))
    })();
    if written.is_err() {
        // Remove the incomplete folder; the first error is reported.
        let _ = fs::remove_dir_all(&part);
    }
    written
}

/// The name of the package, that of its folder: letters, digits, `-` and `_`, from which the crane's name is made.
fn package(folder: &Path) -> Outcome<String> {
    let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    if compiled::LOCK.contains(&format!("\nname = \"{name}\"\n")) {
        let title = format!("`{name}` is the name of a crate that the new crate depends on");
        return Err(Problem::usage(title, format!("choose another name, such as my-{name}")));
    }
    if name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(fits) {
        Ok(name)
    } else {
        Err(Problem::usage(
            format!("`{name}` is not a valid name for a crate"),
            "use lower-case letters, digits, `-` and `_`, starting with a letter, such as my-crane",
        ))
    }
}

/// A spec with the crane renamed and all comments kept; `None` if the name is not on a line of its own.
fn renamed(spec: &str, from: &str, to: &str) -> Option<String> {
    let mut lines: Vec<String> = spec.split_inclusive('\n').map(str::to_owned).collect();
    let name = |line: &String| {
        line.strip_prefix("name:").filter(|rest| rest.contains(from)).map(|rest| rest.replacen(from, to, 1))
    };
    // The last one counts: those before are of specs that it extends.
    let (line, rest) = lines.iter_mut().rev().find_map(|line| name(line).map(|rest| (line, rest)))?;
    *line = format!("name:{rest}");
    Some(lines.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_that_counts_is_replaced() {
        let base = SourceFile::new("base.yaml", "name: boom_long\nlinks: []\n");
        let text = base.changed("name: boom   # short\n").text;
        let expected = text.replace("name: boom   # short", "name: mine   # short");
        assert_eq!(renamed(&text, "boom", "mine"), Some(expected));
        assert_eq!(renamed("{name: boom}", "boom", "mine"), None);
    }
}
