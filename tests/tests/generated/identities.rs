//! Physical identities on random cranes with fixed seeds, by the interpreter.

use std::sync::LazyLock;

use crane_codegen::chain::{BodyId, Chain, CoordinateId, CoordinateKind, Cut, Force, LinePart, Step, StrainLine};
use crane_codegen::program::{Argument, Inputs};
use crane_model::nalgebra::{DMatrix, DVector, Rotation2, Vector2};
use crane_tests::dual::Dual;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::{random, states, workspace};

const SEEDS: std::ops::Range<u64> = 0..24;
/// Seeds of cranes with branches.
const BRANCHED: std::ops::Range<u64> = 24..36;
/// Functions that add up to the potential energy.
const POTENTIAL_ENERGIES: [&str; 6] =
    ["gravity_energy", "support_energy", "element_energy", "drive_energy", "stop_energy", "connector_energy"];

/// Derived once: each test uses most of them.
static CRANES: LazyLock<Vec<(u64, Interpreted)>> = LazyLock::new(|| {
    let serial = SEEDS.map(|seed| (seed, random::spec(seed)));
    let branched = BRANCHED.map(|seed| (seed, random::with_branches(seed)));
    let specs = serial.chain(branched);
    specs.map(|(seed, spec)| (seed, Interpreted::new(workspace::chain_of("random", &spec)))).collect()
});

fn cranes() -> impl Iterator<Item = (u64, &'static Interpreted)> {
    CRANES.iter().map(|(seed, crane)| (*seed, crane))
}

/// The state in dual numbers, with these rates of t, q and v.
fn moving(crane: &Interpreted, state: &State, rates: (f64, &[f64], &[f64])) -> Inputs<Dual> {
    let (t, q, v) = rates;
    let pair = |values: &[f64], rates: &[f64]| values.iter().zip(rates).map(|(x, r)| Dual::new(*x, *r)).collect();
    let parameters = crane.chain.parameter_defaults().into_iter().map(|p| Dual::new(p, 0.0)).collect();
    Inputs::state(Dual::new(state.t, t), pair(&state.q, q), pair(&state.v, v), parameters)
}

/// Relative to the larger of the two, or to `size`, that of the terms that cancel, if it is larger.
fn assert_close(a: f64, b: f64, size: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance * size.max(a.abs()).max(b.abs()), "{what}: {a} against {b}, size {size}");
}

#[test]
fn mass_matrix_is_positive_definite_and_gives_the_kinetic_energy() {
    for (seed, crane) in cranes() {
        for state in states::far(&crane.chain, 4, seed) {
            let matrix = crane.matrix("mass_matrix", &state);
            assert!(matrix.clone().cholesky().is_some(), "seed {seed}: A is not positive definite");
            let v = DVector::from_column_slice(&state.v);
            let energy = 0.5 * v.dot(&(matrix * &v));
            // Different sums of the same thousand terms.
            assert_close(energy, crane.scalar("kinetic_energy", &state), 0.0, 1e-12, &format!("seed {seed}"));
        }
    }
}

/// `½ vᵀ Ȧ v = vᵀ h`: what the skew symmetry of Ȧ − 2C means, with Ȧ by dual numbers and h from the bias.
#[test]
fn velocity_forces_and_the_rate_of_the_mass_matrix_fit() {
    for (seed, crane) in cranes() {
        for state in states::far(&crane.chain, 3, seed) {
            let n = crane.size();
            let rest = vec![0.0; n];
            let inputs = moving(crane, &state, (0.0, &state.v, &rest));
            let rate: Vec<f64> = crane.get("mass_matrix", &inputs, n * n).into_iter().map(Dual::derivative).collect();
            let v = DVector::from_column_slice(&state.v);
            let half = 0.5 * v.dot(&(DMatrix::from_row_slice(n, n, &rate) * &v));
            let at_rest = State { v: rest.clone(), ..state.clone() };
            let h = crane.vector("bias", &at_rest) - crane.vector("bias", &state);
            let size = v.iter().zip(&h).map(|(v, h)| (v * h).abs()).sum();
            assert_close(half, v.dot(&h), size, 1e-11, &format!("seed {seed}"));
        }
    }
}

