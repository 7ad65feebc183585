//! Selects the products that are fused into the sums that use them, `a b + c` with one rounding if the target supports it.

use super::Constants;
use crate::program::Program;
use crate::symbolic::{ExprId, Op};

/// A product in more sums than this is computed once, because its factors would stay alive too long.
const MOST_SUMS: usize = 4;

/// For every sum or difference of `roots`, the product among its operands that is fused into it.
///
/// A product is fused into all sums that use it, or into none, so that it needs no separate operation. Products used by one
/// sum come first; if a sum could fuse either of its two operands, it fuses the one constructed later, whose factors are
/// known later.
#[must_use]
pub fn fuse(program: &Program, constants: &Constants, roots: &[ExprId]) -> Vec<Option<ExprId>> {
    let needed = program.needed(roots.iter().copied());
    let computed = |id: ExprId| needed[id.index()] && !constants.is_free(program, id);
    let mut users: Vec<Vec<ExprId>> = vec![vec![]; program.operations.len()];
    for id in program.ids().filter(|id| computed(*id)) {
        for operand in program.op(id).operands() {
            users[operand.index()].push(id);
        }
    }
    let is_output = {
        let mut is_output = vec![false; program.operations.len()];
        for root in roots {
            is_output[root.index()] = true;
        }
        is_output
    };
    let mut fused = vec![None; program.operations.len()];
    for sums in 1..=MOST_SUMS {
        let products = program.ids().rev().filter(|id| {
            computed(*id)
                && matches!(program.op(*id), Op::Mul(..))
                && users[id.index()].len() == sums
                && !is_output[id.index()]
        });
        for product in products {
            let free = |user: &ExprId| match program.op(*user) {
                Op::Add(a, b) | Op::Sub(a, b) => a != b && fused[user.index()].is_none(),
                _ => false,
            };
            if users[product.index()].iter().all(free) {
                for user in &users[product.index()] {
                    fused[user.index()] = Some(product);
                }
            }
        }
    }
    fused
}
