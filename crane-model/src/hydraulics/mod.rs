//! Cylinders that oil moves: pressures and valves as states of the motion.
//!
//! A cylinder with the length ℓ, `y = ℓ − ℓ_retracted`, has oil at the pressure p on the side of its piston and p′ on that of its rod,
//! with the areas A and A′, and pushes with `F = p A − p′ A′`. With the bulk modulus β and the oil V₀ of hoses and dead ends
//!
//! ```text
//! ṗ  = β/V  (Q  − A ẏ  − λ (p − p′) − relief + suction)     V  = V₀ + A y
//! ṗ′ = β/V′ (Q′ + A′ ẏ + λ (p − p′) − relief + suction)     V′ = V₀′ + A′ (stroke − y)
//! ```
//!
//! λ is the leakage past the piston. Relief valves open at the greatest pressure of the cylinder, suction valves below that of the
//! tank. The spool at u, −1 to 1, opens an edge from the pump to one side and one from the other side to the tank; the flow through an edge is
//! `K |u| r(Δp)` with `r(Δ) = Δ/(Δ² + ε²)^¼`, a square root that is laminar below ε = 1 bar; check valves keep oil from flowing back to
//! the pump. The spool lags behind its command, `u̇ = (u* − u)/T`, which the servo gives, or the spec over time:
//!
//! ```text
//! u* = gain (ℓ* − ℓ) + share · A ẏ*/(K r(p_s − p)),     between −1 and 1
//! ```
//!
//! with the length ℓ* that the cylinder has where the drive's motion is; its speed is set ahead with the pressures measured. The pump
//! keeps up its pressure as long as the valves take no more than its greatest flow; `ṗ_s = β/V_s (Q_pump − Σ Q)`. At the ends of the stroke the piston meets a stiff stop (Hunt–Crossley).
//!
//! The states are, cylinder by cylinder, p, p′ and u, and `p_s` behind all of them. H. E. Merritt, Hydraulic Control Systems, Wiley 1967.

mod valve;

use nalgebra::{Complex, DMatrix, Vector3};

use crate::{
    CylinderInfo, Description, PumpInfo, ValveInfo,
    dyn_crane::{DynCrane, DynDynamics, DynModel},
    modes::{DampedMode, SmallMotions},
    own_states::{Moment, Pushed, STATES},
    results::{CylinderState, cylinders_at},
};
use valve::{flows, root};

/// Share of a pressure above it at which a relief valve passes the nominal flow of the valve, and of its own pressure below which the pump
/// delivers all it can.
const BAND: f64 = 0.05;
/// Pressure below the tank's at which a suction valve passes the nominal flow, Pa.
const SUCTION: f64 = 1e5;
/// Least share of the nominal pressure drop for which the servo computes an opening.
const LEAST_DROP: f64 = 0.1;
/// Way into a stop on which it carries the cylinder's greatest force, m.
const STOP: f64 = 1e-3;
/// Damping of a stop, s/m: it returns `1 − ⅔ a v` of a small speed.
const STOP_DAMPING: f64 = 3.0;

/// The oil of a crane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hydraulics {
    cylinders: Vec<Moved>,
    pump: Option<Pump>,
    /// Every cylinder of the crane: length, rate, and derivative by its coordinate.
    here: Vec<Vector3<f64>>,
    /// The same with all drives where their motions are.
    wanted: Vec<Vector3<f64>>,
    motions: Vec<[f64; 2]>,
    /// Commands over time of the drives' valves.
    openings: Vec<[f64; 2]>,
    place: [Vec<f64>; 2],
}

/// A cylinder with a valve.
#[derive(Clone, Debug)]
struct Moved {
    /// Its place among all cylinders.
    index: usize,
    coordinate: usize,
    info: CylinderInfo,
    valve: ValveInfo,
    bulk_modulus: f64,
    max_pressure: f64,
}

/// Where a servo wants its spool, and the derivatives by the length, the pressures on both sides and the pump's.
#[derive(Clone, Copy, Debug, Default)]
struct Command {
    opening: f64,
    by_length: f64,
    by_sides: [f64; 2],
    by_pump: f64,
}

#[derive(Clone, Copy, Debug)]
struct Pump {
    info: PumpInfo,
    pressure: f64,
    bulk_modulus: f64,
}

