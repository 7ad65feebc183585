"""Series of measured values, with their noise."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._native import real_array
from .results import Array

if TYPE_CHECKING:
    from .model import Crane


@dataclass(frozen=True)
class Series:
    """A measured quantity of an experiment: its values, their noise, and where they were taken.

    experiment, column, unit: names. at: (values), times of a run, s, else the number of the row or the order of the frequency.
    measured: (values). noise: (values), standard deviations; None where they are not known.
    """

    experiment: str
    column: str
    unit: str
    at: Array = field(repr=False)
    measured: Array = field(repr=False)
    noise: Array | None = field(repr=False)


def under(experiment: Any, crane: "Crane", inputs: Mapping[str, float]) -> "Crane":
    """The crane under the conditions of an experiment."""
    try:
        return crane.replace(inputs=dict(inputs) if inputs else None, **experiment.parameters)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{experiment.name}: {error}") from None


def noise_of(experiment: Any, column: str, count: int) -> Array | None:
    """(values): the standard deviations of a column, None where they are not known."""
    noise = experiment.noise.get(column) if isinstance(experiment.noise, Mapping) else experiment.noise
    if noise is None:
        return None
    deviations = real_array("noise", noise)
    if deviations.ndim > 1 or (deviations.ndim == 1 and len(deviations) != count):
        raise ValueError(f"{experiment.name}: noise of {column} has shape {deviations.shape}: give one standard deviation, or {count}")
    if not np.isfinite(deviations).all() or np.any(deviations <= 0):
        raise ValueError(f"{experiment.name}: noise of {column} is {noise}: write standard deviations above 0, or None if they are not known")
    return np.broadcast_to(deviations, count)


def check_noise_names(experiment: Any, columns: list[str]) -> None:
    """Refuses the noise of what was not measured."""
    for name in experiment.noise if isinstance(experiment.noise, Mapping) else ():
        if name not in columns:
            raise ValueError(f"{experiment.name}: noise of {name!r}, which is not among what was measured: {', '.join(columns)}")
