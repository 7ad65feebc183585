"""Loads exported cranes in Pinocchio and MuJoCo, and imported robots in the compiler, and compares A, e and q̈.

    python exchange.py --crane target/release/crane --evaluate target/release/evaluate [--states 20] [--seed 1]

Every compiled crane without symmetric section joints is exported as URDF, which Pinocchio reads, with its springs from a separate file,
and as MJCF, which MuJoCo reads, springs included; both files are imported again. Robots of example-robot-data are imported from URDF
and evaluated by the compiler's interpreter, compared with Pinocchio on the same file, and random robots from MJCF, compared with MuJoCo.
Exit code 0 if all agrees, 1 if something does not.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from importlib.metadata import files
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
from ruamel.yaml import YAML

from agree import compare_all, computed, dense_solution, seeded_states
from chain import TOOLS
from comparison import HEADER, compare
from crane_model import read_crane
from evaluate import Evaluate
from mjcf_import import random_robots_agree
from mujoco_peer import FLAGS, LoadedFile
from pinocchio_peer import Pinocchio
from states import States

# For numbers written as text and read back: the last digits of angles.
TOLERANCE = 1e-9
# Robots of example-robot-data, and their joints that are held at zero: serial arms, then those with branches. Not all others can be: some
# files have bodies that are impossible, such as the finger tips of allegro_right_hand.urdf, or no mass.
ROBOTS = {
    "panda.urdf": ["panda_finger_joint1", "panda_finger_joint2"],
    "ur5_robot.urdf": [],
    "ur10_robot.urdf": [],
    "xarm7.urdf": [],
    "z1.urdf": [],
    "kinova.urdf": [],
    "bravo7_no_ee.urdf": [],
    "ur3_robot.urdf": [],
    # Arm with a hand of two fingers, quadrupeds, two arms, humanoids, the last with hands.
    "panda.urdf with fingers": [],
    "solo12.urdf": [],
    "a1.urdf": [],
    "baxter.urdf": [],
    "simple_humanoid.urdf": [],
    "talos_reduced.urdf": [],
    "alex_sake_hands.urdf": [],
}


class Urdf(Pinocchio):
    """A URDF file in Pinocchio; joints in `fixed` are held at 0. `imported`: the spec made of it and its coordinates, in the order of q."""

    def __init__(self, path, gravity, fixed=(), imported=None):
        self.model = pin.buildModelFromUrdf(str(path))
        if fixed:
            locked = [self.model.getJointId(name) for name in fixed]
            self.model = pin.buildReducedModel(self.model, locked, pin.neutral(self.model))
        self.model.gravity.linear = np.array(gravity)
        self.data = self.model.createData()
        self.order = np.arange(self.model.nv) if imported is None else self.order_of(*imported)
        self.back = np.argsort(self.order)

    def order_of(self, spec, coordinates):
        """Which coordinate of the spec each joint is: Pinocchio visits branches by name, the import as they are in the file."""
        of = {joint["name"]: joint.get("coordinate") for joint in YAML(typ="safe").load(spec)["joints"]}
        return np.array([coordinates.index(of[joint]) for joint in list(self.model.names)[1:]])

    def configuration(self, angles):
        """To Pinocchio, a continuous joint is a point on a circle."""
        return pin.integrate(self.model, pin.neutral(self.model), angles)


class Springs:
    """The springs file of a URDF file."""

    def __init__(self, path, names):
        content = YAML(typ="safe").load(path)
        self.gravity, self.supports = content["gravity"], content.get("supports") or []
        joints = content["joints"] or {}
        keys = ("stiffness", "damping", "rest", "effort")
        self.stiffness, self.damping, self.rest, self.effort = (
            np.array([joints.get(name, {}).get(key, 0) for name in names], float) for key in keys
        )
        self.prescribed = [names.index(name) for name in content.get("prescribed") or {}]
        self.armature = np.array([(content.get("armature") or {}).get(name, 0) for name in names], float)
        letters = ("x", "y", "z", "psi", "theta", "phi")
        base = names[0].rpartition("_")[0]
        self.base = [(i, letters.index(n.rpartition("_")[2])) for i, n in enumerate(names) if n.rpartition("_")[0] == base]

    def force(self, q, v):
        """Generalized forces, as the comments in the file describe."""
        force = self.stiffness * (self.rest - q) - self.damping * v + self.effort
        for support in self.supports:
            x, y, z = support["at"]
            rows = np.array([[1, 0, 0, -y, z, 0], [0, 1, 0, x, 0, -z], [0, 0, 1, 0, -x, y]], float)
            jacobian = np.zeros((3, q.size))
            for index, place in self.base:
                jacobian[:, index] = rows[:, place]
            stretch = jacobian @ q - support["free_play"]
            force -= jacobian.T @ (np.array(support["stiffness"]) * stretch)
            force -= jacobian.T @ (np.array(support["damping"]) * (jacobian @ v))
        return force


def main():
    """Runs both comparisons and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crane", metavar="PROGRAM", required=True, help="the built program `crane`")
    parser.add_argument("--evaluate", metavar="PROGRAM", required=True, help="the built program `evaluate`")
    parser.add_argument("--states", type=int, default=20, help="random states a crane, half near the guess, half far")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random states")
    options = parser.parse_args()
    evaluate = Evaluate(options.evaluate)
    print(HEADER)
    with tempfile.TemporaryDirectory() as folder:
        # A symmetric section joint is exported as three hinges, which differs at second order.
        exact = [
            name
            for name in evaluate.names()
            if not read_crane(TOOLS.parent / evaluate.layout(name)["spec"]).has_rotation_vectors
        ]
        cranes = [Exported(name, evaluate, Path(folder), options).agrees() for name in exact]
        robots = [robot_agrees(name, fixed, evaluate, Path(folder), options) for name, fixed in ROBOTS.items()]
        converted = lambda path, spec: crane(options, "import", path, "-o", spec)
        closed = rests_in_mujoco(options, Path(folder))
        agreed, random = random_robots_agree(evaluate, Path(folder), options, converted, told)
    print(f"{sum(cranes)} of {len(cranes)} cranes agree as exported, {sum(robots)} of {len(robots)} robots as imported from URDF")
    print(f"{agreed} of {random} random robots agree as imported from MJCF")
    return 0 if all(cranes + robots) and cranes and closed and agreed == random else 1


