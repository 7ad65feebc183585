//! Places along beams where something acts on them, before the beams are divided: sections end there.

use std::collections::BTreeMap;

use super::Check;
use crate::chain::{ParameterId, Value};
use crate::spec::{Acting, Crane, Either, Number, On, Place, Scalar, Spanned, Vector, acting, entries};

impl<'a> Check<'a> {
    /// The places on all links, by name, m: of other links and of what acts on them. Mistakes in them are reported where they are
    /// read.
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
            Scalar::Name(name) => {
                Value::Parameter(ParameterId(self.parameters.iter().position(|parameter| parameter.name == *name)?))
            }
            written => written.number()?.into(),
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
    for Acting { link, at, .. } in acting(crane).into_iter().filter(|acting| acting.pushes) {
        places.extend(link.value.as_deref().zip(at.and_then(|at| at.value.as_ref())));
    }
    places
}
