//! Tables of loads.

use crane_model::{
    Cut, Description, Wrench,
    results::{Extremes, Instant, Table},
    sections::Place,
    tipping::TippingLine,
};
use crane_page::tables::{Cell, Grid};

use super::history::{OF_JOINTS, OF_SECTIONS, UNITS, numbers, prefix};

/// Moments about the tipping lines.
pub fn tipping(description: &Description, lines: &[TippingLine]) -> Grid {
    let title = "Moments of weight and loads at rest about the tipping lines, in anticlockwise order seen from above";
    let mut grid = Grid::new("tipping", title, &["from", "to", "stabilising", "overturning", "unit", "margin"]);
    for line in lines {
        let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
        grid.row([
            from.into(),
            to.into(),
            line.stabilising.into(),
            line.overturning.into(),
            "N m".into(),
            line.margin().into(),
        ]);
    }
    grid
}

/// Headings with units.
fn headings(first: &[&str], components: [&str; 6]) -> Vec<String> {
    let components = components.iter().zip(UNITS).map(|(component, unit)| format!("{component} [{unit}]"));
    first.iter().map(|&word| word.to_owned()).chain(components).collect()
}

fn borrowed(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

/// What the ground and the joints carry.
pub fn joints(description: &Description, wrenches: &[Wrench]) -> Grid {
    let title = "Loads at rest: of the ground, in the world frame about its origin; of a joint, exerted by its link on the previous link, \
                 in the frame after the joint about its origin";
    let mut grid = Grid::new("loads", title, &borrowed(&headings(&["joint"], OF_JOINTS)));
    for (cut, wrench) in description.cuts().into_iter().zip(wrenches) {
        let name = match cut {
            Cut::Ground => "ground",
            Cut::Joint { body } => description.bodies[body].link.as_str(),
            Cut::Body { .. } | Cut::Inside { .. } => continue,
        };
        grid.row([Cell::from(name)].into_iter().chain(numbers(wrench).map(Cell::from)).collect::<Vec<_>>());
    }
    grid
}

/// Where a place is: the beam, the distance from its beginning, what is there.
pub fn words(place: &Place, description: &Description) -> [Cell; 3] {
    [place.beam(description).into(), place.x.into(), place.info(description).location().into()]
}

/// What the sections of beams carry.
pub fn sections(description: &Description, rest: &Instant) -> Grid {
    let title = "Section forces of beams at rest, in the section's frame, x along the beam: N is positive in tension, Mx twists, My \
                 and Mz bend as theta and psi do";
    let mut grid = Grid::new("sections", title, &borrowed(&headings(&["beam", "x [m]", "place"], OF_SECTIONS)));
    for place in rest.places(description) {
        let row = words(&place, description).into_iter().chain(numbers(&place.wrench).map(Cell::from));
        grid.row(row.collect::<Vec<_>>());
    }
    grid
}

/// Minimum and maximum loads of the ground and the joints over a run.
pub fn extremes_of_joints(description: &Description, table: &Table) -> Grid {
    let title = "Extremes of the loads along the manoeuvre, frames as at rest, times in s";
    let headers = ["joint", "component", "minimum", "time of minimum", "maximum", "time of maximum", "unit"];
    let mut grid = Grid::new("extremes_of_loads", title, &headers);
    for cut in description.cuts() {
        let name = match cut {
            Cut::Ground => "ground",
            Cut::Joint { body } => description.bodies[body].link.as_str(),
            Cut::Body { .. } | Cut::Inside { .. } => continue,
        };
        for (component, unit, extremes) in extremes(description, cut, table) {
            grid.row([
                name.into(),
                component.into(),
                extremes.minimum.into(),
                extremes.time_of_minimum.into(),
                extremes.maximum.into(),
                extremes.time_of_maximum.into(),
                unit.into(),
            ]);
        }
    }
    grid
}

/// Minimum and maximum section forces of every beam over a run, and where.
pub fn extremes_of_sections(description: &Description, at_rest: &[f64], table: &Table) -> Grid {
    let title = "Extremes of the section forces along the manoeuvre, times in s, places along the beam in m";
    let headers = [
        "beam",
        "component",
        "minimum",
        "x of minimum",
        "time of minimum",
        "maximum",
        "x of maximum",
        "time of maximum",
        "unit",
    ];
    let mut grid = Grid::new("extremes_of_sections", title, &headers);
    // The distance of a section that slides changes.
    let x_at = |cut: Cut, x: f64, time: f64| {
        let (prefix, _) = prefix(description, cut)?;
        let row = table.rows.iter().position(|row| row[0] == time)?;
        Some(table.values(&format!("{prefix}_x")).and_then(|mut values| values.nth(row)).unwrap_or(x))
    };
    let mut beams: Vec<(&str, Vec<(f64, Cut)>)> = Vec::new();
    for cut in description.cuts() {
        if let Some(index) = cut.section() {
            let (section, x) = (&description.sections[index], at_rest[index]);
            let link = description.bodies[section.body].link.as_str();
            match beams.last_mut().filter(|(beam, _)| *beam == link) {
                Some((_, sections)) => sections.push((x, cut)),
                None => beams.push((link, vec![(x, cut)])),
            }
        }
    }
    for (beam, sections) in beams {
        let all: Vec<_> = sections.iter().map(|(x, cut)| ((*x, *cut), extremes(description, *cut, table))).collect();
        for index in 0..UNITS.len() {
            let at = all.iter().map(|(place, found)| (*place, found[index]));
            let least = at.clone().min_by(|(_, (.., a)), (_, (.., b))| a.minimum.total_cmp(&b.minimum));
            let greatest = at.max_by(|(_, (.., a)), (_, (.., b))| a.maximum.total_cmp(&b.maximum));
            let (Some(((x, cut), (component, unit, low))), Some(((x_high, cut_high), (.., high)))) = (least, greatest)
            else {
                continue;
            };
            grid.row([
                beam.into(),
                component.into(),
                low.minimum.into(),
                x_at(cut, x, low.time_of_minimum).into(),
                low.time_of_minimum.into(),
                high.maximum.into(),
                x_at(cut_high, x_high, high.time_of_maximum).into(),
                high.time_of_maximum.into(),
                unit.into(),
            ]);
        }
    }
    grid
}

/// Extremes of the components of a cut.
fn extremes(description: &Description, cut: Cut, table: &Table) -> Vec<(&'static str, &'static str, Extremes)> {
    let Some((prefix, components)) = prefix(description, cut) else { return Vec::new() };
    let of = |(component, unit)| (component, unit, Extremes::of_column(table, &format!("{prefix}_{component}")));
    components.into_iter().zip(UNITS).map(of).collect()
}
