//! Figures of an envelope: load chart, slew diagram, maps.

use std::path::Path;

use crane_model::envelope::{Coverage, Envelope};

use crate::{
    figures::{Curve, Mark, PALETTE, Panel, shade},
    problem::{Outcome, Problem},
    screen::Console,
};

use super::{
    chart::rounded_down,
    letters::{legend, letter},
    map::{Map, svg},
    ranges::shown,
    rows::{ChartRow, Layout},
    surface::{Knot, Sheet, Surface, evenly, levels, short},
};

/// Maximum number of curves of a diagram.
const MOST_CURVES: usize = 6;
/// Maximum number of curves of equal load.
const MOST_LEVELS: usize = 8;

/// What stands above every figure: of which crane and spec it is, and within which limits.
pub struct Heading(Vec<String>);

impl Heading {
    /// Of a chart.
    pub fn new(envelope: &Envelope, layout: &Layout, coverage: &Coverage) -> Self {
        /// Digits of the hash that distinguish specs.
        const DIGITS: usize = 12;
        let hash: String = layout.description.spec_hash.as_str().chars().take(DIGITS).collect();
        let combinations = match layout.combinations.join(", ") {
            none if none.is_empty() => none,
            names => format!("; combinations {names}"),
        };
        let factor =
            if envelope.factor > 1.0 { format!(" of {} times the load", envelope.factor) } else { String::new() };
        Self(vec![
            format!("{}, spec {hash}{combinations}", layout.description.name),
            format!("Limits{factor}: {}", coverage.considered.join("; ")),
            format!("Not considered: {}", coverage.not_considered.join("; ")),
            format!("Radius of {} from {}", layout.reach.point(), layout.reach.axis()),
        ])
    }

    /// Below what a figure shows.
    fn headings(&self, what: &str) -> Vec<String> {
        [what.to_owned()].into_iter().chain(self.0.iter().cloned()).collect()
    }
}

/// Writes the figures that apply; returns their names.
pub fn write_chart_figures(
    console: &Console,
    folder: &Path,
    name: &str,
    envelope: &Envelope,
    layout: &Layout,
    rows: &[ChartRow],
    (surface, heading): (Option<&Surface>, &Heading),
) -> Outcome<Vec<String>> {
    let load = &layout.columns[layout.load()];
    let parameter = &layout.description.parameters[envelope.load].name;
    let mut written = Vec::new();
    let mut save = |what: &str, picture: Result<String, String>| -> Outcome<()> {
        let file = format!("{name}_{what}.svg");
        let picture = picture.map_err(|error| Problem::failed(format!("cannot draw {file}: {error}"), ""))?;
        console.write_text(&folder.join(&file), &picture)?;
        written.push(file);
        Ok(())
    };
    if let Some(surface) = surface {
        let panels = load_chart(surface);
        let mut title = heading.headings(&format!("Load chart: largest {parameter} [{}]", load.unit));
        if surface.sheets.iter().any(Sheet::is_area) {
            title.push(
                "Curves are interpolated between poses; the table has what all poses around a place bear".to_owned(),
            );
        }
        save("load_chart", crate::figures::titled(&title, &panels, panels.len().min(2)))?;
    }
    if let Some(slewing) = layout.slewing(envelope) {
        let title = heading.headings(&format!("Largest {parameter} over the slewing angle [{}]", load.unit));
        save("slew_diagram", crate::figures::titled(&title, &[slew_diagram(envelope, layout, rows, slewing)], 1))?;
    }
    let varying: Vec<usize> =
        (0..envelope.axes.0.len()).filter(|axis| envelope.axes.0[*axis].values.len() > 1).collect();
    if let [.., y, x] = varying[..] {
        let title =
            heading.headings(&format!("Largest {parameter} [{}], the least over all else that varies", load.unit));
        let governed = map(envelope, layout, rows, ([x, y], title), |row| layout.load_of(row), f64::min);
        save("largest_load_map", svg(&governed))?;
        let used = |row: &ChartRow| row.numbers[layout.utilisation()];
        if rows.iter().any(|row| used(row).is_finite()) {
            let title = "Utilisation with the crane's own load, the maximum over everything else that varies";
            let used = map(envelope, layout, rows, ([x, y], heading.headings(title)), used, f64::max);
            save("utilisation_map", svg(&Map { words: Vec::new(), ..used }))?;
        }
    }
    Ok(written)
}

