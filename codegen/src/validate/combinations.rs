//! Combinations of weights and loads.

use super::Check;
use crate::chain::{Combination, Load, ParameterId};
use crate::diagnostic::{rule, suggest};
use crate::presets::{Multiplied, hoisting_factor, partial_factor};
use crate::spec::{self, Constant, Crane, Entries, Spanned};

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
            let preset = combination.preset.as_ref().and_then(|preset| preset.value);
            let partial = |of| preset.map_or(1.0, |preset| partial_factor(preset.name(), of));
            let weight = combination.weight.as_ref();
            let weight =
                weight.map_or(partial(Multiplied::Weight), |constant| self.constant(constant, &subject("the weight")));
            self.factors_are_there(combination, &name);
            let hoisting = combination.hoisting.as_ref().and_then(|hoisting| hoisting.value.as_ref());
            let dynamic = hoisting.map_or(1.0, |hoisting| {
                let speed = self.constant(&hoisting.speed, &format!("the speed of hoisting in combination `{name}`"));
                hoisting.class.value.map_or(f64::NAN, |class| hoisting_factor(class.name(), speed))
            });
            let hoisted = partial(Multiplied::Hoisted) * dynamic;
            let (mut masses, mut of_loads) = (Vec::new(), Vec::new());
            for (mass, factor) in entries(combination.masses.as_ref()) {
                let factor = self.constant(factor, &subject("a mass"));
                masses.extend(self.mass(mass, &name).map(|index| (index, factor)));
            }
            for mass in names(combination.hoisted.as_ref()) {
                // What is written for a mass itself is in place of the preset.
                let index = self.mass(mass, &name).filter(|index| masses.iter().all(|(known, _)| known != index));
                masses.extend(index.map(|index| (index, hoisted)));
            }
            for (load, factor) in entries(combination.loads.as_ref()) {
                let factor = self.constant(factor, &subject("a load"));
                of_loads.extend(self.load_named(load, loads).map(|index| (index, factor)));
            }
            for load in names(combination.wind.as_ref()) {
                let index =
                    self.load_named(load, loads).filter(|index| of_loads.iter().all(|(known, _)| known != index));
                of_loads.extend(index.map(|index| (index, partial(Multiplied::Wind))));
            }
            combinations.push(Combination { name, weight, masses, loads: of_loads });
        }
        combinations
    }

    /// What is named has a factor, and a dynamic factor something to multiply.
    fn factors_are_there(&mut self, given: &spec::Combination, name: &str) {
        let spec::Combination { preset, hoisted, hoisting, wind, .. } = given;
        let of_hoisted =
            (hoisted, hoisting.is_some(), "what is hoisted", "write `preset: regular`, or factors under `masses:`");
        let of_wind = (wind, false, "wind", "write `preset: with_wind`, or factors under `loads:`");
        for (named, has_another, what, help) in [of_hoisted, of_wind] {
            if let Some(named) = named.as_ref().filter(|_| preset.is_none() && !has_another) {
                self.report(rule::no_factor(named.span, name, what, help));
            }
        }
        if let (Some(hoisting), None) = (hoisting, hoisted) {
            self.report(rule::nothing_hoisted(hoisting.span, name));
        }
    }

    /// The live parameter in kg of a name.
    fn mass(&mut self, mass: &'a Spanned<String>, combination: &str) -> Option<ParameterId> {
        let wanted = self.name(mass)?;
        match self.parameters.iter().position(|parameter| parameter.name == wanted) {
            Some(index) if self.parameters[index].unit == MASS => Some(ParameterId(index)),
            Some(index) => {
                let unit = self.parameters[index].unit.clone();
                self.report(rule::not_a_mass(mass.span, combination, wanted, &unit));
                None
            }
            None => {
                let help = suggest(wanted, self.parameters.iter().map(|parameter| parameter.name.as_str()));
                self.report(rule::unknown_mass(mass.span, wanted, help));
                None
            }
        }
    }

    /// The index of the load of a name.
    fn load_named(&mut self, load: &'a Spanned<String>, loads: &[Load]) -> Option<usize> {
        let wanted = self.name(load)?;
        let index = loads.iter().position(|load| load.name == wanted);
        if index.is_none() {
            let help = suggest(wanted, loads.iter().map(|load| load.name.as_str()));
            self.report(rule::unknown_load(load.span, wanted, help));
        }
        index
    }

    /// The combination with which the crane is computed.
    pub(super) fn combination(&mut self, crane: &'a Crane, known: &[Combination]) -> Option<Combination> {
        let text = crane.combination.as_ref()?;
        let wanted = text.value.as_deref()?;
        let found = known.iter().find(|combination| combination.name == wanted);
        if found.is_none() {
            let help = suggest(wanted, known.iter().map(|combination| combination.name.as_str()));
            self.report(rule::unknown_combination(text.span, wanted, help));
        }
        found.cloned()
    }
}

/// Factors by names.
fn entries(given: Option<&Spanned<Entries<Constant>>>) -> impl Iterator<Item = &(Spanned<String>, Spanned<Constant>)> {
    given.and_then(|given| given.value.as_ref()).into_iter().flat_map(|entries| &entries.0)
}

/// Names in a list.
fn names(given: Option<&Spanned<Vec<Spanned<String>>>>) -> impl Iterator<Item = &Spanned<String>> {
    given.and_then(|given| given.value.as_deref()).into_iter().flatten()
}
