//! The crane of the page, and what is asked about it.

use std::ops::ControlFlow;

use crane_codegen::{
    Checked, SourceFile, build,
    chain::{End, Force, Group, Law},
    compile,
    diagnostic::Diagnostics,
    units::number_in,
};
use crane_live::LiveCrane;
use crane_model::{
    Text,
    dyn_crane::{DynCrane, Functions},
    dynamics::{Method, Settings},
    results::cautions::BEND,
    runs::{Start, record_checked},
    statics::{self, Equilibrium},
};
use crane_page::{
    Texts, data, modes,
    tables::{Case, VALUE, diagnostics, equilibria, of_page},
};
use serde_json::{Value, json};

use crate::{
    chart::{self, Wanted},
    driving::Driving,
    levers::{self, Numbers},
    posed::{Outcome, PROGRAM, check_positions, starts, still, subject, with_numbers, with_parameters},
    request::Request,
};

/// The crane of the page.
#[derive(Default)]
pub struct Engine {
    crane: Option<Opened>,
    /// The crane as it rested last.
    resting: Option<(LiveCrane, Equilibrium)>,
    driving: Option<Driving>,
}

/// A spec without mistakes.
struct Opened {
    live: LiveCrane,
    /// The same crane with its drives at positions of the page; made when the first one is moved.
    posed: Option<LiveCrane>,
}

impl Engine {
    /// Answers a request, JSON in UTF-8, in JSON.
    pub fn answer(&mut self, request: &[u8]) -> String {
        let answered = serde_json::from_slice::<Request>(request)
            .map_err(|error| format!("the page asks for something unknown: {error}"))
            .and_then(|request| self.reply(request));
        answered.unwrap_or_else(|words| json!({"error": words})).to_string()
    }

    fn reply(&mut self, request: Request) -> Outcome<Value> {
        match request {
            Request::Open { name, text } => Ok(self.open(&name, &text)),
            Request::Number { text, unit, of } => number_in(&unit, &text, &of)
                .map(|value| json!({"value": value}))
                .map_err(|wrong| format!("{}; {}", wrong.problem, wrong.help)),
            Request::Rest { parameters, positions } => {
                let crane = self.crane()?.at(&parameters, &positions)?;
                let (page, equilibrium) = rest(&crane, positions.is_empty());
                self.resting = Some((crane, equilibrium));
                Ok(page)
            }
            Request::Modes => {
                let (crane, equilibrium) = self.resting.as_ref().ok_or("there is no crane at rest")?;
                modes(&subject(crane, equilibrium, None)).map_err(|error| error.to_string())
            }
            Request::Run { parameters, duration } => run(&self.crane()?.at(&parameters, &[])?, duration),
            Request::Chart { parameters, positions, load, point, ranges } => {
                let crane = self.crane()?.at(&parameters, &positions)?;
                chart::chart(&crane, &Wanted { load, point, ranges })
            }
            Request::Drive { parameters, positions } => {
                let (driving, begun) = Driving::begin(&self.crane()?.live, &parameters, &positions)?;
                self.driving = Some(driving);
                Ok(begun)
            }
            Request::Advance { to, levers, tolerance } => {
                let driving = self.driving.as_mut().ok_or("the crane is not being driven")?;
                driving.advance(to, &levers, tolerance)
            }
            Request::Repeat { calls } => Ok(repeat(&self.crane()?.live, calls)),
        }
    }

    fn crane(&mut self) -> Outcome<&mut Opened> {
        self.crane.as_mut().ok_or_else(|| "there is no crane: the spec has mistakes".to_owned())
    }

    /// Reads a spec; mistakes leave the page without a crane.
    fn open(&mut self, name: &str, text: &str) -> Value {
        *self = Self::default();
        let Checked { chain, warnings, .. } = match check(name, text) {
            Ok(checked) => checked,
            Err(words) => return words,
        };
        let live = LiveCrane::new(chain);
        let opened = described(&live, &diagnostics(&warnings));
        self.crane = Some(Opened { live, posed: None });
        opened
    }
}

/// The spec of a shipped crane, by the name of the crane or of its file.
fn shipped(name: &str) -> Option<&'static str> {
    crane_specs::spec(name.strip_suffix(".yaml").unwrap_or(name))
}

/// A valid chain, or the answer that lists its mistakes.
fn check(name: &str, text: &str) -> Result<Checked, Value> {
    let mistakes = |found: &Diagnostics| json!({"diagnostics": diagnostics(found), "drawn": found.to_string()});
    let source: SourceFile = build::read_with(name, text.as_bytes(), &shipped).map_err(|failure| match failure {
        build::Failure::File(words) => json!({"error": words}),
        build::Failure::Mistakes(found) => mistakes(&found),
    })?;
    compile::check(&source).map_err(|found| mistakes(&found))
}

