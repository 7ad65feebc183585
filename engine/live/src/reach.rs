//! How far out and how high a load is: the point that is shown, and the axis from which its radius is measured.

use crane_codegen::chain::{BodyId, Chain, CoordinateId, CoordinateKind, Value, Vector};
use crane_model::nalgebra::Vector3;

/// The point of a crane whose radius, height and deflection are shown, and the axis from which the radius is measured.
///
/// The point is the one that is asked for; otherwise the only point of interest on what carries the load or beyond it, or else the centre of mass of the
/// load, or where its force acts. Without a load it is the only point of interest, or else the origin of the last link.
///
/// The axis is that of the first drive which turns the point about a vertical axis at the guess, moved along by the drives before it. The last of
/// several drives is a rotator, about whose axis no load has a radius. Without such a drive it is the vertical through the world's origin.
#[derive(Clone, Debug)]
pub struct Reach {
    chain: Chain,
    shown: Shown,
    point: String,
    slew: Option<Slew>,
}

/// What is shown.
#[derive(Clone, Copy, Debug)]
enum Shown {
    /// A point of interest, by its index.
    Point(usize),
    /// The load that a live parameter is, by its index.
    Load(usize),
    /// The origin of the last link.
    End,
}

/// What slews a crane.
#[derive(Clone, Debug)]
struct Slew {
    /// Index of the drive.
    drive: usize,
    coordinate: CoordinateId,
    /// The coordinates of the drives before it.
    before: Vec<CoordinateId>,
}

/// A part of a load.
struct Lump {
    body: BodyId,
    /// Its share of the load: kg, N, or what else the load is counted in.
    weight: f64,
    /// Its centre in the frame of the body, m.
    at: Vector,
    /// What it is of: a body or a force.
    name: String,
}

impl Reach {
    /// Of a crane with these values of its live parameters. `load`: the parameter that is the load; `point`: the point of interest that is asked for.
    ///
    /// # Panics
    /// If `parameters` is shorter than the chain's list of parameters, or an index is beyond its list.
    #[must_use]
    pub fn new(chain: &Chain, parameters: &[f64], load: Option<usize>, point: Option<usize>) -> Self {
        let lumps = load.map_or_else(Vec::new, |load| lumps(chain, parameters, load));
        let is_on_load = |&point: &usize| lumps.iter().any(|lump| chain.is_beyond(chain.points[point].body, lump.body));
        let on_load: Vec<usize> = (0..chain.points.len()).filter(is_on_load).collect();
        let shown = match (point, load, &on_load[..]) {
            (Some(point), ..) | (None, _, &[point]) => Shown::Point(point),
            (None, Some(load), _) if !lumps.is_empty() => Shown::Load(load),
            _ if chain.points.len() == 1 => Shown::Point(0),
            _ => Shown::End,
        };
        let last = BodyId(chain.bodies.len().saturating_sub(1));
        let (point, body) = match shown {
            Shown::Point(point) => (chain.points[point].name.clone(), chain.points[point].body),
            Shown::Load(_) => {
                let mut names: Vec<&str> = lumps.iter().map(|lump| lump.name.as_str()).collect();
                names.dedup();
                let is_force = chain.loads.iter().any(|force| names.contains(&force.name.as_str()));
                let what = if is_force { "the place of" } else { "the centre of mass of" };
                (format!("{what} {}", names.join(" and ")), lumps.first().map_or(last, |lump| lump.body))
            }
            Shown::End => (format!("the origin of {}", chain.bodies[last.0].link), last),
        };
        Self { chain: chain.clone(), shown, point, slew: slew(chain, parameters, body) }
    }

    /// The point in words, such as `hook` or `the centre of mass of log`.
    #[must_use]
    pub fn point(&self) -> &str {
        &self.point
    }

    /// The axis in words, such as `the axis of column_psi`.
    #[must_use]
    pub fn axis(&self) -> String {
        self.slew.as_ref().map_or_else(
            || "the world's origin".to_owned(),
            |slew| format!("the axis of {}", self.chain.coordinates[slew.coordinate.0].name),
        )
    }

    /// Both in words, such as `radius of hook from the axis of column_psi`.
    #[must_use]
    pub fn words(&self) -> String {
        format!("radius of {} from {}", self.point, self.axis())
    }

