"""Many cranes of one spec in motion, stepped together on all threads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .closed import Closed
from .results import Array
from .simulation import is_linear, numbers_of

if TYPE_CHECKING:
    from ._native import Motions
    from .model import Crane


@dataclass(frozen=True)
class VectorState:
    """States of cranes, over their rows; after `VectorSimulation.run` over (steps, rows). The arrays cannot be changed.

    t: (...), s. q, v: (..., n), m and rad, m/s and rad/s.
    """

    t: Array
    q: Array
    v: Array


class VectorSimulation(Closed):
    """Cranes of one spec in motion, each with its own parameters, state and inputs: rows that are stepped together, on all threads and without
    Python's lock.

    >>> import crane, numpy as np
    >>> cranes = crane.load("knuckle_boom", payload=np.linspace(0, 800, 16)).vector_simulation()
    >>> cranes.step(0.02).q.shape
    (16, 4)

    Every row gives the numbers of a `Simulation` with the same calls, to the last bit. A copy, by `copy.deepcopy` or `pickle`, has the history
    of the method, too, and goes on as the original does, to the last bit.
    """

    _instead = (
        "NAME of a simulation cannot be set: `reset(rows, NAME=...)` sets a live parameter, `step(dt, inputs={'NAME': ...})` an input; "
        "method and tolerance are arguments of `crane.vector_simulation`"
    )

    def __init__(
        self,
        crane: Crane,
        timing: dict[str, Any],
        count: int | None = None,
        *,
        t: float = 0.0,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        inputs: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        if count is not None and (isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1):
            raise ValueError(f"count={count!r}: write how many cranes, 1 or more")
        self._timing = {**timing, "method": timing["method"] or ("rk4" if timing["step"] else None)}
        given = {name: real_array(f"inputs[{name!r}]", value) for name, value in {**crane.inputs, **(inputs or {})}.items()}
        states = [np.shape(state)[:-1] for state in (q, v) if state is not None]
        shape = np.broadcast_shapes(crane.shape, *(value.shape for value in given.values()), *states, () if count is None else (count,))
        if len(shape) != 1 or 0 in shape or (count is not None and shape != (count,)):
            raise ValueError(f"rows of shape {shape}: give `count`, or arrays with one axis, one number for each crane")
        (self._count,) = shape
        self._base = crane
        self._parameters = {name: _rows(value, self._count) for name, value in crane.parameters.items()}
        infos = crane.info["inputs"]
        self._inputs = {of["name"]: _rows(np.nan if of["moves"] else of["default"], self._count) for of in infos}
        self._inputs.update({name: _rows(value, self._count) for name, value in given.items()})
        self._motions = self._begin(np.arange(self._count), t, q, v)
        self._read()

    def _begin(self, rows: Array, t: float, q: ArrayLike | None, v: ArrayLike | None) -> Motions:
        """Motions of some rows, with their parameters and inputs; from their own equilibria unless poses are given."""
        crane = self._crane_of(rows)
        inputs = {name: value[rows] for name, value in self._inputs.items() if not np.isnan(value).any()}
        follow = {name: value for name, value in self._inputs.items() if np.isnan(value).any()}
        for name, value in follow.items():
            if not np.isnan(value).all():
                raise ValueError(f"inputs[{name!r}]: it follows a motion of the spec in some rows; set it in all, or in none")
        q = crane.statics(t=t).q if q is None and t != 0.0 else q
        given = (None if state is None else crane._coordinates(name, state) for name, state in (("q", q), ("v", v)))
        states = [None if state is None else np.broadcast_to(state, (len(rows), crane.n)) for state in given]
        if not inputs and not crane.shape and q is None and v is None:
            states[0] = np.broadcast_to(crane.statics(t=t).q, (len(rows), crane.n))
        return crane._motions(self._timing, False, float(t), *states, [], inputs or None)

    def _crane_of(self, rows: Array) -> Crane:
        """Cranes with the parameters of some rows."""
        return self._base.replace(**{name: value[rows] for name, value in self._parameters.items()})

    def _read(self) -> None:
        t, q, v, *_ = self._motions.states()
        self._state: VectorState | Array = VectorState(t, q, v)

    def __getstate__(self) -> dict[str, Any]:
        if any(self.failures):
            raise ValueError("a simulation of which some rows have failed cannot be copied: reset them first")
        return {**self.__dict__, "_motions": [self._motions.memory(row) for row in range(self._count)]}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._parameters, self._inputs = ({name: value.copy() for name, value in of.items()} for of in (self._parameters, self._inputs))
        self._motions = self._crane_of(np.arange(self._count))._recalled(self._timing, False, self._motions)
        self._read()

    def __len__(self) -> int:
        return self._count

    @property
    def crane(self) -> Crane:
        """The cranes, with their present parameters as arrays."""
        return self._base.replace(**self.parameters)

    @property
    def parameters(self) -> dict[str, Array]:
        """Live parameters, (rows) each, after the events so far. `reset` begins with those before them."""
        return dict(zip(self._parameters, self._motions.parameters().T.copy(), strict=True))

    @property
    def events(self) -> dict[str, Array]:
        """Times of the events of the spec, (rows) each, s; NaN in rows in which they have not happened."""
        rows = [self._motions.marks(row) for row in range(self._count)]
        marks = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        return {name: np.where(own > 0.0, own, np.nan) for name, own in marks.items()}

    @property
    def inputs(self) -> dict[str, Array]:
        """Values of the inputs, (rows) each; NaN for those that follow motions of the spec."""
        return {name: value.copy() for name, value in self._inputs.items()}

    @property
    def state(self) -> VectorState:
        """The present states."""
        if isinstance(self._state, np.ndarray):
            t, q, v = np.split(self._state, (1, 1 + self._base.n), axis=1)
            self._state = VectorState(t[:, 0], q, v)
        return self._state

    @property
    def t(self) -> Array:
        """Times, (rows), s."""
        return self.state.t

    @property
    def q(self) -> Array:
        """Coordinates, (rows, n), m and rad."""
        return self.state.q

    @property
    def v(self) -> Array:
        """Rates, (rows, n), m/s and rad/s."""
        return self.state.v

    @property
    def failures(self) -> list[str | None]:
        """Why each row cannot go on; None for those that can."""
        return self._motions.failures()

    @property
    def statistics(self) -> dict[str, Array]:
        """Steps, rejected steps, evaluations of accelerations and factorisations of each row, (rows), since its last reset."""
        each = [self._motions.statistics(row) for row in range(self._count)]
        return {what: np.array([row[what] for row in each]) for what in each[0]}

    def step(self, dt: float, inputs: Mapping[str, ArrayLike] | None = None, *, hold: str = "constant", invalid: str = "raise") -> VectorState:
        """Advances all cranes by dt, s, with new values of inputs by name, numbers or arrays (rows). Returns the new states.

        hold: "constant" or "linear", as for `Simulation.step`.
        invalid: "raise" raises if a row fails; "nan" goes on with the others. A row that fails stays at its last state until it is reset:
        `failures` says why.
        """
        t, q, v = self._advance(dt, 1, inputs, hold, invalid)
        self._state = state = VectorState(t[0], q[0], v[0])
        return state

    def _steer(self, dt: float, names: Sequence[str], places: Sequence[int], values: Array, linear: bool) -> Array:
        """A step with values, (rows, inputs), of inputs that are set, by names and their places in the spec: times, poses and rates, (rows, 1 + 2 n).
        Rows that fail stay, as with `invalid="nan"`."""
        try:
            rows = self._motions.steer(dt, places, values, linear)
        except BaseException:
            self._read()
            raise
        # Divided when it is asked for: that takes longer than what else there is to do.
        self._state = rows
        for name, column in zip(names, values.T, strict=True):
            self._inputs[name][:] = column
        return rows

    def run(
        self, dt: float, steps: int, inputs: Mapping[str, ArrayLike] | None = None, *, hold: str = "constant", invalid: str = "raise"
    ) -> VectorState:
        """Several steps in one call: the states after each, over (steps, rows). Inputs are numbers, or arrays (rows) or (steps, rows)."""
        if steps < 1:
            raise ValueError(f"steps={steps}: write 1 or more")
        path = self._advance(dt, int(steps), inputs, hold, invalid)
        self._state = VectorState(*(numbers[-1] for numbers in path))
        return VectorState(*path)

    def _advance(self, dt: float, steps: int, inputs: Mapping[str, ArrayLike] | None, hold: str, invalid: str) -> tuple[Array, Array, Array]:
        linear, inputs = is_linear(hold), numbers_of(self._base, inputs)
        if invalid not in ("raise", "nan"):
            raise ValueError(f'invalid={invalid!r}: write "raise" or "nan"')
        for name, value in inputs.items():
            if name not in self._inputs:
                raise ValueError(f"there is no input {name!r}: write one of {', '.join(self._inputs) or 'none: the spec has no inputs'}")
            if value is None or not self._motions.can_set(name):
                raise ValueError(f"input {name!r}: it follows a motion of the spec, or shall do so; choose that when cranes begin or are reset")
        try:
            path = self._motions.advance(dt, steps, inputs, linear)
        except BaseException:
            self._read()
            raise
        for name, value in inputs.items():
            last = np.asarray(value, dtype=float)
            self._inputs[name] = _rows(last[-1] if last.ndim == 2 else last, self._count)
        if invalid == "raise":
            try:
                self._motions.check()
            except BaseException:
                self._read()
                raise
        return path

    def reset(
        self,
        rows: Sequence[int] | Array | None = None,
        *,
        t: float = 0.0,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        inputs: Mapping[str, ArrayLike] | None = None,
        **parameters: ArrayLike,
    ) -> VectorState:
        """Begins again in some rows, all unless given, with new parameters and inputs; those not named stay as they are.

        t, s; q, v: (rows, n) or (n); their own static equilibria at rest unless given. Returns the states of all rows.
        """
        rows = np.arange(self._count) if rows is None else np.atleast_1d(np.asarray(rows))
        rows = np.flatnonzero(rows) if rows.dtype == bool else rows.astype(np.intp)
        if len(rows) == 0:
            return self.state
        if not ((rows >= 0) & (rows < self._count)).all() or len(set(rows.tolist())) < len(rows):
            raise ValueError(f"rows={rows.tolist()}: write different ones from 0 to {self._count - 1}")
        before = self._parameters, self._inputs
        self._parameters = self._changed(self._parameters, parameters, rows, "live parameter")
        self._inputs = self._changed(self._inputs, inputs or {}, rows, "input")
        try:
            self._motions.put(rows.tolist(), self._begin(rows, t, q, v))
        except BaseException:
            self._parameters, self._inputs = before
            raise
        self._read()
        return self.state

    def _changed(self, of: dict[str, Array], new: Mapping[str, ArrayLike], rows: Array, what: str) -> dict[str, Array]:
        changed = {name: value.copy() for name, value in of.items()}
        for name, value in new.items():
            if name not in of:
                raise ValueError(f"there is no {what} {name!r}: write one of {', '.join(of) or 'none'}")
            changed[name][rows] = real_array(name, value)
        return changed


def _rows(value: ArrayLike, count: int) -> Array:
    """A number for each row."""
    return np.full(count, value, dtype=float)