/// `Ȧ − 2C` is skew: `wᵀ Ȧ(v) w = 2 wᵀ C(v) w` for any w, with `C(v) w = ½ (h(v + w) − h(v) − h(w))`, h being quadratic
/// in the velocities and Ȧ by dual numbers.
#[test]
fn rate_of_the_mass_matrix_less_twice_c_is_skew() {
    for (seed, crane) in cranes() {
        let n = crane.size();
        for pair in states::far(&crane.chain, 4, seed).chunks(2) {
            let (state, w) = (&pair[0], DVector::from_column_slice(&pair[1].v));
            let v = DVector::from_column_slice(&state.v);
            let h = |v: &DVector<f64>| {
                let at = |v: &DVector<f64>| State { v: v.as_slice().to_vec(), ..state.clone() };
                crane.vector("bias", &at(&DVector::zeros(n))) - crane.vector("bias", &at(v))
            };
            let coriolis = 0.5 * (h(&(&v + &w)) - h(&v) - h(&w));
            let inputs = moving(crane, state, (0.0, &state.v, &vec![0.0; n]));
            let rate: Vec<f64> = crane.get("mass_matrix", &inputs, n * n).into_iter().map(Dual::derivative).collect();
            let quadratic = w.dot(&(DMatrix::from_row_slice(n, n, &rate) * &w));
            let size = w.iter().zip(&h(&(&v + &w))).map(|(w, h)| (w * h).abs()).sum();
            assert_close(quadratic, 2.0 * w.dot(&coriolis), size, 1e-11, &format!("seed {seed}"));
        }
    }
}

/// A rotor adds its inertia to one entry of A, and `½ I q̇²` to the kinetic energy; no other force depends on it.
#[test]
fn a_rotor_adds_to_the_diagonal_and_to_nothing_else() {
    for (seed, crane) in cranes() {
        let without = Interpreted::new(Chain { rotors: vec![], ..crane.chain.clone() });
        let parameters = crane.chain.parameter_defaults();
        let mut armature = DVector::zeros(crane.size());
        for rotor in &crane.chain.rotors {
            armature[rotor.coordinate.0] += rotor.armature.at(&parameters);
        }
        assert!(armature.iter().filter(|inertia| **inertia > 0.0).count() >= 3, "seed {seed}: {armature}");
        for state in states::far(&crane.chain, 2, seed) {
            let v = DVector::from_column_slice(&state.v);
            let added = crane.matrix("mass_matrix", &state) - without.matrix("mass_matrix", &state);
            let size = crane.matrix("mass_matrix", &state).amax();
            assert!((added - DMatrix::from_diagonal(&armature)).amax() <= 1e-15 * size, "seed {seed}");
            let energy = crane.scalar("kinetic_energy", &state) - without.scalar("kinetic_energy", &state);
            let size = crane.scalar("kinetic_energy", &state);
            assert_close(energy, 0.5 * v.component_mul(&armature).dot(&v), size, 1e-15, &format!("seed {seed}"));
            let forces = [
                "bias",
                "support_forces",
                "element_forces",
                "joint_damper_forces",
                "stop_forces",
                "friction_forces",
                "load_forces",
                "connector_forces",
            ];
            for force in forces {
                assert_eq!(crane.vector(force, &state), without.vector(force, &state), "seed {seed}: {force}");
            }
        }
    }
}

/// The support forces on the base's translations are the sum of the reactions, and the gravity forces are the weight:
/// in equilibrium the reactions carry the weight, whatever the crane.
#[test]
fn reactions_sum_to_the_support_forces_and_gravity_to_the_weight() {
    for (seed, crane) in cranes().filter(|(seed, _)| seed % 3 == 0) {
        let parameters = crane.chain.parameter_defaults();
        let inertias = crane.chain.bodies.iter().filter_map(|body| body.inertia.as_ref());
        let mass: f64 = inertias.map(|inertia| inertia.mass.at(&parameters)).sum();
        for state in states::far(&crane.chain, 3, seed) {
            let reactions = crane.get("support_reactions", &crane.inputs(&state), 0);
            let forces = crane.vector("support_forces", &state);
            let weight = crane.vector("bias", &State { v: vec![0.0; crane.size()], ..state.clone() });
            for axis in 0..3 {
                let total: f64 = reactions.iter().skip(axis).step_by(3).sum();
                assert_close(total, forces[axis], forces.amax(), 1e-13, &format!("seed {seed}: reactions"));
                let gravity = mass * crane.chain.gravity[axis].at(&parameters);
                assert_close(weight[axis], gravity, weight.amax(), 1e-13, &format!("seed {seed}: weight"));
            }
        }
    }
}

