//! Arguments of a function and of its pieces.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Stmt, parse_quote};

use super::number::Number;
use super::writer::{RustWriter, Used};
use crate::lower::Statement;
use crate::program::Argument;

/// Arguments that are vectors, and their names.
const VECTORS: [(Argument, &str); 6] = [
    (Argument::Position, "q"),
    (Argument::Velocity, "v"),
    (Argument::Acceleration, "a"),
    (Argument::RightHandSide, "r"),
    (Argument::DrivePositions, "positions"),
    (Argument::AddedInertia, "added_inertia"),
];

/// Name and type of an argument, in functions and in the methods that call them.
pub fn argument_name(argument: Argument, number: Number) -> (&'static str, TokenStream) {
    let number = number.type_tokens();
    match argument {
        Argument::Time => ("t", quote!(#number)),
        Argument::Position => ("q", quote!(&SVector<#number, N>)),
        Argument::Velocity => ("v", quote!(&SVector<#number, N>)),
        Argument::Acceleration => ("a", quote!(&SVector<#number, N>)),
        Argument::RightHandSide => ("r", quote!(&SVector<#number, N>)),
        Argument::DrivePositions => ("positions", quote!(&SVector<#number, N>)),
        Argument::AddedInertia => ("added_inertia", quote!(&SVector<#number, N>)),
        Argument::BaseAddedInertia => ("base", quote!(&SMatrix<#number, 6, 6>)),
        Argument::Factors => ("f", quote!(&Factors)),
        Argument::Parameters => ("c", quote!(&Constants)),
        Argument::Inputs => ("u", quote!(&Inputs)),
        Argument::LoopVarying | Argument::LiveOut => unreachable!("loops take from themselves"),
        Argument::Multiplier => unreachable!("Rust has no products with derivatives"),
    }
}

impl RustWriter<'_> {
    /// Arguments of the function itself: always all of them, whether used or not.
    pub(super) fn all_inputs(&self) -> Vec<TokenStream> {
        let mut used = Used::new();
        self.code.pieces.iter().for_each(|piece| self.use_inputs(piece, &mut used));
        let mut inputs: Vec<TokenStream> = Vec::new();
        for argument in &self.code.function.arguments {
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

    /// Collects the inputs that statements read, including those in loops.
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
    pub(super) fn inputs(&self, used: &Used) -> Vec<TokenStream> {
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

    pub(super) fn input_names(&self, used: &Used) -> Vec<&'static str> {
        let arguments = self.code.function.arguments.iter().filter(|a| used.contains(a));
        arguments
            .map(|a| argument_name(*a, self.number).0)
            .chain(used.contains(&Argument::Parameters).then_some("c"))
            .chain(used.contains(&Argument::Inputs).then_some("u"))
            .collect()
    }

    /// Unpacks vectors into plain arrays: a constant index into an array is checked at compile time.
    pub(super) fn unpack(used: &Used) -> Vec<Stmt> {
        let mut statements: Vec<Stmt> = Vec::new();
        for (argument, vector) in VECTORS {
            if used.contains(&argument) {
                let vector = format_ident!("{vector}");
                statements.push(parse_quote!(let #vector = &#vector.data.0[0];));
            }
        }
        statements
    }
}
