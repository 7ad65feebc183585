"""The search of a fit: least squares from one start or several, with noise that is stated or that of the residuals."""

from dataclasses import dataclass

import numpy as np

from .fit_problem import Problem, scipy
from .identifiability import directions
from .results import Array

# The search ends before that, with one more step: where derivatives are exact, and where they are differences of runs.
SETTLED_EXACT, SETTLED = 1e-4, 0.03
# A step shorter than this part of the deviations leaves derivatives by differences as they are.
SAME_SLOPES = 1.0
# Estimates of noise are repeated until they change by less than this part.
SAME_NOISE = 0.01
ROUNDS = 8


@dataclass(frozen=True)
class Solved:
    """Where the search ended."""

    p: Array
    residuals: Array
    jacobian: Array
    ended: bool
    message: str
    # χ² at the end of the search from each start.
    minima: list[float]


def starts_of(problem: Problem, count: int, seed: int) -> Array:
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


class _Settled(Exception):
    """Ends a search whose next step would be far below the deviations of the numbers."""


@dataclass
class _End:
    """Where a search ended: numbers, residuals and their derivatives there, half of χ²."""

    p: Array
    residuals: Array
    jacobian: Array
    ended: bool
    message: str

    @property
    def cost(self) -> float:
        return float(self.residuals @ self.residuals) / 2


def _search(problem: Problem, start: Array, evaluations: int) -> _End:
    """Least squares from a start, with the present noise: steps of Gauss and Newton within a trust region and bounds."""
    scales, bounds = problem.scales, (problem.lower / problem.scales, problem.upper / problem.scales)
    differences = problem.accuracy > 1e-6
    settled = SETTLED if differences else SETTLED_EXACT
    # The last evaluation, numbers and residuals; the derivatives in use, and how far the next step with them leads.
    last: list[Array] = []
    slopes, length = np.zeros(0), np.inf

    def residuals(z: Array) -> Array:
        last[:] = z, problem.residuals(z * scales)
        return last[1]

    def jacobian(z: Array) -> Array:
        nonlocal slopes, length
        r = last[1] if np.array_equal(last[0], z) else residuals(z)
        before = length
        near = differences and before < SAME_SLOPES
        if not near:
            slopes = problem.jacobian(z * scales)
        length = step_length(z, r)
        if near and length > max(settled, before / 3):
            slopes = problem.jacobian(z * scales)
            length = step_length(z, r)
        if length < settled:
            raise _Settled
        return slopes * scales

    def step_length(z: Array, r: Array) -> float:
        return float(np.linalg.norm(next_step(problem, z * scales, slopes, r)[1]))

    try:
        found = scipy().optimize.least_squares(
            residuals, np.clip(start / scales, *bounds), jacobian, bounds, ftol=1e-6, xtol=1e-9, gtol=1e-12, max_nfev=evaluations
        )
    except _Settled:
        z, r = last
        step, _ = next_step(problem, z * scales, slopes, r)
        p = np.clip(z * scales + step, problem.lower, problem.upper)
        other = problem.residuals(p)
        better = np.isfinite(other).all() and other @ other <= r @ r
        return _End(p if better else z * scales, other if better else r, slopes, True, "settled")
    return _End(found.x * scales, found.fun, found.jac / scales, found.status > 0, found.message)


def next_step(problem: Problem, p: Array, jacobian: Array, residuals: Array) -> tuple[Array, Array]:
    """The next step of Gauss and Newton, of the numbers, and of all combinations that move anything, in standard deviations."""
    free = ~problem.at_bound(p, jacobian.T @ residuals)
    found = directions(jacobian[:, free], problem.sizes(p)[free], problem.accuracy, 0.0)
    root = found.scales[:, None] * found.vectors[:, found.known] / found.singular_values[found.known]
    combinations = -root.T @ (jacobian[:, free].T @ residuals)
    step = np.zeros(len(p))
    step[free] = root @ combinations
    return step, combinations


def solve(problem: Problem, starts: Array, evaluations: int) -> Solved:
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
        _state_noise(problem, found.residuals * before, len(problem.names))
        change = problem.noise / before
        # Weights matter in proportion to each other: one factor for all changes nothing but the deviations.
        if np.ptp(np.log(change)) < SAME_NOISE:
            break
        found = _search(problem, found.p, evaluations)
    ratio = before / problem.noise
    return Solved(
        found.p,
        found.residuals * ratio,
        found.jacobian * ratio[:, None],
        found.ended,
        found.message,
        [2 * search.cost for search in searches],
    )


def _state_noise(problem: Problem, differences: Array, fitted: int) -> None:
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
