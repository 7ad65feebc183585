//! Derivatives of the residual and of accelerations on random cranes and on those shipped, against dual numbers through the functions themselves:
//! those that the runtime multiplies in loops, and those of straight-line code for C.

use crane_codegen::chain::{Chain, Loops};
use crane_codegen::program::{Argument, Inputs};
use crane_live::LiveCrane;
use crane_model::dyn_crane::Functions;
use crane_model::nalgebra::{DMatrix, DVector};
use crane_tests::dual::Dual;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::{random, states, workspace};

fn cranes() -> impl Iterator<Item = (String, Interpreted)> {
    let shipped = workspace::specs().into_iter().map(|path| {
        let source = workspace::source(&path);
        (source.name.clone(), Interpreted::new(workspace::chain_in(&source)))
    });
    let random = (0..12).map(|seed| (format!("random {seed}"), random::spec(seed)));
    let branched = (24..30).map(|seed| (format!("branched {seed}"), random::with_branches(seed)));
    let chains = random.chain(branched);
    shipped.chain(chains.map(|(name, spec)| (name, Interpreted::new(workspace::chain_of("random", &spec)))))
}

/// The state in dual numbers that change with one number of q, or of v.
fn along(crane: &Interpreted, state: &State, a: &[f64], (of_rates, j): (bool, usize)) -> Inputs<Dual> {
    let numbers = |values: &[f64], moves: bool| -> Vec<Dual> {
        let rate = |i: usize| if moves && i == j { 1.0 } else { 0.0 };
        values.iter().enumerate().map(|(i, value)| Dual::new(*value, rate(i))).collect()
    };
    let parameters = numbers(&crane.chain.parameter_defaults(), false);
    let (q, v) = (numbers(&state.q, !of_rates), numbers(&state.v, of_rates));
    Inputs::state(Dual::new(state.t, 0.0), q, v, parameters).with(Argument::Acceleration, numbers(a, false))
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for (name, crane) in cranes() {
        let n = crane.size();
        let live = LiveCrane::new(crane.chain.clone());
        let straight = Interpreted::new(Chain { loops: Loops::Never, ..crane.chain.clone() });
        for state in states::far(&crane.chain, 1, 7) {
            let a = crane.acceleration(&state);
            let inputs = crane.inputs(&state).with(Argument::Acceleration, a.as_slice().to_vec());
            let written_out = straight.get("dynamic_residual_derivatives", &inputs, 0);
            let (mut of_residual, mut of_motion) = (vec![f64::NAN; 2 * n * n], vec![f64::NAN; 3 * n * n]);
            live.dynamic_residual_derivatives(state.t, &state.q, &state.v, a.as_slice(), &mut of_residual);
            live.forward_dynamics_derivatives(state.t, &state.q, &state.v, &mut of_motion);
            for (block, of_rates) in [false, true].into_iter().enumerate() {
                let matrix = |rows: &[f64]| DMatrix::from_row_slice(n, n, &rows[block * n * n..(block + 1) * n * n]);
                let by_duals = |function: &str| {
                    let column = |j: usize| {
                        let slopes = crane.get(function, &along(&crane, &state, a.as_slice(), (of_rates, j)), n);
                        DVector::from_iterator(n, slopes.into_iter().map(Dual::derivative))
                    };
                    DMatrix::from_columns(&(0..n).map(column).collect::<Vec<_>>())
                };
                let expected = by_duals("dynamic_residual");
                for (way, found) in [("loops", &of_residual), ("straight", &written_out)] {
                    let (off, size) = ((matrix(found) - &expected).amax(), expected.amax());
                    // Rounding of the largest entry; positions of some metres and accelerations of some hundred cancel.
                    assert!(off <= 1e-12 * size, "{name}, r, {way}, rates {of_rates}: off by {off:e} of {size:e}");
                }
                let expected = by_duals("forward_dynamics");
                let (off, size) = ((matrix(&of_motion) - &expected).amax(), expected.amax());
                // The same, times the condition of A.
                assert!(off <= 1e-9 * size, "{name}, q̈, rates {of_rates}: off by {off:e} of {size:e}");
            }
            let mass = crane.matrix("mass_matrix", &state);
            let principal = mass.clone().symmetric_eigenvalues();
            let condition = principal.max() / principal.min();
            let inverse = DMatrix::from_row_slice(n, n, &of_motion[2 * n * n..]);
            for j in (0..n).filter(|j| !crane.prescribed().contains(j)) {
                let unit = DVector::from_fn(n, |i, _| if i == j { 1.0 } else { 0.0 });
                let (unknowns, right) = crane.unknowns(mass.clone(), unit);
                let product = unknowns * inverse.column(j);
                // A⁻¹ without what is prescribed, to a few roundings times the condition of A, of up to 6e7.
                let off = (product - right).amax();
                assert!(off <= 4.0 * f64::EPSILON * condition, "{name}, A⁻¹, column {j}: off by {off:e}");
            }
        }
    }
}
