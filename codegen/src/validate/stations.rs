//! Places along beams where something acts on them, before the beams are divided: sections end there.

use std::collections::BTreeMap;

use super::Check;
use crate::chain::{ParameterId, Value};
use crate::spec::{
    Attachment, Connector, Crane, Cylinder, Either, LoopJoint, Number, On, Pin, Place, Scalar, Spanned, Vector, entries,
};

impl<'a> Check<'a> {
    /// The places on all links, by name, m: of other links, loads, pins of cylinders that push, connectors and loop joints. Mistakes in them are
    /// reported where they are read.
    pub(super) fn stations(&self, crane: &'a Crane) -> BTreeMap<&'a str, Vec<Value>> {
        let mut stations: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
        for (link, [x, ..]) in places(crane) {
            if let Some(x) = self.quiet(x) {
                stations.entry(link).or_default().push(x);
            }
        }
        stations
    }

    /// A number that is checked elsewhere; `None` if it cannot be read.
    fn quiet(&self, given: &Spanned<Number>) -> Option<Value> {
        let value = match &given.value.as_ref()?.0 {
            Scalar::Number(number) => (*number).into(),
            Scalar::Quantity(quantity) => quantity.value.into(),
            Scalar::Name(name) => {
                Value::Parameter(ParameterId(self.parameters.iter().position(|parameter| parameter.name == *name)?))
            }
        };
        Some(value).filter(|value| self.now(value).is_finite())
    }
}

/// All places of links at which something acts, with the links' names.
fn places(crane: &Crane) -> Vec<(&str, &Vector)> {
    let mut places = Vec::new();
    for on in entries(Some(&crane.links)).filter_map(|link| link.on.as_ref()?.value.as_ref()) {
        if let Either::Full(On { link, at: Some(Spanned { value: Some(Place::Point(at)), .. }) }) = on {
            places.extend(link.value.as_deref().map(|link| (link, at)));
        }
    }
    let loads = entries(crane.loads.as_ref()).filter_map(|load| Some((&load.link, load.at.as_ref()?)));
    let pushing = entries(crane.cylinders.as_ref()).filter(|cylinder| cylinder.valve.is_some());
    let pins = pushing.flat_map(|Cylinder { foot, head, linkage, .. }| {
        let of_pins = [foot, head].map(|pin| pin.value.as_ref().map(|Pin { link, at }| (link, at)));
        let pivot = linkage.as_ref().and_then(|linkage| Some(&linkage.value.as_ref()?.pivot));
        let pivot = foot.value.as_ref().zip(pivot).map(|(foot, pivot)| (&foot.link, pivot));
        of_pins.into_iter().chain([pivot]).flatten()
    });
    let lines = entries(crane.connectors.as_ref()).flat_map(|Connector { from, to, over, .. }| {
        let over = over.as_ref().and_then(|over| over.value.as_deref()).unwrap_or_default();
        [from, to].into_iter().chain(over)
    });
    let joints = entries(crane.loop_joints.as_ref()).flat_map(|LoopJoint { from, to, .. }| [from, to]);
    let attached = lines.chain(joints).filter_map(|end| end.value.as_ref());
    let attached = attached.filter_map(|Attachment { link, at }| Some((link.as_ref()?, at)));
    for (link, at) in loads.chain(pins).chain(attached) {
        places.extend(link.value.as_deref().zip(at.value.as_ref()));
    }
    places
}
