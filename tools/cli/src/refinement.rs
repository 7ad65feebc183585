//! The same crane with other numbers of sections, and how much its frequencies and stresses change with twice as many.

use crane_codegen::{
    SourceFile, read,
    spec::{Analysis, Link, Sections, Spanned},
};
use crane_live::LiveCrane;
use crane_model::{dyn_crane::DynCrane, modes::undamped, sections::StressedSection};
use crane_page::{history::Instant, tables::Case};

use crate::{problem::Outcome, selection::Registry};

/// Maximum number of coordinates of a crane that is also computed with twice the sections: more take seconds.
const MOST_COORDINATES: usize = 60;
/// Number of lowest modes that the sections should resolve; higher ones are modes of the elements.
const LOWEST: usize = 6;
/// Change of a frequency that is worth a caution.
const CAUTION: f64 = 0.01;
/// Change of a stress that is worth a caution.
const CAUTION_OF_STRESS: f64 = 0.03;

/// Relative changes of the frequencies with twice the sections, lowest first; `None` for a crane without sections, with too many,
/// or without a stable pose.
///
/// # Errors
/// The modes of one of the cranes cannot be computed.
pub fn changes(case: &Case<'_>, registry: &Registry) -> Outcome<Option<Vec<f64>>> {
    let Some(finer) = finer(case.crane, registry) else { return Ok(None) };
    let finer = Case::new(case.label, &finer);
    if !finer.equilibrium.is_stable() {
        return Ok(None);
    }
    let frequencies = |case: &Case<'_>| -> Outcome<Vec<Option<f64>>> {
        let modes = undamped(&case.crane.small_motions_at(&case.equilibrium.q))?;
        Ok(modes.iter().take(LOWEST).map(crane_model::modes::Mode::frequency).collect())
    };
    let pairs = frequencies(case)?.into_iter().zip(frequencies(&finer)?);
    Ok(Some(pairs.map_while(|(coarse, fine)| Some(fine? / coarse? - 1.0)).collect()))
}

/// Relative change of the maximum stress of beams at rest with twice the sections, by utilisation where there is a yield stress; `None` for
/// a crane without stresses or sections, with too many, or without a stable pose.
pub fn change_of_stress(case: &Case<'_>, registry: &Registry) -> Option<f64> {
    let greatest = |case: &Case<'_>| {
        let rest = Instant::at_rest(case.crane, &case.equilibrium.q);
        let sections = rest.stressed_sections(case.crane.description(), &case.crane.section_moduli_at());
        let section = sections.into_iter().max_by(StressedSection::by_use)?;
        Some(section.utilisation.unwrap_or(section.stress.equivalent))
    };
    let coarse = greatest(case).filter(|stress| *stress > 0.0)?;
    let finer = finer(case.crane, registry)?;
    let finer = Case::new(case.label, &finer);
    if !finer.equilibrium.is_stable() {
        return None;
    }
    Some(greatest(&finer)? / coarse - 1.0)
}

/// Says that the sections do not resolve the maximum stress.
pub fn caution_of_stress(change: f64) -> Option<String> {
    (change.abs() > CAUTION_OF_STRESS).then(|| {
        format!(
            "the maximum stress changes by {:+.1} % when the number of sections doubles: give the beams more `sections`",
            100.0 * change
        )
    })
}

/// The crane with twice the sections and the same parameters, if it has sections and not too many.
fn finer(crane: &dyn DynCrane, registry: &Registry) -> Option<LiveCrane> {
    let description = crane.description();
    let text = registry.spec(&description.name).filter(|_| description.coordinates.len() <= MOST_COORDINATES)?;
    let text = with(&description.name, text, |count| 2.0 * count)?;
    let mut finer = LiveCrane::from_spec(&SourceFile::new(description.name.to_string(), text)).ok()?;
    let values: Vec<f64> = (0..description.parameters.len()).map(|index| crane.parameter(index)).collect();
    DynCrane::set_parameters(&mut finer, &values).ok()?;
    Some(finer)
}

/// Names the lowest mode whose frequency the sections do not resolve.
pub fn caution(changes: &[f64]) -> Option<String> {
    let (index, change) = changes.iter().enumerate().find(|(_, change)| change.abs() > CAUTION)?;
    Some(format!(
        "the frequency of mode {} changes by {:.1} % when the number of sections doubles: give the beams more `sections`",
        index + 1,
        100.0 * change
    ))
}

/// Name of a crane with some number of sections of each flexible link.
pub fn name(crane: &str, sections: usize) -> String {
    format!("{crane}_sections_{sections}")
}

/// Spec of that crane.
pub fn spec(crane: &str, text: &str, sections: usize) -> Option<String> {
    with(&name(crane, sections), text, |_| sections as f64)
}

/// The spec of a crane, extended under another name with other numbers of sections; `None` for a crane without sections.
///
/// The ensemble functions are left out, as a run of one crane does not need them: they take rustc as long as all the rest.
fn with(name: &str, text: &str, sections: impl Fn(f64) -> f64) -> Option<String> {
    let base = SourceFile::new(name, text);
    let spec = read(&base).ok()?.crane;
    let count = |given: &Spanned<Link>| {
        let link = given.value.as_ref()?;
        match link.beam.as_ref()?.value.as_ref()?.sections.as_ref()?.value? {
            Sections::Count(count) => Some((link.name.value.as_ref()?.clone(), sections(count))),
            Sections::Rigid => None,
        }
    };
    let links: Vec<String> = (spec.links.value.iter().flatten().filter_map(count))
        .map(|(link, sections)| format!("  - {{name: {link}, beam: {{sections: {sections}}}}}\n"))
        .collect();
    if links.is_empty() {
        return None;
    }
    let asked = spec.analyses.as_ref().and_then(|given| given.value.as_deref()).unwrap_or_default();
    let kept = asked.iter().filter_map(|analysis| analysis.value).filter(|analysis| *analysis != Analysis::Ensemble);
    let kept: Vec<&str> = kept.map(Analysis::name).collect();
    let analyses = if asked.is_empty() { String::new() } else { format!("analyses: [{}]\n", kept.join(", ")) };
    Some(base.changed(&format!("name: {name}\n{analyses}links:\n{}", links.concat())).text)
}
