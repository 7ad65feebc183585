//! Cylinders moved by oil: pressures and valves as states of the motion.
//!
//! A cylinder with the length ℓ, `y = ℓ − ℓ_retracted`, has oil at the pressure p on the side of its piston and p′ on that of its rod,
//! with the areas A and A′, and pushes with `F = p A − p′ A′`. With the bulk modulus β and the volume V₀ of oil in hoses and dead ends
//!
//! ```text
//! ṗ  = β/V  (Q  − A ẏ  − λ (p − p′) − relief + suction)     V  = V₀ + A y
//! ṗ′ = β/V′ (Q′ + A′ ẏ + λ (p − p′) − relief + suction)     V′ = V₀′ + A′ (stroke − y)
//! ```
//!
//! λ is the leakage past the piston. Relief valves open at the maximum pressure of the cylinder, suction valves below tank pressure. The
//! spool at u, −1 to 1, opens an edge from the pump to one side and one from the other side to the tank. The flow through an edge is
//! `K s r(Δp)` with the opening `s = max(0, |u| − overlap)/(1 − overlap)` and `r(Δ) = Δ/(Δ² + ε²)^¼`, a square root that becomes linear,
//! as in laminar flow, below ε = 1 bar. Check valves keep oil from flowing back to the pump. The spool lags behind its command u*,
//! `u̇ = (u* − u)/T`. The spec gives the command over time, or a servo computes it:
//!
//! ```text
//! u* = gain (ℓ* − ℓ) + share · A ẏ*/(K r(p_s − p)),     between −1 and 1
//! ```
//!
//! with the length ℓ* of the cylinder at the prescribed position of the drive and straight beams; the second term is the feed-forward of its speed, at the
//! measured pressures. The pump delivers nothing at its pressure, its maximum flow at 5 % less, and in between in proportion;
//! `ṗ_s = β/V_s (Q_pump − Σ Q)`. At the ends of the stroke the piston meets a stiff stop (Hunt–Crossley).
//!
//! F acts on all coordinates that change ℓ, with the generalized forces `F ∂ℓ/∂q`: on the joint, and on the beams between the pins.
//!
//! The states are, cylinder by cylinder, p, p′ and u, followed by `p_s`. H. E. Merritt, Hydraulic Control Systems, Wiley 1967.

mod cylinder;
mod oil;
mod servo;
mod state;
mod valve;

use nalgebra::{DMatrixViewMut, Vector3};

use crate::{
    CylinderInfo, Description, StateAt,
    dyn_crane::Functions,
    loop_joints,
    stateful_force::{Evaluated, ForceRow, ForceState, STATES, StatefulForces},
};
use cylinder::{Pump, ValveCylinder};
pub(crate) use oil::Oil;
pub(crate) use servo::{Servo, servos, spool};
pub use state::{CylinderState, cylinders_at};
pub(crate) use state::{pressures, unassembled_at};
use valve::flows;
pub(crate) use valve::steepest_flow;

/// The oil of a crane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hydraulics {
    cylinders: Vec<ValveCylinder>,
    pump: Option<Pump>,
    /// Every cylinder of the crane: length, rate, and derivative of the length with respect to its coordinate.
    here: Vec<Vector3<f64>>,
    /// The same with the drives at the positions that their motions prescribe, and straight beams.
    wanted: Vec<Vector3<f64>>,
    /// Derivatives of all lengths with respect to the coordinates, row by row.
    jacobians: Vec<f64>,
    /// The time of what depends only on time: `wanted`, `motions` and `openings`.
    t: Option<f64>,
    motions: Vec<[f64; 2]>,
    /// Prescribed openings of the drives' valves, and their rates.
    openings: Vec<[f64; 2]>,
    place: [Vec<f64>; 2],
}

