//! Import cycles: files that need each other, directly or through others.

use std::collections::{BTreeMap, BTreeSet};

use crate::workspace;

/// The modules of the Python package.
const PYTHON: &str = "apps/python/crane";
/// Maximum size of a permitted cycle of files: a file and its helper.
const HELPED: usize = 2;

/// A file, or a room, and those that it names.
pub type Imports = BTreeMap<String, BTreeSet<String>>;

/// Every circle of rooms, files and folders below the root of a crate, and every cycle of files except for a file and its helper, as a line that names them;
/// and every cycle of Python modules.
pub fn find_cycles() -> Result<Vec<String>, String> {
    let python = cyclic_groups(&python_imports()?);
    let mut found: Vec<String> =
        python.iter().map(|modules| format!("{} import each other in a cycle", modules.join(", "))).collect();
    for root in workspace::members()?.iter().map(|member| format!("{member}/src")) {
        let root = root.as_str();
        if !workspace::root().join(root).is_dir() {
            continue;
        }
        let imports = imports_of(root)?;
        let rooms = cyclic_groups(&by_room(&imports, root)).into_iter().filter(|rooms| rooms.len() > 1);
        found.extend(rooms.map(|rooms| format!("{} of {root} import each other in a circle", rooms.join(", "))));
        let cycles = cyclic_groups(&imports).into_iter().filter(|files| files.len() > HELPED);
        found.extend(cycles.map(|files| format!("{} import each other in a cycle", files.join(", "))));
    }
    Ok(found)
}

/// What every file of a crate names, also through what the crate's root exports. The root itself names everything, and tests may.
fn imports_of(root: &str) -> Result<Imports, String> {
    let all = workspace::find_files(root, "rs")?;
    let (roots, files): (Vec<String>, Vec<String>) =
        all.into_iter().filter(|file| !file.ends_with("/tests.rs")).partition(|file| is_root(file, root));
    let known: BTreeSet<&str> = files.iter().map(String::as_str).collect();
    let mut exports = Exports::new();
    for file in &roots {
        exports.extend(exports_of(&workspace::read_file(file)?, root, &known));
    }
    let mut imports = Imports::new();
    for file in &files {
        let named = files_imported(&workspace::read_file(file)?, file, (root, &exports), &known);
        imports.insert(file.clone(), named);
    }
    Ok(imports)
}

/// What every Python module imports while it is loaded: not for types alone, nor within a function.
fn python_imports() -> Result<Imports, String> {
    let files = workspace::find_files(PYTHON, "py")?;
    let mut imports = Imports::new();
    for file in files.iter().filter(|file| !file.ends_with("/__init__.py")) {
        let named = modules_loaded(&workspace::read_file(file)?).into_iter().map(|name| format!("{PYTHON}/{name}.py"));
        imports.insert(file.clone(), named.filter(|other| files.contains(other)).collect());
    }
    Ok(imports)
}

/// Modules of its own package that a Python module imports without indentation.
fn modules_loaded(text: &str) -> BTreeSet<String> {
    let from = text.lines().filter_map(|line| line.strip_prefix("from ."));
    let named = from.flat_map(|line| {
        let (module, names) = line.split_once(" import ").unwrap_or((line, ""));
        if module.trim().is_empty() { names.trim_matches(['(', ')']).split(',').collect() } else { vec![module] }
    });
    named.map(|name| name.split_whitespace().next().unwrap_or_default().to_owned()).collect()
}

/// What the rooms of a crate import of each other.
pub fn rooms_imported(root: &str) -> Result<Imports, String> {
    Ok(by_room(&imports_of(root)?, root))
}

/// The same between rooms.
fn by_room(imports: &Imports, root: &str) -> Imports {
    let room_of = |file: &str| {
        let inside = file.strip_prefix(root).unwrap_or(file).trim_start_matches('/');
        inside.split('/').next().unwrap_or(inside).trim_end_matches(".rs").to_owned()
    };
    let mut rooms = Imports::new();
    for (file, named) in imports {
        let room = room_of(file);
        let others = named.iter().map(|other| room_of(other)).filter(|other| *other != room);
        rooms.entry(room.clone()).or_default().extend(others.collect::<Vec<_>>());
    }
    rooms
}