impl Hydraulics {
    /// What the description of a crane says about it; nothing where no cylinder has a valve.
    pub fn new(description: &Description) -> Self {
        let moved = description.cylinders.iter().enumerate().filter_map(|(index, info)| {
            Some(Moved {
                index,
                coordinate: description.drives[info.drive].coordinate,
                valve: info.valve?,
                bulk_modulus: info.bulk_modulus?,
                max_pressure: info.max_pressure?,
                info: info.clone(),
            })
        });
        let cylinders: Vec<Moved> = moved.collect();
        let Some(first) = cylinders.first() else { return Self::default() };
        let pump = description
            .pump
            .and_then(|info| Some(Pump { info, pressure: info.pressure?, bulk_modulus: first.bulk_modulus }));
        let n = description.coordinates.len();
        Self {
            pump,
            here: vec![Vector3::zeros(); description.cylinders.len()],
            wanted: vec![Vector3::zeros(); description.cylinders.len()],
            motions: vec![[0.0; 2]; description.drives.len()],
            openings: vec![[0.0; 2]; description.drives.len()],
            place: [vec![0.0; n], vec![0.0; n]],
            cylinders,
        }
    }

    /// Number of states.
    pub fn len(&self) -> usize {
        if self.cylinders.is_empty() { 0 } else { STATES * self.cylinders.len() + 1 }
    }

    /// Whether no cylinder has a valve.
    pub fn is_empty(&self) -> bool {
        self.cylinders.is_empty()
    }

    /// Number of cylinders with a valve.
    pub(crate) fn count(&self) -> usize {
        self.cylinders.len()
    }

    /// Sizes by which errors of the states are measured: the pump's pressure, and the full way of a spool.
    pub(crate) fn scales(&self) -> Vec<f64> {
        let pressure = self.pump.map_or(1.0, |pump| pump.pressure);
        let of_cylinder = [pressure, pressure, 1.0];
        let all = self.cylinders.iter().flat_map(|_| of_cylinder);
        all.chain((!self.is_empty()).then_some(pressure)).collect()
    }

    /// The states that hold a pose at rest at a time: shut valves, and the side that does not carry at the pressure of the tank.
    pub(crate) fn holding(&mut self, crane: &dyn DynDynamics, t: f64, q: &[f64]) -> Vec<f64> {
        if self.is_empty() {
            return Vec::new();
        }
        let rest = vec![0.0; q.len()];
        let (mut bias, mut forces) = (rest.clone(), rest.clone());
        crane.bias(q, &rest, &mut bias);
        crane.forces(t, q, &rest, &mut forces);
        crane.cylinder_states(q, &rest, &mut self.here);
        let of_cylinder = |moved: &Moved| {
            let effort = -(bias[moved.coordinate] + forces[moved.coordinate]);
            let state = CylinderState::new(&moved.info, self.here[moved.index].into(), effort);
            let [piston, rod] = state.pressures;
            [piston, rod, 0.0]
        };
        let all = self.cylinders.iter().flat_map(of_cylinder);
        all.chain(self.pump.map(|pump| pump.pressure)).collect()
    }

