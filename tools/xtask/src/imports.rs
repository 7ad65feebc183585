//! The permitted dependencies: the tables of ARCHITECTURE.md are read here, and the code must keep to them.

use std::collections::{BTreeMap, BTreeSet};

use crate::{cycles, modules, workspace};

const PAGE: &str = "ARCHITECTURE.md";
/// What a reader takes in at one sitting.
const MOST_LINES: usize = 220;
const COMPILER: &str = "codegen/src";
/// Headings of the tables of modules and crates.
const MODULES: &str = "Modules of the compiler";
const CRATES: &str = "Crates of the project";
/// Heading of the runtime's part, with the table of its floors.
const RUNTIME: &str = "The runtime";
const FLOORS: &str = "crane-model/src";
/// A cell that permits every module.
const ALL: &str = "all";

/// Words that a folder may not contain, and why.
const MAY_NOT_NAME: [(&str, &str, &[&str], &str); 8] = [
    (
        "tests/golden",
        "rs",
        &["std::", "alloc::", "panic!", "unwrap("],
        "generated code needs core and the runtime only",
    ),
    ("tools/casadi", "py", &["codegen/src", "import yaml"], "the check shares the YAML file and nothing else"),
    ("tools/peers", "py", &["codegen/src", "import yaml"], "the peers share the YAML file and nothing else"),
    ("codegen/src", "rs", &["unsafe "], "no unsafe code"),
    (
        "engine/live/src",
        "rs",
        &["std::fs", "std::env", "std::process", "leak("],
        "a live crane is made of text in memory and gone when it is dropped: no file is touched, nothing leaks",
    ),
    (
        "apps/page/src",
        "rs",
        &["std::fs", "std::env", "std::process"],
        "a page is text; files and notebooks are for others",
    ),
    (
        "apps/python/src",
        "rs",
        &["unsafe ", "std::fs", "std::process"],
        "the package leaves files and processes to others",
    ),
    (
        "apps/fmu/src",
        "rs",
        &["std::process", "std::thread", "std::env"],
        "a unit computes inside of another program, and leaves that program alone",
    ),
];

/// Words that only some files of the compiler may contain, and what they are.
const ONLY_IN: [(&[&str], &[&str], &str); 5] = [
    (&["fs::", "env::", "process::", "std::{"], &["build.rs", "files.rs"], "files, environment and process"),
    (&["quote!", "prettyplease"], &["emit/"], "Rust as text"),
    (&["syn::"], &["emit/", "validate/names.rs", "exchange/import/links.rs"], "Rust's syntax"),
    (&["serde_yaml"], &["node/tree.rs"], "the YAML library"),
    (&["annotate_snippets"], &["diagnostic/draw.rs"], "the library that draws mistakes"),
];

/// Every breach of the rules.
pub fn check_imports() -> Result<(), String> {
    let page = workspace::read_file(PAGE)?;
    let mut breaches = check_modules(&page)?;
    let lines = page.lines().count();
    breaches.extend((lines > MOST_LINES).then(|| format!("{PAGE}: {lines} lines, more than {MOST_LINES}")));
    breaches.extend(check_crates(&page)?);
    breaches.extend(check_floors(&page)?);
    for (folder, extension, words, reason) in MAY_NOT_NAME {
        for file in &workspace::find_files(folder, extension)? {
            for (number, line) in code_lines(&workspace::read_file(file)?) {
                breaches.extend(
                    words.iter().filter(|w| line.contains(**w)).map(|w| format!("{file}:{number}: `{w}`: {reason}")),
                );
            }
        }
    }
    for file in workspace::find_files(COMPILER, "rs")? {
        let module = &file[COMPILER.len() + 1..];
        let lines = code_lines(&workspace::read_file(&file)?);
        for (words, places, what) in ONLY_IN {
            let permitted = places.iter().any(|permitted| module.starts_with(permitted));
            let named = |line: &str| words.iter().any(|word| line.replace("env!(", "").contains(word));
            let found = lines.iter().filter(|(_, line)| !permitted && named(line));
            breaches.extend(found.map(|(number, _)| format!("{file}:{number}: only {} use {what}", places.join(", "))));
        }
    }
    breaches.extend(cycles::find_cycles()?);
    breaches.extend(modules::find_unused_files()?);
    if breaches.is_empty() { Ok(()) } else { Err(format!("\n{}", breaches.join("\n"))) }
}