/// Force and moment that every cut transmits at a state with accelerations `a`.
fn wrenches(crane: &Interpreted, state: &State, a: &DVector<f64>) -> Vec<[f64; 6]> {
    let inputs = crane.inputs(state).with(Argument::Acceleration, a.as_slice().to_vec());
    crane.get("internal_forces", &inputs, 0).as_chunks().0.to_vec()
}

/// Generalized forces of connectors between points and of pads, `−Jᵀ F`; couplings act along their joints.
fn forces_between_points(crane: &Interpreted, state: &State) -> DVector<f64> {
    let inputs = crane.inputs(state);
    let (tensions, rows) = (crane.get("connector_tensions", &inputs, 0), crane.get("connector_jacobians", &inputs, 0));
    let elements = tensions.chunks_exact(3).zip(rows.chunks_exact(crane.size())).zip(crane.chain.connectors());
    let between = elements.filter(|(_, connector)| !connector.strain.points().is_empty());
    between.fold(DVector::zeros(crane.size()), |sum, ((tension, row), _)| {
        sum - DVector::from_column_slice(row) * tension[0]
    })
}

/// Along the axis of a joint's last coordinate, a cut transmits the generalized force of that coordinate: `A a − e` without the
/// rotor, less the forces of loads, of connectors between points and of pads.
#[test]
fn what_a_joint_transmits_along_its_axis_is_its_effort() {
    for (seed, crane) in cranes() {
        let chain = &crane.chain;
        for state in states::far(chain, 2, seed) {
            let a = DVector::from_column_slice(&state.v) * 3.0;
            let mut efforts = crane.matrix("mass_matrix", &state) * &a
                - crane.vector("bias", &state)
                - crane.vector("load_forces", &state)
                - forces_between_points(crane, &state);
            for rotor in &chain.rotors {
                efforts[rotor.coordinate.0] -= rotor.armature.at(&chain.parameter_defaults()) * a[rotor.coordinate.0];
            }
            let mut compared = 0;
            for (cut, wrench) in chain.cuts().into_iter().zip(wrenches(crane, &state, &a)) {
                let Cut::Joint(body) = cut else { continue };
                let last = chain.bodies[body.0].path.iter().rev().find(|step| !step.coordinates().is_empty());
                let Some(Step::Move(id)) = last else { continue };
                let coordinate = &chain.coordinates[id.0];
                let first = if coordinate.kind == CoordinateKind::Rotation { 3 } else { 0 };
                let transmitted = wrench[first + coordinate.axis.index()];
                assert_close(-transmitted, efforts[id.0], efforts.amax(), 1e-12, &format!("seed {seed}"));
                compared += 1;
            }
            assert!(compared > 0, "seed {seed} has a joint");
        }
    }
}

/// The index in a wrench at a cut of what the last coordinate before it feels, if the cut's frame is the one that this coordinate reaches.
fn along_last_coordinate(crane: &Interpreted, cut: Cut) -> Option<(usize, usize)> {
    let (Cut::Joint(body) | Cut::Body(body)) = cut else { return None };
    let path = &crane.chain.bodies[body.0].path;
    let last = match cut {
        Cut::Joint(_) => path.iter().rev().find(|step| !step.coordinates().is_empty())?,
        _ => path.last()?,
    };
    let Step::Move(id) = last else { return None };
    let coordinate = &crane.chain.coordinates[id.0];
    let first = if coordinate.kind == CoordinateKind::Rotation { 3 } else { 0 };
    Some((id.0, first + coordinate.axis.index()))
}

