"""Velocity steps of a real timber crane beside those of the shipped crane that has its drives, and a fit of stiffness, damping and dead time.

    python velocity_steps.py                          # prints tables, writes velocity_steps.svg
    python velocity_steps.py --axes slew,rotator      # some of the axes

The measurement is in velocity_steps.json: for each axis the mean of 4 to 8 edges of a staircase of commanded velocities, normalised by the settled
change, with the spread over the edges. The source identified the drives with a dead time of 60 ms; `eight_link_identified` has its stiffness and
damping, on links of its own: the inertia of the axes in the measured poses differs, and so does the law of the drive, whose damper acts here on
q̇ − q̇_dr, there on q̇ alone.
"""

import argparse
import json
from pathlib import Path

import crane
import numpy as np

MEASURED = json.loads(Path(__file__).with_name("velocity_steps.json").read_text(encoding="utf-8"))["axes"]
# Dead time of the source, s.
DEAD_TIME = 0.06
# Commanded velocity, rad/s and m/s: small, so that the response is linear and its normalised form that of any step.
RATE = 0.02
# Stiffness, N m/rad and N/m, and damping, N m s/rad and N s/m, of the drives of `eight_link_identified`.
DRIVES = {
    "column_psi": (3.19e5, 7.52e3),
    "boom_psi": (1.834e6, 1.656e5),
    "outer_boom_psi": (5.78e5, 4.70e4),
    "telescope_z": (3.5e6, 9e4),
    "grapple_psi": (7296, 484),
}


def crane_of(axis: dict) -> crane.Crane:
    """The identified crane without a log in the pose of the measurement, whose axis is driven at a constant velocity from rest on."""
    start = {"column_psi": 0.0, "grapple_psi": 1.5 * np.pi, **axis["pose"]}
    moving = axis["coordinate"]
    drives = [f"  - {{coordinate: {name}, motion: {{hold: {start[name]:.6g}}}}}" for name in DRIVES if name != moving]
    drives.append(f"  - {{coordinate: {moving}, stiffness: stiffness, damping: damping, motion: {{speed: {{rate: {RATE}, from: {start[moving]:.6g}}}}}}}")
    stiffness, damping = DRIVES[moving]
    unit = "N/m" if moving == "telescope_z" else "N m/rad"
    text = f"""format: 1
extends: eight_link_identified
name: velocity_step
parameters:
  stiffness: {{value: {stiffness}, unit: {unit}}}
  damping: {{value: {damping}, unit: {unit.replace("/", " s/")}}}
drives:
{chr(10).join(drives)}
guess: {{upper_hinge_psi: {1.5 * np.pi - start["boom_psi"] - start["outer_boom_psi"]:.6g}}}
"""
    return crane.load("velocity_step.yaml", text=text, load_mass=0)


def measurement(axis: dict, dead_time: float | str = "dead_time") -> crane.experiments.Run:
    """The measured step as an experiment; the spread over the edges is its noise."""
    rates, spread = RATE * np.array(axis["response"]), RATE * np.array(axis["spread"])
    column = f"{axis['coordinate']}_rate"
    return crane.experiments.Run(axis["times"], {column: rates}, noise={column: spread}, dead_time=dead_time, name="step")


def response(c: crane.Crane, axis: dict, dead_time: float, t: np.ndarray) -> np.ndarray:
    """The normalised response at times t, s."""
    run = c.simulate(duration=1.3, output=0.005, tolerance=1e-8, verify=False)
    return np.interp(t - dead_time, run.t, run[f"{axis['coordinate']}_rate"] / RATE, left=0.0)


