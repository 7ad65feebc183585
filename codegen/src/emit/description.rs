//! Constants that describe the crane.

use std::fmt::Debug;

use quote::quote;
use syn::{Expr, Item, Member, parse_quote};

use super::arithmetic::integer;
use super::print::constant;
use crate::chain::Chain;

/// The sizes and the `DESCRIPTION`.
pub fn description(chain: &Chain) -> Vec<Item> {
    let n = integer(chain.coordinates.len());
    let mut description = expression(&chain.description());
    if let Expr::Struct(fields) = &mut description
        && let Some(list) = fields.fields.iter_mut().find(|field| is_named(&field.member, "parameters"))
        && !chain.parameters.is_empty()
    {
        list.expr = parse_quote!(List::Static(&PARAMETERS));
    }
    vec![
        constant("Number of generalized coordinates.", "N", &quote!(usize), &quote!(#n)),
        constant("Names, units and settings.", "DESCRIPTION", &quote!(Description), &quote!(#description)),
    ]
}

/// `LOOP_JOINTS`; nothing without loops.
pub fn loop_joints(chain: &Chain) -> Option<Item> {
    let (joints, about) = (chain.loop_joint_infos(), "The joints that close loops, and exact couplings.");
    let (count, list) = (integer(joints.len()), expression(&joints));
    chain.has_loops().then(|| constant(about, "LOOP_JOINTS", &quote!([LoopJointInfo; #count]), &quote!(#list)))
}

/// A part of a description as a constant: its form `{:#?}`.
pub fn expression(part: &(impl Debug + ?Sized)) -> Expr {
    syn::parse_str(&format!("{part:#?}")).expect("an expression")
}

fn is_named(member: &Member, name: &str) -> bool {
    matches!(member, Member::Named(field) if field == name)
}
