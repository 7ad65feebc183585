//! The load chart as tables: loads over the radius, and over radius and height.

use crane_page::tables::{Cell, Grid, Heading};

use crate::figures::wrapped;

use super::{
    given,
    letters::{legend, letter},
    rows::ChartRow,
    surface::{Knot, Sheet, Surface, short},
};

/// How to read it.
pub const NOTE: &str = "The load chart is valid for the model and the limits above: loads at rest, rounded down to three digits, at every \
     slewing angle considered. Between two poses it has the load that both bear. Where a cell is empty, no pose brings the load there.";

/// Upper limit of the number of rows of a chart.
const ROWS: f64 = 12.5;
/// Width of a screen, characters.
pub const SCREEN: usize = 100;

/// Of a radius that is asked for.
pub const UNREACHED: &str = "no pose";
const KEY: &str = "load_chart";
const TITLE: &str =
    "Load chart: the largest load within the limits in the best and in the worst pose that reaches a radius";
/// Key of the loads over radius and height.
const PLACES: &str = "loads_by_place";

/// What a chart needs.
pub struct Chart<'a> {
    /// The poses.
    pub surface: &'a Surface,
    /// Ratings of all poses.
    pub rows: &'a [ChartRow],
    /// Radii that are asked for, m; round ones if there are none.
    pub asked_radii: &'a [f64],
}

/// The charts of poses among which no drive moves the load in or out.
pub fn empty() -> [Grid; 2] {
    [Grid::new(KEY, TITLE, &[]), Grid::new(PLACES, "", &[])]
}

/// The limit that governs a pose, in words.
pub fn limit_words(row: &ChartRow) -> String {
    match row.governing.each_ref().map(String::as_str) {
        ["", _] => "none up to the maximum load".to_owned(),
        [kind, ""] => kind.to_owned(),
        [kind, of] => format!("{kind}: {of}"),
    }
}

