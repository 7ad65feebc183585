//! Sentences of the manual that are too long to be read once.

use crate::{book, manual, workspace};

/// Most words of a sentence. Code between backticks counts as one word, a formula by its words.
const MOST_WORDS: usize = 35;
/// Pages besides the chapters of docs/manual. Pages for developers and pages that a program writes are left out.
const PAGES: [&str; 7] = [
    "README.md",
    "docs/README.md",
    "docs/SPEC.md",
    "docs/messages.md",
    "docs/LIMITS.md",
    "docs/NOTATION.md",
    "docs/EQUATIONS.md",
];

/// Every long sentence.
pub fn find_long() -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    let chapters = manual::chapters_of(&workspace::read_file(manual::SUMMARY)?);
    for page in PAGES.map(str::to_owned).into_iter().chain(chapters) {
        for (line, words, sentence) in long_sentences(&workspace::read_file(&page)?) {
            found.push(format!("{page}:{line}: {words} words, at most {MOST_WORDS}: {sentence}"));
        }
    }
    Ok(found)
}

/// Sentences of a page with too many words: the line where their paragraph begins, their words, and they themselves.
fn long_sentences(page: &str) -> Vec<(usize, usize, String)> {
    let mut long = Vec::new();
    for (line, paragraph) in paragraphs_of(page) {
        let mut sentence: Vec<&str> = Vec::new();
        for word in paragraph.split_whitespace() {
            sentence.push(word);
            if word.trim_end_matches([')', '"', '*', ']']).ends_with(['.', '?', '!']) {
                long.extend(too_long(&sentence).map(|words| (line, words, sentence.join(" "))));
                sentence.clear();
            }
        }
        long.extend(too_long(&sentence).map(|words| (line, words, sentence.join(" "))));
    }
    long
}

/// The number of words of a sentence, if they are too many. Signs are not words.
fn too_long(sentence: &[&str]) -> Option<usize> {
    let words = sentence.iter().filter(|word| word.contains(|c: char| c.is_alphanumeric() || c == '`')).count();
    (words > MOST_WORDS).then_some(words)
}

/// Paragraphs and entries of lists, each on one line, with the line where they begin; without the code between backticks and the targets of links.
fn paragraphs_of(page: &str) -> Vec<(usize, String)> {
    let mut paragraphs: Vec<(usize, String)> = Vec::new();
    let mut last = 0;
    for (number, line) in book::sentence_lines(page) {
        let text = line.trim();
        let entry = text.strip_prefix("* ").or(text.strip_prefix("- ")).or(text
            .split_once(". ")
            .and_then(|(begin, rest)| begin.chars().all(|c| c.is_ascii_digit()).then_some(rest)));
        match paragraphs.last_mut() {
            Some((_, paragraph)) if entry.is_none() && number == last + 1 => {
                paragraph.push(' ');
                *paragraph += text;
            }
            _ => paragraphs.push((number, entry.unwrap_or(text).to_owned())),
        }
        last = number;
    }
    paragraphs.into_iter().map(|(number, text)| (number, without_targets(&without_code(&text)))).collect()
}

/// A text in which a word stands for each piece of code.
fn without_code(text: &str) -> String {
    text.split('`').enumerate().map(|(index, part)| if index % 2 == 0 { part } else { "``" }).collect()
}

/// A text without the targets of its links.
fn without_targets(text: &str) -> String {
    let mut parts = text.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |kept, part| kept + "]" + part.split_once(')').map_or("", |(_, rest)| rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_sentences_are_counted() {
        let words = |count: usize| vec!["word"; count].join(" ");
        let count_long =
            |page: &str| long_sentences(page).into_iter().map(|(line, words, _)| (line, words)).collect::<Vec<_>>();
        let short = format!("{}. {}! `a b c` {} [c d](e f).\n", words(35), words(35), words(32));
        assert_eq!(count_long(&short), []);
        assert_eq!(count_long(&format!("# Head\n\n{}\nend.\n", words(35))), [(3, 36)]);
        assert_eq!(count_long(&format!("* {}\n* {}, =\n\n{}\n", words(30), words(35), words(36))), [(4, 36)]);
        // Code, formulas, tables and pictures are not sentences, and end none.
        assert_eq!(count_long(&format!("```text\n{0}\n```\n| {0} |\n![{0}](a)\n    {0}\n", words(40))), []);
        assert_eq!(count_long(&format!("1. {} `a.` {}\n", words(18), words(18))), [(1, 37)]);
    }
}
