"""Linear models about a state, with inputs and outputs by their names, and margins of loops around them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._native import real_array
from .arguments import names_of
from .results import Array

if TYPE_CHECKING:
    from .model import Crane


@dataclass(frozen=True)
class StateSpace:
    """`d/dt δx = A δx + B δu`, `δy = C δx + D δu` about a state, which need not be at rest; over the leading axes.

    The state has the coordinates that can move, their rates, and the states of forces: pressures, spools, bristles. Of a crane with loops it has
    independent coordinates, as many as the crane has degrees of freedom.

    A: (..., states, states). B: (..., states, inputs). C: (..., outputs, states). D: (..., outputs, inputs).
    states, inputs, outputs: names; state_units, input_units, output_units: their units.
    interval: None, or of a sampled model, `δx[k+1] = A δx[k] + B δu[k]`, the time between samples, s.
    stable: (...,), whether no disturbance grows faster than 1e-4 1/s. drift: (..., coordinates), the rates, m/s and rad/s, of the coordinates in
    the state, if the state is at rest and no equilibrium: oil leaks past pistons whose valves are shut. Zeros for equilibria and for states that
    move. decay: (...,), the rate at which the fastest of them decays, 1/s, NaN without a drift. What only grows with a drift does not count
    as unstable. None for sampled models.

    It unpacks into A, B, C, D: `scipy.signal.StateSpace(*model)`, `control.ss(*model)`.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]
    interval: float | None = None
    stable: NDArray[np.bool_] | None = None
    drift: Array | None = None
    decay: Array | None = None

    def __iter__(self) -> Iterator[Array]:
        return iter((self.A, self.B, self.C, self.D))

    def frequency_response(self, frequencies: ArrayLike) -> NDArray[np.complex128]:
        """(..., frequencies, outputs, inputs): `C (iω − A)⁻¹ B + D` at frequencies in Hz: amplitude and phase of each output per unit of each input.

        Of a sampled model `C (exp(iω interval) − A)⁻¹ B + D`."""
        frequencies = np.atleast_1d(real_array("frequencies", frequencies))
        if not np.isfinite(frequencies).all():
            raise ValueError(f"frequencies={frequencies}: write finite numbers, in Hz")
        turning = 2j * np.pi * frequencies
        if self.interval is not None:
            turning = np.exp(turning * self.interval)
        unit = np.eye(self.A.shape[-1])
        A, B, C, D = (matrix[..., None, :, :] for matrix in self)
        return C @ np.linalg.solve(turning[:, None, None] * unit - A, B.astype(complex)) + D

    def sampled(self, interval: float) -> StateSpace:
        """The model from sample to sample, `interval` s apart, with inputs that are constant between them (zero-order hold)."""
        if self.interval is not None:
            raise ValueError("the model is sampled already")
        interval = float(real_array("interval", interval))
        if not (interval > 0.0 and math.isfinite(interval)):
            raise ValueError(f"interval={interval}: write a number of seconds above 0")
        size, count = self.B.shape[-2:]
        block = np.zeros((*self.A.shape[:-2], size + count, size + count))
        block[..., :size, :size], block[..., :size, size:] = self.A, self.B
        moved = _exponential(block * interval)
        names = (self.states, self.inputs, self.outputs, self.state_units, self.input_units, self.output_units)
        return StateSpace(moved[..., :size, :size], moved[..., :size, size:], self.C, self.D, *names, interval)


def _exponential(matrix: Array) -> Array:
    """exp of matrices by scaling, squaring and the Padé approximation of order 13 [Higham 2005], after balancing units by powers of 2."""
    matrix, scales = _balanced(matrix)
    norm = np.max(np.sum(np.abs(matrix), axis=-2), initial=0.0)
    halvings = max(0, math.ceil(math.log2(norm / 5.371920351148152))) if norm > 0.0 else 0
    matrix = matrix / 2.0**halvings
    order = 13
    factors = [1.0]
    for j in range(1, order + 1):
        factors.append(factors[-1] * (order + 1 - j) / ((2 * order + 1 - j) * j))
    power = np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    even, odd = np.zeros_like(matrix), np.zeros_like(matrix)
    for j, factor in enumerate(factors):
        (odd if j % 2 else even)[...] += factor * power
        power = power @ matrix
    result = np.linalg.solve(even - odd, even + odd)
    for _ in range(halvings):
        result = result @ result
    return result * scales[..., :, None] / scales[..., None, :]


