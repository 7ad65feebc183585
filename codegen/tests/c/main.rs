//! Cranes in C: the system's C compiler compiles them without warnings, and their results equal the interpreter's.

mod compiler;
mod dual;
mod products;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use crane_codegen::chain::{Analyses, Chain, Input, Loops};
use crane_codegen::compile::{generate_c, load};
use crane_codegen::emit_c::{CCode, Precision};
use crane_codegen::mechanics::derive;
use crane_codegen::program::{Argument, Function, Inputs, Layout, Program, Shape};
use crane_codegen::{SourceFile, build};

use compiler::run_program;

const EVERYTHING: Analyses = Analyses {
    statics: true,
    dynamics: true,
    modes: true,
    internal_forces: true,
    derivatives: false,
    motion_derivatives: false,
    ensemble: false,
};

/// A strut, a taut rope on a winch and a slack rope for the knuckle-boom crane.
const CONNECTORS: &str = "connectors:
- {name: strut, from: {at: [0.4, 0, 0.5]}, to: {link: main_boom, at: [1, 0, 0]}, law: {gas_spring: {force: 900, length: 2, stiffness: 300, damping: 50}}}
- {name: guy, from: {at: [-1, 0, 5]}, to: {link: knuckle, at: [1, 0, 0]}, law: {rope: {stiffness: 2e4, damping: 0.1, motion: {cubic: {from: 2, to: 1, duration: 3}}}}}
- {name: slack, from: {link: main_boom, at: [0, 0, 0]}, to: {link: hook, at: [0, 0, 0]}, law: {rope: {stiffness: 2e4, length: 40}}}
";

fn shipped(name: &str) -> Chain {
    let path = format!("{}/../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    load(&build::open(path.as_ref()).unwrap()).unwrap()
}

/// The knuckle-boom crane with a strut and ropes.
fn connected() -> Chain {
    let path = format!("{}/../specs/knuckle_boom.yaml", env!("CARGO_MANIFEST_DIR"));
    load(&build::open(path.as_ref()).unwrap().changed(CONNECTORS)).unwrap()
}

/// A boom whose drive follows one input and is offset by another, with a load that is scaled by a third.
const STEERED: &str = "format: 1
name: steered
parameters: {payload: {value: 80, unit: kg}}
inputs:
  lever: {motion: {quintic: {from: 0, to: 60 deg, begin: 0.2, duration: 3}}, unit: rad}
  trim: {value: 0.1, unit: rad}
  gust: {unit: N, about: wind at the tip}
links:
  - {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [2, 0, 0], inertia: {gyration: [0.1, 1, 1]}}
  - {name: load, placement: {transform: {translation: [4, 0, 0]}}, joint: revolute, mass: payload, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 2e5, damping: 2e4, motion: {input: lever}, offset: trim}]
loads: [{name: wind, link: boom, at: [4, 0, 0], force: [0, 1, 2], scale: {input: gust}}]
";

/// Values of its inputs, of which none, some or all are set.
const SET: [(&str, [Option<f64>; 3]); 3] = [
    ("none_set", [None, None, None]),
    ("some_set", [Some(0.4), None, Some(-300.0)]),
    ("all_set", [Some(-0.2), Some(0.3), Some(50.0)]),
];

fn steered() -> Chain {
    load(&SourceFile::new("steered.yaml", STEERED)).unwrap()
}

/// Numbers between −1 and 1, the same on every run.
fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|index| (12.9898 * index as f64 + 78.233 * seed).sin()).collect()
}

/// Arguments of a function at a state near the guess: names and values in order.
fn arguments(chain: &Chain, function: &Function) -> Vec<(Argument, Vec<f64>)> {
    let n = chain.coordinates.len();
    let near: Vec<f64> = chain.guess.iter().zip(numbers(n, 1.0)).map(|(q, x)| q + 0.1 * x).collect();
    let symmetric = |scale: f64| -> Vec<f64> {
        let random = numbers(36, 5.0);
        (0..36).map(|k| scale * (random[k] + random[6 * (k % 6) + k / 6])).collect()
    };
    let of = |argument: &Argument| match argument {
        Argument::Time => vec![1.7],
        Argument::Position => near.clone(),
        Argument::Velocity => numbers(n, 2.0),
        Argument::Acceleration => numbers(n, 3.0),
        Argument::RightHandSide => numbers(n, 4.0).iter().map(|x| 1e4 * x).collect(),
        Argument::DrivePositions => numbers(n, 5.0),
        Argument::AddedInertia => numbers(n, 6.0).iter().map(|x| 100.0 * (x + 1.0)).collect(),
        Argument::BaseAddedInertia => symmetric(10.0),
        other => panic!("{other:?} is not given from outside"),
    };
    function.arguments.iter().filter(|a| **a != Argument::Factors).map(|a| (*a, of(a))).collect()
}

