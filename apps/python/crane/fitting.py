"""Fits of live parameters to measurements, by least squares with exact derivatives where there are any."""

import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .arguments import names_of
from .coloured import coefficient, score_covariance
from .experiments import Experiment
from .fit_problem import Problem, scipy
from .fit_result import Fit, SeriesFit
from .fit_search import Solved, next_step, solve, starts_of
from .identifiability import describe, directions
from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# A fit has converged if another step of Gauss and Newton would move no combination of numbers by more than this part of its deviation.
REMAINING = 0.1
# A residual is an outlier beyond this many robust deviations.
OUTLIER = 6.0
# χ² per degree of freedom above which residuals are far above the stated noise, if they are so significantly.
FAR_ABOVE = 1.5
# Correlation of successive residuals above which they are not noise. Noise is coloured from the correlation on that chance does not explain, within
# limits: few values do not excuse a large one, and a small one of many values hardly changes intervals.
NO_NOISE = 0.7
COLOURED = (0.1, 0.3)
# Part of values that must be exceeded by chance for a misfit to be significant.
BY_CHANCE = 1e-3


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

    Derivatives of values at rest and of frequencies are exact; those of runs are differences of runs with tolerance 1e-8. Numbers
    are scaled by their values, or by their bounds where they are 0. Where noise is not stated, it is the standard deviation of the residuals of each
    measured quantity. Raises ImportError without SciPy, ValueError for mistakes and where a crane cannot be computed at the start. Everything
    else that is wrong with a fit is in `Fit.status` and `Fit.cautions`.
    """
    begin = time.perf_counter()
    problem = Problem.of(crane, numbers if isinstance(numbers, Mapping) else dict.fromkeys(names_of(numbers)), experiments)
    solved = solve(problem, starts_of(problem, starts, seed), evaluations)
    return _result(problem, solved, time.perf_counter() - begin)


def _result(problem: Problem, solved: Solved, wall_time: float) -> Fit:
    """The fit with its intervals, and what is to be said about it."""
    special = scipy().special
    p, residuals, jacobian = solved.p, solved.residuals, solved.jacobian
    total = len(residuals)
    series = _series(problem, solved)
    at_bound = problem.at_bound(p, jacobian.T @ residuals)
    free = ~at_bound
    scales = problem.sizes(p)
    found = directions(jacobian[:, free], scales[free], problem.accuracy, 0.0)
    degrees = total - int(found.known.sum())
    stated = np.concatenate([np.full(len(one.measured), one.noise is not None) for one in problem.series])
    own = max(degrees * stated.sum() / total, 0.0)
    numbers = int(found.known.sum())
    colours = [_colour(one, numbers, total) for one in series]
    # Squares of coloured noise scatter as fewer independent ones do (Bartlett's formula), and means of it, too.
    squares, means = (_independent(series, colours, power) for power in (2, 1))
    chi2 = float(np.sum(residuals[stated] ** 2)) if stated.any() else float(np.sum(residuals**2))
    own_degrees = own if stated.any() else float(degrees)
    reduced = chi2 / own_degrees if own_degrees > 0 else np.nan
    share = float(squares[stated].mean()) if stated.any() else 1.0
    significant = bool(own_degrees > 0 and stated.any() and chi2 * share > special.chdtri(own_degrees * share, BY_CHANCE))
    spread = float(np.sqrt(reduced)) if significant else 1.0
    # Deviations are known if the noise was stated and is the one that is there, and estimated otherwise.
    estimated = significant or not stated.all() or any(colours)
    independent = float(degrees * means.mean())
    quantile = float(special.stdtrit(independent, 0.975) if estimated and degrees > 0 else special.ndtri(0.975))
    found = directions(jacobian[:, free], scales[free], problem.accuracy, quantile)

    count = len(p)
    covariance = np.zeros((count, count))
    own_covariance = spread**2 * found.covariance
    if any(colours) and degrees > 0:
        scores = [
            score_covariance(jacobian[rows][:, free], residuals[rows], colour) * total / degrees
            if colour
            else spread**2 * jacobian[rows][:, free].T @ jacobian[rows][:, free]
            for rows, colour in zip(problem.rows, colours, strict=True)
        ]
        own_covariance = found.covariance @ np.sum(scores, axis=0) @ found.covariance
    covariance[np.ix_(free, free)] = own_covariance
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
    remaining = float(np.linalg.norm(next_step(problem, p, jacobian, residuals)[1])) / spread
    converged = remaining < REMAINING
    status, cautions = _judge(problem, solved, converged, remaining, indistinct, at_bound, reduced, significant, series, colours)
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
        independent=independent,
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


def _series(problem: Problem, solved: Solved) -> tuple[SeriesFit, ...]:
    """What was measured beside what the fitted crane says."""
    found = []
    for one, rows in zip(problem.series, problem.rows, strict=True):
        noise = problem.noise[rows]
        model = one.measured + solved.residuals[rows] * noise
        found.append(SeriesFit(one.experiment, one.column, one.unit, one.at, one.measured, model, noise, one.noise is not None))
    return tuple(found)


def _colour(one: SeriesFit, numbers: int, total: int) -> float:
    """Coefficient of coloured noise; 0 for white noise."""
    if one.follows is None:
        return 0.0
    count = len(one.measured)
    by_chance = float(-scipy().special.ndtri(BY_CHANCE)) / np.sqrt(count)
    return coefficient(one.follows, count, numbers, total) if one.follows > np.clip(by_chance, *COLOURED) else 0.0


def _independent(series: Sequence[SeriesFit], colours: Sequence[float], power: int) -> Array:
    """(values): what part of an independent value each is worth, for means (power 1) or for means of squares (2)."""
    parts = [np.full(len(one.measured), (1 - colour**power) / (1 + colour**power)) for one, colour in zip(series, colours, strict=True)]
    return np.concatenate(parts)


def _judge(
    problem: Problem,
    solved: Solved,
    converged: bool,
    remaining: float,
    indistinct: list[str],
    at_bound: NDArray[np.bool_],
    reduced: float,
    significant: bool,
    series: Sequence[SeriesFit],
    colours: Sequence[float],
) -> tuple[str, list[str]]:
    """The status of a fit, the worst word that applies, and all that is to be said about it."""
    status, cautions = "converged", []
    if at_bound.any():
        status = "at a bound"
        there = [name for name, is_there in zip(problem.names, at_bound, strict=True) if is_there]
        cautions.append(f"{', '.join(there)} ended at a bound: the intervals of the others hold for this value; is the bound right, and the model?")
    if significant and reduced > FAR_ABOVE:
        status = "misfit"
        cautions.append(
            f"residuals are {np.sqrt(reduced):.1f} times the stated noise (χ² per degree of freedom {reduced:.3g}): the model, a condition or the noise is "
            "wrong, or there are outliers; intervals are widened by this factor, which does not make wrong values right"
        )
    elif significant:
        cautions.append(f"residuals are {np.sqrt(reduced):.2f} times the stated noise, more than by chance; intervals are widened by this factor")
    elif problem.stated.any() and reduced < 0.5 and np.isfinite(reduced) and sum(len(one.measured) for one in series) > 20:
        cautions.append(f"residuals are only {np.sqrt(reduced):.2g} of the stated noise: intervals are wider than need be")
    if len(solved.minima) > 1:
        lowest = min(solved.minima)
        same = sum(minimum < lowest + 1.0 for minimum in solved.minima)
        others = sorted(minimum for minimum in solved.minima if minimum >= lowest + 1.0)
        if others:
            cautions.append(f"{same} of {len(solved.minima)} starts ended here, the others at minima with χ² higher by {others[0] - lowest:.3g} or more")
    for one, colour in zip(series, colours, strict=True):
        if colour and one.follows is not None:
            count = len(one.measured)
            cautions.append(
                f"{one.experiment}: residuals of {one.column} follow each other (correlation {one.follows:.2f}): {count} values are worth about "
                f"{count * (1 - colour) / (1 + colour):.0f} independent ones; intervals allow for coloured noise, but not for what the model leaves out"
            )
            if one.follows > NO_NOISE:
                status = "misfit"
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
