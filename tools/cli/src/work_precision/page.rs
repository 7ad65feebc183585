//! What was found as a Markdown page.

use std::{fmt::Write as _, fs, path::Path};

use crate::{files, problem::Outcome, simulate::write_figure, work_precision::Found};

/// Above each table and figure, by its name.
const TEXTS: [(&str, &str, &str); 5] = [
    (
        "least",
        "Which method for which error",
        "The least time in which a run meets an error of the load path, for each method. Runs are by the methods alone, without \
         files; a run that starts at `crane simulate` also writes its results.",
    ),
    (
        "methods",
        "Every method over its steps or tolerances",
        "Errors are the greatest over all results: of the points' positions relative to the longest way of one from its start, of a \
         drive's torque or force relative to its greatest, of the mechanical energy relative to the greatest kinetic energy. A \
         tolerance is what a step may be off, in m and rad; what comes of it over a run is in this table.",
    ),
    (
        "advice",
        "Which number of sections, method and setting",
        "Errors of model and method together, against what all numbers of sections come to: the least time for each error.",
    ),
    (
        "sections",
        "The model's own error",
        "Against the limit of ever more sections, extrapolated from the two finest as the error of rigid elements goes, with 1/n². \
         Static deflection: of the points, relative to how far they settle under gravity; frequencies and peak torques: the worst \
         of them.",
    ),
    ("runs", "Runs with other numbers of sections", "What the advice was chosen from."),
];

/// Writes the page, and its figures into `images` beside it.
pub fn write(file: &Path, found: &Found<'_>) -> Outcome<()> {
    let name = &found.description.name;
    let mut text = format!(
        "# Error against run time\n\nWhat accuracy costs on the crane `{name}`: of the methods that integrate its motion, and of the \
         number of sections that stand for its flexible links. This page is written by `crane work-precision {name} --page …`; \
         one thread, compiled for any machine of its kind, {}, {} {}.\n\n",
        machine(),
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
    );
    text += &found.facts.markdown();
    text += "\nThe reference is found by two methods, which must agree to 1e-11 of the load path and 1e-9 of torques and energy; otherwise the \
             command ends with an error.\n";
    let folder = file.parent().unwrap_or(Path::new("")).join("images");
    files::folder(&folder)?;
    for (key, title, words) in TEXTS {
        let Some(grid) = found.grids.iter().find(|grid| grid.key() == key) else { continue };
        let _ = write!(text, "\n## {title}\n\n{words}\n\n");
        for (what, alt) in pictures(key) {
            if let Some((_, panels)) = found.figures.iter().find(|(name, _)| name == what) {
                let image = format!("error_{what}.svg");
                write_figure(&folder.join(&image), panels, 2)?;
                let _ = write!(text, "![{alt}](images/{image})\n\n");
            }
        }
        text += &grid.markdown();
    }
    text += "\n## The formulation\n\nThe same A and e by the triple sum of [Urbaś 2016, Eq. (5)] as printed, by composite bodies and \
             Newton's and Euler's equations, and accelerations in O(n) without A differ in time alone, not in error: their times are in \
             [performance.md](performance.md). All methods here take the accelerations in O(n).\n";
    files::write_text(file, &text)
}

/// Figures of a section of the page, and what they show.
fn pictures(key: &str) -> &'static [(&'static str, &'static str)] {
    match key {
        "methods" => &[(
            "work_precision",
            "Errors of load path, torques and energy over wall time, evaluations and steps, for each method.",
        )],
        "advice" => &[("sections_time", "Error of the load path over wall time, for some numbers of sections.")],
        "sections" => &[(
            "sections",
            "Errors of static deflection, frequencies, peak torques and load path over the number of sections.",
        )],
        _ => &[],
    }
}

/// What this runs on, where the system tells.
fn machine() -> String {
    let told = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or(std::env::consts::ARCH, |(_, model)| model.trim());
    format!("{model}, {}", std::env::consts::OS)
}
