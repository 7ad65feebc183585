//! The header: coordinates and parameters by name, and every function with its shapes and units.

use std::fmt::Write;

use super::Precision;
use super::function::CWriter;
use super::words::{comment, field};
use crate::chain::{Chain, CoordinateKind, Input};
use crate::program::{Argument, Count, Extent, Function, FunctionId, Layout, Product, Shape, Struct};

/// The beginning of the source.
pub fn source(chain: &Chain, header: &str) -> String {
    format!("/* {} */\n\n#include \"{header}\"\n\n#include <math.h>\n\n", origin(chain))
}

/// Where the files come from.
fn origin(chain: &Chain) -> String {
    let title = comment(&chain.title);
    format!("{title}. Made by crane-codegen from the spec with hash {}; do not edit.", chain.spec_hash)
}

/// The text of the header.
pub fn header(writer: &CWriter) -> String {
    let CWriter { chain, lowered, precision, .. } = writer;
    let guard = format!("{}_H", chain.name.to_uppercase());
    let mut text = format!("/* {} */\n\n", origin(chain));
    let _ = write!(text, "{}\n\n#ifndef {guard}\n#define {guard}\n\n", about(*precision));
    text += &coordinates(chain);
    text += "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n";
    text += &parameters(writer);
    text += &inputs(writer);
    text += &writer.variables();
    for code in &lowered.functions {
        text += &documentation(writer, code.function, code.count.total());
        let _ = write!(text, "{};\n\n", writer.signature(code.function));
    }
    text + &format!("#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n")
}

fn about(precision: Precision) -> &'static str {
    match precision {
        Precision::Double => {
            "/* C99. No heap, no global data, no recursion. Library functions: sin, cos; sqrt if sections rotate far or points are\n   \
             connected; exp if joints have friction. All functions may be called from several threads. SI units, rad. */"
        }
        Precision::Single => {
            "/* C99, single precision: about six digits, fewer where large numbers cancel. No heap, no global data, no recursion.\n   \
             Library functions: sinf, cosf; sqrtf if sections rotate far or points are connected; expf if joints have friction. All\n   \
             functions may be called from several threads. SI units, rad. */"
        }
    }
}

/// Indices of the coordinates in `q`.
fn coordinates(chain: &Chain) -> String {
    let prefix = chain.name.to_uppercase();
    let mut text = format!(
        "/* Number of coordinates, and their indices in q, v and all results per coordinate. */\n\
         #define {prefix}_N {}\n\nenum {{\n",
        chain.coordinates.len()
    );
    for (index, coordinate) in chain.coordinates.iter().enumerate() {
        let (unit, force) = match coordinate.kind {
            CoordinateKind::Translation => ("m", "N"),
            CoordinateKind::Rotation => ("rad", "N m"),
        };
        let name = coordinate.name.to_uppercase();
        let _ = writeln!(text, "    {prefix}_{name} = {index}, /* {unit}, {unit}/s; forces in {force} */");
    }
    text + "};\n\n"
}

