"""Fits of live parameters to measurements, by least squares with exact derivatives where there are any."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from .experiments import Experiment, Model
from .fit_result import Fit, SeriesFit
from .identifiability import Directions, describe, directions
from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# Steps of differences, relative to the scale of a number: far above the errors of runs, 1e-8, and their square far below 1.
STEP = 1e-4
# A fit has converged if another step of Gauss and Newton would move no combination of numbers by more than this part of its deviation.
REMAINING = 0.1
# Estimates of noise are repeated until they change by less than this part.
SAME_NOISE = 0.01
ROUNDS = 8
# A residual is an outlier beyond this many robust deviations.
OUTLIER = 6.0
# χ² per degree of freedom above which residuals are far above the stated noise, if they are so significantly.
FAR_ABOVE = 1.5
# Correlation of successive residuals of a run above which they are no noise, and above which that is mentioned.
NO_NOISE, MENTIONED = 0.7, 0.3
# Part of values that must be exceeded by chance for a misfit to be significant.
BY_CHANCE = 1e-3


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


def fit(
    crane: "Crane",
    numbers: Mapping[str, tuple[float | None, float | None] | None] | Sequence[str],
    experiments: Experiment | Sequence[Experiment],
    *,
    starts: int = 1,
    seed: int = 0,
    evaluations: int = 100,
) -> Fit:
    """Fits numbers of a crane to measurements: the least squares of residuals, each divided by its noise.

    crane: where the fit begins: with good guesses of the numbers, by `Crane.replace`.
    numbers: live parameters by name, with (minimum, maximum), either of which may be None, or None without bounds; and dead times that runs name,
    s, at first in the middle of their bounds. experiments: of `crane.experiments`, one or several.
    starts: from how many places the search begins: responses with dead times, and those that oscillate, have several minima of which the first
    found need not be the lowest. The others are drawn, with `seed`, within the bounds, and where there are none within a factor of ten.
    evaluations: largest number of evaluations of all experiments from each start, besides those for derivatives.

    Derivatives of values at rest and of frequencies are exact; those of runs are central differences of runs with tolerance 1e-8. Numbers
    are scaled by their values, or by their bounds where they are 0. Where noise is not stated, it is the standard deviation of the residuals of each
    measured quantity. Raises ImportError without SciPy, ValueError for mistakes and where a crane cannot be computed at the start. Everything
    else that is wrong with a fit is in `Fit.status` and `Fit.cautions`.
    """
    begin = time.perf_counter()
    problem = _Problem.of(crane, dict.fromkeys(numbers) if not isinstance(numbers, Mapping) else numbers, experiments)
    solved = _solve(problem, _starts(problem, starts, seed), evaluations)
    return _result(problem, solved, time.perf_counter() - begin)


@dataclass
class _Problem:
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
    def of(cls, crane: "Crane", numbers: Mapping[str, Any], experiments: Any) -> "_Problem":
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
        down, up = np.maximum(p - steps, self.lower) - p, np.minimum(p + steps, self.upper) - p
        ends = dict(zip(self.names, zip(down.tolist(), up.tolist(), strict=True), strict=True))
        return np.concatenate([model.derivatives(numbers, self.names, ends) for model in self.models]) / self.noise[:, None]


@dataclass(frozen=True)
class _Solved:
    """Where the search ended."""

    p: Array
    residuals: Array
    jacobian: Array
    ended: bool
    message: str
    # χ² at the end of the search from each start.
    minima: list[float]


def _starts(problem: _Problem, count: int, seed: int) -> Array:
    """(starts, numbers): where searches begin; the first one is that of the crane."""
    rng = np.random.default_rng(seed)
    drawn = []
    for name, value, scale, least, greatest in zip(problem.names, problem.start, problem.scales, problem.lower, problem.upper, strict=True):
        part = rng.uniform(0.0, 1.0, max(count - 1, 0))
        bounded = np.isfinite(greatest - least)
        if name in problem.crane.parameters and value > 0 and (least > 0 or not bounded):
            # Numbers above 0 by their logarithms.
            low, high = np.log((least, greatest) if bounded else (value / 10, value * 10))
            drawn.append(np.exp(low + part * (high - low)))
        else:
            low, high = (least, greatest) if bounded else (value - 9 * scale, value + 9 * scale)
            drawn.append(low + part * (high - low))
    return np.vstack([problem.start, np.clip(np.array(drawn).T, problem.lower, problem.upper)])


def _search(problem: _Problem, start: Array, evaluations: int) -> Any:
    """Least squares from a start, with the present noise."""
    bounds = problem.lower / problem.scales, problem.upper / problem.scales
    return scipy().optimize.least_squares(
        lambda z: problem.residuals(z * problem.scales),
        np.clip(start / problem.scales, *bounds),
        jac=lambda z: problem.jacobian(z * problem.scales) * problem.scales,
        bounds=bounds,
        ftol=1e-6,
        xtol=1e-9,
        gtol=1e-12,
        max_nfev=evaluations,
    )


def _solve(problem: _Problem, starts: Array, evaluations: int) -> _Solved:
    """Least squares, repeated with the noise of the residuals until it stays the same."""
    problem.noise = np.ones(len(problem.measured))
    differences = problem.values(problem.start) - problem.measured
    if not np.isfinite(differences).all():
        raise ValueError(f"{problem.crane.name}: what was measured is not finite at the start")
    _state_noise(problem, differences, 0)
    searches = [_search(problem, start, evaluations) for start in starts if len(starts) == 1 or np.isfinite(problem.residuals(start)).all()]
    found = min(searches, key=lambda search: search.cost)
    for _ in range(ROUNDS):
        before = problem.noise.copy()
        if problem.stated.all():
            break
        _state_noise(problem, found.fun * before, len(problem.names))
        change = problem.noise / before
        # Weights matter in proportion to each other: one factor for all changes nothing but the deviations.
        if np.ptp(np.log(change)) < SAME_NOISE:
            break
        found = _search(problem, found.x * problem.scales, evaluations)
    ratio = before / problem.noise
    return _Solved(
        found.x * problem.scales,
        found.fun * ratio,
        found.jac / problem.scales * ratio[:, None],
        found.status > 0,
        found.message,
        [2 * search.cost for search in searches],
    )


def _state_noise(problem: _Problem, differences: Array, fitted: int) -> None:
    """Sets the noise of all rows: as stated, or the standard deviation of residuals."""
    total = len(differences)
    if total <= fitted and not problem.stated.all():
        raise ValueError(f"{total} measured values and {fitted} numbers to fit: noise cannot be estimated; state it, or measure more")
    for one, rows in zip(problem.series, problem.rows, strict=True):
        if one.noise is not None:
            problem.noise[rows] = one.noise
        else:
            mean_square = np.mean(differences[rows] ** 2) * total / (total - fitted)
            # Exact measurements of a computer have residuals of rounding.
            least = 1e-9 * max(float(np.max(np.abs(one.measured))), 1e-30)
            problem.noise[rows] = max(float(np.sqrt(mean_square)), least)


def _result(problem: _Problem, solved: _Solved, wall_time: float) -> Fit:
    """The fit with its intervals, and what is to be said about it."""
    special = scipy().special
    p, residuals, jacobian = solved.p, solved.residuals, solved.jacobian
    total = len(residuals)
    nearness = 1e-3 * problem.scales
    slope = jacobian.T @ residuals
    at_bound = ((p - problem.lower < nearness) & (slope > 0)) | ((problem.upper - p < nearness) & (slope < 0))
    free = ~at_bound
    accuracy = max(model.accuracy for model in problem.models)
    scales = np.maximum(np.abs(p), np.abs(problem.scales))
    found = directions(jacobian[:, free], scales[free], accuracy, 1.0)
    degrees = total - int(found.known.sum())
    stated = np.concatenate([np.full(len(one.measured), one.noise is not None) for one in problem.series])
    own = max(degrees * stated.sum() / total, 0.0)
    chi2 = float(np.sum(residuals[stated] ** 2)) if stated.any() else float(np.sum(residuals**2))
    own_degrees = own if stated.any() else float(degrees)
    reduced = chi2 / own_degrees if own_degrees > 0 else np.nan
    significant = own_degrees > 0 and stated.any() and chi2 > special.chdtri(own_degrees, BY_CHANCE)
    spread = float(np.sqrt(reduced)) if significant else 1.0
    # Deviations are known if the noise was stated and is the one that is there, and estimated otherwise.
    estimated = significant or not stated.all()
    quantile = float(special.stdtrit(degrees, 0.975) if estimated and degrees > 0 else special.ndtri(0.975))
    found = directions(jacobian[:, free], scales[free], accuracy, quantile)

    count = len(p)
    covariance = np.zeros((count, count))
    covariance[np.ix_(free, free)] = spread**2 * found.covariance
    unknown = np.zeros((count, found.unknown.shape[1]))
    unknown[free] = found.unknown
    deviations = np.sqrt(np.diag(covariance))
    deviations[free] = np.where(found.involved(), np.inf, deviations[free])
    deviations[at_bound] = np.nan
    half = quantile * deviations
    intervals = np.clip(np.stack([p - half, p + half], axis=-1), problem.lower[:, None], problem.upper[:, None])

    def misfit(place: Array) -> float:
        full = p.copy()
        full[free] = place
        square = float(np.sum(problem.residuals(full) ** 2))
        return square if np.isfinite(square) else np.inf

    names = [name for name, is_free in zip(problem.names, free, strict=True) if is_free]
    indistinct = describe(found, names, p[free], misfit)
    series = _series(problem, solved)
    remaining = _remaining(found, jacobian[:, free], residuals, spread)
    converged = remaining < REMAINING
    status, cautions = _judge(problem, solved, converged, remaining, indistinct, at_bound, reduced, significant, series)
    problem.values(p)
    cautions += [caution for model in problem.models for caution in model.cautions()]
    live = {name: float(value) for name, value in zip(problem.names, p, strict=True) if name in problem.crane.parameters}
    return Fit(
        names=tuple(problem.names),
        units=tuple(problem.units),
        estimates=p,
        start=problem.start,
        bounds=np.stack([problem.lower, problem.upper], axis=-1),
        deviations=deviations,
        intervals=intervals,
        covariance=covariance,
        unknown=unknown * scales[:, None],
        indistinct=indistinct,
        at_bound=tuple(name for name, there in zip(problem.names, at_bound, strict=True) if there),
        chi2=reduced,
        degrees=degrees,
        noise_stated=bool(stated.all()),
        quantile=quantile,
        estimated=bool(estimated),
        status=status,
        cautions=cautions,
        series=series,
        crane=problem.crane.replace(**live),
        statistics={"evaluations": problem.evaluations, "jacobians": problem.jacobians},
        wall_time=wall_time,
    )


def _series(problem: _Problem, solved: _Solved) -> tuple[SeriesFit, ...]:
    """What was measured beside what the fitted crane says."""
    found = []
    for one, rows in zip(problem.series, problem.rows, strict=True):
        noise = problem.noise[rows]
        model = one.measured + solved.residuals[rows] * noise
        found.append(SeriesFit(one.experiment, one.column, one.unit, one.at, one.measured, model, noise, one.noise is not None))
    return tuple(found)


def _remaining(found: Directions, jacobian: Array, residuals: Array, spread: float) -> float:
    """Length of the next step of Gauss and Newton over what is known, in standard deviations."""
    root = found.scales[:, None] * found.vectors[:, found.known] / found.singular_values[found.known]
    return float(np.linalg.norm(root.T @ (jacobian.T @ residuals)) / spread)


def _judge(
    problem: _Problem,
    solved: _Solved,
    converged: bool,
    remaining: float,
    indistinct: list[str],
    at_bound: Array,
    reduced: float,
    significant: bool,
    series: Sequence[SeriesFit],
) -> tuple[str, list[str]]:
    """The status of a fit, the worst word that applies, and all that is to be said about it."""
    status, cautions = "converged", []
    if at_bound.any():
        status = "at a bound"
        there = [name for name, is_there in zip(problem.names, at_bound, strict=True) if is_there]
        cautions.append(f"{', '.join(there)} ended at a bound: the intervals of the others hold for this value; is the bound right, and the model?")
    dependent = [one for one in series if one.follows is not None and one.follows > NO_NOISE and not one.noise_stated]
    if significant and reduced > FAR_ABOVE:
        status = "misfit"
        cautions.append(
            f"residuals are {np.sqrt(reduced):.1f} times the stated noise (χ² per degree of freedom {reduced:.3g}): the model, a condition or the noise is "
            "wrong, or there are outliers; intervals are widened by this factor, which does not make wrong values right"
        )
    elif significant:
        cautions.append(f"residuals are {np.sqrt(reduced):.2f} times the stated noise, more than by chance; intervals are widened by this factor")
    elif dependent:
        status = "misfit"
    elif problem.stated.any() and reduced < 0.5 and np.isfinite(reduced) and sum(len(one.measured) for one in series) > 20:
        cautions.append(f"residuals are only {np.sqrt(reduced):.2g} of the stated noise: intervals are wider than need be")
    if len(solved.minima) > 1:
        lowest = min(solved.minima)
        there = sum(minimum < lowest + 1.0 for minimum in solved.minima)
        others = sorted(minimum for minimum in solved.minima if minimum >= lowest + 1.0)
        if others:
            cautions.append(f"{there} of {len(solved.minima)} starts ended here, the others at minima with χ² higher by {others[0] - lowest:.3g} or more")
    for one in series:
        follows = one.follows
        if follows is not None and follows > MENTIONED:
            cautions.append(
                f"{one.experiment}: residuals of {one.column} follow each other (correlation {follows:.2f}): they are not noise of single values, "
                "but what the model leaves out; intervals are too narrow"
            )
        cautions += one.outliers(OUTLIER)
    if indistinct:
        status = "not identifiable"
        cautions += [f"cannot be told apart: {words}" for words in indistinct]
    if not converged:
        status = "not converged"
        why = "" if solved.ended else f" ({solved.message.rstrip('.').lower()})"
        failed = f"; the last crane that could not be computed: {str(problem.failure).splitlines()[0]}" if problem.failure else ""
        cautions.insert(0, f"the search ended early{why}: another step would move the numbers by {remaining:.2g} deviations; begin elsewhere, or allow more evaluations{failed}")
    return status, cautions


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