    /// Index of the drive that slews the crane about the axis; `None` if no drive does.
    #[must_use]
    pub fn slewing(&self) -> Option<usize> {
        self.slew.as_ref().map(|slew| slew.drive)
    }

    /// Where the point is in the world at a pose, m.
    ///
    /// # Panics
    /// If `q` or `parameters` are shorter than the chain's lists of them.
    #[must_use]
    pub fn position(&self, q: &[f64], parameters: &[f64]) -> Vector3<f64> {
        let frames = self.chain.frames(q, parameters);
        match self.shown {
            Shown::Point(point) => {
                let point = &self.chain.points[point];
                let local = point.position.each_ref().map(|value| value.at(parameters));
                frames[point.body.0].transform_point(local).into()
            }
            Shown::Load(load) => {
                let (mut sum, mut weight) = (Vector3::zeros(), 0.0);
                for lump in lumps(&self.chain, parameters, load) {
                    sum += lump.weight * Vector3::from(frames[lump.body.0].transform_point(lump.at));
                    weight += lump.weight;
                }
                sum / weight
            }
            Shown::End => frames.last().map_or_else(Vector3::zeros, |last| last.origin.into()),
        }
    }

    /// Horizontal distance of the point from the axis at a pose, and its height above the world's origin, m.
    ///
    /// # Panics
    /// If `q` or `parameters` are shorter than the chain's lists of them.
    #[must_use]
    pub fn radius_and_height(&self, q: &[f64], parameters: &[f64]) -> [f64; 2] {
        let place = self.position(q, parameters);
        let [x, y] = self.slew.as_ref().map_or([0.0; 2], |slew| {
            let mut at = self.chain.guess_at(parameters);
            for CoordinateId(before) in &slew.before {
                at[*before] = q[*before];
            }
            let [[x, y, _], _] = self.chain.axis(slew.coordinate, &at, parameters);
            [x, y]
        });
        [(place.x - x).hypot(place.y - y), place.z]
    }
}

/// The drive that slews a body.
fn slew(chain: &Chain, parameters: &[f64], body: BodyId) -> Option<Slew> {
    /// Cosine of the tilt up to which an axis counts as vertical, some 8°.
    const VERTICAL: f64 = 0.99;
    let guess = chain.guess_at(parameters);
    let drives = chain.drives.iter().enumerate().map(|(drive, info)| (info.coordinate, drive));
    let mut drives: Vec<(CoordinateId, usize)> =
        drives.filter(|(coordinate, _)| chain.moves(*coordinate, body)).collect();
    drives.sort_unstable();
    let is_vertical = |&(coordinate, _): &(CoordinateId, usize)| {
        let [_, [_, _, z]] = chain.axis(coordinate, &guess, parameters);
        chain.coordinates[coordinate.0].kind == CoordinateKind::Rotation && z.abs() >= VERTICAL
    };
    let first = drives.iter().position(is_vertical).filter(|first| *first == 0 || first + 1 < drives.len())?;
    let (coordinate, drive) = drives[first];
    Some(Slew { drive, coordinate, before: drives[..first].iter().map(|(coordinate, _)| *coordinate).collect() })
}

/// What becomes heavier with a live parameter; the forces that grow with it if nothing does.
fn lumps(chain: &Chain, parameters: &[f64], load: usize) -> Vec<Lump> {
    let mut more = parameters.to_vec();
    more[load] += more[load].abs().max(1.0);
    let masses = chain.bodies.iter().enumerate().filter_map(|(index, body)| {
        let inertia = body.inertia.as_ref()?;
        let growth = |value: &Value| value.at(&more) - value.at(parameters);
        let weight = growth(&inertia.mass);
        let name = body.parts.iter().find(|part| growth(&part.mass) > 0.0).map_or(&body.link, |part| &part.name);
        let at = inertia.first.each_ref().map(|moment| growth(moment) / weight);
        (weight > 0.0).then(|| Lump { body: BodyId(index), weight, at, name: name.clone() })
    });
    let masses: Vec<Lump> = masses.collect();
    if !masses.is_empty() {
        return masses;
    }
    let forces = chain.loads.iter().filter_map(|force| {
        let growth = force.force.each_ref().map(|value| value.at(&more) - value.at(parameters));
        let weight = Vector3::from(growth).norm();
        let at = force.position.each_ref().map(|value| value.at(parameters));
        (weight > 0.0).then(|| Lump { body: force.body, weight, at, name: force.name.clone() })
    });
    forces.collect()
}
