//! Products with derivatives in C, against derivatives of the interpreter's numbers.

use std::fmt::Write as _;
use std::path::PathBuf;

use crane_codegen::SourceFile;
use crane_codegen::chain::{Chain, Input, Loops};
use crane_codegen::compile::{generate_c, load};
use crane_codegen::emit_c::{CCode, Precision};
use crane_codegen::mechanics::derive;
use crane_codegen::program::{Argument, Function, FunctionId, Inputs, Product, Program, has_products};

use crate::compiler::run_program;
use crate::dual::Dual;
use crate::{EVERYTHING, SET, STEERED, arguments, begin, connected, four_bar, numbers, shipped, steered, takes};

/// The parts of the variables: as they are given to a function, and how many numbers of each are variables.
fn parts(chain: &Chain, function: &Function, inputs: &[Option<f64>]) -> Vec<(Argument, Vec<f64>)> {
    let n = chain.coordinates.len();
    let given = arguments(chain, function);
    let of = |argument: Argument, count: usize| {
        let found = given.iter().find(|(of, _)| *of == argument);
        (argument, found.map_or_else(|| vec![0.0; count], |(_, values)| values.clone()))
    };
    let slots = inputs.iter().flat_map(|value| value.map_or(Input::NOT_SET, Input::set)).collect();
    vec![
        of(Argument::Time, 1),
        of(Argument::Position, n),
        of(Argument::Velocity, n),
        of(Argument::Acceleration, n),
        (Argument::Parameters, chain.parameter_defaults()),
        (Argument::Inputs, slots),
    ]
}

/// The derivatives of the results of a function by all variables, one after the other.
fn jacobian(program: &Program, function: &Function, parts: &[(Argument, Vec<f64>)]) -> Vec<Vec<f64>> {
    let alone = program.alone(function);
    let step = |argument: Argument| if argument == Argument::Inputs { Input::SLOTS } else { 1 };
    let places = parts.iter().flat_map(|(part, values)| (0..values.len()).step_by(step(*part)).map(|k| (*part, k)));
    let along = |(by, index): (Argument, usize)| -> Vec<f64> {
        let given =
            parts.iter().fold(Inputs::state(Dual(0.0, 0.0), vec![], vec![], vec![]), |given, (part, values)| {
                let slope = |k: usize| f64::from(*part == by && k == index);
                given.with(*part, values.iter().enumerate().map(|(k, value)| Dual(*value, slope(k))).collect())
            });
        alone.evaluate(&alone.functions[0], &given).into_iter().map(|Dual(_, slope)| slope).collect()
    };
    places.map(along).collect()
}

/// Numbers in braces.
fn list(values: &[f64]) -> String {
    format!("{{{}}}", values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", "))
}

/// The struct of variables with the given numbers, part by part.
fn variables(chain: &Chain, numbers: &[f64]) -> String {
    let n = chain.coordinates.len();
    let counts = [1, n, n, n, chain.parameters.len(), chain.inputs.len()];
    let mut rest = numbers;
    let part = |(index, count): (usize, usize)| {
        let (values, others) = rest.split_at(count);
        rest = others;
        if index == 0 { format!("{:?}", values[0]) } else { list(values) }
    };
    let parts: Vec<String> = counts.into_iter().enumerate().filter(|(_, count)| *count > 0).map(part).collect();
    format!("{{{}}}", parts.join(", "))
}

/// A program that prints both products of all functions, each with numbers of its own.
fn caller(
    code: &CCode,
    chain: &Chain,
    functions: &[(&Function, Vec<f64>, Vec<f64>)],
    inputs: &[Option<f64>],
) -> String {
    let name = &code.name;
    let mut text = begin(code, chain, inputs);
    for (function, weights, changes) in functions {
        let results = weights.len();
        text += "    {\n";
        let of = arguments(chain, function).into_iter().enumerate().map(|(index, (argument, values))| {
            let _ = writeln!(text, "        const double x{index}[] = {};", list(&values));
            if argument == Argument::Time { format!("x{index}[0]") } else { format!("x{index}") }
        });
        let of: Vec<String> = of.collect();
        let _ = writeln!(text, "        const double w[] = {};", list(weights));
        let _ = writeln!(text, "        const {name}_variables dx = {};", variables(chain, changes));
        let _ = writeln!(text, "        {name}_variables by;\n        double changed[{results}];");
        let is_number = function.id.extent().shape(0, |_| 0).next().is_none();
        for product in Product::ALL {
            let call = format!("{}{}", function.id.name(), product.suffix());
            let own = takes(code, &call).into_iter().chain(of.iter().cloned());
            let given =
                |last: &[&str]| own.chain(last.iter().map(ToString::to_string)).collect::<Vec<String>>().join(", ");
            let _ = match product {
                Product::Vjp => writeln!(text, "        {name}_{call}({});", given(&["w", "&by"])),
                Product::Jvp if is_number => writeln!(text, "        changed[0] = {name}_{call}({});", given(&["&dx"])),
                Product::Jvp => writeln!(text, "        {name}_{call}({});", given(&["&dx", "changed"])),
            };
        }
        let print = |count: usize, what: &str| {
            format!("        for (int k = 0; k < {count}; k++) printf(\"%.17g\\n\", {what});\n")
        };
        text += &print(1, "by.t");
        for vector in ["q", "v", "a"] {
            text += &print(chain.coordinates.len(), &format!("by.{vector}[k]"));
        }
        for parameter in &chain.parameters {
            text += &print(1, &format!("by.params.{}", parameter.name));
        }
        if !chain.inputs.is_empty() {
            text += &print(chain.inputs.len(), "by.inputs[k]");
        }
        text += &print(results, "changed[k]");
        text += "    }\n";
    }
    text + "    return 0;\n}\n"
}

