"""Runs that are compared with measurements: their columns at given times, delayed, and derivatives of these."""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._native import real_array
from .results import Array
from .results import Run as Recorded

if TYPE_CHECKING:
    from .experiments import Run
    from .model import Crane
    from .series import Series

# Longest interval between results from which a response is interpolated, s: an oscillation of 5 Hz then has an error of 3e-5 of itself.
INTERVAL = 0.01
# Time of all runs above which they are computed on all threads, s.
WORTH_THREADS = 0.1
# Rows of a table.
ROWS = 1000
# Tolerance of runs with gradients, relative to that of runs without: derivatives need fewer digits than values.
LOOSER = 10.0


class RunModel:
    """What a crane says to the measured columns of a run."""

    # Gradients of runs of tolerance 1e-7, differences over relative steps of 3e-4 of runs of tolerance 1e-8, or better.
    accuracy = 1e-5

    def __init__(self, experiment: "Run", crane: "Crane", series: list["Series"], delays: dict[str, float | str]) -> None:
        from .fit_problem import scipy

        self._spline = scipy().interpolate.CubicSpline
        self._experiment, self._crane, self._delays = experiment, crane, delays
        end = max(one.at[-1] for one in series)
        self._output = experiment.output or _interval(np.asarray(experiment.t, dtype=float))
        self._duration = self._output * np.ceil(end / self._output - 1e-9)
        self._live = [name for name in crane.parameters if name not in experiment.parameters]
        self._last: Recorded | None = None
        self._known: tuple[dict[str, float], Recorded] | None = None
        first = self._run({})
        try:
            for one in series:
                first[one.column]
        except KeyError as error:
            raise KeyError(f"{experiment.name}: {error.args[0]}") from None
        self.series = [replace(one, unit=first.units[one.column]) for one in series]

    def _run(self, numbers: Mapping[str, float]) -> Recorded:
        """The run with fitted numbers; the last one is kept."""
        own = {name: value for name, value in numbers.items() if name in self._live}
        if self._known is None or self._known[0] != own:
            self._known = own, self._compute(own)
        return self._known[1]

    def _compute(self, numbers: Mapping[str, float]) -> Recorded:
        """The run with fitted numbers, except those that the experiment sets."""
        experiment = self._experiment
        how = {"method": experiment.method, "q": experiment.q, "v": experiment.v}
        # Runs with a constant step have no tolerance.
        how |= {"step": "auto"} if experiment.method == "rk4" else {"tolerance": experiment.tolerance}
        return self._with(numbers).simulate(duration=self._duration, output=self._output, verify=False, **how)

    def _with(self, numbers: Mapping[str, float]) -> "Crane":
        return self._crane.replace(**{name: value for name, value in numbers.items() if name in self._live})

    def _responses(self, run: Recorded, numbers: Mapping[str, float], order: int = 0) -> list[Array]:
        """Every series of a run at the times of the measurement, or its rate of change: at the start before its dead time."""
        found = []
        for one in self.series:
            t = self._times(one, numbers)
            response = self._spline(run.t, run[one.column])(np.clip(t, 0.0, run.t[-1]), order)
            found.append(np.where(t > 0, response, 0.0) if order else response)
        return found

    def _times(self, one: "Series", numbers: Mapping[str, float]) -> Array:
        """Times of the run that were measured later."""
        delay = self._delays[one.column]
        return one.at - (numbers[delay] if isinstance(delay, str) else delay)

    def values(self, numbers: Mapping[str, float]) -> Array:
        self._last = self._run(numbers)
        return np.concatenate(self._responses(self._last, numbers))

    def derivatives(self, numbers: Mapping[str, float], names: Sequence[str], steps: Mapping[str, float]) -> Array:
        slopes = np.zeros((sum(len(one.at) for one in self.series), len(names)))
        moved = [name for name in names if name in self._live]
        if moved:
            found = self._gradients(numbers, moved)
            slopes[:, [names.index(name) for name in moved]] = self._differences(numbers, moved, steps) if found is None else found
        if any(isinstance(delay, str) for delay in self._delays.values()):
            rates = self._responses(self._run(numbers), numbers, 1)
            first = 0
            for one, rate in zip(self.series, rates, strict=True):
                delay = self._delays[one.column]
                if delay in names:
                    slopes[first : first + len(rate), names.index(delay)] = -rate
                first += len(rate)
        return slopes

    def _gradients(self, numbers: Mapping[str, float], names: Sequence[str]) -> Array | None:
        """(values, names): derivatives along one run; None where runs have none."""
        experiment = self._experiment
        # A start with given rates at rest otherwise moves with the numbers, a given one does not.
        if experiment.method not in (None, "rosw4") or (experiment.v is not None and experiment.q is None):
            return None
        how = {"duration": self._duration, "output": self._output, "q": experiment.q, "v": experiment.v}
        if experiment.tolerance is not None:
            how["tolerance"] = LOOSER * experiment.tolerance
        try:
            run = self._with(numbers).simulate(verify=False, gradients=names, **how)
            found = [[run.gradient(one.column, name) for one in self.series] for name in names]
        except ValueError:
            return None
        times = [np.clip(self._times(one, numbers), 0.0, run.t[-1]) for one in self.series]
        columns = [np.concatenate([self._spline(run.t, slope)(t) for slope, t in zip(own, times, strict=True)]) for own in found]
        slopes = np.array(columns).T
        return slopes if np.isfinite(slopes).all() else None

    def _differences(self, numbers: Mapping[str, float], names: Sequence[str], steps: Mapping[str, float]) -> Array:
        """(values, names): differences over steps of which the square is far below the noise of runs."""
        here = np.concatenate(self._responses(self._run(numbers), numbers))
        places = [{**numbers, name: numbers[name] + steps[name]} for name in names]

        def response(place: Mapping[str, float]) -> Array:
            return np.concatenate(self._responses(self._compute(place), place))

        if len(places) * self._run(numbers).wall_time < WORTH_THREADS:
            rows = [response(place) for place in places]
        else:
            pool = ThreadPoolExecutor(max(_native.threads(), 1))
            try:
                rows = list(pool.map(response, places))
            finally:
                pool.shutdown(cancel_futures=True)
        slopes = [(row - here) / steps[name] for name, row in zip(names, rows, strict=True)]
        return np.array(slopes).T.reshape(-1, len(names))

    def cautions(self) -> list[str]:
        return [] if self._last is None else [f"{self._experiment.name}: {caution}" for caution in self._last.cautions]


