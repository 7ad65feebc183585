"""How many cranes can be stepped per second: 64 at 50 Hz, with smooth inputs that move linearly over each step, on all threads.

    python steps_per_second.py 3        # rounds, of which the fastest counts
    python steps_per_second.py 9 env    # one crane: an environment of Gymnasium against `Simulation.step`, medians of rounds by turns
"""

import sys
import time

import crane
import numpy as np

CRANES = {
    "knuckle_boom": (
        "inputs: {boom: {unit: N m}, knuckle: {unit: N m}}\n"
        "drives:\n  - {coordinate: main_boom_theta, stiffness: ~, damping: ~, motion: ~, effort: {input: boom}}\n"
        "  - {coordinate: knuckle_theta, stiffness: ~, damping: ~, motion: ~, effort: {input: knuckle}}\n",
        {"boom": (-5e4, 2e3), "knuckle": (-1.5e4, 1e3)},
    ),
    "eight_link_flexible": (
        "inputs: {slew: {unit: rad}, boom: {unit: rad}}\n"
        "drives: [{coordinate: column_psi, motion: {input: slew}}, {coordinate: boom_psi, motion: {input: boom}}]\n",
        {"slew": (0.0, 0.3), "boom": (0.6, 0.2)},
    ),
}
METHODS = [("bdf", 2e-5), ("rosw4", 2e-5), ("bdf", 1e-3), ("rosw4", 1e-3)]
COUNT, STEP, STEPS = 64, 0.02, 200


def steered(name: str) -> crane.Crane:
    """The crane with its inputs."""
    return crane.load(f"{name}_steered.yaml", text=f"format: 1\nextends: {name}\nname: {name}_steered\n{CRANES[name][0]}")


def measure(name: str, method: str, tolerance: float, rounds: int) -> str:
    """The rate of the fastest round."""
    inputs, c = CRANES[name][1], steered(name)
    cranes = c.vector_simulation(COUNT, method=method, tolerance=tolerance)
    phases = np.random.default_rng(0).uniform(0, 2 * np.pi, (len(inputs), COUNT))

    def advance(first: int, count: int) -> float:
        begin = time.perf_counter()
        for step in range(first, first + count):
            waves = np.sin(1.5 * STEP * step + phases)
            values = {key: middle + size * wave for (key, (middle, size)), wave in zip(inputs.items(), waves, strict=True)}
            cranes.step(STEP, values, hold="linear")
        return COUNT * count / (time.perf_counter() - begin)

    advance(0, 30)
    before = cranes.statistics["evaluations"].sum()
    rate = max(advance(30 + number * STEPS, STEPS) for number in range(rounds))
    each = (cranes.statistics["evaluations"].sum() - before) / (COUNT * rounds * STEPS)
    return f"{name}, {c.n} coordinates, {method} {tolerance:g}: {rate:,.0f} steps per s, {each:.1f} evaluations per step"


def compare(name: str, rounds: int) -> str:
    """Steps per second of one crane as an environment, with a target, reward and `info`, and of its simulation alone, with equal inputs."""
    from crane.gym import CraneEnv, reach

    inputs, c = CRANES[name][1], steered(name)
    bands = {key: (middle - abs(size), middle + abs(size)) for key, (middle, size) in inputs.items()}
    target = c.coordinates[0]
    task = {"targets": {target: (-0.1, 0.1)}, "reward": reach(target), "dt": STEP, "duration": 1e9, "tolerance": 1e-3}
    env, simulation = CraneEnv(c, actions=bands, hold="linear", **task), c.simulation(tolerance=1e-3)
    env.reset(seed=0)
    phases = np.random.default_rng(0).uniform(0, 2 * np.pi, len(inputs))

    def rate(step, values) -> float:
        begin = time.perf_counter()
        for each in values:
            step(each)
        return STEPS / (time.perf_counter() - begin)

    rates = []
    for number in range(rounds + 1):
        shares = np.sin(1.5 * STEP * np.arange(number * STEPS, (number + 1) * STEPS)[:, None] + phases)
        values = [{key: low + 0.5 * (share + 1) * (high - low) for (key, (low, high)), share in zip(bands.items(), row, strict=True)} for row in shares.tolist()]
        turns = [(0, env.step, shares), (1, lambda each: simulation.step(STEP, each, hold="linear"), values)]
        rates.append([found for _, found in sorted((place, rate(step, given)) for place, step, given in turns[:: 1 - number % 2 * 2])])
    # The first round warms up.
    found = np.array(rates[1:])
    alone, ratio = np.median(found[:, 1]), np.median(found[:, 0] / found[:, 1])
    return f"{name}: {np.median(found[:, 0]):,.0f} steps per s in an environment, {alone:,.0f} of a simulation alone, ratio {ratio:.2f}"


if __name__ == "__main__":
    if sys.argv[2:] == ["env"]:
        print(*(compare(crane_name, int(sys.argv[1])) for crane_name in CRANES), sep="\n")
        sys.exit()
    for crane_name in CRANES:
        for kind in METHODS:
            print(measure(crane_name, *kind, int(sys.argv[1]) if len(sys.argv) > 1 else 3), flush=True)
