//! Cranes with branches, by the interpreter.

use crane_codegen::chain::CoordinateId;
use crane_codegen::program::Argument;
use crane_codegen::{SourceFile, exchange};
use crane_model::nalgebra::DVector;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::{random, states, workspace};

fn crane(spec: &str) -> Interpreted {
    Interpreted::new(workspace::chain_of("branches", spec))
}

/// Coordinates of which neither is on the path of the other are not coupled: exactly zero, not nearly.
#[test]
fn branches_are_not_coupled_in_the_mass_matrix() {
    let mut apart = 0;
    for seed in 0..6 {
        let crane = crane(&random::with_branches(seed));
        let chain = &crane.chain;
        let on_path = |j: usize, k: usize| chain.moves(CoordinateId(j), chain.coordinates[k].body);
        for state in states::far(chain, 2, seed) {
            let matrix = crane.matrix("mass_matrix", &state);
            for (j, k) in (0..crane.size()).flat_map(|k| (0..k).map(move |j| (j, k))) {
                if on_path(j, k) {
                    continue;
                }
                assert!(matrix[(j, k)] == 0.0 && matrix[(k, j)] == 0.0, "seed {seed}: {j} and {k}");
                apart += 1;
            }
        }
    }
    assert!(apart > 1000, "{apart} pairs");
}

/// `(A + D̂) x = r` with any D̂ on the diagonal, from the factors and against a dense solution.
#[test]
fn systems_of_implicit_steps_are_solved() {
    for seed in 0..6 {
        let crane = crane(&random::with_branches(seed));
        for state in states::far(&crane.chain, 2, seed) {
            let n = crane.size();
            let added: Vec<f64> = (0..n).map(|j| 2.0 + (j as f64).sin()).collect();
            let inputs = crane.inputs(&state).with(Argument::AddedInertia, added.clone());
            let inputs = inputs.with(Argument::BaseAddedInertia, vec![0.0; 36]);
            let factors = crane.get("factorise", &inputs, 0);
            let inputs = inputs.with(Argument::Factors, factors).with(Argument::RightHandSide, state.v.clone());
            let x = DVector::from_vec(crane.get("solve", &inputs, n));
            let mut matrix = crane.matrix("mass_matrix", &state);
            let base: Vec<usize> = crane.chain.base.iter().flatten().map(|id| id.0).collect();
            for (j, added) in added.iter().enumerate().filter(|(j, _)| !base.contains(j)) {
                matrix[(j, j)] += added;
            }
            let (matrix, right) = crane.unknowns(matrix, DVector::from_column_slice(&state.v));
            let size = (matrix.abs() * x.abs()).amax();
            assert!((&matrix * &x - &right).amax() < 1e-12 * size, "seed {seed}");
        }
    }
}

/// A column whose slewing is held, and an arm of a flexible boom and a link, placed by `at` and named by a letter.
fn arm(letter: &str, on: &str, y: f64, turn: u32) -> String {
    format!(
        "  - name: boom_{letter}
{on}    placement: {{transform: {{translation: [0.3, {y}, 2], rotation: [{{z: {turn} deg}}, {{x: 90 deg}}]}}}}
    joint: revolute
    beam:
      length: 3
      sections: 3
      material: {{E: 2.1e11, G: 8.1e10, density: 7850}}
      section: {{box: {{height: 0.1, width: 0.08, thickness: 0.004}}}}
      damping: {{beta: 1.0e-3}}
  - {{name: stick_{letter}, joint: revolute, mass: 60, com: [0.7, 0.1, 0], inertia: {{gyration: [0.1, 0.4, 0.4]}}}}
  - {{name: load_{letter}, placement: {{transform: {{translation: [1.5, 0, 0]}}}}, joint: revolute, mass: 90, com: [0.4, 0, 0]}}
"
    )
}

