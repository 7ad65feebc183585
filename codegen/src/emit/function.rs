//! A lowered function as a Rust function.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Expr, Stmt, parse_quote};

use super::arithmetic::{borrow_mut, call, element, integer, variable};
use super::labels::Labels;
use super::loops;
use super::names::Names;
use super::number::Number;
use super::print::comment;
use super::shape::{Handover, Storage};
use super::writer::{RustWriter, Used, local, pattern};
use crate::lower::{LoweredFunction, LoweredProgram, Statement};
use crate::symbolic::{ExprId, Op};

/// The items of one function: itself, and its pieces if it is long.
pub fn function(lowered: &LoweredProgram, code: &LoweredFunction, labels: &Labels, number: Number) -> Vec<syn::Item> {
    let writer = RustWriter { lowered, code, storage: Storage::new(code.function, number), labels, number };
    if code.pieces.len() == 1 { vec![writer.whole()] } else { writer.in_pieces() }
}

impl RustWriter<'_> {
    fn whole(&self) -> syn::Item {
        let mut item = self.shell();
        let (mut body, used) = self.piece(&self.code.pieces[0]);
        let mut statements = Self::unpack(&used);
        // A single number needs no storage.
        if !self.is_scalar() {
            statements.extend(self.begin());
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

    /// The storage with its initial values.
    fn begin(&self) -> Vec<Stmt> {
        if matches!(self.storage.handover(), Handover::OutArgument) {
            let zero = self.storage.blank_item();
            return self.storage.open().into_iter().chain([parse_quote!(out.fill(#zero);)]).collect();
        }
        let name = format_ident!("{}", self.storage.storage_name());
        let (storage, blank) = (self.storage.storage_type(), self.storage.blank());
        // If no statement writes a slot, the storage is not mutable.
        let written = self.code.pieces.iter().flatten().any(|s| matches!(s, Statement::Output { .. }));
        let mutable = written.then(|| quote!(mut));
        vec![parse_quote!(let #mutable #name: #storage = #blank;)]
    }

    /// The result from its storage.
    fn finish(&self) -> Vec<Stmt> {
        let finish = self.storage.finish();
        let block: syn::Block = parse_quote!({ #finish });
        block.stmts
    }

    fn in_pieces(&self) -> Vec<syn::Item> {
        let mut item = self.shell();
        let storage = self.storage.storage_type();
        let kept = integer(self.code.kept);
        let (number, zero) = (self.number.type_tokens(), self.number.literal(0.0));
        let mut statements = self.begin();
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
                    let name = names.name(id);
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
                Statement::At(visit) => {
                    statements.append(&mut pending);
                    group = None;
                    sweeping = visit.is_some();
                    statements.extend(visit.as_ref().map(|visit| comment(&loops::position_of(visit))));
                }
                &Statement::Let(id) => {
                    let value = self.operation(id, names, used);
                    pending.push(local(&names.name(id), &value));
                }
                &Statement::Output { slot, value } => {
                    if !sweeping && group != Some(self.storage.group(slot)) {
                        group = Some(self.storage.group(slot));
                        if let Some(label) = self.labels.label(self.code.function, slot) {
                            statements.push(comment(&label));
                        }
                    }
                    let value = self.expression(value, names, used);
                    let alone = self.is_scalar() && self.code.pieces.len() == 1;
                    if alone {
                        pending.push(Stmt::Expr(value, None));
                    } else {
                        let mut target = self.storage.place(slot);
                        if self.is_scalar() {
                            target = parse_quote!(*out);
                        }
                        pending.push(parse_quote!(#target = #value;));
                    }
                    statements.append(&mut pending);
                }
                &Statement::Keep { slot, value } => {
                    let (target, value) = (element(variable("kept"), slot), variable(&names.name(value)));
                    pending.push(parse_quote!(#target = #value;));
                }
                &Statement::Fetch { slot, value } => {
                    pending.push(local(&names.name(value), &element(variable("kept"), slot)));
                }
            }
        }
        statements.append(&mut pending);
        statements
    }
}

/// A pattern of the names of several values, or `_` if none is needed.
fn row_pattern(ids: &[Option<ExprId>], names: &mut Names) -> TokenStream {
    if ids.iter().all(Option::is_none) {
        return quote!(_);
    }
    let patterns = ids.iter().map(|id| pattern(*id, names));
    let patterns: Vec<_> = patterns.collect();
    quote!([#(#patterns),*])
}
