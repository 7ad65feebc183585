"""The result of a fit."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .notebook import embed
from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# Values below which neither correlations nor outliers of residuals mean much.
FEW = 20


@dataclass(frozen=True)
class SeriesFit:
    """A measured quantity beside what the fitted crane says.

    at: times of a run, s, else numbers of rows or of frequencies. measured, model: (values), in `unit`.
    noise: (values), standard deviations; noise_stated: whether they were stated, or are that of the residuals.
    """

    experiment: str
    column: str
    unit: str
    at: Array = field(repr=False)
    measured: Array = field(repr=False)
    model: Array = field(repr=False)
    noise: Array = field(repr=False)
    noise_stated: bool

    @property
    def residuals(self) -> Array:
        """(values): model − measurement."""
        return self.model - self.measured

    @property
    def rms(self) -> float:
        """Root mean square of the residuals."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def follows(self) -> float | None:
        """Correlation of successive residuals: near 0 for noise; None for too few values."""
        r = self.residuals / self.noise
        square = float(r @ r)
        return float(r[1:] @ r[:-1]) / square if len(r) >= FEW and square > 0 else None

    def outliers(self, deviations: float) -> list[str]:
        """Values whose residuals are beyond so many robust deviations, in words; at most three."""
        r = self.residuals / self.noise
        if len(r) < FEW:
            return []
        size = np.abs(r - np.median(r))
        # Half of the residuals of normal noise are within 0.6745 deviations.
        robust = max(float(np.median(size)) / 0.6745, 1e-300)
        worst = [place for place in np.argsort(size)[::-1][:3] if size[place] > deviations * robust]
        return [
            f"{self.experiment}: {self.column} = {self.measured[place]:.4g} {self.unit} at {self.at[place]:g} s is {size[place] / robust:.0f} deviations "
            "from the model: an outlier?"
            for place in worst
        ]


@dataclass(frozen=True)
class Band:
    """A number or an array with its 95 % interval.

    value: with the fitted numbers. low, high: ends of the interval; infinite where what is not known matters.
    draws: (draws, ...), what was computed with numbers drawn from the covariance; None for derivatives.
    """

    value: Any
    low: Any
    high: Any
    draws: Array | None = field(repr=False, default=None)