class Exported:
    """A compiled crane, and its exported files in a folder."""

    def __init__(self, name, evaluate, folder, options):
        self.name, self.evaluate, self.folder, self.options = name, evaluate, folder, options
        self.layout = evaluate.layout(name)
        self.spec = TOOLS.parent / self.layout["spec"]
        self.states = seeded_states(read_crane(self.spec), options)
        self.states.time[:] = 0
        self.ours = evaluate.values(self.layout, self.states)
        if "forward_dynamics" not in self.ours:
            self.ours["forward_dynamics"] = dense_solution(self.ours)

    def agrees(self):
        """Exports to both formats, imports again, and compares everything."""
        urdf, mjcf = (self.folder / f"{self.name}.{suffix}" for suffix in ("urdf", "xml"))
        crane(self.options, "export", self.spec, "--format", "urdf", "-o", urdf)
        springs = Springs(urdf.with_suffix(".springs.yaml"), self.layout["coordinates"])
        library = Urdf(urdf, springs.gravity)
        library.model.armature = springs.armature
        library.data = library.model.createData()
        if list(library.model.names)[1:] != self.layout["coordinates"]:
            print(f"{self.name}: joints are {list(library.model.names)[1:]}")
            return False
        forces = np.array([springs.force(q, v) for q, v in zip(self.states.q, self.states.v)])
        efforts = np.zeros_like(forces)
        efforts[:, springs.prescribed] = self.ours["forces"][:, springs.prescribed]
        expressible = all(s["kinematics"] == "linear" and not s.get("one_sided") for s in springs.supports)
        forces = forces + efforts if expressible else self.ours["forces"]
        passed = self.compare(library, forces, applied=forces)
        passed &= self.again(urdf, springs)
        written = crane(self.options, "export", self.spec, "--format", "mjcf", "-o", mjcf, check=False)
        if not expressible:
            said = any(words in written.stderr for words in (b"kinematics: linear", b"remove `one_sided`"))
            return passed and written.returncode == 1 and said
        passed &= self.again(mjcf, springs, rotors=False)
        # The efforts of rigid drives are applied instead of their equality constraints, which yield slightly.
        library = LoadedFile(mjcf, FLAGS.mjDSBL_EQUALITY)
        forces = np.array([library.passive(q, v) for q, v in zip(self.states.q, self.states.v)])
        return self.compare(library, forces + efforts, applied=efforts) and passed

    def compare(self, library, forces, applied):
        """Compares A, e, the forces and q̈ of a library; `applied` are the forces that it does not compute itself."""
        theirs = computed(library, self.states, applied)
        comparisons = compare_all(theirs, self.ours, self.states)
        comparisons.append(compare("forces", forces, self.ours["forces"], self.states.groups))
        return told(f"{self.name}, {type(library).__name__}", comparisons)

    def again(self, file, springs, rotors=True):
        """Compares A and e of the spec imported from an exported file. `rotors`: adds gravity and rotors, which URDF lacks."""
        spec = self.folder / f"{self.name}_again.yaml"
        crane(self.options, "import", file, "-o", spec, "--force")
        if rotors:
            with spec.open("a", encoding="utf-8") as text:
                text.write(f"gravity: {list(springs.gravity)}\n")
        layout = self.evaluate.layout(str(spec))
        states = States(self.states.time, self.states.q, self.states.v, np.empty((len(self.states.time), 0)))
        again = self.evaluate.values(layout, states)
        if rotors:
            again["mass_matrix"] = again["mass_matrix"] + np.diag(springs.armature).ravel()
        comparisons = [compare(name, self.ours[name], again[name], states.groups) for name in ("mass_matrix", "bias")]
        return told(f"{self.name}, spec of {file.suffix}", comparisons)


