//! The effect of the errors in the printed formulas [Urbaś 2016], each on a crane where it is visible. docs/EQUATIONS.md
//! explains them.

use crane_codegen::chain::{Force, Group, Inertia};
use crane_model::nalgebra::{DVector, Matrix3, Matrix4, Matrix6, SMatrix, Vector3, Vector6};
use crane_tests::interpreted::Interpreted;
use crane_tests::{states, workspace};

type U = SMatrix<f64, 3, 6>;

/// H of Eq. (4).
fn pseudo_inertia(inertia: &Inertia, parameters: &[f64]) -> Matrix4<f64> {
    let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(|i| inertia.second[i].at(parameters));
    let [x, y, z] = [0, 1, 2].map(|i| inertia.first[i].at(parameters));
    Matrix4::new(xx, xy, xz, x, xy, yy, yz, y, xz, yz, zz, z, x, y, z, inertia.mass.at(parameters))
}

/// The triple sum of Eq. (5), over m and all n (right), or n ≥ m once (as printed).
fn velocity_forces(crane: &Interpreted, state: &crane_tests::quantities::State, printed: bool) -> DVector<f64> {
    let inputs = crane.inputs(state);
    let (first, second) =
        (crane.get("transform_derivatives", &inputs, 0), crane.get("transform_second_derivatives", &inputs, 0));
    let matrix = |values: &[f64], k: usize| Matrix4::from_row_slice(&values[16 * k..16 * (k + 1)]);
    let parameters = crane.chain.parameter_defaults();
    let mut h = DVector::zeros(crane.size());
    let (mut start, mut pair) = (0, 0);
    for (p, body) in crane.chain.bodies.iter().enumerate() {
        let count = crane.chain.degrees_of_freedom(crane_codegen::chain::BodyId(p));
        if let Some(inertia) = &body.inertia {
            let inertia = pseudo_inertia(inertia, &parameters);
            let mut acceleration = Matrix4::zeros();
            let mut k = pair;
            for m in 0..count {
                for n in m..count {
                    let weight = if n > m && !printed { 2.0 } else { 1.0 };
                    acceleration += matrix(&second, k) * (weight * state.v[m] * state.v[n]);
                    k += 1;
                }
            }
            for i in 0..count {
                h[i] += (matrix(&first, start + i) * inertia * acceleration.transpose()).trace();
            }
        }
        start += count;
        pair += count * (count + 1) / 2;
    }
    h
}

#[test]
fn eq_5_summed_once_halves_the_coriolis_forces() {
    let crane = Interpreted::new(workspace::chain("eight_link_rigid"));
    for state in states::far(&crane.chain, 3, 5) {
        let rest = crane_tests::quantities::State { v: vec![0.0; crane.size()], ..state.clone() };
        let h = crane.vector("bias", &rest) - crane.vector("bias", &state);
        let right = velocity_forces(&crane, &state, false);
        // A triple sum of ten thousand terms that cancel.
        assert!((&right - &h).amax() < 1e-11 * h.amax(), "the full sum is the recursion's result");
        let printed = velocity_forces(&crane, &state, true);
        let off = (printed - &h).amax() / h.amax();
        assert!(off > 0.1, "the print is off by {:.0} %", 100.0 * off);
    }
}

fn reference_supports() -> Vec<([f64; 3], Vector3<f64>)> {
    let chain = workspace::chain("eight_link_rigid");
    let numbers = |values: &[crane_codegen::chain::Value; 3]| [0, 1, 2].map(|i| values[i].at(&[]));
    chain.supports.iter().map(|s| (numbers(&s.position), Vector3::from(numbers(&s.stiffness)))).collect()
}

/// Columns in the order x y z ψ θ φ.
fn right_u([x, y, z]: [f64; 3]) -> U {
    U::from_row_slice(&[1., 0., 0., -y, z, 0., 0., 1., 0., x, 0., -z, 0., 0., 1., 0., -x, y])
}

