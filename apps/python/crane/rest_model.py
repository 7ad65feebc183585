"""Cranes at rest that are compared with measurements: outputs of `Crane.sensitivity`, with their exact derivatives."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._native import real_array
from .results import Array, Sensitivity
from .series import Series, check_noise_names, noise_of, under

if TYPE_CHECKING:
    from .experiments import Statics
    from .model import Crane

# Begins the names of frequencies among the outputs.
FREQUENCY = "frequency_"


class RestModel:
    """Outputs of `Crane.sensitivity`, with exact derivatives."""

    accuracy = 1e-9

    def __init__(self, experiment: "Statics", crane: "Crane", modes: bool = False) -> None:
        if not experiment.values:
            raise ValueError(f"{experiment.name}: there are no values: give what was measured by name")
        self._experiment = experiment
        self._crane = under(experiment, crane, experiment.inputs)
        self._rows = int(np.prod(self._crane.shape, dtype=int))
        if len(self._crane.shape) > 1:
            raise ValueError(f"{experiment.name}: its parameters have {len(self._crane.shape)} axes: give lists of one axis")
        self._columns = list(experiment.values)
        check_noise_names(experiment, self._columns)
        coordinates = set(crane.coordinates) if modes else set()
        orders = [int(name.removeprefix(FREQUENCY)) for name in self._columns if name.removeprefix(FREQUENCY).isdecimal()]
        self._frequencies = max([3, *orders, crane.n if coordinates & set(self._columns) else 0])
        self._by_shape = coordinates & set(self._columns)
        self._known: tuple[Any, Array, Array] | None = None
        live = [name for name in crane.parameters if name not in experiment.parameters]
        first = self._at({}, live[:1])
        units = dict(zip(first.outputs, first.units, strict=True))
        self.series = []
        for column in self._columns:
            measured = np.atleast_1d(real_array(column, experiment.values[column]))
            if measured.shape != (self._rows,):
                raise ValueError(f"{experiment.name}: {column} has shape {measured.shape}, and there are {self._rows} rows of parameters")
            if not np.isfinite(measured).all():
                raise ValueError(f"{experiment.name}: {column} is {measured}: write finite numbers")
            output = self._output(first, column, 0)
            at = np.full(1, float(output + 1)) if modes else np.arange(self._rows, dtype=float)
            self.series.append(Series(experiment.name, column, units[first.outputs[output]], at, measured, noise_of(experiment, column, self._rows)))

    def _at(self, numbers: Mapping[str, float], names: Sequence[str], reference: Mapping[str, float] | None = None) -> Sensitivity:
        """The sensitivity with fitted numbers, except those that the experiment sets."""
        own = {name: value for name, value in numbers.items() if name in self._crane.parameters and name not in self._experiment.parameters}
        # Of a crane without live parameters that move, any one does: only values are used.
        asked = list(names) or list(self._crane.parameters)[:1]
        return self._crane.replace(**{**own, **(reference or {})}).sensitivity(asked, frequencies=self._frequencies)

    def _output(self, found: Sensitivity, column: str, row: int) -> int:
        """The place of an output by its name, or by the coordinate that dominates it."""
        if column in found.outputs and column not in self._by_shape:
            return found.outputs.index(column)
        places = found.places if found.places.ndim == 1 else found.places[row]
        modes = [index for index, name in enumerate(found.outputs) if name.startswith(FREQUENCY)]
        if column in self._by_shape:
            leading = [places[index].split(", ")[0] for index in modes]
            if column in leading:
                return modes[leading.index(column)]
            raise ValueError(f"{self._experiment.name}: no mode is dominated by {column!r}; those of this crane by {', '.join(leading)}")
        raise KeyError(f"{self._experiment.name}: there is no output {column!r} at rest: write one of {', '.join(found.outputs)}")

    def _of(self, found: Sensitivity, names: Sequence[str], moved: Sequence[str]) -> tuple[Array, Array]:
        """Values of the series, (values), and derivatives, (values, names)."""
        outputs = len(found.outputs)
        values = np.broadcast_to(found.values, (self._rows, outputs)) if found.values.ndim == 1 else found.values
        slopes = np.broadcast_to(found.derivatives, (self._rows, *found.derivatives.shape[-2:]))
        places = [(row, self._output(found, column, row)) for column in self._columns for row in range(self._rows)]
        rows, columns = np.array(places).T
        all_slopes = np.zeros((len(places), len(names)))
        for place, name in enumerate(names):
            if name in moved:
                all_slopes[:, place] = slopes[rows, columns, list(moved).index(name)]
        return values[rows, columns], all_slopes

    def _both(self, numbers: Mapping[str, float], names: Sequence[str]) -> tuple[Array, Array]:
        """Values and derivatives; the last ones are kept."""
        key = (tuple(sorted(numbers.items())), tuple(names))
        if self._known is None or self._known[0] != key:
            moved = [name for name in names if name in self._crane.parameters and name not in self._experiment.parameters]
            values, slopes = self._of(self._at(numbers, moved), names, moved)
            if self._experiment.reference is not None:
                reference = self._experiment.reference
                there = [name for name in moved if name not in reference]
                other, other_slopes = self._of(self._at(numbers, there, reference), names, there)
                values, slopes = values - other, slopes - other_slopes
            self._known = (key, values, slopes)
        return self._known[1:]

    def values(self, numbers: Mapping[str, float]) -> Array:
        return self._both(numbers, [*numbers])[0]

    def derivatives(self, numbers: Mapping[str, float], names: Sequence[str], steps: Mapping[str, float]) -> Array:
        slopes = self._both(numbers, [*numbers])[1]
        return slopes[:, [list(numbers).index(name) for name in names]]

    def cautions(self) -> list[str]:
        return []
