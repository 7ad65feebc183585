//! Storage of results while they are computed, and returned types.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Expr, Stmt, parse_quote};

use super::arithmetic::{at, element, field, integer, place, variable};
use super::number::Number;
use crate::lower::Progression;
use crate::program::{ConcurrentAxes, Function, Shape, Struct};

/// How a function returns its result.
pub enum Handover {
    /// Returned by value.
    Return,
    /// Written to the caller's place, because it may be larger than a stack.
    OutArgument,
    /// Computed from factors into the caller's place.
    FromFactors,
    /// A vector returned by value, a matrix written to the caller's matrix.
    Both,
}

/// Type, storage and slots of a result.
pub struct Storage<'f> {
    shape: &'f Shape,
    number: Number,
}

impl<'f> Storage<'f> {
    pub fn new(function: &'f Function, number: Number) -> Self {
        Storage { shape: &function.shape, number }
    }

    pub fn handover(&self) -> Handover {
        match self.shape {
            Shape::Transforms { corner: 0, .. } | Shape::Rows { .. } | Shape::Symmetric(_) => Handover::OutArgument,
            Shape::TransformFactors { .. } | Shape::Tangent { .. } | Shape::Columns { bias: false, .. } => {
                Handover::FromFactors
            }
            Shape::MassAndBias(_) | Shape::Columns { bias: true, .. } => Handover::Both,
            _ => Handover::Return,
        }
    }

