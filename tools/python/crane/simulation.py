"""Simulations that are stepped from outside, for controllers and learning."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .results import Array

if TYPE_CHECKING:
    from ._native import Motion
    from .model import Crane


@dataclass(frozen=True)
class State:
    """A state of a simulation, to return to.

    Its arrays cannot be changed: `restore` a state with other ones, as in `dataclasses.replace(state, q=...)`.

    t: s. q, v: (n), m and rad, m/s and rad/s. work, dissipated, load_work: J since the start. parameters: live parameters.
    inputs: those that are set. x: states of the oil of cylinders with a valve (pressures on the sides of piston and rod, Pa, and opening of
    each, then the pump's pressure, Pa), then deflections of bristles in joints that stick (rad or m); empty before the first step,
    which begins with those that hold the pose.
    """

    t: float
    q: Array
    v: Array
    work: float = 0.0
    dissipated: float = 0.0
    parameters: dict[str, float] = field(default_factory=dict)
    load_work: float = 0.0
    inputs: dict[str, float] = field(default_factory=dict)
    x: Array = field(default_factory=lambda: np.zeros(0))


class Simulation:
    """A crane in motion, step by step.

    >>> import crane
    >>> simulation = crane.load("knuckle_boom").simulation()
    >>> before = simulation.save()
    >>> simulation.step(0.01, payload=900.0)
    >>> simulation.restore(before)

    Inputs of the spec are set by name, `simulation.step(0.01, inputs={"pull": 300.0})`.

    The method keeps its history across calls, so that short calls cost no more than long ones. A new value of an input or of a
    parameter, and `restore`, begin a new history from the present state: from then on the same calls give the same numbers, to the
    last bit. So does a copy, by `copy.deepcopy` or `pickle`, of a simulation: it continues from the present state with a new history.
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
        method = timing["method"] or ("rk4" if timing["step"] else None)
        self._timing = {**timing, "method": method}
        self.crane = crane
        q = crane.statics(t=t).q if q is None else q
        v = np.zeros_like(q, dtype=float) if v is None else v
        self._state = _fixed(State(float(real_array("t", t)), q, v, parameters=crane.parameters, inputs=crane.inputs))
        self._counted = dict.fromkeys(("steps", "rejections", "evaluations", "factorisations"), 0)
        # The running method, and the state from which it began.
        self._motion: Motion | None = None
        self._begin = self._state

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_counted": self.statistics, "_motion": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._state = _fixed(self._state)

    @property
    def statistics(self) -> dict[str, int]:
        """Steps, rejected steps, evaluations of accelerations and factorisations of all calls together."""
        now = self._motion.statistics() if self._motion else {}
        return {what: count + now.get(what, 0) for what, count in self._counted.items()}

    @property
    def steps(self) -> int:
        """Steps of all calls together."""
        return self.statistics["steps"]

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
        """Work of the loads applied from outside since the start, J."""
        return self._state.load_work

    def step(self, dt: float, inputs: dict[str, float | None] | None = None, **parameters: float) -> State:
        """Advances the crane by dt, s, with new values of inputs and live parameters from now on. Returns the new state.

        inputs: by name, in the units that `Crane.info` shows; None lets an input follow the spec again.

        If it fails or is interrupted, the simulation stays where it was.
        """
        if parameters or inputs:
            self._change(self.crane.replace(inputs=inputs, **parameters))
        if self._motion is None:
            self._motion = self.crane._motion(self._timing, self._state.t, self._state.q, self._state.v, self._state.x)
            self._begin = self._state
        try:
            t, q, v, x, (work, dissipated, load_work) = self._motion.advance(dt)
        except BaseException:
            self._forget()
            raise
        begin = self._begin
        self._state = State(
            t,
            q,
            v,
            work=begin.work + work,
            dissipated=begin.dissipated + dissipated,
            parameters=self._state.parameters,
            load_work=begin.load_work + load_work,
            inputs=self._state.inputs,
            x=x,
        )
        return self._state

    def _change(self, crane: "Crane") -> None:
        """Takes another crane from now on, unless it has the same parameters and inputs."""
        changed = {"parameters": crane.parameters, "inputs": crane.inputs}
        if changed != {"parameters": self._state.parameters, "inputs": self._state.inputs}:
            self._forget()
            self.crane = crane
            self._state = replace(self._state, **changed)

    def _forget(self) -> None:
        """Ends the history; its steps are counted."""
        self._counted = self.statistics
        self._motion = None

    def save(self) -> State:
        """The current state."""
        return self._state

    def restore(self, state: State) -> None:
        """Goes back to a state that was saved, of this simulation or of another one of the same crane."""
        n = self.crane.n
        for name, numbers in (("q", state.q), ("v", state.v)):
            if np.shape(numbers) != (n,):
                raise ValueError(f"{name} of the state has shape {np.shape(numbers)}, and the crane has {n} coordinates")
        unset = dict.fromkeys(self._state.inputs, None)
        self._change(self.crane.replace(inputs={**unset, **state.inputs}, **state.parameters))
        self._forget()
        self._state = _fixed(state)


def _fixed(state: State) -> State:
    """The state with arrays of its own that cannot be changed: a change would not move the crane."""
    numbers = {name: real_array(name, getattr(state, name)) for name in ("q", "v", "x")}
    for array in numbers.values():
        array.flags.writeable = False
    return replace(state, **numbers)
