"""Stiffness, damping, friction and dead time of five drives, found again from noisy runs of 20 s: how often is the truth inside its interval?

    python found_again.py 20                 # repetitions, with other noise and other starts each
    python found_again.py 20 --first 200     # other ones

Every repetition fits 20 numbers of the rigid eight-link crane with the identified drives to 10,000 values, angles and efforts of the drives, from starts that
are wrong by up to 60 %.
"""

import argparse
import time

import crane
import numpy as np
from crane.experiments import Run

# Coordinate: its name in parameters, stiffness, damping, friction, positions at TIMES, noise of the position.
DRIVES = {
    "column_psi": ("column", 3.19e5, 7.52e3, 300, [0, 1.2, 0.3, 0.9, 0], 1e-3),
    "boom_psi": ("boom", 1.834e6, 1.656e5, 800, [0, 0.5, 0.9, 0.3, 0.2], 1e-3),
    "outer_boom_psi": ("outer", 5.78e5, 4.70e4, 500, [1.57, 1.1, 1.4, 0.9, 1.3], 1e-3),
    "telescope_z": ("telescope", 3.5e6, 9e4, 400, [2, 1.2, 1.9, 0.8, 1.5], 1e-3),
    "grapple_psi": ("grapple", 7296, 484, 20, [4.7, 5.6, 4.9, 6, 5], 2e-3),
}
TIMES = [0, 5, 9, 14, 19]
DEAD_TIME = 0.06
T = np.arange(0, 20, 0.02)
# Noise of efforts as a part of the largest one.
EFFORT_NOISE = 0.02


def crane_with_live_drives() -> crane.Crane:
    """The rigid crane whose drives have live stiffness, damping and friction."""
    parameters, drives, friction = "", "", ""
    for coordinate, (name, k, d, f, positions, _) in DRIVES.items():
        parameters += f"  k_{name}: {{value: {k}}}\n  d_{name}: {{value: {d}}}\n  f_{name}: {{value: {f}}}\n"
        motion = f"{{table: {{times: {TIMES}, values: {positions}, shape: spline}}}}"
        drives += f"  - {{coordinate: {coordinate}, stiffness: k_{name}, damping: d_{name}, motion: {motion}}}\n"
        friction += f"  {coordinate}: {{coulomb: f_{name}}}\n"
    text = f"format: 1\nextends: eight_link_rigid\nname: found_again\nparameters:\n{parameters}drives:\n{drives}friction:\n{friction}"
    return crane.load("found_again.yaml", text=text)


def measure(run: crane.Run, rng: np.random.Generator) -> tuple[dict, dict, dict]:
    """Noisy and late columns, their noise, and the names of their dead times."""
    columns, noise, late = {}, {}, {}
    for coordinate, (name, *_, deviation) in DRIVES.items():
        effort = f"{coordinate}_drive_{'force' if coordinate == 'telescope_z' else 'torque'}"
        for column, own in ((coordinate, deviation), (effort, EFFORT_NOISE * np.abs(run[effort]).max())):
            columns[column] = np.interp(T - DEAD_TIME, run.t, run[column]) + rng.normal(0.0, own, len(T))
            noise[column], late[column] = own, f"t_{name}"
    return columns, noise, late


def main(repetitions: int, first: int) -> None:
    """Prints every repetition, then how often each number was inside."""
    exact = crane_with_live_drives()
    live = {name: value for name, value in exact.parameters.items() if name != "load_mass"}
    truth = {**live, **{f"t_{name}": DEAD_TIME for name, *_ in DRIVES.values()}}
    bounds = {name: (0, None) if name in live else (0, 0.2) for name in truth}
    run = exact.simulate(duration=20, output=0.002, tolerance=1e-9, verify=False)
    inside = dict.fromkeys(truth, 0)
    for seed in range(first, first + repetitions):
        rng = np.random.default_rng(seed)
        columns, noise, late = measure(run, rng)
        start = exact.replace(**{name: value * rng.uniform(0.6, 1.6) for name, value in live.items()})
        begin = time.process_time()
        found = crane.fit(start, bounds, Run(T, columns, noise=noise, dead_time=late, output=0.02))
        used = time.process_time() - begin
        missed = [name for name, value in truth.items() if not found.interval(name)[0] <= value <= found.interval(name)[1]]
        for name in truth:
            inside[name] += name not in missed
        print(f"{seed}: {found.status}, {used:.1f} s of a core, {found.wall_time:.1f} s, χ²/ν {found.chi2:.3f}, outside: {', '.join(missed) or 'none'}", flush=True)
        if seed == first:
            print(found)
    print(f"inside their 95 % intervals: {100 * sum(inside.values()) / len(truth) / repetitions:.1f} %, the least often {min(inside, key=inside.get)}: {min(inside.values())} of {repetitions}")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("repetitions", type=int, nargs="?", default=20)
    arguments.add_argument("--first", type=int, default=0, help="seed of the first one")
    given = arguments.parse_args()
    main(given.repetitions, given.first)
