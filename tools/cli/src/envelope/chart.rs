//! The load chart as a table: loads over the radius.

use crane_page::tables::{Cell, Grid, Heading};

use super::surface::{Knot, Sheet, Surface};

/// How to read it.
pub const NOTE: &str = "The load chart is valid for the model and the limits above: loads at rest, rounded down to three digits, at every \
     slewing angle considered. No dynamic factor, no factor of a design code.";

/// Upper limit of the number of rows of a chart.
const ROWS: f64 = 12.5;

const KEY: &str = "load_chart";
const TITLE: &str =
    "Load chart: the largest load within the limits in the best and in the worst pose that reaches a radius";

/// The chart of poses among which no drive moves the load in or out.
pub fn empty() -> Grid {
    Grid::new(KEY, TITLE, &[])
}

/// Loads over the radius: of all poses that bring the load there, the largest and the smallest.
pub fn table(surface: &Surface) -> Grid {
    let greatest = surface.knots().map(|knot| knot.radius).fold(0.0, f64::max);
    let step = step(greatest / ROWS);
    let unit = &surface.unit;
    let of_sheets = surface.sheets.iter().flat_map(|sheet| {
        ["largest load", "least load"].into_iter().flat_map(|load| {
            let headings = [format!("{load} [{unit}]"), format!("height of {load} [m]")];
            headings.map(|heading| Heading::of(&sheet.label, &heading))
        })
    });
    let headings = [Heading::from("radius [m]")].into_iter().chain(of_sheets).collect();
    let mut grid = Grid::with_headings(KEY, TITLE, headings);
    let mut radius = step;
    while radius <= greatest {
        let found: Vec<Option<[Knot; 2]>> = surface.sheets.iter().map(|sheet| best_and_worst(sheet, radius)).collect();
        if found.iter().any(Option::is_some) {
            let cells = found.iter().flat_map(|found| match found {
                Some([best, worst]) => [best, worst]
                    .into_iter()
                    .flat_map(|knot| [Cell::from(rounded_down(knot.load)), Cell::from(centimetres(knot.height))])
                    .collect::<Vec<_>>(),
                None => vec![Cell::Empty; 4],
            });
            grid.row([Cell::from(radius)].into_iter().chain(cells).collect::<Vec<_>>());
        }
        radius += step;
    }
    grid
}

/// Of all neighbouring poses between which the load is at a radius, those with the largest and the smallest load that both bear.
fn best_and_worst(sheet: &Sheet, radius: f64) -> Option<[Knot; 2]> {
    let meets = |[a, b]: [Knot; 2]| {
        let part = (radius - a.radius) / (b.radius - a.radius);
        // Not on edges of constant radius, nor next to poses without an equilibrium.
        (0.0..=1.0).contains(&part).then(|| Knot {
            radius,
            height: a.height + part * (b.height - a.height),
            load: a.load.min(b.load),
        })
    };
    let all = || sheet.edges().filter_map(meets);
    let best = all().max_by(|a, b| a.load.total_cmp(&b.load))?;
    let worst = all().min_by(|a, b| a.load.total_cmp(&b.load))?;
    Some([best, worst])
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
        let knot = |radius, load| Knot { radius, height: radius / 2.0, load };
        let sheet =
            Sheet { label: String::new(), knots: vec![vec![knot(2.0, 800.0), knot(4.0, 300.0), knot(3.0, 200.0)]] };
        let [best, worst] = best_and_worst(&sheet, 3.5).unwrap();
        assert_eq!((best.load, best.height, worst.load), (300.0, 1.75, 200.0));
        assert_eq!(best_and_worst(&sheet, 5.0), None);
    }
}
