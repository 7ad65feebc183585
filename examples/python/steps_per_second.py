"""How many cranes can be stepped per second: 64 at 50 Hz, with smooth inputs that move linearly over each step, on all threads.

    python steps_per_second.py 3        # rounds, of which the fastest counts
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


def measure(name: str, method: str, tolerance: float, rounds: int) -> str:
    """The rate of the fastest round."""
    changes, inputs = CRANES[name]
    c = crane.load(f"{name}_steered.yaml", text=f"format: 1\nextends: {name}\nname: {name}_steered\n{changes}")
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


if __name__ == "__main__":
    for crane_name in CRANES:
        for kind in METHODS:
            print(measure(crane_name, *kind, int(sys.argv[1]) if len(sys.argv) > 1 else 3), flush=True)
