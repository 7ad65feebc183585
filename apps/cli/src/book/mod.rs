//! `crane book`: a crane, its spec and its results as one document to print.
//!
//! Each section is what a command prints, as `--format html` has it, under the command's words: a reader can compute it again.

mod html;

use std::{fs, io::Write, path::Path};

use clap::CommandFactory;
use crane_codegen::{SourceFile, chain::Chain, exchange::xml::escaped};
use crane_live::LiveCrane;
use crane_model::results::cautions::BEND;
use crane_page::diagram::diagram;

use crate::{
    arguments::{self, Arguments, Book},
    compiled::quoted,
    problem::{FAILED, Outcome, Problem},
    selection::Registry,
};

/// A section of the book, or why it is not there.
struct Section {
    title: &'static str,
    /// What it is for.
    about: &'static str,
    /// The words of the command that prints it; empty for a section that no command prints.
    command: Vec<String>,
    content: Content,
}

enum Content {
    /// HTML.
    Shown(String),
    /// Why it is not there, and what to write for it.
    LeftOut(String),
    /// Why it could not be computed, and what was printed before.
    Failed(String, String),
}

/// What does what arguments ask for.
type Dispatch = fn(&Arguments, &Registry, &mut dyn Write) -> Outcome<()>;

/// Computes all sections and writes the document; `dispatch` prints each.
pub fn book(options: &Book, registry: &Registry, dispatch: Dispatch, out: &mut dyn Write) -> Outcome<()> {
    for text in options.chart.iter().chain(&options.fatigue) {
        check_options(text)?;
    }
    let crane = options.crane.open(registry)?;
    let live = registry.live(crane.as_ref())?;
    let chain = live.chain();
    let binder = Binder { options, registry, live: &live, chain, dispatch };
    let mut sections = vec![binder.crane()?, binder.spec()];
    for asked in binder.asked() {
        registry.console.remark(&format!("{}: {}", sections.len() + 1, asked.title));
        sections.push(binder.computed(asked)?);
    }
    registry.console.write_text(&options.file, &html::page(&binder.cover(), &sections))?;
    writeln!(out, "{} written: open it in a browser and print it", options.file.display())?;
    let failed = sections.iter().find_map(|section| match &section.content {
        Content::Failed(why, _) => Some(format!("{}: {why}", section.title)),
        _ => None,
    });
    failed.map_or(Ok(()), |why| Err(Problem::failed(why, "the book says so on its cover")))
}

/// A section that a command computes.
struct BookRequest {
    title: &'static str,
    about: &'static str,
    /// The command and its options; why not, if there is nothing to compute.
    command: Result<String, &'static str>,
}

/// Computes sections.
struct Binder<'a> {
    options: &'a Book,
    registry: &'a Registry,
    live: &'a LiveCrane,
    chain: &'a Chain,
    dispatch: Dispatch,
}

