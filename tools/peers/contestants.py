"""Who computes what: a contestant is one library with one variant, on one crane, computing one quantity."""

import pickle
import subprocess
import sys
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path

import mujoco
import numpy as np

import casadi_peer
import extended
from chain import as_text, read_chain
from crane_model import read_crane
from mujoco_peer import build, with_springs
from springs import read_springs

HERE = Path(__file__).resolve().parent
OURS = "generated Rust"
# The others, by the methods of `Arena` that make their contestants.
LIBRARIES = ["pinocchio", "casadi", "mujoco", "exudyn"]
PINOCCHIO_BASES = ["revolute", "zyx", "composite", "free_flyer"]
PINOCCHIO_ELEMENTS = ["revolute", "zyx", "composite"]
PINOCCHIO_ALGORITHMS = {
    "forward_dynamics": ["aba_local", "aba_world", "dense_local", "dense_world", "llt_local", "llt_world"],
    "mass_matrix_and_bias": ["terms_local", "terms_world"],
    "forward_dynamics_derivatives": ["derivatives_of_aba"],
}
DERIVATIVES = "forward_dynamics_derivatives"
# Derivatives are compared at so many states, with differences of 80-bit recursions over these steps of q, of v, in which accelerations are
# quadratic, and of forces, in which they are linear: errors are some 1e-11.
DERIVATIVE_STATES, STEPS = 2, [1e-6, 0.1, 1e3]
# Maximum number of coordinates; with 73, a step takes 5 ms.
EXUDYN_UP_TO = 25
# Our kernels that compute the same quantities as the others.
SHARED = {
    "forward_dynamics": "forward_dynamics",
    "forward_dynamics_lanes": "forward_dynamics",
    "forward_dynamics_machine_code": "forward_dynamics",
    "forward_dynamics_machine_code_lanes": "forward_dynamics",
    "forward_dynamics_bytecode": "forward_dynamics",
    "forward_dynamics_derivatives": DERIVATIVES,
    "forward_dynamics_derivatives_live": "forward_dynamics_derivatives_live",
    "dense_forward_dynamics": "forward_dynamics",
    "mass_matrix_and_bias": "mass_matrix_and_bias",
    "triple_sum": "mass_matrix_and_bias",
    "rk4_step": "rk4_step",
}


