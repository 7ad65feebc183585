//! What an exported file shows of a crane.

use std::collections::BTreeSet;
use std::path::Path;

use super::free_name;
use crate::chain::{BodyId, Chain, Form, Frame, Vector};

/// A part that is shown, in one colour. It has neither mass nor contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The body in whose frame it is; `None` for the world.
    pub body: Option<BodyId>,
    /// Its pose in that frame.
    pub frame: Frame,
    /// Its form.
    pub form: Form,
    /// Name of its colour, with red, green and blue, each from 0 to 1; `None` for any.
    pub paint: Option<(&'static str, Vector)>,
}

/// The shapes that the spec gives its links.
#[must_use]
pub fn shapes(chain: &Chain, parameters: &[f64]) -> Vec<Look> {
    let look = |shape: &crate::chain::Shape| {
        let (frame, form) = shape.at(chain, parameters);
        Look { body: Some(shape.body), frame, form, paint: None }
    };
    chain.shapes.iter().map(look).collect()
}

/// The colours of some parts, each once.
pub(super) fn colours(looks: &[Look]) -> Vec<(&'static str, String)> {
    let mut found: Vec<(&'static str, String)> = Vec::new();
    for (paint, colour) in looks.iter().filter_map(|look| look.paint) {
        if found.iter().all(|(name, _)| *name != paint) {
            let [red, green, blue] = colour.map(|share| format!("{share:.3}"));
            found.push((paint, format!("{red} {green} {blue} 1")));
        }
    }
    found
}

/// The surfaces of some parts, each once, with names after their files.
pub(super) fn surfaces(looks: &[Look]) -> Vec<(&Form, String)> {
    let mut names = BTreeSet::new();
    let mut found: Vec<(&Form, String)> = Vec::new();
    for form in looks.iter().map(|look| &look.form) {
        if let Form::Mesh { file, .. } = form
            && found.iter().all(|(other, _)| *other != form)
        {
            let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
            found.push((form, free_name(&mut names, &stem, &|_, _| true)));
        }
    }
    found
}

/// The parts on a body, or in the world.
pub(super) fn on(looks: &[Look], body: Option<BodyId>) -> impl Iterator<Item = &Look> {
    looks.iter().filter(move |look| look.body == body)
}
