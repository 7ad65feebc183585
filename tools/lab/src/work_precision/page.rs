//! The results as a Markdown page.

use std::{fmt::Write as _, fs, path::Path};

use crane_cli::{
    Console, files,
    toolbox::{Outcome, write_figure},
};

use super::Found;

/// Texts above each table and figure, by its name.
const TEXTS: [(&str, &str, &str); 5] = [
    (
        "least",
        "Which method for which error",
        "The shortest time in which a run achieves an error of the load path, for each method. Only the integration is timed; \
         `crane simulate` also writes results.",
    ),
    (
        "methods",
        "Every method for its steps or tolerances",
        "Errors are the largest over all results: of the points' positions relative to the largest distance of a point from its \
         start, of a drive's torque or force relative to its maximum, of the mechanical energy relative to the maximum kinetic \
         energy. A tolerance limits the error of a step, in m and rad; this table shows the resulting error of the run.",
    ),
    (
        "advice",
        "Which number of sections, method and setting",
        "Errors of model and method together, relative to the limit of many sections: the shortest time for each error.",
    ),
    (
        "sections",
        "The model's own error",
        "Relative to the limit of many sections, extrapolated from the two finest with the error of rigid elements, 1/n². The static \
         deflection is that of the points, relative to their displacement under gravity; of frequencies and peak torques, the \
         worst is shown.",
    ),
    ("runs", "Runs with other numbers of sections", "The advice is chosen from these runs."),
];

/// Writes the page, and its figures into the folder `images` next to it.
pub fn write_page(console: &Console, file: &Path, found: &Found<'_>) -> Outcome<()> {
    let name = &found.description.name;
    let mut text = format!(
        "# Error against run time\n\nThis page shows the run time needed for a given error on the crane `{name}`, depending on the \
         integration method and on the number of sections of its flexible links. `crane-lab work-precision {name} --page …` writes it; \
         one thread, compiled for a generic processor, {}, {} {}.\n\n",
        machine(),
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
    );
    text += &found.facts.markdown();
    text += "\nThe reference is computed by two methods, which must agree to 1e-11 of the load path and 1e-9 of torques and energy; otherwise \
             the command ends with an error.\n";
    let folder = file.parent().unwrap_or(Path::new("")).join("images");
    files::folder(&folder)?;
    for (key, title, words) in TEXTS {
        let Some(grid) = found.grids.iter().find(|grid| grid.key() == key) else { continue };
        let _ = write!(text, "\n## {title}\n\n{words}\n\n");
        for (what, alt) in pictures(key) {
            if let Some((_, panels)) = found.figures.iter().find(|(name, _)| name == what) {
                let image = format!("error_{what}.svg");
                write_figure(console, &folder.join(&image), panels, 2)?;
                let _ = write!(text, "![{alt}](images/{image})\n\n");
            }
        }
        text += &grid.markdown();
    }
    text += "\n## The formulation\n\nA and e by the triple sum of [Urbaś 2016, Eq. (5)] as printed, A and e by composite bodies and Newton's \
             and Euler's equations, and accelerations in O(n) without A differ only in run time, not in error: \
             [performance.md](performance.md) compares their times. All methods here use the accelerations in O(n).\n";
    console.write_text(file, &text)
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

/// The machine, if the system reports it.
fn machine() -> String {
    let facts = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = facts.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or(std::env::consts::ARCH, |(_, model)| model.trim());
    format!("{model}, {}", std::env::consts::OS)
}
