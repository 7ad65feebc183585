//! Generated code computes what its program defines, and simplification changes nothing but rounding.

use crane_codegen::chain::Analyses;
use crane_codegen::compile;
use crane_codegen::mechanics;
use crane_codegen::program::{Argument, FunctionId, Inputs, Program};
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::{IMPLICIT_STEP, Quantity, State, quantities};
use crane_tests::registry::{self, Entry};
use crane_tests::runtime::Runtime;
use crane_tests::{random, states, workspace};

fn load(entry: &Entry) -> Interpreted {
    Interpreted::new(workspace::chain_in(&workspace::source(&entry.spec())))
}

/// One quantity of `evaluate` by the interpreter.
fn interpret(crane: &Interpreted, quantity: &Quantity, inputs: &Inputs<Runtime>) -> Vec<Runtime> {
    let n = crane.size();
    let linearised = |k: usize| crane.get("linearise", inputs, 3 * n * n)[k * n * n..(k + 1) * n * n].to_vec();
    match quantity.name {
        "linearised_mass" => linearised(0),
        "linearised_stiffness" => linearised(1),
        "linearised_damping" => linearised(2),
        "mass_matrix_lower" => {
            let both = crane.get("mass_matrix_and_bias", inputs, 0);
            let entry = |i: usize, j: usize| if j <= i { both[i * n + j] } else { Runtime(0.0) };
            (0..n * n).map(|k| entry(k / n, k % n)).collect()
        }
        "bias_with_mass_matrix" => crane.get("mass_matrix_and_bias", inputs, 0).split_off(n * n),
        "lane_forward_dynamics" => crane.get("forward_dynamics", inputs, n),
        "implicit_solution" => implicit_solution(crane, inputs),
        "prescribed" => prescribed(crane, inputs),
        name => crane.get(name, inputs, quantity.len()),
    }
}

/// Coordinates and rates, with the prescribed ones set.
fn prescribed(crane: &Interpreted, inputs: &Inputs<Runtime>) -> Vec<Runtime> {
    let mut state = [inputs.get(Argument::Position), inputs.get(Argument::Velocity)];
    for (j, motion) in crane.prescribed().into_iter().zip(crane.get("prescribed_motions", inputs, 0).chunks(2)) {
        (state[0][j], state[1][j]) = (motion[0], motion[1]);
    }
    state.concat()
}

/// As `quantities` computes it.
fn implicit_solution(crane: &Interpreted, inputs: &Inputs<Runtime>) -> Vec<Runtime> {
    let h = Runtime(IMPLICIT_STEP);
    let joints = crane.get("joint_stiffness_and_damping", inputs, 2 * crane.size());
    let added_inertia = joints.chunks(2).map(|pair| h * pair[1] + h * h * pair[0]).collect();
    let (damping, stiffness) = (crane.get("base_damping", inputs, 36), crane.get("base_stiffness", inputs, 36));
    let base = damping.into_iter().zip(stiffness).map(|(d, s)| d * h + s * (h * h)).collect();
    let system = inputs.clone().with(Argument::AddedInertia, added_inertia).with(Argument::BaseAddedInertia, base);
    let factors = crane.get("factorise", &system, 0);
    crane.get(
        "solve",
        &system.with(Argument::Factors, factors).with(Argument::RightHandSide, inputs.get(Argument::Velocity)),
        0,
    )
}

/// Where the target has a fused multiply-add, generated code rounds less often than the interpreter. The tolerance is relative
/// to the largest value, and allows for the magnified rounding of accelerations; where all terms cancel, it is relative to 1.
const FUSED: Option<f64> = if cfg!(any(target_feature = "fma", target_arch = "aarch64")) { Some(1e-11) } else { None };

/// What the runtime multiplies of generated factors, by the same loops for all cranes:
/// `tests/tests/generated/motion_derivatives.rs`.
const MULTIPLIED: [&str; 2] = ["dynamic_residual_derivatives", "inverse_mass_matrix"];

#[test]
fn generated_code_equals_the_interpreter_to_the_bit() {
    for entry in registry::all() {
        let crane = load(&entry);
        let parameters: Vec<f64> = crane.chain.parameter_defaults().iter().map(|p| 1.25 * p).collect();
        for state in states::far(&crane.chain, 4, 7) {
            let generated = (entry.evaluate)(&state, &parameters);
            let all = |values: &[f64]| values.iter().copied().map(Runtime).collect();
            // As in `evaluate`, the rates also serve as accelerations and as the right-hand side.
            let inputs = Inputs::state(Runtime(state.t), all(&state.q), all(&state.v), all(&parameters))
                .with(Argument::Acceleration, all(&state.v))
                .with(Argument::RightHandSide, all(&state.v));
            let mut rest = generated.as_slice();
            for quantity in quantities(entry.description) {
                let (first, others) = rest.split_at(quantity.len());
                rest = others;
                if MULTIPLIED.contains(&quantity.name) {
                    continue;
                }
                let expected = interpret(&crane, &quantity, &inputs);
                assert_eq!(first.len(), expected.len(), "{} {}", entry.name, quantity.name);
                let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.0.abs()));
                for (i, (a, Runtime(b))) in first.iter().zip(&expected).enumerate() {
                    // Same operations in the same order; only the sign of a zero may differ.
                    let equal = a == b || FUSED.is_some_and(|tolerance| (a - b).abs() <= tolerance * size.max(1.0));
                    assert!(equal, "{} {}[{i}]: {a:?} against {b:?}", entry.name, quantity.name);
                }
            }
            assert!(rest.is_empty());
        }
    }
}

