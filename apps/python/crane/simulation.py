"""Simulations that are stepped from outside, for controllers and learning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .arguments import by_name
from .closed import Closed
from .results import Array

if TYPE_CHECKING:
    from ._native import Motions
    from .model import Crane


@dataclass(frozen=True)
class State:
    """A state of a simulation, to return to.

    Its arrays cannot be changed: `restore` a state with other ones, as in `dataclasses.replace(state, q=...)`.

    t: s. q, v: (n), m and rad, m/s and rad/s. work, dissipated, load_work: J since the start. parameters: live parameters.
    inputs: those that are set. x: states of the oil of cylinders with a valve (pressures on the sides of piston and rod, Pa, and opening of
    each, then the pump's pressure, Pa), then deflections of bristles in joints that stick (rad or m); `restore` takes those that hold the
    pose for an empty array. marks: what the events of the spec have done, by name: the time of each, s; 0 if it is still
    to come, NaN if its condition has to cease before, -1 if its time was before the start; empty before the first step.
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
    marks: dict[str, float] = field(default_factory=dict)


class Simulation(Closed):
    """A crane in motion, step by step.

    >>> import crane
    >>> simulation = crane.load("knuckle_boom").simulation()
    >>> before = simulation.save()
    >>> simulation.step(0.01, payload=900.0)
    >>> simulation.restore(before)

    Inputs of the spec are set by name, `simulation.step(0.01, inputs={"pull": 300.0})`. Events of the spec happen within steps, at their times and on their
    conditions, and set live parameters; those before the start do not.

    The method keeps its step size and its history across calls, so that short calls cost no more than long ones; it keeps them when inputs
    change, too. A new value of a parameter, an input that no longer follows a motion of the spec, and `restore` begin a new history
    from the present state: from then on the same calls give the same numbers, to the last bit. A copy, by `copy.deepcopy` or `pickle`, has
    the history, too, and goes on as the original does, to the last bit.
    """

    _instead = (
        "NAME of a simulation cannot be set: `step(dt, NAME=...)` sets a live parameter, `step(dt, inputs={'NAME': ...})` an input; "
        "`restore` a state; method and tolerance are arguments of `crane.simulation`"
    )

    def __init__(
        self,
        crane: Crane,
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
        self._crane = crane
        q = crane.statics(t=t).q if q is None else crane._coordinates("q", q)
        v = np.zeros_like(q) if v is None else crane._coordinates("v", v)
        self._state = _fixed(State(float(real_array("t", t)), q, v, parameters=crane.parameters, inputs=crane.inputs))
        self._counted = dict.fromkeys(("steps", "rejections", "evaluations", "factorisations"), 0)
        # The running method, and the energies at its beginning.
        self._motion: Motions | None = None
        self._begin = self._state

    def __getstate__(self) -> dict[str, Any]:
        memory = self._motion and self._motion.memory(0)
        return {**self.__dict__, "_motion": memory}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._state = _fixed(self._state)
        if self._motion is not None:
            self._motion = self._crane._recalled(self._timing, True, [self._motion])

    @property
    def crane(self) -> Crane:
        """The crane with its present parameters and inputs."""
        if self._crane.inputs != self._state.inputs:
            self._crane = self._with_inputs(self._crane, self._state.inputs)
        return self._crane

    @property
    def statistics(self) -> dict[str, int]:
        """Steps, rejected steps, evaluations of accelerations and factorisations of all calls together."""
        now = self._motion.statistics(0) if self._motion is not None else {}
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

    def step(self, dt: float, inputs: dict[str, float | None] | None = None, hold: str = "constant", **parameters: float) -> State:
        """Advances the crane by dt, s, with new values of inputs and live parameters from now on. Returns the new state.

        inputs: by name, in the units that `Crane.info` shows; None lets an input follow the spec again.
        hold: "constant" sets inputs at the beginning of the step (zero-order hold), "linear" moves them from their last values, which they have
        at its beginning, to these, which they have at its end (first-order hold), and where they then stay.

        If it fails or is interrupted, the simulation stays where it was.
        """
        linear, inputs = is_linear(hold), numbers_of(self._crane, inputs)
        if parameters:
            self._change(self._crane.replace(**parameters))
        values = self._state.inputs
        if inputs:
            values = {name: value for name, value in {**values, **inputs}.items() if value is not None}
            if self._motion is None or not all(value is not None and self._motion.can_set(name) for name, value in inputs.items()):
                self._release(inputs, values, linear)
        if self._motion is None:
            self._motion, self._begin = self._motion_from_here(), self._state
        try:
            self._motion.advance(dt, 1, _as_set(inputs or {}, self._motion), linear)
            self._motion.check()
        except BaseException:
            self._forget()
            raise
        t, q, v, x, energies = (numbers[0] for numbers in self._motion.states())
        work, dissipated, load_work = energies.tolist()
        begin, marks = self._begin, self._motion.marks(0)
        self._state = State(
            float(t),
            q,
            v,
            work=begin.work + work,
            dissipated=begin.dissipated + dissipated,
            parameters=self._present_parameters(self._motion) if marks else self._state.parameters,
            load_work=begin.load_work + load_work,
            inputs={name: float(value if isinstance(value, (int, float)) else np.squeeze(value)) for name, value in values.items()} if inputs else values,
            x=x,
            marks=marks,
        )
        return self._state

    def _motion_from_here(self) -> Motions:
        """A motion with a new history, from the present state."""
        state = self._state
        return self.crane._motions(self._timing, True, state.t, state.q, state.v, state.x, marks=list(state.marks.values()) or None)

    def _present_parameters(self, motion: Motions) -> dict[str, float]:
        """The live parameters, which events may have set; so has the crane."""
        before = self._state.parameters
        now = dict(zip(before, motion.parameters()[0].tolist(), strict=True))
        if now != before:
            self._crane = self._crane.replace(**now)
        return now

    @property
    def events(self) -> dict[str, float]:
        """Times of the events of the spec that have happened, s, by name."""
        return {name: mark for name, mark in self._state.marks.items() if mark > 0.0}

    def _release(self, inputs: dict[str, float | None], values: dict[str, float], linear: bool) -> None:
        """Ends the history if an input begins or ceases to follow a motion of the spec."""
        set_now = self._state.inputs
        released = [of["name"] for of in self._crane.info["inputs"] if of["moves"] and (of["name"] in values) != (of["name"] in set_now)]
        crane = self._with_inputs(self._crane, values)
        if linear and (moving := [name for name in released if name in inputs]):
            raise ValueError(f'{moving[0]} follows a motion of the spec, or shall follow it again: set it with hold="constant"')
        if released:
            self._forget()
            kept = {name: value for name, value in set_now.items() if name not in released}
            changed = {name: values[name] for name in released if name in values}
            self._crane, self._state = crane, replace(self._state, inputs={**kept, **changed})

    def _with_inputs(self, crane: Crane, inputs: dict[str, float]) -> Crane:
        """A crane with these inputs only."""
        return crane.replace(inputs={**dict.fromkeys(crane.inputs), **inputs})

    def _change(self, crane: Crane) -> None:
        """Takes another crane from now on, unless it has the same parameters."""
        if crane.parameters != self._state.parameters:
            self._forget()
            self._crane = crane
            self._state = replace(self._state, parameters=crane.parameters)

    def _forget(self) -> None:
        """Ends the history; its steps are counted."""
        self._counted = self.statistics
        self._motion = None

    def save(self) -> State:
        """The current state."""
        if self._motion is None and not len(self._state.x):
            # Those that hold the pose, with which the first step begins.
            return replace(self._state, x=self._motion_from_here().states()[3][0])
        return self._state

    def restore(self, state: State) -> None:
        """Goes back to a state that was saved, of this simulation or of another one of the same crane."""
        if not isinstance(state, State):
            raise TypeError(f"restore takes a state that `save` or `step` has returned, not {type(state).__name__}")
        n = self.crane.n
        for name, numbers in (("q", state.q), ("v", state.v)):
            if np.shape(numbers) != (n,):
                raise ValueError(f"{name} of the state has shape {np.shape(numbers)}, and the crane has {n} coordinates")
        crane = self._with_inputs(self._crane.replace(**state.parameters), state.inputs)
        self._forget()
        self._crane, self._state = crane, _fixed(state)


def _as_set(inputs: dict[str, float | None], motion: Motions) -> dict[str, float | None]:
    """Inputs without those that follow motions of the spec: None is what these do already."""
    return {name: value for name, value in inputs.items() if value is not None or motion.can_set(name)}


def numbers_of(crane: Crane, inputs: Mapping[str, Any] | None) -> dict[str, Any]:
    """Values of inputs by name, numbers instead of text with a unit."""
    given = {} if inputs is None else by_name("inputs", inputs, '{"lever": 0.3}')
    return {name: crane.replace(inputs={name: value}).inputs[name] if isinstance(value, str) else value for name, value in given.items()}


def is_linear(hold: str) -> bool:
    """Whether inputs move linearly over a step."""
    if hold not in ("constant", "linear"):
        raise ValueError(f'hold={hold!r}: write "constant" or "linear"')
    return hold == "linear"


def _fixed(state: State) -> State:
    """The state with arrays of its own that cannot be changed: a change would not move the crane."""
    numbers = {name: real_array(name, getattr(state, name)) for name in ("q", "v", "x")}
    for array in numbers.values():
        array.flags.writeable = False
    return replace(state, **numbers)
