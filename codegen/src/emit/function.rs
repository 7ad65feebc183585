//! A lowered function as a Rust function.

use std::collections::BTreeSet;

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::{Expr, Ident, Stmt, parse_quote};

use super::arithmetic::{
    borrow_mut, call, difference, element, field, integer, method, negative, product, quotient, sum, variable,
};
use super::labels::Labels;
use super::loops;
use super::names::Names;
use super::number::Number;
use super::print::comment;
use super::shape::{Handover, Storage};
use crate::lower::{LoweredFunction, LoweredProgram, Statement};
use crate::program::Argument;
use crate::symbolic::{ExprId, Op};

/// The items of one function: itself, and its pieces if it is long.
pub fn function(lowered: &LoweredProgram, code: &LoweredFunction, labels: &Labels, number: Number) -> Vec<syn::Item> {
    let writer = Writer { lowered, code, storage: Storage::of(code.function, number), labels, number };
    if code.pieces.len() == 1 { vec![writer.whole()] } else { writer.in_pieces() }
}

/// Writes one function.
pub struct Writer<'a> {
    pub(super) lowered: &'a LoweredProgram<'a>,
    pub(super) code: &'a LoweredFunction<'a>,
    pub(super) storage: Storage<'a>,
    pub(super) labels: &'a Labels<'a>,
    pub(super) number: Number,
}