fn with_links(links: &str) -> String {
    format!(
        "format: 1
name: arms
links:
  - {{name: column, joint: revolute, mass: 500, com: [0, 0, 1], inertia: {{gyration: [0.5, 0.5, 0.2]}}}}
{links}drives:
  - {{coordinate: column_psi, rigid: true, motion: {{hold: 0}}}}
analyses: [statics, dynamics, modes, internal_forces, derivatives]
"
    )
}

/// The places in `of` of the coordinates of `whole`, by their names; the letter of an arm may differ.
fn places(whole: &Interpreted, of: &Interpreted, renamed: impl Fn(&str) -> String) -> Vec<Option<usize>> {
    let position = |name: &str| of.chain.coordinates.iter().position(|coordinate| coordinate.name == renamed(name));
    whole.chain.coordinates.iter().map(|coordinate| position(&coordinate.name)).collect()
}

/// A vector or a state of one crane in the coordinates of another one; what the other lacks is dropped.
fn moved(of: &[f64], places: &[Option<usize>], size: usize) -> Vec<f64> {
    let mut there = vec![0.0; size];
    for (value, place) in of.iter().zip(places) {
        if let Some(index) = place {
            there[*index] = *value;
        }
    }
    there
}

/// One arm twice on a column that is held moves like two separate arms.
#[test]
fn two_arms_on_a_held_column_move_like_separate_arms() {
    let both = crane(&with_links(&format!("{}{}", arm("a", "", 0.5, 0), arm("b", "    on: column\n", -0.5, 140))));
    for (letter, y, turn) in [("a", 0.5, 0), ("b", -0.5, 140)] {
        let one = crane(&with_links(&arm(letter, "", y, turn)));
        let places = places(&both, &one, str::to_owned);
        assert_eq!(places.iter().flatten().count(), one.size());
        for state in states::far(&both.chain, 4, 7) {
            // The column is held at zero and does not move.
            let mut state = state;
            (state.q[0], state.v[0]) = (0.0, 0.0);
            let part = |of: &[f64]| moved(of, &places, one.size());
            let alone = State { q: part(&state.q), v: part(&state.v), ..state };
            let (together, apart) = (part(both.acceleration(&state).as_slice()), one.acceleration(&alone));
            let size = apart.amax();
            for (j, (a, b)) in together.iter().zip(&apart).enumerate() {
                assert!((a - b).abs() < 1e-12 * size, "arm {letter}, coordinate {j}: {a} and {b}");
            }
            for function in ["bias", "static_residual", "element_forces"] {
                let (together, apart) = (part(both.vector(function, &state).as_slice()), one.vector(function, &alone));
                // The column's own entry is the sum over both arms.
                for (j, (a, b)) in together.iter().zip(&apart).enumerate().skip(1) {
                    assert!((a - b).abs() <= 1e-13 * apart.amax(), "arm {letter}, {function} {j}: {a} and {b}");
                }
            }
        }
    }
}

/// The order in which branches are written changes the order of coordinates, and nothing else: also if links of one branch stand between
/// those of another one.
#[test]
fn the_order_in_which_branches_are_written_does_not_matter() {
    let [first, second] = [arm("a", "    on: column\n", 0.5, 0), arm("b", "    on: column\n", -0.5, 140)];
    let split = |arm: &str| -> (String, String) {
        let at = arm.find("  - {name: stick").expect("a stick");
        (arm[..at].to_owned(), arm[at..].to_owned())
    };
    let ((boom_a, rest_a), (boom_b, rest_b)) = (split(&first), split(&second));
    let on = |rest: &str, letter: &str| {
        rest.replacen(&format!("stick_{letter},"), &format!("stick_{letter}, on: boom_{letter},"), 1)
    };
    let orders = [
        format!("{first}{second}"),
        format!("{second}{first}"),
        format!("{boom_a}{boom_b}{}{}", on(&rest_a, "a"), on(&rest_b, "b")),
        format!("{boom_b}{boom_a}{}{}", on(&rest_b, "b"), on(&rest_a, "a")),
    ];
    let cranes: Vec<Interpreted> = orders.iter().map(|links| crane(&with_links(links))).collect();
    let reference = &cranes[0];
    for other in &cranes[1..] {
        let n = other.size();
        let places = places(reference, other, str::to_owned);
        for state in states::far(&reference.chain, 2, 3) {
            let there = State { q: moved(&state.q, &places, n), v: moved(&state.v, &places, n), ..state };
            for function in ["forward_dynamics", "bias", "static_residual", "element_forces"] {
                let [own, expected] = [other.vector(function, &there), reference.vector(function, &state)];
                let expected = moved(expected.as_slice(), &places, n);
                let size = own.amax();
                assert!(own.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-12 * size), "{function}");
            }
            for function in ["mass_matrix", "tangent_stiffness"] {
                let (own, expected) = (other.matrix(function, &there), reference.matrix(function, &state));
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    let [Some(k), Some(l)] = [places[i], places[j]] else { panic!("the same coordinates") };
                    assert!((own[(k, l)] - expected[(i, j)]).abs() <= 1e-13 * own.amax(), "{function} {i} {j}");
                }
            }
            for energy in ["kinetic_energy", "gravity_energy", "element_energy"] {
                let (a, b) = (other.scalar(energy, &there), reference.scalar(energy, &state));
                assert!((a - b).abs() <= 1e-13 * a.abs(), "{energy}: {a} and {b}");
            }
        }
    }
}

