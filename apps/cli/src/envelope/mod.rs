//! `crane envelope`: the largest load within limits over ranges of poses and parameters, as a load chart, diagrams and data.

mod chart;
mod figures;
mod given;
mod identity;
mod letters;
mod map;
mod ranges;
mod reach;
mod rows;
mod summary;
mod surface;

use std::{
    io::Write,
    num::NonZeroUsize,
    sync::{Mutex, PoisonError},
    thread,
    time::Instant,
};

use crane_live::LiveCrane;
use crane_model::{
    Description,
    dyn_crane::DynCrane,
    envelope::{Axes, Coverage, Execution, Limits, PartLimit, Rating, range_of_loads},
};
use crane_page::tables::Report;

use crate::{
    arguments::{Envelope, Format, LoadLimits},
    figures::wrapped,
    files,
    journal::{self, Journal, Request},
    problem::{Outcome, Problem},
    screen::Console,
    selection::{Registry, refusal_message},
    strength::load_parameter,
};

use chart::Chart;
use given::{Given, Places};
pub use identity::facts as facts_of_chart;
pub use map::{Map, svg as map_svg};
pub use ranges::{read_ranges, shown, varied};
pub use reach::{header_with_reach, reach, reach_facts, reach_line};
use rows::{ChartRow, Layout};

/// Maximum number of poses: they take some hours.
const MOST_POSES: usize = 10_000_000;

/// Rates all poses and writes the results.
pub fn envelope(options: &Envelope, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let begin = Instant::now();
    let crane = options.analysis.crane.open(registry)?;
    let live = registry.live(crane.as_ref())?;
    let (envelope, mut layout) = ask(options, crane.as_ref(), &live)?;
    let name = crane.description().name.as_str();
    layout.combinations = if options.combinations {
        registry.combinations(name)?
    } else {
        live.chain().combination.iter().cloned().collect()
    };
    let description = crane.description();
    let unit_of_load = &description.parameters[envelope.load].unit;
    let given = options.given.as_deref();
    let given = given
        .map(|file| Given::read(&registry.console, file, unit_of_load, description, &envelope.axes))
        .transpose()?;
    files::folder(&options.folder.out)?;
    let name = format!("{}_envelope", description.name);
    let (rows, journals) = rows_of(options, registry, crane.as_ref(), (&envelope, &layout))?;
    let seconds = registry.console.seconds_since(begin);

    let mut report = Report::default();
    let coverage = Coverage::new(crane.as_ref(), &envelope.limits, live.gravity());
    summary::facts(&mut report, &envelope, &layout, &coverage, &rows);
    if let Some(seconds) = seconds {
        report.fact("wall time", seconds, "s");
    }
    report.value("parameters", identity::parameters(crane.as_ref(), &envelope));
    let mut written = rows::write_rows(&registry.console, &options.folder.out, &name, &envelope, &layout, &rows)?;
    let surface = surface::Surface::new(&envelope, &layout, &rows);
    let chart = surface.as_ref().map(|surface| Chart { surface, rows: &rows, asked_radii: &options.radii });
    let [by_radius, by_place] = chart.as_ref().map_or_else(chart::empty, |chart| [chart.table(), chart.by_place()]);
    if let Some(chart) = &chart {
        for (end, grid, radius) in [("load_chart", &by_radius, 0), ("loads_by_place", &by_place, 1)] {
            let file = format!("{name}_{end}.csv");
            let (header, rows) = grid.fields();
            let header = header_with_reach(header, radius, &layout.reach);
            registry.console.write_fields(&options.folder.out.join(&file), header, rows)?;
            written.push(file);
        }
        chart.by_radius().into_iter().chain(chart.plates()).for_each(|grid| report.shown(grid));
    }
    if let Some(given) = &given {
        match (&given.places, &chart) {
            (Places::Positions(positions), _) => report.grid(given.beside(positions, &envelope, &layout, &rows)),
            (Places::Radii(radii), Some(chart)) => report.grid(chart.beside(radii, &given.loads)),
            (Places::Radii(_), None) => {
                report.caution(Some("no chart beside the given one: no range moves the load in or out"));
            }
        }
    }
    report.data(by_radius);
    report.data(by_place);
    report.grid(summary::governing(&envelope, &layout, &rows));
    let heading = figures::Heading::new(&envelope, &layout, &coverage);
    written.extend(figures::write_chart_figures(
        &registry.console,
        &options.folder.out,
        &name,
        &envelope,
        &layout,
        &rows,
        (surface.as_ref(), &heading),
    )?);
    let companion = format!("{name}.json");
    written.push(companion.clone());
    journals.into_iter().try_for_each(Journal::remove)?;
    report.grid(crate::simulate::file_list(&options.folder.out, &written));
    registry.console.write_text(&options.folder.out.join(&companion), &format!("{:#}\n", report.json()))?;
    options.analysis.format.print(&report, &registry.console, out)?;
    if options.analysis.format == Format::Table {
        writeln!(out, "\n{}", wrapped(chart::NOTE, chart::SCREEN).join("\n"))?;
    }
    Ok(())
}

