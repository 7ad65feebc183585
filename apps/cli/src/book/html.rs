//! The document: cover, contents, numbered sections, and what is not in it.

use crane_codegen::exchange::xml::escaped;

use super::{Content, Section};
use crate::compiled::quoted;

/// What stands on the cover, and at the foot of every page.
pub struct Cover {
    pub title: String,
    pub name: String,
    pub spec_hash: String,
}

/// A figure with a caption, or with the title that it has itself.
pub fn figure(svg: &str, caption: &str) -> String {
    let own = svg.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>")).map(|(title, _)| title);
    let own = own.map(|title| title.split(';').next().unwrap_or_default().trim().to_owned());
    let caption = if caption.is_empty() { own.unwrap_or_default() } else { escaped(caption) };
    let svg = svg.split_once("?>").map_or(svg, |(_, rest)| rest);
    format!("<figure class=\"drawn\">\n{svg}\n<figcaption>{caption}</figcaption>\n</figure>\n")
}

/// Before and behind a caution of a section.
const CAUTION: &str = "<p class=\"caution\">caution: ";
const END: &str = "</p>\n";

/// The command whose section has pages of its own, printed across: charts are wide.
const ACROSS: &str = "envelope";

/// The whole document.
pub fn page(cover: &Cover, sections: &[Section]) -> String {
    let shown: Vec<(&Section, &str)> = sections
        .iter()
        .filter_map(|section| match &section.content {
            Content::Shown(html) | Content::Failed(_, html) => Some((section, html.as_str())),
            Content::LeftOut(_) => None,
        })
        .collect();
    let last = shown.len() + 1;
    let line = |(number, (section, _)): (usize, &(&Section, &str))| {
        format!("<li><a href=\"#s{number}\">{number} {}</a></li>\n", section.title)
    };
    let contents = (1..).zip(&shown).map(line).collect::<Vec<_>>().concat();
    let body: String = (1..).zip(&shown).map(|(number, (section, html))| section_of(number, section, html)).collect();
    let Cover { title, name, spec_hash } = cover;
    let (title, short) = (escaped(title), spec_hash.chars().take(12).collect::<String>());
    let cautions = cautions_of(&shown);
    let rest = rest_of(last, sections);
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "<!doctype html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>{title}</title>
<style>
{STYLE}@page {{ @bottom-left {{ content: \"{name}, spec {short}\"; }} }}
</style>
</head>
<body>
<header>
<h1>{title}</h1>
<table class=\"facts\">
<tr><th scope=\"row\">crane</th><td>{name}</td></tr>
<tr><th scope=\"row\">hash of the spec</th><td>{spec_hash}</td></tr>
<tr><th scope=\"row\">program</th><td>crane {version}</td></tr>
</table>
<p>This document has what the program computed from the spec in section 2. Each section names the command that prints it again, and the hash
changes with every letter of the spec. Section {last} says what was left out. The document does not verify the crane by a standard: the one who
signs it decides which rules apply, and whether the spec describes the crane.</p>
{cautions}<table class=\"signed\">
<tr><th>computed by</th><th>checked by</th><th>date</th></tr>
<tr><td></td><td></td><td></td></tr>
</table>
<nav>
<h2>Contents</h2>
<ol>
{contents}<li><a href=\"#s{last}\">{last} What was left out</a></li>
</ol>
</nav>
</header>
{body}{rest}</body>
</html>
"
    )
}

/// A section with its heading and its command.
fn section_of(number: usize, section: &Section, html: &str) -> String {
    let Section { title, about, command, .. } = section;
    let words: Vec<String> = command.iter().map(|word| quoted(word)).collect();
    let command = match words.join(" ") {
        none if none.is_empty() => String::new(),
        words => format!("<p class=\"command\"><code>crane {}</code></p>\n", escaped(&words)),
    };
    let failed = match &section.content {
        Content::Failed(why, _) => format!("{CAUTION}{}{END}", escaped(why)),
        _ => String::new(),
    };
    let class = if section.command.iter().any(|word| word == ACROSS) { " class=\"across\"" } else { "" };
    format!(
        "<section id=\"s{number}\"{class}>\n<h2>{number} {title}</h2>\n<p>{about}</p>\n{command}{failed}{html}</section>\n"
    )
}

/// All cautions, with the sections in which they stand.
fn cautions_of(shown: &[(&Section, &str)]) -> String {
    let mut lines: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut failures: Vec<String> = Vec::new();
    for (number, (section, html)) in (1..).zip(shown) {
        if let Content::Failed(why, _) = &section.content {
            failures.push(format!("<li>not computed: {} (section {number})</li>\n", escaped(why)));
        }
        for rest in html.split(CAUTION).skip(1) {
            let words = rest.split(END).next().unwrap_or_default();
            match lines.iter_mut().find(|(known, _)| *known == words) {
                Some((_, numbers)) if numbers.contains(&number) => {}
                Some((_, numbers)) => numbers.push(number),
                None => lines.push((words, vec![number])),
            }
        }
    }
    if lines.is_empty() && failures.is_empty() {
        return String::from("<p>No section has a caution.</p>\n");
    }
    let items = lines.into_iter().map(|(words, numbers)| {
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        format!("<li>{words} (section {})</li>\n", numbers.join(", "))
    });
    let items: String = failures.into_iter().chain(items).collect();
    format!("<h2>Cautions</h2>\n<ul class=\"cautions\">\n{items}</ul>\n")
}

/// What is not in the document, with the reasons.
fn rest_of(number: usize, sections: &[Section]) -> String {
    let left_out = sections.iter().filter_map(|section| match &section.content {
        Content::LeftOut(why) => Some(format!("<li>{}: {}.</li>\n", section.title, escaped(why))),
        Content::Shown(_) | Content::Failed(..) => None,
    });
    let left_out: String = left_out.collect();
    format!(
        "<section id=\"s{number}\">
<h2>{number} What was left out</h2>
<ul>
{left_out}<li>Local stresses at welds, holes, pins and pads, plates that bulge, bolts and bearings: the program knows beams as a whole.</li>
<li>Wind, snow and earthquakes that the spec does not have as loads; slopes of the ground that it does not have as gravity.</li>
<li>The ground below the feet, beyond the stiffness and the friction that the spec gives it.</li>
</ul>
</section>
"
    )
}

/// For the screen and for A4.
const STYLE: &str = "\
:root { color-scheme: light; }
body { font: 10.5pt/1.45 'Liberation Sans', Arial, Helvetica, sans-serif; color: #1c2330; background: #fff; max-width: 178mm; margin: 10mm auto; counter-reset: tables figures; }
h1 { font-size: 22pt; margin: 0 0 6mm; overflow-wrap: anywhere; }
h2 { font-size: 14pt; margin: 9mm 0 2mm; break-after: avoid; }
h3 { font-size: 11pt; margin: 5mm 0 1mm; break-after: avoid; }
p { margin: 0 0 2.5mm; orphans: 3; widows: 3; }
a { color: inherit; }
nav ol { list-style: none; padding: 0; columns: 2; }
section > h2 + p, .command { break-after: avoid; }
.command, figcaption { break-inside: avoid; }
code, pre { font-family: 'Liberation Mono', 'DejaVu Sans Mono', monospace; font-size: 8.5pt; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; border: 0.3mm solid #d5d9e0; padding: 2mm 3mm; line-height: 1.3; }
table { border-collapse: collapse; font-size: 8.5pt; }
th, td { text-align: left; vertical-align: top; padding: 0.6mm 2.5mm 0.6mm 0; overflow-wrap: break-word; }
thead th { border-bottom: 0.3mm solid #1c2330; vertical-align: bottom; }
tbody tr { border-bottom: 0.15mm solid #d5d9e0; break-inside: avoid; }
thead { display: table-header-group; }
table.wide { font-size: 7pt; }
table.wide th, table.wide td { padding-right: 1.2mm; }
th.n, td.n { text-align: right; font-variant-numeric: tabular-nums; }
table.facts { margin: 0 0 4mm; }
table.facts th { font-weight: normal; color: #4a5568; padding-right: 5mm; }
table.signed { width: 100%; margin: 8mm 0; table-layout: fixed; }
table.signed td { height: 14mm; border: 0.3mm solid #8a93a3; }
figure { margin: 5mm 0; }
figure.drawn { break-inside: avoid; }
figure.drawn svg { max-width: 100%; max-height: 105mm; height: auto; }
figcaption { font-size: 9pt; margin: 1mm 0; break-after: avoid; }
figure.drawn figcaption { break-before: avoid; }
figure.table figcaption { counter-increment: tables; }
figure.table figcaption::before { content: 'Table ' counter(tables) '. '; font-weight: bold; }
figure.drawn figcaption { counter-increment: figures; }
figure.drawn figcaption::before { content: 'Figure ' counter(figures) '. '; font-weight: bold; }
.caution, .cautions { color: #8a3b00; }
.more { font-size: 8.5pt; color: #4a5568; }
@page { size: A4; margin: 18mm 16mm 20mm; @bottom-right { content: counter(page) ' of ' counter(pages); } }
@page across { size: A4 landscape; margin: 16mm 18mm; }
@media print {
  body { margin: 0; max-width: none; }
  section.across { page: across; columns: 2; column-gap: 10mm; line-height: 1.25; }
  section.across > h2, section.across > p, section.across > figure.drawn:first-of-type, section.across > figure:has(table.wide) { column-span: all; }
  section.across > figure.drawn:first-of-type svg { max-height: 120mm; width: 100%; }
  section.across > :is(table, figure.table) :is(th, td) { padding-top: 0.3mm; padding-bottom: 0.3mm; }
}
";
