//! Stability against tipping: moments about the lines between the outermost feet.
//!
//! A crane on feet that push and do not pull tips about a tipping line: a side of the convex polygon that the feet make, seen
//! from above. Each link's weight, inertia and loads have a moment about the line, which stabilises or overturns the crane; it
//! tips when the sum of all moments overturns it. Feet are points, and the ground is rigid: yielding under the feet affects the pose only.

use nalgebra::Vector3;

use crate::{SupportInfo, Text, Wrench, dyn_crane::DynCrane};

/// Moments about a tipping line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TippingLine {
    /// Indices of two supports; seen from above, the crane is to the left of the line from the first to the second.
    pub feet: [usize; 2],
    /// Moment of the links that hold the crane down, N m, not negative.
    pub stabilising: f64,
    /// Moment of the links that tip it over the line, N m, not negative.
    pub overturning: f64,
    /// Whether only feet on the line carry the crane. The moments then balance for any load, up to rounding, or something else holds it: the
    /// crane has tipped.
    pub has_tipped: bool,
}

impl TippingLine {
    /// Remaining moment that holds the crane down, N m; negative where it tips, never positive where it has tipped.
    pub fn balance(&self) -> f64 {
        let balance = self.stabilising - self.overturning;
        if self.has_tipped { balance.min(0.0) } else { balance }
    }

    /// `1 − overturning / stabilising`: 1 where nothing tips, 0 where the crane is about to fall, −∞ where nothing holds it; never positive
    /// where it has tipped.
    pub fn margin(&self) -> f64 {
        let margin = self.margin_of_moments();
        if self.has_tipped { margin.min(0.0) } else { margin }
    }

    fn margin_of_moments(&self) -> f64 {
        if self.overturning == 0.0 {
            1.0
        } else if self.stabilising > 0.0 {
            1.0 - self.overturning / self.stabilising
        } else {
            f64::NEG_INFINITY
        }
    }
}

/// The tipping lines of a crane, anticlockwise seen from above, at time `t`, pose `q`, rates `v` and accelerations `a`; none where
/// the supports make no polygon, because there are fewer than three or all are in one line.
pub fn lines(crane: &dyn DynCrane, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Vec<TippingLine> {
    let feet = crane.support_positions_at(q);
    let corners = polygon(&feet);
    let loads = || loads_of_links(crane, t, [q, v, a]).into_iter().map(|(_, load)| load).collect();
    let loads: Vec<Wrench> = if corners.is_empty() { Vec::new() } else { loads() };
    let lifted = if corners.is_empty() { Vec::new() } else { lifted(crane, q, v) };
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let with_feet = |(&from, &to): (&usize, &usize)| TippingLine {
        has_tipped: lifted.contains(&false) && off_line(&feet, [from, to]).all(|foot| lifted[foot]),
        ..line([from, to], [feet[from], feet[to]], &loads)
    };
    sides.map(with_feet).collect()
}

/// Which supports carry nothing because they are above the ground.
fn lifted(crane: &dyn DynCrane, q: &[f64], v: &[f64]) -> Vec<bool> {
    let supports = &crane.description().supports;
    if !supports.iter().any(|support| support.one_sided) {
        return vec![false; supports.len()];
    }
    let carries_nothing = |(support, force): (&SupportInfo, Vector3<f64>)| support.one_sided && force.z <= 0.0;
    supports.iter().zip(crane.support_reactions_at(q, v)).map(carries_nothing).collect()
}

/// The feet that are not on the line through two of them, seen from above.
fn off_line(places: &[Vector3<f64>], [from, to]: [usize; 2]) -> impl Iterator<Item = usize> {
    let along = (places[to] - places[from]).xy();
    let distance = move |place: &Vector3<f64>| along.perp(&(place - places[from]).xy()).abs() / along.norm_squared();
    places.iter().enumerate().filter(move |(_, position)| distance(position) > ON_A_LINE).map(|(foot, _)| foot)
}

/// The line with the smallest margin.
pub fn governing(lines: &[TippingLine]) -> Option<&TippingLine> {
    lines.iter().min_by(|a, b| a.margin().total_cmp(&b.margin()))
}

/// A link's weight, inertia and loads about a tipping line.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkMoment {
    /// The link.
    pub link: Text,
    /// Force downwards, N.
    pub weight: f64,
    /// Moment about the line, N m: positive if it holds the crane down, negative if it overturns it.
    pub moment: f64,
}