/// The interpreter's result, in the order of the result in C.
fn expected(
    program: &Program,
    function: &Function,
    chain: &Chain,
    factors: &[f64],
    inputs: &[Option<f64>],
) -> Vec<f64> {
    let slots = inputs.iter().flat_map(|value| value.map_or(Input::NOT_SET, Input::set)).collect();
    let inputs = arguments(chain, function).into_iter().fold(
        Inputs::state(0.0, vec![], vec![], chain.parameter_defaults())
            .with(Argument::Factors, factors.to_vec())
            .with(Argument::Inputs, slots),
        |inputs, (argument, values)| inputs.with(argument, values),
    );
    let slots = program.evaluate(function, &inputs);
    function.shape.fill(Layout::UpperRows, &slots)
}

/// The beginning of a program that calls functions: parameters and inputs.
fn begin(code: &CCode, chain: &Chain, inputs: &[Option<f64>]) -> String {
    let name = &code.name;
    let mut text = format!("#include <stdio.h>\n#include \"{name}.h\"\n\nint main(void)\n{{\n");
    if !chain.parameters.is_empty() {
        let _ = writeln!(text, "    const {name}_params params = {}_PARAMS;", name.to_uppercase());
        let _ = writeln!(text, "    static {name}_constants c;\n    {name}_set_params(&params, &c);");
    }
    if !inputs.is_empty() {
        let _ = writeln!(text, "    {name}_inputs u = {}_INPUTS;", name.to_uppercase());
        for (input, value) in chain.inputs.iter().zip(inputs) {
            let index = format!("{}_INPUT_{}", name.to_uppercase(), input.name.to_uppercase());
            // An input that is set and then unset behaves as if it had never been set.
            let _ = writeln!(text, "    {name}_set_input(&u, {index}, {:?});", value.unwrap_or(17.0));
            if value.is_none() {
                let _ = writeln!(text, "    {name}_unset_input(&u, {index});");
            }
        }
    }
    text
}

/// What a function takes before its own arguments: the header says which functions depend on inputs.
fn takes(code: &CCode, function: &str) -> Vec<String> {
    let name = &code.name;
    let declared = code.header.split(&format!(" {name}_{function}(")).nth(1).unwrap();
    let declared = declared.split(')').next().unwrap();
    let taken = [("constants *c", "&c"), ("inputs *u", "&u")];
    let taken = taken.into_iter().filter(|(of, _)| declared.contains(&format!("const {name}_{of}")));
    taken.map(|(_, text)| text.to_owned()).collect()
}

/// A program that calls all functions and prints their numbers, one per line.
fn caller(code: &CCode, chain: &Chain, functions: &[&Function], number: &str, inputs: &[Option<f64>]) -> String {
    let (name, mut text) = (&code.name, begin(code, chain, inputs));
    let _ = writeln!(text, "    static {number} f[100000];");
    for function in functions {
        let mut given = takes(code, function.id.name());
        text += "    {\n";
        let mut values = arguments(chain, function).into_iter();
        for argument in &function.arguments {
            if *argument == Argument::Factors {
                given.push("f".to_owned());
                continue;
            }
            let (_, values) = values.next().unwrap();
            let list: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            let variable = format!("x{}", given.len());
            let _ = writeln!(text, "        const {number} {variable}[] = {{{}}};", list.join(", "));
            given.push(if *argument == Argument::Time { format!("{variable}[0]") } else { variable });
        }
        let count = function.shape.entries(Layout::UpperRows).len();
        let call = format!("{name}_{}", function.id.name());
        if function.shape == Shape::Scalar {
            let _ = writeln!(text, "        const {number} out[] = {{{call}({})}};", given.join(", "));
        } else {
            let _ = writeln!(text, "        static {number} out[{count}];");
            let given = given.iter().map(|argument| format!("{argument}, ")).collect::<Vec<_>>().concat();
            let _ = writeln!(text, "        {call}({given}out);");
        }
        if matches!(function.shape, Shape::Factors(_)) {
            let _ = writeln!(text, "        for (int k = 0; k < {count}; k++) f[k] = out[k];");
        }
        let _ =
            writeln!(text, "        for (int k = 0; k < {count}; k++) printf(\"%.17g\\n\", (double)out[k]);\n    }}");
    }
    text + "    return 0;\n}\n"
}

/// Maximum difference of each function from the interpreter's result, relative to the largest number of that result.
fn differences(name: &str, chain: &Chain, precision: Precision, inputs: &[Option<f64>]) -> Vec<(&'static str, f64)> {
    let straight = Chain { loops: Loops::Never, ..chain.clone() };
    let program = derive(&straight, EVERYTHING);
    let functions: Vec<&Function> = program.functions.iter().collect();
    let names: Vec<&str> = functions.iter().map(|function| function.id.name()).collect();
    let header = format!("{}.h", chain.name);
    let code = generate_c(chain, &names, &chain.parameter_defaults(), precision, &header).unwrap();
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("c_{name}_{precision:?}"));
    let number = if precision == Precision::Double { "double" } else { "float" };
    let printed = run_program(&folder, &code, &caller(&code, chain, &functions, number, inputs));
    let mut rest = printed.as_slice();
    let (mut found, mut factors) = (Vec::new(), Vec::new());
    for function in functions {
        let expected = expected(&program, function, chain, &factors, inputs);
        let (computed, others) = rest.split_at(expected.len());
        rest = others;
        if matches!(function.shape, Shape::Factors(_)) {
            factors.clone_from(&expected);
        }
        let size = expected.iter().fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
        let off =
            computed.iter().zip(&expected).map(|(computed, expected)| (computed - expected).abs()).fold(0.0, f64::max);
        found.push((function.id.name(), off / size));
    }
    assert!(rest.is_empty());
    found
}

