//! Identities on random cranes whose stiffnesses and masses span many powers of ten, by the interpreter.

use crane_codegen::chain::{Chain, Group, Law, Transmission, Value};
use crane_codegen::program::{Argument, Inputs};
use crane_model::nalgebra::{DMatrix, DVector};
use crane_tests::dual::Dual;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::{random, states, workspace};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Of a sum, relative to the terms that cancel in it: the recursions over 20 coordinates round about a hundred times per number,
/// and each of six joints may lose a digit where it carries a mass that is a millionth of its neighbour's.
const TOLERANCE: f64 = 1e-9;

/// A random crane at an extreme: powers of ten for the stiffness of drives, elements and supports, and for the masses of
/// the bodies, cyclically.
#[derive(Clone, Debug)]
struct Extreme {
    seed: u64,
    springs: [i32; 3],
    masses: [i32; 4],
    /// θ of elements and base, as a fraction of 90°.
    lean: f64,
}

fn extreme() -> impl Strategy<Value = Extreme> {
    let powers = [-4..7, -4..7, -4..7];
    let masses = [-3..4, -3..4, -3..4, -3..4];
    (0_u64..1000, powers, masses, 0.0..0.999).prop_map(|(seed, springs, masses, lean)| Extreme {
        seed,
        springs,
        masses,
        lean,
    })
}

fn scaled(value: &mut Value, factor: f64) {
    *value = Value::Mul(Box::new(value.clone()), Box::new(Value::Constant(factor)));
}

impl Extreme {
    fn chain(&self) -> Chain {
        let mut chain = workspace::chain_of("random", &random::spec(self.seed));
        let [drives, elements, supports] = self.springs.map(|power| 10_f64.powi(power));
        for drive in &mut chain.drives {
            if let Transmission::Flexible { stiffness, .. } = &mut drive.transmission {
                scaled(stiffness, drives);
            }
        }
        for force in chain.forces.iter_mut().filter(|force| force.group == Group::Elements) {
            let Law::Spring(spring) = &mut force.law else { unreachable!("elements have springs") };
            scaled(&mut spring.stiffness, elements);
        }
        for stiffness in chain.supports.iter_mut().flat_map(|support| &mut support.stiffness) {
            scaled(stiffness, supports);
        }
        for (inertia, power) in
            chain.bodies.iter_mut().filter_map(|b| b.inertia.as_mut()).zip(self.masses.iter().cycle())
        {
            let factor = 10_f64.powi(*power);
            let parts = inertia.first.iter_mut().chain(&mut inertia.second).chain([&mut inertia.mass]);
            parts.for_each(|part| scaled(part, factor));
        }
        chain
    }

    /// A state far from any pose, the second angle of every element and of the base at up to ±90°.
    fn state(&self, chain: &Chain) -> State {
        let mut state = states::far(chain, 1, self.seed).remove(0);
        for (coordinate, q) in chain.coordinates.iter().zip(&mut state.q) {
            if coordinate.name.ends_with("_theta") && q.abs() <= 0.5 {
                *q = q.signum() * self.lean * std::f64::consts::FRAC_PI_2;
            }
        }
        state
    }
}

/// Maximum of `|sum|` over the maximum sum of the magnitudes of its terms, both scaled so that A has a unit diagonal.
fn cancelled(matrix: &DMatrix<f64>, x: &DVector<f64>, terms: &[&DVector<f64>]) -> f64 {
    let scale = |i: usize| matrix[(i, i)].sqrt().recip();
    let sum = matrix * x - terms.iter().fold(DVector::zeros(x.len()), |sum, term| sum + *term);
    let size = |i: usize| {
        let products: f64 = (0..x.len()).map(|j| (matrix[(i, j)] * x[j]).abs()).sum();
        (products + terms.iter().map(|term| term[i].abs()).sum::<f64>()) * scale(i)
    };
    let greatest = (0..x.len()).map(size).fold(f64::MIN_POSITIVE, f64::max);
    (0..x.len()).map(|i| sum[i].abs() * scale(i)).fold(0.0, f64::max) / greatest
}

