//! The same crane with other numbers of sections, and how much its frequencies, stresses and deflections change with twice as many.

use crane_codegen::{
    Change, SourceFile, read,
    spec::{Analysis, Crane, Link, Sections, Spanned},
};
use crane_live::LiveCrane;
use crane_model::{
    CoordinateKind, Description, Wrench,
    dyn_crane::DynCrane,
    modes::undamped,
    results::ROUNDING,
    sections::{Place, StressedSection, stressed},
};
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
/// Part of the length of a beam within which places are one.
const ONE_PLACE: f64 = 1e-6;
/// Rotation of a joint from which a pose is another one, rad: meshes bend alike.
const ANOTHER_POSE: f64 = 0.3;
/// Change of a stress that is worth a caution.
const CAUTION_OF_STRESS: f64 = 0.03;

/// The same crane with another number of sections, at rest.
struct OtherMesh {
    crane: LiveCrane,
    /// What a difference to this crane is of the change with twice the sections.
    share: f64,
}

impl OtherMesh {
    /// With twice the sections, or half of them in a large crane, and the same parameters and inputs; why not, if there is none.
    ///
    /// Errors fall with the square of the number of sections, so that with r times as many, `x_{rn} − x_n = (1 − 1/r²) (x − x_n)`, and with r times
    /// fewer, `x_n − x_{n/r} = (r² − 1) (x − x_n)`. Three quarters of `x − x_n` show with twice as many.
    fn new(crane: &dyn DynCrane, registry: &Registry) -> Result<Self, &'static str> {
        const NOT_MADE: &str = "the crane with other sections cannot be made";
        let description = crane.description();
        // What the crane has, which is more than what is written where more acts on a beam.
        let sections = |description: &Description, link: &str| {
            let elements = description.bodies.iter().filter(|body| body.link == *link).count();
            elements.saturating_sub(1) as f64
        };
        let is_large = description.coordinates.len() > MOST_COORDINATES;
        let mut divided = Vec::new();
        let own = &registry.checked(&description.name).map_err(|_| NOT_MADE)?.spec.crane;
        let change = with(&description.name, own, |link, _| {
            divided.push(link.to_owned());
            let own = sections(description, link);
            if is_large { (0.5 * own).ceil() } else { 2.0 * own }
        });
        let change = change.ok_or("no beam has a number of `sections`")?;
        let checked = registry.changed(&description.name, &change).ok().and_then(Result::ok).ok_or(NOT_MADE)?;
        let mut crane_with = LiveCrane::new(checked.chain);
        let [own, other] = [description, (&crane_with as &dyn DynCrane).description()]
            .map(|description| divided.iter().map(|link| sections(description, link)).sum::<f64>());
        let more = other / own;
        if !more.is_finite() || (more - 1.0).abs() < f64::EPSILON {
            return Err("half of the sections are as many");
        }
        let share = if is_large { -0.75 / (more.powi(-2) - 1.0) } else { 0.75 / (1.0 - more.powi(-2)) };
        take_numbers(crane, &mut crane_with).map_err(|_| NOT_MADE)?;
        Ok(Self { crane: crane_with, share })
    }

    /// At rest, in the pose of a case.
    fn case<'a>(&'a self, own: &Case<'a>) -> Result<Case<'a>, &'static str> {
        let case = Case::new(own.label, &self.crane);
        if !case.equilibrium.is_stable() {
            return Err("the crane with other sections has no stable pose");
        }
        let angles = |case: &Case<'_>| -> Vec<f64> {
            let coordinates = case.crane.description().coordinates.iter().zip(&case.equilibrium.q);
            let of_joints =
                coordinates.filter(|(info, _)| info.kind == CoordinateKind::Rotation && !info.role.is_element());
            of_joints.map(|(_, angle)| *angle).collect()
        };
        let turned = angles(own).into_iter().zip(angles(&case)).any(|(own, other)| (own - other).abs() > ANOTHER_POSE);
        if turned { Err("from the same guess the crane with other sections rests in another pose") } else { Ok(case) }
    }
}

/// Relative changes of the frequencies with twice the sections, lowest first; `None` for a crane without sections or without a stable pose.
///
/// # Errors
/// The modes of one of the cranes cannot be computed.
pub fn changes(case: &Case<'_>, registry: &Registry) -> Outcome<Option<Vec<f64>>> {
    let Ok(mesh) = OtherMesh::new(case.crane, registry) else { return Ok(None) };
    let Ok(other) = mesh.case(case) else { return Ok(None) };
    let frequencies = |case: &Case<'_>| -> Outcome<Vec<Option<f64>>> {
        let modes = undamped(&case.crane.small_motions_at(&case.equilibrium.q))?;
        Ok(modes.iter().take(LOWEST).map(crane_model::modes::Mode::frequency).collect())
    };
    let pairs = frequencies(case)?.into_iter().zip(frequencies(&other)?);
    Ok(Some(pairs.map_while(|(own, other)| Some(mesh.share * (other? / own? - 1.0))).collect()))
}

/// Relative changes of stresses at rest with twice the sections.
pub struct StressChanges {
    /// Of the maximum equivalent stress, which may be elsewhere then.
    pub stress: f64,
    /// Of the maximum utilisation, likewise, if a beam has an allowable stress.
    pub utilisation: Option<f64>,
    /// Of the equivalent stress at each place, and so of its utilisation; `None` where there is none beyond rounding.
    pub places: Vec<Option<f64>>,
}

