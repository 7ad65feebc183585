//! Numbers of a run that are asked for by name.

use std::error::Error;
use std::fmt;

use crane_codegen::diagnostic::similar;
use crane_model::results::Column;
use crane_model::runs::Measure;

/// Why a run has no number of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotAsked {
    /// What is wrong.
    pub title: String,
    /// What to write instead.
    pub hint: String,
}

impl fmt::Display for NotAsked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.title, self.hint)
    }
}

impl Error for NotAsked {}

/// The column, by its index, and the measure of a name as `boom_psi_drive_torque.peak`; the peak if it names none. `has_derivatives`: of columns by
/// their indices.
///
/// # Errors
/// There is no such column or measure, or the column has no derivatives.
pub fn asked(
    columns: &[Column],
    name: &str,
    has_derivatives: &dyn Fn(usize) -> bool,
) -> Result<(usize, Measure), NotAsked> {
    let (column, of) = name.rsplit_once('.').unwrap_or((name, Measure::Peak.name()));
    let Some(measure) = Measure::ALL.into_iter().find(|own| own.name() == of) else {
        let hint = format!("write one of {}, as in `{column}.peak`", Measure::ALL.map(Measure::name).join(", "));
        return Err(NotAsked { title: format!("there is no `{of}` of a column"), hint });
    };
    if columns.first().is_some_and(|first| first.name == column) {
        let title = format!("`{column}` is the time, on which nothing depends");
        return Err(NotAsked { title, hint: "name another column".into() });
    }
    let names = || columns.iter().skip(1).map(|column| column.name.as_str());
    let Some(index) = names().position(|own| own == column).map(|place| place + 1) else {
        let similar =
            similar(column, names()).map_or_else(String::new, |similar| format!("did you mean `{similar}`? "));
        let hint = format!("{similar}columns: {}", names().collect::<Vec<_>>().join(", "));
        return Err(NotAsked { title: format!("the run has no column `{column}`"), hint });
    };
    if !has_derivatives(index) {
        let title =
            format!("`{column}` has no derivatives: it is an integral over the run, by the audit of its energy");
        return Err(NotAsked { title, hint: "name another column".into() });
    }
    Ok((index, measure))
}
