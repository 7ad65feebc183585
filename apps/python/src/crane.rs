//! A spec with parameters and inputs.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crane_codegen::chain::{Frame, Profile, Transmission};
use crane_codegen::compile::check;
use crane_codegen::diagnostic::MAX_BYTES;
use crane_codegen::edit::{BeamEnd, Unbending};
use crane_codegen::exchange::ImportOptions;
use crane_codegen::units::Quantity;
use crane_codegen::{Change, Checked, SourceFile, build, edit, exchange, files};
use crane_live::LiveCrane;
use crane_live::imported::check_import;
use crane_live::rows::BatchEvaluation;
use crane_model::Description;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::runs::Start;
use crane_page::diagram::diagram;
use crane_page::shapes::surfaces::read_surfaces;
use crane_quantities::FunctionId;
use crane_specs::SPECS;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use crate::arrays::{Argument, Joined, array, fixed};
use crate::mistakes::{self, BadRow, Invalid, ParameterError, spec_error, warn, warn_of_rows, warn_of_spec};
use crate::types::{Array, ArrayLike, Dict, Numbers, hints};

/// A crane with its parameters: native part of `crane.Crane`.
#[pyclass(frozen, subclass, module = "crane._native")]
pub struct Crane {
    /// The crane, with the parameters of the first row.
    pub live: LiveCrane,
    /// The spec.
    pub source: SourceFile,
    /// Live parameters of all rows.
    pub parameters: Argument,
    /// Rows whose parameters break a rule.
    pub bad: Vec<BadRow>,
    /// Workspaces for single states, by quantity.
    workspaces: Mutex<HashMap<FunctionId, BatchEvaluation<f64>>>,
}

/// Names of the cranes that come with the package.
#[pyfunction]
pub fn shipped() -> Vec<&'static str> {
    SPECS.iter().map(|(name, _)| *name).collect()
}

/// The spec of a file or of a shipped crane.
fn open(py: Python<'_>, named: &str) -> PyResult<SourceFile> {
    if let Some(text) = crane_specs::spec(named) {
        return Ok(SourceFile::new(format!("{named}.yaml"), text));
    }
    let path = PathBuf::from(named);
    let yaml = path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
    if !yaml && !path.is_file() {
        return Err(PyFileNotFoundError::new_err(format!(
            "there is no crane `{named}` and no such file; cranes: {}; your own spec needs the extension .yaml",
            shipped().join(", ")
        )));
    }
    build::open_with(&path, &crane_specs::spec).map_err(|failure| match failure {
        build::Failure::File(message) if !path.exists() => PyFileNotFoundError::new_err(message),
        failure => not_read(py, failure),
    })
}

/// The spec of a robot in URDF or MJCF, as `crane import` writes it: of a file, with those in MJCF that it includes, or of a text.
#[pyfunction]
#[pyo3(signature = (named, text, fix, repair))]
pub fn import_robot(
    py: Python<'_>,
    named: &str,
    text: Option<&str>,
    fix: Vec<String>,
    repair: bool,
) -> PyResult<String> {
    let source = if let Some(text) = text {
        SourceFile::new(named, text)
    } else {
        let path = PathBuf::from(named);
        let bytes = files::read_file(&path, MAX_BYTES).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => PyFileNotFoundError::new_err(format!("{named}: {error}")),
            _ => PyOSError::new_err(format!("{named}: {error}")),
        })?;
        let source = SourceFile::from_bytes(named, &bytes).map_err(|diagnostics| spec_error(py, &diagnostics))?;
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        exchange::with_includes(source, &mut |file| {
            String::from_utf8(files::read_file(&folder.join(file), MAX_BYTES).ok()?).ok()
        })
    };
    let options = ImportOptions { fixed: fix, repair };
    let imported =
        py.detach(|| exchange::import(&source, &options)).map_err(|diagnostics| spec_error(py, &diagnostics))?;
    py.detach(|| check_import(&imported)).map_err(|deviation| {
        PyRuntimeError::new_err(format!("{named}: the spec does not move as the robot's file says: {deviation}"))
    })?;
    Ok(imported.spec)
}

/// The spec of a text, with those that it extends: shipped ones, or files of the working folder. That of another crane, `Crane.spec`,
/// contains them already.
fn assemble(py: Python<'_>, named: &str, text: &str) -> PyResult<SourceFile> {
    let source = SourceFile::new(named, text);
    if source.is_assembled() {
        return Ok(source);
    }
    build::read_with(named, text.as_bytes(), &crane_specs::spec).map_err(|failure| not_read(py, failure))
}