/// A tree of rigid links, written with branches between each other, comes back from URDF and MJCF with the same mass matrix.
#[test]
fn a_tree_comes_back_from_urdf_and_mjcf() {
    let link = |name: &str, on: &str, at: f64, joint: &str| {
        let inertia = "{Ixx: 0.5, Iyy: 0.9, Izz: 0.7, Ixy: 0.1, Ixz: -0.05, Iyz: 0.2}";
        format!(
            "  - {{name: {name}{on}, placement: {{transform: {{translation: [{at}, 0.2, 0.5], rotation: [{{z: 30 deg}}, {{y: {at}}}]}}}}, \
             joint: {joint}, mass: {}, com: [0.3, {at}, 0.1], inertia: {inertia}}}\n",
            3.0 + at
        )
    };
    let links = [
        link("trunk", "", 0.0, "revolute"),
        link("arm_a", "", 0.4, "{revolute: {axis: y}}"),
        link("arm_b", ", on: trunk", -0.5, "prismatic"),
        link("hand_a", ", on: {link: arm_a, at: [0.7, 0.1, 0]}", 0.1, "{revolute: {axis: x}}"),
        link("hand_b", ", on: arm_b", 0.2, "revolute"),
        link("tail", ", on: trunk", -0.3, "{revolute: {axis: y}}"),
    ];
    let tree = crane(&format!("format: 1\nname: tree\nlinks:\n{}", links.concat()));
    let values = tree.chain.parameter_defaults();
    let files = [
        exchange::urdf(&tree.chain, &values, &[]).expect("an open chain"),
        exchange::mjcf(&tree.chain, &values, &[], (&tree.chain.guess_at(&values), "guess")).expect("expressible"),
    ];
    for text in files {
        let imported = exchange::import(&SourceFile::new("tree.xml", text), &exchange::ImportOptions::default())
            .unwrap_or_else(|told| panic!("{told}"));
        let back = crane(&imported.spec);
        let places: Vec<usize> =
            places(&tree, &back, str::to_owned).into_iter().map(|place| place.expect("the same coordinates")).collect();
        for state in states::far(&tree.chain, 3, 1) {
            let given: Vec<Option<usize>> = places.iter().copied().map(Some).collect();
            let there =
                State { q: moved(&state.q, &given, back.size()), v: moved(&state.v, &given, back.size()), ..state };
            let (own, other) = (tree.matrix("mass_matrix", &state), back.matrix("mass_matrix", &there));
            for (i, j) in (0..tree.size()).flat_map(|i| (0..tree.size()).map(move |j| (i, j))) {
                // Orientations are written with all digits of their angles.
                assert!((own[(i, j)] - other[(places[i], places[j])]).abs() < 1e-13 * own.amax(), "{i} {j}");
            }
        }
    }
}