/// Along the axis of every coordinate, a cylinder that pushes with 1 N transmits `∂ℓ/∂q`, and nothing where it spans no cut; the same with
/// the opposite sign for connectors, which pull.
#[test]
fn wrenches_of_cylinders_and_connectors_follow_from_their_lengths() {
    let (mut of_cylinders, mut of_beams) = (0, 0);
    let shipped = Interpreted::new(workspace::chain("eight_link_hydraulic"));
    let cranes = CRANES.iter().map(|(seed, crane)| (*seed, crane)).filter(|(seed, _)| seed % 8 == 7);
    for (seed, crane) in cranes.chain([(0, &shipped)]) {
        let (chain, cuts) = (&crane.chain, crane.chain.cuts());
        for state in states::far(chain, 3, seed) {
            for (rows, wrenches, sign) in
                [("cylinder_jacobians", "cylinder_wrenches", 1.0), ("connector_jacobians", "connector_wrenches", -1.0)]
            {
                let [rows, wrenches] = [rows, wrenches].map(|name| crane.get(name, &crane.inputs(&state), 0));
                let elements = rows.chunks_exact(crane.size()).zip(wrenches.chunks_exact(6 * cuts.len()));
                for (index, (row, wrenches)) in elements.enumerate() {
                    // Of other ropes, the wrenches are those of the parts between two bodies.
                    let is_within = |line: &StrainLine| line.parts().all(LinePart::joins_bodies);
                    let between = sign > 0.0 || chain.connectors()[index].strain.line().is_some_and(is_within);
                    // A linkage that does not close.
                    if !between || row.iter().any(|entry| entry.is_nan()) {
                        continue;
                    }
                    for (cut, wrench) in cuts.iter().zip(wrenches.chunks_exact(6)) {
                        let Some((j, along)) = along_last_coordinate(crane, *cut) else { continue };
                        let size = row.iter().fold(1.0, |size: f64, entry| size.max(entry.abs()));
                        assert_close(sign * wrench[along], row[j], size, 1e-12, &format!("seed {seed}: {cut:?}"));
                        let spans = sign > 0.0 && chain.spanned_by(&chain.cylinders[index]).contains(&CoordinateId(j));
                        of_cylinders += usize::from(spans);
                        of_beams += usize::from(spans && chain.coordinates[j].name.contains("first_"));
                    }
                }
            }
        }
    }
    assert!(of_cylinders > 60 && of_beams > 20, "{of_cylinders} cylinders, {of_beams} beams");
}

/// The load on the ground consists of the weight and inertia forces of the crane and the loads applied to it: the supports carry
/// just that, also in motion.
#[test]
fn supports_carry_the_load_on_the_ground() {
    for (seed, crane) in cranes().filter(|(seed, _)| seed % 3 == 0) {
        for state in states::far(&crane.chain, 2, seed) {
            let reactions = crane.get("support_reactions", &crane.inputs(&state), 0);
            let ground = wrenches(crane, &state, &crane.acceleration(&state))[0];
            for axis in 0..3 {
                let total: f64 = reactions.iter().skip(axis).step_by(3).sum();
                let size = reactions.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
                // Accelerations are accurate to 1e-12 of the largest, which is that of a light element.
                assert_close(-ground[axis], total, size, 1e-9, &format!("seed {seed}"));
            }
        }
    }
}

/// The error of the energy of a conservative crane after a given time falls as h⁴.
#[test]
fn energy_drift_falls_as_h4() {
    for seed in 0..3 {
        let crane = Interpreted::new(workspace::chain_of("conservative", &random::conservative(seed)));
        let start = State { t: 0.0, ..states::far(&crane.chain, 1, seed)[0].clone() };
        let energy = |state: &State| -> f64 {
            let parts = ["kinetic_energy", "gravity_energy", "support_energy", "element_energy"];
            parts.iter().map(|part| crane.scalar(part, state)).sum()
        };
        // The stiffest springs vibrate at about 500 rad/s, so the largest step is well inside the region of stability.
        let drift = |steps: u32| (energy(&after(&crane, &start, 0.02, steps)) - energy(&start)).abs();
        let drifts = [40, 80, 160].map(drift);
        for pair in drifts.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            // The leading error term may nearly vanish, which only raises the order.
            assert!(order > 3.7, "seed {seed}: order {order}, {drifts:?}");
        }
    }
}

/// Classical Runge–Kutta steps by the interpreter.
fn after(crane: &Interpreted, start: &State, duration: f64, steps: u32) -> State {
    let h = duration / f64::from(steps);
    let moved = |state: &State, rate: &(DVector<f64>, DVector<f64>), h: f64| State {
        t: state.t + h,
        q: state.q.iter().zip(&rate.0).map(|(q, r)| q + h * r).collect(),
        v: state.v.iter().zip(&rate.1).map(|(v, r)| v + h * r).collect(),
    };
    let rate = |state: &State| (DVector::from_column_slice(&state.v), crane.acceleration(state));
    (0..steps).fold(start.clone(), |state, _| {
        let k1 = rate(&state);
        let k2 = rate(&moved(&state, &k1, h / 2.0));
        let k3 = rate(&moved(&state, &k2, h / 2.0));
        let k4 = rate(&moved(&state, &k3, h));
        let mean =
            |a: &DVector<f64>, b: &DVector<f64>, c: &DVector<f64>, d: &DVector<f64>| (a + 2.0 * b + 2.0 * c + d) / 6.0;
        moved(&state, &(mean(&k1.0, &k2.0, &k3.0, &k4.0), mean(&k1.1, &k2.1, &k3.1, &k4.1)), h)
    })
}

