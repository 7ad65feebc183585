//! The live parameter that is the load, and the critical loads: that which lifts the first foot, and that which tips the crane.

use crane_live::LiveCrane;
use crane_model::{
    dyn_crane::DynCrane,
    envelope::{
        Critical, CriticalLoad, Followed, LoadFactor, SecondOrder, critical_load, is_load, load_factor, only_mass,
        second_order,
    },
    statics::Status,
};
use crane_page::tables::{Cell, Grid, Report};

use serde_json::{Map, Value, json};

use crate::problem::{Outcome, Problem, nearest};

/// Index of the parameter that is the load: the one of this name, or else the only one in kg.
pub fn parameter(crane: &dyn DynCrane, name: Option<&str>) -> Outcome<Option<usize>> {
    let parameters = &crane.description().parameters;
    let Some(name) = name else { return Ok(only_mass(crane.description())) };
    let found = parameters.iter().position(|parameter| parameter.name.as_str() == name);
    let found = found.ok_or_else(|| {
        let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        let help = nearest(name, names).map_or_else(
            || "`crane info` lists the live parameters".to_owned(),
            |nearest| format!("did you mean `{nearest}`?"),
        );
        Problem::usage(format!("there is no live parameter `{name}`"), help)
    })?;
    if !is_load(&parameters[found]) {
        let loads = parameters.iter().filter(|parameter| is_load(parameter)).map(|parameter| parameter.name.as_str());
        let loads: Vec<&str> = loads.collect();
        let help = if loads.is_empty() {
            "make the mass of the load a live parameter in kg: `parameters: {payload: {value: 500, unit: kg}}`"
                .to_owned()
        } else {
            format!("live parameters that can be a load: {}", loads.join(", "))
        };
        return Err(Problem::usage(format!("`{name}` is in {}: it is not a load", parameters[found].unit), help));
    }
    Ok(Some(found))
}

/// Adds the factor of weight and all loads at which the crane buckles.
pub fn factor(report: &mut Report, crane: &LiveCrane) {
    let (mut crane, parameter) = crane.with_load_factor();
    let Some(LoadFactor { linearised, followed }) = load_factor(&mut crane, parameter) else { return };
    let name = "critical factor of weight and loads";
    let by_stiffness = match linearised {
        Some(factor) => Cell::from(factor),
        None if (&crane as &dyn DynCrane).loop_joints().is_empty() => format!("above {}", LoadFactor::MOST).into(),
        None => "not computed for closed loops and rigid couplings".into(),
    };
    report.line(format!("{name}, by the stiffness at rest"), by_stiffness, "");
    let followed_to = followed.as_ref().map(|followed| followed.factor.into());
    let followed_to = followed_to.unwrap_or_else(|| Cell::from(format!("above {}", LoadFactor::MOST_FOLLOWED)));
    report.line(format!("{name}, its pose followed"), followed_to, "");
    let without_hold = "a stage is out of its beam";
    if let Some(Followed { beyond, .. }) = &followed {
        report.line("beyond it", beyond.as_ref().map_or_else(|| without_hold.to_owned(), Status::to_string), "");
    }
    let followed = followed.map(|Followed { factor, beyond }| {
        json!({"factor": factor, "status": beyond.as_ref().map_or(without_hold, Status::name)})
    });
    report.value("critical_factor", json!({"linearised": linearised, "followed": followed}));
}

/// Part of the largest displacement or bending moment up to which another one is nothing, and has no factor.
const NOTHING: f64 = 1e-6;

/// Adds deflections and bending moments by the first order beside those at rest.
pub fn orders(report: &mut Report, crane: &LiveCrane) {
    let title =
        "First and second order: how far weight and loads move points, and the largest bending moment of each beam";
    let headers = ["quantity", "place", "first order", "second order", "factor", "unit"];
    let mut grid = Grid::new("second_order", title, &headers);
    let (mut crane, parameter) = crane.with_load_factor();
    let found = second_order(&mut crane, parameter);
    if found.is_none() {
        report.line("first order", "not computed: without weight and loads the crane does not rest nearby", "");
    }
    let SecondOrder { points, beams } = found.unwrap_or_default();
    let description = (&crane as &dyn DynCrane).description();
    let mut rows = |rows: Vec<(String, Option<String>, [f64; 2])>, unit: &str| {
        let greatest = rows.iter().map(|(.., [_, second])| *second).fold(0.0, f64::max);
        for (quantity, place, [first, second]) in rows {
            let factor = (first > NOTHING * greatest).then(|| second / first);
            let place = place.map_or(Cell::Empty, Cell::from);
            grid.row([quantity.into(), place, first.into(), second.into(), factor.into(), unit.into()]);
        }
    };
    let names = description.points.iter().map(|name| format!("displacement of {name}"));
    let displacements = points.iter().map(|moved| moved.map(|moved| moved.norm()));
    rows(names.zip(displacements).map(|(name, moved)| (name, None, moved)).collect(), "m");
    let bending = beams.iter().map(|(place, moments)| {
        (format!("bending of {}", place.beam(description)), Some(place.location(description)), *moments)
    });
    rows(bending.collect(), "N m");
    report.grid(grid);
}

/// Adds the loads at which the first foot carries nothing, and at which the crane tips, or why there is none.
pub fn critical(report: &mut Report, crane: &mut dyn DynCrane, index: usize) -> Outcome<()> {
    let before = crane.parameter(index);
    let parameter = &crane.description().parameters[index];
    let (name, unit) = (parameter.name.to_string(), parameter.unit.to_string());
    let (mut critical, mut reasons) = (Map::new(), Map::new());
    for (key, what, location, kind) in [
        ("first_foot", "lifts the first foot", "first foot to lift", Critical::FirstFoot),
        ("tipping", "tips the crane", "line that it tips over", Critical::Tipping),
    ] {
        let found = critical_load(crane, index, kind);
        crane.set_parameter(index, before).map_err(|refused| Problem::failed(refused.to_string(), ""))?;
        let value = match found {
            Ok(CriticalLoad { load, location: at, at_least }) => {
                let fails = match kind {
                    Critical::FirstFoot => "a foot carries nothing",
                    Critical::Tipping => "the crane does not stand",
                };
                report.caution(at_least.map(|least| format!("{fails} with a {name} of less than {least:.1} {unit}")));
                report.line(format!("{name} that {what}"), load, &unit);
                report.line(location, at.as_str(), "");
                json!({"load": load, "at": at})
            }
            Err(none) => {
                let reason = none.reason(&unit);
                report.line(format!("{name} that {what}"), format!("none: {reason}"), "");
                reasons.insert(key.to_owned(), reason.into());
                Value::Null
            }
        };
        critical.insert(key.to_owned(), value);
    }
    critical.insert("reasons".to_owned(), reasons.into());
    critical.extend([("parameter".to_owned(), name.into()), ("unit".to_owned(), unit.into())]);
    report.value("critical_loads", critical);
    Ok(())
}