/// Curves of equal load over radius and height; over the radius alone if only one drive moves.
fn load_chart(surface: &Surface) -> Vec<Panel> {
    let unit = &surface.unit;
    let of = |sheet: &Sheet| if sheet.label.is_empty() { String::new() } else { format!(", {}", sheet.label) };
    if !surface.sheets.iter().any(Sheet::is_area) {
        let curves = surface.sheets.iter().zip(PALETTE).map(|(sheet, colour)| Curve {
            label: if sheet.label.is_empty() { format!("largest load [{unit}]") } else { sheet.label.clone() },
            colour,
            mark: Mark::Solid,
            points: sheet.edges().filter(|[a, b]| (b.radius - a.radius).is_finite()).flat_map(step).collect(),
        });
        let (x, y) = ("radius [m]".to_owned(), format!("largest load [{unit}]"));
        return vec![Panel { x, y, equal: false, logarithmic: false, curves: curves.collect() }];
    }
    let loads = || surface.knots().map(|knot| knot.load).filter(|load| *load > 0.0);
    let (least, greatest) = (loads().fold(f64::INFINITY, f64::min), loads().fold(0.0, f64::max));
    let levels = levels(least, greatest, MOST_LEVELS);
    let panel = |sheet: &Sheet| {
        let edge = outline(sheet).into_iter().map(|points| Curve {
            label: "outermost poses".to_owned(),
            colour: crate::figures::GREY,
            mark: Mark::Solid,
            points,
        });
        let curves = levels.iter().enumerate().flat_map(|(index, level)| {
            let part = index as f64 / (levels.len().max(2) - 1) as f64;
            contour(sheet, *level).into_iter().map(move |points| Curve {
                label: format!("{} {unit}", short(*level)),
                colour: shade(part),
                mark: Mark::Solid,
                points,
            })
        });
        Panel {
            x: format!("radius [m]{}", of(sheet)),
            y: "height [m]".to_owned(),
            equal: true,
            logarithmic: false,
            curves: edge.chain(curves).collect(),
        }
    };
    surface.sheets.iter().map(panel).collect()
}

/// Between two poses, the load that both bear, as in the table.
fn step([from, to]: [Knot; 2]) -> [(f64, f64); 2] {
    let load = from.load.min(to.load);
    [(from.radius, load), (to.radius, load)]
}

/// The four sides of a sheet.
fn outline(sheet: &Sheet) -> Vec<Vec<(f64, f64)>> {
    let position = |knot: &Knot| (knot.radius, knot.height);
    let last = sheet.knots.len() - 1;
    let sides = [
        sheet.knots[0].iter().map(position).collect(),
        sheet.knots[last].iter().map(position).collect(),
        sheet.knots.iter().filter_map(|row| row.first()).map(position).collect(),
        sheet.knots.iter().filter_map(|row| row.last()).map(position).collect(),
    ];
    sides.to_vec()
}

/// Pieces of the curve on which the largest load is `level`: through both triangles of each cell. Between poses `1/load` is
/// interpolated linearly: exact where the load times its distance from a tipping line is constant, and an underestimate of the load
/// where the boom's own weight matters.
fn contour(sheet: &Sheet, level: f64) -> Vec<Vec<(f64, f64)>> {
    let crossing = |a: &Knot, b: &Knot| {
        // A pose without load counts as one with a thousandth of the level.
        let inverse = |knot: &Knot| 1.0 / knot.load.max(1e-3 * level);
        let part = (1.0 / level - inverse(a)) / (inverse(b) - inverse(a));
        let inside = (0.0..1.0).contains(&part);
        inside.then_some((a.radius + part * (b.radius - a.radius), a.height + part * (b.height - a.height)))
    };
    let mut pieces = Vec::new();
    for corners in sheet.triangles() {
        let sides = [[0, 1], [1, 2], [2, 0]];
        let met: Vec<_> = sides.iter().filter_map(|[from, to]| crossing(&corners[*from], &corners[*to])).collect();
        if let [from, to] = met[..] {
            pieces.push(vec![from, to]);
        }
    }
    pieces
}

