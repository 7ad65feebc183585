//! The cranes that the command can choose from, with parameters set.

use std::{
    borrow::Cow,
    path::Path,
    sync::{Arc, OnceLock},
};

use crane_codegen::{Change, Checked, Diagnostics, SourceFile, chain::Chain, check, compile, read};
use crane_live::LiveCrane;
use crane_model::{Description, InputInfo, ParameterError, ParameterInfo, Refusal, dyn_crane::DynCrane};

use crate::{
    arguments::{Choice, Parameters, STANDARD_INPUT},
    problem::{Outcome, Problem, hint, meant, nearest},
    quantity::number,
    screen::Console,
    spec_file,
    variants::{self, Edit, edited},
};

/// Names and specs (YAML) of shipped cranes.
pub type Specs = &'static [(&'static str, &'static str)];

/// Cranes that the command can choose from: shipped ones, compiled or live, and one of a YAML file.
#[derive(Default)]
pub struct Registry {
    entries: Vec<Entry>,
    shipped: Specs,
    carried: Carried,
    /// What the command that works with them says and reads.
    pub console: Arc<Console>,
}

/// What a command carries that is not beside its source tree.
#[derive(Clone, Copy, Default)]
pub struct Carried {
    /// The shared library of functional mock-up units for this computer; otherwise it is the file beside the command.
    pub unit_library: Option<&'static [u8]>,
    /// The sources of the crates that a new crate depends on: paths within the source tree, and texts.
    pub sources: &'static [(&'static str, &'static str)],
}

/// A crane of the registry.
struct Entry {
    name: String,
    /// Its file, for messages.
    file: String,
    /// Its spec, YAML.
    spec: Cow<'static, str>,
    /// The crane as machine code; otherwise a live crane is made from the spec.
    compiled: Option<Box<dyn DynCrane>>,
    /// What checking the spec found, once it is asked for.
    checked: OnceLock<Checked>,
    /// The live crane, once it is asked for: its clones share what is derived.
    live: OnceLock<LiveCrane>,
}

impl Entry {
    fn new(name: &str, spec: Cow<'static, str>) -> Self {
        let (checked, live) = (OnceLock::new(), OnceLock::new());
        Self { name: name.to_owned(), file: format!("{name}.yaml"), spec, compiled: None, checked, live }
    }

    fn open(&self, console: &Console) -> Outcome<Box<dyn DynCrane>> {
        match &self.compiled {
            Some(compiled) => Ok(compiled.boxed_clone()),
            None => Ok(self.live(console)?.boxed_clone()),
        }
    }

    fn source(&self) -> SourceFile {
        SourceFile::new(&self.file, self.spec.clone())
    }

    fn checked(&self) -> Outcome<&Checked> {
        if let Some(checked) = self.checked.get() {
            return Ok(checked);
        }
        let checked = compile::check(&self.source()).map_err(Problem::mistakes)?;
        Ok(self.checked.get_or_init(|| checked))
    }

    fn live(&self, console: &Console) -> Outcome<&LiveCrane> {
        if let Some(live) = self.live.get() {
            return Ok(live);
        }
        let chain = &self.checked()?.chain;
        console.begin(chain);
        Ok(self.live.get_or_init(|| LiveCrane::new(chain.clone())))
    }
}

impl Registry {
    /// Cranes by names and specs (YAML), those of `compiled` as machine code.
    pub fn new(specs: Specs, mut compiled: Vec<Box<dyn DynCrane>>) -> Self {
        let entry = |&(name, spec): &(&'static str, &'static str)| {
            let index = compiled.iter().position(|crane| crane.description().name == name);
            let compiled = index.map(|index| compiled.swap_remove(index));
            Entry { compiled, ..Entry::new(name, Cow::Borrowed(spec)) }
        };
        Self { entries: specs.iter().map(entry).collect(), shipped: specs, ..Self::default() }
    }