impl Writer<'_> {
    fn whole(&self) -> syn::Item {
        let mut item = self.shell();
        let (mut body, used) = self.piece(&self.code.pieces[0]);
        let mut statements = Self::unpack(&used);
        // A single number needs no storage.
        if !self.is_scalar() {
            statements.push(self.begin());
        }
        statements.append(&mut body);
        if !self.is_scalar() {
            statements.extend(self.finish());
        }
        item.block.stmts = statements;
        syn::Item::Fn(item)
    }

    fn is_scalar(&self) -> bool {
        matches!(self.code.function.shape, crate::program::Shape::Scalar)
    }

    /// The storage, with its blank values.
    fn begin(&self) -> Stmt {
        if matches!(self.storage.handover(), Handover::OutArgument) {
            return parse_quote!(out.fill(Matrix4::zeros()););
        }
        let name = format_ident!("{}", self.storage.storage_name());
        let (storage, blank) = (self.storage.storage_type(), self.storage.blank());
        // Every slot may be zero.
        let written = self.code.pieces.iter().flatten().any(|s| matches!(s, Statement::Output { .. }));
        let mutable = written.then(|| quote!(mut));
        parse_quote!(let #mutable #name: #storage = #blank;)
    }

    /// The result from its storage.
    fn finish(&self) -> Vec<Stmt> {
        if matches!(self.storage.handover(), Handover::OutArgument) {
            return vec![];
        }
        let finish = self.storage.finish();
        let block: syn::Block = parse_quote!({ #finish });
        block.stmts
    }

    fn in_pieces(&self) -> Vec<syn::Item> {
        let mut item = self.shell();
        let storage = self.storage.storage_type();
        let kept = integer(self.code.kept);
        let (number, zero) = (self.number.of(), self.number.literal(0.0));
        let mut statements: Vec<Stmt> = vec![self.begin()];
        if self.code.kept > 0 {
            statements.push(parse_quote!(let mut kept = [#zero; #kept];));
        }
        let mut items = Vec::new();
        let total = self.code.pieces.len();
        for (index, piece) in self.code.pieces.iter().enumerate() {
            let name = format_ident!("{}_{}", self.code.function.id.name(), index + 1);
            let (body, used) = self.piece(piece);
            let unpack = Self::unpack(&used);
            let keeps = piece.iter().any(|s| matches!(s, Statement::Keep { .. } | Statement::Fetch { .. }));
            let outputs = piece.iter().any(|s| matches!(s, Statement::Output { .. }));
            let mut parameters: Vec<TokenStream> = self.inputs(&used);
            let mut arguments: Vec<Expr> = self.input_names(&used).iter().map(|n| variable(n)).collect();
            if keeps {
                parameters.push(quote!(kept: &mut [#number; #kept]));
                arguments.push(borrow_mut(variable("kept")));
            }
            if outputs {
                let name = format_ident!("{}", self.storage.storage_name());
                parameters.push(quote!(#name: &mut #storage));
                let storage = variable(self.storage.storage_name());
                arguments.push(match self.storage.handover() {
                    Handover::OutArgument => storage,
                    Handover::Return | Handover::FromFactors | Handover::Both => borrow_mut(storage),
                });
            }
            let called = call(&name.to_string(), arguments);
            statements.push(parse_quote!(#called;));
            let doc = format!(" Part {} of {total} of [`{}`].", index + 1, self.code.function.id.name());
            let mut part: syn::ItemFn = parse_quote! {
                #[doc = #doc]
                #[inline(never)]
                fn #name(#(#parameters),*) {}
            };
            part.block.stmts = unpack.into_iter().chain(body).collect();
            items.push(syn::Item::Fn(part));
        }
        statements.extend(self.finish());
        item.block.stmts = statements;
        items.insert(0, syn::Item::Fn(item));
        items
    }

    /// Signature and documentation.
    fn shell(&self) -> syn::ItemFn {
        let function = self.code.function;
        let name = format_ident!("{}", function.id.name());
        let docs = [
            format!(" {}", function.doc),
            String::new(),
            format!(" `{}`", function.equation.split(" [").next().unwrap_or_default()),
            function.equation.find(" [").map(|at| function.equation[at..].to_owned()).unwrap_or_default(),
            String::new(),
            format!(" {} operations: {}.", self.code.count.total(), self.code.count),
        ];
        let docs = docs.iter().enumerate().filter(|(i, line)| *i != 3 || !line.is_empty()).map(|(_, line)| line);
        let mut parameters = self.all_inputs();
        let output = self.storage.public_type();
        let signature = match self.storage.handover() {
            Handover::Return => quote!(pub fn #name(#(#parameters),*) -> #output),
            Handover::Both => {
                parameters.push(quote!(mass: &mut SMatrix<f64, N, N>));
                quote!(pub fn #name(#(#parameters),*) -> #output)
            }
            Handover::OutArgument | Handover::FromFactors => {
                parameters.push(quote!(out: &mut #output));
                quote!(pub fn #name(#(#parameters),*))
            }
        };
        parse_quote! {
            #(#[doc = #docs])*
            #signature {}
        }
    }

    /// Arguments of the function itself: always the same for a function, used or not.
    fn all_inputs(&self) -> Vec<TokenStream> {
        let mut used = Used::new();
        self.code.pieces.iter().for_each(|piece| self.use_inputs(piece, &mut used));
        let mut inputs: Vec<TokenStream> = Vec::new();
        for argument in self.code.function.arguments {
            let (name, of) = argument_name(*argument, self.number);
            let name = if used.contains(argument) { format_ident!("{name}") } else { format_ident!("_{name}") };
            inputs.push(quote!(#name: #of));
        }
        if self.code.reads_parameters {
            inputs.push(quote!(c: &Constants));
        }
        if self.code.reads_inputs {
            inputs.push(quote!(u: &Inputs));
        }
        inputs
    }

    /// The values that statements, and loops among them, read.
    fn use_inputs(&self, statements: &[Statement], used: &mut Used) {
        for statement in statements {
            match statement {
                Statement::Input(id) => drop(self.input(*id, used)),
                Statement::Loop { body, .. } => self.use_inputs(body, used),
                _ => {}
            }
        }
    }

    /// Arguments of a piece: those that it uses.
    fn inputs(&self, used: &Used) -> Vec<TokenStream> {
        let mut inputs: Vec<TokenStream> = Vec::new();
        for argument in self.code.function.arguments.iter().filter(|a| used.contains(a)) {
            let (name, of) = argument_name(*argument, self.number);
            let name = format_ident!("{name}");
            inputs.push(quote!(#name: #of));
        }
        if used.contains(&Argument::Parameters) {
            inputs.push(quote!(c: &Constants));
        }
        if used.contains(&Argument::Inputs) {
            inputs.push(quote!(u: &Inputs));
        }
        inputs
    }

    fn input_names(&self, used: &Used) -> Vec<&'static str> {
        let arguments = self.code.function.arguments.iter().filter(|a| used.contains(a));
        arguments
            .map(|a| argument_name(*a, self.number).0)
            .chain(used.contains(&Argument::Parameters).then_some("c"))
            .chain(used.contains(&Argument::Inputs).then_some("u"))
            .collect()
    }

    /// Plain arrays behind the vectors: a constant index into an array is checked when it is compiled.
    fn unpack(used: &Used) -> Vec<Stmt> {
        let mut statements: Vec<Stmt> = Vec::new();
        for (argument, vector) in VECTORS {
            if used.contains(&argument) {
                let vector = format_ident!("{vector}");
                statements.push(parse_quote!(let #vector = &#vector.data.0[0];));
            }
        }
        statements
    }

    /// Statements of a piece, and what they use.
    fn piece(&self, piece: &[Statement]) -> (Vec<Stmt>, Used) {
        let mut names = Names::new(&self.lowered.program, self.code.rerolled.loops.len());
        let mut used = Used::new();
        let mut statements = self.statements(piece, &mut names, &mut used);
        if self.is_scalar()
            && self.code.pieces.len() == 1
            && !piece.iter().any(|s| matches!(s, Statement::Output { .. }))
        {
            statements.push(Stmt::Expr(self.number.literal(0.0), None));
        }
        (statements, used)
    }

    /// Statements one by one.
    pub(super) fn statements(&self, piece: &[Statement], names: &mut Names, used: &mut Used) -> Vec<Stmt> {
        let mut statements = Vec::new();
        let (mut group, mut sweeping) = (None, false);
        let mut pending: Vec<Stmt> = Vec::new();
        for statement in piece {
            match statement {
                &Statement::Input(id) => {
                    let source = self.input(id, used);
                    let name = names.of(id);
                    if !matches!(&source, Expr::Path(path) if path.path.is_ident(&name)) {
                        pending.push(local(&name, &source));
                    }
                }
                Statement::SinCos(angles) => {
                    statements.append(&mut pending);
                    statements.push(comment("Sines and cosines"));
                    let (sines, cosines): (Vec<_>, Vec<_>) = angles.iter().map(|known| (known.sin, known.cos)).unzip();
                    let angles = angles.iter().map(|known| self.expression(known.angle, names, used));
                    let angles: Vec<Expr> = angles.collect();
                    if self.code.rerolled.loops.is_empty() {
                        let sines: Vec<_> = sines.into_iter().map(|sin| pattern(sin, names)).collect();
                        let cosines: Vec<_> = cosines.into_iter().map(|cos| pattern(cos, names)).collect();
                        statements.push(parse_quote!(let ([#(#sines),*], [#(#cosines),*]) = sin_cos([#(#angles),*]);));
                    } else {
                        statements.push(parse_quote!(let (sines, cosines) = sin_cos([#(#angles),*]);));
                        statements.extend(loops::patterns("sines", &sines, names));
                        statements.extend(loops::patterns("cosines", &cosines, names));
                    }
                }
                Statement::Stumpff(arguments) => {
                    statements.append(&mut pending);
                    statements.push(comment("Stumpff's functions"));
                    let of = arguments.iter().map(|known| self.expression(known.argument, names, used));
                    let of: Vec<Expr> = of.collect();
                    let orders =
                        (0..Op::STUMPFF_ORDERS).map(|k| arguments.iter().map(|known| known.values[k]).collect());
                    let orders: Vec<Vec<Option<ExprId>>> = orders.collect();
                    if self.code.rerolled.loops.is_empty() {
                        let patterns = orders.iter().map(|values| row_pattern(values, names));
                        let patterns: Vec<_> = patterns.collect();
                        statements.push(parse_quote!(let [#(#patterns),*] = stumpff([#(#of),*]);));
                    } else {
                        statements.push(parse_quote!(let stumpff_of = stumpff([#(#of),*]);));
                        let patterns = orders.iter().map(|values| row_pattern(values, names));
                        let patterns: Vec<_> = patterns.collect();
                        if orders.iter().flatten().any(Option::is_some) {
                            statements.push(parse_quote!(let [#(#patterns),*] = stumpff_of;));
                        }
                    }
                }
                Statement::Loop { of, body } => {
                    statements.append(&mut pending);
                    group = None;
                    statements.extend(self.loop_statements(*of, body, names, used));
                }
                Statement::At(place) => {
                    statements.append(&mut pending);
                    group = None;
                    sweeping = place.is_some();
                    statements.extend(place.as_ref().map(|place| comment(&loops::position_of(place))));
                }
                &Statement::Let(id) => {
                    let value = self.operation(id, names, used);
                    pending.push(local(&names.of(id), &value));
                }
                &Statement::Output { slot, value } => {
                    if !sweeping && group != Some(self.storage.group(slot)) {
                        group = Some(self.storage.group(slot));
                        if let Some(label) = self.labels.of(self.code.function, slot) {
                            statements.push(comment(&label));
                        }
                    }
                    let value = self.expression(value, names, used);
                    let alone = self.is_scalar() && self.code.pieces.len() == 1;
                    if alone {
                        pending.push(Stmt::Expr(value, None));
                    } else {
                        let mut place = self.storage.place(slot);
                        if self.is_scalar() {
                            place = parse_quote!(*out);
                        }
                        pending.push(parse_quote!(#place = #value;));
                    }
                    statements.append(&mut pending);
                }
                &Statement::Keep { place, value } => {
                    let (place, value) = (element(variable("kept"), place), variable(&names.of(value)));
                    pending.push(parse_quote!(#place = #value;));
                }
                &Statement::Fetch { place, value } => {
                    pending.push(local(&names.of(value), &element(variable("kept"), place)));
                }
            }
        }
        statements.append(&mut pending);
        statements
    }

    /// An argument of a statement: a variable, a number, a constant, or an inlined operation.
    pub(super) fn expression(&self, id: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        let program = &self.lowered.program;
        if self.lowered.constants.is_stored(id) {
            used.insert(Argument::Parameters);
            return field(variable("c"), &self.labels.constant(id));
        }
        match program.op(id) {
            Op::Constant(c) => self.number.literal(c.value()),
            Op::Symbol(symbol) if program.symbol(symbol).argument == Argument::Parameters => {
                used.insert(Argument::Parameters);
                field(field(variable("c"), "params"), &program.symbol(symbol).name)
            }
            _ if self.code.inlined[id.index()] => self.operation(id, names, used),
            _ => variable(&names.of(id)),
        }
    }

    /// An operation on its arguments. Recursion ends within the bound of one statement.
    fn operation(&self, id: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        if let Some(product) = self.code.fused[id.index()] {
            return self.fused(id, product, names, used);
        }
        operation(self.lowered.program.op(id), self.number, &mut |operand| self.expression(operand, names, used))
    }

    /// A sum or difference with a product in it: `fma(a, b, c)`.
    fn fused(&self, id: ExprId, product: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        let program = &self.lowered.program;
        let Op::Mul(a, b) = program.op(product) else { unreachable!("only products are fused") };
        let mut of = |operand: ExprId| self.expression(operand, names, used);
        let (a, b) = (of(a), of(b));
        let [a, b, c] = match program.op(id) {
            Op::Add(x, y) => [a, b, of(if x == product { y } else { x })],
            Op::Sub(x, y) if x == product => [a, b, negative(of(y))],
            Op::Sub(x, _) => [negative(a), b, of(x)],
            _ => unreachable!("only sums and differences take a product"),
        };
        call("fma", [a, b, c])
    }

    fn input(&self, id: ExprId, used: &mut Used) -> Expr {
        let Op::Symbol(symbol) = self.lowered.program.op(id) else { unreachable!("inputs are symbols") };
        let symbol = self.lowered.program.symbol(symbol);
        match symbol.argument {
            Argument::LoopVarying => return self.source(symbol.index, used),
            Argument::LiveOut => return self.live_out(symbol.index),
            _ => used.insert(symbol.argument),
        };
        match symbol.argument {
            Argument::Time => variable("t"),
            Argument::BaseAddedInertia => {
                let columns = field(field(variable("base"), "data"), "0");
                element(element(columns, symbol.index / 6), symbol.index % 6)
            }
            Argument::Parameters => unreachable!("parameters are read where they are used"),
            vector => element(self.argument(vector, used), symbol.index),
        }
    }

    /// An argument by its name.
    pub(super) fn argument(&self, argument: Argument, used: &mut Used) -> Expr {
        used.insert(argument);
        variable(argument_name(argument, self.number).0)
    }
}

/// An operation as Rust.
pub fn operation(op: Op, number: Number, of: &mut dyn FnMut(ExprId) -> Expr) -> Expr {
    match op {
        Op::Neg(a) => negative(of(a)),
        Op::Add(a, b) => sum(of(a), of(b)),
        Op::Sub(a, b) => difference(of(a), of(b)),
        Op::Mul(a, b) => product(of(a), of(b)),
        Op::Div(a, b) => quotient(of(a), of(b)),
        Op::Min(a, b) => method(of(a), "min", of(b)),
        Op::Max(a, b) => method(of(a), "max", of(b)),
        Op::Sqrt(a) => call("sqrt", [of(a)]),
        Op::Exp(a) => call("exp", [of(a)]),
        Op::Select(a, b, c) => {
            let (a, b) = (of(a), of(b));
            call("select", [a, b, of(c)])
        }
        Op::Sin(a) => field_of_pair(&of(a), 0),
        Op::Cos(a) => field_of_pair(&of(a), 1),
        Op::Stumpff(k, a) => {
            let argument = of(a);
            element(element(call("stumpff", [parse_quote!([#argument])]), usize::from(k)), 0)
        }
        Op::Constant(c) => number.literal(c.value()),
        Op::Symbol(_) => unreachable!("inputs are read, not computed"),
    }
}

/// `sin_cos([angle]).0[0]`
fn field_of_pair(angle: &Expr, index: u32) -> Expr {
    let angles: Expr = parse_quote!([#angle]);
    element(field(call("sin_cos", [angles]), &index.to_string()), 0)
}

/// `let name = value;`
pub fn local(name: &str, value: &Expr) -> Stmt {
    let name = Ident::new(name, Span::call_site());
    parse_quote!(let #name = #value;)
}

/// The name of a value, or `_` if it is not needed.
pub fn pattern(id: Option<ExprId>, names: &mut Names) -> TokenStream {
    id.map_or_else(|| quote!(_), |id| Ident::new(&names.of(id), Span::call_site()).into_token_stream())
}

/// The names of several values, or `_` if none is needed.
fn row_pattern(ids: &[Option<ExprId>], names: &mut Names) -> TokenStream {
    if ids.iter().all(Option::is_none) {
        return quote!(_);
    }
    let patterns = ids.iter().map(|id| pattern(*id, names));
    let patterns: Vec<_> = patterns.collect();
    quote!([#(#patterns),*])
}

/// The inputs that a piece reads.
pub type Used = BTreeSet<Argument>;

/// Arguments that are vectors, and their names.
const VECTORS: [(Argument, &str); 5] = [
    (Argument::Position, "q"),
    (Argument::Velocity, "v"),
    (Argument::Acceleration, "a"),
    (Argument::RightHandSide, "r"),
    (Argument::AddedInertia, "added_inertia"),
];

/// Name and type of an argument, in functions and in the methods that call them.
pub fn argument_name(argument: Argument, number: Number) -> (&'static str, TokenStream) {
    let number = number.of();
    match argument {
        Argument::Time => ("t", quote!(#number)),
        Argument::Position => ("q", quote!(&SVector<#number, N>)),
        Argument::Velocity => ("v", quote!(&SVector<#number, N>)),
        Argument::Acceleration => ("a", quote!(&SVector<#number, N>)),
        Argument::RightHandSide => ("r", quote!(&SVector<#number, N>)),
        Argument::AddedInertia => ("added_inertia", quote!(&SVector<#number, N>)),
        Argument::BaseAddedInertia => ("base", quote!(&SMatrix<#number, 6, 6>)),
        Argument::Factors => ("f", quote!(&Factors)),
        Argument::Parameters => ("c", quote!(&Constants)),
        Argument::Inputs => ("u", quote!(&Inputs)),
        Argument::LoopVarying | Argument::LiveOut => unreachable!("loops take from themselves"),
    }
}
