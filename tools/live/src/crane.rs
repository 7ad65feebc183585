//! A crane from a chain that implements the traits of all algorithms.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crane_codegen::chain::{Chain, Input};
use crane_codegen::program::{FunctionId, Shape};
use crane_codegen::{Diagnostics, SourceFile, compile};
use crane_model::dyn_crane::{
    DynBlock, DynCrane, DynDerivatives, DynDynamics, DynEnsemble, DynImplicit, DynInternalForces, DynLinearise,
    DynModel, DynStatics, DynSystem,
};
use crane_model::nalgebra::{Matrix4, Matrix6, Vector3};
use crane_model::rt::lanes::f64x8;
use crane_model::{Description, ParameterError, SectionModuli, Tension, Wrench};

use crate::closing::{mass_matrix, second_derivatives};
use crate::describe::{describe, refusal};
use crate::library::Library;
use crate::machine::{Arguments, Machine};
use crate::routine::Routine;

/// A crane of any number of coordinates that is ready without rustc.
///
/// Functions are derived when they are first called. Clones share them, and have their own parameters.
pub struct LiveCrane {
    library: Arc<Library>,
    description: Description,
    parameters: Vec<f64>,
    /// Of every input its value while it is set, else 0; and 0 while it is set, else 1.
    inputs: Vec<f64>,
    /// Room for a call of every function, kept from the last; cranes that differ in their inputs alone share it.
    rooms: Arc<[Mutex<Option<Room>>; FunctionId::ALL.len()]>,
}

/// What a call of a function needs besides its arguments.
struct Room {
    machine: Machine<f64>,
    /// For results that are copied to other positions.
    results: Vec<f64>,
}

impl LiveCrane {
    /// Coordinates of the largest crane whose functions fit into the registers: `solve` takes 49,144 of 65,536 at 3,013.
    pub const MOST_COORDINATES: usize = 3000;

    /// The crane of a spec.
    ///
    /// # Errors
    /// All mistakes of the spec at once.
    pub fn from_spec(source: &SourceFile) -> Result<Self, Diagnostics> {
        compile::load(source).map(Self::new)
    }

    /// The crane of a chain, with the parameters of its spec.
    #[must_use]
    pub fn new(chain: Chain) -> Self {
        let (description, parameters) = (describe(&chain), chain.parameter_defaults());
        let inputs = not_set(&chain);
        Self { library: Arc::new(Library::new(chain)), description, parameters, inputs, rooms: no_rooms() }
    }

    /// The chain from which it was made.
    #[must_use]
    pub fn chain(&self) -> &Chain {
        self.library.chain()
    }

    /// Calls a function and passes on its results; nothing if the crane does not need it.
    fn call<R>(
        &self,
        id: FunctionId,
        arguments: &Arguments<'_, f64>,
        show: impl FnOnce(&Routine, &mut [f64]) -> R,
    ) -> Option<R> {
        let routine = self.library.routine(id)?;
        let place = &self.rooms[id as usize];
        let kept = place.lock().unwrap_or_else(PoisonError::into_inner).take();
        let mut room = kept.unwrap_or_else(|| self.room(routine));
        routine.run(&mut room.machine, &Arguments { inputs: &self.inputs, ..*arguments }, &mut room.results);
        let shown = show(routine, &mut room.results);
        *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(room);
        Some(shown)
    }

    /// The live parameters, in the order of the description.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// The inputs: of each its value while it is set, else 0; and 0 while it is set, else 1.
    pub(crate) fn inputs(&self) -> &[f64] {
        &self.inputs
    }

    /// The same crane with other inputs, in the order of the description: what is not set is as the spec says. Nothing is computed
    /// again, and the rooms are shared.
    #[must_use]
    pub fn with_inputs(&self, values: &[Option<f64>]) -> Self {
        let mut inputs = not_set(self.chain());
        for (slots, value) in inputs.chunks_mut(Input::SLOTS).zip(values) {
            set(slots, *value);
        }
        let Self { library, description, parameters, rooms, .. } = self;
        Self {
            library: Arc::clone(library),
            description: description.clone(),
            parameters: parameters.clone(),
            inputs,
            rooms: Arc::clone(rooms),
        }
    }