def rests_in_mujoco(options, folder):
    """Whether a crane with loops, an effort and a rigid drive rests in MuJoCo in the pose in which statics finds it at rest.

    Accelerations are compared with those of the same pose without equalities and efforts. MuJoCo's equalities are soft: what they have to
    prevent comes through by 1e-4 at most."""
    spec, mjcf = Path(__file__).with_name("closed_loops.yaml"), folder / "closed_loops.xml"
    crane(options, "export", spec, "--format", "mjcf", "-o", mjcf)
    pose = json.loads(crane(options, "statics", spec, "--all", "--format", "json").stdout)["pose"]
    accelerations = []
    for flags in (0, FLAGS.mjDSBL_EQUALITY | FLAGS.mjDSBL_ACTUATION):
        library = LoadedFile(mjcf, flags)
        for coordinate in pose:
            library.data.joint(coordinate["coordinate"]).qpos[0] = coordinate["value"]
        mujoco.mj_forward(library.model, library.data)
        accelerations.append(np.abs(library.data.qacc).max())
    share = accelerations[0] / accelerations[1]
    print(f"closed_loops, at rest in MuJoCo: {share:.1e} of the accelerations without its loops", flush=True)
    return share < 1e-3


def robot_agrees(name, fixed, evaluate, folder, options):
    """Imports a robot and compares the interpreter's results for the spec with Pinocchio's for the URDF file."""
    urdf = next(path for path in files("example-robot-data") if path.name == name.split()[0]).locate()
    spec = folder / f"{re.sub(r'[ .]', '_', name)}.yaml"
    crane(options, "import", urdf, "-o", spec, *[word for joint in fixed for word in ("--fix", joint)])
    layout = evaluate.layout(str(spec))
    rng, shape = np.random.default_rng(options.seed), (options.states, len(layout["coordinates"]))
    q, v = rng.uniform(-np.pi, np.pi, shape), rng.uniform(-2, 2, shape)
    states = States(np.zeros(options.states), q, v, np.empty((options.states, 0)))
    ours = evaluate.values(layout, states)
    theirs = computed(Urdf(urdf, [0, 0, -9.81], fixed, (spec, layout["coordinates"])), states, ours["forces"])
    return told(name, compare_all(theirs, ours, states))


def told(subject, comparisons):
    """Prints the worst of some comparisons, and all that failed; returns whether none did."""
    for comparison in comparisons:
        comparison.tolerance = TOLERANCE
    worst = max(comparisons, key=lambda comparison: comparison.by_entry)
    for comparison in [worst, *(c for c in comparisons if not c.passed and c is not worst)]:
        comparison.quantity = f"{subject}: {comparison.quantity}"
        print(comparison.row(), flush=True)
    return all(comparison.passed for comparison in comparisons)


def crane(options, *arguments, check=True):
    """Runs the command."""
    return subprocess.run([options.crane, *map(str, arguments)], check=check, capture_output=True)


if __name__ == "__main__":
    sys.exit(main())