/// The failure of reading a spec, as an exception.
fn not_read(py: Python<'_>, failure: build::Failure) -> PyErr {
    match failure {
        build::Failure::File(message) => PyOSError::new_err(message),
        build::Failure::Mistakes(mistakes) => spec_error(py, &mistakes),
    }
}

/// A change of a spec: mappings, lists, texts and numbers; `None` removes a key.
fn change(value: &Bound<'_, PyAny>) -> PyResult<Change> {
    if value.is_none() {
        Ok(Change::removed())
    } else if let Ok(flag) = value.cast::<PyBool>() {
        Ok(flag.is_true().into())
    } else if let Ok(text) = value.extract::<String>() {
        Ok(text.as_str().into())
    } else if let Ok(number) = value.extract::<f64>() {
        Ok(number.into())
    } else if let Ok(keys) = value.cast::<PyDict>() {
        Ok(Change::keys(entries(keys)?))
    } else {
        let items = value.try_iter()?.map(|item| change(&item?));
        Ok(Change::list(items.collect::<PyResult<Vec<_>>>()?))
    }
}

/// Keys with what is laid over their values.
fn entries(keys: &Bound<'_, PyDict>) -> PyResult<Vec<(String, Change)>> {
    keys.iter().map(|(key, value)| Ok((key.extract()?, change(&value)?))).collect()
}

