"""Runs of cranes compared with SciPy's Radau (Radau IIA, order 5) on equations of motion that CasADi derives.

    python motion.py --command target/release/crane [--crane NAME]... [--duration 0.5]

Neither the model nor the method is shared with the generated code and its integrators: only the YAML file, and the states that
`crane simulate` writes. Exit code 0 if every method agrees on every crane, 1 if one does not.
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
from force_states import ForceStates

WORKSPACE = Path(__file__).resolve().parents[2]
CRANES = ["double_pendulum", "eight_link_flexible", "eight_link_hydraulic", "knuckle_boom"]
# Simulated time, s: half of it with oil, whose equations take Radau a minute per second of motion and more.
DURATIONS = {"eight_link_hydraulic": 0.25}
DURATION = 0.5
# Radau's error per step, m and rad.
TOLERANCE = 1e-10
# The same for our adaptive methods, and the allowed difference, since both sides accumulate the errors of some hundred steps: relative
# to the largest scaled state, at least 1. bdf, of order 4 at most, takes more steps; dopri5 does not notice where joints stick.
METHODS = {"bdf": (1e-10, 1e-8), "rosw4": (1e-10, 1e-8), "dopri5": (1e-9, 1e-7)}


def main():
    """Compares all cranes and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", metavar="PROGRAM", required=True, help="the built program `crane`")
    parser.add_argument("--crane", metavar="NAME", action="append", help="compare this crane only (may be repeated)")
    parser.add_argument("--duration", type=float, help=f"simulated time, s [default: {DURATION}, or {DURATIONS}]")
    options = parser.parse_args()
    agree = [compare(name, options) for name in options.crane or CRANES]
    return 0 if all(agree) else 1


def compare(name, options):
    """Runs a crane by its own methods and by Radau from the same pose at rest."""
    crane = read_crane(WORKSPACE / "specs" / f"{name}.yaml")
    slope, jacobian, rates, force_states = equations(crane)
    names = [coordinate.name for coordinate in crane.coordinates]
    scales = np.concatenate([np.ones(len(names)), force_states.scales])
    places = np.r_[: len(names), 2 * len(names) : 2 * len(names) + len(force_states.names)]
    agree = True
    exact = None
    for method, (tolerance, agreement) in METHODS.items():
        duration = options.duration or DURATIONS.get(name, DURATION)
        times, states = simulate(name, method, tolerance, names + force_states.names, (options.command, duration))
        states /= scales
        if exact is None:
            start = np.concatenate([states[0, : len(names)], rates, states[0, len(names) :]])
            span = (times[0], times[-1])
            # The same tolerance for rates: an error of a rate matters less than one of a coordinate, by the time that it lasts.
            exact = solve_ivp(slope, span, start, "Radau", times, jac=jacobian, rtol=TOLERANCE, atol=TOLERANCE)
        error = np.abs(states - exact.y[places].T).max() / max(1.0, np.abs(states).max())
        moved = np.abs(states - states[0]).max()
        good = bool(exact.success) and error < agreement
        verdict = "ok" if good else "FAILED"
        print(f"{name:24} {method:8} moved {moved:8.1e}  off by {error:8.1e}  tolerance {agreement:.0e}  {verdict}")
        agree &= good
    return agree


def equations(crane):
    """Slopes of (q, v, x) and their Jacobian as functions of t and (q, v, x), the rates at t = 0, and the states x of
    forces, which are scaled.

    Where a rigid drive prescribes a coordinate, its acceleration is given and integrated with the others, which also checks the motion.
    """
    derivations = Derivations(crane)
    quantities = derivations.quantities
    count = crane.q.numel()
    mass = ca.reshape(quantities["mass_matrix"], count, count)
    force_states = ForceStates(crane, derivations.rate)
    scales = ca.DM(force_states.scales)
    scaled = ca.SX.sym("x", len(force_states.names))
    state = ca.vertcat(crane.q, crane.v, scaled)
    parts = (force_states.forces, force_states.rates / scales)
    by_states = [ca.substitute(part, force_states.x, scales * scaled) for part in parts]
    forces = quantities["bias"] + quantities["forces"] + by_states[0]
    prescribed = list(crane.rigid_drives)
    defaults = ca.DM(list(crane.spec.defaults.values()))
    at = [crane.time, state, crane.parameters]
    rates = ca.Function("rates", [crane.time, crane.parameters], [ca.densify(given_rates(crane, derivations))])
    slopes = [ca.jacobian(forces, state), ca.jacobian(by_states[1], state)]
    function = ca.Function("forces", at, [mass, forces, quantities[PRESCRIBED], by_states[1], *slopes])

    def values(t, y):
        mass, forces, given, of_states, slopes, slopes_of_states = (part.full() for part in function(t, y, defaults))
        return mass, forces[:, 0], given[:, 0], of_states.reshape(-1), slopes, slopes_of_states

    def slope(t, y):
        mass, forces, given, of_states, *_ = values(t, y)
        others = solve_unknown(mass[None], (forces - mass @ given)[None], prescribed)[0]
        return np.concatenate([y[count : 2 * count], given + others, of_states])

    def jacobian(t, y):
        """Without the derivative of the mass matrix: Newton's iteration converges without it, to the same result."""
        mass, *_, slopes, slopes_of_states = values(t, y)
        upper = np.hstack([np.zeros((count, count)), np.eye(count), np.zeros((count, len(force_states.names)))])
        columns = [solve_unknown(mass[None], column[None], prescribed)[0] for column in slopes.T]
        return np.vstack([upper, np.column_stack(columns), slopes_of_states])

    return slope, jacobian, rates(0, defaults).full()[:, 0], force_states


def given_rates(crane, derivations):
    """Zero, except for coordinates that rigid drives prescribe."""
    rates = ca.SX.zeros(crane.q.shape)
    for place, drive in crane.rigid_drives.items():
        rates[place] = derivations.rate(ca.SX(drive.motion))
    return rates


def simulate(name, method, tolerance, states, command_and_duration):
    """Times and states that `crane simulate` writes."""
    command, duration = command_and_duration
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["simulate", name, "--method", method, "--tolerance", str(tolerance), "--out", folder]
        arguments += ["--duration", str(duration), "--output", str(duration / 50)]
        subprocess.run([command, *arguments], check=True, stdout=subprocess.DEVNULL)
        with open(Path(folder) / f"{name}.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    columns = [title.split(" ")[0] for title in rows[0]]
    table = np.array(rows[1:], dtype=float)
    return table[:, columns.index("t")], table[:, [columns.index(state) for state in states]]


if __name__ == "__main__":
    sys.exit(main())