/// Differences between the first table and what the modules of the compiler import.
fn check_modules(page: &str) -> Result<Vec<String>, String> {
    let rows = read_table(page, MODULES);
    let files = workspace::find_files(COMPILER, "rs")?;
    let present: BTreeSet<&str> = files.iter().map(|file| module_of(file)).filter(|name| *name != "lib").collect();
    let mut breaches = unlisted_rows(MODULES, &present, &rows);
    let known: BTreeSet<&str> = files.iter().map(String::as_str).collect();
    let reexports = read_reexports()?;
    // Of each module the modules that it names, each with a file that does.
    let mut used: BTreeMap<&str, BTreeMap<String, &str>> = BTreeMap::new();
    for file in files.iter().filter(|file| !is_test(file)) {
        let text = workspace::read_file(file)?;
        let named = cycles::files_imported(&text, file, (COMPILER, &cycles::Exports::new()), &known);
        let mut named: BTreeSet<String> = named.iter().map(|file| module_of(file).to_owned()).collect();
        named.extend(modules_named(&text, "crate::", &reexports));
        named.retain(|name| name != module_of(file) && name != "lib");
        used.entry(module_of(file)).or_default().extend(named.into_iter().map(|name| (name, file.as_str())));
    }
    for (row, name) in rows.iter().flat_map(|row| row[0].iter().map(move |name| (row, name))) {
        let Some(used) = used.get(name.as_str()) else { continue };
        let wrong = used.iter().filter(|(other, _)| !row[1].contains(*other));
        breaches.extend(wrong.map(|(other, file)| format!("{file}: `{name}` may not import `{other}`")));
        let unused = row[1].iter().filter(|other| !used.contains_key(*other));
        breaches.extend(unused.map(|other| format!("{PAGE}, {MODULES}: `{name}` does not import `{other}`")));
    }
    Ok(breaches)
}

/// Crates that depend on a crate, or name a module of the compiler, that the second table does not permit.
fn check_crates(page: &str) -> Result<Vec<String>, String> {
    let rows = read_table(page, CRATES);
    let members = workspace::members()?;
    let members: BTreeSet<&str> = members.iter().map(String::as_str).collect();
    let mut breaches = unlisted_rows(CRATES, &members, &rows);
    let reexports = read_reexports()?;
    for (row, member) in rows.iter().flat_map(|row| row[0].iter().map(move |member| (row, member))) {
        if !members.contains(member.as_str()) {
            continue;
        }
        let manifest = format!("{member}/Cargo.toml");
        let wrong =
            dependencies_of(&workspace::read_file(&manifest)?).into_iter().filter(|name| !row[1].contains(name));
        breaches.extend(wrong.map(|name| format!("{manifest}: may not depend on crane-{name}")));
        if row[2].contains(ALL) {
            continue;
        }
        for file in workspace::find_files(&format!("{member}/src"), "rs")?.iter().filter(|file| !is_test(file)) {
            let named = modules_named(&workspace::read_file(file)?, "crane_codegen::", &reexports);
            let wrong = named.iter().filter(|name| !row[2].contains(*name));
            breaches.extend(wrong.map(|name| format!("{file}: may not import `{name}` of the compiler")));
        }
    }
    Ok(breaches)
}

/// Rooms of the runtime that use what is on a floor above.
fn check_floors(page: &str) -> Result<Vec<String>, String> {
    let rows = read_table(page, RUNTIME);
    let imports = cycles::rooms_imported(FLOORS)?;
    let present: BTreeSet<&str> = imports.keys().map(String::as_str).collect();
    let floor = |room: &str| rows.iter().position(|row| row[0].contains(room));
    let mut breaches = unlisted_rows(RUNTIME, &present, &rows);
    for (room, named) in &imports {
        let above = named.iter().filter(|other| floor(other) > floor(room));
        breaches.extend(above.map(|other| format!("{FLOORS}: `{room}` uses `{other}` of a floor above")));
    }
    Ok(breaches)
}

/// Crates of the project on which a manifest depends, except for its tests.
fn dependencies_of(manifest: &str) -> BTreeSet<String> {
    let sections = manifest
        .split("\n[")
        .filter(|section| ["dependencies]", "build-dependencies]"].iter().any(|title| section.starts_with(title)));
    let names = sections.flat_map(str::lines).filter_map(|line| line.strip_prefix("crane-"));
    names.filter_map(|line| line.split([' ', '.', '=']).next()).map(str::to_owned).collect()
}

/// Rows of the table under a heading: the words in backticks of each cell.
fn read_table(page: &str, heading: &str) -> Vec<Vec<BTreeSet<String>>> {
    let part = page.split("\n#").find(|part| part.lines().next().is_some_and(|line| line.ends_with(heading)));
    let rows = part.unwrap_or_default().lines().filter(|line| line.starts_with("| `"));
    let words = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    rows.map(|row| row.trim_matches('|').split('|').map(words).collect()).collect()
}