    /// No cranes, for the same command.
    #[must_use]
    pub fn empty(&self) -> Self {
        Self { console: Arc::clone(&self.console), ..Self::default() }
    }

    /// The same cranes in a command that carries more.
    #[must_use]
    pub fn carrying(self, carried: Carried) -> Self {
        Self { carried, ..self }
    }

    /// What the command carries.
    pub(super) fn carried(&self) -> &Carried {
        &self.carried
    }

    /// Adds a crane by its spec, in place of one of the same name.
    pub fn add(&mut self, name: &str, spec: String) {
        self.replace(Entry::new(name, Cow::Owned(spec)));
    }

    /// The spec of a shipped crane, or of a YAML file.
    pub(super) fn source(&self, given: &str) -> Outcome<SourceFile> {
        let file = Path::new(given);
        match self.spec(given) {
            Some(text) => Ok(SourceFile::new(format!("{given}.yaml"), text)),
            None if file == Path::new(STANDARD_INPUT) => spec_file::open(&self.console, file, spec_file::SPEC),
            None if file.extension().is_some() || file.exists() => {
                spec_file::open(&self.console, file, spec_file::SPEC)
            }
            // Neither: the message names the most similar crane.
            None => self
                .crane(given)
                .and_then(|_| Err(Problem::failed(format!("the spec of {given} is not available"), ""))),
        }
    }

    /// The chain of a shipped crane or of a YAML file, and its text; warnings are shown, and are mistakes if `strict`.
    pub(super) fn load(&self, text: &str, strict: bool) -> Outcome<(Chain, String)> {
        spec_file::parse(&self.console, self.source(text)?, strict)
    }

