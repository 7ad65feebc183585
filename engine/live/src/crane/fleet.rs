//! Eight cranes as one.

use std::sync::{Mutex, PoisonError};

use crane_codegen::chain::Input;
use crane_codegen::program::{Extent, FunctionId, Item};
use crane_model::dyn_crane::{DynBlock, DynCrane, DynSystem};
use crane_model::nalgebra::Matrix4;
use crane_model::rt::lanes::f64x8;
use crane_model::{Description, Entry, LoopJointInfo, ParameterError, StageInfo, entry_type, slice_argument};
use crane_quantities::{Count, Part, quantities};
use wide::bytemuck::{cast_slice, cast_slice_mut};

use super::LiveCrane;
use super::methods::{method, methods};
use crate::inputs::{is_free, slots_of};
use crate::machine::{Arguments, Batch, Machine};
use crate::routine::Routine;

/// Number of cranes.
const CRANES: usize = <f64x8 as Batch>::LANES;

/// Eight cranes as one, the same number of each next to each other.
pub(super) struct Fleet {
    /// The functions of all, and what is not of a fleet.
    crane: LiveCrane,
    description: Description,
    loop_joints: Vec<LoopJointInfo>,
    /// The live parameters and the numbers of the inputs.
    parameters: Vec<f64x8>,
    inputs: Vec<f64x8>,
    /// Workspaces for calls.
    rooms: [Mutex<Option<Room>>; FunctionId::ALL.len()],
}

/// What a call of a function needs.
struct Room {
    machine: Machine<f64x8>,
    given: Given,
    results: Vec<f64x8>,
}

/// Arguments, as vectors.
#[derive(Default)]
struct Given([Vec<f64x8>; 8]);

impl Given {
    /// Takes arguments apart from live parameters and inputs.
    fn take<'g>(&'g mut self, arguments: &Arguments<'_, f64>, inputs: &'g [f64x8]) -> Arguments<'g, f64x8> {
        let &Arguments { t, q, v, a, r, positions, added_inertia, base, factors, .. } = arguments;
        for (vectors, numbers) in self.0.iter_mut().zip([q, v, a, r, positions, added_inertia, base, factors]) {
            vectors.resize(numbers.len() / CRANES, f64x8::splat(0.0));
            cast_slice_mut(vectors).copy_from_slice(numbers);
        }
        let [q, v, a, r, positions, added_inertia, base, factors] = self.0.each_ref().map(Vec::as_slice);
        let t = f64x8::splat(t);
        Arguments { t, q, v, a, r, positions, added_inertia, base, factors, inputs, ..Arguments::none() }
    }
}

impl Fleet {
    /// Cranes which differ from one in their parameters and inputs, filled up with the last one.
    pub fn new(crane: &LiveCrane, cranes: &[&dyn DynCrane]) -> Self {
        let of = |lane: usize| cranes[lane.min(cranes.len() - 1)];
        let parameters = (0..crane.parameters.len()).map(|index| f64x8::from_lanes(|lane| of(lane).parameter(index)));
        let inputs = (0..crane.inputs.len()).flat_map(|index| {
            let slots: [_; CRANES] = std::array::from_fn(|lane| slots_of(of(lane).input(index)));
            (0..slots[0].len()).map(move |slot| f64x8::from_lanes(|lane| slots[lane][slot]))
        });
        Self {
            description: crane.description.of_fleet(CRANES),
            loop_joints: crane.loop_joints.iter().map(|joint| joint.of_fleet(CRANES)).collect(),
            parameters: parameters.collect(),
            inputs: inputs.collect(),
            crane: crane.clone(),
            rooms: no_rooms(),
        }
    }

    /// Calls a function and passes its results to `show`; `None` if the cranes do not need the function.
    fn call<R>(&self, id: FunctionId, arguments: &Arguments<'_, f64>, show: impl FnOnce(&[f64x8]) -> R) -> Option<R> {
        let routine = self.crane.library.routine(id)?;
        let mut room = self.rooms[id as usize].lock().unwrap_or_else(PoisonError::into_inner);
        let Room { machine, given, results } = room.get_or_insert_with(|| self.room(routine));
        routine.run(machine, &given.take(arguments, &self.inputs), results);
        Some(show(results))
    }

    fn room(&self, routine: &Routine) -> Room {
        let results = vec![f64x8::splat(0.0); routine.results()];
        Room { machine: routine.machine(&self.parameters), given: Given::default(), results }
    }

