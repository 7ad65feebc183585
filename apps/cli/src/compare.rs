//! `crane` alone: compares the eight-link crane with a rigid and with a flexible boom, as [Urbaś 2016, section 3] does; `crane compare`:
//! any two cranes.

use std::{io::Write, mem, time::Instant};

use crane_codegen::read;
use crane_model::{Description, dyn_crane::DynCrane, dynamics::Method, results::Table};
use crane_page::tables::{Case, FLEXIBLE, RIGID, add_runs, caution_of_runs, deflection, equilibria, extremes};

use crate::{
    arguments::{Compare, ComparePair, Format, Parameters, spec_file},
    figures::{Curve, Mark, PALETTE, Panel},
    files,
    integration::{prepare, runs},
    page,
    problem::{Outcome, Problem},
    selection::{Registry, set_inputs},
    simulate::{Trace, file_list, points, spoken, write_figure, write_figures, write_run},
    spec_file,
    variants::{Edit, edited},
};

/// The rigid and the flexible crane.
pub const CRANES: [&str; 2] = ["eight_link_rigid", "eight_link_flexible"];

/// The eight-link cranes: statics and motion, figures and data.
pub fn compare(options: &Compare, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let [rigid, flexible] = CRANES.map(|name| options.parameters.crane(name, false, registry));
    side_by_side(options, [(RIGID, rigid?), (FLEXIBLE, flexible?)], Method::Rk4, registry, out)
}

/// Adds the cranes of YAML files, or the rigid one, to the registry, and puts their names in place of the files.
pub fn load(options: &mut ComparePair, registry: &mut Registry) -> Outcome<()> {
    let ComparePair { first, second, strict, .. } = options;
    if let Some(file) = spec_file(first) {
        *first = registry.add_file(file, &[], *strict)?;
    }
    let Some(name) = second else {
        // The first becomes the rigid crane, as in the comparison of the eight-link cranes.
        let otherwise = format!("give a second crane to compare it with: `crane compare {first} other.yaml`");
        let rigid = registry.edit(first, &[Edit::Rigid(&otherwise)])?;
        *second = Some(mem::replace(first, rigid));
        return Ok(());
    };
    if let Some(file) = spec_file(name) {
        let spec = read(&spec_file::open(&registry.console, file, spec_file::SPEC)?).map_err(Problem::mistakes)?;
        // Two versions of a crane may share one name.
        let other = format!("{first}_other");
        let edit = (spec.crane.name.value.as_ref() == Some(first)).then_some(Edit::Name(&other));
        let checked = edited(&spec, edit.as_slice())?;
        *name =
            registry.add_checked(spec_file::warned(&registry.console, checked, *strict)?, &file.display().to_string());
    }
    if options.rigid {
        for name in [&mut options.first].into_iter().chain(&mut options.second) {
            *name = registry.edit(name, &[Edit::Rigid("leave `--rigid` out")])?;
        }
    }
    Ok(())
}

/// Statics and motion of two cranes, figures and data.
pub fn compare_pair(options: &ComparePair, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let ComparePair { first, second, strict, inputs, compare, .. } = options;
    let Some(second) = second else {
        return Err(Problem::failed("the second crane is missing", "please report this as a bug"));
    };
    let known = |name: &str| Ok::<_, Problem>(compare.parameters.known_to(registry.crane(name)?.description()));
    let [mut one, other] = [known(first)?, known(second)?];
    if compare
        .parameters
        .settings
        .iter()
        .any(|setting| !one.settings.contains(setting) && !other.settings.contains(setting))
    {
        // A parameter that neither crane has is a mistake, which the first one reports.
        one = Parameters { settings: compare.parameters.settings.clone() };
    }
    let mut cranes = [one.crane(first, *strict, registry)?, other.crane(second, *strict, registry)?];
    let has = |crane: &dyn DynCrane, setting: &String| {
        let name = setting.split('=').next().unwrap_or_default();
        crane.description().inputs.iter().any(|input| *input.name == *name)
    };
    let nobody = inputs.iter().find(|setting| !cranes.iter().any(|crane| has(crane.as_ref(), setting)));
    for crane in &mut cranes {
        // An input that neither crane has is a mistake, which the first one reports.
        let settings = inputs.iter().filter(|setting| has(crane.as_ref(), setting)).chain(nobody).cloned();
        let settings: Vec<String> = settings.collect();
        set_inputs(crane.as_mut(), &settings)?;
    }
    let twins = *first == format!("{second}_rigid");
    let labels = if twins { [RIGID, FLEXIBLE] } else { [first.as_str(), second.as_str()] };
    let [one, other] = cranes;
    side_by_side(compare, [(labels[0], one), (labels[1], other)], Method::RECOMMENDED, registry, out)
}

