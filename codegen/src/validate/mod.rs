//! `CraneSpec ─validate→ Chain`: checks every rule of the language and expands links into bodies.
//!
//! A mistake never ends the checks. An invalid number is replaced by NaN; every comparison with NaN is false, so each
//! number is reported only once.

mod base;
mod beam;
mod columns;
mod combinations;
mod connectors;
mod cylinders;
mod drives;
mod elements;
mod events;
mod inertias;
mod inputs;
mod joints;
mod limits;
mod links;
mod loads;
mod loop_joints;
mod mass;
mod names;
mod numbers;
mod on;
mod plausibility;
mod regular;
mod rope;
mod run;
mod section;
mod sections;
mod shapes;
mod slides_in;
mod stations;

use std::collections::BTreeMap;

use crate::chain::{
    self, Analyses, Body, BodyId, Bound, Chain, Coordinate, CoordinateId, Division, Force, Input, Loops, Parameter,
    ParameterId, Relation, Value,
};
use crate::diagnostic::{Diagnostics, Mistake, SourceFile, Span, code, rule};
use crate::expand::beam::Distribution;
use crate::spec::{self, Analysis, Crane, CraneSpec, Lookalike, Slope, Spanned, entries};
use crate::units::Quantity;
use inertias::Judgement;
use names::Names;
use section::Elastic;
use slides_in::Stage;

/// A crane without mistakes.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The crane as written.
    pub spec: CraneSpec,
    /// The chain of its bodies.
    pub chain: Chain,
    /// Warnings about numbers that suggest a wrong unit or a slip; the crane is compiled nevertheless.
    pub warnings: Diagnostics,
    /// The units of its numbers, by their locations.
    pub units: Vec<(Span, String)>,
    found: Inventory,
}

/// What checking notes besides the chain.
#[derive(Clone, Debug)]
struct Inventory {
    warnings: Vec<Mistake>,
    units: Vec<(Span, String)>,
    judged: Vec<plausibility::Judged>,
}

impl Inventory {
    /// Warnings about a crane with values of parameters other than those of the spec, by name.
    fn warnings(&self, spec: &CraneSpec, chain: &Chain, set: &[(&str, f64)]) -> Diagnostics {
        let value = |parameter: &Parameter| {
            set.iter().rev().find(|(name, _)| *name == parameter.name).map_or(parameter.default, |(_, value)| *value)
        };
        let values = chain.parameters.iter().map(value).collect();
        let mut warnings = self.warnings.clone();
        warnings.extend(plausibility::warnings(&spec.crane, chain, values, &self.judged));
        Diagnostics::new(&spec.source, warnings)
    }
}

impl Checked {
    /// Warnings for parameter values other than those of the spec, given by name and value.
    #[must_use]
    pub fn warnings_with(&self, set: &[(&str, f64)]) -> Diagnostics {
        self.found.warnings(&self.spec, &self.chain, set)
    }

    /// The unit of the number at a place, such as `links.boom.beam.section.box.height`, in SI: that which messages about it name. Empty
    /// for a number without one.
    #[must_use]
    pub fn unit_at(&self, place: &str) -> &str {
        let at = self.spec.span_at(place);
        self.units.iter().find(|(span, _)| Some(*span) == at).map_or("", |(_, unit)| unit)
    }
}

/// Checks a spec and expands it into the chain of its bodies.
///
/// # Errors
/// If the spec breaks any rule of the language; all mistakes are returned together, including those of reading.
pub fn validate(spec: &CraneSpec) -> Result<Chain, Diagnostics> {
    expand(spec).map(|(chain, _)| chain)
}

/// The chain of a spec before the checks that need a whole crane: what its parts are called.
///
/// # Errors
/// The mistakes so far.
pub fn outline(spec: &CraneSpec) -> Result<Chain, Diagnostics> {
    let (check, chain) = Check::begin(spec);
    check.end(spec)?;
    Ok(chain)
}

/// Checks a spec, expands it into the chain of its bodies, and looks for implausible numbers.
///
/// # Errors
/// If the spec breaks any rule of the language; all mistakes are returned together, including those of reading.
pub fn check(spec: CraneSpec) -> Result<Checked, Diagnostics> {
    let (chain, mut found) = expand(&spec)?;
    let (warnings, units) = (found.warnings(&spec, &chain, &[]), std::mem::take(&mut found.units));
    Ok(Checked { spec, chain, warnings, units, found })
}

