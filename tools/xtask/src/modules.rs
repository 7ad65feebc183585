//! Files of Rust that belong to no crate: cargo ignores them in silence, and tests in them would never run.

use crate::workspace;

/// Folders whose files are roots of crates, or are included as they are.
const ROOTS: [&str; 5] = ["/tests", "/benches", "/examples", "/bin", "/golden"];

/// Every file that no other file declares as a module, as a line that names it.
pub fn find_unused_files() -> Result<Vec<String>, String> {
    let members = workspace::read_file("Cargo.toml")?;
    let members = members.split("members = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap_or_default();
    let mut files: Vec<(String, String)> = Vec::new();
    for member in members.split('"').skip(1).step_by(2) {
        for folder in ["src", "tests"].map(|folder| format!("{member}/{folder}")) {
            if workspace::root().join(&folder).is_dir() {
                for file in workspace::find_files(&folder, "rs")? {
                    files.push((workspace::read_file(&file)?, file));
                }
            }
        }
    }
    let files: Vec<(&str, &str)> = files.iter().map(|(text, file)| (file.as_str(), text.as_str())).collect();
    Ok(unused_files(&files))
}

fn unused_files(files: &[(&str, &str)]) -> Vec<String> {
    let unused = files.iter().filter(|(file, _)| {
        let Some((folder, name)) = file.rsplit_once('/') else { return false };
        let is_root = matches!(name, "lib.rs" | "main.rs") || ROOTS.iter().any(|root| folder.ends_with(root));
        // `a/mod.rs` is the module `a` of the folder that holds `a`.
        let (module, holder) = match (name, folder.rsplit_once('/')) {
            ("mod.rs", Some((above, module))) => (module, above),
            _ => (name.trim_end_matches(".rs"), folder),
        };
        let by_path = format!("{module}{}", if name == "mod.rs" { "/mod.rs\"]" } else { ".rs\"]" });
        let declares = |(other, text): &(&str, &str)| {
            let beside = other.rsplit_once('/').is_some_and(|(own, _)| own == holder);
            let of_holder = beside || other.trim_end_matches(".rs") == holder;
            (of_holder && declares_module(text, module)) || text.contains(&by_path)
        };
        !is_root && !files.iter().any(declares)
    });
    unused.map(|(file, _)| format!("{file}: no file declares this module")).collect()
}

/// Whether a line of a text is `mod module;`, with any visibility.
fn declares_module(text: &str, module: &str) -> bool {
    let declared = format!("mod {module};");
    text.lines().any(|line| line.trim_start().split_once(&declared).is_some_and(|(before, _)| !before.contains("//")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_no_module_declares_are_found() {
        let files = [
            ("a/src/lib.rs", "pub mod one;\nmod two;\n// mod four;"),
            ("a/src/one.rs", ""),
            ("a/src/two/mod.rs", "pub(crate) mod three;"),
            ("a/src/two/three.rs", ""),
            ("a/src/four.rs", ""),
            ("a/tests/whole.rs", ""),
            ("a/tests/part/main.rs", "mod five;\n#[path = \"../common/mod.rs\"]\nmod common;"),
            ("a/tests/part/five.rs", ""),
            ("a/tests/part/six.rs", ""),
            ("a/tests/common/mod.rs", ""),
        ];
        let found = unused_files(&files);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("a/src/four.rs") && found[1].starts_with("a/tests/part/six.rs"));
    }
}
