//! The functions of a crane: signatures, documentation, and what is left out.

mod drive_efforts;
mod energies;
mod forces;
mod internal_forces;
mod loop_joints;
mod motion_derivatives;
mod statics;

use std::cell::OnceCell;

use crate::chain::{Analyses, Beam, Body, BodyId, Chain, Group, Section};
use crate::program::{Argument, Count, Extent, Function, FunctionId, Item, Part, Program, Shape, Struct, Symbol};
use crate::symbolic::{Expr, Graph, Stages, SweepTrace, SymbolId};

use super::articulated::Effort;
use super::columns::columns;
use super::elements::{Posed, Strains};
use super::factors::{Factor, factors};
use super::forces::{Forces, Kind};
use super::forward::{self, ForwardInputs, ForwardMotion};
use super::inertia::Inertias;
use super::kinematics::Kinematics;
use super::loop_joints::LoopEquations;
use super::model::Model;
use super::motion_derivatives::with_rotors;
use super::twist::{Twist, twists};
use super::vector::{SymmetricMatrix, Vec3};
use super::{cylinders, drives, effective_mass, energy, newton_euler, pads, points, rotors, transforms};

/// Derives the functions of analyses over one graph.
pub fn program(graph: Graph, chain: &Chain, analyses: Analyses) -> Program {
    of_parts(graph, chain, &|part| analyses.request(part))
}

/// Derives the functions of a part over one graph.
pub fn part(graph: Graph, chain: &Chain, wanted: Part) -> Program {
    of_parts(graph, chain, &|part| part == wanted)
}

fn of_parts(graph: Graph, chain: &Chain, wanted: &dyn Fn(Part) -> bool) -> Program {
    let mut symbols = Model::symbols(chain);
    let derivation = Derivation::new(&graph, chain);
    let parts = Part::ALL.into_iter().filter(|part| wanted(*part));
    let functions = parts.flat_map(|part| derivation.part(part, &mut symbols)).collect();
    drop(derivation);
    Program::new(graph, symbols, functions)
}

/// A model with the expressions that several functions share.
struct Derivation<'g> {
    model: Model<'g>,
    factors: Vec<Factor<'g>>,
    kinematics: Kinematics<'g>,
    inertias: Inertias<'g>,
    twists: Vec<Twist<'g>>,
    strains: Strains<'g>,
    loops: OnceCell<LoopEquations<'g>>,
    /// Whether some coordinate is prescribed.
    rigid: bool,
}

/// What the dynamics of a chain needs besides its pose: velocities, forces, prescribed accelerations, gravity.
#[derive(Clone, Copy)]
struct DynamicsInputs<'a, 'g> {
    v: &'a [Expr<'g>],
    forces: &'a [Expr<'g>],
    prescribed: &'a [Option<Expr<'g>>],
    gravity: Vec3<'g>,
}

impl<'g> Derivation<'g> {
    fn new(graph: &'g Graph, chain: &'g Chain) -> Self {
        let model = Model::new(graph, chain);
        let factors = factors(&model);
        let kinematics = Kinematics::new(&model);
        let inertias = Inertias::new(&model, &kinematics);
        let twists = twists(&model, &kinematics);
        let rigid = chain.rigid_drives().next().is_some();
        let strains = Strains::new(chain);
        Derivation { model, factors, kinematics, inertias, twists, strains, loops: OnceCell::new(), rigid }
    }

    fn part(&self, part: Part, symbols: &mut Vec<Symbol>) -> Vec<Function> {
        match part {
            Part::Common => [self.poses(), self.force_functions(), self.loop_joints(), self.energies()].concat(),
            Part::Dynamics => self.dynamics(),
            Part::Systems => self.systems(symbols),
            Part::StepMatrices => self.step_matrices(),
            Part::Statics => self.statics(),
            Part::Modes => vec![self.linearise()],
            Part::InternalForces => self.internal_forces(),
            Part::Derivatives => self.transform_derivatives(),
            Part::MotionDerivatives => self.motion_derivatives(),
        }
    }

