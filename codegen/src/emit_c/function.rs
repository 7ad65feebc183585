//! A lowered function as a function in C.

use std::collections::{BTreeSet, HashSet};
use std::fmt::Write;

use super::Precision;
use super::arithmetic::Expression;
use super::words::{comment, field, not_for_variables};
use crate::chain::{Chain, Input};
use crate::emit::{Labels, Names};
use crate::lower::{LoweredFunction, LoweredProgram, Statement};
use crate::program::{Argument, Function, Layout, Product, Shape};
use crate::symbolic::{ExprId, Op};

/// Writes functions.
pub struct CWriter<'a> {
    pub chain: &'a Chain,
    pub lowered: &'a LoweredProgram<'a>,
    pub labels: &'a Labels<'a>,
    /// Initial values of the live parameters.
    pub parameters: &'a [f64],
    pub precision: Precision,
}

/// What a piece of a function reads.
type Used = BTreeSet<Argument>;

impl CWriter<'_> {
    /// The definition of a function, after those of its pieces.
    pub fn function(&self, code: &LoweredFunction) -> String {
        let (signature, numbers) =
            (self.signature(code.function), code.function.shape.entries(Layout::UpperRows).len());
        let number = self.precision.name();
        let scalar = code.function.shape == Shape::Scalar;
        let blank = if scalar {
            format!("    {number} out[1] = {{0}};\n")
        } else if is_of_variables(code.function) {
            format!("    *out = ({}){{0}};\n", self.name("variables"))
        } else {
            format!("    for (int k = 0; k < {numbers}; k++) {{\n        out[k] = 0;\n    }}\n")
        };
        let end = if scalar { "    return out[0];\n" } else { "" };
        let [piece] = code.pieces.as_slice() else { return self.in_pieces(code, &blank, end) };
        let (body, used) = self.piece(code, piece);
        let ignored = self.ignored(code.function, &used);
        format!("{signature}\n{{\n{ignored}{blank}{body}{end}}}\n\n")
    }

    /// A long function: pieces that pass values on in an array provided by their caller.
    fn in_pieces(&self, code: &LoweredFunction, blank: &str, end: &str) -> String {
        let (function, number) = (code.function, self.precision.name());
        let (name, kept) = (self.name(&function.name()), code.kept.max(1));
        let arguments = self.arguments(function);
        let (mut pieces, mut calls) = (String::new(), String::new());
        for (index, piece) in code.pieces.iter().enumerate() {
            let part = format!("{name}_{}", index + 1);
            let (body, used) = self.piece(code, piece);
            let ignored = self.ignored(function, &used);
            let declared: Vec<&str> = arguments.iter().map(|(_, declared)| declared.as_str()).collect();
            let declared = [declared.join(", "), format!("{number} kept[{kept}], {}", self.out(function))].join(", ");
            let unused = "    (void)kept;\n    (void)out;\n";
            let _ = write!(pieces, "static void {part}({declared})\n{{\n{ignored}{unused}{body}}}\n\n");
            let names: Vec<&str> = arguments.iter().map(|(name, _)| *name).collect();
            let _ = writeln!(calls, "    {part}({}, kept, out);", names.join(", "));
        }
        let signature = self.signature(function);
        format!("{pieces}{signature}\n{{\n    {number} kept[{kept}];\n{blank}{calls}{end}}}\n\n")
    }

    /// A name with the crane's name as its prefix.
    pub fn name(&self, of: &str) -> String {
        format!("{}_{of}", self.chain.name)
    }

    /// Type, name and arguments of a function.
    pub fn signature(&self, function: &Function) -> String {
        let number = self.precision.name();
        let mut arguments: Vec<String> = self.arguments(function).into_iter().map(|(_, declared)| declared).collect();
        let returned = if function.shape == Shape::Scalar {
            number
        } else {
            arguments.push(self.out(function));
            "void"
        };
        let arguments = if arguments.is_empty() { "void".to_owned() } else { arguments.join(", ") };
        format!("{returned} {}({arguments})", self.name(&function.name()))
    }

    /// Declaration of the result.
    fn out(&self, function: &Function) -> String {
        if is_of_variables(function) {
            return format!("{} *out", self.name("variables"));
        }
        format!("{} out[{}]", self.precision.name(), function.shape.entries(Layout::UpperRows).len())
    }

    /// Names and declarations of the arguments of a function.
    fn arguments(&self, function: &Function) -> Vec<(&'static str, String)> {
        let (n, number) = (self.chain.coordinates.len(), self.precision.name());
        let array = |name: &'static str, count: usize| (name, format!("const {number} {name}[{count}]"));
        let constants = format!("const {} *c", self.name("constants"));
        let of = |argument: &Argument| match argument {
            Argument::Time => ("t", format!("{number} t")),
            Argument::BaseAddedInertia => array("base", 36),
            Argument::Factors => array("f", self.factors()),
            Argument::Multiplier => match function.product {
                Some(Product::Jvp) => ("dx", format!("const {} *dx", self.name("variables"))),
                _ => array("w", self.results(function)),
            },
            vector => array(argument_name(function, *vector), n),
        };
        let live = (!self.chain.parameters.is_empty()).then_some(("c", constants));
        let inputs = self.reads_inputs(function).then(|| ("u", format!("const {} *u", self.name("inputs"))));
        live.into_iter().chain(inputs).chain(function.arguments.iter().map(of)).collect()
    }

    /// The number of results of a function that has products.
    fn results(&self, function: &Function) -> usize {
        function.id.extent().shape(self.chain.coordinates.len(), |count| self.chain.count(count)).product()
    }

    /// Whether a function depends on inputs.
    fn reads_inputs(&self, function: &Function) -> bool {
        self.lowered.functions.iter().any(|code| std::ptr::eq(code.function, function) && code.reads_inputs)
    }

    /// The number of factors that `solve` takes from `factorise`.
    fn factors(&self) -> usize {
        let shapes = self.lowered.program.functions.iter().map(|function| &function.shape);
        shapes.filter_map(|shape| if let Shape::Factors(count) = shape { Some(*count) } else { None }).sum()
    }

    /// Marks arguments that nothing reads as intentionally unused.
    fn ignored(&self, function: &Function, used: &Used) -> String {
        let reads = |name: &str| used.iter().any(|argument| argument_name(function, *argument) == name);
        let unread = self.arguments(function).into_iter().filter(|(name, _)| !reads(name));
        unread.map(|(name, _)| format!("    (void){name};\n")).collect::<Vec<_>>().concat()
    }

    /// Statements of a piece, and what they read.
    fn piece(&self, code: &LoweredFunction, piece: &[Statement]) -> (String, Used) {
        let names = Names::new(&self.lowered.program, 0).avoiding(&not_for_variables());
        let positions = code.function.shape.positions(Layout::UpperRows);
        let mut body = Body {
            writer: self,
            code,
            names,
            positions,
            fields: self.fields(),
            used: Used::new(),
            text: String::new(),
        };
        for statement in piece {
            body.statement(statement);
        }
        (body.text, body.used)
    }

    /// The functions that set inputs; empty if there are none.
    pub fn inputs(&self) -> String {
        if self.chain.inputs.is_empty() {
            return String::new();
        }
        let number = |number: f64| Expression::number(number, self.precision).text().to_owned();
        let body = |numbers: [String; Input::SLOTS]| {
            let places = numbers.iter().enumerate();
            let lines =
                places.map(|(slot, number)| format!("    u->slots[{} * input + {slot}] = {number};\n", Input::SLOTS));
            format!("{{\n{}}}\n\n", lines.collect::<String>())
        };
        let [set, unset] = self.input_functions();
        let [_, held, still] = Input::set(0.0).map(number);
        format!("{set}\n{}{unset}\n{}", body(["value".to_owned(), held, still]), body(Input::NOT_SET.map(number)))
    }

    /// Signatures of the functions that set an input, and that return it to the value or motion of the spec.
    pub fn input_functions(&self) -> [String; 2] {
        let (inputs, number) = (self.name("inputs"), self.precision.name());
        [
            format!("void {}({inputs} *u, int input, {number} value)", self.name("set_input")),
            format!("void {}({inputs} *u, int input)", self.name("unset_input")),
        ]
    }

    /// The function that computes constants from live parameters; empty if there are none.
    pub fn constants(&self) -> String {
        if self.chain.parameters.is_empty() {
            return String::new();
        }
        let (program, stored) = (&self.lowered.program, &self.lowered.constants.stored);
        let number = self.precision.name();
        let kept: HashSet<ExprId> = stored.iter().copied().collect();
        let needed = program.needed(stored.iter().copied());
        let text_of = |id: ExprId| {
            if kept.contains(&id) { format!("c->{}", self.labels.constant(id)) } else { format!("t{:03}", id.index()) }
        };
        let mut text = format!(
            "void {}(const {} *params, {} *c)\n{{\n    c->params = *params;\n",
            self.name("set_params"),
            self.name("params"),
            self.name("constants")
        );
        for id in program.ids().filter(|id| needed[id.index()] && !program.op(*id).is_leaf()) {
            let value = operation(program.op(id), self.precision, &mut |operand| match program.op(operand) {
                Op::Constant(constant) => Expression::number(constant.value(), self.precision),
                Op::Symbol(symbol) => Expression::atom(format!("params->{}", field(&program.symbol(symbol).name))),
                _ => Expression::atom(text_of(operand)),
            });
            let declared = if kept.contains(&id) { String::new() } else { format!("const {number} ") };
            let _ = writeln!(text, "    {declared}{} = {};", text_of(id), value.text());
        }
        text + "}\n\n"
    }
}

