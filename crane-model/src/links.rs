//! The coordinates of a crane, and what they are attached to.

use crate::rt::derivatives::Link;
use crate::{CoordinateKind, Description};

/// Writes what each coordinate is attached to, for the `parents` of [`CraneModel::parents`](crate::CraneModel::parents). Without a heap.
pub fn fill_links(description: &Description, parents: &[usize], links: &mut [Link]) {
    for (j, (link, coordinate)) in links.iter_mut().zip(&description.coordinates).enumerate() {
        *link = Link { rotates: coordinate.kind == CoordinateKind::Rotation, before: j.checked_sub(1) };
    }
    if parents.is_empty() {
        return;
    }
    let mut first = 0;
    for body in 0..description.bodies.len() {
        let own = own_coordinates(description, parents, body);
        if let Some(link) = links.get_mut(first).filter(|_| own > 0) {
            link.before = last_before(description, parents, body);
        }
        first += own;
    }
}

/// The body that carries another one.
fn carrier(parents: &[usize], body: usize) -> Option<usize> {
    body.checked_sub(1).map(|before| parents.get(before).copied().unwrap_or(before))
}

/// The number of coordinates of a body's joint.
fn own_coordinates(description: &Description, parents: &[usize], body: usize) -> usize {
    let degrees = |body: usize| description.bodies.get(body).map_or(0, |info| info.degrees_of_freedom);
    degrees(body).saturating_sub(carrier(parents, body).map_or(0, degrees))
}

/// The last coordinate on the path to a body, without those of its own joint.
fn last_before(description: &Description, parents: &[usize], mut body: usize) -> Option<usize> {
    loop {
        body = carrier(parents, body)?;
        if own_coordinates(description, parents, body) > 0 {
            let own = |body| own_coordinates(description, parents, body);
            return (0..=body).map(own).sum::<usize>().checked_sub(1);
        }
    }
}