impl Chart<'_> {
    /// Kind of the limit that governs at a knot, and what it is a limit of.
    fn limit(&self, knot: &Knot) -> [&str; 2] {
        self.rows.get(knot.pose).map_or(["", ""], |row| row.governing.each_ref().map(String::as_str))
    }

    /// The limit in words.
    fn limit_words(&self, knot: &Knot) -> String {
        self.rows.get(knot.pose).map_or_else(String::new, limit_words)
    }

    /// The radii that are asked for, or round ones up to the largest.
    fn radii(&self) -> Vec<f64> {
        if !self.asked_radii.is_empty() {
            return self.asked_radii.to_vec();
        }
        multiples(self.surface.knots().map(|knot| knot.radius))
    }

    /// Loads over the radius, for programs: of all poses that bring the load there, the largest and the smallest.
    pub fn table(&self) -> Grid {
        let unit = &self.surface.unit;
        let of_sheets = self.surface.sheets.iter().flat_map(|sheet| {
            ["largest load", "least load"].into_iter().flat_map(|load| {
                let headings =
                    [format!("{load} [{unit}]"), format!("height of {load} [m]"), format!("limit of {load}")];
                headings.map(|heading| Heading::about(&sheet.label, &heading))
            })
        });
        let headings = [Heading::from("radius [m]")].into_iter().chain(of_sheets).collect();
        let mut grid = Grid::with_headings(KEY, TITLE, headings);
        for radius in self.radii() {
            let sheets = &self.surface.sheets;
            let found: Vec<Option<[Knot; 2]>> = sheets.iter().map(|sheet| best_and_worst(sheet, radius)).collect();
            if found.iter().any(Option::is_some) {
                let cells = found.iter().flat_map(|found| match found {
                    Some(knots) => knots.iter().flat_map(|knot| self.cells(knot)).collect::<Vec<_>>(),
                    None => vec![Cell::Empty; 6],
                });
                grid.row([Cell::from(radius)].into_iter().chain(cells).collect::<Vec<_>>());
            }
        }
        grid
    }

    /// Load, height and limit of a knot.
    fn cells(&self, knot: &Knot) -> [Cell; 3] {
        [rounded_down(knot.load).into(), centimetres(knot.height).into(), self.limit_words(knot).into()]
    }

    /// The same for people: one table for each sheet, and how to read its letters.
    pub fn by_radius(&self) -> Vec<Grid> {
        let unit = &self.surface.unit;
        let table = |sheet: &Sheet| {
            let headings = [
                "radius [m]".to_owned(),
                format!("largest load [{unit}]"),
                "height [m]".to_owned(),
                "limit".to_owned(),
                format!("least load [{unit}]"),
                "height [m]".to_owned(),
                "limit".to_owned(),
            ];
            let title =
                format!("Load chart{}: largest load in the best and in the worst pose of a radius", caption_of(sheet));
            let mut grid = Grid::new(KEY, title, &headings.each_ref().map(String::as_str));
            for radius in self.radii() {
                let Some(knots) = best_and_worst(sheet, radius) else {
                    if !self.asked_radii.is_empty() {
                        let blank = [Cell::Empty, Cell::Empty, Cell::from(UNREACHED)];
                        grid.row(
                            [Cell::from(radius)].into_iter().chain(blank.clone()).chain(blank).collect::<Vec<_>>(),
                        );
                    }
                    continue;
                };
                let cells = knots.iter().flat_map(|knot| {
                    let kind = self.limit(knot)[0];
                    let limit = if kind.is_empty() { "none" } else { kind };
                    [rounded_down(knot.load).into(), centimetres(knot.height).into(), Cell::from(limit)]
                });
                grid.row([Cell::from(radius)].into_iter().chain(cells).collect::<Vec<_>>());
            }
            grid
        };
        self.surface.sheets.iter().map(table).collect()
    }

    /// Given loads at radii beside the largest loads of this chart.
    pub fn beside(&self, radii: &[f64], loads: &[f64]) -> Grid {
        let unit = &self.surface.unit;
        let several = self.surface.sheets.len() > 1;
        let headings = [
            "case".to_owned(),
            "radius [m]".to_owned(),
            format!("given load [{unit}]"),
            format!("largest load [{unit}]"),
            "difference [%]".to_owned(),
            "limit".to_owned(),
        ];
        let headings: Vec<&str> = headings.iter().map(String::as_str).skip(usize::from(!several)).collect();
        let title =
            "The given chart, the largest load in the best pose of each radius, and its difference from the given one";
        let mut grid = Grid::new(given::KEY, title, &headings);
        for sheet in &self.surface.sheets {
            for (&radius, &load) in radii.iter().zip(loads) {
                let best = best_and_worst(sheet, radius).map(|[best, _]| best);
                let computed = best.map(|best| rounded_down(best.load));
                let difference = computed.map_or(Cell::Empty, |computed| Cell::Change(computed / load - 1.0));
                let limit = best.map_or(Cell::from(UNREACHED), |best| self.limit_words(&best).into());
                let case = several.then(|| Cell::from(sheet.label.as_str()));
                let numbers = [radius.into(), load.into(), computed.map_or(Cell::Empty, Cell::from), difference, limit];
                grid.row(case.into_iter().chain(numbers).collect::<Vec<_>>());
            }
        }
        grid
    }

    /// Loads over radius and height, for programs: case, place, load and limit.
    pub fn by_place(&self) -> Grid {
        let unit = &self.surface.unit;
        let headings = ["case", "radius [m]", "height [m]", &format!("load [{unit}]"), "limit", "of"];
        let mut grid = Grid::new(PLACES, "Loads over radius and height", &headings);
        for sheet in &self.surface.sheets {
            for height in self.heights() {
                for (radius, knot) in
                    self.radii().into_iter().filter_map(|radius| Some((radius, at(sheet, radius, height)?)))
                {
                    let [kind, of] = self.limit(&knot);
                    let limit = if kind.is_empty() { Cell::Empty } else { kind.into() };
                    let load = Cell::from(rounded_down(knot.load));
                    grid.row([sheet.label.as_str().into(), radius.into(), height.into(), load, limit, of.into()]);
                }
            }
        }
        grid
    }

    /// The same for a driver: heights downwards, radii to the right, in each cell the load and the letter of its limit.
    pub fn plates(&self) -> Vec<Grid> {
        let radii = self.radii();
        let unit = &self.surface.unit;
        let mut grids = Vec::new();
        for sheet in self.surface.sheets.iter().filter(|sheet| sheet.is_area()) {
            let mut used: Vec<&str> = Vec::new();
            let mut lines: Vec<(f64, Vec<String>)> = Vec::new();
            for height in self.heights().into_iter().rev() {
                let mut cell = |radius: &f64| {
                    at(sheet, *radius, height).map_or_else(String::new, |knot| {
                        let kind = self.limit(&knot)[0];
                        used.push(kind);
                        format!("{} {}", short(rounded_down(knot.load)), letter(kind))
                    })
                };
                lines.push((height, radii.iter().map(&mut cell).collect()));
            }
            lines.retain(|(_, cells)| cells.iter().any(|cell| !cell.is_empty()));
            let reached = |column: usize| lines.iter().any(|(_, cells)| !cells[column].is_empty());
            let columns: Vec<usize> = (0..radii.len()).filter(|column| reached(*column)).collect();
            let width = lines.iter().flat_map(|(_, cells)| cells).map(|cell| cell.chars().count()).max().unwrap_or(0);
            // Two blanks before each column, the heights first.
            let columns = thinned(columns, (SCREEN - 14) / (width.max(5) + 2));
            let title = format!(
                "Load chart{}: largest load [{unit}] over radius and height, and what limits it: {}",
                caption_of(sheet),
                legend(used.iter().copied()).join(", ")
            );
            let headings: Vec<String> = ["height [m]".to_owned()]
                .into_iter()
                .chain(columns.iter().map(|column| format!("{} m", short(radii[*column]))))
                .collect();
            let mut grid = Grid::new(
                "",
                wrapped(&title, SCREEN).join("\n"),
                &headings.iter().map(String::as_str).collect::<Vec<_>>(),
            );
            for (height, cells) in &lines {
                let cells = columns.iter().map(|column| Cell::from(cells[*column].as_str()));
                grid.row([Cell::from(*height)].into_iter().chain(cells).collect::<Vec<_>>());
            }
            grids.push(grid);
        }
        grids
    }

    /// Round heights from the lowest to the highest.
    fn heights(&self) -> Vec<f64> {
        multiples(self.surface.knots().map(|knot| knot.height))
    }
}

