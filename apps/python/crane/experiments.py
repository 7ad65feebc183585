"""Measurements of a crane, for `crane.fit`: what was measured, under which conditions, and how exactly.

>>> import crane
>>> weighed = crane.experiments.Statics({"load_centre_z": -1.06}, noise=0.002, parameters={"payload": 800})
>>> rung = crane.experiments.Frequencies([0.46, None, 5.1], noise=0.01)

Every experiment may set live parameters and inputs of its own, which then are not fitted in it. Noise is a standard deviation in the unit of
the measured quantity: one number, one for every value, or either of these by name. Where it is not given, the fit estimates it from the residuals of each quantity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .rest_model import FREQUENCY, RestModel
from .results import Array
from .run_model import RunModel, following
from .series import Series, check_noise_names, noise_of, under

if TYPE_CHECKING:
    from .model import Crane

Noise = ArrayLike | Mapping[str, ArrayLike | None] | None


class Model(Protocol):
    """An experiment of a certain crane: what the crane says to what was measured."""

    series: list[Series]
    # Relative accuracy of the derivatives.
    accuracy: float

    def values(self, numbers: Mapping[str, float]) -> Array:
        """All series, one after the other, with these numbers."""

    def derivatives(self, numbers: Mapping[str, float], names: Sequence[str], steps: Mapping[str, float]) -> Array:
        """(values, names): their derivatives; `steps` are those of differences."""

    def cautions(self) -> list[str]:
        """What the last computation says about itself."""


@dataclass(frozen=True)
class Statics:
    """Values of a crane at rest.

    values: measured numbers by name, of all outputs of `Crane.sensitivity`: positions of points, efforts of drives, pressures, reactions,
    stresses, frequencies, … A number each, or one for every row of `parameters`.
    noise: standard deviation, or one by name. parameters, inputs: of this experiment; parameters may be arrays of one axis.
    reference: parameters of another state, from which the values are differences: a deflection under a load of 500 kg is that from
    {"payload": 0} to {"payload": 500}.
    """

    values: Mapping[str, ArrayLike]
    noise: Noise = None
    parameters: Mapping[str, ArrayLike] = field(default_factory=dict)
    inputs: Mapping[str, float] = field(default_factory=dict)
    reference: Mapping[str, float] | None = None
    name: str = "statics"

    def model_of(self, crane: Crane, fitted: Sequence[str]) -> Model:
        """What a crane says to it."""
        return RestModel(self, crane)

    def delays(self) -> set[str]:
        """Names of dead times."""
        return set()


@dataclass(frozen=True)
class Frequencies:
    """Natural frequencies at rest, undamped, Hz.

    values: the lowest ones in order, None or NaN for those that were not measured; or by name: of the coordinate that dominates the mode, as
    `Crane.modes` names it, the lowest such mode counts, or "frequency_2" by order.
    noise, parameters, inputs: as for `Statics`, without arrays.
    """

    values: Sequence[float | None] | Mapping[str, float]
    noise: Noise = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[str, float] = field(default_factory=dict)
    name: str = "frequencies"

    def model_of(self, crane: Crane, fitted: Sequence[str]) -> Model:
        """What a crane says to it."""
        values = self.values
        if not isinstance(values, Mapping):
            ordered = [np.nan if value is None else float(value) for value in values]
            values = {f"{FREQUENCY}{order}": value for order, value in enumerate(ordered, 1) if np.isfinite(value)}
        return RestModel(Statics(values, self.noise, self.parameters, self.inputs, name=self.name), crane, modes=True)

    def delays(self) -> set[str]:
        """Names of dead times."""
        return set()


@dataclass(frozen=True)
class Run:
    """Columns of a run over time.

    t: times of the measurement, s, from the start of the run; increasing. columns: measured values by the names of the columns of
    `Crane.simulate`, NaN where one is missing. noise: standard deviation, or one by column.
    parameters: of this run. inputs: by name, a number, an array over t, or a pair of arrays, times and values; between these a
    cubic spline, as for a `table` from a file. q, v: start; the static equilibrium at rest unless given.
    dead_time: by which the crane's response is delayed, s: a number, the name of a fitted number, or one of these by column. Before its beginning
    the response is that at the start.
    tolerance, method, output: of the runs, as for `Crane.simulate`.
    """

    t: ArrayLike
    columns: Mapping[str, ArrayLike]
    noise: Noise = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[str, Any] = field(default_factory=dict)
    q: ArrayLike | None = None
    v: ArrayLike | None = None
    dead_time: float | str | Mapping[str, float | str] = "dead_time"
    tolerance: float | None = 1e-8
    method: str | None = None
    output: float | None = None
    name: str = "run"

    def __post_init__(self) -> None:
        # Of a data frame, too.
        object.__setattr__(self, "columns", {str(name): self.columns[name] for name in self.columns})

    def model_of(self, crane: Crane, fitted: Sequence[str]) -> Model:
        """What a crane says to it."""
        t = real_array("t", self.t)
        if t.ndim != 1 or len(t) < 2 or not np.all(np.diff(t) > 0) or not np.isfinite(t).all() or t[0] < 0:
            raise ValueError(f"{self.name}: t must be at least two times from 0 on that increase, s")
        if not self.columns:
            raise ValueError(f"{self.name}: there are no columns: give what was measured, as in {{'boom_psi': [...]}}")
        series = []
        for column, given in self.columns.items():
            measured = real_array(column, given)
            if measured.shape != t.shape:
                raise ValueError(f"{self.name}: {column} has shape {measured.shape}, and t {t.shape}: give one value for each time")
            there = ~np.isnan(measured)
            if not there.any() or np.isinf(measured).any():
                raise ValueError(f"{self.name}: {column} holds {'infinite values' if there.any() else 'no values'}: write finite numbers, NaN where one is missing")
            noise = noise_of(self, column, len(t))
            series.append(Series(self.name, column, "", t[there], measured[there], None if noise is None else noise[there]))
        check_noise_names(self, list(self.columns))
        crane = under(self, crane, {name: value for name, value in self.inputs.items() if np.ndim(value) == 0 and not isinstance(value, tuple)})
        over_time = {name: value for name, value in self.inputs.items() if name not in crane.inputs}
        crane = following(crane, over_time, t, self.name)
        return RunModel(self, crane, series, {column: self._delay(column, crane, fitted) for column in self.columns})

    def delays(self) -> set[str]:
        """Names of dead times."""
        given = self.dead_time.values() if isinstance(self.dead_time, Mapping) else [self.dead_time]
        return {name for name in given if isinstance(name, str)}

    def _delay(self, column: str, crane: Crane, fitted: Sequence[str]) -> float | str:
        """The dead time of a column: a number, or the name of a fitted one."""
        if isinstance(self.dead_time, Mapping):
            for name in self.dead_time:
                if name not in self.columns:
                    raise ValueError(f"{self.name}: dead_time names {name!r}, which is not among the columns: {', '.join(self.columns)}")
            delay = self.dead_time.get(column, 0.0)
        else:
            delay = self.dead_time
        if not isinstance(delay, str):
            return float(delay)
        if delay in fitted and delay not in crane.parameters:
            return delay
        if delay == "dead_time":
            return 0.0
        raise ValueError(f"{self.name}: the dead time {delay!r} is not among the numbers to fit: add {delay!r}: (0, 0.2), or give a number")


Experiment = Statics | Frequencies | Run
