//! What an envelope shows, in a few lines.

use crane_model::{
    Description, DriveInfo,
    envelope::{Envelope, Limits},
};
use crane_page::tables::{Cell, Grid, Report};
use serde_json::{Value, json};

use super::{
    ranges::shown,
    rows::{Layout, Row},
    surface::short,
};

/// The crane, the limits, and the poses that bear the most and the least.
pub fn facts(report: &mut Report, asked: &Envelope, layout: &Layout, description: &Description, rows: &[Row]) {
    report.fact("crane", description.name.as_str(), "");
    report.fact("load", description.parameters[asked.load].name.as_str(), "");
    let limits = &asked.limits;
    let mut said = Vec::new();
    said.extend(limits.tipping.map(|margin| format!("tipping margin at least {margin}")));
    said.extend(limits.utilisation.map(|utilisation| format!("utilisation at most {utilisation}")));
    for (drive, effort) in description.drives.iter().zip(&limits.efforts).filter(|(_, effort)| effort.is_finite()) {
        let coordinate = &description.coordinates[drive.coordinate];
        said.push(format!("{} at most {effort} {}", coordinate.name, coordinate.kind.force_unit()));
    }
    for (point, way) in description.points.iter().zip(&limits.deflections).filter(|(_, way)| way.is_finite()) {
        said.push(format!("the load moves {point} by at most {way} m"));
    }
    report.line("limits", said.join("; "), "");
    report.value("limits", limits_of(limits, description));
    report.fact("poses", rows.len(), "");
    let by_load = |a: &&Row, b: &&Row| layout.load_of(a).total_cmp(&layout.load_of(b));
    let rated = || rows.iter().filter(|row| row.numbers[layout.load()].is_finite());
    if let (Some(least), Some(greatest)) = (rated().min_by(by_load), rated().max_by(by_load)) {
        for (key, name, row) in
            [("least", "minimum of the largest loads", least), ("greatest", "maximum of the largest loads", greatest)]
        {
            report.line(name, told(row, asked, layout), "");
            report.value(key, rating_of(row, asked, layout));
        }
    }
    let none = rows.len() - rated().count();
    if none > 0 {
        report.caution(Some(format!(
            "{none} of {} poses are beyond a limit with the minimum load, {} {}, or have no stable equilibrium: they have no \
             largest load, and count as 0 in charts",
            rows.len(),
            asked.loads[0],
            description.parameters[asked.load].unit
        )));
    }
    if limits.tipping.is_some() && rows.iter().all(|row| row.numbers[layout.margin()].is_nan()) {
        report.caution(Some("tipping limits nothing: there are no supports, or they form no polygon"));
    }
    if limits.utilisation.is_some() && rows.iter().all(|row| row.numbers[layout.utilisation()].is_nan()) {
        report
            .caution(Some("utilisation limits nothing: no beam has a section with known moduli and a `yield_stress`"));
    }
}

/// Limits, for programs.
fn limits_of(limits: &Limits, description: &Description) -> Value {
    let drive = |info: &DriveInfo| &description.coordinates[info.coordinate];
    let efforts = description.drives.iter().zip(&limits.efforts).filter(|(_, effort)| effort.is_finite());
    let efforts = efforts.map(|(info, effort)| {
        json!({"drive": drive(info).name.as_str(), "value": effort, "unit": drive(info).kind.force_unit()})
    });
    let deflections = description.points.iter().zip(&limits.deflections).filter(|(_, way)| way.is_finite());
    let deflections = deflections.map(|(point, way)| json!({"point": point.as_str(), "value": way, "unit": "m"}));
    json!({
        "tipping_margin": limits.tipping,
        "utilisation": limits.utilisation,
        "efforts": efforts.collect::<Vec<_>>(),
        "deflections": deflections.collect::<Vec<_>>(),
    })
}

/// Load, place, pose and governing limit of a row, for programs.
fn rating_of(row: &Row, asked: &Envelope, layout: &Layout) -> Value {
    let pose = layout.columns[..asked.axes.0.len()].iter().zip(&row.numbers);
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

/// Load, place, pose and governing limit of a row.
fn told(row: &Row, asked: &Envelope, layout: &Layout) -> String {
    let pose = asked.axes.0.iter().zip(&row.numbers).map(|(axis, value)| {
        let (name, unit, factor) = shown(axis, &layout.description);
        let blank = if unit == "°" { "" } else { " " };
        format!("{name} {}{blank}{unit}", short(value * factor))
    });
    let limit = match row.governing.each_ref().map(String::as_str) {
        ["", _] => "up to the maximum load considered".to_owned(),
        ["equilibrium", _] => "limited by equilibrium: there is none beyond".to_owned(),
        [kind, of] => format!("limited by {kind}, {of}"),
    };
    format!(
        "{:.1} {} at a radius of {:.2} m and a height of {:.2} m ({}), {limit}",
        layout.load_of(row),
        layout.columns[layout.load()].unit,
        row.numbers[layout.radius()],
        row.numbers[layout.height()],
        pose.collect::<Vec<_>>().join(", ")
    )
}

/// Which limits govern in how many poses.
pub fn governing(asked: &Envelope, layout: &Layout, rows: &[Row]) -> Grid {
    let title = "Which limit governs, in how many poses, and for which loads";
    let unit = &layout.description.parameters[asked.load].unit;
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
