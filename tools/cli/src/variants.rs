//! Specs of cranes that differ in a few values, by exchanging these in the text.

use crane_codegen::{
    SourceFile,
    diagnostic::Span,
    read,
    spec::{Analysis, Beam, Crane, Sections},
};

/// What stands after the name of a crane in the name of the same crane with rigid beams.
const RIGID: &str = "_rigid";

/// A spec under another name; `None` where it cannot be read.
pub fn renamed(name: &str, text: &str) -> Option<String> {
    let spec = read(&SourceFile::new(name, text)).ok()?;
    Some(exchanged(text, vec![(spec.crane.name.span, name.to_owned())]))
}

/// A spec under another name with other numbers of sections; `None` for a crane without sections.
///
/// What a run of one crane does not need is left out: eight cranes a call take rustc as long as all the rest.
pub fn with_sections(name: &str, text: &str, sections: impl Fn(f64) -> String) -> Option<String> {
    let spec = read(&SourceFile::new(name, text)).ok()?.crane;
    let mut values = numbers_of_sections(&spec, sections);
    if values.is_empty() {
        return None;
    }
    values.push((spec.name.span, name.to_owned()));
    let analyses = spec.analyses.as_ref().and_then(|given| given.value.as_deref()).unwrap_or_default();
    if let Some(index) = analyses.iter().position(|analysis| analysis.value == Some(Analysis::Ensemble)) {
        // With the comma that sets it apart from its neighbour.
        let start = index.checked_sub(1).map_or(analyses[index].span.start, |before| analyses[before].span.end);
        let end = if index > 0 { analyses[index].span.end } else { analyses.get(1)?.span.start };
        values.push((Span { start, end }, String::new()));
    }
    Some(exchanged(text, values))
}

/// Name and spec of a crane whose beams do not bend, and nothing else is different; `None` for a crane without beams that bend.
///
/// # Errors
/// A beam is given element by element: the name of its link.
pub fn rigid(crane: &str, text: &str) -> Result<Option<(String, String)>, String> {
    let name = format!("{crane}{RIGID}");
    let Ok(spec) = read(&SourceFile::new(crane, text)) else { return Ok(None) };
    let spec = spec.crane;
    if let Some((link, _)) = beams(&spec).find(|(_, beam)| beam.elements.is_some()) {
        return Err(link.to_owned());
    }
    let mut values = numbers_of_sections(&spec, |_| "rigid".to_owned());
    if values.is_empty() {
        return Ok(None);
    }
    values.push((spec.name.span, name.clone()));
    if let Some(guess) = &spec.guess {
        // What the elements' coordinates are guessed to be has nothing to be said of any more.
        let flexible: Vec<String> = beams(&spec).map(|(link, _)| link.to_owned()).collect();
        let of_element = |coordinate: &str| {
            flexible.iter().any(|link| {
                let rest = coordinate.strip_prefix(link.as_str()).and_then(|rest| rest.strip_prefix('_'));
                rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
            })
        };
        let entries = guess.value.iter().flat_map(|entries| &entries.0);
        let kept: Vec<String> = entries
            .clone()
            .filter(|(coordinate, _)| !coordinate.value.as_deref().is_some_and(of_element))
            .map(|(coordinate, value)| {
                let [coordinate, value] = [coordinate.span, value.span].map(|span| &text[span.start..span.end]);
                format!("{coordinate}: {value}")
            })
            .collect();
        if kept.len() < entries.count() {
            values.push((guess.span, format!("{{{}}}", kept.join(", "))));
        }
    }
    Ok(Some((name, exchanged(text, values))))
}

/// Beams and the names of their links.
fn beams(spec: &Crane) -> impl Iterator<Item = (&str, &Beam)> {
    let links = spec.links.value.iter().flatten().filter_map(|link| link.value.as_ref());
    links.filter_map(|link| Some((link.name.value.as_deref()?, link.beam.as_ref()?.value.as_ref()?)))
}

/// Places of the numbers of sections, and others in place of them.
fn numbers_of_sections(spec: &Crane, sections: impl Fn(f64) -> String) -> Vec<(Span, String)> {
    let counts = beams(spec).filter_map(|(_, beam)| beam.sections.as_ref());
    counts
        .filter_map(|given| match &given.value {
            Some(Sections::Count(count)) => Some((given.span, sections(*count))),
            _ => None,
        })
        .collect()
}

/// A text with other values in some places.
fn exchanged(text: &str, mut values: Vec<(Span, String)>) -> String {
    // From the last on: places before it stay.
    values.sort_unstable_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, value) in values {
        text.replace_range(span.start..span.end, &value);
    }
    text
}

#[cfg(test)]
mod tests {
    use crane_codegen::compile;

    use super::*;

    const BOOM: &str = "format: 1
name: boom
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - name: boom
    joint: revolute
    beam: {length: 2, sections: 2, material: steel, section: {circle: {diameter: 0.1}}}
  - {name: load, joint: revolute, mass: 10, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 1e6, motion: {hold: 0}}]
guess:
  boom_1_psi: 0.01
  load_psi: 90 deg
  boom_2_theta: 0.02
";

    #[test]
    fn a_rigid_beam_has_no_elements_and_no_guess_of_them() {
        let (name, text) = rigid("boom", BOOM).unwrap().unwrap();
        assert_eq!(name, "boom_rigid");
        assert!(text.contains("sections: rigid") && text.contains("guess:\n  {load_psi: 90 deg}"), "{text}");
        let chain = compile::load(&SourceFile::new("boom_rigid.yaml", text.as_str())).unwrap_or_else(|m| panic!("{m}"));
        let names: Vec<_> = chain.coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
        assert_eq!(names, ["boom_psi", "load_psi"]);
        assert_eq!(rigid("boom_rigid", &text), Ok(None));
    }

    #[test]
    fn a_name_is_exchanged_alone() {
        assert_eq!(renamed("other", BOOM).unwrap(), BOOM.replace("name: boom\nm", "name: other\nm"));
    }
}
