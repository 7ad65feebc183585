//! What the second order of beam theory adds: a crane at rest beside one whose pose does not change the lever arms of what it carries.

use nalgebra::Vector3;

use super::rating::Posed;
use crate::{
    Wrench,
    dyn_crane::DynCrane,
    sections::{Place, places},
};

/// Parts of weight and loads from which the first order is extrapolated: so small that lever arms stay as they are without them.
const PARTS: [f64; 2] = [1e-4, 2e-4];

/// A crane at rest by the first and by the second order.
///
/// With a factor λ of weight and all loads, the first order of X is `X(0) + X′(0)`, by two small factors; the second order is `X(1)`.
#[derive(Clone, Debug, Default)]
pub struct SecondOrder {
    /// How far weight and loads move each point of interest, by the first order and as it is, m.
    pub points: Vec<[Vector3<f64>; 2]>,
    /// For each beam the place that is bent most, and its bending moment by the first order and as it is, N m.
    pub beams: Vec<(Place, [f64; 2])>,
}

/// A crane with some part of its weight and loads.
struct Loaded {
    points: Vec<Vector3<f64>>,
    /// By section.
    places: Vec<Place>,
}

/// The crane with its drives at the beginning of their motions. `parameter` is the factor of its weight and loads, which is left at another value. `None` if the crane
/// does not rest with all of them, or with small parts of them nearby.
pub fn second_order(crane: &mut dyn DynCrane, parameter: usize) -> Option<SecondOrder> {
    let positions = crane.drive_targets_at(0.0);
    let mut posed = Posed { crane, load: parameter, positions: &positions };
    let whole = posed.find(1.0, None)?;
    let loaded = |posed: &Posed<'_>, q: &[f64]| {
        let (crane, rest) = (&*posed.crane, vec![0.0; q.len()]);
        let wrenches = crane.internal_forces_at(0.0, q, &rest, &rest);
        let mut places = places(crane.description(), &crane.section_places_at(q), &wrenches);
        places.sort_by_key(|place| place.section);
        Loaded { points: crane.points_at(q), places }
    };
    let all = loaded(&posed, &whole.q);
    let [one, two] = PARTS;
    let twice = posed.change_load(1.0, two, whole)?;
    let of_two = loaded(&posed, &twice.q);
    let once = posed.change_load(two, one, twice)?;
    let of_one = loaded(&posed, &once.q);
    let points = all.points.iter().zip(of_one.points.iter().zip(&of_two.points)).map(|(all, (of_one, of_two))| {
        let slope = (of_two - of_one) / (two - one);
        [slope, all - (of_one - slope * one)]
    });
    let bending = |wrench: &Wrench| wrench.moment.y.hypot(wrench.moment.z);
    let places = all.places.iter().zip(of_one.places.iter().zip(&of_two.places)).map(|(all, (of_one, of_two))| {
        let [of_one, of_two] = [of_one, of_two].map(|place| place.wrench.moment);
        let slope = (of_two - of_one) / (two - one);
        let first = Wrench { force: Vector3::zeros(), moment: of_one + slope * (1.0 - one) };
        (*all, [bending(&first), bending(&all.wrench)])
    });
    let description = posed.crane.description();
    let mut beams: Vec<(Place, [f64; 2])> = Vec::new();
    for (place, moments) in places {
        match beams.iter_mut().find(|(known, _)| known.beam(description) == place.beam(description)) {
            Some(known) if known.1[1] < moments[1] => *known = (place, moments),
            Some(_) => {}
            None => beams.push((place, moments)),
        }
    }
    Some(SecondOrder { points: points.collect(), beams })
}
