//! What acts on links at points of them, besides other links.

use super::{Attachment, Connector, Contact, Crane, Cylinder, LoopJoint, Pin, Spanned, Vector, entries};

/// A point of a link at which a load, a cylinder, a connector, the ground or a loop joint acts.
#[derive(Clone, Copy, Debug)]
pub struct Acting<'a> {
    /// The word for what acts there.
    pub kind: &'static str,
    /// Its name.
    pub name: &'a Spanned<String>,
    /// The link.
    pub link: &'a Spanned<String>,
    /// The point in the frame of the link, m; `None` for its origin.
    pub at: Option<&'a Spanned<Vector>>,
    /// Whether a force acts at the point: not at pins of cylinders without a valve, whose joint is driven.
    pub pushes: bool,
}

/// All that acts on links of a crane; what is attached to the world is left out.
#[must_use]
pub fn acting(crane: &Crane) -> Vec<Acting<'_>> {
    let mut all = Vec::new();
    for load in entries(crane.loads.as_ref()) {
        let at = load.at.as_ref();
        all.push(Acting { kind: "load", name: &load.name, link: &load.link, at, pushes: true });
    }
    for Cylinder { name, foot, head, linkage, valve, .. } in entries(crane.cylinders.as_ref()) {
        let pivot = linkage.as_ref().and_then(|linkage| Some(&linkage.value.as_ref()?.pivot));
        let [foot, head] = [foot, head].map(|pin| pin.value.as_ref().map(|Pin { link, at }| (link, at)));
        let pivot = foot.zip(pivot).map(|((link, _), pivot)| (link, pivot));
        for (link, at) in [foot, head, pivot].into_iter().flatten() {
            all.push(Acting { kind: "cylinder", name, link, at: Some(at), pushes: valve.is_some() });
        }
    }
    for Connector { name, from, to, over, .. } in entries(crane.connectors.as_ref()) {
        let over = over.as_ref().and_then(|over| over.value.as_deref()).unwrap_or_default();
        for end in [from, to].into_iter().chain(over) {
            all.extend(attached("connector", name, end));
        }
    }
    for Contact { name, link, at, .. } in entries(crane.contacts.as_ref()) {
        all.push(Acting { kind: "contact", name, link, at: at.as_ref(), pushes: true });
    }
    for LoopJoint { name, from, to, .. } in entries(crane.loop_joints.as_ref()) {
        for end in [from, to] {
            all.extend(attached("loop joint", name, end));
        }
    }
    all
}

/// What is attached by one of its ends; `None` if that is on the world.
fn attached<'a>(kind: &'static str, name: &'a Spanned<String>, end: &'a Spanned<Attachment>) -> Option<Acting<'a>> {
    let Attachment { link, at } = end.value.as_ref()?;
    Some(Acting { kind, name, link: link.as_ref()?, at: Some(at), pushes: true })
}