@dataclass(frozen=True)
class Fit(Mapping[str, float]):
    """Fitted numbers: `found["d_hook"]`; `print(found)` shows them all.

    names, units, estimates, start, bounds: (numbers), in the units of the parameters; dead times in s.
    deviations: (numbers), standard deviations; infinite where a number cannot be told apart from others, NaN at a bound.
    intervals: (numbers, 2), 95 % intervals from the covariance: of a normal distribution if the noise was stated and is the one that is there, else
    of Student's t. covariance: (numbers, numbers), without what is not known.
    indistinct: combinations of numbers that the measurements do not tell apart, in words; unknown: (numbers, combinations), these combinations.
    chi2: χ² per degree of freedom, over what has a stated noise if anything has; degrees: degrees of freedom, values less numbers; independent: as
    many as intervals have, fewer where residuals follow each other.
    status: "converged", "at a bound", "misfit" (residuals are far above the stated noise, or follow each other), "not identifiable" or "not converged":
    the worst that applies. cautions: all that is to be said about the fit. series: what was measured, and what the fitted crane says.
    crane: the crane with the fitted values. statistics: evaluations of all experiments, and of their derivatives.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    estimates: Array
    start: Array
    bounds: Array = field(repr=False)
    deviations: Array
    intervals: Array
    covariance: Array = field(repr=False)
    unknown: Array = field(repr=False)
    indistinct: list[str]
    at_bound: tuple[str, ...]
    chi2: float
    degrees: int
    independent: float = field(repr=False)
    noise_stated: bool
    quantile: float = field(repr=False)
    estimated: bool = field(repr=False)
    status: str
    cautions: list[str]
    series: tuple[SeriesFit, ...] = field(repr=False)
    crane: Crane = field(repr=False)
    statistics: dict[str, int] = field(repr=False)
    wall_time: float = field(repr=False)

    def __getitem__(self, name: str) -> float:
        return float(self.estimates[self._place(name)])

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def _place(self, name: str) -> int:
        if name not in self.names:
            raise KeyError(f"{name!r} was not fitted: write one of {', '.join(self.names)}")
        return self.names.index(name)

    def interval(self, name: str) -> tuple[float, float]:
        """The 95 % interval of a number."""
        low, high = self.intervals[self._place(name)]
        return float(low), float(high)

    @property
    def converged(self) -> bool:
        """Whether the fit has nothing to say against its values: `status` is "converged"."""
        return self.status == "converged"

    @property
    def correlations(self) -> Array:
        """(numbers, numbers): correlations; NaN for numbers at a bound or without an interval."""
        size = np.where(np.isfinite(self.deviations), np.sqrt(np.diag(self.covariance)), np.nan)
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.covariance / np.outer(size, size)

    def __repr__(self) -> str:
        found = ", ".join(f"{name}={value:.4g}" for name, value in self.items())
        return f"<fit of {self.crane.name}: {self.status}; {found}>"

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def page(self) -> str:
        """The fit as an HTML page that needs no network, to be written to a file: its numbers, and every measured quantity with residuals."""
        from .fit_page import page

        return page(self)

    def _repr_html_(self) -> str:
        """The page, for notebooks."""
        return embed(self.page(), f"fit of {self.crane.name}")

    def tables(self) -> tuple[list[tuple[str, ...]], list[tuple[str, ...]], list[str]]:
        """What `print` shows, as text: rows of the numbers and of what was measured, each with a head, and what else is to be said."""
        numbers = [("number", "value", "95 % from", "to", "±", "start", "unit")]
        for place, name in enumerate(self.names):
            low, high = self.intervals[place]
            value, deviation = self.estimates[place], self.quantile * self.deviations[place]
            known = np.isfinite(deviation)
            width = f"{100 * deviation / abs(value):.2g} %" if known and value != 0 else ("at a bound" if name in self.at_bound else "unknown")
            ends = (_shown(low), _shown(high)) if known else ("", "")
            numbers.append((name, _shown(value), *ends, width, _shown(self.start[place]), self.units[place]))
        measured = [("measured", "values", "rms of residuals", "noise", "", "unit")]
        for one in self.series:
            stated = "stated" if one.noise_stated else "estimated"
            measured.append((f"{one.experiment}: {one.column}", str(len(one.measured)), f"{one.rms:.2g}", _range(one.noise), stated, one.unit))
        words = [self._agreement()]
        words += [f"correlation of {one} and {other}: {correlation:+.3f}" for one, other, correlation in self._strong()]
        return numbers, measured, words

    def _agreement(self) -> str:
        """Whether residuals are as large as the noise."""
        values = sum(len(one.measured) for one in self.series)
        known = sum(len(one.measured) for one in self.series if one.noise_stated)
        if self.degrees == 0:
            return "no degrees of freedom: as many numbers as values, so nothing shows whether the model is right"
        if known == 0:
            return f"noise estimated from the residuals, {self.degrees} degrees of freedom"
        over = "" if known == values else f"; χ² is that of the {known} values with a stated noise"
        return f"χ² per degree of freedom {self.chi2:.3g}, {self.degrees} degrees of freedom{over}"

    def _lines(self) -> Iterator[str]:
        numbers, measured, words = self.tables()
        values = sum(len(one.measured) for one in self.series)
        yield f"{self.crane.name}: {len(self.names)} numbers fitted to {values} values: {self.status}"
        yield ""
        yield from _table(numbers)
        yield ""
        yield from _table(measured)
        yield ""
        yield from words
        yield from (f"caution: {caution}" for caution in self.cautions)

    def _strong(self) -> list[tuple[str, str, float]]:
        """Pairs of numbers with a correlation above 0.9."""
        found, count = self.correlations, len(self.names)
        pairs = ((i, j) for i in range(count) for j in range(i + 1, count))
        return [(self.names[i], self.names[j], float(found[i, j])) for i, j in pairs if abs(found[i, j]) > 0.9]

    def confidence(
        self, what: str | Callable[[Crane], ArrayLike], *, draws: int = 100, seed: int = 0, **parameters: float
    ) -> Band:
        """What the intervals of the fit mean for another number of the crane: its value with a 95 % interval.

        what: the name of an output of `Crane.sensitivity`, by its exact derivatives; `parameters` are of this crane, such as another payload. Or a
        function of a crane that returns a number or an array, such as a load chart or the largest swing of a run: it is computed with `draws` sets of
        numbers, drawn from the covariance and kept within their bounds; the interval has 2.5 % of the draws on either side.

        Where the output depends on combinations that are not known, its interval is infinite; a function cannot tell, and raises ValueError.
        """
        if isinstance(what, str):
            return self._propagated(what, parameters)
        if self.unknown.size:
            raise ValueError(f"numbers cannot be drawn: {'; '.join(self.indistinct)}: leave out one of them, or measure something that distinguishes them")
        if draws < 1:
            raise ValueError(f"draws={draws}: write how many sets of numbers are drawn, 1 or more")
        rng = np.random.default_rng(seed)
        values, vectors = np.linalg.eigh(self.covariance)
        normal = rng.standard_normal((draws, len(self.names)))
        if self.estimated and self.degrees > 0:
            normal *= np.sqrt(self.independent / rng.chisquare(self.independent, (draws, 1)))
        sets = np.clip(self.estimates + normal * np.sqrt(np.maximum(values, 0.0)) @ vectors.T, *self.bounds.T)
        live = [place for place, name in enumerate(self.names) if name in self.crane.parameters]
        computed = []
        for row in sets:
            drawn = {self.names[place]: float(row[place]) for place in live}
            try:
                computed.append(np.asarray(what(self.crane.replace(**{**drawn, **parameters})), dtype=float))
            except ValueError as error:
                listed = ", ".join(f"{name} = {value:.4g}" for name, value in drawn.items())
                raise ValueError(f"a draw cannot be computed, {listed}: {error}; give the fit bounds that keep its numbers where they are allowed") from error
        results = np.stack(computed)
        low, high = np.percentile(results, [2.5, 97.5], axis=0)
        value = np.asarray(what(self.crane.replace(**parameters)), dtype=float)
        return Band(_plain(value), _plain(low), _plain(high), results)

    def _propagated(self, output: str, parameters: dict[str, float]) -> Band:
        """An output at rest: variance gᵀ C g, with its exact derivatives g."""
        live = [name for name in self.names if name in self.crane.parameters and name not in parameters]
        order = int(output.removeprefix("frequency_")) if output.removeprefix("frequency_").isdecimal() else 3
        found = self.crane.replace(**parameters).sensitivity(live or list(self.crane.parameters)[:1], frequencies=max(order, 3))
        gradient = np.zeros(len(self.names))
        for name in live:
            gradient[self._place(name)] = found.derivative(output, name)
        if output not in found.outputs:
            raise KeyError(f"there is no output {output!r}: write one of {', '.join(found.outputs)}")
        value = float(found.values[found.outputs.index(output)])
        half = self.quantile * float(np.sqrt(gradient @ self.covariance @ gradient))
        # A combination that is not known matters if a change of it by the size of the numbers does, beyond rounding.
        if np.any(np.abs(gradient @ self.unknown) > 1e-3 * np.linalg.norm(gradient * self.estimates)):
            half = np.inf
        return Band(value, value - half, value + half)


def _plain(numbers: NDArray[Any]) -> Any:
    """A number as a float."""
    return float(numbers) if np.ndim(numbers) == 0 else numbers


def _range(numbers: Array) -> str:
    """Numbers that are alike as one, others by their range."""
    low, high = float(np.min(numbers)), float(np.max(numbers))
    return f"{low:.2g}" if high - low < 1e-9 * high else f"{low:.2g}–{high:.2g}"


def _shown(number: float) -> str:
    return f"{number:.5g}"


def _table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    """Rows with columns of equal width: words to the left, numbers to the right."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    words = {0, len(widths) - 1}
    for row in rows:
        cells = (cell.ljust(width) if column in words else cell.rjust(width) for column, (cell, width) in enumerate(zip(row, widths, strict=True)))
        yield ("  " + "  ".join(cells)).rstrip()
