//! What an exported file shows of a crane.

use crate::chain::{BodyId, Frame, Vector};

/// A part that is shown, in one colour. It has neither mass nor contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The body in whose frame it is; `None` for the world.
    pub body: Option<BodyId>,
    /// Its pose in that frame.
    pub frame: Frame,
    /// Its form.
    pub form: Form,
    /// Name of its colour.
    pub paint: &'static str,
    /// Red, green and blue, each from 0 to 1.
    pub colour: Vector,
}

/// The form of a part; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A box about its middle, with sides along x, y and z.
    Box(Vector),
    /// A cylinder about its middle, along z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length.
        length: f64,
    },
    /// A ball about its middle.
    Sphere(f64),
    /// A surface in a file of its own.
    Mesh {
        /// A name that no other one has.
        name: String,
        /// The file, as the exported file names it.
        file: String,
    },
}

/// The colours of some parts, each once.
pub(super) fn colours(looks: &[Look]) -> Vec<(&'static str, String)> {
    let mut found: Vec<(&'static str, String)> = Vec::new();
    for look in looks {
        if found.iter().all(|(name, _)| *name != look.paint) {
            let [red, green, blue] = look.colour.map(|share| format!("{share:.3}"));
            found.push((look.paint, format!("{red} {green} {blue} 1")));
        }
    }
    found
}

/// The parts on a body, or in the world.
pub(super) fn on(looks: &[Look], body: Option<BodyId>) -> impl Iterator<Item = &Look> {
    looks.iter().filter(move |look| look.body == body)
}
