"""What a fit is to solve: numbers with bounds and scales, experiments, and the noise that is assumed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .experiments import Model
from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# Steps of differences, relative to the value of a number: the errors of runs, 1e-8, and what is nonlinear are then both some thousandths of a derivative.
STEP = 3e-4


def scipy() -> ModuleType:
    """SciPy with its parts for fits; ImportError says what to install."""
    try:
        import scipy
        import scipy.interpolate
        import scipy.optimize
        import scipy.special
    except ImportError as error:
        raise ImportError("fits need SciPy: pip install 'crane[fit]'") from error
    return scipy


@dataclass
class Problem:
    """What is to be fitted: numbers p = scales · z, experiments, and the noise that is assumed at present."""

    crane: "Crane"
    names: list[str]
    units: list[str]
    start: Array
    lower: Array
    upper: Array
    scales: Array
    models: list[Model]
    noise: Array = field(init=False)
    failure: Exception | None = None
    evaluations: int = 0
    jacobians: int = 0

    def __post_init__(self) -> None:
        self.series = [one for model in self.models for one in model.series]
        self.measured = np.concatenate([one.measured for one in self.series])
        ends = np.cumsum([len(one.measured) for one in self.series])
        self.rows = [slice(end - len(one.measured), end) for one, end in zip(self.series, ends, strict=True)]
        self.stated = np.array([one.noise is not None for one in self.series])

    @classmethod
    def of(cls, crane: "Crane", numbers: Mapping[str, Any], experiments: Any) -> "Problem":
        """Checks what is asked for."""
        scipy()
        if crane.shape:
            raise ValueError("the parameters of the crane are arrays: a fit begins at one value of each")
        experiments = list(experiments) if isinstance(experiments, Sequence) else [experiments]
        if not experiments or not numbers:
            raise ValueError(f"there are no {'numbers' if experiments else 'experiments'}: a fit needs at least one of each")
        delays = set().union(*(experiment.delays() for experiment in experiments))
        info = {of["name"]: of for of in crane.info["parameters"]}
        names = list(numbers)
        for name in names:
            if name not in info and name not in delays:
                raise ValueError(
                    f"{crane.name} has no live parameter {name!r}, and no run has a dead time of this name: write one of {', '.join([*info, *sorted(delays)])}, "
                    "or make a number of the spec live under `parameters:`"
                )
        bounds = [_bounds(name, numbers[name], name in info) for name in names]
        lower, upper = np.array(bounds).T
        start = np.array([crane.parameters[name] if name in info else _middle(*own) for name, own in zip(names, bounds, strict=True)])
        for name, value, least, greatest in zip(names, start, lower, upper, strict=True):
            if not least <= value <= greatest:
                raise ValueError(f"{name} begins at {value:g}, outside its bounds from {least:g} to {greatest:g}: begin within them, with crane.replace({name}=…)")
        models = _named([experiment.model_of(crane, names) for experiment in experiments])
        width = upper - lower
        scales = np.where(start != 0.0, np.abs(start), np.where(np.isfinite(width), width, 0.0))
        for place, name in enumerate(names):
            if scales[place] == 0.0:
                if name in info:
                    raise ValueError(f"{name} begins at 0: give it bounds, from which its size follows, or begin at another value")
                scales[place] = 0.05
        units = [info[name]["unit"] if name in info else "s" for name in names]
        return cls(crane, names, units, start, lower, upper, scales, models)

    @property
    def accuracy(self) -> float:
        """Relative accuracy of the derivatives."""
        return max(model.accuracy for model in self.models)

    def sizes(self, p: Array) -> Array:
        """Scales of numbers in whose proportion combinations are judged."""
        return np.maximum(np.abs(p), self.scales)

    def at_bound(self, p: Array, slope: Array) -> NDArray[np.bool_]:
        """Which numbers are held by a bound, where χ² falls beyond it; slope: half the derivatives of χ²."""
        near = 1e-3 * self.scales
        return ((p - self.lower < near) & (slope > 0)) | ((self.upper - p < near) & (slope < 0))

    def values(self, p: Array) -> Array:
        """What the crane says to all measurements."""
        self.evaluations += 1
        numbers = dict(zip(self.names, p.tolist(), strict=True))
        return np.concatenate([model.values(numbers) for model in self.models])

    def residuals(self, p: Array) -> Array:
        """(model − measurement)/noise, NaN where the crane cannot be computed."""
        try:
            return (self.values(p) - self.measured) / self.noise
        except (ValueError, RuntimeError, ArithmeticError) as failure:
            self.failure = failure
            return np.full(len(self.measured), np.nan)

    def jacobian(self, p: Array) -> Array:
        """(values, numbers): derivatives of the residuals."""
        self.jacobians += 1
        numbers = dict(zip(self.names, p.tolist(), strict=True))
        steps = STEP * np.maximum(np.abs(p), 0.1 * self.scales)
        # Downward where a bound leaves no room above.
        steps = np.where(p + steps > self.upper, -steps, steps)
        ends = dict(zip(self.names, steps.tolist(), strict=True))
        try:
            slopes = [model.derivatives(numbers, self.names, ends) for model in self.models]
        except (ValueError, RuntimeError, ArithmeticError) as failure:
            listed = ", ".join(f"{name} = {value:.6g}" for name, value in numbers.items())
            raise type(failure)(f"no derivatives at {listed}: {failure}; give the fit bounds that keep its numbers where they are allowed") from failure
        return np.concatenate(slopes) / self.noise[:, None]


def _bounds(name: str, given: Any, live: bool) -> tuple[float, float]:
    """Bounds of a number, infinite where there are none; dead times are not negative."""
    if given is None:
        return (-np.inf if live else 0.0, np.inf)
    if np.ndim(given) != 1 or len(given) != 2:
        raise ValueError(f"{name}: {given!r}: write (minimum, maximum), or None")
    least, greatest = (-np.inf if given[0] is None else float(given[0])), (np.inf if given[1] is None else float(given[1]))
    if not least < greatest:
        raise ValueError(f"{name}: its bounds {least:g} and {greatest:g} do not increase: write (minimum, maximum)")
    return least, greatest


def _middle(least: float, greatest: float) -> float:
    """Where a dead time begins."""
    return (least + greatest) / 2 if np.isfinite(least + greatest) else max(least, 0.0)


def _named(models: list[Model]) -> list[Model]:
    """The models, whose experiments have different names: "run 1", "run 2" instead of "run" twice."""
    names = [model.series[0].experiment for model in models]
    for place, model in enumerate(models):
        if names.count(names[place]) > 1:
            number = names[: place + 1].count(names[place])
            model.series = [replace(one, experiment=f"{names[place]} {number}") for one in model.series]
    return models
