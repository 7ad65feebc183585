//! The point whose radius, height and deflection are shown, and the axis of the radius: chosen by name, and named in results.

use crane_live::{LiveCrane, Reach};
use crane_model::dyn_crane::Functions;
use crane_page::tables::Report;

use crate::problem::{Outcome, Problem, nearest};

/// The point of this name, otherwise that of the load.
pub fn reach(name: Option<&str>, load: Option<usize>, crane: &LiveCrane) -> Outcome<Reach> {
    let names = super::points(crane.description());
    let index = |name: &str| {
        names.iter().position(|point| *point == name).ok_or_else(|| {
            let guess = nearest(name, names.iter().copied());
            let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
            Problem::usage(format!("there is no point `{name}`"), format!("{guess}points: {}", names.join(", ")))
        })
    };
    let point = name.map(index).transpose()?;
    Ok(Reach::new(crane.chain(), crane.parameters(), load, point))
}

/// The point and the axis, for people.
pub fn reach_line(report: &mut Report, reach: &Reach) {
    report.line("point", format!("{}, its radius from {}", reach.point(), reach.axis()), "");
}

/// The same, also for programs.
pub fn reach_facts(report: &mut Report, reach: &Reach) {
    reach_line(report, reach);
    report.value("point", reach.point());
    report.value("radius_from", reach.axis());
}

/// The header of a file whose column `radius` has the radius.
pub fn header_with_reach(
    header: impl Iterator<Item = String>,
    radius: usize,
    reach: &Reach,
) -> impl Iterator<Item = String> {
    let in_full = format!("{} [m]", reach.words());
    header.enumerate().map(move |(index, name)| if index == radius { in_full.clone() } else { name })
}