/// The body of a piece while it is written.
struct Body<'a> {
    writer: &'a CWriter<'a>,
    code: &'a LoweredFunction<'a>,
    names: Names<'a>,
    /// Where the slots are in the result.
    positions: Vec<Vec<usize>>,
    /// Of the [`variables`](super::variables).
    fields: Vec<String>,
    used: Used,
    text: String,
}

impl Body<'_> {
    fn statement(&mut self, statement: &Statement) {
        let number = self.writer.precision.name();
        let f = self.writer.precision.suffix();
        match statement {
            &Statement::Input(id) => {
                let (source, name) = (self.input(id), self.names.name(id));
                if source != name {
                    self.local(&name, &source);
                }
            }
            Statement::SinCos(angles) => {
                for known in angles {
                    let angle = self.expression(known.angle);
                    for (id, function) in [(known.sin, "sin"), (known.cos, "cos")] {
                        if let Some(id) = id {
                            let name = self.names.name(id);
                            self.local(&name, &format!("{function}{f}({})", angle.text()));
                        }
                    }
                }
            }
            Statement::Stumpff(arguments) => {
                for (index, known) in arguments.iter().enumerate() {
                    let argument = self.expression(known.argument);
                    let (row, orders) = (format!("stumpff_{index}"), Op::STUMPFF_ORDERS);
                    self.line(&format!("{number} {row}[{orders}];"));
                    self.line(&format!("stumpff({}, {row});", argument.text()));
                    for (k, id) in known.values.iter().enumerate() {
                        if let Some(id) = id {
                            let name = self.names.name(*id);
                            self.local(&name, &format!("{row}[{k}]"));
                        }
                    }
                }
            }
            Statement::At(visit) => {
                if let Some(visit) = visit {
                    let direction = if visit.outward { "Outward" } else { "Inward" };
                    self.line(&format!("/* {direction}: {} */", comment(&visit.body)));
                }
            }
            &Statement::Let(id) => {
                let value = self.operation(id);
                let name = self.names.name(id);
                self.local(&name, value.text());
            }
            &Statement::Output { slot, value } => {
                let value = self.expression(value);
                let places = &self.positions[slot];
                let out = |place: &usize| match self.fields.get(*place) {
                    Some(field) if is_of_variables(self.code.function) => format!("out->{field} = "),
                    _ => format!("out[{place}] = "),
                };
                let written = places.iter().map(out).collect::<Vec<_>>().concat();
                self.line(&format!("{written}{};", value.text()));
            }
            &Statement::Keep { slot, value } => {
                let name = self.names.name(value);
                self.line(&format!("kept[{slot}] = {name};"));
            }
            &Statement::Fetch { slot, value } => {
                let name = self.names.name(value);
                self.local(&name, &format!("kept[{slot}]"));
            }
            Statement::Loop { .. } => unreachable!("chains without loops have none"),
        }
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "    {line}");
    }

    fn local(&mut self, name: &str, value: &str) {
        let number = self.writer.precision.name();
        self.line(&format!("const {number} {name} = {value};"));
    }

    /// An argument of a statement: a variable, a number, a constant, or an inlined operation.
    fn expression(&mut self, id: ExprId) -> Expression {
        let (program, constants) = (&self.writer.lowered.program, &self.writer.lowered.constants);
        if constants.is_stored(id) {
            self.used.insert(Argument::Parameters);
            return Expression::atom(format!("c->{}", self.writer.labels.constant(id)));
        }
        match program.op(id) {
            Op::Constant(constant) => Expression::number(constant.value(), self.writer.precision),
            Op::Symbol(symbol) if program.symbol(symbol).argument == Argument::Parameters => {
                self.used.insert(Argument::Parameters);
                Expression::atom(format!("c->params.{}", field(&program.symbol(symbol).name)))
            }
            _ if self.code.inlined[id.index()] => self.operation(id),
            _ => Expression::atom(self.names.name(id)),
        }
    }

    /// An operation on its arguments. Recursion ends within the bound of one statement.
    fn operation(&mut self, id: ExprId) -> Expression {
        let program = &self.writer.lowered.program;
        match (self.code.fused[id.index()], program.op(id)) {
            // A fused product is written as an ordinary product: the C compiler decides whether it is rounded.
            (Some(product), Op::Add(x, y)) if x == product => self.operation(x).plus(self.expression(y)),
            (Some(product), Op::Add(x, _)) => self.expression(x).plus(self.operation(product)),
            (Some(product), Op::Sub(x, y)) if x == product => self.operation(x).minus(self.expression(y)),
            (Some(product), Op::Sub(x, _)) => self.expression(x).minus(self.operation(product)),
            (_, op) => {
                let precision = self.writer.precision;
                operation(op, precision, &mut |operand| self.expression(operand))
            }
        }
    }

    /// The C text that reads an input.
    fn input(&mut self, id: ExprId) -> String {
        let Op::Symbol(symbol) = self.writer.lowered.program.op(id) else { unreachable!("inputs are symbols") };
        let symbol = self.writer.lowered.program.symbol(symbol);
        self.used.insert(symbol.argument);
        let name = argument_name(self.code.function, symbol.argument);
        match symbol.argument {
            Argument::Time => name.to_owned(),
            Argument::Inputs => format!("{name}->slots[{}]", symbol.index),
            Argument::Multiplier if self.code.function.product == Some(Product::Jvp) => {
                format!("{name}->{}", self.fields[symbol.index])
            }
            _ => format!("{name}[{}]", symbol.index),
        }
    }
}