impl Binder<'_> {
    /// Title, name, hash and program.
    fn cover(&self) -> html::Cover {
        let Chain { title, name, spec_hash, .. } = self.chain;
        html::Cover { title: title.clone(), name: name.clone(), spec_hash: spec_hash.clone() }
    }

    /// What is asked for, in order.
    fn asked(&self) -> Vec<BookRequest> {
        let Self { options: Book { run, chart, fatigue, folder, .. }, chain, .. } = self;
        let when = |holds: bool, command: &str, otherwise| if holds { Ok(command.to_owned()) } else { Err(otherwise) };
        let given = |options: &Option<String>, command: &str, otherwise| {
            options.as_ref().map(|options| format!("{command} {options}")).ok_or(otherwise)
        };
        let out = quoted(&folder.out.display().to_string());
        let bends = !chain.beams.is_empty();
        let moves = !chain.drives.is_empty();
        vec![
            BookRequest {
                title: "The crane at rest",
                about: "Where the crane rests with its drives at the beginning of their motions, and what drives, feet and cylinders carry.",
                command: Ok("statics".to_owned()),
            },
            BookRequest {
                title: "Strength and tipping",
                about: "Stresses of beams at every place where something acts on them, forces of joints, and how far the crane is from tipping.",
                command: Ok(
                    ["strength", if bends { " --buckling" } else { "" }, if *run { " --run" } else { "" }].concat()
                ),
            },
            BookRequest {
                title: "Combinations of weights and loads",
                about: "The same with the partial factors of every combination of the spec, and which of them governs each part.",
                command: self.combinations(),
            },
            BookRequest {
                title: "Load chart",
                about: "The largest load within all limits, pose by pose.",
                command: given(
                    chart,
                    &format!("envelope --out {out}"),
                    "it needs the poses: add `--chart \"--range DRIVE=FROM:TO:COUNT\"`",
                ),
            },
            BookRequest {
                title: "Frequencies and damping",
                about: "Small vibrations about the pose at rest.",
                command: Ok("modes".to_owned()),
            },
            BookRequest {
                title: "The manoeuvre",
                about: "The motion from rest that the spec describes.",
                command: when(*run, &format!("simulate --out {out}"), "it was not asked for: add `--run`"),
            },
            BookRequest {
                title: "Fatigue",
                about: "Cycles of stress by the manoeuvre, damage and life.",
                command: given(
                    fatigue,
                    "fatigue",
                    "it needs the number of cycles and the detail category: add `--fatigue \"--cycles NUMBER --category STRESS\"`",
                ),
            },
            BookRequest {
                title: "Sensitivity",
                about: "What moves the results, and by how much.",
                command: when(
                    !chain.parameters.is_empty() && moves,
                    "sensitivity",
                    "the spec has no live `parameters`, or no drive",
                ),
            },
        ]
    }

    /// The command for all combinations, or why there is none.
    fn combinations(&self) -> Result<String, &'static str> {
        match (
            self.options.crane.combination.as_ref().or(self.chain.combination.as_ref()),
            &self.chain.combinations[..],
        ) {
            (Some(_), _) => Err("the book is computed with one of them"),
            (None, []) => Err("the spec has none: add `combinations`"),
            _ => Ok("strength --combinations".to_owned()),
        }
    }

    /// What the crane consists of.
    fn crane(&self) -> Outcome<Section> {
        let drawn = html::figure(
            &diagram(self.live),
            "The crane as its spec describes it, in the undeformed pose of its guess",
        );
        let mut tables = Vec::new();
        self.print("info", &mut tables)?;
        Ok(Section {
            title: "The crane",
            about: "Its coordinates, bodies, supports and drives, as the program understood the spec.",
            command: self.shown("info")?,
            content: Content::Shown(drawn + &String::from_utf8_lossy(&tables)),
        })
    }

    /// The spec as it was written.
    fn spec(&self) -> Section {
        let name = &self.options.crane.name;
        let text = self.registry.spec(name).unwrap_or_default();
        let source = SourceFile::new(name, text);
        let parts = source.parts().into_iter().map(|part| {
            let name = Path::new(part.name).file_name().map_or(part.name.into(), |name| name.to_string_lossy());
            format!("<h3>{}</h3>\n<pre class=\"spec\">{}</pre>\n", escaped(&name), escaped(part.text.trim_end()))
        });
        Section {
            title: "The spec",
            about: "All input, as it was written. Numbers without a unit are in SI units.",
            command: Vec::new(),
            content: Content::Shown(parts.collect()),
        }
    }

    /// A section by its command.
    fn computed(&self, asked: BookRequest) -> Outcome<Section> {
        let BookRequest { title, about, command } = asked;
        let section = |command: Vec<String>, content| Section { title, about, command, content };
        let command = match command {
            Ok(command) => command,
            Err(why) => return Ok(section(Vec::new(), Content::LeftOut(why.to_owned()))),
        };
        let mut printed = Vec::new();
        let content = match self.print(&command, &mut printed) {
            Ok(()) => {
                let tables = String::from_utf8_lossy(&printed).into_owned();
                Content::Shown(self.figures(&tables)? + &tables)
            }
            // Where the crane does not rest, the book says so in place of its strength.
            Err(Problem::Message { title, code: FAILED, .. }) => {
                Content::Failed(title, String::from_utf8_lossy(&printed).into_owned())
            }
            Err(problem) => return Err(problem),
        };
        Ok(section(self.shown(&command)?, content))
    }

    /// The words of a command as a reader would write it.
    fn shown(&self, command: &str) -> Outcome<Vec<String>> {
        let crane = &self.options.crane;
        let mut command = words_of(command)?.into_iter();
        let mut words: Vec<String> = command.next().into_iter().collect();
        words.push(self.registry.word_for(&crane.name));
        words.extend(crane.rigid.then(|| "--rigid".to_owned()));
        words.extend(crane.combination.iter().flat_map(|name| ["--combination".to_owned(), name.clone()]));
        words.extend(numbers_of(self.options));
        words.extend(command);
        Ok(words)
    }

    /// Prints a command as a section of a page.
    fn print(&self, command: &str, out: &mut dyn Write) -> Outcome<()> {
        let mut words = vec!["crane".to_owned()];
        words.extend(self.shown(command)?);
        // The crane has been read, with its combination or with rigid beams; here the words are only checked.
        words[2].clone_from(&self.options.crane.name);
        words.extend(["--format".to_owned(), "html".to_owned()]);
        let arguments = parsed(&words)?;
        (self.dispatch)(&arguments, self.registry, out)
    }

    /// The figures among the files that a section lists as written.
    fn figures(&self, tables: &str) -> Outcome<String> {
        let mut shown = String::new();
        for name in tables.split("<td>").filter_map(|cell| Some(cell.split_once("</td>")?.0)) {
            if Path::new(name).extension().is_none_or(|extension| extension != "svg") {
                continue;
            }
            let file = self.options.folder.out.join(name);
            let drawn = fs::read_to_string(&file).map_err(|error| Problem::file(&file, &error))?;
            shown += &html::figure(&drawn, "");
        }
        Ok(shown)
    }
}

