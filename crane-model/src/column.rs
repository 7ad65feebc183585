//! Columns of results: names, units and kinds.

use std::fmt;

use crane_quantities::ColumnKind;

/// Name, unit and kind of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// What it shows.
    pub kind: ColumnKind,
}

impl Column {
    /// A column that is none of a part's.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), kind: ColumnKind::Other }
    }

    /// The part whose quantity it is: its name without what its kind adds.
    pub fn part(&self) -> &str {
        let endings = [true, false].into_iter().flat_map(|turns| self.kind.endings(turns));
        endings.filter_map(|ending| self.name.strip_suffix(ending)).min_by_key(|part| part.len()).unwrap_or(&self.name)
    }
}

/// The columns of one kind of a part.
pub(crate) fn columns_of(kind: ColumnKind, part: &str, turns: bool) -> impl Iterator<Item = Column> {
    let column = move |ending: &&str| Column { name: [part, ending].concat(), unit: kind.unit(turns).to_owned(), kind };
    kind.endings(turns).iter().map(column)
}

/// Name of the only column of a kind of a part.
pub fn column_name(kind: ColumnKind, part: &str, turns: bool) -> String {
    [part, kind.endings(turns)[0]].concat()
}

impl fmt::Display for Column {
    /// `name [unit]`, as in the header of a CSV file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.name, self.unit)
    }
}