/// The label of a sheet in a title.
fn caption_of(sheet: &Sheet) -> String {
    if sheet.label.is_empty() { String::new() } else { format!(", {}", sheet.label) }
}

/// Of all neighbouring poses between which the load is at a radius, those with the largest and the smallest load that both bear.
fn best_and_worst(sheet: &Sheet, radius: f64) -> Option<[Knot; 2]> {
    let meets = |[a, b]: [Knot; 2]| {
        let part = (radius - a.radius) / (b.radius - a.radius);
        // Not on edges of constant radius, nor next to poses without an equilibrium.
        let lower = if b.load < a.load { b } else { a };
        (0.0..=1.0).contains(&part).then_some(Knot { radius, height: a.height + part * (b.height - a.height), ..lower })
    };
    let all = || sheet.edges().filter_map(meets);
    let best = all().max_by(|a, b| a.load.total_cmp(&b.load))?;
    let worst = all().min_by(|a, b| a.load.total_cmp(&b.load))?;
    Some([best, worst])
}

/// The smallest load that all poses bear which surround a place.
fn at(sheet: &Sheet, radius: f64, height: f64) -> Option<Knot> {
    let least = |corners: [Knot; 3]| corners.into_iter().min_by(|a, b| a.load.total_cmp(&b.load));
    let around = sheet.triangles().filter(|corners| contains(corners, radius, height)).filter_map(least);
    around.min_by(|a, b| a.load.total_cmp(&b.load))
}

