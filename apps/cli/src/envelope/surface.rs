//! Largest loads over radius and height: poses as a net whose knots are where the load hangs.

use crane_model::envelope::{Envelope, Varied};

use super::{
    ranges::shown,
    rows::{ChartRow, Layout},
};

/// Maximum number of sheets shown.
const MOST_SHEETS: usize = 6;

/// A pose: where the load hangs, and the largest load there at every slewing angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Horizontal distance from the slewing axis, m.
    pub radius: f64,
    /// Height, m.
    pub height: f64,
    /// The largest load, in the unit of its parameter.
    pub load: f64,
    /// Which of all poses it is.
    pub pose: usize,
}

/// Poses of one or two drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The values of everything else; empty if this is the only sheet.
    pub label: String,
    /// Rows of knots; neighbours are neighbouring poses.
    pub knots: Vec<Vec<Knot>>,
}

/// Sheets of knots.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// One per combination of the values that the knots do not vary.
    pub sheets: Vec<Sheet>,
    /// Unit of the loads.
    pub unit: String,
}

impl Surface {
    /// The poses of an envelope; `None` where no drive moves the load in or out. A knot has the smallest load over all slewing
    /// angles.
    pub fn new(envelope: &Envelope, layout: &Layout, rows: &[ChartRow]) -> Option<Self> {
        let axes = &envelope.axes.0;
        let slewing = layout.slewing(envelope);
        let moves = |axis: &usize| {
            axes[*axis].values.len() > 1 && Some(*axis) != slewing && matches!(axes[*axis].varied, Varied::Drive(_))
        };
        let mut net = (0..axes.len()).filter(moves);
        let first = net.next()?;
        let second = net.next();
        let others: Vec<usize> = (0..axes.len())
            .filter(|axis| *axis != first && Some(*axis) != second && Some(*axis) != slewing)
            .filter(|axis| axes[*axis].values.len() > 1)
            .collect();
        let count = |axis: Option<usize>| axis.map_or(1, |axis| axes[axis].values.len());
        let combinations: usize = others.iter().map(|axis| axes[*axis].values.len()).product();
        let none = Knot { radius: f64::NAN, height: f64::NAN, load: f64::INFINITY, pose: usize::MAX };
        let mut sheets = vec![vec![vec![none; count(second)]; count(Some(first))]; combinations];
        for (pose, row) in rows.iter().enumerate() {
            let places = envelope.axes.places(pose);
            let sheet = others.iter().fold(0, |sheet, axis| sheet * axes[*axis].values.len() + places[*axis]);
            let knot = &mut sheets[sheet][places[first]][second.map_or(0, |second| places[second])];
            let load = layout.load_of(row);
            if load < knot.load {
                *knot = Knot { radius: row.numbers[layout.radius()], height: row.numbers[layout.height()], load, pose };
            }
        }
        let label = |sheet: usize| {
            let mut rest = sheet;
            let mut words = Vec::new();
            for axis in others.iter().rev() {
                let (name, unit, factor) = shown(&axes[*axis], &layout.description);
                let value = axes[*axis].values[rest % axes[*axis].values.len()] * factor;
                rest /= axes[*axis].values.len();
                words.push(format!("{name} {} {unit}", short(value)));
            }
            words.reverse();
            words.join(", ")
        };
        let chosen = evenly(sheets.len(), MOST_SHEETS);
        let sheets = sheets.into_iter().enumerate().filter(|(sheet, _)| chosen.contains(sheet));
        let sheets = sheets.map(|(sheet, knots)| Sheet { label: label(sheet), knots });
        Some(Self { sheets: sheets.collect(), unit: layout.columns[layout.load()].unit.clone() })
    }

    /// Knots whose poses have an equilibrium.
    pub fn knots(&self) -> impl Iterator<Item = &Knot> {
        self.sheets.iter().flat_map(|sheet| sheet.knots.iter().flatten()).filter(|knot| knot.radius.is_finite())
    }
}

impl Sheet {
    /// Pairs of neighbours.
    pub fn edges(&self) -> impl Iterator<Item = [Knot; 2]> {
        let along = self.knots.iter().flat_map(|row| row.windows(2).map(|pair| [pair[0], pair[1]]));
        let across = self.knots.windows(2).flat_map(|rows| rows[0].iter().zip(&rows[1]).map(|(a, b)| [*a, *b]));
        along.chain(across)
    }

    /// Whether poses of two drives vary, which reach an area and not only a curve.
    pub fn is_area(&self) -> bool {
        self.knots.len().min(self.knots.first().map_or(0, Vec::len)) > 1
    }

    /// Triangles of neighbours, two for each cell between four poses.
    pub fn triangles(&self) -> impl Iterator<Item = [Knot; 3]> {
        self.knots.windows(2).flat_map(|rows| {
            (1..rows[0].len()).flat_map(|column| {
                let [a, b, c, d] = [rows[0][column - 1], rows[0][column], rows[1][column], rows[1][column - 1]];
                [[a, b, c], [a, c, d]]
            })
        })
    }
}

/// At most `most` of `count` indices, evenly spaced.
pub fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|index| index * (count - 1) / (most - 1)).collect()
}

/// A number with at most two decimals.
pub fn short(number: f64) -> String {
    let text = format!("{number:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// At most `most` round numbers within a range, evenly chosen.
pub fn levels(least: f64, greatest: f64, most: usize) -> Vec<f64> {
    let mut levels = Vec::new();
    if !(least > 0.0 && greatest.is_finite()) {
        return levels;
    }
    let mut power = 10_f64.powf(least.log10().floor());
    while power < greatest {
        levels.extend([1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0].map(|digit| digit * power));
        power *= 10.0;
    }
    levels.retain(|level| (least..greatest).contains(level));
    evenly(levels.len(), most).into_iter().map(|index| levels[index]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_within() {
        assert_eq!(levels(120.0, 1600.0, 6), [120.0, 200.0, 300.0, 500.0, 800.0, 1500.0]);
        assert_eq!(levels(0.0, 10.0, 6), [] as [f64; 0]);
        assert_eq!(evenly(10, 4), [0, 3, 6, 9]);
        assert_eq!(short(0.5), "0.5");
        assert_eq!(short(-0.001), "0");
    }
}
