//! Draws mistakes under their lines.

use std::fmt;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::{Mistake, SourceFile};

/// Mistakes beyond this number are counted, not drawn.
const MAX_DRAWN: usize = 100;
/// A line longer than this is cut around the mistake, bytes.
const MAX_LINE: usize = 400;

/// Writes every mistake with file, line, column, the offending line, label and help, then their number; with the colours of a terminal
/// on request.
pub(super) fn draw(source: &SourceFile, mistakes: &[Mistake], coloured: bool, f: &mut impl fmt::Write) -> fmt::Result {
    let renderer = if coloured { Renderer::styled() } else { Renderer::plain() };
    for mistake in mistakes.iter().take(MAX_DRAWN) {
        draw_one(&renderer, source, mistake, f)?;
        f.write_str("\n\n")?;
    }
    let word = if mistakes.iter().any(Mistake::is_warning) { "warning" } else { "mistake" };
    match mistakes.len() {
        1 => write!(f, "{}: 1 {word}", source.name),
        n if n > MAX_DRAWN => write!(f, "{}: {n} {word}s, of which {} are not shown", source.name, n - MAX_DRAWN),
        n => write!(f, "{}: {n} {word}s", source.name),
    }
}

fn draw_one(renderer: &Renderer, source: &SourceFile, mistake: &Mistake, f: &mut impl fmt::Write) -> fmt::Result {
    let start = source.boundary(mistake.span.start);
    let line = source.line(start);
    let first = source.boundary(line.start.max(start.saturating_sub(MAX_LINE / 2)));
    let last = source.boundary(line.end.min(start + MAX_LINE / 2));
    // A span longer than its line, such as that of a block, is drawn up to the end of the line.
    let end = source.boundary(mistake.span.end).clamp(start, last);
    let (number, _) = source.position(start);
    let shown = harmless(&source.text[first..last]);
    let snippet = Snippet::source(shown.as_str())
        .line_start(number)
        .path(source.part(start).name)
        .annotation(AnnotationKind::Primary.span(start - first..end - first).label(&mistake.label));
    let level = if mistake.is_warning() { Level::WARNING } else { Level::ERROR };
    let report = level
        .primary_title(&mistake.title)
        .id(mistake.code)
        .element(snippet)
        .element(Level::HELP.message(&mistake.help));
    f.write_str(&renderer.render(&[report]))
}

/// The text with visible replacements for characters that a terminal would execute (C1 controls) or that change the writing
/// direction. Each replacement has the same number of bytes, so that locations stay valid.
fn harmless(text: &str) -> String {
    let shown = |c: char| match c {
        '\u{80}'..='\u{9f}' => '¿',
        '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        other => other,
    };
    text.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excerpts_hold_nothing_that_a_terminal_obeys() {
        let text = "a\u{9b}31m b\u{202e}c é";
        let shown = harmless(text);
        assert_eq!(shown, "a¿31m b\u{fffd}c é");
        assert_eq!(shown.len(), text.len());
    }
}
