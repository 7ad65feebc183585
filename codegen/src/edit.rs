//! Edits of specs: a rigid link of a robot replaced by a beam that bends.

use crate::diagnostic::{Diagnostics, SourceFile};
use crate::read::{Change, read};
use crate::spec::{
    Crane, Either, Link, Number, On, Place, Placement, Spanned, Transform, Turn, Vector, acting, entries,
};

/// A point may be beyond the end of the beam by this fraction of its length, because both are rounded numbers.
const WRITTEN: f64 = 1e-9;

/// Why a link cannot become a beam.
#[derive(Clone, Debug)]
pub enum Unbending {
    /// The spec has mistakes.
    Mistakes(Diagnostics),
    /// What is wrong and what to write instead.
    Refused(String),
}

/// Where the beam of a link is to end.
#[derive(Clone, Copy, Debug)]
pub enum BeamEnd<'a> {
    /// At the frame of the only link that goes on from another place.
    Next,
    /// At the frame of the link of this name, which goes on from it, or at the point of interest or the frame of this name on it.
    Named(&'a str),
    /// At a point in the frame of the link that bends, m: no other link moves with the end.
    Point([f64; 3]),
}

/// Where the beam of a link ends.
struct End<'a> {
    /// The link that goes on from there, if any, with its name.
    next: Option<(&'a str, &'a Link)>,
    /// In the frame of the link, m.
    at: [f64; 3],
}

/// The spec of a crane in which a beam takes the place of the mass and the inertia of a rigid link: from its frame to `to`. The
/// joint of the link stays; the beam is a link of its own, `<link>_beam`, whose x leads there. `keys` are those of
/// [`Beam`](crate::spec::Beam) besides `length`.
///
/// # Errors
/// The spec has mistakes, or the link cannot become a beam.
pub fn with_beam(
    source: &SourceFile,
    link: &str,
    to: BeamEnd<'_>,
    keys: impl IntoIterator<Item = (String, Change)>,
) -> Result<SourceFile, Unbending> {
    let crane = read(source).map_err(Unbending::Mistakes)?.crane;
    let change = change(&crane, link, to, keys.into_iter().collect()).map_err(Unbending::Refused)?;
    Ok(source.changed(&change.text()))
}

/// Names of the bodies of a link besides its own: of an imported robot, what its file fixes to the link.
#[must_use]
pub fn fixed_bodies(source: &SourceFile, link: &str) -> Vec<String> {
    let Ok(document) = read(source) else { return Vec::new() };
    let found = entries(Some(&document.crane.links)).find(|own| name_of(own) == Some(link));
    let bodies = found.and_then(|link| link.bodies.as_ref());
    let names = entries(bodies).filter_map(|body| body.name.value.clone());
    names.filter(|name| name != link).collect()
}

