"""Robots in MJCF as the compiler imports them, compared with MuJoCo on the same files."""

import mujoco
import numpy as np

from agree import compare_all, computed, dense_solution
from comparison import compare
from mujoco_peer import DISABLED, FLAGS, LoadedFile
from random_mjcf import RandomRobot
from states import States

# Random robots, by seed.
ROBOTS = range(40)


def random_robots_agree(evaluate, folder, options, import_to, told):
    """How many random robots agree, and how many there are."""
    agreed = 0
    for seed in ROBOTS:
        path = folder / f"random_{seed}.xml"
        path.write_text(RandomRobot(seed).document(), encoding="utf-8")
        spec = folder / f"random_{seed}.yaml"
        import_to(path, spec)
        agreed += told(path.name, compare_import(path, spec, evaluate, options))
    return agreed, len(ROBOTS)


def compare_import(path, spec, evaluate, options):
    """Compares A, e, forces and q̈ of a spec imported from an MJCF file with those of that file."""
    layout, library = evaluate.layout(str(spec)), LoadedFile(path, DISABLED)
    rng, shape = np.random.default_rng(options.seed), (options.states, library.model.nv)
    q, v = rng.uniform(-np.pi, np.pi, shape), rng.uniform(-2, 2, shape)
    # Angles of joints that turn freely, away from theta = ±90°, where their rates are not determined.
    for first, _ in library.turning:
        q[:, first : first + 3] *= 0.4
    states = States(np.zeros(options.states), q, v, np.empty((options.states, 0)))
    ours = evaluate.values(layout, states)
    if "forward_dynamics" not in ours:
        ours["forward_dynamics"] = dense_solution(ours)
    theirs = computed(library, states, np.zeros(shape))
    forces = np.array([library.passive(*state) for state in zip(q, v)])
    comparisons = [*compare_all(theirs, ours, states), compare("forces", forces, ours["forces"], states.groups)]
    if library.model.neq:
        comparisons += compare_equalities(path, ours, states)
    return comparisons


def compare_equalities(path, ours, states):
    """Compares gaps and rows of equalities of hinges and slides, which yield in MuJoCo, with those of rigid couplings."""
    library = LoadedFile(path, int(DISABLED) & ~int(FLAGS.mjDSBL_CONSTRAINT | FLAGS.mjDSBL_EQUALITY))
    library.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    gaps, rows = [], []
    for q, v in zip(states.q, states.v):
        library.move_to(q, v)
        mujoco.mj_forward(library.model, library.data)
        gaps.append(library.data.efc_pos.copy())
        rows.append(library.data.efc_J.copy().ravel())
    pairs = {"gaps": (np.array(gaps), ours["loop_states"][:, ::3]), "rows of gaps": (np.array(rows), ours["loop_jacobians"])}
    return [compare(name, theirs, found, states.groups) for name, (theirs, found) in pairs.items()]
