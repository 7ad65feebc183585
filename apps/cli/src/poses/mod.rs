//! Poses that `--hold` and `--range` ask for: drives that hold, and one row of quantities per pose.

mod quantities;

use std::{io::Write, num::NonZeroUsize, path::Path};

use crane_codegen::{Change, spec::Crane};
use crane_model::{
    CoordinateKind, Description,
    dyn_crane::DynCrane,
    envelope::{Axes, TURN, Varied},
};
use crane_page::tables::Report;

use crate::{
    arguments::{Action, Analysis, Poses},
    envelope::{self, read_ranges},
    figures::titled,
    problem::{Outcome, Problem},
    quantity::{is_bare, number},
    selection::{Registry, set_parameters},
};
use quantities::{PoseRow, Quantities, figure, table};

/// What makes the drives of a crane hold their positions. Positions that `--range` varies become live parameters, so that the crane is
/// derived once.
///
/// # Errors
/// There is no such drive, or a position is wrong.
pub fn hold(held: &[String], ranges: &[String], description: &Description, spec: &Crane) -> Outcome<Change> {
    let (mut parameters, mut drives) = (Vec::new(), Vec::new());
    let mut is_held = vec![false; description.drives.len()];
    let offset = offset_drives(spec);
    let name_of = |drive: usize| format!("`{}`", description.coordinates[description.drives[drive].coordinate].name);
    for text in held {
        let (drive, _) = text.split_once('=').ok_or_else(|| {
            let help = "write `--hold drive=position`, such as `--hold boom_psi=30deg`";
            Problem::usage(format!("`--hold {text}` has no value"), help)
        })?;
        let Varied::Drive(drive) = envelope::varied(drive.trim(), description)? else {
            return Err(Problem::usage(
                format!("{drive} is a live parameter, not a drive"),
                format!("write `--set {text}`"),
            ));
        };
        let value = held_number(text, description.coordinates[description.drives[drive].coordinate].kind, false)?;
        if std::mem::replace(&mut is_held[drive], true) {
            let title = format!("{} is held twice", name_of(drive));
            return Err(Problem::usage(title, "leave one of the two out"));
        }
        drives.push(held_at(description, drive, value.into(), &offset));
    }
    for axis in &read_ranges(ranges, description)?.0 {
        if let Varied::Drive(drive) = axis.varied {
            if is_held[drive] {
                let title = format!("{} is held and varied", name_of(drive));
                return Err(Problem::usage(title, "leave `--hold` or `--range` of it out"));
            }
            let info = &description.coordinates[description.drives[drive].coordinate];
            let parameter = parameter_of(description, drive);
            drives.push(held_at(description, drive, parameter.as_str().into(), &offset));
            let entry = Change::keys([("value", axis.values[0].into()), ("unit", info.kind.unit().into())]);
            parameters.push((parameter, entry));
        }
    }
    let lists = [
        (!parameters.is_empty()).then(|| ("parameters", Change::keys(parameters))),
        (!drives.is_empty()).then(|| ("drives", Change::list(drives))),
    ];
    Ok(Change::keys(lists.into_iter().flatten()))
}

/// The number of `--hold NAME=VALUE`, of a coordinate or its rate.
///
/// # Errors
/// It is not finite, no crane moves so far or so fast, or an angle is probably in degrees.
pub fn held_number(text: &str, kind: CoordinateKind, is_rate: bool) -> Outcome<f64> {
    /// Largest position or rate, m, rad, m/s or rad/s.
    const FARTHEST: f64 = 1e6;
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let (what, per) = if is_rate { ("rate", "/s") } else { ("position", "") };
    let unit = &format!("{}{per}", kind.unit());
    // `30deg` of a rate is 30° per second.
    let of_angle =
        if is_rate && kind == CoordinateKind::Rotation { number(kind.unit(), value, name).ok() } else { None };
    let number = of_angle.map_or_else(|| number(unit, value, name), Ok)?;
    if number.abs() > FARTHEST {
        let help = format!("write a {what} in {unit}, at most {FARTHEST:e}");
        return Err(Problem::usage(format!("`--hold {}` is out of range", text.trim()), help));
    }
    if kind == CoordinateKind::Rotation && !is_rate && number.abs() > TURN && is_bare(value) {
        return Err(Problem::usage(
            format!("`--hold {text}` is {number} rad, {:.0}°", number.to_degrees()),
            format!("write degrees with their unit, `--hold {}deg`", text.trim()),
        ));
    }
    Ok(number)
}

/// Coordinates whose drives have an offset.
fn offset_drives(spec: &Crane) -> Vec<String> {
    let drives = spec.drives.iter().filter_map(|drives| drives.value.as_ref()).flatten();
    let offset = drives.filter_map(|drive| drive.value.as_ref().filter(|drive| drive.offset.is_some()));
    offset.filter_map(|drive| drive.coordinate.value.clone()).collect()
}