/// d/dt (E_k + E_p) = power of drives, loads and winches − dissipation, along the motion that the equations give.
#[test]
fn power_balances() {
    for (seed, crane) in cranes() {
        for state in states::far(&crane.chain, 3, seed) {
            let acceleration = crane.acceleration(&state);
            let inputs = moving(crane, &state, (1.0, &state.v, acceleration.as_slice()));
            let parts = ["kinetic_energy"].into_iter().chain(POTENTIAL_ENERGIES);
            let rates: Vec<f64> = parts.map(|part| crane.get(part, &inputs, 1)[0].derivative()).collect();
            let supplied = crane.scalar("drive_power", &state)
                + crane.scalar("load_power", &state)
                + crane.scalar("winch_power", &state)
                - crane.scalar("dissipation", &state);
            let size = rates.iter().map(|rate| rate.abs()).sum();
            // q̈ comes from a dense solve, so its error grows with the condition number of A.
            assert_close(rates.iter().sum(), supplied, size, 1e-9, &format!("seed {seed}: {rates:?}"));
        }
    }
}

/// Rigid drives: their coordinates move as prescribed, `A q̈ = e + f` holds with the drive forces that this takes, and no linear
/// system has them among its unknowns.
#[test]
fn prescribed_coordinates_are_left_out_of_every_function() {
    let mut tested = 0;
    for (seed, crane) in cranes() {
        let (n, prescribed) = (crane.size(), crane.prescribed());
        tested += prescribed.len();
        for state in states::far(&crane.chain, 3, seed) {
            let acceleration = crane.acceleration(&state);
            let (mass, force) =
                (crane.matrix("mass_matrix", &state), crane.vector("bias", &state) + crane.vector("forces", &state));
            let size = (mass.abs() * acceleration.abs()).amax();
            assert!((&mass * &acceleration - &force).amax() < 1e-12 * size, "seed {seed}: A q̈ = e + f");
            let parts = [
                "support_forces",
                "element_forces",
                "drive_forces",
                "joint_damper_forces",
                "stop_forces",
                "friction_forces",
                "load_forces",
                "connector_forces",
            ];
            let sum = parts.iter().fold(DVector::zeros(n), |sum, part| sum + crane.vector(part, &state));
            let forces = crane.vector("forces", &state);
            assert!(
                (sum - &forces).amax() <= 1e-14 * forces.amax(),
                "seed {seed}: the forces are the sum of their parts"
            );

            let motions = moving(crane, &state, (1.0, &vec![0.0; n], &vec![0.0; n]));
            let motions = crane.get("prescribed_motions", &motions, 0);
            for (j, motion) in prescribed.iter().zip(motions.chunks(2)) {
                let (rate, expected) = (motion[1].derivative(), acceleration[*j]);
                assert_close(motion[0].derivative(), motion[1].value(), 1.0, 1e-13, &format!("seed {seed}, rate {j}"));
                assert_close(rate, expected, 1.0, 1e-12, &format!("seed {seed}, acceleration {j}"));
            }

            let right = DVector::from_column_slice(&state.v);
            let inputs = crane.inputs(&state).with(Argument::RightHandSide, state.v.clone());
            let x = DVector::from_vec(crane.get("solve_mass", &inputs, n));
            let (unknowns, right) = crane.unknowns(mass, right);
            assert!(prescribed.iter().all(|j| x[*j] == 0.0), "seed {seed}: prescribed coordinates are not solved for");
            let size = (unknowns.abs() * x.abs()).amax();
            assert!((unknowns * x - &right).amax() < 1e-12 * size, "seed {seed}: A x = r");
        }
    }
    assert!(tested >= 24, "{tested} rigid drives");
}

