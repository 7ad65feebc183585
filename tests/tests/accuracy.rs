//! Accuracy of the O(n) recursions under rounding, against A, e and forces of 192 bits and a dense elimination.
//!
//! The oracle shares neither the recursion nor its simplifications: A is Eq. (5) as printed, from the unsimplified program's
//! derivatives of all transforms. It takes the numbers of constant rotations as they are stored, whose `sin² + cos²` is 1 only
//! to 1e-16; composites rotated by formulas that assume exactly 1 are off by as much, which the elimination multiplies by thousands.

use std::ops::Add;

use crane_codegen::chain::{Analyses, BodyId, Chain, Inertia};
use crane_codegen::mechanics;
use crane_codegen::program::{Argument, FunctionId, Inputs, Program};
use crane_codegen::symbolic::Scalar;
use crane_tests::precise::{self, Precise};
use crane_tests::quantities::State;
use crane_tests::{random, states, workspace};

const DYNAMICS: Analyses = Analyses { statics: false, modes: false, internal_forces: false, ..Analyses::COMMAND };
const WITH_DERIVATIVES: Analyses = Analyses { derivatives: true, ..DYNAMICS };

/// Relative to the largest acceleration: rounding of the forces alone, 1e-16 of the stiffest spring, is multiplied by
/// about a hundred along the chain. The dense 64-bit solve is off by 3e-10 at 103 coordinates.
const TOLERANCE: f64 = 1e-13;
/// Roundings of a force: it is a sum of about this many terms.
const ROUNDINGS: f64 = 10.0;

struct Crane {
    chain: Chain,
    simple: Program,
    verbatim: Program,
}

impl Crane {
    fn new(chain: Chain) -> Self {
        let simple = mechanics::derive(&chain, DYNAMICS);
        let verbatim = mechanics::derive_verbatim(&chain, WITH_DERIVATIVES);
        Crane { chain, simple, verbatim }
    }

    fn shipped(name: &str) -> Self {
        Self::new(workspace::chain(name))
    }

    /// The reference crane with this many sections.
    fn reference(sections: usize) -> Self {
        Self::new(workspace::reference(sections))
    }

    fn size(&self) -> usize {
        self.chain.coordinates.len()
    }

    fn inputs<S: Scalar>(&self, state: &State) -> Inputs<S> {
        let all = |values: &[f64]| values.iter().map(|x| S::from_f64(*x)).collect();
        let parameters = self.chain.parameter_defaults();
        Inputs::state(S::from_f64(state.t), all(&state.q), all(&state.v), all(&parameters))
    }

    fn evaluate(&self, function: &str, inputs: &Inputs<f64>) -> Vec<f64> {
        self.simple.evaluate(self.simple.function(FunctionId::named(function).unwrap()).unwrap(), inputs)
    }

    fn precise(&self, function: &str, state: &State) -> Vec<Precise> {
        match FunctionId::named(function).and_then(|id| self.verbatim.function(id)) {
            Some(function) => self.verbatim.evaluate(function, &self.inputs(state)),
            None => vec![Precise::from_f64(0.0); self.size()],
        }
    }

    /// `a_ij = Σ tr(∂T/∂q_i H ∂Tᵀ/∂q_j)` over the bodies [Urbaś 2016, Eq. (5)], and rotors.
    fn mass_matrix(&self, state: &State) -> Vec<Vec<Precise>> {
        let n = self.size();
        let mut matrix = vec![vec![Precise::from_f64(0.0); n]; n];
        for rotor in &self.chain.rotors {
            let armature = rotor.armature.at(&self.chain.parameter_defaults());
            matrix[rotor.coordinate.0][rotor.coordinate.0] = Precise::from_f64(armature);
        }
        let entries = self.precise("transform_derivatives", state);
        // Three rows of four, one after the other.
        let mut derivatives = entries.chunks(12);
        for (index, body) in self.chain.bodies.iter().enumerate() {
            let coordinates = self.chain.coordinates_of(BodyId(index));
            let moving: Vec<_> = coordinates.iter().map(|id| id.0).zip(derivatives.by_ref()).collect();
            let Some(inertia) = &body.inertia else { continue };
            let pseudo_inertia = pseudo_inertia(inertia, &self.chain.parameter_defaults());
            for (place, (i, derivative)) in moving.iter().enumerate() {
                let product = |row: usize, column: usize| {
                    let terms = (0..4).map(|k| derivative[4 * row + k].clone() * pseudo_inertia[k][column].clone());
                    terms.fold(Precise::from_f64(0.0), Precise::add)
                };
                let momentum: Vec<Precise> = (0..12).map(|k| product(k / 4, k % 4)).collect();
                for (j, other) in &moving[place..] {
                    let terms = momentum.iter().zip(*other).map(|(a, b)| a.clone() * b.clone());
                    let sum = terms.fold(matrix[*i][*j].clone(), Precise::add);
                    matrix[*j][*i] = sum.clone();
                    matrix[*i][*j] = sum;
                }
            }
        }
        matrix
    }
}

/// H: second moments, first moments and mass of a body in its frame.
fn pseudo_inertia(inertia: &Inertia, parameters: &[f64]) -> [[Precise; 4]; 4] {
    let [xx, yy, zz, xy, xz, yz] = inertia.second.each_ref().map(|value| value.at(parameters));
    let [x, y, z] = inertia.first.each_ref().map(|value| value.at(parameters));
    let rows = [[xx, xy, xz, x], [xy, yy, yz, y], [xz, yz, zz, z], [x, y, z, inertia.mass.at(parameters)]];
    rows.map(|row| row.map(Precise::from_f64))
}

