//! Values that are used once and have no name are inlined into the expression that uses them.

use super::Constants;
use crate::program::Program;
use crate::symbolic::ExprId;

/// Maximum number of operations in a statement: about one line of text.
const LARGEST_EXPRESSION: usize = 7;

/// For every node, whether it is inlined into the expressions that use it: more than one only for a fused product.
pub(super) fn bundle(
    program: &Program,
    constants: &Constants,
    fused: &[Option<ExprId>],
    roots: &[ExprId],
) -> Vec<bool> {
    let needed = program.needed(roots.iter().copied());
    let mut uses = vec![0usize; program.operations.len()];
    for root in roots {
        uses[root.index()] += 1;
    }
    for id in program.ids().filter(|id| needed[id.index()] && !constants.is_stored(*id)) {
        for operand in program.op(id).operands() {
            uses[operand.index()] += 1;
        }
    }
    let mut inlined = vec![false; program.operations.len()];
    let mut shared = vec![false; program.operations.len()];
    for product in fused.iter().flatten() {
        shared[product.index()] = uses[product.index()] > 1;
    }
    let mut size = vec![0usize; program.operations.len()];
    for id in program.ids().filter(|id| needed[id.index()] && !constants.is_free(program, *id)) {
        let op = program.op(id);
        if op.is_leaf() {
            continue;
        }
        // Only products of two variables are written more than once.
        let operands = op.operands().filter(|_| !shared[id.index()]);
        let mut candidates: Vec<ExprId> =
            operands.filter(|operand| may_be_inlined(program, constants, *operand, uses[operand.index()])).collect();
        // Smaller operands first: the larger one gets a variable if both do not fit.
        candidates.sort_by_key(|operand| size[operand.index()]);
        let mut total = 1;
        if let Some(product) = fused[id.index()] {
            total = size[product.index()];
            inlined[product.index()] = true;
            candidates.retain(|operand| *operand != product);
        }
        for operand in candidates {
            if total + size[operand.index()] <= LARGEST_EXPRESSION {
                total += size[operand.index()];
                inlined[operand.index()] = true;
            }
        }
        size[id.index()] = total;
    }
    // A result that nothing else reads is computed where it is stored.
    for root in roots {
        inlined[root.index()] |= may_be_inlined(program, constants, *root, uses[root.index()]);
    }
    inlined
}

fn may_be_inlined(program: &Program, constants: &Constants, id: ExprId, uses: usize) -> bool {
    let op = program.op(id);
    uses == 1 && !op.is_leaf() && !op.is_elementary() && !program.names.contains_key(&id) && !constants.is_stored(id)
}