    /// Its functions, which all its clones share.
    pub(crate) fn library(&self) -> Arc<Library> {
        Arc::clone(&self.library)
    }

    /// Whether all parameters together may have these values.
    ///
    /// # Errors
    /// The rule of the spec language that they break.
    pub fn check(&self, parameters: &[f64]) -> Result<(), ParameterError> {
        for (info, value) in self.description.parameters.iter().zip(parameters) {
            info.check(*value)?;
        }
        match self.chain().broken_relation(parameters) {
            Some(relation) => Err(ParameterError { given: None, refusal: refusal(&relation.refusal) }),
            None => Ok(()),
        }
    }

    /// All parameters, of which the first have these values.
    fn with_first(&self, values: &[f64]) -> Result<Vec<f64>, ParameterError> {
        let mut parameters = self.parameters.clone();
        copy(values, &mut parameters);
        self.check(&parameters)?;
        Ok(parameters)
    }

    fn room(&self, routine: &Routine) -> Room {
        Room { machine: routine.machine(&self.parameters), results: vec![0.0; routine.results()] }
    }

    fn scalar(&self, id: FunctionId, arguments: &Arguments<'_, f64>) -> f64 {
        self.call(id, arguments, |_, results| results.first().copied().unwrap_or(0.0)).unwrap_or(0.0)
    }

    fn numbers(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [f64]) {
        let called = self.call(id, arguments, |_, results| copy(results, out));
        if called.is_none() {
            out.fill(0.0);
        }
    }

    fn vectors(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [Vector3<f64>]) {
        let vector = |vector: &[f64; 3]| Vector3::from(*vector);
        let called = self.call(id, arguments, |_, results| copy_as(results.as_chunks().0, vector, out));
        if called.is_none() {
            out.fill(Vector3::zeros());
        }
    }

    fn pairs(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [[f64; 2]]) {
        let called = self.call(id, arguments, |_, results| copy_as(results.as_chunks().0, |pair| *pair, out));
        if called.is_none() {
            out.fill([0.0; 2]);
        }
    }

    fn matrices(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [Matrix4<f64>]) {
        let called = self.call(id, arguments, |_, results| {
            copy_as(results.as_chunks::<16>().0, |matrix| Matrix4::from_column_slice(matrix), out);
        });
        if called.is_none() {
            out.fill(Matrix4::zeros());
        }
    }

    fn over_the_base(&self, id: FunctionId, q: &[f64], v: &[f64]) -> Matrix6<f64> {
        self.call(id, &state(0.0, q, v), |_, results| Matrix6::from_column_slice(results)).unwrap_or_default()
    }
}

fn no_rooms() -> Arc<[Mutex<Option<Room>>; FunctionId::ALL.len()]> {
    Arc::new(std::array::from_fn(|_| Mutex::new(None)))
}

/// Inputs of which none is set.
fn not_set(chain: &Chain) -> Vec<f64> {
    chain.inputs.iter().flat_map(|_| Input::NOT_SET).collect()
}

/// Sets the numbers of an input, or gives it back to its spec.
fn set(slots: &mut [f64], value: Option<f64>) {
    slots.copy_from_slice(&value.map_or(Input::NOT_SET, |value| [value, 0.0]));
}

fn copy(results: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(results).for_each(|(place, result)| *place = *result);
}

fn copy_as<T, R>(results: &[T], as_is: impl Fn(&T) -> R, out: &mut [R]) {
    out.iter_mut().zip(results).for_each(|(place, result)| *place = as_is(result));
}

/// A pose.
fn at(q: &[f64]) -> Arguments<'_, f64> {
    Arguments { q, ..Arguments::none() }
}

