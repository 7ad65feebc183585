"""Imports all robots below some folders, and compares those that are accepted with Pinocchio (URDF) or MuJoCo (MJCF).

    python public_robots.py --crane target/release/crane --evaluate target/release/evaluate FOLDER... [--states 5] [--seed 1]

Files that the library cannot load, or in which nothing moves, are passed over, and so are copies. A, e and, of MJCF, forces without friction
are compared to 1e-9 of the largest entry. Prints each robot that is refused or differs, and a summary.
Exit code 0 if none differs.
"""

import argparse
import hashlib
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin

from agree import computed
from comparison import compare
from evaluate import Evaluate
from exchange import Urdf
from mujoco_peer import DISABLED, LoadedFile
from states import States

TOLERANCE = 1e-9
ROUNDING = 1e-12


def main():
    """Imports and compares; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", metavar="FOLDER", nargs="+", type=Path, help="folders with robots, at any depth")
    parser.add_argument("--crane", metavar="PROGRAM", required=True, help="the built program `crane`")
    parser.add_argument("--evaluate", metavar="PROGRAM", required=True, help="the built program `evaluate`")
    parser.add_argument("--states", type=int, default=5, help="random states a robot")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random states")
    options = parser.parse_args()
    evaluate = Evaluate(options.evaluate)
    verdicts = {".urdf": Counter(), ".xml": Counter()}
    seen = set()
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / "robot.yaml"
        for path in sorted(path for folder in options.folders for path in folder.rglob("*") if path.suffix in verdicts):
            content = hashlib.sha256(path.read_bytes()).digest()
            library = loaded(path)
            if content in seen or library is None:
                continue
            seen.add(content)
            verdict, reason = judged(path, library, spec, evaluate, options)
            verdicts[path.suffix][verdict] += 1
            if reason:
                print(f"{verdict}: {path.name}: {reason}", flush=True)
    for suffix, counts in verdicts.items():
        print(f"{suffix[1:]}: {sum(counts.values())} robots; {', '.join(f'{count} {verdict}' for verdict, count in counts.items())}")
    return 1 if any(counts["different"] for counts in verdicts.values()) else 0


def loaded(path):
    """A robot in its library; `None` if it cannot be loaded or nothing in it moves."""
    try:
        library = Urdf(path, [0, 0, -9.81]) if path.suffix == ".urdf" else LoadedFile(path, DISABLED)
    except (ValueError, RuntimeError, mujoco.FatalError):
        return None
    return library if library.model.nv > 0 else None


def judged(path, library, spec, evaluate, options):
    """What became of a robot, and why if it is not right."""
    imported = subprocess.run([options.crane, "import", path, "-o", spec, "--force"], check=False, capture_output=True, text=True)
    if imported.returncode != 0:
        mistakes = re.findall(r"error(?:\[\w+\])?: (.*)", imported.stderr)
        return "refused", mistakes[0] if mistakes else imported.stderr.strip()
    layout = evaluate.layout(str(spec))
    size = library.model.nv
    if len(layout["coordinates"]) != size:
        return "different", f"{len(layout['coordinates'])} coordinates instead of {size}"
    rng = np.random.default_rng(options.seed)
    q, v = rng.uniform(-1.2, 1.2, (options.states, size)), rng.uniform(-2, 2, (options.states, size))
    states = States(np.zeros(options.states), q, v, np.empty((options.states, 0)))
    if path.suffix == ".urdf":
        if any(joint.nv > 1 for joint in library.model.joints):
            return "imported, not compared", None
        library = Urdf(path, [0, 0, -9.81], (), (spec, layout["coordinates"]))
    else:
        library.model.opt.density = library.model.opt.viscosity = 0
        library.model.body_gravcomp[:] = 0
    ours = evaluate.values(layout, states)
    theirs = computed(library, states, np.zeros_like(q))
    pairs = {name: (theirs[name], ours[name]) for name in ("mass_matrix", "bias")}
    text = spec.read_text(encoding="utf-8")
    if path.suffix == ".xml" and not any(word in text for word in ("coulomb:", "rigid: true, motion", "Left out of tendon")):
        forces = np.array([library.passive(*state) for state in zip(q, v)])
        pairs["forces"] = forces, ours["forces"]
    # Weights of a robot that needs none to hold it vanish up to the rounding of its inertia times gravity.
    floor = ROUNDING * 9.81 * np.abs(theirs["mass_matrix"]).max()
    failed = []
    for name, (expected, found) in pairs.items():
        error = compare(name, expected, found, states.groups, TOLERANCE).by_state
        if error > TOLERANCE and np.abs(expected - found).max() > floor:
            failed.append(f"{name} by {error:.1e} of its largest entry")
    return ("different", ", ".join(failed)) if failed else ("right", None)


if __name__ == "__main__":
    sys.exit(main())
