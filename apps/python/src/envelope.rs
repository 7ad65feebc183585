//! Envelopes: the largest loads within limits, over positions of drives and live parameters.

use std::sync::{Mutex, PoisonError};

use crane_live::Reach;
use crane_model::Description;
use crane_model::dyn_crane::DynCrane;
use crane_model::envelope::{
    Axes, Axis, Condition, Coverage, Envelope, Execution, Limit, Limits, PartLimit, Rating, Varied, is_load, only_mass,
    range_of_loads,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::crane::Crane;
use crate::parallel::{Watch, threads};
use crate::types::{Dict, Keys, Progress};

/// Maximum number of poses: some hours of computing.
const MOST_POSES: usize = 10_000_000;
/// Largest position of a drive, m or rad: a pose is approached in strides.
const FURTHEST: f64 = 1000.0;

/// The request, as given.
#[derive(FromPyObject)]
pub struct ChartRequest {
    #[pyo3(item)]
    ranges: Vec<(String, Vec<f64>)>,
    #[pyo3(item)]
    load: Option<String>,
    #[pyo3(item)]
    greatest_load: Option<f64>,
    #[pyo3(item)]
    tipping: Option<f64>,
    #[pyo3(item)]
    utilisation: Option<f64>,
    #[pyo3(item)]
    efforts: Vec<(String, f64)>,
    #[pyo3(item)]
    deflections: Vec<(String, f64)>,
    #[pyo3(item)]
    without: Vec<String>,
    #[pyo3(item)]
    lift_off: bool,
    #[pyo3(item)]
    slack_ropes: bool,
    #[pyo3(item)]
    load_factor: f64,
    #[pyo3(item)]
    point: Option<String>,
}

#[pymethods]
impl Crane {
    /// Largest loads over the axes: `Crane.envelope` makes an `Envelope` of them.
    #[pyo3(name = "_envelope", signature = (asked, progress=None))]
    fn run_envelope<'py>(
        &self,
        py: Python<'py>,
        asked: Keys<ChartRequest>,
        progress: Option<Progress>,
    ) -> PyResult<Dict<'py>> {
        if !self.is_single() {
            return Err(PyValueError::new_err("the parameters are arrays: name them in `ranges` instead"));
        }
        let crane: &dyn DynCrane = &self.live;
        let description = crane.description();
        let point = asked.point.as_deref().map(|name| index_of(name, "point", &points(description))).transpose()?;
        let envelope = asked.envelope(crane)?;
        let reach = Reach::new(self.live.chain(), self.live.parameters(), Some(envelope.load), point);
        let poses = envelope.axes.poses();
        let ratings: Mutex<Vec<Option<Rating>>> = Mutex::new(vec![None; poses]);
        let watch = Watch::reporting(progress, poses);
        let caller = std::thread::current().id();
        let run = py.detach(|| {
            let done = |piece: usize, rated: &[Rating]| {
                let mut ratings = ratings.lock().unwrap_or_else(PoisonError::into_inner);
                for (pose, rating) in envelope.poses_of(piece).zip(rated) {
                    ratings[pose] = Some(rating.clone());
                    watch.count();
                }
            };
            let cancelled = || if std::thread::current().id() == caller { watch.look() } else { watch.is_off() };
            let pieces: Vec<usize> = (0..envelope.pieces()).collect();
            envelope.run(crane, &pieces, &Execution { threads: threads(), done: &done, cancelled: &cancelled })
        });
        watch.finish(py)?;
        run.map_err(|refused| PyValueError::new_err(refused.to_string()))?;
        let ratings = ratings.into_inner().unwrap_or_else(PoisonError::into_inner);
        let ratings: Vec<Rating> = ratings.into_iter().flatten().collect();
        let all = Named { crane, reach, shape: axes_shape(&envelope) }.all(py, &envelope, &ratings)?;
        let coverage = Coverage::new(crane, &envelope.limits, self.live.gravity());
        all.set_item("considered", coverage.considered)?;
        all.set_item("not_considered", coverage.not_considered)?;
        Ok(all.into())
    }
}

