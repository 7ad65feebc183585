//! The same crane with other numbers of sections, and how much its frequencies, stresses and deflections change with twice as many.

use crane_codegen::{
    SourceFile, read,
    spec::{Analysis, Link, Sections, Spanned},
};
use crane_live::LiveCrane;
use crane_model::{Description, dyn_crane::DynCrane, modes::undamped, sections::StressedSection};
use crane_page::{history::Instant, tables::Case};

use crate::{
    problem::Outcome,
    selection::{Registry, take_numbers},
};

/// Maximum number of coordinates of a crane that is also computed with twice the sections: more take seconds. Of larger ones, the change is estimated
/// by half of the sections.
const MOST_COORDINATES: usize = 60;
/// Number of lowest modes that the sections should resolve; higher ones are modes of the elements.
const LOWEST: usize = 6;
/// Change of a frequency that is worth a caution.
const CAUTION: f64 = 0.01;
/// Change of a stress that is worth a caution.
const CAUTION_OF_STRESS: f64 = 0.03;

/// The same crane with another number of sections, at rest.
struct OtherMesh {
    crane: LiveCrane,
    /// What a difference to this crane is of the change with twice the sections.
    share: f64,
}

impl OtherMesh {
    /// With twice the sections, or half of them in a large crane, and the same parameters and inputs; `None` without sections to change.
    ///
    /// Errors fall with the square of the number of sections, so that with r times as many, `x_{rn} − x_n = (1 − 1/r²) (x − x_n)`, and with r times
    /// fewer, `x_n − x_{n/r} = (r² − 1) (x − x_n)`. Three quarters of `x − x_n` show with twice as many.
    fn of(crane: &dyn DynCrane, registry: &Registry) -> Option<Self> {
        let description = crane.description();
        let text = registry.spec(&description.name)?;
        // What the crane has, which is more than what is written where more acts on a beam.
        let sections = |description: &Description, link: &str| {
            let elements = description.bodies.iter().filter(|body| body.link == *link).count();
            elements.saturating_sub(1) as f64
        };
        let is_large = description.coordinates.len() > MOST_COORDINATES;
        let mut divided = Vec::new();
        let text = with(&description.name, text, |link, _| {
            divided.push(link.to_owned());
            let own = sections(description, link);
            if is_large { (0.5 * own).ceil() } else { 2.0 * own }
        })?;
        let mut crane_with = LiveCrane::from_spec(&SourceFile::new(description.name.to_string(), text)).ok()?;
        let [own, other] = [description, (&crane_with as &dyn DynCrane).description()]
            .map(|description| divided.iter().map(|link| sections(description, link)).sum::<f64>());
        let more = other / own;
        if !more.is_finite() || (more - 1.0).abs() < f64::EPSILON {
            return None;
        }
        let share = if is_large { -0.75 / (more.powi(-2) - 1.0) } else { 0.75 / (1.0 - more.powi(-2)) };
        take_numbers(crane, &mut crane_with).ok()?;
        Some(Self { crane: crane_with, share })
    }

    /// At rest; `None` without a stable pose.
    fn case<'a>(&'a self, label: &'a str) -> Option<Case<'a>> {
        Some(Case::new(label, &self.crane)).filter(|case| case.equilibrium.is_stable())
    }
}

/// Relative changes of the frequencies with twice the sections, lowest first; `None` for a crane without sections or without a stable pose.
///
/// # Errors
/// The modes of one of the cranes cannot be computed.
pub fn changes(case: &Case<'_>, registry: &Registry) -> Outcome<Option<Vec<f64>>> {
    let Some(mesh) = OtherMesh::of(case.crane, registry) else { return Ok(None) };
    let Some(other) = mesh.case(case.label) else { return Ok(None) };
    let frequencies = |case: &Case<'_>| -> Outcome<Vec<Option<f64>>> {
        let modes = undamped(&case.crane.small_motions_at(&case.equilibrium.q))?;
        Ok(modes.iter().take(LOWEST).map(crane_model::modes::Mode::frequency).collect())
    };
    let pairs = frequencies(case)?.into_iter().zip(frequencies(&other)?);
    Ok(Some(pairs.map_while(|(own, other)| Some(mesh.share * (other? / own? - 1.0))).collect()))
}

/// Relative change of the maximum equivalent stress of beams at rest with twice the sections; `None` for a crane without stresses or sections, or
/// without a stable pose.
pub fn change_of_stress(case: &Case<'_>, registry: &Registry) -> Option<f64> {
    let greatest = |case: &Case<'_>| {
        let rest = Instant::at_rest(case.crane, &case.equilibrium.q);
        let sections = rest.stressed_sections(case.crane.description(), &case.crane.section_moduli_at());
        sections.into_iter().max_by(StressedSection::by_stress).map(|section| section.stress.equivalent)
    };
    let own = greatest(case).filter(|stress| *stress > 0.0)?;
    let mesh = OtherMesh::of(case.crane, registry)?;
    Some(mesh.share * (greatest(&mesh.case(case.label)?)? / own - 1.0))
}

/// By how much each point of interest moves with twice the sections, m; `None` for a crane without points or sections, or without a stable pose.
pub fn changes_of_points(case: &Case<'_>, registry: &Registry) -> Option<Vec<f64>> {
    let places = |case: &Case<'_>| case.crane.points_at(&case.equilibrium.q);
    let own = places(case);
    if own.is_empty() || !case.equilibrium.is_stable() {
        return None;
    }
    let mesh = OtherMesh::of(case.crane, registry)?;
    let other = places(&mesh.case(case.label)?);
    Some(own.iter().zip(&other).map(|(own, other)| mesh.share.abs() * (other - own).norm()).collect())
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
    with(&name(crane, sections), text, |_, _| sections as f64)
}

/// The spec of a crane, extended under another name with other numbers of sections; `None` for a crane without sections.
///
/// The ensemble functions are left out, as a run of one crane does not need them: they take rustc as long as all the rest.
fn with(name: &str, text: &str, mut sections: impl FnMut(&str, f64) -> f64) -> Option<String> {
    let base = SourceFile::new(name, text);
    let spec = read(&base).ok()?.crane;
    let count = |given: &Spanned<Link>| {
        let link = given.value.as_ref()?;
        match link.beam.as_ref()?.value.as_ref()?.sections.as_ref()?.value? {
            Sections::Count(count) => {
                let name = link.name.value.as_ref()?;
                Some((name.clone(), sections(name, count)))
            }
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