#[test]
fn simplification_changes_nothing_but_rounding() {
    for seed in 0..8 {
        let chain = workspace::chain_of("random", &random::spec(seed));
        let crane = Interpreted::new(chain);
        let verbatim = mechanics::derive_verbatim(&crane.chain, Analyses::ALL);
        for state in states::far(&crane.chain, 2, seed) {
            // An arbitrary system with damping, factorised by each program: their factors differ in number and order.
            let diagonal = (0..36).map(|i| if i % 7 == 0 { 10.0 } else { 0.0 }).collect();
            let inputs = (crane.inputs(&state).with(Argument::RightHandSide, state.v.clone()))
                .with(Argument::Acceleration, state.v.clone())
                .with(Argument::DrivePositions, state.q.clone())
                .with(Argument::AddedInertia, vec![1.0; crane.size()])
                .with(Argument::BaseAddedInertia, diagonal);
            let evaluate = |program: &Program, id: FunctionId| {
                let factors = program.evaluate(program.function(FunctionId::Factorise).unwrap(), &inputs);
                program.evaluate(program.function(id).unwrap(), &inputs.clone().with(Argument::Factors, factors))
            };
            for function in crane.program.functions.iter().filter(|function| function.id != FunctionId::Factorise) {
                let (simple, plain) = (evaluate(&crane.program, function.id), evaluate(&verbatim, function.id));
                let size = plain.iter().fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
                for (a, b) in simple.iter().zip(&plain) {
                    // About a hundred roundings of the largest intermediate results.
                    assert!((a - b).abs() <= 1e-12 * size, "seed {seed} {}: {a} against {b}", function.id.name());
                }
            }
        }
    }
}

/// The guess of a driven coordinate comes from the numeric profile, the motion from the symbolic profile.
#[test]
fn driven_coordinates_start_where_their_drives_do() {
    for entry in registry::all() {
        let crane = load(&entry);
        let start = State { t: 0.0, q: crane.chain.guess.clone(), v: vec![0.0; crane.size()] };
        let motions = crane.get("drive_motions", &crane.inputs(&start), 0);
        for (drive, motion) in crane.chain.drives.iter().zip(motions.chunks(2)) {
            let guess = crane.chain.guess[drive.coordinate.0];
            assert!((guess - motion[0]).abs() <= 1e-15 * guess.abs(), "{}: {guess} {}", entry.name, motion[0]);
        }
    }
}

/// Parameters may have the names of variables in generated code: each keeps its value.
#[test]
fn parameters_named_like_generated_code_keep_their_values() {
    let names = ["c001", "t012", "params", "sin_cos", "out", "q", "t", "v"];
    let parameters: Vec<String> = names.iter().map(|name| format!("  {name}: {{value: 2.0}}")).collect();
    let bodies: Vec<String> =
        names.iter().map(|name| format!("      - {{name: b_{name}, mass: {name}, com: [{name}, 0, 1]}}")).collect();
    let spec = format!(
        "format: 1\nname: names\nparameters:\n{}\nlinks:\n  - name: arm\n    joint: revolute\n    bodies:\n{}\n",
        parameters.join("\n"),
        bodies.join("\n")
    );
    let chain = workspace::chain_of("names", &spec);
    let code = compile::generate(&chain, chain.analyses, "names.yaml").text;
    for name in names {
        assert!(code.contains(&format!("pub {name}: f64")), "{name}");
        assert!(code.contains(&format!("params.{name}")), "{name} is read from the parameters");
        assert!(!code.contains(&format!("let {name} = params.{name};")), "{name} is not a variable");
    }
}

#[test]
fn the_same_spec_gives_the_same_bytes_from_any_folder() {
    let text = workspace::shipped("eight_link_rigid").text;
    let compiled = |name: &str| {
        let source = crane_codegen::SourceFile::new(name, text.as_str());
        compile::compile(&source, Some(Analyses::ALL)).unwrap().code.text
    };
    let first = compiled("/somewhere/eight_link_rigid.yaml");
    assert_eq!(first, compiled("elsewhere/deep/eight_link_rigid.yaml"));
    assert!(!first.contains("somewhere"), "no path in generated code");
}

#[test]
fn functions_that_a_scene_does_not_need_are_zero() {
    let entry = registry::all().into_iter().find(|entry| entry.name == "double_pendulum").unwrap();
    let state = State { t: 0.0, q: vec![0.1; 2], v: vec![0.2; 2] };
    let values = (entry.evaluate)(&state, &[]);
    let mut rest = values.as_slice();
    for quantity in quantities(entry.description) {
        let (first, others) = rest.split_at(quantity.len());
        rest = others;
        if ["support_forces", "element_forces", "drive_forces", "drive_energy"].contains(&quantity.name) {
            assert!(first.iter().all(|x| *x == 0.0), "{}", quantity.name);
        }
    }
}