/// Largest difference of both products of functions from the sums of derivatives, relative to the largest of these sums; of `only` one function, or of
/// all that have products.
fn differences(name: &str, chain: &Chain, inputs: &[Option<f64>], only: Option<FunctionId>) -> Vec<(String, f64)> {
    let straight = Chain { loops: Loops::Never, ..chain.clone() };
    let program = derive(&straight, EVERYTHING);
    let mut rows = Vec::new();
    for function in &program.functions {
        if has_products(function.id, chain.has_loops()) && only.is_none_or(|only| only == function.id) {
            let jacobian = jacobian(&program, function, &parts(chain, function, inputs));
            let (weights, changes) = (numbers(jacobian[0].len(), 7.0), numbers(jacobian.len(), 8.0));
            rows.push((function, weights, changes, jacobian));
        }
    }
    let of = |function: &Function| Product::ALL.map(|product| format!("{}{}", function.id.name(), product.suffix()));
    let names: Vec<String> = rows.iter().flat_map(|(function, ..)| of(function)).collect();
    let header = format!("{}.h", chain.name);
    let code = generate_c(chain, &names, &chain.parameter_defaults(), Precision::Double, &header).unwrap();
    let given: Vec<_> = rows.iter().map(|(function, w, dx, _)| (*function, w.clone(), dx.clone())).collect();
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("c_products_{name}"));
    let printed = run_program(&folder, &code, &caller(&code, chain, &given, inputs));
    let mut rest = printed.as_slice();
    let mut found = Vec::new();
    for (function, weights, changes, jacobian) in rows {
        let pulled = jacobian.iter().map(|column| column.iter().zip(&weights).map(|(slope, w)| slope * w).sum());
        let pushed = (0..weights.len()).map(|i| jacobian.iter().zip(&changes).map(|(column, dx)| column[i] * dx).sum());
        for (name, expected) in of(function).into_iter().zip([pulled.collect::<Vec<f64>>(), pushed.collect()]) {
            let (computed, others) = rest.split_at(expected.len());
            rest = others;
            let size = expected.iter().fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
            let off = computed.iter().zip(&expected).map(|(x, expected)| (x - expected).abs()).fold(0.0, f64::max);
            found.push((name, off / size));
        }
    }
    assert!(rest.is_empty());
    found
}

/// Rounding of other operations, which forward dynamics of stiff cranes magnifies.
fn assert_small(name: &str, differences: Vec<(String, f64)>) {
    for (product, off) in differences {
        assert!(off < 1e-12, "{name}: {product} is off by {off:e}");
    }
}

#[test]
fn products_are_sums_of_derivatives() {
    // The compiler of C takes a minute over the largest.
    let largest = std::env::var_os("CRANE_THOROUGH").map(|_| "eight_link_rigid");
    for name in ["double_pendulum", "knuckle_boom"].into_iter().chain(largest) {
        assert_small(name, differences(name, &shipped(name), &[], None));
    }
    // In several pieces.
    let name = "eight_link_flexible";
    assert_small(name, differences(name, &shipped(name), &[], Some(FunctionId::ForwardDynamics)));
    assert_small("connected", differences("connected", &connected(), &[], None));
    assert_small("four_bar", differences("four_bar", &four_bar(), &[], None));
}

#[test]
fn products_have_derivatives_by_values_of_inputs() {
    for (name, inputs) in SET {
        assert_small(name, differences(name, &steered(), &inputs, None));
    }
    let code = generate_c(&steered(), &["forward_dynamics_vjp"], &[80.0], Precision::Double, "steered.h").unwrap();
    let signature = "void steered_forward_dynamics_vjp(const steered_constants *c, const steered_inputs *u, double t, const double q[2], \
                     const double v[2], const double w[2], steered_variables *out)";
    assert!(code.header.contains(signature), "{}", code.header);
    assert!(code.header.contains("    double inputs[3]; /* values */\n} steered_variables;"));
}

/// The weights of a product are called `w`, and its changes `dx`.
#[test]
fn inputs_may_be_called_as_the_arguments_of_products() {
    let text = STEERED.replace("lever", "w").replace("gust", "dx");
    let chain = load(&SourceFile::new("steered.yaml", text)).unwrap();
    let [.., (_, all_set)] = SET;
    assert_small("called_as_arguments", differences("called_as_arguments", &chain, &all_set, Some(FunctionId::Forces)));
}

#[test]
fn a_function_without_products_is_named_with_those_that_have_them() {
    let refused = |chain: &Chain, name: &str| {
        let refused = generate_c(chain, &["bias_vjp", name], &chain.parameter_defaults(), Precision::Double, "x.h");
        refused.map(|code| code.header).unwrap_err()
    };
    for name in ["mass_matrix_vjp", "solve_jvp", "transforms_jvp", "levitation_vjp"] {
        let refused = refused(&shipped("knuckle_boom"), name);
        assert_eq!(refused.name, name);
        assert!(refused.with_products.contains(&"forward_dynamics") && !refused.with_products.contains(&"mass_matrix"));
    }
    // Accelerations of the open chain are not those of the crane.
    let refused = refused(&four_bar(), "forward_dynamics_vjp");
    assert!(refused.known.contains(&"forward_dynamics") && !refused.with_products.contains(&"forward_dynamics"));
}