/// What the page needs to know of a crane before anything is computed.
fn described(live: &LiveCrane, warnings: &Value) -> Value {
    let description = live.description();
    let parameters: Vec<Value> = description
        .parameters
        .iter()
        .map(|info| {
            let ends = [&info.lower_bound, &info.upper_bound].map(|bound| bound.value);
            json!({
                "name": info.name.as_str(), "unit": info.unit.as_str(), "about": info.about.as_str(), "value": info.default,
                "least": ends[0], "most": ends[1],
            })
        })
        .collect();
    let stops = |coordinate: usize, side: End| {
        let of_side = |force: &Force| match &force.law {
            Law::Stop(stop) if stop.end == side && force.coordinate()?.0 == coordinate => {
                Some(stop.at.at(live.parameters()))
            }
            _ => None,
        };
        live.chain().forces_of_group(Group::Stops).iter().find_map(of_side)
    };
    let drives: Vec<Value> = description
        .drives
        .iter()
        .zip(&live.chain().drives)
        .zip(starts(live))
        .map(|((info, drive), start)| {
            let coordinate = &description.coordinates[info.coordinate];
            json!({
                "name": coordinate.name.as_str(), "unit": coordinate.kind.unit(), "start": start,
                "lever": match levers::kind(drive) { levers::Kind::Valve => "valve", levers::Kind::Speed => "speed" },
                "full": levers::full_speed(coordinate.kind, info.max_rate), "stops": [stops(info.coordinate, End::Lower), stops(info.coordinate, End::Upper)],
            })
        })
        .collect();
    json!({
        "diagnostics": warnings, "name": description.name.as_str(), "title": description.title.as_str(),
        "coordinates": live.size(), "bodies": description.bodies.len(), "spec_hash": description.spec_hash.as_str(),
        "parameters": parameters, "drives": drives, "points": description.points.iter().map(Text::as_str).collect::<Vec<_>>(),
        "duration": description.duration,
        "cylinders": description.cylinders.iter().map(|own| json!({"name": own.name.as_str(), "most": own.max_pressure})).collect::<Vec<_>>(),
    })
}

impl Opened {
    /// The crane with parameters, and with its drives at positions; with none of them, that of the spec.
    fn at(&mut self, parameters: &[f64], positions: &[f64]) -> Outcome<LiveCrane> {
        if positions.is_empty() {
            return with_parameters(&self.live, parameters);
        }
        check_positions(&self.live, positions)?;
        let posed = self.posed.get_or_insert_with(|| LiveCrane::new(levers::with_levers(self.live.chain(), false)));
        let mut crane = posed.clone();
        let all = with_numbers(&self.live, parameters, positions.iter().map(|position| Numbers::holding(*position)))?;
        crane.set_parameters(&all).map_err(|refused| refused.to_string())?;
        Ok(crane)
    }
}

/// The crane at rest: what the page draws, and the same tables as those of `crane statics`; without modes.
fn rest(crane: &LiveCrane, as_written: bool) -> (Value, Equilibrium) {
    let case = Case::new(VALUE, crane as &dyn DynCrane);
    let report = equilibria(std::slice::from_ref(&case), BEND);
    let results = if as_written { report.json() } else { Value::Null };
    let texts = Texts { tables: Some(report), ..Texts::default() };
    let mut page = still(crane, &case.equilibrium, texts);
    let equilibrium = &case.equilibrium;
    page["results"] = results;
    page["rest"] = json!({
        "stable": equilibrium.is_stable(), "rests": equilibrium.rests(), "words": equilibrium.status.to_string(), "steps": equilibrium.steps(), "q": equilibrium.q,
        "drives": starts(crane),
    });
    if !equilibrium.is_stable() {
        let failed = crane_model::runs::Reason::no_equilibrium(crane, equilibrium).for_crane(&crane.description().name);
        page["rest"]["why"] = json!(format!("{failed}; {}", failed.advice()));
    }
    (page, case.equilibrium)
}

/// The run of the spec from its start, with all tables.
fn run(crane: &LiveCrane, duration: Option<f64>) -> Outcome<Value> {
    let own = Settings::from_description(crane.description());
    let settings =
        Settings { method: Method::RECOMMENDED, audit: true, duration: duration.unwrap_or(own.duration), ..own };
    if !(settings.duration > 0.0 && settings.duration <= Settings::TIMES.1)
        || settings.duration / settings.output > Settings::MOST_RESULTS
    {
        return Err(format!("a run of {} s: choose a time above 0 with at most a million results", settings.duration));
    }
    let told = |failed: crane_model::runs::Failed| format!("{failed}; {}", failed.advice());
    let start = Start::new(crane).map_err(told)?;
    let recorded =
        record_checked(crane, &start, &settings, (false, BEND), &mut |_| ControlFlow::Continue(())).map_err(told)?;
    let case = Case::new(VALUE, crane as &dyn DynCrane);
    let tables = of_page(std::slice::from_ref(&case), &[&recorded], BEND, None).map_err(told)?;
    let texts = Texts { tables: Some(tables), ..Texts::default() };
    let subject = subject(crane, &case.equilibrium, Some((&settings, &recorded)));
    data(&[subject], texts, PROGRAM).map_err(|error| error.to_string())
}

/// Calls the acceleration many times; the page measures how long this takes.
fn repeat(crane: &LiveCrane, calls: u32) -> Value {
    let q = (crane as &dyn DynCrane).equilibrium(&statics::Settings::default()).q;
    let (v, mut a) = (vec![0.0; q.len()], vec![0.0; q.len()]);
    for _ in 0..calls {
        crane.forward_dynamics(0.0, &q, &v, &mut a);
    }
    json!({"calls": calls, "sum": a.iter().sum::<f64>()})
}
