//! Cranes that differ little from others: changes of their specs.

use crane_codegen::{
    Change, Checked, CraneSpec, Diagnostics, check,
    diagnostic::code,
    outline,
    spec::{Beam, Crane, Sections, entries},
};

use crane_model::Description;

use crate::problem::{Outcome, Problem, meant};

/// What an option changes in a crane.
pub enum Edit<'a> {
    /// Beams become rigid; what to do otherwise.
    Rigid(&'a str),
    /// One of its combinations is in force.
    Combination(&'a str),
    /// Drives hold positions: what makes a crane with this description and spec do so.
    Hold(&'a dyn Fn(&Description, &Crane) -> Outcome<Change>),
    /// It has another name.
    Name(&'a str),
}

/// A crane with edits of its spec, which is checked once. What only the replaced parts referred to, parameters and inputs, is removed.
///
/// # Errors
/// Mistakes of the spec itself; otherwise of the first edit that makes some, in its words.
pub fn edited(spec: &CraneSpec, edits: &[Edit<'_>]) -> Outcome<Checked> {
    edited_by(spec, edits, &mut check)
}

/// What checks a spec.
type Check<'a> = &'a mut dyn FnMut(CraneSpec) -> Result<Checked, Diagnostics>;

fn edited_by(spec: &CraneSpec, edits: &[Edit<'_>], check: Check<'_>) -> Outcome<Checked> {
    if !edits.is_empty() && spec.is_sound() {
        let all = edits.iter().try_fold(spec.clone(), |spec, edit| edit.applied(&spec));
        if let Some(checked) = all.ok().and_then(|all| check_used(all, spec, check).ok()) {
            return Ok(checked);
        }
    }
    // What is wrong, step by step.
    let mut checked = check(spec.clone()).map_err(Problem::mistakes)?;
    for edit in edits {
        let found = check_used(edit.applied(&checked.spec)?, &checked.spec, check);
        checked = found.map_err(|diagnostics| edit.refused(&checked.chain.name, diagnostics))?;
    }
    Ok(checked)
}

/// Checks a changed spec, and removes parameters and inputs that are used in the one `before` it alone.
fn check_used(mut spec: CraneSpec, before: &CraneSpec, check: Check<'_>) -> Result<Checked, Diagnostics> {
    // An input may be all that uses a parameter.
    for _ in 0..2 {
        let diagnostics = match check(spec.clone()) {
            Ok(checked) => return Ok(checked),
            Err(diagnostics) => diagnostics,
        };
        let unused = [("parameters", code::unused_parameter), ("inputs", code::unused_input)].map(|(key, code)| {
            let own = diagnostics.mistakes().iter().filter(|mistake| mistake.code == code);
            let names = own.filter_map(|mistake| before.source().text.get(mistake.span.start..mistake.span.end));
            let names = names.filter(|name| before.mentions(name)).map(|name| (name, Change::removed()));
            (key, names.collect::<Vec<_>>())
        });
        let removed: Vec<_> = unused.into_iter().filter(|(_, names)| !names.is_empty()).collect();
        if removed.is_empty() {
            return Err(diagnostics);
        }
        spec = spec.changed(&Change::keys(removed.into_iter().map(|(key, names)| (key, Change::keys(names)))))?;
    }
    check(spec)
}

impl Edit<'_> {
    /// The spec with the edit, not checked.
    fn applied(&self, spec: &CraneSpec) -> Outcome<CraneSpec> {
        let name = spec.crane.name.value.as_deref().unwrap_or_default();
        let change = match self {
            Self::Rigid(otherwise) => rigid(name, &spec.crane)
                .map_err(|link| {
                    Problem::usage(
                        format!("the beam of {link} is curved or given element by element: it has no rigid form"),
                        "give it `sections`, `material` and `section` without `bend`, or write the rigid crane yourself",
                    )
                })?
                .ok_or_else(|| Problem::usage(format!("{name} has no beams that bend: it is rigid already"), *otherwise))?,
            Self::Combination(combination) => {
                let known = names_of_combinations(&spec.crane)?;
                if !known.contains(combination) {
                    let title = format!("{name} has no combination `{combination}`");
                    return Err(Problem::usage(title, meant(combination, &known, "combinations")));
                }
                Change::keys([("combination", (*combination).into())])
            }
            Self::Hold(hold) => hold(&outline(spec).map_err(Problem::mistakes)?.description(), &spec.crane)?,
            Self::Name(name) => Change::keys([("name", (*name).into())]),
        };
        spec.changed(&change).map_err(Problem::mistakes)
    }

    /// What mistakes of the edit mean.
    fn refused(&self, name: &str, diagnostics: Diagnostics) -> Problem {
        match self {
            Self::Rigid(otherwise)
                if diagnostics.mistakes().iter().any(|mistake| mistake.code == code::nothing_moves) =>
            {
                Problem::usage(format!("with rigid beams, nothing in {name} can move: only its beams do"), *otherwise)
            }
            Self::Rigid(otherwise) => {
                Problem::failed(format!("{name} has no form with rigid beams: {}", diagnostics.headline()), *otherwise)
            }
            _ => Problem::mistakes(diagnostics),
        }
    }
}

/// Names of the combinations of a crane: at least one.
///
/// # Errors
/// It has none.
pub fn names_of_combinations(spec: &Crane) -> Outcome<Vec<&str>> {
    let names: Vec<&str> =
        entries(spec.combinations.as_ref()).filter_map(|combination| combination.name.value.as_deref()).collect();
    if names.is_empty() {
        return Err(Problem::usage(
            format!("{} has no combinations", spec.name.value.as_deref().unwrap_or_default()),
            "add them to its spec, such as `combinations: [{name: lifting, weight: 1.2}]`",
        ));
    }
    Ok(names)
}

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
    use crane_codegen::{Change, Checked, SourceFile, check, compile, read, spec::Crane};
    use crane_model::Description;

    use super::{Edit, edited_by};
    use crate::problem::Problem;

    fn rigid(crane: &str, text: &str) -> Result<Option<String>, String> {
        let checked = compile::check(&SourceFile::new(crane, text)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let Some(change) = super::rigid(crane, &checked.spec.crane)? else { return Ok(None) };
        let changed =
            checked.spec.changed(&change).and_then(check).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let text = changed.spec.saved().text.clone();
        // What is saved is the same crane.
        let saved = compile::load(&SourceFile::new("saved.yaml", text.as_str()))
            .unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        assert_eq!(format!("{:?}", changed.chain), format!("{saved:?}"));
        Ok(Some(text))
    }

    /// One check where nothing is wrong, two where an edit leaves a parameter unused, and the mistakes of the file as without edits.
    #[test]
    fn a_spec_with_edits_is_checked_once() {
        let held = Change::keys([("coordinate", "boom_psi".into()), ("motion", Change::keys([("hold", 0.3.into())]))]);
        let held = Change::keys([("drives", Change::list([held]))]);
        let hold = |_: &Description, _: &Crane| Ok(held.clone());
        let edits = [Edit::Rigid(""), Edit::Combination("lift"), Edit::Hold(&hold)];
        let checks = |more: &str| {
            let text = BOOM.replace("{hold: 0}", if more.contains("angle") { "{hold: angle}" } else { "{hold: 0}" });
            let text = format!("{text}combinations: [{{name: lift, weight: 1.5}}]\n{more}");
            let spec = read(&SourceFile::new("boom.yaml", text)).expect("YAML");
            let mut count = 0;
            let found = edited_by(&spec, &edits, &mut |spec| {
                count += 1;
                check(spec)
            });
            (count, found)
        };
        for (more, checked) in [("", 1), ("parameters: {angle: {value: 0.1, unit: rad}}\n", 2)] {
            let (count, found) = checks(more);
            let Ok(Checked { chain, spec, .. }) = found else { panic!("a crane") };
            assert_eq!((count, &*chain.name, chain.parameters.len()), (checked, "boom_rigid", 0));
            assert!(spec.crane.combination.is_some() && spec.saved().text.contains("motion: {hold: 0.3}"));
        }
        for (more, told) in [("parameters: {spare: {value: 1}}\n", "E027"), ("run: {duration: -1}\n", "E031")] {
            let (count, found) = checks(more);
            assert!(matches!(found, Err(Problem::Mistakes(found)) if found.mistakes()[0].code == told), "{more}");
            assert_eq!(count, 1);
        }
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