#[pymethods]
impl Crane {
    #[new]
    #[pyo3(signature = (named, text=None, parameters=None, invalid="raise", like=None, inputs=None))]
    fn new(
        py: Python<'_>,
        named: &str,
        text: Option<&str>,
        parameters: Option<Dict<'_, hints::ArrayLike>>,
        invalid: &str,
        like: Option<&Bound<'_, Crane>>,
        inputs: Option<Dict<'_, Option<hints::Float>>>,
    ) -> PyResult<Self> {
        let (parameters, inputs) = (parameters.as_deref(), inputs.as_deref());
        let invalid = Invalid::named(invalid)?;
        if let Some(like) = like {
            return like.get().with_others(py, parameters, invalid)?.with_inputs(inputs);
        }
        let source = match text {
            Some(text) => assemble(py, named, text)?,
            None => open(py, named)?,
        };
        // Numbers that are set are checked for plausibility, too; whether they may be set is checked below.
        let number = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let name = name.extract::<String>().ok()?;
            let with_unit = value.extract::<String>().ok().and_then(|text| Some(Quantity::parse(&text)?.ok()?.value));
            let given = || Argument::scalars(&name, &value).ok().filter(|argument| argument.shape.is_empty());
            let number = with_unit.or_else(|| Some(given()?.numbers[0]))?;
            Some((name, number))
        };
        let set: Vec<(String, f64)> = parameters.into_iter().flatten().filter_map(number).collect();
        let set: Vec<(&str, f64)> = set.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let checked = py.detach(|| check(&source)).map_err(|diagnostics| spec_error(py, &diagnostics))?;
        warn_of_spec(py, &checked.warnings_with(&set))?;
        let Checked { mut chain, .. } = checked;
        if text.is_none()
            && let Some(told) = read_surfaces(&mut chain, Path::new(named), files::read_file)
        {
            warn(py, &py.get_type::<mistakes::SpecWarning>(), told)?;
        }
        let count = chain.coordinates.len();
        if count > LiveCrane::MOST_COORDINATES {
            let most = LiveCrane::MOST_COORDINATES;
            return Err(mistakes::SpecError::new_err(format!(
                "{} has {count} coordinates; at most {most} are supported: give flexible links fewer `sections`",
                chain.name
            )));
        }
        Self::with(py, LiveCrane::new(chain), source, parameters, invalid)?.with_inputs(inputs)
    }

    /// Name of the crane.
    #[getter]
    fn name(&self) -> &str {
        &self.live.description().name
    }

    /// One line about it.
    #[getter]
    fn title(&self) -> &str {
        &self.live.description().title
    }

    /// Number of coordinates.
    #[getter]
    fn n(&self) -> usize {
        self.live.size()
    }

    /// Names of the coordinates, in the order of q.
    #[getter]
    fn coordinates(&self) -> Vec<&str> {
        self.live.description().coordinates.iter().map(|coordinate| &*coordinate.name).collect()
    }

    /// Its spec, YAML.
    #[getter]
    fn spec(&self) -> &str {
        &self.source.text
    }

    /// Its spec with changes, keys with what is laid over their values, None to remove them: a spec that `load(text=...)` takes.
    #[pyo3(name = "_changed")]
    fn changed(&self, changes: Dict<'_>) -> PyResult<String> {
        Ok(self.source.changed(&Change::keys(entries(&changes)?).text()).text)
    }

    /// Its spec with a beam in the place of a rigid link, from the link's frame to another one's, or to a point in it; `keys` are those of the beam.
    #[pyo3(name = "_with_beam", signature = (link, to, point, keys))]
    fn with_beam(
        &self,
        py: Python<'_>,
        link: &str,
        to: Option<&str>,
        point: Option<[f64; 3]>,
        keys: Dict<'_>,
    ) -> PyResult<String> {
        let end = match (to, point) {
            (Some(to), _) => BeamEnd::Named(to),
            (None, Some(point)) => BeamEnd::Point(point),
            (None, None) => BeamEnd::Next,
        };
        match edit::with_beam(&self.source, link, end, entries(&keys)?) {
            Ok(changed) => Ok(changed.text),
            Err(Unbending::Mistakes(diagnostics)) => Err(spec_error(py, &diagnostics)),
            Err(Unbending::Refused(why)) => Err(PyValueError::new_err(why)),
        }
    }

    /// Names of the bodies of a link besides its own: of a robot, what its file fixes to the link.
    #[pyo3(name = "_fixed_bodies")]
    fn fixed_bodies(&self, link: &str) -> Vec<String> {
        edit::fixed_bodies(&self.source, link)
    }

    /// Names of the combinations of weights and loads of its spec.
    #[getter]
    fn combinations(&self) -> Vec<&str> {
        self.live.chain().combinations.iter().map(|combination| combination.name.as_str()).collect()
    }

    /// Hash of the spec.
    #[getter]
    fn spec_hash(&self) -> &str {
        &self.live.description().spec_hash
    }

    /// Origin of the spec, as shown in messages.
    #[getter]
    fn source(&self) -> &str {
        &self.source.name
    }

    /// Leading axes of the parameters; empty where all are numbers.
    #[getter]
    fn shape(&self) -> Vec<usize> {
        self.parameters.shape.clone()
    }

    /// Inputs that are set, by name.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Dict<'py, hints::Float>> {
        let all = PyDict::new(py);
        for (index, info) in self.live.description().inputs.iter().enumerate() {
            if let Some(value) = self.live.input(index) {
                all.set_item(&*info.name, value)?;
            }
        }
        Ok(all.into())
    }

    /// Least and greatest values of inputs that are efforts of drives with a `max_effort`, N m or N, by name.
    #[pyo3(name = "_input_bounds")]
    fn input_bounds(&self) -> HashMap<String, (f64, f64)> {
        let chain = self.live.chain();
        let bounds = chain.drives.iter().filter_map(|drive| {
            let Transmission::Flexible { effort: Some(Profile::Input(input, _)), max_effort: Some(most), .. } =
                &drive.transmission
            else {
                return None;
            };
            let most = most.at(self.live.parameters());
            Some((chain.inputs[input.0].name.clone(), (-most, most)))
        });
        bounds.collect()
    }

    /// A diagram of the crane: its bodies and coordinates at the guess, with the present parameters, SVG.
    fn picture(&self) -> String {
        diagram(&self.live)
    }

    /// The crane for other programs: "urdf", "springs" (what URDF cannot express, YAML) or "mjcf", with the present parameters.
    fn export(&self, format: &str) -> PyResult<String> {
        if !self.is_single() {
            return Err(PyValueError::new_err("the parameters are arrays: export a crane with one value of each"));
        }
        let (chain, parameters) = (self.live.chain(), self.live.parameters());
        let refused = |failure: exchange::Inexpressible| PyValueError::new_err(failure.to_string());
        match format {
            "urdf" => exchange::urdf(chain, parameters, &[]).map_err(refused),
            "springs" => Ok(exchange::springs(chain, parameters)),
            "mjcf" => {
                let start = Start::of_or_guess(&self.live);
                exchange::mjcf(chain, parameters, &[], (&start.q, &start.what)).map_err(refused)
            }
            other => Err(PyValueError::new_err(format!("format={other:?}: write \"urdf\", \"springs\" or \"mjcf\""))),
        }
    }

    /// Values of a live parameter, by its index, over the leading axes.
    #[pyo3(name = "_parameter_rows")]
    fn parameter_rows<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let values = self.parameters.numbers.iter().skip(index).step_by(self.parameters.width.max(1)).copied();
        let values: Vec<f64> = values.collect();
        match (values.as_slice(), self.parameters.shape.as_slice()) {
            ([value], []) => Ok(value.into_pyobject(py)?.into_any()),
            _ => Ok(fixed(array(py, values, &self.parameters.shape, &[])?).into_pyobject(py)?.into_any()),
        }
    }

    /// (..., frames, 4, 4): poses of the frames that the spec names, each in the frame of its body, or in the world; m.
    #[pyo3(name = "_frame_poses")]
    fn frame_poses<'py>(&self, py: Python<'py>) -> Array<'py> {
        let chain = self.live.chain();
        let poses = crate::parallel::map_rows(py, self.parameters.rows(), |row, _| {
            let live = self.of_row(row);
            let poses = chain.frames.iter().map(|frame| frame.pose(chain, live.parameters()));
            let entries = poses.flat_map(|Frame { axes: [x, y, z], origin }| {
                let row = move |i: usize| [x[i], y[i], z[i], origin[i]];
                [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat()
            });
            entries.collect::<Vec<f64>>()
        })?;
        array(py, poses.concat(), &self.parameters.shape, &[chain.frames.len(), 4, 4]).map(Numbers::from)
    }

    /// (..., n): coordinates, rates or accelerations, by the names of columns if they have some.
    #[pyo3(name = "_coordinates")]
    fn coordinate_rows<'py>(&self, py: Python<'py>, name: &str, numbers: ArrayLike<'py>) -> Array<'py> {
        let rows = Argument::coordinates(name, &numbers, self.live.description())?;
        array(py, rows.numbers, &rows.shape, &[self.live.size()]).map(Numbers::from)
    }

    /// (..., n): where statics begins, m and rad; NaN for parameters that break a rule.
    #[getter]
    fn guess<'py>(&self, py: Python<'py>) -> Array<'py> {
        let (rows, size) = (self.parameters.rows(), self.live.size());
        let guesses = crate::parallel::map_rows(py, rows, |row, _| {
            if self.bad.iter().any(|bad| bad.row == row) {
                return vec![f64::NAN; size];
            }
            (&*self.of_row(row) as &dyn DynCrane).guess()
        })?;
        array(py, guesses.concat(), &self.parameters.shape, &[size]).map(fixed)
    }
}