/// The residual is the gradient of the potential energy at any time and the tangent is its Hessian, by dual numbers.
#[test]
fn residual_and_tangent_are_derivatives_of_the_energy() {
    for (seed, crane) in cranes() {
        let n = crane.size();
        for state in states::far(&crane.chain, 2, seed) {
            let state = State { v: vec![0.0; n], ..state };
            let residual = crane.vector("static_residual", &state);
            let tangent = crane.matrix("tangent_stiffness", &state);
            let holding = crane.get("drive_forces_at_rest", &crane.inputs(&state), n);
            let loads = crane.vector("load_forces", &state);
            let mut jacobian = tangent.clone();
            for j in 0..n {
                let mut direction = vec![0.0; n];
                direction[j] = 1.0;
                let inputs = moving(crane, &state, (0.0, &direction, &vec![0.0; n]));
                let slopes: Vec<f64> =
                    POTENTIAL_ENERGIES.iter().map(|part| crane.get(part, &inputs, 1)[0].derivative()).collect();
                let of_oil = crane.slope_of_holding_energy(&state, &inputs);
                let size = slopes.iter().map(|slope| slope.abs()).sum::<f64>() + loads[j].abs() + of_oil.abs();
                let gradient = slopes.iter().sum::<f64>() - loads[j] + of_oil;
                if crane.prescribed().contains(&j) {
                    // Not an unknown: its drive balances the gradient, and it does not move.
                    assert_close(gradient, holding[j], size, 1e-11, &format!("seed {seed}, held {j}"));
                    assert!(residual[j] == 0.0, "seed {seed}, residual {j}");
                    let column: Vec<f64> = tangent.column(j).iter().copied().collect();
                    assert_eq!(column, direction, "seed {seed}, tangent {j}");
                    continue;
                }
                assert_close(gradient, residual[j], size, 1e-11, &format!("seed {seed}, residual {j}"));
                let column: Vec<f64> =
                    crane.get("static_residual", &inputs, n).into_iter().map(Dual::derivative).collect();
                jacobian.column_mut(j).copy_from_slice(&column);
            }
            // Moments and forces that turn with a link have no potential: the tangent is the symmetric part of the Jacobian.
            let symmetric = (&jacobian + jacobian.transpose()) * 0.5;
            assert!((symmetric - &tangent).amax() < 1e-12 * tangent.amax(), "seed {seed}: tangent");
        }
    }
}

/// The tangent is the derivative of the residual wherever the drives hold the crane: along a random direction, by dual numbers, with loads
/// and winches that move.
#[test]
fn the_tangent_is_the_derivative_of_the_residual_at_any_time_and_positions() {
    let (mut loads, mut winches) = (0, 0);
    for (seed, crane) in cranes() {
        let n = crane.size();
        let is_fixed = |j: usize| crane.prescribed().contains(&j);
        for state in states::far(&crane.chain, 2, seed) {
            assert!(state.t > 0.0, "seed {seed}");
            // Positions that no motion has, and a direction in which no prescribed coordinate moves.
            let positions: Vec<f64> = state.q.iter().zip(&state.v).map(|(q, v)| q + 0.02 * v.sin()).collect();
            let direction: Vec<f64> = (0..n).map(|j| if is_fixed(j) { 0.0 } else { state.v[j].sin() }).collect();
            let held = positions.iter().map(|position| Dual::new(*position, 0.0)).collect();
            let inputs = moving(crane, &state, (0.0, &direction, &vec![0.0; n])).with(Argument::DrivePositions, held);
            let along: Vec<f64> = crane.get("static_residual", &inputs, n).into_iter().map(Dual::derivative).collect();
            let inputs = crane.inputs(&state).with(Argument::DrivePositions, positions);
            let tangent = DMatrix::from_row_slice(n, n, &crane.get("tangent_stiffness", &inputs, n * n));
            let direction = DVector::from_vec(direction);
            // Of loads that turn with their link, the tangent has the symmetric part.
            let work = (DVector::from_vec(along) - &tangent * &direction).dot(&direction).abs();
            assert!(work < 1e-12 * tangent.amax() * direction.norm_squared(), "seed {seed}: {work:e}");
        }
        loads += crane.chain.loads.iter().filter(|load| load.scale.is_some()).count();
        winches += crane.chain.connectors().iter().filter_map(Force::winch).count();
    }
    assert!(loads >= 3 && winches >= 3, "{loads} loads and {winches} winches that change");
}