/// A state.
fn state<'a>(t: f64, q: &'a [f64], v: &'a [f64]) -> Arguments<'a, f64> {
    Arguments { t, q, v, ..Arguments::none() }
}

impl Clone for LiveCrane {
    fn clone(&self) -> Self {
        Self {
            library: Arc::clone(&self.library),
            description: self.description.clone(),
            parameters: self.parameters.clone(),
            inputs: self.inputs.clone(),
            rooms: no_rooms(),
        }
    }
}

impl fmt::Debug for LiveCrane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = f.debug_struct("LiveCrane");
        debug.field("name", &self.description.name).field("parameters", &self.parameters).finish_non_exhaustive()
    }
}

impl DynModel for LiveCrane {
    fn description(&self) -> &Description {
        &self.description
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index).copied().unwrap_or(f64::NAN)
    }

    fn input(&self, index: usize) -> Option<f64> {
        let slots = self.inputs.get(Input::SLOTS * index..)?;
        slots.first_chunk().and_then(|[value, free]| (*free == 0.0).then_some(*value))
    }

    fn transforms(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.matrices(FunctionId::Transforms, &at(q), out);
    }

    fn points(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::Points, &at(q), out);
    }

    fn point_velocities(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::PointVelocities, &state(0.0, q, v), out);
    }

    fn forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::Forces, &state(t, q, v), out);
    }

    fn element_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ElementForces, &state(0.0, q, v), out);
    }

    fn drive_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::DriveForces, &state(t, q, v), out);
    }

    fn stop_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::StopForces, &state(0.0, q, v), out);
    }

    fn friction_forces(&self, v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::FrictionForces, &state(0.0, &[], v), out);
    }

    fn load_forces(&self, t: f64, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::LoadForces, &state(t, q, &[]), out);
    }

    fn connector_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorForces, &state(t, q, v), out);
    }

    fn connector_forces_at_rest(&self, t: f64, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorForcesAtRest, &state(t, q, &[]), out);
    }

    fn connector_lengths(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::ConnectorLengths, &state(0.0, q, v), out);
    }

    fn connector_tensions(&self, t: f64, q: &[f64], v: &[f64], out: &mut [Tension]) {
        self.call(FunctionId::ConnectorTensions, &state(t, q, v), |_, results| {
            let tension = |&[force, stiffness, damping]: &[f64; 3]| Tension { force, stiffness, damping };
            copy_as(results.as_chunks().0, tension, out);
        });
    }

    fn connector_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorJacobians, &at(q), out);
    }

    fn winch_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::WinchPieces, &Arguments::none(), out);
    }

    fn load_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::LoadPieces, &Arguments::none(), out);
    }

    fn support_reactions(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::SupportReactions, &state(0.0, q, v), out);
    }

    fn support_gaps(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::SupportGaps, &state(0.0, q, v), out);
    }

    fn cylinder_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::CylinderStates, &state(0.0, q, v), out);
    }

    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DriveMotions, &Arguments { t, ..Arguments::none() }, out);
    }

    fn drive_limits(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DriveLimits, &state(t, q, v), out);
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.call(FunctionId::PrescribedMotions, &Arguments { t, ..Arguments::none() }, |_, results| {
            for (drive, [position, rate]) in self.chain().rigid_drives().zip(results.as_chunks().0) {
                (q[drive.coordinate.0], v[drive.coordinate.0]) = (*position, *rate);
            }
        });
    }

    fn valve_openings(&self, t: f64, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::ValveOpenings, &Arguments { t, ..Arguments::none() }, out);
    }

    fn drive_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DrivePieces, &Arguments::none(), out);
    }

    fn gravity_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::GravityEnergy, &at(q))
    }

    fn support_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::SupportEnergy, &at(q))
    }

    fn element_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::ElementEnergy, &at(q))
    }

    fn drive_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.scalar(FunctionId::DriveEnergy, &Arguments { t, ..at(q) })
    }

    fn stop_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::StopEnergy, &at(q))
    }

    fn drive_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::DrivePower, &state(t, q, v))
    }

    fn connector_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.scalar(FunctionId::ConnectorEnergy, &state(t, q, &[]))
    }

    fn winch_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::WinchPower, &state(t, q, v))
    }

    fn load_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::LoadPower, &state(t, q, v))
    }

    fn dissipation(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::Dissipation, &state(t, q, v))
    }
}

