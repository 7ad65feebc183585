//! The document that `crane book` writes: every section is what its command prints, in JSON as well.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::Value;

const COMBINED: &str = "extends: knuckle_boom
name: combined
combinations: [{name: lifting, weight: 1.1, masses: {payload: 1.3}}, {name: test, masses: {payload: 1.25}}]
";

fn crane(folder: &Path, arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    let output = command.current_dir(folder).args(arguments).output().expect("the command starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// The book of a crane, and the folder in which it is.
fn book(name: &str, arguments: &[&str]) -> (String, PathBuf) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("book_{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("combined.yaml"), COMBINED).expect("a file");
    crane(&folder, &[&["book", "--quiet", "--reproducible", "-o", "book.html"], arguments].concat());
    (fs::read_to_string(folder.join("book.html")).expect("a book"), folder)
}

/// The sections with a command: its words, and what stands below it.
fn sections(book: &str) -> Vec<(Vec<String>, &str)> {
    let bodies = book.split("<p class=\"command\"><code>crane ").skip(1);
    let section = |text| -> Option<(Vec<String>, &str)> {
        let (command, rest) = str::split_once(text, "</code></p>\n")?;
        let plain = command.replace("&quot;", "\"").replace('\'', "");
        let words = plain.split(' ').map(str::to_owned).collect();
        Some((words, rest.split_once("</section>")?.0))
    };
    bodies.filter_map(section).collect()
}

#[test]
fn every_section_is_what_its_command_prints() {
    let chart = ["--chart", "--range main_boom_theta=-40deg:0:3", "--run"];
    for (name, arguments, count) in [
        ("cantilever", &["cantilever"][..], 4),
        ("eight_link_rigid", &["eight_link_rigid", "--set", "load_mass=300", "--run"], 6),
        ("combined", &[&["combined.yaml"], &chart[..]].concat(), 8),
    ] {
        let (book, folder) = book(name, arguments);
        let sections = sections(&book);
        assert_eq!(sections.len(), count, "{name}");
        for (words, body) in sections {
            let mut command: Vec<&str> = words.iter().map(String::as_str).collect();
            command.extend(["--quiet", "--reproducible", "--format", "html"]);
            let printed = crane(&folder, &command);
            assert!(!printed.is_empty() && body.ends_with(&printed), "{words:?}:\n{printed}\nin the book:\n{body}");
        }
        // No text of the spec has ended an element, and nothing is asked for.
        for element in ["section", "table", "figure", "svg", "pre", "html"] {
            let opened = book.matches(&format!("<{element}>")).count() + book.matches(&format!("<{element} ")).count();
            assert_eq!(opened, book.matches(&format!("</{element}>")).count(), "{name}: {element}");
        }
        for reference in ["src=", "href=\"http", "url(", "@import", "<script"] {
            assert!(!book.contains(reference), "{name}: {reference}");
        }
    }
}

/// Of each foot, the vertical force of the JSON is a cell of the table.
#[test]
fn numbers_are_those_of_the_json() {
    let (book, folder) = book("numbers", &["eight_link_rigid"]);
    let json: Value =
        serde_json::from_str(&crane(&folder, &["statics", "eight_link_rigid", "--format", "json"])).expect("JSON");
    let (_, statics) = sections(&book).into_iter().find(|(words, _)| words[0] == "statics").expect("a section");
    let rows = json["reactions"].as_array().expect("a table");
    assert!(rows.len() > 8);
    for row in rows {
        let name = row["support"].as_str().expect("a name");
        let (_, cells) = statics.split_once(&format!("<td>{name}</td>")).expect("a row");
        let cells = cells.split_once("</tr>").expect("an end").0;
        let numbers: Vec<f64> = cells
            .split("<td class=\"n\">")
            .skip(1)
            .map(|cell| cell.split('<').next().and_then(|text| text.parse().ok()).expect("a number"))
            .collect();
        for (shown, axis) in numbers.iter().zip(["x", "y", "z"]) {
            let exact = row[axis].as_f64().expect("a number");
            // Four digits, or whole newtons.
            assert!((shown - exact).abs() <= 5e-4 * exact.abs() + 0.5, "{name} {axis}: {shown} for {exact}");
        }
        assert_eq!(numbers.len(), 3);
    }
}

fn refuses(folder: &Path, arguments: &[&str], words: &str) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    let output =
        command.current_dir(folder).args(["book", "combined.yaml"]).args(arguments).output().expect("it starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    assert!(told.contains(words), "{arguments:?}: {told}");
}

/// Nothing holds the truck: it has no rest and no strength. The cover says so, and the command fails.
#[test]
fn a_crane_that_does_not_rest_has_a_book_that_says_so() {
    let (_, folder) = book("fails", &["combined.yaml"]);
    fs::write(folder.join("my falling.yaml"), FALLING).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    command.current_dir(&folder).args(["book", "my falling.yaml", "-o", "falling.html", "--bend-limit", "1"]);
    let output = command.output().expect("it starts");
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let book = fs::read_to_string(folder.join("falling.html")).expect("a book");
    let (cover, _) = book.split_once("<nav>").expect("contents");
    assert!(cover.contains("not computed: ") && !cover.contains("No section has a caution"), "{cover}");
    assert!(book.contains("<code>crane statics 'my falling.yaml' --bend-limit 1</code>"), "quoted, with its limits");
}

const FALLING: &str = "format: 1
name: falling
links: [{name: truck, joint: free, mass: 100, com: [0, 0, 1], inertia: {Ixx: 10, Iyy: 10, Izz: 10}}]
";

#[test]
fn what_is_not_there_says_how_it_would_be() {
    let (book, folder) = book("left_out", &["combined.yaml", "--combination", "lifting"]);
    let (_, rest) = book.split_once("What was left out</h2>").expect("a section");
    for words in ["add `--chart", "add `--run`", "add `--fatigue", "computed with one of them"] {
        assert!(rest.contains(words), "{words}: {rest}");
    }
    assert!(book.contains("combination lifting</h1>"), "the title has the combination");
    assert!(sections(&book).iter().all(|(words, _)| words.join(" ").contains("combined.yaml --combination lifting")));
    // Only figures of this book: not those of another chart in the same folder.
    let two = ["--range", "main_boom_theta=-40deg:0:3", "--range", "knuckle_theta=0:40deg:3"];
    crane(&folder, &[&["envelope", "combined.yaml", "--quiet"], &two[..]].concat());
    let chart = ["--chart", "--range main_boom_theta=-40deg:0:3", "-o", "one.html"];
    crane(&folder, &[&["book", "combined.yaml", "--quiet"], &chart[..]].concat());
    let one = fs::read_to_string(folder.join("one.html")).expect("a book");
    assert!(
        one.contains("Load chart: largest") && !one.contains("the least over all else"),
        "a map of the other chart"
    );
    refuses(&folder, &["--chart", "--rnge main_boom_theta=1"], "--rnge");
    refuses(&folder, &["--chart", "--range main_boom_theta=1 --rigid"], "`--rigid` is not for a single section");
    refuses(&folder, &["--chart", ""], "--range");
    refuses(&folder, &["--chart", "--range 'main_boom_theta=1"], "has no second '");
    let both = ["--combination", "test", "--chart", "--combinations --range main_boom_theta=0"];
    refuses(&folder, &both, "cannot be used with");
}
