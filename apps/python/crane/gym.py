"""Environments for learning, in the interface of Gymnasium: `pip install 'crane[gym]'`.

>>> import crane.gym
>>> env = crane.gym.CraneEnv("my_crane.yaml", actions={"slew": (-0.4, 0.4)}, rates=True, observations=["column_psi", "column_psi_rate"])
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from operator import add
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._native import real_array
from .arguments import names_of
from .loops import closed
from .model import Crane, load
from .results import Array
from .simulation import is_linear
from .vector_simulation import VectorSimulation

Band = tuple[float, float]
# Booleans, numbers of rows, or texts.
Rows = NDArray[Any]
Results = Mapping[str, Array]
Reward = Callable[[Results], Array]


def reach(
    targets: Mapping[str, float] | Sequence[str] | str,
    swing: Mapping[str, float] | Sequence[str] | str = (),
    effort: Mapping[str, float] | Sequence[str] | str = (),
) -> Reward:
    """The reward for coming to targets and damping the swing there, per step: `−Σ ((x − x_target)/s)² − Σ (w/s)² − Σ (a/s)²`.

    targets: results with a target, by name, with the distance s that counts as 1; 1 unless given. swing: results that shall be zero, such as rates of
    a hanging load. effort: results that shall be small, such as actions (`action_slew`).
    """
    missed, *small = (dict(of) if isinstance(of, Mapping) else dict.fromkeys(names_of(of), 1.0) for of in (targets, swing, effort))
    for name, scale in (missed | small[0] | small[1]).items():
        _above_zero(f"the distance of {name!r} that counts as 1", scale)
    # Distances as arrays: NumPy takes longer to read a number than to divide by it.
    scales = [{name: np.array(scale, dtype=float) for name, scale in of.items()} for of in (missed, small[0] | small[1])]
    return _Reach([(name, f"{name}_target", scale) for name, scale in scales[0].items()], list(scales[1].items()))


@dataclass(frozen=True)
class _Reach:
    """The reward that `reach` makes: results, with their targets, and distances that count as 1."""

    missed: list[tuple[str, str, Array]]
    small: list[tuple[str, Array]]

    def __call__(self, results: Results) -> Array:
        missed = [(results[name] - results[target]) / scale for name, target, scale in self.missed]
        small = [results[name] / scale for name, scale in self.small]
        sums = [reduce(add, (each * each for each in of)) for of in (missed, small) if of]
        return -reduce(add, sums) if sums else np.zeros(1)


@dataclass(frozen=True)
class Task:
    """What a crane shall do in an episode: the arguments of `CraneEnv` and `CraneVectorEnv`.

    actions: inputs of the spec by name, with their least and greatest values; without bounds, None, those of the spec: plus and minus `max_effort` of
    the drive whose effort the input is. Actions are scaled: −1 is the least value, 1 the greatest, and those beyond are taken for the nearest of both.
    rates: whether actions are rates of the inputs, per second, instead of values; then bounds are those of the rates.
    observations: names of results: coordinates, their rates (`boom_psi_rate`), points (`tip_x`), inputs (`input_slew`) and targets
    (`boom_psi_target`).
    reward: a function of results by name, (rows) each, and also of actions (`action_slew`), the time `t`, and `dt`; `reach` makes one.
    targets: results with the bands from which their targets are drawn at every reset.
    bands: live parameters with the bands from which they are drawn at every reset (domain randomisation).
    starts: inputs with the bands from which their first values are drawn.
    limits: results with the bands that they may not leave: the episode terminates. tipping: the least tipping margin.
    dt: the time of an action, s; duration: that of an episode, s, after which it is truncated.
    hold: "constant" or "linear": how inputs come to their new values. It is "linear" with rates.
    penalty: the reward when an episode terminates, added to that of its last step.
    scales: of observations, by which they are divided; 1 unless given.
    """

    actions: Mapping[str, Band | None]
    reward: Reward
    observations: Sequence[str] | str = ()
    rates: bool = False
    targets: Mapping[str, Band] = field(default_factory=dict)
    bands: Mapping[str, Band] = field(default_factory=dict)
    starts: Mapping[str, Band] = field(default_factory=dict)
    limits: Mapping[str, Band] = field(default_factory=dict)
    tipping: float | None = None
    dt: float = 0.02
    duration: float = 10.0
    hold: str = "constant"
    penalty: float = 0.0
    scales: Mapping[str, float] = field(default_factory=dict)
    tolerance: float | None = None
    method: str | None = None


class _Episodes:
    """Episodes of a task in many cranes: what both environments share."""

    def __init__(self, crane: Crane | str, count: int, task: Task) -> None:
        self.crane = load(crane) if isinstance(crane, str) else crane
        self.task, self.count = task, count
        if self.crane.shape:
            raise ValueError("the parameters are arrays: give bands, from which each episode draws its own")
        if count < 1:
            raise ValueError(f"num_envs={count}: write how many cranes, 1 or more")
        if not callable(task.reward):
            raise TypeError(f"reward={task.reward!r}: give a function of results by name, such as crane.gym.reach('boom_psi')")
        for what, number in (("dt", task.dt), ("duration", task.duration), *((f"scales[{name!r}]", scale) for name, scale in task.scales.items())):
            _above_zero(what, number)
        coordinates, points, inputs = self.crane.coordinates, self.crane.info["points"], self.crane.info["inputs"]
        self._inputs = [of["name"] for of in inputs]
        if not task.actions:
            raise ValueError("actions: name at least one input of the spec, as in actions={'slew': (-1, 1)}")
        for name in (*task.actions, *task.starts):
            _known(name, self._inputs, "input")
        for name in task.bands:
            _known(name, self.crane.parameters, "live parameter")
        bounds = {name: self._bounds(name) if band is None else band for name, band in task.actions.items()}
        self._actions = list(bounds)
        self._action_names = [f"action_{name}" for name in bounds]
        # Over the rows: NumPy takes twice as long to broadcast.
        self._low, most = (np.tile([float(bounds[name][side]) for name in bounds], (count, 1)) for side in (0, 1))
        self._half = 0.5 * (most - self._low)
        self._one, self._least = np.ones_like(self._low), -np.ones_like(self._low)
        self._steered = [self._inputs.index(name) for name in bounds]
        self._linear = is_linear("linear" if task.rates else task.hold)
        self._dt = np.array(task.dt)
        for name, (low, high) in {**bounds, **task.targets, **task.bands, **task.starts, **task.limits}.items():
            if not low <= high:
                raise ValueError(f"{name!r}: ({low}, {high}): write the least value first")
        # Where episodes begin: inputs that follow motions of the spec are NaN.
        self._parameters = self.crane.parameters
        followed = {of["name"] for of in inputs if of["moves"]}.difference(task.actions)
        self._defaults = {of["name"]: np.nan if of["name"] in followed else of["default"] for of in inputs} | self.crane.inputs
        # Where each result is: an array and its column.
        self._state = [f"{name}{of}" for of in ("", "_rate") for name in coordinates]
        given = [*(f"{name}_target" for name in task.targets), *(f"input_{name}" for name in self._inputs)]
        axes = [f"{point}_{axis}" for point in points for axis in "xyz"]
        arrays = {"states": ["t", *self._state, *given], "points": axes, "velocities": [f"{point}_v{axis}" for point in points for axis in "xyz"]}
        self._places = {name: (array, column) for array, names in arrays.items() for column, name in enumerate(names)}
        for name in (*task.targets, *task.limits):
            _known(name, [of for of in self._places if of not in ("t", *given)], "result")
        self.names = names_of(task.observations) or arrays["states"][1:]
        for name in (*self.names, *task.scales):
            _known(name, [of for of in self._places if of != "t"], "observation")
        self._scales = np.array([task.scales.get(name, 1.0) for name in self.names])
        # What `info` has: observations first.
        self.told = list(dict.fromkeys([*self.names, *given, "t"]))
        self._told = [array for array in arrays if any(self._places[name][0] == array for name in self.told)]
        names = [name for array in self._told for name in arrays[array]]
        self._columns = np.array([names.index(name) for name in self.told])
        # A slice is a view; names that are twice among the observations need an index.
        once = len(set(self.names)) == len(self.names)
        self._observed = slice(len(self.names)) if once else [self.told.index(name) for name in self.names]
        self._limits = [(name, np.array(low, dtype=float), np.array(high, dtype=float)) for name, (low, high) in task.limits.items()]
        # Targets and inputs of all rows, and which of them are actions.
        self._given = np.zeros((count, len(given)))
        self._acted = np.array([given.index(f"input_{name}") for name in self._actions])
        self._simulation: VectorSimulation | None = None
        self._random: list[np.random.Generator] = [np.random.default_rng() for _ in range(count)]
        self._steps = np.zeros(count)
        self._fine = np.full(count, "", dtype=object)
        self._most_steps = np.array(max(1, round(task.duration / task.dt)))
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (len(self.names),), np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(self._actions),), np.float32)

    def _bounds(self, name: str) -> Band:
        bounds = self.crane._input_bounds().get(name)
        if bounds is None or self.task.rates:
            raise ValueError(f"actions[{name!r}]: the spec has no bounds for it; write them, as in actions={{{name!r}: (-1, 1)}}")
        return bounds

    @property
    def begun(self) -> bool:
        """Whether there are episodes."""
        return self._simulation is not None

    @property
    def cranes(self) -> Crane:
        """The cranes of all rows, with their parameters."""
        return self.crane if self._simulation is None else self._simulation.crane

    def seed(self, seeds: Sequence[int | None]) -> None:
        """New random numbers in rows whose seed is given."""
        for row, seed in enumerate(seeds):
            if seed is not None:
                self._random[row] = np.random.default_rng(seed)

    def reset(self, rows: Rows, options: Mapping[str, Any] | None = None) -> "_Results":
        """Begins new episodes in some rows; what options give is not drawn."""
        task, options = self.task, dict(options or {})
        start, targets = (dict(options.pop(of, {})) for of in ("start", "targets"))
        for names, known, what in (
            (options, [*self._parameters, "start", "targets"], "option"),
            (start, [*self._inputs, *self._state], "input or coordinate"),
            (targets, task.targets, "target"),
        ):
            for name, value in names.items():
                names[_known(name, known, what)] = self._rows(name, value)[rows]
        # The same numbers are drawn with and without options.
        drawn = [{of: self._draw(row, bands) for of, bands in self._drawn_from().items()} for row in rows]
        drawn_of = {of: {name: np.array([each[of][name] for each in drawn]) for name in bands} for of, bands in self._drawn_from().items()}
        changed = {**drawn_of["bands"], **options}
        inputs = {**self._defaults, **drawn_of["starts"], **{of: value for of, value in start.items() if of in self._inputs}}
        if self._simulation is None:
            cranes = self.crane.replace(**changed) if changed else self.crane
            self._simulation = cranes.vector_simulation(self.count, method=task.method, tolerance=task.tolerance, inputs=inputs)
        else:
            self._simulation.reset(rows, inputs=inputs, **{**self._parameters, **changed})
        moved = [name for name in start if name not in self._inputs]
        if moved:
            state = np.concatenate((self._simulation.q, self._simulation.v), axis=1)
            for name in moved:
                state[rows, self._state.index(name)] = start[name]
            q, v = np.split(state, 2, axis=1)
            q, v, _ = closed(self.cranes, q, v, moved)
            self._simulation.reset(rows, q=q[rows], v=v[rows])
        targets = {**drawn_of["targets"], **targets}
        self._given[rows] = np.column_stack([*(targets[of] for of in task.targets), *(self._simulation.inputs[of][rows] for of in self._inputs)])
        self._steps[rows] = 0
        reached = self._simulation.state
        return _Results(self, np.column_stack((reached.t, reached.q, reached.v)))

    def _rows(self, name: str, value: Any) -> Array:
        """An option for each row: one number, or as many as there are rows."""
        numbers = real_array(name, value)
        if numbers.shape not in ((), (1,), (self.count,)):
            raise ValueError(f"option {name!r} has shape {numbers.shape}: give one number" + (f", or {self.count} of them" if self.count > 1 else ""))
        return np.full(self.count, numbers)

    def _drawn_from(self) -> dict[str, Mapping[str, Band]]:
        return {"targets": self.task.targets, "bands": self.task.bands, "starts": self.task.starts}

    def _draw(self, row: int, bands: Mapping[str, Band]) -> dict[str, float]:
        return {name: self._random[row].uniform(low, high) for name, (low, high) in bands.items()}

    def step(self, actions: Array) -> tuple["_Results", Array, Rows, Rows, Rows]:
        """Advances all rows: results, rewards, terminations, truncations, and why: texts, empty where an episode goes on."""
        task, simulation = self.task, self._simulation
        if simulation is None:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        shares = np.asarray(actions, dtype=float).reshape(self.count, len(self._actions))
        if np.isnan(shares).any():
            raise ValueError("actions hold NaN: give numbers from -1 to 1")
        values = self._low + (np.minimum(np.maximum(shares, self._least), self._one) + self._one) * self._half
        inputs = self._given.take(self._acted, axis=1) + values * self._dt if task.rates else values
        rows = simulation._steer(task.dt, self._actions, self._steered, inputs, self._linear)
        self._given[:, self._acted] = inputs
        self._steps += 1.0
        results = _Results(self, rows)
        for name, column in zip(self._action_names, values.T, strict=True):
            results[name] = column
        failures = simulation.failures
        why = np.array([reason or "" for reason in failures], dtype=object) if any(failures) else self._fine
        for name, low, high in self._limits:
            out = (results[name] < low) | (results[name] > high)
            if out.any():
                why = np.where((why == "") & out, f"{name} left its limits", why)
        if task.tipping is not None:
            margin = simulation.crane.strength(simulation.q, simulation.v, t=simulation.t).tipping_margin
            why = np.where((why == "") & (margin < task.tipping), "tipping", why)
        rewards = np.empty(self.count)
        rewards[:] = task.reward(results)
        if np.isnan(rewards).any():
            raise ValueError("the reward is NaN: give one that is a number in every state")
        terminations, truncations = why.astype(bool), self._steps >= self._most_steps
        if why is not self._fine:
            rewards += task.penalty * terminations
            truncations &= ~terminations
        return results, rewards, terminations, truncations, why


class _Results(dict[str, Array]):
    """Results of the present states by name, (rows) each; those of points are computed when one of them is first read."""

    def __init__(self, episodes: _Episodes, rows: Array) -> None:
        self["dt"] = episodes._dt
        self._episodes, self._rows = episodes, rows
        self._arrays = {"states": np.concatenate((rows, episodes._given), axis=1)}

    def _array(self, of: str) -> Array:
        if of not in self._arrays:
            crane, (q, v) = self._episodes.cranes, np.split(self._rows[:, 1:], 2, axis=1)
            found = crane.points(q) if of == "points" else crane.point_velocities(q, v)
            self._arrays[of] = found.reshape(len(found), -1)
        return self._arrays[of]

    def __missing__(self, name: str) -> Array:
        places = self._episodes._places
        array, column = places[name if name in places else _known(name, places, "result")]
        self[name] = found = self._array(array)[:, column]
        return found

    def told(self) -> tuple[Array, Array]:
        """Observations, (rows, names), and what is told, (rows, told)."""
        episodes = self._episodes
        arrays = [self._array(of) for of in episodes._told]
        told = (arrays[0] if len(arrays) == 1 else np.concatenate(arrays, axis=1)).take(episodes._columns, axis=1)
        return told[:, episodes._observed] / episodes._scales, told


def _above_zero(what: str, number: float) -> None:
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{what} is {number}: write a number above 0")


def _known(name: str, of: Any, what: str) -> str:
    if name not in of:
        raise ValueError(f"there is no {what} {name!r}: write one of {', '.join(of) or 'none'}")
    return name


class CraneEnv(gymnasium.Env):
    """A crane as an environment of Gymnasium: `Task` explains the arguments, such as actions and reward.

    `reset(seed=...)` draws targets, parameters and first inputs: the same seed and the same actions give the same episode, to the last bit. It can
    be copied and pickled within an episode. `info` has the results by name, and `why` an episode terminated: what left its limits, "tipping",
    or how the integration failed. Observations and rewards are those of the state reached.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, crane: Crane | str, *, render_mode: str | None = None, **task: Any) -> None:
        if render_mode is not None:
            _known(render_mode, self.metadata["render_modes"], "render mode")
        self.render_mode = render_mode
        self._episodes = _Episodes(crane, 1, Task(**task))
        self.metadata = {**self.metadata, "render_fps": round(1 / self._episodes.task.dt)}
        self.observation_space, self.action_space = self._episodes.observation_space, self._episodes.action_space

    @property
    def crane(self) -> Crane:
        """The crane, with the parameters of its spec."""
        return self._episodes.crane

    @property
    def observation_names(self) -> list[str]:
        """What each number of an observation is."""
        return list(self._episodes.names)

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begins a new episode. options, for this episode alone: live parameters by name, `{"payload": 300}`; "start", first values of inputs,
        and of coordinates and their rates, which otherwise are at rest, `{"start": {"slew": 0.1, "load_phi_rate": 0.2}}`; and "targets".
        """
        super().reset(seed=seed)
        self._episodes.seed([seed])
        return self._told(self._episodes.reset(np.array([0]), options), "")

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Advances the crane by `dt` with an action."""
        results, rewards, terminations, truncations, why = self._episodes.step(action)
        observation, info = self._told(results, why[0])
        return observation, float(rewards[0]), bool(terminations[0]), bool(truncations[0]), info

    def render(self) -> NDArray[np.uint8] | None:
        """The crane as it is now, (480, 640, 3) red, green and blue, with `render_mode="rgb_array"`; else nothing."""
        if self.render_mode is None:
            return None
        simulation = self._episodes._simulation
        if simulation is None:
            raise gymnasium.error.ResetNeeded("call reset() before render()")
        crane = simulation.crane
        # Room for where statics begins, too: the view then seldom moves with the crane.
        return crane.render(simulation.q[0], shown=[crane.guess.reshape(-1), simulation.q[0]])

    def _told(self, results: _Results, why: str) -> tuple[Array, dict[str, Any]]:
        observations, told = results.told()
        info = dict(zip(self._episodes.told, told[0].tolist(), strict=True))
        info["why"] = why
        return observations[0], info