def _interval(t: Array) -> float:
    """An interval of results on which the times of a measurement lie, if they are equally spaced, and which is short enough for splines."""
    step = float(np.min(np.diff(t)))
    step /= np.ceil(step / INTERVAL - 1e-9)
    return float(f"{step:.12g}")


def following(crane: "Crane", inputs: Mapping[str, Any], t: Array, named: str) -> "Crane":
    """The crane whose inputs follow measured values over time: a cubic spline, as for a `table` from a file."""
    if not inputs:
        return crane
    from .model import _load_again

    known = [of["name"] for of in crane.info["inputs"]]
    changed: dict[str, Any] = {}
    for name, given in inputs.items():
        if name not in known:
            raise ValueError(f"{named}: there is no input {name!r}: " + (f"write one of {', '.join(known)}" if known else "the spec has none"))
        times, values = given if isinstance(given, tuple) else (t, given)
        times, values = real_array(name, times), real_array(name, values)
        if times.ndim != 1 or times.shape != values.shape:
            raise ValueError(f"{named}: the input {name!r} has shape {values.shape}, and its times {times.shape}: give one value for each time")
        if len(times) > ROWS:
            raise ValueError(f"{named}: the input {name!r} has {len(times)} values, and a table at most {ROWS}: give fewer, as (times, values)")
        changed[name] = {"value": None, "motion": {"table": {"times": times.tolist(), "values": values.tolist(), "shape": "spline"}}}
    text = crane._changed({"inputs": changed})
    kept = {name: value for name, value in crane.inputs.items() if name not in inputs}
    return _load_again(crane.source, text, crane.parameters, kept)
