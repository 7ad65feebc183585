//! The functions of a crane: signatures, documentation, and what is left out.

mod drive_efforts;
mod energies;
mod forces;
mod internal_forces;
mod loop_joints;
mod statics;

use crate::chain::{Analyses, BodyId, Chain, Group};
use crate::program::Argument::{
    self, AddedInertia, BaseAddedInertia, Factors, Position, RightHandSide, Time, Velocity,
};
use crate::program::{Function, FunctionId, Program, Shape, Symbol};
use crate::symbolic::{Expr, Graph, Stages, SweepTrace, SymbolId};

use super::articulated::Effort;
use super::columns::columns;
use super::factors::{Factor, factors};
use super::forces::{Forces, Kind};
use super::forward::{self, ForwardInputs, Motion};
use super::inertia::Inertias;
use super::kinematics::Kinematics;
use super::model::Model;
use super::twist::{Twist, twists};
use super::vector::{SymmetricMatrix, Vec3};
use super::{cylinders, drives, effective_mass, energy, newton_euler, points, rotors, transforms};

/// Derives all functions over one graph.
pub fn program(graph: Graph, chain: &Chain, analyses: Analyses) -> Program {
    let mut symbols = Model::symbols(chain);
    let functions = Derivation::new(&graph, chain).functions(analyses, &mut symbols);
    Program::new(graph, symbols, functions)
}

