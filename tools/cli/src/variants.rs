//! Cranes that differ little from others: changes of their specs.

use crane_codegen::{
    Change,
    spec::{Beam, Crane, Sections},
};

/// Suffix of a crane's name in the name of the same crane with rigid beams.
const RIGID: &str = "_rigid";

/// The crane with rigid beams, under another name and without any other difference; `None` for a crane without beams that bend.
///
/// # Errors
/// A beam is curved or given element by element: the name of its link.
pub fn rigid(crane: &str, spec: &Crane) -> Result<Option<Change>, String> {
    if let Some((link, _)) = beams(spec).find(|(_, beam)| beam.elements.is_some() || beam.bend.is_some()) {
        return Err(link.to_owned());
    }
    let bends = |(_, beam): &(&str, &Beam)| {
        matches!(beam.sections.as_ref().and_then(|given| given.value), Some(Sections::Count(_)))
    };
    let flexible: Vec<&str> = beams(spec).filter(bends).map(|(link, _)| link).collect();
    if flexible.is_empty() {
        return Ok(None);
    }
    let links = flexible
        .iter()
        .map(|link| Change::keys([("name", (*link).into()), ("beam", Change::keys([("sections", "rigid".into())]))]));
    let mut changes = vec![("name", format!("{crane}{RIGID}").as_str().into()), ("links", Change::list(links))];
    let mut guesses = guesses_of_elements(spec, &flexible).map(|coordinate| (coordinate, Change::removed())).peekable();
    if guesses.peek().is_some() {
        changes.push(("guess", Change::keys(guesses)));
    }
    Ok(Some(Change::keys(changes)))
}

/// Beams and the names of their links.
fn beams(spec: &Crane) -> impl Iterator<Item = (&str, &Beam)> {
    let links = spec.links.value.iter().flatten().filter_map(|link| link.value.as_ref());
    links.filter_map(|link| Some((link.name.value.as_deref()?, link.beam.as_ref()?.value.as_ref()?)))
}

/// Coordinates of elements of some links for which the spec has a guess.
fn guesses_of_elements<'a>(spec: &'a Crane, links: &'a [&str]) -> impl Iterator<Item = &'a str> {
    let of_element = |coordinate: &&str| {
        links.iter().any(|link| {
            let rest = coordinate.strip_prefix(link).and_then(|rest| rest.strip_prefix('_'));
            rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    let guesses = spec.guess.iter().filter_map(|guess| guess.value.as_ref()).flat_map(|entries| &entries.0);
    guesses.filter_map(|(coordinate, _)| coordinate.value.as_deref()).filter(of_element)
}

#[cfg(test)]
mod tests {
    use crane_codegen::{SourceFile, compile};

    fn rigid(crane: &str, text: &str) -> Result<Option<String>, String> {
        let checked = compile::check(&SourceFile::new(crane, text)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let Some(change) = super::rigid(crane, &checked.spec.crane)? else { return Ok(None) };
        let (changed, text) = compile::check_changed(&checked, text, &change).unwrap_or_else(|found| panic!("{found}"));
        // What is saved is the same crane.
        let saved =
            compile::load(&SourceFile::new("saved.yaml", text.as_str())).unwrap_or_else(|found| panic!("{found}"));
        assert_eq!(format!("{:?}", changed.chain), format!("{saved:?}"));
        Ok(Some(text))
    }

    const BOOM: &str = "format: 1
name: boom
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - name: boom
    joint: revolute
    beam: {length: 2, sections: 2, material: steel, section: {circle: {diameter: 0.1}}}
  - {name: load, joint: revolute, mass: 10, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 1e6, motion: {hold: 0}}]
";

    #[test]
    fn a_curved_beam_has_no_rigid_twin() {
        let curved = BOOM.replace("sections: 2,", "sections: 2, bend: {theta: 10 deg},");
        assert_eq!(rigid("boom", &curved), Err("boom".to_owned()));
        assert!(rigid("boom", BOOM).is_ok());
    }

    #[test]
    fn a_rigid_beam_has_no_elements_and_no_guess_of_them() {
        for guess in [
            "guess:\n  boom_1_psi: 0.01\n  load_psi: 90 deg\n  boom_2_theta: 0.02   # a little\n",
            "guess: {boom_1_psi: 0.01, boom_2_theta: 0.02}\n",
            "",
        ] {
            let text = rigid("boom", &format!("{BOOM}{guess}")).unwrap().unwrap();
            let source = SourceFile::new("boom_rigid.yaml", text.as_str());
            let chain = compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"));
            assert_eq!(chain.name, "boom_rigid");
            let names: Vec<_> = chain.coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
            assert_eq!(names, ["boom_psi", "load_psi"], "{text}");
            let expected = if guess.contains("load_psi") { std::f64::consts::FRAC_PI_2 } else { 0.0 };
            assert!((chain.guess[1] - expected).abs() < 1e-15, "{text}");
            assert_eq!(rigid("boom_rigid", &text), Ok(None));
        }
    }
}