    /// Rates of the states, and every cylinder with a valve, at a state of the crane. `by_states`, if wanted: the derivatives of the
    /// rates by the states.
    pub(crate) fn evaluate(
        &mut self,
        crane: &dyn DynModel,
        &Moment { t, q, v, x }: &Moment<'_>,
        rates: &mut [f64],
        pushed: &mut [Pushed],
        mut by_states: Option<&mut DMatrix<f64>>,
    ) {
        let Some(last) = self.len().checked_sub(1) else { return };
        let p_s = x[last];
        self.measure(crane, t, q, v);
        let (mut taken, mut taken_by_pump) = (0.0, 0.0);
        let pump = self.pump;
        let of_pump = pump.map_or(0.0, |pump| pump.bulk_modulus / pump.info.volume);
        for (place, moved) in self.cylinders.iter().enumerate() {
            let first = STATES * place;
            let (here, wanted) = (self.here[moved.index], self.wanted[moved.index]);
            let u = x[first + 2];
            let flows = flows(&moved.valve, u, [x[first], x[first + 1]], p_s, moved.info.back_pressure);
            let fed = usize::from(u <= 0.0);
            taken += flows.into[fed];
            taken_by_pump += flows.by_pump[fed];
            let mut own = moved.push(here, [x[first], x[first + 1]]);
            own.from_pump = flows.into[fed];
            (own.first, own.count) = (first, STATES);
            let mut block = [[0.0; STATES]; STATES];
            for side in 0..2 {
                let sign = [1.0, -1.0][side];
                let area = moved.info.areas[side];
                let extension = (here.x - moved.info.retracted).clamp(0.0, moved.info.stroke);
                let inside = extension == here.x - moved.info.retracted;
                let way = if side == 0 { extension } else { moved.info.stroke - extension };
                let volume = moved.info.hose_volumes[side] + area * way;
                let p = x[first + side];
                let leak = moved.valve.leakage * (x[first] - x[first + 1]);
                let (guard, guard_slope) = moved.guards(p);
                let flow = flows.into[side] - sign * (area * here.y + leak) + guard;
                let stiffness = moved.bulk_modulus / volume;
                rates[first + side] = stiffness * flow;
                let by_way = if inside { -sign * area / volume } else { 0.0 };
                own.rates_by_length[side] = rates[first + side] * by_way;
                own.rates_by_speed[side] = -sign * stiffness * area;
                let leakage = stiffness * moved.valve.leakage;
                block[side][side] = stiffness * (flows.by_own[side] + guard_slope) - leakage;
                block[side][1 - side] = leakage;
                block[side][2] = stiffness * flows.by_spool[side];
                if let Some(matrix) = by_states.as_deref_mut() {
                    matrix[(first + side, last)] = stiffness * flows.by_pump[side];
                    matrix[(last, first + side)] = if side == fed { -of_pump * flows.by_own[side] } else { 0.0 };
                }
            }
            let command = if moved.valve.commanded {
                let [opening, _] = self.openings[moved.info.drive];
                Command { opening: opening.clamp(-1.0, 1.0), ..Command::default() }
            } else {
                moved.command(here, wanted, [x[first], x[first + 1]], p_s)
            };
            let lag = moved.valve.lag;
            rates[first + 2] = (command.opening - u) / lag;
            own.rates_by_length[2] = command.by_length / lag;
            block[2] = [command.by_sides[0] / lag, command.by_sides[1] / lag, -1.0 / lag];
            if let Some(matrix) = by_states.as_deref_mut() {
                for (row, numbers) in block.iter().enumerate() {
                    for (column, number) in numbers.iter().enumerate() {
                        matrix[(first + row, first + column)] = *number;
                    }
                }
                matrix[(last, first + 2)] = -of_pump * flows.by_spool[fed];
                matrix[(first + 2, last)] = command.by_pump / lag;
            }
            pushed[place] = own;
        }
        let (delivered, slope) = pump.map_or((0.0, 0.0), |pump| pump.flow(p_s));
        rates[last] = of_pump * (delivered - taken);
        if let Some(matrix) = by_states {
            matrix[(last, last)] = of_pump * (slope - taken_by_pump);
        }
    }

    /// Lengths of all cylinders here, and where the drives' motions are.
    fn measure(&mut self, crane: &dyn DynModel, t: f64, q: &[f64], v: &[f64]) {
        crane.cylinder_states(q, v, &mut self.here);
        crane.drive_motions(t, &mut self.motions);
        crane.valve_openings(t, &mut self.openings);
        let [wanted_q, wanted_v] = &mut self.place;
        wanted_q.copy_from_slice(q);
        wanted_v.copy_from_slice(v);
        for moved in &self.cylinders {
            let [position, rate] = self.motions[moved.info.drive];
            wanted_q[moved.coordinate] = position;
            wanted_v[moved.coordinate] = rate;
        }
        crane.cylinder_states(wanted_q, wanted_v, &mut self.wanted);
        // What bends between the pins of a cylinder changes its length a little, but only its joint takes its force.
        for Moved { index, coordinate, .. } in &self.cylinders {
            self.here[*index].y = self.here[*index].z * v[*coordinate];
            self.wanted[*index].y = self.wanted[*index].z * wanted_v[*coordinate];
        }
    }

    /// The pump at its pressure: flow, m³/s, power, W, and that pressure, Pa.
    fn delivered(&self, x: &[f64]) -> [f64; 3] {
        let (Some(pump), Some(pressure)) = (self.pump, self.len().checked_sub(1).map(|last| x[last])) else {
            return [0.0; 3];
        };
        let (flow, _) = pump.flow(pressure);
        [flow, flow * pressure, pressure]
    }
}

