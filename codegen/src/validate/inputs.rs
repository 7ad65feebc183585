//! Inputs, and references to them.

use super::Check;
use super::numbers::Whose;
use crate::chain::{Input, InputId, Profile};
use crate::diagnostic::{Span, rule, suggest};
use crate::spec::{self, Crane, Motion, Spanned};

impl<'a> Check<'a> {
    pub(super) fn take_inputs(&mut self, crane: &'a Crane) {
        let Some(inputs) = &crane.inputs else { return };
        let Some(entries) = &inputs.value else {
            self.unknown_inputs = true;
            return;
        };
        for (text, input) in &entries.0 {
            let (Some(name), Some(input)) = (self.name(text), &input.value) else {
                self.unknown_inputs = true;
                continue;
            };
            let unit = self.text(input.unit.as_ref(), &format!("the unit of input `{name}`"));
            let about = self.text(input.about.as_ref(), &format!("`about` of input `{name}`"));
            let unless_set = self.unless_set(name, text.span, input, unit.as_deref());
            let (unit, about) = (unit.unwrap_or_default(), about.unwrap_or_default());
            self.inputs.push(Input { name: name.to_owned(), unit, about, unless_set });
            self.used_inputs.push(false);
        }
    }

    /// The profile that an input follows until it is set.
    fn unless_set(&mut self, name: &str, span: Span, input: &spec::Input, unit: Option<&str>) -> Profile {
        if input.value.is_some() && input.motion.is_some() {
            self.report(rule::input_twice(span, name));
        }
        if let Some(given) = &input.motion {
            let motion = given.value.as_ref();
            if let Some(Motion::Input(_)) = motion {
                self.report(rule::input_of_input(given.span, name));
                return Profile::Hold(f64::NAN.into());
            }
            let profile = motion.and_then(|motion| self.motion(motion, Whose::Own(unit), given.span));
            return profile.unwrap_or(Profile::Hold(f64::NAN.into()));
        }
        let value = input.value.as_ref().map_or(0.0, |value| self.in_own_unit(value, &format!("input `{name}`"), unit));
        Profile::Hold(value.into())
    }

    /// The input of that name.
    pub(super) fn input(&mut self, text: &Spanned<String>) -> Option<Profile> {
        let name = text.value.as_deref()?;
        if let Some(index) = self.inputs.iter().position(|input| input.name == name) {
            self.used_inputs[index] = true;
            return Some(Profile::Input(InputId(index), Box::new(self.inputs[index].unless_set.clone())));
        }
        if !self.unknown_inputs {
            let help = suggest(name, self.inputs.iter().map(|input| input.name.as_str()));
            self.report(rule::unknown_input(text.span, name, help));
        }
        None
    }

    pub(super) fn every_input_used(&mut self, crane: &Crane) {
        // Something that could not be read may refer to it.
        if !self.mistakes.is_empty() {
            return;
        }
        let Some(entries) = crane.inputs.as_ref().and_then(|inputs| inputs.value.as_ref()) else { return };
        for ((name, _), used) in entries.0.iter().zip(std::mem::take(&mut self.used_inputs)) {
            if let (false, Some(text)) = (used, &name.value) {
                self.report(rule::unused_input(name.span, text));
            }
        }
    }
}
