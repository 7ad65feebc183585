//! Writes indented XML: elements, attributes, comments.

use std::fmt::Write;

/// A document under construction.
pub struct Xml {
    text: String,
    open: Vec<&'static str>,
}

/// Attributes of an element, in order.
pub type Attributes<'a> = &'a [(&'a str, String)];

impl Xml {
    /// A document with a comment before its root.
    #[must_use]
    pub fn new(comment: &str) -> Self {
        let mut xml = Xml { text: "<?xml version=\"1.0\"?>\n".to_owned(), open: Vec::new() };
        xml.comment(comment);
        xml
    }

    /// A comment; it must not contain two consecutive hyphens.
    pub fn comment(&mut self, text: &str) {
        let text = text.replace("--", "\u{2013}");
        self.line(&format!("<!-- {text} -->"));
    }

    /// Begins an element.
    pub fn open(&mut self, name: &'static str, attributes: Attributes) {
        let tag = tag(name, attributes);
        self.line(&format!("<{tag}>"));
        self.open.push(name);
    }

    /// Ends the innermost open element.
    pub fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            self.line(&format!("</{name}>"));
        }
    }

    /// An element without content.
    pub fn leaf(&mut self, name: &str, attributes: Attributes) {
        let tag = tag(name, attributes);
        self.line(&format!("<{tag}/>"));
    }

    /// The text, with all elements closed.
    #[must_use]
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn line(&mut self, line: &str) {
        let indent = 2 * self.open.len();
        let _ = writeln!(self.text, "{:indent$}{line}", "");
    }
}

fn tag(name: &str, attributes: Attributes) -> String {
    let written = attributes.iter().map(|(key, value)| format!(" {key}=\"{}\"", escaped(value)));
    format!("{name}{}", written.collect::<String>())
}

/// Text as XML has it, in elements and in attributes.
#[must_use]
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Numbers separated by blanks, each the shortest text that reads back as the same number.
#[must_use]
pub fn numbers(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(|number| number_text(*number)).collect();
    words.join(" ")
}

/// A number: integers without a fraction, no negative zero.
#[must_use]
pub fn number_text(number: f64) -> String {
    let text = format!("{:?}", number + 0.0);
    text.strip_suffix(".0").map_or(text.clone(), ToOwned::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_indented_and_text_is_escaped() {
        let mut xml = Xml::new("a -- b");
        xml.open("robot", &[("name", "\"x\" & <y>".to_owned())]);
        xml.leaf("link", &[]);
        let text = "<?xml version=\"1.0\"?>\n<!-- a \u{2013} b -->\n\
                    <robot name=\"&quot;x&quot; &amp; &lt;y>\">\n  <link/>\n</robot>\n";
        assert_eq!(xml.finish(), text);
        assert_eq!(numbers(&[1.0, -0.0, 0.1, 1e-20]), "1 0 0.1 1e-20");
    }
}
