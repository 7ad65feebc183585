//! What moves a run: peaks, extremes, final values and integrals of its columns.

use std::{io::Write, ops::ControlFlow};

use crane_live::LiveCrane;
use crane_live::sensitivity::runs::{self, Along, METHOD, NotAsked, run_with_gradients};
use crane_live::sensitivity::{self, Group, Output};
use crane_model::{
    dyn_crane::Functions,
    results::{Column, Table},
    runs::{Measure, Start},
};

use super::{Changes, Number, Request, begin, numbers, ordered, print, remarks};
use crate::{
    arguments::{Sensitivity, Timing},
    problem::{Outcome, Problem},
    screen::Console,
};

/// A column of a run, and what is taken of it.
type Asked = (usize, Measure);

/// Prints what moves the run of a crane from rest.
pub fn sensitivity(
    console: &Console,
    options: &Sensitivity,
    request: &Request<'_>,
    crane: &LiveCrane,
    out: &mut dyn Write,
) -> Outcome<()> {
    let description = crane.description();
    let (parameters, places) = numbers(request.numbers, description, None)?;
    if let Some(place) = places.first() {
        let title = format!("`{place}` cannot be a live parameter, and runs have derivatives by live parameters only");
        return Err(Problem::usage(
            title,
            "leave it out of `--with`, or compare runs of two specs with `crane compare`",
        ));
    }
    let names = parameters.iter().map(|&index| &description.parameters[index].name);
    let along = names.map(|name| {
        Along::named(crane, name).map_err(|not| Problem::usage(not.to_string(), "leave it out of `--with`"))
    });
    let along = along.collect::<Outcome<Vec<Along>>>()?;
    let timing = Timing {
        method: Some(METHOD),
        tolerance: options.tolerance,
        step: None,
        force: false,
        no_verify: true,
        duration: options.duration,
        interval: options.interval,
        from: None,
        start: Vec::new(),
    };
    let start = Start::new(crane)?;
    let settings = crane_model::dynamics::Settings { audit: false, ..timing.settings(crane, &start, METHOD)? };
    let bar = console.progress(settings.duration);
    let proceed = &mut |t: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
        bar.set_position((1e3 * t) as u64);
        ControlFlow::Continue(())
    };
    let (recorded, gradients) = run_with_gradients(crane, &start, &settings, &along, proceed)?;
    bar.finish_and_clear();
    let table = &recorded.table;
    // Integrals by the audit of a run have none.
    let has_derivatives = |index: usize| gradients.iter().flatten().all(|row| !row[index].is_nan());
    let asked = asked(request, table, &has_derivatives)?;
    let column = |rows: &[Vec<f64>], index: usize| -> Vec<f64> { rows.iter().map(|row| row[index]).collect() };
    let t = column(&table.rows, 0);
    let mut found = sensitivity::Sensitivity {
        q: start.q.clone(),
        parameters: parameters.clone(),
        outputs: Vec::new(),
        values: Vec::new(),
        derivatives: vec![Vec::new(); parameters.len()],
        pose: Vec::new(),
        notes: Vec::new(),
    };
    for &(index, of) in &asked {
        let info = &table.columns[index];
        let values = column(&table.rows, index);
        let place = of.row(&values).map_or_else(String::new, |row| format!("at {:.4} s", t[row]));
        let unit = unit(&info.unit, of);
        found.outputs.push(Output { name: format!("{}.{}", info.name, of.name()), unit, group: Group::Run, place });
        found.values.push(of.take(&t, &values, &values));
        for (derivatives, rows) in found.derivatives.iter_mut().zip(&gradients) {
            derivatives.push(of.take(&t, &values, &column(rows, index)));
        }
    }
    let own: Vec<Number> = parameters.iter().map(|&index| Number::live(crane, index)).collect();
    let changes: Changes = ordered(request, description, found, own, (0..asked.len()).collect());
    let mut report = begin(options, description);
    report.fact("start", recorded.start.as_str(), "");
    crate::simulate::method(&mut report, &settings);
    report.fact("duration", settings.duration, "s");
    remarks(&mut report, &changes);
    for caution in &recorded.cautions {
        report.caution(Some(caution.as_str()));
    }
    print(console, options, report, &changes, out)
}

/// The columns that are asked for; peaks of the most important ones if none are, of all with `--all`.
fn asked(request: &Request<'_>, table: &Table, has_derivatives: &dyn Fn(usize) -> bool) -> Outcome<Vec<Asked>> {
    if request.outputs.is_empty() {
        let is_main = |column: &Column| request.all || column.kind.headline().is_some();
        let columns = (1..table.columns.len()).filter(|&index| is_main(&table.columns[index]));
        let columns = columns.filter(|&index| has_derivatives(index));
        return Ok(columns.map(|index| (index, Measure::Peak)).collect());
    }
    let mut found = Vec::new();
    for asked in request.outputs {
        let own = runs::asked(&table.columns, asked, has_derivatives);
        let own = own.map_err(|NotAsked { title, hint }| Problem::usage(title, hint))?;
        if !found.contains(&own) {
            found.push(own);
        }
    }
    Ok(found)
}

/// The unit of a column, or of its integral over time.
fn unit(unit: &str, of: Measure) -> &'static str {
    /// Units of columns, and of their integrals.
    const UNITS: [(&str, &str); 10] = [
        ("m", "m s"),
        ("rad", "rad s"),
        ("m/s", "m"),
        ("rad/s", "rad"),
        ("N", "N s"),
        ("N m", "N m s"),
        ("Pa", "Pa s"),
        ("J", "J s"),
        ("W", "J"),
        ("m³/s", "m³"),
    ];
    let known = UNITS.into_iter().find(|(own, _)| *own == unit);
    match (known, of) {
        (Some((_, integral)), Measure::Integral) => integral,
        (Some((own, _)), _) => own,
        (None, Measure::Integral) => "s",
        (None, _) => "",
    }
}