impl DynStatics for LiveCrane {
    fn static_residual(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::StaticResidual, &at(q), out);
    }

    fn tangent_stiffness(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::TangentStiffness, &at(q), out);
    }

    fn connector_stiffness(&self, t: f64, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorStiffness, &state(t, q, &[]), out);
    }

    fn drive_forces_at_rest(&self, q: &[f64], out: &mut [f64]) {
        if self.call(FunctionId::DriveForcesAtRest, &at(q), |_, results| copy(results, out)).is_none() {
            // At the rates of the motions the dampers are unloaded.
            let (mut v, mut motions) = (vec![0.0; q.len()], vec![[0.0; 2]; self.description.drives.len()]);
            self.drive_motions(0.0, &mut motions);
            for (drive, [_, rate]) in self.description.drives.iter().zip(motions) {
                v[drive.coordinate] = rate;
            }
            self.drive_forces(0.0, q, &v, out);
        }
    }
}

impl DynDynamics for LiveCrane {
    fn mass_matrix(&self, q: &[f64], out: &mut [f64]) {
        self.call(FunctionId::MassMatrix, &at(q), |routine, results| match routine.shape() {
            Shape::Columns { points, .. } => mass_matrix(points, results, out),
            _ => copy(results, out),
        });
    }

    fn bias(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::Bias, &state(0.0, q, v), out);
    }

    fn forward_dynamics(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ForwardDynamics, &state(t, q, v), out);
    }

    fn solve_mass(&self, q: &[f64], r: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::SolveMass, &Arguments { right: r, ..at(q) }, out);
    }

    fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::KineticEnergy, &state(0.0, q, v))
    }
}

impl DynImplicit for LiveCrane {
    fn system(&self) -> Box<dyn DynSystem + '_> {
        let ready = |id: FunctionId| {
            let routine = self.library.routine(id)?;
            Some((routine, routine.machine(&self.parameters)))
        };
        let factors = self.library.routine(FunctionId::Factorise).map_or(0, Routine::results);
        Box::new(System {
            factorise: ready(FunctionId::Factorise),
            solve: ready(FunctionId::Solve),
            factors: vec![f64::NAN; factors],
        })
    }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::JointStiffnessAndDamping, &Arguments::none(), out);
    }

    fn nonlinear_stiffness_and_damping(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::NonlinearStiffnessAndDamping, &state(t, q, v), out);
    }

    fn base_stiffness(&self, q: &[f64], v: &[f64]) -> Matrix6<f64> {
        self.over_the_base(FunctionId::BaseStiffness, q, v)
    }

    fn base_damping(&self, q: &[f64], v: &[f64]) -> Matrix6<f64> {
        self.over_the_base(FunctionId::BaseDamping, q, v)
    }
}

/// A function and room for its calls.
type Ready<'a, T> = Option<(&'a Routine, Machine<T>)>;

/// Systems with the factors of the last one.
struct System<'a> {
    factorise: Ready<'a, f64>,
    solve: Ready<'a, f64>,
    factors: Vec<f64>,
}

impl DynSystem for System<'_> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &Matrix6<f64>) {
        if let Some((routine, machine)) = &mut self.factorise {
            let arguments = Arguments { added_inertia, base: base.as_slice(), ..at(q) };
            routine.run(machine, &arguments, &mut self.factors);
        }
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        if let Some((routine, machine)) = &mut self.solve {
            routine.run(machine, &Arguments { factors: &self.factors, right: r, ..Arguments::none() }, out);
        }
    }
}

