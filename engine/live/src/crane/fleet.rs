//! Eight cranes as one.

use std::sync::{Mutex, PoisonError};

use crane_codegen::program::{Extent, FunctionId, Item};
use crane_model::dyn_crane::{Arguments, Derived, DynCrane, DynSystem, Functions};
use crane_model::rt::lanes::f64x8;
use crane_model::{Description, LoopJointInfo};
use crane_quantities::{Count, Part};
use wide::bytemuck::{cast_slice, cast_slice_mut};

use super::LiveCrane;
use super::evaluation::Evaluation;
use super::systems::LiveSystem;
use crate::inputs::slots_of;
use crate::machine::Batch;

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
    rooms: [Mutex<Option<Room>>; FunctionId::COUNT],
}

/// What a call of a function needs.
struct Room {
    evaluation: Evaluation<f64x8>,
    given: Given,
    results: Vec<f64x8>,
}

/// Arguments, as vectors.
#[derive(Default)]
struct Given([Vec<f64x8>; 5]);

impl Given {
    fn take(&mut self, arguments: &Arguments<'_>) -> Arguments<'_, f64x8> {
        let &Arguments { t, q, v, a, r, positions } = arguments;
        for (vectors, numbers) in self.0.iter_mut().zip([q, v, a, r, positions]) {
            take(numbers, vectors);
        }
        let [q, v, a, r, positions] = self.0.each_ref().map(Vec::as_slice);
        Arguments { t: f64x8::splat(t), q, v, a, r, positions }
    }
}

/// Numbers of all cranes, as vectors.
fn take(numbers: &[f64], vectors: &mut Vec<f64x8>) {
    vectors.resize(numbers.len() / CRANES, f64x8::splat(0.0));
    cast_slice_mut(vectors).copy_from_slice(numbers);
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
            rooms: std::array::from_fn(|_| Mutex::new(None)),
        }
    }

    /// Lends the workspace of a function.
    fn with_room<R>(&self, id: FunctionId, compute: impl FnOnce(&mut Room) -> R) -> R {
        let mut room = self.rooms[id as usize].lock().unwrap_or_else(PoisonError::into_inner);
        compute(room.get_or_insert_with(|| {
            let mut evaluation = Evaluation::new(&self.crane, id);
            evaluation.set_parameters(&self.parameters);
            evaluation.set_inputs(self.inputs.iter().copied());
            let results = vec![f64x8::splat(0.0); evaluation.width()];
            Room { evaluation, given: Given::default(), results }
        }))
    }

    /// Writes results for each crane apart.
    fn write(&self, id: FunctionId, results: &[f64x8], out: &mut [f64]) {
        let Description { drives, loads, connectors, .. } = &self.crane.description;
        match id.extent() {
            // The sum over all cranes.
            Extent::Number => out.fill(results.iter().map(|number| number.reduce_add()).sum()),
            Extent::List(item, count) if item != Item::Row => {
                let ends = self.crane.loop_joints.iter().map(|joint| joint.ends.iter().flatten().count());
                let len = item.numbers();
                match count {
                    Count::WinchPieces => {
                        spread(results, connectors.iter().map(|connector| connector.pieces), len, out);
                    }
                    Count::Attachments => {
                        let points = connectors.iter().map(|connector| connector.points.len());
                        spread(results, points.chain(ends), len, out);
                    }
                    Count::DrivePieces => spread(results, drives.iter().map(|drive| drive.pieces), len, out),
                    Count::LoadPieces => spread(results, loads.iter().map(|load| load.pieces), len, out),
                    _ => spread(results, std::iter::repeat(1), len, out),
                }
            }
            _ => out.iter_mut().zip(cast_slice(results)).for_each(|(out, number)| *out = *number),
        }
    }
}

/// Takes a list of items of `len` numbers for each crane apart: of each part of a crane, which has some items, those of the first crane come first.
fn spread(results: &[f64x8], parts: impl Iterator<Item = usize>, len: usize, out: &mut [f64]) {
    let mut first = 0;
    for count in parts {
        let items = results.get(first * len..(first + count) * len);
        let places = out.get_mut(CRANES * first * len..CRANES * (first + count) * len);
        let (Some(items), Some(places)) = (items, places) else { break };
        for (index, entry) in places.chunks_exact_mut(len).enumerate() {
            let item = &items[index % count * len..][..len];
            entry.iter_mut().zip(item).for_each(|(number, vector)| *number = vector.lane(index / count));
        }
        first += count;
    }
}

impl Functions for Fleet {
    fn call(&self, id: FunctionId, arguments: &Arguments<'_>, out: &mut [f64]) -> Derived {
        // Matrices and derivatives of a fleet would have other sizes.
        if id.extent() == Extent::Matrix || id.part().is_in(&[Part::Modes, Part::Derivatives, Part::MotionDerivatives])
        {
            out.fill(f64::NAN);
            return Derived::No;
        }
        self.with_room(id, |Room { evaluation, given, results }| {
            let derived = evaluation.evaluate(&given.take(arguments), results);
            self.write(id, results, out);
            derived
        })
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

    fn loop_joints(&self) -> &[LoopJointInfo] {
        &self.loop_joints
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.with_room(FunctionId::PrescribedMotions, |Room { evaluation, given, results }| {
            evaluation.evaluate(&given.take(&Arguments { t, ..Arguments::none() }), results);
            for (drive, [position, rate]) in self.crane.chain().rigid_drives().zip(results.as_chunks().0) {
                let places = CRANES * drive.coordinate.0..CRANES * (drive.coordinate.0 + 1);
                q[places.clone()].copy_from_slice(position.as_array());
                v[places].copy_from_slice(rate.as_array());
            }
        });
    }

    fn system(&self) -> Box<dyn DynSystem + '_> {
        let system = LiveSystem::new(&self.crane.library, &self.parameters);
        Box::new(FleetSystem { system, given: Default::default(), solution: vec![] })
    }
}

/// Linear systems of all cranes.
struct FleetSystem<'a> {
    system: LiveSystem<'a, f64x8>,
    given: [Vec<f64x8>; 3],
    solution: Vec<f64x8>,
}

impl DynSystem for FleetSystem<'_> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]) {
        self.given.iter_mut().zip([q, added_inertia, base]).for_each(|(vectors, numbers)| take(numbers, vectors));
        let [q, added_inertia, base] = &self.given;
        self.system.factorise(q, added_inertia, base);
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        let Self { system, given: [given, ..], solution } = self;
        take(r, given);
        solution.resize(given.len(), f64x8::splat(0.0));
        system.solve(given, solution);
        out.copy_from_slice(cast_slice(solution));
    }
}