/// `h² K + h D` of joints and base for a step h.
fn added_inertias(crane: &Crane, h: f64) -> (Vec<f64>, Vec<f64>, DMatrix<f64>) {
    let (n, inputs) = (crane.interpreted.size(), crane.interpreted.inputs(&crane.state));
    let step = |stiffness: f64, damping: f64| h * h * stiffness + h * damping;
    let joints = crane.interpreted.get("joint_stiffness_and_damping", &inputs, 2 * n);
    let diagonal: Vec<f64> = joints.chunks(2).map(|pair| step(pair[0], pair[1])).collect();
    let blocks = ["base_stiffness", "base_damping"].map(|name| crane.interpreted.get(name, &inputs, 36));
    let base: Vec<f64> = blocks[0].iter().zip(&blocks[1]).map(|(s, d)| step(*s, *d)).collect();
    let held = crane.interpreted.chain.base.iter().flatten().count();
    let added = DMatrix::from_fn(n, n, |i, j| match (i < held && j < held, i == j) {
        (true, _) => base[i + 6 * j],
        (false, true) => diagonal[i],
        (false, false) => 0.0,
    });
    (diagonal, base, added)
}

struct Crane {
    interpreted: Interpreted,
    state: State,
}

impl Crane {
    fn new(extreme: &Extreme) -> Self {
        let chain = extreme.chain();
        let state = extreme.state(&chain);
        Crane { interpreted: Interpreted::new(chain), state }
    }