/// What each link contributes to the moments about the line between two feet, at time `t`, for pose, rates and accelerations.
pub fn moments(crane: &dyn DynCrane, t: f64, motion: [&[f64]; 3], feet: [usize; 2]) -> Vec<LinkMoment> {
    let places = crane.support_positions_at(motion[0]);
    let line = feet.map(|foot| places[foot]);
    let of_link = |(link, load): (Text, Wrench)| LinkMoment { link, weight: -load.force.z, moment: held(line, &load) };
    loads_of_links(crane, t, motion).into_iter().map(of_link).collect()
}

/// Moment of a load about the line through two points, positive if it holds the crane down: a load within the polygon turns the crane clockwise about
/// the line, and so against the ground.
fn held([from, to]: [Vector3<f64>; 2], load: &Wrench) -> f64 {
    -(to - from).normalize().dot(&(load.moment - from.cross(&load.force)))
}

/// Moments of loads about the line through two points.
fn line(feet: [usize; 2], places: [Vector3<f64>; 2], loads: &[Wrench]) -> TippingLine {
    let (mut stabilising, mut overturning) = (0.0, 0.0);
    for moment in loads.iter().map(|load| held(places, load)) {
        if moment > 0.0 {
            stabilising += moment;
        } else {
            overturning -= moment;
        }
    }
    TippingLine { feet, stabilising, overturning, has_tipped: false }
}

/// Where a link begins, and which links it carries.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkCut {
    /// The link.
    pub link: Text,
    /// Index of its first body.
    pub body: usize,
    /// Index of the cut before that body among [`Description::cuts`](crate::Description::cuts).
    pub cut: usize,
    /// The links that are attached to it, by their indices in this list.
    pub carried: Vec<usize>,
}

/// The links of a crane, from the base to the tip: what a link carries itself is the wrench at its cut less those at the cuts of the links
/// that are attached to it.
pub fn link_cuts(crane: &dyn DynCrane) -> Vec<LinkCut> {
    let description = crane.description();
    let link_of = |body: usize| &description.bodies[body].link;
    let mut links: Vec<LinkCut> = Vec::new();
    for (cut, at) in description.cuts().into_iter().enumerate() {
        if let crate::Cut::Body { body, .. } = at
            && (body == 0 || link_of(body - 1) != link_of(body))
        {
            links.push(LinkCut { link: link_of(body).clone(), body, cut, carried: Vec::new() });
        }
    }
    let tree = crane.tree();
    for index in 0..links.len() {
        let link = link_of(links[index].body);
        let is_carried = |other: &LinkCut| {
            other.body != links[index].body && tree.parent(other.body).is_some_and(|carrier| link_of(carrier) == link)
        };
        links[index].carried = (0..links.len()).filter(|&other| is_carried(&links[other])).collect();
    }
    links
}

/// Wrench of the weight, the inertia and the applied loads of every link, in the world frame about the world's origin.
fn loads_of_links(crane: &dyn DynCrane, t: f64, [q, v, a]: [&[f64]; 3]) -> Vec<(Text, Wrench)> {
    let wrenches = crane.external_forces_at(t, q, v, a);
    let transforms = crane.transforms_at(q);
    let links = link_cuts(crane);
    // The link and everything beyond it.
    let beyond = |link: &LinkCut| {
        let (frame, wrench) = (&transforms[link.body], &wrenches[link.cut]);
        let (turn, position) = (frame.fixed_view::<3, 3>(0, 0), frame.fixed_view::<3, 1>(0, 3));
        let force = turn * wrench.force;
        Wrench { force, moment: turn * wrench.moment + position.cross(&force) }
    };
    let of_link = |link: &LinkCut| {
        let carried = link.carried.iter().map(|&carried| beyond(&links[carried]));
        let own = carried
            .fold(beyond(link), |own, rest| Wrench { force: own.force - rest.force, moment: own.moment - rest.moment });
        (link.link.clone(), own)
    };
    links.iter().map(of_link).collect()
}