/// Live parameters and the constants computed from them; empty if there are none.
fn parameters(writer: &CWriter) -> String {
    let CWriter { chain, lowered, precision, .. } = writer;
    if chain.parameters.is_empty() {
        return String::new();
    }
    let number = precision.name();
    let [params, constants] = ["params", "constants"].map(|name| writer.name(name));
    let mut text = "/* Values that stay live. */\ntypedef struct {\n".to_owned();
    for (parameter, value) in chain.parameters.iter().zip(writer.parameters) {
        let words = [parameter.about.as_str(), &parameter.unit, &format!("{value:?} in {}", macro_name(chain))]
            .into_iter()
            .filter(|words| !words.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        let _ = writeln!(text, "    {number} {}; /* {} */", field(&parameter.name), comment(&words));
    }
    let values: Vec<String> =
        writer.parameters.iter().map(|value| format!("{value:?}{}", precision.suffix())).collect();
    let _ = write!(text, "}} {params};\n\n#define {} {{{}}}\n", macro_name(chain), values.join(", "));
    let _ = write!(
        text,
        "\n/* Live parameters, and constants that depend only on them; set by {}. */\ntypedef struct {{\n    {params} params;\n",
        writer.name("set_params")
    );
    for id in &lowered.constants.stored {
        let _ = writeln!(text, "    {number} {};", writer.labels.constant(*id));
    }
    let _ = write!(
        text,
        "}} {constants};\n\n/* Computes the constants for given parameters; call it after they change. The rules of the spec language are not\n   \
         checked here: masses and stiffnesses must be within the limits of the spec. */\nvoid {}(const {params} *params, {constants} *c);\n\n",
        writer.name("set_params")
    );
    text
}

/// Inputs by name, and the functions that set them; empty if there are none.
fn inputs(writer: &CWriter) -> String {
    let CWriter { chain, precision, .. } = writer;
    if chain.inputs.is_empty() {
        return String::new();
    }
    let prefix = chain.name.to_uppercase();
    let mut text = "/* Inputs. */\nenum {\n".to_owned();
    for (index, input) in chain.inputs.iter().enumerate() {
        let words = [input.unit.as_str(), &input.about]
            .into_iter()
            .filter(|words| !words.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        let comment = if words.is_empty() { String::new() } else { format!(" /* {} */", comment(&words)) };
        let _ = writeln!(text, "    {prefix}_INPUT_{} = {index},{comment}", input.name.to_uppercase());
    }
    let not_set = chain.inputs.iter().flat_map(|_| Input::NOT_SET);
    let not_set: Vec<String> = not_set.map(|slot| format!("{slot:?}{}", precision.suffix())).collect();
    let (name, slots) = (writer.name("inputs"), Input::SLOTS * chain.inputs.len());
    let _ = write!(
        text,
        "}};\n\n/* Values of the inputs; start from {prefix}_INPUTS, in which all follow the spec. */\n\
         typedef struct {{\n    {} slots[{slots}];\n}} {name};\n\n#define {prefix}_INPUTS {{{{{}}}}}\n\n",
        precision.name(),
        not_set.join(", ")
    );
    let [set, unset] = writer.input_functions();
    let _ = write!(
        text,
        "/* Sets one of the inputs listed above to a value. */\n{set};\n\n/* Lets an input follow the spec again. */\n{unset};\n\n"
    );
    text
}

/// The macro with initial values of the parameters.
fn macro_name(chain: &Chain) -> String {
    format!("{}_PARAMS", chain.name.to_uppercase())
}

/// What a function computes, from which arguments, and the shape of its result.
fn documentation(writer: &CWriter, function: &Function, operations: usize) -> String {
    let mut text = format!("/* {}{}\n   {}\n", product(function), comment(function.doc), comment(function.equation));
    for argument in &function.arguments {
        let _ = writeln!(text, "   {}", of_argument(function, *argument));
    }
    let _ = writeln!(text, "   {}; {operations} operations. */", result(writer.chain, function));
    text
}

/// What a product is, before the documentation of the function.
fn product(function: &Function) -> String {
    let name = function.id.name();
    match function.product {
        None => String::new(),
        Some(Product::Vjp) => format!("w' J, derivatives of the results of {name}, weighted and summed:\n   "),
        Some(Product::Jvp) => {
            format!("J dx, changes of the results of {name} with changes of all that it depends on:\n   ")
        }
    }
}

fn of_argument(function: &Function, argument: Argument) -> &'static str {
    match argument {
        Argument::Time => "t: time, s",
        Argument::Position => "q: coordinates, m and rad",
        Argument::Velocity => "v: their rates, m/s and rad/s",
        Argument::Acceleration => "a: their accelerations, m/s2 and rad/s2",
        Argument::RightHandSide => "r: generalized forces, N and N m",
        Argument::Multiplier => match function.product {
            Some(Product::Jvp) => "dx: changes, in the units of what changes",
            _ => "w: weights of the results, in their order",
        },
        Argument::DrivePositions => {
            "positions: at which the drives are held, at the places of their coordinates, m and rad"
        }
        Argument::AddedInertia => "added_inertia: added to the diagonal of the mass matrix, one number per coordinate",
        Argument::BaseAddedInertia => {
            "base: added to the mass matrix in the rows and columns of the base's coordinates, symmetric, 6 x 6"
        }
        Argument::Factors => "f: result of factorise",
        Argument::Parameters | Argument::Inputs | Argument::LoopVarying | Argument::LiveOut => "",
    }
}

/// Names of the parts that a list counts.
fn names_of(chain: &Chain, of: Count) -> String {
    let names: Vec<String> = match of {
        Count::Bodies => chain.bodies.iter().map(|body| body.name.clone()).collect(),
        Count::Points => chain.points.iter().map(|point| point.name.clone()).collect(),
        Count::Supports => chain.supports.iter().map(|support| support.name.clone()).collect(),
        Count::Connectors => chain.connectors().iter().map(|connector| connector.name.clone()).collect(),
        Count::Cylinders => chain.cylinders.iter().map(|cylinder| cylinder.name.clone()).collect(),
        Count::LoopEquations => chain.loop_equations().collect(),
        _ => return format!("{} {}", chain.count(of), of.name()),
    };
    format!("{} {}", of.name().replace('_', " "), names.join(", "))
}

/// The shape of a result in words.
fn result(chain: &Chain, Function { id, product, shape, .. }: &Function) -> String {
    let n = chain.coordinates.len();
    let names = || match id.extent() {
        Extent::List(_, count) => names_of(chain, count.factors().first().copied().unwrap_or(count)),
        _ => String::new(),
    };
    match shape {
        _ if *product == Some(Product::Vjp) => {
            "out: derivatives by all that the function depends on, of an input by its value; units of w' f over those of each".to_owned()
        }
        Shape::Vectors(_) if *id == FunctionId::CylinderStates => {
            format!("out: length, its rate and its derivative by the joint's coordinate, of the {}", names())
        }
        Shape::Vectors(_) if *id == FunctionId::LoopStates => {
            format!("out: gap, its rate and J' q', of the {}", names())
        }
        Shape::Scalar => "Returns the number".to_owned(),
        Shape::Vector(_) => "out: one number per coordinate".to_owned(),
        Shape::Symmetric(_) => format!("out: {n} x {n}, symmetric"),
        Shape::Base => "out: 6 x 6, symmetric, in the order x, y, z, psi, theta, phi of the base".to_owned(),
        Shape::MassAndBias(_) => format!("out: {n} x {n}, symmetric, then one number per coordinate"),
        Shape::Vectors(_) => format!("out: x, y, z of each of the {}", names()),
        Shape::Pairs(count) => format!("out: {count} pairs"),
        Shape::Rows { count, n } if *id == FunctionId::LoopDynamics => {
            format!("out: {count} x {n}, row by row: q'' of the open chain, J' q', J, inv(A) J'")
        }
        Shape::Rows { count, n } if matches!(id, FunctionId::MassFactors | FunctionId::ResidualFactors) => {
            format!("out: {count} x {n}, row by row, one number per coordinate in each")
        }
        Shape::Rows { count, n }
            if matches!(id, FunctionId::DynamicResidualDerivatives | FunctionId::ForceDerivatives) =>
        {
            format!("out: {} matrices of {n} x {n}, row by row, one after the other", count / n)
        }
        Shape::Rows { count, n } => format!("out: {count} x {n}, row by row, of the {}", names()),
        Shape::Structs(Struct::Tension, _) => {
            format!("out: force and its derivatives with respect to length and rate, of the {}", names())
        }
        Shape::Structs(Struct::Wrench, count) if *id == FunctionId::InternalForces => {
            let open = if chain.has_loops() { ", without what loops transmit" } else { "" };
            format!("out: force x, y, z and moment x, y, z of each of {count} cuts, from the ground to the tip{open}")
        }
        Shape::Structs(Struct::Wrench, _) => {
            format!("out: force x, y, z and moment x, y, z of all cuts, one after the other for the {}", names())
        }
        Shape::Structs(Struct::SectionModuli, count) => {
            format!(
                "out: area, moduli of bending about y and z and of torsion, shear areas along y and z, whether there are corners, \
                 allowable stress, of each of {count} sections of beams"
            )
        }
        Shape::Transforms { counts, .. } => {
            let matrices: usize = counts.iter().sum();
            let bodies = names_of(chain, Count::Bodies);
            format!("out: the upper three rows of {matrices} 4 x 4 matrices, row by row, of the {bodies}")
        }
        Shape::Factors(count) => format!("out: {count} numbers for solve"),
        Shape::Record(_, fields) => {
            let fields = fields.iter().map(|(name, shape)| format!("{name} ({} numbers)", shape.entries(Layout::UpperRows).len()));
            format!("out: {}, one after the other", fields.collect::<Vec<_>>().join(", "))
        }
        Shape::Columns { .. } | Shape::Tangent { .. } | Shape::TransformFactors { .. } => "out: factors".to_owned(),
    }
}
