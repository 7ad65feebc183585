//! Names of results: no two columns of a table, and no two variables of a unit for co-simulation, have the same.

use std::collections::BTreeMap;

use super::Check;
use crate::chain::Chain;
use crate::diagnostic::{Span, rule};
use crate::spec::{Crane, Spanned, entries};

/// Where names are written, by whose they are.
fn places(crane: &Crane) -> BTreeMap<String, Span> {
    let mut places = BTreeMap::new();
    let mut add = |what: &str, name: &Spanned<String>| {
        if let Some(written) = name.value.as_deref() {
            places.entry(format!("{what} `{written}`")).or_insert(name.span);
        }
    };
    let of_parameters = crane.parameters.as_ref().and_then(|given| given.value.as_ref());
    of_parameters.iter().flat_map(|given| &given.0).for_each(|(name, _)| add("parameter", name));
    let of_inputs = crane.inputs.as_ref().and_then(|given| given.value.as_ref());
    of_inputs.iter().flat_map(|given| &given.0).for_each(|(name, _)| add("input", name));
    entries(crane.points.as_ref()).for_each(|point| add("point", &point.name));
    entries(crane.supports.as_ref()).for_each(|support| add("support", &support.name));
    entries(crane.cylinders.as_ref()).for_each(|cylinder| add("cylinder", &cylinder.name));
    entries(crane.connectors.as_ref()).for_each(|connector| add("connector", &connector.name));
    entries(crane.couplings.as_ref()).for_each(|coupling| add("connector", &coupling.name));
    entries(crane.loop_joints.as_ref()).for_each(|joint| add("loop joint", &joint.name));
    places
}

impl Check<'_> {
    /// Reports names that two results would have. The crane has no other mistakes.
    pub(super) fn shared_columns(&mut self, chain: &Chain, crane: &Crane) {
        let places = places(crane);
        let mut told: Vec<String> = Vec::new();
        for [name, one, other] in chain.result_names().shared {
            let [owner, other] = if places.contains_key(&other) { [other, one] } else { [one, other] };
            if !told.contains(&owner) {
                let span = places.get(&owner).copied().unwrap_or(crane.links.span);
                self.report(rule::shared_column(span, &owner, other, name));
                told.push(owner);
            }
        }
    }
}