    /// All forces except those of rigid drives.
    fn forces(&self) -> Forces<'_, 'g> {
        Forces::new(self.posed())
    }

    fn posed(&self) -> Posed<'_, 'g> {
        (&self.model, &self.kinematics, &self.strains)
    }

    fn poses(&self) -> Vec<Function> {
        let chain = self.model.chain;
        let model = &self.model;
        let mut functions = vec![
            self.function(FunctionId::Transforms, transforms::transforms(&self.kinematics)),
            self.function(FunctionId::BodySizes, body_sizes(model)),
        ];
        if !chain.supports.is_empty() {
            functions.push(self.function(FunctionId::SupportPlaces, crate::mechanics::supports::places(model)));
        }
        let places: Vec<_> = chain.beams.iter().flat_map(|beam| section_places(model, beam)).collect();
        if !places.is_empty() {
            functions.push(self.function(FunctionId::SectionPlaces, places));
        }
        let attachments: Vec<_> = chain.attachments().flat_map(|at| model.vector(&at.position).0).collect();
        if !attachments.is_empty() {
            functions.push(self.function(FunctionId::Attachments, attachments));
        }
        if !chain.points.is_empty() {
            functions.push(self.function(FunctionId::Points, points::positions(&self.model, &self.kinematics)));
            functions.push(self.function(
                FunctionId::PointVelocities,
                points::velocities(&self.model, &self.kinematics, &self.twists),
            ));
            let (model, kinematics) = (&self.model, &self.kinematics);
            let (accelerations, trace) =
                model.graph.recorded(|| newton_euler::point_accelerations(model, kinematics, &self.factors));
            functions.push(self.function(FunctionId::PointAccelerations, accelerations).by(trace));
        }
        if !chain.cylinders.is_empty() {
            functions.push(self.function(FunctionId::CylinderStates, cylinders::states(&self.model)));
        }
        if chain.has_valves() {
            functions.push(self.function(FunctionId::CylinderJacobians, cylinders::jacobians(&self.model)));
        }
        functions
    }

    fn dynamics(&self) -> Vec<Function> {
        let model = &self.model;
        let gravity = model.vector(&model.chain.gravity);
        let forces = self.forces().all();
        let prescribed = drives::accelerations(model);
        let of_motion = DynamicsInputs { v: &model.v, forces: &forces, prescribed: &prescribed, gravity };
        let (accelerations, trace) = model.graph.recorded(|| self.hybrid_dynamics(&of_motion).accelerations);
        let (solution, solution_trace) = model.graph.recorded(|| self.response(&model.right_hand_side));
        let (columns, mass_trace) = model.graph.recorded(|| columns(model, &self.factors));
        let (bias, bias_trace) = model.graph.recorded(|| newton_euler::bias(model, &self.factors));
        // The loop includes neither rotors nor branches, which leave most of A zero.
        let looped = model.chain.loops.fill_mass_matrix(model.size())
            && model.chain.rotors.is_empty()
            && !model.chain.has_branches();
        let (mass_shape, both_shape, mass, mut both) = if looped {
            let slots = columns.slots();
            let shape = |bias| Shape::Columns { n: model.size(), points: columns.points(model), bias };
            (shape(false), shape(true), slots.clone(), slots)
        } else {
            let upper = columns.mass_matrix(model).into_upper();
            (Shape::Symmetric(model.size()), Shape::MassAndBias(model.size()), upper.clone(), upper)
        };
        both.extend(&bias);
        let mut functions: Vec<Function> = self.loop_dynamics(&accelerations, &trace).into_iter().collect();
        functions.extend([
            self.function(FunctionId::ForwardDynamics, accelerations).by(trace),
            self.function(FunctionId::SolveMass, solution).by(solution_trace),
            shaped(FunctionId::MassMatrix, mass_shape, mass).by(mass_trace.clone()),
            shaped(FunctionId::MassMatrixAndBias, both_shape, both).by(mass_trace.then(bias_trace.clone())),
            self.function(FunctionId::Bias, bias).by(bias_trace),
            self.function(FunctionId::KineticEnergy, vec![energy::kinetic_energy(model, &self.inertias, &self.twists)]),
        ]);
        functions
    }