/// Statics and motion of two labelled cranes, figures and data; `default`: the method unless one is asked for.
fn side_by_side(
    options: &Compare,
    [(first, one), (second, other)]: [(&str, Box<dyn DynCrane>); 2],
    default: Method,
    registry: &Registry,
    out: &mut dyn Write,
) -> Outcome<()> {
    let begin = Instant::now();
    let folder = &options.folder.out;
    let cases = [Case::new(first, one.as_ref()), Case::new(second, other.as_ref())];
    // Arguments that cannot be used are refused before anything is written.
    let prepared = prepare(&registry.console, &cases, &options.timing, default)?;
    let format = options.format;
    let mut report = equilibria(&cases, options.limits.bend);
    report.grid(deflection(&cases[0], &cases[1]));
    report.show_all(options.all);
    if format == Format::Table {
        // Something to read while the cranes move.
        let [from, to] = [&one, &other].map(|crane| crane.description());
        writeln!(out, "Comparing {} and {}.", from.name, to.name)?;
        writeln!(out, "Figures (SVG), results (CSV) and report.html go to the folder {}.\n", folder.display())?;
        writeln!(out, "Statics of {}\n", to.title)?;
        format.print(&mem::take(&mut report), &registry.console, out)?;
        report.show_all(options.all);
    }

    files::folder(folder)?;
    let (settings, runs) = runs(&registry.console, &cases, &options.timing, options.limits, prepared)?;
    let [one_run, other_run] = runs.as_slice() else {
        return Err(Problem::failed("a simulation is missing", "please report this as a bug"));
    };

    let mut written = Vec::new();
    for ((case, settings), run) in cases.iter().zip(&settings).zip(&runs) {
        written.extend(write_run(&registry.console, folder, case.crane, settings, run)?);
    }
    let description = other.description();
    let traces = [
        Trace { label: second, table: &other_run.table, dashed: false },
        Trace { label: first, table: &one_run.table, dashed: true },
    ];
    written.extend(write_figures(&registry.console, folder, "comparison_", description, &traces)?);
    let panels = deviation(description, (first, &one_run.table), (second, &other_run.table));
    if panels.iter().any(|panel| !panel.curves.is_empty()) {
        let deviation_file = "comparison_deviation.svg".to_owned();
        write_figure(&registry.console, &folder.join(&deviation_file), &panels, 1)?;
        written.push(deviation_file);
    }

    let page = "report.html";
    page::write_page(&folder.join(page), registry, (&cases, options.limits), &settings, &runs)?;
    written.push(page.to_owned());

    let labelled = [(first, one_run), (second, other_run)];
    caution_of_runs(&mut report, labelled.into_iter());
    report.grid(extremes(&labelled));
    add_runs(&mut report, &[(first, one.as_ref(), one_run), (second, other.as_ref(), other_run)]);
    report.grid(file_list(folder, &written));
    if format == Format::Table {
        let (duration, method, step) = (settings[1].duration, settings[1].method, other_run.run.step);
        let which = if method.is_adaptive() { "mean step" } else { "step" };
        let step = format!("{:.3}", 1e3 * step);
        writeln!(
            out,
            "\nMotion over {duration} s from the {}, {}, {which} {step} ms\n",
            other_run.start,
            method.title()
        )?;
    }
    format.print(&report, &registry.console, out)?;
    if let (Format::Table, Some(seconds)) = (format, registry.console.seconds_since(begin)) {
        writeln!(out, "\nTotal time: {seconds:.1} s")?;
    }
    Ok(())
}

/// How far the second crane's points are from the first one's of the same name over time, along each axis.
fn deviation(description: &Description, first: (&str, &Table), second: (&str, &Table)) -> Vec<Panel> {
    let panel = |axis: &str| {
        let curves = description.points.iter().zip(PALETTE.iter().cycle()).filter_map(|(point, &colour)| {
            let column = format!("{point}_{axis}");
            let [from, to] = [first.1, second.1].map(|table| points(table, "t", &column, 1e3));
            let difference: Vec<_> = from.iter().zip(&to).map(|(from, to)| (to.0, to.1 - from.1)).collect();
            let curve = Curve { label: spoken(point), colour, mark: Mark::Solid, points: difference };
            (!curve.points.is_empty()).then_some(curve)
        });
        Panel {
            x: "t [s]".to_owned(),
            y: format!("Δ{axis}, {} − {} [mm]", second.0, first.0),
            equal: false,
            logarithmic: false,
            curves: curves.collect(),
        }
    };
    ["x", "y", "z"].map(panel).into()
}