    fn vector(&self, function: &str) -> DVector<f64> {
        self.interpreted.vector(function, &self.state)
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2016),
        ..ProptestConfig::default()
    })]

    /// `A q̈ = e + f` and `½ vᵀ A v = E_k`, with A symmetric positive definite: the recursion does not use the matrix.
    #[test]
    fn accelerations_obey_the_equations_of_motion(extreme in extreme()) {
        let crane = Crane::new(&extreme);
        let mass = crane.interpreted.matrix("mass_matrix", &crane.state);
        prop_assert!(mass.clone().cholesky().is_some(), "A is not positive definite");
        let (x, e, f) = (crane.vector("forward_dynamics"), crane.vector("bias"), crane.vector("forces"));
        let off = cancelled(&mass, &x, &[&e, &f]);
        prop_assert!(off < TOLERANCE, "q̈ off by {off:.1e}");

        let v = DVector::from_column_slice(&crane.state.v);
        let (energy, kinetic) = (0.5 * v.dot(&(&mass * &v)), crane.interpreted.scalar("kinetic_energy", &crane.state));
        prop_assert!((energy - kinetic).abs() < TOLERANCE * kinetic, "{energy} against {kinetic}");
    }

    /// `(A + D̂) x = r` of an implicit step, for steps that resolve the springs and for steps that do not.
    #[test]
    fn implicit_systems_are_solved(extreme in extreme(), power in -6..0_i32) {
        let crane = Crane::new(&extreme);
        let mass = crane.interpreted.matrix("mass_matrix", &crane.state);
        let (added_inertia, base, added) = added_inertias(&crane, 10_f64.powi(power));
        // The actual forces.
        let right = crane.vector("bias") + crane.vector("forces");
        let inputs: Inputs<f64> = crane.interpreted.inputs(&crane.state)
            .with(Argument::RightHandSide, right.as_slice().to_vec())
            .with(Argument::AddedInertia, added_inertia)
            .with(Argument::BaseAddedInertia, base);
        let factors = crane.interpreted.get("factorise", &inputs, 0);
        let x = crane.interpreted.get("solve", &inputs.with(Argument::Factors, factors), right.len());
        let (matrix, right) = crane.interpreted.unknowns(mass + added, right);
        let off = cancelled(&matrix, &DVector::from_vec(x), &[&right]);
        prop_assert!(off < TOLERANCE, "x off by {off:.1e}");
    }

    /// The residual is the gradient of the energy less the load forces, and the tangent is the derivative of the residual: along a
    /// random direction, by dual numbers.
    #[test]
    fn statics_are_derivatives_of_the_energy(extreme in extreme()) {
        let crane = Crane::new(&extreme);
        let n = crane.interpreted.size();
        let mut direction = crane.state.v.clone();
        crane.interpreted.prescribed().into_iter().for_each(|j| direction[j] = 0.0);
        let state = State { v: vec![0.0; n], ..crane.state };
        let pairs = |x: &[f64], d: &[f64]| x.iter().zip(d).map(|(x, d)| Dual::new(*x, *d)).collect();
        let parameters = crane.interpreted.chain.parameter_defaults().into_iter().map(|p| Dual::new(p, 0.0)).collect();
        let inputs = Inputs::state(Dual::new(state.t, 0.0), pairs(&state.q, &direction), pairs(&state.v, &state.v), parameters);
        let along = DVector::from_vec(direction);

        let residual = crane.interpreted.vector("static_residual", &state);
        let parts = ["gravity_energy", "support_energy", "element_energy", "drive_energy", "stop_energy", "connector_energy"];
        let slopes = parts.map(|part| crane.interpreted.get(part, &inputs, 1)[0].derivative());
        // Applied loads have no energy; they contribute the work that they do along the direction.
        let work = crane.interpreted.vector("load_forces", &state).dot(&along);
        let of_oil = crane.interpreted.slope_of_holding_energy(&state, &inputs);
        let size = slopes.iter().map(|slope| slope.abs()).sum::<f64>() + work.abs() + of_oil.abs()
            + residual.iter().zip(&along).map(|(r, d)| (r * d).abs()).sum::<f64>();
        let off = (slopes.iter().sum::<f64>() + of_oil - work - residual.dot(&along)).abs();
        prop_assert!(off < TOLERANCE * size, "residual off by {off:.1e} of {size:.1e}");

        let tangent = crane.interpreted.matrix("tangent_stiffness", &state);
        let change: Vec<f64> = crane.interpreted.get("static_residual", &inputs, n).into_iter().map(Dual::derivative).collect();
        let off = &tangent * &along - DVector::from_vec(change);
        // The tangent of a load that turns with its link is not symmetric; only its symmetric part is used.
        let off = if crane.interpreted.chain.loads.is_empty() { off.amax() } else { off.dot(&along).abs() / along.norm() };
        prop_assert!(off < TOLERANCE * tangent.amax(), "tangent off by {off:.1e} of {:.1e}", tangent.amax());
    }

    /// The energy changes by the power of drives, loads and winches less the dissipation.
    #[test]
    fn power_balances(extreme in extreme()) {
        let crane = Crane::new(&extreme);
        let State { t, q, v } = &crane.state;
        let pairs = |x: &[f64], d: &[f64]| x.iter().zip(d).map(|(x, d)| Dual::new(*x, *d)).collect();
        let parameters = crane.interpreted.chain.parameter_defaults().into_iter().map(|p| Dual::new(p, 0.0)).collect();
        let acceleration = crane.vector("forward_dynamics");
        let inputs = Inputs::state(Dual::new(*t, 1.0), pairs(q, v), pairs(v, acceleration.as_slice()), parameters);
        let parts = ["kinetic_energy", "gravity_energy", "support_energy", "element_energy", "drive_energy", "stop_energy", "connector_energy"];
        let rates = parts.map(|part| crane.interpreted.get(part, &inputs, 1)[0].derivative());
        let scalar = |function: &str| crane.interpreted.scalar(function, &crane.state);
        let supplied = scalar("drive_power") + scalar("load_power") + scalar("winch_power") - scalar("dissipation");
        let off = (rates.iter().sum::<f64>() - supplied).abs();
        // The power that coordinates exchange through inertia forces cancels in the sum.
        let mass = crane.interpreted.matrix("mass_matrix", &crane.state);
        let exchanged = (0..v.len()).map(|i| (0..v.len()).map(|j| (v[i] * mass[(i, j)] * acceleration[j]).abs()).sum::<f64>());
        let size = rates.iter().map(|rate| rate.abs()).sum::<f64>() + exchanged.sum::<f64>();
        prop_assert!(off < TOLERANCE * size, "off by {off:.1e} W of {size:.1e} W");
    }
}