    /// The sum over all cranes.
    fn scalar(&self, id: FunctionId, arguments: &Arguments<'_, f64>) -> f64 {
        let sum = |results: &[f64x8]| results.first().map(|number| number.reduce_add());
        self.call(id, arguments, sum).flatten().unwrap_or(0.0)
    }

    /// Numbers of all cranes; NaN instead of matrices, whose sizes are other ones.
    fn numbers(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [f64]) {
        if id.extent() == Extent::Matrix {
            return out.fill(f64::NAN);
        }
        let called = self.call(id, arguments, |results| match cast_slice(results) {
            numbers if numbers.len() == out.len() => out.copy_from_slice(numbers),
            _ => out.fill(f64::NAN),
        });
        if called.is_none() {
            out.fill(0.0);
        }
    }

    /// A list, zeros if the cranes do not need the function.
    fn list<T: Entry>(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [T]) {
        let Description { drives, loads, connectors, .. } = &self.crane.description;
        let called = self.call(id, arguments, |results| match id.extent() {
            Extent::List(Item::Row, _) => {
                out.iter_mut().zip(cast_slice(results)).for_each(|(out, number)| *out = T::from_numbers(&[*number]));
            }
            Extent::List(_, Count::WinchPieces) => {
                spread(results, connectors.iter().map(|connector| connector.pieces), out);
            }
            Extent::List(_, Count::Attachments) => {
                let ends = self.crane.loop_joints.iter().map(|joint| joint.ends.iter().flatten().count());
                spread(results, connectors.iter().map(|connector| connector.points.len()).chain(ends), out);
            }
            Extent::List(_, Count::DrivePieces) => spread(results, drives.iter().map(|drive| drive.pieces), out),
            Extent::List(_, Count::LoadPieces) => spread(results, loads.iter().map(|load| load.pieces), out),
            _ => spread(results, std::iter::repeat(1), out),
        });
        if called.is_none() {
            out.fill(T::repeat(0.0));
        }
    }

    fn matrices(&self, id: FunctionId, arguments: &Arguments<'_, f64>, out: &mut [Matrix4<f64>]) {
        self.call(id, arguments, |results| match id {
            FunctionId::Transforms => spread(results, std::iter::repeat(1), out),
            _ => out.fill(Matrix4::repeat(f64::NAN)),
        });
    }
}

/// Takes a list for each crane apart: of each part of a crane, which has some items, those of the first crane come first.
fn spread<T: Entry>(results: &[f64x8], parts: impl Iterator<Item = usize>, out: &mut [T]) {
    let mut first = 0;
    for count in parts {
        let items = results.get(first * T::LEN..(first + count) * T::LEN);
        let places = out.get_mut(CRANES * first..CRANES * (first + count));
        let (Some(items), Some(places)) = (items, places) else { break };
        for (index, entry) in places.iter_mut().enumerate() {
            let mut numbers = [0.0; 16];
            let item = &items[index % count * T::LEN..][..T::LEN];
            numbers.iter_mut().zip(item).for_each(|(number, vector)| *number = vector.lane(index / count));
            *entry = T::from_numbers(&numbers);
        }
        first += count;
    }
}

impl DynCrane for Fleet {
    fn parts(&self) -> &[Part] {
        &[Part::Common, Part::Dynamics, Part::Systems, Part::StepMatrices, Part::Statics, Part::InternalForces]
    }

    fn description(&self) -> &Description {
        &self.description
    }

    fn cranes(&self) -> usize {
        CRANES
    }

    fn count(&self, count: Count) -> usize {
        CRANES * self.crane.count(count)
    }

