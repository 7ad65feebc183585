//! What a page shows of the output of its commands, compared with what they print.
//!
//! Lines are compared word by word, in order; `…` stands for any words, alone on a line for any lines. A message, `caution: …`, may go on over several
//! lines of the page. What is printed besides may be left out, but no message.

/// How messages begin.
const MESSAGES: [&str; 3] = ["error:", "caution:", "warning:"];
/// Beginnings of lines whose numbers another run does not repeat.
const TIMES: [&str; 2] = ["wall time", "real-time factor"];
/// Below this magnitude a number is rounding, such as a residual, and any other such number will do.
const ROUNDING: f64 = 1e-9;

/// A line of a page or of an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Line(Vec<String>);

impl Line {
    fn new(text: &str) -> Self {
        Self(text.split_whitespace().map(str::to_owned).collect())
    }

    /// Whether it is a message.
    fn is_message(&self) -> bool {
        self.0.first().is_some_and(|word| MESSAGES.contains(&word.as_str()))
    }

    /// Whether it is a message that a command failed.
    fn is_error(&self) -> bool {
        self.0.first().is_some_and(|word| word == MESSAGES[0])
    }

    /// Its words, with spaces between them.
    pub fn text(&self) -> String {
        self.0.join(" ")
    }

    /// Whether a page that shows this line shows a printed one.
    fn shows(&self, printed: &Line) -> bool {
        let is_time = TIMES.iter().any(|time| self.text().starts_with(time));
        if is_time {
            let label = |line: &Line| -> Vec<String> {
                line.0.iter().filter(|word| word.parse::<f64>().is_err()).cloned().collect()
            };
            return label(self) == label(printed);
        }
        are_alike(&self.0, &printed.0)
    }
}

/// Whether words are those of a pattern, in which `…` stands for any.
fn are_alike(pattern: &[String], words: &[String]) -> bool {
    match (pattern.split_first(), words.split_first()) {
        (None, None) => true,
        (Some((first, rest)), _) if first == "…" => {
            (0..=words.len()).any(|skipped| are_alike(rest, &words[skipped..]))
        }
        (Some((wanted, pattern)), Some((word, words))) => is_alike(wanted, word) && are_alike(pattern, words),
        _ => false,
    }
}

/// Whether two words are the same, or numbers that differ by no more than one unit of the last digit shown, as the rounding of another processor may make them.
fn is_alike(shown: &str, printed: &str) -> bool {
    let [shown, printed] = [shown, printed].map(|word| word.trim_matches(['(', ')', ',', ';', ':', '%']));
    let numbers = [shown, printed].map(|word| word.parse::<f64>().ok().filter(|number| number.is_finite()));
    match numbers {
        [Some(a), Some(b)] => (a - b).abs() <= 1.001 * last_digit(shown) || a.abs().max(b.abs()) < ROUNDING,
        _ => shown == printed,
    }
}

/// One unit of the last digit of a number.
fn last_digit(number: &str) -> f64 {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    format!("1e{}", exponent.parse::<i64>().unwrap_or(0) - i64::try_from(decimals).unwrap_or(0)).parse().unwrap_or(0.0)
}

/// The lines that a block shows: without empty ones, and with messages each in one.
pub fn lines_of(block: &str) -> Vec<Line> {
    let (mut lines, mut goes_on) = (Vec::<Line>::new(), false);
    for text in block.lines() {
        let line = Line::new(text);
        if line.0.is_empty() || line.0 == ["…"] {
            goes_on = false;
        } else if line.is_message() {
            goes_on = true;
            lines.push(line);
        } else if let Some(message) = lines.last_mut().filter(|_| goes_on) {
            message.0.extend(line.0);
        } else {
            lines.push(line);
        }
    }
    lines
}

/// The lines of an output.
pub fn printed_lines(output: &str) -> Vec<Line> {
    output.lines().map(Line::new).collect()
}

/// Shown lines that are not printed, in their order.
pub fn missing<'a>(shown: &'a [Line], printed: &[Line]) -> Vec<&'a Line> {
    let mut from = 0;
    let is_missing = |line: &&Line| match printed[from..].iter().position(|printed| line.shows(printed)) {
        Some(skipped) => {
            from += skipped + 1;
            false
        }
        None => true,
    };
    shown.iter().filter(is_missing).collect()
}

/// Printed messages that no line of a page shows.
pub fn unquoted<'a>(printed: &'a [Line], page: &[Line]) -> Vec<&'a Line> {
    printed.iter().filter(|line| line.is_message() && !page.iter().any(|shown| shown.shows(line))).collect()
}

/// Whether an output reports a failure.
pub fn fails(printed: &[Line]) -> bool {
    printed.iter().any(Line::is_error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_shown(shown: &str, printed: &str) -> bool {
        missing(&lines_of(shown), &printed_lines(printed)).is_empty()
    }

    #[test]
    fn numbers_agree_to_their_last_digit() {
        for (shown, printed) in [
            ("1.23 m", "1.24 m"),
            ("7.5e-5", "7.6e-5"),
            ("8400", "8401"),
            ("+5.51 %", "+5.50 %"),
            ("(3.5e-14)", "(-2e-13)"),
        ] {
            assert!(is_shown(shown, printed), "{shown} {printed}");
        }
        for (shown, printed) in
            [("1.23", "1.25"), ("7.5e-5", "7.7e-5"), ("8400", "8402"), ("3 m", "3 mm"), ("a 3", "a")]
        {
            assert!(!is_shown(shown, printed), "{shown} {printed}");
        }
    }

    #[test]
    fn lines_are_found_in_order_and_left_out_where_an_ellipsis_is() {
        let printed = "a 1\nb 2  x, …\nwall time 0.3 s\nc 3\n";
        assert!(is_shown("a 1\n…\n\nc   3\n", printed));
        assert!(is_shown("b 2 …\nwall time 0.9 s\n", printed));
        assert!(!is_shown("c 3\na 1\n", printed));
        assert!(!is_shown("a 1\nd\n", printed));
        assert!(!is_shown("wall time\n", printed));
    }

    #[test]
    fn messages_go_on_and_must_be_quoted() {
        let page = lines_of("caution: one\n  and two 3.0 kN\ncaution: feet …\n\nafter\n");
        assert_eq!(
            page.iter().map(Line::text).collect::<Vec<_>>(),
            ["caution: one and two 3.0 kN", "caution: feet …", "after"]
        );
        let printed =
            printed_lines("caution: one and two 3.1 kN\ncaution: feet of both\nwarning: other\ntext\nerror: none\n");
        let left: Vec<String> = unquoted(&printed, &page).into_iter().map(Line::text).collect();
        assert_eq!(left, ["warning: other", "error: none"]);
        assert!(fails(&printed) && !fails(&page));
    }
}