def compare(names: list[str], starts: int) -> dict[str, tuple[crane.Crane, crane.Fit]]:
    """Prints how the shipped and the fitted drives meet the measurement; returns both cranes."""
    found = {}
    for name in names:
        axis = MEASURED[name]
        shipped = crane_of(axis)
        bounds = {key: (value / 1000, value * 10) for key, value in shipped.parameters.items() if key != "load_mass"}
        fit = crane.fit(shipped, {**bounds, "dead_time": (0, 0.25)}, measurement(axis), starts=starts)
        found[name] = shipped, fit
    print("Normalised velocity after a step of the command, and differences from the measurement in its spreads σ")
    print(f"{'axis':10}{'t [s]':>7}{'measured':>10}{'σ':>7}{'shipped':>9}{'':>8}{'fitted':>8}")
    for name, (shipped, fit) in found.items():
        axis = MEASURED[name]
        t, measured, spread = (np.array(axis[key]) for key in ("times", "response", "spread"))
        before, after = response(shipped, axis, DEAD_TIME, t), response(fit.crane, axis, fit["dead_time"], t)
        for row in zip(t, measured, spread, before, after, strict=True):
            differences = [(model - row[1]) / row[2] for model in row[3:]]
            print(f"{name:10}{row[0]:7.2f}{row[1]:10.3f}{row[2]:7.3f}{row[3]:9.3f}{differences[0]:+6.1f} σ{row[4]:8.3f}{differences[1]:+6.1f} σ")
    print("\nFitted drives; inertia of the axis in its pose, kg m² or kg, of this crane and of the measured one")
    print(f"{'axis':10}{'stiffness':>11}{'shipped':>19}{'damping':>11}{'shipped':>19}{'dead time, ms':>19}{'χ²/ν':>7}{'':>8}{'inertia':>9}{'measured':>9}  status")
    for name, (shipped, fit) in found.items():
        axis = MEASURED[name]
        index = shipped.coordinates.index(axis["coordinate"])
        inertia = shipped.mass_matrix(shipped.statics().q)[index, index]
        before = response(shipped, axis, DEAD_TIME, np.array(axis["times"]))
        shipped_chi2 = np.sum(((before - axis["response"]) / axis["spread"]) ** 2) / len(before)
        values = shipped.parameters
        known = np.isfinite(fit.deviations)
        widths = [f"±{fit.quantile * deviation * 10 ** (3 * (key == 'dead_time')):.2g}" for key, deviation in zip(fit.names, fit.deviations, strict=True)]
        half = {key: width if there else "unknown" for key, width, there in zip(fit.names, widths, known, strict=True)}
        print(
            f"{name:10}{fit['stiffness']:11.3g} {half['stiffness']:9}{values['stiffness']:9.3g}{fit['damping']:11.3g} {half['damping']:9}{values['damping']:9.3g}"
            f"{1e3 * fit['dead_time']:9.0f} {half['dead_time']:9}{shipped_chi2:7.1f} →{fit.chi2:6.1f}{inertia:9.0f}{axis['inertia']:9.0f}  {fit.status}"
        )
    for name, (_, fit) in found.items():
        for caution in fit.cautions:
            print(f"{name}: {caution}")
    return found


def draw(found: dict[str, tuple[crane.Crane, crane.Fit]], path: Path) -> None:
    """A panel for each axis."""
    import matplotlib

    matplotlib.use("svg")
    # Text as text, and the same file from the same numbers.
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "velocity steps"})
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, len(found), figsize=(3.6 * len(found), 3.4), sharey=True, squeeze=False, layout="constrained")
    for panel, (name, (shipped, fit)) in zip(panels[0], found.items(), strict=True):
        axis = MEASURED[name]
        t = np.linspace(0, axis["times"][-1], 300)
        panel.errorbar(axis["times"], axis["response"], axis["spread"], fmt="ko", markersize=4, capsize=2, label="measured, ± spread")
        panel.plot(t, response(shipped, axis, DEAD_TIME, t), color="tab:gray", linestyle="--", label="shipped drive, 60 ms")
        panel.plot(t, response(fit.crane, axis, fit["dead_time"], t), color="tab:blue", label=f"fitted, {1e3 * fit['dead_time']:.0f} ms")
        panel.set(title=f"{name}: χ²/ν {fit.chi2:.1f}", xlabel="t [s]")
        panel.grid(alpha=0.3)
        panel.legend(fontsize=7, loc="lower right")
    panels[0, 0].set_ylabel("velocity / settled velocity")
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--axes", default=",".join(MEASURED), help=f"some of {','.join(MEASURED)}")
    arguments.add_argument("--out", type=Path, default=Path("velocity_steps.svg"))
    arguments.add_argument("--starts", type=int, default=8, help="from how many places each fit begins")
    given = arguments.parse_args()
    draw(compare(given.axes.split(","), given.starts), given.out)
    print(f"wrote {given.out}")