fn change(crane: &Crane, name: &str, to: BeamEnd<'_>, keys: Vec<(String, Change)>) -> Result<Change, String> {
    let links: Vec<(&str, &Link)> =
        entries(Some(&crane.links)).filter_map(|link| Some((name_of(link)?, link))).collect();
    let Some(index) = links.iter().position(|(other, _)| *other == name) else {
        let known: Vec<&str> = links.iter().map(|(name, _)| *name).collect();
        return Err(format!("there is no link `{name}`; the links are {}", known.join(", ")));
    };
    let link = links[index].1;
    if link.beam.is_some() || link.rope.is_some() {
        return Err(format!("`{name}` bends already: change its keys in the spec"));
    }
    if let Some(what) = attached(crane, name) {
        return Err(format!(
            "{what} is on `{name}`, and would not bend with it: write the beam in the spec, and move what is on it there"
        ));
    }
    let beyond: Vec<(&str, &Link)> =
        links.iter().enumerate().filter(|(at, _)| carrier(&links, *at) == Some(name)).map(|(_, link)| *link).collect();
    let end = end(crane, &beyond, name, to)?;
    let [x, y, z] = end.at;
    let length = (x * x + y * y + z * z).sqrt();
    if length == 0.0 || !length.is_finite() {
        return Err(format!("a beam from the frame of `{name}` to [{x}, {y}, {z}] has no length"));
    }
    // x of the beam is Rz(ψ) Ry(θ) x.
    let (psi, theta) = (y.atan2(x), (-z).atan2(x.hypot(y)));
    let beam = &*format!("{name}_beam");
    if links.iter().any(|(other, _)| *other == beam) {
        return Err(format!("there is a link `{beam}` already"));
    }
    let replaced = [
        ("mass", link.mass.is_some()),
        ("com", link.com.is_some()),
        ("inertia", link.inertia.is_some()),
        ("bodies", link.bodies.is_some()),
    ];
    let gone = replaced.into_iter().filter(|(_, given)| *given).map(|(key, _)| (key, Change::removed()));
    let mut changed = vec![Change::keys([("name", name.into())].into_iter().chain(gone))];
    let placed = |transform| ("placement", Change::keys([("transform", Change::keys::<&str>(transform))]));
    let turned = Change::list([turn("z", psi), turn("y", theta)]);
    let along = ("length".to_owned(), length.into());
    changed.push(Change::keys([
        ("name", beam.into()),
        ("after", name.into()),
        ("on", name.into()),
        placed(vec![("rotation", turned)]),
        ("beam", Change::keys([along].into_iter().chain(keys))),
    ]));
    for (other, of) in &beyond {
        // What does not go on from the end of the beam stays on the frame of the link, which does not bend.
        let Some((_, next)) = end.next.filter(|(next, _)| next == other) else {
            if of.on.is_none() {
                changed.push(Change::keys([("name", (*other).into()), ("on", name.into())]));
            }
            continue;
        };
        let given = transform(next);
        let moved = given.and_then(|given| given.translation.as_ref()).map(|_| ("translation", Change::removed()));
        let rotation = ("rotation", rotations_in_beam(given, other, psi, theta)?);
        changed.push(Change::keys([
            ("name", (*other).into()),
            ("on", beam.into()),
            placed(moved.into_iter().chain([rotation]).collect()),
        ]));
    }
    let on_link =
        |link: &Option<Spanned<String>>| link.as_ref().is_some_and(|link| link.value.as_deref() == Some(name));
    let on_beam = |x: &f64| (0.0..=length * (1.0 + WRITTEN)).contains(x);
    let (mut points, mut frames) = (Vec::new(), Vec::new());
    for point in entries(crane.points.as_ref()).filter(|point| on_link(&point.link)) {
        let Some(at) = numbers_or_zero(point.at.as_ref()) else { continue };
        let at = in_beam(at, psi, theta);
        if let Some(point) = point.name.value.as_deref().filter(|_| on_beam(&at[0])) {
            points.push(Change::keys([("name", point.into()), ("link", beam.into()), ("at", vector(at))]));
        }
    }
    for frame in entries(crane.frames.as_ref()).filter(|frame| on_link(&frame.link)) {
        let given = frame.transform.as_ref().and_then(|transform| transform.value.as_ref());
        let Some(at) = numbers_or_zero(given.and_then(|given| given.translation.as_ref())) else { continue };
        let at = in_beam(at, psi, theta);
        let Some(frame) = frame.name.value.as_deref().filter(|_| on_beam(&at[0])) else { continue };
        let turned = ("rotation", rotations_in_beam(given, frame, psi, theta)?);
        let transform = Change::keys([("translation", vector(at)), turned]);
        frames.push(Change::keys([("name", frame.into()), ("link", beam.into()), ("transform", transform)]));
    }
    let lists = [("links", changed), ("points", points), ("frames", frames)].into_iter();
    Ok(Change::keys(lists.filter(|(_, list)| !list.is_empty()).map(|(key, list)| (key, Change::list(list)))))
}

/// A rotation about an axis, rad.
fn turn(axis: &str, angle: f64) -> Change {
    Change::keys([(axis, angle.into())])
}

fn vector(components: [f64; 3]) -> Change {
    Change::list(components.map(Change::from))
}

/// The components of a vector along the axes of the beam.
fn in_beam([x, y, z]: [f64; 3], psi: f64, theta: f64) -> [f64; 3] {
    let (along, across) = (psi.cos() * x + psi.sin() * y, psi.cos() * y - psi.sin() * x);
    [theta.cos() * along - theta.sin() * z, across, theta.sin() * along + theta.cos() * z]
}

/// The rotations of a transformation of the link, from the axes of the beam.
fn rotations_in_beam(given: Option<&Transform>, name: &str, psi: f64, theta: f64) -> Result<Change, String> {
    let own = turns(given, name)?.into_iter();
    Ok(Change::list([("y", -theta), ("z", -psi)].into_iter().chain(own).map(|(axis, angle)| turn(axis, angle))))
}

/// The place of a point of interest on a link, or of one of its frames, m.
fn point_on(crane: &Crane, link: &str, name: &str) -> Option<[f64; 3]> {
    let is = |word: &Spanned<String>, given: &Option<Spanned<String>>| {
        word.value.as_deref() == Some(name) && given.as_ref().is_some_and(|on| on.value.as_deref() == Some(link))
    };
    if let Some(point) = entries(crane.points.as_ref()).find(|point| is(&point.name, &point.link)) {
        return numbers_or_zero(point.at.as_ref());
    }
    let frame = entries(crane.frames.as_ref()).find(|frame| is(&frame.name, &frame.link))?;
    let given = frame.transform.as_ref().and_then(|transform| transform.value.as_ref());
    numbers_or_zero(given.and_then(|given| given.translation.as_ref()))
}