class CraneVectorEnv(gymnasium.vector.VectorEnv):
    """Many cranes as a vector environment of Gymnasium, stepped together on all threads: `Task` explains the arguments.

    autoreset_mode: what follows an episode that ends, as in Gymnasium's own vector environments, member or value of `AutoresetMode`. "NextStep": it
    begins again at the next step, whose action is ignored and whose reward is 0. "SameStep": at once, with the last observation and `info` in
    `final_obs` and `final_info`. "Disabled": when `reset(options={"reset_mask": ...})` says so, (rows), true where it shall.
    `metadata["autoreset_mode"]` says which. `info` has arrays (rows), each with a mask, `_why` of `why`, as Gymnasium makes them.
    `reset(seed=s)` seeds row i with s + i: it has the episodes of a `CraneEnv` that is reset with that seed, to the last bit.
    """

    metadata = {"render_modes": []}

    def __init__(self, crane: Crane | str, num_envs: int, *, autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP, **task: Any) -> None:
        self._episodes = _Episodes(crane, num_envs, Task(**task))
        self._mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self._mode}
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = self._episodes.observation_space, self._episodes.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, dtype=bool)

    @property
    def crane(self) -> Crane:
        """The crane, with the parameters of its spec."""
        return self._episodes.crane

    @property
    def observation_names(self) -> list[str]:
        """What each number of an observation is."""
        return list(self._episodes.names)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begins new episodes in all rows, or in those where `options["reset_mask"]` is true; other options as of `CraneEnv.reset`, numbers or
        arrays (rows).
        """
        if isinstance(seed, int | np.integer):
            seed = [int(seed) + row for row in range(self.num_envs)]
        seeds = [None] * self.num_envs if seed is None else list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: {len(seeds)} numbers for {self.num_envs} environments")
        options = dict(options or {})
        mask = self._mask(options.pop("reset_mask", None))
        self._episodes.seed([seed if begins else None for seed, begins in zip(seeds, mask, strict=True)])
        results = self._episodes.reset(np.flatnonzero(mask), options)
        self._ended[mask] = False
        return self._told(results, np.full(self.num_envs, "", dtype=object), mask)

    def _mask(self, given: Any) -> Rows:
        """Which rows begin again."""
        if given is None:
            return np.ones(self.num_envs, dtype=bool)
        mask = np.asarray(given)
        if mask.dtype != bool or mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(f"options['reset_mask']: write an array of {self.num_envs} booleans, at least one of them true")
        if not self._episodes.begun and not mask.all():
            raise gymnasium.error.ResetNeeded("call reset() of all rows before that of some")
        return mask

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Advances all cranes by `dt`."""
        again = self._ended
        if self._mode == AutoresetMode.DISABLED and again.any():
            rows = np.flatnonzero(again).tolist()
            raise gymnasium.error.ResetNeeded(f"episodes of rows {rows} have ended: reset(options={{'reset_mask': ...}}) begins new ones")
        results, rewards, terminations, truncations, why = self._episodes.step(actions)
        final: dict[str, Any] = {}
        if self._mode == AutoresetMode.NEXT_STEP and again.any():
            results = self._episodes.reset(np.flatnonzero(again))
            rewards[again], terminations[again], truncations[again] = 0.0, False, False
            why = np.where(again, "", why)
        ended = terminations | truncations
        if self._mode == AutoresetMode.SAME_STEP and ended.any():
            observations, info = self._told(results, why, ended)
            last = np.full(self.num_envs, None, dtype=object)
            for row in np.flatnonzero(ended):
                last[row] = observations[row]
            final = {"final_obs": last, "_final_obs": ended, "final_info": info, "_final_info": ended}
            results = self._episodes.reset(np.flatnonzero(ended))
            why = np.where(ended, "", why)
        self._ended = ended
        observations, info = self._told(results, why, np.ones(self.num_envs, dtype=bool))
        return observations, rewards, terminations, truncations, final | info

    def _told(self, results: _Results, why: Rows, rows: Rows) -> tuple[Array, dict[str, Any]]:
        """Observations of all rows, and `info` of some: each result with a mask of these rows, and zero in the others."""
        observations, told = results.told()
        reasons = why.copy()
        reasons[~rows] = None
        info: dict[str, Any] = {"why": reasons, "_why": rows}
        for name, values in zip(self._episodes.told, np.where(rows, told.T, 0.0), strict=True):
            info[name], info[f"_{name}"] = values, rows
        return observations, info
