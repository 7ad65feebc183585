"""Whole runs of the same crane: which error each library makes with each method and step, and how long it takes on one core.

The crane is let go at its guess, with its load pulled aside, while its drives hold. Errors are relative to a library's own run with its shortest
steps, so that small differences between models do not count: the largest of a coordinate at any result, over the largest change of a
coordinate.
"""

import subprocess
import time
from dataclasses import asdict, dataclass

import exudyn as exu
import mujoco
import numpy as np

from exudyn_peer import Exudyn
from mujoco_peer import with_springs

# Time of a run: the shortest of so many; ours take a millisecond, and Exudyn's, of seconds, are timed once.
REPEAT, REPEAT_OURS = 3, 30
# Steps per interval of results; of explicit methods, from the largest that is stable.
STEPS = [5, 10, 20, 50, 100, 200, 400, 800]
STEPS_QUICK = [10, 400]
# Nothing is gained by shorter ones, and each of Exudyn's takes 0.15 ms.
STEPS_EXUDYN = [5, 10, 20, 50, 100, 200, 400]
TOLERANCES = [10.0**-k for k in (1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7)]
TOLERANCES_QUICK = [1e-2, 1e-4]
MUJOCO = {
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
}
EXUDYN = {"RK44": exu.DynamicSolverType.RK44, "generalized alpha": exu.DynamicSolverType.GeneralizedAlpha}


@dataclass
class RunTime:
    """A run: `accuracy` is the number of steps per interval of results, or the tolerance; `seconds` of `duration`."""

    library: str
    method: str
    accuracy: float
    seconds: float
    error: float
    duration: float


def measure(arena, libraries, quick):
    """All runs of the crane of an arena whose results are finite."""
    plan = np.frombuffer(arena.ask("plan", arena.coordinates))
    duration, interval, start = plan[0], plan[1], plan[2:]
    found = list(errors(ours(arena, quick), start, duration))
    steps = STEPS_QUICK if quick else STEPS
    if "mujoco" in libraries:
        found += errors(by_mujoco(arena, start, duration, interval, steps), start, duration)
    if "exudyn" in libraries:
        steps = steps if quick else STEPS_EXUDYN
        found += errors(by_exudyn(arena, start, duration, interval, steps), start, duration)
    return [asdict(run) for run in found]


def errors(runs, start, duration):
    """Runs with their errors: those of a library against its last, which is the most accurate."""
    runs = list(runs)
    reference = runs[-1][-1]
    change = np.abs(reference - start).max()
    for library, method, accuracy, seconds, poses in runs[:-1]:
        error = np.abs(poses - reference).max() / change
        if np.isfinite(error):
            yield RunTime(library, method, accuracy, seconds, float(error), duration)


def ours(arena, quick):
    """Generated Rust by the methods for stiff and for soft motions."""
    tolerances = TOLERANCES_QUICK if quick else TOLERANCES
    for method, accuracies in {"bdf": tolerances, "rosw4": tolerances, "rk4": [1e-4], "dopri5": [1e-11]}.items():
        for accuracy in accuracies:
            command = [arena.bench, "run", str(arena.coordinates), method, str(accuracy), str(REPEAT_OURS)]
            result = subprocess.run(command, capture_output=True, check=False)
            if result.returncode == 0:
                seconds, *poses = np.frombuffer(result.stdout)
                yield "ours", method, accuracy, seconds, np.reshape(poses, (-1, arena.coordinates))


def by_mujoco(arena, start, duration, interval, steps):
    """MuJoCo's methods, each with all steps; the last is the reference."""
    for method in reversed(MUJOCO):
        for count in [*steps, *([2 * steps[-1]] if method == "RK4" else [])]:
            spec = with_springs(arena.chain, arena.springs, interval / count)
            spec.option.integrator = MUJOCO[method]
            model = spec.compile()
            seconds, poses = np.inf, None
            for _ in range(REPEAT):
                data = mujoco.MjData(model)
                data.qpos = start
                poses, begun = [start], time.perf_counter()
                for _ in range(round(duration / interval)):
                    mujoco.mj_step(model, data, nstep=count)
                    poses.append(data.qpos.copy())
                seconds = min(seconds, time.perf_counter() - begun)
            yield "MuJoCo", method, count, seconds, np.array(poses)


def by_exudyn(arena, start, duration, interval, steps):
    """Exudyn's explicit and implicit methods; the last is the reference."""
    for method in reversed(EXUDYN):
        for count in [*steps, *([2 * steps[-1]] if method == "RK44" else [])]:
            system = Exudyn(arena.chain, arena.springs, interval / count)
            state, poses, seconds = (start, np.zeros(len(start))), [start], 0.0
            try:
                for _ in range(round(duration / interval)):
                    q, v, taken = system.run(*state, count, EXUDYN[method])
                    state, seconds = (q, v), seconds + taken
                    poses.append(q)
            except (RuntimeError, ValueError):
                poses.append(np.full(len(start), np.nan))
            missing = round(duration / interval) + 1 - len(poses)
            poses += missing * [np.full(len(start), np.nan)]
            yield "Exudyn", method, count, seconds, np.array(poses)