/// Where the beam ends.
fn end<'a>(crane: &Crane, beyond: &[(&'a str, &'a Link)], name: &str, to: BeamEnd<'_>) -> Result<End<'a>, String> {
    let names = |links: &[(&str, &Link)]| links.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let next = match to {
        BeamEnd::Point(at) => return Ok(End { next: None, at }),
        BeamEnd::Named(to) => match (beyond.iter().find(|(other, _)| *other == to), point_on(crane, name, to)) {
            (Some(link), _) => *link,
            (None, Some(at)) => return Ok(End { next: None, at }),
            (None, None) => {
                let known = if beyond.is_empty() { "nothing".to_owned() } else { names(beyond) };
                return Err(format!(
                    "`{to}` is neither a link that goes on from `{name}` ({known}) nor a point of interest or a frame on it"
                ));
            }
        },
        BeamEnd::Next => {
            let away = |link: &Link| placed_at(link).is_ok_and(|at| at.iter().any(|x| *x != 0.0));
            let away: Vec<_> = beyond.iter().copied().filter(|(_, link)| away(link)).collect();
            match away[..] {
                [one] => one,
                [] => {
                    return Err(format!(
                        "no link goes on from `{name}` at another place than its own frame: give the point `to` which the beam leads"
                    ));
                }
                _ => {
                    return Err(format!(
                        "several links go on from `{name}`: the beam leads `to` one of {}",
                        names(&away)
                    ));
                }
            }
        }
    };
    Ok(End { next: Some(next), at: placed_at(next.1)? })
}

/// Where a link begins in the frame of the rigid link that carries it, m.
fn placed_at(link: &Link) -> Result<[f64; 3], String> {
    let name = name_of(link).unwrap_or_default();
    let unread = || format!("the place of `{name}` is not given by numbers: write the beam in the spec");
    let on = match link.on.as_ref().and_then(|on| on.value.as_ref()) {
        Some(Either::Full(On { at: Some(Spanned { value: Some(Place::Point(_)), .. }), .. })) => return Err(unread()),
        _ => [0.0; 3],
    };
    match link.placement.as_ref().map(|placement| &placement.value) {
        None => Ok(on),
        Some(Some(Placement::Transform(given))) => match &given.translation {
            None => Ok(on),
            Some(given) => given.value.as_ref().and_then(numbers).ok_or_else(unread),
        },
        _ => Err(format!(
            "`{name}` is placed by a row of Denavit and Hartenberg: write its `placement` as a `transform`"
        )),
    }
}

fn transform(link: &Link) -> Option<&Transform> {
    match link.placement.as_ref()?.value.as_ref()? {
        Placement::Transform(transform) => Some(transform),
        _ => None,
    }
}

/// The rotations of a transformation of what has this name: axis and angle, rad.
fn turns(given: Option<&Transform>, name: &str) -> Result<Vec<(&'static str, f64)>, String> {
    let given = given.and_then(|transform| transform.rotation.as_ref()?.value.as_ref());
    let turns = given.map_or(&[][..], |given| &given.0);
    let turn = |turn: &Spanned<Turn>| {
        let (axis, angle) = match turn.value.as_ref()? {
            Turn::X(angle) => ("x", angle),
            Turn::Y(angle) => ("y", angle),
            Turn::Z(angle) => ("z", angle),
        };
        Some((axis, angle.value.as_ref()?.0.number()?))
    };
    let all: Option<Vec<_>> = turns.iter().map(turn).collect();
    all.ok_or_else(|| format!("the rotation of `{name}` is not given by numbers"))
}

/// What acts on a link besides other links: it would have to move to the beam.
fn attached(crane: &Crane, name: &str) -> Option<String> {
    let acting = acting(crane).into_iter().find(|acting| acting.link.value.as_deref() == Some(name))?;
    Some(format!("{} `{}`", acting.kind, acting.name.value.as_deref().unwrap_or_default()))
}

/// The name of the link that carries the one at this index.
fn carrier<'a>(links: &[(&'a str, &'a Link)], index: usize) -> Option<&'a str> {
    let link = links[index].1;
    link.named_on().or_else(|| link.on.is_none().then_some(links[index.checked_sub(1)?].0))
}

fn name_of(link: &Link) -> Option<&str> {
    link.name.value.as_deref()
}

fn numbers_or_zero(given: Option<&Spanned<Vector>>) -> Option<[f64; 3]> {
    given.map_or(Some([0.0; 3]), |given| numbers(given.value.as_ref()?))
}

fn numbers(vector: &Vector) -> Option<[f64; 3]> {
    let [x, y, z] =
        vector.each_ref().map(|Spanned { value, .. }| value.as_ref().and_then(|Number(number, _)| number.number()));
    Some([x?, y?, z?])
}