    /// Adds the crane of a YAML file, with edits of its spec, in place of one of the same name; returns its name.
    ///
    /// # Errors
    /// The file cannot be read, or the spec has mistakes; or warnings, if `strict`.
    pub(super) fn add_file(&mut self, file: &Path, edits: &[Edit<'_>], strict: bool) -> Outcome<String> {
        let spec = read(&spec_file::open(&self.console, file, spec_file::SPEC)?).map_err(Problem::mistakes)?;
        let checked = spec_file::warned(&self.console, edited(&spec, edits)?, strict)?;
        Ok(self.add_checked(checked, &file.display().to_string()))
    }

    /// Adds a crane with edits of its spec, unless there are none, in place of one of the same name; returns its name.
    ///
    /// # Errors
    /// There is no such crane, or its spec has mistakes with them.
    pub(super) fn edit(&mut self, name: &str, edits: &[Edit<'_>]) -> Outcome<String> {
        if edits.is_empty() {
            return Ok(name.to_owned());
        }
        let entry = self.known(name)?;
        let checked = match entry.checked.get() {
            Some(checked) => edited(&checked.spec, edits)?,
            None => edited(&read(&entry.source()).map_err(Problem::mistakes)?, edits)?,
        };
        let file = entry.file.clone();
        Ok(self.add_checked(checked, &file))
    }

    /// As [`Self::add`], for a spec that has been checked, from a `file` beside which its surfaces are; returns the crane's name.
    pub(super) fn add_checked(&mut self, mut checked: Checked, file: &str) -> String {
        let name = checked.chain.name.clone();
        let entry = Entry::new(&name, Cow::Owned(checked.spec.saved().text.clone()));
        spec_file::read_surfaces(&self.console, &mut checked.chain, Path::new(file));
        self.replace(Entry { checked: checked.into(), file: file.to_owned(), ..entry });
        name
    }

    /// What checking the spec of a crane found.
    pub(super) fn checked(&self, name: &str) -> Outcome<&Checked> {
        self.entry(name)?.checked()
    }

    fn replace(&mut self, entry: Entry) {
        self.entries.retain(|known| known.name != entry.name);
        self.entries.push(entry);
    }

    /// The shipped cranes.
    pub(super) fn shipped(&self) -> Specs {
        self.shipped
    }

    /// A crane with a change of its spec; or the mistakes that it makes.
    pub(super) fn changed(&self, name: &str, change: &Change) -> Outcome<Result<Checked, Diagnostics>> {
        Ok(self.checked(name)?.spec.changed(change).and_then(check))
    }

    /// Puts a crane in place of the one whose spec it has, changed.
    pub(super) fn add_variant(&mut self, of: &str, checked: Checked) -> Outcome<String> {
        let file = self.entry(of)?.file.clone();
        Ok(self.add_checked(checked, &file))
    }

    /// What to write for a crane in place of the word CRANE: its file, or the name of a shipped one.
    pub fn word_for(&self, name: &str) -> String {
        let file = self.entries.iter().find(|entry| entry.name == name).map(|entry| entry.file.as_str());
        let file = file.unwrap_or(name);
        let own = file.strip_suffix(".yaml").unwrap_or(file);
        let is_shipped = self.shipped.iter().any(|(shipped, _)| *shipped == own);
        if is_shipped { own.to_owned() } else { file.to_owned() }
    }

    /// A live crane with the parameters and inputs of another one, and with a combination of the spec of both.
    pub(super) fn live_combined(&self, crane: &dyn DynCrane, combination: &str) -> Outcome<LiveCrane> {
        let spec = &self.checked(&crane.description().name)?.spec;
        with_numbers_of(crane, LiveCrane::new(edited(spec, &[Edit::Combination(combination)])?.chain))
    }

    /// Names of the combinations of a crane's spec: at least one.
    ///
    /// # Errors
    /// There is no such crane, or it has none.
    pub(super) fn combinations(&self, name: &str) -> Outcome<Vec<String>> {
        let names = variants::names_of_combinations(&self.known(name)?.checked()?.spec.crane)?;
        Ok(names.into_iter().map(str::to_owned).collect())
    }

    /// Names of all cranes.
    pub fn names(&self) -> Vec<&str> {
        self.entries.iter().map(|entry| entry.name.as_str()).collect()
    }

    /// All cranes, with the parameters of their specs.
    pub(super) fn all(&self) -> impl Iterator<Item = Outcome<Box<dyn DynCrane>>> {
        self.entries.iter().map(|entry| entry.open(&self.console))
    }

    /// Whether a crane is machine code.
    pub fn is_compiled(&self, name: &str) -> bool {
        self.entries.iter().any(|entry| entry.name == name && entry.compiled.is_some())
    }

    /// Whether it has cranes of all these names.
    pub(super) fn has(&self, names: [&str; 2]) -> bool {
        names.iter().all(|name| self.entries.iter().any(|entry| entry.name == *name))
    }

    /// The spec of a crane.
    pub fn spec(&self, name: &str) -> Option<&str> {
        self.entries.iter().find(|entry| entry.name == name).map(|entry| entry.spec.as_ref())
    }

    /// A live crane of the same spec and parameters, which has derivatives of transforms too.
    pub(super) fn live(&self, crane: &dyn DynCrane) -> Outcome<LiveCrane> {
        with_numbers_of(crane, self.entry(&crane.description().name)?.live(&self.console)?.clone())
    }

    fn entry(&self, name: &str) -> Outcome<&Entry> {
        let entry = self.entries.iter().find(|entry| entry.name == name);
        entry.ok_or_else(|| Problem::failed(format!("{name} has no spec"), ""))
    }

    /// A crane by its name.
    ///
    /// # Errors
    /// There is no such crane, or its parameters cannot have these values.
    pub fn crane(&self, name: &str) -> Outcome<Box<dyn DynCrane>> {
        self.known(name)?.open(&self.console)
    }

    /// A crane by its name, which a user has written.
    fn known(&self, name: &str) -> Outcome<&Entry> {
        if let Some(entry) = self.entries.iter().find(|entry| entry.name == name) {
            return Ok(entry);
        }
        let file = format!("{name}.yaml");
        let help = if Path::new(&file).exists() {
            format!("did you mean the file `{file}`?")
        } else if Path::new(name).is_file() {
            "rename the file so that its name ends in `.yaml`".to_owned()
        } else {
            meant(name, &self.names(), "cranes")
        };
        Err(Problem::usage(format!("there is no crane `{name}`"), help))
    }
}

/// A live crane with the parameters and inputs of another one of the same parameters and inputs.
fn with_numbers_of(crane: &dyn DynCrane, mut live: LiveCrane) -> Outcome<LiveCrane> {
    take_numbers(crane, &mut live)?;
    Ok(live)
}

/// Gives a variant of a crane, with other sections or none, the same numbers: parameters and inputs, by their names.
///
/// # Errors
/// The variant refuses a parameter.
pub fn take_numbers(of: &dyn DynCrane, variant: &mut dyn DynCrane) -> Outcome<()> {
    let (own, others) = (of.description(), variant.description());
    let parameter = |(index, info): (usize, &ParameterInfo)| {
        let known = own.parameters.iter().position(|known| known.name == info.name);
        known.map_or_else(|| variant.parameter(index), |known| of.parameter(known))
    };
    let parameters: Vec<f64> = others.parameters.iter().enumerate().map(parameter).collect();
    let input = |(index, info): (usize, &InputInfo)| {
        Some((index, of.input(own.inputs.iter().position(|known| known.name == info.name)?)))
    };
    let inputs: Vec<(usize, Option<f64>)> = others.inputs.iter().enumerate().filter_map(input).collect();
    variant.set_parameters(&parameters).map_err(|refused| {
        let (title, help) = refusal_message(&refused);
        Problem::usage(title, help)
    })?;
    for (index, value) in inputs {
        variant.set_input(index, value);
    }
    Ok(())
}

/// Sets inputs `name=value`.
pub fn set_inputs(crane: &mut dyn DynCrane, settings: &[String]) -> Outcome<()> {
    for setting in settings {
        let (index, value) = input(setting, crane.description())?;
        crane.set_input(index, Some(value));
    }
    Ok(())
}

impl Choice {
    /// The crane with its parameters and inputs.
    ///
    /// # Errors
    /// There is no such crane or input, or its parameters cannot have these values.
    pub fn open(&self, registry: &Registry) -> Outcome<Box<dyn DynCrane>> {
        let mut crane = self.parameters.crane(&self.name, self.strict, registry)?;
        set_inputs(crane.as_mut(), &self.inputs)?;
        Ok(crane)
    }
}

/// Index of an input and its value, as in `name=value`.
fn input(setting: &str, description: &Description) -> Outcome<(usize, f64)> {
    let (name, value) = setting.split_once('=').ok_or_else(|| {
        Problem::usage(
            format!("`--input {setting}` has no value"),
            "write `--input name=value`, such as `--input pull=300`",
        )
    })?;
    let known = || description.inputs.iter().map(|input| input.name.as_str());
    let index = known().position(|known| known == name).ok_or_else(|| {
        let help = if description.inputs.is_empty() {
            "it has none; name them under `inputs:` in its spec".to_owned()
        } else {
            meant(name, &known().collect::<Vec<_>>(), "inputs")
        };
        Problem::usage(format!("{} has no input `{name}`", description.name), help)
    })?;
    let unit = description.inputs[index].unit.as_str();
    let number = number(unit, value, name)?;
    Ok((index, number))
}

impl Parameters {
    /// A crane with these parameters; `strict`: implausible values are mistakes.
    ///
    /// # Errors
    /// There is no such crane, or its parameters cannot have these values.
    pub fn crane(&self, name: &str, strict: bool, registry: &Registry) -> Outcome<Box<dyn DynCrane>> {
        let mut crane = registry.crane(name)?;
        let description = crane.description();
        let settings = self.read(&description.name, &known_parameters(description))?;
        if settings.is_empty() {
            return Ok(crane);
        }
        let values: Vec<(String, f64)> =
            settings.iter().map(|&(index, value)| (description.parameters[index].name.to_string(), value)).collect();
        set_parameters(crane.as_mut(), &settings)?;
        if let Some(entry) = registry.entries.iter().find(|entry| entry.name == name) {
            let warned = spec_file::warn_of(&registry.console, entry.checked()?, &values);
            if let (true, Some(problem)) = (strict, warned) {
                return Err(problem);
            }
        }
        Ok(crane)
    }

    /// Only the settings of parameters that a crane has.
    #[must_use]
    pub fn known_to(&self, description: &Description) -> Self {
        let is_known = |setting: &&String| {
            let name = setting.split('=').next().unwrap_or_default();
            description.parameters.iter().any(|parameter| parameter.name == name)
        };
        Self { settings: self.settings.iter().filter(is_known).cloned().collect() }
    }

    /// Indices of the parameters that are set, and their values; `known`: names and units of those that the crane has.
    ///
    /// # Errors
    /// A setting is not `name=value`, or the crane has no such parameter.
    pub fn read(&self, crane: &str, known: &[(&str, &str)]) -> Outcome<Vec<(usize, f64)>> {
        let read = |setting: &String| {
            let (name, value) = setting.split_once('=').ok_or_else(|| {
                Problem::usage(
                    format!("`--set {setting}` has no value"),
                    "write `--set name=value`, such as `--set load_mass=300`",
                )
            })?;
            let index = index_of_known(name, crane, known).map_err(|(title, help)| Problem::usage(title, help))?;
            let unit = known[index].1;
            let number = number(unit, value, name)?;
            Ok((index, number))
        };
        self.settings.iter().map(read).collect()
    }
}

/// Sets live parameters, by their indices in the description, all at once.
pub fn set_parameters(crane: &mut dyn DynCrane, settings: &[(usize, f64)]) -> Outcome<()> {
    let mut values: Vec<f64> = crane.parameter_values();
    for &(index, value) in settings {
        values[index] = value;
    }
    crane.set_parameters(&values).map_err(|refused| {
        let (title, help) = refusal_message(&refused);
        Problem::usage(title, help)
    })
}

/// What is wrong with the value of a parameter, and what to write instead.
pub fn refusal_message(refused: &ParameterError) -> (String, String) {
    let Refusal { code, title, help } = &refused.refusal;
    let title = match &refused.given {
        Some((parameter, value)) if value.abs() < 1e15 => format!("parameter `{parameter}`: {title} {value} [{code}]"),
        Some((parameter, value)) => format!("parameter `{parameter}`: {title} {value:e} [{code}]"),
        None => format!("{title} [{code}]"),
    };
    (title, help.to_string())
}

/// Names and units of a crane's live parameters.
fn known_parameters(description: &Description) -> Vec<(&str, &str)> {
    description.parameters.iter().map(|parameter| (parameter.name.as_str(), parameter.unit.as_str())).collect()
}

/// Index of a live parameter by its name; otherwise what is wrong and what to write.
pub fn find_parameter(name: &str, description: &Description) -> Result<usize, (String, String)> {
    index_of_known(name, &description.name, &known_parameters(description))
}

fn index_of_known(name: &str, crane: &str, known: &[(&str, &str)]) -> Result<usize, (String, String)> {
    known.iter().position(|(known, _)| *known == name).ok_or_else(|| {
        let names: Vec<String> = known.iter().map(|(name, unit)| format!("{name} [{unit}]")).collect();
        let title = format!("{crane} has no live parameter `{name}`");
        if names.is_empty() {
            return (title, "it has none; define some under `parameters:` in its spec".to_owned());
        }
        let guess = nearest(name, known.iter().map(|(name, _)| *name));
        (title, hint(guess, &names.join(", "), "parameters"))
    })
}
