//! The glossary of the manual: each term is defined and says where it is explained, and where a page that teaches uses it first, it links there.

use std::collections::BTreeMap;

use crate::{book, manual, workspace};

const GLOSSARY: &str = "docs/manual/glossary.md";
/// Parts of the manual, as headings of its list of pages, whose pages teach.
const TEACHING: [&str; 2] = ["Learn", "Understand"];

/// A term, and the pages that explain it.
#[derive(Debug, PartialEq)]
struct Term {
    name: String,
    homes: Vec<String>,
}

/// Every term without an explanation, and every first use of one without a link.
pub fn check_glossary() -> Result<(), String> {
    let terms = terms_of(&workspace::read_file(GLOSSARY)?);
    if terms.is_empty() {
        return Err(format!("{GLOSSARY}: no terms found"));
    }
    let homeless = terms.iter().filter(|term| term.homes.is_empty());
    let mut wrong: Vec<String> =
        homeless.map(|term| format!("{GLOSSARY}: {}: link to the page that explains it", term.name)).collect();
    for page in teaching_pages(&workspace::read_file(manual::SUMMARY)?) {
        let text = workspace::read_file(&page)?;
        wrong.extend(unlinked(&page, &text, &terms).into_iter().map(|problem| format!("{page}: {problem}")));
    }
    if wrong.is_empty() { Ok(()) } else { Err(format!("\n{}", wrong.join("\n"))) }
}

/// Terms of a glossary, longest first: `mode` is not used where `loop mode` stands.
fn terms_of(glossary: &str) -> Vec<Term> {
    let entries = glossary.split("\n### ").skip(1).filter_map(|entry| entry.split_once('\n'));
    let links = |text| book::links_of(text).into_iter().map(|(_, link)| book::resolve_link(GLOSSARY, file_of(link)));
    let term = |(name, text): (&str, _)| Term { name: name.trim().to_lowercase(), homes: links(text).collect() };
    let mut terms: Vec<Term> = entries.map(term).collect();
    terms.sort_by_key(|term| std::cmp::Reverse(term.name.len()));
    terms
}

/// The file to which a link leads.
fn file_of(link: &str) -> &str {
    link.split('#').next().unwrap_or(link)
}

/// Chapters of the manual in the parts that teach.
fn teaching_pages(summary: &str) -> Vec<String> {
    let parts = summary.split("\n# ").filter(|part| TEACHING.iter().any(|name| part.starts_with(name)));
    parts.flat_map(manual::chapters_of).collect()
}

/// Terms that a page uses first without a link to the glossary or to where they are explained.
fn unlinked(page: &str, text: &str, terms: &[Term]) -> Vec<String> {
    let (mut prose, links) = prose_and_links(text);
    let mut missing = Vec::new();
    for term in terms {
        let uses = uses_of(&prose, &term.name);
        let Some(&first) = uses.first() else { continue };
        let end = first + term.name.len();
        let leads_there = |link: &str| {
            let file = book::resolve_link(page, file_of(link));
            file == GLOSSARY || term.homes.contains(&file)
        };
        let is_linked =
            links.range(..=first).next_back().is_some_and(|(_, (close, link))| end <= *close && leads_there(link));
        if !is_linked && !term.homes.iter().any(|home| home == page) {
            let context: String = prose[..end].chars().rev().take(60).collect();
            let context: String = context.chars().rev().collect();
            missing.push(format!("`{}` is used first in `…{context}`: link it to {GLOSSARY}", term.name));
        }
        for start in uses {
            prose.replace_range(start..start + term.name.len(), &" ".repeat(term.name.len()));
        }
    }
    missing
}

/// Sentences of a page on one line in small letters, without headings, tables and code; and its links: from where to where in it, and their target.
fn prose_and_links(text: &str) -> (String, BTreeMap<usize, (usize, String)>) {
    let lines: Vec<&str> = book::sentence_lines(text).map(|(_, line)| line.trim()).collect();
    let joined = lines.join(" ").to_ascii_lowercase();
    let outside_of_code = joined.split('`').step_by(2).collect::<Vec<_>>().join("_");
    let (mut prose, mut links) = (String::new(), BTreeMap::new());
    let mut rest = outside_of_code.as_str();
    while let Some((before, after)) = rest.split_once('[') {
        prose += before;
        let Some((words, target)) = after.split_once("](").filter(|(words, _)| !words.contains(']')) else {
            rest = after;
            continue;
        };
        let start = prose.len();
        prose += words;
        let (target, after) = target.split_once(')').unwrap_or((target, ""));
        links.insert(start, (prose.len(), target.to_owned()));
        rest = after;
    }
    (prose + rest, links)
}

/// Where a term stands as a whole word, or in the plural.
fn uses_of(prose: &str, term: &str) -> Vec<usize> {
    let is_letter = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    let is_whole = |start: &usize| {
        let after = &prose[start + term.len()..];
        let after = after.strip_prefix('s').unwrap_or(after);
        !prose[..*start].ends_with(is_letter) && !after.starts_with(is_letter)
    };
    prose.match_indices(term).map(|(start, _)| start).filter(is_whole).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_uses_are_linked_unless_the_page_explains_the_term() {
        let terms = terms_of(
            "# Glossary\n\n### Mode\nA shape. See [A](a.md#x).\n\n### Rigid mode\nNo shape. See [B](../B.md).\n",
        );
        let names: Vec<&str> = terms.iter().map(|term| term.name.as_str()).collect();
        assert_eq!(names, ["rigid mode", "mode"]);
        assert_eq!(terms[1].homes, ["docs/manual/a.md"]);
        let missing = |page: &str, text: &str| unlinked(page, text, &terms).len();
        let page = "docs/manual/c.md";
        for linked in [
            "[Modes](glossary.md#mode) are modes.",
            "A [first mode](a.md) and `mode`.",
            "# Mode\n| mode |\nmodel, commode, _mode",
        ] {
            assert_eq!(missing(page, linked), 0, "{linked}");
        }
        for bare in ["Modes.", "A mode, then a [mode](a.md).", "A [mode](d.md).", "A rigid\nmode [x](a.md)", "`a` mode"]
        {
            assert_eq!(missing(page, bare), 1, "{bare}");
        }
        assert_eq!(missing("docs/manual/a.md", "A mode."), 0);
    }

    #[test]
    fn pages_that_teach_are_those_of_two_parts() {
        let summary = "# M\n[A](README.md)\n\n# Learn\n* [A](manual/a.md)\n# Do\n* [B](manual/b.md)\n# Understand\n* [C](manual/c.md)\n* [D](D.md)\n";
        assert_eq!(teaching_pages(summary), ["docs/manual/a.md", "docs/manual/c.md"]);
    }
}
