"""Simulations that are stepped from outside, for controllers and learning."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .results import Array

if TYPE_CHECKING:
    from .model import Crane


@dataclass(frozen=True)
class State:
    """A moment of a simulation, to come back to.

    t: s. q, v: (n), m and rad, m/s and rad/s. work, dissipated: J since the start. parameters: live parameters.
    """

    t: float
    q: Array
    v: Array
    work: float = 0.0
    dissipated: float = 0.0
    parameters: dict[str, float] = field(default_factory=dict)


class Simulation:
    """A crane in motion, step by step.

    >>> import crane
    >>> simulation = crane.load("knuckle_boom").simulation()
    >>> before = simulation.save()
    >>> simulation.step(0.01, payload=900.0)
    >>> simulation.restore(before)

    Each step is a run of its own from the present state: the same state and the same step give the same numbers, to the last
    bit, whatever came before. So a saved state can be restored, copied or sent to another process.
    """

    def __init__(
        self,
        crane: "Crane",
        timing: dict[str, Any],
        *,
        t: float = 0.0,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
    ) -> None:
        if crane.shape:
            raise ValueError("the parameters are arrays: a simulation needs one value of each")
        # Each step starts from the state alone: methods of one step lose nothing by that.
        method = timing["method"] or ("rk4" if timing["step"] else "rosw4")
        self._timing = {**timing, "method": method}
        self.crane = crane
        q = crane.statics(t=t).q if q is None else np.array(q, dtype=float)
        v = np.zeros_like(q) if v is None else np.array(v, dtype=float)
        self._state = State(float(t), q, v, parameters=crane.parameters)
        self.steps = 0

    @property
    def t(self) -> float:
        """Time, s."""
        return self._state.t

    @property
    def q(self) -> Array:
        """Coordinates, (n), m and rad."""
        return self._state.q

    @property
    def v(self) -> Array:
        """Rates, (n), m/s and rad/s."""
        return self._state.v

    @property
    def work(self) -> float:
        """Work of the drives' motions since the start, J."""
        return self._state.work

    @property
    def dissipated(self) -> float:
        """Energy that the dampers dissipated since the start, J."""
        return self._state.dissipated

    def step(self, dt: float, **parameters: float) -> State:
        """Moves the crane on by dt, s, with new values of live parameters from now on. Returns the state reached.

        Where it fails or is interrupted, the simulation stays where it was.
        """
        crane = self.crane.replace(**parameters) if parameters else self.crane
        now = self._state
        timing = {**self._timing, "duration": dt, "output": dt}
        t, q, v, work, dissipated, steps = crane.advance(timing, now.t, now.q, now.v)
        self._state = State(t, q, v, now.work + work, now.dissipated + dissipated, crane.parameters)
        self.crane = crane
        self.steps += steps
        return self._state

    def save(self) -> State:
        """The current state."""
        return self._state

    def restore(self, state: State) -> None:
        """Goes back to a state that was saved, of this simulation or of another one of the same crane."""
        n = self.crane.n
        for name, numbers in (("q", state.q), ("v", state.v)):
            if np.shape(numbers) != (n,):
                raise ValueError(f"{name} of the state has shape {np.shape(numbers)}, and the crane has {n} coordinates")
        if state.parameters != self.crane.parameters:
            self.crane = self.crane.replace(**state.parameters)
        self._state = state