impl ChartRequest {
    fn envelope(&self, crane: &dyn DynCrane) -> PyResult<Envelope> {
        let description = crane.description();
        let mut axes: Vec<Axis> = Vec::new();
        for (name, values) in &self.ranges {
            let varied = Varied::named(name, description).ok_or_else(|| {
                let known =
                    drives(description).into_iter().chain(parameters(description)).collect::<Vec<_>>().join(", ");
                PyValueError::new_err(format!(
                    "{} has no drive and no live parameter `{name}`; drives and parameters: {known}",
                    description.name
                ))
            })?;
            if axes.iter().any(|axis| axis.varied == varied) {
                return Err(PyValueError::new_err(format!("ranges: `{name}` is given twice")));
            }
            let axis = Axis { varied, values: values.clone() };
            check_axis(&axis, &format!("ranges['{name}']"), description)?;
            axes.push(axis);
        }
        let axes = Axes(axes);
        if axes.0.is_empty() || axes.poses() > MOST_POSES {
            return Err(PyValueError::new_err(format!("ranges: give from 1 to {MOST_POSES} poses")));
        }
        let load = match &self.load {
            Some(name) => {
                let load = index_of(name, "live parameter", &parameters(description))?;
                let unit = &description.parameters[load].unit;
                if !is_load(&description.parameters[load]) {
                    return Err(PyValueError::new_err(format!("`{name}` is in {unit}: it is not a load")));
                }
                load
            }
            None => only_mass(description).ok_or_else(|| {
                let name = &description.name;
                PyValueError::new_err(format!(
                    "{name} does not have exactly one live parameter in kg to vary as the load: name it with `load`"
                ))
            })?,
        };
        if axes.0.iter().any(|axis| axis.varied == Varied::Parameter(load)) {
            let name = &description.parameters[load].name;
            return Err(PyValueError::new_err(format!("{name} is the load, which is found for each pose")));
        }
        if let Some(greatest) = self.greatest_load.filter(|greatest| !greatest.is_finite()) {
            return Err(PyValueError::new_err(format!("greatest_load={greatest}: write a finite number")));
        }
        let loads = range_of_loads(crane, load, self.greatest_load);
        if loads[1] <= loads[0] {
            let [least, greatest] = loads;
            return Err(PyValueError::new_err(format!("greatest_load={greatest}: write a number above {least}")));
        }
        for (name, value, range, is_allowed) in [
            ("tipping", self.tipping, "from 0 to below 1", (|margin| (0.0..1.0).contains(&margin)) as fn(f64) -> bool),
            ("utilisation", self.utilisation, "above 0", |part| part > 0.0 && part.is_finite()),
            ("load_factor", Some(self.load_factor), "above 0", |factor| factor > 0.0 && factor.is_finite()),
        ] {
            if let Some(wrong) = value.filter(|value| !is_allowed(*value)) {
                return Err(PyValueError::new_err(format!("{name}={wrong}: write a number {range}")));
            }
        }
        let mut of_parts = PartLimit::DEFAULT.to_vec();
        for name in &self.without {
            let known = PartLimit::DEFAULT.map(PartLimit::name);
            let kind = PartLimit::named(name).filter(|_| known.contains(&name.as_str())).ok_or_else(|| {
                PyValueError::new_err(format!(
                    "without: there is no limit `{name}` to leave out; limits: {}",
                    known.join(", ")
                ))
            })?;
            of_parts.retain(|left_out| *left_out != kind);
        }
        of_parts.extend(self.lift_off.then_some(PartLimit::LiftOff));
        of_parts.extend(self.slack_ropes.then_some(PartLimit::SlackRopes));
        let limits = Limits {
            tipping: self.tipping,
            utilisation: self.utilisation,
            of_parts,
            efforts: limits(&self.efforts, "drive", &drives(description))?,
            deflections: limits(&self.deflections, "point", &points(description))?,
        };
        Ok(Envelope { axes, load, loads, limits, factor: self.load_factor })
    }
}

/// Ratings as arrays.
struct Named<'a> {
    crane: &'a dyn DynCrane,
    reach: Reach,
    shape: Vec<usize>,
}