    /// The response of the chain at rest to forces, `A⁻¹ f`.
    fn response(&self, forces: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let model = &self.model;
        let (v, prescribed, gravity) = (&model.zeros(), &drives::at_rest(model), Vec3::zero(model.graph));
        self.hybrid_dynamics(&DynamicsInputs { v, forces, prescribed, gravity }).accelerations
    }

    /// Accelerations, and efforts of rigid drives, at the present state.
    fn motion(&self) -> ForwardMotion<'g> {
        let model = &self.model;
        let forces = self.forces().all();
        let prescribed = drives::accelerations(model);
        let gravity = model.vector(&model.chain.gravity);
        self.hybrid_dynamics(&DynamicsInputs { v: &model.v, forces: &forces, prescribed: &prescribed, gravity })
    }

    /// The motion of the chain, including rotors.
    fn hybrid_dynamics(&self, inputs: &DynamicsInputs<'_, 'g>) -> ForwardMotion<'g> {
        let DynamicsInputs { v, forces, prescribed, gravity } = *inputs;
        let armatures = rotors::armatures(&self.model);
        let efforts = forces.iter().zip(armatures).map(|(&applied, added_inertia)| Effort { applied, added_inertia });
        let efforts: Vec<_> = efforts.collect();
        forward::hybrid_dynamics(
            &self.model,
            &self.factors,
            &ForwardInputs { v, efforts: &efforts, prescribed, gravity },
        )
    }

    /// The generalized forces that a motion requires, and how they are computed.
    fn inverse_dynamics(&self) -> (Vec<Expr<'g>>, SweepTrace) {
        let model = &self.model;
        let (required, trace) = model.graph.recorded(|| newton_euler::inverse_dynamics(model, &self.factors));
        (with_rotors(model, required), trace)
    }

    /// For implicit integration: what a motion requires beyond the forces that act, and systems with stiffness and damping.
    fn systems(&self, symbols: &mut Vec<Symbol>) -> Vec<Function> {
        let model = &self.model;
        let solve = || effective_mass::solution(model, &self.kinematics, &self.factors);
        let (solution, trace) = model.graph.recorded(solve);
        let first = SymbolId(u32::try_from(symbols.len()).expect("fewer than 2^32 inputs"));
        let late = |SymbolId(id): SymbolId| {
            symbols.get(id as usize).is_some_and(|symbol| symbol.argument == Argument::RightHandSide)
        };
        let Stages { factors, results, trace: late_trace } = model.graph.stages(&solution, &trace, late, first);
        symbols.extend((0..factors.len()).map(|index| Symbol {
            name: format!("f{index:03}"),
            argument: Argument::Factors,
            index,
        }));
        let (required, required_trace) = self.inverse_dynamics();
        let residual = required.iter().zip(&self.forces().all()).map(|(required, force)| *required - *force).collect();
        vec![
            shaped(FunctionId::Factorise, Shape::Factors(factors.len()), factors).by(trace),
            shaped(FunctionId::Solve, Shape::Vector(model.size()), results).by(late_trace),
            self.function(FunctionId::DynamicResidual, residual).by(required_trace),
        ]
    }

    /// For implicit integration: structured stiffness and damping.
    fn step_matrices(&self) -> Vec<Function> {
        let model = &self.model;
        let [stiffness, damping] = self.forces().step_matrices();
        let base: Vec<usize> = model.chain.base.iter().flatten().map(|id| id.0).collect();
        let diagonal =
            |j: usize| [&stiffness, &damping].map(|m| if base.contains(&j) { model.zero() } else { m.at(j, j) });
        let joints = (0..model.size()).flat_map(diagonal).collect();
        let mut functions = vec![self.function(FunctionId::JointStiffnessAndDamping, joints)];
        if [Kind::Of(Group::Stops), Kind::Of(Group::Friction)].iter().any(|kind| kind.is_in(model.chain))
            || model.chain.has_limited_drives()
        {
            functions.push(self.function(
                FunctionId::NonlinearStiffnessAndDamping,
                self.forces().nonlinear().into_iter().flatten().collect(),
            ));
        }
        if !base.is_empty() {
            let block = |matrix: &SymmetricMatrix<'g>| {
                let entry = |i: usize, j: usize| match (base.get(i), base.get(j)) {
                    (Some(&i), Some(&j)) => matrix.at(i, j),
                    _ => model.zero(),
                };
                (0..6).flat_map(|i| (i..6).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect()
            };
            functions.push(self.function(FunctionId::BaseStiffness, block(&stiffness)));
            functions.push(self.function(FunctionId::BaseDamping, block(&damping)));
        }
        functions
    }

    fn transform_derivatives(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let (second_shape, second) = transforms::second_derivatives(model, kinematics);
        vec![
            self.function(FunctionId::TransformDerivatives, transforms::derivatives(model, kinematics)),
            shaped(FunctionId::TransformSecondDerivatives, second_shape, second),
        ]
    }

    /// A function whose shape follows from the table and the counts of the chain.
    fn function(&self, id: FunctionId, outputs: Vec<Expr<'_>>) -> Function {
        shaped(id, shape(self.model.chain, id.extent()), outputs)
    }
}

