"""Which numbers a measurement can tell apart: singular vectors of a scaled Jacobian, and what they mean in words."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from .results import Array

# A combination is unknown if its 95 % interval is wider than the numbers themselves, upward and downward.
UNKNOWN = 1.0
# Parts of a singular vector below this one are errors of the derivatives, or of no interest.
PART = 0.05
# How far numbers are moved, in proportion, to try whether a law about them holds beyond small changes.
MOVED = 0.2
# Growth of χ² at which such a law is refused: a thousandth of what moving a number alone causes.
ALIKE = 1e-3


@dataclass(frozen=True)
class Directions:
    """Singular values and vectors of a Jacobian J, (values, numbers), whose rows are divided by their noise: J diag(scales) = U diag(s) Vᵀ.

    A combination `vᵢ` of numbers, relative to their scales, has the standard deviation 1/sᵢ.
    known: which ones are known better than by their scales and beyond the errors of the derivatives.
    """

    scales: Array
    singular_values: Array
    vectors: Array
    known: Array = field(repr=False)

    @property
    def covariance(self) -> Array:
        """(numbers, numbers): covariance of the numbers, C = S V diag(1/s²) Vᵀ S over what is known."""
        root = self.scales[:, None] * self.vectors[:, self.known] / self.singular_values[self.known]
        return root @ root.T

    @property
    def unknown(self) -> Array:
        """(numbers, combinations): orthonormal combinations, relative to the scales, that are not known."""
        return self.vectors[:, ~self.known]

    def involved(self) -> Array:
        """(numbers): whether a number is part of a combination that is not known."""
        return np.any(np.abs(self.unknown) > PART, axis=1)


def directions(jacobian: Array, scales: Array, accuracy: float, widening: float) -> Directions:
    """Decomposes a Jacobian. accuracy: relative, of its entries; widening: from standard deviations to half a 95 % interval."""
    # Rows of zeros, where there are fewer values than numbers, so that every combination has its singular value.
    missing = np.zeros((max(len(scales) - len(jacobian), 0), len(scales)))
    _, singular_values, vectors = np.linalg.svd(np.vstack([jacobian * scales, missing]), full_matrices=False)
    floor = accuracy * max(singular_values[0], 1e-300) if len(singular_values) else 0.0
    known = (singular_values > floor) & (singular_values * UNKNOWN > widening)
    return Directions(scales, singular_values, vectors.T, known)


def describe(found: Directions, names: Sequence[str], values: Array, misfit: Callable[[Array], float]) -> list[str]:
    """What is not known, in words: laws of two numbers by name if they hold beyond small changes.

    misfit: χ² with given numbers; infinite where the crane cannot be computed.
    """
    size = np.where(values != 0.0, np.abs(values), found.scales)
    # In proportion to the numbers, and each combination in as few of them as possible.
    combinations = _sparse(found.unknown * (found.scales / size)[:, None])
    return [_words(combination, names, values, size, misfit) for combination in combinations.T]


def _sparse(vectors: Array) -> Array:
    """Combinations of the columns that contain few rows each: reduced by elimination with pivots."""
    rows = vectors.T.copy()
    for place in range(len(rows)):
        pivot = int(np.argmax(np.max(np.abs(rows[place:]), axis=1))) + place
        rows[[place, pivot]] = rows[[pivot, place]]
        column = int(np.argmax(np.abs(rows[place])))
        rows[place] /= rows[place, column]
        for other in range(len(rows)):
            if other != place:
                rows[other] -= rows[other, column] * rows[place]
    return (rows / np.max(np.abs(rows), axis=1, keepdims=True)).T if len(rows) else vectors


def _words(combination: Array, names: Sequence[str], values: Array, size: Array, misfit: Callable[[Array], float]) -> str:
    """One combination that is not known."""
    parts = [int(place) for place in np.flatnonzero(np.abs(combination) > PART)]
    if len(parts) == 1:
        return f"{names[parts[0]]} not at all: nothing that was measured depends on it enough"
    if len(parts) == 2:
        law = _law(combination, parts, names, values, size, misfit)
        if law:
            return f"{names[parts[0]]} and {names[parts[1]]} only as {law}"
    listed = ", ".join(names[place] for place in parts[:-1]) + f" and {names[parts[-1]]}"
    if np.ptp(combination[parts]) < PART * np.max(np.abs(combination)):
        return f"{listed} only as their ratios: changing all of them by the same factor changes nothing that can be seen"
    changes = ", ".join(f"{names[place]} by {combination[place]:+.2g} %" for place in parts)
    return f"{listed} only together: changing {changes} changes nothing that can be seen"


def _law(combination: Array, parts: list[int], names: Sequence[str], values: Array, size: Array, misfit: Callable[[Array], float]) -> str | None:
    """A product, ratio, sum or difference of two numbers that alone is known, if one holds beyond small changes."""
    a, b = parts
    here = misfit(values)

    def moved(one: float, other: float) -> float:
        place = values.copy()
        place[a], place[b] = one, other
        return misfit(place) - here

    change = 1.0 + MOVED
    alone = min(moved(values[a] * change, values[b]), moved(values[a], values[b] * change))
    laws = []
    for m, n in product((1, 2, 3), repeat=2):
        # aᵐ bⁿ stays the same if a grows by a factor of cⁿ and b falls by cᵐ.
        if np.gcd(m, n) == 1:
            for sign in (1, -1):
                if abs(combination[a] * m + sign * combination[b] * n) < 2 * PART * max(m, n):
                    # The larger exponent moves by the whole change.
                    c = change ** (1.0 / max(m, n))
                    laws.append((moved(values[a] * c**n, values[b] * c ** (-sign * m)), _power_law(names[a], m, names[b], sign * n)))
    steps = combination[a] * size[a], combination[b] * size[b]
    for sign, word in ((1, f"their sum {names[a]} + {names[b]}"), (-1, f"their difference {names[a]} − {names[b]}")):
        if abs(steps[0] + sign * steps[1]) < 2 * PART * max(map(abs, steps)):
            step = MOVED * min(abs(values[a]), abs(values[b]))
            laws.append((moved(values[a] + step, values[b] - sign * step), word))
    fitting = [law for law in laws if law[0] < max(ALIKE * alone, 1e-6)]
    return min(fitting)[1] if fitting else None


def _power_law(a: str, m: int, b: str, n: int) -> str:
    """A product of powers."""
    powers = {1: "", 2: "²", 3: "³"}
    text = f"{a}{powers[m]}{' · ' if n > 0 else '/'}{b}{powers[abs(n)]}"
    if m == abs(n) == 1:
        return f"their product {text}" if n > 0 else f"their ratio {text}"
    return text