#[test]
fn every_function_of_every_kind_of_crane_is_the_interpreters() {
    for name in ["double_pendulum", "knuckle_boom", "eight_link_rigid", "eight_link_flexible"] {
        for (function, off) in differences(name, &shipped(name), Precision::Double, &[]) {
            // The same operations with the same rounding, except for sines; forward dynamics of stiff cranes loses some digits to cancellation.
            assert!(off < 1e-12, "{name}: {function} is off by {off:e}");
        }
    }
}

#[test]
fn springs_and_ropes_are_the_interpreters() {
    let found = differences("connected", &connected(), Precision::Double, &[]);
    assert_eq!(found.iter().filter(|(function, _)| function.starts_with("connector_")).count(), 6);
    for (function, off) in found {
        assert!(off < 1e-12, "{function} is off by {off:e}");
    }
}

/// The four-bar of the manual.
fn four_bar() -> Chain {
    let page = fs::read_to_string(format!("{}/../docs/manual/loops.md", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let (_, rest) = page.split_once("```yaml\n").unwrap();
    let (spec, _) = rest.split_once("```").unwrap();
    load(&SourceFile::new("four_bar.yaml", spec)).unwrap()
}

#[test]
fn gaps_and_rows_of_loops_are_the_interpreters() {
    let found = differences("four_bar", &four_bar(), Precision::Double, &[]);
    assert_eq!(found.iter().filter(|(function, _)| function.starts_with("loop_")).count(), 4);
    for (function, off) in found {
        assert!(off < 1e-12, "{function} is off by {off:e}");
    }
}

#[test]
fn single_precision_has_the_digits_that_the_manual_says() {
    let off = differences("eight_link_flexible", &shipped("eight_link_flexible"), Precision::Single, &[]);
    let of = |name: &str| off.iter().find(|(function, _)| *function == name).unwrap().1;
    // Measured: 6e-8, 4e-8, 2e-6.
    assert!(of("mass_matrix") < 1e-6 && of("bias") < 1e-6 && of("forward_dynamics") < 1e-5, "{off:?}");
    // A smaller error than 24-bit numbers allow would mean double precision.
    assert!(of("forward_dynamics") > 1e-8, "{off:?}");
}

#[test]
fn inputs_are_arguments() {
    let steered = steered();
    for (name, inputs) in SET {
        for (function, off) in differences(name, &steered, Precision::Double, &inputs) {
            assert!(off < 1e-12, "{name}: {function} is off by {off:e}");
        }
    }
    let code =
        generate_c(&steered, &["mass_matrix", "forward_dynamics"], &[80.0], Precision::Double, "steered.h").unwrap();
    // A function that does not depend on inputs does not have this argument.
    assert!(code.header.contains("steered_mass_matrix(const steered_constants *c, const double q[2], double out[4])"));
    assert!(code.header.contains("steered_forward_dynamics(const steered_constants *c, const steered_inputs *u,"));
    assert!(code.header.contains("STEERED_INPUT_GUST = 2, /* N, wind at the tip */"));
}

/// As [`STEERED`], with names and words that mean something in C.
fn hostile() -> String {
    let words = "\"*/ int x = 1; /*\"";
    STEERED
        .replace("payload", "double")
        .replace("lever", "restrict")
        .replace("trim", "cos")
        .replace("gust", "unix")
        .replace("unit: kg", &format!("unit: {words}, about: {words}"))
        .replace("unit: N, about: wind at the tip", &format!("unit: {words}, about: {words}"))
        .replace("name: steered", &format!("name: steered\ntitle: {words}"))
}

#[test]
fn keywords_and_comments_of_c_in_a_spec_are_harmless() {
    let chain = load(&SourceFile::new("hostile.yaml", hostile())).unwrap();
    // The strict compilation refuses text outside a comment, a keyword as a name, and a variable that hides `cos`.
    for (function, off) in differences("hostile", &chain, Precision::Double, &[Some(0.4), None, Some(-300.0)]) {
        assert!(off < 1e-12, "{function} is off by {off:e}");
    }
    let code = generate_c(&chain, &["mass_matrix"], &[80.0], Precision::Double, "other.h").unwrap();
    assert!(code.header.contains("    double double_; /* * / int x = 1; / *"), "{}", code.header);
    assert!(code.source.contains("#include \"other.h\"\n"));
}

#[test]
fn a_function_that_the_crane_does_not_have_is_named_with_those_that_it_has() {
    let refused =
        generate_c(&shipped("knuckle_boom"), &["bias", "levitation"], &[800.0], Precision::Double, "x.h").unwrap_err();
    assert_eq!(refused.name, "levitation");
    assert!(refused.known.contains(&"forward_dynamics"));
}