impl Crane {
    /// The same crane with some inputs set to numbers, or following the spec again if given as None.
    fn with_inputs(mut self, given: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let Some(given) = given else { return Ok(self) };
        let description = self.live.description();
        let mut values: Vec<Option<f64>> = (0..description.inputs.len()).map(|index| self.live.input(index)).collect();
        for (name, value) in given {
            let name: String = name.extract()?;
            let slot = input_index(description, &name)?;
            values[slot] =
                if value.is_none() { None } else { Some(input(&name, &description.inputs[slot].unit, &value)?) };
        }
        self.live = self.live.with_inputs(&values);
        Ok(self)
    }

    /// The same crane with other parameters; those not named keep their values.
    fn with_others(&self, py: Python<'_>, given: Option<&Bound<'_, PyDict>>, invalid: Invalid) -> PyResult<Self> {
        let all = PyDict::new(py);
        for (index, info) in self.live.description().parameters.iter().enumerate() {
            all.set_item(&*info.name, self.parameter_rows(py, index)?)?;
        }
        if let Some(given) = given {
            all.update(given.as_mapping())?;
        }
        Self::with(py, self.live.clone(), self.source.clone(), Some(&all), invalid)
    }

    /// The crane with parameters by name, numbers or arrays.
    fn with(
        py: Python<'_>,
        mut live: LiveCrane,
        source: SourceFile,
        given: Option<&Bound<'_, PyDict>>,
        invalid: Invalid,
    ) -> PyResult<Self> {
        let description = live.description().clone();
        let mut values: Vec<Argument> = live
            .parameters()
            .iter()
            .map(|value| Argument { shape: Vec::new(), numbers: vec![*value], width: 1 })
            .collect();
        for (name, value) in given.into_iter().flatten() {
            let name: String = name.extract()?;
            let index = parameter_index(&description, &name)?;
            values[index] = Argument::scalars_in(&description.parameters[index].unit, &name, &value)?;
        }
        let names = description.parameters.iter().map(|info| &*info.name);
        let joined = Joined::new(&names.zip(&values).collect::<Vec<_>>())?;
        let rows = joined.rows();
        let of = |values: &[f64], row: usize| values[if values.len() == 1 { 0 } else { row }];
        let numbers: Vec<f64> =
            (0..rows).flat_map(|row| joined.arguments.iter().map(move |values| of(values, row))).collect();
        let width = values.len();
        let check = |row: usize| {
            let refused = live.check(&numbers[row * width..(row + 1) * width]).err()?;
            Some(BadRow { row, reason: refused.to_string() })
        };
        let bad: Vec<BadRow> = if width == 0 { Vec::new() } else { (0..rows).filter_map(check).collect() };
        if let (Some(first), true) = (bad.first(), invalid == Invalid::Raise || joined.shape.is_empty()) {
            return Err(ParameterError::new_err(mistakes::describe(first, &joined.shape)));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        let sound = (0..rows).find(|row| bad.iter().all(|bad| bad.row != *row));
        if let (Some(row), true) = (sound, width > 0) {
            let row = &numbers[row * width..(row + 1) * width];
            live.set_parameters(row).map_err(|refused| ParameterError::new_err(refused.to_string()))?;
        }
        let parameters = Argument { shape: joined.shape.clone(), numbers, width };
        Ok(Self { live, source, parameters, bad, workspaces: Mutex::default() })
    }

    /// The crane of a row of parameters.
    pub fn of_row(&self, row: usize) -> Box<LiveCrane> {
        let mut live = self.live.clone();
        let Argument { width, numbers, .. } = &self.parameters;
        if *width > 0 && self.parameters.rows() > 1 && self.bad.iter().all(|bad| bad.row != row) {
            // Checked when they were given.
            let _ = live.set_parameters(&numbers[row * width..(row + 1) * width]);
        }
        Box::new(live)
    }

    /// Whether all rows have the same parameters.
    pub fn is_single(&self) -> bool {
        self.parameters.shape.is_empty()
    }

    /// Runs `call` with the workspace for a function of one state, kept from the last call.
    pub fn with_workspace<R>(&self, function: FunctionId, call: impl FnOnce(&mut BatchEvaluation<f64>) -> R) -> R {
        let kept = self.workspaces.lock().unwrap_or_else(PoisonError::into_inner).remove(&function);
        let mut evaluation = kept.unwrap_or_else(|| BatchEvaluation::new(&self.live, function));
        let result = call(&mut evaluation);
        self.workspaces.lock().unwrap_or_else(PoisonError::into_inner).insert(function, evaluation);
        result
    }
}

/// Index of an input by its name.
pub fn input_index(description: &Description, name: &str) -> PyResult<usize> {
    let known = || description.inputs.iter().map(|info| &*info.name);
    known().position(|known| known == name).ok_or_else(|| {
        let known: Vec<&str> = known().collect();
        let has = match known.as_slice() {
            [] => "it has none; name them under `inputs:` in its spec".to_owned(),
            _ => format!("inputs: {}", known.join(", ")),
        };
        PyValueError::new_err(format!("{} has no input `{name}`; {has}", description.name))
    })
}

/// The number to which an input is set.
fn input(name: &str, unit: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let argument = Argument::scalars_in(unit, &format!("inputs['{name}']"), value)?;
    match *argument.numbers {
        [value] if argument.shape.is_empty() && value.is_finite() => Ok(value),
        [value] if argument.shape.is_empty() => {
            Err(PyValueError::new_err(format!("inputs['{name}'] is {value}, not a finite number")))
        }
        _ => Err(PyTypeError::new_err(format!(
            "inputs['{name}'] is an array: an input is one number, except in `simulate_ensemble`; parameters may be arrays"
        ))),
    }
}

/// Index of a live parameter by its name.
pub fn parameter_index(description: &Description, name: &str) -> PyResult<usize> {
    let names = || description.parameters.iter().map(|info| &*info.name);
    names().position(|known| known == name).ok_or_else(|| {
        let known: Vec<String> =
            description.parameters.iter().map(|info| format!("{} [{}]", info.name, info.unit)).collect();
        let known = if known.is_empty() {
            "it has none; define some under `parameters:` in its spec".to_owned()
        } else {
            format!("parameters: {}", known.join(", "))
        };
        PyTypeError::new_err(format!("{} has no live parameter `{name}`; {known}", description.name))
    })
}
