//! docs/EQUATIONS.md names functions and tests, ARCHITECTURE.md the tests that hold its invariants: all of them must exist, and no generated
//! function may be missing in the first. docs/manual/from-the-paper.md derives every equation of the paper and names its functions.

use crate::workspace;

const DOCUMENT: &str = "docs/EQUATIONS.md";
/// Its invariants end with the names of their tests.
const INVARIANTS: &str = "ARCHITECTURE.md";
/// It derives the paper's equations, each under a heading `### (n) …`, with its functions after `Code:` and a number after `By hand`.
const DERIVATIONS: &str = "docs/manual/from-the-paper.md";
/// Number of the last of them.
const LAST_EQUATION: usize = 23;
/// The file that lists the generated functions.
const FUNCTIONS: &str = "quantities/src/table.rs";

/// Every name that is stale, and every generated function without a row.
pub fn check_equations() -> Result<(), String> {
    let document = workspace::read_file(DOCUMENT)?;
    let generated = generated_functions(&workspace::read_file(FUNCTIONS)?);
    let mut stale = Vec::new();
    let mut documented = Vec::new();
    for (index, line) in document.lines().enumerate().filter(|(_, line)| line.starts_with('|')) {
        let mut complain = |what: String| stale.push(format!("{DOCUMENT}:{}: {what}", index + 1));
        let names: Vec<&str> = line.split('`').skip(1).step_by(2).collect();
        for name in names.iter().filter(|name| name.contains("::")) {
            if !function_exists(name)? {
                complain(format!("`{name}` does not exist"));
            }
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        // Rows of the first table: equation, what, derived by, generated, tests.
        if cells.len() == 7 {
            for name in cells[4].split('`').skip(1).step_by(2) {
                if !generated.iter().any(|function| function == name) {
                    complain(format!("no function `{name}` is generated"));
                }
                documented.push(name.to_owned());
            }
        }
    }
    stale.extend(
        generated
            .iter()
            .filter(|function| !documented.contains(function))
            .map(|function| format!("{DOCUMENT}: the generated function `{function}` has no row")),
    );
    let invariants = workspace::read_file(INVARIANTS)?;
    for name in tests_named(&invariants) {
        if !function_exists(name)? {
            stale.push(format!("{INVARIANTS}: `{name}` does not exist"));
        }
    }
    let derivations = workspace::read_file(DERIVATIONS)?;
    for name in derivations.split('`').filter(|name| name.contains("::") && !name.contains(char::is_whitespace)) {
        if !function_exists(name)? {
            stale.push(format!("{DERIVATIONS}: `{name}` does not exist"));
        }
    }
    stale.extend(missing_derivations(&derivations).into_iter().map(|problem| format!("{DERIVATIONS}: {problem}")));
    if stale.is_empty() { Ok(()) } else { Err(format!("\n{}", stale.join("\n"))) }
}

/// Equations without a section in their order, and sections without functions or a number.
fn missing_derivations(page: &str) -> Vec<String> {
    let sections: Vec<&str> = page.split("\n### ").skip(1).collect();
    let wanted = (1..=LAST_EQUATION).filter_map(|number| {
        let Some(section) = sections.get(number - 1).filter(|section| section.starts_with(&format!("({number}) ")))
        else {
            return Some(format!("section {number} is not that of equation ({number})"));
        };
        let without = ["Code: ", "By hand"].into_iter().find(|part| !section.contains(part))?;
        Some(format!("equation ({number}) has no `{without}`"))
    });
    wanted.collect()
}

/// Whether `path/file.rs::name` or `module::name` of the compiler is a function.
fn function_exists(name: &str) -> Result<bool, String> {
    let Some((module, function)) = name.rsplit_once("::") else { return Ok(false) };
    let candidates = if module.contains('.') {
        vec![module.to_owned()]
    } else {
        let path = module.replace("::", "/");
        vec![format!("codegen/src/{path}.rs"), format!("codegen/src/{path}/mod.rs")]
    };
    let found: Vec<&String> = candidates.iter().filter(|path| workspace::root().join(path).is_file()).collect();
    for path in found {
        let text = workspace::read_file(path)?;
        let defined = ["fn ", "def "].iter().any(|keyword| {
            text.match_indices(&format!("{keyword}{function}"))
                .any(|(at, found)| text[at + found.len()..].starts_with(['(', '<']))
        });
        if defined {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Names of tests in a text, `path/file.rs::name`.
fn tests_named(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2).filter(|name| [".rs::", ".py::"].iter().any(|file| name.contains(file)))
}

/// Names in rows `Id = name(arguments) -> result rule`.
fn generated_functions(text: &str) -> Vec<String> {
    let rows = text.lines().filter_map(|line| line.strip_prefix("    ")?.split_once(") -> ")?.0.split_once(" = "));
    let rows = rows.filter(|(id, _)| id.chars().all(char::is_alphanumeric));
    rows.filter_map(|(_, call)| Some(call.split_once('(')?.0.to_owned())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_of_invariants_are_found_and_exist() {
        let text = "* held by `a/b.rs::c`, by `T`, `m::f` and by `d.py::e`";
        assert_eq!(tests_named(text).collect::<Vec<_>>(), ["a/b.rs::c", "d.py::e"]);
        assert!(function_exists("tools/xtask/src/equations.rs::tests_of_invariants_are_found_and_exist").unwrap());
        assert!(!function_exists("tools/xtask/src/equations.rs::another").unwrap());
        assert!(tests_named(&workspace::read_file(INVARIANTS).unwrap()).count() > 15);
    }

    #[test]
    fn every_equation_is_derived_with_its_code_and_a_number() {
        let section = |number: usize, text: &str| format!("\n### ({number}) One\n{text}\n");
        let all = |odd: usize, text: &str| -> String {
            (1..=LAST_EQUATION).map(|n| section(n, if n == odd { text } else { "Code: `a::b`. By hand: 1." })).collect()
        };
        assert_eq!(missing_derivations(&all(0, "")), [""; 0]);
        assert_eq!(missing_derivations(&all(7, "Code: `a::b`.")), ["equation (7) has no `By hand`"]);
        assert_eq!(missing_derivations(&section(2, "")).len(), LAST_EQUATION);
    }
}
