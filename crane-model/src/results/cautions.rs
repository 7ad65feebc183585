//! Cautions about poses and runs for which the model is not valid.

use super::{
    Extremes, Table, connectors, cylinders, feet, limits, loads, loops, overlaps, servos, stop_effort, telescopes,
};
use crate::{CylinderInfo, Description, dyn_crane::DynCrane, loop_joints};

/// Default rotation of one section of a beam above which there is a caution, degrees: linear springs and straight elements then
/// have an error of about 1 %.
pub const BEND: f64 = 20.0;

/// Cautions about a pose at rest, the most important first: stages of telescopes that little or nothing holds, moments that tip the crane over,
/// sections beyond their allowable stress, feet that pull the crane down or have lifted, drives and cylinders at their limits, joints on their
/// stops, slack ropes, stages without pads that overlap, elements bent beyond `bend` degrees, and angles for which the equations lose accuracy.
pub fn of_pose(crane: &dyn DynCrane, q: &[f64], bend: f64) -> Vec<String> {
    let description = crane.description();
    let angles = description.coordinates.iter().zip(q).filter(|(coordinate, _)| coordinate.role.is_element());
    let bent = angles.map(|(coordinate, angle)| (coordinate.name.as_str(), *angle));
    let stopped = description.stops.iter().zip(crane.stop_efforts_at(q, &vec![0.0; q.len()]));
    let stopped = stopped.filter(|(_, effort)| *effort != 0.0).map(|(&coordinate, effort)| {
        let coordinate = &description.coordinates[coordinate];
        format!("{} rests on its stop with {:.1} {}", coordinate.name, effort.abs(), coordinate.kind.force_unit())
    });
    overlaps::of_pose(crane, q)
        .into_iter()
        .chain(loads::of_pose(crane, q))
        .chain(feet::of_pose(crane, q))
        .chain(limits::of_pose(crane, q))
        .chain(cylinders::of_pose(crane, q))
        .chain(stopped)
        .chain(connectors::of_pose(crane, q))
        .chain(loop_joints::cautions(crane, q))
        .chain(telescopes::of_pose(crane, q))
        .chain(bent_beyond(bent, bend))
        .chain(description.near_singular(q))
        .chain(description.large_tilt(q))
        .collect()
}

/// Stages of a telescope, at a pose: those on pads that overlap the beam in which they slide too little, and those without that overlap it.
pub fn of_telescopes(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    [overlaps::of_pose(crane, q), telescopes::of_pose(crane, q)].concat()
}