/// As printed in Eq. (16): rotations in the order φ θ ψ, against q̃ in the order ψ θ φ.
fn printed_u([x, y, z]: [f64; 3]) -> U {
    U::from_row_slice(&[1., 0., 0., 0., z, -y, 0., 1., 0., -z, 0., x, 0., 0., 1., y, -x, 0.])
}

/// Generalized forces of the supports of the rigid reference crane, displaced in one coordinate of its base.
fn support_forces(coordinate: usize, by: f64) -> DVector<f64> {
    let crane = Interpreted::new(workspace::chain("eight_link_rigid"));
    let mut state = crane_tests::quantities::State { t: 0.0, q: vec![0.0; crane.size()], v: vec![0.0; crane.size()] };
    state.q[coordinate] = by;
    crane.vector("support_forces", &state)
}

#[test]
fn eq_16_printed_column_order_lets_yaw_push_the_vertical_springs() {
    let yaw = Vector6::new(0.0, 0.0, 0.0, 0.01, 0.0, 0.0);
    let force = |(at, s): ([f64; 3], Vector3<f64>)| -right_u(at).transpose() * s.component_mul(&(right_u(at) * yaw));
    let right = reference_supports().into_iter().map(force).sum::<Vector6<f64>>();
    let ours = support_forces(3, 0.01);
    // Rounding of products and sums over eight feet.
    assert!((right - ours.fixed_rows::<6>(0)).amax() < 1e-12 * right.amax(), "{ours} instead of {right}");
    let lift = |u: fn([f64; 3]) -> U| -> f64 {
        reference_supports().iter().map(|&(at, s)| (s.z * (u(at) * yaw).z).abs()).sum()
    };
    assert_eq!(lift(right_u), 0.0);
    // Eight feet, 0, 1, 8 and 9 m from the origin, 1e7 N/m, 0.01 rad.
    assert!((lift(printed_u) - 2.0 * (1.0 + 8.0 + 9.0) * 1e7 * 0.01).abs() < 1e-3, "{} N", lift(printed_u));
}

#[test]
fn eq_16_with_an_absolute_value_is_undefined_at_rest_and_has_two_wells() {
    // Force s (|u| − l₀)/|u| u of Eq. (18), for one spring.
    let printed = |u: f64, free: f64| 1e7 * (u.abs() - free) / u.abs() * u;
    assert!(printed(0.0, 0.0).is_nan(), "0/0 where the crane stands");
    assert!(printed(0.005, 0.01) < 0.0 && printed(-0.005, 0.01) > 0.0, "it pushes away between two wells");
    // Ours is defined at rest, and pulls back from every displacement.
    for coordinate in 0..6 {
        assert_eq!(support_forces(coordinate, 0.0).amax(), 0.0);
        for by in [1e-12, 1e-3, 0.1] {
            let [up, down] = [by, -by].map(|by| support_forces(coordinate, by)[coordinate]);
            assert!(up < 0.0 && (up + down).abs() <= 1e-12 * up.abs(), "{coordinate}: {up} and {down}");
        }
    }
}

#[test]
fn eq_18_with_u_transposed_u_counts_each_spring_three_times() {
    let (mut right, mut printed) = (Matrix6::zeros(), Matrix6::zeros());
    for (at, s) in reference_supports() {
        let u = right_u(at);
        right += u.transpose() * Matrix3::from_diagonal(&s) * u;
        printed += s.sum() * u.transpose() * u;
    }
    assert_eq!(right[(2, 2)], 8e7);
    assert_eq!(printed[(2, 2)], 8.0 * 1.6e7, "vertical stiffness 1.6 times too high");
    assert_eq!(printed[(0, 0)] / right[(0, 0)], 1.6e7 / 3e6, "horizontal stiffness 5.3 times too high");
    for j in 0..6 {
        for i in 0..6 {
            let (force, expected) = (support_forces(j, 1e-3)[i], -1e-3 * right[(i, j)]);
            assert!((force - expected).abs() <= 1e-12 * right.amax(), "{i} {j}: {force} against {expected}");
        }
    }
}