impl Pump {
    /// What it delivers at a pressure, m³/s, and the derivative.
    fn flow(&self, pressure: f64) -> (f64, f64) {
        let band = BAND * self.pressure;
        let share = (self.pressure - pressure) / band;
        let slope = if (0.0..1.0).contains(&share) { -self.info.max_flow / band } else { 0.0 };
        (self.info.max_flow * share.clamp(0.0, 1.0), slope)
    }
}

impl Moved {
    /// Force and its derivatives at pressures.
    fn push(&self, here: Vector3<f64>, [piston, rod]: [f64; 2]) -> Pushed {
        let [area, ring] = self.info.areas;
        let y = here.x - self.info.retracted;
        let beyond = if y > self.info.stroke { y - self.info.stroke } else { y.min(0.0) };
        let stiffness = area * self.max_pressure / STOP;
        let damping = (1.0 + STOP_DAMPING * here.y * beyond.signum()).max(0.0);
        let stopped = beyond != 0.0;
        let (by_length, by_speed) = if stopped && damping > 0.0 {
            (-stiffness * damping, -stiffness * STOP_DAMPING * beyond.abs())
        } else {
            (0.0, 0.0)
        };
        Pushed {
            coordinate: self.coordinate,
            arm: here.z,
            force: piston * area - rod * ring - stiffness * beyond * damping,
            by_length,
            by_speed,
            by_states: [area, -ring, 0.0],
            speed: here.y,
            ..Pushed::default()
        }
    }

    /// What relief and suction valves let in, m³/s, and the derivative by the pressure.
    fn guards(&self, pressure: f64) -> (f64, f64) {
        let relief = -self.valve.flow / (BAND * self.max_pressure);
        let suction = -self.valve.flow / SUCTION;
        let (above, below) = (pressure - self.max_pressure, pressure - self.info.back_pressure);
        if above > 0.0 {
            (relief * above, relief)
        } else if below < 0.0 {
            (suction * below, suction)
        } else {
            (0.0, 0.0)
        }
    }

    /// Where the servo wants the spool.
    fn command(&self, here: Vector3<f64>, wanted: Vector3<f64>, sides: [f64; 2], pump: f64) -> Command {
        let ValveInfo { flow, pressure_drop, gain, feed_forward, .. } = self.valve;
        let fed = usize::from(wanted.y <= 0.0);
        let difference = pump - sides[fed];
        let least = LEAST_DROP * pressure_drop;
        let drop = root(difference.max(least));
        let share = feed_forward * self.info.areas[fed] * wanted.y * root(pressure_drop).value / (flow * drop.value);
        let opening = gain * (wanted.x - here.x) + share;
        if opening.abs() >= 1.0 {
            return Command { opening: opening.clamp(-1.0, 1.0), ..Command::default() };
        }
        let by_pump = if difference > least { -share * drop.slope / drop.value } else { 0.0 };
        let mut by_sides = [0.0; 2];
        by_sides[fed] = -by_pump;
        Command { opening, by_length: -gain, by_sides, by_pump }
    }
}

/// The oil of a crane at a state: the cylinders with a valve by their place among all cylinders, their efforts on their joints, N m and N, and
/// where their spools are; flow (m³/s), power (W) and pressure (Pa) of the pump.
pub(crate) struct Oil {
    pub cylinders: Vec<(usize, CylinderState, f64)>,
    pub pump: [f64; 3],
}

impl Oil {
    /// At a state of the crane and its oil.
    pub fn at(crane: &dyn DynModel, moment: &Moment<'_>) -> Option<Self> {
        let x = moment.x;
        let mut hydraulics = Hydraulics::new(crane.description());
        if hydraulics.is_empty() || x.len() < hydraulics.len() {
            return None;
        }
        let mut pushed = vec![Pushed::default(); hydraulics.count()];
        hydraulics.evaluate(crane, moment, &mut vec![0.0; x.len()], &mut pushed, None);
        let cylinders =
            hydraulics.cylinders.iter().zip(&pushed).zip(x.chunks_exact(STATES)).map(|((moved, own), x)| {
                let state = CylinderState {
                    length: hydraulics.here[moved.index].x,
                    speed: own.speed,
                    arm: own.arm,
                    force: own.force,
                    pressures: [x[0], x[1]],
                    flow: own.from_pump,
                };
                (moved.index, state, x[2])
            });
        Some(Self { cylinders: cylinders.collect(), pump: hydraulics.delivered(x) })
    }

