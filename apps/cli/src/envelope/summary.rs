//! What an envelope shows, in a few lines.

use crane_model::{
    Description, DriveInfo,
    envelope::{Coverage, Envelope},
};
use crane_page::tables::{Cell, Grid, Report};
use serde_json::{Value, json};

use crate::figures::wrapped;

use super::{
    chart::SCREEN,
    ranges::shown,
    reach::reach_facts,
    rows::{ChartRow, Layout},
    surface::short,
};

/// Width of the column of values, characters: a screen without the names of the facts.
const ROOM: usize = SCREEN - 30;

/// The crane, the limits, and the poses that bear the most and the least.
pub fn facts(report: &mut Report, envelope: &Envelope, layout: &Layout, coverage: &Coverage, rows: &[ChartRow]) {
    let description = &layout.description;
    report.fact("crane", description.name.as_str(), "");
    report.fact_as("spec_hash", "hash of the spec", description.spec_hash.as_str(), "");
    report.fact("load", description.parameters[envelope.load].name.as_str(), "");
    if !layout.combinations.is_empty() {
        report.fact("combinations", layout.combinations.join(", "), "");
    }
    if envelope.factor > 1.0 {
        report.line("loads multiplied by", envelope.factor, "");
    }
    for (name, all) in [("limits", &coverage.considered), ("not considered", &coverage.not_considered)] {
        for (index, words) in all.iter().flat_map(|words| wrapped(words, ROOM)).enumerate() {
            report.line(if index == 0 { name } else { "" }, words, "");
        }
    }
    report.value("limits", limits_of(envelope, description, coverage));
    reach_facts(report, &layout.reach);
    report.fact("poses", rows.len(), "");
    let by_load = |a: &&ChartRow, b: &&ChartRow| layout.load_of(a).total_cmp(&layout.load_of(b));
    let rated = || rows.iter().filter(|row| row.numbers[layout.load()].is_finite());
    if let (Some(least), Some(greatest)) = (rated().min_by(by_load), rated().max_by(by_load)) {
        for (key, name, row) in
            [("least", "minimum of the largest loads", least), ("greatest", "maximum of the largest loads", greatest)]
        {
            for (index, words) in row_text(row, envelope, layout).into_iter().enumerate() {
                report.line(if index == 0 { name } else { "" }, words, "");
            }
            report.value(key, rating_of(row, envelope, layout));
        }
    }
    let none = rows.len() - rated().count();
    if none > 0 {
        report.caution(Some(format!(
            "{none} of {} poses are beyond a limit with the minimum load, {} {}, or have no stable equilibrium: they have no \
             largest load, and count as 0 in charts",
            rows.len(),
            envelope.loads[0],
            description.parameters[envelope.load].unit
        )));
    }
    for why in &coverage.without_effect {
        report.caution(Some(why.as_str()));
    }
}

/// Limits, for programs.
fn limits_of(envelope: &Envelope, description: &Description, coverage: &Coverage) -> Value {
    let limits = &envelope.limits;
    let drive = |info: &DriveInfo| &description.coordinates[info.coordinate];
    let efforts = description.drives.iter().zip(&limits.efforts).filter(|(_, effort)| effort.is_finite());
    let efforts = efforts.map(|(info, effort)| {
        json!({"drive": drive(info).name.as_str(), "value": effort, "unit": drive(info).kind.force_unit()})
    });
    let deflections =
        description.points.iter().zip(&limits.deflections).filter(|(_, deflection)| deflection.is_finite());
    let deflections =
        deflections.map(|(point, deflection)| json!({"point": point.as_str(), "value": deflection, "unit": "m"}));
    json!({
        "tipping_margin": limits.tipping,
        "utilisation": limits.utilisation,
        "efforts": efforts.collect::<Vec<_>>(),
        "deflections": deflections.collect::<Vec<_>>(),
        "of_parts": limits.of_parts.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "load_factor": envelope.factor,
        "considered": coverage.considered,
        "not_considered": coverage.not_considered,
    })
}

/// Load, place, pose and governing limit of a row, for programs.
fn rating_of(row: &ChartRow, envelope: &Envelope, layout: &Layout) -> Value {
    let pose = layout.columns[..envelope.axes.0.len()].iter().zip(&row.numbers);
    let pose = pose.map(|(column, value)| json!({"name": column.name, "value": value, "unit": column.unit}));
    let [kind, of] = row.governing.each_ref().map(|words| (!words.is_empty()).then_some(words));
    json!({
        "load": layout.load_of(row),
        "unit": layout.columns[layout.load()].unit,
        "radius": row.numbers[layout.radius()],
        "height": row.numbers[layout.height()],
        "pose": pose.collect::<Vec<_>>(),
        "limit": kind,
        "of": of,
    })
}

/// Load and place of a row; its pose; its governing limit.
fn row_text(row: &ChartRow, envelope: &Envelope, layout: &Layout) -> [String; 3] {
    let pose = envelope.axes.0.iter().zip(&row.numbers).map(|(axis, value)| {
        let (name, unit, factor) = shown(axis, &layout.description);
        let blank = if unit == "°" { "" } else { " " };
        format!("{name} {}{blank}{unit}", short(value * factor))
    });
    let limit = match row.governing.each_ref().map(String::as_str) {
        ["", _] => "up to the maximum load considered".to_owned(),
        ["equilibrium", ""] => "limited by equilibrium".to_owned(),
        [kind, of] => format!("limited by {kind}, {of}"),
    };
    let load = format!(
        "{:.1} {} at a radius of {:.2} m and a height of {:.2} m",
        layout.load_of(row),
        layout.columns[layout.load()].unit,
        row.numbers[layout.radius()],
        row.numbers[layout.height()]
    );
    [load, format!("with {}", pose.collect::<Vec<_>>().join(", ")), limit]
}

/// Which limits govern in how many poses.
pub fn governing(envelope: &Envelope, layout: &Layout, rows: &[ChartRow]) -> Grid {
    let title = "Which limit governs, in how many poses, and for which loads";
    let unit = &layout.description.parameters[envelope.load].unit;
    let headers = [
        "limit".to_owned(),
        "of".to_owned(),
        "poses".to_owned(),
        format!("least load [{unit}]"),
        format!("greatest load [{unit}]"),
    ];
    let mut grid = Grid::new("governing", title, &headers.each_ref().map(String::as_str));
    let mut limits: Vec<&[String; 2]> = rows.iter().map(|row| &row.governing).collect();
    limits.sort_unstable();
    limits.dedup();
    for limit in limits {
        let governed = || rows.iter().filter(|row| row.governing == *limit);
        let loads = || governed().map(|row| layout.load_of(row));
        let kind = if limit[0].is_empty() { "none up to the maximum load" } else { limit[0].as_str() };
        grid.row([
            Cell::from(kind),
            limit[1].as_str().into(),
            governed().count().into(),
            loads().fold(f64::INFINITY, f64::min).into(),
            loads().fold(0.0, f64::max).into(),
        ]);
    }
    grid
}