fn expand(spec: &CraneSpec) -> Result<(Chain, Inventory), Diagnostics> {
    let (mut check, mut chain) = Check::begin(spec);
    if check.mistakes.is_empty() {
        // The mass matrix exists only if there are no other mistakes.
        check.shared_columns(&chain, &spec.crane);
        check.regular(&chain, &spec.crane);
        check.connectors_apart(&chain, &spec.crane);
        check.loops_move(&mut chain, &spec.crane);
        check.couplings_move(&chain, &spec.crane);
        check.keep_masses(&mut chain);
        check.conditions(&mut chain, &spec.crane);
        check.events_allowed(&chain, &spec.crane);
    }
    Ok((chain, check.end(spec)?))
}

/// If a new entry lacks keys and its name is almost that of an entry of the extended spec, replaces its mistakes by one: the misspelt name.
fn misspelt(mut mistakes: Vec<Mistake>, lookalikes: &[Lookalike]) -> Vec<Mistake> {
    for Lookalike { name, at, span, known } in lookalikes {
        let within = |mistake: &Mistake| (span.start..span.end).contains(&mistake.span.start);
        if mistakes.iter().any(|mistake| within(mistake) && mistake.code == code::missing_key) {
            mistakes.retain(|mistake| !within(mistake));
            mistakes.push(rule::misspelt_entry(*at, name, known));
        }
    }
    mistakes
}

/// The owner of a coordinate.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Owner {
    /// The free base.
    Base,
    /// A revolute or prismatic joint.
    Joint,
    /// The springs of a beam, by link.
    Beam(String),
    /// The pads on which a beam slides, by link.
    Pads(String),
}

/// The bodies of a link along x.
#[derive(Clone, Debug, Default)]
struct Carried {
    /// Their starts when undeformed, m; after a mistake in a beam or a rope, there are none.
    starts: Vec<Value>,
    /// The tip of the last one, m; 0 for a rigid link.
    tip: Value,
    /// The sections of a beam that is not given element by element.
    division: Division,
}

/// The position of a link in the chain.
#[derive(Clone, Debug)]
struct LinkBodies {
    /// Index of its first body, if it has any.
    first: usize,
    /// Its bodies.
    carried: Carried,
}

impl std::ops::Deref for LinkBodies {
    type Target = Carried;

    fn deref(&self) -> &Carried {
        &self.carried
    }
}

impl LinkBodies {
    /// Its length, m; 0 for a rigid link.
    fn length(&self) -> Value {
        self.starts.last().cloned().unwrap_or(Value::ZERO) + self.tip.clone()
    }

    /// Its first body.
    fn first(&self) -> Option<BodyId> {
        (!self.starts.is_empty()).then_some(BodyId(self.first))
    }

    /// Its last body.
    fn last(&self) -> Option<BodyId> {
        self.starts.len().checked_sub(1).map(|last| BodyId(self.first + last))
    }
}

/// The check of one spec: its state so far, and the mistakes found.
#[derive(Debug, Default)]
struct Check<'a> {
    mistakes: Vec<Mistake>,
    /// Warnings about rules that are slightly violated.
    warnings: Vec<Mistake>,
    parameters: Vec<Parameter>,
    /// Default values of the parameters, at which live numbers are checked.
    defaults: Vec<f64>,
    /// Their values as written, if with a unit.
    written: Vec<Option<Quantity>>,
    /// Whether their values are plain numbers, with or without a unit beside them.
    labelled: Vec<bool>,
    /// The units of the numbers so far, by their locations.
    units: Vec<(Span, String)>,
    /// Numbers with a usual range.
    judged: Vec<plausibility::Judged>,
    /// Whether some number refers to each parameter.
    used: Vec<bool>,
    /// Live masses, and the bound of those that cannot be zero.
    live_masses: Vec<(ParameterId, Bound)>,
    /// Rules about several numbers, some of them live.
    relations: Vec<Relation>,
    /// Inertias as written, with the bodies of which they are a part.
    judgements: Vec<(BodyId, Judgement)>,
    inputs: Vec<Input>,
    /// Whether some motion refers to each input.
    used_inputs: Vec<bool>,
    /// Whether some inputs could not be read.
    unknown_inputs: bool,
    /// Whether some drives could not be read.
    unknown_drives: bool,
    materials: BTreeMap<&'a str, Elastic>,
    coordinates: Vec<Coordinate>,
    /// The owner of each coordinate.
    owners: Vec<Owner>,
    bodies: Vec<Body>,
    /// Springs between elements of flexible links.
    element_springs: Vec<Force>,
    /// Damping of the joints of ropes.
    rope_damping: Vec<(CoordinateId, Value)>,
    beams: Vec<chain::Beam>,
    /// What each of the beams consists of; `None` if its elements are given one by one, and for ropes.
    distributions: Vec<Option<Distribution>>,
    base: [Option<CoordinateId>; 6],
    links: BTreeMap<&'a str, LinkBodies>,
    /// Names of loop joints, as written.
    loop_names: Vec<&'a str>,
    /// Places along beams where something acts on them, by link, m.
    stations: BTreeMap<&'a str, Vec<Value>>,
    /// Stages of telescopes.
    stages: Vec<Stage<'a>>,
    /// What links look like.
    shapes: Vec<chain::Shape>,
    /// Names of bodies and coordinates after expansion.
    expanded: Names,
    /// Kinds of names of which some could not be read.
    unknown: Unknown,
}

