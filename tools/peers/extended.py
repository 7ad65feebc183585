"""CasADi functions in 80-bit numbers: the reference for double precision."""

import casadi as ca
import numpy as np

UNARY = {
    ca.OP_ASSIGN: lambda a: a,
    ca.OP_NEG: np.negative,
    ca.OP_SQ: np.square,
    ca.OP_TWICE: lambda a: a + a,
    ca.OP_INV: np.reciprocal,
    ca.OP_SIN: np.sin,
    ca.OP_COS: np.cos,
}
BINARY = {ca.OP_ADD: np.add, ca.OP_SUB: np.subtract, ca.OP_MUL: np.multiply, ca.OP_DIV: np.divide}


def evaluate(function, *arguments):
    """Results of an SX function at many states: arguments and results with one row per state, results column by column."""
    arguments = [np.asarray(argument, dtype=np.longdouble) for argument in arguments]
    states = len(arguments[0])
    results = [np.zeros((states, function.numel_out(k)), dtype=np.longdouble) for k in range(function.n_out())]
    work = [None] * function.sz_w()
    for k in range(function.n_instructions()):
        operation, inputs, outputs = (
            function.instruction_id(k),
            function.instruction_input(k),
            function.instruction_output(k),
        )
        if operation == ca.OP_CONST:
            work[outputs[0]] = np.full(states, function.instruction_constant(k), dtype=np.longdouble)
        elif operation == ca.OP_INPUT:
            work[outputs[0]] = arguments[inputs[0]][:, inputs[1]]
        elif operation == ca.OP_OUTPUT:
            results[outputs[0]][:, outputs[1]] = work[inputs[0]]
        elif operation in UNARY:
            work[outputs[0]] = UNARY[operation](work[inputs[0]])
        else:
            work[outputs[0]] = BINARY[operation](work[inputs[0]], work[inputs[1]])
    return results