/// The rows of all poses, with all combinations if the arguments ask for them; and the journals, which have them until they are written.
fn rows_of(
    options: &Envelope,
    registry: &Registry,
    crane: &dyn DynCrane,
    (asked, layout): (&crane_model::envelope::Envelope, &Layout),
) -> Outcome<(Vec<ChartRow>, Vec<Journal>)> {
    let name = crane.description().name.as_str();
    let rate = |crane: &dyn DynCrane, name: &str| -> Outcome<(Vec<ChartRow>, Journal)> {
        let file = options.folder.out.join(format!("{name}_envelope.part.csv"));
        let request = Request {
            line: format!("{} {asked:?} {:?}", journal::identity(crane), layout.reach.words()),
            of: "an envelope",
            elsewhere: "choose another folder with `--out`",
        };
        let (journal, records) = Journal::open(&file, &request, options.restart)?;
        let kept = kept_rows(&records, asked, layout);
        Ok((rate(&registry.console, asked, layout, crane, options.threads, &journal, kept)?, journal))
    };
    if !options.combinations {
        let (rows, journal) = rate(crane, name)?;
        return Ok((rows, vec![journal]));
    }
    let (mut least, mut journals): (Vec<ChartRow>, _) = (Vec::new(), Vec::new());
    for combination in &layout.combinations {
        let combined = registry.live_combined(crane, combination)?;
        let (mut rows, journal) = rate(&combined, &format!("{name}_{combination}"))?;
        for row in &mut rows {
            row.govern_with(combination);
        }
        least = if least.is_empty() { rows } else { layout.least(least, rows) };
        journals.push(journal);
    }
    Ok((least, journals))
}

/// What the arguments ask for.
fn ask(
    options: &Envelope,
    crane: &dyn DynCrane,
    live: &LiveCrane,
) -> Outcome<(crane_model::envelope::Envelope, Layout)> {
    let description = crane.description();
    let axes = read_ranges(&options.ranges, description)?;
    if axes.poses() > MOST_POSES {
        return Err(Problem::usage(
            format!("{} poses are more than {MOST_POSES}", axes.poses()),
            "write smaller counts in `--range NAME=FROM:TO:COUNT`",
        ));
    }
    let asked = within(&options.limits, axes, crane)?;
    let reach = reach(options.point.as_deref(), Some(asked.load), live)?;
    let layout = Layout::new(&asked, description, reach);
    Ok((asked, layout))
}