fn is_root(file: &str, root: &str) -> bool {
    ["lib.rs", "main.rs"].iter().any(|name| file == format!("{root}/{name}"))
}

/// Names that the root of a crate exports, and the files that they come from.
pub type Exports = BTreeMap<String, String>;

/// What a root exports with `pub use`.
fn exports_of(text: &str, root: &str, known: &BTreeSet<&str>) -> Exports {
    let uses = text.match_indices("pub use ").chain(text.match_indices("pub(crate) use "));
    let paths = uses.flat_map(|(at, before)| paths_of(text[at + before.len()..].trim_start_matches("crate::")));
    let named = |path: Vec<String>| Some((path.last()?.clone(), resolve_path(root, &path, known)?));
    paths.filter_map(named).collect()
}

/// Files that a text names in paths from `crate`, `super` or `self`. A folder's `mod.rs` that declares a file does not import it.
pub fn files_imported(
    text: &str,
    file: &str,
    (root, exports): (&str, &Exports),
    known: &BTreeSet<&str>,
) -> BTreeSet<String> {
    // Tests at the end may use everything.
    let code = text.split("\n#[cfg(test)]").next().unwrap_or_default();
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let folder = folder_of(file);
    let mut found = BTreeSet::new();
    for (start, base) in [("crate::", root.to_owned()), ("super::", parent_of(file)), ("self::", folder)] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            for path in paths_of(&code[at + start.len()..]) {
                let exported = path.first().filter(|_| base == root).and_then(|name| exports.get(name)).cloned();
                let target = resolve_path(&base, &path, known).or(exported);
                found.extend(target.filter(|target| target != file));
            }
        }
    }
    found
}

/// The folder that holds the submodules of a file.
fn folder_of(file: &str) -> String {
    let stem = file.trim_end_matches(".rs");
    stem.strip_suffix("/mod").unwrap_or(stem).to_owned()
}

/// The folder that holds the siblings of a file.
fn parent_of(file: &str) -> String {
    folder_of(file).rsplit_once('/').map_or_else(String::new, |(parent, _)| parent.to_owned())
}

/// Paths at the beginning of a text, those in braces expanded: `a::{b, c::d}` is `a::b` and `a::c::d`.
pub fn paths_of(text: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    expand_path(text.trim_start(), &mut Vec::new(), &mut found);
    found
}

/// Reads one path and returns what follows it.
fn expand_path<'t>(text: &'t str, before: &mut Vec<String>, found: &mut Vec<Vec<String>>) -> &'t str {
    let depth = before.len();
    let mut rest = text;
    loop {
        if let Some(list) = rest.strip_prefix('{') {
            rest = list.trim_start();
            while !rest.is_empty() && !rest.starts_with('}') {
                rest = expand_path(rest, before, found).trim_start();
                rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
            }
            before.truncate(depth);
            return rest.strip_prefix('}').unwrap_or(rest);
        }
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        if end == 0 {
            // `*` or something that is not a path.
            found.push(before.clone());
            before.truncate(depth);
            let mut letters = rest.chars();
            letters.next();
            return letters.as_str();
        }
        before.push(rest[..end].to_owned());
        rest = &rest[end..];
        let Some(deeper) = rest.strip_prefix("::") else {
            found.push(before.clone());
            before.truncate(depth);
            // A renamed import.
            let renamed = rest
                .strip_prefix(" as ")
                .map(|rest| rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_'));
            return renamed.unwrap_or(rest);
        };
        rest = deeper.trim_start();
    }
}

