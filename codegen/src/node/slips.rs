//! Slips that are common enough to be recognised: decimal commas, entries of lists without a dash, tabs, keys of earlier versions.

use super::tree::{Content, Node};
use crate::diagnostic::{Mistake, Span, rule};

/// The numbers that a text with commas may mean: with a comma for decimals, or for thousands.
fn without_commas(text: &str) -> Vec<String> {
    let (sign, digits) = text.strip_prefix('-').map_or(("", text), |digits| ("-", digits));
    let groups: Vec<&str> = digits.split(',').collect();
    let are_digits = |text: &&str| !text.is_empty() && text.len() < 20 && text.bytes().all(|b| b.is_ascii_digit());
    if groups.len() < 2 || !groups.iter().all(are_digits) {
        return Vec::new();
    }
    let are_thousands = groups[0].len() <= 3 && !groups[0].starts_with('0') && groups[1..].iter().all(|g| g.len() == 3);
    let thousands = are_thousands.then(|| format!("{sign}{}", groups.concat()));
    let decimals = (groups.len() == 2).then(|| format!("{sign}{}.{}", groups[0], groups[1]));
    thousands.into_iter().chain(decimals).collect()
}

/// What to write instead of a text that is a number with commas.
pub(crate) fn number_with_commas(content: &Content) -> Option<String> {
    let Content::Text(text) = content else { return None };
    match without_commas(text).as_slice() {
        [] => None,
        [number] if number.contains('.') => Some(format!("`{number}`, with a decimal point")),
        [number] => Some(format!("`{number}`, without commas")),
        [thousands, decimals, ..] => {
            Some(format!("`{thousands}` or `{decimals}`, whichever it is: a comma can mean either"))
        }
    }
}

/// Digits as they are written, with leading zeros; `None` unless they can follow a decimal comma.
fn digits(node: &Node) -> Option<String> {
    let Content::Number(number) = node.content else { return None };
    let width = node.span.end.saturating_sub(node.span.start);
    (number >= 0.0 && number.is_sign_positive() && number.fract() == 0.0 && number < 1e15)
        .then(|| format!("{number:0width$}"))
        .filter(|digits| digits.len() == width)
}

/// Help for a key that is the decimals of the value before it: in `{mass: 50,5}`, the comma ends the number.
pub(crate) fn decimals_as_key(before: Option<&Node>, key: &Node, value: &Node) -> Option<String> {
    let (Content::Number(whole), Content::Null) = (&before?.content, &value.content) else { return None };
    let fraction = digits(key).filter(|_| whole.fract() == 0.0)?;
    let meant: Vec<String> = without_commas(&format!("{whole},{fraction}")).iter().map(|n| format!("`{n}`")).collect();
    (!meant.is_empty())
        .then(|| format!("did you mean {}? Write decimals with a point, not a comma", meant.join(" or ")))
}