/// The largest load within limits over some axes.
///
/// # Errors
/// There is no such load, or a limit is not one of the crane.
pub fn within(options: &LoadLimits, axes: Axes, crane: &dyn DynCrane) -> Outcome<crane_model::envelope::Envelope> {
    let description = crane.description();
    let load = load_parameter(crane, options.load.as_deref())?.ok_or_else(|| {
        Problem::usage(
            format!("{} does not have exactly one live parameter in kg to vary as the load", description.name),
            "name the live parameter that is the load, as in `--load payload`; `crane info` lists them",
        )
    })?;
    let info = &description.parameters[load];
    if ranges::varies(&axes, load) {
        return Err(Problem::usage(
            format!("{} is the load, which is found for each pose", info.name),
            "leave its `--range` out, or name another load with `--load`",
        ));
    }
    let [least, greatest] = range_of_loads(crane, load, options.greatest_load);
    if greatest.is_nan() || greatest <= least {
        return Err(Problem::usage(
            format!("`--greatest-load {greatest}` is not above the minimum load, {least}"),
            format!("write a number above {least}, in {}", info.unit),
        ));
    }
    let without = |name: &str| options.without.iter().any(|left_out| left_out.name() == name);
    let more = [(options.lift_off, PartLimit::LiftOff), (options.slack_ropes, PartLimit::SlackRopes)];
    let of_parts = PartLimit::DEFAULT.into_iter().filter(|kind| !without(kind.name()));
    let limits = Limits {
        tipping: Some(options.tipping).filter(|_| !without("tipping")),
        utilisation: Some(options.utilisation).filter(|_| !without("utilisation")),
        of_parts: of_parts.chain(more.into_iter().filter(|(asked, _)| *asked).map(|(_, kind)| kind)).collect(),
        efforts: ranges::limits(&options.efforts, "effort", "drive", &drives(description))?,
        deflections: ranges::limits(&options.deflections, "deflection", "point", &points(description))?,
    };
    let factor = options.load_factor;
    Ok(crane_model::envelope::Envelope { axes, load, loads: [least, greatest], limits, factor })
}

fn drives(description: &Description) -> Vec<&str> {
    description.drives.iter().map(|drive| description.coordinates[drive.coordinate].name.as_str()).collect()
}

fn points(description: &Description) -> Vec<&str> {
    description.points.iter().map(crane_model::Text::as_str).collect()
}

/// Rows of the poses that an interrupted command completed. A piece counts only as a whole.
fn kept_rows(
    records: &[Vec<String>],
    asked: &crane_model::envelope::Envelope,
    layout: &Layout,
) -> Vec<Option<ChartRow>> {
    let mut kept = vec![None; asked.axes.poses()];
    for (pose, row) in records.iter().filter_map(|record| layout.read(record)) {
        if let Some(slot) = kept.get_mut(pose) {
            *slot = Some(row);
        }
    }
    for piece in 0..asked.pieces() {
        if asked.poses_of(piece).any(|pose| kept[pose].is_none()) {
            asked.poses_of(piece).for_each(|pose| kept[pose] = None);
        }
    }
    kept
}

/// Rates the poses that the journal does not have yet; returns all rows, in order.
fn rate(
    console: &Console,
    asked: &crane_model::envelope::Envelope,
    layout: &Layout,
    crane: &dyn DynCrane,
    threads: Option<NonZeroUsize>,
    journal: &Journal,
    kept: Vec<Option<ChartRow>>,
) -> Outcome<Vec<ChartRow>> {
    let threads = threads.map_or_else(thread::available_parallelism, Ok).map_or(1, NonZeroUsize::get);
    let pieces: Vec<usize> =
        (0..asked.pieces()).filter(|piece| asked.poses_of(*piece).any(|pose| kept[pose].is_none())).collect();
    let bar = console.batches(asked.axes.poses());
    bar.set_message("poses");
    bar.inc(kept.iter().flatten().count() as u64);
    let state = Mutex::new((kept, Ok(())));
    let done = |piece: usize, ratings: &[Rating]| {
        let poses = asked.poses_of(piece);
        let rows: Vec<ChartRow> =
            poses.clone().zip(ratings).map(|(pose, rating)| layout.row(asked, crane, pose, rating)).collect();
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.1.is_ok() {
            state.1 = journal.add(poses.clone().zip(&rows).map(|(pose, row)| row.record(pose)));
        }
        for (pose, row) in poses.zip(rows) {
            state.0[pose] = Some(row);
        }
        bar.inc(ratings.len() as u64);
    };
    let failed = || state.lock().unwrap_or_else(PoisonError::into_inner).1.is_err();
    let run = asked.run(crane, &pieces, &Execution { threads, done: &done, cancelled: &failed });
    bar.finish_and_clear();
    run.map_err(|refused| {
        let (title, help) = refusal_message(&refused);
        Problem::usage(title, help)
    })?;
    let (rows, written) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    written?;
    rows.into_iter().map(|row| row.ok_or_else(|| Problem::failed("a pose is missing", "please report it"))).collect()
}