impl Named<'_> {
    fn all<'py>(&self, py: Python<'py>, envelope: &Envelope, ratings: &[Rating]) -> PyResult<Bound<'py, PyDict>> {
        let (all, description) = (PyDict::new(py), self.crane.description());
        let numbers = |of: &dyn Fn(&Rating) -> Option<f64>| {
            array(py, ratings.iter().map(|rating| of(rating).unwrap_or(f64::NAN)).collect(), &self.shape, &[])
        };
        let place = |(pose, rating): (usize, &Rating)| {
            let parameters = envelope.axes.parameters(self.crane, pose);
            rating.loaded.as_ref().map_or([f64::NAN; 2], |at| self.reach.radius_and_height(&at.q, &parameters))
        };
        let places: Vec<[f64; 2]> = ratings.iter().enumerate().map(place).collect();
        for (key, index) in [("radius", 0), ("height", 1)] {
            all.set_item(key, array(py, places.iter().map(|place| place[index]).collect(), &self.shape, &[])?)?;
        }
        all.set_item("point", self.reach.point())?;
        all.set_item("radius_from", self.reach.axis())?;
        all.set_item("load", numbers(&|rating| rating.load)?)?;
        all.set_item("tipping_margin", numbers(&|rating| rating.with_spec_load.as_ref()?.margin())?)?;
        all.set_item("utilisation", numbers(&|rating| rating.with_spec_load.as_ref()?.utilisation())?)?;
        let n = description.coordinates.len();
        let rows = |width: usize, of: &dyn Fn(&Rating) -> Option<Vec<f64>>| {
            let row = |rating: &Rating| of(rating).unwrap_or_else(|| vec![f64::NAN; width]);
            array(py, ratings.iter().flat_map(row).collect(), &self.shape, &[width])
        };
        all.set_item("q", rows(n, &|rating| Some(rating.loaded.as_ref()?.q.clone()))?)?;
        let of_load =
            |of: fn(&Condition) -> &Vec<f64>| move |rating: &Rating| Some(of(rating.with_spec_load.as_ref()?).clone());
        all.set_item("drive_efforts", rows(description.drives.len(), &of_load(|of_load| &of_load.efforts))?)?;
        let moved = |rating: &Rating| (!rating.deflections.is_empty()).then(|| rating.deflections.clone());
        all.set_item("deflections", rows(description.points.len(), &moved)?)?;
        let words = |of: &dyn Fn(Limit) -> String| -> Vec<String> {
            ratings.iter().map(|rating| rating.governing.map_or_else(String::new, of)).collect()
        };
        all.set_item("governing", words(&|limit| limit.kind().to_owned()))?;
        all.set_item("governing_of", words(&|limit| limit.location(self.crane)))?;
        all.set_item("shape", self.shape.clone())?;
        all.set_item("unit", description.parameters[envelope.load].unit.as_str())?;
        all.set_item("parameter", description.parameters[envelope.load].name.as_str())?;
        Ok(all)
    }
}

fn axes_shape(envelope: &Envelope) -> Vec<usize> {
    envelope.axes.0.iter().map(|axis| axis.values.len()).collect()
}

/// Whether the values of an axis, or positions at which a drive is held, are finite and plausible; `text`: what they were given as.
pub fn check_axis(axis: &Axis, text: &str, description: &Description) -> PyResult<()> {
    let wrong = |told: String| Err(PyValueError::new_err(format!("{text}{told}")));
    if axis.values.is_empty() || axis.values.iter().any(|value| !value.is_finite()) {
        return wrong(": write one or more finite numbers".to_owned());
    }
    let far = axis.values.iter().find(|value| matches!(axis.varied, Varied::Drive(_)) && value.abs() > FURTHEST);
    if let Some(far) = far {
        return wrong(format!(": {far:e} is beyond ±{FURTHEST}, in m or rad, where no crane reaches"));
    }
    if let Some(angle) = axis.implausible_angle(description) {
        let degrees = angle.to_degrees();
        return wrong(format!(" goes to {angle} rad, {degrees:.0}°: angles are in rad, as in np.radians({angle})"));
    }
    Ok(())
}

/// Names of the coordinates that have a drive.
pub fn drives(description: &Description) -> Vec<&str> {
    description.drives.iter().map(|drive| &*description.coordinates[drive.coordinate].name).collect()
}

fn points(description: &Description) -> Vec<&str> {
    description.points.iter().map(|point| &**point).collect()
}

fn parameters(description: &Description) -> Vec<&str> {
    description.parameters.iter().map(|parameter| &*parameter.name).collect()
}

/// Index of a name.
fn index_of(name: &str, what: &str, names: &[&str]) -> PyResult<usize> {
    names
        .iter()
        .position(|known| *known == name)
        .ok_or_else(|| PyValueError::new_err(format!("there is no {what} `{name}`; {what}s: {}", names.join(", "))))
}

/// Limits by name, infinite where none is given.
fn limits(given: &[(String, f64)], what: &str, names: &[&str]) -> PyResult<Vec<f64>> {
    let mut limits = vec![f64::INFINITY; names.len()];
    for (name, limit) in given {
        let index = index_of(name, what, names)?;
        if limit.is_nan() || *limit <= 0.0 {
            return Err(PyValueError::new_err(format!(
                "the limit of `{name}` is {limit}: write a number above 0, in SI units"
            )));
        }
        limits[index] = *limit;
    }
    Ok(limits)
}
