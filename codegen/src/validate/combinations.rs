//! Combinations of weights and loads.

use super::Check;
use crate::chain::{Combination, Load, ParameterId};
use crate::diagnostic::{rule, suggest};
use crate::spec::{Constant, Crane, Entries, Spanned};

/// The unit of masses.
const MASS: &str = "kg";

impl<'a> Check<'a> {
    pub(super) fn combinations(&mut self, crane: &'a Crane, loads: &[Load]) -> Vec<Combination> {
        let given = crane.combinations.as_ref().and_then(|given| given.value.as_deref()).unwrap_or_default();
        let mut combinations = Vec::new();
        for combination in given.iter().filter_map(|combination| combination.value.as_ref()) {
            let name = self.name(&combination.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("combinations", &name, "an earlier combination".into(), combination.name.span);
            }
            let subject = |what: &str| format!("the factor of {what} in combination `{name}`");
            let weight = combination.weight.as_ref();
            let weight = weight.map_or(1.0, |given| self.constant(given, &subject("the weight")));
            let mut masses = Vec::new();
            for (mass, factor) in entries(combination.masses.as_ref()) {
                let factor = self.constant(factor, &subject("a mass"));
                let Some(wanted) = self.name(mass) else { continue };
                match self.parameters.iter().position(|parameter| parameter.name == wanted) {
                    Some(index) if self.parameters[index].unit == MASS => masses.push((ParameterId(index), factor)),
                    Some(index) => {
                        let unit = self.parameters[index].unit.clone();
                        self.report(rule::not_a_mass(mass.span, &name, wanted, &unit));
                    }
                    None => {
                        let help = suggest(wanted, self.parameters.iter().map(|parameter| parameter.name.as_str()));
                        self.report(rule::unknown_mass(mass.span, wanted, help));
                    }
                }
            }
            let mut of_loads = Vec::new();
            for (load, factor) in entries(combination.loads.as_ref()) {
                let factor = self.constant(factor, &subject("a load"));
                let Some(wanted) = self.name(load) else { continue };
                if let Some(index) = loads.iter().position(|load| load.name == wanted) {
                    of_loads.push((index, factor));
                } else {
                    let help = suggest(wanted, loads.iter().map(|load| load.name.as_str()));
                    self.report(rule::unknown_load(load.span, wanted, help));
                }
            }
            combinations.push(Combination { name, weight, masses, loads: of_loads });
        }
        combinations
    }

    /// The combination with which the crane is computed.
    pub(super) fn combination(&mut self, crane: &'a Crane, known: &[Combination]) -> Option<Combination> {
        let given = crane.combination.as_ref()?;
        let wanted = given.value.as_deref()?;
        let found = known.iter().find(|combination| combination.name == wanted);
        if found.is_none() {
            let help = suggest(wanted, known.iter().map(|combination| combination.name.as_str()));
            self.report(rule::unknown_combination(given.span, wanted, help));
        }
        found.cloned()
    }
}

/// Factors by names.
fn entries(given: Option<&Spanned<Entries<Constant>>>) -> impl Iterator<Item = &(Spanned<String>, Spanned<Constant>)> {
    given.and_then(|given| given.value.as_ref()).into_iter().flat_map(|entries| &entries.0)
}
