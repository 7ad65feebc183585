//! The manual as a book: docs/SUMMARY.md lists every page, every link leads to an existing page and heading, and every chapter ends with the next one.
//!
//! [`check_manual`] reads the Markdown, including pages outside of the book, in a second. [`build_site`] builds the site with mdBook and follows the
//! links of its pages.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::{instrument, report, step, workspace};

const FOLDER: &str = "docs";
const SUMMARY: &str = "docs/SUMMARY.md";
/// Chapters, which end with a line that leads on. Notebooks, which a program writes, do not.
const CHAPTERS: &str = "docs/manual/";
const NOTEBOOKS: &str = "docs/manual/notebooks/";
/// Pages outside of the book.
const OUTSIDE: [&str; 3] = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"];

/// Every page that is not listed exactly once, every link that leads nowhere, and every chapter that ends without the next one.
pub fn check_manual() -> Result<(), String> {
    let mut pages = BTreeMap::new();
    let inside = workspace::find_files(FOLDER, "md")?;
    for path in inside.into_iter().chain(OUTSIDE.map(str::to_owned)) {
        let text = workspace::read_file(&path)?;
        pages.insert(path, text);
    }
    let mut wrong = unlisted_pages(&pages);
    wrong.extend(dead_ends(&pages));
    for (path, text) in &pages {
        for (line, link) in links_of(text) {
            if let Some(problem) = problem_of_link(path, link, &pages) {
                wrong.push(format!("{path}:{line}: {problem}"));
            }
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(format!("\n{}", wrong.join("\n"))) }
}

/// Builds the manual as a site into the folder `book` of the target, with the page as an instrument and reports of the shipped cranes beside it,
/// follows every link of its pages, and opens every spec that they link to.
pub fn build_site() -> Result<(), String> {
    let [site, reports] = ["book", "book-reports"].map(|name| workspace::target().join(name));
    let engine = instrument::write_page()?;
    report::write_reports(&reports)?;
    let builder = |task: &str| {
        let mut command = Command::new(step::cargo());
        let manifest = ["--locked", "--manifest-path", "tools/book/Cargo.toml", "--target-dir"];
        command.arg(task).args(manifest).arg(workspace::target().join("book-builder")).current_dir(workspace::root());
        command
    };
    step::run_to_end(&mut builder("test"))?;
    let mut build = builder("run");
    build.args(["--", FOLDER]).arg(&site).args(["specs", instrument::PAGE]).arg(&reports);
    step::run_to_end(&mut build)?;
    step::run_to_end(report::command_in_folder("node").arg("instrument/site.js").arg(engine).arg(site))
}

/// Pages of the book that its summary does not list exactly once.
fn unlisted_pages(pages: &BTreeMap<String, String>) -> Vec<String> {
    let summary = pages.get(SUMMARY).map_or("", String::as_str);
    let listed: Vec<String> = links_of(summary).into_iter().map(|(_, link)| resolve_link(SUMMARY, link)).collect();
    let inside = pages.keys().filter(|page| page.starts_with(FOLDER) && *page != SUMMARY);
    let count = |page: &str| listed.iter().filter(|listed| *listed == page).count();
    inside
        .map(|page| (page, count(page)))
        .filter(|(_, count)| *count != 1)
        .map(|(page, count)| format!("{SUMMARY}: lists {page} {count} times instead of once"))
        .collect()
}

/// Chapters whose last line does not lead on.
fn dead_ends(pages: &BTreeMap<String, String>) -> Vec<String> {
    let chapters = pages.iter().filter(|(page, _)| page.starts_with(CHAPTERS) && !page.starts_with(NOTEBOOKS));
    let leads_on = |line: &str| line.starts_with("Next: [") && line.contains("](") && line.ends_with('.');
    chapters
        .filter(|(_, text)| !text.lines().next_back().is_some_and(leads_on))
        .map(|(page, text)| format!("{page}:{}: end with a line `Next: [page](file.md), why.`", text.lines().count()))
        .collect()
}

/// What is wrong with a link of a page, if anything is.
fn problem_of_link(page: &str, link: &str, pages: &BTreeMap<String, String>) -> Option<String> {
    if link.contains("://") {
        return None;
    }
    let (file, anchor) = link.split_once('#').map_or((link, None), |(file, anchor)| (file, Some(anchor)));
    let target = if file.is_empty() { page.to_owned() } else { resolve_link(page, file) };
    if !workspace::root().join(&target).exists() {
        return Some(format!("`{link}`: there is no {target}"));
    }
    let anchor = anchor?;
    let known = pages.get(&target)?;
    (!anchors_of(known).contains(anchor)).then(|| format!("`{link}`: {target} has no such heading"))
}

/// The path from the root of a link on a page.
pub fn resolve_link(page: &str, link: &str) -> String {
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            "." | "" => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Lines of a page outside of blocks of code, with their numbers.
fn prose_lines(page: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut in_code = false;
    (1..).zip(page.lines()).filter(move |(_, line)| {
        let fence = line.starts_with("```");
        in_code ^= fence;
        !in_code && !fence && !line.starts_with("    ")
    })
}

/// Lines of a page that are or contain sentences: without code, headings, tables, comments and pictures.
pub fn sentence_lines(page: &str) -> impl Iterator<Item = (usize, &str)> {
    prose_lines(page).filter(|(_, line)| {
        let text = line.trim_start();
        !text.is_empty() && !text.starts_with(['#', '|', '<']) && !text.starts_with("![")
    })
}

/// Links of a page, with the numbers of their lines.
pub fn links_of(page: &str) -> Vec<(usize, &str)> {
    prose_lines(page)
        .flat_map(|(number, line)| {
            line.split("](").skip(1).filter_map(move |rest| Some((number, rest.split(')').next()?)))
        })
        .collect()
}

/// Anchors of a page's headings, as mdBook and forges make them.
fn anchors_of(page: &str) -> BTreeSet<String> {
    prose_lines(page)
        .filter_map(|(_, line)| line.strip_prefix('#'))
        .map(|rest| anchor(rest.trim_start_matches('#')))
        .collect()
}

/// The anchor of a heading: letters, digits, `-` and `_` in lower case, blanks as `-`.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter_map(|c| match c {
        c if c.is_whitespace() => Some('-'),
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
        _ => None,
    });
    kept.flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_and_headings_are_found_outside_of_code() {
        let page =
            "# A page\n[one](b.md#Two) and [two](../c.md)\n```sh\n# no heading [x](y)\n```\n## T̃(3,i), `loops`: why?\n";
        assert_eq!(links_of(page), [(2, "b.md#Two"), (2, "../c.md")]);
        let expected = ["a-page", "t3i-loops-why"].map(str::to_owned);
        assert_eq!(anchors_of(page), BTreeSet::from(expected));
        assert_eq!(resolve_link("docs/manual/a.md", "../SPEC.md"), "docs/SPEC.md");
    }

    #[test]
    fn chapters_that_do_not_lead_on_are_named() {
        let pages = [
            ("docs/manual/a.md", "# A\n\nNext: [B](b.md), more of it.\n"),
            ("docs/manual/b.md", "# B\n\nNext: [A](a.md), and\nmore.\n"),
            ("docs/manual/c.md", "# C\n"),
            ("docs/manual/notebooks/d.md", "# D\n"),
            ("docs/e.md", "# E\n"),
        ];
        let pages: BTreeMap<String, String> = pages.map(|(path, text)| (path.to_owned(), text.to_owned())).into();
        let found = dead_ends(&pages);
        assert!(found.len() == 2 && found[0].starts_with("docs/manual/b.md:4"), "{found:?}");
    }

    #[test]
    fn pages_and_anchors_that_are_missing_are_named() {
        let pages = [(SUMMARY, "[A](a.md)"), ("docs/a.md", "# A\n[b](b.md) [c](#c)"), ("docs/d.md", "")];
        let pages: BTreeMap<String, String> = pages.map(|(path, text)| (path.to_owned(), text.to_owned())).into();
        assert_eq!(unlisted_pages(&pages), [format!("{SUMMARY}: lists docs/d.md 0 times instead of once")]);
        let of = |link| problem_of_link("docs/a.md", link, &pages).unwrap_or_default();
        assert!(of("b.md").contains("there is no docs/b.md"), "{}", of("b.md"));
        // This page exists in the workspace.
        assert_eq!(problem_of_link("docs/manual/a.md", "../SPEC.md", &pages), None);
    }
}