/// The file that a path from a folder names: that of the longest beginning of the path that is a module.
fn resolve_path(base: &str, path: &[String], known: &BTreeSet<&str>) -> Option<String> {
    let mut folder = base.to_owned();
    let mut module = None;
    for name in path {
        if name == "super" {
            folder = folder.rsplit_once('/').map_or_else(String::new, |(parent, _)| parent.to_owned());
            continue;
        }
        folder = format!("{folder}/{name}");
        let file =
            [format!("{folder}.rs"), format!("{folder}/mod.rs")].into_iter().find(|file| known.contains(file.as_str()));
        match file {
            Some(file) => module = Some(file),
            None => break,
        }
    }
    module
}

/// Files that reach each other, group by group.
fn cyclic_groups(imports: &Imports) -> Vec<Vec<String>> {
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        imports.keys().map(|file| (file.as_str(), files_reached(imports, file))).collect();
    let mut found: Vec<Vec<String>> = Vec::new();
    for file in imports.keys() {
        if found.iter().flatten().any(|known| known == file) {
            continue;
        }
        let back = |other: &&&str| reached.get(**other).is_some_and(|from| from.contains(file.as_str()));
        let cycle: Vec<String> = reached[file.as_str()].iter().filter(back).map(ToString::to_string).collect();
        if !cycle.is_empty() {
            found.push(cycle);
        }
    }
    found
}

/// Everything that a file needs, directly or through others.
fn files_reached<'i>(imports: &'i Imports, file: &str) -> BTreeSet<&'i str> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&str> = imports.get(file).into_iter().flatten().map(String::as_str).collect();
    while let Some(next) = open.pop() {
        if found.insert(next) {
            open.extend(imports.get(next).into_iter().flatten().map(String::as_str));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_in_braces_are_written_out() {
        let words = |text: &str| paths_of(text).iter().map(|path| path.join("::")).collect::<Vec<_>>();
        assert_eq!(words("chain::Chain;"), ["chain::Chain"]);
        assert_eq!(
            words("{SourceFile, compile as c, emit::{self, labels::Labels}, own::*};"),
            ["SourceFile", "compile", "emit::self", "emit::labels::Labels", "own"]
        );
        assert_eq!(words("lower::lower(p)"), ["lower::lower"]);
    }

    #[test]
    fn python_modules_are_found() {
        let text = "from __future__ import annotations\nfrom .results import Row, names\nfrom . import loops, model as own\nif TYPE_CHECKING:\n    from .run import Run\n";
        assert_eq!(modules_loaded(text), ["loops", "model", "results"].map(str::to_owned).into());
    }

    #[test]
    fn cycles_of_three_are_found_and_pairs_are_not() {
        let known: BTreeSet<&str> = ["r/a.rs", "r/b/mod.rs", "r/b/c.rs", "r/d.rs"].into();
        let exports = exports_of("pub use d::{self, Deep};\n", "r", &known);
        let of = |file: &str, text: &str| (file.to_owned(), files_imported(text, file, ("r", &exports), &known));
        let mut imports: Imports = [
            of("r/a.rs", "use crate::{b::c::Name, d};\n"),
            of("r/b/mod.rs", "mod c;\nuse crate::Deep;\n"),
            of("r/b/c.rs", "use super::super::d::Other;\n// crate::a\n"),
            of("r/d.rs", "fn f() { super::a::g() }\n#[cfg(test)]\nuse crate::b;\n"),
        ]
        .into();
        let cycle = ["r/a.rs", "r/b/c.rs", "r/d.rs"].map(str::to_owned).to_vec();
        assert_eq!(cyclic_groups(&imports), [cycle]);
        imports.extend([of("r/b/c.rs", "use std::fmt;\n")]);
        assert_eq!(cyclic_groups(&imports), [["r/a.rs", "r/d.rs"].map(str::to_owned).to_vec()]);
        assert!(imports["r/b/mod.rs"].contains("r/d.rs"));
        let rooms = by_room(&imports, "r");
        assert_eq!(rooms["b"], ["d".to_owned()].into());
        assert_eq!(cyclic_groups(&rooms), [["a", "b", "d"].map(str::to_owned).to_vec()]);
    }
}
