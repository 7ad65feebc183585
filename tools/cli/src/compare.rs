//! `crane` alone: compares the eight-link crane with a rigid and with a flexible boom, as [Urbaś 2016, section 3] does.

use std::{io::Write, mem, thread, time::Instant};

use crane_model::{
    Description,
    dynamics::{Method, Settings},
    results::Table,
    runs::Recorded,
};

use crate::{
    Fleet,
    arguments::{Compare, Format, Limits, Timing},
    extremes::extremes,
    figures::{Curve, Mark, PALETTE, Panel},
    files, page,
    problem::{Outcome, Problem},
    run::{progress, record_checked},
    simulate::{Trace, file_list, points, spoken, summary, write_figure, write_figures, write_run},
    statics::{Case, caution_of_runs, deflection, tables},
};

/// The rigid and the flexible crane.
pub const CRANES: [&str; 2] = ["eight_link_rigid", "eight_link_flexible"];

/// Statics and motion of both cranes, figures and data.
pub fn compare(options: &Compare, fleet: &Fleet, out: &mut dyn Write) -> Outcome<()> {
    let begin = Instant::now();
    let (rigid, flexible) =
        (options.parameters.crane(CRANES[0], false, fleet)?, options.parameters.crane(CRANES[1], false, fleet)?);
    let folder = &options.folder.out;

    let cases = [Case::new("rigid", rigid.as_ref()), Case::new("flexible", flexible.as_ref())];
    let format = options.format;
    let mut report = tables(&cases, options.limits);
    let [rigid_case, flexible_case] = &cases;
    report.grid(deflection(rigid_case, flexible_case));
    if format == Format::Table {
        // Something to read while the cranes move.
        let [rigid, flexible] = [&rigid, &flexible].map(|crane| crane.description());
        writeln!(out, "Comparing {} and {}.", rigid.name, flexible.name)?;
        writeln!(out, "Figures (SVG), results (CSV) and report.html go to the folder {}.\n", folder.display())?;
        writeln!(out, "Statics of {}\n", flexible.title)?;
        mem::take(&mut report).print(format, out)?;
    }

    files::folder(folder)?;
    let (settings, runs) = runs(&cases, &options.timing, options.limits, Method::Rk4)?;
    let [rigid_run, flexible_run] = runs.as_slice() else {
        return Err(Problem::failed("a simulation is missing", "please report this as a bug"));
    };

    let mut written = Vec::new();
    for ((case, settings), run) in cases.iter().zip(&settings).zip(&runs) {
        written.extend(write_run(folder, case.rig, settings, run)?);
    }
    let description = flexible.description();
    let traces = [
        Trace { label: flexible_case.label, table: &flexible_run.table, dashed: false },
        Trace { label: rigid_case.label, table: &rigid_run.table, dashed: true },
    ];
    written.extend(write_figures(folder, "comparison_", description, &traces)?);
    let deviation_file = "comparison_deviation.svg".to_owned();
    write_figure(&folder.join(&deviation_file), &deviation(description, &rigid_run.table, &flexible_run.table), 1)?;
    written.push(deviation_file);

    let page = "report.html";
    page::write(&folder.join(page), fleet, (&cases, options.limits), &settings, &runs)?;
    written.push(page.to_owned());

    let labelled = [("rigid", rigid_run), ("flexible", flexible_run)];
    caution_of_runs(&mut report, labelled.into_iter());
    report.grid(extremes(description, &labelled));
    report.grid(summary(&labelled));
    report.grid(file_list(folder, &written));
    if format == Format::Table {
        let (duration, method, step) = (settings[1].duration, settings[1].method.title(), flexible_run.run.step);
        writeln!(out, "\nMotion over {duration} s from the {}, {method}, step {step} s\n", flexible_run.start)?;
    }
    report.print(format, out)?;
    if format == Format::Table {
        writeln!(out, "\nTotal time: {:.1} s", begin.elapsed().as_secs_f64())?;
    }
    Ok(())
}

/// Runs cranes side by side, each from its own start; `default`: the method unless one is asked for.
pub fn runs(
    cases: &[Case<'_>],
    timing: &Timing,
    limits: Limits,
    default: Method,
) -> Outcome<(Vec<Settings>, Vec<Recorded>)> {
    // The last is the one that the arguments are about.
    let starts = cases.iter().enumerate();
    let starts =
        starts.map(|(index, case)| timing.start(case.rig, index + 1 < cases.len())).collect::<Outcome<Vec<_>>>()?;
    let settings = cases
        .iter()
        .zip(&starts)
        .map(|(case, start)| timing.settings(case.rig, start, default))
        .collect::<Outcome<Vec<_>>>()?;
    let bar = progress(settings.iter().map(|settings| settings.duration).sum());
    bar.set_message("simulating");
    let results: Vec<Outcome<Recorded>> = thread::scope(|scope| {
        let runs: Vec<_> = cases
            .iter()
            .zip(&starts)
            .zip(&settings)
            .map(|((case, start), settings)| {
                scope.spawn(|| record_checked(case.rig, start, settings, (!timing.no_verify, limits), &bar))
            })
            .collect();
        let broken = |_| Err(Problem::failed("a simulation broke off", "please report this as a bug"));
        runs.into_iter().map(|run| run.join().unwrap_or_else(broken)).collect()
    });
    bar.finish_and_clear();
    Ok((settings, results.into_iter().collect::<Outcome<_>>()?))
}

/// How far the flexible crane's points are from the rigid one's over time, along each axis.
fn deviation(description: &Description, rigid: &Table, flexible: &Table) -> Vec<Panel> {
    let panel = |axis: &str| {
        let curves = description.points.iter().zip(PALETTE.iter().cycle()).map(|(point, &colour)| {
            let column = format!("{point}_{axis}");
            let [from, to] = [rigid, flexible].map(|table| points(table, "t", &column, 1e3));
            let difference = from.iter().zip(&to).map(|(from, to)| (to.0, to.1 - from.1)).collect();
            Curve { label: spoken(point), colour, mark: Mark::Solid, points: difference }
        });
        Panel {
            x: "t [s]".to_owned(),
            y: format!("Δ{axis}, flexible − rigid [mm]"),
            equal: false,
            logarithmic: false,
            curves: curves.collect(),
        }
    };
    ["x", "y", "z"].map(panel).into()
}
