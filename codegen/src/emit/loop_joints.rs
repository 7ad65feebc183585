//! The joints that close loops and exact couplings, as a constant.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Item, parse_quote};

use super::arithmetic::integer;
use super::description::{attachment_info, text};
use crate::chain::{Chain, CoordinateId, LoopEquation, LoopJoint, RigidCoupling};

/// `LOOP_JOINTS`; nothing without loops.
pub fn loop_joints(chain: &Chain) -> Option<Item> {
    let info = |name: &str, kind, ends: TokenStream, closed_by: &[CoordinateId], equations: Vec<LoopEquation>| {
        let (name, kind) = (text(name), text(kind));
        let [first, end] = Chain::range(closed_by).map(integer);
        let equations = equations.into_iter().map(|LoopEquation { direction, is_moment }| {
            let direction = text(direction);
            quote!(LoopEquationInfo { direction: #direction, is_moment: #is_moment })
        });
        quote!(LoopJointInfo {
            name: #name,
            kind: #kind,
            ends: #ends,
            spanned: [#first, #end],
            equations: List::Static(&[#(#equations),*]),
        })
    };
    let joint = |joint: &LoopJoint| {
        let ends = joint.ends.iter().map(attachment_info);
        let ends = quote!(Some([#(#ends),*]));
        info(&joint.name, joint.kind.name(), ends, &chain.closed_by(joint), joint.kind.equations())
    };
    let coupling = |coupling: &RigidCoupling| {
        let RigidCoupling { name, follower, .. } = coupling;
        info(name, RigidCoupling::KIND, quote!(None), &follower.coordinates(), vec![coupling.equation()])
    };
    let joints: Vec<_> =
        chain.loop_joints.iter().map(joint).chain(chain.rigid_couplings.iter().map(coupling)).collect();
    let count = integer(joints.len());
    chain.has_loops().then(|| {
        parse_quote! {
            #[doc = " The joints that close loops, and exact couplings."]
            pub const LOOP_JOINTS: [LoopJointInfo; #count] = [#(#joints),*];
        }
    })
}