/// Indices of everything else on its axis, and loads over the slewing angle.
type Group = (Vec<usize>, Vec<(f64, f64)>);

/// The largest load over the slewing angle, with everything else at some of its values.
fn slew_diagram(envelope: &Envelope, layout: &Layout, rows: &[ChartRow], slewing: usize) -> Panel {
    let axes = &envelope.axes.0;
    let (name, unit, factor) = shown(&axes[slewing], &layout.description);
    let mut groups: Vec<Group> = Vec::new();
    for (pose, row) in rows.iter().enumerate() {
        let mut places = envelope.axes.places(pose);
        let angle = axes[slewing].values[places[slewing]] * factor;
        places[slewing] = 0;
        let point = (angle, layout.load_of(row));
        match groups.iter_mut().find(|(others, _)| *others == places) {
            Some((_, points)) => points.push(point),
            None => groups.push((places, vec![point])),
        }
    }
    let chosen = evenly(groups.len(), MOST_CURVES);
    let label = |places: &[usize]| {
        let others =
            axes.iter().zip(places).enumerate().filter(|(index, (axis, _))| *index != slewing && axis.values.len() > 1);
        let words = others.map(|(_, (axis, index))| {
            let (name, unit, factor) = shown(axis, &layout.description);
            format!("{name} {}{}{unit}", short(axis.values[*index] * factor), if unit == "°" { "" } else { " " })
        });
        let words: Vec<String> = words.collect();
        if words.is_empty() { "largest load".to_owned() } else { words.join(", ") }
    };
    let curves = chosen.iter().zip(PALETTE).map(|(group, colour)| {
        let (places, points) = &groups[*group];
        Curve { label: label(places), colour, mark: Mark::Solid, points: points.clone() }
    });
    Panel {
        x: format!("{name} [{unit}]"),
        y: format!("largest load [{}]", layout.columns[layout.load()].unit),
        equal: false,
        logarithmic: false,
        curves: curves.collect(),
    }
}

/// A quantity over two axes, reduced over the others by `worst`, with the letters of the limits that govern there.
fn map(
    envelope: &Envelope,
    layout: &Layout,
    rows: &[ChartRow],
    ([x, y], mut title): ([usize; 2], Vec<String>),
    quantity: impl Fn(&ChartRow) -> f64,
    worst: fn(f64, f64) -> f64,
) -> Map {
    let axes = &envelope.axes.0;
    let side = |axis: usize| {
        let (name, unit, factor) = shown(&axes[axis], &layout.description);
        let values: Vec<f64> = axes[axis].values.iter().map(|value| value * factor).collect();
        (format!("{name} [{unit}]"), values)
    };
    let (width, height) = (axes[x].values.len(), axes[y].values.len());
    let mut cells = vec![vec![f64::NAN; width]; height];
    let mut words = vec![vec![String::new(); width]; height];
    for (pose, row) in rows.iter().enumerate() {
        let places = envelope.axes.places(pose);
        let (column, line) = (places[x], places[y]);
        let (cell, value) = (&mut cells[line][column], quantity(row));
        let next = if cell.is_nan() { value } else { worst(*cell, value) };
        if cell.is_nan() || next != *cell {
            words[line][column] = format!("{} {}", short(rounded_down(next)), letter(&row.governing[0]));
        }
        *cell = next;
    }
    title.push(legend(rows.iter().map(|row| row.governing[0].as_str())).join(", "));
    Map { title, x: side(x), y: side(y), cells, words }
}