/// The largest error over the largest value.
fn error(values: &[f64], exact: &[Precise]) -> f64 {
    let size = exact.iter().map(|x| x.round().abs()).fold(0.0, f64::max);
    let off = values.iter().zip(exact).map(|(x, y)| (Precise::from_f64(*x) - y.clone()).round().abs());
    off.fold(0.0, f64::max) / size
}

fn check_forward_dynamics(crane: &Crane, count: usize, seed: u64) {
    for state in states::far(&crane.chain, count, seed) {
        let (bias, forces) = (crane.precise("bias", &state), crane.precise("forces", &state));
        let solve = |forces: &[Precise]| {
            let sum = bias.iter().zip(forces).map(|(bias, force)| bias.clone() + force.clone());
            precise::solve(crane.mass_matrix(&state), sum.collect())
        };
        let exact = solve(&forces);
        // The error due to rounding of the forces alone; a crane with a nearly massless link multiplies it by thousands.
        let rounded: Vec<Precise> = forces.iter().map(|force| Precise::from_f64(force.round())).collect();
        let of_rounding = error(&solve(&rounded).iter().map(Precise::round).collect::<Vec<f64>>(), &exact);
        let total = error(&crane.evaluate("forward_dynamics", &crane.inputs(&state)), &exact);
        let name = &crane.chain.name;
        assert!(
            total < TOLERANCE + ROUNDINGS * of_rounding,
            "{name}, {} coordinates, seed {seed}: {total:.1e}, by rounding of forces {of_rounding:.1e}",
            crane.size()
        );
    }
}

#[test]
fn forward_dynamics_of_shipped_cranes() {
    for spec in workspace::specs() {
        check_forward_dynamics(&Crane::shipped(spec.file_stem().unwrap().to_str().unwrap()), 8, 3);
    }
}

#[test]
fn forward_dynamics_of_random_cranes() {
    for seed in 0..24 {
        check_forward_dynamics(&Crane::new(workspace::chain_of("random", &random::spec(seed))), 2, seed);
    }
}

#[test]
fn forward_dynamics_of_103_coordinates() {
    for (crane, count) in [(Crane::reference(30), 3), (Crane::new(workspace::reference_symmetric(30)), 1)] {
        assert_eq!(crane.size(), 103);
        check_forward_dynamics(&crane, count, 5);
    }
}

/// `(A + D̂) x = r` with D̂ of an implicit step, and `A x = r`.
#[test]
fn structured_solves() {
    for (crane, h) in [
        (Crane::shipped("eight_link_flexible"), 1e-3),
        (Crane::shipped("eight_link_two_flexible"), 1e-2),
        (Crane::shipped("cantilever"), 1e-2),
        (Crane::shipped("knuckle_boom"), 1e-2),
        (Crane::reference(30), 1e-3),
        (Crane::new(workspace::reference_symmetric(4)), 1e-3),
    ] {
        for state in states::far(&crane.chain, 2, 11) {
            let inputs = crane.inputs(&state).with(Argument::RightHandSide, state.v.clone());
            let right: Vec<Precise> = state.v.iter().map(|x| Precise::from_f64(*x)).collect();
            let exact = precise::solve(crane.mass_matrix(&state), right.clone());
            let of_mass = error(&crane.evaluate("solve_mass", &inputs), &exact);
            assert!(of_mass < TOLERANCE, "{}: A x = r to {of_mass:.1e}", crane.chain.name);

            let (added_inertia, base) = added_inertia(&crane, &inputs, h);
            let mut matrix = crane.mass_matrix(&state);
            let held = crane.chain.base.iter().flatten().count();
            for i in 0..crane.size() {
                for j in 0..crane.size() {
                    let added = match (i < held && j < held, i == j) {
                        (true, _) => base[i.min(j) + 6 * i.max(j)],
                        (false, true) => added_inertia[i],
                        (false, false) => 0.0,
                    };
                    matrix[i][j] = matrix[i][j].clone() + Precise::from_f64(added);
                }
            }
            let exact = precise::solve(matrix, right);
            let inputs = inputs.with(Argument::AddedInertia, added_inertia).with(Argument::BaseAddedInertia, base);
            let factors = crane.evaluate("factorise", &inputs);
            let of_sum = error(&crane.evaluate("solve", &inputs.with(Argument::Factors, factors)), &exact);
            // Springs stiffer than h⁻² times the inertias leave fewer digits for these in the sum.
            assert!(of_sum < 1e-12, "{}: (A + D̂) x = r to {of_sum:.1e}", crane.chain.name);
        }
    }
}

/// `h D + h² K`: its diagonal, and the base's block column by column.
fn added_inertia(crane: &Crane, inputs: &Inputs<f64>, h: f64) -> (Vec<f64>, Vec<f64>) {
    let step = |stiffness: f64, damping: f64| h * damping + h * h * stiffness;
    let joints = crane.evaluate("joint_stiffness_and_damping", inputs);
    let diagonal = joints.chunks(2).map(|pair| step(pair[0], pair[1])).collect();
    let mut base = vec![0.0; 36];
    if crane.simple.function(FunctionId::BaseStiffness).is_some() {
        let (stiffness, damping) = (crane.evaluate("base_stiffness", inputs), crane.evaluate("base_damping", inputs));
        let upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
        for ((i, j), (stiffness, damping)) in upper.zip(stiffness.iter().zip(&damping)) {
            base[i + 6 * j] = step(*stiffness, *damping);
        }
    }
    (diagonal, base)
}