/// Kinds of names of which some could not be read: references to unknown names of such a kind are not reported.
#[derive(Clone, Copy, Debug, Default)]
struct Unknown {
    parameters: bool,
    materials: bool,
    links: bool,
}

impl<'a> Check<'a> {
    /// All that needs no whole crane.
    fn begin(spec: &'a CraneSpec) -> (Self, Chain) {
        let mut check = Check { mistakes: spec.mistakes.clone(), ..Check::default() };
        let chain = check.crane(&spec.crane, &spec.saved);
        (check, chain)
    }

    fn end(self, spec: &CraneSpec) -> Result<Inventory, Diagnostics> {
        if !self.mistakes.is_empty() {
            return Err(Diagnostics::new(&spec.source, misspelt(self.mistakes, &spec.noticed.lookalikes)));
        }
        Ok(Inventory { warnings: self.warnings, units: self.units, judged: self.judged })
    }

    fn report(&mut self, mistake: Mistake) {
        self.mistakes.push(mistake);
    }

    fn crane(&mut self, crane: &'a Crane, source: &SourceFile) -> Chain {
        self.format(crane);
        let name = self.crane_name(&crane.name).unwrap_or_default();
        let title = self.text(crane.title.as_ref(), "`title`").unwrap_or_else(|| name.to_owned());
        self.take_parameters(crane);
        self.take_inputs(crane);
        self.take_materials(crane);
        let gravity = match &crane.gravity {
            Some(gravity) => self.vector(gravity, "`gravity`"),
            None => [0.0, 0.0, -9.81].map(Value::from),
        };
        let gravity = self.on_slope(gravity, crane.slope.as_ref());
        self.loop_names = entries(crane.loop_joints.as_ref()).filter_map(|joint| joint.name.value.as_deref()).collect();
        self.stations = self.stations(crane);
        self.links(&crane.links);
        self.possible_inertias();
        let supports = self.supports(crane);
        let (mut drives, mut rotors) = self.drives(crane);
        let mut forces = std::mem::take(&mut self.element_springs);
        forces.extend(self.joint_dampers(crane, &drives));
        forces.extend(self.joint_forces(crane, &drives));
        let loads = self.loads(crane);
        let combinations = self.combinations(crane, &loads);
        let combination = self.combination(crane, &combinations);
        let cylinders = self.cylinders(crane, &drives);
        let pump = self.pump(crane);
        self.make_drives_hydraulic(crane, &cylinders, pump.as_ref(), &mut drives);
        let mut connectors = self.connectors(crane, &cylinders);
        connectors.extend(self.contacts(crane, &cylinders));
        let (couplings, rigid_couplings) = self.couplings(crane, &cylinders);
        connectors.extend(couplings);
        let (pads, exact_pads) = self.pads(&cylinders, &forces);
        connectors.extend(pads);
        let (mut loop_joints, in_pins) = self.loop_joints(crane, &cylinders);
        loop_joints.extend(exact_pads);
        connectors.extend(in_pins);
        rotors.extend(self.rotors(crane, &drives));
        self.beam_sections(&loads, &cylinders, &connectors, &loop_joints);
        let frames = self.frames(crane);
        let joints = self.joints(crane);
        let points = self.points(crane, &frames);
        let written_guess = self.guess(crane, &drives);
        let run = self.run(crane.run.as_ref());
        let events = self.events(crane, &points);
        let analyses = self.analyses(crane.analyses.as_ref());
        self.something_moves(crane);
        self.every_parameter_used(crane);
        self.every_input_used(crane);
        let mut chain = Chain {
            title,
            name: name.to_owned(),
            spec_hash: source.hash(),
            gravity,
            parameters: std::mem::take(&mut self.parameters),
            relations: std::mem::take(&mut self.relations),
            coordinates: std::mem::take(&mut self.coordinates),
            bodies: std::mem::take(&mut self.bodies),
            base: self.base,
            supports,
            beams: std::mem::take(&mut self.beams),
            drives,
            forces: [forces, connectors].concat(),
            loads,
            combinations,
            combination: None,
            cylinders,
            pump,
            loop_joints,
            rigid_couplings,
            inputs: std::mem::take(&mut self.inputs),
            rotors,
            frames,
            joints,
            points,
            shapes: std::mem::take(&mut self.shapes),
            written_guess,
            guess: Vec::new(),
            run,
            events,
            analyses,
            loops: loops(crane.loops.as_ref()),
        };
        chain.guess = chain.guess_at(&self.defaults);
        match combination {
            Some(combination) => chain.combined(&combination),
            None => chain,
        }
    }