/// Names that have no row, or more than one, and rows of what does not exist.
fn unlisted_rows(heading: &str, present: &BTreeSet<&str>, rows: &[Vec<BTreeSet<String>>]) -> Vec<String> {
    let listed: Vec<&str> = rows.iter().flat_map(|row| &row[0]).map(String::as_str).collect();
    let once = |name: &str| listed.iter().filter(|listed| **listed == name).count() == 1;
    let lacking = present.iter().filter(|name| !once(name)).map(|name| format!("`{name}` needs one row"));
    let gone = listed.iter().filter(|name| !present.contains(**name)).map(|name| format!("there is no `{name}`"));
    lacking.chain(gone).map(|problem| format!("{PAGE}, {heading}: {problem}")).collect()
}

/// The module of the compiler that a file belongs to.
fn module_of(file: &str) -> &str {
    let path = file.trim_start_matches(COMPILER).trim_start_matches('/');
    path.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// Names that the compiler's root exports from its modules: `Diagnostics` from `diagnostic`.
fn read_reexports() -> Result<BTreeMap<String, String>, String> {
    let text = workspace::read_file(&format!("{COMPILER}/lib.rs"))?;
    let lines = text.split("\npub use ").skip(1).flat_map(cycles::paths_of);
    Ok(lines.filter_map(|path| Some((path.last()?.clone(), path.first()?.clone()))).collect())
}

/// Modules of the compiler that a text names in paths with a beginning; what the root exports belongs to its module.
fn modules_named(text: &str, start: &str, reexports: &BTreeMap<String, String>) -> BTreeSet<String> {
    let code: Vec<String> = code_lines(text).into_iter().map(|(_, line)| line).collect();
    let code = code.join("\n");
    let macros = code.replace(&format!("${start}"), "");
    let paths = macros.split(start).skip(1).flat_map(cycles::paths_of);
    let names = paths.filter_map(|path| path.into_iter().next());
    names
        .filter_map(|name| match reexports.get(&name) {
            Some(module) => Some(module.clone()),
            None => name.starts_with(char::is_lowercase).then_some(name),
        })
        .collect()
}

/// Tests of a module may use more.
fn is_test(file: &str) -> bool {
    file.ends_with("/tests.rs")
}

/// Lines that are code, without the tests at the end of a file, with their numbers.
fn code_lines(text: &str) -> Vec<(usize, String)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]" || text.contains("mod tests;"))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(index, line)| (index + 1, line.to_owned()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_found() {
        let reexports = [("SourceFile".to_owned(), "diagnostic".to_owned())].into();
        let named = |text: &str| modules_named(text, "crate::", &reexports).into_iter().collect::<Vec<_>>();
        assert_eq!(named("use crate::chain::Chain;"), ["chain"]);
        assert_eq!(
            named("use crate::{\n    SourceFile, compile,\n    emit::{self, Report},\n};"),
            ["compile", "diagnostic", "emit"]
        );
        assert_eq!(named("    crate::lower::lower(p)\n// crate::read\n#[cfg(test)]\nuse crate::spec;"), ["lower"]);
        assert_eq!(module_of("codegen/src/emit/mod.rs"), "emit");
        assert_eq!(module_of("codegen/src/build.rs"), "build");
    }

    #[test]
    fn tables_are_read_and_compared() {
        let page = "# A\n## Tables\n### Modules of the compiler\n| Module | May use |\n|---|---|\n| `a`, `b` | `c` |\n| `c` | nothing |\n## B\n| `d` | |\n";
        let rows = read_table(page, MODULES);
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0][0], ["a", "b"].map(str::to_owned).into());
        assert_eq!(rows[0][1], ["c".to_owned()].into());
        let problems = unlisted_rows(MODULES, &["a", "c", "x"].into(), &rows);
        assert_eq!(problems.len(), 2, "{problems:?}");
        assert!(problems[0].ends_with("`x` needs one row") && problems[1].ends_with("there is no `b`"), "{problems:?}");
    }

    #[test]
    fn dependencies_are_found() {
        let manifest = "[package]\nname = \"crane-x\"\n\n[dependencies]\ncrane-model = { path = \"..\" }\nserde = \"1\"\n\n\
                        [dev-dependencies]\ncrane-live.workspace = true\n\n[build-dependencies]\ncrane-codegen.workspace = true\n";
        assert_eq!(dependencies_of(manifest), ["codegen", "model"].map(str::to_owned).into());
    }
}