/// Whether a place is in a triangle; none is in one with a pose without an equilibrium, nor in one without an area.
fn contains(corners: &[Knot; 3], radius: f64, height: f64) -> bool {
    let sides = [[0, 1], [1, 2], [2, 0]].map(|[from, to]: [usize; 2]| {
        let [from, to] = [corners[from], corners[to]];
        (to.radius - from.radius) * (height - from.height) - (to.height - from.height) * (radius - from.radius)
    });
    let area: f64 = sides.iter().sum();
    let inside = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
    inside && area != 0.0
}

/// Multiples of a round step within the range of some values, at most about a dozen.
fn multiples(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let (least, greatest) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if least > greatest {
        return Vec::new();
    }
    let step = step((greatest - least.min(0.0)) / ROWS);
    let mut all = Vec::new();
    let mut count = (least / step).ceil();
    while count * step <= greatest {
        // Without the digits that rounding leaves.
        all.push((count * step * 1e6).round() / 1e6);
        count += 1.0;
    }
    all
}

/// At most `most` of some columns, every second, third or so, from the first on.
fn thinned(columns: Vec<usize>, most: usize) -> Vec<usize> {
    let stride = columns.len().div_ceil(most.max(1)).max(1);
    columns.into_iter().step_by(stride).collect()
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `least`.
fn step(least: f64) -> f64 {
    let power = 10_f64.powf(least.max(1e-6).log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// Rounded down to three digits.
pub fn rounded_down(load: f64) -> f64 {
    if load <= 0.0 {
        return 0.0;
    }
    let exponent = load.log10().floor() - 2.0;
    if exponent >= 0.0 {
        let unit = 10_f64.powf(exponent).round();
        (load / unit).floor() * unit
    } else {
        let parts = 10_f64.powf(-exponent).round();
        (load * parts).floor() / parts
    }
}

/// Rounded to the nearest centimetre.
fn centimetres(height: f64) -> f64 {
    (height * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knot(radius: f64, height: f64, load: f64) -> Knot {
        Knot { radius, height, load, pose: 0 }
    }

    #[test]
    fn loads_are_rounded_down() {
        for (load, expected) in [
            (1487.9, 1480.0),
            (999.99, 999.0),
            (1000.0, 1000.0),
            (48.77, 48.7),
            (0.123_99, 0.123),
            (123_456.0, 123_000.0),
            (0.0, 0.0),
        ] {
            assert_eq!(rounded_down(load), expected);
        }
        assert_eq!([step(0.83), step(1.0), step(2.1), step(0.07)], [1.0, 1.0, 5.0, 0.1]);
    }

    /// Two poses at 2 m and 4 m: between them the chart has the load that both bear.
    #[test]
    fn a_chart_has_what_both_neighbours_bear() {
        let knot = |radius, load| knot(radius, radius / 2.0, load);
        let sheet =
            Sheet { label: String::new(), knots: vec![vec![knot(2.0, 800.0), knot(4.0, 300.0), knot(3.0, 200.0)]] };
        let [best, worst] = best_and_worst(&sheet, 3.5).unwrap();
        assert_eq!((best.load, best.height, worst.load), (300.0, 1.75, 200.0));
        assert_eq!(best_and_worst(&sheet, 5.0), None);
    }

    /// A square of poses with four loads: a place in one of its triangles has the smallest load of three corners.
    #[test]
    fn a_place_has_what_all_poses_around_it_bear() {
        let knots = vec![
            vec![knot(0.0, 0.0, 900.0), knot(2.0, 0.0, 700.0)],
            vec![knot(0.0, 2.0, 500.0), knot(2.0, 2.0, 800.0)],
        ];
        let sheet = Sheet { label: String::new(), knots };
        assert_eq!(at(&sheet, 1.5, 0.5).unwrap().load, 700.0);
        assert_eq!(at(&sheet, 0.5, 1.5).unwrap().load, 500.0);
        assert_eq!(at(&sheet, 2.5, 0.5), None);
        assert_eq!(multiples([-1.2, 3.1].into_iter()), [-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(thinned((0..10).collect(), 4), [0, 3, 6, 9]);
    }
}