def _balanced(matrix: Array) -> tuple[Array, Array]:
    """`S⁻¹ M S` with a diagonal S of powers of 2, whose rows and columns are of one size: pressures in Pa beside angles in rad; and S."""
    scales = np.ones(matrix.shape[:-1])
    for _ in range(20):
        scaled = np.abs(matrix) * scales[..., None, :] / scales[..., :, None]
        off = scaled * (1.0 - np.eye(matrix.shape[-1]))
        rows, columns = off.sum(axis=-1), off.sum(axis=-2)
        both = (rows > 0.0) & (columns > 0.0)
        change = np.where(both, np.exp2(np.round(0.5 * np.log2(np.where(both, rows / np.where(columns > 0.0, columns, 1.0), 1.0)))), 1.0)
        if np.all(change == 1.0):
            break
        scales = scales * change
    return matrix * scales[..., None, :] / scales[..., :, None], scales


@dataclass(frozen=True)
class Margins:
    """Stability margins of a loop, over the leading axes. L: the gain of the open loop; frequencies in rad/s; NaN where there is none.

    stable: whether the closed loop is stable, by Nyquist's count. phase: phase of L + 180°, rad, where |L| = 1 and its size is least; crossover:
    where that is. gain: smallest factor above 1 with which L passes −1, and its frequency gain_at; reduction: largest factor below 1.
    distance: of L from −1, the inverse of the largest sensitivity, and its frequency distance_at. bandwidth: where |L/(1 + L)| falls below 1/√2.
    closed: eigenvalue, 1/s, of the least damped of all motions of the closed loop up to the highest frequency with |L| ≥ 0.1, with the exact dead
    time, and of those that grow; NaN where |L| is nowhere 0.1. damping: its damping ratio. Where the dead time turns L by more than 30 rad up
    to its crossover, or where the motions that grow are not as many as Nyquist's count, both are NaN, and a warning says so.
    """

    stable: NDArray[np.bool_]
    phase: Array
    crossover: Array
    gain: Array
    gain_at: Array
    reduction: Array
    distance: Array
    distance_at: Array
    bandwidth: Array
    closed: NDArray[np.complex128]

    @property
    def damping(self) -> Array:
        """Damping ratio of the least damped motion of the closed loop; negative if it grows, however slowly: below 1e-4 1/s it counts as stable."""
        return -self.closed.real / np.abs(self.closed)


def about(
    crane: Crane,
    state: tuple[ArrayLike, ArrayLike | None, ArrayLike | None, ArrayLike | None],
    inputs: str | Sequence[str] | None,
    outputs: str | Sequence[str] | None,
    invalid: str,
    *,
    valves: str = "shut",
    steady: bool = False,
) -> StateSpace:
    """The linear model of a crane about a state q, v, t, x: see `Crane.state_space`."""
    lists = (None if names is None else names_of(names) for names in (inputs, outputs))
    found = crane._state_space(*state, valves=valves, steady=steady, **dict(zip(("inputs", "outputs"), lists, strict=True)), invalid=invalid)
    names = ("states", "inputs", "outputs", "state_units", "input_units", "output_units")
    verdicts = {"stable": found["stable"] == 1.0, "drift": found["drift"], "decay": found["decay"]}
    return StateSpace(*(found[name] for name in "ABCD"), *(tuple(found[name]) for name in names), **verdicts)


def margins(crane: Crane, model: StateSpace, powers: list[int], numbers: list[float], invalid: str) -> Margins:
    """The margins of a loop around a model with one output: see `Crane.margins`."""
    axes = model.A.shape[:-2]
    A, B, C, D = (np.ascontiguousarray(matrix.reshape(-1, *matrix.shape[len(axes) :])) for matrix in model)
    found = _native.loop_margins(A, B, np.ascontiguousarray(C[:, 0]), np.ascontiguousarray(D[:, 0]), powers, numbers, invalid)
    columns = [column.reshape(axes) for column in np.moveaxis(found, -1, 0)]
    return Margins(columns[0] == 1.0, *columns[1:9], columns[9] + 1j * columns[10])
