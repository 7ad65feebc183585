//! Specs that differ from shipped ones, or are written for a case.

use std::fmt::Write;

/// The text of a spec.
#[derive(Clone, Debug)]
pub struct Spec {
    /// The YAML.
    pub text: String,
    /// Words that a change did not find: the shipped spec is no longer what the case was written for.
    pub missing: Option<String>,
}

impl Spec {
    /// A spec as written.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), missing: None }
    }

    /// With other words in all places of some.
    pub fn with(mut self, words: &str, others: &str) -> Self {
        if !self.text.contains(words) {
            self.missing.get_or_insert_with(|| words.to_owned());
        }
        self.text = self.text.replace(words, others);
        self
    }

    /// With other words in the lines that hold a mark.
    pub fn on_line(mut self, mark: &str, words: &str, others: &str) -> Self {
        let hit = |line: &&str| line.contains(mark) && line.contains(words);
        if !self.text.lines().any(|line| hit(&line)) {
            self.missing.get_or_insert_with(|| format!("{mark} … {words}"));
        }
        let lines =
            self.text.lines().map(|line| if hit(&line) { line.replace(words, others) } else { line.to_owned() });
        self.text = lines.collect::<Vec<_>>().join("\n") + "\n";
        self
    }

    /// Without the lines that hold a mark.
    pub fn without(mut self, mark: &str) -> Self {
        if !self.text.contains(mark) {
            self.missing.get_or_insert_with(|| mark.to_owned());
        }
        let lines: Vec<&str> = self.text.lines().filter(|line| !line.contains(mark)).collect();
        self.text = lines.join("\n") + "\n";
        self
    }

    /// With all numbers of a key multiplied, in the section of the top level that begins with `section`.
    pub fn scaled(mut self, section: &str, key: &str, factor: f64) -> Self {
        let mut within = false;
        let mut found = false;
        let mut text = String::new();
        for line in self.text.lines() {
            if line.starts_with(|c: char| c.is_ascii_alphabetic()) {
                within = line.starts_with(section);
            }
            match line.split_once(key).filter(|_| within) {
                Some((before, after)) => {
                    found = true;
                    let _ = writeln!(text, "{before}{key}{}", multiplied(after, factor));
                }
                None => {
                    let _ = writeln!(text, "{line}");
                }
            }
        }
        if !found {
            self.missing.get_or_insert_with(|| format!("{section} … {key}"));
        }
        self.text = text;
        self
    }
}

/// The number or the list of numbers at the beginning of a text, multiplied.
fn multiplied(text: &str, factor: f64) -> String {
    let end = if text.trim_start().starts_with('[') {
        text.find(']').unwrap_or(text.len())
    } else {
        text.find([',', '}', '#']).unwrap_or(text.len())
    };
    let (numbers, rest) = text.split_at(end);
    let part = |part: &str| {
        let (bracket, number) = part.split_at(part.find(|c: char| c.is_ascii_digit()).unwrap_or(0));
        number
            .trim()
            .parse::<f64>()
            .map_or_else(|_| part.to_owned(), |number| format!("{bracket}{:e}", number * factor))
    };
    numbers.split(',').map(part).collect::<Vec<_>>().join(",") + rest
}