/// Servos whose loops with the crane are unstable about a pose at rest at time `t`, s, with the gains that would make them stable.
pub fn of_servos(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Vec<String> {
    servos::of_pose(crane, t, q)
}

/// What a run shows only on inspection of every result, the most important first: moments that tip the crane over, sections beyond their
/// allowable stress, and servos whose loops with the crane are unstable. It takes about as long as a part of the run itself.
pub fn of_loads(crane: &dyn DynCrane, table: &Table) -> [Vec<String>; 2] {
    [loads::of_run(crane, table), servos::of_run(crane, table)]
}

/// Cautions over a run, the most important first: those of a pose, without loads.
pub fn of_run(crane: &dyn DynCrane, table: &Table, bend: f64) -> Vec<String> {
    let description = crane.description();
    let elements = description.coordinates.iter().filter(|coordinate| coordinate.role.is_element());
    let elements = elements.map(|coordinate| coordinate.name.as_str());
    let extremes = Extremes::of_all(table, elements.clone());
    let bent = elements
        .zip(extremes)
        .map(|(name, Extremes { minimum, maximum, .. })| (name, if -minimum > maximum { minimum } else { maximum }));
    let stopped = description.stops.iter().filter_map(|&coordinate| on_stop(description, table, coordinate));
    overlaps::of_run(crane, table)
        .into_iter()
        .chain(feet::of_run(description, table))
        .chain(limits::of_run(crane, table))
        .chain(cylinders::of_run(description, table))
        .chain(stopped)
        .chain(connectors::of_run(description, table))
        .chain(loops::of_run(crane, table))
        .chain(telescopes::of_run(crane, table))
        .chain(bent_beyond(bent, bend))
        .chain(near_singular(description, table))
        .chain(large_tilt(description, table))
        .collect()
}

/// Cylinders that load the beams between their pins by a torque at the joint, because they have no valve.
pub fn of_strength(crane: &dyn DynCrane) -> Vec<String> {
    let (description, tree) = (crane.description(), crane.tree());
    let over_beams = |info: &&CylinderInfo| {
        let [first, end] = info.spanned;
        // Other branches may have coordinates in this range.
        let ends = [description.drives[info.drive].coordinate, end - 1];
        let on_a_path = |coordinate: &usize| {
            let moving = ends.map(|end| (0..description.bodies.len()).find(|body| tree.own(*body).contains(&end)));
            moving.into_iter().flatten().any(|body| tree.coordinates(body).contains(coordinate))
        };
        let mut bends = (first..end).filter(|coordinate| description.coordinates[*coordinate].role.is_element());
        info.valve.is_none() && bends.any(|coordinate| on_a_path(&coordinate))
    };
    let caution = |info: &CylinderInfo| {
        let joint = &description.coordinates[description.drives[info.drive].coordinate].name;
        format!(
            "{} has no valve: the sections between its pins carry the torque of the drive of {joint} instead of the force of the cylinder; with a `valve` \
             it pushes on its pins",
            info.name
        )
    };
    description.cylinders.iter().filter(over_beams).map(caution).collect()
}

/// The first pose of a run near which the equations are singular.
pub fn near_singular(description: &Description, table: &Table) -> Option<String> {
    description.near_singular_in(table.poses(description))
}

/// The first pose of a run at which a base that is limited to small rotations has rotated further.
pub fn large_tilt(description: &Description, table: &Table) -> Option<String> {
    table.poses(description).find_map(|q| description.large_tilt(q))
}

/// Reports how long a joint is on its stops during a run, and their largest effort.
fn on_stop(description: &Description, table: &Table, coordinate: usize) -> Option<String> {
    let coordinate = &description.coordinates[coordinate];
    let column = stop_effort(&coordinate.name, coordinate.kind);
    let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of_column(table, &column);
    let (effort, time) = if -minimum > maximum { (-minimum, time_of_minimum) } else { (maximum, time_of_maximum) };
    let samples = table.values(&column)?.filter(|effort| *effort != 0.0).count();
    let met = table.time_of(samples);
    (effort > 0.0).then(|| {
        let (name, unit) = (&coordinate.name, coordinate.kind.force_unit());
        format!("{name} rests on its stop for {met:.2} s, with up to {effort:.1} {unit} at {time:.2} s")
    })
}

/// Reports the element with the largest rotation, if it exceeds `limit` degrees.
fn bent_beyond<'a>(angles: impl Iterator<Item = (&'a str, f64)>, limit: f64) -> Option<String> {
    let (name, angle) = angles.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let degrees = angle.to_degrees();
    (degrees.abs() > limit).then(|| {
        // With the digits of a limit below one degree.
        let degrees = if limit < 1.0 { format!("{degrees:.2}°") } else { format!("{degrees:.0}°") };
        format!(
            "{name} turns by {degrees} in one section, more than {limit}°: check E, G, the cross-section and their units; \
             if they are right, use more sections"
        )
    })
}

/// Reports a step that is so close to the largest stable one that a change of pose may make it unstable.
pub fn of_step(step: f64, limit: f64) -> Option<String> {
    /// Fraction of the limit.
    const NEAR: f64 = 0.97;
    (step > NEAR * limit).then(|| {
        format!(
            "the step of {step:.3e} s is within 3 % of the largest stable step, {limit:.3e} s: fast modes are wrong, and a \
             change of pose may make the run unstable; the step `auto` is a safe one"
        )
    })
}
