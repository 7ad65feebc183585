"""Runs of cranes compared with SciPy's Radau (Radau IIA, order 5) on equations of motion that CasADi derives.

    python motion.py --command target/release/crane [--crane NAME]... [--duration 0.5]

Neither the model nor the method is shared with the generated code and its integrators: only the YAML file, and the pose and
results that `crane simulate` writes. Exit code 0 if every method agrees on every crane, 1 if one does not.
"""

import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from crane_model import read_crane
from derivations import PRESCRIBED, Derivations, solve_unknown

WORKSPACE = Path(__file__).resolve().parents[2]
CRANES = ["double_pendulum", "eight_link_flexible", "knuckle_boom"]
# Of Radau: an error per step, m and rad.
TOLERANCE = 1e-9
# Of our adaptive methods likewise; bdf, of order 4 at most, adds up more steps.
METHODS = {"bdf": 1e-10, "rosw4": 1e-9, "dopri5": 1e-9}
# Both sides add up the errors of some hundred steps, relative to the greatest coordinate, at least 1 m or rad.
AGREEMENT = 1e-8


def main():
    """Compares all cranes and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", metavar="PROGRAM", required=True, help="the built program `crane`")
    parser.add_argument("--crane", metavar="NAME", action="append", help="compare this crane only (may be repeated)")
    parser.add_argument("--duration", type=float, default=0.5, help="simulated time, s")
    options = parser.parse_args()
    agree = [compare(name, options) for name in options.crane or CRANES]
    return 0 if all(agree) else 1


def compare(name, options):
    """Runs a crane by its own methods and by Radau from the same pose at rest."""
    crane = read_crane(WORKSPACE / "specs" / f"{name}.yaml")
    slope, jacobian, rates = equations(crane)
    names = [coordinate.name for coordinate in crane.coordinates]
    agree = True
    exact = None
    for method, tolerance in METHODS.items():
        times, poses = simulate(name, method, tolerance, names, options)
        if exact is None:
            start = np.concatenate([poses[0], rates])
            span = (times[0], times[-1])
            # An error of a rate counts less than one of a coordinate, as it lasts.
            exact = solve_ivp(slope, span, start, "Radau", times, jac=jacobian, rtol=TOLERANCE, atol=TOLERANCE)
        error = np.abs(poses - exact.y[: len(names)].T).max() / max(1.0, np.abs(poses).max())
        moved = np.abs(poses - poses[0]).max()
        good = bool(exact.success) and error < AGREEMENT
        verdict = "ok" if good else "FAILED"
        print(f"{name:24} {method:8} moved {moved:8.1e}  off by {error:8.1e}  tolerance {AGREEMENT:.0e}  {verdict}")
        agree &= good
    return agree


def equations(crane):
    """Slopes of (q, v) and their Jacobian as functions of t and (q, v), and the rates at t = 0.

    Where a rigid drive prescribes a coordinate, its acceleration is given: it is integrated along, as a check of the motion too.
    """
    derivations = Derivations(crane)
    quantities = derivations.quantities
    count = crane.q.numel()
    mass = ca.reshape(quantities["mass_matrix"], count, count)
    state = ca.vertcat(crane.q, crane.v)
    forces = quantities["bias"] + quantities["forces"]
    prescribed = list(crane.rigid_drives)
    defaults = ca.DM(list(crane.spec.defaults.values()))
    at = [crane.time, crane.q, crane.v, crane.parameters]
    rates = ca.Function("rates", [crane.time, crane.parameters], [ca.densify(given_rates(crane, derivations))])
    function = ca.Function("forces", at, [mass, forces, ca.jacobian(forces, state), quantities[PRESCRIBED]])

    def values(t, y):
        mass, forces, slopes, given = function(t, y[:count], y[count:], defaults)
        return mass.full(), forces.full()[:, 0], slopes.full(), given.full()[:, 0]

    def slope(t, y):
        mass, forces, _, given = values(t, y)
        others = solve_unknown(mass[None], (forces - mass @ given)[None], prescribed)[0]
        return np.concatenate([y[count:], given + others])

    def jacobian(t, y):
        """Without the change of the mass matrix: Newton's iteration needs no more, and its result does not depend on it."""
        mass, _, slopes, _ = values(t, y)
        upper = np.hstack([np.zeros((count, count)), np.eye(count)])
        columns = [solve_unknown(mass[None], column[None], prescribed)[0] for column in slopes.T]
        return np.vstack([upper, np.column_stack(columns)])

    return slope, jacobian, rates(0, defaults).full()[:, 0]


def given_rates(crane, derivations):
    """Zero, except for coordinates that rigid drives prescribe."""
    rates = ca.SX.zeros(crane.q.shape)
    for place, drive in crane.rigid_drives.items():
        rates[place] = derivations.rate(ca.SX(drive.motion))
    return rates


def simulate(name, method, tolerance, coordinates, options):
    """Times and poses that `crane simulate` writes."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["simulate", name, "--method", method, "--tolerance", str(tolerance), "--out", folder]
        arguments += ["--duration", str(options.duration), "--output", str(options.duration / 50)]
        subprocess.run([options.command, *arguments], check=True, stdout=subprocess.DEVNULL)
        with open(Path(folder) / f"{name}.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    columns = [title.split(" ")[0] for title in rows[0]]
    table = np.array(rows[1:], dtype=float)
    return table[:, columns.index("t")], table[:, [columns.index(coordinate) for coordinate in coordinates]]


if __name__ == "__main__":
    sys.exit(main())