impl Hydraulics {
    /// From the description of a crane; empty if no cylinder has a valve.
    pub fn new(description: &Description) -> Self {
        let with_valves = description.cylinders.iter().enumerate().filter_map(|(index, info)| {
            Some(ValveCylinder {
                index,
                coordinate: description.drives[info.drive].coordinate,
                valve: info.valve?,
                bulk_modulus: info.bulk_modulus?,
                max_pressure: info.max_pressure?,
                info: info.clone(),
            })
        });
        let cylinders: Vec<ValveCylinder> = with_valves.collect();
        let Some(first) = cylinders.first() else { return Self::default() };
        let pump = description
            .pump
            .and_then(|info| Some(Pump { info, pressure: info.pressure?, bulk_modulus: first.bulk_modulus }));
        let n = description.coordinates.len();
        Self {
            pump,
            here: vec![Vector3::zeros(); description.cylinders.len()],
            wanted: vec![Vector3::zeros(); description.cylinders.len()],
            jacobians: vec![0.0; description.cylinders.len() * n],
            t: None,
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

    /// Sets the rows of the cylinders with a valve to those of the last evaluation.
    fn update(&self, rows: &mut [ForceRow]) {
        let n = self.place[0].len();
        for (row, cylinder) in rows.iter_mut().zip(&self.cylinders) {
            let [first, end] = cylinder.info.spanned.map(|coordinate| cylinder.index * n + coordinate);
            row.entries.copy_from_slice(&self.jacobians[first..end]);
        }
    }

    /// Updates the lengths of all cylinders at this state, and with the drives at the positions that their motions prescribe.
    fn measure(&mut self, crane: &dyn Functions, t: f64, q: &[f64], v: &[f64]) {
        crane.cylinder_states(q, v, &mut self.here);
        crane.cylinder_jacobians(q, &mut self.jacobians);
        if self.t == Some(t) {
            return;
        }
        self.t = Some(t);
        crane.drive_motions(t, &mut self.motions);
        crane.valve_openings(t, &mut self.openings);
        // All other coordinates stay zero: they do not change these lengths, and beams are straight.
        let [wanted_q, wanted_v] = &mut self.place;
        for cylinder in &self.cylinders {
            let [position, rate] = self.motions[cylinder.info.drive];
            wanted_q[cylinder.coordinate] = position;
            wanted_v[cylinder.coordinate] = rate;
        }
        crane.cylinder_states(wanted_q, wanted_v, &mut self.wanted);
    }

    /// What the pump delivers at its present pressure: flow, m³/s, and power, W; then that pressure, Pa.
    fn delivered(&self, x: &[f64]) -> [f64; 3] {
        let (Some(pump), Some(pressure)) = (self.pump, self.len().checked_sub(1).map(|last| x[last])) else {
            return [0.0; 3];
        };
        let (flow, _) = pump.flow(pressure);
        [flow, flow * pressure, pressure]
    }
}

impl StatefulForces for Hydraulics {
    /// Pressures on both sides and the spool of each cylinder with a valve, then the pressure of the pump.
    fn states(&self) -> Vec<ForceState> {
        let pressure = self.pump.map_or(1.0, |pump| pump.pressure);
        let of_pressure = |name: String| ForceState { name, scale: pressure, range: None };
        let of_cylinder = |ValveCylinder { info, .. }: &ValveCylinder| {
            let [piston, rod] = ["piston", "rod"].map(|side| of_pressure(format!("{}_{side}_pressure", info.name)));
            let range = Some(([-1.0, 1.0], "a valve is fully open at −1 and 1"));
            [piston, rod, ForceState { name: format!("{}_valve", info.name), scale: 1.0, range }]
        };
        let pump = (!self.is_empty()).then(|| of_pressure("pump_pressure".to_owned()));
        self.cylinders.iter().flat_map(of_cylinder).chain(pump).collect()
    }

    fn rows(&self) -> Vec<ForceRow> {
        let row = |ValveCylinder { info: CylinderInfo { spanned: [first, end], .. }, .. }: &ValveCylinder| ForceRow {
            first: *first,
            entries: vec![0.0; end - first],
        };
        self.cylinders.iter().map(row).collect()
    }

    fn is_local(&self) -> bool {
        false
    }

    fn forget(&mut self) {
        self.t = None;
    }

    fn seal(&mut self) {
        self.cylinders.iter_mut().for_each(|cylinder| cylinder.valve.leakage = 0.0);
    }

    fn supplies_power(&self) -> bool {
        true
    }

    /// Shut valves, and the unloaded side at tank pressure. The cylinders also balance what loop joints transmit.
    fn holding(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> Vec<f64> {
        if self.is_empty() {
            return Vec::new();
        }
        let rest = vec![0.0; q.len()];
        let (mut bias, mut forces) = (rest.clone(), rest.clone());
        crane.bias(q, &rest, &mut bias);
        crane.forces(t, q, &rest, &mut forces);
        crane.cylinder_states(q, &rest, &mut self.here);
        let resisted = loop_joints::generalized(crane, q, &loop_joints::required(crane, t, [q, &rest, &rest]));
        let of_cylinder = |cylinder: &ValveCylinder| {
            let j = cylinder.coordinate;
            let effort = resisted[j] - (bias[j] + forces[j]);
            let state = CylinderState::new(&cylinder.info, self.here[cylinder.index].into(), effort);
            let [piston, rod] = state.pressures;
            [piston, rod, 0.0]
        };
        let all = self.cylinders.iter().flat_map(of_cylinder);
        all.chain(self.pump.map(|pump| pump.pressure)).collect()
    }

    /// As held, with valves that have opened slightly, towards the pump and towards the tank.
    fn slightly_open(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> [Vec<f64>; 2] {
        let holding = self.holding(crane, t, q);
        [1.0, -1.0].map(|towards| self.opened_slightly(&holding, towards))
    }

    fn evaluate(
        &mut self,
        crane: &dyn Functions,
        &StateAt { t, q, v, x }: &StateAt<'_>,
        Evaluated { rates, forces, rows }: Evaluated<'_>,
        mut by_states: Option<DMatrixViewMut<'_, f64>>,
    ) {
        let Some(last) = self.len().checked_sub(1) else { return };
        let p_s = x[last];
        self.measure(crane, t, q, v);
        self.update(rows);
        let (mut taken, mut taken_by_pump) = (0.0, 0.0);
        let pump = self.pump;
        let of_pump = pump.map_or(0.0, |pump| pump.bulk_modulus / pump.info.volume);
        for (index, cylinder) in self.cylinders.iter().enumerate() {
            let first = STATES * index;
            let (here, wanted) = (self.here[cylinder.index], self.wanted[cylinder.index]);
            let u = x[first + 2];
            let flows = flows(&cylinder.valve, u, [x[first], x[first + 1]], p_s, cylinder.info.back_pressure);
            let fed = usize::from(u <= 0.0);
            taken += flows.into[fed];
            taken_by_pump += flows.by_pump[fed];
            let mut force = cylinder.force(here, [x[first], x[first + 1]]);
            force.from_pump = flows.into[fed];
            (force.first, force.count) = (first, STATES);
            let mut block = [[0.0; STATES]; STATES];
            for side in 0..2 {
                let sign = [1.0, -1.0][side];
                let area = cylinder.info.areas[side];
                let extension = (here.x - cylinder.info.retracted).clamp(0.0, cylinder.info.stroke);
                let inside = extension == here.x - cylinder.info.retracted;
                let way = if side == 0 { extension } else { cylinder.info.stroke - extension };
                let volume = cylinder.info.hose_volumes[side] + area * way;
                let p = x[first + side];
                let leak = cylinder.valve.leakage * (x[first] - x[first + 1]);
                let (guard, guard_slope) = cylinder.relief_and_suction(p);
                let flow = flows.into[side] - sign * (area * here.y + leak) + guard;
                let stiffness = cylinder.bulk_modulus / volume;
                rates[first + side] = stiffness * flow;
                let by_way = if inside { -sign * area / volume } else { 0.0 };
                force.rates_by_length[side] = rates[first + side] * by_way;
                force.rates_by_speed[side] = -sign * stiffness * area;
                let leakage = stiffness * cylinder.valve.leakage;
                block[side][side] = stiffness * (flows.by_own[side] + guard_slope) - leakage;
                block[side][1 - side] = leakage;
                block[side][2] = stiffness * flows.by_spool[side];
                if let Some(matrix) = &mut by_states {
                    matrix[(first + side, last)] = stiffness * flows.by_pump[side];
                    matrix[(last, first + side)] = if side == fed { -of_pump * flows.by_own[side] } else { 0.0 };
                }
            }
            let command = if cylinder.valve.commanded {
                let [opening, _] = self.openings[cylinder.info.drive];
                ValveCylinder::commanded(opening)
            } else {
                cylinder.command(here, wanted, [x[first], x[first + 1]], p_s)
            };
            let lag = cylinder.valve.lag;
            rates[first + 2] = (command.opening - u) / lag;
            force.rates_by_length[2] = command.by_length / lag;
            force.cylinder = Some(cylinder.index);
            force.by_command = command.by_wanted.map(|slope| slope / lag);
            block[2] = [command.by_sides[0] / lag, command.by_sides[1] / lag, -1.0 / lag];
            if let Some(matrix) = &mut by_states {
                for (row, numbers) in block.iter().enumerate() {
                    for (column, number) in numbers.iter().enumerate() {
                        matrix[(first + row, first + column)] = *number;
                    }
                }
                matrix[(last, first + 2)] = -of_pump * flows.by_spool[fed];
                matrix[(first + 2, last)] = command.by_pump / lag;
            }
            forces[index] = force;
        }
        let (delivered, slope) = pump.map_or((0.0, 0.0), |pump| pump.flow(p_s));
        rates[last] = of_pump * (delivered - taken);
        if let Some(matrix) = &mut by_states {
            matrix[(last, last)] = of_pump * (slope - taken_by_pump);
        }
    }

    /// Those of cylinders, valves and pump.
    fn branches(&mut self, crane: &dyn Functions, &StateAt { t, q, v, x }: &StateAt<'_>, out: &mut Vec<bool>) {
        let Some(last) = self.len().checked_sub(1) else { return };
        let p_s = x[last];
        self.measure(crane, t, q, v);
        for (cylinder, own) in self.cylinders.iter().zip(x.chunks_exact(STATES)) {
            let (here, wanted) = (self.here[cylinder.index], self.wanted[cylinder.index]);
            cylinder.branches(here, wanted, own, p_s, out);
        }
        if let Some(pump) = self.pump {
            out.extend(pump.branches(p_s));
        }
    }
}

#[cfg(test)]
mod tests;