/// A command, its crane and options that were given as words of an option.
pub fn parsed(words: &[String]) -> Outcome<Arguments> {
    arguments::read(Arguments::command(), words).map_err(|error| {
        let text = error.to_string();
        let lines = text.lines().take_while(|line| !line.is_empty()).map(str::trim);
        let title = lines.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned();
        let begin = words[..words.len().min(2)].join(" ");
        Problem::usage(title, format!("these are options of `{begin}`: see `{begin} --help`"))
    })
}

/// Options that belong to the document as a whole.
const OWN: [&str; 8] = ["--combination", "--compile", "--format", "--help", "--out", "--rigid", "-h", "-o"];

/// Refuses what is not for a section among its options.
pub fn check_options(options: &str) -> Outcome<()> {
    let words = words_of(options)?;
    match words.iter().find(|word| OWN.contains(&word.split('=').next().unwrap_or_default())) {
        Some(own) => {
            let title = format!("`{own}` is not for a single section");
            Err(Problem::usage(title, "leave it out, or give it to the command itself if it has this option"))
        }
        None => Ok(()),
    }
}

/// The options of the command that change numbers of the crane.
fn numbers_of(options: &Book) -> Vec<String> {
    let crane = &options.crane;
    let each = |option: &'static str, values: &[String]| -> Vec<String> {
        values.iter().flat_map(|value| [option.to_owned(), value.clone()]).collect()
    };
    let bend = crane.limits.bend;
    let limits = if bend.total_cmp(&BEND).is_ne() { vec!["--bend-limit".to_owned(), bend.to_string()] } else { vec![] };
    [each("--set", &crane.parameters.settings), each("--input", &crane.inputs), limits].concat()
}

/// Words of a command, separated by blanks outside of quotation marks.
pub fn words_of(command: &str) -> Outcome<Vec<String>> {
    let (mut words, mut word, mut quote): (Vec<String>, Option<String>, Option<char>) = (Vec::new(), None, None);
    for letter in command.chars() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '"' | '\'') => (quote, word) = (Some(letter), Some(word.unwrap_or_default())),
            (None, _) if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    if let Some(open) = quote {
        return Err(Problem::usage(format!("`{command}` has no second {open}"), "close the quotation"));
    }
    words.extend(word);
    Ok(words)
}