/// Fraction of the polygon's size below which a foot counts as on the line between two others.
const ON_A_LINE: f64 = 1e-9;

/// Corners of the convex hull of some points, seen from above, anticlockwise from the one with the lowest index; none if the points are on
/// one line.
fn polygon(places: &[Vector3<f64>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&i, &j| {
        (places[i].x, places[i].y).partial_cmp(&(places[j].x, places[j].y)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let size = |axis: usize| {
        let along = || places.iter().map(|position| position[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let least = if places.is_empty() { 0.0 } else { ON_A_LINE * size(0).max(size(1)).powi(2) };
    // Twice the area of the triangle of three points, positive where it turns left.
    let turn = |[i, j, k]: [usize; 3]| {
        let (one, two) = (places[j] - places[i], places[k] - places[i]);
        one.x * two.y - one.y * two.x
    };
    // Andrew's monotone chain: the lower side from left to right, then the upper side back.
    let side = |order: &mut dyn Iterator<Item = usize>| {
        let mut corners: Vec<usize> = Vec::new();
        for next in order {
            while corners.len() >= 2 && turn([corners[corners.len() - 2], corners[corners.len() - 1], next]) <= least {
                corners.pop();
            }
            corners.push(next);
        }
        corners.pop();
        corners
    };
    let mut corners = side(&mut order.iter().copied());
    corners.extend(side(&mut order.iter().rev().copied()));
    if corners.len() < 3 {
        return Vec::new();
    }
    // Start at the foot with the lowest index: the leftmost corner changes as the crane moves.
    let first = corners.iter().enumerate().min_by_key(|(_, foot)| **foot).map_or(0, |(position, _)| position);
    corners.rotate_left(first);
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(xy: &[[f64; 2]]) -> Vec<Vector3<f64>> {
        xy.iter().map(|[x, y]| Vector3::new(*x, *y, 0.3)).collect()
    }

    #[test]
    fn a_polygon_has_its_outermost_feet() {
        let feet = [[1.0, 1.0], [-1.0, -1.0], [0.0, 0.2], [1.0, -1.0], [-1.0, 1.0], [0.0, -1.0]];
        assert_eq!(polygon(&places(&feet)), [0, 4, 1, 3]);
        let turned: Vec<_> = feet.iter().map(|[x, y]| [-x, -y]).collect();
        assert_eq!(polygon(&places(&turned)), [0, 4, 1, 3]);
    }

    #[test]
    fn feet_in_a_line_make_none() {
        assert_eq!(polygon(&places(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]])), [] as [usize; 0]);
        assert_eq!(polygon(&places(&[[0.0, 0.0], [1.0, 1.0]])), [] as [usize; 0]);
        assert_eq!(polygon(&[]), [] as [usize; 0]);
    }

    /// A weight of 10 N at 0.5 m from the line x = 1 within the square, and one of 4 N at 1 m beyond it.
    #[test]
    fn moments_about_a_line() {
        let weight = |newton: f64, position: Vector3<f64>| {
            let force = Vector3::new(0.0, 0.0, -newton);
            Wrench { force, moment: position.cross(&force) }
        };
        let loads = [weight(10.0, Vector3::new(0.5, 0.3, 2.0)), weight(4.0, Vector3::new(2.0, -5.0, 1.0))];
        let feet = [Vector3::new(1.0, -1.0, 0.0), Vector3::new(1.0, 1.0, 0.0)];
        let found = line([0, 1], feet, &loads);
        assert_eq!((found.stabilising, found.overturning), (5.0, 4.0));
        assert!((found.margin() - 0.2).abs() < 1e-15);
        assert_eq!(found.balance(), 1.0);
        let tipped = TippingLine { has_tipped: true, ..found };
        assert_eq!((tipped.margin(), tipped.balance()), (0.0, 0.0));
    }

    #[test]
    fn a_foot_between_two_is_on_their_line() {
        let feet = places(&[[1.0, 1.0], [-1.0, 1.0], [0.2, 1.0], [0.0, -1.0]]);
        assert_eq!(off_line(&feet, [0, 1]).collect::<Vec<_>>(), [3]);
        assert_eq!(off_line(&feet, [1, 3]).collect::<Vec<_>>(), [0, 2]);
    }
}