/// A drive that holds a position instead of moving, and that no input offsets.
fn held_at(description: &Description, drive: usize, position: Change, offset: &[String]) -> Change {
    let coordinate = &description.coordinates[description.drives[drive].coordinate].name;
    let mut keys = vec![("coordinate", coordinate.as_str().into()), ("motion", Change::keys([("hold", position)]))];
    if offset.iter().any(|own| *own == coordinate.as_str()) {
        keys.push(("offset", Change::removed()));
    }
    Change::keys(keys)
}

/// Name of the live parameter at whose value a drive holds.
fn parameter_of(description: &Description, drive: usize) -> String {
    let coordinate = &description.coordinates[description.drives[drive].coordinate].name;
    // An underscore at the end, which no unit or word of a user needs, keeps it apart.
    format!("hold_{coordinate}_")
}

/// Rows that `--range` asks for.
pub struct PosesRequest<'a> {
    poses: &'a Poses,
    wanted: Quantities,
    analysis: &'a Analysis,
    /// Where the table goes, too.
    file: Option<&'a Path>,
}

/// What an action asks for by `--range`, if it does.
pub fn asked(action: &Action) -> Option<PosesRequest<'_>> {
    /// Number of lowest modes for each pose.
    const LOWEST: usize = 3;
    let (wanted, analysis, file) = match action {
        Action::Statics(options) => (Quantities::Statics, &options.analysis, &options.file),
        Action::Strength(options) => (Quantities::Strength, &options.analysis, &options.results),
        Action::Modes(options) => {
            (Quantities::Modes(options.count.map_or(LOWEST, NonZeroUsize::get)), &options.analysis, &options.file)
        }
        _ => return None,
    };
    let poses = action.poses().filter(|poses| !poses.ranges.is_empty())?;
    Some(PosesRequest { poses, wanted, analysis, file: file.as_deref() })
}

/// Computes the rows of `--range` and writes them.
pub fn rows(asked: &PosesRequest<'_>, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let PosesRequest { poses, wanted, analysis, file } = asked;
    let crane = analysis.crane.open(registry)?;
    let description = crane.description();
    let axes = read_ranges(&poses.ranges, description)?;
    let subject = quantities::PosedCrane::new(crane.as_ref(), &axes, poses.point.as_deref(), *wanted, registry)?;
    let bar = registry.console.batches(axes.poses());
    let mut rows: Vec<PoseRow> = Vec::new();
    for pose in 0..axes.poses() {
        rows.push(subject.row(&settings(&axes, pose, description)?)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact_as("count", "poses", rows.len(), "");
    let standing = rows.iter().filter(|row| row.stands()).count();
    report.fact_as("stable_poses", "of which stable", standing, "");
    envelope::reach_facts(&mut report, &subject.reach);
    for caution in subject.cautions(&rows) {
        report.caution(Some(caution));
    }
    let grid = table(&subject, &rows);
    if let Some(file) = file {
        let (header, fields) = grid.fields();
        let header = envelope::header_with_reach(header, axes.0.len(), &subject.reach);
        registry.console.write_fields(file, header, fields)?;
        let panels = figure(&subject, &rows);
        if !panels.is_empty() {
            let file = file.with_extension("svg");
            let picture = titled(&[subject.reach.words()], &panels, 2)
                .map_err(|error| Problem::failed(format!("cannot draw {}: {error}", file.display()), ""))?;
            registry.console.write_text(&file, &picture)?;
        }
    }
    report.grid(grid);
    analysis.format.print(&report, &registry.console, out)?;
    if standing == 0 {
        return Err(Problem::failed("the crane has no stable equilibrium in any of the poses", "choose other ranges"));
    }
    Ok(())
}

/// Parameters of a pose, by their indices.
pub fn settings(axes: &Axes, pose: usize, description: &Description) -> Outcome<Vec<(usize, f64)>> {
    let coordinate_of = |varied| match varied {
        Varied::Parameter(index) => Some(index),
        Varied::Drive(drive) => {
            let name = parameter_of(description, drive);
            description.parameters.iter().position(|parameter| *parameter.name == *name)
        }
    };
    let pairs = axes.0.iter().zip(axes.values(pose));
    let found: Option<Vec<(usize, f64)>> =
        pairs.map(|(axis, value)| Some((coordinate_of(axis.varied)?, value))).collect();
    found.ok_or_else(|| Problem::failed("a drive does not hold", "please report this as a bug"))
}

/// The crane in a pose.
fn posed(crane: &dyn DynCrane, settings: &[(usize, f64)]) -> Outcome<Box<dyn DynCrane>> {
    let mut crane = crane.boxed_clone();
    set_parameters(crane.as_mut(), settings)?;
    Ok(crane)
}
