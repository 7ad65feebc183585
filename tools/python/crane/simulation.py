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

    t: s. q, v: (n), m and rad, m/s and rad/s. work, dissipated, load_work: J since the start. parameters: live parameters.
    inputs: those that are set.
    """

    t: float
    q: Array
    v: Array
    work: float = 0.0
    dissipated: float = 0.0
    parameters: dict[str, float] = field(default_factory=dict)
    load_work: float = 0.0
    inputs: dict[str, float] = field(default_factory=dict)


class Simulation:
    """A crane in motion, step by step.

    >>> import crane
    >>> simulation = crane.load("knuckle_boom").simulation()
    >>> before = simulation.save()
    >>> simulation.step(0.01, payload=900.0)
    >>> simulation.restore(before)

    Inputs of the spec are set by name, `simulation.step(0.01, inputs={"pull": 300.0})`.

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

    @property
    def load_work(self) -> float:
        """Work that loads applied from outside put in since the start, J."""
        return self._state.load_work

    def step(self, dt: float, inputs: dict[str, float | None] | None = None, **parameters: float) -> State:
        """Moves the crane on by dt, s, with new values of inputs and live parameters from now on. Returns the state reached.

        inputs: by name, in the units that `Crane.info` shows; None gives an input back to its spec.

        Where it fails or is interrupted, the simulation stays where it was.
        """
        crane = self.crane.replace(**parameters) if parameters else self.crane
        now = self._state
        known = [info["name"] for info in crane.info["inputs"]]
        set_now = self._inputs(known, inputs or {})
        timing = {**self._timing, "duration": dt, "output": dt}
        t, q, v, integrals, steps = crane.advance(timing, now.t, now.q, now.v, [set_now.get(name) for name in known])
        work, dissipated, load_work = integrals
        energies = {
            "work": now.work + work,
            "dissipated": now.dissipated + dissipated,
            "load_work": now.load_work + load_work,
        }
        self._state = State(t, q, v, parameters=crane.parameters, inputs=set_now, **energies)
        self.crane = crane
        self.steps += steps
        return self._state

    def _inputs(self, known: list[str], given: dict[str, float | None]) -> dict[str, float]:
        """The inputs that are set from now on."""
        for name, value in given.items():
            if name not in known:
                has = f"inputs: {', '.join(known)}" if known else "it has none; name them under `inputs:` in its spec"
                raise ValueError(f"{self.crane.name} has no input `{name}`; {has}")
            if value is not None and not np.isfinite(value):
                raise ValueError(f"inputs[{name!r}] is {value}, not a finite number")
        merged = {**self._state.inputs, **given}
        return {name: float(value) for name, value in merged.items() if value is not None}

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