impl DynLinearise for LiveCrane {
    fn linearise(&self, q: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]) {
        self.call(FunctionId::Linearise, &at(q), |_, results| {
            let mut rest: &[f64] = results;
            for matrix in [mass, stiffness, damping] {
                let (own, others) = rest.split_at(matrix.len().min(rest.len()));
                copy(own, matrix);
                rest = others;
            }
        });
    }
}

impl DynInternalForces for LiveCrane {
    fn internal_forces(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [Wrench]) {
        self.call(FunctionId::InternalForces, &Arguments { a, ..state(t, q, v) }, |_, results| {
            let wrench = |[fx, fy, fz, mx, my, mz]: &[f64; 6]| Wrench {
                force: Vector3::new(*fx, *fy, *fz),
                moment: Vector3::new(*mx, *my, *mz),
            };
            copy_as(results.as_chunks().0, wrench, out);
        });
    }

    fn section_moduli(&self, out: &mut [SectionModuli]) {
        self.call(FunctionId::SectionModuli, &Arguments::none(), |_, results| {
            let moduli = |numbers: &[f64; 8]| {
                let [area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress] = *numbers;
                SectionModuli { area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress }
            };
            copy_as(results.as_chunks().0, moduli, out);
        });
    }

    fn support_positions(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::SupportPositions, &at(q), out);
    }
}

impl DynEnsemble for LiveCrane {
    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        let lanes = parameters.iter().map(|values| self.with_first(values)).collect::<Result<Vec<_>, _>>()?;
        // Unused lanes are copies of this crane.
        let of = |lane: usize| lanes.get(lane).unwrap_or(&self.parameters);
        let eight = |index: usize| f64x8::new(std::array::from_fn(|lane| of(lane)[index]));
        let parameters: Vec<f64x8> = (0..self.parameters.len()).map(eight).collect();
        let routine = self.library.routine(FunctionId::ForwardDynamics);
        Ok(Box::new(Block {
            ready: routine.map(|routine| (routine, routine.machine(&parameters))),
            inputs: self.inputs.iter().map(|slot| f64x8::splat(*slot)).collect(),
        }))
    }
}

/// Eight cranes.
struct Block<'a> {
    ready: Ready<'a, f64x8>,
    inputs: Vec<f64x8>,
}

impl DynBlock for Block<'_> {
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]) {
        if let Some((routine, machine)) = &mut self.ready {
            let arguments = Arguments { t: f64x8::splat(t), q, v, inputs: &self.inputs, ..Arguments::none() };
            routine.run(machine, &arguments, out);
        }
    }
}

impl DynDerivatives for LiveCrane {
    fn transform_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.matrices(FunctionId::TransformDerivatives, &at(q), out);
    }

    fn transform_second_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.call(FunctionId::TransformSecondDerivatives, &at(q), |routine, results| match routine.shape() {
            Shape::TransformFactors { degrees, rotations, vectors } => {
                second_derivatives(degrees, rotations.len(), vectors, results, out);
            }
            _ => copy_as(results.as_chunks::<16>().0, |matrix| Matrix4::from_column_slice(matrix), out),
        });
    }
}

impl DynCrane for LiveCrane {
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        let mut values = self.parameters.clone();
        if let Some(parameter) = values.get_mut(index) {
            *parameter = value;
        }
        self.set_parameters(&values)
    }

    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        self.parameters = self.with_first(values)?;
        // The workspaces contain constants computed from parameters.
        self.rooms = no_rooms();
        Ok(())
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) {
        if let Some(slots) = self.inputs.chunks_mut(Input::SLOTS).nth(index) {
            set(slots, value);
        }
    }

    fn boxed_clone(&self) -> Box<dyn DynCrane> {
        Box::new(self.clone())
    }
}