/// A model with the expressions that several functions share.
struct Derivation<'g> {
    model: Model<'g>,
    factors: Vec<Factor<'g>>,
    kinematics: Kinematics<'g>,
    inertias: Inertias<'g>,
    twists: Vec<Twist<'g>>,
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
        Derivation { model, factors, kinematics, inertias, twists, rigid }
    }

    fn functions(&self, analyses: Analyses, symbols: &mut Vec<Symbol>) -> Vec<Function> {
        let mut functions = self.poses();
        functions.extend(self.force_functions());
        functions.extend(self.loop_joints());
        functions.extend(self.energies());
        if analyses.dynamics {
            functions.extend(self.dynamics());
            functions.extend(self.implicit(symbols));
        }
        if analyses.statics {
            functions.extend(self.statics());
        }
        if analyses.modes {
            functions.push(self.linearise());
        }
        if analyses.internal_forces {
            functions.extend(self.internal_forces());
        }
        if analyses.derivatives {
            functions.extend(self.transform_derivatives());
        }
        functions
    }

    /// All forces except those of rigid drives.
    fn forces(&self) -> Forces<'_, 'g> {
        Forces::new(&self.model, &self.kinematics)
    }

    fn poses(&self) -> Vec<Function> {
        let chain = self.model.chain;
        let mut functions = vec![function(
            FunctionId::Transforms,
            "Transforms T of all bodies into the world frame; translations in m.",
            "T(p) = T(p−1) T̃(p) [Urbaś 2016, Eq. (3)]",
            &[Position],
            Shape::Transforms { counts: vec![1; chain.bodies.len()], corner: 1 },
            transforms::transforms(&self.kinematics),
        )];
        if !chain.points.is_empty() {
            let shape = || Shape::Vectors(chain.points.len());
            functions.push(function(
                FunctionId::Points,
                "Positions of the points of interest in the world frame, m.",
                "T(p) r",
                &[Position],
                shape(),
                points::positions(&self.model, &self.kinematics),
            ));
            functions.push(function(
                FunctionId::PointVelocities,
                "Velocities of the points of interest in the world frame, m/s.",
                "Ṫ(p) r = ω × x + υ",
                &[Position, Velocity],
                shape(),
                points::velocities(&self.model, &self.kinematics, &self.twists),
            ));
        }
        if !chain.cylinders.is_empty() {
            functions.push(function(
                FunctionId::CylinderStates,
                "Length of every cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate, m/rad or m/m.",
                "ℓ, ℓ̇, ∂ℓ/∂q_j",
                &[Position, Velocity],
                Shape::Vectors(chain.cylinders.len()),
                cylinders::states(&self.model),
            ));
        }
        if chain.has_valves() {
            functions.push(function(
                FunctionId::CylinderJacobians,
                "Derivatives of the length of every cylinder with respect to the coordinates, m/m and m/rad.",
                "∂ℓ/∂q",
                &[Position],
                Shape::Rows { count: chain.cylinders.len(), n: self.model.size() },
                cylinders::jacobians(&self.model),
            ));
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
        let (rest, still) = (model.zeros(), drives::at_rest(model));
        let at_rest = DynamicsInputs {
            v: &rest,
            forces: &model.right_hand_side,
            prescribed: &still,
            gravity: Vec3::zero(model.graph),
        };
        let (solution, solution_trace) = model.graph.recorded(|| self.hybrid_dynamics(&at_rest).accelerations);
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
        vec![
            function(
                FunctionId::ForwardDynamics,
                "Accelerations q̈, m/s² and rad/s².",
                "A q̈ = e + f [Urbaś 2016, Eq. (23)], by articulated bodies",
                &[Time, Position, Velocity],
                Shape::Vector(model.size()),
                accelerations,
            )
            .by(trace),
            function(
                FunctionId::SolveMass,
                "Solution x of `A x = r`; r in N and N m, x in m/s² and rad/s².",
                "A x = r, by articulated bodies at rest",
                &[Position, RightHandSide],
                Shape::Vector(model.size()),
                solution,
            )
            .by(solution_trace),
            function(
                FunctionId::MassMatrix,
                "Mass matrix A; kg, kg m and kg m².",
                "a_ij = tr(Ω_i W_max(i,j) Ω_jᵀ) [Urbaś 2016, Eq. (5)]",
                &[Position],
                mass_shape,
                mass,
            )
            .by(mass_trace.clone()),
            function(
                FunctionId::MassMatrixAndBias,
                "Mass matrix A, its lower triangle, and bias e; kg, kg m, kg m², N, N m.",
                "A, e [Urbaś 2016, Eqs. (5), (9)]",
                &[Position, Velocity],
                both_shape,
                both,
            )
            .by(mass_trace.then(bias_trace.clone())),
            function(
                FunctionId::Bias,
                "Bias e: velocity and gravity forces, N and N m.",
                "e = −(h + g), h_i + g_i = tr(Ω_i Σ T H B̄ᵀ) [Urbaś 2016, Eqs. (5), (7), (9)]",
                &[Position, Velocity],
                Shape::Vector(model.size()),
                bias,
            )
            .by(bias_trace),
            function(
                FunctionId::KineticEnergy,
                "Kinetic energy, J.",
                "E_k = ½ Σ tr(Ṫ H Ṫᵀ) [Urbaś 2016, Eq. (4)]",
                &[Position, Velocity],
                Shape::Scalar,
                vec![energy::kinetic_energy(model, &self.inertias, &self.twists)],
            ),
        ]
    }

    /// Accelerations, and efforts of rigid drives, at the present state.
    fn motion(&self) -> Motion<'g> {
        let model = &self.model;
        let forces = self.forces().all();
        let prescribed = drives::accelerations(model);
        let gravity = model.vector(&model.chain.gravity);
        self.hybrid_dynamics(&DynamicsInputs { v: &model.v, forces: &forces, prescribed: &prescribed, gravity })
    }

    /// The motion of the chain, including rotors.
    fn hybrid_dynamics(&self, inputs: &DynamicsInputs<'_, 'g>) -> Motion<'g> {
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

    /// Functions for implicit integration: structured stiffness and damping, and systems with them.
    fn implicit(&self, symbols: &mut Vec<Symbol>) -> Vec<Function> {
        let model = &self.model;
        let solve = || effective_mass::solution(model, &self.kinematics, &self.factors);
        let (solution, trace) = model.graph.recorded(solve);
        let first = SymbolId(u32::try_from(symbols.len()).expect("fewer than 2^32 inputs"));
        let late =
            |SymbolId(id): SymbolId| symbols.get(id as usize).is_some_and(|symbol| symbol.argument == RightHandSide);
        let Stages { factors, results, trace: late_trace } = model.graph.stages(&solution, &trace, late, first);
        symbols.extend((0..factors.len()).map(|index| Symbol {
            name: format!("f{index:03}"),
            argument: Factors,
            index,
        }));
        let mut functions = vec![
            function(
                FunctionId::Factorise,
                "Factors of `A + D̂` for [`solve`]: D̂ has `added_inertia` on its diagonal, and `base` in the base's rows and columns.",
                "A + D̂, by articulated bodies at rest",
                &[Position, AddedInertia, BaseAddedInertia],
                Shape::Factors(factors.len()),
                factors,
            )
            .by(trace),
            function(
                FunctionId::Solve,
                "Solution x of `(A + D̂) x = r` from the factors of `A + D̂`.",
                "(A + D̂) x = r",
                &[Factors, RightHandSide],
                Shape::Vector(model.size()),
                results,
            )
            .by(late_trace),
        ];
        let [stiffness, damping] = self.forces().step_matrices();
        let base: Vec<usize> = model.chain.base.iter().flatten().map(|id| id.0).collect();
        let diagonal =
            |j: usize| [&stiffness, &damping].map(|m| if base.contains(&j) { model.zero() } else { m.at(j, j) });
        functions.push(function(
            FunctionId::JointStiffnessAndDamping,
            "Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) on single coordinates, without those of the base.",
            "s, d [Urbaś 2016, Eqs. (14), (19)]",
            &[],
            Shape::Pairs(model.size()),
            (0..model.size()).flat_map(diagonal).collect(),
        ));
        if [Kind::Of(Group::Stops), Kind::Of(Group::Friction)].iter().any(|kind| kind.is_in(model.chain))
            || model.chain.has_limited_drives()
        {
            functions.push(function(
                FunctionId::NonlinearStiffnessAndDamping,
                "Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) of end stops and friction on single coordinates.",
                "∂F/∂q, max(0, ∂F/∂q̇)",
                &[Time, Position, Velocity],
                Shape::Pairs(model.size()),
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
            for (id, doc, matrix) in [
                (
                    FunctionId::BaseStiffness,
                    "Stiffness of supports and drives over the base's coordinates; N/m, N and N m.",
                    &stiffness,
                ),
                (
                    FunctionId::BaseDamping,
                    "Damping of supports, drives and joints over the base's coordinates; N s/m, N s and N m s.",
                    &damping,
                ),
            ] {
                functions.push(function(
                    id,
                    doc,
                    "Σ Jᵀ diag(s, d) J [Urbaś 2016, Eq. (18)]",
                    &[Position, Velocity],
                    Shape::Base,
                    block(matrix),
                ));
            }
        }
        functions
    }

    fn transform_derivatives(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let counts = (0..model.chain.bodies.len()).map(|p| model.chain.degrees_of_freedom(BodyId(p))).collect();
        let (second_shape, second) = transforms::second_derivatives(model, kinematics);
        vec![
            function(
                FunctionId::TransformDerivatives,
                "Derivatives ∂T/∂q_j of every body, for all coordinates j that move it; 1, m, 1/m.",
                "∂T/∂q_j = Ω_j T",
                &[Position],
                Shape::Transforms { counts, corner: 0 },
                transforms::derivatives(model, kinematics),
            ),
            function(
                FunctionId::TransformSecondDerivatives,
                "Second derivatives ∂²T/∂q_m∂q_n of every body, for all pairs m ≤ n of the coordinates that move it.",
                "∂²T/∂q_m∂q_n = Ω_m Ω_n T",
                &[Position],
                second_shape,
                second,
            ),
        ]
    }
}

fn function(
    id: FunctionId,
    doc: &'static str,
    equation: &'static str,
    arguments: &'static [Argument],
    shape: Shape,
    outputs: Vec<Expr<'_>>,
) -> Function {
    assert_eq!(shape.len(), outputs.len(), "{id:?}");
    let outputs = outputs.into_iter().map(Expr::id).collect();
    Function { id, doc, equation, arguments, shape, outputs, trace: SweepTrace::default() }
}
