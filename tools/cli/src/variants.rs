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
    values.extend(guesses_of_elements(&spec, text));
    Ok(Some((name, exchanged(text, values))))
}

/// Places of what the elements' coordinates are guessed to be, with nothing in place of them.
fn guesses_of_elements(spec: &Crane, text: &str) -> Vec<(Span, String)> {
    let links: Vec<&str> = beams(spec).map(|(link, _)| link).collect();
    let of_element = |coordinate: &str| {
        links.iter().any(|link| {
            let rest = coordinate.strip_prefix(link).and_then(|rest| rest.strip_prefix('_'));
            rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    let entries = spec.guess.iter().filter_map(|guess| guess.value.as_ref()).flat_map(|entries| &entries.0);
    let entries: Vec<(Span, bool)> = entries
        .map(|(key, value)| {
            let span = Span { start: key.span.start, end: value.span.end };
            (span, key.value.as_deref().is_some_and(of_element))
        })
        .collect();
    let nothing = |span: Span| (span, String::new());
    if let (Some((first, _)), Some((last, _)), true) =
        (entries.first(), entries.last(), entries.iter().all(|(_, of)| *of))
    {
        // Nothing is left to guess, so the key goes, too.
        let start = text[..first.start].rfind("guess").unwrap_or(first.start);
        let flow = text[start..first.start].contains('{');
        let end =
            if flow { text[last.end..].find('}').map_or(last.end, |brace| last.end + brace + 1) } else { last.end };
        return vec![nothing(Span { start, end })];
    }
    let without_comma = |Span { start, end }: Span| {
        let behind = text[end..].trim_start_matches([' ', '\n']);
        match behind.strip_prefix(',') {
            Some(rest) => Span { start, end: text.len() - rest.trim_start_matches([' ', '\n']).len() },
            None => Span {
                start: start
                    - usize::from(text[..start].trim_end().ends_with(','))
                        * (start - text[..start].trim_end().len() + 1),
                end,
            },
        }
    };
    entries.into_iter().filter(|(_, of)| *of).map(|(span, _)| nothing(without_comma(span))).collect()
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
        assert!(text.contains("sections: rigid"), "{text}");
        let block = BOOM.split("guess:").next().unwrap();
        for guess in [
            "guess:\n  boom_1_psi: 0.01\n  load_psi: 90 deg\n  boom_2_theta: 0.02   # a little\n",
            "guess: {boom_1_psi: 0.01, load_psi: 90 deg, boom_2_theta: 0.02}\n",
            "guess: {load_psi: 90 deg, boom_1_psi: 0.01}\n",
            "guess: {boom_1_psi: 0.01, boom_2_theta: 0.02}\n",
            "guess:\n  boom_1_psi: 0.01\n",
            "",
        ] {
            let (_, text) = rigid("boom", &format!("{block}{guess}")).unwrap().unwrap();
            let source = SourceFile::new("boom_rigid.yaml", text.as_str());
            let chain = compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"));
            let names: Vec<_> = chain.coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
            assert_eq!(names, ["boom_psi", "load_psi"], "{text}");
            let expected = if guess.contains("load_psi") { std::f64::consts::FRAC_PI_2 } else { 0.0 };
            assert!((chain.guess[1] - expected).abs() < 1e-15, "{text}");
        }
        assert_eq!(rigid("boom_rigid", &text), Ok(None));
    }

    #[test]
    fn a_name_is_exchanged_alone() {
        assert_eq!(renamed("other", BOOM).unwrap(), BOOM.replace("name: boom\nm", "name: other\nm"));
    }
}