/// An operation as C.
fn operation(op: Op, precision: Precision, of: &mut dyn FnMut(ExprId) -> Expression) -> Expression {
    let f = precision.suffix();
    let call = |function: &str, arguments: &[Expression]| Expression::call(function, arguments);
    match op {
        Op::Neg(a) => of(a).negative(),
        Op::Add(a, b) => of(a).plus(of(b)),
        Op::Sub(a, b) => of(a).minus(of(b)),
        Op::Mul(a, b) => of(a).times(of(b)),
        Op::Div(a, b) => of(a).over(of(b)),
        Op::Min(a, b) => call("smaller", &[of(a), of(b)]),
        Op::Max(a, b) => call("larger", &[of(a), of(b)]),
        Op::Select(a, b, c) => call("choose", &[of(a), of(b), of(c)]),
        Op::Sqrt(a) => call(&format!("sqrt{f}"), &[of(a)]),
        Op::Exp(a) => call(&format!("exp{f}"), &[of(a)]),
        Op::Sin(a) => call(&format!("sin{f}"), &[of(a)]),
        Op::Cos(a) => call(&format!("cos{f}"), &[of(a)]),
        Op::Constant(constant) => Expression::number(constant.value(), precision),
        Op::Symbol(_) | Op::Stumpff(..) => unreachable!("inputs are read, Stumpff's functions are evaluated first"),
    }
}

/// Whether the result is one number for each of the [`variables`](super::variables).
fn is_of_variables(function: &Function) -> bool {
    function.product == Some(Product::Vjp)
}

/// The name of an argument.
fn argument_name(function: &Function, argument: Argument) -> &'static str {
    match argument {
        Argument::Time => "t",
        Argument::Position => "q",
        Argument::Velocity => "v",
        Argument::Acceleration => "a",
        Argument::RightHandSide => "r",
        Argument::Multiplier if function.product == Some(Product::Jvp) => "dx",
        Argument::Multiplier => "w",
        Argument::DrivePositions => "positions",
        Argument::AddedInertia => "added_inertia",
        Argument::BaseAddedInertia => "base",
        Argument::Factors => "f",
        Argument::Parameters => "c",
        Argument::Inputs => "u",
        Argument::LoopVarying | Argument::LiveOut => unreachable!("chains without loops have none"),
    }
}
