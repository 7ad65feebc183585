//! Outlines of beams, for pictures, from their sections in the spec. Mechanics needs only areas and moments.

use crate::spec::{Beam, Crane, Given, Number, Scalar, Section};

/// Outline of a beam's section.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Name of the link.
    pub link: String,
    /// Along the link's y and z, m.
    pub size: [f64; 2],
    /// Whether it is an ellipse in that box instead of the box.
    pub round: bool,
}

/// Outlines of the beams whose sections have a shape, with parameters at their defaults.
#[must_use]
pub fn outlines(crane: &Crane) -> Vec<Outline> {
    let links = crane.links.value.iter().flatten().filter_map(|link| link.value.as_ref());
    let outline = |link: &crate::spec::Link| {
        let Beam { section, .. } = link.beam.as_ref()?.value.as_ref()?;
        let number = |given: &Given<Number>| number(crane, given);
        let (size, round) = match section.as_ref()?.value.as_ref()? {
            Section::Box { height, width, .. } | Section::Solid { height, width } => {
                ([number(height)?, number(width)?], false)
            }
            Section::Tube { diameter, .. } | Section::Circle { diameter } => ([number(diameter)?; 2], true),
            Section::Numbers { .. } => return None,
        };
        Some(Outline { link: link.name.value.clone()?, size, round })
    };
    links.filter_map(outline).collect()
}

/// A number; for a parameter, its default.
fn number(crane: &Crane, given: &Given<Number>) -> Option<f64> {
    match &given.value.as_ref()?.0 {
        Scalar::Number(number) | Scalar::Angle(number) => Some(*number),
        Scalar::Name(name) => {
            let entries = &crane.parameters.as_ref()?.value.as_ref()?.0;
            let (_, parameter) = entries.iter().find(|(known, _)| known.value.as_ref() == Some(name))?;
            match parameter.value.as_ref()?.value.value.as_ref()?.0 {
                Scalar::Number(number) => Some(number),
                _ => None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SourceFile, read};

    #[test]
    fn sections_with_a_shape_have_an_outline() {
        let beam = |name: &str, section: &str| {
            format!("  - {{name: {name}, beam: {{length: 1, sections: 1, material: m, section: {section}}}}}\n")
        };
        let text = "format: 1\nname: x\nparameters: {d: {value: 0.3}}\nlinks:\n".to_owned()
            + &beam("boxed", "{box: {height: 0.2, width: 0.1, thickness: 0.01}}")
            + &beam("piped", "{tube: {diameter: d, thickness: 0.01}}")
            + &beam("plain", "{numbers: {area: 1, Jy: 1, Jz: 1, Jo: 1}}");
        let spec = read(&SourceFile::new("x.yaml", text)).expect("readable");
        let outline = |link: &str, size, round| Outline { link: link.into(), size, round };
        let expected = [outline("boxed", [0.2, 0.1], false), outline("piped", [0.3, 0.3], true)];
        assert_eq!(outlines(&spec.crane), expected);
    }
}