    /// Puts the efforts of cylinders with a valve in place of those of their drives.
    pub fn give_efforts(&self, description: &Description, efforts: &mut [f64]) {
        for (index, state, _) in &self.cylinders {
            efforts[description.cylinders[*index].drive] = state.force * state.arm;
        }
    }

    /// Puts the states of cylinders with a valve in place of what their drives would take.
    pub fn give_states(&self, cylinders: &mut [CylinderState]) {
        for (index, state, _) in &self.cylinders {
            cylinders[*index] = *state;
        }
    }

    /// Flow, power and pressure of the pump, and the openings of the valves.
    pub fn pump_and_spools(&self) -> impl Iterator<Item = f64> {
        self.pump.into_iter().chain(self.cylinders.iter().map(|(.., spool)| *spool))
    }
}

/// How fast the oil of each cylinder with a valve may decay at a pose, as a mode of its joint: while its suction valves let in oil, with edges
/// near balance. Explicit methods are limited by it.
pub fn decays(crane: &dyn DynCrane, q: &[f64]) -> Vec<DampedMode> {
    let cylinders = &crane.description().cylinders;
    let mut lengths = vec![Vector3::zeros(); cylinders.len()];
    crane.cylinder_states(q, &vec![0.0; q.len()], &mut lengths);
    let decay = |(info, length): (&CylinderInfo, &Vector3<f64>)| {
        let (valve, bulk_modulus) = (info.valve?, info.bulk_modulus?);
        let y = (length.x - info.retracted).clamp(0.0, info.stroke);
        let [of_piston, of_rod] = info.hose_volumes;
        let volume = (of_piston + info.areas[0] * y).min(of_rod + info.areas[1] * (info.stroke - y));
        let slope = 1.0 / SUCTION + root(0.0).slope / root(valve.pressure_drop).value;
        let eigenvalue = Complex::new(-bulk_modulus / volume * valve.flow * slope, 0.0);
        Some(DampedMode { eigenvalue, dominating: vec![crane.description().drives[info.drive].coordinate] })
    };
    cylinders.iter().zip(&lengths).filter_map(decay).collect()
}

/// Names of the columns of results with the states, in their order.
pub(crate) fn columns(description: &Description) -> Vec<String> {
    let valves = description.cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
    let of_cylinder =
        |info: &CylinderInfo| ["piston_pressure", "rod_pressure", "valve"].map(|what| format!("{}_{what}", info.name));
    let mut names: Vec<String> = valves.flat_map(of_cylinder).collect();
    if !names.is_empty() {
        names.push("pump_pressure".to_owned());
    }
    names
}

/// Adds the stiffness of the oil that shut valves trap, `k (∂ℓ/∂q)² − F ∂²ℓ/∂q²`, to that of small motions about a pose at rest.
pub(crate) fn stiffen(crane: &dyn DynCrane, q: &[f64], motions: &mut SmallMotions) {
    /// Difference over which a lever is differenced, m or rad: an error of 1e-8 of the second term.
    const DIFFERENCE: f64 = 1e-4;
    let cylinders = &crane.description().cylinders;
    if !crane.description().has_valves() {
        return;
    }
    let rest = vec![0.0; q.len()];
    let states = cylinders_at(crane, q, &rest, &crane.drive_efforts_at_rest(q));
    for (index, (info, state)) in
        cylinders.iter().zip(&states).enumerate().filter(|(_, (info, _))| info.valve.is_some())
    {
        let coordinate = crane.description().drives[info.drive].coordinate;
        let lever = |step: f64| {
            let mut moved = q.to_vec();
            moved[coordinate] += step;
            let mut lengths = vec![Vector3::zeros(); cylinders.len()];
            crane.cylinder_states(&moved, &rest, &mut lengths);
            lengths[index].z
        };
        let curvature = (lever(DIFFERENCE) - lever(-DIFFERENCE)) / (2.0 * DIFFERENCE);
        let Some(place) = motions.unknowns.iter().position(|unknown| *unknown == coordinate) else { continue };
        let oil = state.oil_stiffness(info).unwrap_or(f64::NAN);
        motions.stiffness[(place, place)] += oil - state.force * curvature;
    }
}

#[cfg(test)]
mod tests;
