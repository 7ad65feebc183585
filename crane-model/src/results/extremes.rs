//! Minimum and maximum of a quantity, signed, and their times.

use super::Table;

/// Minimum and maximum of a quantity, and their first times.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    /// Minimum.
    pub minimum: f64,
    /// Its time, s.
    pub time_of_minimum: f64,
    /// Maximum.
    pub maximum: f64,
    /// Its time, s.
    pub time_of_maximum: f64,
}

impl Extremes {
    /// Extremes of the column with this name; zeros if there is none.
    pub fn of_column(table: &Table, name: &str) -> Self {
        let Some(values) = table.values(name) else { return Self::default() };
        Self::over(table.rows.iter().map(|row| row[0]).zip(values))
    }

    /// Extremes of values behind their times, s; zeros if there are none.
    pub fn over(mut values: impl Iterator<Item = (f64, f64)>) -> Self {
        let Some((t, first)) = values.next() else { return Self::default() };
        let mut extremes = Self::at(t, first);
        values.for_each(|(t, value)| extremes.widen(t, value));
        extremes
    }

    /// Extremes of several columns, in one pass.
    pub(super) fn of_all<'n>(table: &Table, names: impl Iterator<Item = &'n str>) -> Vec<Self> {
        let Some((first, rest)) = table.rows.split_first() else { return names.map(|_| Self::default()).collect() };
        let place = |name: &str| table.columns.iter().position(|column| column.name == name);
        let places: Vec<Option<usize>> = names.map(place).collect();
        let begin =
            |place: &Option<usize>| place.map_or_else(Self::default, |column| Self::at(first[0], first[column]));
        let mut found: Vec<Self> = places.iter().map(begin).collect();
        for row in rest {
            for (extremes, place) in found.iter_mut().zip(&places) {
                if let Some(column) = place {
                    extremes.widen(row[0], row[*column]);
                }
            }
        }
        found
    }

    /// The largest absolute value.
    pub fn size(&self) -> f64 {
        self.minimum.abs().max(self.maximum.abs())
    }

    /// The extremes of one value.
    pub fn at(t: f64, value: f64) -> Self {
        Self { minimum: value, time_of_minimum: t, maximum: value, time_of_maximum: t }
    }

    /// Includes a later value. The first NaN is the result: extremes without it would be wrong.
    pub fn widen(&mut self, t: f64, value: f64) {
        if value < self.minimum || (value.is_nan() && !self.minimum.is_nan()) {
            (self.minimum, self.time_of_minimum) = (value, t);
        }
        if value > self.maximum || (value.is_nan() && !self.maximum.is_nan()) {
            (self.maximum, self.time_of_maximum) = (value, t);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_keep_their_signs_and_first_times() {
        let mut extremes = Extremes::at(0.0, -1.0);
        for (t, value) in [(1.0, -3.0), (2.0, 2.0), (3.0, -3.0), (4.0, 2.0)] {
            extremes.widen(t, value);
        }
        let expected = Extremes { minimum: -3.0, time_of_minimum: 1.0, maximum: 2.0, time_of_maximum: 2.0 };
        assert_eq!(extremes, expected);
        extremes.widen(5.0, f64::NAN);
        extremes.widen(6.0, 9.0);
        let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = extremes;
        assert!(minimum.is_nan() && maximum.is_nan() && [time_of_minimum, time_of_maximum] == [5.0, 5.0]);
    }
}