/// The shape of a result.
///
/// # Panics
/// If it does not follow from the counts of the chain.
fn shape(chain: &Chain, extent: Extent) -> Shape {
    let n = chain.coordinates.len();
    match extent {
        Extent::Number => Shape::Scalar,
        Extent::Vector => Shape::Vector(n),
        Extent::Matrix => Shape::Symmetric(n),
        Extent::Base => Shape::Base,
        Extent::List(Item::Vector, count) => Shape::Vectors(chain.count(count)),
        Extent::List(Item::Pair, count) => Shape::Pairs(chain.count(count)),
        Extent::List(Item::Row, count) => Shape::Rows { count: chain.count(count), n },
        Extent::List(Item::Tension, count) => Shape::Structs(Struct::Tension, chain.count(count)),
        Extent::List(Item::Wrench, count) => Shape::Structs(Struct::Wrench, chain.count(count)),
        Extent::List(Item::Moduli, count) => Shape::Structs(Struct::SectionModuli, chain.count(count)),
        Extent::List(Item::Transform, Count::Derivatives) => {
            let counts = (0..chain.bodies.len()).map(|body| chain.degrees_of_freedom(BodyId(body))).collect();
            Shape::Transforms { counts, corner: 0 }
        }
        Extent::List(Item::Transform, count) => Shape::Transforms { counts: vec![1; chain.count(count)], corner: 1 },
        Extent::Other => unreachable!("such functions state their shapes"),
    }
}

/// A function of another shape.
fn shaped(id: FunctionId, shape: Shape, outputs: Vec<Expr<'_>>) -> Function {
    assert_eq!(shape.len(), outputs.len(), "{id:?}");
    let outputs = outputs.into_iter().map(Expr::id).collect();
    let (doc, equation, arguments) = (id.doc(), id.equation(), id.arguments().to_vec());
    Function { id, product: None, doc, equation, arguments, shape, outputs, trace: SweepTrace::default() }
}

/// Mass and length of every body.
fn body_sizes<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let size = |body: &Body| {
        let mass = body.inertia.as_ref().map_or(model.zero(), |inertia| model.number(&inertia.mass));
        [mass, model.number(&body.length)]
    };
    model.chain.bodies.iter().flat_map(size).collect()
}

/// Where the sections of a beam are, and its length.
fn section_places<'g>(model: &Model<'g>, beam: &Beam) -> Vec<Expr<'g>> {
    let elements = model.chain.bodies.iter().filter(|body| body.link == beam.link);
    let length = elements.fold(model.zero(), |length, body| length + model.number(&body.length));
    let place = |section: &Section| match &section.slides {
        None => model.number(&section.x),
        Some(sliding) => pads::place_on_beam(model, sliding),
    };
    beam.sections.iter().flat_map(|section| [place(section), length]).collect()
}