/// Tip deflection under a unit force of a cantilever of unit length and stiffness with springs at these places, each
/// bending as a section of length d.
fn tip_deflection(springs: &[f64], d: f64) -> f64 {
    springs.iter().map(|x| d * (1.0 - x) * (1.0 - x)).sum()
}

/// Where the springs of the cantilever are, and the length of a section; its length is 1.
fn cantilever() -> (Vec<f64>, f64) {
    let chain = workspace::chain("cantilever");
    let parameters = chain.parameter_defaults();
    let lengths: Vec<f64> = chain.bodies.iter().map(|body| body.length.at(&parameters)).collect();
    let whole: f64 = lengths.iter().sum();
    let ends = lengths.iter().scan(0.0, |end, length| {
        *end += length / whole;
        Some(*end)
    });
    // Three springs at the beginning of every element but the first.
    let joints = chain.element_springs().count() / 3;
    (ends.take(joints).collect(), 1.0 / joints as f64)
}

#[test]
fn translations_of_elements_as_printed_put_the_springs_in_the_wrong_places() {
    let (places, d) = cantilever();
    let n = 1.0 / d;
    let right = tip_deflection(&places, d);
    // Rounding of a few sums of numbers below 1.
    assert!((3.0 * right - (1.0 - 1.0 / (4.0 * n * n))).abs() < 1e-14, "the law of the cantilever: {places:?}");
    // Printed: element i is translated by l(i) instead of l(i−1). All springs but the last move outward by half a section.
    let last = places.len() - 1;
    let printed: Vec<f64> = places.iter().enumerate().map(|(i, x)| x + if i < last { 0.5 * d } else { 0.0 }).collect();
    let printed = tip_deflection(&printed, d);
    assert!(printed < 0.9 * right, "{:.0} % of the right deflection", 100.0 * printed / right);
}

#[test]
fn eqs_11_14_15_with_one_spring_too_many_are_too_soft() {
    let (places, d) = cantilever();
    // i = 1 … n_rfe = n + 1: the additional spring can only sit at the joint, where element 0 has none.
    let printed = tip_deflection(&[&[0.0][..], &places].concat(), d);
    let right = tip_deflection(&places, d);
    assert!(printed > 1.3 * right, "{:.2} times the right deflection", printed / right);
}

#[test]
fn eq_14_with_positions_in_the_dissipation_dissipates_at_rest() {
    let crane = Interpreted::new(workspace::chain("eight_link_flexible"));
    let state = crane_tests::quantities::State { t: 100.0, ..crane.equilibrium() };
    let elements = crane.chain.forces_of_group(Group::Elements).iter();
    let damper = |force: &Force| Some((force.coordinate()?.0, force.spring()?.damping.at(&[])));
    let printed: f64 = elements.filter_map(damper).map(|(j, damping)| damping * state.q[j].powi(2)).sum();
    let mut at_rest = state.clone();
    at_rest.v.fill(0.0);
    assert_eq!(crane.scalar("dissipation", &at_rest), 0.0);
    assert!(printed > 1e-3, "{printed} W in a crane that does not move");
}

#[test]
fn eq_23_with_rates_in_the_energy_gives_supports_without_stiffness() {
    let crane = Interpreted::new(workspace::chain("eight_link_rigid"));
    let state = crane.equilibrium();
    let energy = |state: &crane_tests::quantities::State| crane.scalar("support_energy", state);
    let slope = |of: fn(&mut crane_tests::quantities::State) -> &mut f64| {
        let at = |by: f64| {
            let mut state = state.clone();
            *of(&mut state) += by;
            energy(&state)
        };
        (at(1e-6) - at(-1e-6)) / 2e-6
    };
    // ∂E_p/∂q̇ is zero: as printed, nothing would carry the crane. −∂E_p/∂q is the force along z.
    assert_eq!(slope(|state| &mut state.v[2]), 0.0);
    let force = crane.vector("support_forces", &state)[2];
    // A difference of energies of some kJ over 2 µm.
    assert!(force > 1.6e5 && (slope(|state| &mut state.q[2]) + force).abs() < 1e-5 * force, "{force} N");
}