/// Help for a list with too many items, if these may come from decimal commas: `[0,02, 0, 0,7]`.
pub(crate) fn decimals_as_items(items: &[Node], length: usize) -> Option<String> {
    let is_split = |pair: &[Node]| {
        matches!(pair, [whole, fraction] if whole.span.end + 1 == fraction.span.start
            && matches!(whole.content, Content::Number(number) if number.fract() == 0.0)
            && digits(fraction).is_some())
    };
    if items.len() <= length || !items.windows(2).any(is_split) {
        return None;
    }
    let number = |node: &Node| match node.content {
        Content::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let (mut joined, mut rest) = (Vec::new(), items);
    while let [first, others @ ..] = rest {
        let split = rest.get(..2).is_some_and(is_split);
        // Without spaces between the items, it is not clear which of them belong together.
        if split && rest.get(1..3).is_some_and(is_split) {
            joined.clear();
            break;
        }
        joined.push(match others {
            [fraction, ..] if split => format!("{}.{}", number(first)?, digits(fraction)?),
            _ => number(first)?,
        });
        rest = &others[usize::from(split)..];
    }
    Some(if joined.len() == length {
        format!("a comma separates items: write `[{}]`, with decimal points", joined.join(", "))
    } else {
        format!("write {length} items; a comma separates items, so write decimals with a point: 0.02, not 0,02")
    })
}

/// Keys that the language had, each with the key that took its place and what to do.
const REMOVED: &[(&str, &str, &str)] = &[(
    "full_hold",
    "friction_coefficient",
    "feet hold by friction now: remove `full_hold`, or write `friction_coefficient:`",
)];

/// Help for a key that the language had where it now has the given keys.
pub(crate) fn removed_key(name: &str, keys: &[&str]) -> Option<String> {
    let removed = REMOVED.iter().find(|(removed, new, _)| *removed == name && keys.contains(new));
    removed.map(|(_, _, help)| (*help).to_owned())
}

/// Splits entries of lists in which the first key returns on a line of its own, as the first of further keys: a dash is missing there.
pub(crate) fn split_entries(node: &mut Node, list: &str, text: &str, mistakes: &mut Vec<Mistake>) {
    match &mut node.content {
        Content::Mapping(entries) => {
            for (key, value) in entries {
                split_entries(value, &key.key_text(), text, mistakes);
            }
        }
        Content::Sequence(items) => {
            *items =
                std::mem::take(items).into_iter().flat_map(|item| split_entry(item, list, text, mistakes)).collect();
            for item in items {
                split_entries(item, list, text, mistakes);
            }
        }
        _ => (),
    }
}

fn split_entry(item: Node, list: &str, text: &str, mistakes: &mut Vec<Mistake>) -> Vec<Node> {
    let Node { span, content: Content::Mapping(mut entries) } = item else { return vec![item] };
    let before = |key: &Node| {
        let text = text.get(..key.span.start).unwrap_or_default();
        text[text.rfind('\n').map_or(0, |end| end + 1)..].trim().to_owned()
    };
    let Some(first) = entries.first().filter(|(key, _)| before(key) == "-").map(|(key, _)| key.key_text()) else {
        return vec![Node { span, content: Content::Mapping(entries) }];
    };
    let mut parts = Vec::new();
    loop {
        let begins = |(index, (key, _)): &(usize, &(Node, Node))| {
            *index > 1 && *index + 1 < entries.len() && key.key_text() == first && before(key).is_empty()
        };
        let Some(index) = entries.iter().enumerate().find(begins).map(|(index, _)| index) else { break };
        let rest = entries.split_off(index);
        mistakes.push(rule::missing_dash(rest[0].0.span, &first, list));
        parts.push(std::mem::replace(&mut entries, rest));
    }
    parts.push(entries);
    let node = |entries: Vec<(Node, Node)>| {
        let start =
            if entries.first().is_some_and(|(key, _)| before(key).is_empty()) { entries[0].0.span } else { span };
        Node { span: start, content: Content::Mapping(entries) }
    };
    parts.into_iter().map(node).collect()
}

/// What to do about a text that is not YAML, and where, if the problem is a common one.
pub(crate) fn not_yaml(text: &str, span: Span, problem: &str) -> Mistake {
    /// Advice for problems that are none of the common ones.
    const ADVICE: &str =
        "check the indentation (spaces, not tabs), brackets and quotes of this line and the previous one";
    let begin = text.get(..span.start).unwrap_or_default().rfind('\n').map_or(0, |end| end + 1);
    let lines = text.get(begin..).unwrap_or_default().split_inclusive('\n').scan(begin, |at, line| {
        *at += line.len();
        Some((*at - line.len(), line))
    });
    // The parser stops at the end of the last sound value, which may be a line earlier.
    let near: Vec<(usize, &str)> = lines.filter(|(_, line)| !line.trim().is_empty()).take(2).collect();
    for (start, line) in &near {
        let indentation = &line[..line.len() - line.trim_start().len()];
        if let Some(tab) = indentation.find('\t') {
            let span = Span { start: start + tab, end: start + tab + 1 };
            return rule::not_yaml(span, "a tab is in the indentation", "indent with spaces, as the lines above");
        }
    }
    let here = near.first().map_or("", |(_, line)| line.trim_start());
    let in_list = problem.contains("'-' indicator") || (problem.contains("expected key") && here.starts_with("- "));
    let in_braces = problem.contains("simple key") && here.starts_with('{');
    let help = if in_list || in_braces {
        "begin every entry of a list with `-`, all in one column; one here or before lacks it, or stands in another column"
    } else {
        ADVICE
    };
    rule::not_yaml(span, problem, help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_mean_decimals_or_thousands() {
        for (text, meant) in [
            ("50,5", &["50.5"] as &[&str]),
            ("-0,25", &["-0.25"]),
            ("8,600", &["8600", "8.600"]),
            ("0,600", &["0.600"]),
            ("8,60", &["8.60"]),
            ("1,250,000", &["1250000"]),
            ("1,25,000", &[]),
            ("a,5", &[]),
            ("5,", &[]),
            ("5", &[]),
        ] {
            assert_eq!(without_commas(text), meant, "{text}");
        }
    }
}
