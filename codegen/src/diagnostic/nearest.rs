//! The most similar valid word.

/// Help that names the most similar of the valid words, or all of them if none is similar.
pub(crate) fn suggest<'a>(word: &str, offered: impl IntoIterator<Item = &'a str>) -> String {
    suggest_among(word, &offered.into_iter().collect::<Vec<_>>())
}

fn suggest_among(word: &str, offered: &[&str]) -> String {
    /// More words than this are not listed.
    const MOST: usize = 16;
    match nearest(word, offered.iter().copied()) {
        Some(known) => format!("did you mean `{known}`?"),
        None if offered.is_empty() => "none is defined".into(),
        None if offered.len() <= MOST => format!("write one of {}", list(offered)),
        None => format!("write one of {}, ...", list(&offered[..MOST])),
    }
}

/// The most similar of the valid words, if one is similar: at most a third of the letters of `word` are wrong.
pub fn nearest<'a>(word: &str, offered: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A longer word may contain more typing errors.
    let tolerance = (word.chars().count() / 3).max(1);
    let by_distance = offered.into_iter().map(|known| (distance(word, known), known));
    by_distance
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, _)| *distance <= tolerance)
        .map(|(_, known)| known)
}

/// The most similar of the valid words, or else the first that contains the word.
pub fn similar<'a>(word: &str, offered: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let offered: Vec<&str> = offered.into_iter().collect();
    let contains = |known: &&str| !word.is_empty() && known.contains(word);
    nearest(word, offered.iter().copied()).or_else(|| offered.iter().copied().find(contains))
}

/// A list of words: `a`, `b`, `c`.
pub(crate) fn list(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// Edit distance of two words, ignoring case: insertions, deletions, replacements, and swaps of neighbours.
fn distance(a: &str, b: &str) -> usize {
    /// No name is longer; a file of one huge word must not take quadratic time.
    const LONGEST: usize = 64;
    let letters = |word: &str| word.chars().take(LONGEST).flat_map(char::to_lowercase).collect::<Vec<_>>();
    let (a, b) = (letters(a), letters(b));
    let mut table = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            table[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = table[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let edited = replaced.min(table[i - 1][j] + 1).min(table[i][j - 1] + 1);
                let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                if swapped { edited.min(table[i - 2][j - 2] + 1) } else { edited }
            };
        }
    }
    table[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_slips() {
        for (a, b, slips) in [("mass", "mass", 0), ("masss", "mass", 1), ("mas", "mass", 1), ("msas", "mass", 1)] {
            assert_eq!(distance(a, b), slips, "{a} {b}");
        }
        assert_eq!(distance("density", "Density"), 0);
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn a_far_word_gets_the_list() {
        assert_eq!(suggest("jont", ["name", "joint"]), "did you mean `joint`?");
        assert_eq!(suggest("colour", ["name", "joint"]), "write one of `name`, `joint`");
    }
}