    /// Type that the function returns, or whose reference it takes.
    pub fn public_type(&self) -> TokenStream {
        let number = self.number.type_tokens();
        match self.shape {
            Shape::Scalar => quote!(f64),
            Shape::Vector(_) | Shape::MassAndBias(_) | Shape::Columns { bias: true, .. } => quote!(SVector<#number, N>),
            Shape::Symmetric(_) | Shape::Tangent { .. } | Shape::Columns { bias: false, .. } => {
                quote!(SMatrix<f64, N, N>)
            }
            Shape::Base => quote!(SMatrix<f64, 6, 6>),
            Shape::Factors(_) => quote!(Factors),
            Shape::Vectors(n) => array(&quote!(Vector3<f64>), *n),
            Shape::Pairs(n) => array(&quote!([f64; 2]), *n),
            Shape::Rows { count, .. } => array(&quote!([f64; N]), *count),
            Shape::Structs(of, n) => array(&struct_name(*of), *n),
            Shape::Transforms { .. } | Shape::TransformFactors { .. } => {
                array(&quote!(Matrix4<f64>), self.shape.matrices())
            }
            Shape::Record(name, _) => {
                let name = format_ident!("{name}");
                quote!(#name<N>)
            }
        }
    }

    /// Name of the variable that collects the result.
    pub fn storage_name(&self) -> &'static str {
        match self.shape {
            Shape::TransformFactors { .. } | Shape::Tangent { .. } => "factors",
            Shape::Columns { .. } => "columns",
            _ => "out",
        }
    }

    /// Type of the variable `out` that collects the result.
    pub fn storage_type(&self) -> TokenStream {
        let number = self.number.type_tokens();
        match self.shape {
            Shape::Vector(_) => quote!([#number; N]),
            Shape::Symmetric(_) => quote!([[f64; N]; N]),
            Shape::Tangent { .. } => array(&quote!(f64), self.shape.len()),
            Shape::Base => quote!([[f64; 6]; 6]),
            Shape::Columns { n, .. } => {
                let eights = integer(n.div_ceil(8));
                quote!(MassColumns<N, #eights>)
            }
            Shape::MassAndBias(_) => quote!(MassAndBias<N>),
            Shape::Record(_, fields) => array(&quote!([[f64; N]; N]), fields.len()),
            Shape::TransformFactors { degrees, vectors, .. } => {
                let total = integer(degrees.iter().sum());
                // Without rotation vectors the parameter keeps its default.
                let vectors = (!vectors.is_empty()).then(|| integer(vectors.len())).map(|count| quote!(, #count));
                quote!(TransformFactors<N, #total #vectors>)
            }
            _ => self.public_type(),
        }
    }

    /// A storage in which every slot that no statement writes already has its value.
    pub fn blank(&self) -> TokenStream {
        let zero = self.number.literal(0.0);
        match self.shape {
            Shape::Scalar => quote!(0.0),
            Shape::Vector(_) => quote!([#zero; N]),
            Shape::Base => quote!([[0.0; 6]; 6]),
            Shape::Columns { .. } => quote!(MassColumns::zeros()),
            Shape::MassAndBias(_) => quote!(MassAndBias::zeros()),
            Shape::Factors(_) | Shape::Tangent { .. } => array(&quote!(0.0), self.shape.len()),
            Shape::Vectors(n) => array(&quote!(Vector3::zeros()), *n),
            Shape::Pairs(n) => array(&quote!([0.0; 2]), *n),
            Shape::Structs(of, n) => {
                let of = struct_name(*of);
                array(&quote!(#of::ZERO), *n)
            }
            Shape::Transforms { counts, corner } => {
                let blank = if *corner == 1 { quote!(BLANK) } else { quote!(Matrix4::zeros()) };
                array(&blank, counts.iter().sum())
            }
            Shape::TransformFactors { .. } => quote!(TransformFactors::zeros()),
            Shape::Record(_, fields) => array(&quote!([[0.0; N]; N]), fields.len()),
            Shape::Rows { .. } | Shape::Symmetric(_) => unreachable!("written to the caller's place"),
        }
    }

    /// The storage that the caller has, if it is part of the argument.
    pub fn open(&self) -> Option<Stmt> {
        matches!(self.shape, Shape::Symmetric(_)).then(|| parse_quote!(let out = &mut out.data.0;))
    }

    /// An item of a storage that the caller has.
    pub fn blank_item(&self) -> TokenStream {
        if let Shape::Rows { .. } | Shape::Symmetric(_) = self.shape {
            quote!([0.0; N])
        } else {
            quote!(Matrix4::zeros())
        }
    }

    /// The result from its storage.
    pub fn finish(&self) -> TokenStream {
        match self.shape {
            Shape::Vector(_) => quote!(SVector::from(out)),
            Shape::Symmetric(_) => quote!(mirror(out);),
            Shape::Transforms { corner: 0, .. } | Shape::Rows { .. } => TokenStream::new(),
            Shape::Base => quote!(symmetric(out)),
            Shape::Columns { points, bias: false, .. } => {
                let points = points.iter().map(concurrent_axes);
                quote!(columns.mass_matrix(&[#(#points),*], &mut out.data.0);)
            }
            Shape::Columns { points, bias: true, .. } => {
                let points = points.iter().map(concurrent_axes);
                quote! {
                    columns.fill(&[#(#points),*], &mut mass.data.0);
                    SVector::from(columns.bias)
                }
            }
            Shape::Tangent { segments, entries, .. } => {
                let segments = segments.iter().map(|numbers| numbers.map(integer)).map(|of| quote!([#(#of),*]));
                let entries = entries.iter().map(|numbers| numbers.map(integer)).map(|of| quote!([#(#of),*]));
                let (segments, entries) = (quote!(&[#(#segments),*]), quote!(&[#(#entries),*]));
                quote!(fill_tangent(#segments, #entries, (&factors, 0.0), out.data.0.as_flattened_mut());)
            }
            Shape::MassAndBias(_) => quote! {
                mass.data.0 = out.mass;
                SVector::from(out.bias)
            },
            Shape::Record(name, fields) => {
                let name = format_ident!("{name}");
                let names: Vec<_> = fields.iter().map(|(field, _)| format_ident!("{field}")).collect();
                quote! {
                    let [#(#names),*] = out.map(symmetric);
                    #name { #(#names),* }
                }
            }
            Shape::TransformFactors { degrees, vectors, .. } => {
                let degrees = degrees.iter().map(|n| integer(*n));
                let set = (!vectors.is_empty()).then(|| {
                    let vectors = vectors.iter().map(|first| integer(*first));
                    quote!(factors.vectors = [#(#vectors),*];)
                });
                quote!(#set factors.second_derivatives(&[#(#degrees),*], out);)
            }
            _ => quote!(out),
        }
    }

    /// The position of a slot in the storage.
    pub fn place(&self, slot: usize) -> Expr {
        slot_of(self.shape, slot, variable(self.storage_name()))
    }

    /// The position of slots in a loop.
    pub fn place_at(&self, slots: Progression) -> Expr {
        let out = variable(self.storage_name());
        let Progression { first, step } = slots;
        if let Shape::Structs(of, _) = self.shape {
            let slots = isize::try_from(of.len()).expect("a few");
            let which = at(Progression { first: first / of.len(), step: step / slots });
            return struct_slot(*of, place(out, &which), first % of.len());
        }
        if let Shape::Rows { n, .. } = self.shape {
            return place(element(out, first / n), &at(Progression { first: first % n, step }));
        }
        let Shape::Columns { n, .. } = self.shape else { return place(out, &at(slots)) };
        if let Some(first) = first.checked_sub(12 * n) {
            return place(field(out, "bias"), &at(Progression { first, step }));
        }
        let (kind, component) = (first / (3 * n), first % 3);
        let j = at(Progression { first: first % (3 * n) / 3, step: step / 3 });
        match kind {
            0 => element(place(field(out, "axes"), &j), component),
            3 => element(place(field(out, "offsets"), &j), component),
            _ => {
                let eight: Expr = parse_quote!(#out.eights[(#j) / 8]);
                let momenta = element(field(eight, if kind == 1 { "linear" } else { "angular" }), component);
                parse_quote!(#momenta[(#j) % 8])
            }
        }
    }

    /// The group of slots that a slot belongs to, for a comment before it.
    pub fn group(&self, slot: usize) -> usize {
        match self.shape {
            Shape::Scalar | Shape::Factors(_) | Shape::Tangent { .. } => 0,
            Shape::Vector(_) => slot,
            Shape::Base => row_of_triangle(6, slot).0,
            Shape::MassAndBias(n) if slot >= n * (n + 1) / 2 => slot,
            Shape::Columns { n, .. } if slot >= 12 * n => slot,
            Shape::Columns { n, .. } => slot / (3 * n),
            Shape::Symmetric(n) | Shape::MassAndBias(n) => row_of_triangle(*n, slot).0,
            Shape::Vectors(_) => slot / 3,
            Shape::Pairs(_) => slot / 2,
            Shape::Rows { n, .. } => slot / n,
            Shape::Structs(of, _) => slot / of.len(),
            Shape::Transforms { .. } => slot / 12,
            Shape::TransformFactors { rotations, degrees, .. } => {
                let axes = 3 * rotations.len();
                let matrices = degrees.iter().sum::<usize>();
                if slot < axes { 0 } else { (1 + (slot - axes) / 12).min(1 + matrices) }
            }
            Shape::Record(_, fields) => {
                let (index, rest) = field_of(fields, slot);
                let Shape::Symmetric(n) = fields[index].1 else { return index };
                index * n + row_of_triangle(n, rest).0
            }
        }
    }
}

/// `ConcurrentAxes { coordinates: 3, rotate: true }`
fn concurrent_axes(point: &ConcurrentAxes) -> TokenStream {
    let (coordinates, rotate) = (integer(point.coordinates), point.rotate);
    quote!(ConcurrentAxes { coordinates: #coordinates, rotate: #rotate })
}

/// The runtime's name of a type; the type has a constant `ZERO`.
pub fn struct_name(of: Struct) -> TokenStream {
    match of {
        Struct::Wrench => quote!(Wrench),
        Struct::SectionModuli => quote!(SectionModuli),
        Struct::Tension => quote!(Tension),
    }
}

/// A field of a type of the runtime.
fn struct_slot(of: Struct, value: Expr, slot: usize) -> Expr {
    match of {
        Struct::Wrench => field(field(value, ["force", "moment"][slot / 3]), ["x", "y", "z"][slot % 3]),
        Struct::SectionModuli => {
            let fields =
                ["area", "bending_y", "bending_z", "torsion", "shear_y", "shear_z", "corners", "allowable_stress"];
            field(value, fields[slot])
        }
        Struct::Tension => field(value, ["force", "stiffness", "damping"][slot]),
    }
}

/// Entry of a matrix in an array of matrices.
fn matrix_slot(matrices: Expr, slot: usize) -> Expr {
    let (row, column) = (slot % 12 / 4 + 1, slot % 4 + 1);
    field(element(matrices, slot / 12), &format!("m{row}{column}"))
}

/// `[item; n]`, a type or a value.
fn array(item: &TokenStream, n: usize) -> TokenStream {
    let n = integer(n);
    quote!([#item; #n])
}

fn slot_of(shape: &Shape, slot: usize, out: Expr) -> Expr {
    match shape {
        Shape::Scalar => out,
        Shape::Vector(_) | Shape::Factors(_) | Shape::Tangent { .. } => element(out, slot),
        Shape::Base => slot_of(&Shape::Symmetric(6), slot, out),
        Shape::MassAndBias(n) => {
            if let Some(row) = slot.checked_sub(n * (n + 1) / 2) {
                element(field(out, "bias"), row)
            } else {
                let (row, column) = row_of_triangle(*n, slot);
                element(element(field(out, "mass"), row), column)
            }
        }
        Shape::Columns { n, .. } => {
            let (kind, j, k) = (slot / (3 * n), slot % (3 * n) / 3, slot % 3);
            let eights = |of: &str| {
                let eight = element(field(out.clone(), "eights"), j / 8);
                element(element(field(eight, of), k), j % 8)
            };
            match kind {
                0 => element(element(field(out, "axes"), j), k),
                1 => eights("linear"),
                2 => eights("angular"),
                3 => element(element(field(out, "offsets"), j), k),
                _ => element(field(out, "bias"), slot - 12 * n),
            }
        }
        Shape::Symmetric(n) => {
            let (row, column) = row_of_triangle(*n, slot);
            element(element(out, row), column)
        }
        Shape::Vectors(_) => field(element(out, slot / 3), ["x", "y", "z"][slot % 3]),
        Shape::Pairs(_) => element(element(out, slot / 2), slot % 2),
        Shape::Rows { n, .. } => element(element(out, slot / n), slot % n),
        Shape::Structs(of, _) => struct_slot(*of, element(out, slot / of.len()), slot % of.len()),
        Shape::Transforms { .. } => matrix_slot(out, slot),
        Shape::TransformFactors { rotations, degrees, .. } => {
            let axes = 3 * rotations.len();
            let shares = axes + 12 * degrees.iter().sum::<usize>();
            if let Some(slot) = slot.checked_sub(shares) {
                let vector = element(field(out, "shares"), slot / 18);
                element(element(vector, slot % 18 / 3), slot % 3)
            } else if slot < axes {
                field(element(field(out, "axes"), slot / 3), ["x", "y", "z"][slot % 3])
            } else {
                matrix_slot(field(out, "first"), slot - axes)
            }
        }
        Shape::Record(_, fields) => {
            let (index, rest) = field_of(fields, slot);
            slot_of(&fields[index].1, rest, element(out, index))
        }
    }
}

/// Row and column of a slot of an upper triangle stored row by row.
pub fn row_of_triangle(n: usize, mut slot: usize) -> (usize, usize) {
    let mut row = 0;
    while slot >= n - row {
        slot -= n - row;
        row += 1;
    }
    (row, row + slot)
}

/// The field of a record that contains a slot, and the index of the slot within it.
pub fn field_of(fields: &[(&'static str, Shape)], mut slot: usize) -> (usize, usize) {
    let mut index = 0;
    while slot >= fields[index].1.len() {
        slot -= fields[index].1.len();
        index += 1;
    }
    (index, slot)
}
