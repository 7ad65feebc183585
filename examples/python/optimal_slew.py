"""The quickest slewing of a hanging load by 60° that ends at rest, by direct collocation with CasADi and Ipopt, on the equations of motion that the
command exports as C, with their exact derivatives. The result is run on the live crane.

    python optimal_slew.py [FOLDER]

`crane` and a C compiler must be on the path; the C code is written to FOLDER.
"""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np

import crane

SPEC = Path(__file__).with_name("slewing_crane.yaml")
N = 3  # coordinates
GOAL = np.radians(60)
LIMIT = 2000.0  # of the torque, N m
SWING = np.radians(12)  # of the rope, to each side
INTERVALS = 40


class Residual:
    """r = A a − e − f of the exported C code: what a motion requires beyond the forces that act, here the torque of the column."""

    def __init__(self, folder: Path) -> None:
        functions = ["dynamic_residual", "dynamic_residual_derivatives", "mass_matrix"]
        source, library = folder / "slewing_crane.c", folder / "slewing_crane.so"
        export = ["crane", "export", SPEC, "--format", "c", "--functions", ",".join(functions), "--quiet", "-o", source]
        subprocess.run(export, check=True)
        # What a caller in C writes with the macros of the header, as three functions of numbers alone.
        wrapper = folder / "wrapper.c"
        wrapper.write_text(
            '#include "slewing_crane.h"\n'
            "static slewing_crane_constants c;\nstatic slewing_crane_inputs u = SLEWING_CRANE_INPUTS;\n"
            "void begin(void) { slewing_crane_params p = SLEWING_CRANE_PARAMS; slewing_crane_set_params(&p, &c);\n"
            "  slewing_crane_set_input(&u, SLEWING_CRANE_INPUT_TORQUE, 0); }\n"
            "void residual(const double *x, double *r) { slewing_crane_dynamic_residual(&c, &u, 0, x, x + 3, x + 6, r); }\n"
            "void derivatives(const double *x, double *d) {\n"
            "  slewing_crane_dynamic_residual_derivatives(&c, &u, 0, x, x + 3, x + 6, d); slewing_crane_mass_matrix(&c, x, d + 18); }\n"
        )
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", wrapper, source, "-o", library, "-lm"], check=True)
        self._library = ctypes.CDLL(str(library))
        self._library.begin()

    def evaluate(self, function: str, x: np.ndarray, size: int) -> np.ndarray:
        x, out = np.ascontiguousarray(x, dtype=float), np.empty(size)
        pointer = lambda array: array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        getattr(self._library, function)(pointer(x), pointer(out))
        return out


class OfResidual(ca.Callback):
    """The residual, (3), or its Jacobian, (3, 9), as a function of CasADi of x = (q, v, a)."""

    def __init__(self, name: str, residual: Residual, is_jacobian: bool = False) -> None:
        ca.Callback.__init__(self)
        self.residual, self.is_jacobian = residual, is_jacobian
        self.construct(name, {})

    def get_n_in(self):
        return 2 if self.is_jacobian else 1

    def get_sparsity_in(self, place):
        return ca.Sparsity.dense(3 * N if place == 0 else N, 1)

    def get_sparsity_out(self, _):
        return ca.Sparsity.dense(N, 3 * N if self.is_jacobian else 1)

    def eval(self, arguments):
        x = np.array(arguments[0]).ravel()
        if self.is_jacobian:
            blocks = self.residual.evaluate("derivatives", x, 3 * N * N).reshape(3, N, N)
            return [ca.DM(np.concatenate(blocks, axis=1))]
        return [ca.DM(self.residual.evaluate("residual", x, N))]

    def has_jacobian(self):
        return not self.is_jacobian

    def get_jacobian(self, name, *_):
        self.of_jacobian = OfResidual(name, self.residual, is_jacobian=True)
        return self.of_jacobian


def main(folder: Path) -> float:
    """Solves it and runs it; returns the distance of the load from its goal 1 s after the motion, m."""
    residual = OfResidual("residual", Residual(folder))
    problem = ca.Opti()
    duration = problem.variable()
    q, v, a = (problem.variable(N, INTERVALS + 1) for _ in range(3))
    torque = problem.variable(INTERVALS + 1)  # in units of its limit
    h = duration / INTERVALS
    for k in range(INTERVALS + 1):
        problem.subject_to(residual(ca.vertcat(q[:, k], v[:, k], a[:, k])) / LIMIT == ca.vertcat(torque[k], 0, 0))
        if k < INTERVALS:  # accelerations change linearly within an interval
            problem.subject_to(v[:, k + 1] == v[:, k] + h / 2 * (a[:, k] + a[:, k + 1]))
            problem.subject_to(q[:, k + 1] == q[:, k] + h * v[:, k] + h**2 / 6 * (2 * a[:, k] + a[:, k + 1]))
    problem.subject_to(problem.bounded(-1, torque, 1))
    problem.subject_to(problem.bounded(-SWING, ca.vec(q[1:, :]), SWING))
    problem.subject_to(problem.bounded(3, duration, 30))
    for ends in (q[:, 0], v[:, 0], v[:, -1], q[:, -1] - [GOAL, 0, 0], a[:, -1]):
        problem.subject_to(ends == 0)
    # Torques without jumps, where time leaves the choice.
    problem.minimize(duration / 10 + 0.1 * ca.sumsqr(ca.diff(torque)))
    begin, x = 12.0, np.linspace(0, 1, INTERVALS + 1)
    problem.set_initial(duration, begin)
    problem.set_initial(q[0, :], GOAL * x**2 * (3 - 2 * x))
    problem.set_initial(v[0, :], GOAL * 6 * x * (1 - x) / begin)
    problem.set_initial(a[0, :], GOAL * 6 * (1 - 2 * x) / begin**2)
    quiet = {"print_level": 0, "sb": "yes"}
    problem.solver("ipopt", {"print_time": False}, {**quiet, "hessian_approximation": "limited-memory", "max_iter": 1000})
    found = problem.solve()

    seconds, command = float(found.value(duration)), found.value(torque) * LIMIT
    slewing = crane.load(SPEC)
    simulation = slewing.simulation(q=np.zeros(N))
    times = np.linspace(0, seconds, INTERVALS + 1)
    steps = 400
    for step in range(steps):
        middle = (step + 0.5) / steps * seconds
        simulation.step(seconds / steps, inputs={"torque": float(np.interp(middle, times, command))})
    simulation.step(1.0, inputs={"torque": 0.0})
    off = float(np.linalg.norm(slewing.points(simulation.q)[0] - slewing.points(np.array([GOAL, 0, 0]))[0]))
    print(f"{seconds:.2f} s with at most {np.abs(command).max():.0f} N m; the live crane is {off:.3f} m from the goal 1 s later")
    return off


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        off = main(Path(sys.argv[1] if len(sys.argv) > 1 else temporary))
    sys.exit(0 if off < 0.1 else "the load does not arrive")