@dataclass
class Contestant:
    """`arguments` of its program after `values` or `time`; `times` in nanoseconds for one crane.

    `compiler`: where there is a choice.
    """

    quantity: str
    library: str
    variant: str
    coordinates: int
    program: list
    arguments: list
    lanes: int = 1
    compiler: str = ""
    error: float | None = None
    times: list = field(default_factory=list)

    def run(self, task, *further):
        """The output of its program."""
        command = [*map(str, self.program), task, *map(str, self.arguments), *map(str, further)]
        result = subprocess.run(command, capture_output=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: {result.stderr.decode(errors='replace')}")
        return result.stdout

    def values(self, states):
        """What it computes, one row per state."""
        return np.frombuffer(self.run("values")).reshape(states, -1)

    def time(self, seconds):
        """Nanoseconds for one crane, measured for this many seconds."""
        return float(self.run("time", seconds)) / self.lanes


class Arena:
    """One crane in the form of every library, and all contestants on it."""

    def __init__(self, coordinates, builds, compilers, bench, libraries):
        self.coordinates, self.builds, self.compilers, self.bench = coordinates, builds, compilers, bench
        self.libraries = libraries
        crane = read_crane(builds.write(f"crane_{coordinates}.yaml", self.ask("spec", coordinates)))
        self.states = builds.write(f"states_{coordinates}", self.ask("states", coordinates))
        self.records = np.fromfile(self.states).reshape(-1, 1 + 3 * coordinates)
        self.chain = read_chain(crane)
        # The times of the states are before any drive moves.
        self.springs = read_springs(crane, self.records[0, 0])
        self.functions = casadi_peer.functions(self.chain)
        self.step = float(self.ask("step"))

    def ask(self, *words):
        """The output of the program of crane-bench."""
        return subprocess.run([self.bench, *map(str, words)], capture_output=True, check=True).stdout

    def contestants(self):
        """All of them, ours first."""
        return [*self.ours(), *(found for library in self.libraries for found in getattr(self, library)())]

    def ours(self):
        """All kernels of crane-bench."""
        for line in self.ask("kernels", self.coordinates).decode().split("\n")[:-1]:
            kernel, lanes = line.split()
            quantity = SHARED.get(kernel, kernel)
            arguments = [self.coordinates, kernel]
            yield Contestant(quantity, OURS, kernel, self.coordinates, [self.bench], arguments, int(lanes))

    def pinocchio(self):
        """All joint models and algorithms. A crane without elements has only one joint model for them."""
        chain = self.builds.write(f"chain_{self.coordinates}.txt", as_text(self.chain))
        flexible = any(len(link.joints) == 3 for link in self.chain.links)
        models = list(product(PINOCCHIO_BASES, PINOCCHIO_ELEMENTS if flexible else PINOCCHIO_ELEMENTS[:1]))
        for compiler in self.compilers:
            program = self.builds.program("pinocchio", compiler)
            for (base, elements), (quantity, algorithms) in product(models, PINOCCHIO_ALGORITHMS.items()):
                for algorithm in algorithms:
                    arguments = [chain, self.states, f"{base}.{elements}.{algorithm}"]
                    variant = f"{algorithm}, base {base}, elements {elements}"
                    found = Contestant(quantity, "Pinocchio", variant, self.coordinates, [program], arguments)
                    yield replace(found, compiler=compiler.name)

    def sources(self):
        """Each function of CasADi as a separate C file."""
        for function in self.functions:
            path = self.builds.folder / f"casadi_{function.name()}_{self.coordinates}.c"
            casadi_peer.write_c([function], path)
            yield function, path

    def casadi(self):
        """The functions of CasADi, with each compiler."""
        for (function, source), compiler in product(self.sources(), self.compilers):
            library = self.builds.shared_library(source, compiler)
            program = self.builds.program("casadi", compiler)
            arguments = [library, self.states, function.name()]
            found = Contestant(function.name(), "CasADi C", "recursion", self.coordinates, [program], arguments)
            yield replace(found, compiler=compiler.name)

    def mujoco(self):
        """mj_forward with applied forces, and an RK4 step with springs and dampers."""
        program = self.builds.program("mujoco", self.compilers[0])
        models = {
            ("forward_dynamics", "forward"): build(self.chain),
            ("rk4_step", "rk4_step"): with_springs(self.chain, self.springs, self.step),
        }
        for (quantity, kernel), spec in models.items():
            path = self.builds.folder / f"{kernel}_{self.coordinates}.mjb"
            mujoco.mj_saveModel(spec.compile(), str(path))
            arguments = [path, self.states, kernel]
            yield Contestant(quantity, "MuJoCo", kernel, self.coordinates, [program], arguments)

    def exudyn(self):
        """An RK44 step, for cranes for which a run does not take minutes."""
        if self.coordinates > EXUDYN_UP_TO:
            return
        crane = self.builds.write(f"exudyn_{self.coordinates}", pickle.dumps((self.chain, self.springs, self.step)))
        program = [sys.executable, HERE / "exudyn_peer.py"]
        yield Contestant("rk4_step", "Exudyn", "RK44", self.coordinates, program, [crane, self.states])

    def reference(self):
        """Reference values, by quantity: recursions in 80-bit numbers; the step by our own kernel."""
        n = self.coordinates
        q, v, f = (self.records[:, 1 + k * n : 1 + (k + 1) * n] for k in range(3))
        right = {
            function.name(): np.hstack(extended.evaluate(function, *(q, v, f)[: function.n_in()]))
            for function in self.functions
        }
        right[DERIVATIVES] = self.derivatives()
        step = Contestant("rk4_step", OURS, "rk4_step", n, [self.bench], [n, "rk4_step"])
        return right | {"rk4_step": step.values(len(self.records)) - self.records[:, 1 : 1 + 2 * n]}

    def derivatives(self):
        """∂q̈/∂q, ∂q̈/∂v and A⁻¹ at the first states, row by row, by differences in 80-bit numbers."""
        n = self.coordinates
        function = next(function for function in self.functions if function.name() == "forward_dynamics")
        sizes = np.repeat(np.array(STEPS, dtype=np.longdouble), n)
        found = []
        for record in self.records[:DERIVATIVE_STATES]:
            state = record[1:].astype(np.longdouble)
            ahead, behind = (
                extended.evaluate(function, *np.split(state + sign * np.diag(sizes), 3, axis=1))[0] for sign in (1, -1)
            )
            slopes = (ahead - behind) / (2 * sizes[:, None])
            # One row for each number that changes.
            found.append(np.concatenate([block.T.ravel() for block in np.split(slopes, 3)]))
        return np.array(found)

    def error(self, contestant, reference):
        """The maximum over the states of the largest error over the largest entry; None if no other program computes the same."""
        if contestant.quantity not in reference:
            return None
        right = reference[contestant.quantity]
        values = contestant.values(len(self.records))
        if contestant.quantity == DERIVATIVES:
            return self.error_of_derivatives(values[:DERIVATIVE_STATES], right)
        if contestant.quantity == "rk4_step":
            values = values - self.records[:, 1 : 1 + 2 * self.coordinates]
        return float((np.abs(values - right).max(axis=1) / np.abs(right).max(axis=1)).max())

    def error_of_derivatives(self, values, right):
        """The maximum over states and matrices. A free flyer, whose derivatives are in its tangent space, has NaN for those of the base."""
        shape = len(right), 3, self.coordinates**2
        values, right = values.reshape(shape), right.reshape(shape)
        off = np.nanmax(np.abs(values - right), axis=2)
        return float((off / np.abs(right).max(axis=2)).max())
