"""Fatigue of beams by runs that repeat."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from . import _native
from .results import Array, Run


class Cycle(NamedTuple):
    """A cycle of stress of one repetition: the index of its manoeuvre, range and mean, Pa, how often it occurs, times of both ends, s, and its part of
    the damage by all repetitions."""

    manoeuvre: int
    range: float
    mean: float
    count: float
    start: float
    end: float
    part: float


@dataclass(frozen=True)
class Fatigue:
    """What runs that repeat do to every place of beams, at the point of its contour that suffers most.

    beams, x (m from the beginning of the beam), places (in words): where. category: ranges that details endure 2e6 times, divided by the safety
    factor, Pa. damage: by all repetitions; at 1 the life is over. parts: (places, manoeuvres), the damage by each. largest_range: Pa.
    history_parameter: `s = Σ (range/largest range)^m n/2e6`. histories: of each manoeuvre (times, places), stresses, Pa.
    """

    beams: tuple[str, ...]
    x: Array
    places: tuple[str, ...]
    category: Array
    damage: Array
    parts: Array
    largest_range: Array
    history_parameter: Array
    histories: tuple[Array, ...] = field(repr=False)
    _cycles: tuple[tuple[Cycle, ...], ...] = field(repr=False)

    @property
    def worst(self) -> int:
        """Index of the place with the greatest damage."""
        return int(np.argmax(self.damage))

    @property
    def life(self) -> Array:
        """How often all repetitions of all manoeuvres may be gone through until the damage is 1; infinite where there is none."""
        with np.errstate(divide="ignore"):
            return 1.0 / self.damage

    def cycles(self, place: int | None = None) -> tuple[Cycle, ...]:
        """The cycles at a place, those that do most damage first; by default where the damage is greatest."""
        return self._cycles[self.worst if place is None else place]


def fatigue(
    manoeuvres: Run | Sequence[tuple[Run, float]],
    category: float | str | Mapping[str, float | str],
    *,
    slope: float = 3.0,
    safety_factor: float = 1.0,
) -> Fatigue:
    """Cycles of stress of beams by runs that repeat, counted by rainflow, and the damage that they do, as `crane fatigue` computes it.

    manoeuvres: runs of one crane with how often each is repeated, as in `[(loaded, 20_000), (empty, 20_000)]`; a run alone counts once. They may have other
    motions, loads and parameters. Each repeats on its own: changes from one to another do not count. category: range of nominal stress that a
    detail endures 2e6 times, in Pa or as "71 MPa"; one for all beams, or by their names. slope: m of the curve of strength. safety_factor: divides
    all categories.
    """
    given = [(manoeuvres, 1.0)] if isinstance(manoeuvres, Run) else list(manoeuvres)
    for entry in given:
        if not (isinstance(entry, tuple) and len(entry) == 2 and isinstance(entry[0], Run)):
            raise TypeError("manoeuvres: write a run, or a list of runs with how often each is repeated, as in [(run, 20_000)]")
    categories = list(category.items()) if isinstance(category, Mapping) else [(None, category)]
    runs = [(run.crane, run.table, float(repetitions)) for run, repetitions in given]
    found = _native.fatigue_of(runs, categories, float(slope), float(safety_factor))
    if not found:
        raise ValueError("no beam has a section whose stresses are known: give the beam a `section` such as `box`, with its sizes")

    def of_place(place: tuple[str, float, str, float, float, list[tuple[float, list[float], list[list[float]]]]]) -> tuple[Cycle, ...]:
        of_category, parts = place[3], place[5]
        whole = sum(damage for damage, _, _ in parts)
        cycles = []
        for index, ((_, _, own), (_, _, repetitions)) in enumerate(zip(parts, runs, strict=True)):
            for size, mean, count, start, end in own:
                damage = repetitions * count * (size / of_category) ** slope / 2e6
                cycles.append(Cycle(index, size, mean, count, start, end, damage / whole if whole > 0 else 0.0))
        return tuple(sorted(cycles, key=lambda cycle: -cycle.part))

    cycles = tuple(of_place(place) for place in found)
    parts = np.array([[damage for damage, _, _ in place[5]] for place in found])
    return Fatigue(
        tuple(place[0] for place in found),
        np.array([place[1] for place in found]),
        tuple(place[2] for place in found),
        np.array([place[3] for place in found]),
        parts.sum(axis=1),
        parts,
        np.array([max((cycle.range for cycle in own), default=0.0) for own in cycles]),
        np.array([place[4] for place in found]),
        tuple(np.array([place[5][index][1] for place in found]).T for index in range(len(runs))),
        cycles,
    )