    fn parents(&self) -> &[usize] {
        self.crane.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index / CRANES).map_or(f64::NAN, |values| values.lane(index % CRANES))
    }

    fn input(&self, index: usize) -> Option<f64> {
        let slots = self.inputs.as_chunks::<{ Input::SLOTS }>().0.get(index / CRANES)?;
        let slots = slots.map(|slot| slot.lane(index % CRANES));
        (!is_free(slots)).then_some(slots[0])
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        &self.loop_joints
    }

    fn stages(&self) -> &[StageInfo] {
        &[]
    }

    fn stage_height(&self, _: usize) -> f64 {
        0.0
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.call(FunctionId::PrescribedMotions, &Arguments { t, ..Arguments::none() }, |results| {
            for (drive, [position, rate]) in self.crane.chain().rigid_drives().zip(results.as_chunks().0) {
                let places = CRANES * drive.coordinate.0..CRANES * (drive.coordinate.0 + 1);
                q[places.clone()].copy_from_slice(position.as_array());
                v[places].copy_from_slice(rate.as_array());
            }
        });
    }

    fn system(&self) -> Box<dyn DynSystem + '_> {
        let ready = |id: FunctionId| {
            let routine = self.crane.library.routine(id)?;
            Some((routine, self.room(routine)))
        };
        let mut factorise = ready(FunctionId::Factorise);
        if let Some((_, Room { results, .. })) = &mut factorise {
            results.fill(f64x8::splat(f64::NAN));
        }
        Box::new(FleetSystem { factorise, solve: ready(FunctionId::Solve), version: 1 })
    }

    fn linearise(&self, _: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]) {
        for matrix in [mass, stiffness, damping] {
            matrix.fill(f64::NAN);
        }
    }

    fn block(&self, _: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        Ok(Box::new(Nothing))
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        let mut values = self.parameters.clone();
        if let Some(values) = values.get_mut(index / CRANES) {
            values.as_mut_array()[index % CRANES] = value;
        }
        self.set_parameters(cast_slice(&values))
    }

    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        let mut parameters = self.parameters.clone();
        cast_slice_mut(&mut parameters).iter_mut().zip(values).for_each(|(parameter, value)| *parameter = *value);
        for crane in 0..CRANES {
            let own: Vec<f64> = parameters.iter().map(|values| values.lane(crane)).collect();
            self.crane.check(&own)?;
        }
        self.parameters = parameters;
        self.rooms = no_rooms();
        Ok(())
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) {
        let slots = self.inputs.as_chunks_mut::<{ Input::SLOTS }>().0.get_mut(index / CRANES);
        for (slot, number) in slots.into_iter().flatten().zip(slots_of(value)) {
            slot.as_mut_array()[index % CRANES] = number;
        }
    }

    fn boxed_clone(&self) -> Box<dyn DynCrane> {
        let Self { crane, description, loop_joints, parameters, inputs, .. } = self;
        Box::new(Self {
            crane: crane.clone(),
            description: description.clone(),
            loop_joints: loop_joints.clone(),
            parameters: parameters.clone(),
            inputs: inputs.clone(),
            rooms: no_rooms(),
        })
    }

    fn dynamic_residual_derivatives(&self, _: f64, _: &[f64], _: &[f64], _: &[f64], out: &mut [f64]) {
        out.fill(f64::NAN);
    }

    fn inverse_mass_matrix(&self, _: &[f64], out: &mut [f64]) {
        out.fill(f64::NAN);
    }

    fn forward_dynamics_derivatives(&self, _: f64, _: &[f64], _: &[f64], out: &mut [f64]) {
        out.fill(f64::NAN);
    }

    quantities! { methods }
}

/// Linear systems of all cranes.
struct FleetSystem<'a> {
    factorise: Option<(&'a Routine, Room)>,
    solve: Option<(&'a Routine, Room)>,
    /// The number of the factors.
    version: u64,
}

impl DynSystem for FleetSystem<'_> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]) {
        if let Some((routine, Room { machine, given, results })) = &mut self.factorise {
            let arguments = Arguments { q, added_inertia, base, ..Arguments::none() };
            routine.run(machine, &given.take(&arguments, &[]), results);
            self.version += 1;
        }
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        if let Some((routine, Room { machine, given, results })) = &mut self.solve {
            let factors = self.factorise.as_ref().map_or(&[][..], |(_, room)| &room.results);
            let arguments = Arguments { r, ..Arguments::none() };
            let own = given.take(&arguments, &[]);
            routine.run(machine, &Arguments { factors, version: self.version, ..own }, results);
            out.copy_from_slice(cast_slice(results));
        }
    }
}

/// No cranes: their accelerations are NaN.
struct Nothing;

impl DynBlock for Nothing {
    fn forward_dynamics(&mut self, _: f64, _: &[f64x8], _: &[f64x8], out: &mut [f64x8]) {
        out.fill(f64x8::splat(f64::NAN));
    }
}

fn no_rooms() -> [Mutex<Option<Room>>; FunctionId::ALL.len()] {
    std::array::from_fn(|_| Mutex::new(None))
}