    fn format(&mut self, crane: &Crane) {
        let version = self.constant(&crane.format, "`format`");
        if !version.is_nan() && version.to_bits() != 1f64.to_bits() {
            self.report(rule::wrong_format(crane.format.span, version));
        }
    }

    /// Gravity on an inclined ground, in the axes of the ground: `g (sin α cos φ, sin α sin φ, −cos α)`.
    fn on_slope(&mut self, gravity: [Value; 3], slope: Option<&Spanned<Slope>>) -> [Value; 3] {
        let Some((given, slope)) = slope.and_then(|given| Some((given, given.value.as_ref()?))) else { return gravity };
        let angle = self.number(&slope.angle, "`angle` of `slope`");
        let towards = slope.towards.as_ref();
        let towards = towards.map_or(Value::ZERO, |towards| self.number(towards, "`towards` of `slope`"));
        let [x, y, z] = gravity;
        if !x.is_zero() || !y.is_zero() {
            self.report(rule::slope_twice(given.span));
        }
        let steep = self.now(&angle);
        if steep.abs() >= std::f64::consts::FRAC_PI_2 {
            self.report(rule::steep_slope(slope.angle.span, steep, plausibility::rounded(steep)));
        }
        let ((sin, cos), (across, along)) = (angle.sin_cos(), towards.sin_cos());
        let down = -z.clone() * sin;
        [down.clone() * along, down * across, z * cos]
    }

    fn something_moves(&mut self, crane: &Crane) {
        // A joint with a mistake may be the one that moves.
        if self.mistakes.is_empty() && self.coordinates.is_empty() {
            self.report(rule::nothing_moves(crane.links.span));
        }
    }

    fn take_materials(&mut self, crane: &'a Crane) {
        let Some(materials) = &crane.materials else { return };
        let Some(materials) = &materials.value else {
            self.unknown.materials = true;
            return;
        };
        for (name, material) in &materials.0 {
            self.unknown.materials |= material.value.is_none();
            let constants = material.value.as_ref().map(|material| self.elastic(material));
            if let (Some(name), Some(constants)) = (self.name(name), constants) {
                self.materials.insert(name, constants);
            }
        }
    }

    fn analyses(&mut self, given: Option<&Spanned<Vec<Spanned<Analysis>>>>) -> Analyses {
        let default = Analyses { internal_forces: false, ..Analyses::COMMAND };
        let Some((list, span)) = given.and_then(|given| Some((given.value.as_ref()?, given.span))) else {
            return default;
        };
        if list.is_empty() {
            self.report(rule::no_analyses(span));
        }
        let wants = |analysis| list.iter().any(|item| item.value == Some(analysis));
        Analyses {
            statics: wants(Analysis::Statics),
            dynamics: wants(Analysis::Dynamics) || wants(Analysis::Ensemble) || wants(Analysis::MotionDerivatives),
            modes: wants(Analysis::Modes),
            internal_forces: wants(Analysis::InternalForces),
            derivatives: wants(Analysis::Derivatives),
            motion_derivatives: wants(Analysis::MotionDerivatives),
            ensemble: wants(Analysis::Ensemble),
        }
    }
}

fn loops(given: Option<&Spanned<spec::Loops>>) -> Loops {
    match given.and_then(|given| given.value) {
        None | Some(spec::Loops::Auto) => Loops::Auto,
        Some(spec::Loops::Always) => Loops::Always,
        Some(spec::Loops::Never) => Loops::Never,
    }
}