/// ∂T/∂q and ∂²T/∂q∂q against dual numbers through T and ∂T/∂q.
#[test]
fn transform_derivatives_are_derivatives() {
    for (seed, crane) in cranes().filter(|(seed, _)| seed % 24 < 4) {
        let n = crane.size();
        let moving_bodies: Vec<Vec<CoordinateId>> =
            (0..crane.chain.bodies.len()).map(|p| crane.chain.coordinates_of(BodyId(p))).collect();
        for state in states::far(&crane.chain, 1, seed) {
            let first = crane.get("transform_derivatives", &crane.inputs(&state), 0);
            let second = crane.get("transform_second_derivatives", &crane.inputs(&state), 0);
            for m in 0..n {
                let mut direction = vec![0.0; n];
                direction[m] = 1.0;
                let inputs = moving(crane, &state, (0.0, &direction, &vec![0.0; n]));
                let slopes = |function: &str| -> Vec<f64> {
                    crane.get(function, &inputs, 0).into_iter().map(Dual::derivative).collect()
                };
                let (of_pose, of_first) = (slopes("transforms"), slopes("transform_derivatives"));
                let (mut start, mut pairs) = (0, 0);
                for (body, coordinates) in moving_bodies.iter().enumerate() {
                    let count = coordinates.len();
                    let place = coordinates.binary_search(&CoordinateId(m)).ok();
                    for k in 0..16 {
                        let expected = place.map_or(0.0, |index| first[16 * (start + index) + k]);
                        assert_close(
                            of_pose[16 * body + k],
                            expected,
                            1.0,
                            1e-13,
                            &format!("seed {seed}, T of body {body}"),
                        );
                    }
                    for (m, j) in place.into_iter().flat_map(|index| (index..count).map(move |j| (index, j))) {
                        let pair = pairs + m * count - m * m.saturating_sub(1) / 2 + j - m;
                        for k in 0..16 {
                            let (a, b) = (of_first[16 * (start + j) + k], second[16 * pair + k]);
                            assert_close(a, b, 1.0, 1e-13, &format!("seed {seed}, body {body}, {m} {j}"));
                        }
                    }
                    start += count;
                    pairs += count * (count + 1) / 2;
                }
            }
        }
    }
}

/// Turning an unsupported crane about the vertical changes neither its energies nor its forces in its own frame.
#[test]
fn an_unsupported_crane_may_slew_freely() {
    let mut tested = 0;
    for seed in SEEDS {
        let spec = random::spec(seed);
        if !spec.contains("joint: free\n") {
            continue;
        }
        tested += 1;
        let spec: Vec<String> = spec
            .lines()
            .map(|line| if line.starts_with("gravity") { "gravity: [0, 0, -9.81]".into() } else { line.to_owned() })
            .collect();
        let text = spec.join("\n");
        let (start, end) = (text.find("supports:").unwrap(), text.find("drives:").unwrap());
        let free = format!("{}{}", &text[..start], &text[end..]).replace("  ground: {value: 4.0e3, unit: N/m}\n", "");
        let crane = Interpreted::new(workspace::chain_of("unsupported", &free));
        let foot = match &crane.chain.bodies[0].path[0] {
            crane_codegen::chain::Step::Translate(by) => Vector2::new(by[0].at(&[]), by[1].at(&[])),
            step => panic!("the foot is placed by a translation, not {step:?}"),
        };
        let turn = Rotation2::new(1.1);
        let turned = |x: &mut [f64], about: Vector2<f64>| {
            let moved = turn * (Vector2::new(x[0], x[1]) + about) - about;
            x[..2].copy_from_slice(moved.as_slice());
        };
        for state in states::far(&crane.chain, 3, seed) {
            let mut slewed = state.clone();
            turned(&mut slewed.q, foot);
            slewed.q[3] += 1.1;
            turned(&mut slewed.v, Vector2::zeros());
            for energy in ["kinetic_energy", "gravity_energy"] {
                let (a, b) = (crane.scalar(energy, &state), crane.scalar(energy, &slewed));
                assert_close(a, b, 1.0, 1e-12, &format!("seed {seed}: {energy}"));
            }
            let (mut bias, after) = (crane.vector("bias", &state), crane.vector("bias", &slewed));
            turned(bias.as_mut_slice(), Vector2::zeros());
            assert!((&bias - &after).amax() < 1e-11 * bias.amax(), "seed {seed}: bias");
        }
    }
    assert!(tested >= 4, "{tested} cranes on a free base");
}
