//! A loop as Rust.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Expr, Stmt, parse_quote};

use super::arithmetic::{at, element, integer, place, variable};
use super::names::{Names, OF_LOOPS, of_loop};
use super::number::Number;
use super::print::comment;
use super::writer::{RustWriter, Used, pattern};
use crate::lower::{LiveOut, Source, Statement, SweepPosition};
use crate::symbolic::ExprId;

impl RustWriter<'_> {
    /// The initial values of a loop, and the loop.
    pub(super) fn loop_statements(
        &self,
        of: usize,
        body: &[Statement],
        names: &mut Names,
        used: &mut Used,
    ) -> Vec<Stmt> {
        let rolled = &self.code.rerolled.loops[of];
        let [numbers, gathered, loop_carried, saved] = OF_LOOPS.map(|name| owned(name, of));
        let (number, iterations) = (self.number.type_tokens(), integer(rolled.iterations));
        let [first, last] = &rolled.ends;
        let mut statements = vec![comment(&format!("{} to {}", position_of(first), last.body))];
        if !rolled.numbers.is_empty() {
            let rows = (0..rolled.iterations)
                .map(|k| row(rolled.numbers.iter().map(|column| Number::Single.literal(column[k]))));
            let width = integer(rolled.numbers.len());
            statements.push(parse_quote!(static #numbers: [[f64; #width]; #iterations] = [#(#rows),*];));
        }
        if !rolled.gathered.is_empty() {
            let rows: Vec<TokenStream> = (0..rolled.iterations)
                .map(|k| row(rolled.gathered.iter().map(|column| self.expression(column[k], names, used))))
                .collect();
            statements.push(parse_quote!(let #gathered = [#(#rows),*];));
        }
        if !rolled.loop_carried.is_empty() {
            let initial = row(rolled.loop_carried.iter().map(|(initial, _)| self.expression(*initial, names, used)));
            statements.push(parse_quote!(let mut #loop_carried = #initial;));
        }
        if !rolled.saved.is_empty() {
            let (width, zero) = (integer(rolled.saved.len()), self.number.literal(0.0));
            statements
                .push(parse_quote!(let mut #saved: [[#number; #width]; #iterations] = [[#zero; #width]; #iterations];));
        }
        let mut iteration = self.statements(body, names, used);
        for (slots, value) in &rolled.results {
            let (target, value) = (self.storage.place_at(*slots), self.expression(*value, names, used));
            iteration.push(parse_quote!(#target = #value;));
        }
        if !rolled.saved.is_empty() {
            let values = row(rolled.saved.iter().map(|value| self.expression(*value, names, used)));
            iteration.push(parse_quote!(#saved[k] = #values;));
        }
        if !rolled.loop_carried.is_empty() {
            let values = row(rolled.loop_carried.iter().map(|(_, next)| self.expression(*next, names, used)));
            iteration.push(parse_quote!(#loop_carried = #values;));
        }
        statements.push(parse_quote!(for k in 0..#iterations { #(#iteration)* }));
        statements
    }

    /// A value that differs from iteration to iteration.
    pub(super) fn source(&self, index: usize, used: &mut Used) -> Expr {
        let (of, source) = &self.code.rerolled.sources[index];
        match source {
            Source::Number(column) => {
                let number = element(place(owned("numbers", *of), &variable("k")), *column);
                match self.number {
                    Number::Single => number,
                    Number::Lanes => parse_quote!(splat(#number)),
                }
            }
            Source::Input(argument, slots) => place(self.argument(*argument, used), &at(*slots)),
            Source::Sine(places) => place(variable("sines"), &at(*places)),
            Source::Cosine(places) => place(variable("cosines"), &at(*places)),
            Source::Stumpff(k, places) => place(element(variable("stumpff_of"), usize::from(*k)), &at(*places)),
            Source::LoopCarried(slot) => element(owned("carried", *of), *slot),
            Source::Saved { of, slot, iteration } => element(place(owned("saved", *of), &at(*iteration)), *slot),
            Source::Gathered(column) => element(place(owned("gathered", *of), &variable("k")), *column),
        }
    }

    /// A value taken from a loop after its last iteration.
    pub(super) fn live_out(&self, index: usize) -> Expr {
        match self.code.rerolled.live_outs[index] {
            LiveOut::LoopCarried { of, slot } => element(owned("carried", of), slot),
            LiveOut::Saved { of, slot, iteration } => element(element(owned("saved", of), iteration), slot),
        }
    }
}

/// `Outward: boom_1`
pub fn position_of(SweepPosition { body, outward }: &SweepPosition) -> String {
    format!("{}: {body}", if *outward { "Outward" } else { "Inward" })
}

/// Names for those elements of an array that need one: `let [_, sin_psi] = sines;`
pub fn patterns(array: &str, ids: &[Option<ExprId>], names: &mut Names) -> Option<Stmt> {
    let array = variable(array);
    let patterns: Vec<TokenStream> = ids.iter().map(|id| pattern(*id, names)).collect();
    ids.iter().any(Option::is_some).then(|| parse_quote!(let [#(#patterns),*] = #array;))
}

/// `saved_1` of the first loop.
fn owned(name: &str, of: usize) -> Expr {
    variable(&of_loop(name, of))
}

/// `[a, b, c]`
fn row(values: impl Iterator<Item = Expr>) -> TokenStream {
    quote!([#(#values),*])
}
