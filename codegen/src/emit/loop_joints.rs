//! The joints that close loops, as a constant.

use quote::quote;
use syn::{Item, parse_quote};

use super::arithmetic::integer;
use super::description::{attachment_info, text};
use crate::chain::{Chain, LoopEquation, LoopJoint};

/// `LOOP_JOINTS`; nothing without loops.
pub fn loop_joints(chain: &Chain) -> Option<Item> {
    let joint = |joint: &LoopJoint| {
        let (name, kind) = (text(&joint.name), text(joint.kind.name()));
        let ends = joint.ends.iter().map(attachment_info);
        let [first, end] = Chain::range(&chain.closed_by(joint)).map(integer);
        let equations = joint.kind.equations().into_iter().map(|LoopEquation { direction, is_moment }| {
            let direction = text(direction);
            quote!(LoopEquationInfo { direction: #direction, is_moment: #is_moment })
        });
        quote!(LoopJointInfo {
            name: #name,
            kind: #kind,
            ends: [#(#ends),*],
            spanned: [#first, #end],
            equations: List::Static(&[#(#equations),*]),
        })
    };
    let joints = chain.loop_joints.iter().map(joint);
    let count = integer(chain.loop_joints.len());
    (!chain.loop_joints.is_empty()).then(|| {
        parse_quote! {
            #[doc = " The joints that close loops."]
            pub const LOOP_JOINTS: [LoopJointInfo; #count] = [#(#joints),*];
        }
    })
}
