"""A load on a rope is slewed by 40° in 4 s, and swings. A ZV shaper splits the motion into two halves, half a period of the load apart, so that the
swing of one cancels that of the other: N. C. Singer, W. P. Seering, Preshaping command inputs to reduce system vibration, 1990.

    python zv_shaping.py
"""

import sys
from pathlib import Path

import numpy as np

import crane

HERE = Path(__file__).parent
DURATION = 4.0  # of the motion without a shaper, s
ANGLE = np.radians(40)
# The same crane, whose column follows a motion.
SLEWN = """
format: 1
extends: {base}
name: slewn
inputs: {{torque: ~}}
drives: [{{coordinate: column_psi, rigid: true, max_effort: ~, damping: ~, effort: ~, motion: {{table: {{times: {times}, values: {values}, shape: spline}}}}}}]
"""


def main() -> float:
    """Runs both motions; returns the ratio of the swings that they leave."""
    held = slewn(np.array([0.0, 1.0]), np.zeros(2))
    modes = held.modes()
    tangential = int(np.argmax(np.abs(modes.shapes[:, held.coordinates.index("tangential_phi")])))
    frequency, damping = modes.frequencies[tangential], modes.damping_ratios[tangential]
    half = 0.5 / (frequency * np.sqrt(1 - damping**2))
    second = 1 / (1 + np.exp(np.pi * damping / np.sqrt(1 - damping**2)))
    print(f"the load swings with {frequency:.4f} Hz and {100 * damping:.2f} % of critical damping: impulses of {1 - second:.3f} and {second:.3f}, {half:.3f} s apart")

    times = np.linspace(0, DURATION + half + 0.2, 400)
    plain, delayed = smooth(times), smooth(times - half)
    swings = {}
    for name, motion in {"plain": plain, "shaped": (1 - second) * plain + second * delayed}.items():
        run = slewn(times, ANGLE * motion).simulate(duration=DURATION + half + 6, verify=False)
        after = run.t > DURATION + half + 0.2
        swings[name] = np.degrees(np.abs(run["tangential_phi"][after]).max())
        print(f"{name:>7}: the load swings by {swings[name]:.3f}° after the motion")
    return swings["shaped"] / swings["plain"]


def slewn(times, values):
    """The crane whose column follows a motion."""
    text = SLEWN.format(base=HERE / "slewing_crane.yaml", times=times.round(6).tolist(), values=values.round(9).tolist())
    return crane.load("slewn", text=text)


def smooth(t):
    """From 0 to 1 with steady acceleration and deceleration."""
    x = np.clip(t / DURATION, 0, 1)
    return np.where(x < 0.5, 2 * x**2, 1 - 2 * (1 - x) ** 2)


if __name__ == "__main__":
    sys.exit(0 if main() < 0.1 else "the shaper does not help")