/// Relative changes of stresses and utilisations at rest with twice the sections; `None` for a crane without stresses.
///
/// # Errors
/// Why they are not computed.
pub fn changes_of_stress(
    case: &Case<'_>,
    rest: &Instant,
    registry: &Registry,
) -> Option<Result<StressChanges, &'static str>> {
    let moduli = case.crane.section_moduli_at();
    let own = rest.stressed_sections(case.crane.description(), &moduli);
    let greatest = |sections: &[StressedSection]| {
        let stress = sections.iter().map(|section| section.stress.equivalent).reduce(f64::max);
        let used = sections.iter().filter_map(|section| section.utilisation).reduce(f64::max);
        (stress, used)
    };
    let (Some(stress), used) = greatest(&own) else { return None };
    if stress <= 0.0 {
        return None;
    }
    Some(OtherMesh::new(case.crane, registry).and_then(|mesh| {
        let other = mesh.case(case)?;
        let description = other.crane.description();
        let finer = Instant::at_rest(other.crane, &other.equilibrium.q);
        let (stress_then, used_then) =
            greatest(&finer.stressed_sections(description, &other.crane.section_moduli_at()));
        let change = |then: f64, now: f64| mesh.share * (then / now - 1.0);
        let carried = carried(case.crane.description(), &own, &finer.places(description), description);
        let at_place = |(section, wrench): (&StressedSection, Option<Wrench>)| {
            let then = stressed(&moduli, Place { wrench: wrench?, ..section.place })?;
            let now = section.stress.equivalent;
            (now > ROUNDING * stress).then(|| change(then.stress.equivalent, now))
        };
        Ok(StressChanges {
            stress: change(stress_then.unwrap_or(f64::NAN), stress),
            utilisation: used.zip(used_then).filter(|(now, _)| *now > 0.0).map(|(now, then)| change(then, now)),
            places: own.iter().zip(carried).map(at_place).collect(),
        })
    }))
}

/// What the beams of another mesh carry at the places of the own one.
fn carried(
    own: &Description,
    sections: &[StressedSection],
    other: &[Place],
    others: &Description,
) -> Vec<Option<Wrench>> {
    let mut before: Option<(&str, f64, usize)> = None;
    let mut slid = 0;
    let wrench = |section: &StressedSection| {
        let (beam, x) = (section.beam(own), section.place.x);
        let of_beam: Vec<&Place> = other.iter().filter(|place| place.beam(others) == beam).collect();
        let tolerance = ONE_PLACE * of_beam.last()?.x;
        // Of several places at one distance, each has a force before it.
        let is_next = |(last, at, _): &(&str, f64, usize)| *last == beam && (x - at).abs() <= tolerance;
        let number = before.filter(is_next).map_or(0, |(.., number)| number + 1);
        if before.is_none_or(|(last, ..)| last != beam) {
            slid = 0;
        }
        before = Some((beam, x, number));
        if section.info(own).slides {
            slid += 1;
            return of_beam.iter().filter(|place| place.info(others).slides).nth(slid - 1).map(|place| place.wrench);
        }
        wrench_at(&of_beam, (x, number), tolerance)
    };
    sections.iter().map(wrench).collect()
}

/// What a beam carries `x` m from its beginning, at the place of this number there; `None` if it has none there, as in the middle of a section: what is
/// carried is given along the axes of an element, which turn from one to the next.
fn wrench_at(places: &[&Place], (x, number): (f64, usize), tolerance: f64) -> Option<Wrench> {
    let here: Vec<&&Place> = places.iter().filter(|place| (place.x - x).abs() <= tolerance).collect();
    here.get(number).or(here.last()).map(|place| place.wrench)
}

/// By how much each point of interest moves with twice the sections, m; `None` for a crane without points or without beams that bend, or without a stable
/// pose.
///
/// # Errors
/// Why it is not computed.
pub fn changes_of_points(case: &Case<'_>, registry: &Registry) -> Option<Result<Vec<f64>, &'static str>> {
    let places = |case: &Case<'_>| case.crane.points_at(&case.equilibrium.q);
    let own = places(case);
    let bends = case.crane.description().coordinates.iter().any(|coordinate| coordinate.role.is_element());
    (bends && !own.is_empty() && case.equilibrium.is_stable()).then(|| {
        let mesh = OtherMesh::new(case.crane, registry)?;
        let other = places(&mesh.case(case)?);
        Ok(own.iter().zip(&other).map(|(own, other)| mesh.share.abs() * (other - own).norm()).collect())
    })
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
    let source = SourceFile::new(crane, text);
    let spec = read(&source).ok()?;
    let change = with(&name(crane, sections), &spec.crane, |_, _| sections as f64)?;
    Some(spec.changed(&change).ok()?.saved().text.clone())
}

/// A crane under another name with other numbers of sections; `None` for a crane without sections.
///
/// The ensemble functions are left out, as a run of one crane does not need them: they take rustc as long as all the rest.
fn with(name: &str, spec: &Crane, mut sections: impl FnMut(&str, f64) -> f64) -> Option<Change> {
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
    let links: Vec<Change> = (spec.links.value.iter().flatten().filter_map(count))
        .map(|(link, sections)| {
            let beam = Change::keys([("sections", sections.into())]);
            Change::keys([("name", link.as_str().into()), ("beam", beam)])
        })
        .collect();
    if links.is_empty() {
        return None;
    }
    let asked = spec.analyses.as_ref().and_then(|given| given.value.as_deref()).unwrap_or_default();
    let kept = asked.iter().filter_map(|analysis| analysis.value).filter(|analysis| *analysis != Analysis::Ensemble);
    let mut changes = vec![("name", name.into()), ("links", Change::list(links))];
    if !asked.is_empty() {
        changes.push(("analyses", Change::list(kept.map(|analysis| analysis.name().into()))));
    }
    Some(Change::keys(changes))
}
