"""Compares A, e, q̈ and joint wrenches of the generated Rust functions with what Pinocchio and MuJoCo compute from the same YAML file.

    python agree.py --evaluate target/release/evaluate [--crane NAME]... [--states 100] [--seed 1]
    python agree.py --self-test [SPEC.yaml]...

Exit code 0 if every quantity of every crane agrees, 1 if one does not.
"""

import sys
import time
import zlib

import casadi as ca
import numpy as np

from chain import TOOLS, read_chain
from command_line import parser, run
from comparison import HEADER, TOLERANCE, compare
from crane_model import read_crane
from evaluate import Evaluate
from mujoco_peer import MuJoCo
from pinocchio_peer import Pinocchio
from sabotage import perturb
from states import random_states

# A solve with the dense A loses cond(A) ε: 2e6 · 2e-16 for the shipped cranes. Their own recursion, and ours, do not.
TOLERANCES = {"mass_matrix": TOLERANCE, "bias": TOLERANCE, "forward_dynamics": 1e-9}
# Poses of frames and wrenches are propagated along the chain in a different way.
TOLERANCE_OF_WRENCHES = 1e-9
# The error introduced by the self-test: a hundred times the largest tolerance.
PERTURBATION = 1e-7


def main():
    """Runs the comparison or the self-test and returns the exit code."""
    return run(parser(__doc__), agree, self_test)


def agree(options):
    """Compares all cranes and prints a table for each."""
    evaluate = Evaluate(options.evaluate)
    names = options.crane or evaluate.names()
    failed = [name for name in names if not agree_on(name, evaluate, options)]
    print(f"{len(names) - len(failed)} of {len(names)} cranes agree")
    if failed:
        print(f"FAILED: {', '.join(failed)}")
    return 1 if failed or not names else 0


def agree_on(name, evaluate, options):
    """Compares one crane with each library; returns whether all quantities agree."""
    started = time.perf_counter()
    layout = evaluate.layout(name)
    crane = read_crane(TOOLS.parent / layout["spec"])
    if crane.has_rotation_vectors:
        print(f"{name}: not compared, hinges cannot be symmetric section joints; CasADi derives it")
        return True
    states = seeded_states(crane, options)
    generated = evaluate.values(layout, states)
    if "forward_dynamics" not in generated:
        generated["forward_dynamics"] = dense_solution(generated)
    comparisons = {
        library: compare_all(computed(library(read_chain(crane)), states, generated["forces"]), generated, states)
        for library in (Pinocchio, MuJoCo)
    }
    comparisons[Pinocchio] += compare_wrenches(crane, generated, states)
    seconds = time.perf_counter() - started
    print(f"{name}: {len(crane.coordinates)} coordinates, {len(states.time)} states, {seconds:.2f} s\n{HEADER}")
    for library, quantities in comparisons.items():
        for comparison in quantities:
            comparison.quantity += f", {library.name}"
            print(comparison.row(), flush=True)
    return all(comparison.passed for quantities in comparisons.values() for comparison in quantities)


def seeded_states(crane, options):
    """The states of a crane, which do not depend on what else is compared; parameters at their defaults, as the chain has them."""
    states = random_states(crane, options.states, [options.seed, zlib.crc32(crane.name.encode())])
    states.parameters[:] = list(crane.spec.defaults.values())
    return states


def computed(library, states, forces):
    """A, e and q̈ of a library at all states: name -> array with one row per state."""
    rows = [library.evaluate(*state) for state in zip(states.q, states.v, forces)]
    return {name: np.array([row[i].ravel() for row in rows]) for i, name in enumerate(TOLERANCES)}


def dense_solution(values):
    """q̈ = A⁻¹(e + f)."""
    right = values["bias"] + values["forces"]
    mass_matrices = values["mass_matrix"].reshape(*right.shape, right.shape[1])
    return np.linalg.solve(mass_matrices, right[..., None])[..., 0]


def compare_all(expected, generated, states):
    """One comparison per quantity."""
    return [
        compare(name, expected[name], generated[name], states.groups, tolerance)
        for name, tolerance in TOLERANCES.items()
    ]


def last_moved(body):
    """The last coordinate that moves a body, -1 without one."""
    return max(body.moved_by, default=-1)


def compare_wrenches(crane, generated, states):
    """Compares the wrenches in joints and sections, with the rates as accelerations, with Pinocchio's recursion."""
    first_moved = {}
    for place, body in enumerate(crane.bodies):
        first_moved.setdefault(last_moved(body), place)
    cuts = [
        (place, cut.frame, last_moved(crane.bodies[cut.body]))
        for place, cut in enumerate(crane.cuts)
        # The joint before a cut carries what is beyond the cut, and nothing else.
        if place > 0 and cut.portion is None and first_moved[last_moved(crane.bodies[cut.body])] == cut.body
    ]
    cuts = [cut for cut in cuts if cut[2] >= 0]
    # The joint wrenches of a chain do not include loads and connectors.
    if not cuts or crane.loads or crane.connectors:
        return []
    poses = ca.Function("poses", [crane.q, crane.parameters], [frame for _, frame, _ in cuts])
    library = Pinocchio(read_chain(crane))
    rows = []
    for q, v, parameters in zip(states.q, states.v, states.parameters):
        frames = [pose.full() for pose in poses.call([q, parameters])]
        rows.append(library.transmitted(q, v, v, list(zip((joint for *_, joint in cuts), frames))).ravel())
    ours = generated["internal_forces"].reshape(len(rows), len(crane.cuts), 6)[:, [place for place, *_ in cuts]]
    quantity = "internal_forces"
    return [compare(quantity, np.array(rows), ours.reshape(len(rows), -1), states.groups, TOLERANCE_OF_WRENCHES)]


def self_test(options):
    """Checks that both libraries agree, and that an error of 1e-7 in any quantity is detected."""
    failed = False
    for path in options.self_test or sorted(TOOLS.parent.glob("specs/*.yaml")):
        crane = read_crane(path)
        states = seeded_states(crane, options)
        chain, rng = read_chain(crane), np.random.default_rng(options.seed)
        forces = rng.uniform(-1, 1, states.q.shape)
        ours, theirs = (computed(library(chain), states, forces) for library in (Pinocchio, MuJoCo))
        comparisons = compare_all(ours, theirs, states)
        wrong = {name: perturb(name, values, rng, PERTURBATION) for name, values in theirs.items()}
        missed = [comparison.quantity for comparison in compare_all(ours, wrong, states) if comparison.passed]
        failed |= bool(missed) or not all(comparison.passed for comparison in comparisons)
        print(f"{crane.name}: {len(crane.coordinates)} coordinates, Pinocchio against MuJoCo\n{HEADER}")
        print("\n".join(comparison.row() for comparison in comparisons))
        print(f"  errors put into every quantity: {'NOT NOTICED in ' + ', '.join(missed) if missed else 'all noticed'}")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
