//! Load charts: the largest load within limits over the positions of one or two drives.

use crane_live::{LiveCrane, Reach};
use crane_model::{
    dyn_crane::{DynCrane, Functions},
    envelope::{Axes, Axis, Envelope, Execution, Limit, Limits, Rating, Varied, is_load, only_mass, range_of_loads},
};
use serde_json::{Value, json};

use crate::{posed::Outcome, request::Range};

/// Maximum number of poses: these take a minute.
const MOST_POSES: usize = 2000;

/// What a chart is about.
pub struct Wanted {
    /// The parameter that is the load.
    pub load: Option<String>,
    /// The point whose place is shown.
    pub point: Option<String>,
    /// The positions of drives.
    pub ranges: Vec<Range>,
}

/// Rates every pose, with the limits of `crane envelope` unless told otherwise.
pub fn chart(crane: &LiveCrane, wanted: &Wanted) -> Outcome<Value> {
    let description = crane.description();
    let named = |name: &String| description.parameters.iter().position(|info| info.name == name.as_str());
    let load = match &wanted.load {
        Some(name) => named(name).filter(|&index| is_load(&description.parameters[index])),
        None => only_mass(description),
    };
    let load = load.ok_or("choose the live parameter that is the load: a mass, a force, a moment or a factor")?;
    let point = wanted.point.as_ref();
    let point = point.and_then(|name| description.points.iter().position(|own| own == name.as_str()));
    let reach = Reach::new(crane.chain(), crane.parameters(), Some(load), point);
    let axes = axes(&wanted.ranges, description.drives.len())?;
    let limits = Limits::usual(description);
    let loads = range_of_loads(crane, load, None);
    let envelope = Envelope { axes, load, loads, limits, factor: 1.0 };
    let pieces: Vec<usize> = (0..envelope.pieces()).collect();
    let rated = std::sync::Mutex::new(vec![None; envelope.axes.poses()]);
    let done = |piece: usize, ratings: &[Rating]| {
        let mut rated = rated.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        for (pose, rating) in envelope.poses_of(piece).zip(ratings) {
            rated[pose] = Some(rating.clone());
        }
    };
    envelope
        .run(crane, &pieces, &Execution { threads: 1, done: &done, cancelled: &|| false })
        .map_err(|refused| refused.to_string())?;
    let row = |(pose, rating): (usize, &Option<Rating>)| {
        let rating = rating.as_ref()?;
        let parameters = envelope.axes.parameters(crane, pose);
        let place = rating.loaded.as_ref().map(|at| reach.radius_and_height(&at.q, &parameters));
        Some(json!({
            "at": envelope.axes.values(pose),
            "load": rating.load,
            "limit": rating.governing.map(Limit::kind),
            "where": rating.governing.map(|limit| limit.location(crane as &dyn DynCrane)),
            "radius": place.map(|[radius, _]| radius),
            "height": place.map(|[_, height]| height),
        }))
    };
    let rated = rated.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let poses: Vec<Value> = rated.iter().enumerate().filter_map(row).collect();
    let info = &description.parameters[load];
    Ok(json!({
        "poses": poses, "load": info.name.as_str(), "unit": info.unit.as_str(), "point": reach.point(), "radius_from": reach.axis(),
    }))
}

fn axes(ranges: &[Range], drives: usize) -> Outcome<Axes> {
    let count: usize = ranges.iter().map(|range| range.count).fold(1, usize::saturating_mul);
    if ranges.is_empty() || ranges.len() > 2 || !(1..=MOST_POSES).contains(&count) {
        return Err(format!("choose one or two drives, and at most {MOST_POSES} poses"));
    }
    let axis = |range: &Range| {
        let Range { drive, from, to, count } = *range;
        if drive >= drives || !(from.is_finite() && to.is_finite()) {
            return Err("a range is from one position of a drive to another".to_owned());
        }
        let steps = (count.max(2) - 1) as f64;
        let values = (0..count).map(|index| from + (to - from) * (index as f64 / steps)).collect();
        Ok(Axis { varied: Varied::Drive(drive), values })
    };
    ranges.iter().map(axis).collect::<Outcome<_>>().map(Axes)
}
